"""Search for peaks on pieces of the turn: between the angles at which friction jumps or forces have a kink.

The direction of sliding is known on each piece, so that all signals are smooth there, ends included. A piece also ends
at each narrow near-toggle, so that its samples can be dense about it, and where a half turn does. Loads over the angle
are polynomials: of tables between their knots, of which a piece has a few, and of functions on the whole piece. Pieces
of many designs are searched side by side, each as a turn that follows it there and back.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from linksweep.engine.peaks.evaluators import ALONG, END, FAR, FAR_WIDTH, NEAR_WIDTH, TANGENT
from linksweep.engine.peaks.find_peaks import PeaksOnPieces, find_peaks_on_pieces, zeros_of_pieces
from linksweep.engine.peaks.search import FEW, HALF
from linksweep.engine.quantity import Row, Table
from linksweep.engine.run import Fields, evaluate
from linksweep.engine.trace.plan import Plan, plan
from linksweep.physics.algebra import planar
from linksweep.physics.closures import crank_angle
from linksweep.results.peak_search.along_paths import SignalPeak, angle_in_period, put
from linksweep.results.peak_search.arcs import NEAREST, arc_ends
from linksweep.results.peak_search.between import EVERYWHERE, ONE
from linksweep.results.peak_search.clear import ENDS, FASTEST, HALF_TURN
from linksweep.results.peak_search.groups import Group, all_at_once, groups
from linksweep.results.peak_search.paths import distinct
from linksweep.results.peak_search.poles import singular_angles
from linksweep.scene.curves.polynomials import Polynomials, polynomials
from linksweep.scene.pairs import Array, by_row, places_of
from linksweep.scene.scene import Scene

AT_ONCE = 8192
"""Designs whose pieces are searched together."""
WIDTHS = "width_at_start", "width_at_end"
"""Inputs of a piece besides its ends: the widths of near-toggles as seen from them."""
MIDDLE, ANGLE = "piece_middle", "angle_on_piece"
"""Input of a piece with loads over the angle, its middle as such a tangent; and the angle from there [rad]."""
LOADED_AT_ONCE = 2048
"""Designs with loads over the angle whose pieces are searched together: they have more."""
NARROWEST = 0.02
"""Width of a near-toggle below which a design has many samples on each of its pieces."""
NARROW = 0.5
"""Width of a near-toggle, as tangent of half the angle, below which pieces end at it."""
BORDERS = np.array([90.0, 270.0])
"""Ends of half turns, from the near-toggle [degree]."""
BEYOND = 30.0
"""How far a piece may reach beyond its half turn, rather than be cut at the border [degree]."""
PROBES = np.array([1e-4, 1e-5])
"""Distances from a toggle, in x of an arc, of the samples that show whether a signal is unbounded."""
BESIDE_TOGGLE = 0.03
"""Part of an arc that is a piece of its own beside each toggle."""
LEAST_GROWTH, LARGE = 5.0, 1e3
"""Growth from the one to the other, and over the middle of the arc, of an unbounded signal."""


class Pieces(NamedTuple):
    """Pieces of the turns of designs, in their order: row of the design in its group, start and end, as angles from the
    near-toggle [degree]; directions of sliding (direction, piece); and what limits the widths of peaks about its ends
    (end, piece), as tangents of half the angle that follows the piece."""

    row: Array
    start: Array
    end: Array
    directions: Array
    widths: Array | float = 1.0

    @property
    def half(self) -> Array:
        """0 or 1 for the half turn in which, or about which, each piece lies."""
        return np.floor(np.mod(0.5 * (self.start + self.end) + 90.0, 360.0) / 180.0)

    def tangents(self, half: Array, angle: Array) -> Array:
        """Return the tangents of half the angles from the middles of these half turns."""
        away = np.mod(angle - 180.0 * half + 180.0, 360.0) - 180.0
        return np.tan(np.radians(0.5 * away))


def divides(scene: Scene) -> bool:
    """Return whether all jumps of a scene are those of friction, so that signals are smooth between them."""
    machine = scene.mechanism
    return bool(machine.directions()) and not scene.approaches() and len(scene.jumps()) == len(machine.jumps())


def rubbing_signals(scene: Scene, signals: tuple[str, ...]) -> tuple[str, ...]:
    """Return those signals of a scene that depend on the direction of sliding; none where pieces are not enough."""
    machine = scene.mechanism
    if not divides(scene):
        return ()
    known = {on_piece(name) for name in machine.directions()}
    forms = (*scene.inputs.forms, *((name, ()) for name in (*known, *ENDS, HALF_TURN, *WIDTHS, ALONG, END)))
    table = _table_on_pieces(scene.table, machine.directions())
    inputs_of = {signal: plan(table, (signal,), forms).inputs for signal in signals}
    return tuple(signal for signal, inputs in inputs_of.items() if not known.isdisjoint(inputs))


def known_on_pieces(scene: Scene) -> bool:
    """Return whether pieces of the cycle, between which all jumps lie, state the motion and the loads over the
    angle."""
    machine = scene.mechanism
    divided = bool(machine.directions()) or not machine.jumps()
    simple = not (scene.table.contacts or scene.approaches()) and scene.period_of_motion == machine.period
    return divided and simple and machine.fastest <= FASTEST and (scene.steady or _loads(scene) is not None)


def turning_without_jams(scene: Scene, designs: Array) -> Array:
    """Return those designs of a scene that turn fully, without jams or dead centres."""
    return designs_without_jams(scene, designs[all_at_once(scene, designs).assembly() == EVERYWHERE])


def designs_without_jams(scene: Scene, designs: Array) -> Array:
    """Return those designs of a scene that friction jams nowhere, and whose drive stands still nowhere."""
    return designs[~np.isfinite(singular_angles(all_at_once(scene, designs))).any(axis=1)]


def follow_pieces(scene: Scene, designs: Array, peaks: dict[str, SignalPeak], threads: int | None) -> None:
    """Write the peaks of designs, from a search of their pieces."""
    at_once = AT_ONCE if scene.steady else LOADED_AT_ONCE
    for whole in groups(scene, tuple(peaks), designs, at_once, at_once) if peaks else ():
        for half, group in _by_samples(whole):
            pieces = _pieces(group, threads)
            request, inputs = _evaluated(group, pieces, tuple(peaks))
            results = find_peaks_on_pieces(request, tuple(peaks), inputs, ONE, pieces.row, half, threads)
            for signal, peak in peaks.items():
                put(peak, group, _highest(group, pieces, inputs, results[signal]))


def _by_samples(group: Group) -> Iterator[tuple[int, Group]]:
    """Yield the designs of a group by the number of samples in half of each piece: few on the short pieces of loads
    over the angle, where no near-toggle is narrow."""
    narrow = (group.near_toggles()[1] < NARROWEST).any(axis=1) | (_loads(group.scene) is None)
    for half, some in ((FEW, np.flatnonzero(~narrow)), (HALF, np.flatnonzero(narrow))):
        if len(some):
            yield half, group.some(some)


def _highest(group: Group, pieces: Pieces, inputs: Fields, peak: PeaksOnPieces) -> tuple[Array, ...]:
    """Return value, angle [degree], bound and samples of the highest peak of each design's pieces."""
    first = np.flatnonzero(np.diff(pieces.row, prepend=-1))
    value, height = peak.value, np.nan_to_num(peak.value, nan=-np.inf)
    highest = np.maximum.reduceat(height, first)
    winner = np.flatnonzero(height == highest[pieces.row])[::-1]
    own = np.empty(len(first), dtype=int)
    own[pieces.row[winner]] = winner  # the first of equals is written last
    reach = np.maximum.reduceat(np.nan_to_num(value + peak.beyond, nan=-np.inf), first)
    angle = _angles(pieces, inputs, own, peak.tangent[own], peak.end[own])
    angle = angle_in_period(angle + group.number(group.scene.mechanism.near_toggle_angle), group.scene.period)
    samples = np.add.reduceat(peak.evaluations, first)
    unknown = np.isnan(value[own])
    return tuple(np.where(unknown, np.nan, numbers) for numbers in (highest, angle, reach - highest, samples))


