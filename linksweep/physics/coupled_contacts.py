"""Coulomb friction of slides that the drive loads, where this friction decides the drive in turn.

For the drive's torque or force T, and the friction f_j of all these slides, statics gives their normal forces; the
virtual work of the whole machine per radian of the crank gives T:

    N_i = a_i + b_i T + Σ c_ij f_j        0 = W + r T + Σ r_j f_j

W is the work of all the rest; r and r_j are the rates of drive and slides per rate of the crank. Without T,

    N_i = A_i + Σ C_ij f_j,    A_i = a_i − b_i W/r,    C_ij = c_ij − b_i r_j/r

With f_j = −σ_j d_j N_j, d_j = μ_j·sign(v_j), each choice of the signs σ is a linear system. It is a solution where its
normal forces have these signs; one slide has exactly one where |C d| < 1, as in `linksweep.physics.coulomb`.

Where a slide bears nothing, rounding leaves A_i and C_ij of either sign, near a dead centre (r = 0) many times more.
What may be rounding is set to zero before signs are tried: it would jam the slide where friction wedges.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import product
from typing import NamedTuple

from linksweep.physics.algebra.arithmetic import NOISE, Number, marked_low, where
from linksweep.physics.algebra.planar import identity
from linksweep.physics.coulomb import CONTACT_NOISE, friction, has_sign

Matrix = Sequence[Sequence[Number]]


def work_with_cylinders(work: Number, rates: Sequence[Number], cylinders: Matrix) -> tuple[Number, ...]:
    """Return W, r and all r_j with the work of cylinders of given length, whose forces depend on drive and friction.

    Each cylinder has its rate l per rate of the crank, and the coefficients of its force: a + b T + Σ c_j f_j.
    """
    terms = [work, *rates]
    for rate, *coefficients in cylinders:
        terms = [term + rate * slope for term, slope in zip(terms, coefficients, strict=True)]
    return tuple(terms)


def noise_of_drive(work: Number, rate: Number, size: Number, *terms: Number) -> tuple[Number, Number]:
    """Return the noise of W/r, whose W is a sum of terms, and of 1/r relative to it: much about a dead centre."""
    of_rate = CONTACT_NOISE * (1.0 + size / abs(rate))
    return (CONTACT_NOISE * sum(map(abs, terms), abs(work)) + abs(work) * of_rate) / abs(rate), of_rate


def without_drive(
    free: Number, per_drive: Number, work: Number, rate: Number, noise: Sequence[Number], rates_and_slopes: Matrix
) -> tuple[Number, ...]:
    """Return A_i and all C_ij from a_i, b_i, W, r, the noise of W/r and of 1/r, and the pairs r_j, c_ij.

    What rounding may have left of nothing is zero: where nothing presses, nothing wedges.
    """
    of_drive, of_rate = noise
    by_work = per_drive / rate
    alone = cleared(free - by_work * work, CONTACT_NOISE * abs(free) + abs(per_drive) * of_drive)
    slopes = []
    for sliding, slope in rates_and_slopes:
        driven = by_work * sliding
        slopes.append(cleared(slope - driven, CONTACT_NOISE * abs(slope) + abs(driven) * of_rate))
    return alone, *slopes


def cleared(x: Number, noise: Number) -> Number:
    """Return a number, or 0 where it may be noise: its derivative stays, since what bears nothing here may bear
    something under other parameters."""
    return x - marked_low(where(abs(x) < noise, x, 0.0))


def coupled_contacts(
    frictionless: Sequence[Number], slopes: Matrix, directions: Sequence[Number]
) -> tuple[Number, ...]:
    """Return the friction of each slide, from all A_i, C_ij and d_j, then the number of solutions; NaN where that is
    not 1.

    A normal force of zero counts as positive.
    """
    normals: list[Number] = [0.0 for _ in directions]
    count: Number = 0.0
    for signs in _choices(len(directions)):
        matrix = coupled_matrix(slopes, [sign * d for sign, d in zip(signs, directions, strict=True)])
        forces = solved(matrix, frictionless)
        holds: Number = 1.0
        for force, sign in zip(forces, signs, strict=True):
            holds = holds * has_sign(force, sign, 0.0)
        normals = [where(holds > 0.0, force, normal) for force, normal in zip(forces, normals, strict=True)]
        count = count + holds
    single = abs(count - 1.0) < 0.5
    pairs = zip(normals, directions, strict=True)
    return *(friction(where(single, normal, math.nan), direction) for normal, direction in pairs), count


def solved(matrix: Matrix, right: Sequence[Number]) -> list[Number]:
    """Return the solution of a small linear system, by Cramer's rule."""
    inverse = 1.0 / determinant(matrix)
    return [determinant(rows) * inverse for rows in with_column(matrix, right)]


