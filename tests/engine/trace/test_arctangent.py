"""The arctangent of the package, against 50 digits and C's own at special values."""

import math

import mpmath
import numpy as np
import pytest

from linksweep.engine.trace.arctangent import arctangent


def angle(y, x):
    with np.errstate(all="ignore"):
        return np.asarray(arctangent(np.asarray(y, dtype=float), np.asarray(x, dtype=float), np.where))


def drawn_angles(draw: np.random.Generator, count: int) -> np.ndarray:
    """Return angles all around, and angles near multiples of 22.5°, where pieces of the formula meet."""
    near = np.round(draw.uniform(-8.0, 8.0, count)) * np.pi / 8.0
    return np.concatenate([draw.uniform(-np.pi, np.pi, count), near + 10.0 ** draw.uniform(-17.0, -1.0, count)])


def test_within_two_units_in_the_last_place():
    draw = np.random.default_rng(7)
    angles = drawn_angles(draw, 1500)
    length = 10.0 ** draw.uniform(-30.0, 30.0, len(angles))
    y, x = length * np.sin(angles), length * np.cos(angles)
    with mpmath.workdps(50):
        exact = [mpmath.atan2(mpmath.mpf(b), mpmath.mpf(a)) for a, b in zip(x.tolist(), y.tolist(), strict=True)]
        errors = [float(abs(mpmath.mpf(own) - true)) for own, true in zip(angle(y, x).tolist(), exact, strict=True)]
    units = np.array(errors) / np.spacing(np.abs([float(true) for true in exact]))
    assert units.max() <= 2.0
    assert units.mean() < 0.25  # as good as rounded, nearly everywhere


@pytest.mark.parametrize("length", [1e-290, 1.0, 1e290])
def test_multiples_of_45_degrees_are_exact(length):
    corners = [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (1.0, -1.0), (0.0, -1.0), (-1.0, 1.0), (-1.0, 0.0), (-1.0, -1.0)]
    y, x = length * np.array(corners).T
    np.testing.assert_array_equal(angle(y, x), [math.atan2(*corner) for corner in corners])


def test_opposite_angles_are_opposite():
    draw = np.random.default_rng(8)
    y, x = draw.normal(size=(2, 1000))
    np.testing.assert_array_equal(angle(-y, x), -angle(y, x))


def test_special_values():
    assert angle(0.0, 0.0) == 0.0
    assert angle(-0.0, -2.0) == math.pi  # the range is −π … π, its end +π
    assert angle(3.0, math.inf) == 0.0 and angle(math.inf, 3.0) == math.pi / 2
    assert all(math.isnan(angle(y, x)) for y, x in ((math.nan, 1.0), (1.0, math.nan), (math.nan, math.nan)))
