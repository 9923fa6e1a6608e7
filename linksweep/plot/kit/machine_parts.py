"""Parts of a drawn machine: supports, guides, links, blocks, cylinders. All take points in the data's coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from linksweep.plot.kit.colors import GREY, SKY

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BAR, EDGE = "#DCE6EE", "#3F4B55"
CENTRE_LINE = (0.0, (8.0, 3.0, 1.0, 3.0))
CENTRE = 7.5  # points: size of a centre of gravity
STROKES = 0.35  # of the block's half side: length of the hatching
HIDDEN = 0.14  # of a link's length: distance from a symbol within which that hides the link's number


def supports(ax: Axes, at: np.ndarray, size: float = 30.0) -> None:
    """Draw a hatched support of this size [points] under each ground pin, the rows of `at`."""
    from matplotlib.path import Path

    strokes = [[(x, -1.0), (x - 0.25, -1.3)] for x in np.linspace(-0.7, 0.9, 6)]
    outline = [(0.0, 0.0), (-0.6, -1.0), (0.6, -1.0), (0.0, 0.0)]
    lines = [outline, [(-0.9, -1.0), (0.9, -1.0)], *strokes]
    codes = [Path.MOVETO if k == 0 else Path.LINETO for line in lines for k in range(len(line))]
    support = Path([vertex for line in lines for vertex in line], codes)
    style: dict[str, Any] = {"markersize": size, "markerfacecolor": "white", "markeredgecolor": EDGE, "zorder": 2.1}
    ax.plot(*at.T, linestyle="none", marker=support, label="_ground", **style)


def centre_line(ax: Axes, ends: np.ndarray) -> None:
    ax.plot(*ends.T, color=GREY, linewidth=0.8, linestyle=CENTRE_LINE, zorder=2.0)


def circle(ax: Axes, centre: np.ndarray, radius: float, name: str) -> None:
    """Draw a thin circle: that of the crank's pin, or a gear's pitch circle."""
    around = np.radians(np.linspace(0.0, 360.0, 181))
    points = centre[:, None] + radius * np.array([np.cos(around), np.sin(around)])
    ax.plot(*points, color=GREY, alpha=0.55, linewidth=0.8, linestyle="--", zorder=2.0, label=f"_{name}")


def rails(ax: Axes, first: np.ndarray, last: np.ndarray, along: np.ndarray, half: float) -> None:
    """Draw the two sides of a guide, hatched outside, for a block of this half side between its first and last
    place."""
    across = np.array([-along[1], along[0]])
    begin, end = first - 1.2 * half * along, last + 1.2 * half * along
    count = 1 + int(np.linalg.norm(end - begin) / (STROKES * half))
    feet = begin + np.linspace(0.0, 1.0, count)[:, None] * (end - begin)
    for side in (across, -across):
        edge = np.array([begin, end]) + half * side
        ax.plot(*edge.T, color=EDGE, linewidth=1.2, zorder=2.1, label="_guide")
        stroke = STROKES * half * (side - along)
        hatching = np.stack([feet, feet + stroke, np.full_like(feet, np.nan)], axis=1) + half * side
        ax.plot(*hatching.reshape(-1, 2).T, color=EDGE, linewidth=0.7, zorder=2.05, label="_hatching")


def block(ax: Axes, corners: np.ndarray) -> None:
    """Draw a block by its corners."""
    ax.fill(*corners.T, facecolor=BAR, zorder=2.16)
    ax.plot(*corners.T, color=EDGE, linewidth=1.0, zorder=2.17, label="_block")


def bar(ax: Axes, number: int, ends: np.ndarray, behind: bool = False) -> None:
    """Draw a bar from pin to pin; one that carries a block lies behind it."""
    for width, color in ((9.0, EDGE), (7.2, BAR)):
        style: dict[str, Any] = {"color": color, "linewidth": width, "solid_capstyle": "round"}
        ax.plot(*ends.T, zorder=2.12 if behind else 2.2, label=f"_link {number}", **style)


def link(ax: Axes, number: int, corners: np.ndarray) -> None:
    """Draw a link by its pins: a bar, or with three pins and more a plate."""
    if len(corners) > 2:
        middle = corners.mean(axis=0)
        around = np.argsort(np.arctan2(*(corners - middle).T[::-1]))
        corners = corners[[*around, around[0]]]
        ax.fill(*corners.T, facecolor=BAR, zorder=2.2)
    bar(ax, number, corners)


def number_of_link(ax: Axes, number: int, ends: np.ndarray, own: np.ndarray, covered: np.ndarray) -> None:
    """Write a link's number between its first two pins, as far as possible from symbols of its `own`, these pins among
    them, unless one of the `covered` points lies there now; both in rows."""
    side = ends[1] - ends[0]
    length = np.linalg.norm(side) or 1.0  # two pins may lie together
    places = ends[0] + np.linspace(0.2, 0.8, 13)[:, None] * side
    clear, free = (np.linalg.norm(places[:, None] - points, axis=2).min(axis=1) / length for points in (own, covered))
    best = np.argmax(np.round(clear, 6))  # where two are equally far, the same one in every frame of a film
    number_at(ax, number, places[best if free[best] > HIDDEN else np.argmax(np.minimum(clear, free))])


def telescope(ax: Axes, barrel: np.ndarray, rod: np.ndarray, shortest: float) -> None:
    """Draw a cylinder: its barrel from the first pin, nearly as long as the cylinder at its shortest, and its rod."""
    end = barrel + (0.8 * shortest / np.linalg.norm(rod - barrel)) * (rod - barrel)
    ax.plot(*np.array([end, rod]).T, color=EDGE, linewidth=3.0, zorder=2.18, label="_rod")
    for width, color in ((11.0, EDGE), (9.0, "white")):
        style: dict[str, Any] = {"color": color, "linewidth": width, "solid_capstyle": "butt"}
        ax.plot(*np.array([barrel, end]).T, zorder=2.19, label="_barrel", **style)


def stay(ax: Axes, place: np.ndarray, corners: np.ndarray) -> None:
    """Draw a thin line from a point of a link to the nearest place between the link's pins, which may lie apart."""
    around = corners if len(corners) < 3 else np.append(corners, corners[:1], axis=0)
    start, side = around[:-1], np.diff(around, axis=0)
    squared = np.sum(side * side, axis=1)
    share = np.sum((place - start) * side, axis=1) / np.where(squared > 0.0, squared, 1.0)  # two pins may lie together
    feet = start + np.clip(share, 0.0, 1.0)[:, None] * side
    foot = feet[np.argmin(np.linalg.norm(feet - place, axis=1))]
    ax.plot(*np.array([foot, place]).T, color=EDGE, linewidth=0.8, zorder=2.11, label="_stay")


