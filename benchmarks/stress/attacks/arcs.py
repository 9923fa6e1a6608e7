"""Compare two searches for the limits of random linkages: all designs side by side, and one part after the other.

They share the signals, not the samples: a short arc that one of them steps over is found by the other.
"""

from __future__ import annotations

from collections.abc import Iterator
from unittest.mock import patch

import numpy as np

import linksweep as ls
from benchmarks.stress.attacks import Outcome
from benchmarks.stress.six_bars import KINDS, OTHERS
from linksweep.engine.quantity import Limit
from linksweep.results.peak_search import limits as one_after_the_other
from linksweep.results.peak_search.limits import Limits, find_limits
from linksweep.results.peak_search.side_by_side import Events, search_side_by_side

TITLE = "arcs, dead centres and jams of random linkages of every topology: two searches find the same"
ROUNDS = 200
SMALL = 3
DESIGNS = 1000
"""Designs of one kind in a round."""
ALLOWED = 1e-6
"""Difference between two angles that are the same, and length of an arc that is a point [degree]."""

Array = np.ndarray


def attack(random: np.random.Generator, rounds: int) -> Outcome:
    kinds, failures = [*KINDS.items(), *OTHERS.items()], []
    for k in range(rounds):
        kind, drawn = kinds[k % len(kinds)]
        failures += [f"round {k}, {kind}: {failure}" for failure in unequal(drawn(random, DESIGNS))]
    return Outcome(rounds, failures)


def unequal(scene: ls.Scene) -> Iterator[str]:
    """Yield a sentence about each table of limits of a scene that differs between the searches, with a design."""
    machine, limits, designs = scene.unloaded, scene.table.limits or (), np.arange(DESIGNS)
    both = find_limits(machine, limits, designs)
    with patch.object(one_after_the_other, "search_side_by_side", _of_none):
        other = find_limits(machine, limits, designs)
    pairs = zip(_comparable(both, other, machine.period), _comparable(other, other, machine.period), strict=True)
    for name, tables in zip(("starts of arcs", "ends of arcs", "zeros"), pairs, strict=True):
        odd = _alone(*tables, machine.period) | _alone(*tables[::-1], machine.period)
        if odd.any():
            k = np.flatnonzero(odd)[0]
            one, two = (table[k][np.isfinite(table[k])] for table in tables)
            yield f"{name} of {odd.sum()} designs, of design {k}: {one} degrees, and {two}"


def _comparable(limits: Limits, known: Limits, period: float) -> tuple[Array, Array, Array]:
    """Return starts, ends and zeros (design, …), NaN in place of arcs that are points, and of zeros that do not lie
    inside a known arc: nobody asks for these."""
    starts, ends, zeros = limits.arc_start, limits.arc_end, limits.zeros
    lengths, known_lengths = ends - starts, known.arc_end - known.arc_start
    along = np.mod(zeros[..., None] - known.arc_start[:, None, None], period)
    inside = (along > ALLOWED) & (along < known_lengths[:, None, None] - ALLOWED)
    arcs = (np.where(lengths > ALLOWED, table, np.nan) for table in (starts, ends))
    return *arcs, np.where(inside.any(axis=-1), zeros, np.nan)


def _alone(one: Array, two: Array, period: float) -> Array:
    """Return whether designs have an angle in one table that no angle of theirs in the other is equal to."""
    away = np.mod(one[..., :, None] - two[..., None, :], period)
    nearest = np.nan_to_num(np.minimum(away, period - away), nan=np.inf).min(axis=-1, initial=np.inf)
    return (np.isfinite(one) & (nearest > ALLOWED)).reshape(len(one), -1).any(axis=1)


def _of_none(scene: ls.Scene, limits: tuple[Limit, ...], designs: Array) -> tuple[Array, Events, Array]:
    return search_side_by_side(scene, limits, designs[:0])
