"""Find peaks that consist of rounding errors.

Beside an angle at which some forces grow without bound, a force that has a limit may be the difference of two that have
none. Where a quantity rises there, it does so smoothly; rounding errors scatter. A peak of these is searched for again,
clear of that angle.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from linksweep.base.degrees import signed_distance
from linksweep.results.peak_search.arcs import arc_ends_of_whole_period
from linksweep.results.peak_search.between import PARTLY, driven_elsewhere
from linksweep.results.peak_search.groups import Group
from linksweep.results.peak_search.paths import AT_JUMP, Part, jump_angles
from linksweep.results.peak_search.singular.poles import Candidates, pole_candidates
from linksweep.scene.pairs import Array, by_row

CLEAR, FARTHEST = 0.01, 10.24
"""Distances from a singular place [degree] within which rounding errors may be peaks: of most signals, and of those
that are the difference of forces which grow as the fourth power."""
CLOSE_BY, FARTHER = 1e-5, 2.0
"""Distance from it [degree] beyond which a peak may be one of the signal after all, and the factor to the next one
where the signal is not smooth there."""
SIDES = np.array([-1.0, 1.0])
OF_PARABOLA = np.outer(SIDES, [1.0, 2.0, 3.0])
"""Samples (side, step) beside a singular place, clear of rounding errors, whose parabolas tell how high a quantity may
reach there."""
DOUBLED = CLEAR * 2.0 ** np.arange(round(math.log2(FARTHEST / CLEAR)) + 1)
AT_DOUBLED = np.multiply.outer(SIDES, np.multiply.outer(DOUBLED, 1.0 + 0.003 * np.arange(5.0)))
"""Distances from a place [degree], and five samples at each (side, distance, step)."""
ROUGH = 1e-6
"""Least fourth difference of these five, relative to them, that tells of rounding errors: of 1/distance⁴ it is 7e-8."""
SPOILT = 1e-9
"""Least error, relative to a quantity, that tells a peak of rounding errors from one of the quantity."""
RESOLVED = 5e-6
"""Least distance from a place [degree] that the angle of a peak tells: within as much of a period it is 0."""
DISTANCES, STEPS = 33, (1e-3, 3e-5, 1e-6)
"""Samples that tell scatter from a rise: the number of distances on either side of a place, at each of which five are
close together, and the steps between these, relative to the distance: a rise is smooth at one of them."""
SCATTER = 0.1
"""Least fourth difference of such five that is scatter, relative to how far a peak exceeds what may be reached."""
ABOUT = np.linspace(-0.2, 0.2, 5)
"""Places about a peak at which five samples each tell whether a signal is smooth, relative to its distance."""
NEAREST, SMOOTH, GROWN, STEADY = 1e-9, 0.01, 3.0, 1.2
"""Infinite peaks: the least of those distances [degree], the scatter up to which samples are smooth, relative to their
size, and their least growth, coming closer, while they are: in all, and over each of the last three distances."""


class Singular(NamedTuple):
    """Places beside which samples may consist of rounding errors: the row of the design in its group, the angle
    [degree], and whether an arc ends there."""

    row: Array
    angle: Array
    ends_arc: Array

    def of_designs(self, designs: Array, clear: Array) -> tuple[Array, Array]:
        """Return the angles of some designs (design, nth) to keep clear of, and by which distances [degree], NaN for
        none; `clear` has the distance of each place, 0 for none."""
        own = (clear > 0.0) & np.isin(self.row, designs)
        row = np.searchsorted(designs, self.row[own])
        return by_row(row, self.angle[own], len(designs)), by_row(row, clear[own], len(designs))

    def close_to(self, designs: Array, clear: Array, period: float) -> tuple[Array, Array]:
        """Return `of_designs`, with the places that lie within such a distance of another: a search clear of that one
        has not met their rounding errors yet."""
        own = np.isin(self.row, designs)
        row = np.searchsorted(designs, self.row[own])
        angles, distances = (by_row(row, numbers[own], len(designs)) for numbers in (self.angle, clear))
        away = np.abs(signed_distance(angles[:, :, None], angles[:, None, :], period))
        reach = distances[:, None, :]
        within = np.where(away <= reach, reach, 0.0).max(axis=-1)
        return np.where(within > 0.0, angles, np.nan), within

    def as_poles(self, clear: Array) -> Candidates:
        """Return places to keep clear of as possible poles, which show at the distances where rounding errors end."""
        own = clear > 0.0
        return Candidates(self.row[own], self.angle[own], clear[own])


def singular_places(group: Group, signals: tuple[str, ...]) -> Singular:
    """Return the possible poles of these designs; and the ends of their arcs, unless the crank drives: then forces are
    computed from those of the machine by its crank, which grow without bound there."""
    row, angle, _ = pole_candidates(group, signals)
    ends = arc_ends_of_whole_period(group) if driven_elsewhere(group.scene) else ()
    if not ends:
        return Singular(row, angle, np.zeros(len(row), dtype=bool))
    toggles = np.concatenate(ends, axis=1)
    design, which = np.nonzero(np.isfinite(toggles) & (group.assembly() == PARTLY)[:, None])
    ends_arc = np.repeat([False, True], [len(row), len(design)])
    return Singular(np.concatenate([row, design]), np.concatenate([angle, toggles[design, which]]), ends_arc)


def spoilt_peaks(group: Group, places: Singular, peaks: dict[str, tuple[Array, ...]], among: Array) -> Array:
    """Return the distances [degree] from these places (signal, place) by which to search clear of them for peaks that
    consist of rounding errors now, 0 for none. `peaks` are the values and the angles [degree] of each signal's peaks,
    those `among` (signal, design) new.

    Such a peak exceeds the parabola through three samples on one side, and the signal scatters there. At the end of an
    arc it may be infinite, too.
    """
    signals, of_signals = tuple(peaks), zip(*peaks.values(), strict=True)
    value, at = (np.stack(numbers)[:, places.row] for numbers in of_signals)
    away = signed_distance(at, places.angle, group.scene.period)

    def values_beside(signal: Array, place: Array, beside: Array) -> Array:
        """Return one signal's values about one place each, at angles (each, …) beside it [degree]."""
        angles, values = (places.angle[place] + beside.T).T, np.empty(beside.shape)
        for k in np.unique(signal):
            own = signal == k
            rows = np.repeat(places.row[place[own]], math.prod(beside.shape[1:]))
            values[own] = group.values((signals[k],), rows, angles[own].ravel()).reshape(values[own].shape)
        return values

    suspect = among[:, places.row] & (np.abs(away) < CLEAR) & (np.isfinite(value) | places.ends_arc & (value == np.inf))
    signal, place = np.nonzero(suspect)
    clear = _where_smooth(values_beside(signal, place, np.tile(AT_DOUBLED, (len(place), 1, 1, 1))))
    with np.errstate(invalid="ignore"):
        reached = _reached(values_beside(signal, place, np.multiply.outer(clear, OF_PARABOLA)))
        high = value[signal, place] > reached
    signal, place, clear, reached = signal[high], place[high], clear[high], reached[high]
    excess, distance = value[signal, place] - reached, np.abs(away[signal, place])
    least = np.spacing(np.maximum(places.angle[place], 1.0))
    nearest = np.where(distance > RESOLVED, 0.25 * distance, least)
    farthest = np.maximum(distance, 4.0 * RESOLVED)  # beyond a peak there may be others
    infinite = excess == np.inf
    nearest[infinite], farthest[infinite] = NEAREST, clear[infinite]
    beside = _five_at_each(away[signal, place], nearest, farthest, least)
    across = _across_jumps(group.some(places.row[place]), places.angle[place], beside)
    scatters = _scatters(values_beside(signal, place, beside), across, reached, excess)
    spoilt = np.zeros(suspect.shape)
    spoilt[signal, place] = np.where(scatters, clear, 0.0)
    return spoilt


