"""The four-bar A-B-C-D: crank r2 = A→B of length a, frame line A→D of length d, joined by an RRR dyad.

With ψ the angle from the frame line to the crank, f² = |BD|² = a² + d² − 2ad·cos ψ, so that

    low  = f² − (b−c)² = 2ad·(cos ψ_f − cos ψ),    cos ψ_f =  1 + (d−a−b+c)(d−a+b−c)/(2ad)    folded over the rocker
    high = (b+c)² − f² = 2ad·(cos ψ − cos ψ_s),    cos ψ_s = −1 − (b+c−d−a)(b+c+d+a)/(2ad)    stretched out

in units of 2ad, so that no higher power than the square of a length occurs. Open or crossed, the mechanism closes while
low·high > 0. Only the differences of cosines cancel, so the cosines are kept in double-double; the sums of lengths are
exact.

With p and q the crank's components along BD and across it, in units of f, and along3, along4 and across those of
coupler and rocker (see `linksweep.physics.closures.dyad_rrr`), k3 = ω3/ω2 = along4·q/across − p, and k4 likewise
with along3. Their derivatives with respect to the crank's angle are

    k3' = q (1 − k3 − k4) + along4·g    k4' = q (1 − k3 − k4) + along3·g
    f² (1 − k3 − k4) = d² − a² − (b² − c²)·q/across
    g = (low₀·high·(1 + cos ψ) − high₀·low·(1 − cos ψ)) / (2·√(low·high)³)

with low₀ = low at ψ = 0 and high₀ = high at 180°. With a change point one of them vanishes; in a parallelogram both do,
and with them g. This form keeps its digits where the links lie nearly flat: there a difference of accelerations over
the sine of the angle between r3 and r4 would have none left.

Where ψ_f = 0 or ψ_s = 180° the mechanism has a change point: it passes through its toggle, flat, and can leave it on
either branch. With both (parallelogram a = c, b = d; kite a = b, c = d) the side of B→D that C is on changes twice a
turn, and the branch goes through: the sign of sin ψ gives the side. With only one, such a motion would repeat after
two turns, so C keeps to its side.
"""

from linksweep.physics.algebra.arithmetic import Number, sqrt, where
from linksweep.physics.algebra.double_double import add, difference, divide, multiply, two_product, two_sum
from linksweep.physics.closures.crank_angle import cosine_noise, range_noise

LENGTH_NOISE = 2.0**-52
"""Rounding error of a sum of lengths, relative to the sum of all: each length is rounded in its last digit."""


def diagonal(
    crank_length: Number,
    ground_length: Number,
    ground_cos: Number,
    ground_sin: Number,
    versine: Number,
    psi_sin: Number,
) -> tuple[Number, Number]:
    """Return the vector B→D, from its components along the frame line and across, which stay accurate where B is near
    D."""
    along, across = (ground_length - crank_length) + crank_length * versine, -(crank_length * psi_sin)
    return along * ground_cos - across * ground_sin, along * ground_sin + across * ground_cos


def crank_on_diagonal(
    crank_length: Number,
    ground_length: Number,
    versine: Number,
    psi_sin: Number,
    inverse_2ff: Number,
    half_inverse_root: Number,
) -> tuple[Number, Number, Number]:
    """Return p and q, accurate also where the links lie flat, and q over the component across of coupler and rocker."""
    along = (ground_length - crank_length) / ground_length - versine
    return along * inverse_2ff, psi_sin * inverse_2ff, 2.0 * psi_sin * half_inverse_root


def least_factors(
    crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number
) -> tuple[Number, Number, Number, Number]:
    """Return low at ψ = 0 and high at 180°, each as a double-double."""
    a, b, c, d = crank_length, coupler_length, rocker_length, ground_length
    c_a, twice_ad = two_sum(c, -a), two_product(2.0 * a, d)
    low = multiply(add(two_sum(d, -b), c_a), add(two_sum(d, -c), two_sum(b, -a)))
    high = multiply(add(two_sum(b, -d), c_a), add(two_sum(b, c), two_sum(d, a)))
    return *divide(low, twice_ad), *divide(high, twice_ad)


def sums_unit(
    crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number, closure_unit: Number
) -> Number:
    """Return the rounding error of the least factors relative to that of a double-double cosine (2⁻⁸⁶).

    Their sums of lengths are rounded to 2⁻¹⁰² of perimeter²/(2ad).
    """
    perimeter = crank_length + coupler_length + rocker_length + ground_length
    return 2.0**-16 * perimeter * perimeter / closure_unit


def toggle_cosines(
    least_low: Number, least_low_lo: Number, least_high: Number, least_high_lo: Number
) -> tuple[Number, Number, Number, Number]:
    """Return cos ψ_f and cos ψ_s, each as a double-double."""
    return *add((1.0, 0.0), (least_low, least_low_lo)), *add((-1.0, 0.0), (-least_high, -least_high_lo))


