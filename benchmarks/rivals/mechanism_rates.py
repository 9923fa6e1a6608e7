"""mechanism: angles, speeds and accelerations of the links, each angle's loop equations solved by scipy's fsolve."""

from __future__ import annotations

import numpy as np

from benchmarks.rivals import Bound, peers
from benchmarks.rivals.peers import Array, Design


def bind(q: Design, theta2: Array) -> Bound:
    from mechanism import Mechanism, Vector, get_joints

    t2 = np.radians(theta2)
    A, B, C, D = get_joints("A B C D")
    crank, coupler, rocker = Vector((A, B), r=q.a), Vector((B, C), r=q.b), Vector((D, C), r=q.c)
    ground = Vector((A, D), r=q.d, theta=0)
    angles = peers.position(q, t2[0])
    guess = [np.array(angles), np.array(peers.rates(q, t2[0], *angles)), np.zeros(2)]
    machine = Mechanism(
        vectors=(crank, coupler, rocker, ground),
        origin=A,
        loops=lambda x, i: crank(i) + coupler(x[0]) - rocker(x[1]) - ground(),
        pos=t2,
        vel=np.full(len(t2), q.omega2),
        acc=np.full(len(t2), q.alpha2),
        guess=guess,
    )
    read = (coupler.vel, "omegas"), (rocker.vel, "omegas"), (coupler.acc, "alphas"), (rocker.acc, "alphas")
    return Bound(machine.iterate, lambda _: np.stack([getattr(*what) for what in read]))
