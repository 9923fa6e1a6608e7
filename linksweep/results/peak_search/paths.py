"""Make paths through the crank angles of designs, for searches that the fused one does not cover, and for integrals.

The parameter of a path over a whole turn is the crank angle [degree]: even samples, denser ones about near-toggles by
their width, and both sides of every jump and kink. Windows are short paths about jumps, kinks and closest approaches.
Arcs between toggles: `linksweep.results.peak_search.arcs`.
"""

from __future__ import annotations

import math
from functools import singledispatch
from typing import Any, NamedTuple

import numpy as np

from linksweep.base.degrees import OFF_ROUND, signed_distance
from linksweep.engine.peaks.samples import HALF
from linksweep.engine.roots import roots
from linksweep.results.peak_search.approaches import (
    NARROW_NEAR_TOGGLE,
    REACH,
    Approaches,
    approaches,
    approaches_of_turns,
)
from linksweep.results.peak_search.between import driven_elsewhere
from linksweep.results.peak_search.friction.contacts import contact_angles
from linksweep.results.peak_search.groups import Group
from linksweep.results.peak_search.limits import graded_samples
from linksweep.scene.pairs import Array, by_row, in_order, in_period, joined, with_repeated
from linksweep.scene.scene import Scene

PER_TURN = 720
"""Even samples of a turn: loads over the angle may vary as quickly as an engine's indicator diagram."""
EVEN_STEP = 3.0
"""Step of even samples beside those about near-toggles that are not opposite to each other [degree]."""
MERGED = 1e-3
"""Distance between samples, relative to that of the next ones, below which they become one."""
ASIDE = 1e-9
"""Distance from a jump at which its one-sided limits are taken [degree]."""
BESIDE = np.array([ASIDE, 1e-3, 0.01, 0.1, 0.3, 1.0, 2.0, 4.0, 7.0, 11.0, 16.0, 22.0, 30.0])
"""Distances from a break of the samples on either side, far enough to reach those of the fused search [degree]."""
AT_JUMP = 0.1 * ASIDE
"""Distance from a jump within which an angle is at it, or samples are one [degree]."""
FARTHER_ASIDE = 1e-4, 0.01
"""Distances from a break of more samples: of summits on both sides of a kink, its own sides would show one [degree]."""
CLOSE_BESIDE = np.array([1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1.0])
"""Distances from a break of the samples of a window on either side, up to those of a turn [degree]."""
SHORT_LAP, PER_LAP = 30.0, 12
"""Length of a lap that ends early [degree] below which samples of a turn may lie too far apart, and its own samples."""
KINK_STEPS = 3
"""Steps of the false position towards a kink between two samples: a search finds it from there."""
MOST_CUTS = 200
"""Cuts at which a load or speed over the angle changes quickly: more do not help a mean."""
QUARTER = 0.5 * np.pi
JUMPS = ("jump", "wedge", "dead_centre")
"""Kinds of zeros at which a quantity may jump."""

Part = tuple[float, float]
"""First and last crank angle [degree] of a machine that moves over part of a turn."""


class Paths(NamedTuple):
    """Paths of designs, each stated by its row in a group: samples to search, and cuts between which to integrate.

    `x` are the samples (path, sample), `before` and `after` their neighbours, `cuts` (path, cut) the ends of smooth
    pieces. On a turn x is the angle [degree]; on an arc θ2 = middle + half·sin x, and `steps` (path, end) are those by
    which limits at its ends are extrapolated, 0 at an end that is no toggle.

    `ends` states how signals continue at the ends of a path: "meet" on a turn (the first follows the
    last), "stop" on an arc, "pass" (they continue beyond) in a window.
    """

    row: Array
    x: Array
    before: Array
    after: Array
    cuts: Array
    middle: Any = None
    half: Any = None
    steps: Any = None
    ends: str = "meet"

    def some(self, which: Array) -> Paths:
        """Return the paths in these rows."""
        picked = {name: numbers[which] for name, numbers in self._asdict().items() if isinstance(numbers, np.ndarray)}
        return self._replace(**picked)

    def angles(self, path: Array, x: Array) -> Array:
        """Return θ2 [degree] at places x of these paths."""
        return x if self.middle is None or self.half is None else self.middle[path] + self.half[path] * np.sin(x)

    def stretch(self, path: Array, x: Array) -> Array:
        """Return dθ2/dx at places x of these paths, in units that may differ from path to path."""
        return np.ones(x.shape) if self.half is None else self.half[path] * np.cos(x)


