"""Find where designs close, of machines that have no closed form of it: arcs, toggles and near-toggles.

A part of a machine closes where its signals, its distances from a toggle, are positive. They are smooth functions of
the crank angle wherever the parts before it close, so the search for peaks finds all their extremes:

    least value < 0       two toggles, one on either side: between them the part does not close
    least value x > 0     a near-toggle; signal ≈ x + y·(θ − θ0)², zero at θ0 ± i·√(x/y): its half-width is √(x/y)

Parts are searched in the order in which they close, each on the arcs that those before leave, with samples that are
dense about the ends of these arcs and about near-toggles: pins move quickly there.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from linksweep.base.degrees import OFF_ROUND
from linksweep.engine.peaks.samples import GRADES, HALF, grades
from linksweep.engine.quantity import Limit
from linksweep.engine.run import Field
from linksweep.engine.trace.plan import plan
from linksweep.results.compute import compute, zeros_of
from linksweep.results.peak_search.between import EVERYWHERE, NEVER, PARTLY
from linksweep.results.peak_search.curves import SEAM, WIDE, Curves, Extremes, parabola, zeros_and_extremes
from linksweep.results.peak_search.side_by_side import close_at, search_side_by_side
from linksweep.scene.pairs import Array, by_row, different_designs, in_order, in_period, joined, some_of
from linksweep.scene.scene import Scene

AT_ONCE = 512
"""Designs searched together over one turn, so that the memory for it does not grow with a study."""
EVEN = 360
"""Even samples of a turn or an arc."""
NEAREST = 1e-11
"""Distance of the closest sample from the end of an arc, relative to its length."""
WIDTH_STEPS = 5
"""Steps towards the width of a near-toggle: each measures the curvature over the width of the last."""
SHORTEST = 1e-12
"""Length of an arc that rounding may leave between two toggles that are one [degree]."""
NO_TOGGLE = -1


class Arcs(NamedTuple):
    """Arcs on which designs close: row of the design, start and end [degree], and the part in a toggle at either."""

    row: Array
    start: Array
    end: Array
    start_part: Array
    end_part: Array

    @property
    def whole(self) -> Array:
        """True for each arc that is a whole period without a toggle."""
        return self.start_part == NO_TOGGLE


class NearToggles(NamedTuple):
    """Least distances from a zero: row of the design, angle [degree] and half-width, as tangent of half the angle."""

    row: Array
    angle: Array
    width: Array


NOWHERE = NearToggles(np.empty(0, dtype=int), np.empty(0), np.empty(0))


class Zeros(NamedTuple):
    """Zeros of signals where a design moves: row of the design, angle [degree] and part."""

    row: Array
    angle: Array
    part: Array


class Limits(NamedTuple):
    """Limits of designs as tables (design, nth), NaN where others have more; angles in degrees; zeros (design, part,
    nth) by part.

    Widths of near-toggles are tangents of half the angle, as the search grades its samples.
    """

    assembly: Array
    arc_start: Array
    arc_end: Array
    near_toggle: Array
    near_toggle_width: Array
    zeros: Array

    def zeros_of(self, limits: tuple[Limit, ...], kind: str) -> Array:
        """Return the zeros (design, nth) [degree] of one kind, of these limits."""
        parts = [k for k, limit in enumerate(limits) if limit.zeros == kind]
        return self.zeros[:, parts].reshape(len(self.zeros), len(parts) * self.zeros.shape[2])  # of no design, too


def assembly_of(scene: Scene) -> Field:
    """Return the assembly of each design: at every angle (0), at some (1) or at none (2)."""
    if scene.table.limits is not None:
        sizes, limits = limits_of(scene.unloaded)
        return Field(tuple(sizes), limits.assembly.reshape(tuple(sizes.values())))
    sampled, grid = scene.at_one_angle, scene.grid(1)
    if scene.bare.mechanism.closes_everywhere:
        return zeros_of("assembly", sampled, grid)
    return compute(sampled, grid, ("assembly",))["assembly"]


@lru_cache(maxsize=2)
def limits_of(unloaded: Scene) -> tuple[dict[str, int], Limits]:
    """Return the limits of designs, row-major over those dims that they depend on, with the dims' sizes."""
    limits = unloaded.table.limits or ()
    inputs = unloaded.at_one_angle.inputs
    dims = plan(unloaded.table, signals_of(limits), inputs.forms).loops
    sizes = {dim: n for dim, n in inputs.sizes.items() if dim in dims}
    return sizes, find_limits(unloaded, limits, different_designs(unloaded, signals_of(limits)))