# --------------------------------------------------------------------------------------------------- arcs


def follow_unbounded(scene: Scene, designs: Array, peaks: dict[str, SignalPeak], threads: int | None) -> Array:
    """Write the peaks of those designs that move over part of a turn, and of which all signals grow without bound at
    all toggles, to either side; return the other designs."""
    if not len(designs) or scene.jumps() or scene.mechanism.kinks() or scene.approaches():
        return designs
    regular, signals = designs_without_jams(scene, designs), tuple(peaks)
    others = [np.setdiff1d(designs, regular, assume_unique=True)]
    for group in groups(scene, signals, regular, AT_ONCE):
        arcs, growth = _growth_at_toggles(group, signals, threads)
        known = np.bincount(arcs.row, (growth == 0.0).any(axis=(0, 1)), len(group.designs)) == 0.0
        known &= np.bincount(arcs.row, minlength=len(group.designs)) > 0
        others.append(group.designs[~known])
        for signal, of_signal in zip(signals, growth, strict=True):
            upwards = np.bincount(arcs.row, (of_signal > 0.0).any(axis=0), len(group.designs)) > 0
            _put_infinite(group, np.flatnonzero(known & upwards), peaks[signal], arcs, of_signal)
            bounded = np.flatnonzero(known & ~upwards)
            if len(bounded):
                part = group.some(bounded)
                pieces = _of_arcs(part, arcs.some(np.flatnonzero((known & ~upwards)[arcs.row]), bounded))
                request, inputs = _evaluated(part, pieces, (signal,))
                results = find_peaks_on_pieces(request, (signal,), inputs, ONE, pieces.row, HALF, threads)
                put(peaks[signal], part, _highest(part, pieces, inputs, results[signal]))
    return np.sort(np.concatenate(others))


