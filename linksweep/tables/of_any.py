"""The table of any result: values of single numbers, ranges of those over angles and designs, flags in words."""

from __future__ import annotations

from collections.abc import Hashable, Iterator

import numpy as np
import xarray as xr

from linksweep.mechanisms import indices
from linksweep.tables.cells import digits, fixed, in_words, label, meanings, plain_unit, unit_of
from linksweep.tables.table import Part, Row, Table

MOST_DIMS = 2
"""Dims that the title of a column names."""
FEW = 4
"""Places along a dim without labels, such as the arcs of a check, that have a row each."""


def parts_of_any(ds: xr.Dataset) -> Iterator[Part]:
    """Yield the table of single numbers, the table of what changes, and the flags in words."""
    for index in [dim for dim in indices() if ds.sizes.get(dim) == 1]:
        yield f"at {index} = {fixed(float(ds[index].values[0]), 2)}°"
        ds = ds.isel({index: 0}, drop=True)
    names = [str(name) for name in ds.data_vars if not _is_angle_of_another(ds, str(name))]
    numbers = [name for name in names if "flag_meanings" not in ds[name].attrs and ds[name].dtype.kind in "fiu"]
    few = [name for name in numbers if _has_few(ds, name)]
    yield _values(ds, few)
    yield _ranges(ds, [name for name in numbers if name not in few])
    flags = [name for name in names if "flag_meanings" in ds[name].attrs]
    yield Table((), [(name.replace("_", " ") + ":", in_words(ds[name])) for name in flags], right=())


def parts_to_compute(ds: xr.Dataset) -> Iterator[Part]:
    """Yield the table of names, dims and units of results that dask has yet to compute."""
    rows = [(str(name), ", ".join(map(str, each.dims)), unit_of(each)) for name, each in ds.data_vars.items()]
    yield Table(("quantity", "dims", "unit"), rows, right=(), meanings=meanings(ds))
    yield "Not computed yet: call .compute()."


def _is_angle_of_another(ds: xr.Dataset, name: str) -> bool:
    base = name.removesuffix("_at")
    return base != name and base in ds and ds[base].dims == ds[name].dims


def _has_few(ds: xr.Dataset, name: str) -> bool:
    """Return whether a variable has so few values that each has a row of its own."""
    sizes = ds[name].sizes
    return all(_is_named(ds, dim) or (dim not in ds.coords and n <= FEW) for dim, n in sizes.items())


def _is_named(ds: xr.Dataset, dim: Hashable) -> bool:
    return dim in ds.coords and ds[dim].dtype.kind in "UO" and ds.sizes[dim] <= 3 * FEW


def _values(ds: xr.Dataset, names: list[str]) -> Table:
    """Return the table of single numbers, each with the angle at which it is reached, if it has one."""
    rows: list[Row] = []
    for name in names:
        for place in np.ndindex(ds[name].shape):
            where = [str(label(ds, dim, k)) for dim, k in zip(ds[name].dims, place, strict=True)]
            angle = float(ds[f"{name}_at"].values[place]) if f"{name}_at" in ds else np.nan
            at = f"{fixed(angle, 2)}°" if np.isfinite(angle) else ""
            title = f"{name} ({', '.join(where)})" if where else name
            value = float(ds[name].values[place])
            known = (title, "none", "") if np.isnan(value) else (title, digits(value), plain_unit(ds[name]))
            rows.append((*known, at))
    cut = 4 if any(row[3] for row in rows) else 3
    header = ("quantity", "value", "unit", "at")
    return Table(header[:cut], [row[:cut] for row in rows], meanings=_of_rows(ds, rows))


def _of_rows(ds: xr.Dataset, rows: list[Row]) -> dict[str, str]:
    known = meanings(ds)
    return {row[0]: known.get(row[0].partition(" (")[0], "") for row in rows}


def _ranges(ds: xr.Dataset, names: list[str]) -> Table:
    """Return the table of least and largest values, each with its place."""
    dims = list(dict.fromkeys(dim for name in names for dim in ds[name].dims))
    over = ", ".join(map(str, dims)) if len(dims) <= MOST_DIMS else "these"
    rows: list[Row] = []
    for name in names:
        if ds[name].size and np.isfinite(ds[name].values).any():
            least, largest = (_end(ds, name, sign) for sign in (1.0, -1.0))
            rows.append((name, *least, *largest, plain_unit(ds[name])))
        else:
            rows.append((name, "none", "", "none", "", plain_unit(ds[name])))
    header = ("quantity", "least", f"at {over}", "largest", f"at {over}", "unit")
    return Table(header, rows, right=(1, 2, 3, 4), meanings=meanings(ds))


def _end(ds: xr.Dataset, name: str, sign: float) -> tuple[str, str]:
    """Return the least value and its place; with sign −1 the largest."""
    values = ds[name].values
    k = np.unravel_index(np.argmin(np.where(np.isnan(values), np.inf, sign * values)), values.shape)
    places = (_place(ds, dim, int(j)) for dim, j in zip(ds[name].dims, k, strict=True))
    return digits(float(values[k])), ", ".join(places)


def _place(ds: xr.Dataset, dim: Hashable, k: int) -> str:
    return f"{fixed(float(ds[dim].values[k]), 2)}°" if dim in indices() and dim in ds.coords else str(label(ds, dim, k))
