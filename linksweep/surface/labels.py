"""Labels that find their own place when the figure is drawn: near their point, off the curves, and off each other.

They look at what is really on the paper: the size of the figure, of the font and of the axes at that moment. So they
stay right when the figure is resized, or laid out anew because another panel came.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.offsetbox import AnnotationBbox, TextArea, VPacker
from matplotlib.patheffects import withStroke

CURVES = 2.0  # zorder from which lines are curves, to be kept clear; grids and reference lines lie below
CELL = 3.0  # pixels to which points of curves are rounded before they are counted
DISTANCES = (6.0, 12.0, 20.0, 30.0, 42.0, 58.0, 78.0, 105.0, 140.0)  # points from the labelled point to the label's box
SPACE = 3.0  # points kept free around a label
LEADER = 10.0  # points from which on a thin line leads back
Line = tuple[str, str]  # text and colour
DIRECTIONS = np.radians(np.arange(0.0, 360.0, 15.0))


class Box(NamedTuple):
    """A rectangle on the paper [pixel]."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def area(self) -> float:
        return (self.right - self.left) * (self.top - self.bottom)

    def count(self, points: np.ndarray) -> int:
        inside = (points >= (self.left, self.bottom)) & (points <= (self.right, self.top))
        return int(inside.all(axis=1).sum())

    def overlap(self, other: Box) -> float:
        """Shared area, as a fraction of the smaller box."""
        width = min(self.right, other.right) - max(self.left, other.left)
        height = min(self.top, other.top) - max(self.bottom, other.bottom)
        smaller = min(self.area, other.area)
        return max(width, 0.0) * max(height, 0.0) / smaller if smaller else 0.0


def label(axes: Axes, x: float, y: float, *lines: Line, **style: Any) -> AnnotationBbox:
    """Write lines of text, each with its colour, near the point (x, y) of the data, where there is room when drawn."""
    halo = withStroke(linewidth=2.0, alpha=0.7, foreground=axes.get_facecolor())
    style = {"fontsize": "small", "path_effects": [halo]} | style
    texts: list[Artist] = [TextArea(text, textprops=style | {"color": color}) for text, color in lines]
    leader = {"arrowstyle": "-", "color": lines[0][1], "linewidth": 0.6, "shrinkA": 0.0, "shrinkB": 2.0}
    note = AnnotationBbox(
        VPacker(children=texts, pad=0.0, sep=1.5),
        (x, y),
        (0.0, 0.0),
        boxcoords="offset points",
        arrowprops=leader,
        frameon=False,
        pad=0.0,
        annotation_clip=False,
    )
    note.set_in_layout(False)
    axes.add_artist(note)
    _placer(axes).notes.append(note)
    return note


def labels_of(axes: Axes) -> list[AnnotationBbox]:
    """The labels written so far."""
    return _placer(axes).notes


def text_of(note: AnnotationBbox) -> str:
    return "\n".join(line.get_text() for line in note.offsetbox.get_children() if isinstance(line, TextArea))


def _placer(axes: Axes) -> Placer:
    placer = next((artist for artist in axes.artists if isinstance(artist, Placer)), None)
    if placer is None:
        placer = Placer()
        axes.add_artist(placer)
    return placer


def arrow(axes: Axes, start: np.ndarray, end: np.ndarray, color: str) -> None:
    """Draw an arrow in the data's coordinates; its shaft counts as a curve."""
    shaft = np.array([start, end])
    axes.plot(*shaft.T, color=color, linewidth=1.6, zorder=CURVES + 0.4, solid_capstyle="butt")
    head = {"arrowstyle": "-|>", "color": color, "shrinkA": 0.0, "shrinkB": 0.0, "mutation_scale": 11.0}
    note = axes.annotate("", tuple(end), tuple(start), arrowprops=head | {"linewidth": 0.0}, annotation_clip=False)
    note.set_in_layout(False)


