"""Double-double arithmetic: a number as the unevaluated sum of a high and a low word, precise to twice the digits.

Sums and products of two floats are exact under IEEE rounding, provided nothing overflows or underflows and nothing is
contracted or reordered (Knuth, TAOCP 2, 4.2.2): `rounded` keeps sums in a trace from taking exact products. Where high
words cancel in a difference, the low words hold the remaining digits.
"""

from linksweep.physics.algebra.arithmetic import Number, marked_low, ordered_low, product_low, rounded, sum_low

Pair = tuple[Number, Number]
"""A double-double (high, low); high is the sum rounded to a float."""


def two_sum(x: Number, y: Number) -> Pair:
    """Return x + y exactly."""
    return rounded(x) + rounded(y), sum_low(x, y)


def ordered_sum(x: Number, y: Number) -> Pair:
    """Return x + y exactly, where |x| ≥ |y| or x = 0."""
    return rounded(x) + rounded(y), ordered_low(x, y)


def two_product(x: Number, y: Number) -> Pair:
    """Return x·y exactly."""
    return rounded(x * y), product_low(x, y)


def add(p: Pair, q: Pair) -> Pair:
    high, low = two_sum(p[0], q[0])
    return ordered_sum(high, low + (p[1] + q[1]))


def multiply(p: Pair, q: Pair) -> Pair:
    high, low = two_product(p[0], q[0])
    return ordered_sum(high, low + (p[0] * q[1] + p[1] * q[0]))


def divide(p: Pair, q: Pair) -> Pair:
    high = p[0] / q[0]
    product, product_lo = two_product(high, q[0])
    missed = (((p[0] - product) - product_lo) + (p[1] - high * q[1])) / q[0]
    return ordered_sum(high, marked_low(missed))


def difference(p: Pair, q: Pair) -> Number:
    """Return p − q as one number: the high words cancel exactly, the low words add the digits beyond them."""
    return (p[0] - q[0]) + (p[1] - q[1])


def dot(px: Pair, py: Pair, qx: Pair, qy: Pair) -> Pair:
    """Return px·qx + py·qy as a double-double."""
    return ordered_sum(*overlapping_dot(px, py, qx, qy))


def overlapping_dot(px: Pair, py: Pair, qx: Pair, qy: Pair) -> Pair:
    """Return px·qx + py·qy as the sum of two words, of which the low one may reach into the last digit of the high one:
    enough where all that follows is a difference."""
    (x, x_lo), (y, y_lo) = two_product(px[0], qx[0]), two_product(py[0], qy[0])
    high, low = two_sum(x, y)
    mixed = (px[0] * qx[1] + px[1] * qx[0]) + (py[0] * qy[1] + py[1] * qy[0])
    return high, low + ((x_lo + y_lo) + mixed)


def overlapping_square(x: Pair, y: Pair) -> Pair:
    """Return x² + y² likewise; the low words of x and y may reach into their high ones, too."""
    (xx, xx_lo), (yy, yy_lo) = two_product(x[0], x[0]), two_product(y[0], y[0])
    high, low = two_sum(xx, yy)
    mixed = x[0] * x[1] + y[0] * y[1]
    return high, low + ((xx_lo + yy_lo) + (mixed + mixed))


def square_of(x: Pair, y: Pair) -> Pair:
    """Return x² + y² as a double-double."""
    return ordered_sum(*overlapping_square(x, y))


def cross(px: Pair, py: Pair, qx: Pair, qy: Pair) -> Number:
    """Return px·qy − py·qx as one number, to full precision even where it cancels."""
    (x, x_lo), (y, y_lo) = two_product(px[0], qy[0]), two_product(py[0], qx[0])
    mixed = (px[0] * qy[1] + px[1] * qy[0]) - (py[0] * qx[1] + py[1] * qx[0])
    return (x - y) + ((x_lo - y_lo) + mixed)
