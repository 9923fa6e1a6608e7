"""Tornado plot: how far the tolerance of each parameter alone moves a result."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from linksweep.base.validate import count_problems, name_problems, refuse
from linksweep.plot.kit.colors import BLACK, BLUE, GREY, ORANGE
from linksweep.plot.kit.style import axes_or_new, grid, panels
from linksweep.results.compute import require_dataset
from linksweep.results.origin.in_shown_units import in_shown_units
from linksweep.results.origin.machine_of_results import name_in_results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


MOST = 12
"""Parameters with a bar, unless told otherwise."""


def tornado(ds: xr.Dataset, of: str | None = None, *, most: int = MOST, ax: Axes | None = None) -> Axes:
    """Plot how far each tolerance alone moves a result, the widest on top.

    Parameters
    ----------
    ds : Dataset
        Result of `linksweep.tolerance`, of one design.
    of : str, default None
        Name of the result, such as "F32_peak"; None for the first in the Dataset.
    most : int, default 12
        Largest number of parameters.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with a bar for each parameter from its lower to its upper limit, and ±3 sigma of all together, about their
        mean, as a band.

    Raises
    ------
    ValueError
        For a Dataset without tolerances, for an unknown name, for more than one design, for a count below 1, and for a
        result that is infinite or has no derivative.

    Examples
    --------
    >>> import linksweep as ls
    >>> made = {"crank.length": "js9", "ground": "js9"}
    >>> ls.plot.tornado(ls.tolerance(ls.example("press"), made, of="F32_peak", n=0)).get_xlabel()
    'F32_peak [N]'
    """
    from matplotlib.ticker import MaxNLocator  # here: only those who plot need wait for it

    require_dataset(ds, "ls.tolerance")
    known = _results(ds)
    refuse([] if known else ["ds has no tolerances: take what ls.tolerance returns"])
    name = known[0] if of is None else name_in_results(ds, of)
    refuse(name_problems("of", name, known) + count_problems("most", most))
    several = [str(dim) for dim in ds[f"{name}_share"].dims if dim != "parameter"]
    one = f"take one, as ds.isel({dict.fromkeys(several, 0)})"
    refuse([f"ds has several designs, over {', '.join(several)}: {one}"] if several else [])
    ds = in_shown_units(ds)
    nominal, sigma, shift = (float(ds[f"{name}{word}"]) for word in ("", "_sigma", "_shift"))
    finite = np.isfinite(nominal) and np.isfinite(sigma)
    refuse([] if finite else [f"ds has no finite {name} with a derivative: its {name}_status says why"])
    lower, upper = (ds[f"{name}_{word}"].values for word in ("lower", "upper"))
    order = np.argsort(np.maximum(abs(lower), abs(upper)))[-most:]
    ax = grid(axes_or_new(ax, figsize=_size(len(order))))
    mean = nominal + shift
    ax.axvspan(mean - 3.0 * sigma, mean + 3.0 * sigma, color=GREY, alpha=0.2, label="±3 sigma of all")
    for changes, color, text in ((lower, BLUE, "at its lower limit"), (upper, ORANGE, "at its upper limit")):
        ax.barh(np.arange(len(order)), changes[order], left=nominal, color=color, height=0.6, label=text)
    ax.axvline(nominal, color=BLACK, linewidth=1.0)
    ax.set_yticks(np.arange(len(order)), [str(ds["parameter"].values[k]) for k in order])
    ax.xaxis.set_major_locator(MaxNLocator(5))
    ax.ticklabel_format(axis="x", useOffset=False)
    ax.set_xlabel(f"{name} [{ds[name].attrs['units']}]")
    ax.legend(fontsize="small", frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, borderaxespad=0.2)
    return ax


def tornados(ds: xr.Dataset) -> Figure:
    """Return a figure with a panel for each result of a tolerance, of one design, that has finite numbers."""
    finite = [name for name in _results(ds) if np.isfinite(ds[name]) and np.isfinite(ds[f"{name}_sigma"])]
    names = finite or _results(ds)[:1]  # the first states what it lacks
    width, height = _size(min(ds.sizes["parameter"], MOST))
    with panels(len(names), 1, figsize=(width, height * len(names)), squeeze=False) as (figure, axes):
        for name, ax in zip(names, axes[:, 0], strict=True):
            tornado(ds, name, ax=ax)
    return figure


def _results(ds: xr.Dataset) -> list[str]:
    """Return the names of the results whose tolerances a Dataset holds."""
    return [str(key).removesuffix("_share") for key in ds.data_vars if str(key).endswith("_share")]


def _size(bars: int) -> tuple[float, float]:
    """Return width and height [inch] of a figure of so many bars."""
    return 6.4, 1.6 + 0.3 * bars
