"""Compute the angle of a vector by + − × ÷, comparisons and choices alone: the same bits on every processor and path.

The quotient of the two components, or of their difference and sum beyond 22.5°, lies within ±tan 22.5°. There a
polynomial in its square, the best of its degree to 6e-18, gives the arctangent; a multiple of 45°, as a double-double,
is added to it. Results lie within two units in the last place.
"""

from collections.abc import Callable
from functools import reduce
from typing import Any

QUARTER, QUARTER_LOW = 0.7853981633974483, 3.061616997868383e-17
"""π/4 as a double-double. Up to four times each word of it is exact, or rounded as it should be."""
TANGENT = 0.41421356237309503
"""tan 22.5°"""
POLYNOMIAL = (
    -0.01917688711906226,
    0.03923165829558719,
    -0.0508544973794026,
    0.0585814891280221,
    -0.06664511447381948,
    0.07692183190826087,
    -0.09090904578123903,
    0.11111111015256361,
    -0.14285714284666542,
    0.1999999999999552,
    -0.3333333333333333,
)
"""(arctan t / t − 1)/t² in powers of t², the highest first: by Chebyshev's points on 0 … tan² 22.5°."""
LEAST = 1e-300
"""Below it a vector counts as zero, and has angle 0."""


def arctangent(y: Any, x: Any, where: Callable[[Any, Any, Any], Any]) -> Any:
    """Return the angle of the vector (x, y) from the axis x, from −π to π: 0 for the zero vector, π for y = −0, x < 0.

    `where(condition, a, b)` chooses between numbers of the same kind as y and x.
    """
    steep, backward = abs(x) < abs(y), x < 0.0
    small, large = where(steep, abs(x), abs(y)), where(steep, abs(y), abs(x))
    diagonal = TANGENT * large < small
    divisor = where(diagonal, small + large, large)
    tangent = where(diagonal, small - large, small) / where(divisor < LEAST, 1.0, divisor)
    quarters = where(diagonal, 1.0, where(steep, 2.0, 0.0))
    quarters = where(backward, 4.0 - quarters, quarters)
    tangent = where(steep, -tangent, tangent)
    tangent = where(backward, -tangent, tangent)
    square = tangent * tangent
    bend = tangent * (square * reduce(lambda sum_, term: sum_ * square + term, POLYNOMIAL))
    angle = QUARTER * quarters + (tangent + (bend + QUARTER_LOW * quarters))
    return where(y < 0.0, -angle, angle)