class Arcs(NamedTuple):
    """Arcs of designs, in their order: row of the design in its group, start and end [degree]."""

    row: Array
    start: Array
    end: Array

    def some(self, which: Array, rows: Array) -> Arcs:
        """Return some arcs, of designs in these rows of the group."""
        return Arcs(np.searchsorted(rows, self.row[which]), self.start[which], self.end[which])


def _growth_at_toggles(group: Group, signals: tuple[str, ...], threads: int | None) -> tuple[Arcs, Array]:
    """Return the arcs of designs, and for each (signal, end, arc) 1 where the signal tends to +∞, −1 where it tends to
    −∞, and 0 where samples do not show it."""
    starts, ends = arc_ends(group)
    row, nth = np.nonzero(np.isfinite(starts))
    arcs = Arcs(row, starts[row, nth], ends[row, nth])
    middle, half = 0.5 * (arcs.start + arcs.end), 0.5 * (arcs.end - arcs.start)
    away = 1.0 - np.cos(PROBES)
    shares = np.concatenate([away - 1.0, [0.0], 1.0 - away])  # the start's, the middle's, the end's
    angles = (middle[:, None] + half[:, None] * shares).ravel()
    values = group.values((*signals, "status"), np.repeat(row, len(shares)), angles, threads)
    values = np.moveaxis(values.reshape(-1, len(row), len(shares)), 2, 0)
    moves, inside = values[2, -1] == 0.0, LARGE * np.abs(values[2, :-1])
    growth = []
    for probe, closer in ((values[0, :-1], values[1, :-1]), (values[3, :-1], values[4, :-1])):
        unbounded = (np.abs(closer) > LEAST_GROWTH * np.abs(probe)) & (np.abs(closer) > inside) & moves
        growth.append(np.where(unbounded, np.sign(closer), 0.0))
    return arcs, np.stack(growth, axis=1)


def _put_infinite(group: Group, rows: Array, peak: SignalPeak, arcs: Arcs, growth: Array) -> None:
    """Write the infinite peaks of a signal of the designs in these rows: at the first end at which it grows."""
    if not len(rows):
        return
    arc, end = np.nonzero((growth > 0.0).T)
    own, first = np.unique(arcs.row[arc], return_index=True)
    at = first[np.searchsorted(own, rows)]
    angle = angle_in_period(np.where(end > 0, arcs.end[arc], arcs.start[arc])[at], group.scene.period)
    known = np.zeros(len(rows))
    put(peak, group.some(rows), (known + np.inf, angle, known, known + len(PROBES) * 2.0 + 1.0))


def _of_arcs(group: Group, arcs: Arcs) -> Pieces:
    """Return the pieces of arcs: between toggles, narrow near-toggles, and ends of half turns."""
    length = arcs.end - arcs.start
    start = np.mod(arcs.start - group.number(group.scene.mechanism.near_toggle_angle)[arcs.row], 360.0)
    middles, widths = group.near_toggles()
    with np.errstate(invalid="ignore"):
        narrow = np.where(widths < NARROW, middles, np.nan)[arcs.row]
        cuts = np.concatenate([narrow, np.broadcast_to(BORDERS, (len(length), 2))], axis=1)
        away = np.mod(cuts - start[:, None], 360.0)
        least = np.array([0.0, 0.0, BEYOND, BEYOND])
        away = np.where((away > least) & (away < length[:, None] - least), away, np.nan)
    near = 0.5 * (1.0 - np.cos(NEAREST))
    away = np.concatenate([away, np.multiply.outer(length, [near, BESIDE_TOGGLE, 1.0 - BESIDE_TOGGLE])], axis=1)
    arc, first, last = _between(np.sort(start[:, None] + away, axis=1), start + (1.0 - near) * length)
    before, after = first - start[arc], start[arc] + length[arc] - last
    widths = np.sqrt(np.minimum(np.stack([before, after]) / (last - first), 1.0))
    return Pieces(arcs.row[arc], first, last, np.empty((0, len(arc))), widths)


