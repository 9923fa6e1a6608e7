"""Draw a car on a circular track: the track with the force that it bears, and that force over the position."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.files.netcdf import scene_of
from linksweep.plot.curves import shade_gaps
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import BLACK, BLUE, GREY, VERMILION
from linksweep.plot.kit.style import grid, panels, show_lengths
from linksweep.results.compute import angles_missing, require_results
from linksweep.results.origin.in_shown_units import in_shown_units, results_in_shown_units
from linksweep.results.origin.machine_of_results import machine_of_results
from linksweep.results.peaks import peaks
from linksweep.scene.designs.choose import design_labels
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import shown_units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BAND = 0.55  # of the radius: the largest force on the drawing
ARROWS = 36  # round the whole track
PAGE = (7.1, 3.5)  # inches: half the height of an A4 page's picture


def loop(ds: xr.Dataset) -> Figure:
    """Plot a car on its track with the force of the track on it, and that force over the position.

    Parameters
    ----------
    ds : Dataset
        Cycle of one design from `linksweep.sweep`, of a machine that is a car on a track, with the track's force.

    Returns
    -------
    matplotlib Figure
        7.1 inches wide: on the left the force [N] as arrows onto the track, on the right over the position [degree].
        Where the car is not on the track there is no force; the positions are shaded, with the reason.

    Raises
    ------
    ValueError
        For a Dataset of another machine, without the force, or of more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> figure = ls.sweep(ls.example("loop")).linksweep.loop()
    >>> [ax.get_ylabel() for ax in figure.axes]
    ['y [m]', 'force of the track $F_N$ [N]']
    """
    require_results(ds, "ls.sweep")
    machine = machine_of_results(ds)
    track = machine.track if machine else None
    if machine is None or track is None or machine.index not in ds.dims or track.force not in ds:
        raise ValueError("ds has no force of a track over the position: take what ls.sweep returns for a car in a loop")
    scene, ds = scene_of(ds), results_in_shown_units(ds).rename({machine.index: signals.INDEX})
    signals.require_one_design([ds[track.force]])
    radius = float(getattr(scene.mechanism, track.radius))
    with panels(1, 2, figsize=PAGE, width_ratios=(1.0, 1.15)) as (figure, (left, right)):
        outer = draw_track(left, ds, track.force, radius)
        show_lengths(left, shown_units(scene.units))
        _arrows(left, signals.by_angle(ds, ds[track.force])[0], outer, radius)
        draw_car(left, radius)
        draw_force(right, ds, scene)
    return figure


def draw_force(ax: Axes, ds: xr.Dataset, scene: Scene) -> None:
    """Draw the force over the position, its extremes marked, of a cycle in the units in which it is shown."""
    from matplotlib.ticker import MultipleLocator

    from linksweep.plot.kit.labels import label

    name = scene.mechanism.track.force  # type: ignore[union-attr]
    angles, force = signals.by_angle(ds, ds[name])
    unit = signals.unit(ds[name], "N")
    grid(ax)
    ax.axhline(0.0, color=GREY, linewidth=0.8, zorder=2.0)
    ax.plot(angles, force, color=BLUE, label=f"_{name}")
    shade_gaps(ax, ds, ds[name])
    if np.ptp(angles) >= 180.0:
        ax.xaxis.set_major_locator(MultipleLocator(90.0))
        ax.xaxis.set_minor_locator(MultipleLocator(30.0))
        ax.set_xlim(angles[0], max(360.0, angles[-1]))
    for end, (angle, value) in _extremes(scene, name, angles, force).items():
        ax.plot([angle], [value], "o", color=BLUE, markersize=4.5, clip_on=False, label=f"_{end}")
        label(ax, angle, value, (f"{end} {signals.number(value)} {unit} at {signals.angle_text(angle)}", BLUE))
    ax.margins(y=0.18)
    ax.set(xlabel="position $\\theta$ [°]", ylabel=f"force of the track $F_N$ [{unit}]")


def _extremes(scene: Scene, name: str, angles: np.ndarray, force: np.ndarray) -> dict[str, tuple[float, float]]:
    """Return position and force of the extremes, exact ones of a scene of one design; none of an even force."""
    if not np.nanmin(force, initial=np.inf) < np.nanmax(force, initial=-np.inf):
        return {}
    if not design_labels(scene) and not angles_missing(scene):
        part = None if signals.full_turn(angles) else (float(angles[0]), float(angles[-1]))
        worst = peaks(scene, of=[name], between=part)
        worst = in_shown_units(worst)
        places = {end: angles[0] + (worst[f"{name}_{end}_at"].item() - angles[0]) % 360.0 for end in ("max", "min")}
        return {end: (float(at), worst[f"{name}_{end}"].item()) for end, at in places.items()}
    samples = {"max": int(np.nanargmax(force)), "min": int(np.nanargmin(force))}
    return {end: (angles[k], force[k]) for end, k in samples.items()}


def draw_track(ax: Axes, cycle: xr.Dataset, name: str, radius: float) -> np.ndarray:
    """Draw a track and the force of this name, outside the track at a distance that grows with the force.

    Returns these distances from the centre [m], by position.
    """
    angles, forces = signals.by_angle(cycle, cycle[name])
    largest = float(np.max(forces, initial=0.0, where=np.isfinite(forces))) or 1.0
    outer = radius * (1.0 + BAND * forces / largest)
    everywhere = np.linspace(0.0, 360.0, 361)
    grid(ax)
    ax.plot(*place(radius, everywhere), color=GREY, linewidth=1.0, linestyle="--", zorder=2.0, label="_loop")
    ax.plot(*place(np.where(np.isfinite(forces), radius, np.nan), angles), color=BLACK, linewidth=2.0, label="_driven")
    ax.plot(*place(outer, angles), color=BLUE, linewidth=1.0, label="_force")
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    return outer


def place(radius: float | np.ndarray, degrees: np.ndarray) -> np.ndarray:
    """Return the points (x, y) at distances from the track's centre [m] and positions from the bottom [degree]."""
    angle = np.radians(degrees)
    return np.array([radius * np.sin(angle), -radius * np.cos(angle)])


