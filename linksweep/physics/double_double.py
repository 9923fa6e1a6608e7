"""Sums and products with their rounding errors: a number as the pair high + rest, good to twice the digits.

Each operation here is exact as IEEE rounds, as long as nothing over- or underflows and nothing is contracted or
reordered (Dekker 1971; Knuth, TAOCP 2, 4.2.2). Where a difference cancels, the rests hold the digits that are left.
"""

from linksweep.physics.arithmetic import Number

Pair = tuple[Number, Number]
"""high + rest, where high is the sum rounded."""

SPLITTER = 2.0**27 + 1.0


def two_sum(x: Number, y: Number) -> Pair:
    """x + y, exactly."""
    high = x + y
    part = high - x
    return high, (x - (high - part)) + (y - part)


def ordered_sum(x: Number, y: Number) -> Pair:
    """x + y, exactly, where |x| ≥ |y| or x = 0."""
    high = x + y
    return high, y - (high - x)


def halves(x: Number) -> Pair:
    """x as the sum of two numbers of 26 bits, whose products with others of the kind are exact."""
    scaled = SPLITTER * x
    high = scaled - (scaled - x)
    return high, x - high


def two_product(x: Number, y: Number) -> Pair:
    """x·y, exactly."""
    high = x * y
    (x_high, x_low), (y_high, y_low) = halves(x), halves(y)
    return high, x_low * y_low - (((high - x_high * y_high) - x_low * y_high) - x_high * y_low)


def add(p: Pair, q: Pair) -> Pair:
    high, rest = two_sum(p[0], q[0])
    return ordered_sum(high, rest + (p[1] + q[1]))


def multiply(p: Pair, q: Pair) -> Pair:
    high, rest = two_product(p[0], q[0])
    return ordered_sum(high, rest + (p[0] * q[1] + p[1] * q[0]))


def divide(p: Pair, q: Pair) -> Pair:
    high = p[0] / q[0]
    product, rest = two_product(high, q[0])
    return ordered_sum(high, (((p[0] - product) - rest) + (p[1] - high * q[1])) / q[0])


def difference(p: Pair, q: Pair) -> Number:
    """p − q as one number: what cancels in the highs is exact, and the rests add what it was short of."""
    return (p[0] - q[0]) + (p[1] - q[1])


def dot(px: Pair, py: Pair, qx: Pair, qy: Pair) -> Pair:
    """px·qx + py·qy, to twice the digits of its terms."""
    (x, x_lo), (y, y_lo) = two_product(px[0], qx[0]), two_product(py[0], qy[0])
    high, rest = two_sum(x, y)
    mixed = (px[0] * qx[1] + px[1] * qx[0]) + (py[0] * qy[1] + py[1] * qy[0])
    return ordered_sum(high, rest + ((x_lo + y_lo) + mixed))


def cross(px: Pair, py: Pair, qx: Pair, qy: Pair) -> Number:
    """px·qy − py·qx as one number, with all its digits where it cancels."""
    (x, x_lo), (y, y_lo) = two_product(px[0], qy[0]), two_product(py[0], qx[0])
    mixed = (px[0] * qy[1] + px[1] * qy[0]) - (py[0] * qx[1] + py[1] * qx[0])
    return (x - y) + ((x_lo - y_lo) + mixed)
