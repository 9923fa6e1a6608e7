"""Functions and data that change within a fraction of a degree: where they do, and their exact peaks."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.scene.curves.quick import STEP, of_data, of_function

PRESS = ls.example("press").mechanism
PLACE = 77.8707


def smooth(theta2):
    return 5.0 * np.cos(np.radians(theta2)) + 2.0 * np.sin(7.0 * np.radians(theta2))


def pulse(width, height=30.0, at=PLACE):
    """Return a smooth function with a Gaussian pulse that falls to 1/e at `width` degrees from its middle."""
    return lambda theta2: smooth(theta2) + height * np.exp(-(((theta2 - at) / width) ** 2))


def loaded(torque, **words) -> ls.Scene:
    load = ls.Load("crank", torque=torque, **words)
    return ls.Scene(PRESS, omega2=30.0, gravity=(0.0, -9.81), loads=[load])


def largest_torque(torque, theta2) -> float:
    """Return the least T12 under a torque on the crank: the unloaded machine's T12 minus the torque."""
    own = ls.sweep(ls.Scene(PRESS, omega2=30.0, gravity=(0.0, -9.81)), theta2, of=["T12"]).T12.values
    return float((own - torque(theta2)).min())


# --------------------------------------------------------------------------------------------- where they are quick


@pytest.mark.parametrize("function", [smooth, lambda theta2: 3.0, lambda theta2: np.zeros_like(theta2)])
def test_smooth_functions_need_no_dense_samples(function):
    quick = of_function(function, (), 360.0)
    assert len(quick.angles) == 0
    assert quick.all


@pytest.mark.parametrize("width", [0.02, 0.06, 0.2])
@pytest.mark.parametrize("height", [1e-4, 1.0, -1e6])
def test_only_a_pulse_is_sampled_densely(width, height):
    quick = of_function(pulse(width, height), (), 360.0)
    assert quick.all
    inside = np.abs(quick.angles - PLACE) < 1.5 * width
    assert np.diff(np.sort(quick.angles[inside])).max() < 0.8 * width
    assert np.abs(quick.angles - PLACE).max() < 8.0 * width + 3.0 * STEP


def test_a_jump_is_located_and_a_kink_needs_no_dense_samples():
    jump = of_function(lambda theta2: np.where(theta2 > PLACE, smooth(theta2), 1.0), (), 360.0)
    assert jump.all
    beside = np.sort(np.abs(jump.angles - PLACE))[:2]
    assert beside.max() < 1.1e-9
    assert min(jump.angles) < PLACE < max(jump.angles)
    kinks = of_function(lambda theta2: np.interp(theta2, [0.0, 33.3, 111.1, 250.0, 360.0], [1, 5, -3, 8, 1]), (), 360.0)
    assert (len(kinks.angles), kinks.all) == (0, True)


@pytest.mark.parametrize("function", [lambda theta2: np.sin(1e5 * theta2), lambda theta2: np.sin(1e9 * theta2**2)])
def test_a_function_too_quick_to_sample_is_marked_incomplete(function):
    assert not of_function(function, (), 360.0).all


def test_differences_are_not_taken_across_breaks():
    quick = of_function(pulse(1e-5), (PLACE,), 360.0)
    assert quick.all
    assert np.abs(quick.angles - PLACE).min() < 1e-5
    steps = of_function(lambda theta2: np.where((theta2 > 10.0) & (theta2 < 10.001), 1.0, 0.0), (10.0, 10.001), 360.0)
    assert (len(steps.angles), steps.all) == (0, True)


def test_data_are_sampled_densely_where_their_angles_are_close():
    known = [0.0, 100.0, 100.1, 100.2, 250.0]
    np.testing.assert_allclose(np.unique(of_data(known, 360.0, 360.0).angles), [100.0, 100.05, 100.1, 100.15, 100.2])
    twice = np.unique(of_data(known, 360.0, 720.0).angles)
    np.testing.assert_allclose(twice[5:], twice[:5] + 360.0)
    assert of_data(np.arange(0.0, 360.0, 5.0), 360.0, 360.0).angles.size == 0


