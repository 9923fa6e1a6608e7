"""Parts of drawn loads: arrows of forces and torques, gas on a piston, springs and dampers, in the data's
coordinates."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from linksweep.plot.kit import machine_parts
from linksweep.plot.kit.colors import LOAD
from linksweep.plot.kit.load_symbols import LoadSymbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LINE: dict[str, Any] = {"color": LOAD, "linewidth": 1.2, "solid_capstyle": "butt", "solid_joinstyle": "round"}
ABOVE = 2.46  # zorder: over pins
COILS = 6
POINTS = 60  # of an arc
SIGN = 27.0  # points: size of what turns about a pin
HEAD, RIM = 15.0, 3.0  # points: size of an arrowhead; how far it ends from its point, at which there may be a pin
TURN = np.radians([-60.0, 210.0])  # ends of the arc of a torque, counter-clockwise


def draw_loads(
    ax: Axes, loads: Iterable[LoadSymbol], links: Mapping[int, np.ndarray], half: float, scale: float
) -> list[tuple[LoadSymbol, np.ndarray]]:
    """Draw loads at one angle; return those that do something there, each with the place of its name.

    `links` has the ends of each drawn link, to which points beside it are tied; `half` is half a side of the machine's
    blocks [m], which the symbols follow; `scale` is the length of a unit of force [m/N].
    """
    drawn = [(load, place) for load in loads if (place := _draw(ax, load, half, scale)) is not None]
    for load, _ in drawn:
        for number, place in zip(load.links, (load.place, load.end), strict=False):
            if number in links and place is not None:
                machine_parts.stay(ax, place, links[number])
    return drawn


def _draw(ax: Axes, load: LoadSymbol, half: float, scale: float) -> np.ndarray | None:
    """Draw a load; return the place of its name, or None where it does nothing."""
    if load.force is not None:
        return _force(ax, load, half, scale)
    if load.torque is not None:
        return _torque(ax, load)
    if load.end is not None:
        draw = _damper if load.kind == "damper" else _spring
        draw(ax, load.place, load.end, half)
        _acts(ax, np.array([load.place, load.end]))
        standing = [at for number, at in zip(load.links, (load.place, load.end), strict=True) if number == 1]
        machine_parts.supports(ax, np.reshape(standing, (-1, 2)), 16.0)
        return 0.5 * (load.place + load.end)
    return _turning(ax, load)


def tail(load: LoadSymbol, half: float, scale: float) -> np.ndarray:
    """Return start and end of the arrow of a force, whose tip is at its place, of gas at the face of its piston."""
    force: Any = load.force
    tip = load.place - half / np.hypot(*force) * force if load.kind == "gas" else load.place
    return np.array([tip - scale * force, tip])


def _force(ax: Axes, load: LoadSymbol, half: float, scale: float) -> np.ndarray | None:
    """Draw the arrow of a force; the gas of a cylinder as three, side by side."""
    from linksweep.plot.kit.labels import arrow

    if not load.acts:
        return None
    start, end = tail(load, half, scale)
    length = float(np.hypot(*(end - start)))
    if load.kind == "gas":
        across = 0.6 * half / length * np.array([start[1] - end[1], end[0] - start[0]])
        ax.plot(*np.array([start - across, start + across]).T, zorder=ABOVE, label="_gas", **LINE)
        for side in (-across, across):
            arrow(ax, start + side, end + side, LOAD, HEAD)
    else:
        _acts(ax, end[None])
    arrow(ax, start, end, LOAD, HEAD, 0.0 if load.kind == "gas" else RIM)
    return start


def _torque(ax: Axes, load: LoadSymbol) -> np.ndarray | None:
    """Draw an arc with an arrowhead in the sense of a torque."""
    torque: Any = load.torque
    if not abs(float(torque)) > 0.0:
        return None
    arc, tip = _arc(1.0, *TURN), TURN[1]
    band = np.concatenate([1.05 * arc, 0.95 * arc[::-1]])
    radial, ahead = np.array([np.cos(tip), np.sin(tip)]), np.array([-np.sin(tip), np.cos(tip)])
    head = np.array([1.3 * radial, radial + 0.7 * ahead, 0.7 * radial])
    mirror = np.array([1.0 if torque > 0.0 else -1.0, 1.0])
    _sign(ax, load, [mirror * band, mirror * head], markerfacecolor=LOAD, markeredgewidth=0.0)
    return load.place


def _sign(ax: Axes, load: LoadSymbol, lines: list[np.ndarray], **look: Any) -> None:
    """Draw lines about the place of a load, as large as pins are: the same in machines of any size."""
    from matplotlib.path import Path

    lines = [np.append(line, line[:1], axis=0) if look["markeredgewidth"] == 0.0 else line for line in lines]
    path = Path.make_compound_path(*map(Path, lines))
    ax.plot(*load.place, linestyle="none", marker=path, markersize=SIGN, zorder=ABOVE, label=f"_{load.kind}", **look)


def _arc(radius: float, first: float, last: float) -> np.ndarray:
    """Return points of an arc between two angles [rad]."""
    around = np.linspace(first, last, POINTS)
    return radius * np.stack([np.cos(around), np.sin(around)], axis=-1)


def _acts(ax: Axes, at: np.ndarray) -> None:
    ax.plot(*at.T, "o", color=LOAD, markersize=3.0, markeredgewidth=0.0, zorder=2.43, label="_acts")


def _frame(start: np.ndarray, end: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Return the length of a line, its direction, and the direction to its left."""
    length = float(np.hypot(*(end - start)))
    along = (end - start) / (length or 1.0)
    return length, along, np.array([-along[1], along[0]])


