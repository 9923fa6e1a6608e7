"""A drawing on a page, by matplotlib: a figure with axes, or a page on which lengths are to a scale."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from linksweep.base.validate import refuse
from linksweep.files.atomic import write_from_memory
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import GREY, OTHER_COLORS, SKY
from linksweep.plot.kit.style import grid, show_lengths
from linksweep.plot.machine import mechanism
from linksweep.plot.sheets.skeleton import Curve, Line, Point, skeleton
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import shown_units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INCH = 0.0254  # m
MARGIN = 0.015  # m of paper about the drawing, for names
CORNER = 0.002  # m of paper from the corner to the words
LARGEST = 5.0  # m: side of a page; PDF has no larger ones
SIZE = (7.1, 5.4)  # inches of a figure with axes


def page(scene: Scene, angle: float, curves: Sequence[Curve] | None, machine: bool, scale: float | None) -> Figure:
    """Return the figure of a machine at a crank angle [degree], with curves; `scale` is paper per length, if any."""
    figure = Figure(SIZE, layout="constrained") if scale is None else Figure()
    ax = figure.add_subplot() if scale is None else figure.add_axes((0.0, 0.0, 1.0, 1.0))
    listed = list(curves or [])
    if machine:  # with the first curve
        at: dict[str, Any] = {"link": listed[0].link, "point": listed[0].at} if listed else {}
        mechanism(scene, angle, ax=ax, **at)
    _curves(ax, scene, angle, listed[1:] if machine else listed)
    if not machine:
        grid(ax).set_aspect("equal", adjustable="datalim")
        show_lengths(ax, shown_units(scene.units))
    if scale is not None:
        _to_scale(figure, ax, scale, angle if machine else None)
    return figure


def write_page(figure: Figure, path: Path, kind: str) -> None:
    """Write a figure as "svg" or "pdf", byte for byte equal for equal figures."""
    metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}[kind]
    with rc_context({"svg.hashsalt": "linksweep"}):
        write_from_memory(path, partial(figure.savefig, format=kind, metadata=metadata))


def _curves(ax: Axes, scene: Scene, angle: float, curves: Sequence[Curve]) -> None:
    """Draw the curves of further points."""
    colors = [SKY, *OTHER_COLORS]
    for k, curve in enumerate(curves):
        for part in skeleton(scene, angle, [curve], machine=False):
            color = colors[k % len(colors)]
            if isinstance(part, Line):
                points = np.append(part.points, part.points[:1], axis=0) if part.closed else part.points
                ax.plot(*points.T, color=color, linewidth=1.4, zorder=2.0, label="_curve")
            elif isinstance(part, Point):
                ax.plot(*part.at, "o", color=color, markersize=4.5, zorder=2.45, label="_point")


def _to_scale(figure: Figure, ax: Axes, scale: float, angle: float | None) -> None:
    """Make the page as large as the drawing to this scale, with a margin, and state the scale in it."""
    low, high = ax.dataLim.get_points()
    room = MARGIN / scale
    paper = scale * (high - low) + 2.0 * MARGIN
    too_large = f"scale = {scale:g}: makes a page of {paper.max():.3g} m; must be small enough for one of {LARGEST:g} m"
    refuse([too_large] if paper.max() > LARGEST else [])
    figure.set_size_inches(*(paper / INCH))
    ax.set_axis_off()
    ax.set_title("", loc="left")
    ax.set_aspect("auto")
    ax.set(xlim=(low[0] - room, high[0] + room), ylim=(low[1] - room, high[1] + room))
    ratio = f"{scale:g}:1" if scale >= 1.0 else f"1:{1.0 / scale:g}"
    words = ratio if angle is None else f"$\\theta_2$ = {signals.angle_text(angle)}, {ratio}"
    x, y = CORNER / paper
    figure.text(x, y, words, color=GREY, size=8.0)