# --------------------------------------------------------------------------------------------------- their peaks


@pytest.mark.parametrize("width", [0.02, 0.05, 0.1, 0.2])
@pytest.mark.parametrize("height", [30.0, 0.5])
def test_no_pulse_of_a_load_is_missed(width, height):
    peaks = ls.peaks(loaded(pulse(width, height)), of=["T12", "T12_bound"])
    theta2 = np.concatenate([np.arange(0.0, 360.0, 0.01), PLACE + np.arange(-2.0, 2.0, 1e-4)])
    assert peaks.T12_min <= largest_torque(pulse(width, height), theta2) + 1e-10 * peaks.T12_peak
    assert peaks.T12_bound < 1e-8 * peaks.T12_peak


def test_a_pulse_of_the_speed_is_not_missed():
    def omega2(theta2):
        return 30.0 + 3.0 * np.exp(-(((theta2 - PLACE) / 0.05) ** 2))

    scene = ls.Scene(PRESS, omega2=omega2, alpha2=0.0)
    brute = ls.peaks(scene, of=["omega4"], theta2=np.arange(76.0, 79.0, 1e-4))
    assert ls.peaks(scene, of=["omega4"]).omega4_peak >= brute.omega4_peak * (1.0 - 1e-10)


def test_a_pulse_in_data_closer_than_the_samples_is_not_missed():
    """Each design has its own data."""
    known = np.concatenate([np.arange(0.0, 360.0, 5.0), 77.0 + 0.02 * np.arange(1, 12)])
    values = np.concatenate([np.zeros(72), 30.0 * np.exp(-(((np.arange(1, 12) - 6.0) / 2.0) ** 2))])
    order = np.argsort(known)
    torque = xr.DataArray(values[order], {"theta2": known[order]}, "theta2")
    many = loaded(torque * xr.DataArray([1.0, -0.5], dims="design"), interpolation="pchip")
    brute = ls.peaks(many, of=["T12"], theta2=np.arange(76.9, 77.4, 1e-4))
    peaks = ls.peaks(many, of=["T12"])
    assert (peaks.T12_max >= brute.T12_max - 1e-10 * peaks.T12_peak).all()
    assert (peaks.T12_min <= brute.T12_min + 1e-10 * peaks.T12_peak).all()


def test_the_bound_is_infinite_for_a_load_too_quick_to_sample():
    """So it is of magnitudes; a quantity that the load does not change has its own bound."""
    load = ls.Load("rocker", torque=lambda theta2: np.sin(100_003 * np.radians(theta2)))
    peaks = ls.peaks(ls.Scene(PRESS, omega2=30.0, loads=[load]), of=["T12_bound", "F32_bound", "omega4_bound"])
    assert peaks.T12_bound == peaks.F32_bound == np.inf
    assert peaks.omega4_bound < 1e-9


def test_a_pulse_on_part_of_a_turn_is_not_missed():
    machine = ls.FourBar(*(ls.Link(x, 1.0, 0.01, 0.1) for x in (0.3, 0.3, 0.35)), ground=0.55)
    torque = pulse(0.03, at=64.0)
    scene = ls.Scene(machine, omega2=0.0, loads=[ls.Load("crank", torque=torque)])
    peaks = ls.peaks(scene, of=["T12"])
    assert peaks.status == 1
    assert peaks.T12_min == pytest.approx(-torque(64.0), rel=1e-6)


def test_a_mean_includes_a_pulse():
    """Without mass and gravity the crank's torque alone is left: T12 is its opposite, whose mean is known."""
    nothing = ls.Link(0.1, 0.0, 0.0)
    machine = ls.FourBar(nothing, ls.Link(0.3, 0.0, 0.0), ls.Link(0.25, 0.0, 0.0), ground=0.28)
    scene = ls.Scene(machine, omega2=30.0, loads=[ls.Load("crank", torque=pulse(0.02))])
    expected = -30.0 * 0.02 * np.sqrt(np.pi) / 360.0
    np.testing.assert_allclose(ls.peaks(scene, of=["T12_mean"]).T12_mean, expected, rtol=1e-9)
