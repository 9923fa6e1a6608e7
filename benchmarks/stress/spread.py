"""Propagate the last digits of the inputs to the results, to first order: Σ |∂/∂x| ulp(x).

This is half the width of the set of results for inputs that cannot be told apart. Errors in units of it plus the
result's own last digit are mixed forward-backward errors (N. J. Higham, Accuracy and Stability, section 1.5): of a
nearly right answer to a nearly right question. They stay O(1) where a problem is nearly singular.
"""

from __future__ import annotations

import numpy as np

from benchmarks.stress.decimals import Array


class FirstOrder:
    """A number of each design, and its change with the last digit of each input: (n,) and (inputs, n)."""

    __slots__ = ("parts", "value")
    __array_ufunc__ = None

    def __init__(self, value: Array, parts: Array) -> None:
        self.value, self.parts = value, parts

    def __add__(self, other: FirstOrder) -> FirstOrder:
        return FirstOrder(self.value + other.value, self.parts + other.parts)

    def __sub__(self, other: FirstOrder) -> FirstOrder:
        return FirstOrder(self.value - other.value, self.parts - other.parts)

    def __neg__(self) -> FirstOrder:
        return FirstOrder(-self.value, -self.parts)

    def __mul__(self, other: FirstOrder | Array | int) -> FirstOrder:
        if not isinstance(other, FirstOrder):
            return FirstOrder(self.value * other, self.parts * other)
        return FirstOrder(self.value * other.value, self.parts * other.value + self.value * other.parts)

    __rmul__ = __mul__

    def __truediv__(self, other: FirstOrder) -> FirstOrder:
        value = self.value / other.value
        return FirstOrder(value, (self.parts - value * other.parts) / other.value)

    def root(self, value: Array | None = None) -> FirstOrder:
        """Return the square root, with a value that may be known more precisely."""
        value = np.sqrt(self.value) if value is None else value
        return FirstOrder(value, self.parts / (2.0 * value))

    @property
    def spread(self) -> Array:
        return np.abs(self.parts).sum(axis=0)