def _where_smooth(sampled: Array) -> Array:
    """Return the least of the doubled distances [degree] at which, and at the next one, samples (each, side, distance,
    step) do not scatter."""
    with np.errstate(invalid="ignore"):
        rough = np.abs(np.diff(sampled, n=4))[..., 0] > ROUGH * np.abs(sampled).max(axis=-1)
    smooth = ~(rough[..., :-1] | rough[..., 1:]).any(axis=1)
    return DOUBLED[np.where(smooth.any(axis=1), smooth.argmax(axis=1), -1)]


def _reached(beside: Array) -> Array:
    """Return how high signals may reach at places by the parabolas through their samples (each, side, step)."""
    first, second, third = np.moveaxis(beside, -1, 0)
    bend = first - 2.0 * second + third
    reached = np.fmax(first, first + (first - second) + bend) + np.abs(bend) + SPOILT * np.abs(first)
    return np.fmax.reduce(reached, axis=-1)


def _five_at_each(peak: Array, nearest: Array, farthest: Array, least: Array) -> Array:
    """Return angles beside places (each, kind of step, distance, step) [degree]: five close together at each distance
    on both sides, and from the peak on, either way; no step is less than the least."""
    distances = np.geomspace(nearest, farthest, DISTANCES).T
    starts = np.concatenate([distances, -distances, peak[:, None], peak[:, None]], axis=1)
    ways = np.repeat([1.0, -1.0, 1.0, -1.0], [DISTANCES, DISTANCES, 1, 1])
    steps = [ways * np.maximum(step * np.abs(starts), least[:, None]) for step in STEPS]
    return starts[:, None, :, None] + np.stack(steps, axis=1)[..., None] * np.arange(5.0)