def closure_unit(crank_length: Number, ground_length: Number) -> Number:
    """Return 2ad."""
    return 2.0 * crank_length * ground_length


def closure_factors(
    psi_cos: Number,
    psi_cos_lo: Number,
    folded_cos: Number,
    folded_cos_lo: Number,
    stretched_cos: Number,
    stretched_cos_lo: Number,
) -> tuple[Number, Number]:
    """Return low and high of the module's equations."""
    cosine = psi_cos, psi_cos_lo
    low = difference((folded_cos, folded_cos_lo), cosine)
    return low, difference(cosine, (stretched_cos, stretched_cos_lo))


def change_points(
    crank_length: Number,
    coupler_length: Number,
    rocker_length: Number,
    ground_length: Number,
    closure_unit: Number,
    least_low: Number,
    least_high: Number,
) -> tuple[Number, Number, Number]:
    """Return the noise floors of `least_low` and `least_high`; `parallel` is 1 where both lie below them (parallelogram
    or kite)."""
    a, b, c, d = crank_length, coupler_length, rocker_length, ground_length
    perimeter = a + b + c + d
    noise = LENGTH_NOISE * perimeter
    folded_noise = noise * (abs(d - a) + abs(b - c) + noise) / closure_unit
    stretched_noise = noise * perimeter / closure_unit
    also_stretched = where(abs(least_high) < stretched_noise, 1.0, 0.0)
    parallel = where(abs(least_low) < folded_noise, also_stretched, 0.0)
    return folded_noise, stretched_noise, parallel


def side_of_diagonal(parallel: Number, psi_sin: Number, branch_sign: Number) -> Number:
    """Return 1 with C to the left of the line B→D, −1 to its right."""
    return where(parallel * psi_sin < 0.0, -branch_sign, branch_sign)


def closure_noise(
    closure_unit: Number,
    least_low: Number,
    folded_noise: Number,
    least_high: Number,
    stretched_noise: Number,
    psi_sin: Number,
    sums_unit: Number,
) -> tuple[Number, Number]:
    """Return the noise floors of low and high, below which they may be zero."""
    beyond = range_noise(closure_unit) + sums_unit * range_noise(sums_unit * sums_unit)
    return (
        cosine_noise(least_low, folded_noise, psi_sin) + beyond,
        cosine_noise(least_high, stretched_noise, psi_sin) + beyond,
    )


def ratio_slopes(
    low: Number,
    high: Number,
    least_low: Number,
    least_high: Number,
    versine: Number,
    vercosine: Number,
    half_inverse_root: Number,
    along3: Number,
    along4: Number,
    crank_across: Number,
    crank_per_across: Number,
    inverse_2ff: Number,
    crank_length: Number,
    coupler_length: Number,
    rocker_length: Number,
    ground_length: Number,
    closure_unit: Number,
) -> tuple[Number, Number]:
    """Return k3' and k4' of the module's equations."""
    numerator = 4.0 * least_low * vercosine * high - 4.0 * least_high * versine * low
    growth = numerator * (half_inverse_root * half_inverse_root) * half_inverse_root
    a, b, c, d = crank_length, coupler_length, rocker_length, ground_length
    crank_term, dyad_term = 2.0 * (d - a) * (d + a) / closure_unit, 2.0 * (b - c) * (b + c) / closure_unit
    common = crank_across * ((crank_term - dyad_term * crank_per_across) * inverse_2ff)
    return common + along4 * growth, common + along3 * growth


def extremes(
    crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number
) -> tuple[Number, Number, Number, Number]:
    """Return the least and the largest low, at ψ = 0 and 180°, and the least and the largest high, at 180° and 0."""
    a, b, c, d = crank_length, coupler_length, rocker_length, ground_length
    return (
        ((d - b) + (c - a)) * ((d - c) + (b - a)),
        ((d - b) + (c + a)) * ((d - c) + (b + a)),
        ((b - d) + (c - a)) * (b + c + d + a),
        ((b - d) + (c + a)) * ((c - a) + (b + d)),
    )


def assembly(crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number) -> Number:
    """Return 0 where it closes at every angle, 1 where at some, 2 where at none."""
    least_low, largest_low, least_high, largest_high = extremes(
        crank_length, coupler_length, rocker_length, ground_length
    )
    partly = where(least_low < 0.0, 1.0, where(least_high < 0.0, 1.0, 0.0))
    return where(largest_low < 0.0, 2.0, where(largest_high < 0.0, 2.0, partly))


def near_toggle_widths(
    crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number
) -> tuple[Number, Number]:
    """Return the half-widths, as tan(angle/2), of the narrowest peaks that forces may have about ψ = 0 and 180°.

    Low and high are x + y·tan² of half the angle from there, and vanish at tan = ±i·√(x/y): the width is √(x/y).
    """
    least_low, largest_low, least_high, largest_high = extremes(
        crank_length, coupler_length, rocker_length, ground_length
    )
    return sqrt(least_low / largest_low), sqrt(least_high / largest_high)
