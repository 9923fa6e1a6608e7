"""The mechanism drawn in a position: bars, pins, ground, the crank's circle and the curve of a point of the coupler."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.mechanisms.degrees import cos_sin
from linksweep.mechanisms.four_bar import PINS
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene
from linksweep.surface import signals
from linksweep.surface.palette import BLACK, FORCES, GREY, SHADE, SKY
from linksweep.surface.storage import scene_of

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
    >>> ax = linksweep.surface.plot.mechanism(scene, theta2=30.0, forces=True)  # doctest: +SKIP
    """
    scene = ds_or_scene if isinstance(ds_or_scene, Scene) else scene_of(ds_or_scene)
    names = [*POSITIONS, *(f"{pin}{axis}" for pin in signals.PIN_FORCES * forces for axis in "xy")]
    turn = np.arange(CURVE) * (360.0 / CURVE)
    cycle = sweep(scene, theta2=[*turn, theta2], outputs=names)
    signals.require_one_design(cycle.values())
    _require_assembled(cycle)
    ax = _axes(ax)
    pins, curve, marked = _shape(scene, cycle, point)
    _ground(ax, scene, pins)
    _curve(ax, scene, curve)
    _links(ax, pins, marked)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.16)
    if forces:
        _forces(ax, cycle, pins)
    _names(ax, pins, marked, "P" if point else "$G_3$")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.set_title(f"$\\theta_2$ = {signals.angle_text(float(theta2))}", loc="left")
    return ax


def _require_assembled(cycle: xr.Dataset) -> None:
    """Raise ValueError if the last angle has no result."""
    status, angles = cycle.status.values, cycle[signals.INDEX].values
    if status[-1] == 0:
        return
    reason = cycle.status.attrs["flag_meanings"].split()[status[-1]].replace("_", " ")
    possible = angles[:-1][status[:-1] == 0]
    off = np.abs((possible - angles[-1] + 180.0) % 360.0 - 180.0)
    advice = f"the nearest angle at which it stands is {possible[np.argmin(off)]:.5g}" if possible.size else "nor at any angle"
    raise ValueError(f"theta2 = {angles[-1]:.6g} degree: the mechanism has no position there ({reason}); {advice}")


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


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.subplots(layout="constrained")[1]


def _ground(ax: Axes, scene: Scene, pins: dict[str, np.ndarray]) -> None:
    """The frame's line, a hatched support under each ground pin, and the circle that pin B runs on."""
    from matplotlib.path import Path

    ends = np.array([pins["A"], pins["D"]])
    strokes = [[(x, -1.0), (x - 0.25, -1.3)] for x in np.linspace(-0.7, 0.9, 6)]
    outline = [(0.0, 0.0), (-0.6, -1.0), (0.6, -1.0), (0.0, 0.0)]
    lines = [outline, [(-0.9, -1.0), (0.9, -1.0)], *strokes]
    codes = [Path.MOVETO if k == 0 else Path.LINETO for line in lines for k in range(len(line))]
    support = Path([vertex for line in lines for vertex in line], codes)
    ax.plot(*ends.T, color=GREY, linewidth=0.8, linestyle=(0.0, (8.0, 3.0, 1.0, 3.0)), zorder=1.0)
    style = {"markersize": 30.0, "markerfacecolor": "white", "markeredgecolor": EDGE, "zorder": 2.1}
    ax.plot(*ends.T, linestyle="none", marker=support, label="_ground", **style)
    around = np.radians(np.linspace(0.0, 360.0, 181))
    radius = _one(scene.mechanism.crank.length)
    circle = radius * np.array([np.cos(around), np.sin(around)])
    ax.plot(*circle, color=GREY, alpha=0.55, linewidth=0.8, linestyle="--", zorder=1.1, label="_crank circle")


def _curve(ax: Axes, scene: Scene, curve: np.ndarray) -> None:
    ax.grid(color=SHADE, linewidth=0.6)
    ax.set_axisbelow(True)
    ax.plot(*curve, color=SKY, linewidth=1.4, zorder=2.0, label="_coupler curve")


def _links(ax: Axes, pins: dict[str, np.ndarray], marked: np.ndarray) -> None:
    """Bars from pin to pin with their numbers, the coupler point tied to its link, and the pins on top."""
    plate = np.array([pins["B"], marked, pins["C"]])
    ax.fill(*plate.T, facecolor=BAR, edgecolor=EDGE, linewidth=0.8, alpha=0.6, zorder=2.15)
    for number, (start, end) in {2: "AB", 3: "BC", 4: "DC"}.items():
        bar = np.array([pins[start], pins[end]])
        for width, color in ((9.0, EDGE), (7.2, BAR)):
            ax.plot(*bar.T, color=color, linewidth=width, solid_capstyle="round", zorder=2.2, label=f"_link {number}")
        middle = {"ha": "center", "va": "center", "fontsize": 6.5, "zorder": 2.3, "color": EDGE}
        ax.text(*(bar[0] + 0.4 * (bar[1] - bar[0])), str(number), **middle)
    circles = {"markerfacecolor": "white", "markeredgecolor": EDGE, "markersize": 6.0, "zorder": 2.45}
    ax.plot(*np.array(list(pins.values())).T, "o", label="_pins", **circles)
    ax.plot(*marked, "o", color=SKY, markeredgecolor=EDGE, markersize=4.5, zorder=2.45, label="_point")


def _names(ax: Axes, pins: dict[str, np.ndarray], marked: np.ndarray, point: str) -> None:
    from linksweep.surface.labels import label

    for name, position in pins.items():
        label(ax, *position, name, BLACK, fontweight="bold")
    label(ax, *marked, point, BLACK)


def _forces(ax: Axes, cycle: xr.Dataset, pins: dict[str, np.ndarray]) -> None:
    """An arrow at each pin, to one scale, with its value."""
    from linksweep.surface.labels import arrow, label

    last = cycle.isel({signals.INDEX: -1})
    vectors = {name: np.array([float(part) for part in signals.components(last, name)]) for name in signals.PIN_FORCES}
    sizes = {name: float(np.hypot(*vector)) for name, vector in vectors.items()}
    extent = max(np.ptp(ax.dataLim.intervalx), np.ptp(ax.dataLim.intervaly))
    largest = max(sizes.values())
    for (pin, (i, j)) in PINS.items():
        name = f"F{i}{j}"
        if sizes[name] > 0.0:
            tip = pins[pin] + vectors[name] * (ARROW * extent / largest)
            arrow(ax, pins[pin], tip, FORCES[name])
            units = signals.unit(cycle[f"{name}x"], "N")
            label(ax, *tip, f"{signals.symbol(name)} {signals.number(sizes[name])} {units}", FORCES[name])
