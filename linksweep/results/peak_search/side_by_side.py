"""Find where signals of limits come near to zero, designs side by side: toggles, near-toggles, jumps and jams.

All signals are sampled on pieces of the turn, and those that come near to zero are looked at closely. Where one part of
a machine is in a toggle, or near one, those beyond it move quickly: the turn is divided there, and searched again,
until no other such place is found. Few designs that turn fully are searched more than twice.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from linksweep.engine.near_zero import dips, samples
from linksweep.engine.near_zero.find import dips_and_zeros
from linksweep.engine.peaks.roles import ANYWHERE, FAR, OF_HALF, TANGENT, WIDTHS
from linksweep.engine.quantity import Limit, Row, Table
from linksweep.engine.run import Field, Fields, evaluate
from linksweep.engine.trace.plan import Plan
from linksweep.physics.algebra import planar
from linksweep.physics.algebra.arithmetic import Number
from linksweep.results.peak_search.between import ONE, half_tangent, half_turn_of, number_of, one_by_one
from linksweep.scene.pairs import Array, by_row, joined, some_of
from linksweep.scene.scene import Scene

AT_ONCE = 8192
"""Designs searched together, so that the memory for it does not grow with a study."""
NOISE = 1e2
"""Distance from zero, in units of the signal's noise, from which on a signal is clear of it."""
FASTEST = 3.0
"""Turns of a wheel per turn of the crank up to which these samples suffice."""
NARROW = 0.1
"""Half-width of a near-toggle, as tangent of half the angle, below which samples must be dense about it."""
SAME = 0.5
"""Distance of two near-toggles, relative to their width, up to which samples about one are dense enough for both."""
SAME_TOGGLE = 1e-9
"""Distance of two toggles that are one, as tangent of half the angle."""
MORE_LOOKS = 3
"""Looks at a design, besides one for each of its limits, before it is left to another search."""
KINDS = {"toggle": dips.TOGGLE, "wedge": dips.BOUND, "dead_centre": dips.BOUND, "jump": dips.JUMP}
"""Kinds of signals, by what their zeros are."""
WIDTH = "turn_width"
"""Input that takes the place of the widths of near-toggles."""


class Events(NamedTuple):
    """Near-toggles, zeros and flat places of designs: row of the design, place on the turn as in
    `engine.near_zero.samples`, and number of the limit; half-width of a near-toggle, 0 of a zero, such as a toggle, and
    −1 times that of a flat place."""

    row: Array
    place: Array
    part: Array
    width: Array

    @property
    def angle(self) -> Array:
        """Angle from the middle of the first half turn [degree]."""
        half = self.place > samples.BORDER
        return 2.0 * np.degrees(np.arctan(self.place - samples.FAR_HALF * half)) + 180.0 * half


def search_side_by_side(scene: Scene, limits: tuple[Limit, ...], designs: Array) -> tuple[Array, Events, Array]:
    """Return the rows of those designs of a mechanism alone that this search suits; their events; and the angles of
    these [degree]. Left out are designs that touch a toggle but for noise, or have too many events."""
    simple = limits and scene.steady and scene.period == scene.mechanism.period
    simple = simple and scene.mechanism.fastest <= FASTEST and _all_move(scene, limits, designs)
    every = np.arange(len(designs) if simple else 0)
    parts = np.split(every, range(AT_ONCE, len(every), AT_ONCE))
    settled, some = zip(*(_search(scene, limits, designs, rows) for rows in parts), strict=True)
    events = joined(some)
    middle = number_of(scene, scene.mechanism.near_toggle_angle, designs)
    return np.concatenate(settled), events, events.angle + middle[events.row]


def _all_move(scene: Scene, limits: tuple[Limit, ...], designs: Array) -> bool:
    """Return whether the signals of all limits change with the angle: not where parts of a linkage stand still."""
    request, _ = _evaluated(scene, limits, designs[:1])
    return all(scene.mechanism.index in node.dims for name, node in request.outputs.items() if name not in WIDTHS)


def _search(scene: Scene, limits: tuple[Limit, ...], designs: Array, rows: Array) -> tuple[Array, Events]:
    """Return the rows of those designs in some rows that are not left out, and their events."""
    nothing = Events(np.empty(0, dtype=int), np.empty(0), np.empty(0, dtype=int), np.empty(0))
    before_others = np.array([limit.zeros == "toggle" for limit in limits[:-1]] + [False])
    settled, results, cuts = [rows[:0]], [nothing], nothing
    for _ in range(len(limits) + MORE_LOOKS):
        if not len(rows):
            break
        events, left = _look(scene, limits, designs[rows], cuts)
        known = _are_among(events, cuts, len(rows))
        narrow = np.where(events.width > 0.0, events.part < len(limits) - 1, before_others[events.part])
        narrow = (events.width < 0.0) | ((events.width < NARROW) & narrow)
        again = np.bincount(events.row[narrow & ~known], minlength=len(rows)) > 0
        done = ~(left | again)
        settled.append(rows[done])
        toggles = some_of(cuts, cuts.width == 0.0)
        own = joined([some_of(events, (events.width > 0.0) | ((events.width == 0.0) & ~(narrow & known))), toggles])
        own = some_of(own, done[own.row])
        results.append(own._replace(row=rows[own.row]))
        again &= ~left
        cuts = joined([some_of(events, narrow), some_of(cuts, cuts.width <= 0.0)])  # pieces that end there hide these
        cuts = some_of(cuts, again[cuts.row])
        rows, cuts = rows[again], _apart(cuts._replace(row=(np.cumsum(again) - 1)[cuts.row]))
    return np.concatenate(settled), joined(results)


