"""Interpolation of an array between its angles, or its positions: four kinds of curve, and the ringing of one.

    periodic cubic   smooth to its second derivative; rings beside steps, where it leaves the range of its data
    pchip            monotone between neighbours, so that it never leaves their range; smooth to its first derivative
    linear           straight from each value to the next
    step             each value holds from its own angle up to the next one, where it jumps

Source: scipy.interpolate, `CubicSpline` (bc_type="periodic") and `PchipInterpolator`; F. N. Fritsch and J. Butland,
SIAM J. Sci. Stat. Comput. 5 (1984) 300.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from linksweep.base.validate import choice_problems, refuse

Array = np.ndarray

CUBIC = "periodic cubic"
INTERPOLATIONS = (CUBIC, "pchip", "linear", "step")
RINGING = 0.01
"""How far beyond its data's range a spline may go, relative to that range, before it is worth a warning."""
INSIDE = np.arange(1, 16) / 16
"""Places between two neighbours at which a spline is compared with its data."""


class OvershootWarning(UserWarning):
    """A spline leaves the range of its data by more than 1 % of that range.

    The curve through values that rise in a step swings beyond them. State interpolation="pchip", "linear" or "step" for
    the `linksweep.Load`, or more values where they change quickly.
    """


def interpolation_attribute(table: dict[str, Any]) -> dict[str, Any]:
    """Return the `interpolation` of an array's table in a scene file as the array's attribute. Raises ValueError."""
    own = {key: kind for key, kind in table.items() if key == "interpolation"}
    refuse([problem for key, kind in own.items() for problem in choice_problems(key, kind, INTERPOLATIONS)])
    return own


@dataclass(frozen=True, eq=False)
class PeriodicCurve:
    """A curve through values (angle, …) at known angles [degree], which rise within one period, and round again.

    It is evaluated for all columns of the values, or at each angle for one of them: `columns` are their numbers,
    row-major.
    """

    known: Array
    values: Array
    period: float
    interpolation: str = CUBIC

    def __call__(self, angles: Array, columns: Array | None = None) -> Array:
        """Return values (angle, …) at any angles [degree]; at known ones, and whole periods from them, to the bit."""
        values, (known, number) = self.slope(angles, 0, columns), self._in_period
        place = np.mod(angles, self.period)
        nearest = np.minimum(np.searchsorted(known, place), len(known) - 1)
        held = known[nearest] == place
        values[held] = _picked(self.values, number[nearest[held]], columns if columns is None else columns[held])
        return values

    def slope(self, angles: Array, order: int = 1, columns: Array | None = None) -> Array:
        """Return the slopes (angle, …) there, per degree; of a higher order the derivatives, per degree^order."""
        return derivative_at(self._curve, self._folded(angles), order, columns)

    @cached_property
    def overshoot(self) -> float:
        """Distance by which it leaves its data's range, relative to that range; the largest of all batched curves."""
        if self.interpolation != CUBIC:
            return 0.0
        steps = np.diff(self.known, append=self.known[0] + self.period)
        low, high = self.values.min(axis=0), self.values.max(axis=0)
        rounding, beyond = 1e-12 * np.maximum(np.abs(low), np.abs(high)) + 1e-300, np.zeros_like(low)
        for share in INSIDE:
            between = self._curve(self.known + share * steps)
            beyond = np.maximum(beyond, np.maximum(between.max(axis=0) - high, low - between.min(axis=0)) - rounding)
        return float(np.max(beyond / np.maximum(high - low, rounding)))

    @cached_property
    def _in_period(self) -> tuple[Array, Array]:
        """The known angles in [0, period), in order, and the number of the value at each."""
        places = np.mod(self.known, self.period)
        order = np.argsort(places)
        return places[order], order

    def _folded(self, angles: Array) -> Array:
        return self.known[0] + np.mod(angles - self.known[0], self.period)

    @cached_property
    def _curve(self) -> Any:
        turn = self.period
        if self.interpolation == CUBIC:
            from scipy.interpolate import CubicSpline  # here and below: only arrays between their angles need scipy

            closing = np.append(self.known, self.known[0] + turn), np.concatenate([self.values, self.values[:1]])
            return CubicSpline(*closing, bc_type="periodic")
        turns = self.known - turn, self.known, self.known + turn
        return curve_through(self.interpolation, np.concatenate(turns), np.concatenate([self.values] * len(turns)))


def derivative_at(curve: Any, places: Array, order: int, columns: Array | None) -> Array:
    """Return a derivative (place, …) of scipy's piecewise polynomials inside their range, of order 0 their values; with
    `columns`, of one of them at each place: the same to the bit."""
    if columns is None:
        return curve(places, order)
    piece = np.clip(np.searchsorted(curve.x, places, side="right") - 1, 0, len(curve.x) - 2)
    step, power, sums = places - curve.x[piece], 1.0, np.zeros(len(places))
    for exponent, coefficients in enumerate(curve.c[::-1]):
        if exponent >= order:
            sums += _picked(coefficients, piece, columns) * power * math.perm(exponent, order)
            power = power * step
    return sums


def _picked(table: Array, rows: Array, columns: Array | None) -> Array:
    """Return rows of a table (row, …); with `columns`, of each the number in one of its columns, row-major."""
    return table[rows] if columns is None else table.reshape(len(table), -1)[rows, columns]


def curve_through(interpolation: str, known: Array, values: Array) -> Any:
    """Return the curve through values (place, …) at rising places that do not come round, as a function of places."""
    from scipy.interpolate import PchipInterpolator, PPoly

    if interpolation == "pchip":
        return PchipInterpolator(known, values)
    start, rise = values[:-1], np.diff(values, axis=0)
    if interpolation == "step":
        return PPoly(start[None], known)
    return PPoly(np.stack([(rise.T / np.diff(known)).T, start]), known)
