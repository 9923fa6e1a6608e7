"""Collocation of a motion over the crank's travel: w = ½ω² by polynomials between angles, which are its elements.

In an element of the width h, a = dw/dφ is the parabola through its values at the three Gauss points c_j, so that

    w(c) = w_0 + h Σ_j a_j ∫_0^c l_j(t) dt

with Lagrange's l_j. The balance of torques R(φ, w, a) is 0 at the Gauss points; what remains between them is the
defect, whose integral over an element is the error of its energy. At the ends of elements the error falls with h⁶.
Sources: E. Hairer, S. P. Nørsett and G. Wanner, Solving Ordinary Differential Equations I, section II.7; A. S. Kronrod,
Nodes and Weights of Quadrature Formulas (1965).
"""

from __future__ import annotations

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
    lack, to_w, to_a = balance
    matrix = to_w[..., None] * (widths[:, None, None] * INTEGRALS)
    matrix[..., range(3), range(3)] += to_a
    own, by_start = _solved(matrix, np.stack([-lack, -to_w], axis=-1))
    return Steps(own, by_start, 1.0 + widths * (by_start @ WEIGHTS), widths * (own @ WEIGHTS))


def _solved(matrix: Array, right: Array) -> tuple[Array, Array]:
    """Return the solutions for two right sides; no pivoting, since inertia keeps the diagonal the largest."""
    rows = [np.concatenate([matrix[..., k, :], right[..., k, :]], axis=-1) for k in range(3)]
    for k in range(3):
        rows[k] = rows[k] / rows[k][..., k, None]
        for other in range(3):
            if other != k:
                rows[other] = rows[other] - rows[other][..., k, None] * rows[k]
    solution = np.stack([row[..., 3:] for row in rows], axis=-2)
    return solution[..., 0], solution[..., 1]


def carried(steps: Steps) -> tuple[Array, Array]:
    """Return how the change of w at the first node reaches every node, as factor and sum: (design, node)."""
    designs, count = steps.grow.shape
    factors, sums = np.ones((count + 1, designs)), np.zeros((count + 1, designs))
    grow, add = np.ascontiguousarray(steps.grow.T), np.ascontiguousarray(steps.add.T)
    for k in range(count):
        factors[k + 1] = grow[k] * factors[k]
        sums[k + 1] = grow[k] * sums[k] + add[k]
    return factors.T, sums.T


def between(nodes: Array, a: Array, widths: Array, at: Array) -> tuple[Array, Array]:
    """Return w and a at places 0 to 1 in every element: (design, element, place)."""
    values, integrals = parabolas(at)
    return nodes[:, :-1, None] + widths[:, None] * (a @ integrals.T), a @ values.T


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
