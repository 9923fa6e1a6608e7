"""Search for peaks on pieces of the turn: between the angles at which friction jumps or forces have a kink.

The direction of sliding is known on each piece, so that all signals are smooth there, ends included. A piece also ends
at each narrow near-toggle, so that its samples can be dense about it, and where a half turn does. Loads and speeds over
the angle are polynomials: of tables between their knots, of which a piece has a few, and of functions on the whole
piece. Designs are searched side by side, piece by piece, each piece as a turn that follows it there and back.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from linksweep.base.degrees import signed_distance
from linksweep.engine.peaks.find_peaks import find_peaks_on_pieces, zeros_of_pieces
from linksweep.engine.peaks.roles import ALONG, END, FAR, PIECE, TANGENT, WIDTHS
from linksweep.engine.peaks.samples import FEW, HALF
from linksweep.engine.quantity import Row, Table
from linksweep.engine.run import Field, Fields, evaluate
from linksweep.engine.trace.plan import Plan, plan
from linksweep.physics.algebra import planar
from linksweep.physics.closures import crank_angle
from linksweep.results.peak_search.along_paths import Best, SignalPeak, angle_in_period, on_own_side, put
from linksweep.results.peak_search.between import ONE, half_tangent, half_turn_of
from linksweep.results.peak_search.friction.directions import speed_at_one_angle
from linksweep.results.peak_search.groups import Group, groups
from linksweep.results.peak_search.paths import distinct
from linksweep.results.peak_search.side_by_side import FASTEST
from linksweep.scene.curves.polynomials import Polynomials, polynomials
from linksweep.scene.dimensions import aligned
from linksweep.scene.pairs import Array, by_row, places_of
from linksweep.scene.scene import Scene

AT_ONCE = 8192
"""Designs whose pieces are searched together."""
ENDS = "piece_from", "piece_to"
"""Inputs of a piece besides its half turn: its ends, as tangents of half the angle from the middle of that."""
WIDTHS_AT_ENDS = "width_at_start", "width_at_end"
"""Inputs of a piece, too: the widths of near-toggles as seen from its ends."""
MIDDLE, ANGLE = "piece_middle", "angle_on_piece"
"""Input of a piece over whose angle something changes, its middle as such a tangent; and the angle from there [rad]."""
CHANGING_AT_ONCE = 2048
"""Designs with loads or speeds over the angle whose pieces are searched together: they have more."""
NARROWEST = 0.02
"""Width of a near-toggle below which a design has many samples on each of its pieces."""
NARROW = 0.5
"""Width of a near-toggle, as tangent of half the angle, below which pieces end at it."""
NEAR_END = 1e-4
"""Share of a piece from its end to the place where the direction of sliding is that near the end: a slide that moves by
less than rounding elsewhere does move near a near-toggle."""
BORDERS = np.array([90.0, 270.0])
"""Ends of half turns, from the near-toggle [degree]."""
SHORTEST = 1e-6
"""Length of a piece of which only the start counts [degree]."""
AT_END = 1e-6
"""Tangent below which a place is the end of its piece, but for rounding."""
BEYOND = 30.0
"""How far a piece may reach beyond its half turn, rather than be cut at the border [degree]."""


class Pieces(NamedTuple):
    """Pieces of the turns of designs, in their order.

    `start` and `end` (design, piece) are angles from the near-toggle [degree], in one row where all designs share them;
    `half` is 0 or 1 for the half turn in which, or about which, a piece lies. A design with fewer pieces than others,
    as `counts` tells, goes on with its first. `directions` are those of sliding (direction, design, piece); `arc` has
    the toggles at both ends (end, design) of an arc, in place of a turn, that pieces divide.
    """

    start: Array
    end: Array
    half: Array
    counts: Array
    directions: Array
    arc: Array | None = None

    @property
    def widths(self) -> Array | float:
        """Largest widths of peaks about the ends (end, design, piece), by the distances of the arc's toggles: as
        tangents of half the angle that follows a piece."""
        if self.arc is None:
            return 1.0
        start, end = self.arc[..., None]
        return np.sqrt(np.minimum(np.stack([self.start - start, end - self.end]) / (self.end - self.start), 1.0))

    @property
    def exist(self) -> Array:
        """True for pieces (design, piece) that are a design's own, and do not only fill up its row."""
        return np.arange(self.start.shape[1]) < self.counts[:, None]

    def some(self, rows: Array) -> Pieces:
        """Return the pieces of the designs in these rows."""
        start, end, half = (x if len(x) < len(self.counts) else x[rows] for x in self[:3])
        arc = None if self.arc is None else self.arc[:, rows]
        return Pieces(start, end, half, self.counts[rows], self.directions[:, rows], arc)

    def tangents(self, angle: Array) -> Array:
        """Return the tangents of half the angles from the middles of half turns."""
        return half_tangent(angle, self.half)


