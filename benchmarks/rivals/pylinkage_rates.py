"""pylinkage: positions, velocities and accelerations of the pins, by its solver compiled with numba."""

from __future__ import annotations

import numpy as np

from benchmarks.rivals import Bound, peers
from benchmarks.rivals.peers import Array, Design


def bind(q: Design, theta2: Array) -> Bound:
    """Bind the rates at evenly spaced crank angles of one turn."""
    from pylinkage.actuators import Crank
    from pylinkage.components import Ground
    from pylinkage.dyads import RRRDyad
    from pylinkage.simulation import Linkage

    n = len(theta2)
    step = 2 * np.pi / n
    A, D = Ground(0.0, 0.0), Ground(q.d, 0.0)
    crank = Crank(anchor=A, radius=q.a, angular_velocity=step)
    linkage = Linkage([A, D, crank, RRRDyad(anchor1=crank.output, anchor2=D, distance1=q.b, distance2=q.c)])
    linkage.set_input_velocity(crank, omega=q.omega2, alpha=q.alpha2)
    before = theta2[0] / 360.0 * 2 * np.pi - step  # it turns the crank by a step first
    start = [(0.0, 0.0), (q.d, 0.0), _pair(q.a * np.exp(1j * before)), _pair(_C(q, before))]

    def call() -> tuple:
        linkage.set_coords(start)
        return linkage.step_fast_with_kinematics(n)

    return Bound(call, lambda rows: _rates(q, *rows))


def _C(q: Design, t2: float) -> complex:
    return q.d + q.c * np.exp(1j * peers.position(q, t2)[1])


def _pair(z: complex) -> tuple[float, float]:
    return z.real, z.imag


def _rates(q: Design, position: Array, velocity: Array, acceleration: Array) -> Array:
    """Return omega3, omega4, alpha3, alpha4 from the pins' motion; components are A, D, B, C."""
    D, B, C = (position[:, k] @ [1, 1j] for k in (1, 2, 3))
    (vB, vC), (aB, aC) = ([motion[:, k] @ [1, 1j] for k in (2, 3)] for motion in (velocity, acceleration))
    u, v = C - B, C - D
    return np.stack(
        [
            (u.conj() * (vC - vB)).imag / q.b**2,
            (v.conj() * vC).imag / q.c**2,
            (u.conj() * (aC - aB)).imag / q.b**2,
            (v.conj() * aC).imag / q.c**2,
        ]
    )
