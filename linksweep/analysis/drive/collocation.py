"""Collocation of a motion over the crank's travel: w = ½ω² by polynomials between angles, which are its elements.

In an element of the width h, a = dw/dφ is the parabola through its values at the three Gauss points c_j, so that

    w(c) = w_0 + h Σ_j a_j ∫_0^c l_j(t) dt

with Lagrange's l_j. The balance of torques R(φ, w, a) is 0 at the Gauss points; what remains between them is the
defect, whose integral over an element is the error of its energy. At the ends of elements the error falls with h⁶.
Sources: E. Hairer, S. P. Nørsett and G. Wanner, Solving Ordinary Differential Equations I, section II.7; A. S. Kronrod,
Nodes and Weights of Quadrature Formulas (1965).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

Array = np.ndarray

POINTS = 0.5 + np.sqrt(0.15) * np.array([-1.0, 0.0, 1.0])
"""Gauss points of an element, 0 to 1."""
WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
_KRONROD = np.array([0.960491268708020283423507092629080, 0.434243749346802558002071502844628])
BETWEEN = 0.5 + 0.5 * np.array([-_KRONROD[0], -_KRONROD[1], _KRONROD[1], _KRONROD[0]])
"""Points that Kronrod adds to the three of Gauss: they integrate the defect, which is 0 at those."""
BETWEEN_WEIGHTS = (
    0.5 * np.array([0.104656226026467265193823857192073, 0.401397414775962222905051818618432])[[0, 1, 1, 0]]
)


COEFFICIENTS = np.linalg.inv(np.vander(POINTS, increasing=True))
"""Coefficients of Lagrange's parabolas through the Gauss points: (power, point)."""


def parabolas(at: Array) -> tuple[Array, Array]:
    """Return Lagrange's parabolas, and their integrals from 0, at places 0 to 1: (place, point)."""
    powers = np.arange(3)
    at = np.asarray(at, dtype=float)[:, None]
    return at**powers @ COEFFICIENTS, (at ** (powers + 1) / (powers + 1)) @ COEFFICIENTS


INTEGRALS = parabolas(POINTS)[1]


class Linear(NamedTuple):
    """A balance of torques at places of all elements, and its derivatives to w and a: (design, element, place)."""

    lack: Array
    to_w: Array
    to_a: Array


class Steps(NamedTuple):
    """Newton's changes of a in each element, `own` + `by_start`·δw_0, and of w at its end: `grow`·δw_0 + `add`."""

    own: Array
    by_start: Array
    grow: Array
    add: Array


def newton_steps(balance: Linear, widths: Array) -> Steps:
    """Return the changes that make a linear balance 0 at the Gauss points of each element."""
    lack, to_w, to_a = (np.ascontiguousarray(np.moveaxis(part, -1, 0)) for part in balance)
    matrix = (to_w * widths)[:, None] * INTEGRALS[..., None, None]
    matrix[range(3), range(3)] += to_a
    changes = _solved(matrix, -np.stack([lack, to_w], axis=1))
    add, grow = widths * np.tensordot(WEIGHTS, changes, axes=1)
    own, by_start = np.moveaxis(changes, (1, 0), (0, -1))
    return Steps(own, by_start, 1.0 + grow, add)


def _solved(matrix: Array, right: Array) -> Array:
    """Return the solutions (row, side, …) of equations (row, column, …) for right sides, both of which it overwrites;
    without pivoting, since inertia keeps the diagonal the largest."""
    for k in range(3):
        for row in range(k + 1, 3):
            part = matrix[row, k] / matrix[k, k]
            matrix[row, k + 1 :] -= part * matrix[k, k + 1 :]
            right[row] -= part * right[k]
    for k in reversed(range(3)):
        for column in range(k + 1, 3):
            right[k] -= matrix[k, column] * right[column]
        right[k] /= matrix[k, k]
    return right


def carried(steps: Steps) -> tuple[Array, Array]:
    """Return how the change of w at the first node reaches every node, as factor and sum: (design, node).

    Elements are taken in rows: first all rows side by side, then one row after another.
    """
    designs, count = steps.grow.shape
    length = math.isqrt(count - 1) + 1
    grow, add = (
        np.pad(part, ((0, 0), (0, -count % length)), constant_values=unchanged).reshape(designs, -1, length)
        for part, unchanged in ((steps.grow, 1.0), (steps.add, 0.0))
    )
    factors, sums = _one_after_another(grow, add)
    before, before_sum = _with_start(*_one_after_another(factors[..., -1], sums[..., -1]))
    before, before_sum = before[:, :-1, None], before_sum[:, :-1, None]
    at_ends = (each.reshape(designs, -1)[:, :count] for each in (factors * before, factors * before_sum + sums))
    return _with_start(*at_ends)


def _one_after_another(grow: Array, add: Array) -> tuple[Array, Array]:
    """Return factor and sum behind each element of the last axis: those of its own and of all before."""
    factors, sums = np.cumprod(grow, axis=-1), add.copy()
    for k in range(1, sums.shape[-1]):
        sums[..., k] += grow[..., k] * sums[..., k - 1]
    return factors, sums


def _with_start(factors: Array, sums: Array) -> tuple[Array, Array]:
    """Return factors and sums (design, node) with those of the first node: 1 and 0."""
    return np.pad(factors, ((0, 0), (1, 0)), constant_values=1.0), np.pad(sums, ((0, 0), (1, 0)))


def between(starts: Array, a: Array, widths: Array, at: Array) -> tuple[Array, Array]:
    """Return w and a at places 0 to 1 in elements with these first values of w: (design, element, place)."""
    values, integrals = parabolas(at)
    return starts[..., None] + widths[:, None] * (a @ integrals.T), a @ values.T


def turning_points(nodes: Array, a: Array, widths: Array) -> Array:
    """Return w where a is 0 within an element, and at its start where it is not: (design, element, 2)."""
    constant, linear, square = np.moveaxis(a @ COEFFICIENTS.T, -1, 0)
    with np.errstate(all="ignore"):
        half = -0.5 * (linear + np.copysign(np.sqrt(linear * linear - 4.0 * square * constant), linear))
        roots = np.stack([half / square, constant / half], axis=-1)
    c = np.where((roots > 0.0) & (roots < 1.0), roots, 0.0)
    gains = constant[..., None] * c + linear[..., None] * c**2 / 2.0 + square[..., None] * c**3 / 3.0
    return nodes[:, :-1, None] + widths[:, None] * gains


def integral(values: Array, widths: Array) -> Array:
    """Return the integrals over all elements of values at their Gauss points, for each design."""
    return (values @ WEIGHTS) @ widths