def rubbing_signals(scene: Scene, signals: tuple[str, ...]) -> tuple[str, ...]:
    """Return those signals of a scene that depend on the direction of sliding."""
    machine = scene.mechanism
    known = {on_piece(name) for name in machine.directions()}
    forms = (*scene.inputs.forms, *((name, ()) for name in (*known, *ENDS, FAR, *WIDTHS_AT_ENDS, ALONG, END)))
    table = _table_on_pieces(scene.table, machine.directions())
    request = plan(table, signals, forms)
    return tuple(signal for signal in signals if not known.isdisjoint(request.only((signal,)).inputs))


def known_on_pieces(scene: Scene) -> bool:
    """Return whether pieces of the cycle, between which all jumps lie, state the motion, and what changes over the
    angle."""
    machine = scene.mechanism
    divided = scene.unloaded.steady if machine.directions() else not machine.jumps()  # a moved cylinder may turn slides
    simple = not (scene.table.contacts or scene.approaches()) and scene.period_of_motion == machine.period
    return divided and simple and machine.fastest <= FASTEST and (scene.steady or _over_angle(scene) is not None)


def follow_pieces(scene: Scene, designs: Array, peaks: dict[str, SignalPeak]) -> None:
    """Write the peaks of designs, from a search of their pieces."""
    at_once = AT_ONCE if scene.steady else CHANGING_AT_ONCE
    for whole in groups(scene, designs, at_once, at_once) if peaks else ():
        for half, group in _by_samples(whole):
            highest = highest_on_pieces(group, _pieces(group, half), tuple(peaks), half)
            for signal, numbers in highest.items():
                put(peaks[signal], group, numbers)


def _by_samples(group: Group) -> Iterator[tuple[int, Group]]:
    """Yield the designs of a group by the number of samples in half of each piece: few on short pieces between changes
    over the angle, where no near-toggle is narrow."""
    narrow = (group.near_toggles()[1] < NARROWEST).any(axis=1) | (_over_angle(group.scene) is None)
    for half, some in ((FEW, np.flatnonzero(~narrow)), (HALF, np.flatnonzero(narrow))):
        if len(some):
            yield half, group.some(some)


def highest_on_pieces(
    group: Group, pieces: Pieces, signals: tuple[str, ...], half: int, levels: Array | None = None
) -> Mapping[str, Best]:
    """Return the highest peak of each signal on the pieces of each design, which have so many samples on either side of
    the middle of each half turn; below a level (signal, design) only the highest sample."""
    order = np.argsort(pieces.counts, kind="stable")  # side by side stand designs with as many pieces
    group, pieces, back = group.some(order), pieces.some(order), np.argsort(order)
    request, inputs = _evaluated(group, pieces, signals)
    frame, period = group.number(group.scene.mechanism.near_toggle_angle), group.scene.period
    highest = {}
    levels = None if levels is None else levels[:, order]
    peaks = find_peaks_on_pieces(request, signals, inputs, ONE, pieces.counts, half, levels)
    for signal, (value, tangent, far, bound, samples, piece) in peaks.items():
        at = np.arange(len(value)), np.nan_to_num(piece).astype(int)
        angle = angle_in_period(_angles(pieces, inputs, at, tangent, far) + frame, period)
        (end,) = np.nonzero(np.abs(tangent) < AT_END)
        angle[end] = on_own_side(group.of(signal, end), angle[end], value[end], period)
        highest[signal] = Best(value[back], angle[back], bound[back], samples[back])
    return highest


# ------------------------------------------------------------------------------------------------- pieces


def _pieces(group: Group, half: int) -> Pieces:
    """Return the pieces of a group's designs, which end at all jumps and kinks."""
    return cut_at_kinks(group, _between_jumps(group), half)


def cut_at_kinks(group: Group, pieces: Pieces, half: int) -> Pieces:
    """Return pieces between jumps, cut at all kinks, with their directions of sliding."""
    pieces = pieces._replace(directions=_directions(group, pieces))
    for name in group.scene.mechanism.kinks():
        pieces = _cut_at_zeros(group, pieces, name, half)
    return pieces


