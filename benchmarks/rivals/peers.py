"""Solve the nine unknowns of a four-bar as an engineer does today: numpy, without linksweep.

The notation is that of document 2, ME 470 Final Project, with weights: links 2 crank, 3 coupler, 4 rocker, lengths a,
b, c and ground d, centres of gravity at (s, delta2), (p, delta3), (u, delta4). Fij is the force of link i on link j. In
order: F12x F12y F32x F32y F43x F43y F14x F14y [N], T12 [N m].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

Array = np.ndarray
Number = float | Array

# Document 2's matrix without its R-values: rows are forces x, y and moments about G, link after link.
FORCE_BALANCE = np.zeros((9, 9))
FORCE_BALANCE[[0, 1, 0, 1, 2], [0, 1, 2, 3, 8]] = 1.0
FORCE_BALANCE[[3, 4, 6, 7], [2, 3, 4, 5]] = -1.0
FORCE_BALANCE[[3, 4, 6, 7], [4, 5, 6, 7]] = 1.0


@dataclass(frozen=True)
class Design:
    """A four-bar, its motion and its gravity; a field is a number, or a column (n_designs, 1)."""

    a: Number  # lengths [m]
    b: Number
    c: Number
    d: Number
    m2: Number  # masses [kg]
    m3: Number
    m4: Number
    I2: Number  # moments of inertia about the centre of gravity [kg m2]
    I3: Number
    I4: Number
    s: Number = 0.0  # centre of gravity, distance from the link's first pin [m] ...
    p: Number = 0.0
    u: Number = 0.0
    delta2: Number = 0.0  # ... and angle from its line of pins [degree]
    delta3: Number = 0.0
    delta4: Number = 0.0
    omega2: Number = 1.0  # [rad/s]
    alpha2: Number = 0.0  # [rad/s2]
    gx: Number = 0.0  # [m/s2]
    gy: Number = -9.81
    sign: Number = 1.0  # +1 open (C left of B->D), -1 crossed

    def __getitem__(self, rows: slice) -> Design:
        """Return some of the designs, as columns."""
        columns = {f.name: getattr(self, f.name) for f in fields(self)}
        return Design(**{name: v[rows] if np.ndim(v) else v for name, v in columns.items()})


def grid(n_angles: int) -> Array:
    """Return crank angles of one revolution [degree]; 360 is not repeated."""
    return np.arange(n_angles) * (360.0 / n_angles)


def _polar(radius: Number, angle: Array) -> tuple[Array, Array]:
    return radius * np.cos(angle), radius * np.sin(angle)


def position(q: Design, t2: Array) -> tuple[Array, Array]:
    """Return theta3 and theta4 [rad]; arctan2 instead of document 2's quotient, whose denominators can vanish."""
    cos2, sin2 = np.cos(t2), np.sin(t2)
    k1, k2, k4 = q.d / q.a, q.d / q.c, q.d / q.b
    k3 = (q.a**2 - q.b**2 + q.c**2 + q.d**2) / (2 * q.a * q.c)
    k5 = (q.c**2 - q.d**2 - q.a**2 - q.b**2) / (2 * q.a * q.b)
    A, B, C = cos2 - k1 - k2 * cos2 + k3, -2 * sin2, k1 - (k2 + 1) * cos2 + k3
    D, F = cos2 - k1 + k4 * cos2 + k5, k1 + (k4 - 1) * cos2 + k5
    t4 = 2 * np.arctan2(-B - q.sign * np.sqrt(B**2 - 4 * A * C), 2 * A)
    t3 = 2 * np.arctan2(-B - q.sign * np.sqrt(B**2 - 4 * D * F), 2 * D)
    return t3, t4


def rates(q: Design, t2: Array, t3: Array, t4: Array) -> tuple[Array, Array]:
    """Return omega3 and omega4 [rad/s]."""
    omega3 = q.a * q.omega2 * np.sin(t4 - t2) / (q.b * np.sin(t3 - t4))
    omega4 = q.a * q.omega2 * np.sin(t2 - t3) / (q.c * np.sin(t4 - t3))
    return omega3, omega4


