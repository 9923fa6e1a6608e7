"""Make paths along arcs: the crank angles between two toggles, over which a design moves that makes no full turn.

The parameter of a path along an arc is x from −π/2 to π/2, with θ2 = middle + half·sin x. Near a toggle quantities vary
as the square root of the angle that remains up to it; as functions of x they are smooth.
"""

from __future__ import annotations

import math
from functools import singledispatch
from typing import Any

import numpy as np

from linksweep.base.degrees import signed_distance
from linksweep.results.peak_search.approaches import approaches
from linksweep.results.peak_search.between import EVERYWHERE
from linksweep.results.peak_search.groups import Group
from linksweep.results.peak_search.paths import (
    ASIDE,
    QUARTER,
    Part,
    Paths,
    approach_samples,
    beside_breaks,
    both_sides,
    jump_angles,
    kinks,
    near_toggle_samples,
    over_whole_period,
    thinned,
    windows_about,
)
from linksweep.scene.curves.quick import STEP
from linksweep.scene.pairs import Array, in_order, with_repeated
from linksweep.scene.scene import Scene

PER_ARC = 192
"""Even samples of an arc, in x."""
NEAREST = 1e-5
"""Distance in x from the end of an arc within which rounding errors exceed any rise left to find."""
SAME = 2e-13
"""Difference of two angles of an arc, relative to half of it, from which on they differ by more than rounding."""
NEIGHBOURS = np.array([-1.0, 0.0, 1.0])
"""Periods of the motion away from the nearest one in which an arc may still reach into a piece."""
LONGEST_PIECE = 180.0
"""Longest piece of a part that one path follows [degree]."""

Parts = tuple[Array, Array]
"""A part of each design: first and last angles [degree], NaN for none."""


@singledispatch
def arc_ends(group: Any) -> tuple[Array, ...]:
    """Return the starts and the ends (design, arc) of each design's arcs [degree]; () for a machine without arcs."""
    if group.limits is not None:
        return group.limits.arc_start, group.limits.arc_end
    for findings, numbers in group.scene.mechanism.findings():
        checks = findings(*map(group.number, numbers))
        if "arc_start" in checks:
            return checks["arc_start"].values, checks["arc_end"].values
    return ()


def arcs(group: Group) -> Paths:
    """Return the arcs on which each design can be assembled, one or two a turn, without those on which no sample is
    ok."""
    return _along(group, arc_ends_of_whole_period(group), arc_ends(group))


def arc_ends_of_whole_period(group: Group) -> tuple[Array, ...]:
    """Return the `arc_ends` of the whole period: loads may take several turns."""
    return tuple(over_whole_period(group, ends) for ends in arc_ends(group))


def arcs_within(part: Part | Parts, group: Group, pieces: int = 1) -> Paths:
    """Return the arcs or turns of each design between two angles [degree], or those of its own part, in this number
    of equal pieces at least."""
    whole = group.assembly()[:, None] == EVERYWHERE  # the ends of its turns are no toggles
    toggles = tuple(np.where(whole, np.nan, ends) for ends in arc_ends(group))
    none = (np.full((len(group.designs), 1), np.nan),) * 2
    return _along(group, _pieces(group, part, toggles, pieces), toggles or none, closely=True)


def about_approaches_on_arcs(group: Group) -> Paths:
    """Return a window about every closest approach on the arcs of each design."""
    row, middle, half = _middles(arc_ends_of_whole_period(group))
    close = approaches(group.some(row), _angles(middle, half, _even(group)), ends_meet=False)
    return windows_about(close._replace(row=row[close.row]))


def _middles(ends: tuple[Array, ...]) -> tuple[Array, Array, Array]:
    """Return the design, the middle and the half length [degree] of each arc between starts and ends (design, arc)."""
    first, last = ends
    row, which = np.nonzero(np.isfinite(first))
    return row, 0.5 * (first + last)[row, which], 0.5 * (last - first)[row, which]


def _angles(middle: Array, half: Array, x: Array) -> Array:
    """Return θ2 (path, place) [degree] at the same places x of all arcs."""
    return middle[:, None] + half[:, None] * np.sin(x)