def _directions(group: Group, pieces: Pieces) -> Array:
    """Return the directions of sliding (direction, design, piece): those near the narrower near-toggle at an end of
    each piece, or in its middle."""
    names, shape = group.scene.mechanism.directions(), (len(pieces.counts), pieces.start.shape[1])
    if not names:
        return np.empty((0, *shape))
    start, end = map(pieces.tangents, (pieces.start, pieces.end))
    at_start, at_end = _widths(pieces, start, end, *group.near_toggles())
    near_end = np.where(at_end < at_start, 1.0 - NEAR_END, NEAR_END)
    directions = _directions_at(group, pieces, np.where(np.minimum(at_start, at_end) < 1.0, near_end, 0.5))
    if (directions == 0.0).any():
        directions = np.where(directions == 0.0, _directions_at(group, pieces, np.array([[0.5]])), directions)
    return directions


def _directions_at(group: Group, pieces: Pieces, share: Array) -> Array:
    """Return the directions of sliding (direction, design, piece) at a share of the way along each piece."""
    scene, shape = group.scene, (len(pieces.counts), pieces.start.shape[1])
    names, angle = scene.mechanism.directions(), pieces.start + share * (pieces.end - pieces.start)
    places = {TANGENT: pieces.tangents(angle), FAR: pieces.half}
    own = {name: _of_pieces(values) for name, values in places.items()} | speed_at_one_angle(group)
    return _values(group, scene.table.between_samples, names, own, shape)


def _between_jumps(group: Group) -> Pieces:
    """Return the pieces of the whole cycle between jumps, narrow near-toggles, and ends of half turns or knots."""
    breaks, narrow = breaks_and_near_toggles(group)
    ends = [*breaks, narrow]
    if _over_angle(group.scene) is None:
        close = np.abs(signed_distance(_side_by_side(breaks)[:, :, None], BORDERS)) < BEYOND
        ends.append(np.where(close.any(axis=1), np.nan, BORDERS))
    cuts = distinct(_side_by_side(ends))
    return between(cuts, cuts[:, 0] + group.scene.period, len(group.designs))


def breaks_and_near_toggles(group: Group) -> tuple[list[Array], Array]:
    """Return the angles from the near-toggle (design, nth) [degree] of jumps and knots of the whole cycle, each kind in
    one row if that is the same for all designs, and those of narrow near-toggles."""
    scene, period, designs = group.scene, group.scene.period, len(group.designs)
    turns = np.arange(0.0, period, scene.mechanism.period)
    located = (group.zeros("jump")[..., None] + turns).reshape(designs, -1)
    frame = _in_one_row(group.number(scene.mechanism.near_toggle_angle)[:, None])
    changing, jumps = _over_angle(scene), [group.number(jump)[:, None] + turns for jump in scene.jumps()]
    cuts = [changing.cuts[None]] if changing else []
    breaks = [np.mod(angles - frame, period) for angles in (*jumps, located, *cuts)]
    middles, widths = group.near_toggles()
    with np.errstate(invalid="ignore"):
        narrow = np.where(widths < NARROW, middles, np.nan)
    if changing and group.limits is None:  # pieces are short in any case, and many designs share them
        narrow = middles[:1]
    return breaks, (narrow[..., None] + turns).reshape(len(narrow), -1)


def _in_one_row(numbers: Array) -> Array:
    """Return numbers (design, …) that are the same for all designs in one row."""
    return numbers[:1] if (numbers == numbers[:1]).all() else numbers


def _side_by_side(parts: list[Array]) -> Array:
    """Return numbers (design, …) side by side, in one row where all parts that have any are in one."""
    parts = [part for part in parts if part.shape[1]] or [np.empty((1, 0))]
    rows = max(map(len, parts))
    return np.concatenate([np.broadcast_to(part, (rows, part.shape[1])) for part in parts], axis=1)


def between(cuts: Array, last: Array, designs: int) -> Pieces:
    """Return the pieces of designs between cuts (row, cut) in order, NaN for none, and the last end of each row."""
    sound = (np.diff(cuts, axis=1, prepend=-np.inf) > 0.0) & (cuts < last[:, None])
    cuts = np.sort(np.where(sound, cuts, np.nan), axis=1)
    counts = sound.sum(axis=1)
    cuts = cuts[:, : counts.max()]
    ends = np.concatenate([cuts[:, 1:], np.full((len(cuts), 1), np.nan)], axis=1)
    ends = np.where(np.isnan(ends), last[:, None], ends)
    start, end = (np.where(np.isnan(cuts), x[:, :1], x) for x in (cuts, ends))
    half = half_turn_of(0.5 * (start + end))
    return Pieces(start, end, half, np.broadcast_to(counts, designs), np.empty((0, designs, 0)))


