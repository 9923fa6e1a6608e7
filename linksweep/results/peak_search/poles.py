"""Find poles: crank angles inside a turn or an arc at which quantities grow without bound.

Their possible angles are known in closed form: the dead centres of the drive and of the output, the angles at which
friction begins to jam the machine, and, where the crank turns fully, its change points. A quantity has a pole at such
an angle if it grows as a power of the distance, on one side at least: neither rounding nor a quantity that has a limit
does that.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from functools import singledispatch
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from linksweep.chains.finding import Finding
from linksweep.engine.quantity import regardless_of_jams
from linksweep.engine.run import Field
from linksweep.results.compute import surely_ok
from linksweep.results.peak_search.arcs import arc_ends
from linksweep.results.peak_search.between import PARTLY
from linksweep.results.peak_search.friction.jams import jammed_designs, may_jam
from linksweep.results.peak_search.groups import Group, all_at_once
from linksweep.results.peak_search.limits import limits_of
from linksweep.results.peak_search.paths import Part
from linksweep.scene.dimensions import side_by_side
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene

CLOSEST = 1e-8
"""Distance from a dead centre or jam of the closest sample [degree]."""
CLOSEST_TO_TOGGLE = 1e-5, 1e-4
"""Distances from a change point of the closest samples [degree].