# ------------------------------------------------------------------------------------------------- pieces


def _pieces(group: Group, threads: int | None) -> Pieces:
    """Return the pieces of a group's designs, which end at all jumps and kinks."""
    pieces = _between_jumps(group)
    pieces = pieces._replace(directions=_directions(group, pieces, threads))
    for name in group.scene.mechanism.kinks():
        pieces = _cut_at_zeros(group, pieces, name, threads)
    return pieces


def _directions(group: Group, pieces: Pieces, threads: int | None) -> Array:
    """Return the directions of sliding (direction, piece), those in the middle of each piece."""
    scene, half = group.scene, pieces.half
    directions, count = scene.mechanism.directions(), len(pieces.row)
    if not directions:
        return np.empty((0, count))
    place = {TANGENT: pieces.tangents(half, 0.5 * (pieces.start + pieces.end)), FAR: half}
    request, inputs = group.one_by_one(scene.table.between_samples, directions, pieces.row, place, ())
    values = evaluate(request, inputs, scene.grid(1), {ONE: count}, threads)
    return np.stack([np.broadcast_to(values[name].values, count) for name in directions])


def _between_jumps(group: Group) -> Pieces:
    """Return the pieces of the whole cycle between jumps, narrow near-toggles, and ends of half turns or knots."""
    scene, period, designs = group.scene, group.scene.period, len(group.designs)
    turns = np.arange(0.0, period, scene.mechanism.period)
    located = (group.zeros("jump")[..., None] + turns).reshape(designs, -1)
    frame = group.number(scene.mechanism.near_toggle_angle)[:, None]
    loads, jumps = _loads(scene), [group.number(jump)[:, None] + turns for jump in scene.jumps()]
    jumps += [np.broadcast_to(loads.cuts, (designs, len(loads.cuts)))] if loads else []
    breaks = np.mod(np.concatenate([*jumps, located], axis=1) - frame, period)
    middles, widths = group.near_toggles()
    with np.errstate(invalid="ignore"):
        narrow = np.where(widths < NARROW, middles, np.nan)[..., None] + turns
        ends = [breaks, narrow.reshape(designs, -1)]
        if loads is None:  # pieces between cuts are short
            away = np.abs(np.mod(breaks[:, :, None] - BORDERS + 180.0, 360.0) - 180.0)
            ends.append(np.where((away < BEYOND).any(axis=1), np.nan, BORDERS))
    cuts = distinct(np.concatenate(ends, axis=1))
    return Pieces(*_between(cuts, cuts[:, 0] + period), np.empty((0, designs)))


def _between(cuts: Array, last: Array) -> tuple[Array, Array, Array]:
    """Return row, start and end of the pieces between cuts (row, cut) in order, NaN at the end for none, and the last
    end of each row."""
    row, nth = np.nonzero(np.isfinite(cuts))
    start = cuts[row, nth]
    end = np.append(start[1:], 0.0)
    final = np.append(row[1:] != row[:-1], True)
    end[final] = last[row[final]]
    sound = end > start
    return row[sound], start[sound], end[sound]


def _cut_at_zeros(group: Group, pieces: Pieces, name: str, threads: int | None) -> Pieces:
    """Return the pieces, cut at the zeros of a quantity."""
    request, inputs = _evaluated(group, pieces, (name,))
    tangent, far = zeros_of_pieces(request, inputs, {ONE: len(pieces.row)}, threads)
    piece, nth = np.nonzero(np.isfinite(tangent))
    if not len(piece):
        return pieces
    angle = _angles(pieces, inputs, piece, tangent[piece, nth], far[piece, nth])
    cuts = np.concatenate([pieces.start[:, None], by_row(piece, angle, len(pieces.row))], axis=1)
    of, start, end = _between(np.sort(cuts, axis=1), pieces.end)
    return Pieces(pieces.row[of], start, end, pieces.directions[:, of])


