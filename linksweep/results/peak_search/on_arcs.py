"""Search for peaks on arcs between toggles, at which signals grow without bound or have limits.

Each arc is searched piece by piece. Two pieces begin beside its toggles, with samples that are dense down to rounding:
there quantities vary as the root of the angle that remains, so that they are smooth along the piece, whatever lies just
beyond the toggle. Limits are those of polynomials of that root.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linksweep.engine.peaks.samples import HALF
from linksweep.engine.quantity import LAST_UNJAMMED
from linksweep.results.peak_search.along_paths import (
    GROWTH,
    OF_PEAK,
    Best,
    SignalPeak,
    angle_in_period,
    raise_to,
)
from linksweep.results.peak_search.arcs import NEAREST, arc_ends, steps_at_ends
from linksweep.results.peak_search.between import driven_elsewhere
from linksweep.results.peak_search.groups import Group, groups
from linksweep.results.peak_search.paths import distinct
from linksweep.results.peak_search.pieces import (
    AT_ONCE,
    BEYOND,
    BORDERS,
    CHANGING_AT_ONCE,
    Pieces,
    between,
    breaks_and_near_toggles,
    cut_at_kinks,
    highest_on_pieces,
    known_on_pieces,
    values_at,
)
from linksweep.results.peak_search.singular.extrapolated import Extrapolated, extrapolated
from linksweep.results.peak_search.singular.poles import designs_without_jams
from linksweep.scene.pairs import Array, in_order, some_of
from linksweep.scene.scene import Scene

PROBES = 10.0, 1.0
"""Distances from a toggle, as multiples of that of the closest sample, of those that show whether a signal is
unbounded."""
SURELY = 1e3
"""Size there, relative to that in the middle of the arc, from which on it has no peak elsewhere."""
LONGEST = 120.0
"""Length of an arc [degree] above which it is cut in its middle: most samples of a piece lie near its toggles, and
those in the middle of a long one would be too far apart."""
BESIDE_TOGGLE = 1e-4
"""Part of an arc that is a piece of its own beside each toggle."""
ROUNDING, SHORTEST = 1e-12, 1e-6
"""Distance of a sample from a toggle in which rounding does not show, and the length of the shortest arcs [degree]."""


class Arcs(NamedTuple):
    """Arcs of designs, in their order: row of the design in its group, start and end as angles from the near-toggle
    [degree]."""

    row: Array
    start: Array
    end: Array

    @property
    def length(self) -> Array:
        """Length of each arc [degree]."""
        return self.end - self.start

    @property
    def nearest(self) -> Array:
        """Distance in x of the closest sample from either end."""
        return np.maximum(NEAREST, 2.0 * np.sqrt(ROUNDING / self.length))

    def beside(self, ends: Array, x: Array) -> Array:
        """Return angles (arc, place) at distances x (arc, place) from the starts (0) or ends (1) of arcs."""
        away = self.length[:, None] * np.sin(0.5 * x) ** 2
        return np.where(ends > 0, self.end[:, None] - away, self.start[:, None] + away)


def follow_arcs(scene: Scene, designs: Array, peaks: dict[str, SignalPeak]) -> Array:
    """Write the peaks of designs that move over part of a turn; return those for which pieces are not enough."""
    if not (peaks and len(designs) and known_on_pieces(scene)):
        return designs
    sound, signals = designs if _jams_end_arcs(scene) else designs_without_jams(scene, designs), tuple(peaks)
    left = [np.setdiff1d(designs, sound, assume_unique=True)]
    at_once = AT_ONCE if scene.steady else CHANGING_AT_ONCE
    for group in groups(scene, sound, at_once, at_once):
        every = _arcs(group)
        arcs = some_of(every, every.length > 0.0)
        if not len(arcs.row):
            left.append(group.designs)
            continue
        best, sure = _highest(group.some(arcs.row), arcs, signals)
        known = np.bincount(arcs.row, minlength=len(group.designs)) > 0
        known[arcs.row[~sure]] = known[every.row[every.length <= 0.0]] = False  # some close at one angle alone
        numbers = _highest_of_designs(arcs.row, best, len(known))
        rows = np.flatnonzero(known & (numbers.value > -np.inf).any(axis=0))  # others are jammed on all arcs
        for k, peak in enumerate(peaks.values()):
            value, angle, bound, samples = (table[k, rows] for table in numbers)
            raise_to(peak, group.some(rows), (value, angle_in_period(angle, scene.period), bound, samples))
        left.append(np.delete(group.designs, rows))
    return np.sort(np.concatenate(left))


def _jams_end_arcs(scene: Scene) -> bool:
    """Return whether arcs are cut where friction wedges: where the crank drives, it jams all between two cuts, or
    nothing."""
    return scene.table.limits is not None and not driven_elsewhere(scene)


def _highest_of_designs(row: Array, best: Best, designs: int) -> Best:
    """Return the highest values on all arcs of designs (signal, design), of equal ones the first."""
    nth = np.arange(len(row)) - np.searchsorted(row, row)
    tables = np.zeros((4, len(best.value), designs, nth.max(initial=0) + 1))
    tables[0] = -np.inf
    tables[:, :, row, nth] = best
    value, angle, bound, samples = tables
    first = value.argmax(axis=2)[..., None]
    highest, at = (np.take_along_axis(table, first, axis=2)[..., 0] for table in (value, angle))
    with np.errstate(invalid="ignore"):
        above = np.where(highest < np.inf, (value + bound).max(axis=2) - highest, 0.0)
    return Best(highest, at, above, samples.sum(axis=2))


def _arcs(group: Group) -> Arcs:
    """Return all arcs of a group's designs, in every turn of the cycle, cut where friction wedges."""
    (starts, ends), machine = arc_ends(group), group.scene.mechanism
    turns = np.arange(0.0, group.scene.period, machine.period)
    row, nth, turn = np.nonzero(np.isfinite(starts)[..., None] & np.isfinite(turns))
    first, length = starts[row, nth, None], (ends - starts)[row, nth, None]
    start = np.mod(first[:, 0] - group.number(machine.near_toggle_angle)[row], machine.period) + turns[turn]
    wedged = np.mod(group.zeros("wedge")[row] - first, machine.period)
    cuts = in_order(np.concatenate([0.0 * length, np.where(wedged < length, wedged, np.nan), length], axis=1))
    arc, nth = np.nonzero((np.diff(cuts, axis=1) > 0.0) | (length <= 0.0))
    return Arcs(row[arc], start[arc] + cuts[arc, nth], start[arc] + cuts[arc, nth + 1])


