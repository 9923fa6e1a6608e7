"""Numbers to 50 digits in numpy's object arrays, and vectors of them; cosines and sines of angles in degrees.

Decimals are those of Python's standard library. Formulas in + - * / and `root` run on them, and on the first-order
numbers of `spread`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from decimal import Context, Decimal, localcontext
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

Number = Any
Array = np.ndarray

DIGITS = 50
RADIAN = Decimal("0.0174532925199432957692369076848861271344287188854172545609719144")
"""A degree [rad]."""


@contextmanager
def fifty_digits() -> Iterator[None]:
    """Round every operation to 50 digits; undefined results are NaN."""
    with localcontext(Context(prec=DIGITS, Emax=999_999, Emin=-999_999, traps=[])):
        yield


exactly = np.frompyfunc(Decimal, 1, 1)
"""Convert floats to decimals without rounding."""


def root(x: Number) -> Number:
    return np.sqrt(x) if isinstance(x, np.ndarray) else x.root()


def sign(x: Number) -> Array:
    """Return ±1, or 0 for 0."""
    values = x if isinstance(x, np.ndarray) else x.value
    return (values > 0) * 1 - (values < 0) * 1


class Vector(NamedTuple):
    x: Number
    y: Number

    def __add__(self, other: Vector) -> Vector:  # type: ignore[override]
        return Vector(self.x + other.x, self.y + other.y)

    def __sub__(self, other: Vector) -> Vector:
        return Vector(self.x - other.x, self.y - other.y)

    def __mul__(self, factor: Number) -> Vector:  # type: ignore[override]
        return Vector(self.x * factor, self.y * factor)

    def dot(self, other: Vector) -> Number:
        return self.x * other.x + self.y * other.y

    def cross(self, other: Vector) -> Number:
        return self.x * other.y - self.y * other.x

    @property
    def left(self) -> Vector:
        """The vector rotated by 90°."""
        return Vector(-self.y, self.x)

    def turned(self, direction: Vector) -> Vector:
        """Return the vector rotated by the angle of a unit vector."""
        return direction * self.x + direction.left * self.y


def exact(values: Any, designs: int) -> Array:
    """Return numbers, floats or decimals, one or an array over the designs, as decimals over the designs."""
    array = np.asarray(values)
    return exactly(np.broadcast_to(array if array.dtype == object else array.astype(float), designs))


def directions(degrees: Array) -> Vector:
    """Return unit vectors at angles [degree]."""
    return Vector(*_direction(degrees))


def angles(u: Vector) -> Array:
    """Return the angles of vectors [degree], in (-180, 180]: those of floats, corrected by Taylor's series."""
    near = exactly(np.degrees(np.arctan2(*(part.astype(float) for part in (u.y, u.x)))))
    unit = directions(near)
    tangent = unit.cross(u) / unit.dot(u)
    return near + (tangent - tangent**3 / 3) / RADIAN


@lru_cache(maxsize=10_000)
def _cos_sin(degrees: float) -> tuple[Decimal, Decimal]:
    """Return cosine and sine: of the whole degree from the table, of the remainder by Taylor's series."""
    angle = Decimal(degrees) % 360
    whole = int(angle.to_integral_value())
    cos, sin = _table()[whole % 360]
    remainder = (angle - whole) * RADIAN
    if not remainder:
        return +cos, +sin
    c, s, term = Decimal(1), remainder, remainder
    for k in range(2, 20):
        term = term * remainder / k
        if k % 2:
            s += term if k % 4 == 1 else -term
        else:
            c += term if k % 4 == 0 else -term
    return cos * c - sin * s, sin * c + cos * s


_direction = np.frompyfunc(_cos_sin, 1, 2)


@lru_cache(maxsize=1)
def _table() -> list[tuple[Decimal, Decimal]]:
    """Return cosine and sine of every whole degree: of the first by Taylor's series, then step by step."""
    with localcontext(Context(prec=DIGITS + 14)):
        terms = [Decimal(1)]
        for k in range(1, 30):
            terms.append(terms[-1] * RADIAN / k)
        c, s = sum(terms[0::4]) - sum(terms[2::4]), sum(terms[1::4]) - sum(terms[3::4])
        quarter = [(Decimal(1), Decimal(0))]
        for _ in range(89):
            cos, sin = quarter[-1]
            quarter.append((cos * c - sin * s, sin * c + cos * s))
        second = [(-sin, cos) for cos, sin in quarter]
        half = quarter + second
        return half + [(-cos, -sin) for cos, sin in half]
