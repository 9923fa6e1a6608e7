"""Find the polynomials that loads and speeds over the angle are, interval by interval of the cycle.

Cubic splines, pchip curves, straight lines and steps are cubics between two neighbouring angles of their arrays, the
knots; smooth functions are polynomials of more terms in short intervals. So is each input of the engine that is a
multiple of one. Its polynomial is that through samples of its interval; one more shows whether the input is one. The
samples lie inside, so that a jump at a knot has its limit on either side. The acceleration that follows from a speed is
that of its polynomial.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.degrees import signed_distance
from linksweep.base.frozen import cached_beside
from linksweep.base.validate import Rule
from linksweep.engine.quantity import Row
from linksweep.engine.run import Field
from linksweep.physics.closures import crank_angle
from linksweep.scene.curves import smooth
from linksweep.scene.curves.over_angle import called, period_of

if TYPE_CHECKING:
    from linksweep.scene.scene import Scene

Array = np.ndarray

SPEED, ACCELERATION = "omega2", "alpha2"
"""Inputs: the speed of the crank, and the acceleration that may follow from one that changes."""
CUBIC = 4
"""Coefficients of a cubic."""
CHECKED = 0.1
"""Place of the sample that shows whether an input is a polynomial, from −1 to 1 in its interval."""
ROUNDING = 1e-13
"""Difference, relative to the input's largest size, from which on an input is no polynomial."""
MOST_KNOTS, LONGEST_PIECE = 4, 30.0
"""Most knots of a piece, and its greatest length [degree]: with more knots an evaluation takes more operations, with
more pieces there are more samples."""
ROUNDED = 1e-7
"""Distance of two angles that are one but for rounding [degree]."""
SHORTEST = 1e-6
"""Shortest interval [degree]: that of angles with which a jump is imitated, or of two tables that differ by rounding,
is too short for samples."""


class Polynomials(NamedTuple):
    """Inputs of the engine that change over the angle, as polynomials between knots.

    `knots` [degree] are in order, the first again after a period. The coefficients (interval, power, design dims…) of
    each input are those of powers of the angle from the interval's `origin` [rad]. The cycle is cut into pieces at
    `cuts`: where an input jumps or bends, and so often that a piece has no more than `per_piece` knots. From a speed
    that `accelerates` follows alpha2.
    """

    knots: Array
    origins: Array
    inputs: dict[str, Field]
    cuts: Array
    per_piece: int
    accelerates: bool

    def rows(self, angle: str) -> tuple[Row, ...]:
        """Return the rows that make the inputs from the angle on a piece, by its name, and numbers of the piece."""
        rows = []
        for name, field in self.inputs.items():
            terms = field.values.shape[1]
            numbers = chain.from_iterable((_origin(nth), *_terms(name, nth, terms)) for nth in range(self.per_piece))
            if self.accelerates and name == SPEED:
                rows.append(Row(crank_angle.speed_on_piece, (SPEED, ACCELERATION), (angle, *numbers)))
            else:
                function = crank_angle.polynomial_on_piece if self.per_piece == 1 else crank_angle.cubics_on_piece
                rows.append(Row(function, (name,), (angle, *numbers)))
        return tuple(rows)

    def turns_one_way(self) -> Field:
        """Return where the speed surely keeps its sign: in no interval do the other terms add up to the first one."""
        speed = self.inputs[SPEED]
        half, powers = np.radians(0.5 * np.diff(self.knots)), np.arange(1, speed.values.shape[1])
        others = np.einsum("ip,ip...->i...", half[:, None] ** powers, np.abs(speed.values[:, 1:]))
        return Field(speed.dims, (others < np.abs(speed.values[:, 0])).all(axis=0))

    def on_pieces(self, start: Array, length: Array, places: Mapping[str, Array]) -> dict[str, Array]:
        """Return the numbers of pieces of designs at these places, by the names that `rows` take.

        Pieces start at any angle and have any length between two cuts [degree]; their angles are measured from the
        middle [rad].
        """
        count, period = len(self.knots) - 1, self.knots[-1] - self.knots[0]
        knots, origins = np.append(self.knots, self.knots[1:] + period), np.append(self.origins, self.origins + period)
        start = self.knots[0] + np.mod(start - self.knots[0] + ROUNDED, period) - ROUNDED
        first = np.searchsorted(knots, start + ROUNDED, side="right") - 1
        last = np.searchsorted(knots, start + length - ROUNDED, side="left") - 1
        last = np.maximum(first, last)  # a rounding error before a knot, a piece may be shorter than that of its start
        at_designs = {name: tuple(places[dim] for dim in field.dims) for name, field in self.inputs.items()}
        numbers = {}
        for nth in range(self.per_piece):
            interval = np.minimum(first + nth, last)
            away = np.radians(origins[interval] - (start + 0.5 * length))
            numbers[_origin(nth)] = np.where((first + nth > last) & (nth > 0), np.inf, away)
            for name, field in self.inputs.items():
                terms = np.moveaxis(field.values, 1, -1)[(interval % count, *at_designs[name])]
                numbers |= zip(_terms(name, nth, terms.shape[-1]), np.moveaxis(terms, -1, 0), strict=True)
        return numbers