def signals_of(limits: tuple[Limit, ...]) -> tuple[str, ...]:
    """Return the signals of all limits."""
    return tuple(name for limit in limits for name in limit.signals)


def find_limits(scene: Scene, limits: tuple[Limit, ...], designs: Array) -> Limits:
    """Search the limits of these designs of a mechanism alone, whose period is that of its motion."""
    rows, events, angle = search_side_by_side(scene, limits, designs)
    zeros = Zeros(events.row, angle, events.part)
    toggle = (events.width == 0.0) & np.array([limit.zeros == "toggle" for limit in limits] or [False])[events.part]
    arcs = _closed(scene, limits, designs, rows, some_of(zeros, toggle))
    near = some_of(NearToggles(events.row, angle, events.width), events.width > 0.0)
    some = [(arcs, near, some_of(zeros, (events.width == 0.0) & ~toggle))]
    others = np.setdiff1d(np.arange(len(designs)), rows, assume_unique=True)
    step = max(1, AT_ONCE // round(scene.period / scene.mechanism.period))
    some += [_search(scene, limits, designs, others[k : k + step]) for k in range(0, len(others), step)]
    arcs, near, zeros = map(joined, zip(*some, strict=True))
    zeros = joined([zeros, Zeros(arcs.row, arcs.start, arcs.start_part), Zeros(arcs.row, arcs.end, arcs.end_part)])
    return _tables(arcs, near, zeros, len(designs), len(limits), scene.period)


def _closed(scene: Scene, limits: tuple[Limit, ...], designs: Array, rows: Array, toggles: Zeros) -> Arcs:
    """Return the arcs between toggles, or whole turns, on which the designs in these rows close: there all signals are
    positive but for noise."""
    period, turning = scene.period, np.setdiff1d(rows, toggles.row)
    row, start, part = some_of(toggles, np.lexsort((in_period(toggles.angle, period), toggles.row)))
    start = in_period(start, period)
    first = np.flatnonzero(np.diff(row, prepend=-1))
    last = np.append(first[1:], len(row))[: len(first)] - 1
    end, end_part = np.roll(start, -1), np.roll(part, -1)
    end[last], end_part[last] = start[first] + period, part[first]
    zero, none = np.zeros(len(turning)), np.full(len(turning), NO_TOGGLE)
    arcs = joined([Arcs(turning, zero, zero + period, none, none), Arcs(row, start, end, part, end_part)])
    arcs = some_of(arcs, arcs.end - arcs.start > SHORTEST)
    return some_of(arcs, close_at(scene, limits, designs[arcs.row], 0.5 * (arcs.start + arcs.end)))


def _tables(arcs: Arcs, near: NearToggles, zeros: Zeros, designs: int, parts: int, period: float) -> Limits:
    """Return the limits of so many designs, of machines with so many parts, as tables."""
    arcs = some_of(arcs, np.lexsort((in_period(arcs.start, period), arcs.row)))
    start, count = in_period(arcs.start, period), np.bincount(arcs.row, minlength=designs)
    whole = np.bincount(arcs.row, arcs.whole, designs) > 0
    known = np.flatnonzero(zeros.part != NO_TOGGLE)
    angles = by_row((zeros.row * parts + zeros.part)[known], in_period(zeros.angle[known], period), designs * parts)
    return Limits(
        np.where(whole, EVERYWHERE, np.where(count > 0, PARTLY, NEVER)),
        by_row(arcs.row, start, designs),
        by_row(arcs.row, start + (arcs.end - arcs.start), designs),
        by_row(near.row, in_period(near.angle, period), designs),
        by_row(near.row, near.width, designs),
        np.sort(angles, axis=1).reshape(designs, parts, angles.shape[1]),
    )


# ------------------------------------------------------------------------------------- one part after the other


def _search(scene: Scene, limits: tuple[Limit, ...], every: Array, rows: Array) -> tuple[Arcs, NearToggles, Zeros]:
    """Return the arcs, near-toggles and zeros of the designs in these rows."""
    designs, count = every[rows], len(rows)
    none, zero = np.full(count, NO_TOGGLE), np.zeros(count)
    arcs = Arcs(np.arange(count), zero, zero + scene.period, none, none)
    near = NOWHERE
    zeros = [Zeros(*(np.empty(0, dtype=kind) for kind in (int, float, int)))]
    for part, limit in enumerate(limits):
        pieces, known = [some_of(arcs, np.empty(0, dtype=int))], [near]
        for turns in (True, False):
            own = some_of(arcs, np.flatnonzero(arcs.whole == turns))
            if not len(own.row):
                continue
            curves = Curves(scene, limit, designs[own.row], _places(own, near, count, turns, scene.period), turns)
            crossed, touched, near_toggles = _zeros(curves, own, part)
            known.append(near_toggles)
            pieces.append(_pieces(curves, own, crossed, part) if limit.zeros == "toggle" else own)
            zeros += [touched] if limit.zeros == "toggle" else [touched, crossed._replace(row=own.row[crossed.row])]
        arcs, near = joined(pieces), joined(known)
    inside = joined(zeros)
    return (
        arcs._replace(row=rows[arcs.row]),
        near._replace(row=rows[near.row]),
        inside._replace(row=rows[inside.row]),
    )


def _zeros(curves: Curves, arcs: Arcs, part: int) -> tuple[Zeros, Zeros, NearToggles]:
    """Return the zeros of curves, with the arc in place of the design, then those that they touch, and near-toggles."""
    curve, angle, turning = zeros_and_extremes(curves)
    height = turning.height
    angle = in_period(angle, curves.scene.period) if curves.turns else angle  # the last samples repeat the first
    closes = (turning.sign > 0.0) | (curves.limit.zeros != "toggle")
    unbounded = curves.limit.zeros != "jump"
    near = _near_toggles(curves, arcs, turning.some(closes & (height >= -turning.noise) & unbounded))
    least = turning.some(closes & (np.abs(height) <= turning.noise))
    row = arcs.row[curves.arc(least.curve)]
    touched = Zeros(row, least.x[1], np.full(len(row), part))
    return Zeros(curves.arc(curve), angle, np.full(len(curve), part)), touched, near


def _near_toggles(curves: Curves, arcs: Arcs, least: Extremes) -> NearToggles:
    """Return the narrow ones of least distances from zero as near-toggles."""
    angle, value = least.x[1], least.height
    depth = np.maximum(value, least.noise)
    with np.errstate(all="ignore"):
        width = np.nan_to_num(np.sqrt(depth / parabola(least)[1]), nan=WIDE)  # noise may bend it the other way
        for _ in range(WIDTH_STEPS):
            step = np.degrees(np.clip(width, 1e-9, WIDE))
            before, after = (least.sign * curves.at(least.curve, angle + away)[0] - value for away in (-step, step))
            rise = np.fmax(0.5 * (before + after), np.fmin(before, after))  # the end of an arc may be nearer
            width = np.where(rise > 0.0, np.sqrt(depth / rise) * np.radians(step), width)
    narrow = np.flatnonzero(width < WIDE)
    return NearToggles(arcs.row[curves.arc(least.curve[narrow])], angle[narrow], np.tan(0.5 * width[narrow]))


def _pieces(curves: Curves, arcs: Arcs, toggles: Zeros, part: int) -> Arcs:
    """Return the pieces of arcs, cut at the toggles of a part, on which all its signals are positive but for noise."""
    arc, angle, _ = toggles
    wraps = (np.bincount(arc, minlength=len(arcs.row)) > 0) & curves.turns
    first = np.full(len(wraps), np.inf)
    np.minimum.at(first, arc, angle)
    end, end_part = np.where(wraps, first + curves.scene.period, arcs.end), np.where(wraps, part, arcs.end_part)
    starts = np.flatnonzero(~wraps)
    owner = np.concatenate([arc, starts, np.arange(len(wraps))])
    x = np.concatenate([angle, arcs.start[starts], end])
    parts = np.concatenate([np.full(len(arc), part), arcs.start_part[starts], end_part])
    order = np.lexsort((x, owner))
    owner, x, parts = owner[order], x[order], parts[order]
    k = np.flatnonzero((owner[1:] == owner[:-1]) & (np.diff(x) > SHORTEST))
    values, noise = curves.on_arcs(owner[k], 0.5 * (x[k] + x[k + 1]))
    k = k[(values >= -noise).all(axis=0)]
    return Arcs(arcs.row[owner[k]], x[k], x[k + 1], parts[k], parts[k + 1])


# --------------------------------------------------------------------------------------------------- samples


def _places(arcs: Arcs, near: NearToggles, designs: int, turns: bool, period: float) -> Array:
    """Return the places (arc, sample) [degree] of samples: even ones, and dense ones about near-toggles and ends."""
    angle, width = (by_row(near.row, numbers, designs)[arcs.row] for numbers in (near.angle, near.width))
    graded = graded_samples(angle, width)
    return on_turns(graded, period) if turns else on_arcs(arcs.start, arcs.end, graded, period)


def on_turns(dense: Array, period: float) -> Array:
    """Return places (arc, sample) [degree] on whole periods: even ones, these, and the first ones again at the end."""
    count = EVEN * round(period / 360.0)
    even = np.broadcast_to((np.arange(count) + OFF_ROUND) * (period / count), (len(dense), count))
    x = in_order(np.concatenate([even, in_period(dense, period)], axis=1))
    return np.concatenate([x, x[:, :SEAM] + period], axis=1)


def on_arcs(start: Array, end: Array, dense: Array, period: float) -> Array:
    """Return places (arc, sample) [degree] on arcs: even ones, dense ones about the ends, and those of these on the
    arc."""
    count = EVEN * round(period / 360.0)
    start, length = start[:, None], (end - start)[:, None]
    along = in_period(dense - start, period) / length
    even = 0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / count)
    ends = NEAREST * 2.0 ** np.arange(np.log2(even[0] / NEAREST))
    shared = np.broadcast_to(np.concatenate([ends, even, 1.0 - ends]), (len(dense), count + 2 * len(ends)))
    return start + length * in_order(np.concatenate([shared, np.where(along < 1.0, along, np.nan)], axis=1))


def graded_samples(angles: Array, widths: Array, half: int = HALF) -> Array:
    """Return samples (design, sample) [degree] graded about near-toggles (design, nth) by their widths, so many on
    either side of each."""
    scale = np.frexp(np.nan_to_num(np.maximum(widths, 1e-30), nan=1.0))[1]
    after = 2.0 * np.degrees(np.arctan(grades(half)))[np.clip(1 - scale, 0, GRADES - 1)]
    steps = np.concatenate([-after[..., :0:-1], after[..., :-1]], axis=-1)
    return (angles[..., None] + steps).reshape(len(angles), angles.shape[1] * steps.shape[2])
