"""The four-bar A-B-C-D: crank r2 = A→B of length a, frame line A→D of length d, joined by an RRR dyad.

With φ the angle from the frame line to the crank, f² = |BD|² = (d−a)² + 4ad·sin²(φ/2), so that

    low  = f² − (b−c)² = (d−a−b+c)(d−a+b−c) + 4ad·sin²(φ/2)
    high = (b+c)² − f² = (b+c−d−a)(b+c+d+a) + 4ad·cos²(φ/2)

Half angles keep every digit where cos φ would drop them, and lengths subtracted in these pairs are exactly 0 at a
change point with equal links. Open or crossed, the mechanism closes while low·high > 0.
"""

from linksweep.physics.arithmetic import NOISE, Number, where


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
