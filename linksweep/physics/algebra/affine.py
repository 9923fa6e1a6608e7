"""Numbers that depend linearly on unknowns: functions made of + − × ÷ evaluate on them as on floats.

A linear law is thus written once, and its coefficients follow by superposition, without any differences.
"""

from __future__ import annotations

from collections.abc import Mapping

from linksweep.physics.algebra.arithmetic import Number


class Affine:
    """A number `constant` + Σ `slopes[x]`·x over the unknowns x; an unknown without a slope has no effect."""

    __slots__ = ("constant", "slopes")

    def __init__(self, constant: Number, slopes: Mapping[str, Number] | None = None) -> None:
        self.constant, self.slopes = constant, dict(slopes or {})

    @classmethod
    def unknown(cls, name: str) -> Affine:
        """Return an unknown itself."""
        return cls(0.0, {name: 1.0})

    def coefficients(self, *names: str) -> tuple[Number, ...]:
        """Return the constant, then the slopes of these unknowns."""
        return (self.constant, *(self.slopes.get(name, 0.0) for name in names))

    def __neg__(self) -> Affine:
        return Affine(-self.constant, {name: -slope for name, slope in self.slopes.items()})

    def __add__(self, other: Affine | Number) -> Affine:
        other = affine(other)
        both = {name: self.slopes[name] + other.slopes[name] for name in self.slopes.keys() & other.slopes}
        return Affine(self.constant + other.constant, {**self.slopes, **other.slopes, **both})

    def __sub__(self, other: Affine | Number) -> Affine:
        return self + -affine(other)

    def __rsub__(self, other: Number) -> Affine:
        return affine(other) - self

    def __mul__(self, other: Affine | Number) -> Affine:
        other = affine(other)
        if self.slopes and other.slopes:
            raise TypeError("a product of two unknowns is not linear")
        varying, factor = (self, other.constant) if self.slopes else (other, self.constant)
        return Affine(self.constant * other.constant, {x: slope * factor for x, slope in varying.slopes.items()})

    def __truediv__(self, other: Affine | Number) -> Affine:
        other = affine(other)
        if other.slopes:
            raise TypeError("a quotient by an unknown is not linear")
        slopes = {name: slope / other.constant for name, slope in self.slopes.items()}
        return Affine(self.constant / other.constant, slopes)

    def __rtruediv__(self, other: Number) -> Affine:
        return affine(other) / self

    __radd__, __rmul__ = __add__, __mul__


def affine(number: Affine | Number) -> Affine:
    """Return a number as one on which no unknown has an effect."""
    return number if isinstance(number, Affine) else Affine(number)
