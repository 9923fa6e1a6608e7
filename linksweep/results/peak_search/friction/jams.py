"""Find the crank angles at which friction jams a slide: between jumps and zeros of contacts a status does not change.

The status in the middle of each piece between these, and between even cuts beside, shows which pieces are jammed;
bisection finds the ends.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linksweep.base.degrees import OFF_ROUND
from linksweep.engine.quantity import LAST_UNJAMMED
from linksweep.engine.run import Field
from linksweep.results.peak_search.arcs import arc_ends_of_whole_period
from linksweep.results.peak_search.between import EVERYWHERE
from linksweep.results.peak_search.groups import Group, all_at_once, different, empty_over_all, groups
from linksweep.results.peak_search.paths import ASIDE, jump_angles
from linksweep.scene.pairs import Array, by_row, in_order, joined, some_of
from linksweep.scene.scene import Scene

STEP = 2.0
"""Step of the even cuts [degree]."""
STATUS = ("status", "status_at")
FREE = 0
"""Place of a jam where there is none."""
HALVINGS = 50
"""Halvings of the distance of two pieces down to the last digits of an angle."""


class Jams(NamedTuple):
    """Jams: row of the design, start and end [degree], and the number of the place, as `status_at` counts them."""

    row: Array
    start: Array
    end: Array
    place: Array


class Pieces(NamedTuple):
    """Pieces of the period of designs, in order: row of the design, middle [degree], and the place that is jammed."""

    row: Array
    middle: Array
    place: Array


def may_jam(scene: Scene) -> bool:
    """Return whether friction may jam a slide of a machine without closed forms."""
    return scene.table.limits is not None and scene.mechanism.rubs


def jammed_designs(scene: Scene) -> Field:
    """Return whether each design that closes at all angles is jammed at any."""
    jammed, every = empty_over_all(scene, STATUS), all_at_once(scene, different(scene, STATUS))
    every = every.some(np.flatnonzero(every.assembly() == EVERYWHERE))
    same = _never_changes(every)
    known = every.some(np.flatnonzero(same))
    row = np.arange(len(known.designs))
    of_groups = [(known, _jammed_place(known, row, np.full(len(row), OFF_ROUND)) != FREE)]
    for group in groups(scene, every.designs[~same]):
        pieces = _pieces(group)
        of_groups.append((group, np.bincount(pieces.row, pieces.place != FREE, len(group.designs)) > 0))
    for group, values in of_groups:
        jammed.values[tuple(group.places[dim] for dim in jammed.dims)] = values if jammed.dims else values.any()
    return Field(jammed.dims, jammed.values > 0.0)


def _never_changes(group: Group) -> Array:
    """Return whether each design that closes at all angles is jammed at all or at none: jams begin where friction
    wedges, or where one of two contacts bears nothing."""
    begins = np.concatenate([group.zeros("wedge"), group.zeros("dead_centre")], axis=1)
    return ~np.isfinite(begins).any(axis=1) & (not group.scene.table.contacts)


def jam_tables(scene: Scene) -> tuple[tuple[str, ...], Array, Array, Array]:
    """Return the design dims of jams, and tables (design dims…, jam) of their starts, ends and places; NaN for none."""
    dims, values = empty_over_all(scene, STATUS)
    parts = [Jams(*(np.empty(0, dtype=kind) for kind in (int, float, float, int)))]
    for group in groups(scene, different(scene, STATUS)):
        jams = _jams(group)
        places = tuple(group.places[dim][jams.row] for dim in dims)
        parts.append(jams._replace(row=np.ravel_multi_index(places, values.shape) if dims else jams.row))
    row, *numbers = joined(parts)
    tables = (by_row(row, number.astype(float), values.size) for number in numbers)
    start, end, place = (table.reshape(*values.shape, table.shape[1]) for table in tables)
    return dims, start, end, place


def _jams(group: Group) -> Jams:
    """Return the jams of designs, each ended by the next change of place."""
    row, middle, place = _pieces(group)
    period, following = group.scene.period, _next_of_row(row)
    changes = np.flatnonzero(place[following] != place)
    ahead = middle[following] + np.where(following <= np.arange(len(row)), period, 0.0)
    angle = _bisected(group, row[changes], place[changes], middle[changes], ahead[changes])
    after, end = place[following[changes]], angle[_next_of_row(row[changes])] if len(changes) else angle
    end = end + np.where(end <= angle, period, 0.0)
    always = np.flatnonzero((place != FREE) & ~np.isin(row, row[changes]) & (np.diff(row, prepend=-1) > 0))
    ended = some_of(Jams(row[changes], angle, end, after), after != FREE)
    whole = Jams(row[always], np.zeros(len(always)), np.full(len(always), period), place[always])
    jams = joined([ended, whole])
    turns = np.floor(jams.start / period) * period
    jams = jams._replace(start=jams.start - turns, end=jams.end - turns)
    return some_of(jams, np.lexsort((jams.start, jams.row)))


def _pieces(group: Group) -> Pieces:
    """Return the pieces of a group's designs, without those as short as the noise of a jump."""
    period = group.scene.period
    even = np.broadcast_to(np.arange(0.5 * STEP, period, STEP), (len(group.designs), round(period / STEP)))
    ends = arc_ends_of_whole_period(group)
    cuts = in_order(np.mod(np.concatenate([even, jump_angles(group), *ends], axis=1), period))
    length = np.diff(cuts, axis=1, append=cuts[:, :1] + period)
    row, nth = np.nonzero(length > 4.0 * ASIDE)
    middle = (cuts + 0.5 * length)[row, nth]
    return Pieces(row, middle, _jammed_place(group, row, middle))


def _jammed_place(group: Group, row: Array, angle: Array) -> Array:
    """Return the place that is jammed at angles of designs, `FREE` for none."""
    status, place = group.values(STATUS, row, angle)
    return np.where(status > LAST_UNJAMMED, place, FREE).astype(int)


def _next_of_row(row: Array) -> Array:
    """Return the index of the next item of the same row, of its last item that of the first; rows are in order."""
    count = np.arange(len(row))
    first = np.searchsorted(row, row)
    return np.where(np.append(row[1:] != row[:-1], True), first, count + 1)


def _bisected(group: Group, row: Array, place: Array, before: Array, after: Array) -> Array:
    """Return the angle at which the jammed place changes from this one, between two angles."""
    for _ in range(HALVINGS):
        middle = 0.5 * (before + after)
        same = _jammed_place(group, row, middle) == place
        before, after = np.where(same, middle, before), np.where(same, after, middle)
    return after
