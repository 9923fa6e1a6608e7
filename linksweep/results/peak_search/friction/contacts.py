"""Find where one of two contacts that share a force bears nothing: friction acts in another way beyond, or jams.

That depends on forces and thus on loads, so it is searched on the arcs that the limits of the motion leave.
"""

from __future__ import annotations

import numpy as np

from linksweep.engine.quantity import Limit
from linksweep.results.peak_search.between import EVERYWHERE
from linksweep.results.peak_search.curves import Curves, zeros_and_extremes
from linksweep.results.peak_search.groups import Group
from linksweep.results.peak_search.limits import graded_samples, on_arcs, on_turns
from linksweep.scene.pairs import Array, by_row, in_period

Zeros = tuple[Array, Array]
"""The design of each zero, by its row in a group, and its angle [degree]."""


def contact_angles(group: Group, jumps: Array) -> Array:
    """Return those angles (design, nth) [degree]; samples on both sides of `jumps` (design, nth) know forces there."""
    designs, contacts = len(group.designs), group.scene.table.contacts
    if not contacts or group.limits is None:
        return np.empty((designs, 0))
    row, nth = np.nonzero(np.isfinite(group.limits.arc_start))
    whole = group.limits.assembly[row] == EVERYWHERE
    period, zeros = group.scene.period_of_motion, [(np.empty(0, dtype=int), np.empty(0))]
    for turns in (True, False):
        own, which = row[whole == turns], nth[whole == turns]
        if not len(own):
            continue
        dense = np.concatenate([graded_samples(*group.some(own).near_toggles()), jumps[own]], axis=1)
        start, end = (table[own, which] for table in (group.limits.arc_start, group.limits.arc_end))
        x = on_turns(dense, period) if turns else on_arcs(start, end, dense, period)
        zeros += [_zeros(group, contact, own, x, turns) for contact in contacts]
    rows, angles = map(np.concatenate, zip(*zeros, strict=True))
    return by_row(rows, angles, designs)


def _zeros(group: Group, contact: Limit, row: Array, x: Array, turns: bool) -> Zeros:
    """Return the zeros of a limit's signals along arcs with samples x (arc, sample), in every period of the motion."""
    zeros = []
    for start in np.arange(0.0, group.scene.period, group.scene.period_of_motion):
        curves = Curves(group.scene, contact, group.designs[row], x + start, turns)
        curve, angle, turning = zeros_and_extremes(curves)
        touching = turning.some(np.abs(turning.height) <= turning.noise)
        zeros += [(row[curves.arc(curve)], angle), (row[curves.arc(touching.curve)], touching.x[1])]
    rows, angles = map(np.concatenate, zip(*zeros, strict=True))
    return rows, in_period(angles, group.scene.period)
