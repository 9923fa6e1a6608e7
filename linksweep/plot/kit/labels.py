"""Labels that find a free place when the figure is drawn: near their point, off the curves, and off each other.

Places are computed from the size of the figure, of the font and of the axes at that moment, so that labels stay free
when the figure is resized, or laid out anew for another panel.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.offsetbox import AnnotationBbox, TextArea, VPacker
from matplotlib.path import Path
from matplotlib.patheffects import withStroke

CURVES = 2.0  # zorder from which lines are curves, to be kept clear; grids and reference lines lie below
CELL = 1.5  # points: side of the cells in which curves are counted
SPACE = 3.0  # points kept free around a label
LEADER = 10.0  # points from which on a thin line leads back
PLACES = np.array(  # where a label's box may begin, seen from its point: x, y and distance [points]
    [
        (distance * np.cos(angle), distance * np.sin(angle), distance)
        for distance in (6.0, 12.0, 20.0, 30.0, 42.0, 58.0, 78.0, 105.0, 140.0)
        for angle in np.radians(np.arange(0.0, 360.0, 15.0))
    ]
)
TextLine = tuple[str, str]  # text and colour


def label(axes: Axes, x: float, y: float, *lines: TextLine, **style: Any) -> AnnotationBbox:
    """Write lines of text, each with its colour, near the point (x, y) of the data, where there is room when drawn."""
    halo = withStroke(linewidth=2.0, alpha=0.7, foreground=axes.get_facecolor())
    style = {"fontsize": "small", "path_effects": [halo]} | style
    texts: list[Artist] = [TextArea(text, textprops=style | {"color": color}) for text, color in lines]
    leader = {"arrowstyle": "-", "color": lines[0][1], "linewidth": 0.6, "shrinkA": 0.0, "shrinkB": 2.0}
    box = VPacker(children=texts, pad=0.0, sep=1.5)
    look: dict[str, Any] = {"boxcoords": "offset points", "frameon": False, "pad": 0.0, "annotation_clip": False}
    note = AnnotationBbox(box, (x, y), (0.0, 0.0), arrowprops=leader, **look)
    note.set_in_layout(False)
    axes.add_artist(note)
    _placer(axes).notes.append(note)
    return note


def _placer(axes: Axes) -> Placer:
    placer = next((artist for artist in axes.artists if isinstance(artist, Placer)), None)
    if placer is None:
        placer = Placer()
        axes.add_artist(placer)
    return placer


def arrow(axes: Axes, start: np.ndarray, end: np.ndarray, color: str, head: float = 11.0, gap: float = 0.0) -> None:
    """Draw an arrow in the data's coordinates; its shaft counts as a curve.

    The head has this size [points], and ends this far before the end [points].
    """
    shaft = np.array([start, end])
    axes.plot(*shaft.T, color=color, linewidth=1.6, zorder=CURVES + 0.4, solid_capstyle="butt")
    look = {"arrowstyle": "-|>", "color": color, "shrinkA": 0.0, "shrinkB": gap, "mutation_scale": head}
    note = axes.annotate("", tuple(end), tuple(start), arrowprops=look | {"linewidth": 0.0}, annotation_clip=False)
    note.set_in_layout(False)


class Placer(Artist):
    """An artist that places the labels of its axes just before they are drawn."""

    def __init__(self) -> None:
        super().__init__()
        self.notes: list[AnnotationBbox] = []
        self.set_zorder(CURVES + 0.5)  # labels are drawn after this, at 3
        self.set_in_layout(False)

    def draw(self, renderer: Any) -> None:
        axes: Any = self.axes
        notes = [note for note in self.notes if note.axes is axes and note.get_visible()]
        ink, taken = Ink(axes, renderer), _texts(axes, renderer)
        for line in axes.lines:
            if line.get_visible() and line.get_zorder() >= CURVES:
                ink.add_line(line)
        anchors = axes.transData.transform(np.reshape([note.xy for note in notes], (-1, 2)))
        ink.add(anchors)
        for note, anchor in zip(notes, anchors, strict=True):
            box, leader = _place(note, anchor, ink, taken, renderer)
            taken = np.concatenate([taken, [box]])
            ink.add(leader)


class Ink:
    """The cells of the axes that curves and markers cover.

    Boxes are rows (left, bottom, right, top) [pixel].
    """

    def __init__(self, axes: Axes, renderer: Any) -> None:
        self.frame = np.array(axes.get_window_extent(renderer).extents)
        self.point = renderer.points_to_pixels(1.0)
        self.side = CELL * self.point
        self.cells = np.zeros(1 + np.ceil((self.frame[2:] - self.frame[:2]) / self.side).astype(int), dtype=bool)

    def add_line(self, line: Line2D) -> None:
        """Add the cells that a line and its markers cover."""
        points = line.get_transform().transform(line.get_xydata())
        if line.get_linestyle() != "None":
            self.add(self._broad(_dense(points), 0.5 * line.get_linewidth()))
        marker: Any = line.get_marker()
        if isinstance(marker, Path):
            shape = np.array(marker.vertices)  # its largest coordinate is half its size
            half = 0.5 * line.get_markersize() * self.point / np.abs(shape).max()
            self.add((points[:, None] + half * _dense(shape)).reshape(-1, 2))
        elif marker not in ("", " ", "None", None):
            self.add(self._broad(points, 0.5 * line.get_markersize()))

    def add(self, points: np.ndarray) -> None:
        inside = points[_within(points, self.frame)]  # no NaN
        self.cells[tuple(self._cell(inside).T)] = True

    def count(self, boxes: np.ndarray) -> np.ndarray:
        """Count the covered cells in each box, by a table of sums."""
        sums = np.pad(self.cells.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
        (left, bottom), (right, top) = self._cell(boxes[:, :2]).T, self._cell(boxes[:, 2:]).T + 1
        return sums[right, top] - sums[left, top] - sums[right, bottom] + sums[left, bottom]

    def at(self, points: np.ndarray) -> np.ndarray:
        """Return whether each point lies on a covered cell."""
        cell = self._cell(points)
        return self.cells[cell[..., 0], cell[..., 1]]

    def _broad(self, points: np.ndarray, radius: float) -> np.ndarray:
        """Return the points, and those of a square around each, of this half side [points]."""
        if radius < CELL:
            return points
        ticks = np.linspace(-radius, radius, 2 + int(2.0 * radius / CELL)) * self.point
        square = np.array([(x, y) for x in ticks for y in ticks])
        return (points[:, None] + square).reshape(-1, 2)

    def _cell(self, points: np.ndarray) -> np.ndarray:
        cell = ((points - self.frame[:2]) / self.side).astype(int)
        return np.clip(cell, 0, np.array(self.cells.shape) - 1)


def _dense(points: np.ndarray) -> np.ndarray:
    """Return at least 2000 points of a line, evenly spaced between each two; NaN where the line has a gap."""
    points = np.where(np.isfinite(points), points, np.nan)
    steps = max(1, 2000 // max(len(points), 1))
    between = np.linspace(0.0, 1.0, steps, endpoint=False)[:, None, None]
    filled = points[:-1] + (points[1:] - points[:-1]) * between
    return np.concatenate([filled.reshape(-1, 2), points])


def _texts(axes: Axes, renderer: Any) -> np.ndarray:
    """Return the boxes of the other texts in the axes."""
    texts: list[Any] = [text for text in axes.texts if text.get_text()]
    if axes.get_legend() is not None:
        texts.append(axes.get_legend())
    return np.reshape([other.get_window_extent(renderer).extents for other in texts], (-1, 4))


def _place(
    note: AnnotationBbox, anchor: np.ndarray, ink: Ink, taken: np.ndarray, renderer: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Move a label to its cheapest place; return its box and the points of its leader."""
    point = ink.point
    size = np.array(note.offsetbox.get_bbox(renderer).size) + SPACE * point
    centres = anchor + PLACES[:, :2] * point + np.sign(np.round(PLACES[:, :2], 9)) * size / 2.0
    boxes = np.hstack([centres - size / 2.0, centres + size / 2.0])
    leaders = anchor + (centres - anchor)[:, None] * np.linspace(0.0, 1.0, 20)[:, None]
    best = int(np.argmin(PLACES[:, 2] + _cost(boxes, leaders, ink, taken)))
    note.xybox = tuple((centres[best] - anchor) / point)
    if note.arrow_patch is not None:
        note.arrow_patch.set_visible(PLACES[best, 2] >= LEADER)
    return boxes[best], leaders[best]


