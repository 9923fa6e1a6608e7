"""Trigonometry in degrees: cos and sin exact at multiples of 90, as accurate at a million turns as at none.

`cos_sin_low_words` gives them to about 90 bits, in double-double: near a toggle the result depends on digits of a crank
angle beyond the 53 bits of its cosine. An angle is split exactly into quarter turns, steps of 1/64 degree, whose cos
and sin are tabulated, and a small remainder t:  cos(x + t) = cos x − t·sin x − …,  where t·sin x is an exact product of
numbers of 26 bits.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

STEPS = 64
"""Tabulated angles per degree."""
ONE = 2**128
DEGREE = 5939047689249815265887113184232615463
"""One, and a degree in radians, as integers with 128 bits after the binary point."""

OFF_ROUND = 0.381966
"""First of even samples, in steps (1 − 0.618…, the golden section): off round angles, where machines have toggles."""
COS_SIGNS, SIN_SIGNS = np.array([1.0, -1.0, -1.0, 1.0]), np.array([1.0, 1.0, -1.0, -1.0])
"""Signs of cosine and sine, quadrant by quadrant."""


def signed_distance(angle: Any, place: Any, period: float = 360.0) -> Any:
    """Return how far angles lie from a place, the shorter way round [degree]."""
    distance = angle - place
    return distance - period * np.round(distance / period)


def cos_sin(degrees):
    """Return cosine and sine of an angle [degree]: a number, an array or a DataArray; two of the kind passed in."""
    if type(degrees) is float:  # a number takes long to look for what it is not
        return _of_angle(degrees)[:2]
    return cos_sin_low_words(degrees)[:2]


def cos_sin_low_words(degrees: Any) -> tuple[Any, ...]:
    """Return cosine and sine of an angle [degree], then the low word of each; four of the kind passed in."""
    if hasattr(degrees, "cos_sin_low_words"):  # a number with slopes, of the scene's
        return degrees.cos_sin_low_words()
    if hasattr(degrees, "dims"):
        return tuple(degrees.copy(data=values) for values in cos_sin_low_words(degrees.values))
    return _of_angles(np.asarray(degrees, dtype=float)) if np.ndim(degrees) else _of_angle(float(degrees))


@lru_cache(maxsize=1024)
def _of_angle(degrees: float) -> tuple[float, ...]:
    return tuple(map(float, _of_angles(np.asarray(degrees))))


def _of_angles(degrees: np.ndarray) -> tuple[np.ndarray, ...]:
    angle = np.fmod(degrees, 360.0)
    quarter = np.rint(angle / 90.0)
    cos, sin, cos_lo, sin_lo = _within_an_eighth(angle - 90.0 * quarter)
    quadrant = quarter.astype(np.int64) % 4
    odd, sign_of_cos, sign_of_sin = quadrant % 2 == 1, COS_SIGNS[quadrant], SIN_SIGNS[quadrant]
    return (
        np.where(odd, sin, cos) * sign_of_cos + 0.0,  # + 0.0 turns -0.0 into 0.0
        np.where(odd, cos, sin) * sign_of_sin + 0.0,
        np.where(odd, sin_lo, cos_lo) * sign_of_cos + 0.0,
        np.where(odd, cos_lo, sin_lo) * sign_of_sin + 0.0,
    )


def arcsine(part: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """Return asin(part/whole) [degree] from half angles, without loss of digits near ±90; NaN beyond."""
    with np.errstate(invalid="ignore"):
        return 90.0 - 2.0 * np.degrees(np.arctan2(np.sqrt(whole - part), np.sqrt(whole + part)))


def _within_an_eighth(angle: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return cos and sin for angles [degree] from −45 to 45, then the low word of each."""
    step = np.rint(angle * STEPS)
    cos, sin, cos_lo, sin_lo = (row[step.astype(np.int64) + 45 * STEPS] for row in _table())
    t, t_lo = _radians(angle - step / STEPS)
    whole, square = t + t_lo, 0.5 * t * t  # the square is exact: t has 26 bits
    half = 0.5 * whole * whole
    versine = _coarse(square, 52)  # 1 − cos(t + t_lo)
    versine_lo = (square - versine) + (t_lo * (t + 0.5 * t_lo) - half * half * (1.0 / 6.0 - half / 90.0))
    lag = whole * half * (1.0 / 3.0 - half / 30.0) - t_lo  # t − sin(t + t_lo)
    cos_a, sin_a = _coarse(cos, 26), _coarse(sin, 26)  # their products with t and versine are exact
    cos_b, sin_b = (cos - cos_a) + cos_lo, (sin - sin_a) + sin_lo
    cos_lo += sin * lag - sin_b * t - cos_b * versine - cos * versine_lo
    sin_lo += cos_b * t - cos * lag - sin_b * versine - sin * versine_lo
    cos, cos_lo = _summed(cos, -sin_a * t, -cos_a * versine, cos_lo)
    sin, sin_lo = _summed(sin, cos_a * t, -sin_a * versine, sin_lo)
    return cos, sin, cos_lo, sin_lo


def _radians(degrees: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return an angle of at most half a step in radians, as its first 26 bits and the remainder."""
    radian, radian_lo = _pair(DEGREE)
    coarse, factor = _coarse(degrees, 33), _coarse(radian, 31)
    product = coarse * factor  # exact
    t = _coarse(product, 38)
    return t, (product - t) + ((degrees - coarse) * radian + coarse * ((radian - factor) + radian_lo))


def _summed(x: np.ndarray, y: np.ndarray, z: np.ndarray, low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return x + y + z + low, each far smaller than those before it, as a high and a low word."""
    xy = x + y
    high = xy + z
    low = low + ((y - (xy - x)) + (z - (high - xy)))
    rounded = high + low
    return rounded, low - (rounded - high)


def _coarse(x, bits: int):
    """Return x rounded to so many bits after the binary point: adding 1.5·2^(52 − bits) pushes further bits out."""
    shift = 1.5 * 2.0 ** (52 - bits)
    return (x + shift) - shift


@lru_cache(maxsize=1)
def _table() -> np.ndarray:
    """Return cos, sin and their low words at every step from −45 to 45 degrees, by rotation step by step."""
    terms = [ONE]
    for n in range(1, 12):  # Taylor series of one step: later terms are below 2⁻¹²⁸
        terms.append(terms[-1] * DEGREE // (n * STEPS * ONE))
    cos_step = sum(terms[0::4]) - sum(terms[2::4])
    sin_step = sum(terms[1::4]) - sum(terms[3::4])
    rotated = [(ONE, 0)]
    for _ in range(45 * STEPS):
        cos, sin = rotated[-1]
        rotated.append(((cos * cos_step - sin * sin_step) // ONE, (sin * cos_step + cos * sin_step) // ONE))
    half = np.array([(*_pair(cos), *_pair(sin)) for cos, sin in rotated]).T[[0, 2, 1, 3]]
    mirrored = half * np.array([[1.0], [-1.0], [1.0], [-1.0]])
    return np.concatenate([mirrored[:, :0:-1], half], axis=1)


def _pair(integer: int) -> tuple[float, float]:
    """Return a fixed-point integer (128 bits after the point) as a double-double."""
    rounded = integer / ONE
    return rounded, (integer - int(rounded * ONE)) / ONE