def _are_among(events: Events, cuts: Events, designs: int) -> Array:
    """Return whether each of these places is one at which the turn is cut, and samples are dense enough."""
    place, width = (by_row(cuts.row, numbers, designs)[events.row] for numbers in (cuts.place, abs(cuts.width)))
    own = abs(events.width)[:, None]
    same = abs(place - events.place[:, None]) < np.maximum(SAME * own, SAME_TOGGLE)
    return (same & (width <= own / SAME)).any(axis=1)


def _apart(cuts: Events) -> Events:
    """Return cuts in order, without the wider ones of those that are nearly the same."""
    cuts = some_of(cuts, np.lexsort((cuts.place, cuts.row)))
    width = abs(cuts.width)
    wider = np.maximum(width[1:], width[:-1])
    same = (np.diff(cuts.row) == 0) & (np.diff(cuts.place) < np.maximum(SAME * wider, SAME_TOGGLE))
    dropped = np.flatnonzero(same) + (width[1:] >= width[:-1])[same]
    return _apart(some_of(cuts, np.delete(np.arange(len(width)), dropped))) if len(dropped) else cuts


def _look(scene: Scene, limits: tuple[Limit, ...], designs: Array, cuts: Events) -> tuple[Events, Array]:
    """Return the events on turns with these cuts, and whether each design is left out."""
    count = len(designs)
    places = np.concatenate([np.tile(samples.ENDS, (count, 1)), by_row(cuts.row, cuts.place, count)], axis=1)
    widths = np.concatenate([np.ones((count, len(samples.ENDS))), by_row(cuts.row, abs(cuts.width), count)], axis=1)
    order = np.argsort(places, axis=1)
    ends = np.stack([np.take_along_axis(numbers, order, axis=1) for numbers in (places, widths)])
    signals = [(k, KINDS[limit.zeros]) for k, limit in enumerate(limits) for _ in limit.signals]
    parts, kinds = map(np.array, zip(*signals, strict=True))
    numbers, left = dips_and_zeros(*_evaluated(scene, limits, designs), ONE, kinds, ends)
    row, nth = np.nonzero(np.isfinite(numbers[samples.PLACE]))
    place, half, signal, width = numbers[:, row, nth]
    return Events(row, place + samples.FAR_HALF * half, parts[signal.astype(int)], width), left


def _evaluated(scene: Scene, limits: tuple[Limit, ...], designs: Array) -> tuple[Plan, Fields]:
    """Return the plan of all signals of limits, each thrice, at places anywhere on a turn, and its inputs."""
    index, signals = scene.mechanism.index, [name for limit in limits for name in limit.signals]
    outputs = [*signals, *map("opposite of {}".format, signals), *map("upper bound of {}".format, signals)]
    places = ((ANYWHERE, (index, ONE)), (OF_HALF, (index, ONE)))
    own = {WIDTH: Field((ONE,), np.ones(len(designs)))}
    return one_by_one(scene, designs, _table(scene.table, limits), (*outputs, *WIDTHS), own, places)


def close_at(scene: Scene, limits: tuple[Limit, ...], designs: Array, angles: Array) -> Array:
    """Return whether each of these designs closes at an angle [degree]: signals are positive there but for noise."""
    toggles = [limit for limit in limits if limit.zeros == "toggle"]
    if not (toggles and len(designs)):
        return np.full(len(designs), True)
    signals, noise = ([name for limit in toggles for name in getattr(limit, part)] for part in ("signals", "noise"))
    angles = angles - number_of(scene, scene.mechanism.near_toggle_angle, designs)
    half = half_turn_of(angles)
    own = {TANGENT: Field((ONE,), half_tangent(angles, half)), FAR: Field((ONE,), half)}
    request, inputs = one_by_one(scene, designs, scene.table.between_samples, (*signals, *noise), own, ())
    values = evaluate(request, inputs, scene.grid(1), {ONE: len(designs)})
    return np.all([values[name].values >= -values[by].values for name, by in zip(signals, noise, strict=True)], axis=0)


@lru_cache(maxsize=64)
def _table(table: Table, limits: tuple[Limit, ...]) -> Table:
    """Return the table between samples, with opposites and upper bounds of the limits' signals."""
    rows = [Row(planar.identity, (width,), (WIDTH,)) for width in WIDTHS]
    rows += [Row(planar.identity, (name,), (own,)) for name, own in ((TANGENT, ANYWHERE), (FAR, OF_HALF))]
    for limit in limits:
        for name, noise in zip(limit.signals, limit.noise, strict=True):
            rows.append(Row(planar.opposite, (f"opposite of {name}",), (name,)))
            rows.append(Row(upper_bound, (f"upper bound of {name}",), (name, noise)))
    between = table.between_samples
    return between.replacing(*rows)


def upper_bound(signal: Number, noise: Number) -> Number:
    """Return the highest value that a signal may have, as far as its noise may have lowered it."""
    return signal + NOISE * noise
