"""The mechanism drawn in a position: bars, pins, ground, the crank's circle and the curve of a point of the coupler."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.mechanisms.degrees import cos_sin
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene
from linksweep.surface import signals
from linksweep.surface.storage import scene_of
from linksweep.surface.style import BLACK, FORCES, GREY, SKY, axes_or_new, grid

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CURVE = 720  # positions along the coupler curve
ARROW = 0.3  # of the drawing's extent: the longest force
POSITIONS = ("Bx", "By", "Cx", "Cy")
BAR, EDGE = "#DCE6EE", "#3F4B55"


def mechanism(
    ds_or_scene: xr.Dataset | Scene,
    theta2: float = 45.0,
    ax: Axes | None = None,
    point: tuple[float, float] | None = None,
    forces: bool = False,
) -> Axes:
    """Draw the mechanism in the position of one crank angle, to scale [m].

    Parameters
    ----------
    ds_or_scene : Dataset or Scene
        A scene of one design, or a Dataset from `linksweep.sweep` that holds it.
    theta2 : float
        Crank angle [degree].
    ax : matplotlib Axes, optional
        Where to draw; by default a new figure.
    point : tuple of float, optional
        The coupler point whose curve is drawn: (distance from pin B [m], angle from the line B→C [degree]); by default
        the coupler's centre of gravity.
    forces : bool
        Whether to draw the pin forces F12 and F32 on the crank, F43 on the coupler and F14 on the rocker, to one scale.

    Returns
    -------
    matplotlib Axes
        With equal scales.

    Raises
    ------
    ValueError
        Where the mechanism cannot be assembled at that angle, and for more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.plot.mechanism(ls.example("press"), theta2=30.0, forces=True).get_xlabel()
    'x [m]'
    """
    scene = ds_or_scene if isinstance(ds_or_scene, Scene) else scene_of(ds_or_scene)
    angle = _angle(theta2)
    cycle = _positions(scene, angle)
    pins, curve, marked = _shape(scene, cycle, point)
    acting = _pin_forces(scene, angle) if forces else {}
    ax = axes_or_new(ax)
    _ground(ax, scene, pins)
    _curve(ax, scene, curve)
    _links(ax, pins, marked)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.2)
    _forces(ax, acting, pins)
    _names(ax, pins, marked, "P" if point else "$G_3$")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.set_title(f"$\\theta_2$ = {signals.angle_text(angle)}", loc="left")
    return ax


def _angle(theta2: Any) -> float:
    try:
        return float(theta2)
    except (TypeError, ValueError):
        raise ValueError(f"theta2 = {theta2!r}: must be one crank angle, in degrees") from None


def _positions(scene: Scene, angle: float) -> xr.Dataset:
    """Positions of the pins over the revolution and, last, at the angle. Raises ValueError where it has none."""
    geometry = replace(scene, omega2=0.0, alpha2=0.0, loads=(), drive="crank")
    turn = np.arange(CURVE) * (360.0 / CURVE)
    cycle = sweep(geometry, theta2=[*turn, angle], outputs=POSITIONS)
    signals.require_one_design(cycle.values())
    status, angles = cycle.status.values, cycle[signals.INDEX].values
    if status[-1]:
        possible = angles[:-1][status[:-1] == 0]
        off = np.abs((possible - angle + 180.0) % 360.0 - 180.0)
        nearest = f"choose another, such as {possible[np.argmin(off)]:.5g}" if possible.size else "nor at any other"
        raise ValueError(f"theta2 = {angle:.6g} degree: the mechanism {_meaning(cycle)} there; {nearest}")
    return cycle


def _meaning(cycle: xr.Dataset) -> str:
    """What the last status says, to follow a subject."""
    word = cycle.status.attrs["flag_meanings"].split()[int(cycle.status.values[-1])]
    said = {"cannot_assemble": "cannot be assembled", "toggle": "is at a toggle", "dead_centre": "is at a dead centre"}
    return said.get(word, word.replace("_", " "))


def _pin_forces(scene: Scene, angle: float) -> dict[str, np.ndarray]:
    """Components (x, y) of each pin force at the angle [N]. Raises ValueError where there are none."""
    found = sweep(scene, theta2=[angle], outputs=[f"{pin}{axis}" for pin in signals.PIN_FORCES for axis in "xy"])
    signals.require_one_design(found.values())
    if found.status.values[-1]:
        raise ValueError(f"theta2 = {angle:.6g} degree: no pin forces there, the mechanism {_meaning(found)}")
    return {
        pin: np.array([part.values.reshape(-1)[0] for part in signals.components(found, pin)])
        for pin in signals.PIN_FORCES
    }


def _shape(scene: Scene, cycle: xr.Dataset, point: Any) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray]:
    """Positions of the pins by letter, the coupler point's curve (2, angles), and where it is now [m]."""
    four_bar = scene.mechanism
    cos, sin = (_one(part) for part in cos_sin(four_bar.ground_angle))
    ground = _one(four_bar.ground)
    B, C = (np.array([cycle[f"{pin}x"].values, cycle[f"{pin}y"].values]) for pin in "BC")
    distance, angle = point or (four_bar.coupler.cg_distance, four_bar.coupler.cg_angle)
    along, across = (_one(distance) * _one(part) for part in cos_sin(angle))
    x, y = (C - B) / _one(four_bar.coupler.length)
    path = B + along * np.array([x, y]) + across * np.array([-y, x])
    D = np.array([ground * cos, ground * sin])
    pins = {"A": np.zeros(2), "B": B[:, -1], "C": C[:, -1], "D": D}
    return pins, np.append(path[:, :-1], path[:, :1], axis=1), path[:, -1]


