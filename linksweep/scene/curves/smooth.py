"""Divide the cycle into intervals in which functions of the crank angle are polynomials but for rounding.

Intervals between breaks are halved until the polynomial through a few samples of each interval agrees with dense
samples everywhere. A function that jumps or bends elsewhere is not divided.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial.polynomial import polyval

from linksweep.base.degrees import OFF_ROUND

Array = np.ndarray
Function = Callable[[Array], Any]

TERMS = 12
"""Coefficients of the polynomial that stands for a function in an interval."""
ROUNDING = 1e-13
"""Largest error of such a polynomial, relative to the function's largest size."""
LONGEST = 30.0
"""Longest interval [degree]."""
SHORTEST = 1.0
"""Intervals below this length are not halved [degree]: the function jumps or bends there."""
MOST = 64
"""Intervals of each turn, at most, besides those of known knots: more take longer than a search along paths."""
STEP = 0.02
"""Distance of the dense samples [degree]; the first one is off round angles, at which functions jump."""
BESIDE_BREAKS = np.geomspace(1e-9, 1.0, 60)
"""Distances of further dense samples from a break, beside which a function may be narrow [degree]."""


def chebyshev(count: int) -> Array:
    """Return the places of samples in an interval through which a polynomial is determined well: from −1 to 1."""
    return -np.cos(np.pi * (np.arange(count) + 0.5) / count)


def coefficients(places: Array, values: Array) -> Array:
    """Return the coefficients (…, power) of the polynomials through values (…, place)."""
    columns = values.reshape(-1, len(places)).T
    return np.linalg.solve(places[:, None] ** np.arange(len(places)), columns).T.reshape(values.shape)


def smooth_knots(
    functions: Sequence[Function], known: Array, breaks: Array, quick: Array, period: float
) -> Array | None:
    """Return knots between which all functions are polynomials of `TERMS` coefficients; None where there are none.

    Parameters
    ----------
    functions : sequence of callable
        Functions of arrays of theta2 [degree].
    known : array
        Angles that are knots in any case [degree].
    breaks, quick : array
        Angles at which functions may jump, which are knots, too; and angles at which they change quickly [degree].
    period : float
        Period of all functions [degree].

    Returns
    -------
    array
        Knots in order, the first again after a period [degree].
    """
    breaks = np.append(breaks, 0.0)  # where a function of so many turns may begin anew
    knots = divided(np.concatenate([known, breaks]), period)
    beside = np.add.outer(np.concatenate([-BESIDE_BREAKS, BESIDE_BREAKS]), breaks).ravel()
    dense = np.concatenate([np.arange(OFF_ROUND * STEP, period, STEP), beside, quick])
    dense = np.unique(knots[0] + np.mod(dense - knots[0], period))
    exact = [np.asarray(function(np.mod(dense, period))) for function in functions]
    most = len(known) + MOST * period / 360.0
    while len(knots) <= most:
        half = 0.5 * np.diff(knots)
        middle, interval = knots[:-1] + half, np.searchsorted(knots, dense, side="right") - 1
        places = np.mod((middle[:, None] + half[:, None] * chebyshev(TERMS)).ravel(), period)
        share, wrong = (dense - middle[interval]) / half[interval], np.zeros(len(half), dtype=bool)
        for function, values in zip(functions, exact, strict=True):
            terms = coefficients(chebyshev(TERMS), np.asarray(function(places)).reshape(-1, TERMS))
            error = np.abs(polyval(share, terms[interval].T, tensor=False) - values)
            wrong[interval[error > ROUNDING * np.max(np.abs(values))]] = True
        if not wrong.any():
            return knots
        if half[wrong].min() < 0.5 * SHORTEST:
            return None
        knots = np.sort(np.concatenate([knots, middle[wrong]]))
    return None


def divided(angles: Array, period: float) -> Array:
    """Return different angles in order, the first again after a period, and even ones in intervals beyond `LONGEST`."""
    knots = np.unique(np.mod(angles, period))
    knots = np.append(knots, knots[0] + period)
    parts = [
        np.linspace(start, end, math.ceil((end - start) / LONGEST), endpoint=False) for start, end in pairwise(knots)
    ]
    return np.append(np.concatenate(parts), knots[-1])