def tie(ax: Axes, corners: np.ndarray, behind: bool = False) -> None:
    """Draw the triangle that ties a point to its link."""
    style: dict[str, Any] = {"facecolor": BAR, "edgecolor": EDGE, "linewidth": 0.8, "alpha": 0.6}
    ax.fill(*corners.T, zorder=2.11 if behind else 2.15, **style)


def pins(ax: Axes, at: np.ndarray) -> None:
    circles: dict[str, Any] = {"markerfacecolor": "white", "markeredgecolor": EDGE, "markersize": 6.0, "zorder": 2.45}
    ax.plot(*at.T, "o", label="_pins", **circles)


def centres(ax: Axes, at: np.ndarray) -> None:
    """Draw the sign of a centre of gravity, a circle in black and white quarters, at each row of `at`."""
    from matplotlib.path import Path

    style: dict[str, Any] = {"linestyle": "none", "markersize": CENTRE, "markeredgecolor": "black", "zorder": 2.44}
    ax.plot(*at.T, marker="o", markerfacecolor="white", markeredgewidth=0.8, label="_centres", **style)
    quarters = Path.make_compound_path(Path.wedge(0.0, 90.0), Path.wedge(180.0, 270.0))
    ax.plot(*at.T, marker=quarters, markerfacecolor="black", markeredgewidth=0.0, label="_quarters", **style)


def point(ax: Axes, at: np.ndarray) -> None:
    ax.plot(*at, "o", color=SKY, markeredgecolor=EDGE, markersize=4.5, zorder=2.45, label="_point")


def number_at(ax: Axes, number: int, at: np.ndarray) -> None:
    x, y = at
    ax.text(x, y, str(number), ha="center", va="center", fontsize=6.5, zorder=2.3, color=EDGE)
