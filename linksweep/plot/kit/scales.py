"""Scales of numbers that differ much between designs: their ends, round numbers, colours and colour bars."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from linksweep.plot.kit.designs import Column

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROUND = (1.0, 2.0, 5.0)  # numbers on a logarithmic scale
DECADE = 10.0  # how many times as large as the least the largest of a linear scale may be


def span(values: np.ndarray) -> tuple[float, float]:
    """Return the ends of a scale that shows all designs, but for a few that lie far from the others.

    Near toggles peaks grow without bound, and one such design would flatten all the others. A design
    is off the scale where it is farther from the middle nine tenths than these are wide.
    """
    low, high = float(values.min()), float(values.max())
    least, most = (float(end) for end in np.quantile(values, (0.05, 0.95)))
    width = most - least
    return (least if low < least - width else low), (most if high > most + width else high)


def many_sizes(limits: tuple[float, float]) -> bool:
    """Return whether a scale is better logarithmic: above zero, with a largest number many times the least."""
    return 0.0 < DECADE * limits[0] < limits[1]


def digits(values: np.ndarray) -> int:
    """Return the significant digits, four at least, in which numbers differ by a hundredth of their span."""
    width, size = float(np.ptp(values)), float(np.max(np.abs(values)))
    return min(max(4, math.ceil(math.log10(100.0 * size / width))), 15) if width else 4


def plain(values: np.ndarray) -> Any:
    """Return a function that writes ticks of an axis whole, without a power of ten or an offset beside it."""
    significant = digits(values) + 1  # for ticks, of which some end in a 5

    def tick(value: float, place: int | None = None) -> str:
        return f"{value + 0.0:.{significant}g}".replace("-", "−")

    return tick


def norm(limits: tuple[float, float]) -> Any:
    """Return matplotlib's map from numbers to colours."""
    from matplotlib.colors import LogNorm, Normalize

    return (LogNorm if many_sizes(limits) else Normalize)(*limits)


def levels(limits: tuple[float, float]) -> np.ndarray:
    """Return a few round numbers on a scale."""
    from matplotlib.ticker import LogLocator, MaxNLocator

    locator: Any = LogLocator(subs=ROUND) if many_sizes(limits) else MaxNLocator(6)
    ticks = locator.tick_values(*limits)
    return ticks[(ticks >= limits[0]) & (ticks <= limits[1])]


def color_bar(ax: Axes, colored: Any, item: Column, limits: tuple[float, float]) -> None:
    """Add a colour bar with round numbers, and with a pointed end where values are off its scale."""
    round_numbers: dict[str, Any] = {"format": plain(np.array(limits))}
    if many_sizes(limits):
        round_numbers = {"ticks": levels(limits), "format": "%g"}
    if item.words:
        round_numbers = {"ticks": range(len(item.words)), "format": lambda value, _: item.words[round(value)]}
    bar = ax.figure.colorbar(colored, ax=ax, label=item.text, extend=beyond(item.values, limits), **round_numbers)
    bar.minorticks_off()
    if bar.solids is not None:
        bar.solids.set(alpha=1.0)


def beyond(values: np.ndarray, limits: tuple[float, float]) -> str:
    """Return the ends of a scale beyond which there are values, in matplotlib's words for colour bars."""
    if (values < limits[0]).any():
        return "both" if (values > limits[1]).any() else "min"
    return "max" if (values > limits[1]).any() else "neither"