def _system(q: Design, t2: Array) -> tuple[Array, Array]:
    """Return document 2's matrix (..., 9, 9) and right-hand side (..., 9) at theta2 [rad]."""
    t3, t4 = position(q, t2)
    w2, al2 = q.omega2, q.alpha2
    w3, w4 = rates(q, t2, t3, t4)

    (ax, ay), (bx, by), (cx, cy) = _polar(q.a, t2), _polar(q.b, t3), _polar(q.c, t4)
    C = al2 * ay + w2**2 * ax + w3**2 * bx - w4**2 * cx
    F = al2 * ax - w2**2 * ay - w3**2 * by + w4**2 * cy
    al3 = (C * cx - cy * F) / (cy * bx - by * cx)
    al4 = (C * bx - by * F) / (cy * bx - by * cx)

    r12x, r12y = _polar(-q.s, t2 + np.radians(q.delta2))
    r23x, r23y = _polar(-q.p, t3 + np.radians(q.delta3))
    r14x, r14y = _polar(-q.u, t4 + np.radians(q.delta4))
    a2x, a2y = al2 * r12y + w2**2 * r12x, -al2 * r12x + w2**2 * r12y
    a3x = -(al2 * ay + w2**2 * ax) + al3 * r23y + w3**2 * r23x
    a3y = al2 * ax - w2**2 * ay - al3 * r23x + w3**2 * r23y
    a4x, a4y = al4 * r14y + w4**2 * r14x, -al4 * r14x + w4**2 * r14y

    shape = np.broadcast_shapes(np.shape(t2), *map(np.shape, vars(q).values()))
    matrix = np.empty((*shape, 9, 9))
    matrix[...] = FORCE_BALANCE
    matrix[..., 2, 0], matrix[..., 2, 1] = -r12y, r12x
    matrix[..., 2, 2], matrix[..., 2, 3] = -(ay + r12y), ax + r12x
    matrix[..., 5, 2], matrix[..., 5, 3] = r23y, -r23x
    matrix[..., 5, 4], matrix[..., 5, 5] = -(by + r23y), bx + r23x
    matrix[..., 8, 4], matrix[..., 8, 5] = cy + r14y, -(cx + r14x)
    matrix[..., 8, 6], matrix[..., 8, 7] = -r14y, r14x
    rhs = np.empty((*shape, 9))
    rhs[..., 0], rhs[..., 1], rhs[..., 2] = q.m2 * (a2x - q.gx), q.m2 * (a2y - q.gy), q.I2 * al2
    rhs[..., 3], rhs[..., 4], rhs[..., 5] = q.m3 * (a3x - q.gx), q.m3 * (a3y - q.gy), q.I3 * al3
    rhs[..., 6], rhs[..., 7], rhs[..., 8] = q.m4 * (a4x - q.gx), q.m4 * (a4y - q.gy), q.I4 * al4
    return matrix, rhs


def numpy_rates(design: Design, theta2: Array) -> Array:
    """Return omega3 and omega4 [rad/s] (2, n) at theta2 [degree]."""
    t2 = np.radians(theta2)
    return np.stack(rates(design, t2, *position(design, t2)))


def numpy_lapack(design: Design, theta2: Array) -> Array:
    """Return the nine unknowns (9, n) at theta2 [degree]: every 9×9 built, then one batched np.linalg.solve."""
    matrix, rhs = _system(design, np.radians(theta2))
    return np.moveaxis(np.linalg.solve(matrix, rhs[..., None])[..., 0], -1, 0)


def numpy_peaks(
    designs: Design, n_angles: int, nine: Callable[[Design, Array], Array], chunk: int = 10
) -> tuple[Array, Array]:
    """Return the largest F12, F32, F43, F14, largest and smallest T12 over the grid, and their samples.

    Both results are (n_designs, 6). A few designs are done at a time: all matrices at once would not fit the memory.
    """
    theta2 = grid(n_angles)
    chunks = (designs[i : i + chunk] for i in range(0, len(designs.a), chunk))
    values, at = zip(*(_grid_peaks(nine(part, theta2)) for part in chunks), strict=True)
    return np.concatenate(values), np.concatenate(at)


