"""Locus of a force: the curve that the tip of its arrow draws over a revolution, with dots at round crank angles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import BLUE, GREY, VERMILION
from linksweep.plot.kit.style import grid, round_step
from linksweep.tables.cells import fixed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIZE = (5.6, 5.2)  # inches
LABELS, LABELLED = 8, 90.0  # dots with an angle, at most, and degrees between them, at least
DOTS = 3  # from one angle to the next
BEYOND = 1.1  # of the largest force on the scale: larger forces are off it


def draw_locus(
    ax: Axes,
    name: str,
    angles: np.ndarray,
    x: np.ndarray,
    y: np.ndarray,
    units: str,
    last: float | None = None,
    size: np.ndarray | None = None,
    nothing: str = "no result",
) -> None:
    """Draw the locus of a force, dots on it up to the last angle, and an arrow from the origin to the largest force.

    A `size` that is infinite where x and y are large beside a toggle says that the force has no bound there; `nothing`
    is why there is no force at any angle.
    """
    size = np.hypot(x, y) if size is None else size
    largest = signals.peak(angles, size)
    usual = signals.scale([(angles, size)], [largest])
    draw_cross(ax)
    ax.plot(x, y, color=BLUE, label=f"_locus {name}")
    tip = np.zeros(2)
    if largest is None:
        look = {"facecolor": "white", "linewidth": 0.0, "pad": 2.0}
        ax.text(0.5, 0.5, nothing, transform=ax.transAxes, ha="center", va="center", color=GREY, bbox=look)
    if largest and largest.value > 0.0:
        k = int(np.nanargmax(size))
        force = np.array([x[k], y[k]])
        force = force if np.isfinite(force).all() else signals.tip(x, y)
        tip = _arrow(ax, name, largest, force, units, usual)
    _ticks(ax, angles, x, y, usual, angles[-1] if last is None else last)
    near = size <= BEYOND * usual
    set_limits(ax, np.append(x[near], tip[0]), np.append(y[near], tip[1]))


def draw_cross(ax: Axes) -> None:
    """Set equal scales, and draw a cross through the origin."""
    from matplotlib.ticker import MaxNLocator

    ax.set_aspect("equal", adjustable="datalim")
    ax.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))  # room for numbers of five digits
    grid(ax)
    ax.axhline(0.0, color=GREY, linewidth=0.8, zorder=2.0)
    ax.axvline(0.0, color=GREY, linewidth=0.8, zorder=2.0)
    ax.plot([0.0], [0.0], "+", color="black", markersize=11.0, markeredgewidth=1.6, zorder=2.6, label="_origin")


def set_limits(ax: Axes, x: np.ndarray, y: np.ndarray) -> None:
    """Set limits around these points and the origin, which equal scales may still widen."""
    for values, set_range in ((x, ax.set_xlim), (y, ax.set_ylim)):
        low, high = np.min(values, initial=0.0), np.max(values, initial=0.0)
        room = 0.16 * ((high - low) or 1.0)
        set_range(low - room, high + room, auto=True)


def _ticks(ax: Axes, angles: np.ndarray, x: np.ndarray, y: np.ndarray, usual: float, last: float) -> None:
    """Draw dots on the locus at round crank angles up to the last, some with the angle beside them."""
    from linksweep.plot.kit.labels import label

    labelled = round_step(last - angles[0], LABELS, LABELLED)
    tick = labelled / DOTS
    at = np.arange(np.ceil(angles[0] / tick) * tick, last + 1e-9, tick)
    closed = (x[0], y[0]) == (x[-1], y[-1])
    at = at[:-1] if len(at) > 1 and closed and (at[0], at[-1]) == (angles[0], angles[-1]) else at
    points = np.array([np.interp(at, angles, x), np.interp(at, angles, y)])
    there = np.isfinite(points).all(axis=0) & (np.hypot(*points) <= BEYOND * usual)
    at, points = at[there], points[:, there]
    ax.plot(*points, "o", color=BLUE, markersize=3.6, label="_ticks")
    named = at % labelled == 0.0
    if named.sum() < 3:
        named[:] = True
    for k, (angle, point) in enumerate(zip(at[named], points.T[named], strict=True)):
        label(ax, *point, (("$\\theta_2$ = " if k == 0 else "") + signals.angle_text(angle), BLUE))


def _arrow(ax: Axes, name: str, largest: signals.Peak, force: np.ndarray, units: str, usual: float) -> np.ndarray:
    """Draw an arrow from the origin to the largest force, with value and angles; return its end."""
    from linksweep.plot.kit.labels import arrow, label

    beyond = largest.value > BEYOND * usual
    tip = force * (BEYOND * usual / np.hypot(*force)) if beyond else force
    direction = float(np.degrees(np.arctan2(force[1], force[0])))
    lines = (
        f"{signals.force_symbol(name)} = {signals.number(largest.value)} {units}",
        f"{'off scale ' * beyond}at $\\theta_2$ = {signals.angle_text(largest.angle)}",
        f"direction {fixed(direction, 1)}°".replace("-", "−"),
    )
    arrow(ax, np.zeros(2), tip, VERMILION)
    ax.plot(*tip, "o", color=VERMILION, markersize=4.5, zorder=2.7, label=f"_peak {name}")
    label(ax, *tip, *((line, VERMILION) for line in lines))
    return tip