def _cut_at_zeros(group: Group, pieces: Pieces, name: str, half: int) -> Pieces:
    """Return the pieces, cut at the zeros of a quantity."""
    request, inputs = _evaluated(group, pieces, (name,))
    if group.scene.mechanism.index not in request.outputs[name].dims:  # as the force on a guide that bears nothing
        return pieces
    tangent, far = zeros_of_pieces(request, inputs, ONE, pieces.counts, half)
    zeros = np.nonzero(np.isfinite(tangent))
    if not len(zeros[0]):
        return pieces
    angle = _angles(pieces, inputs, zeros[:2], tangent[zeros], far[zeros])
    designs, start = len(pieces.counts), np.where(pieces.exist, pieces.start, np.nan)
    cuts = np.sort(np.concatenate([start, by_row(zeros[0], angle, designs)], axis=1), axis=1)
    cut = between(cuts, np.where(pieces.exist, pieces.end, -np.inf).max(axis=1), designs)
    of = (cut.start[:, :, None] >= start[:, None, :]).sum(axis=-1) - 1
    return cut._replace(directions=np.take_along_axis(pieces.directions, of[None], axis=2), arc=pieces.arc)


def _angles(pieces: Pieces, inputs: Fields, at: tuple[Array, ...], tangent: Array, far: Array) -> Array:
    """Return the angles from the near-toggle [degree] of places on pieces `at` (design, piece)."""
    square = tangent * tangent
    share = square / (1.0 + square)
    shape = len(pieces.counts), pieces.start.shape[1]
    first, last, half = (np.broadcast_to(inputs[name].values, shape)[at] for name in (*ENDS, FAR))
    x = np.where(far > 0.0, last - (last - first) * share, first + (last - first) * share)
    angle, start = 2.0 * np.degrees(np.arctan(x)) + 180.0 * half, np.broadcast_to(pieces.start, shape)[at]
    return start + np.mod(angle - start + 90.0, 360.0) - 90.0


# ---------------------------------------------------------------------------------------------- evaluation


def values_at(group: Group, names: tuple[str, ...], angles: Array) -> Array:
    """Return values (name, design, nth) of quantities at angles (design, nth) from the near-toggle [degree]: at the
    starts of pieces."""
    known = np.full(len(angles), angles.shape[1])
    pieces = Pieces(angles, angles + SHORTEST, half_turn_of(angles), known, np.empty((0, *angles.shape)))
    if group.scene.mechanism.directions():
        pieces = pieces._replace(directions=_directions_at(group, pieces, np.zeros((1, 1))))
    table, own = _on_own_pieces(group, pieces)
    start = {ALONG: Field((), np.zeros(())), END: Field((), np.zeros(()))}
    return _values(group, table, names, own | start, angles.shape)


def _values(group: Group, table: Table, names: tuple[str, ...], own: Fields, shape: tuple[int, ...]) -> Array:
    """Return values (name, design, piece) of quantities of a table, each at one place on a piece."""
    request, inputs = group.one_by_one(table, names, own)
    values = evaluate(request, inputs, group.scene.grid(1), dict(zip((ONE, PIECE), shape, strict=True)))
    return np.stack([np.broadcast_to(aligned(values[name], (ONE, PIECE)), shape) for name in names])


def _evaluated(group: Group, pieces: Pieces, names: tuple[str, ...]) -> tuple[Plan, Fields]:
    """Return the plan of quantities on pieces, and its inputs: those of the designs, and of the pieces."""
    index, (table, own) = group.scene.mechanism.index, _on_own_pieces(group, pieces)
    start, end = (np.atleast_2d(own[name].values) for name in ENDS)
    widths = np.minimum(_widths(pieces, start, end, *group.near_toggles()), pieces.widths)
    own |= {name: _of_pieces(values) for name, values in zip(WIDTHS_AT_ENDS, widths, strict=True)}
    places = ((ALONG, (index, ONE, PIECE)), (END, (index,)))
    return group.one_by_one(table, (*names, *WIDTHS), own, places)