Nearer ones have the status of a toggle; two distances, as quantities may grow by different powers near and far."""
BESIDE = np.array([1.0, 2.0, 4.0, 8.0])
"""Distances of the samples beside a possible pole, as multiples of the closest one."""
LEAST_GROWTH = 1.5
"""Least growth when the distance to a pole halves; a quantity that varies as 1/distance**n grows 2**n times."""
EVENNESS = 1.1
"""Factor by which the growths over two halvings differ at most: of a power they are equal."""
TOGGLE = 2.0
"""Status of a sample in a toggle."""
CLEAR = 0.01
"""Distance from a dead centre or change point [degree] within which a quantity that has a limit there may be a quotient
of rounding errors."""
SPOILT = 1e-9
"""Least error, relative to a quantity, that tells a peak of rounding errors from one of the quantity."""
BESIDE_CLEAR = np.outer([-CLEAR, CLEAR], [1.0, 2.0, 3.0])
"""Places of the samples of the parabolas (side, step) beside a possible pole [degree]."""
RESOLVED = 5e-6
"""Least distance from a possible pole [degree] that the angle of a peak tells: within as much of a period it is 0."""
DISTANCES = 33
"""Number of distances from a singular place at which samples tell scatter from a rise."""
LEAST_OF_INFINITE, SMOOTH, GROWN = 1e-9, 0.01, 3.0
"""Least distance of samples from the end of an arc where a peak is infinite [degree]; their scatter, relative to their
size, up to which they are smooth; and how much they grow up to there where the peak is no rounding error."""
STEP = 1e-3
"""Step between samples that tell scatter from a rise, relative to their distance from the pole."""
SCATTER = 0.1
"""Least fourth difference of such samples that is scatter, relative to how far a peak exceeds the parabola."""
KINDS = {"dead_centre": "dead_centre", "wedge": "jam"}
"""Kinds of zeros that a search locates, and what closed forms call them."""
OF_OUTPUT = ("torque_ratio", "mechanical_advantage")
"""Quantities with a pole where the output stands still, whichever link drives."""

Candidates = tuple[Array, Array, Array]
"""Possible poles: the row of its design in a group, the angle, and the distance of the closest sample [degree]."""


def may_have_poles(scene: Scene, signals: tuple[str, ...]) -> bool:
    """Return whether any of these quantities may grow without bound inside a turn or an arc."""
    return "unbounded" in scene.mechanism.round_meanings and (_of_output(signals) or not surely_ok(scene))


def _of_output(signals: tuple[str, ...]) -> bool:
    return any(regardless_of_jams(signal).removeprefix("-") in OF_OUTPUT for signal in signals)


def with_dead_centres(scene: Scene, assembly: Field) -> Field:
    """Return `assembly` as it is, but PARTLY where a dead centre or friction forbids some angles of a whole turn."""
    if surely_ok(scene):
        return assembly
    forbidding = [jammed_designs(scene)] if may_jam(scene) else []
    if "unbounded" in scene.mechanism.round_meanings:
        poles = chain(_poles_by_search(scene), _poles_in_closed_form(scene))
        forbidding += [Field(dims, np.isfinite(angles).any(axis=-1)) for dims, angles in poles]
    dims, (status, *some) = side_by_side((assembly, *forbidding))
    return Field(dims, np.where(np.any(some, axis=0) & (status < PARTLY), PARTLY, status)) if some else assembly


def _poles_by_search(scene: Scene) -> Iterator[tuple[tuple[str, ...], Array]]:
    """Yield dims and angles [degree], several on a trailing axis, of dead centres located by a search."""
    if scene.table.limits:
        sizes, limits = limits_of(scene.unloaded)
        angles = limits.zeros_of(scene.table.limits, "dead_centre")
        yield tuple(sizes), angles.reshape(*sizes.values(), angles.shape[1])


def _poles_in_closed_form(scene: Scene) -> Iterator[tuple[tuple[str, ...], Array]]:
    """Yield dims and angles [degree], several on a trailing axis, of dead centres and jams in closed form."""
    for findings, numbers in scene.mechanism.driven_findings(scene.motion | {"drive": scene.drive}):
        dims, arrays = side_by_side(numbers)
        for angles in _singular_angles(findings(*arrays)):
            yield dims, angles


def poles(group: Group, signals: tuple[str, ...], threads: int | None = None) -> tuple[Array, Array, Array]:
    """Return the possible poles of these designs, where they can be assembled, and the signals that are inf there.

    Three arrays: of each pole the row of its design in the group and its angle [degree], and whether each signal is inf
    there (pole, signal).
    """
    row, angle, step = pole_candidates(group, signals)
    if not len(row):
        return row, angle, np.zeros((0, len(signals)), dtype=bool)
    side = np.array([-1.0, 1.0])
    angles = angle[:, None, None] + step[:, None, None] * side[:, None] * BESIDE
    rows = np.repeat(row, angles[:1].size)
    with np.errstate(invalid="ignore"):
        values = group.values(signals, rows, angles.ravel(), threads).reshape(len(signals), *angles.shape)
        infinite = _grows_as_a_power(np.abs(values)) & (values[..., 0] > 0.0)
    return row, angle, np.any(infinite, axis=-1).T


class Singular(NamedTuple):
    """Angles beside which samples may consist of rounding errors: the row of the design in its group, the angle
    [degree], and whether an arc ends there."""

    row: Array
    angle: Array
    ends_arc: Array

    def angles_of(self, designs: Array, chosen: Array) -> Array:
        """Return the chosen angles of some designs (design, nth) [degree], NaN for none."""
        place = np.flatnonzero(chosen & np.isin(self.row, designs))
        place = place[np.argsort(self.row[place], kind="stable")]
        own = np.searchsorted(designs, self.row[place])
        nth = np.arange(len(own)) - np.searchsorted(own, own)
        angles = np.full((len(designs), 1 + nth.max(initial=0)), np.nan)
        angles[own, nth] = self.angle[place]
        return angles


def singular_places(group: Group, signals: tuple[str, ...]) -> Singular:
    """Return the possible poles of these designs; and the ends of their arcs, unless the crank drives: forces are
    computed from those of a machine by its crank, which are unbounded there."""
    row, angle, _ = pole_candidates(group, signals)
    ends = arc_ends(group) if driven_elsewhere(group.scene) else ()
    toggles = np.concatenate(ends, axis=1) if ends else np.empty((len(group.designs), 0))
    design, which = np.nonzero(np.isfinite(toggles))
    ends_arc = np.repeat([False, True], [len(row), len(design)])
    return Singular(np.concatenate([row, design]), np.concatenate([angle, toggles[design, which]]), ends_arc)


def driven_elsewhere(scene: Scene) -> bool:
    """Return whether another part than the crank drives."""
    return scene.drive != scene.mechanism.defaults.get("drive", "")


def spoilt_peaks(
    group: Group, places: Singular, peaks: dict[str, tuple[Array, ...]], among: Array, threads: int | None = None
) -> Array:
    """Return which signals have peaks that consist of rounding errors, and close to which of these places (signal,
    place). `peaks` are the values and the angles [degree] of each signal's peaks, of which those `among` (signal,
    design) are looked at.

    Such a peak exceeds the parabola through three samples on one side, and the signal scatters there: where it rises,
    it does so smoothly. At the end of an arc it may be infinite, too.
    """
    signals, (value, at) = tuple(peaks), (np.stack(numbers) for numbers in zip(*peaks.values(), strict=True))
    row, angle, ends_arc = places
    away = signed_distance(angle, at[:, row], group.scene.period)

    def values_at(signal: Array, near: Array, beside: Array) -> Array:
        """Return one signal's values about one place each, at angles (each, row, step) beside it [degree]."""
        angles, values = angle[near, None, None] + beside, np.empty(beside.shape)
        for k in np.unique(signal):
            own = signal == k
            rows = np.repeat(row[near[own]], math.prod(beside.shape[1:]))
            values[own] = group.values((signals[k],), rows, angles[own].ravel(), threads).reshape(-1, *beside.shape[1:])
        return values

    close = (
        among[:, row] & (np.abs(away) < CLEAR) & (np.isfinite(value[:, row]) | (ends_arc & (value[:, row] == np.inf)))
    )
    signal, near = np.nonzero(close)
    with np.errstate(invalid="ignore"):
        reached = _reached(values_at(signal, near, np.tile(BESIDE_CLEAR, (len(near), 1, 1))))
        excess = value[signal, row[near]] - reached
    high = excess > 0.0
    signal, near, reached, excess = signal[high], near[high], reached[high], excess[high]
    least = np.where(excess < np.inf, np.spacing(np.maximum(angle[near], 1.0)), np.inf)
    scatters = _scatters(values_at(signal, near, _places_about(away[signal, near], least)), reached, excess)
    spoilt = np.zeros(close.shape, dtype=bool)
    spoilt[signal[scatters], near[scatters]] = True
    return spoilt