def _highest(group: Group, arcs: Arcs, signals: tuple[str, ...]) -> tuple[Best, Array]:
    """Return the highest values of signals on arcs, one of each design of a group, and whether they are known; their
    angles [degree] are those of the crank."""
    both, probes = np.repeat([0, 1], len(PROBES)), np.multiply.outer(arcs.nearest, np.tile(PROBES, 2))
    angles = np.concatenate([arcs.beside(both, probes), (arcs.start + 0.5 * arcs.length)[:, None]], axis=1)
    values = values_at(group, (*signals, "status"), angles)
    status = values[-1, :, -1]
    known = (status == 0.0) & (arcs.length > SHORTEST) & np.isfinite(values).all(axis=(0, 2))
    farther, closer, middle = values[:-1, :, :-1:2], values[:-1, :, 1:-1:2], np.abs(values[:-1, :, -1:])
    with np.errstate(invalid="ignore"):
        grows, change = known[:, None] & (np.abs(closer) > GROWTH * np.abs(farther)), np.abs(closer - farther)
        infinite = grows & (closer > SURELY * middle)
        best = _on_pieces(group, arcs, signals, known & ~infinite.any(axis=2))
        grows &= np.abs(closer) > OF_PEAK * np.abs(best.value)[..., None]
        infinite |= grows & (closer > 0.0)
        limited = known[:, None] & ~grows & (closer + change >= best.value[..., None])
    limited &= ~infinite.any(axis=2, keepdims=True)
    best.samples[...] += values.shape[2]
    frame = group.number(group.scene.mechanism.near_toggle_angle)
    edges = arcs.start + frame, arcs.end + frame
    for end, edge in enumerate(edges):
        best.raise_to(infinite[..., end] & (best.value < np.inf), np.inf, edge, 0.0)
    for end, edge in enumerate(edges):
        beside = _extrapolated(group, arcs, end, signals, limited[..., end])
        limit = np.minimum(beside.limit, closer[..., end] + change[..., end])
        best.raise_to(limit > best.value, limit, edge, beside.error)
        best.samples[...] += beside.samples
    return best, known | (status > LAST_UNJAMMED)