def _on_own_pieces(group: Group, pieces: Pieces) -> tuple[Table, dict[str, Field]]:
    """Return the table of quantities on pieces, and the inputs of the pieces but for widths of near-toggles."""
    scene, directions = group.scene, group.scene.mechanism.directions()
    numbers = pieces.tangents(pieces.start), pieces.tangents(pieces.end), pieces.half
    own = dict(zip((*ENDS, FAR), numbers, strict=True))
    own |= {on_piece(name): values for name, values in zip(directions, pieces.directions, strict=True)}
    table, changing = _table_on_pieces(scene.table, directions), _over_angle(scene)
    if changing is not None:
        own |= {MIDDLE: pieces.tangents(0.5 * (pieces.start + pieces.end))}
        own |= _on_pieces(changing, group, pieces)
        table = _table_on_pieces(scene.table, directions, changing.rows(ANGLE))
    return table, {name: _of_pieces(values) for name, values in own.items()}


def _of_pieces(values: Array) -> Field:
    """Return numbers (design, piece) of designs, or in one row of all, as an input."""
    return Field((PIECE,), values[0]) if len(values) == 1 else Field((ONE, PIECE), values)


def _on_pieces(changing: Polynomials, group: Group, pieces: Pieces) -> dict[str, Array]:
    """Return the numbers of polynomials on pieces."""
    scene = group.scene
    frame = _in_one_row(group.number(scene.mechanism.near_toggle_angle)[:, None])
    places = places_of(scene.at_one_angle.inputs.sizes, group.designs[:, None])
    return changing.on_pieces(pieces.start + frame, pieces.end - pieces.start, places)


def on_piece(name: str) -> str:
    """Return the name of a direction that is known on a piece."""
    return f"{name}_on_piece"


@lru_cache(maxsize=64)
def _table_on_pieces(table: Table, directions: tuple[str, ...], changing: tuple[Row, ...] = ()) -> Table:
    """Return the table between samples with places on pieces, and with these rows of what changes over the angle."""
    between = table.between_samples
    known = dict(zip(WIDTHS, WIDTHS_AT_ENDS, strict=True)) | {name: on_piece(name) for name in directions}
    rows = (
        Row(crank_angle.place_on_piece, ("half_tangent",), (ALONG, END, *ENDS)),
        Row(crank_angle.angle_on_piece, (ANGLE,), ("half_tangent", MIDDLE)),
        *(Row(planar.identity, (name,), (own,)) for name, own in known.items()),
        *changing,
    )
    return between.replacing(*rows)


def _over_angle(scene: Scene) -> Polynomials | None:
    """Return the loads and speeds over the angle of a scene as polynomials, if there are any and they are such."""
    return None if scene.steady else polynomials(scene)


def _widths(pieces: Pieces, start: Array, end: Array, angles: Array, widths: Array) -> Array:
    """Return the widths of near-toggles (design, nth) as both ends of pieces know them (end, design, piece), as
    tangents of half the angle that follows a piece.

    Quantities have poles at tangents x ± i·width, at a share z of the piece. There tan² is z/(1 − z).
    """
    seen = np.ones((2, len(pieces.counts), start.shape[1]))
    for angle, width in zip(angles.T, widths.T, strict=True):
        rows = np.flatnonzero(width < NARROW)
        if len(rows):
            first, last, half = (x if len(x) == 1 else x[rows] for x in (start, end, pieces.half))
            from_middle = signed_distance(_in_one_row(angle[rows, None]), 180.0 * half)
            beside = np.abs(from_middle) < 180.0 - BEYOND
            near = np.flatnonzero(beside.any(axis=0))
            x, at, length = np.tan(np.radians(0.5 * from_middle[:, near])), np.ix_(rows, near), (last - first)[:, near]
            height = (1.0 + x * x) * width[rows, None]
            for of_end, distance in zip(seen, (x - first[:, near], last[:, near] - x), strict=True):
                limit = _imaginary_root(distance, length, height)
                of_end[at] = np.where(beside[:, near], np.minimum(of_end[at], limit), of_end[at])
    return seen


def _imaginary_root(distance: Array, length: Array, height: Array) -> Array:
    """Return the imaginary part of √(z/(1 − z)), z = (distance + i·height)/length: inf of z = 1."""
    below = (length - distance) ** 2 + height * height
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.sqrt((distance * distance + height * height) / below)
        real = (distance * (length - distance) - height * height) / below
    return np.where(below > 0.0, np.sqrt(0.5 * np.maximum(size - real, 0.0)), np.inf)
