"""The dyad of two sliders that share a pin (PRP): pin C where two known guides cross.

Guide i has the direction g_i and the left normal n_i, and lies at the offset e_i from the origin O_i of its axes. With
γ the angle from the first to the second, and D = O_1→O_2, the positions along the guides are

    x_1 = (e_1 cos γ − e_2 − n_2·D)/sin γ        x_2 = (e_1 − e_2 cos γ − n_1·D)/sin γ

There is one position, unless the guides are parallel.
"""

from linksweep.physics.algebra.arithmetic import Number, atan2, degrees, where
from linksweep.physics.algebra.double_double import add, difference, dot, multiply
from linksweep.physics.algebra.double_double import cross as cross_pairs
from linksweep.physics.algebra.planar import cross


def prp_crossing(
    guide_cos: Number,
    guide_sin: Number,
    guide_cos_lo: Number,
    guide_sin_lo: Number,
    second_guide_cos: Number,
    second_guide_sin: Number,
    second_guide_cos_lo: Number,
    second_guide_sin_lo: Number,
) -> tuple[Number, Number, Number, Number]:
    """Return cos γ and its low word, sin γ, and sin² γ."""
    first = (guide_cos, guide_cos_lo), (guide_sin, guide_sin_lo)
    second = (second_guide_cos, second_guide_cos_lo), (second_guide_sin, second_guide_sin_lo)
    sin = cross_pairs(*first, *second)
    return *dot(*first, *second), sin, sin * sin


def prp_gap(
    OOx: Number,
    OOy: Number,
    OOx_lo: Number,
    OOy_lo: Number,
    guide_cos: Number,
    guide_sin: Number,
    guide_cos_lo: Number,
    guide_sin_lo: Number,
    offset: Number,
    offset_lo: Number,
    other_offset: Number,
    other_offset_lo: Number,
    crossing_cos: Number,
    crossing_cos_lo: Number,
) -> tuple[Number, Number]:
    """Return e − e' cos γ + n·D of this guide and another, D from that guide's origin to this one's; and the size of
    its terms.

    Divided by the sine of the angle from this guide to the other, it is the position along the other guide.
    """
    across = dot((guide_cos, guide_cos_lo), (-guide_sin, -guide_sin_lo), (OOy, OOy_lo), (OOx, OOx_lo))
    turned = multiply((other_offset, other_offset_lo), (crossing_cos, crossing_cos_lo))
    gap = difference(add((offset, offset_lo), across), turned)
    return gap, abs(OOx) + abs(OOy) + abs(offset) + abs(other_offset)


def prp_positions(gap: Number, second_gap: Number, crossing_sin: Number) -> tuple[Number, Number, Number]:
    """Return x_1 and x_2 of the module's equations, from the gaps of the second and of the first guide; and 1/sin γ."""
    inverse = 1.0 / crossing_sin
    return -(gap * inverse), second_gap * inverse, inverse


def prp_status(low: Number, low_noise: Number) -> Number:
    """Return 0 ok, or 2 toggle: the guides parallel within the error of their angles."""
    return where(low > low_noise, 0.0, 2.0)


def prp_rates(
    wx: Number,
    wy: Number,
    guide_cos: Number,
    guide_sin: Number,
    second_guide_cos: Number,
    second_guide_sin: Number,
    crossing_sin: Number,
) -> tuple[Number, Number]:
    """Return x_1' and x_2' of  x_1' g_1 − x_2' g_2 = w,  the velocity of the second guide less that of the first, at C;
    or x_1'' and x_2'', from their accelerations."""
    inverse = 1.0 / crossing_sin
    return (
        cross(wx, wy, second_guide_cos, second_guide_sin) * inverse,
        cross(wx, wy, guide_cos, guide_sin) * inverse,
    )


def crossing_angle(cos: Number, sin: Number) -> Number:
    """Return the acute angle between two lines [degree], from cosine and sine of any angle between them."""
    return degrees(atan2(abs(sin), abs(cos)))
