"""The car in the loop on one page: the track with the force that it bears, and that force over the position."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.files.netcdf import scene_of
from linksweep.plot.kit import signals
from linksweep.plot.kit.style import BLACK, BLUE, GREY, SHADE, VERMILION, grid, small_type
from linksweep.results.peaks import peaks

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INDEX = "theta"
BAND = 0.55  # of the radius: the largest force on the drawing
ARROWS = 36  # round the whole track
PAGE = (7.1, 3.5)  # inches: half the height of an A4 page's picture


def loop(ds: xr.Dataset) -> Figure:
    """Plot a loop: the track with its force on the car drawn outside it, and that force [N] over the position [degree].

    Parameters
    ----------
    ds : Dataset
        From `linksweep.sweep` of a LoopTrack, with normal_force, of one design.

    Returns
    -------
    matplotlib Figure
        7.1 inches wide. Where the car is not on the track there is no force; the angles are shaded, with the reason.

    Raises
    ------
    ValueError
        For a Dataset of another mechanism, without normal_force, and of more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> figure = ls.sweep(ls.example("loop")).linksweep.loop()
    >>> [ax.get_ylabel() for ax in figure.axes]
    ['y [m]', 'force of the track $F_N$ [N]']
    """
    import matplotlib.pyplot as plt

    if INDEX not in ds.dims or "normal_force" not in ds:
        raise ValueError("the Dataset has no normal_force over theta: give what ls.sweep returns for a LoopTrack")
    ds = ds.rename({INDEX: signals.INDEX})
    signals.require_one_design([ds["normal_force"]])
    with small_type():
        figure, (track, force) = plt.subplots(1, 2, figsize=PAGE, layout="constrained", width_ratios=(1.0, 1.15))
        outer = draw_track(track, ds)
        _arrows(track, _rows(ds)[0], outer, _radius(ds))
        draw_car(track, _radius(ds))
        draw_force(force, ds)
    return figure


def _rows(ds: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Positions in order, and the force there; without gravity it is the same everywhere."""
    angles = ds[signals.INDEX].values
    order = np.argsort(angles)
    return angles[order], np.broadcast_to(ds["normal_force"].values, angles.shape)[order]


def draw_force(ax: Axes, ds: xr.Dataset) -> None:
    """The force over the position, its extremes marked."""
    from matplotlib.ticker import MultipleLocator

    from linksweep.plot.kit.labels import label

    angles, force = _rows(ds)
    grid(ax)
    ax.axhline(0.0, color=GREY, linewidth=0.8, zorder=2.0)
    ax.plot(angles, force, color=BLUE, label="_normal_force")
    for gap in signals.gaps(ds, ds["normal_force"]):
        ax.axvspan(gap.start, gap.stop, facecolor=SHADE, linewidth=0.0, zorder=0.4)
        upright = "horizontal" if gap.stop - gap.start > 90.0 else "vertical"
        middle, across = 0.5 * (gap.start + gap.stop), ax.get_xaxis_transform()
        ax.text(middle, 0.5, gap.reason, transform=across, ha="center", va="center", color=GREY, rotation=upright)
    if np.ptp(angles) >= 180.0:
        ax.xaxis.set_major_locator(MultipleLocator(90.0))
        ax.xaxis.set_minor_locator(MultipleLocator(30.0))
        ax.set_xlim(angles[0], max(360.0, angles[-1]))
    for said, (angle, value) in _extremes(ds, angles, force).items():
        ax.plot([angle], [value], "o", color=BLUE, markersize=4.5, clip_on=False, label=f"_{said}")
        label(ax, angle, value, (f"{said} {signals.number(value)} N at {signals.angle_text(angle)}", BLUE))
    ax.margins(y=0.18)
    ax.set_xlabel("position $\\theta$ [°]")
    ax.set_ylabel("force of the track $F_N$ [N]")


