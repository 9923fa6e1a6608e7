"""Results as a table: one row per design, or per design and crank angle, for spreadsheets and pandas."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.files.atomic import ending_of, whole
from linksweep.mechanisms import indices
from linksweep.results.origin.in_shown_units import in_shown_units

if TYPE_CHECKING:
    import pandas as pd

FORMULAS = ("=", "+", "-", "@", "\t", "\r")
"""First characters of a text that a spreadsheet evaluates as a formula."""
COUNT = "number_of_observations"
"""Standard name, by the CF conventions, of counts of designs, which are no results of one."""


def to_pandas(ds: xr.Dataset) -> pd.DataFrame:
    """Return a Dataset as a pandas table.

    Parameters
    ----------
    ds : Dataset
        Dataset of linksweep.

    Returns
    -------
    pandas.DataFrame
        Table with a row per design, or per design and crank angle. The columns are the dims (labels, or positions
        from 0), the parameters that vary, then the results; each has its unit in its name, "F32_peak [N]", always
        of SI. Status is in words. Counts of a screening have a table of their own, ``ds[["F32_peak_count"]]``.

    Examples
    --------
    >>> import linksweep as ls
    >>> table = ls.peaks(ls.example("press"), of=["F32"]).linksweep.to_pandas()
    >>> list(table.columns)
    ['F32_peak [N]', 'F32_peak_at [degree]', 'status']
    """
    import pandas as pd  # here: its import is slow

    ds = without_counts(ds)
    sizes = {dim: ds.sizes[dim] for dim in sorted(ds.sizes, key=lambda dim: dim in indices())}  # angles innermost
    known = ds.assign_coords({dim: np.arange(n) for dim, n in sizes.items() if dim not in ds.coords})
    names = [*sizes, *(name for name in known.coords if name not in sizes), *known.data_vars]
    return pd.DataFrame({header_of(known[name]): _column(known[name].variable, sizes) for name in names})


def without_counts(ds: xr.Dataset) -> xr.Dataset:
    """Return a Dataset without counts of designs, which have dims of their own; one of nothing else as it is."""
    counts = [values for values in ds.data_vars.values() if values.attrs.get("standard_name") == COUNT]
    dims = {dim for values in counts for dim in values.dims}
    return ds.drop_dims(dims) if dims < {*ds.dims} else ds


def to_csv(ds: xr.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a Dataset as a CSV file, whole or not at all, with the columns of `to_pandas`.

    They are in the units in which results are shown, see `linksweep.units`, and have all their digits, NaN as an empty
    cell. A label that a spreadsheet would evaluate as a formula is preceded by an apostrophe.

    Parameters
    ----------
    ds : Dataset
        Dataset of linksweep.
    path : str or PathLike
        File to write, "study.csv".

    Raises
    ------
    ValueError
        When the name of the file does not end in .csv.
    OSError
        When the folder is missing, cannot be written or is full; an existing file stays.
    """
    ending_of(path, (".csv",))
    table = to_pandas(in_shown_units(ds))
    with whole(path) as temporary:
        table.map(_no_formula).rename(columns=_no_formula).to_csv(temporary, index=False, encoding="utf-8")


def _no_formula(cell: Any) -> Any:
    """Return a cell unchanged, or with an apostrophe before a text that a spreadsheet would evaluate."""
    if not isinstance(cell, str):
        return cell
    mark = "'" if cell.startswith(FORMULAS) and not _is_number(cell) else ""
    return mark + cell.replace("\r", "\n")  # csv puts line feeds in quotes


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def header_of(values: xr.DataArray) -> str:
    """Return the title of a variable's column, "F32_peak [N]"."""
    units = str(values.attrs.get("units", ""))
    return str(values.name) if units in ("", "1") else f"{values.name} [{units}]"


def _column(variable: xr.Variable, sizes: dict[Any, int]) -> Any:
    """Return one value per row; flags in words, nothing for NaN."""
    values = variable.set_dims(sizes).values.reshape(-1)
    if "flag_meanings" not in variable.attrs:
        return values
    words = np.array([*str(variable.attrs["flag_meanings"]).split(), ""])  # NaN stands behind all values
    return words[np.searchsorted(np.atleast_1d(variable.attrs["flag_values"]), values)]
