"""Locate the crank angles at which functions and data over the revolution change quickly.

A function is sampled every 0.02 degrees between its breaks. An interval between samples is smooth where the polynomial
through eight even samples, some of them beyond its ends, predicts its middle. It has a kink where one of two cubics,
each through four samples on one side, predicts the middle and the two cross within; a jump where they do not cross. All
other intervals are halved until they are one of these: their ends and middles are quick. A jump is halved down to its
two sides.

Values at known angles, joined by a spline, are as quick as their angles are close.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from linksweep.base.validate import Rule
from linksweep.scene.curves.over_angle import called, period_of

Array = np.ndarray
Function = Callable[[Array], Array]

STEP = 0.5
"""Distance of samples between which a smooth function is not quick [degree]."""
LEVELS = 4
"""Halvings of this step down to that of the samples taken everywhere."""
FEWEST = 16
"""Steps between breaks, however close they are."""
ASIDE = 1e-9
"""How far beside a break its sides are, and those of a jump at most [degree]."""
TOLERANCE = 1e-9
"""Largest error of a smooth interval's middle, relative to the range of the function."""
ROUNDING = 64.0
"""Rounding of a function's values, in units of their last digit."""
LAST_DIGIT = 2.0**-40
"""Rounding of an angle inside a function [degree]."""
MOST = 20_000
"""Most intervals that are halved; of a function with more it is not known where it is quick."""


class Quick(NamedTuple):
    """Angles [degree] at which a function or an array is quick; `all` is True where there are surely no others."""

    angles: Array
    all: bool


def quick_angles(scene: Any) -> Quick:
    """Return where the functions of theta2 and the arrays over it that a scene holds are quick."""
    arrays = [array for array in scene.arrays.values() if "theta2" in array.dims and "theta2" in array.coords]
    periods = [period_of(array, scene.mechanism.period) for array in arrays]
    data = [of_data(array["theta2"].values, own, scene.period) for array, own in zip(arrays, periods, strict=True)]
    functions = [_of_checked(scene, path, scene.numbers[path][1]) for path in scene.functions]
    return joined([*data, *functions])


def _of_checked(scene: Any, path: str, kind: str) -> Quick:
    """Return where a function of a scene is quick between the breaks of its load."""
    function = scene.functions[path]
    called(path, function, Rule(kind, over_angle=True), np.arange(0.0, scene.period, STEP))
    loads = [load for k, load in enumerate(scene.loads, 1) if path.startswith(f"loads[{k}].")]
    return of_function(function, [angle for load in loads for angle in getattr(load, "breaks", ())], scene.period)


def joined(parts: Iterable[Quick]) -> Quick:
    """Return the quick angles of several functions or arrays together."""
    parts = list(parts)
    return Quick(np.unique(np.concatenate([np.empty(0), *(part.angles for part in parts)])), all(p.all for p in parts))


def of_data(angles: Any, period: float, whole: float) -> Quick:
    """Return the quick angles of values at known angles: those closer than two steps, and others between them.

    The values repeat after `period`; the angles are over the `whole` period of the scene [degree].
    """
    known = np.unique(np.mod(np.asarray(angles, dtype=float), period))
    gaps = np.diff(known, append=known[:1] + period)
    close = gaps < 2.0 * STEP
    quick = known[close] + np.multiply.outer([0.0, 0.5, 1.0], gaps[close])
    return Quick(np.add.outer(np.arange(0.0, whole, period), quick).ravel(), True)


def of_function(function: Function, breaks: Iterable[float], period: float) -> Quick:
    """Return the quick angles of a function of theta2 [degree] between its breaks in a period."""
    cuts = np.unique([0.0, *(angle % period for angle in breaks), period])
    ends = zip(cuts[:-1] + ASIDE, cuts[1:] - ASIDE, strict=True)
    pieces = [_Piece(function, start, end) for start, end in ends if start < end]
    tolerance = _tolerance([piece.everywhere for piece in pieces])
    return joined(piece.quick(tolerance) for piece in pieces)


def _tolerance(values: list[Array]) -> float:
    """Return the tolerance on values interpolated from others; the function's own type limits their digits."""
    last = max(np.finfo(part.dtype).eps if part.dtype.kind == "f" else 0.0 for part in values)
    every = np.concatenate(values).astype(float)
    return TOLERANCE * float(np.ptp(every)) + ROUNDING * max(last, 2.0**-52) * float(np.max(np.abs(every)))