def _extremes(ds: xr.Dataset, angles: np.ndarray, force: np.ndarray) -> dict[str, tuple[float, float]]:
    """Return position and force of the extremes: exact for a whole lap, else of the samples; none of an even force."""
    if not np.nanmin(force, initial=np.inf) < np.nanmax(force, initial=-np.inf):
        return {}
    exact = _exact_extremes(ds) if signals.full_turn(angles) else None
    samples = {"max": int(np.nanargmax(force)), "min": int(np.nanargmin(force))}
    return exact or {said: (angles[k], force[k]) for said, k in samples.items()}


def _exact_extremes(ds: xr.Dataset) -> dict[str, tuple[float, float]] | None:
    """Return the extremes of the scene that a Dataset holds; None where it holds none, or more than one design."""
    try:
        found = peaks(scene_of(ds), of=["normal_force"])
        words = {said: f"normal_force_{said}" for said in ("max", "min")}
        return {said: (found[f"{name}_at"].item(), found[name].item()) for said, name in words.items()}
    except ValueError:
        return None


def draw_track(ax: Axes, ds: xr.Dataset) -> np.ndarray:
    """The track, and outside it the force as far away as it is large: these distances from the centre come back [m]."""
    radius = _radius(ds)
    angles, force = _rows(ds)
    largest = float(np.max(force, initial=0.0, where=np.isfinite(force))) or 1.0
    outer = radius * (1.0 + BAND * force / largest)
    everywhere = np.linspace(0.0, 360.0, 361)
    grid(ax)
    ax.plot(*place(radius, everywhere), color=GREY, linewidth=1.0, linestyle="--", zorder=2.0, label="_loop")
    ax.plot(*place(np.where(np.isfinite(force), radius, np.nan), angles), color=BLACK, linewidth=2.0, label="_driven")
    ax.plot(*place(outer, angles), color=BLUE, linewidth=1.0, label="_force")
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    return outer


def _radius(ds: xr.Dataset) -> float:
    machine: Any = scene_of(ds.rename({signals.INDEX: INDEX})).mechanism
    return float(machine.radius)


def place(radius: float | np.ndarray, degrees: np.ndarray) -> np.ndarray:
    """Points at a distance from the loop's centre, at positions from the bottom."""
    angle = np.radians(degrees)
    return np.array([radius * np.sin(angle), -radius * np.cos(angle)])


def _arrows(ax: Axes, angles: np.ndarray, outer: np.ndarray, radius: float) -> None:
    """Arrows onto the track at round positions."""
    for position in np.arange(ARROWS) * (360.0 / ARROWS):
        k = int(np.argmin(np.abs(angles - position)))
        if abs(angles[k] - position) < 180.0 / ARROWS:
            press(ax, angles[k], outer[k], radius, linewidth=0.8, mutation_scale=7.0)


def press(ax: Axes, angle: float, outer: float, radius: float, **style: Any) -> None:
    """An arrow of the force from outside onto the track; a very short one would be all head."""
    if outer > 1.06 * radius:
        start, end = place(np.array([outer, radius]), np.array([angle, angle])).T
        style = {"arrowstyle": "-|>", "color": BLUE, "shrinkA": 0.0, "shrinkB": 0.0} | style
        ax.annotate("", tuple(end), tuple(start), arrowprops=style)


def draw_car(ax: Axes, radius: float, angle: float = 0.0) -> None:
    """The car at a position from the bottom [degree], where it enters, and which way it goes."""
    half, height = 0.09 * radius, 0.08 * radius
    x = np.array([-half, half, half, -half])
    y = -radius + height * np.array([0.3, 0.3, 1.3, 1.3])
    (c, s) = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([(c, -s), (s, c)])
    ax.fill(*(turn @ [x, y]), facecolor=VERMILION, edgecolor=BLACK, linewidth=0.6, zorder=2.5)
    start, end = (turn @ np.array([(half, half + 0.22 * radius), (-radius + 0.8 * height,) * 2])).T
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": VERMILION, "shrinkA": 0.0, "shrinkB": 0.0})