def signed_distance(poles: Array, angle: Array, period: float) -> Array:
    """Return how far angles lie from poles, the shorter way round [degree]."""
    distance = angle - poles
    return distance - period * np.round(distance / period)


def _reached(beside: Array) -> Array:
    """Return how high a signal may reach at a pole by the parabolas through its values (each, row, step) beside it."""
    first, second, third = np.moveaxis(beside, -1, 0)
    bend = first - 2.0 * second + third
    reached = np.fmax(first, first + (first - second) + bend) + np.abs(bend) + SPOILT * np.abs(first)
    return np.fmax.reduce(reached, axis=-1)


def _scatters(sampled: Array, reached: Array, excess: Array) -> Array:
    """Return whether samples (each, row, step) beside peaks scatter by as much as these exceed what is reached; where
    they are infinite, without having grown much from there before."""
    with np.errstate(invalid="ignore"):
        size = np.abs(sampled).max(axis=2)
        scatter = np.abs(np.diff(sampled, n=4))[..., 0]
        noisy = np.any(scatter > SCATTER * np.minimum(size, excess[:, None]), axis=1)
        smooth = (scatter < SMOOTH * size)[:, : 2 * DISTANCES].reshape(len(size), 2, DISTANCES)
        clear = np.logical_and.accumulate(smooth[..., ::-1], axis=2)[..., ::-1].reshape(len(size), 2 * DISTANCES)
        grown = np.where(clear, size[:, : 2 * DISTANCES], 0.0).max(axis=1) > GROWN * np.abs(reached)
    return noisy & ~(grown & (excess == np.inf))


def _places_about(away: Array, least: Array) -> Array:
    """Return places (each, row, step) beside singular places [degree]: on both sides at distances like those of finite
    peaks, at any of infinite ones, and from the peaks on; each row has five close to each other."""
    distance, finite = np.abs(away), least < np.inf
    nearest = np.where(distance > RESOLVED, 0.25 * distance, least)
    farthest = np.where(finite, 4.0 * np.maximum(distance, RESOLVED), CLEAR)
    nearest, least = np.where(finite, nearest, LEAST_OF_INFINITE), np.where(finite, least, 0.0)
    distances = np.geomspace(nearest, farthest, DISTANCES).T
    sides = np.concatenate([distances, -distances, away[:, None], away[:, None]], axis=1)
    forth = np.repeat([1.0, -1.0, 1.0, -1.0], [DISTANCES, DISTANCES, 1, 1])
    return sides[..., None] + (forth * np.maximum(STEP * np.abs(sides), least[:, None]))[..., None] * np.arange(5.0)


