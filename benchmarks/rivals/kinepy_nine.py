"""KinePy: forces in plane mechanisms, with accelerations by central differences over even samples of a turn.

One more sample at either end gives the ends of the turn their differences.
"""

from __future__ import annotations

import contextlib
import io
from functools import partial

import numpy as np

from benchmarks.rivals import Bound
from benchmarks.rivals.peers import Array, Design


def bind(q: Design, theta2: Array) -> Bound:
    with contextlib.redirect_stdout(io.StringIO()):  # it prints what it compiles
        system, pins = _system(q)
    step = 2 * np.pi / len(theta2)
    angles = np.radians(theta2[0]) + step * np.arange(-1, len(theta2) + 1)
    return Bound(partial(system.solve_dynamics, angles, len(angles) * step / q.omega2), lambda _: _nine(*pins))


def _system(q: Design):
    import kinepy
    from kinepy import units

    units.set_unit(units.LENGTH, units.METER)
    system = kinepy.System()

    def link(mass, inertia, distance, angle):
        at = distance * np.exp(1j * np.radians(angle))
        return system.add_solid("", mass, inertia, (at.real, at.imag))

    crank = link(q.m2, q.I2, q.s, q.delta2)
    coupler = link(q.m3, q.I3, q.p, q.delta3)
    rocker = link(q.m4, q.I4, q.u, q.delta4)
    A = system.add_revolute(system.ground, crank)
    B = system.add_revolute(crank, coupler, (q.a, 0.0), (0.0, 0.0))
    C = system.add_revolute(coupler, rocker, (q.b, 0.0), (q.c, 0.0))
    D = system.add_revolute(system.ground, rocker, (q.d, 0.0), (0.0, 0.0))
    system.add_gravity((q.gx, q.gy))
    system.pilot(A)
    system.block(A)
    system.compile()
    system.change_signs([-q.sign])
    return system, (A, B, C, D)


def _nine(A, B, C, D) -> Array:
    return np.concatenate([-A.force, B.force, C.force, -D.force, -A.torque[None]])[:, 1:-1]
