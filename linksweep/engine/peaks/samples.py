"""Places of samples of a turn: graded about the middles of its two halves, where near-toggles may be narrow.

Each half is parametrised by the tangent x of half its angle from its own middle (`far` is 0 on one half, 1 on the
other), so that x runs from −1 to 1 on both.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

HALF = 24
"""Samples on either side of the middle of each half turn. With 96 a turn, `benchmarks.accuracy.missed` finds no design
of a million whose peak the search misses."""
FEW = 8
"""Samples on either side of the middle of a short piece of a turn, on which a signal has few summits."""
EVENLY = 0.12
"""Share of the samples that are spread evenly over x, whatever the scale of the grade: without them the search missed 2
peaks of a million, between samples 20 degrees apart."""
SAMPLES = 4 * HALF
PLACED = 2 * HALF + 2
"""Places of each half turn: its samples, and one before and after."""
GRADES = 27
"""Scales of the grade: 1, 1/2, 1/4, … The finest, 2⁻²⁶, is narrower than any near-toggle that is not yet a toggle
by its status (8e-8 rad)."""
NEWTON_STEPS = 12
"""Newton steps to the places of samples, from above on a convex curve: the last ones change rounding alone."""


@lru_cache(maxsize=4)
def grades(half: int = HALF, evenly: float = EVENLY) -> np.ndarray:
    """Return the half-angle tangents x of the samples of half a turn from its middle on, for each scale s of the grade;
    both ends are 1.

    Most samples are spread evenly over asinh(x/s), a share `evenly` over x: else those far from a narrow near-toggle
    would be up to 40 degrees apart.
    """
    scale = 0.5 ** np.arange(GRADES)[:, None]
    part, end = np.arange(half + 1) / half, np.arcsinh(1.0 / scale)
    y = np.minimum(part / (1.0 - evenly), 1.0) * end
    for _ in range(NEWTON_STEPS):
        error = (1.0 - evenly) * y / end + evenly * scale * np.sinh(y) - part
        y -= error / ((1.0 - evenly) / end + evenly * scale * np.cosh(y))
    table = scale * np.sinh(y)
    table[:, -1] = 1.0
    return table


def grade(width, scale):
    """Return the first grade of samples whose scale does not exceed a half-width; that of the first is `scale`."""
    number = 0
    while width < scale and number < GRADES - 1:
        number += 1
        scale *= 0.5
    return number
