"""Axes of lengths: drawn in metres, with ticks that are round in the unit in which lengths are shown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from linksweep.scene.shown_units import UnitSystem

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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