def _one(number: Any) -> float:
    if isinstance(number, xr.DataArray):
        signals.require_one_design([number])
    return float(number)


def _ground(ax: Axes, scene: Scene, pins: dict[str, np.ndarray]) -> None:
    """The frame's line, a hatched support under each ground pin, and the circle that pin B runs on."""
    from matplotlib.path import Path

    ends = np.array([pins["A"], pins["D"]])
    strokes = [[(x, -1.0), (x - 0.25, -1.3)] for x in np.linspace(-0.7, 0.9, 6)]
    outline = [(0.0, 0.0), (-0.6, -1.0), (0.6, -1.0), (0.0, 0.0)]
    lines = [outline, [(-0.9, -1.0), (0.9, -1.0)], *strokes]
    codes = [Path.MOVETO if k == 0 else Path.LINETO for line in lines for k in range(len(line))]
    support = Path([vertex for line in lines for vertex in line], codes)
    ax.plot(*ends.T, color=GREY, linewidth=0.8, linestyle=(0.0, (8.0, 3.0, 1.0, 3.0)), zorder=2.0)
    style: dict[str, Any] = {"markersize": 30.0, "markerfacecolor": "white", "markeredgecolor": EDGE, "zorder": 2.1}
    ax.plot(*ends.T, linestyle="none", marker=support, label="_ground", **style)
    around = np.radians(np.linspace(0.0, 360.0, 181))
    radius = _one(scene.mechanism.crank.length)
    circle = radius * np.array([np.cos(around), np.sin(around)])
    ax.plot(*circle, color=GREY, alpha=0.55, linewidth=0.8, linestyle="--", zorder=2.0, label="_crank circle")


def _curve(ax: Axes, scene: Scene, curve: np.ndarray) -> None:
    grid(ax)
    ax.plot(*curve, color=SKY, linewidth=1.4, zorder=2.0, label="_coupler curve")


def _links(ax: Axes, pins: dict[str, np.ndarray], marked: np.ndarray) -> None:
    """Bars from pin to pin with their numbers, the coupler point tied to its link, and the pins on top."""
    plate = np.array([pins["B"], marked, pins["C"]])
    ax.fill(*plate.T, facecolor=BAR, edgecolor=EDGE, linewidth=0.8, alpha=0.6, zorder=2.15)
    for number, (start, end) in {2: ("A", "B"), 3: ("B", "C"), 4: ("D", "C")}.items():
        bar = np.array([pins[start], pins[end]])
        for width, color in ((9.0, EDGE), (7.2, BAR)):
            ax.plot(*bar.T, color=color, linewidth=width, solid_capstyle="round", zorder=2.2, label=f"_link {number}")
        middle: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 6.5, "zorder": 2.3, "color": EDGE}
        x, y = bar[0] + 0.4 * (bar[1] - bar[0])
        ax.text(x, y, str(number), **middle)
    circles: dict[str, Any] = {"markerfacecolor": "white", "markeredgecolor": EDGE, "markersize": 6.0, "zorder": 2.45}
    ax.plot(*np.array(list(pins.values())).T, "o", label="_pins", **circles)
    ax.plot(*marked, "o", color=SKY, markeredgecolor=EDGE, markersize=4.5, zorder=2.45, label="_point")


def _names(ax: Axes, pins: dict[str, np.ndarray], marked: np.ndarray, point: str) -> None:
    from linksweep.surface.labels import label

    for name, position in pins.items():
        label(ax, *position, (name, BLACK), fontweight="bold")
    label(ax, *marked, (point, BLACK))


def _forces(ax: Axes, forces: dict[str, np.ndarray], pins: dict[str, np.ndarray]) -> None:
    """An arrow at each pin, to one scale, with its value [N]."""
    from linksweep.surface.labels import arrow, label

    extent = max(np.ptp(ax.dataLim.intervalx), np.ptp(ax.dataLim.intervaly))
    largest = max((float(np.hypot(*vector)) for vector in forces.values()), default=0.0)
    for name, vector in forces.items():
        size = float(np.hypot(*vector))
        if size > 0.0:
            start = pins[signals.PIN_OF[name]]
            tip = start + vector * (ARROW * extent / largest)
            arrow(ax, start, tip, FORCES[name])
            label(ax, *tip, (f"{signals.symbol(name)} {signals.number(size)} N", FORCES[name]))