def _origin(nth: int) -> str:
    return f"origin_{nth}"


def _terms(name: str, nth: int, count: int) -> tuple[str, ...]:
    return tuple(f"{name}_{nth}_{power}" for power in range(count))


@cached_beside
def polynomials(scene: Scene) -> Polynomials | None:
    """Return the inputs of a scene that change over the angle as polynomials; None where they are none.

    That is so of functions that jump or bend elsewhere than at their breaks, and of the pressure of ideal cycles.
    """
    tables = [array for array in scene.arrays.values() if "theta2" in array.coords]
    if scene.steady or not (tables or scene.functions):
        return None
    knots = _knots_of_functions(scene, tables) if scene.functions else _knots(scene, tables)
    if knots is None or np.diff(knots).min() < SHORTEST:
        return None
    terms, cuts = (smooth.TERMS, [*range(len(knots) - 1)]) if scene.functions else (CUBIC, _cuts(scene, knots))
    half, per_piece = 0.5 * np.diff(knots), int(np.diff(cuts, append=len(knots) - 1).max())
    middle, places = knots[:-1] + half, np.append(smooth.chebyshev(terms), CHECKED)
    grid = scene.grid(np.mod((middle[:, None] + half[:, None] * places).ravel(), scene.period))
    from_middle = 0.0 if per_piece == 1 else 1.0  # where the origin is, of which there may be several on a piece
    changing = {name: field for name, field in scene.at(grid).inputs.fields.items() if grid.dim in field.dims}
    if accelerates := scene.changes_speed and scene.alpha2 is None:
        del changing[ACCELERATION]
    places, half_lengths = places + from_middle, np.radians(half)
    inputs = {name: _polynomials(field, grid.dim, places, half_lengths) for name, field in changing.items()}
    known = {name: field for name, field in inputs.items() if field is not None}
    origins = middle - from_middle * half
    if len(known) < len(inputs):
        return None
    return Polynomials(knots, origins, known, knots[cuts], per_piece, accelerates)


def _knots(scene: Scene, tables: list[xr.DataArray]) -> Array:
    """Return the angles of tables in the whole period, and the first again after it; long intervals are divided."""
    every = []
    for table in tables:
        period = period_of(table, scene.mechanism.period)
        every.append(np.add.outer(np.arange(0.0, scene.period, period), np.mod(table["theta2"].values, period)).ravel())
    return smooth.divided(np.concatenate(every), scene.period)


def _knots_of_functions(scene: Scene, tables: list[xr.DataArray]) -> Array | None:
    """Return angles between which the functions of a scene are polynomials, those of its tables among them."""
    if not scene.quick.all:
        return None
    rules = {path: Rule(scene.numbers[path][1], over_angle=True) for path in scene.functions}
    functions = [partial(called, path, function, rules[path]) for path, function in scene.functions.items()]
    known = _knots(scene, tables)[:-1] if tables else np.empty(0)
    breaks = [angle for load in scene.loads for angle in getattr(load, "breaks", ())]
    breaks = np.add.outer(np.arange(0.0, scene.period, scene.mechanism.period), breaks).ravel()
    return smooth.smooth_knots(functions, known, breaks, scene.quick.angles, scene.period)


def _cuts(scene: Scene, knots: Array) -> list[int]:
    """Return the numbers of the knots at which pieces start: all of pchip curves, whose curvature jumps there, so that
    a peak beside a knot may lie between two samples, and of speeds, of whose acceleration that is true."""
    corners = np.array([jump for jump in scene.jumps() if not hasattr(jump, "dims")])
    away = signed_distance(knots[:, None], corners, scene.mechanism.period)
    corner = (np.abs(away) < ROUNDED).any(axis=1)
    corner |= scene.changes_speed or any(getattr(load, "interpolation", None) == "pchip" for load in scene.loads)
    cuts = [0]
    for k in range(1, len(knots) - 1):
        if corner[k] or k - cuts[-1] == MOST_KNOTS or knots[k + 1] - knots[cuts[-1]] > LONGEST_PIECE:
            cuts.append(k)
    return cuts


def _polynomials(field: Field, dim: str, places: Array, half_lengths: Array) -> Field | None:
    """Return the coefficients of an input from its samples at places of each interval, in half lengths from its origin;
    None where the polynomial through the others misses the last sample."""
    terms, axis = len(places) - 1, field.dims.index(dim)
    values = np.moveaxis(field.values, axis, 0)
    values = np.moveaxis(values.reshape(len(half_lengths), terms + 1, *values.shape[1:]), 1, -1)
    through = smooth.coefficients(places[:-1], values[..., :-1])
    error = values[..., -1] - through @ places[-1] ** np.arange(terms)
    if not np.all(np.abs(error) <= ROUNDING * np.max(np.abs(values))):
        return None
    lengths = half_lengths.reshape(-1, *[1] * (through.ndim - 1))
    through = np.moveaxis(through / lengths ** np.arange(terms), -1, 1)
    return Field(tuple(name for name in field.dims if name != dim), np.ascontiguousarray(through))