def _along(group: Group, ends: tuple[Array, ...], toggles: tuple[Array, ...], closely: bool = False) -> Paths:
    """Return paths between starts and ends (design, path); `closely` samples closest approaches, too."""
    row, middle, half = _middles(ends)
    at_jumps = jump_angles(group)[row]
    x, cuts = _samples_and_cuts(group.some(row), middle, half, at_jumps, closely)
    before, after = np.roll(x, 1, axis=1), np.roll(x, -1, axis=1)
    before[:, 0], after[:, -1] = x[:, 0] - 0.01 * NEAREST, x[:, -1] + 0.01 * NEAREST
    near = np.empty((len(row), 0)) if group.limits is None else group.limits.near_toggle[row]
    singular = np.concatenate([toggles[0][row], toggles[1][row], near], axis=1)
    steps = steps_at_ends(singular, middle, half, group.scene.period_of_motion)
    paths = Paths(row, x, before, after, cuts, middle, half, steps, ends="stop")
    return paths.some(_ok_somewhere(group, paths))


def _pieces(group: Group, part: Part | Parts, toggles: tuple[Array, ...], pieces: int) -> tuple[Array, ...]:
    """Return starts and ends (design, piece) of a part, where a design can be assembled [degree]; NaN for no piece."""
    first, last = (np.broadcast_to(edge, len(group.designs)) for edge in part)
    longest = np.fmax.reduce(last - first, initial=LONGEST_PIECE)
    pieces *= math.ceil(longest / (pieces * LONGEST_PIECE))
    edges = np.linspace(first, last, 1 + pieces, axis=-1)[:, None, :, None]
    kind = group.assembly()
    whole = (kind[:, None] == EVERYWHERE) | (not toggles)
    period = group.scene.period_of_motion
    turn = [np.where(whole, ends, np.nan) for ends in (0.0, period)]
    arcs = toggles or np.full((2, *whole.shape), np.nan)
    start, end = (np.concatenate(ends, axis=1)[..., None, None] for ends in zip(turn, arcs, strict=True))
    away = period * (np.round((edges[:, :, :-1] - start) / period) + NEIGHBOURS)
    first, last = np.maximum(start + away, edges[:, :, :-1]), np.minimum(end + away, edges[:, :, 1:])
    return tuple(np.where(first < last, ends, np.nan).reshape(len(kind), -1) for ends in (first, last))


def _ok_somewhere(group: Group, paths: Paths) -> Array:
    """Return whether any sample of each path is ok; every 64th sample shows that for most paths."""
    ok = np.zeros(len(paths.row), dtype=bool)
    for some in (paths.x[:, 8::64], paths.x):
        path = np.repeat(np.flatnonzero(~ok), some.shape[1])
        (status,) = group.values(("status",), paths.row[path], paths.angles(path, some[~ok].ravel()))
        ok[~ok] = (status.reshape(-1, some.shape[1]) == 0.0).any(axis=1)
        if ok.all():
            break
    return ok


# ---------------------------------------------------------------------------------------- samples and cuts


