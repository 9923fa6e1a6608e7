"""Colours of Okabe and Ito, which colour-blind readers tell apart, two greys, and the axes to draw in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

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


def grid(ax: Axes) -> None:
    """Faint lines below everything."""
    ax.grid(color=SHADE, linewidth=0.6)
    ax.set_axisbelow(True)
