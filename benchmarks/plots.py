"""Draw run time against error: one figure per group, with the machine named below."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.accuracy.grids import MEDIAN, MOST, POPULATIONS
from benchmarks.accuracy.solves import LINKSWEEP, NEAR, OURS, RATES
from benchmarks.machine import machine, short_name
from benchmarks.speed.exact import EXACT
from benchmarks.timing import Row

Axes = Any
HERE = Path(__file__).parent
BLACK, GREY, SHADE = "#000000", "#666666", "#EBEBEB"
BLUE, ORANGE, GREEN, PURPLE = "#0072B2", "#D55E00", "#009E73", "#CC79A7"
"""Colours of Okabe and Ito."""
MACHINE = "{name}, one core; {system}, Python {Python}, numpy {numpy}, numba {numba}, linksweep {linksweep}"
STYLE = {"font.size": 9.0, "axes.spines.top": False, "axes.spines.right": False, "figure.dpi": 160}
LEAST = 1e-16
"""Smaller errors are drawn as this."""
PLACES = [
    place
    for down in (0.0, -10.0, -20.0, -30.0, -40.0)
    for place in (((0.0, down - 14.0), "center"), ((7.0, down - 3.0), "left"), ((-7.0, down - 3.0), "right"))
]
"""Offsets of a name from its point [pt], in order of preference."""
BESIDE = [place for place, _ in PLACES[:3]]
"""Offsets of names that stand beside their points."""
SMALL = {"textcoords": "offset points", "ha": "center", "fontsize": 7.5}
LEGEND = {"loc": "lower right", "frameon": False, "fontsize": 8.0}
GAP = 2.0
"""Gap between names [px]."""
LEADER = {"arrowstyle": "-", "color": GREY, "linewidth": 0.5, "shrinkA": 0.0, "shrinkB": 3.0}
"""Style of a line from a name to its point."""
HEIGHT = 6.0
"""Height of a name [pt]."""
WHITE = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5}


def draw(name: str, rows: list[Row], folder: Path = HERE) -> None:
    """Draw the figure of a group, if it has one, to NAME.png."""
    if name not in FIGURES:
        return
    import matplotlib.pyplot as plt

    with plt.rc_context(STYLE):
        figure = FIGURES[name]([row for row in rows if row.seconds is not None])
        figure.savefig(folder / f"{name}.png")
        plt.close(figure)


def _two_panels(**more: Any) -> Any:
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(1, 2, figsize=(10.0, 5.2), sharey=True, layout="constrained", **more)
    facts = machine()
    figure.supxlabel(MACHINE.format_map({"name": short_name(facts), **facts}), fontsize=7.0, color=GREY)
    return figure, panels


def _solves(rows: list[Row]) -> Any:
    figure, panels = _two_panels(width_ratios=(2.4, 1.0))
    jobs = {
        OURS: "nine unknowns: pin forces and torque",
        RATES: r"rates alone: $\omega_3, \omega_4, \alpha_3, \alpha_4$",
    }
    for ax, (against, title) in zip(panels, jobs.items(), strict=True):
        _log_axes(ax, title, "time per crank angle [ns]")
        _methods(ax, [row for row in rows if row.against == against])
        ax.margins(x=0.26 if against == OURS else 0.3)
    panels[0].set(ylabel="largest error, relative", ylim=(3e-18, 1.0))
    _key(panels[0])
    for ax, against in zip(panels, jobs, strict=True):
        _names(ax, [row for row in rows if row.against == against])
    return figure


def _methods(ax: Axes, rows: list[Row]) -> None:
    """Draw a point for each method, and above it, hollow, its error near a toggle."""
    for row in rows:
        (x, y), color = _point(row), _color(row)
        ax.plot(x, y, "o", color=color, markersize=6.0, zorder=3)
        if NEAR in row.figures:
            near = max(row.figures[NEAR], LEAST)
            ax.plot([x, x], [y, near], ":", color=color, linewidth=0.9)
            ax.plot(x, near, "o", markerfacecolor="white", color=color, markersize=6.0, zorder=3)


def _point(row: Row) -> tuple[float, float]:
    return row.seconds * 1e9, max(row.error, LEAST)


def _color(row: Row) -> str:
    return BLUE if row.job in LINKSWEEP else BLACK


def _names(ax: Axes, rows: list[Row]) -> None:
    """Write each name below its point, or at the next place free of other names and points, a thin line between."""
    ax.figure.draw_without_rendering()
    taken = [_around(ax.transData.transform(_point(row))) for row in rows]
    for row in sorted(rows, key=lambda row: row.seconds):
        name = ax.annotate(row.job, _point(row), (0.0, 0.0), color=_color(row), **SMALL)
        name.set(bbox=WHITE, zorder=2.0, in_layout=False)
        for place, align in PLACES:
            name.set(position=place, ha=align)
            if not any(name.get_window_extent().padded(GAP).overlaps(other) for other in taken):
                break
        taken.append(name.get_window_extent())
        if place not in BESIDE:
            ax.annotate("", _point(row), (place[0], place[1] + HEIGHT), **SMALL, arrowprops=LEADER, zorder=1.0)


def _around(point: Any) -> Any:
    from matplotlib.transforms import Bbox

    return Bbox([point - 5.0, point + 5.0])


def _key(ax: Axes) -> None:
    ax.plot([], [], "o", color=GREY, label="over a revolution")
    ax.plot([], [], "o", color=GREY, markerfacecolor="white", label="down to 1e-6 rad from a toggle")
    ax.legend(loc="upper left", frameon=False, fontsize=8.0)


def _grids(rows: list[Row]) -> Any:
    import matplotlib.pyplot as plt

    figure, panels = _two_panels(sharex=True)
    for ax, population in zip(panels, POPULATIONS, strict=True):
        _log_axes(ax, f"random crank-rockers, {population}", "time per design [µs]")
        here = [row for row in rows if row.note == population]
        ax.margins(x=0.24)
        for way in COLORS:
            _ladder(ax, way, [row for row in here if _way(row) == way])
    panels[0].set_ylabel("error of a design's worst peak, relative")
    what = [
        plt.Line2D([], [], marker="o", color=GREY, markersize=4.0, label="median"),
        plt.Rectangle((0, 0), 1, 1, color=GREY, alpha=0.2, label="up to 99 % of the designs"),
        plt.Line2D([], [], marker="_", linestyle="", color=GREY, label="worst"),
    ]
    panels[0].legend(handles=what, **LEGEND)
    ways = {_way(row): COLORS[_way(row)] for row in rows if row.job != EXACT}
    lines = [plt.Line2D([], [], marker="o", color=color, markersize=4.0, label=way) for way, color in ways.items()]
    panels[1].legend(handles=lines, **LEGEND)
    return figure


def _way(row: Row) -> str:
    return row.job.rsplit(", ", 1)[0] if row.job.endswith("samples") else row.job


def _ladder(ax: Axes, way: str, rows: list[Row]) -> None:
    """Draw the errors of one way of evaluation, from few samples to many."""
    if not rows:
        return
    color = COLORS[way]
    x = [row.seconds * 1e6 for row in rows]
    median, most, worst = ([max(value, LEAST) for value in values] for values in zip(*map(_spread, rows), strict=True))
    ax.fill_between(x, median, most, color=color, alpha=0.15, linewidth=0.0)
    ax.plot(x, median, "o-", color=color, markersize=4.0)
    ax.plot(x, worst, "_", color=color, markersize=8.0)
    if way == EXACT:
        ax.annotate(way, (x[0], worst[0]), (0.0, 7.0), color=color, **SMALL)
    if way == FASTEST:
        for end in (0, -1):
            ax.annotate(rows[end].job.removeprefix(f"{way}, "), (x[end], median[end]), (-20.0, -11.0), **SMALL)


def _spread(row: Row) -> tuple[float, float, float]:
    return row.figures[MEDIAN], row.figures[MOST], row.error


def _log_axes(ax: Axes, title: str, xlabel: str) -> None:
    ax.set(xscale="log", yscale="log", xlabel=xlabel)
    ax.set_title(title, loc="left", fontsize=9.5)
    ax.grid(color=SHADE, linewidth=0.6)
    ax.set_axisbelow(True)


COLORS = {"ls.peaks": BLUE, EXACT: BLUE, "limit.c": GREEN, "numpy closed form": ORANGE}
COLORS["numpy + LAPACK"] = PURPLE
FASTEST = "ls.peaks"
"""The way whose points are labelled with numbers of samples: nothing is drawn on their left."""
FIGURES: dict[str, Callable[[list[Row]], Any]] = {"solves": _solves, "grids": _grids}