# -------------------------------------------------------------------------------------------------- turns


@singledispatch
def turns(group: Any) -> Paths:
    """Return the whole period of each design as a path."""
    period, turn = group.scene.period, group.scene.mechanism.period
    even = (np.arange(PER_TURN * round(period / turn)) + OFF_ROUND) * (turn / PER_TURN)
    even, quick = (np.broadcast_to(angles, (len(group.designs), len(angles))) for angles in (even, group.quick))
    graded = _graded_over_period(group)
    at_jumps = jump_angles(group)
    sides, jumps = beside_breaks(np.concatenate([at_jumps, kinks(group)], axis=1)), both_sides(at_jumps)
    close = approach_samples(group)[:, ::7]
    # a piece between cuts has 15 nodes of its own: it needs fewer cuts than a search needs samples
    samples, edges = (
        (even, graded, sides, quick),
        (even[:, ::30], _graded_over_period(group, 2), jumps, close, thinned(quick)),
    )
    x, cuts = (in_order(in_period(np.concatenate(parts, axis=1), period)) for parts in (samples, edges))
    x = distinct(x, AT_JUMP)
    before, after = neighbours(x, period)
    cuts = np.concatenate([cuts, cuts[:, :1] + period], axis=1)
    return Paths(np.arange(len(x)), x, before, after, cuts)


def short_laps(group: Group) -> Paths:
    """Return a path along each lap that ends soon, to one sample beyond its end."""
    fields = group.scene.inputs.fields
    end = np.degrees(np.min([group.number(fields[name]) for name in group.scene.mechanism.lap_ends], axis=0))
    (row,) = np.nonzero((end > 0.0) & (end < SHORT_LAP))
    step = end[row, None] / PER_LAP
    x = step * np.arange(PER_LAP + 2)
    return Paths(row, x, x - step, x + step, x, ends="stop")


def search_samples(group: Group) -> Array:
    """Return the samples (design, sample) of the whole period of a search, also those about closest approaches, in
    order [degree]; some repeat."""
    return in_order(in_period(np.concatenate([turns(group).x, approach_samples(group)], axis=1), group.scene.period))


