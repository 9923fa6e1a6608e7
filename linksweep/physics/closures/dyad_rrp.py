"""The dyad of two pins and a slider (RRP): rod r3 = B→C of length b, with C on a straight guide.

In the guide's axes, s along it and n across, C stays at the height e. So the rod's component across, h = r3·n = e −
r2·n, is known, and its component along is q = r3·s = ±√(b² − h²): + on the open branch, C ahead of B. The mechanism
supplies the factors low = b − h and high = b + h in a form that does not cancel.
"""

from linksweep.physics.algebra.arithmetic import Number, atan2, degrees, sqrt, where
from linksweep.physics.algebra.double_double import difference, overlapping_dot, two_sum
from linksweep.physics.algebra.planar import dot
from linksweep.physics.closures.crank_angle import CHANGE_POINT_NOISE, range_noise


def rrp_close(
    low: Number, high: Number, rod_across: Number, guide_cos: Number, guide_sin: Number, branch_sign: Number
) -> tuple[Number, Number, Number, Number]:
    """Return r3 in ground axes, its component along the guide, and the inverse of that component."""
    root = sqrt(low * high)
    along = branch_sign * root
    return (
        along * guide_cos - rod_across * guide_sin,
        along * guide_sin + rod_across * guide_cos,
        along,
        branch_sign / root,
    )


def rrp_between(
    Bx: Number,
    By: Number,
    Bx_lo: Number,
    By_lo: Number,
    guide_cos: Number,
    guide_sin: Number,
    guide_cos_lo: Number,
    guide_sin_lo: Number,
    offset: Number,
    offset_lo: Number,
    rod_length: Number,
    rod_length_lo: Number,
) -> tuple[Number, Number, Number, Number]:
    """Return B's component along the guide and the rod's across it, and the factors low and high.

    B is a sum of two words, and the guide's direction a double-double, from the origin of the guide's axes, from which
    the guide lies at the offset.
    """
    guide_x, guide_y, rod = (guide_cos, guide_cos_lo), (guide_sin, guide_sin_lo), (rod_length, rod_length_lo)
    B_across, B_across_lo = overlapping_dot(guide_x, guide_y, (By, By_lo), (-Bx, -Bx_lo))
    across, across_lo = two_sum(offset, -B_across)
    across_lo = across_lo + (offset_lo - B_across_lo)
    low, high = difference(rod, (across, across_lo)), difference(rod, (-across, -across_lo))
    return dot(Bx, By, guide_cos, guide_sin), across + across_lo, low, high


def rrp_noise(rod_length: Number, offset: Number) -> Number:
    """Return the noise floor of low and high between any pin and guide."""
    size = rod_length + abs(offset)
    return size * (CHANGE_POINT_NOISE + range_noise(size * size))


def rrp_status(low: Number, high: Number, low_noise: Number, high_noise: Number) -> Number:
    """Return 0 ok, 1 cannot assemble, or 2 toggle: the rod perpendicular to the guide within the error of lengths and
    angle."""
    closes = where(low * high > 0.0, 0.0, 1.0)
    return where(abs(low) > low_noise, where(abs(high) > high_noise, closes, 2.0), 2.0)


def rrp_velocity_ratios(
    crank_along: Number, crank_across: Number, rod_across: Number, inverse_rod_along: Number
) -> tuple[Number, Number]:
    """Return ω3/ω2 and v_slider/ω2, from ω2 × r2 + ω3 × r3 = v s."""
    ratio3 = -(crank_along * inverse_rod_along)
    return ratio3, -crank_across - ratio3 * rod_across


def rrp_accelerations(
    aBx: Number,
    aBy: Number,
    omega3: Number,
    rod_along: Number,
    rod_across: Number,
    inverse_rod_along: Number,
    guide_cos: Number,
    guide_sin: Number,
) -> tuple[Number, Number]:
    """Return α3 and a_slider, from a_B + α3 × r3 − ω3² r3 = a s."""
    square3 = omega3 * omega3
    aB_across = guide_cos * aBy - guide_sin * aBx
    alpha3 = (square3 * rod_across - aB_across) * inverse_rod_along
    return alpha3, dot(aBx, aBy, guide_cos, guide_sin) - alpha3 * rod_across - square3 * rod_along


def rod_transmission_angle(rod_along: Number, rod_across: Number) -> Number:
    """Return the acute angle between the rod and the guide's normal [degree]: 90 with the rod along the guide, 0 at a
    toggle."""
    return degrees(atan2(abs(rod_along), abs(rod_across)))