@dataclass(frozen=True)
class _Piece:
    """A function between two breaks. Level k has so many even steps that each is half of one of the level before."""

    function: Function
    start: float
    end: float

    @cached_property
    def everywhere(self) -> Array:
        """Its values at all samples of the level below the last that is sampled everywhere."""
        return self._called(LEVELS + 1, np.arange(self.count(LEVELS + 1) + 1))

    def count(self, level: int) -> int:
        return max(FEWEST, int(np.ceil((self.end - self.start) / STEP))) << level

    def angles(self, level: int, k: Array) -> Array:
        return self.start + (self.end - self.start) * (k / self.count(level))

    def values(self, level: int, k: Array) -> Array:
        if level <= LEVELS + 1:
            return self.everywhere[k << (LEVELS + 1 - level)]
        different, place = np.unique(k, return_inverse=True)
        return self._called(level, different)[place.reshape(k.shape)]

    def _called(self, level: int, k: Array) -> Array:
        angles = self.angles(level, k)
        return np.broadcast_to(np.asarray(self.function(angles)), angles.shape)

    def quick(self, tolerance: float) -> Quick:
        """Return the ends and middles of rough intervals, and the sides of jumps."""
        level, k, angles = 0, np.arange(self.count(0)), [np.empty(0)]
        while True:
            smooth, jumps = self._classified(level, k, tolerance)
            rough, rest = k[~smooth & ~jumps], k[~smooth]
            angles += [self.angles(level + 1, 2 * rough + side) for side in range(3)]
            last = self.end - self.start <= ASIDE * self.count(level)
            if last or (level >= LEVELS and not 0 < len(rest) <= MOST):
                break
            level += 1
            k = np.arange(self.count(level)) if level <= LEVELS else np.concatenate([2 * rest, 2 * rest + 1])
        angles += [self.angles(level, rest + side) for side in range(2)]
        return Quick(np.concatenate(angles), not len(rest) or (last and not len(rough)))

    def _classified(self, level: int, k: Array, tolerance: float) -> tuple[Array, Array]:
        """Return which intervals are smooth or have a kink, and which have a jump, by the samples around them."""
        smooth = np.abs(self._by_eight(level, k, 3) - self._middle(level, k)) <= tolerance
        jumps, others = np.zeros(k.shape, dtype=bool), np.flatnonzero(~smooth)
        smooth[others], jumps[others] = self._classified_by_sides(level, k[others], tolerance)
        return smooth, jumps

    def _middle(self, level: int, k: Array) -> Array:
        return self.values(level + 1, 2 * k + 1).astype(float)

    def _classified_by_sides(self, level: int, k: Array, tolerance: Any) -> tuple[Array, Array]:
        middle, around = self._middle(level, k), self._around(level, k)
        blur = LAST_DIGIT * self.count(level) / (self.end - self.start)
        tolerance = tolerance + blur * np.nanmax(np.abs(np.diff(around, axis=1)), axis=1, initial=0.0)
        left, right = around[:, 3:7], around[:, 10:6:-1]
        sides = np.minimum(*(np.abs((side * HALF_A_STEP_ON).sum(axis=-1) - middle) for side in (left, right)))
        apart_before = left[:, -1] - (right * A_STEP_ON).sum(axis=-1)
        apart_after = (left * A_STEP_ON).sum(axis=-1) - right[:, -1]
        cross = np.sign(apart_before) * np.sign(apart_after) <= 0.0
        fits = np.min([np.abs(self._by_eight(level, k, reach) - middle) for reach in (0, 3, 6)], axis=0) <= tolerance
        return fits | (sides <= tolerance) & cross, (sides <= tolerance) & ~cross & ~fits

    def _around(self, level: int, k: Array) -> Array:
        """Return values (interval, sample) from six steps before to six after each interval; NaN beyond the piece."""
        places = k[:, None] + np.arange(-6, 8)
        inside = (places >= 0) & (places <= self.count(level))
        return np.where(inside, self.values(level, np.clip(places, 0, self.count(level))), np.nan)

    def _by_eight(self, level: int, k: Array, reach: int) -> Array:
        """Predict the middles of intervals by eight samples, of which the first lies `reach` steps before each."""
        first = np.clip(k - reach, 0, self.count(level) - 7)
        return (self.values(level, first[:, None] + np.arange(8)) * MIDDLES[k - first]).sum(axis=-1)


def _weights(nodes: int, at: float) -> Array:
    """Return the weights of values at 0, 1, 2, … in the polynomial through them, evaluated at a place."""
    every = range(nodes)
    return np.array([np.prod([(at - j) / (i - j) for j in every if j != i]) for i in every])


MIDDLES = np.array([_weights(8, k + 0.5) for k in range(7)])
HALF_A_STEP_ON, A_STEP_ON = _weights(4, 3.5), _weights(4, 4.0)
