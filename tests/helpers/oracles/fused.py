"""Operations of plans on arrays: numpy's, and those that it lacks, as fractions rounded once."""

import math
from fractions import Fraction

import numpy as np

from linksweep.engine.trace.operators import OPERATORS, interpret, traced_arctangent


def _fma(x: float, y: float, z: float) -> float:
    """Return x·y + z, rounded once."""
    if math.isinf(z) and math.isfinite(x) and math.isfinite(y):
        return z  # though the product may overflow
    plain = x * y + z
    if not all(map(math.isfinite, (x, y, z))) or 0.0 in (x, y):
        return plain
    exact = Fraction(x) * Fraction(y) + Fraction(z)
    try:
        return exact.numerator / exact.denominator if exact else plain
    except OverflowError:
        return math.inf if exact > 0 else -math.inf


def arctangent(y, x):
    inputs, nodes, (angle,) = traced_arctangent()
    return interpret(nodes, dict(zip(inputs, (y, x), strict=True)), EVERY)[angle]


fma = np.vectorize(_fma, otypes=[float])
EVERY = {**OPERATORS, "fma": fma, "fnma": lambda x, y, z: fma(-np.asarray(x), y, z), "atan2": arctangent}
"""All operations by name."""
