"""Search for peaks along paths, with brackets as in the fused search: `linksweep.engine.peaks.paths`.

Signals are evaluated at the samples of each path; lanes about their summits are refined until none can exceed the
current peak. Limits at the ends of arcs are extrapolated; poles are known by their angles.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from linksweep.engine.peaks import brackets
from linksweep.engine.peaks.paths import open_brackets, refine
from linksweep.engine.peaks.summits import might_reach
from linksweep.engine.run import Field
from linksweep.results.peak_search.groups import Group
from linksweep.results.peak_search.paths import ASIDE, QUARTER, Part, Paths, moved_aside, reversals
from linksweep.results.peak_search.singular.extrapolated import extrapolated
from linksweep.results.peak_search.singular.poles import Candidates, poles
from linksweep.scene.pairs import Array, flat_index, in_period

PROBE, LEAST_PROBE = 0.025, 1e-5
"""Distance from the end, as part of a step and at least, of the sample that shows whether a signal is unbounded."""
GROWTH, OF_PEAK = 5.0, 0.1
"""Least growth of an unbounded signal over a tenth of that distance, and its least size there, relative to its peak."""
ATTAINED = 1e-9
"""Difference of a peak and the value at its angle, relative to the peak, beyond which it is a limit at a jump."""
NEAR_PERIOD = 5e-6
"""Distance from the end of a period within which a peak counts as at its start [degree]: half of what its angle may err
by."""

PathsOf = Callable[[Any], Paths]
"""A function that returns the paths of a group of designs."""


class SignalPeak(NamedTuple):
    """A signal's largest value, its angle [degree], a bound on how much higher it may be, and the count of samples."""

    value: Field
    angle: Field
    bound: Field
    samples: Field


class Best(NamedTuple):
    """The four numbers of the highest values of signals, as arrays over designs, paths or arcs."""

    value: Array
    angle: Array
    bound: Array
    samples: Array

    def raise_to(self, higher: Array, value: Array | float, angle: Array, bound: Array | float) -> None:
        """Replace values by higher ones."""
        for own, numbers in zip(self, (value, angle, bound), strict=False):
            np.copyto(own, numbers, where=higher)


def nothing(field: Field) -> SignalPeak:
    """Return peaks that are all NaN, from a field of NaN."""
    return SignalPeak(*(Field(field.dims, field.values.copy()) for _ in SignalPeak._fields))


def with_unknown_bound(peak: SignalPeak) -> SignalPeak:
    """Return a peak whose bound is inf: the signal depends on a load that changes too quickly to be followed."""
    bound = np.where(np.isfinite(peak.value.values), np.inf, peak.bound.values)
    return peak._replace(bound=Field(peak.bound.dims, bound))


def angle_in_period(angle: Array, period: float) -> Array:
    """Return the angles of peaks in [0, period); one within rounding of the period becomes 0."""
    return start_near_period(in_period(angle, period), period)


def start_near_period(angle: Array, period: float) -> Array:
    """Return the angles of peaks, changed in place: one within rounding of the period becomes 0."""
    near = angle >= period - NEAR_PERIOD
    if np.count_nonzero(near):  # faster than `any`
        angle[near] = 0.0
    return angle


def on_own_side(
    values_at: Callable[[Array, Array], Array], angle: Array, height: Array, period: float, first: float = 0.0
) -> Array:
    """Return the angles [degree] of peaks; of a limit at a jump the angle just beside it, where the quantity has this
    value, in the period that begins at `first`."""
    angle = angle.copy()
    with np.errstate(invalid="ignore"):  # of peaks that are infinite, or are none
        away = np.abs(values_at(np.arange(len(angle)), np.nan_to_num(angle)) - height)
        (row,) = np.nonzero(away > ATTAINED * np.abs(height))
        if len(row):
            places = [angle[row], *(first + in_period(angle[row] + side - first, period) for side in (-ASIDE, ASIDE))]
            beside = [away[row], *(np.abs(values_at(row, place) - height[row]) for place in places[1:])]
            angle[row] = np.choose(np.nan_to_num(beside, nan=np.inf).argmin(axis=0), places)
    return angle