def _spring(ax: Axes, start: np.ndarray, end: np.ndarray, half: float) -> None:
    """Draw a spring as a zigzag from end to end."""
    length, along, across = _frame(start, end)
    bends = 0.2 + 0.6 * (np.arange(2 * COILS) + 0.5) / (2 * COILS)
    steps = np.array([0.0, 0.2, *bends, 0.8, 1.0])
    sides = np.array([0.0, 0.0, *np.resize([1.0, -1.0], len(bends)), 0.0, 0.0])
    points = start + length * steps[:, None] * along + min(0.35 * half, 0.2 * length) * sides[:, None] * across
    ax.plot(*points.T, zorder=ABOVE, label="_spring", **LINE)


def _damper(ax: Axes, start: np.ndarray, end: np.ndarray, half: float) -> None:
    """Draw a damper as a pot, open at one end, with a piston in it."""
    length, along, across = _frame(start, end)
    wide, middle = min(0.35 * half, 0.2 * length) * across, 0.5 * (start + end)
    first, last = middle - 0.5 * half * along, middle + 0.5 * half * along
    pot = [last + wide, first + wide, first - wide, last - wide]
    plate = [middle + 0.8 * wide, middle - 0.8 * wide]
    for points in ([start, first], pot, plate, [middle, end]):
        ax.plot(*np.transpose(points), zorder=ABOVE, label="_damper", **LINE)


def _turning(ax: Axes, load: LoadSymbol) -> np.ndarray:
    """Draw a torsion spring as a spiral, a torsion damper as a plate between two arcs."""
    spiral = np.linspace(0.4, 1.0, POINTS)[:, None] * _arc(1.0, 0.0, 4.5 * np.pi)
    rims = [_arc(radius, -0.25 * np.pi, 1.25 * np.pi) for radius in (0.7, 1.0)]
    plate = np.array([(0.0, 0.75), (0.0, 0.95)])
    lines = [spiral] if load.kind == "torsion spring" else [*rims, plate]
    _sign(ax, load, lines, markerfacecolor="none", markeredgecolor=LOAD, markeredgewidth=1.2)
    return load.place