def _on_pieces(group: Group, arcs: Arcs, signals: tuple[str, ...], needs: Array) -> Best:
    """Return the highest values of signals on pieces of arcs where they are needed (signal, arc); else −inf."""
    best = Best(np.full(needs.shape, -np.inf), *np.zeros((3, *needs.shape)))
    rows, which = np.flatnonzero(needs.any(axis=0)), np.flatnonzero(needs.any(axis=1))
    if len(rows):
        part, names = group.some(rows), tuple(signals[k] for k in which)
        pieces = cut_at_kinks(part, _pieces(part, some_of(arcs, rows)), HALF)
        own = np.ix_(which, rows)
        levels = np.where(needs[own], -np.inf, np.inf)
        highest = highest_on_pieces(part, pieces, names, HALF, levels)
        for table, *of_signals in zip(best, *highest.values(), strict=True):
            table[own] = np.where(needs[own], of_signals, table[own])
    return best


def _pieces(group: Group, arcs: Arcs) -> Pieces:
    """Return the pieces of arcs, one of each of these designs: between toggles, jumps and knots, narrow near-toggles,
    and ends of half turns."""
    length, period = arcs.length, group.scene.period
    nearest = length * np.sin(0.5 * arcs.nearest) ** 2
    breaks, narrow = breaks_and_near_toggles(group)
    away = [
        _inside(np.mod(angles - arcs.start[:, None], period), least, length)
        for angles, least in [*((angles, nearest) for angles in (*breaks, narrow)), (BORDERS[None], BEYOND)]
    ]
    shares = np.array([BESIDE_TOGGLE, 0.5, 1.0 - BESIDE_TOGGLE]) * length[:, None]
    shares[length <= LONGEST, 1] = np.nan
    cuts = arcs.start[:, None] + np.concatenate([*away, nearest[:, None], shares], axis=1)
    pieces = between(distinct(cuts), arcs.end - nearest, len(length))
    return pieces._replace(arc=np.stack([arcs.start, arcs.end]))


def _inside(away: Array, least: Array | float, length: Array) -> Array:
    """Return distances (arc, nth) from the starts of arcs, NaN for those that are less from either end."""
    least = np.broadcast_to(least, len(length))[:, None]
    with np.errstate(invalid="ignore"):
        return np.where((away > least) & (away < length[:, None] - least), away, np.nan)


def _extrapolated(group: Group, arcs: Arcs, end: int, signals: tuple[str, ...], needs: Array) -> Extrapolated:
    """Return the polynomials of signals at one end of each arc, where they are needed (signal, arc)."""

    def at_distances(which: Array, rows: Array, x: Array) -> Array:
        angles = some_of(arcs, rows).beside(np.array([end]), x)
        return values_at(group.some(rows), tuple(signals[k] for k in which), angles)

    steps = _steps(group, arcs)[:, end] if needs.any() else np.zeros(len(arcs.row))
    return extrapolated(at_distances, steps, needs)


def _steps(group: Group, arcs: Arcs) -> Array:
    """Return the steps in x (arc, end) of a search along paths, by the distances to other toggles and near-toggles."""
    frame = group.number(group.scene.mechanism.near_toggle_angle)[:, None]
    middles, widths = group.near_toggles()
    singular = [ends - frame for ends in (*arc_ends(group), group.zeros("wedge"))]
    singular.append(np.where(np.isfinite(widths), middles, np.nan))
    middle, half = 0.5 * (arcs.start + arcs.end), 0.5 * arcs.length
    return steps_at_ends(np.concatenate(singular, axis=1), middle, half, group.scene.period_of_motion)