def clear_of(angles: Array, part: Part | None, period: float) -> Array:
    """Return the parts (start or end, nth, design) between angles (design, nth) [degree], NaN for none, and clear of
    them, of a part of the period or of all of it."""
    least = np.nanmin(angles, axis=1, keepdims=True)
    start, end = np.broadcast_arrays(*part, least)[:2] if part else (least + CLEAR, least + period - CLEAR)
    inside = np.sort(start + np.mod(angles - start, period), axis=1)
    inside[~(inside <= end)] = np.nan
    first, last = np.concatenate([start, inside + CLEAR], axis=1), np.concatenate([inside - CLEAR, end], axis=1)
    last = np.where(np.isnan(last) & np.isfinite(first), end, last)  # of the last part
    return np.stack([first.T, last.T])


def designs_with_candidates(scene: Scene, designs: Array, signals: tuple[str, ...]) -> Array:
    """Return those designs of a scene with closed forms that have possible poles."""
    row, *_ = pole_candidates(all_at_once(scene, designs), signals)
    return designs[np.unique(row)]


@singledispatch
def pole_candidates(group: Any, signals: tuple[str, ...]) -> Candidates:
    """Return the possible poles of these signals."""
    return concatenated([_singular(group, signals), _change_points(group)])


def concatenated(parts: list[Candidates]) -> Candidates:
    """Return all candidates in one."""
    row, angle, step = (np.concatenate(part) for part in zip(*parts, strict=True))
    return row, angle, step


def _grows_as_a_power(size: Array) -> Array:
    """Return whether sizes (…, step), the closest first, grow by the same factor each time the distance halves."""
    with np.errstate(all="ignore"):
        growth = size[..., :-1] / size[..., 1:]
    least, largest = growth.min(axis=-1), growth.max(axis=-1)
    return (least > LEAST_GROWTH) & (largest < EVENNESS * least)


def _singular_angles(findings: dict[str, Finding], kinds: Collection[str] = KINDS) -> list[Array]:
    """Return the dead centres and jams among findings in closed form [degree], several on a trailing axis."""
    return [findings[f"{KINDS[kind]}_angle"].values for kind in kinds if f"{KINDS[kind]}_angle" in findings]


def singular_angles(group: Group, signals: tuple[str, ...] = (), kinds: Collection[str] = KINDS) -> Array:
    """Return the dead centres and jams (design, nth) of designs, those of the output if it is among the signals."""
    scene = group.scene
    checks = scene.mechanism.driven_findings(scene.motion | {"drive": scene.drive})
    checks += scene.mechanism.output_findings() if _of_output(signals) else ()
    angles = [_singular_angles(findings(*map(group.number, numbers)), kinds) for findings, numbers in checks]
    return np.concatenate([*map(group.zeros, kinds), *chain(*angles)], axis=1)


def designs_without_jams(scene: Scene, designs: Array) -> Array:
    """Return those designs of a scene that friction jams nowhere, and whose drive stands still nowhere."""
    return designs[~np.isfinite(singular_angles(all_at_once(scene, designs))).any(axis=1)]


def _singular(group: Group, signals: tuple[str, ...], kinds: Collection[str] = KINDS) -> Candidates:
    """Return the dead centres and jams of these designs, or those of one kind."""
    angle = singular_angles(group, signals, kinds)
    row, which = np.nonzero(np.isfinite(angle))
    return row, angle[row, which], np.full(len(row), CLOSEST)


def _change_points(group: Group) -> Candidates:
    """Return the near-toggles of these designs that cannot be distinguished from toggles, with two distances each."""
    middle = group.number(group.scene.mechanism.near_toggle_angle)
    away, _ = group.near_toggles()
    which, row = np.nonzero(np.isfinite(away.T))
    angle = middle[row] + away[row, which]
    (status,) = group.values(("status",), row, angle)
    toggles = np.flatnonzero(status == TOGGLE)
    twice = np.repeat(toggles, len(CLOSEST_TO_TOGGLE))
    return row[twice], angle[twice], np.tile(CLOSEST_TO_TOGGLE, len(toggles))
