"""Coulomb friction of slides that the drive loads, where this friction decides the drive in turn.

For the drive's torque or force T, and the friction f_j of all these slides, statics gives their normal forces; the
virtual work of the whole machine per radian of the crank gives T:

    N_i = a_i + b_i T + Σ c_ij f_j        0 = W + r T + Σ r_j f_j

W is the work of all the rest; r and r_j are the rates of drive and slides per rate of the crank. Without T,

    N_i = A_i + Σ C_ij f_j,    A_i = a_i − b_i W/r,    C_ij = c_ij − b_i r_j/r

With f_j = −σ_j d_j N_j, d_j = μ_j·sign(v_j), each choice of the signs σ is a linear system. It is a solution where its
normal forces have these signs; one slide has exactly one where |C d| < 1, as in `linksweep.physics.coulomb`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import product

from linksweep.physics.algebra.arithmetic import NOISE, Number, where
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


def without_drive(
    free: Number, per_drive: Number, work: Number, rate: Number, rates_and_slopes: Matrix
) -> tuple[Number, ...]:
    """Return A_i, the size of its terms, and all C_ij, from a_i, b_i, W, r and the pairs r_j, c_ij."""
    by_work = per_drive / rate
    driven = by_work * work
    return free - driven, abs(free) + abs(driven), *(slope - by_work * sliding for sliding, slope in rates_and_slopes)


def coupled_contacts(
    frictionless: Sequence[Number], sizes: Sequence[Number], slopes: Matrix, directions: Sequence[Number]
) -> tuple[Number, ...]:
    """Return the friction of each slide, from all A_i with their sizes, C_ij and d_j, then the number of solutions;
    NaN where that is not 1.

    A normal force that is next to nothing counts as positive: where nothing presses, nothing wedges.
    """
    least = -CONTACT_NOISE * sum(sizes)
    normals: list[Number] = [0.0 for _ in directions]
    count: Number = 0.0
    for signs in product((1.0, -1.0), repeat=len(directions)):
        matrix = coupled_matrix(slopes, [sign * d for sign, d in zip(signs, directions, strict=True)])
        forces = solved(matrix, frictionless)
        holds: Number = 1.0
        for force, sign in zip(forces, signs, strict=True):
            holds = holds * has_sign(force, sign, least)
        normals = [where(holds > 0.0, force, normal) for force, normal in zip(forces, normals, strict=True)]
        count = count + holds
    single = abs(count - 1.0) < 0.5
    pairs = zip(normals, directions, strict=True)
    return *(friction(where(single, normal, math.nan), direction) for normal, direction in pairs), count


def coupled_matrix(slopes: Matrix, directions: Sequence[Number]) -> list[list[Number]]:
    """Return the matrix of the system for the normal forces: 1 on the diagonal, plus C_ij times σ_j d_j."""
    return [
        [(1.0 if i == j else 0.0) + slope * k for j, (slope, k) in enumerate(zip(row, directions, strict=True))]
        for i, row in enumerate(slopes)
    ]


def solved(matrix: Matrix, right: Sequence[Number]) -> list[Number]:
    """Return the solution of a small linear system, by Cramer's rule."""
    inverse = 1.0 / determinant(matrix)
    columns = range(len(right))
    replaced = ([[*row[:k], x, *row[k + 1 :]] for row, x in zip(matrix, right, strict=True)] for k in columns)
    return [determinant(rows) * inverse for rows in replaced]


def determinant(matrix: Matrix) -> Number:
    """Return the determinant of a small matrix, by expansion along its first row."""
    first, *others = matrix
    if not others:
        return first[0]
    minors = (determinant([[*row[:k], *row[k + 1 :]] for row in others]) for k in range(len(first)))
    terms = [(-x if k % 2 else x) * minor for k, (x, minor) in enumerate(zip(first, minors, strict=True))]
    return sum(terms[1:], terms[0])


def wedging_signals(systems: Iterable[Matrix]) -> tuple[Number, ...]:
    """Return a number for each choice of signs, which is zero where friction wedges, and then their noise: the
    determinant of the system for T and all N_i."""
    systems = [*systems]
    return *map(determinant, systems), NOISE * _size(systems[0])


def unloaded_signals(systems: Iterable[Matrix], right: Sequence[Number]) -> tuple[Number, ...]:
    """Return a number for each slide and choice of the signs of the others, which is zero where that slide bears
    nothing, and then their noise: the numerator of N_i in Cramer's rule."""
    systems = [*systems]
    signals = []
    for n, rows in enumerate(systems):
        for k in range(1, len(right)):
            if not n >> (len(right) - 1 - k) & 1:  # its own sign has no effect
                replaced = [[*row[:k], x, *row[k + 1 :]] for row, x in zip(rows, right, strict=True)]
                signals.append(determinant(replaced))
    with_right = [[*row, x] for row, x in zip(systems[0], right, strict=True)]
    return *signals, CONTACT_NOISE * _size(with_right)


def systems(
    rate: Number, rates: Sequence[Number], per_drive: Sequence[Number], slopes: Matrix, frictions: Sequence[Number]
) -> Iterator[Matrix]:
    """Yield the matrix of the system for T and all N_i by each choice of signs, from r, r_j, b_i, c_ij and μ_j.

    It is smooth also where r is zero, and where a slide turns round: it has μ in place of μ·sign(v).
    """
    for signs in product((1.0, -1.0), repeat=len(frictions)):
        k = [sign * coefficient for sign, coefficient in zip(signs, frictions, strict=True)]
        work = [rate, *(-sliding * own for sliding, own in zip(rates, k, strict=True))]
        yield [work, *([-slope, *row] for slope, row in zip(per_drive, coupled_matrix(slopes, k), strict=True))]


def _size(matrix: Matrix) -> Number:
    """Return a bound on a determinant: the product of the sums of its rows."""
    return math.prod(sum(map(abs, row)) for row in matrix)
