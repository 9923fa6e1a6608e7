"""Search again for peaks that consist of rounding errors: clear of singular places, and then as close to them as the
quantity is smooth."""

from __future__ import annotations

from functools import partial

import numpy as np

from linksweep.base.degrees import signed_distance
from linksweep.results.peak_search.along_paths import (
    SignalPeak,
    angle_in_period,
    follow,
    inside_part,
    numbers_of,
    put,
    raise_to,
    raise_to_poles,
)
from linksweep.results.peak_search.arcs import arcs_within
from linksweep.results.peak_search.groups import Group
from linksweep.results.peak_search.paths import Part, breaks_of, windows_beside
from linksweep.results.peak_search.singular.extrapolated import SPANS, extrapolated
from linksweep.results.peak_search.singular.rounding_errors import (
    CLEAR,
    CLOSE_BY,
    FARTHER,
    Singular,
    are_smooth,
    clear_of,
    singular_places,
    spoilt_peaks,
)
from linksweep.scene.pairs import Array, in_period, some_of

SPANS_BESIDE = (*SPANS, 0.008)
"""Distances of the farthest samples from a singular place, in units of `STEP`: a force that rises a hundredfold within
0.01 degree may have a limit there, too."""
STEP, OF_ROUNDING, KNOWN = 0.1, 32.0, 1e-3
"""Polynomials beside singular places: the step [degree] that `SPANS` multiply; the error, relative to their last terms,
as values have rounding errors; and the largest, relative to them, with which a peak is raised."""


def clear_of_rounding_errors(group: Group, peaks: dict[str, SignalPeak], part: Part | None) -> None:
    """Replace peaks of rounding errors beside singular places by those clear of these, or by limits there."""
    signals, places = tuple(peaks), singular_places(group, tuple(peaks))
    clear = np.zeros((len(signals), len(places.row)))
    among = np.ones((len(signals), len(group.designs)), dtype=bool)
    while among.any():  # each time clear of more places
        known = {signal: numbers_of(peak, group)[:2] for signal, peak in peaks.items()}
        spoilt = np.where(clear > 0.0, 0.0, spoilt_peaks(group, places, known, among))
        clear += spoilt
        among[...] = False
        for k in np.flatnonzero(spoilt.any(axis=1)):
            designs = np.unique(places.row[spoilt[k] > 0.0])
            among[k, designs] = True
            own, peak = group.some(designs), {signals[k]: peaks[signals[k]]}
            _search_clear_of(*places.of_designs(designs, clear[k]), own, peak, part)
    if clear.any():
        raise_to_poles(group, peaks, part)
    _raise_by_polynomials(group, peaks, places, clear, part)
    for k in np.flatnonzero(clear.any(axis=1)):
        designs, peak = np.unique(places.row[clear[k] > 0.0]), {signals[k]: peaks[signals[k]]}
        raise_to_poles(group, peak, part, places.as_poles(clear[k]))
        close = places.close_to(designs, clear[k], group.scene.period)
        _raise_close_to(*close, group.some(designs), peak, part)


def _raise_by_polynomials(
    group: Group, peaks: dict[str, SignalPeak], places: Singular, clear: Array, part: Part | None
) -> None:
    """Raise finite peaks beside singular places to the highest values of polynomials, from the limits there on as far
    as samples may consist of rounding errors, `clear` (signal, place) [degree]; or raise their bounds, where these are
    not known as well. `part`: as of `raise_to_poles`."""
    inside = inside_part(places.angle, part, group.scene.period)
    places, clear = some_of(places, inside), np.tile(clear[:, inside], 2)
    signals, side = tuple(peaks), np.repeat([-1.0, 1.0], len(places.row))
    row, angle = np.tile(places.row, 2), np.tile(places.angle, 2)
    known = zip(*(numbers_of(peak, group)[:2] for peak in peaks.values()), strict=True)
    value, at = (np.stack(numbers)[:, row] for numbers in known)
    reach = 2.0 * np.maximum(clear, CLEAR)
    none = np.isnan(value) & (clear > 0.0)  # of a part that lies too close to the place
    value = np.where(none, -np.inf, value)
    needs = none | np.isfinite(value) & (np.abs(signed_distance(at, angle, group.scene.period)) < reach)

    def values_at(which: Array, ends: Array, x: Array) -> Array:
        angles, rows = angle[ends, None] + side[ends, None] * x, np.repeat(row[ends], x.shape[1])
        names = tuple(signals[k] for k in which)
        return group.values(names, rows, angles.ravel()).reshape(-1, *x.shape)

    beside = extrapolated(values_at, np.full(len(row), STEP), needs, SPANS_BESIDE)
    within = clear if part is None else np.minimum(clear, _distance_to_end(angle, side, part, group.scene.period))
    height, distance = beside.highest(within)
    beyond = OF_ROUNDING * beside.error
    higher = (beyond <= KNOWN * np.abs(height)) & (height - beyond > value)
    with np.errstate(invalid="ignore"):  # of polynomials that are not known
        bound = np.where(higher, beyond, np.maximum(height + beyond - value, 0.0))
    there = angle_in_period(angle + side * distance, group.scene.period)
    numbers = np.where(higher, height, value), np.where(higher, there, at), bound, beside.samples
    for k, peak in enumerate(peaks.values()):
        ends = np.flatnonzero(needs[k] & (beside.error[k] < np.inf))
        raise_to(peak, group.some(row[ends]), tuple(table[k, ends] for table in numbers))