def thinned(angles: Array) -> Array:
    """Return every n-th angle (design, angle), with n such that about MOST_CUTS are left at most."""
    return angles[:, :: 1 + angles.shape[1] // MOST_CUTS]


def neighbours(x: Array, period: float) -> tuple[Array, Array]:
    """Return the samples before and after each one of a path whose ends meet after a period."""
    before, after = np.roll(x, 1, axis=1), np.roll(x, -1, axis=1)
    before[:, 0] -= period
    after[:, -1] += period
    return before, after


# -------------------------------------------------------------- near-toggles, jumps, kinks, closest approaches


def near_toggle_samples(group: Group) -> Array:
    """Return samples (design, sample) of one period of the motion [degree], graded about near-toggles."""
    middle = group.number(group.scene.mechanism.near_toggle_angle)
    half = 2 * HALF if driven_elsewhere(group.scene) else HALF  # forces over the rate of another drive vary more
    samples = middle[:, None] + graded_samples(*group.near_toggles(), half)
    if group.limits is None:
        return samples
    even = np.arange(OFF_ROUND, group.scene.period_of_motion, EVEN_STEP)
    even = np.broadcast_to(even, (len(samples), len(even)))
    return _merged(np.sort(np.concatenate([samples, even], axis=1), axis=1))  # near-toggles may be few, or on one side


def _merged(x: Array) -> Array:
    """Return places (path, place) in order, those made equal that lie far closer to each other than to the next ones.

    Near-toggles of several parts may be one but for rounding; between samples so close a signal shows no slope.
    """
    gap = np.diff(x, axis=1, prepend=x[:, :1], append=x[:, -1:])
    with np.errstate(invalid="ignore"):
        close = gap[:, 1:-1] < MERGED * np.fmax(gap[:, :-2], gap[:, 2:])
    return with_repeated(x, np.pad(close, ((0, 0), (1, 0))))


def _graded_over_period(group: Group, step: int = 1) -> Array:
    """Return the samples (design, sample) about the near-toggles of the whole period [degree], in order: all, or one of
    each `step` in a period of the motion."""
    one = np.sort(in_period(near_toggle_samples(group), group.scene.period_of_motion), axis=1)
    return np.concatenate([in_order(one[:, ::step]) + start for start in starts_of_motion(group)], axis=1)


def starts_of_motion(group: Group) -> Array:
    """Return the angles [degree] at which the motion begins anew within the whole period."""
    period = group.scene.period_of_motion
    return period * np.arange(round(group.scene.period / period))


def over_whole_period(group: Group, angles: Array) -> Array:
    """Return angles (design, nth) [degree] of one period of the motion, and those of all others of the whole period."""
    return np.concatenate([angles + start for start in starts_of_motion(group)], axis=1)


def both_sides(angles: Array, away: float = ASIDE) -> Array:
    """Return the angles (design, side) just before and just after each of these."""
    return np.concatenate([angles - away, angles + away], axis=1)


def beside_breaks(breaks: Array) -> Array:
    """Return samples (design, sample) on both sides of each break [degree]."""
    return np.concatenate([both_sides(breaks, away) for away in (ASIDE, *FARTHER_ASIDE)], axis=1)


def breaks_of(group: Group) -> Array:
    """Return the angles (design, break) of jumps and kinks [degree]."""
    return np.concatenate([jump_angles(group), kinks(group)], axis=1)


def may_hide_summits(scene: Scene) -> bool:
    """Return whether samples beside breaks may hide summits close by, of rounding errors or on the lower side of a
    jump: unless the crank drives at a steady speed."""
    return driven_elsewhere(scene) or scene.changes_speed


def kinks(group: Group) -> Array:
    """Return the angles (design, kink) of kinks, nearly: too inexact to cut an integral at."""
    changes = [_changes_of_sign(group, name) for name in group.scene.mechanism.kinks()]
    return np.concatenate([np.empty((len(group.designs), 0)), *changes], axis=1)


def jump_angles(group: Group) -> Array:
    """Return the jumps (design, jump) of the whole period [degree], and the angles at which friction begins to jam and
    contacts bear nothing; NaN where others have more."""
    located = [group.zeros(kind) + start for kind in JUMPS for start in starts_of_motion(group)]
    located += [jam + start for jam in _jam_angles(group) for start in _turns(group)]
    jumps = np.concatenate([listed_jumps(group), *located], axis=1)
    return distinct(np.concatenate([jumps, contact_angles(group, both_sides(jumps))], axis=1))


@singledispatch
def reversals(group: Any) -> Array:
    """Return the angles (design, nth) [degree] of the whole period at which slides with friction turn round.

    There alone a slide has no friction, though a load that jumps with it may be on: forces that neither side has.
    """
    scene, none = group.scene, np.empty((len(group.designs), 0))
    if not scene.mechanism.rubs:
        return none
    known = [group.number(jump)[:, None] + _turns(group) for jump in scene.mechanism.jumps()]
    return np.concatenate([none, *known, over_whole_period(group, group.zeros("jump"))], axis=1)


def moved_aside(angles: Array, jump: Array, period: float) -> Array:
    """Return angles [degree] with each that is at its jump moved to the nearer side."""
    away = signed_distance(angles, jump, period)
    return np.where(np.abs(away) < AT_JUMP, angles - away + np.copysign(AT_JUMP, away), angles)


def listed_jumps(group: Group) -> Array:
    """Return the jumps (design, jump) of the whole period that the scene lists [degree]."""
    angles = [group.number(jump)[:, None] + _turns(group) for jump in group.scene.jumps()]
    return np.concatenate([np.empty((len(group.designs), 0)), *angles], axis=1)


def _turns(group: Group) -> Array:
    """Return the angles [degree] at which the turns of the whole period begin."""
    return np.arange(0.0, group.scene.period, group.scene.mechanism.period)


def _jam_angles(group: Group) -> list[Array]:
    """Return the angles (design, jam) [degree] at which friction begins to jam a machine, where they have closed forms:
    a force may have a limit there."""
    scene = group.scene
    checks = scene.mechanism.driven_findings(scene.motion | {"drive": scene.drive}) if scene.mechanism.rubs else ()
    angles_of = [findings(*map(group.number, numbers)) for findings, numbers in checks]
    return [angles["jam_angle"].values for angles in angles_of if "jam_angle" in angles]


def distinct(angles: Array, least: float = ASIDE) -> Array:
    """Return angles (design, nth) in order, those made equal that differ by rounding, as where two slides turn round
    together: between samples so close a signal shows no slope. `least` is the least difference of others."""
    x = np.sort(angles, axis=1)
    return with_repeated(x, np.diff(x, axis=1, prepend=-np.inf) < least)


def _changes_of_sign(group: Group, name: str) -> Array:
    """Return angles (design, change) at which a quantity changes sign between samples; NaN where others have more."""
    angles = _graded_over_period(group)
    designs, count = angles.shape
    (values,) = group.values((name,), np.repeat(np.arange(designs), count), angles.ravel())
    values = values.reshape(angles.shape)
    following = np.roll(values, -1, axis=1)
    row, before = np.nonzero((values < 0.0) & (following > 0.0) | (values > 0.0) & (following < 0.0))
    start = angles[row, before]
    end = start + np.mod(angles[row, (before + 1) % count] - start, group.scene.period)
    heights = np.stack([values[row, before], following[row, before]])
    return by_row(row, roots(group.of(name, row), np.stack([start, end]), heights, KINK_STEPS), designs)


def approach_samples(group: Group, angles: Array | None = None) -> Array:
    """Return samples (design, sample) about closest approaches [degree]; NaN where other designs have more.

    Approaches are those of the whole period, or those between the first and last of angles (design, angle) [degree].
    """
    designs = len(group.designs)
    if not group.scene.approaches():
        return np.empty((designs, 0))
    close = _approaches(group) if angles is None else approaches(group, angles, ends_meet=False)
    close_by = by_row(close.row, close.samples(), designs)
    return close_by.reshape(designs, math.prod(close_by.shape[1:]))  # of no design, too


def _approaches(group: Group) -> Approaches:
    """Return the closest approaches of the whole period, beside narrow near-toggles between graded samples."""
    narrow = np.flatnonzero((group.near_toggles()[1] < NARROW_NEAR_TOGGLE).any(axis=1))
    if not len(narrow):
        return approaches_of_turns(group)
    graded = approaches(group.some(narrow), _graded_over_period(group.some(narrow)))
    return joined([approaches_of_turns(group), graded._replace(row=narrow[graded.row])])


# ------------------------------------------------------------------------------------------------ windows


def about_breaks(group: Group) -> Paths:
    """Return a window about every break of each design, wide enough to reach the samples of the fused search."""
    angles = breaks_of(group)
    row = np.repeat(np.arange(len(angles)), angles.shape[1])
    return _windows(row, np.nan_to_num(angles).reshape(-1, 1) + np.concatenate([-BESIDE[::-1], BESIDE]), BESIDE[-1])


def windows_beside(group: Group, breaks: Array, part: Part | None) -> Paths:
    """Return a window on either side of every break (design, break) [degree], clear of the break, where the design
    moves; those inside a part, if there is one."""
    row, nth = np.nonzero(np.isfinite(breaks))
    steps = np.stack([-CLOSE_BESIDE[::-1], CLOSE_BESIDE])
    x = (breaks[row, nth, None, None] + steps).reshape(-1, len(CLOSE_BESIDE))
    row = np.repeat(row, len(steps))
    (status,) = group.values(("status",), np.repeat(row, x.shape[1]), x.ravel())
    inside = status.reshape(x.shape) == 0.0
    if part is not None:
        inside &= in_period(x - part[0], group.scene.period) <= part[1] - part[0]
    return _windows(row, x, CLOSE_BESIDE[-1]).some(np.flatnonzero(inside.all(axis=1)))


@singledispatch
def about_approaches(group: Any) -> Paths:
    """Return a window about every closest approach of the ends of a spring or damper of each design."""
    return windows_about(_approaches(group))


def windows_about(close: Approaches) -> Paths:
    """Return a window about each closest approach."""
    return _windows(close.row, close.samples(), REACH)


def _windows(row: Array, x: Array, reach: float) -> Paths:
    before, after = neighbours(x, 2.0 * reach + 1.0)
    return Paths(row, x, before, after, x, ends="pass")
