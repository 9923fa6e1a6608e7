"""Find the strokes of linkages, which have no closed form of them: their ends, reversals, and positions' crank angles.

Even samples of a position and its rate, with the extremes of the rate between them, bracket every reversal; reversals,
the ends of arcs on which the machine closes, and the samples divide the motion into pieces on which the position goes
one way, so that each has one crank angle for a position at most.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.degrees import OFF_ROUND, signed_distance
from linksweep.base.validate import Number
from linksweep.engine.roots import roots
from linksweep.engine.trace.plan import plan
from linksweep.mechanisms.strokes import Angles, Stroke
from linksweep.scene.dimensions import aligned
from linksweep.scene.pairs import Array, by_row, different_designs, in_period, quantities_at

if TYPE_CHECKING:
    from linksweep.scene.scene import Scene

PER_TURN = 1440
"""Even samples of a turn."""
THIRDS = 40
"""Steps towards an extreme of a rate, each of which leaves two thirds of two steps between samples."""
HALVINGS = 60
"""Halvings of a step towards the end of an arc: to the last digit of its angle."""


def stroke_of(scene: Scene, name: str) -> Stroke:
    """Return the stroke of a position, located by a search where the mechanism has no closed form of it."""
    stroke = scene.mechanism.strokes[name]
    return stroke if stroke.crank_angles else _located(scene.unloaded, name)


@lru_cache(maxsize=4)
def _located(alone: Scene, name: str) -> Stroke:
    """Return the stroke of a position of a mechanism alone."""
    stroke = alone.mechanism.strokes[name]
    motion = _motion_of(alone, stroke)
    located = replace(stroke, crank_angles=motion.crank_angles, turning=motion.columns(motion.reversals))
    if not stroke.from_end:
        return located
    with np.errstate(invalid="ignore"):
        return replace(located, start=motion.over_designs(np.fmax.reduce(motion.position, axis=1)))


class Motion(NamedTuple):
    """A position of designs over a period [degree]: at angles in order (design, place), NaN where it is not assembled.

    `reversals` (design, nth) are the angles [degree] at which it turns round. `at` returns it for pairs of a design, by
    its row, and an angle; `turns` states that it is an angle [degree]. `sizes` are those of the designs' dims.
    """

    angle: Array
    position: Array
    reversals: Array
    at: Callable[[Array, Array], Array]
    turns: bool
    sizes: dict[str, int]
    period: float

    def crank_angles(self, position: Number) -> Angles:
        """Return the crank angles [degree] at which designs have a position; NaN for none."""
        target = np.broadcast_to(self._by_design(position)[:, None], self.position.shape)
        away = self._away(self.position, target)
        following = np.roll(away, -1, axis=1)
        leap = 180.0 if self.turns else np.inf  # opposite to the position an angle leaps by a turn
        with np.errstate(invalid="ignore"):
            row, k = np.nonzero(((away < 0.0) != (following < 0.0)) & (abs(following - away) < leap))
        start = self.angle[row, k]
        end = start + in_period(self.angle[row, (k + 1) % self.angle.shape[1]] - start, self.period)
        at = roots(
            lambda root, angle: self._away(self.at(row[root], angle), target[row[root], 0]),
            np.stack([start, end]),
            np.stack([away[row, k], following[row, k]]),
        )
        return self.columns(by_row(row, in_period(at, self.period), len(self.angle)))

    def columns(self, table: Array) -> Angles:
        """Return the columns of a table (design, nth) over the designs' dims."""
        return tuple(map(self.over_designs, table.T))

    def over_designs(self, values: Array) -> Number:
        """Return numbers of designs over their dims."""
        return xr.DataArray(values.reshape(tuple(self.sizes.values())), dims=tuple(self.sizes))

    def _by_design(self, number: Number) -> Array:
        """Return a number for each design, one that may be over their dims."""
        return np.broadcast_to(aligned(number, tuple(self.sizes)), tuple(self.sizes.values())).ravel()

    def _away(self, position: Array, target: Array) -> Array:
        return signed_distance(position, target) if self.turns else position - target