def numpy_lapack_peaks(designs: Design, n_angles: int, chunk: int = 10) -> tuple[Array, Array]:
    """Return grid peaks by dense solves."""
    return numpy_peaks(designs, n_angles, numpy_lapack, chunk)


def _grid_peaks(nine: Array) -> tuple[Array, Array]:
    magnitudes = np.sqrt(nine[0:8:2] ** 2 + nine[1:8:2] ** 2)
    at = np.stack([*magnitudes.argmax(axis=-1), nine[8].argmax(axis=-1), nine[8].argmin(axis=-1)], axis=-1)
    signals = np.stack([*magnitudes, nine[8], nine[8]], axis=-2)
    return np.take_along_axis(signals, at[..., None], axis=-1)[..., 0], at


def difference(values: Array, expected: Array) -> float:
    """Return the largest difference of two arrays (..., angles), relative to the largest of its own row."""
    return float(np.max(np.abs(values - expected).max(axis=-1) / np.abs(expected).max(axis=-1)))


def numpy_closed_form(design: Design, theta2: Array) -> Array:
    """Return the nine unknowns (9, n) at theta2 [degree] by the formulas of limit.c, as numpy expressions."""
    q, t2 = design, np.radians(theta2)
    cos2, sin2, half = np.cos(t2), np.sin(t2), np.sin(t2 / 2) ** 2
    Bx, By = q.a * cos2, q.a * sin2
    rx, ry = q.d - Bx, -By
    low = (q.d - q.a - q.b + q.c) * (q.d - q.a + q.b - q.c) + 4 * q.a * q.d * half
    high = (q.b + q.c - q.d - q.a) * (q.b + q.c + q.d + q.a) + 4 * q.a * q.d * (1 - half)
    det = q.sign * np.sqrt(low * high) / 2
    f2 = low + (q.b - q.c) ** 2
    along, across = (low + 2 * q.b * (q.b - q.c)) / (2 * f2), det / f2
    alongv = (2 * q.c * (q.b - q.c) - low) / (2 * f2)
    ux, uy = along * rx - across * ry, along * ry + across * rx
    vx, vy = alongv * rx - across * ry, alongv * ry + across * rx

    g3, g4 = (By * vx - Bx * vy) / det, (By * ux - Bx * uy) / det
    w2, w3, w4 = q.omega2**2, (q.omega2 * g3) ** 2, (q.omega2 * g4) ** 2
    aBx, aBy = -q.alpha2 * By - w2 * Bx, q.alpha2 * Bx - w2 * By
    Kx, Ky = aBx - w3 * ux + w4 * vx, aBy - w3 * uy + w4 * vy
    al3, al4 = -(Kx * vx + Ky * vy) / det, -(Kx * ux + Ky * uy) / det

    Q2x, Q2y, N2 = _effective(q.m2, q.I2, q.s, q.delta2, q.a, Bx, By, w2, q.alpha2, q.gx, q.gy)
    Q3x, Q3y, N3 = _effective(q.m3, q.I3, q.p, q.delta3, q.b, ux, uy, w3, al3, q.gx - aBx, q.gy - aBy)
    Q4x, Q4y, N4 = _effective(q.m4, q.I4, q.u, q.delta4, q.c, vx, vy, w4, al4, q.gx, q.gy)
    F43x, F43y = -(N4 * ux + N3 * vx) / det, -(N4 * uy + N3 * vy) / det
    F32x, F32y = F43x + Q3x, F43y + Q3y
    T12 = -(N2 + Bx * Q3y - By * Q3x + g3 * N3 + g4 * N4)
    return np.stack([-F32x - Q2x, -F32y - Q2y, F32x, F32y, F43x, F43y, F43x - Q4x, F43y - Q4y, T12])


def _effective(m, inertia, distance, delta, length, ex, ey, w_squared, alpha, gx, gy) -> tuple[Array, Array, Array]:
    """Return the d'Alembert force of a link with pin vector (ex, ey), and its moment about the first pin."""
    k, j = _polar(m * distance / length, np.radians(delta))
    hx, hy = k * ex - j * ey, k * ey + j * ex
    moment = hx * gy - hy * gx - (inertia + m * distance**2) * alpha
    return m * gx + alpha * hy + w_squared * hx, m * gy - alpha * hx + w_squared * hy, moment
