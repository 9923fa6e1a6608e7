"""JAX on the CPU in float64: document 2's 9×9 of one angle, vmapped over all and compiled."""

from __future__ import annotations

import numpy as np

from benchmarks.rivals import Bound
from benchmarks.rivals.peers import FORCE_BALANCE, Array, Design


def bind(q: Design, theta2: Array) -> Bound:
    import jax

    jax.config.update("jax_enable_x64", True)
    jax.config.update("jax_platforms", "cpu")
    compiled, t2 = jax.jit(jax.vmap(lambda t2: _nine(q, t2), out_axes=-1)), jax.numpy.asarray(np.radians(theta2))
    return Bound(lambda: compiled(t2).block_until_ready())


def _nine(q: Design, t2):
    """Return the unknowns at one angle [rad]; vectors are complex numbers."""
    import jax.numpy as jnp

    def turned(distance, angle, by):
        return distance * np.exp(1j * np.radians(angle)) * by

    line2 = jnp.exp(1j * t2)
    B = q.a * line2
    r = q.d - B
    along = (abs(r) ** 2 + q.b**2 - q.c**2) / (2 * abs(r) ** 2)
    u = r * (along + 1j * q.sign * jnp.sqrt(q.b**2 / abs(r) ** 2 - along**2))
    v = u - r
    det = _cross(u, v)
    w2, w3, w4 = q.omega2, _cross(v, B) * q.omega2 / det, _cross(u, B) * q.omega2 / det
    aB = (1j * q.alpha2 - w2**2) * B
    k = aB - w3**2 * u + w4**2 * v
    al3, al4 = -_dot(k, v) / det, -_dot(k, u) / det
    g2, g3, g4 = turned(q.s, q.delta2, line2), turned(q.p, q.delta3, u / q.b), turned(q.u, q.delta4, v / q.c)

    a2, a3, a4 = (1j * q.alpha2 - w2**2) * g2, aB + (1j * al3 - w3**2) * g3, (1j * al4 - w4**2) * g4
    gravity = q.gx + 1j * q.gy
    forces = [m * (a - gravity) for m, a in ((q.m2, a2), (q.m3, a3), (q.m4, a4))]
    moments = (q.I2 * q.alpha2, q.I3 * al3, q.I4 * al4)
    rhs = jnp.stack([part for f, m in zip(forces, moments, strict=True) for part in (f.real, f.imag, m)])

    matrix = jnp.asarray(FORCE_BALANCE)
    arms = {(2, 0): -g2, (2, 2): B - g2, (5, 2): g3, (5, 4): u - g3, (8, 4): g4 - v, (8, 6): -g4}
    for (row, column), arm in arms.items():
        matrix = matrix.at[row, column].set(-arm.imag).at[row, column + 1].set(arm.real)
    return jnp.linalg.solve(matrix, rhs)


def _cross(u, v):
    return u.real * v.imag - u.imag * v.real


def _dot(u, v):
    return u.real * v.real + u.imag * v.imag
