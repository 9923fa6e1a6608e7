"""The dyad of three pins (RRR): coupler r3 = B→C of length b and rocker r4 = D→C of length c, closed between B and D.

With f = |BD|, the triangle B, C, D has 16·area² = ((b+c)² − f²)·(f² − (b−c)²) = high·low. The mechanism supplies both
factors, divided by its closure unit (the square of a length), in a form that does not cancel; the plain triangle
formulas lose all digits near a toggle. The rest follows without another subtraction of nearly equal numbers:

    r3 = (low + 2b(b−c))/(2f²) · BD ± √(low·high)/(2f²) · BD⊥          open branch: +, C left of B→D
    r4 = −(low − 2c(b−c))/(2f²) · BD ± √(low·high)/(2f²) · BD⊥
    r3 × r4 = ±√(low·high)/2
"""

from linksweep.physics.algebra.arithmetic import Number, atan2, degrees, sqrt, where
from linksweep.physics.algebra.double_double import add, difference, multiply, overlapping_square
from linksweep.physics.algebra.planar import cross, dot
from linksweep.physics.closures.crank_angle import CHANGE_POINT_NOISE, range_noise
from linksweep.physics.crank_driven import moments_or_work


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
    """Return link vectors r3, r4 and 1/(r4 × r3), by one square root and one division; then along3 and along4, their
    components along BD, and `across`, the component across it that both have, in units of |BD|; last 1/(2f²) and
    ±1/(2√(low·high)) in closure units. `side` is 1 with C left of B→D."""
    difference = coupler_length - rocker_length
    ff = low + difference * difference / closure_unit
    root = side * sqrt(low * high)
    half_inverse = 0.5 / (ff * root)
    inverse_2ff, half_inverse_root = half_inverse * root, half_inverse * ff
    along3 = (low + 2.0 * coupler_length * difference / closure_unit) * inverse_2ff
    along4 = (2.0 * rocker_length * difference / closure_unit - low) * inverse_2ff
    across = root * inverse_2ff
    side_x, side_y = across * BDy, across * BDx
    r3x, r3y = along3 * BDx - side_x, along3 * BDy + side_y
    r4x, r4y = along4 * BDx - side_x, along4 * BDy + side_y
    inverse_r4_cross_r3 = -4.0 / closure_unit * half_inverse_root
    return r3x, r3y, r4x, r4y, inverse_r4_cross_r3, along3, along4, across, inverse_2ff, half_inverse_root


def rrr_between_pins(
    BDx: Number,
    BDy: Number,
    BDx_lo: Number,
    BDy_lo: Number,
    coupler_length: Number,
    coupler_length_lo: Number,
    rocker_length: Number,
    rocker_length_lo: Number,
) -> tuple[Number, Number]:
    """Return low and high of the module's equations, for B→D as a sum of two words."""
    b, c = (coupler_length, coupler_length_lo), (rocker_length, rocker_length_lo)
    square, difference_bc, sum_bc = overlapping_square((BDx, BDx_lo), (BDy, BDy_lo)), add(b, (-c[0], -c[1])), add(b, c)
    low = difference(square, multiply(difference_bc, difference_bc))
    return low, difference(multiply(sum_bc, sum_bc), square)


def rrr_reach(coupler_length: Number, rocker_length: Number) -> tuple[Number, Number]:
    """Return (b+c)², and the noise floor of low and high between any two pins."""
    square = (coupler_length + rocker_length) * (coupler_length + rocker_length)
    return square, square * (CHANGE_POINT_NOISE + range_noise(square))


def rrr_ratios_between_pins(
    wx: Number,
    wy: Number,
    r3x: Number,
    r3y: Number,
    r4x: Number,
    r4y: Number,
    inverse_r4_cross_r3: Number,
) -> tuple[Number, Number]:
    """Return k3 and k4 of  k3⊥r3 − k4⊥r4 = w,  with w the velocity of D less that of B, per rate of the crank."""
    return -(dot(wx, wy, r4x, r4y) * inverse_r4_cross_r3), -(dot(wx, wy, r3x, r3y) * inverse_r4_cross_r3)


def rrr_slopes_between_pins(
    wx: Number,
    wy: Number,
    ratio3: Number,
    ratio4: Number,
    r3x: Number,
    r3y: Number,
    r4x: Number,
    r4y: Number,
    inverse_r4_cross_r3: Number,
) -> tuple[Number, Number]:
    """Return the derivatives of k3 and k4 to the crank's angle; w is the derivative of the velocity of D less B's."""
    square3, square4 = ratio3 * ratio3, ratio4 * ratio4
    across = wx + square3 * r3x - square4 * r4x, wy + square3 * r3y - square4 * r4y
    return rrr_ratios_between_pins(*across, r3x, r3y, r4x, r4y, inverse_r4_cross_r3)


