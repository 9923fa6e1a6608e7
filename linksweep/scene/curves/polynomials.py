"""Find the polynomials that loads over the angle are between two angles of their tables.

Cubic splines, pchip curves, straight lines and steps are cubics between two neighbouring angles of their arrays, the
knots; so is each input of the engine that is a multiple of one. A cubic is that through four samples of its interval; a
fifth shows whether the input is one. The samples lie inside, so that a jump at a knot has its limit on either side.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr

from linksweep.engine.run import Field
from linksweep.scene.curves.over_angle import period_of

if TYPE_CHECKING:
    from linksweep.scene.scene import Scene

Array = np.ndarray

TERMS = 4
"""Coefficients of a cubic."""
NODES = 0.5 - 0.5 * np.cos(np.pi * (np.arange(TERMS) + 0.5) / TERMS)
"""Places of the samples in an interval, those of Chebyshev: from 0 to 1."""
CHECKED = 0.5
"""Place of the sample that shows whether an input is a cubic."""
TO_COEFFICIENTS = np.linalg.inv(NODES[:, None] ** np.arange(TERMS))
ROUNDING = 1e-13
"""Difference, relative to the input's largest size, from which on an input is no cubic."""
LONGEST = 45.0
"""Longest interval [degree]: longer ones are divided evenly."""
MOST_KNOTS, LONGEST_PIECE = 4, 60.0
"""Most knots of a piece, and its greatest length [degree]: with more knots an evaluation takes more operations, with
more pieces there are more samples."""
ROUNDED = 1e-7
"""Distance of two angles that are one but for rounding [degree]."""
SHORTEST = 1e-6
"""Shortest interval [degree]: that of angles with which a jump is imitated, or of two tables that differ by rounding,
is too short for samples."""


class Polynomials(NamedTuple):
    """Inputs of the engine that change over the angle, as cubics between knots.

    `knots` [degree] are in order, the first again after a period. The coefficients (interval, power, design dims…) of
    each input are those of powers of the angle from the interval's knot [rad]. The cycle is cut into pieces at the
    knots with the numbers `cuts`: where an input jumps or bends, and so often that a piece has no more than `per_piece`
    knots.
    """

    knots: Array
    inputs: dict[str, Field]
    cuts: Array
    per_piece: int

    def on_pieces(self, start: Array, length: Array, places: Mapping[str, Array]) -> dict[str, Array]:
        """Return the numbers of the cubics on pieces of designs at these places, by `names_on_piece`.

        Pieces start at any angle and have any length between two cuts [degree]; their angles are measured from the
        middle [rad].
        """
        count, period = len(self.knots) - 1, self.knots[-1] - self.knots[0]
        knots = np.append(self.knots, self.knots[1:] + period)
        start = self.knots[0] + np.mod(start - self.knots[0] + ROUNDED, period) - ROUNDED
        first = np.searchsorted(knots, start + ROUNDED, side="right") - 1
        last = np.searchsorted(knots, start + length - ROUNDED, side="left") - 1
        at_designs = {name: tuple(places[dim] for dim in field.dims) for name, field in self.inputs.items()}
        numbers = {}
        for nth in range(self.per_piece):
            interval = np.minimum(first + nth, last)
            away = np.radians(knots[interval] - (start + 0.5 * length))
            numbers[_knot(nth)] = np.where((first + nth > last) & (nth > 0), np.inf, away)
            for name, field in self.inputs.items():
                terms = np.moveaxis(field.values, 1, -1)[(interval % count, *at_designs[name])]
                numbers |= zip(_terms(name, nth), terms.T, strict=True)
        return numbers


def names_on_piece(name: str, per_piece: int) -> tuple[str, ...]:
    """Return the names of the numbers that state an input on a piece: for each knot its angle and coefficients."""
    return tuple(chain.from_iterable((_knot(nth), *_terms(name, nth)) for nth in range(per_piece)))


def _knot(nth: int) -> str:
    return f"knot_{nth}"


def _terms(name: str, nth: int) -> tuple[str, ...]:
    return tuple(f"{name}_{nth}_{power}" for power in range(TERMS))


@lru_cache(maxsize=2)
def polynomials(scene: Scene) -> Polynomials | None:
    """Return the inputs of a scene that change over the angle as cubics; None where they are none.

    That is so of functions, of the pressure of ideal cycles, and where the speed of the crank changes.
    """
    tables = [array for array in scene.arrays.values() if "theta2" in array.coords]
    if scene.steady or scene.functions or scene.changes_speed or not tables:
        return None
    knots = _knots(scene, tables)
    steps = np.diff(knots)
    if steps.min() < SHORTEST:
        return None
    angles = knots[:-1, None] + steps[:, None] * np.append(NODES, CHECKED)
    grid = scene.grid(np.mod(angles.ravel(), scene.period))
    changing = {name: field for name, field in scene.at(grid).inputs.fields.items() if grid.dim in field.dims}
    inputs = {name: _cubics(field, grid.dim, np.radians(steps)) for name, field in changing.items()}
    known = {name: field for name, field in inputs.items() if field is not None}
    cuts = _cuts(scene, knots)
    per_piece = int(np.diff(cuts, append=len(steps)).max())
    return Polynomials(knots, known, knots[cuts], per_piece) if len(known) == len(inputs) else None


def _knots(scene: Scene, tables: list[xr.DataArray]) -> Array:
    """Return the angles of tables in the whole period, and the first again after it; long intervals are divided."""
    every = []
    for table in tables:
        period = period_of(table, scene.mechanism.period)
        every.append(np.add.outer(np.arange(0.0, scene.period, period), np.mod(table["theta2"].values, period)).ravel())
    knots = np.unique(np.concatenate(every))
    knots = np.append(knots, knots[0] + scene.period)
    parts = [math.ceil(step / LONGEST) for step in np.diff(knots)]
    divided = [
        np.linspace(start, end, n, endpoint=False) for start, end, n in zip(knots[:-1], knots[1:], parts, strict=True)
    ]
    return np.append(np.concatenate(divided), knots[-1])


def _cuts(scene: Scene, knots: Array) -> list[int]:
    """Return the numbers of the knots at which pieces start."""
    corners = np.array([jump for jump in scene.jumps() if not hasattr(jump, "dims")])
    away = np.mod(knots[:, None] - corners + 0.5 * scene.mechanism.period, scene.mechanism.period)
    corner = (np.abs(away - 0.5 * scene.mechanism.period) < ROUNDED).any(axis=1)
    cuts = [0]
    for k in range(1, len(knots) - 1):
        if corner[k] or k - cuts[-1] == MOST_KNOTS or knots[k + 1] - knots[cuts[-1]] > LONGEST_PIECE:
            cuts.append(k)
    return cuts


def _cubics(field: Field, dim: str, steps: Array) -> Field | None:
    """Return the coefficients of an input from its samples in each interval; None where it is no cubic there."""
    axis = field.dims.index(dim)
    values = np.moveaxis(field.values, axis, 0)
    values = values.reshape(len(steps), TERMS + 1, *values.shape[1:])
    coefficients = np.tensordot(values[:, :TERMS], TO_COEFFICIENTS, axes=(1, 1))
    error = values[:, TERMS] - coefficients @ CHECKED ** np.arange(TERMS)
    if not np.all(np.abs(error) <= ROUNDING * np.max(np.abs(values))):
        return None
    lengths = steps.reshape(-1, *[1] * (coefficients.ndim - 1))
    coefficients = np.moveaxis(coefficients / lengths ** np.arange(TERMS), -1, 1)
    return Field(tuple(name for name in field.dims if name != dim), np.ascontiguousarray(coefficients))
