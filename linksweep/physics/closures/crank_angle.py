"""The crank's angle ψ = θ2 − ψ0 from the near-toggle ψ0: the mechanism comes nearest to a toggle at ψ = 0 and 180°.

Every closure is a squared length times the difference of cos ψ and the toggle's own cosine. That difference cancels, so
cos ψ is a double-double (see `linksweep.physics.algebra.double_double`), from a grid's table or, between samples, from
half-angle tangents. The turn is then split into two halves, centred on ψ = 0 and 180°. With x the tangent of half the
angle from the nearer centre,  1 − cos = 2x²/(1 + x²)  and  sin = 2x/(1 + x²):  no digit is lost as x tends to 0.
"""

import math

from linksweep.physics.algebra.arctangent import arctangent, small_angle
from linksweep.physics.algebra.arithmetic import Number, where
from linksweep.physics.algebra.double_double import add, cross, divide, dot, ordered_sum, two_product

ANGLE_NOISE = 8.0 * 2.0**-52
"""[rad] Bound on the rounding error of an angle within the first turn."""
CHANGE_POINT_NOISE = 2.0**-48
"""1 ± cos ψ below which a change point has status toggle: 8e-8 rad from flat, closer than any lengths are known."""
RANGE_MARGIN = 2.0**-950
"""Squared lengths stay this factor away from the smallest and the largest float."""


def psi_from_crank_angle(
    cos2: Number,
    cos2_lo: Number,
    sin2: Number,
    sin2_lo: Number,
    psi0_cos: Number,
    psi0_cos_lo: Number,
    psi0_sin: Number,
    psi0_sin_lo: Number,
) -> tuple[Number, Number, Number]:
    """Return cos(θ2 − ψ0) as a double-double, and sin(θ2 − ψ0)."""
    crank = (cos2, cos2_lo), (sin2, sin2_lo)
    psi0 = (psi0_cos, psi0_cos_lo), (psi0_sin, psi0_sin_lo)
    return *dot(*crank, *psi0), cross(*psi0, *crank)


def angle_from_tangent(half_tangent: Number, far_half: Number) -> tuple[Number, Number, Number]:
    """Return cos ψ as a double-double, and sin ψ; `far_half` is positive in the half turn centred on 180°."""
    inverse = 1.0 / (1.0 + half_tangent * half_tangent)
    sin = 2.0 * half_tangent * inverse
    versine = half_tangent * sin
    (cos, cos_lo), far = ordered_sum(1.0, -versine), far_half > 0.0
    return where(far, -cos, cos), where(far, -cos_lo, cos_lo), where(far, -sin, sin)


def place_on_piece(piece_tangent: Number, piece_end: Number, piece_from: Number, piece_to: Number) -> Number:
    """Return the half-angle tangent of a place on a piece of a half turn, between those of its ends.

    The place moves as sin²(φ/2) from the start to the end, and back, while φ makes a turn: what varies smoothly along
    the piece, or as the root of the distance from an end, is a smooth and even function of φ. `piece_tangent` is
    tan(φ/2), or, where `piece_end` is positive, that of the angle from φ = 180°.
    """
    square = piece_tangent * piece_tangent
    moved = (piece_to - piece_from) * (square / (1.0 + square))
    return where(piece_end > 0.0, piece_to - moved, piece_from + moved)


def angle_on_piece(half_tangent: Number, piece_middle: Number) -> Number:
    """Return the crank's angle from the middle of a piece [rad], from their half-angle tangents; 45° either way."""
    return 2.0 * small_angle((half_tangent - piece_middle) / (1.0 + half_tangent * piece_middle))


def polynomial_on_piece(angle_on_piece: Number, origin: Number, *terms: Number) -> Number:
    """Return the value of a polynomial of the crank's angle: `terms` are the coefficients of the powers of the angle
    from an origin [rad], the least power first."""
    away, total = angle_on_piece - origin, terms[-1]
    for term in terms[-2::-1]:
        total = term + away * total
    return total


def speed_on_piece(angle_on_piece: Number, origin: Number, *terms: Number) -> tuple[Number, Number]:
    """Return a speed ω that is such a polynomial, and its acceleration α = ω·dω/dθ."""
    away, omega, slope = angle_on_piece - origin, terms[-1], 0.0
    for term in terms[-2::-1]:
        omega, slope = term + away * omega, omega + away * slope
    return omega, omega * slope


def cubics_on_piece(angle_on_piece: Number, *numbers: Number) -> Number:
    """Return the value of a function of the crank's angle that is another cubic from each of several knots on.

    `numbers` are, for each knot, its angle on the piece [rad] and the four coefficients of the powers of the angle from
    it, the least power first. The first cubic also holds before its knot.
    """
    knots = [numbers[first : first + 5] for first in range(0, len(numbers), 5)]
    latest = knots[0]
    for knot in knots[1:]:
        beyond = angle_on_piece > knot[0]
        latest = tuple(where(beyond, *both) for both in zip(knot, latest, strict=True))
    return polynomial_on_piece(angle_on_piece, *latest)


def crank_from_tangent(half_tangent: Number, far_half: Number) -> tuple[Number, Number, Number, Number]:
    """Return cos θ2 and sin θ2 as double-doubles, each with its low word; `far_half` as in `angle_from_tangent`."""
    square, far = two_product(half_tangent, half_tangent), far_half > 0.0
    whole = add((1.0, 0.0), square)
    cos = divide(add((1.0, 0.0), (-square[0], -square[1])), whole)
    sin = divide((2.0 * half_tangent, 0.0), whole)
    return tuple(where(far, -word, word) for word in (*cos, *sin))


def angle_from_x(cos: Number, sin: Number, psi0_cos: Number, psi0_sin: Number) -> tuple[Number, Number]:
    """Return cos θ2 and sin θ2, where θ2 = ψ + ψ0."""
    return cos * psi0_cos - sin * psi0_sin, sin * psi0_cos + cos * psi0_sin


def versines(psi_cos: Number, psi_cos_lo: Number) -> tuple[Number, Number]:
    """Return 1 − cos ψ and 1 + cos ψ to full precision."""
    return (1.0 - psi_cos) - psi_cos_lo, (1.0 + psi_cos) + psi_cos_lo


def one_turn(cos2: Number, sin2: Number) -> Number:
    """Return θ2 [rad] in [0, 2π)."""
    angle = arctangent(sin2, cos2)
    return where(angle < 0.0, angle + 2.0 * math.pi, angle)


def cosine_noise(miss: Number, noise: Number, psi_sin: Number) -> Number:
    """Return by how much cos ψ must differ from a toggle's cosine for the mechanism to be clear of the toggle.

    The angle may be off in its last digit. `miss` is the distance of the toggle's cosine from ±1. Where it is below
    `noise`, rounded lengths may be its only cause: then the mechanism is taken as lying flat at ψ = 0 or 180°, and
    cosines within twice the miss cannot be distinguished from the toggle's.
    """
    return ANGLE_NOISE * abs(psi_sin) + CHANGE_POINT_NOISE + where(abs(miss) < noise, 2.0 * abs(miss), 0.0)


def range_noise(square: Number) -> Number:
    """Return more than any cosine where a squared length comes near the smallest or largest float, else next to 0."""
    return RANGE_MARGIN * (square + 1.0 / square)
