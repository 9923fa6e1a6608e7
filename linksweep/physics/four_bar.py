"""The four-bar A-B-C-D: crank r2 = A→B of length a, frame line A→D of length d, joined by an RRR dyad.

With ψ the angle from the frame line to the crank, f² = |BD|² = a² + d² − 2ad·cos ψ, so that

    low  = f² − (b−c)² = 2ad·(cos ψ_f − cos ψ),    cos ψ_f =  1 + (d−a−b+c)(d−a+b−c)/(2ad)    folded over the rocker
    high = (b+c)² − f² = 2ad·(cos ψ − cos ψ_s),    cos ψ_s = −1 − (b+c−d−a)(b+c+d+a)/(2ad)    stretched out

in units of 2ad, so that nothing goes beyond the square of a length. Open or crossed, the mechanism closes while
low·high > 0. All that cancels are the differences of cosines, which are therefore sums of two numbers each, and sums
of lengths, which are exact.

Where ψ_f = 0 or ψ_s = 180° the mechanism has a change point: it passes through its toggle, flat, and can leave it on
either branch. With both (parallelogram a = c, b = d; kite a = b, c = d) the side of B→D that C is on changes twice a
turn, and the branch goes through: sin ψ says the side. With one it would take two turns to come round, so C keeps to
its side.
"""

from linksweep.physics.arithmetic import Number, sqrt, where
from linksweep.physics.crank_angle import beyond_range, unknown_of_cosine
from linksweep.physics.double_double import add, difference, divide, multiply, two_product, two_sum

LENGTH_NOISE = 2.0**-52
"""What sums of lengths may be off by, relative to the sum of all: each length is rounded in its last digit."""


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


def crank_on_diagonal(
    crank_length: Number, ground_length: Number, pinch_cos: Number, pinch_sin: Number
) -> tuple[Number, Number]:
    """r2 · BD and r2 × BD, which keeps its digits where the links lie flat."""
    return (
        crank_length * (ground_length * pinch_cos - crank_length),
        -(crank_length * ground_length * pinch_sin),
    )


def toggle_cosines(
    crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number
) -> tuple[Number, Number, Number, Number]:
    """cos ψ_f and cos ψ_s, each with its rest."""
    a, b, c, d = crank_length, coupler_length, rocker_length, ground_length
    c_a, twice_ad = two_sum(c, -a), two_product(2.0 * a, d)
    least_low = multiply(add(two_sum(d, -b), c_a), add(two_sum(d, -c), two_sum(b, -a)))
    least_high = multiply(add(two_sum(d, -b), two_sum(a, -c)), add(two_sum(b, c), two_sum(d, a)))
    folded = add((1.0, 0.0), divide(least_low, twice_ad))
    stretched = add((-1.0, 0.0), divide(least_high, twice_ad))
    return *folded, *stretched


def closure_unit(crank_length: Number, ground_length: Number) -> Number:
    """2ad."""
    return 2.0 * crank_length * ground_length


def closure_factors(
    pinch_cos: Number,
    pinch_cos_rest: Number,
    folded_cos: Number,
    folded_cos_rest: Number,
    stretched_cos: Number,
    stretched_cos_rest: Number,
) -> tuple[Number, Number]:
    """low and high, as the module's equations write them."""
    cosine = pinch_cos, pinch_cos_rest
    low = difference((folded_cos, folded_cos_rest), cosine)
    return low, difference(cosine, (stretched_cos, stretched_cos_rest))


def change_points(
    crank_length: Number,
    coupler_length: Number,
    rocker_length: Number,
    ground_length: Number,
    closure_unit: Number,
    folded_cos: Number,
    folded_cos_rest: Number,
    stretched_cos: Number,
    stretched_cos_rest: Number,
) -> tuple[Number, Number, Number, Number, Number]:
    """By how much the toggles' cosines miss 1 and −1, what of that may be rounding, and 1 where both are change
    points as far as the lengths can tell."""
    a, b, c, d = crank_length, coupler_length, rocker_length, ground_length
    perimeter = a + b + c + d
    noise = LENGTH_NOISE * perimeter
    folded_noise = noise * (abs(d - a) + abs(b - c) + noise) / closure_unit
    stretched_noise = noise * perimeter / closure_unit
    folded_miss = difference((folded_cos, folded_cos_rest), (1.0, 0.0))
    stretched_miss = difference((stretched_cos, stretched_cos_rest), (-1.0, 0.0))
    also_stretched = where(abs(stretched_miss) < stretched_noise, 1.0, 0.0)
    parallel = where(abs(folded_miss) < folded_noise, also_stretched, 0.0)
    return folded_miss, folded_noise, stretched_miss, stretched_noise, parallel


def side_of_diagonal(parallel: Number, pinch_sin: Number, branch_sign: Number) -> Number:
    """1 with C to the left of the line B→D, −1 to its right."""
    return where(parallel * pinch_sin < 0.0, -branch_sign, branch_sign)


def closure_noise(
    closure_unit: Number,
    folded_miss: Number,
    folded_noise: Number,
    stretched_miss: Number,
    stretched_noise: Number,
    pinch_sin: Number,
) -> tuple[Number, Number]:
    """What low and high cannot tell from zero."""
    beyond = beyond_range(closure_unit)
    return (
        unknown_of_cosine(folded_miss, folded_noise, pinch_sin) + beyond,
        unknown_of_cosine(stretched_miss, stretched_noise, pinch_sin) + beyond,
    )


def extremes(
    crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number
) -> tuple[Number, Number, Number, Number]:
    """The least and the largest low, at ψ = 0 and 180°, and the least and the largest high, at 180° and 0."""
    a, b, c, d = crank_length, coupler_length, rocker_length, ground_length
    return (
        ((d - b) + (c - a)) * ((d - c) + (b - a)),
        ((d - b) + (c + a)) * ((d - c) + (b + a)),
        ((b - d) + (c - a)) * (b + c + d + a),
        ((b - d) + (c + a)) * ((c - a) + (b + d)),
    )


def assembly(crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number) -> Number:
    """0 where it closes at every angle, 1 where at some, 2 where at none."""
    least_low, largest_low, least_high, largest_high = extremes(
        crank_length, coupler_length, rocker_length, ground_length
    )
    partly = where(least_low < 0.0, 1.0, where(least_high < 0.0, 1.0, 0.0))
    return where(largest_low < 0.0, 2.0, where(largest_high < 0.0, 2.0, partly))


def pinch_widths(
    crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number
) -> tuple[Number, Number]:
    """How narrow forces may peak about ψ = 0 and 180°: low and high are x + y·tan², and zero at tan = ±i·√(x/y)."""
    least_low, largest_low, least_high, largest_high = extremes(
        crank_length, coupler_length, rocker_length, ground_length
    )
    return sqrt(least_low / largest_low), sqrt(least_high / largest_high)