def _angles(pieces: Pieces, inputs: Fields, piece: Array, tangent: Array, far: Array) -> Array:
    """Return the angles from the near-toggle [degree] of places on pieces."""
    square = tangent * tangent
    share = square / (1.0 + square)
    start, end = (inputs[name].values[piece] for name in ENDS)
    tangent = np.where(far > 0.0, end - (end - start) * share, start + (end - start) * share)
    middle = 180.0 * inputs[HALF_TURN].values[piece]
    angle = 2.0 * np.degrees(np.arctan(tangent)) + middle
    return pieces.start[piece] + np.mod(angle - pieces.start[piece] + 90.0, 360.0) - 90.0


# ---------------------------------------------------------------------------------------------- evaluation


def _evaluated(group: Group, pieces: Pieces, names: tuple[str, ...]) -> tuple[Plan, Fields]:
    """Return the plan of quantities on pieces, and its inputs: those of the designs, and of the pieces."""
    scene, index = group.scene, group.scene.mechanism.index
    directions = scene.mechanism.directions()
    half = pieces.half
    start, end = (pieces.tangents(half, angle) for angle in (pieces.start, pieces.end))
    widths = _widths(pieces, start, end, *group.near_toggles())
    own = dict(zip((*ENDS, HALF_TURN, *WIDTHS), (start, end, half, *np.minimum(widths, pieces.widths)), strict=True))
    own |= {on_piece(name): values for name, values in zip(directions, pieces.directions, strict=True)}
    table, loads = _table_on_pieces(scene.table, directions), _loads(scene)
    if loads is not None:
        own |= {MIDDLE: pieces.tangents(half, 0.5 * (pieces.start + pieces.end))}
        own |= _on_pieces(loads, group, pieces)
        table = _table_on_pieces(scene.table, directions, loads.rows(ANGLE))
    places = ((ALONG, (index, ONE)), (END, (index,)))
    return group.one_by_one(table, (*names, NEAR_WIDTH, FAR_WIDTH), pieces.row, own, places)


def _on_pieces(loads: Polynomials, group: Group, pieces: Pieces) -> dict[str, Array]:
    """Return the numbers of loads over the angle on pieces."""
    scene, designs = group.scene, group.designs[pieces.row]
    start = pieces.start + group.number(scene.mechanism.near_toggle_angle)[pieces.row]
    places = places_of(scene.at_one_angle.inputs.sizes, designs)
    return loads.on_pieces(start, pieces.end - pieces.start, places)


def on_piece(name: str) -> str:
    """Return the name of a direction that is known on a piece."""
    return f"{name}_on_piece"


@lru_cache(maxsize=64)
def _table_on_pieces(table: Table, directions: tuple[str, ...], loads: tuple[Row, ...] = ()) -> Table:
    """Return the table between samples with places on pieces, and with these rows of loads over the angle."""
    between = table.between_samples
    known = {NEAR_WIDTH: WIDTHS[0], FAR_WIDTH: WIDTHS[1]} | {name: on_piece(name) for name in directions}
    rows = (
        Row(crank_angle.place_on_piece, ("half_tangent",), (ALONG, END, *ENDS)),
        Row(crank_angle.angle_on_piece, (ANGLE,), ("half_tangent", MIDDLE)),
        *(Row(planar.identity, (name,), (own,)) for name, own in known.items()),
        *loads,
    )
    return replace(between, rows=(*between.rows, *rows))


def _loads(scene: Scene) -> Polynomials | None:
    """Return the loads over the angle of a scene as polynomials, if there are any and they are such."""
    return None if scene.steady else polynomials(scene)


def _widths(pieces: Pieces, start: Array, end: Array, angles: Array, widths: Array) -> tuple[Array, Array]:
    """Return the widths of near-toggles (design, nth) as both ends of pieces know them, as tangents of half the angle
    that follows a piece.

    Quantities have poles at tangents x ± i·width, at a share z of the piece. There tan² is z/(1 − z).
    """
    away = np.mod(angles[pieces.row] - 180.0 * pieces.half[:, None] + 180.0, 360.0) - 180.0
    with np.errstate(invalid="ignore"):
        own = (widths[pieces.row] < NARROW) & (np.abs(away) < 180.0 - BEYOND)
    piece, nth = np.nonzero(own)
    x = np.tan(np.radians(0.5 * away[piece, nth]))
    width = 1j * (1.0 + x * x) * widths[pieces.row[piece], nth]
    seen = np.ones((2, len(start)))
    for of_end, distance in zip(seen, (x - start[piece], end[piece] - x), strict=True):
        z = (distance + width) / (end - start)[piece]
        np.minimum.at(of_end, piece, np.abs(np.sqrt(z / (1.0 - z)).imag))
    return seen[0], seen[1]