def put(peak: SignalPeak, group: Any, numbers: tuple[Array, ...]) -> None:
    """Write the four numbers of a signal's peak of each of a group's designs."""
    at = flat_index(peak.value, group.places, len(group.designs))
    for field, values in zip(peak, numbers, strict=True):
        field.values.reshape(-1)[at] = values


def numbers_of(peak: SignalPeak, group: Any) -> tuple[Array, ...]:
    """Return the four numbers of a signal's peak of each of a group's designs."""
    at = flat_index(peak.value, group.places, len(group.designs))
    return tuple(field.values.reshape(-1)[at] for field in peak)


def raise_to(peak: SignalPeak, group: Any, numbers: tuple[Array, ...]) -> None:
    """Replace a signal's peaks of a group's designs, some of which may share one, by the highest of these numbers."""
    if len(group.designs):
        _raise(peak, flat_index(peak.value, group.places, len(group.designs)), *numbers)


def follow(group: Any, peaks: dict[str, SignalPeak], all_paths: tuple[PathsOf, ...]) -> None:
    """Search along all paths of a group's designs, and replace the peaks that are exceeded."""
    for paths in (paths_of(group) for paths_of in all_paths):
        if not len(paths.row):
            continue
        places = group.some(paths.row).places
        at = [flat_index(peak.value, places, len(paths.row)) for peak in peaks.values()]
        current = [peak.value.values.reshape(-1)[index] for peak, index in zip(peaks.values(), at, strict=True)]
        best = highest(group, tuple(peaks), paths, np.stack(current, axis=1))
        for k, (peak, index) in enumerate(zip(peaks.values(), at, strict=True)):
            _raise(peak, index, *(numbers[:, k] for numbers in best))


def raise_to_poles(
    group: Any, peaks: dict[str, SignalPeak], part: Part | None = None, candidates: Candidates | None = None
) -> None:
    """Make the peaks infinite at the poles of their signals, or those among candidates, inside a part of the period if
    there is one."""
    row, angle, infinite = poles(group, tuple(peaks), candidates)
    inside = inside_part(angle, part, group.scene.period)
    row, angle, infinite = row[inside], angle[inside], infinite[inside]
    places, angle = group.some(row).places, angle_in_period(angle, group.scene.period)
    for k, peak in enumerate(peaks.values()):
        at = flat_index(peak.value, places, len(row))[infinite[:, k]]
        for field, values in zip(peak[:3], (np.inf, angle[infinite[:, k]], 0.0), strict=True):
            field.values.reshape(-1)[at] = values


def inside_part(angle: Array, part: Part | None, period: float) -> Array:
    """Return whether angles [degree] lie inside a part of the period; all do if there is none."""
    return np.full(len(angle), True) if part is None else in_period(angle - part[0], period) <= part[1] - part[0]


def _raise(peak: SignalPeak, at: Array, best: Array, best_angle: Array, best_bound: Array, taken: Array) -> None:
    """Replace a signal's peak at each index by the highest of the paths with that index, where that is higher."""
    value, angle, bound, samples = (field.values.reshape(-1) for field in peak)
    height = np.nan_to_num(best, nan=-np.inf)
    order = np.lexsort((-np.arange(len(at)), height, at))  # by index, then height; of equals the first path is last
    last = order[np.append(at[order][1:] != at[order][:-1], True)]  # the highest of each index
    place = at[last]
    with np.errstate(invalid="ignore"):
        reach = np.nan_to_num(value + bound, nan=-np.inf, posinf=np.inf, neginf=-np.inf)
        np.maximum.at(reach, at, height + best_bound)
        higher = last[~(height[last] <= value[place]) & (height[last] > -np.inf)]
        value[at[higher]], angle[at[higher]] = best[higher], best_angle[higher]
        bound[place] = np.nan_to_num(reach - value, posinf=np.inf)[place]
    known = np.where(np.isfinite(value[place]), bound[place], 0.0)  # nothing is above an infinite peak
    bound[place] = np.where(np.isnan(value[place]), np.nan, known)
    samples[place] = np.nan_to_num(samples[place]) + np.bincount(at, taken, len(value))[place]


