"""Crank angles at which forces jump and which parameters move in a way that is known, each angle once.

Several forces may jump at one angle, as gas and friction at a dead centre. Where they move alike, they are one jump, of
all that drops there; a load that only bends there has no part in it. Where parameters part them, they jump in either
order, and what is not linear in them has one derivative for each.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.degrees import signed_distance
from linksweep.results.derivatives.half_turns import half_turns
from linksweep.results.derivatives.of_peaks import size_of, unlike
from linksweep.results.derivatives.samples import Pairs, pairs_over
from linksweep.results.derivatives.sides import BESIDE, inputs_of, leaps, unlisted
from linksweep.scene.derivatives.differentiated import differentiated
from linksweep.scene.derivatives.sloped import Sloped, slopes_of, value_of
from linksweep.scene.inputs import as_field
from linksweep.scene.loads.changing_load import ChangingLoad
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene


class Jumps(NamedTuple):
    """Jumps of designs: their angles (jump, design) [degree], NaN where a design has none; how far parameters move them
    (jump, parameter, design) [degree]; and whether a parameter parts two of a design (parameter, design)."""

    angles: Array
    moves: Array
    parted: Array


def known_jumps(pairs: Pairs) -> Jumps:
    """Return the jumps of designs that move in a way that is known."""
    sources = sorted(_sources(pairs), key=lambda source: not source[2].any())  # those that move are first
    moving = sum(bool(moves.any()) for _, _, moves in sources)
    shape = (len(pairs.scene.to), len(pairs.designs))
    angles = np.array([angle for _, angle, _ in sources]).reshape(-1, shape[1])
    moves = np.array([own for *_, own in sources]).reshape(-1, *shape)
    loads, jumps = [load for load, *_ in sources], Jumps(angles, moves, np.zeros(shape, dtype=bool))
    for i in range(moving):
        near = np.abs(signed_distance(angles, angles[i], pairs.scene.period)) < BESIDE
        for j in map(int, np.flatnonzero(near.any(axis=1))):
            if j > i:
                _unite(pairs, loads, jumps, (i, j), near[j])
        _leave_to_unlisted(pairs, loads, jumps, i)
    return Jumps(angles[:moving], moves[:moving], jumps.parted)


def _unite(pairs: Pairs, loads: list[int], jumps: Jumps, two: tuple[int, int], near: Array) -> None:
    """Leave one of two jumps that are near each other: the first, or the second where the first load only bends."""
    (i, j), (angles, moves, parted) = two, jumps
    one, other = (near & _leaps(pairs, loads[k], angles[k]) for k in two)
    parted |= one & other & _unlike(pairs, moves[i], moves[j])
    angles[j, one], angles[i, near & ~one] = np.nan, np.nan


def _leave_to_unlisted(pairs: Pairs, loads: list[int], jumps: Jumps, i: int) -> None:
    """Leave a jump out where its load only bends and others jump that no parameter moves; mark it where it parts."""
    angles, moves, parted = jumps
    other = leaps(pairs, unlisted(pairs.scene), angles[i])
    if other.any():
        one = other & _leaps(pairs, loads[i], angles[i])
        parted |= one & (moves[i] != 0.0)
        angles[i, other & ~one] = np.nan


def parted_jumps(scene: Scene, to: tuple[str, ...]) -> dict[str, xr.DataArray]:
    """Return by parameter whether it parts two jumps at one angle, of each design."""
    own = differentiated(scene, (), to)
    pairs = pairs_over(own, tuple(own.at_one_angle.inputs.sizes))
    fields = map(pairs.field, known_jumps(pairs).parted)
    return {path: xr.DataArray(field.values, dims=field.dims) for path, field in zip(to, fields, strict=True)}


def moving_unknown(scene: Scene, to: tuple[str, ...]) -> bool:
    """Return whether forces jump at angles that a parameter may move in a way that is not known."""
    own = differentiated(scene, (), to)
    searched = any(limit.zeros == "jump" for limit in scene.table.limits or ()) and scene.mechanism.rubs
    return searched or any(not isinstance(jump.angle, Sloped | float) for jump in own.moving_jumps)


def _sources(pairs: Pairs) -> Iterator[tuple[int, Array, Array]]:
    """Yield the jumps over the whole cycle: the number of the load, angles of designs, and how far they are moved."""
    scene, turn = pairs.scene, pairs.scene.mechanism.period
    closed = [jump for jump in scene.moving_jumps if isinstance(jump.angle, Sloped | float)]
    each_turn = [(*jump, k * turn) for jump in closed for k in range(round(scene.period / turn))]
    for load, angle, later in [*each_turn, *((*jump, 0.0) for jump in half_turns(scene))]:
        first, slopes = pairs.numbers(as_field(value_of(angle))), slopes_of(angle)
        moves = np.array([pairs.numbers(as_field(slopes.get(path, 0.0))) for path in scene.to])
        yield load, first + later, moves


def _unlike(pairs: Pairs, one: Array, other: Array) -> Array:
    """Return whether parameters move two jumps differently (parameter, design)."""
    numbers = pairs.scene.numbers
    sizes = [pairs.numbers(as_field(size_of(*numbers[path]))) for path in pairs.scene.to]
    return unlike(one, other, 360.0, np.reshape(sizes, one.shape))


def _leaps(pairs: Pairs, load: int, angle: Array) -> Array:
    """Return whether a load, or the machine itself, jumps at an angle of each design, and does not only bend."""
    if not load or not isinstance(pairs.scene.loads[load - 1], ChangingLoad):
        return np.isfinite(angle)
    return leaps(pairs, inputs_of(pairs.scene, load), angle)