def rrr_status(low: Number, high: Number, low_noise: Number, high_noise: Number) -> Number:
    """Return 0 ok, 1 cannot assemble, or 2 toggle: r3 and r4 in one line within the error of lengths and angle."""
    closes = where(low * high > 0.0, 0.0, 1.0)
    return where(abs(low) > low_noise, where(abs(high) > high_noise, closes, 2.0), 2.0)


def rrr_velocity_ratios(
    along3: Number, along4: Number, crank_along: Number, crank_per_across: Number
) -> tuple[Number, Number]:
    """Return ω3/ω2 and ω4/ω2, from ω2 × r2 + ω3 × r3 = ω4 × r4 (document 2, ME 470, velocity).

    They are r2 × r4 and r2 × r3 over r4 × r3, written with the crank's component along BD (`crank_along`) and with its
    component across divided by that of coupler and rocker (`crank_per_across`).
    """
    return along4 * crank_per_across - crank_along, along3 * crank_per_across - crank_along


def rrr_leverage(ratio: Number, inverse_r4_cross_r3: Number) -> Number:
    """Return r2 × r4 from ω3/ω2, or r2 × r3 from ω4/ω2."""
    return ratio / inverse_r4_cross_r3


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
    """Return F43 from r3 × F43 = −N3 and r4 × F43 = N4: two equations remain of the 9×9 after elimination by hand.

    Their solution (N4 r3 + N3 r4)/(r4 × r3) is summed in components along BD and across: in ground axes digits are lost
    where the links lie nearly in one line.
    """
    n3, n4 = N3 * inverse_r4_cross_r3, N4 * inverse_r4_cross_r3
    force_along, force_across = n4 * along3 + n3 * along4, (n3 + n4) * across
    return force_along * BDx - force_across * BDy, force_along * BDy + force_across * BDx


def rrr_driven_pin_force(
    r2x: Number,
    r2y: Number,
    crank_length: Number,
    moment_r2: Number,
    rx: Number,
    ry: Number,
    moment: Number,
    ratio: Number,
    inverse_r4_cross_r3: Number,
) -> tuple[Number, Number, Number, Number]:
    """Return F43 from r2 × F43 = moment_r2 and r × F43 = moment, where r is the link without the drive; then its
    component along r2 times r4 × r3 (a moment, `pull`) and its component across (`push`), both divided by |r2|.

    The driven link's ratio to the crank vanishes at a dead centre and is divided by once only, so that force and torque
    have the same error.
    """
    across = moment_r2 * (1.0 / (crank_length * crank_length))
    pull = (across * dot(r2x, r2y, rx, ry) - moment) / ratio
    along = pull * inverse_r4_cross_r3
    return along * r2x - across * r2y, along * r2y + across * r2x, pull, across


def rrr_rocker_torque(
    pull: Number,
    push: Number,
    N4: Number,
    r2x: Number,
    r2y: Number,
    r4x: Number,
    r4y: Number,
    work: Number,
    ratio4: Number,
    ratio3: Number,
) -> Number:
    """Return T14, from r4 × F43 = N4 + T14 while the rocker is slower than the coupler, then from virtual work."""
    by_moments = push * dot(r2x, r2y, r4x, r4y) - pull * ratio3 - N4
    return moments_or_work(by_moments, work, ratio4, ratio3)


def rrr_coupler_torque(
    pull: Number,
    push: Number,
    N3: Number,
    r2x: Number,
    r2y: Number,
    r3x: Number,
    r3y: Number,
    work: Number,
    ratio3: Number,
    ratio4: Number,
) -> Number:
    """Return T13, from r3 × F43 = −N3 − T13 while the coupler is slower than the rocker, then from virtual work."""
    by_moments = pull * ratio4 - push * dot(r2x, r2y, r3x, r3y) - N3
    return moments_or_work(by_moments, work, ratio3, ratio4)


def transmission_angle(r3x: Number, r3y: Number, r4x: Number, r4y: Number) -> Number:
    """Return the acute angle between coupler and rocker [degree]."""
    return degrees(atan2(abs(cross(r3x, r3y, r4x, r4y)), abs(dot(r3x, r3y, r4x, r4y))))


def transmission_angle_signed(r3x: Number, r3y: Number, r4x: Number, r4y: Number) -> Number:
    """Return μ = θ4 − θ3 of document 2 (ME 470) [degree], in (−180, 180]: positive with C to the left of B→D."""
    return degrees(atan2(cross(r3x, r3y, r4x, r4y), dot(r3x, r3y, r4x, r4y)))