def _arrows(ax: Axes, angles: np.ndarray, outer: np.ndarray, radius: float) -> None:
    """Draw arrows of the force onto the track at round positions."""
    for position in np.arange(ARROWS) * (360.0 / ARROWS):
        k = int(np.argmin(np.abs(angles - position)))
        if abs(angles[k] - position) < 180.0 / ARROWS:
            press(ax, angles[k], outer[k], radius, linewidth=0.8, mutation_scale=7.0)


def press(ax: Axes, angle: float, outer: float, radius: float, **style: Any) -> None:
    """Draw an arrow of the force from outside onto the track, unless it is so short that it would be all head."""
    if outer > 1.06 * radius:
        start, end = place(np.array([outer, radius]), np.array([angle, angle])).T
        style = {"arrowstyle": "-|>", "color": BLUE, "shrinkA": 0.0, "shrinkB": 0.0} | style
        ax.annotate("", tuple(end), tuple(start), arrowprops=style)


def draw_car(ax: Axes, radius: float, angle: float = 0.0) -> None:
    """Draw the car at a position from the bottom [degree], with an arrow in its direction."""
    half, height = 0.09 * radius, 0.08 * radius
    x = np.array([-half, half, half, -half])
    y = -radius + height * np.array([0.3, 0.3, 1.3, 1.3])
    (c, s) = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([(c, -s), (s, c)])
    ax.fill(*(turn @ [x, y]), facecolor=VERMILION, edgecolor=BLACK, linewidth=0.6, zorder=2.5)
    start, end = (turn @ np.array([(half, half + 0.22 * radius), (-radius + 0.8 * height,) * 2])).T
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": VERMILION, "shrinkA": 0.0, "shrinkB": 0.0})
