"""The dyad of a pin, a slider and a pin (RPR): a block on pin B slides along a line that turns about pin D.

With u the direction of the line and n = u⊥ its left normal, the line passes D at the offset e, and B lies at s on it:

    w = D→B = s u + e n,    s = ±√(|w|² − e²),    u = (s w − e w⊥)/|w|²         open branch: s > 0, B ahead of D

The mechanism supplies s² in a form that does not cancel. Block and line turn together, ω3 = ω4.
"""

from linksweep.physics.algebra.arithmetic import NOISE, Number, atan2, degrees, sqrt, where
from linksweep.physics.algebra.double_double import add, difference, divide, multiply, square_of, two_product
from linksweep.physics.algebra.double_double import dot as dot_pairs
from linksweep.physics.algebra.planar import cross, dot
from linksweep.physics.closures.crank_angle import CHANGE_POINT_NOISE, range_noise


def rpr_close(
    DBx: Number, DBy: Number, slide_squared: Number, offset: Number, branch_sign: Number
) -> tuple[Number, Number, Number, Number]:
    """Return s, 1/s and the line's direction u."""
    root = sqrt(slide_squared)
    slide, inverse = branch_sign * root, 1.0 / (slide_squared + offset * offset)
    along, across = slide * inverse, offset * inverse
    return slide, branch_sign / root, along * DBx + across * DBy, along * DBy - across * DBx


def rpr_between_pins(
    DBx: Number, DBy: Number, DBx_lo: Number, DBy_lo: Number, offset: Number, offset_lo: Number
) -> Number:
    """Return s² of the module's equation, for pins B and D that are double-doubles."""
    line_offset = offset, offset_lo
    return difference(square_of((DBx, DBx_lo), (DBy, DBy_lo)), multiply(line_offset, line_offset))


def rpr_noise(DBx: Number, DBy: Number, offset: Number) -> Number:
    """Return the noise floor of s² between any two pins."""
    size = DBx * DBx + DBy * DBy + offset * offset
    return size * (CHANGE_POINT_NOISE + range_noise(size))


def standing_noise(DBx: Number, DBy: Number, offset: Number) -> Number:
    """Return the velocity per radian of the crank below which the block stands still: rounding of lengths."""
    return 0.25 * NOISE * (abs(DBx) + abs(DBy) + abs(offset))


def rpr_direction(
    DBx: Number,
    DBy: Number,
    DBx_lo: Number,
    DBy_lo: Number,
    offset: Number,
    offset_lo: Number,
    slide: Number,
) -> tuple[Number, Number, Number, Number]:
    """Return u of the module's equations, and its low words."""
    w, square, e = ((DBx, DBx_lo), (DBy, DBy_lo)), square_of((DBx, DBx_lo), (DBy, DBy_lo)), (offset, offset_lo)
    e_squared = multiply(e, e)
    slide_squared = add(square, (-e_squared[0], -e_squared[1]))
    s = slide, 0.5 * (difference(slide_squared, two_product(slide, slide)) / slide)
    x, y = divide(dot_pairs(s, e, *w), square), divide(dot_pairs(s, (-e[0], -e[1]), w[1], w[0]), square)
    return x[0], y[0], x[1], y[1]


def rpr_status(slide_squared: Number, noise: Number) -> Number:
    """Return 0 ok, 1 cannot assemble, or 2 toggle: D→B perpendicular to the line within lengths' and angle's error."""
    return where(abs(slide_squared) > noise, where(slide_squared > 0.0, 0.0, 1.0), 2.0)


def rpr_velocity_ratios(crank_along: Number, slide_leverage: Number, inverse_slide: Number) -> tuple[Number, Number]:
    """Return ω4/ω2 and s'/ω2, from ω2 × r2 = s' u + ω4 × w.

    Across the line, r2·u = s ω4/ω2; along w, r2 × w = s s'/ω2.
    """
    return crank_along * inverse_slide, slide_leverage * inverse_slide


def rpr_accelerations(
    aBx: Number,
    aBy: Number,
    omega4: Number,
    slide: Number,
    slide_velocity: Number,
    inverse_slide: Number,
    offset: Number,
    r3x: Number,
    r3y: Number,
) -> tuple[Number, Number]:
    """Return α4 and s'', from a_B = s'' u + 2 ω4 × s' u (Coriolis) + α4 × w − ω4² w, across the line and along it."""
    square4 = omega4 * omega4
    across = cross(r3x, r3y, aBx, aBy) - 2.0 * (slide_velocity * omega4)
    alpha4 = (across + square4 * offset) * inverse_slide
    return alpha4, dot(aBx, aBy, r3x, r3y) + alpha4 * offset + square4 * slide


def rpr_transmission_angle(slide: Number, offset: Number) -> Number:
    """Return the acute angle between D→B and the line's normal [degree]: 90 where the line passes through D, 0 at a
    toggle."""
    return degrees(atan2(abs(slide), abs(offset)))
