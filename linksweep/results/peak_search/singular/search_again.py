"""Search again for peaks that consist of rounding errors: clear of singular places, and then as close to them as the
quantity is smooth."""

from __future__ import annotations

from functools import partial

import numpy as np

from linksweep.base.degrees import signed_distance
from linksweep.results.peak_search.along_paths import (
    SignalPeak,
    follow,
    numbers_of,
    put,
    raise_to,
    raise_to_limits,
    raise_to_poles,
)
from linksweep.results.peak_search.arcs import arcs_within
from linksweep.results.peak_search.groups import Group
from linksweep.results.peak_search.paths import Part
from linksweep.results.peak_search.singular.rounding_errors import (
    CLEAR,
    CLOSE_BY,
    FARTHER,
    are_smooth,
    clear_of,
    singular_places,
    spoilt_peaks,
)
from linksweep.scene.pairs import Array


def clear_of_rounding_errors(group: Group, peaks: dict[str, SignalPeak], part: Part | None) -> None:
    """Replace peaks of rounding errors beside singular places by those clear of these, or by limits there."""
    signals, places = tuple(peaks), singular_places(group, tuple(peaks))
    left_out = np.zeros((len(signals), len(places.row)), dtype=bool)
    among = np.ones((len(signals), len(group.designs)), dtype=bool)
    while among.any():  # each time clear of more places
        known = {signal: numbers_of(peak, group)[:2] for signal, peak in peaks.items()}
        spoilt = spoilt_peaks(group, places, known, among) & ~left_out
        left_out |= spoilt
        among[...] = False
        for k in np.flatnonzero(spoilt.any(axis=1)):
            designs = np.unique(places.row[spoilt[k]])
            among[k, designs] = True
            own, peak = group.some(designs), {signals[k]: peaks[signals[k]]}
            angles = places.angles_of(designs, left_out[k])
            _search_clear_of(angles, np.full(angles.shape, CLEAR), own, peak, part)
    if left_out.any():
        raise_to_poles(group, peaks, part)
    raise_to_limits(group, peaks, places, part)
    for k in np.flatnonzero(left_out.any(axis=1)):
        designs = np.unique(places.row[left_out[k]])
        peak = {signals[k]: peaks[signals[k]]}
        _raise_close_to(places.angles_of(designs, left_out[k]), group.some(designs), peak, part)


def _search_clear_of(
    angles: Array, distances: Array, group: Group, peak: dict[str, SignalPeak], part: Part | None
) -> None:
    """Replace the peaks of a signal by those clear of angles by distances (design, nth) [degree]."""
    for numbers in peak.values():
        put(numbers, group, (np.full(len(angles), np.nan),) * len(SignalPeak._fields))
    parts = clear_of(angles, distances, part, group.scene.period)
    follow(group, peak, tuple(partial(arcs_within, ends) for ends in zip(*parts, strict=True)))


def _raise_close_to(angles: Array, group: Group, peak: dict[str, SignalPeak], part: Part | None) -> None:
    """Raise a signal's peaks to those close to angles (design, nth) [degree] that were left out, where it is smooth:
    rounding errors reach less far from most of them."""
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
        left = rough[np.where(beside, distances[rough], 0.0).max(axis=1) < CLEAR]
