"""The look of axes, legends and figures; axes of lengths."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from linksweep.base.validate import refuse
from linksweep.plot.kit.colors import SHADE
from linksweep.scene.shown_units import UnitSystem

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


SMALL: dict[Any, Any] = {"font.size": 8.0, "axes.titlesize": 9.0, "lines.linewidth": 1.3}
"""Settings of figures of several panels."""
ROUND = (45.0, 90.0, 180.0, 360.0, 720.0, 1800.0, 3600.0, 7200.0, 18000.0)
"""Steps of crank angles [degree] that are easy to read off: parts of a turn, then turns."""


def axes_or_new(ax: Axes | None, **figure: Any) -> Axes:
    """Return `ax`, or the axes of a new figure where it is None; raise ValueError for anything else."""
    if ax is None:
        import matplotlib.pyplot as plt  # here: only those who plot need wait for it

        return plt.subplots(layout="constrained", **figure)[1]
    from matplotlib.axes import Axes

    one = "must be one Axes of matplotlib, as figure.axes[0], or axes[0] of an array of them"
    refuse([] if isinstance(ax, Axes) else [f"ax is a {type(ax).__name__}: {one}"])
    return ax


@contextmanager
def small_type() -> Iterator[None]:
    """Set the look of figures of several panels, within a with statement."""
    import matplotlib.pyplot as plt

    plt.draw_if_interactive()  # wakes a notebook's backend, which turns on display; rc_context would turn it off again
    with plt.rc_context(SMALL):
        yield


@contextmanager
def panels(rows: int, columns: int, **options: Any) -> Iterator[tuple[Figure, Any]]:
    """Make a figure of several panels and its axes, for a with statement in the look of such figures."""
    import matplotlib.pyplot as plt

    with small_type():
        yield plt.subplots(rows, columns, **{"layout": "constrained"} | options)


def crank_angles(ax: Axes, angles: np.ndarray) -> None:
    """Set an axis of crank angles [degree] from the first to the last, with as many round ticks as there is room
    for."""
    from matplotlib.ticker import MultipleLocator

    span = float(angles[-1] - angles[0])
    if span >= 180.0:
        wide = ax.get_window_extent().width / ax.figure.dpi > 4.0
        step = round_step(span, 9.0) if wide else round_step(span, 5.0, 90.0)
        ax.xaxis.set_major_locator(MultipleLocator(step))
        ax.xaxis.set_minor_locator(MultipleLocator(step / 3.0))
    if span > 0.0:
        ax.set_xlim(angles[0], angles[-1])
    ax.set_xlabel("crank angle $\\theta_2$ [°]")


def round_step(span: float, most: float, least: float = ROUND[0]) -> float:
    """Return the least round step [degree] of which so many, at most, cover a span of crank angles."""
    return next((step for step in ROUND if step >= least and span <= most * step), span / most)


def grid(ax: Axes) -> Axes:
    """Draw faint grid lines below everything; return the axes."""
    ax.grid(color=SHADE, linewidth=0.6)
    ax.set_axisbelow(True)
    return ax


def legend_above(ax: Axes, **options: Any) -> Any:
    """Draw the legend above the axes, where there are no curves."""
    place: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.2}
    return ax.legend(fontsize="small", frameon=False, **place | options)


def show_lengths(ax: Axes, system: UnitSystem) -> None:
    """Label both axes as lengths, in a system's unit; the data stay in metres."""
    unit, size = system.unit("m"), system.size("m")
    ax.set(xlabel=f"x [{unit}]", ylabel=f"y [{unit}]")
    if size != 1.0:
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_major_locator(_locator(size))
            axis.set_major_formatter(lambda value, place: f"{round(value / size, 9):g}".replace("-", "−"))


def _locator(size: float) -> Any:
    """Return a locator of ticks that are round in units of this size."""
    from matplotlib.ticker import MaxNLocator  # here: its import is slow

    class Rounded(MaxNLocator):
        def tick_values(self, vmin: float, vmax: float) -> Any:
            return np.asarray(super().tick_values(vmin / size, vmax / size)) * size

    return Rounded(nbins="auto", steps=[1, 2, 2.5, 5, 10])