class Placer(Artist):
    """Puts the labels of its axes into place just before they are drawn."""

    def __init__(self) -> None:
        super().__init__()
        self.notes: list[AnnotationBbox] = []
        self.set_zorder(CURVES + 0.5)  # labels are drawn after this, at 3
        self.set_in_layout(False)

    def draw(self, renderer: Any) -> None:
        notes = [note for note in self.notes if note.axes is self.axes and note.get_visible()]
        axes: Any = self.axes
        curves, taken = _curves(axes), list(_boxes(axes, renderer))
        frame = Box(*axes.get_window_extent(renderer).extents)
        anchors = axes.transData.transform(np.reshape([note.xy for note in notes], (-1, 2)))
        curves = np.concatenate([curves, anchors])
        for note, anchor in zip(notes, anchors, strict=True):
            box, leader = _place(note, anchor, curves, taken, frame, renderer)
            taken.append(box)
            curves = np.concatenate([curves, leader])


def _curves(axes: Axes) -> np.ndarray:
    """Points of all that is drawn of curves and markers, so close together that no box slips between them [pixel]."""
    found = [np.empty((0, 2))]
    for line in axes.lines:
        if line.get_visible() and line.get_zorder() >= CURVES:
            found += _drawn(line)
    points = np.concatenate(found)
    return np.unique(np.rint(points[np.isfinite(points).all(axis=1)] / CELL), axis=0) * CELL


def _drawn(line: Line2D) -> Iterator[np.ndarray]:
    points = line.get_transform().transform(line.get_xydata())
    figure: Any = line.figure
    pixels = figure.dpi / 72.0
    if line.get_linestyle() != "None":
        yield _broad(_dense(points), 0.5 * line.get_linewidth() * pixels)
    if line.get_marker() not in ("", " ", "None", None):
        yield _broad(points, 0.5 * line.get_markersize() * pixels)


def _dense(points: np.ndarray) -> np.ndarray:
    """The points of a line with 2000 or more in all, evenly between each two; NaN where the line has a gap."""
    steps = max(1, 2000 // max(len(points), 1))
    between = np.linspace(0.0, 1.0, steps, endpoint=False)[:, None, None]
    filled = points[:-1] + (points[1:] - points[:-1]) * between
    return np.concatenate([filled.reshape(-1, 2), points])


def _broad(points: np.ndarray, radius: float) -> np.ndarray:
    """The points with those of a square around each."""
    if radius < CELL:
        return points
    ticks = np.linspace(-radius, radius, 2 + int(radius / CELL))
    square = np.array([(x, y) for x in ticks for y in ticks])
    return (points[:, None] + square).reshape(-1, 2)


def _boxes(axes: Axes, renderer: Any) -> Iterator[Box]:
    """What else is written in the axes."""
    others: list[Any] = [text for text in axes.texts if text.get_text()]
    if axes.get_legend() is not None:
        others.append(axes.get_legend())
    for other in others:
        yield Box(*other.get_window_extent(renderer).extents)


def _place(
    note: AnnotationBbox, anchor: np.ndarray, curves: np.ndarray, taken: list[Box], frame: Box, renderer: Any
) -> tuple[Box, np.ndarray]:
    """Move a label to its cheapest place; its box and the points of its leader come back."""
    point = renderer.points_to_pixels(1.0)
    size = np.array(note.offsetbox.get_bbox(renderer).size) + SPACE * point
    best: Any = (np.inf,)
    for distance in DISTANCES:
        if distance >= best[0]:  # all that is farther costs more
            break
        for direction in DIRECTIONS:
            unit = np.array([np.cos(direction), np.sin(direction)])
            centre = anchor + unit * (distance * point) + np.sign(np.round(unit, 9)) * size / 2.0
            box = Box(*(centre - size / 2.0), *(centre + size / 2.0))
            leader = anchor + (centre - anchor) * np.linspace(0.0, 1.0, 20)[:, None]
            cost = distance + _cost(box, leader, curves, taken, frame)
            if cost < best[0]:
                best = (cost, distance, centre, box, leader)
    _, distance, centre, box, leader = best
    note.xybox = tuple((centre - anchor) / point)
    if note.arrow_patch is not None:
        note.arrow_patch.set_visible(distance >= LEADER)
    return box, leader


def _cost(box: Box, leader: np.ndarray, curves: np.ndarray, taken: list[Box], frame: Box) -> float:
    """How bad a place is: on another text or outside the axes worst, then on a curve."""
    on_texts = sum(float(box.overlap(other) > 0.0) + box.overlap(other) + 0.05 * other.count(leader) for other in taken)
    outside = 1.0 - box.overlap(frame)
    return 500.0 * (on_texts + outside) + 12.0 * box.count(curves)
