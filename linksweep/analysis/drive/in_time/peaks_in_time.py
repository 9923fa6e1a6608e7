"""Largest magnitudes of quantities on the way of a crank that speeds up or slows down.

Twelve places of each step are sampled, on the polynomial of fifth degree through both ends with their speeds and
accelerations: 144 places a turn at least. The highest samples are refined: a step of the integration leads from the
start of their own step to any place near them, so that the peak is a value on the way itself. What may be missed is a
peak between two samples that neither of them shows.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linksweep.analysis.drive.in_time.motion_in_time import ANGLE, SPEED, Run
from linksweep.scene.pairs import Array, by_row

PLACES = 12
"""Samples of a step."""
HIGHEST = 3
"""Highest samples of a quantity, each larger than its neighbours, that are refined."""
ROUNDS = 14
"""Places tried about each of them."""
GOLDEN = 0.381966
AT_ONCE = 2**18
"""Samples of all designs together that are held at a time."""


class Way(NamedTuple):
    """The ways of some designs: the ends of their steps (design, step), and derivatives to time there."""

    rows: Array
    time: Array
    state: Array
    slope: Array

    @classmethod
    def of(cls, run: Run) -> Way:
        """Return the ways of all designs of a run."""
        trace, count = run.trace, len(run.target)
        tables = (by_row(trace.rows, values, count) for values in (trace.time, trace.state, trace.slope))
        return cls(np.arange(count), *tables)

    def some(self, rows: Array) -> Way:
        """Return the ways of the designs in these rows."""
        return Way(*(values[rows] for values in self))

    def samples(self) -> tuple[Array, Array, Array]:
        """Return time, angle and speed (design, sample): at the start, and at the places of each step."""
        s = np.arange(1, PLACES + 1) / PLACES
        h = np.diff(self.time, axis=1)[..., None]
        (x, w, a), (x1, w1, a1) = (
            [values[:, part, None] for values in self._motion] for part in (np.s_[:-1], np.s_[1:])
        )
        rest = x1 - x - h * w - 0.5 * h * h * a
        lead, bend = h * (w1 - w) - h * h * a, h * h * (a1 - a)
        third = 10.0 * rest - 4.0 * lead + 0.5 * bend
        fourth, fifth = -15.0 * rest + 7.0 * lead - bend, 6.0 * rest - 3.0 * lead + 0.5 * bend
        angle = x + s * (h * w + s * (0.5 * h * h * a + s * (third + s * (fourth + s * fifth))))
        speed = w + s * (h * a + s * (3.0 * third + s * (4.0 * fourth + 5.0 * s * fifth)) / h)
        starts = (self.time, *self._motion[:2])
        samples = (self.time[:, :-1, None] + s * h, angle, speed)
        flat = (values.reshape(len(self.rows), -1) for values in samples)
        time, angle, speed = (
            np.concatenate([first[:, :1], rest], axis=1) for first, rest in zip(starts, flat, strict=True)
        )
        return time, angle, speed

    @property
    def _motion(self) -> tuple[Array, Array, Array]:
        return self.state[..., ANGLE], self.state[..., SPEED], self.slope[..., SPEED]


class Peaks(NamedTuple):
    """Largest magnitudes (quantity, design), and time and angle φ [rad] of each."""

    value: Array
    time: Array
    angle: Array


def peaks_in_time(run: Run, names: tuple[str, ...]) -> Peaks:
    """Return the largest magnitude of each quantity on the way of each design."""
    way, count = Way.of(run), len(run.target)
    at_once = max(1, AT_ONCE // (PLACES * way.time.shape[1]))
    parts = [_of_some(run, way.some(np.arange(k, min(k + at_once, count))), names) for k in range(0, count, at_once)]
    return Peaks(*(np.concatenate(arrays, axis=1) for arrays in zip(*parts, strict=True)))


def _of_some(run: Run, way: Way, names: tuple[str, ...]) -> Peaks:
    time, angle, speed = way.samples()
    known = np.isfinite(time)
    sizes = np.full((len(names), *time.shape), -np.inf)
    rows = np.broadcast_to(way.rows[:, None], time.shape)[known]
    sizes[:, known] = _sizes(run, names, rows, angle[known], speed[known])
    quantity, design, sample = _highest(sizes)
    starts = np.maximum(sample - 1, 0) // PLACES  # the step of a sample
    left = time[design, np.maximum(sample - 1, 0)]
    last = np.minimum(sample + 1, time.shape[1] - 1)
    right = np.where(known[design, last], time[design, last], time[design, sample])
    near = _Near(run, names, quantity, way.rows[design], *(values[design, starts] for values in way[1:]))
    value, when, where = near.highest(left, time[design, sample], right)
    best = Peaks(*np.full((3, len(names), len(time)), np.nan))
    for k in np.argsort(value, kind="stable"):  # the largest last
        for results, number in zip(best, (value[k], when[k], where[k]), strict=True):
            results[quantity[k], design[k]] = number
    return best


def _sizes(run: Run, names: tuple[str, ...], rows: Array, angle: Array, speed: Array) -> Array:
    """Return the magnitudes of quantities (quantity, pair); -inf where there are none."""
    pairs = run.crank.at(rows, angle)
    rise = run.crank.rise(pairs, speed)
    values = np.where(np.isfinite(rise), abs(run.crank.values(names, pairs, speed, rise)), -np.inf)
    return np.where(np.isnan(values), -np.inf, values)


def _highest(sizes: Array) -> tuple[Array, Array, Array]:
    """Return quantity, design and number of the highest samples that top their neighbours."""
    padded = np.pad(sizes, ((0, 0), (0, 0), (1, 1)), constant_values=-np.inf)
    tops = (sizes >= padded[..., :-2]) & (sizes >= padded[..., 2:]) & np.isfinite(sizes)
    ranked = np.where(tops, sizes, -np.inf)
    most = min(HIGHEST, ranked.shape[2])
    samples = np.argpartition(ranked, -most, axis=2)[..., -most:]
    good = np.isfinite(np.take_along_axis(ranked, samples, axis=2))
    quantity, design, nth = np.nonzero(good)
    return quantity, design, samples[quantity, design, nth]


class _Near(NamedTuple):
    """Places on the way near some samples, each of one quantity and design, counted from the start of a step."""

    run: Run
    names: tuple[str, ...]
    quantity: Array
    rows: Array
    time: Array
    state: Array
    slope: Array

    def size(self, time: Array) -> tuple[Array, Array]:
        """Return the magnitude of the quantity at times, and the angle there."""
        state, _ = self.run.systems.advanced(self.rows, self.state, self.slope, time - self.time)
        sizes = _sizes(self.run, self.names, self.rows, state[:, ANGLE], state[:, SPEED])
        return sizes[self.quantity, np.arange(len(time))], state[:, ANGLE]

    def highest(self, left: Array, middle: Array, right: Array) -> tuple[Array, Array, Array]:
        """Return the largest magnitude between two times, with its time and angle: by parabolas and golden sections."""
        (low, _), (top, angle), (high, _) = map(self.size, (left, middle, right))
        for _ in range(ROUNDS):
            with np.errstate(invalid="ignore", divide="ignore"):
                before, after = (middle - left) * (top - high), (middle - right) * (top - low)
                vertex = middle - 0.5 * ((middle - left) * before - (middle - right) * after) / (before - after)
            part = right - left
            useful = (vertex > left) & (vertex < right) & (abs(vertex - middle) > 1e-6 * part)
            golden = np.where(
                right - middle > middle - left, middle + GOLDEN * (right - middle), middle - GOLDEN * (middle - left)
            )
            trial = np.where(useful, vertex, golden)
            size, place = self.size(trial)
            better, later = size > top, trial > middle
            left, low = (
                np.where(better == later, np.where(better, a, b), c)
                for a, b, c in ((middle, trial, left), (top, size, low))
            )
            right, high = (
                np.where(better != later, np.where(better, a, b), c)
                for a, b, c in ((middle, trial, right), (top, size, high))
            )
            middle, top = np.where(better, trial, middle), np.where(better, size, top)
            angle = np.where(better, place, angle)
        return top, middle, angle
