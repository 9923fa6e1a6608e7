"""Compute what a rounded product misses of the exact one.

Dekker's splitting (1971) gives it by + − × alone, exactly provided nothing over- or underflows and nothing is
contracted or reordered. Compiled kernels take one fused multiply-add instead, which is exact as well.
"""

from typing import Any

SPLITTER = 2**27 + 1
"""Dekker's constant: multiplying by it splits 53 bits into 26 and 26."""


def product_low(x: Any, y: Any) -> Any:
    """Return x·y less its rounded value, of floats, arrays or fractions; where that is zero, +0."""
    (x_high, x_low), (y_high, y_low) = _split(x), _split(y)
    return x_low * y_low - (((x * y - x_high * y_high) - x_low * y_high) - x_high * y_low) + 0


def _split(x: Any) -> tuple[Any, Any]:
    """Return x as the sum of two numbers of 26 bits each; products of such numbers are exact."""
    scaled = SPLITTER * x
    high = scaled - (scaled - x)
    return high, x - high
