"""The four-bar A-B-C-D: crank r2 = A→B of length a, frame line A→D of length d, joined by an RRR dyad.

With φ the angle from the frame line to the crank, f² = |BD|² = (d−a)² + 4ad·sin²(φ/2), so that

    low  = f² − (b−c)² = (d−a−b+c)(d−a+b−c) + 4ad·sin²(φ/2)
    high = (b+c)² − f² = (b+c−d−a)(b+c+d+a) + 4ad·cos²(φ/2)

Half angles keep every digit where cos φ would drop them, and lengths subtracted in these pairs are exactly 0 at a
change point with equal links. Open or crossed, the mechanism closes while low·high > 0.
"""

import math

from linksweep.physics.arithmetic import NOISE, Number, where
from linksweep.physics.planar import cross


def crank_pin(crank_length: Number, cos2: Number, sin2: Number) -> tuple[Number, Number]:
    """r2 = A→B."""
    return crank_length * cos2, crank_length * sin2


def frame_half_angle(
    sin2_half: Number, cos2_half: Number, ground_sin_half: Number, ground_cos_half: Number
) -> tuple[Number, Number]:
    """sin and cos of φ/2 = (θ2 − ground angle)/2."""
    return (
        sin2_half * ground_cos_half - cos2_half * ground_sin_half,
        cos2_half * ground_cos_half + sin2_half * ground_sin_half,
    )


def diagonal(
    crank_length: Number,
    ground_length: Number,
    ground_cos: Number,
    ground_sin: Number,
    r2x: Number,
    r2y: Number,
) -> tuple[Number, Number]:
    """The vector B→D."""
    return ground_length * ground_cos - r2x, ground_length * ground_sin - r2y


def closure_factors(
    crank_length: Number,
    coupler_length: Number,
    rocker_length: Number,
    ground_length: Number,
    sin_half: Number,
    cos_half: Number,
) -> tuple[Number, Number]:
    """low and high, as the module's equations write them."""
    a, b, c, d = crank_length, coupler_length, rocker_length, ground_length
    four_ad = 4.0 * a * d
    low = ((d - b) + (c - a)) * ((d - c) + (b - a)) + four_ad * (sin_half * sin_half)
    high = ((b - d) + (c - a)) * (b + c + d + a) + four_ad * (cos_half * cos_half)
    return low, high


def closure_noise(
    crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number
) -> tuple[Number, Number]:
    """What low and high cannot tell from zero: each sum of lengths is known to a few last digits of the perimeter."""
    a, b, c, d = crank_length, coupler_length, rocker_length, ground_length
    perimeter = a + b + c + d
    noise = 0.25 * NOISE * perimeter
    return noise * (abs(d - a) + abs(b - c) + noise), noise * perimeter


def assembly(crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number) -> Number:
    """0 where it closes at every angle, 1 where at some, 2 where at none: low is least at φ = 0, high at φ = 180°."""
    lengths = (crank_length, coupler_length, rocker_length, ground_length)
    least_low, largest_high = closure_factors(*lengths, 0.0, 1.0)
    largest_low, least_high = closure_factors(*lengths, 1.0, 0.0)
    partly = where(least_low < 0.0, 1.0, where(least_high < 0.0, 1.0, 0.0))
    return where(largest_low < 0.0, 2.0, where(largest_high < 0.0, 2.0, partly))


def crank_pin_acceleration(omega2: Number, alpha2: Number, r2x: Number, r2y: Number) -> tuple[Number, Number]:
    """a_B = α2 × r2 − ω2² r2."""
    centripetal = omega2 * omega2
    return -alpha2 * r2y - centripetal * r2x, alpha2 * r2x - centripetal * r2y


def coupler_balance(F43x: Number, F43y: Number, Q3x: Number, Q3y: Number) -> tuple[Number, Number]:
    """F32, from −F32 + F43 + Q3 = 0."""
    return F43x + Q3x, F43y + Q3y


def rocker_balance(F43x: Number, F43y: Number, Q4x: Number, Q4y: Number) -> tuple[Number, Number]:
    """F14, from F14 − F43 + Q4 = 0."""
    return F43x - Q4x, F43y - Q4y


def crank_balance(F32x: Number, F32y: Number, Q2x: Number, Q2y: Number) -> tuple[Number, Number]:
    """F12, from F12 + F32 + Q2 = 0."""
    return -F32x - Q2x, -F32y - Q2y


def moment_on_crank(N2: Number, Q3x: Number, Q3y: Number, r2x: Number, r2y: Number) -> Number:
    """r2 × F43 where the crank's torques are all known: its moments about A, with F32 = F43 + Q3."""
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
    """Virtual work per turn of the crank of all loads, weights and inertia forces: no pin force enters."""
    return N2 + cross(r2x, r2y, Q3x, Q3y) + ratio3 * N3 + ratio4 * N4


def balancing_torque(work: Number, ratio: Number) -> Number:
    """Torque on a link turning `ratio` times as fast as the crank that does the opposite virtual work."""
    return where(abs(ratio) > 0.0, -work / ratio, math.nan)


def drive_status(closure: Number, leverage: Number, p: Number, q: Number) -> Number:
    """The closure's status, or 3 (dead centre) where the driven link stands still and no torque on it can drive.

    The leverage is the cross product of the two other links, of lengths p and q.
    """
    return where(abs(leverage) > NOISE * p * q, closure, where(closure > 0.0, closure, 3.0))
