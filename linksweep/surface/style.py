"""Colours of Okabe and Ito, which colour-blind readers tell apart, two greys, and the axes to draw in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
GREY, SHADE = "#666666", "#EBEBEB"
FORCE_COLORS = {"F12": BLUE, "F32": VERMILION, "F43": GREEN, "F14": PURPLE}


def axes_or_new(ax: Axes | None, **figure: Any) -> Axes:
    """The axes given, or those of a new figure."""
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt  # here: only those who plot need wait for it

    return plt.subplots(layout="constrained", **figure)[1]


def crank_angles(ax: Axes, angles: np.ndarray) -> None:
    """An axis of crank angles [degree] from the first to the last, with round ticks."""
    from matplotlib.ticker import MultipleLocator

    span = float(angles[-1] - angles[0])
    if span >= 180.0:
        ax.xaxis.set_major_locator(MultipleLocator(90.0 if span <= 400.0 else 180.0))
    if span > 0.0:
        ax.set_xlim(angles[0], angles[-1])
    ax.set_xlabel("crank angle $\\theta_2$ [°]")


def grid(ax: Axes) -> None:
    """Faint lines below everything."""
    ax.grid(color=SHADE, linewidth=0.6)
    ax.set_axisbelow(True)
