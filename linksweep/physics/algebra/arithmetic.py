"""The few operations beyond + - * / that physics may use, for floats and for the engine's traced values."""

import math
from typing import Any

from linksweep.base import low_words

Number = Any
"""A float, or a stand-in for one: a traced value, a numpy array, a 50-digit number."""

NOISE = 32.0 * 2.0**-52
"""Bound on the rounding error of a cross product of two links, relative to the product of their lengths."""


def sqrt(x: Number) -> Number:
    return math.sqrt(x) if isinstance(x, float) else x.sqrt()


def atan2(y: Number, x: Number) -> Number:
    return math.atan2(y, x) if isinstance(y, float) else y.atan2(x)


def sum_low(x: Number, y: Number) -> Number:
    """Return what the rounded sum x + y misses of the exact one."""
    return _low_word("sum_low", x, y)


def ordered_low(x: Number, y: Number) -> Number:
    """Return what the rounded sum x + y misses of the exact one, where |x| ≥ |y| or x = 0."""
    return _low_word("ordered_low", x, y)


def product_low(x: Number, y: Number) -> Number:
    """Return what the rounded product x·y misses of the exact one."""
    return _low_word("product_low", x, y)


def _low_word(name: str, x: Number, y: Number) -> Number:
    """Return a low word by the operation of a traced operand, or computed."""
    traced = y if isinstance(x, float) else x
    return traced.low_word(name, x, y) if hasattr(traced, "low_word") else getattr(low_words, name)(x, y)


def marked_low(x: Number) -> Number:
    """Return x, marked in a trace as the low word of a double-double: what rounding left, without a derivative."""
    return x.marked_low() if hasattr(x, "marked_low") else x


def rounded(x: Number) -> Number:
    """Return x, in a trace as a rounded number: no sum takes it as an exact product."""
    return x.rounded() if hasattr(x, "rounded") else x


def where(condition: Number, x: Number, y: Number) -> Number:
    """Return `x` where the condition holds, else `y`; both are evaluated."""
    return (x if condition else y) if isinstance(condition, bool) else condition.where(x, y)


def degrees(radians: Number) -> Number:
    return radians * (180.0 / math.pi)
