"""A plain loop in numba: for each angle document 2's 9×9, built and solved by LAPACK."""

from __future__ import annotations

from functools import cache, partial

import numpy as np

from benchmarks.rivals import Bound
from benchmarks.rivals.peers import FORCE_BALANCE, Array, Design


def bind(q: Design, theta2: Array) -> Bound:
    numbers = np.array([float(getattr(q, name)) for name in NUMBERS])
    return Bound(partial(_loop(), numbers, np.radians(theta2), FORCE_BALANCE))


NUMBERS = (
    "a", "b", "c", "d", "m2", "m3", "m4", "I2", "I3", "I4", "s", "p", "u", "delta2", "delta3", "delta4",
    "omega2", "alpha2", "gx", "gy", "sign",
)  # fmt: skip


@cache
def _loop():
    from numba import njit

    return njit(_nine)


def _nine(numbers, t2, force_balance):
    a, b, c, d, m2, m3, m4, I2, I3, I4, s, p, u, delta2, delta3, delta4, w2, al2, gx, gy, sign = numbers
    nine = np.empty((9, len(t2)))
    for i in range(len(t2)):
        ax, ay = a * np.cos(t2[i]), a * np.sin(t2[i])
        rx, ry = d - ax, -ay
        r2 = rx * rx + ry * ry
        along = (r2 + b * b - c * c) / (2.0 * r2)
        across = sign * np.sqrt(b * b / r2 - along * along)
        bx, by = along * rx - across * ry, along * ry + across * rx
        cx, cy = bx - rx, by - ry

        det = bx * cy - by * cx
        w3, w4 = w2 * (cx * ay - cy * ax) / det, w2 * (bx * ay - by * ax) / det
        aBx, aBy = -al2 * ay - w2 * w2 * ax, al2 * ax - w2 * w2 * ay
        kx, ky = aBx - w3 * w3 * bx + w4 * w4 * cx, aBy - w3 * w3 * by + w4 * w4 * cy
        al3, al4 = -(kx * cx + ky * cy) / det, -(kx * bx + ky * by) / det

        t3, t4 = np.arctan2(by, bx), np.arctan2(cy, cx)
        g2x, g2y = s * np.cos(t2[i] + np.radians(delta2)), s * np.sin(t2[i] + np.radians(delta2))
        g3x, g3y = p * np.cos(t3 + np.radians(delta3)), p * np.sin(t3 + np.radians(delta3))
        g4x, g4y = u * np.cos(t4 + np.radians(delta4)), u * np.sin(t4 + np.radians(delta4))

        matrix, rhs = force_balance.copy(), np.empty(9)
        matrix[2, 0], matrix[2, 1], matrix[2, 2], matrix[2, 3] = g2y, -g2x, g2y - ay, ax - g2x
        matrix[5, 2], matrix[5, 3], matrix[5, 4], matrix[5, 5] = -g3y, g3x, g3y - by, bx - g3x
        matrix[8, 4], matrix[8, 5], matrix[8, 6], matrix[8, 7] = cy - g4y, g4x - cx, g4y, -g4x
        rhs[0] = m2 * (-al2 * g2y - w2 * w2 * g2x - gx)
        rhs[1] = m2 * (al2 * g2x - w2 * w2 * g2y - gy)
        rhs[2] = I2 * al2
        rhs[3] = m3 * (aBx - al3 * g3y - w3 * w3 * g3x - gx)
        rhs[4] = m3 * (aBy + al3 * g3x - w3 * w3 * g3y - gy)
        rhs[5] = I3 * al3
        rhs[6] = m4 * (-al4 * g4y - w4 * w4 * g4x - gx)
        rhs[7] = m4 * (al4 * g4x - w4 * w4 * g4y - gy)
        rhs[8] = I4 * al4
        nine[:, i] = np.linalg.solve(matrix, rhs)
    return nine