def _samples_and_cuts(group: Group, middle: Array, half: Array, at_jumps: Array, closely: bool) -> tuple[Array, Array]:
    """Return samples and cuts in x of arcs, one arc for each row of the group and of the angles (arc, jump) of jumps.

    Samples are even, and dense towards both ends, about near-toggles that the arc passes, beside breaks and, `closely`,
    about closest approaches.
    """
    even, period = _even(group), group.scene.period_of_motion
    near = QUARTER - NEAREST * 2.0 ** np.arange(0.0, np.log2(np.pi / len(even) / NEAREST), 0.5)
    shared = np.broadcast_to(np.concatenate([even, near, -near]), (len(middle), len(even) + 2 * len(near)))
    breaks = np.concatenate([at_jumps, kinks(group)], axis=1)
    special = near_toggle_samples(group), beside_breaks(breaks), both_sides(at_jumps)
    graded, sides, jumps = (_on_arc(angles, middle, half, period) for angles in special)
    quick = _on_arc(_quick_and_even(group), middle, half, period)
    close = _on_arc(approach_samples(group, _angles(middle, half, even)), middle, half, period)
    samples = [shared, graded, sides, quick, *([close] if closely else [])]
    # no cuts near the ends: a quantity that has a mean is smooth there, and rounding spoils samples nearer to them
    shared = np.broadcast_to(np.concatenate([[-QUARTER], even[4::8], [QUARTER]]), (len(middle), len(even) // 8 + 2))
    cuts = [shared, graded[:, ::2], jumps, close[:, ::7], thinned(quick)]
    return _once(in_order(np.concatenate(samples, axis=1))), in_order(np.concatenate(cuts, axis=1))


def _once(x: Array) -> Array:
    """Return samples (arc, sample) in order, those made equal whose angles differ by rounding: between several so close
    the highest is one of rounding, and its neighbours hide a summit beyond them."""
    return with_repeated(x, np.diff(np.sin(x), axis=1, prepend=-np.inf) < SAME)


def _quick_and_even(group: Group) -> Array:
    """Return angles (design, angle) at which loads over the angle change quickly, and even ones for slower changes."""
    changes = group.scene.at_one_angle is not group.scene
    angles = np.append(group.quick, np.arange(0.0, group.scene.period, STEP)) if changes else group.quick
    return np.broadcast_to(angles, (len(group.designs), len(angles)))


def _even(group: Group) -> Array:
    count = PER_ARC * round(group.scene.period_of_motion / group.scene.mechanism.period)
    return (np.arange(count) + 0.5) * (np.pi / count) - QUARTER


def _on_arc(angles: Array, middle: Array, half: Array, period: float) -> Array:
    """Return x of angles on arcs; NaN for angles beyond an arc, or within NEAREST of its end."""
    with np.errstate(invalid="ignore", divide="ignore"):  # an angle beyond the arc, or an arc of no length
        x = np.arcsin(signed_distance(angles, middle[:, None], period) / half[:, None])
    return np.where(np.abs(x) < QUARTER - NEAREST, x, np.nan)


def steps_at_ends(toggles: Array, middle: Array, half: Array, period: float) -> Array:
    """Return steps (path, end) for extrapolation to the ends, small against the distance in x to the next toggle or
    near-toggle.

    The step is 0 at an end that is no toggle: there a signal has a value, and needs no extrapolation.
    """
    own = np.stack([middle - half, middle + half], axis=1)
    distances = np.abs(signed_distance(own[:, :, None], toggles[:, None, :], period))
    distances = np.sort(np.nan_to_num(distances, nan=0.5 * period), axis=-1)  # the least is the end itself
    steps = np.clip(0.01 * np.sqrt(2.0 * distances[:, :, 1] / np.maximum(half[:, None], 1e-300)), 1e-6, 0.004)
    return np.where(distances[:, :, 0] < ASIDE, steps, 0.0)


# -------------------------------------------------------------------------------------------- integrals of a part


def within(paths: Paths, part: Part, scene: Scene) -> Paths:
    """Return turns or arcs of a scene with their cuts clipped to lie between two angles [degree]; samples stay as they
    are."""
    first, last = part
    if paths.middle is None:
        start = paths.cuts[:, :1] + np.mod(first - paths.cuts[:, :1], scene.period)
        twice = np.concatenate([paths.cuts, paths.cuts[:, 1:] + scene.period], axis=1)
        return paths._replace(cuts=np.clip(twice, start, start + (last - first)))
    period = scene.period
    nearest, reach = np.round((0.5 * (first + last) - paths.middle) / period), 1 + int((last - first) // (2.0 * period))
    away = np.arange(-reach, reach + 1.0)  # periods from the part's middle in which an arc may still lie in the part
    copies = paths.some(np.tile(np.arange(len(paths.row)), len(away)))
    middle = copies.middle + period * (np.tile(nearest, len(away)) + np.repeat(away, len(paths.row)))
    ends = (np.arcsin(np.clip((end - middle) / copies.half, -1.0, 1.0))[:, None] for end in part)
    return copies._replace(middle=middle, cuts=np.clip(copies.cuts, *ends))