def _cost(boxes: np.ndarray, leaders: np.ndarray, ink: Ink, taken: np.ndarray) -> np.ndarray:
    """Return the cost of each place: highest on another text or outside the axes, then on a curve, then across one."""
    on_texts = _overlap(boxes, taken)
    on_texts += on_texts > 0.0
    struck = _within(leaders[:, :, None], taken).sum(axis=(1, 2))
    outside = 1.0 - _overlap(boxes, ink.frame[None])[:, 0]
    outside += outside > 1e-6
    across = ink.at(leaders[:, 6:]).sum(axis=1)  # where a leader begins, there is always a curve
    return 500.0 * on_texts.sum(axis=1) + 4000.0 * outside + 25.0 * struck + 12.0 * ink.count(boxes) + 3.0 * across


def _within(points: np.ndarray, boxes: np.ndarray) -> np.ndarray:
    """Return whether points lie in boxes, side by side."""
    (x, y), (left, bottom, right, top) = np.moveaxis(points, -1, 0), np.moveaxis(boxes, -1, 0)
    return (x >= left) & (x <= right) & (y >= bottom) & (y <= top)


def _overlap(boxes: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Return the area that each box shares with each of the others, as a fraction of the smaller of the two."""
    low = np.maximum(boxes[:, None, :2], others[:, :2])
    high = np.minimum(boxes[:, None, 2:], others[:, 2:])
    smaller = np.minimum(_area(boxes)[:, None], _area(others))
    return np.clip(high - low, 0.0, None).prod(axis=2) / np.where(smaller > 0.0, smaller, 1.0)


def _area(boxes: np.ndarray) -> np.ndarray:
    return (boxes[:, 2:] - boxes[:, :2]).prod(axis=1)