def coupled_matrix(slopes: Matrix, directions: Sequence[Number]) -> list[list[Number]]:
    """Return the matrix of the system for the normal forces: 1 on the diagonal, plus C_ij times σ_j d_j."""
    return [
        [(1.0 if i == j else 0.0) + slope * k for j, (slope, k) in enumerate(zip(row, directions, strict=True))]
        for i, row in enumerate(slopes)
    ]


class Statics(NamedTuple):
    """Numbers of the equations for T and all N_i: r, r_j, b_i, c_ij and μ_j."""

    rate: Number
    rates: Sequence[Number]
    per_drive: Sequence[Number]
    slopes: Matrix
    frictions: Sequence[Number]

    def systems(self) -> Iterator[Matrix]:
        """Yield the matrix of the system for T and all N_i by each choice of signs.

        It is smooth also where r is zero, and where a slide turns round: it has μ in place of μ·sign(v).
        """
        for signs in _choices(len(self.frictions)):
            yield self._system([sign * coefficient for sign, coefficient in zip(signs, self.frictions, strict=True)])

    def bounds(self) -> Matrix:
        """Return bounds on the magnitudes of the elements of all these matrices."""
        (rates, per_drive), slopes = _magnitudes((self.rates, self.per_drive)), _magnitudes(self.slopes)
        return _magnitudes(Statics(abs(self.rate), rates, per_drive, slopes, self.frictions)._system(self.frictions))

    def _system(self, k: Sequence[Number]) -> Matrix:
        """Return the matrix with these numbers σ_j μ_j."""
        work = [self.rate, *(-sliding * own for sliding, own in zip(self.rates, k, strict=True))]
        rows = zip(self.per_drive, coupled_matrix(self.slopes, k), strict=True)
        return [work, *([-slope, *row] for slope, row in rows)]


def wedging_signals(statics: Statics) -> tuple[Number, ...]:
    """Return a number for each choice of signs, which is zero where friction wedges, and then their noise: the
    determinant of the system for T and all N_i."""
    return *map(determinant, statics.systems()), NOISE * permanent(statics.bounds())


def unloaded_signals(statics: Statics, right: Sequence[Number]) -> tuple[Number, ...]:
    """Return a number for each slide and choice of the signs of the others, which is zero where that slide bears
    nothing, slide by slide, and then the noise of each slide: the numerator of N_i in Cramer's rule."""
    signals = []
    for k in range(len(statics.frictions)):
        for signs, matrix in zip(_choices(len(statics.frictions)), statics.systems(), strict=True):
            if signs[k] > 0.0:  # its own sign has no effect
                signals.append(determinant(with_column(matrix, right)[k + 1]))
    _, *bounds = with_column(statics.bounds(), [abs(x) for x in right])
    return *signals, *(CONTACT_NOISE * permanent(rows) for rows in bounds)


def with_column(matrix: Matrix, column: Sequence[Number]) -> list[Matrix]:
    """Return a square matrix with each of its columns in turn replaced by this one."""
    return [[[*row[:k], x, *row[k + 1 :]] for row, x in zip(matrix, column, strict=True)] for k in range(len(column))]


def determinant(matrix: Matrix) -> Number:
    """Return the determinant of a small matrix."""
    return _expanded(matrix, operator.neg)


def permanent(matrix: Matrix) -> Number:
    """Return the permanent of a small matrix: its determinant with all terms added, a bound on their sum."""
    return _expanded(matrix, identity)


def _expanded(matrix: Matrix, odd: Callable[[Number], Number]) -> Number:
    """Return the sum of the elements of the first row times their minors, `odd` of every second element."""
    first, *others = matrix
    if not others:
        return first[0]
    minors = (_expanded([[*row[:k], *row[k + 1 :]] for row in others], odd) for k in range(len(first)))
    terms = [(odd(x) if k % 2 else x) * minor for k, (x, minor) in enumerate(zip(first, minors, strict=True))]
    return sum(terms[1:], terms[0])


def _choices(slides: int) -> Iterator[tuple[float, ...]]:
    """Return all choices of the signs of the slides' normal forces."""
    return product((1.0, -1.0), repeat=slides)


def _magnitudes(matrix: Iterable[Sequence[Number]]) -> list[list[Number]]:
    return [[abs(x) for x in row] for row in matrix]
