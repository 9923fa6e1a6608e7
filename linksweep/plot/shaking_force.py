"""Plots of shaking: the hodograph of a force vector, and the orders of signals."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from linksweep.base.validate import one_text_problems, refuse
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import BLUE, GREEN, ORANGE, PURPLE, VERMILION
from linksweep.plot.kit.locus import SIZE, draw_locus
from linksweep.plot.kit.style import axes_or_new, grid
from linksweep.plot.kit.with_peaks import with_peaks
from linksweep.results.compute import requested, require_results
from linksweep.results.origin.in_shown_units import in_shown_units
from linksweep.results.origin.machine_of_results import name_in_results

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLORS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE)
ENDING = "_amplitude"


def hodograph(ds: xr.Dataset, of: str = "Fs", *, ax: Axes | None = None) -> Axes:
    """Plot the path of a vector's tip over the revolution: of the shaking force [N], or of a pin force.

    Parameters
    ----------
    ds : Dataset
        Cycle from `linksweep.sweep` with the components (Fsx, Fsy), of one design.
    of : str, default "Fs"
        Vector, named as its components without x and y.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with equal scales, a dot every 30 degrees of the crank, of many turns fewer, and an arrow to the
        largest.

    Raises
    ------
    ValueError
        For components that are not in the Dataset, and for more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.plot.hodograph(ls.sweep(ls.example("press"), of=["Fsx", "Fsy"])).get_xlabel()
    'shaking force $F_{sx}$ [N]'
    """
    refuse(one_text_problems("of", of, "the name of a force, such as Fs"))
    of = name_in_results(ds, of)
    ds = with_peaks(ds, of)
    missing = [part for part in (f"{of}x", f"{of}y") if part not in ds]
    refuse([f"ds has no {part}: sweep with of=[..., {part!r}]" for part in missing])
    angles, x, y = signals.revolution(ds, ds[f"{of}x"], ds[f"{of}y"])
    ax, units = axes_or_new(ax, figsize=SIZE), signals.unit(ds[f"{of}x"], "N")
    last = min(angles[-1], angles[0] + 359.0)  # inertia is the same in all turns
    draw_locus(ax, of, angles, x, y, units, last, nothing=signals.reasons(ds, ds[f"{of}x"]))
    words = "shaking force" if of == "Fs" else "force"
    across, up = (f"{words} {signals.force_symbol(of + axis)} [{units}]" for axis in "xy")
    ax.set(xlabel=across, ylabel=up)
    return ax


def orders(ds: xr.Dataset, of: Iterable[str] | None = None, *, ax: Axes | None = None) -> Axes:
    """Plot the amplitudes of orders as bars, those of several signals side by side.

    Parameters
    ----------
    ds : Dataset
        Result of `linksweep.orders`, of one design.
    of : iterable of str, default None
        Signals with one common unit; None for all in the Dataset.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with order 0 as the mean, and the largest order of each signal in the legend.

    Raises
    ------
    ValueError
        For a Dataset without orders, for unknown signals, several units or designs, and for more than five signals.

    Examples
    --------
    >>> import linksweep as ls
    >>> shaking = ls.orders(ls.sweep(ls.example("engine"), of=["Fsx", "Fsy"]), ["Fsx", "Fsy"], n=6)
    >>> ls.plot.orders(shaking).get_ylabel()
    'amplitude [N]'
    """
    require_results(ds, "ls.orders")
    known = [str(key).removesuffix(ENDING) for key in ds.data_vars if str(key).endswith(ENDING)]
    names = known if of is None else [name_in_results(ds, name) for name in requested("of", of)]
    refuse([] if known else ["ds has no amplitudes: take what ls.orders returns"])
    refuse([f"of: there are no orders of {name}; there are {', '.join(known)}" for name in {*names} - {*known}])
    ds = in_shown_units(ds)
    chosen = [ds[name + ENDING] for name in names]
    units = {amplitude.attrs["units"] for amplitude in chosen}
    several = "must share one unit: plot each alone"
    refuse([f"of = {names}: {several}"] if len(units) > 1 else [])
    refuse([] if 0 < len(names) <= len(COLORS) else [f"of: one to {len(COLORS)} signals, not {len(names)}"])
    refuse([f"{a.name} is over {a.dims}: plot one design, as ds.isel(...)" for a in chosen if a.ndim > 1])
    from matplotlib.ticker import MaxNLocator

    ax = grid(axes_or_new(ax))
    order = ds["order"].values
    step = order[1] - order[0] if len(order) > 1 else 1.0
    width = 0.8 * step / len(names)
    for k, (name, amplitude) in enumerate(zip(names, chosen, strict=True)):
        place = order + (k - 0.5 * (len(names) - 1)) * width
        ax.bar(place, amplitude.values, width, color=COLORS[k], label=_legend_text(name, amplitude))
    ax.xaxis.set_major_locator(MaxNLocator(16, integer=True))
    ax.set(xlabel="order [turns per turn of the crank]", ylabel=f"amplitude [{units.pop()}]")
    ax.margins(y=0.12)
    ax.set_ylim(bottom=0.0)
    ax.legend(fontsize="small", frameon=False)
    return ax


def _legend_text(name: str, amplitude: xr.DataArray) -> str:
    """Return the legend of a signal, with its largest order."""
    text = signals.force_symbol(name) if name[0] == "F" else signals.symbol(name) or name.replace("_", " ")
    if not np.nansum(amplitude.values) > 0.0:
        return text
    largest = amplitude.isel(order=int(np.nanargmax(amplitude.values)))
    return f"{text}, largest {signals.number(float(largest))} {amplitude.units} at order {float(largest.order):g}"
