"""Equations common to machines with a crank A-B: the motion of its pin B, the force balances, the torque of the drive.

Q and N are the effective force and moment of a link (see `linksweep.physics.inertia`); r2 = A→B.
"""

import math

from linksweep.physics.algebra.arithmetic import NOISE, Number, where
from linksweep.physics.algebra.planar import cross


def crank_pin(crank_length: Number, cos2: Number, sin2: Number) -> tuple[Number, Number]:
    """Return r2 = A→B."""
    return crank_length * cos2, crank_length * sin2


def crank_pin_acceleration(omega2: Number, alpha2: Number, r2x: Number, r2y: Number) -> tuple[Number, Number]:
    """Return a_B = α2 × r2 − ω2² r2."""
    centripetal = omega2 * omega2
    return -alpha2 * r2y - centripetal * r2x, alpha2 * r2x - centripetal * r2y


def angular_acceleration(omega2: Number, alpha2: Number, ratio: Number, slope: Number) -> Number:
    """Return α of a link that turns `ratio` times as fast as the crank; `slope` is d(ratio)/dθ2."""
    return omega2 * omega2 * slope + alpha2 * ratio


def coupler_balance(F43x: Number, F43y: Number, Q3x: Number, Q3y: Number) -> tuple[Number, Number]:
    """Return F32, from −F32 + F43 + Q3 = 0."""
    return F43x + Q3x, F43y + Q3y


def rocker_balance(F43x: Number, F43y: Number, Q4x: Number, Q4y: Number) -> tuple[Number, Number]:
    """Return F14, from F14 − F43 + Q4 = 0."""
    return F43x - Q4x, F43y - Q4y


def moment_on_crank(N2: Number, Q3x: Number, Q3y: Number, r2x: Number, r2y: Number) -> Number:
    """Return r2 × F43 where all torques on the crank are known: its moments about A, with F32 = F43 + Q3."""
    return -N2 - cross(r2x, r2y, Q3x, Q3y)


def work_on_crank(
    N2: Number,
    N3: Number,
    N4: Number,
    Q3x: Number,
    Q3y: Number,
    r2x: Number,
    r2y: Number,
    ratio3: Number,
    ratio4: Number,
) -> Number:
    """Return the virtual work of loads, weights and inertia forces per radian of the crank; pin forces do none."""
    return N2 + cross(r2x, r2y, Q3x, Q3y) + ratio3 * N3 + ratio4 * N4


def balancing_drive(work: Number, ratio: Number) -> Number:
    """Return the drive's torque on a link that turns, or force on a part that slides, `ratio` per radian of the crank,
    from zero total virtual work."""
    return where(abs(ratio) > 0.0, -work / ratio, math.nan)


def moments_or_work(by_moments: Number, work: Number, ratio: Number, other_ratio: Number) -> Number:
    """Return the drive's torque on a link other than the crank: from moments while the link is slower than the third
    link, from virtual work while it is faster.

    Near its dead centre the torque is large, and moments agree with the pin forces, for both have the same error. Where
    the third link nearly stands still, its terms cancel in the moments; virtual work leaves them out.
    """
    return where(abs(ratio) < abs(other_ratio), by_moments, balancing_drive(work, ratio))


def away_from_dead_centre(number: Number, leverage: Number, p: Number, q: Number) -> Number:
    """Return `number`, or NaN where the driven link stands still.

    `leverage` is the cross product of the two other links, of lengths p and q.
    """
    return where(abs(leverage) > NOISE * p * q, number, math.nan)


def drive_status(closure: Number, leverage: Number, p: Number, q: Number) -> Number:
    """Return the closure's status, or, where it is 0 and the driven link stands still, 3 (dead centre)."""
    return where(abs(leverage) > NOISE * p * q, closure, where(closure > 0.0, closure, 3.0))
