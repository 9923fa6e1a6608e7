"""The dyad of three pins (RRR): coupler r3 = B→C of length b and rocker r4 = D→C of length c, closed between B and D.

With f = |BD|, the triangle B, C, D has 16·area² = ((b+c)² − f²)·(f² − (b−c)²) = high·low. Both factors come
from the mechanism in a form that does not cancel, in units of a square that it chooses; the plain triangle formulas
lose all digits near a toggle. Everything else follows without another subtraction of nearly equal numbers:

    r3 = (low + 2b(b−c))/(2f²) · BD ± √(low·high)/(2f²) · BD⊥          open branch: +, C left of B→D
    r4 = −(low − 2c(b−c))/(2f²) · BD ± √(low·high)/(2f²) · BD⊥
    r3 × r4 = ±√(low·high)/2
"""

import math

from linksweep.physics.arithmetic import Number, atan2, degrees, sqrt, where
from linksweep.physics.planar import cross, dot


def rrr_close(
    BDx: Number,
    BDy: Number,
    low: Number,
    high: Number,
    coupler_length: Number,
    rocker_length: Number,
    side: Number,
    closure_unit: Number,
) -> tuple[Number, ...]:
    """Link vectors r3, r4 and 1/(r4 × r3), by one square root and one division; then their shares along BD, in units
    of it, and the one across that both have. `side` is 1 with C left of B→D."""
    difference = coupler_length - rocker_length
    ff = low + difference * difference / closure_unit
    root = side * sqrt(low * high)
    half_inverse = 0.5 / (ff * root)
    inverse_2ff = half_inverse * root
    along3 = (low + 2.0 * coupler_length * difference / closure_unit) * inverse_2ff
    along4 = (2.0 * rocker_length * difference / closure_unit - low) * inverse_2ff
    across = root * inverse_2ff
    side_x, side_y = across * BDy, across * BDx
    r3x, r3y = along3 * BDx - side_x, along3 * BDy + side_y
    r4x, r4y = along4 * BDx - side_x, along4 * BDy + side_y
    return r3x, r3y, r4x, r4y, -4.0 / closure_unit * (half_inverse * ff), along3, along4, across


def rrr_status(low: Number, high: Number, low_noise: Number, high_noise: Number) -> Number:
    """0 ok, 1 cannot assemble, 2 toggle: r3 and r4 in one line, as far as lengths and angle can tell."""
    closes = where(low * high > 0.0, 0.0, 1.0)
    return where(abs(low) > low_noise, where(abs(high) > high_noise, closes, 2.0), 2.0)


def rrr_velocity_ratios(
    r2_dot_BD: Number,
    r2_cross_BD: Number,
    along3: Number,
    along4: Number,
    across: Number,
    inverse_r4_cross_r3: Number,
) -> tuple[Number, Number]:
    """ω3/ω2 and ω4/ω2, from ω2 × r2 + ω3 × r3 = ω4 × r4 (document 2, ME 470, velocity): r2 × r4 and r2 × r3."""
    return (
        (along4 * r2_cross_BD + across * r2_dot_BD) * inverse_r4_cross_r3,
        (along3 * r2_cross_BD + across * r2_dot_BD) * inverse_r4_cross_r3,
    )


def rrr_leverage(ratio: Number, inverse_r4_cross_r3: Number) -> tuple[Number, Number]:
    """r2 × r4 from ω3/ω2, or r2 × r3 from ω4/ω2, and its inverse.

    The drive's unknown, from virtual work, is divided by the same ratio: near a dead centre both have the same error.
    """
    inverse = where(abs(ratio) > 0.0, inverse_r4_cross_r3 / ratio, math.nan)
    return ratio / inverse_r4_cross_r3, inverse


def rrr_accelerations(
    aBx: Number,
    aBy: Number,
    omega2: Number,
    omega3: Number,
    omega4: Number,
    BDx: Number,
    BDy: Number,
    r2_cross_BD: Number,
    r3x: Number,
    r3y: Number,
    r4x: Number,
    r4y: Number,
    inverse_r4_cross_r3: Number,
) -> tuple[Number, Number]:
    """α3 and α4, from a_B + α3 × r3 − ω3² r3 = α4 × r4 − ω4² r4 (document 2, ME 470, acceleration).

    The two last terms nearly cancel where both links are long; with r3 = BD + r4 and ω4 − ω3 = ω2 (r2 × BD)/(r4 × r3)
    they are −ω3² BD + (ω4² − ω3²) r4.
    """
    square3, growth = omega3 * omega3, omega2 * (r2_cross_BD * inverse_r4_cross_r3) * (omega3 + omega4)
    kx = aBx - square3 * BDx + growth * r4x
    ky = aBy - square3 * BDy + growth * r4y
    return (
        dot(kx, ky, r4x, r4y) * inverse_r4_cross_r3,
        dot(kx, ky, r3x, r3y) * inverse_r4_cross_r3,
    )


def rrr_pin_force(
    N3: Number,
    N4: Number,
    along3: Number,
    along4: Number,
    across: Number,
    BDx: Number,
    BDy: Number,
    inverse_r4_cross_r3: Number,
) -> tuple[Number, Number]:
    """F43 from r3 × F43 = −N3 and r4 × F43 = N4: what is left of the 9×9 once the rest is eliminated by hand.

    That is (N4 r3 + N3 r4)/(r4 × r3), by its shares along BD and across: in the ground's axes digits are lost where
    the links lie nearly in one line.
    """
    n3, n4 = N3 * inverse_r4_cross_r3, N4 * inverse_r4_cross_r3
    along, aside = n4 * along3 + n3 * along4, (n3 + n4) * across
    return along * BDx - aside * BDy, along * BDy + aside * BDx


def transmission_angle(r3x: Number, r3y: Number, r4x: Number, r4y: Number) -> Number:
    """Acute angle between coupler and rocker [degree]; document 2 leaves μ = θ4 − θ3 unfolded."""
    return degrees(atan2(abs(cross(r3x, r3y, r4x, r4y)), abs(dot(r3x, r3y, r4x, r4y))))