# ------------------------------------------------------------------------------------- lanes about summits


def highest(group: Any, signals: tuple[str, ...], paths: Paths, current: Array) -> Best:
    """Return the highest of each signal on each path; lanes that cannot exceed `current` (path, signal) are dropped."""
    best = _search(group, signals, paths, current)
    return best if paths.steps is None else _with_limits(group, signals, paths, best)


def _search(group: Group, signals: tuple[str, ...], paths: Paths, current: Array) -> Best:
    """Return the highest of each signal on each path, without the limits at its ends."""
    count_of_paths = len(paths.x)
    samples = _different(paths).sum(axis=1)
    values_along = _values_along(group, signals, paths)
    lanes, count, best = _opened(values_along, signals, paths)

    def values_at(tag: Array, x: Array) -> Array:
        path = tag // len(signals)
        samples[:] += np.bincount(path, minlength=count_of_paths)
        return values_along(path, x)[tag % len(signals), np.arange(len(tag))]

    with np.errstate(all="ignore"):
        best[brackets.PEAK] = np.fmax(best[brackets.PEAK], current.ravel())
        count = _keep_promising(lanes, count, best[brackets.PEAK], paths, len(signals))
        refine(lanes, count, best, values_at)
    value, x, bound = (best[row].reshape(-1, len(signals)) for row in (brackets.PEAK, brackets.PEAK_X, brackets.BEYOND))
    angle = angle_in_period(paths.angles(np.arange(count_of_paths)[:, None], x), group.scene.period)
    return Best(value, angle, bound, np.full(value.shape, samples[:, None], dtype=float))


def rises(group: Group, signal: str, paths: Paths, level: Array) -> tuple[Array, Array, Array]:
    """Return path, angle [degree] and height of all rises of a signal on paths that may reach the level of their path,
    each refined on its own."""
    values_along = _values_along(group, (signal,), paths)
    lanes, count, _ = _opened(values_along, (signal,), paths)
    count = _keep_promising(lanes, count, level, paths, 1)
    path = lanes[brackets.TAG, :count].astype(int)
    lanes[brackets.TAG, :count] = np.arange(count)
    best = np.zeros((brackets.BEST_ROWS, count))
    best[brackets.PEAK], best[brackets.PEAK_X] = lanes[brackets.FB, :count], lanes[brackets.XB, :count]

    def values_at(tag: Array, x: Array) -> Array:
        return values_along(path[tag], x)[0]

    with np.errstate(all="ignore"):
        refine(lanes, count, best, values_at)
    angle = angle_in_period(paths.angles(path, best[brackets.PEAK_X]), group.scene.period)
    return path, angle, best[brackets.PEAK]


def _values_along(group: Group, signals: tuple[str, ...], paths: Paths) -> Callable[[Array, Array], Array]:
    """Return the function that evaluates signals at places x of paths, on either side of where slides turn round."""
    turning = reversals(group)[paths.row]

    def values_along(path: Array, x: Array) -> Array:
        angles = paths.angles(path, x)
        for angle in turning.T:
            angles = moved_aside(angles, angle[path], group.scene.period)
        return group.values(signals, paths.row[path], angles)

    return values_along


def _opened(
    values_along: Callable[[Array, Array], Array], signals: tuple[str, ...], paths: Paths
) -> tuple[Array, int, Array]:
    """Return the lanes about all samples that may lead to a peak, their number, and each signal's highest sample."""
    count_of_paths, per_path = paths.x.shape
    different = _different(paths)
    path, _ = np.nonzero(different)
    values = values_along(path, paths.x[different])[:, np.cumsum(different) - 1]
    rows = values.reshape(len(signals), count_of_paths, per_path).swapaxes(0, 1)
    most = count_of_paths * len(signals) * (per_path + 3)  # at a sample, or between it and the next one
    lanes = np.zeros((brackets.BRACKET_ROWS, brackets.in_blocks(most)))
    best = np.empty((brackets.BEST_ROWS, count_of_paths * len(signals)))
    with np.errstate(all="ignore"):
        count = open_brackets(rows, paths.x, paths.before, paths.after, paths.ends == "meet", lanes, best)
    return lanes, count, best


