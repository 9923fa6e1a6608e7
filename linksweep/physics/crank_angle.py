"""The crank's angle ψ from the pinch: the angle about which, and opposite to which, a mechanism is nearest to a toggle.

Every closure is a length squared times cos ψ less the toggle's own cosine. There all digits are lost that cos ψ does
not have, so that it comes as a pair cos + rest (see `linksweep.physics.double_double`), from a grid's table or, between
samples, from half-angle tangents. A turn is then seen from two middles, ψ = 0 and 180°. With x the tangent of half the
angle from the nearer one,  1 − cos = 2x²/(1 + x²)  and  sin = 2x/(1 + x²):  no digit is lost as x tends to 0.
"""

import math

from linksweep.physics.arctangent import arctangent
from linksweep.physics.arithmetic import Number, where
from linksweep.physics.double_double import cross, dot

ULP = 8.0 * 2.0**-52
"""[rad] More than the last digit of an angle of the first turn."""
FLATTEST = 2.0**-48
"""1 ± cos ψ nearer than which a change point is told as lying flat: 8e-8 rad, less than lengths are ever known to."""
END = 2.0**-950
"""What the squares of lengths keep away from the least and the largest number by."""


def psi_from_crank_angle(
    cos2: Number,
    cos2_lo: Number,
    sin2: Number,
    sin2_lo: Number,
    middle_cos: Number,
    middle_cos_lo: Number,
    middle_sin: Number,
    middle_sin_lo: Number,
) -> tuple[Number, Number, Number]:
    """cos(θ2 − middle), its rest, and sin(θ2 − middle)."""
    crank = (cos2, cos2_lo), (sin2, sin2_lo)
    middle = (middle_cos, middle_cos_lo), (middle_sin, middle_sin_lo)
    return *dot(*crank, *middle), cross(*middle, *crank)


def angle_from_tangent(half_tangent: Number, far_half: Number) -> tuple[Number, Number, Number]:
    """cos ψ, its rest, and sin ψ."""
    inverse = 1.0 / (1.0 + half_tangent * half_tangent)
    sin = 2.0 * half_tangent * inverse
    versine = half_tangent * sin
    cos = 1.0 - versine
    rest, far = (1.0 - cos) - versine, far_half > 0.0
    return where(far, -cos, cos), where(far, -rest, rest), where(far, -sin, sin)


def angle_from_x(cos: Number, sin: Number, middle_cos: Number, middle_sin: Number) -> tuple[Number, Number]:
    """cos and sin of θ2 = ψ + middle."""
    return cos * middle_cos - sin * middle_sin, sin * middle_cos + cos * middle_sin


def versines(psi_cos: Number, psi_cos_lo: Number) -> tuple[Number, Number]:
    """1 − cos ψ and 1 + cos ψ, with all their digits."""
    return (1.0 - psi_cos) - psi_cos_lo, (1.0 + psi_cos) + psi_cos_lo


def one_turn(cos2: Number, sin2: Number) -> Number:
    """θ2 [rad] in [0, 2π)."""
    angle = arctangent(sin2, cos2)
    return where(angle < 0.0, angle + 2.0 * math.pi, angle)


def unknown_of_cosine(miss: Number, noise: Number, psi_sin: Number) -> Number:
    """By how much cos ψ must differ from a toggle's for the mechanism to be told from one at its toggle.

    The angle may be off by its last digit. Where the toggle's cosine misses ±1 by so little that rounded lengths may
    be the cause (`noise`), the mechanism is meant to lie flat there, and what the miss alone decides is not known.
    """
    return ULP * abs(psi_sin) + FLATTEST + where(abs(miss) < noise, 2.0 * abs(miss), 0.0)


def beyond_range(square: Number) -> Number:
    """More than any cosine where the square of a length comes near the ends of what a number can hold, else nothing."""
    return END * (square + 1.0 / square)
