"""Trigonometry in degrees: cos and sin exact at multiples of 90, as accurate at a million turns as at none."""

from __future__ import annotations

import numpy as np


def cos_sin(degrees):
    """Cosine and sine of an angle [degree]: a number, an array or a DataArray; two of the same kind come back."""
    if hasattr(degrees, "dims"):
        return tuple(degrees.copy(data=values) for values in cos_sin(degrees.values))
    turned = np.fmod(np.asarray(degrees, dtype=float), 360.0)
    quarter = np.rint(turned / 90.0)
    rest = np.radians(turned - 90.0 * quarter)
    cos, sin = np.cos(rest), np.sin(rest)
    quadrant = quarter.astype(np.int64) % 4
    values = (
        np.choose(quadrant, (cos, -sin, -cos, sin)) + 0.0,  # + 0.0 turns -0.0 into 0.0
        np.choose(quadrant, (sin, cos, -sin, -cos)) + 0.0,
    )
    return values if np.ndim(degrees) else tuple(map(float, values))


def arcsine(part: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """asin(part/whole) [degree] from half angles, without the loss near ±90; NaN beyond."""
    with np.errstate(invalid="ignore"):
        return 90.0 - 2.0 * np.degrees(np.arctan2(np.sqrt(whole - part), np.sqrt(whole + part)))