def _different(paths: Paths) -> Array:
    """Return which samples of paths (path, sample) are at another place than the one before."""
    return np.diff(paths.x, axis=1, prepend=-np.inf) > 0.0


def _keep_promising(lanes: Array, count: int, peak: Array, paths: Paths, signals: int) -> int:
    """Move the lanes that can exceed the current peak of their signal to the front, and return their number."""
    with np.errstate(all="ignore"):
        kept = np.flatnonzero(_promising(lanes[:, :count], peak, paths, signals))
    lanes[:, : len(kept)] = lanes[:, kept]
    return len(kept)


def _promising(lanes: Array, peak: Array, paths: Paths, signals: int) -> Array:
    """Return whether each lane can exceed the current peak of its signal.

    No lane at an end of a window counts, as the signals continue beyond: it may lie on a slope, not about a summit.
    """
    tag, x = lanes[brackets.TAG].astype(int), lanes[brackets.XB]
    ratio = (lanes[brackets.XC] - x) / (x - lanes[brackets.XA])
    promise = might_reach(lanes[brackets.FA], lanes[brackets.FB], lanes[brackets.FC], ratio) > peak[tag]
    path = tag // signals
    known = (lanes[brackets.FA] > -np.inf) & (lanes[brackets.FC] > -np.inf)
    promise |= lanes[brackets.FB] == -np.inf  # between two samples: by the cubic through four
    return promise & ((paths.ends != "pass") | known & (x > paths.x[path, 0]) & (x < paths.x[path, -1]))


# ------------------------------------------------------------------------------------- limits at ends of arcs


def _with_limits(group: Group, signals: tuple[str, ...], paths: Paths, best: Best) -> Best:
    """Return the highest values on arcs, raised to the limits at their ends: inf where a signal is unbounded."""
    for end, side in enumerate((-1.0, 1.0)):
        limit, error, samples = (numbers.T for numbers in _limits(group, signals, paths, end, best.value.T))
        edge = angle_in_period(paths.middle + side * paths.half, group.scene.period)[:, None]
        best.raise_to(limit > best.value, limit, edge, error)
        best.samples[...] += samples
    return best


def _limits(group: Group, signals: tuple[str, ...], paths: Paths, end: int, peak: Array) -> tuple[Array, Array, Array]:
    """Return limits (signal, path) at one end of arcs that may exceed a peak, their errors, and counts of samples."""
    step = paths.steps[:, end]

    def values_at(which: Array, rows: Array, x: Array) -> Array:
        names, path = tuple(signals[k] for k in which), np.repeat(rows, x.shape[1])
        places = (2 * end - 1) * (QUARTER - x).ravel()
        return group.values(names, paths.row[path], paths.angles(path, places)).reshape(-1, *x.shape)

    probes = np.maximum(PROBE * step, LEAST_PROBE)[:, None] * [1.0, 0.1]
    probe, closer = np.moveaxis(values_at(np.arange(len(signals)), np.arange(len(step)), probes), 2, 0)
    with np.errstate(invalid="ignore"):
        # ten times closer in x: a signal that varies as 1/x is ten times as large, a signal with a limit hardly changes
        grows = (np.abs(closer) > GROWTH * np.abs(probe)) & (np.abs(closer) > OF_PEAK * np.nan_to_num(np.abs(peak)))
        infinite = grows & (step > 0.0)  # at an end that is no toggle a signal has a value, if only of rounding errors
        highest = closer + np.abs(closer - probe)
        beside = extrapolated(values_at, step, ~infinite & (highest >= peak))
        limit = np.where(infinite, np.copysign(np.inf, closer), np.minimum(beside.limit, highest))
    return limit, np.where(infinite, 0.0, beside.error), beside.samples + probes.shape[1]
