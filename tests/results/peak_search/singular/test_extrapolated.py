"""Polynomials beside an end reach limits, and summits, that rounding errors hide."""

import numpy as np
import pytest

import linksweep as ls
from benchmarks.accuracy import missed
from linksweep.results.peak_search.singular.extrapolated import extrapolated


def signals(which, _ends, x):
    """Return 5·exp(−(x − 0.3)²), whose summit is at 0.3, and exp(−x), whose limit at 0 is 1, with errors of 1e-9."""
    errors = 1.0 + 1e-9 * np.sin(1e5 * x)
    return np.stack([5.0 * np.exp(-((x - 0.3) ** 2)), np.exp(-x)])[which] * errors


@pytest.mark.parametrize("within", [1.0, 0.31])
def test_a_summit_within_a_distance_is_higher_than_the_limit(within):
    beside = extrapolated(signals, np.ones(1), np.full((2, 1), True), (2.0, 0.5))
    height, distance = beside.highest(np.full((2, 1), within))
    np.testing.assert_allclose(height[:, 0], [5.0, 1.0], rtol=1e-7)
    np.testing.assert_allclose(distance[:, 0], [0.3, 0.0], atol=1e-3)


@pytest.mark.parametrize(("within", "nearly"), [(0.29, 3e-5), (0.1, 4e-3), (0.0, 1e-7)])
def test_a_summit_farther_away_does_not_count(within, nearly):
    """The highest value is that at the distance, nearly: at one of many places before it."""
    beside = extrapolated(signals, np.ones(1), np.full((2, 1), True), (2.0, 0.5))
    height, distance = beside.highest(np.full((2, 1), within))
    highest = 5.0 * np.exp(-((within - 0.3) ** 2))
    assert highest * (1.0 - nearly) < height[0, 0] < highest * (1.0 + 1e-7)
    assert within - 0.02 <= distance[0, 0] <= within
    assert (height[1, 0], distance[1, 0]) == (pytest.approx(1.0, rel=1e-7), 0.0)


def test_a_signal_that_is_not_needed_is_not_known():
    beside = extrapolated(signals, np.ones(2), np.array([[True, False], [False, True]]), (0.5,))
    assert (np.isfinite(beside.limit) == [[True, False], [False, True]]).all()
    assert (np.isfinite(beside.highest(np.ones((2, 2)))[0]) == [[True, False], [False, True]]).all()


def test_a_summit_among_rounding_errors_beside_a_dead_centre():
    """F43 of a six-bar by its output is rough by 6e-6: forces are unbounded 0.014° from its summit, which is that of
    the polynomial of degree 8 through many samples. A part of the turn that ends before it has a lower peak."""
    scene = missed.FAMILIES["Watt six-bar by its output"].scene(np.random.default_rng([30_000_085, 0]), missed.CHUNK)
    one, angles = ls.scene_at(scene, design=2166), np.linspace(-0.005, 0.035, 20_001)
    forces = ls.sweep(one, angles, of=["F43"]).F43.values
    summit = np.polynomial.Chebyshev.fit(angles, forces, 8)(angles).max()
    peaks = ls.peaks(one, of=["F43"])
    assert float(peaks.F43_peak) == pytest.approx(summit, rel=4e-6)
    assert float(peaks.F43_peak_at) == pytest.approx(0.005, abs=0.001)
    before = ls.peaks(one, of=["F43"], between=(-5.0, 0.0))
    assert float(before.F43_peak) < float(peaks.F43_peak) and -5.0 <= float(before.F43_peak_at) <= 0.0
    among_errors = ls.peaks(one, of=["F43"], between=(-0.02, 0.001))
    assert float(among_errors.F43_peak) == pytest.approx(summit, rel=2e-5)
