"""Plots of the causes of a pin's load: the contribution of each source, and the peak over the crank's speed."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.analysis.pins.breakdown import breakdown as breakdown_of
from linksweep.analysis.pins.speed_limit import LIMITS, speed_limit
from linksweep.base.checked_number import one_number
from linksweep.base.conversion import all_to_float64
from linksweep.base.validate import name_problems, quote, refuse
from linksweep.files.netcdf import scene_of
from linksweep.plot.curves import shade_gaps
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION
from linksweep.plot.kit.style import axes_or_new, crank_angles, grid
from linksweep.plot.kit.with_peaks import between, with_peaks
from linksweep.results.compute import requested_one, require, require_results
from linksweep.results.origin.in_shown_units import results_in_shown_units
from linksweep.results.peaks import peaks
from linksweep.scene.changes import angles_of_changes
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import UnitSystem, shown_units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLORS = (BLUE, ORANGE, GREEN, SKY, VERMILION, PURPLE, "#F0E442")
ROOM = 1.3  # of the largest value, for the legend
HATCHES = ("", "///", "\\\\\\", "...")


def breakdown(ds: xr.Dataset, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Plot the sources of a pin's load over the revolution: their contributions stacked, their sum as a line.

    Parameters
    ----------
    ds : Dataset
        Result of `linksweep.breakdown`, of one design.
    of : str, default None
        Force or torque; None for the first in the Dataset.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with contributions that load stacked upwards from 0, those that relieve (or turn backwards) downwards.
        Where they grow without bound beside angles that have no result, the axis ends at a usual size.

    Raises
    ------
    ValueError
        For a Dataset without sources, for an unknown name, and for more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.plot.breakdown(ls.breakdown(ls.example("press"), "F32")).get_ylabel()
    'share in $F_{32}$ [N]'
    """
    require_results(ds, "ls.breakdown")
    known = [str(key) for key, item in ds.data_vars.items() if "source" in item.dims]
    refuse([] if known else ["ds has no sources: take what ls.breakdown returns"])
    of = known[0] if of is None else signals.force_named(ds, of)
    refuse(name_problems("of", of, known))
    signals.require_one_design([ds[of].isel(source=0)])
    signals.require_angles(ds)
    ds = results_in_shown_units(_with_peaks(ds, of))
    ax = grid(axes_or_new(ax))
    rows = [(str(s), signals.revolution(ds, ds[of].sel(source=s))) for s in ds["source"].values]
    rows = [(source, row) for source, row in rows if np.nanmax(np.abs(row[1]), initial=0.0) > 0.0]
    bases: dict[float, Any] = {1.0: 0.0, -1.0: 0.0}
    for k, (source, (angles, values)) in enumerate(rows):
        look: dict[str, Any] = {"color": COLORS[k % len(COLORS)], "hatch": HATCHES[k // len(COLORS) % len(HATCHES)]}
        for sign, base in bases.items():
            top = base + np.where(values * sign > 0.0, values, 0.0)
            ax.fill_between(angles, base, top, **look, linewidth=0.0, label=source if sign > 0.0 else None, alpha=0.85)
            bases[sign] = top
    angles, whole = signals.revolution(ds, ds[of].sum("source", skipna=False))
    ax.plot(angles, whole, color=BLACK, linewidth=1.6, label="sum")
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    crank_angles(ax, angles)
    _usual_size(ax, angles, whole, {sign: np.asarray(base) for sign, base in bases.items()})
    shade_gaps(ax, ds, ds[of].sum("source", skipna=False))
    ax.set_ylabel(f"share in {signals.symbol(of) or of} [{signals.unit(ds[of], 'N')}]")
    ax.legend(fontsize="small", frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return ax


def _with_peaks(ds: xr.Dataset, of: str) -> xr.Dataset:
    """Return a breakdown with samples at the exact peaks of its sum, and where loads change.

    To one that was altered, or whose sum is unbounded, no samples are added.
    """
    whole = ds[["status"]].assign({of: ds[of].sum("source", skipna=False, keep_attrs=True)})
    more = with_peaks(whole, of)
    if signals.WHOLE_TURN not in more.attrs or np.isinf(more[of]).any():
        return ds
    scene, angles, turn = scene_of(ds), more[signals.INDEX].values, more.attrs[signals.WHOLE_TURN]
    ends = angles[0], angles[0] + turn if turn else angles[-1]
    angles = np.union1d(angles, between(angles_of_changes(scene), ends, scene.period))
    return breakdown_of(scene, of, theta2=angles).assign_attrs({signals.WHOLE_TURN: turn})


def _usual_size(ax: Axes, angles: np.ndarray, whole: np.ndarray, stacks: dict[float, np.ndarray]) -> None:
    """Limit the axis to usual sizes, where the sum grows without bound beside a gap."""
    size = np.abs(whole)
    largest = signals.peak(angles, size)
    usual = signals.scale([(angles, size)], [largest])
    if largest is None or largest.value <= usual:
        return
    tops = [float(np.max(np.abs(stack[size <= usual]), initial=0.0)) for stack in stacks.values()]
    ax.set_ylim(-1.1 * tops[1], 1.1 * tops[0])
    ax.set_title("off scale beside a gap", loc="left", fontsize="small", color=GREY)


def over_speed(scene: Scene, of: str, *, speeds: Any, below: float | None = None, ax: Axes | None = None) -> Axes:
    """Plot the exact peak of a force or torque over the speed of the crank, with the highest speed that keeps a limit.

    Parameters
    ----------
    scene : Scene
        Scene of one design; with a limit, one without friction and dampers.
    of : str
        Pin force, or the drive's torque; for a signed quantity the largest magnitude is drawn.
    speeds : array_like
        Speeds of the crank [rad/s], in place of the scene's omega2.
    below : float, default None
        Limit of the peak [N, N m]; None for no limit.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with the peak at rest, of weight and loads alone, as a dashed line.

    Raises
    ------
    ValueError
        For speeds that are no list of numbers; otherwise as `linksweep.peaks` and `linksweep.speed_limit` do.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.plot.over_speed(ls.example("press"), "F32", speeds=range(10, 52, 2), below=500.0).get_xlabel()
    'crank speed $\\\\omega_2$ [rad/s]'
    """
    require(scene, "drives")
    values = _of_crank(speeds)
    omega2 = xr.DataArray(values, dims="omega2")
    of = requested_one("of", of, scene)
    at_rest = replace(scene, omega2=0.0)
    name = f"{of}_peak"
    worst = peaks(replace(scene, omega2=omega2.assign_coords(omega2=omega2)), of=[of])[name]
    refuse([] if np.isfinite(worst).any() else [f"{of} grows without bound at every speed: see the status of ls.peaks"])
    system, force = shown_units(scene.units), worst.attrs["units"]
    rest = system.value(float(peaks(at_rest, of=[of])[name]), force)
    limit = None if below is None else float(speed_limit(scene, of, below=below).omega2_limit)
    ax = grid(axes_or_new(ax))
    symbol, units = signals.symbol(of) or of, system.unit(force)
    speeds, sizes = system.value(values, "rad/s"), system.value(worst.values, force)
    most = None if below is None else system.value(one_number("below", below, LIMITS[force]), force)
    ax.plot(speeds, sizes, "-" if len(speeds) > 1 else "o", color=BLUE, label=f"peak of {symbol}")
    ax.axhline(rest, color=GREY, linestyle="--", linewidth=1.0, label="at rest: weight and loads")
    if len(speeds) > 1:
        ax.set_xlim(float(speeds.min()), float(speeds.max()))
    largest = float(np.max(sizes, initial=0.0, where=np.isfinite(sizes)))
    ax.set_ylim(0.0, ROOM * max(largest, most or 0.0) or 1.0)
    if np.isinf(sizes).any():
        ax.set_title("grows without bound at speeds without a curve", loc="left", fontsize="small", color=GREY)
    if limit is not None:
        _mark_limit(ax, system.value(limit, "rad/s"), float(most or 0.0), units, system)
    ax.set(
        xlabel=f"crank speed $\\omega_2$ [{system.unit('rad/s')}]", ylabel=f"largest {symbol} in the cycle [{units}]"
    )
    ax.legend(fontsize="small", frameon=False, loc="upper left")
    return ax


def _of_crank(speeds: Any) -> np.ndarray:
    """Return a list of speeds [rad/s]; ValueError for anything else."""
    converted = all_to_float64("speeds", speeds, "angular_velocity")
    try:
        values = np.asarray(converted, dtype=float)
    except (TypeError, ValueError):
        values = np.empty(0)
    sound = values.ndim == 1 and values.size > 0 and np.isfinite(values).all()
    refuse([] if sound else [f"speeds = {quote(speeds)}: must be a list of numbers in rad/s, as range(10, 52, 2)"])
    return values


def _mark_limit(ax: Axes, limit: float, below: float, units: str, system: UnitSystem) -> None:
    """Draw the limit of the peak, and a dot where each direction of the crank reaches it."""
    from linksweep.plot.kit.labels import label

    low, high = ax.get_xlim()
    signed = f"{'±' if low < 0.0 else ''}{limit:.5g} {system.unit('rad/s')}"
    range_text = {np.inf: "at any speed"}.get(limit, "at none" if np.isnan(limit) else f"up to {signed}")
    text = f"limit, {signals.number(below)} {units}: kept {range_text}"
    ax.axhline(below, color=VERMILION, linewidth=1.0, label=text)
    for place in (limit, -limit):
        if low <= place <= high:
            ax.plot([place], [below], "o", color=VERMILION, markersize=5.0, label="_limit")
            label(ax, place, below, (_speed_text(place, system).replace("-", "−"), VERMILION))


def _speed_text(speed: float, system: UnitSystem) -> str:
    text = f"{speed:.5g} {system.unit('rad/s')}"
    return f"{text} = {speed * 30.0 / np.pi:.5g} rpm" if text.endswith("rad/s") else text
