"""Compute low words: what rounded sums and products miss of the exact ones.

Each is a number, which + − × alone give exactly, provided nothing over- or underflows and nothing is contracted or
reordered: of a sum by Knuth (TAOCP 2, 4.2.2), of a product by Dekker's splitting (1971). Compiled kernels take one
fused multiply-add for the latter, which is exact as well. Operands are floats, arrays or fractions.
"""

from typing import Any

SPLITTER = 2**27 + 1
"""Dekker's constant: multiplying by it splits 53 bits into 26 and 26."""


def sum_low(x: Any, y: Any) -> Any:
    """Return x + y less its rounded value."""
    high = x + y
    part = high - x
    return (x - (high - part)) + (y - part)


def difference_low(x: Any, y: Any) -> Any:
    """Return x − y less its rounded value."""
    high = x - y
    part = high - x
    return (x - (high - part)) - (y + part)


def ordered_low(x: Any, y: Any) -> Any:
    """Return x + y less its rounded value, where |x| ≥ |y| or x = 0."""
    return y - ((x + y) - x)


def product_low(x: Any, y: Any) -> Any:
    """Return x·y less its rounded value; where that is zero, +0."""
    (x_high, x_low), (y_high, y_low) = _split(x), _split(y)
    return x_low * y_low - (((x * y - x_high * y_high) - x_low * y_high) - x_high * y_low) + 0


def _split(x: Any) -> tuple[Any, Any]:
    """Return x as the sum of two numbers of 26 bits each; products of such numbers are exact."""
    scaled = SPLITTER * x
    high = scaled - (scaled - x)
    return high, x - high