def _motion_of(alone: Scene, stroke: Stroke) -> Motion:
    """Return the motion of a stroke's position."""
    names, period = (stroke.quantity, stroke.slope), alone.period
    designs = different_designs(alone, names)
    loops = plan(alone.table, names, alone.at_one_angle.inputs.forms).loops
    sizes = {dim: size for dim, size in alone.at_one_angle.inputs.sizes.items() if dim in loops}

    def at(row: Array, angle: Array) -> Array:
        return quantities_at(alone, names, designs[row], angle)

    count = PER_TURN * round(period / alone.mechanism.period)
    even = np.tile((np.arange(count) + OFF_ROUND) * (period / count), (len(designs), 1))
    rows = np.repeat(np.arange(len(designs)), count)
    position, rate = at(rows, even.ravel()).reshape(2, *even.shape)
    known, step = np.isfinite(rate), period / count
    row, reversal = zeros_between(lambda row, angle: at(row, angle)[1], even, rate, step)
    end_row, end = _ends_of_arcs(at, even, known, np.roll(known, -1, axis=1), step)
    special = by_row(np.append(row, end_row), in_period(np.append(reversal, end), period), len(designs))
    special = np.where(np.isnan(special), even[:, :1], special)
    angle = np.sort(np.concatenate([even, special], axis=1), axis=1)
    rows = np.repeat(np.arange(len(designs)), angle.shape[1])
    position = at(rows, angle.ravel())[0].reshape(angle.shape)
    reversals = by_row(row, in_period(reversal, period), len(designs))
    turns = stroke.kind == "angle"
    return Motion(angle, position, reversals, lambda row, angle: at(row, angle)[0], turns, sizes, period)


def zeros_between(
    value_at: Callable[[Array, Array], Array], angles: Array, values: Array, step: float
) -> tuple[Array, Array]:
    """Return design and angle [degree] of the zeros of a smooth periodic function with values (design, sample).

    They lie between samples that differ in sign, and on either side of an extreme beyond zero between samples that do
    not; NaN are passed over.
    """
    following = np.roll(values, -1, axis=1)
    known = np.isfinite(values) & np.isfinite(following)
    row, k = np.nonzero(known & ((values < 0.0) != (following < 0.0)))
    start = angles[row, k]
    near, middle, least = _extremes_towards_zero(value_at, angles, values, step)
    beyond = np.flatnonzero(least * values[near] < 0.0)
    (turned, j), middle, least = (index[beyond] for index in near), middle[beyond], least[beyond]
    rows, first = np.concatenate([row, turned, turned]), angles[turned, j]
    count = values.shape[1]
    places = [(start, first - step, middle), (start + step, middle, first + step)]
    ends = [
        (values[row, k], values[turned, j - 1], least),
        (following[row, k], least, values[turned, (j + 1) % count]),
    ]
    x, heights = (np.stack([np.concatenate(end) for end in both]) for both in (places, ends))
    return rows, roots(lambda root, angle: value_at(rows[root], angle), x, heights)


def _extremes_towards_zero(
    value_at: Callable[[Array, Array], Array], angles: Array, values: Array, step: float
) -> tuple[tuple[Array, Array], Array, Array]:
    """Return the samples nearest to zero, of one sign with those beside them, about which a function may reach it; the
    angle [degree] of its extreme about each, and its value there."""
    size, before, after = (np.abs(np.roll(values, shift, axis=1)) for shift in (0, 1, -1))
    signs = np.sign(values)
    with np.errstate(all="ignore"):
        nearest = (signs == np.roll(signs, 1, axis=1)) & (signs == np.roll(signs, -1, axis=1))
        nearest &= (size < before) & (size <= after)
        drop = (before - after) ** 2 / (8.0 * (before + after - 2.0 * size))  # of the parabola through all three
        row, k = np.nonzero(nearest & (drop > 0.5 * size))
    low, high, sign = angles[row, k] - step, angles[row, k] + step, signs[row, k]
    for _ in range(THIRDS):
        third = (high - low) / 3.0
        left, right = (sign * value_at(row, angle) for angle in (low + third, high - third))
        low, high = np.where(left < right, low, low + third), np.where(left < right, high - third, high)
    middle = 0.5 * (low + high)
    return (row, k), middle, value_at(row, middle)


def _ends_of_arcs(
    at: Callable[[Array, Array], Array], angles: Array, known: Array, known_after: Array, step: float
) -> tuple[Array, Array]:
    """Return the design and the last angle [degree] of each end of an arc that lies between two samples."""
    row, k = np.nonzero(known != known_after)
    inside = angles[row, k] + np.where(known[row, k], 0.0, step)
    outside = angles[row, k] + np.where(known[row, k], step, 0.0)
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        closes = np.isfinite(at(row, middle)[1])
        inside, outside = np.where(closes, middle, inside), np.where(closes, outside, middle)
    return row, inside