def _distance_to_end(angle: Array, side: Array, part: Part, period: float) -> Array:
    """Return the distances [degree] from angles inside a part of the period to its start (side −1) or end (1)."""
    from_start = in_period(angle - part[0], period)
    return np.where(side < 0.0, from_start, part[1] - part[0] - from_start)


def raise_beside_breaks(group: Group, peaks: dict[str, SignalPeak], part: Part | None) -> None:
    """Raise peaks to those close beside breaks where the signals are smooth: samples at a break may hide these."""
    breaks = breaks_of(group)
    known = {signal: numbers_of(peak, group) for signal, peak in peaks.items()}
    follow(group, peaks, (lambda _: windows_beside(group, breaks, part),))
    for signal, peak in peaks.items():
        closer = numbers_of(peak, group)
        put(peak, group, known[signal])
        higher = np.flatnonzero(closer[0] > known[signal][0])
        own, (value, at, *others) = group.some(higher), (numbers[higher] for numbers in closer)
        away = np.abs(signed_distance(breaks[higher], at[:, None], group.scene.period))
        nearest = np.fmin.reduce(away, axis=1, initial=np.inf)
        smooth = are_smooth(own, signal, at, nearest, value - known[signal][0][higher])
        raise_to(peak, own.some(smooth), tuple(numbers[smooth] for numbers in (value, at, *others)))


def _search_clear_of(
    angles: Array, distances: Array, group: Group, peak: dict[str, SignalPeak], part: Part | None
) -> None:
    """Replace the peaks of a signal by those clear of angles by distances (design, nth) [degree]."""
    for numbers in peak.values():
        put(numbers, group, (np.full(len(angles), np.nan),) * len(SignalPeak._fields))
    parts = clear_of(angles, distances, part, group.scene.period)
    follow(group, peak, tuple(partial(arcs_within, ends) for ends in zip(*parts, strict=True)))


def _raise_close_to(angles: Array, clear: Array, group: Group, peak: dict[str, SignalPeak], part: Part | None) -> None:
    """Raise a signal's peaks to those closer to angles than they were kept clear of them (design, nth) [degree], where
    it is smooth: rounding errors reach less far from most of them."""
    ((signal, of_signal),) = peak.items()
    distances, left = np.full(angles.shape, CLOSE_BY), np.arange(len(angles))
    while len(left):
        own = group.some(left)
        known = numbers_of(of_signal, own)
        _search_clear_of(angles[left], distances[left], own, peak, part)
        closer = numbers_of(of_signal, own)
        put(of_signal, own, known)
        higher = closer[0] > known[0]
        left, own, (value, at, *others) = left[higher], own.some(higher), (numbers[higher] for numbers in closer)
        away = np.abs(signed_distance(angles[left], at[:, None], group.scene.period))
        nearest = np.nanmin(away, axis=1)
        smooth = are_smooth(own, signal, at, nearest, value - known[0][higher])
        raise_to(of_signal, own.some(smooth), tuple(numbers[smooth] for numbers in (value, at, *others)))
        rough, beside = left[~smooth], (away <= 2.0 * nearest[:, None])[~smooth]
        distances[rough] *= np.where(beside, FARTHER, 1.0)
        left = rough[(~beside | (distances[rough] < clear[rough])).all(axis=1)]