def _across_jumps(group: Group, place: Array, beside: Array) -> Array:
    """Return whether fives of samples (each, kind of step, distance, step), one row for each of a group's designs, lie
    on both sides of a jump, or at it; they are stated by angles beside a place of that design [degree]."""
    first, last = beside[..., 0], beside[..., -1]
    least, most = np.minimum(first, last) - AT_JUMP, np.maximum(first, last) + AT_JUMP
    across = np.zeros(first.shape, dtype=bool)
    for jump in signed_distance(jump_angles(group), place[:, None], group.scene.period).T[..., None, None]:
        across |= (least <= jump) & (jump <= most)
    return across


def _scatter(sampled: Array, across: Array) -> Array:
    """Return by how much fives of samples (each, kind of step, distance, step) scatter at each distance: as little as
    by any kind of step, without those across jumps."""
    scatters = np.where(across, np.inf, np.abs(np.diff(sampled, n=4))[..., 0])
    return np.where(across.all(axis=1), 0.0, scatters.min(axis=1))


def _scatters(sampled: Array, across: Array, reached: Array, excess: Array) -> Array:
    """Return whether fives of samples (each, kind of step, distance, step) scatter as much as peaks exceed what may be
    reached; infinite ones, only if they have not grown from there while they were smooth."""
    with np.errstate(invalid="ignore"):
        size, scatter = np.abs(sampled).max(axis=3).min(axis=1), _scatter(sampled, across)
        noisy = np.any(scatter > SCATTER * np.minimum(size, excess[:, None]), axis=1)
        # by the longest steps: samples closer together may have one error
        smooth = np.abs(np.diff(sampled[:, 0], n=4))[..., 0] < SMOOTH * size
        size, smooth = (of_fives[:, : 2 * DISTANCES].reshape(-1, 2, DISTANCES) for of_fives in (size, smooth))
        up_to_there = np.logical_and.accumulate(smooth[..., ::-1], axis=2)[..., ::-1]
        grows = sliding_window_view(size[..., :-1] > STEADY * size[..., 1:], 3, axis=2).all(axis=-1)
        steadily = grows & up_to_there[..., : grows.shape[2]]
        grown = np.where(steadily, size[..., : grows.shape[2]], 0.0).max(axis=(1, 2)) > GROWN * np.abs(reached)
    return noisy & ~(grown & (excess == np.inf))


def are_smooth(group: Group, signal: str, angle: Array, distance: Array, rise: Array) -> Array:
    """Return whether a signal of each design is smooth about an angle [degree] at a distance from a singular place: it
    scatters by less than a share of a rise."""
    starts, steps = distance[:, None] * ABOUT, np.multiply.outer(distance, STEPS)
    beside = starts[:, None, :, None] + steps[..., None, None] * np.arange(5.0)
    rows = np.repeat(np.arange(len(angle)), math.prod(beside.shape[1:]))
    (values,) = group.values((signal,), rows, (angle + beside.T).T.ravel())
    with np.errstate(invalid="ignore"):
        scatter = _scatter(values.reshape(beside.shape), _across_jumps(group, angle, beside))
        return (scatter < SCATTER * rise[:, None]).all(axis=1) & (rise < np.inf)


def clear_of(angles: Array, distances: Array, part: Part | None, period: float) -> Array:
    """Return the parts (start or end, nth, design) between angles, and clear of them by distances (design, nth)
    [degree], NaN for none, of a part of the period or of all of it."""
    if part:
        start, end = np.broadcast_arrays(*part, angles[:, :1])[:2]
    else:
        first = np.nanargmin(angles, axis=1)[:, None]
        at, away = (np.take_along_axis(numbers, first, axis=1) for numbers in (angles, distances))
        start, end = at + away, at + period - away
    inside = start + np.mod(angles - start, period)
    order = np.argsort(inside, axis=1)
    inside, away = (np.take_along_axis(numbers, order, axis=1) for numbers in (inside, distances))
    inside[~(inside <= end)] = np.nan
    first, last = np.concatenate([start, inside + away], axis=1), np.concatenate([inside - away, end], axis=1)
    last = np.where(np.isnan(last) & np.isfinite(first), end, last)  # of the last part
    return np.stack([first.T, last.T])
