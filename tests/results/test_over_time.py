"""Means are over time, also where the crank changes its speed: against integrals in closed form.

The crank turns at ω = ω0·(1 + e·cos θ): a turn takes 2π/(ω0·√(1 − e²)). Links without mass leave of a four-bar's forces
T/(c·sin μ) in rod and rocker, for a torque T on the rocker; a torque on the crank is all that its drive feels.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from references import mp
from scipy.integrate import quad

import linksweep as ls

PRESS = ls.example("press")
MEAN, UNEVEN = 30.0, 0.5
TURN = 2.0 * np.pi / (MEAN * np.sqrt(1.0 - UNEVEN**2))
A, B, C, D = 0.08, 0.22, 0.18, 0.20
LIGHT = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in (A, B, C)), ground=D)


def uneven(theta2):
    return MEAN * (1.0 + UNEVEN * np.cos(np.radians(theta2)))


def over_time(function) -> float:
    """Mean over time of a function of the crank angle in radians."""

    def rate(angle):
        return MEAN * (1 + UNEVEN * mp.cos(angle))

    ends = [0, mp.pi / 2, mp.pi, 3 * mp.pi / 2, 2 * mp.pi]
    return mp.quad(lambda x: function(x) / rate(x), ends) / mp.quad(lambda x: 1 / rate(x), ends)


def pressed(angle):
    """T/(c·sin μ) of T = 12 N m: μ by the law of cosines."""
    a, b, c, d = map(mp.mpf, (A, B, C, D))
    cos = (b * b + c * c - a * a - d * d + 2 * a * d * mp.cos(angle)) / (2 * b * c)
    return 12 / (c * mp.sqrt(1 - cos * cos))


def pressing(**words):
    return ls.Scene(LIGHT, omega2=uneven, loads=[ls.Load("rocker", torque=-12.0)], **words)


@pytest.mark.parametrize("theta2", [None, 720])
def test_a_conservative_machine_takes_no_power(theta2):
    """Weight, a constant force and a torque on a link that comes back give back what they take."""
    peaks = ls.peaks(replace(PRESS, omega2=uneven), ["power_mean", "power"], theta2=theta2)
    assert abs(float(peaks.power_mean)) < 1e-9 * float(peaks.power_peak)
    assert peaks.power_mean.long_name.startswith("mean over time of: ")


@pytest.mark.parametrize("theta2", [None, 360])
def test_mean_and_rms_of_a_force(theta2):
    peaks = ls.peaks(pressing(), ["F32_mean", "F32_rms"], theta2=theta2)
    assert float(peaks.F32_mean) == pytest.approx(float(over_time(pressed)), rel=1e-11)
    squared = over_time(lambda angle: pressed(angle) ** 2)
    assert float(peaks.F32_rms) == pytest.approx(float(mp.sqrt(squared)), rel=1e-11)
    assert peaks.F32_rms.long_name.startswith("root mean square over time of: ")


def test_an_acceleration_has_no_mean_over_time():
    """After a turn the speed is as before."""
    peaks = ls.peaks(replace(PRESS, omega2=uneven), ["alpha3_mean", "alpha3"])
    assert abs(float(peaks.alpha3_mean)) < 1e-9 * float(peaks.alpha3_peak)


@pytest.mark.parametrize("theta2", [None, 36])
def test_each_design_has_its_own_pace(theta2):
    """The angle of the rocker does not depend on the speed; its mean over time does."""
    angles = np.arange(0.0, 360.0, 10.0)
    sizes = xr.DataArray([0.0, 0.5, -0.5], dims="size")
    speeds = MEAN * (1.0 + sizes * xr.DataArray(np.cos(np.radians(angles)), {"theta2": angles}, "theta2"))
    peaks = ls.peaks(replace(PRESS, omega2=speeds), ["theta4_mean", "F32_rms"], theta2=theta2)
    assert peaks.theta4_mean.dims == ("size",)
    for k in range(3):
        alone = ls.peaks(replace(PRESS, omega2=speeds.isel(size=k)), ["theta4_mean", "F32_rms"], theta2=theta2)
        assert float(peaks.theta4_mean[k]) == float(alone.theta4_mean)
        assert float(peaks.F32_rms[k]) == float(alone.F32_rms)
    steady = ls.peaks(PRESS, ["theta4_mean"], theta2=theta2)
    assert float(peaks.theta4_mean[0]) == pytest.approx(float(steady.theta4_mean), rel=1e-12)


@pytest.mark.parametrize("slowest_at", [180.0, 213.3])
def test_a_crank_that_nearly_stands_still_spends_its_time_there(slowest_at):
    """ω = ω0·(1 + s − cos δ), δ from the slowest angle: a turn takes 2π/(ω0·√((1 + s)² − 1)), nearly all there."""
    slowest = 2.0**-30
    scene = replace(pressing(), omega2=lambda a: MEAN * (1.0 + slowest - np.cos(np.radians(a - slowest_at))))
    peaks = ls.peaks(scene, ["omega2_mean", "F32_mean"])
    assert float(peaks.omega2_mean) == pytest.approx(MEAN * np.sqrt(slowest * (2.0 + slowest)), rel=1e-7)
    assert float(peaks.F32_mean) == pytest.approx(float(pressed(np.radians(slowest_at))), rel=1e-3)


STANDING = {
    "touches 0": lambda a: MEAN * (1.0 + np.cos(np.radians(a))),
    "touches 0 elsewhere": lambda a: MEAN * (1.0 + np.cos(np.radians(a - 33.3))),
    "touches 0 flatly": lambda a: MEAN * (1.0 + np.cos(np.radians(a))) ** 2,
    "has larger rounding errors": lambda a: 100.0 + (1.0 + np.cos(np.radians(a - 33.3))) - 100.0,
    "is 0 for long": lambda a: MEAN * np.maximum(np.cos(np.radians(a)), 0.0) ** 2,
    "changes its sign": lambda a: MEAN * np.cos(np.radians(a)),
}


@pytest.mark.parametrize("speed", STANDING.values(), ids=STANDING)
def test_a_crank_that_stands_still_at_an_angle_ends_no_cycle(speed):
    peaks = ls.peaks(replace(PRESS, omega2=speed), ["F32_mean", "F32_rms", "omega2_mean", "T12_mean", "F32"])
    means = peaks[["F32_mean", "F32_rms", "omega2_mean", "T12_mean"]]
    assert all(np.isnan(mean) for mean in means.values()), means
    assert float(peaks.F32_peak) > 0.0


def test_samples_of_a_crank_that_stands_still_have_no_mean():
    """At a sample, or between two of which one turns back."""
    for speed, theta2 in (("touches 0", 360), ("changes its sign", 360), ("changes its sign", 359)):
        scene = replace(PRESS, omega2=STANDING[speed])
        peaks = ls.peaks(scene, ["omega2_mean", "F32_rms"], theta2=theta2)
        assert np.isnan(peaks.omega2_mean) and np.isnan(peaks.F32_rms)
        assert np.isnan(ls.compare(scene, scene, of=["F32_rms"], theta2=theta2).F32_rms).all()


def test_designs_that_stand_still_leave_others_their_means():
    """∫dθ/cos θ over ±60° is 2·ln(tan 75°): there a crank that stands still at 90° does not."""
    angles = np.arange(0.0, 360.0, 10.0)
    wave = xr.DataArray(np.cos(np.radians(angles)), {"theta2": angles}, "theta2")
    peaks = ls.peaks(replace(PRESS, omega2=MEAN * (xr.DataArray([2.0, 1.0], dims="least") + wave)), ["F32_mean"])
    alone = ls.peaks(replace(PRESS, omega2=MEAN * (2.0 + wave)), ["F32_mean"])
    assert float(peaks.F32_mean[0]) == float(alone.F32_mean) and np.isnan(peaks.F32_mean[1])
    scene = replace(PRESS, omega2=STANDING["changes its sign"])
    mean = float(ls.peaks(scene, ["omega2_mean"], between=(-60.0, 60.0)).omega2_mean)
    assert mean == pytest.approx(MEAN * np.pi / 3.0 / np.log(np.tan(np.radians(75.0))), rel=1e-12)
    hours = ls.bearings(scene, {"B": ls.Bearing(capacity=30e3)}).L10h.sel(pin="B")
    assert np.isinf(hours)


def test_a_car_that_slows_down_at_the_top_spends_its_time_there():
    """v² = v0² − 2g·r(1 − cos θ): a lap takes 4r/v0·K(m), m = 4g·r/v0², a complete elliptic integral."""
    radius, speed, g = 30.0, 50.0, 9.81
    scene = ls.Scene(ls.LoopTrack(radius, 700.0), speed=speed, gravity=(0.0, -g), profile="energy")
    lap = 4.0 * radius / speed * mp.ellipk(4.0 * g * radius / speed**2)
    for theta in (None, 360):
        peaks = ls.peaks(scene, ["speed_mean"], theta=theta)
        assert float(peaks.speed_mean) == pytest.approx(float(2 * mp.pi * radius / lap), rel=1e-12)


def test_duty_of_a_crank_that_changes_its_speed():
    """12 N m on the crank: in a turn 24π J, at a power of that over the turn's time."""
    scene = ls.Scene(LIGHT, omega2=uneven, loads=[ls.Load("crank", torque=-12.0)])
    duty = ls.duty(scene)
    assert float(duty.work) == pytest.approx(24.0 * np.pi, rel=1e-12)
    assert float(duty.power_mean) == pytest.approx(24.0 * np.pi / TURN, rel=1e-12)
    assert float(duty.work_of_loads) == pytest.approx(-24.0 * np.pi, rel=1e-12)
    press = ls.duty(replace(PRESS, omega2=uneven))
    assert abs(float(press.work)) < 1e-9 * float(press.work_fed)


def test_the_heat_of_a_motor():
    """Its torque is T/i and i·J·α, α = −e·ω0²·(1 + e·cos θ)·sin θ."""
    scene = ls.Scene(LIGHT, omega2=uneven, loads=[ls.Load("crank", torque=-12.0)])
    result = ls.motor_load(scene, ls.Motor((0.0, 900.0), (9.0, 9.0), inertia=2e-3), ratio=8.0)

    def torque(angle):
        alpha = -UNEVEN * MEAN**2 * (1 + UNEVEN * mp.cos(angle)) * mp.sin(angle)
        return mp.mpf(12) / 8 + mp.mpf(2e-3) * 8 * alpha

    expected = mp.sqrt(over_time(lambda angle: torque(angle) ** 2))
    assert float(result.motor_torque_rms) == pytest.approx(float(expected), rel=1e-9)


FINE_AND_COARSE = np.r_[0.0:180.0, 180.0:361.0:10.0]
"""On either half of a turn, even steps integrate what is even about its ends to all digits."""


@pytest.mark.parametrize("theta2", [FINE_AND_COARSE, FINE_AND_COARSE[::-1]], ids=["upwards", "downwards"])
@pytest.mark.parametrize("omega2", [MEAN, uneven], ids=["steady", "uneven"])
def test_samples_at_uneven_angles_stand_for_half_the_way_to_their_neighbours(omega2, theta2):
    scene = ls.Scene(LIGHT, omega2, loads=[ls.Load("crank", torque=lambda a: -4.0 - 6.0 * np.cos(np.radians(2.0 * a)))])
    weight = (lambda angle: MEAN / uneven(np.degrees(angle))) if callable(omega2) else (lambda angle: 1.0)

    def torque(angle):
        return 4.0 + 6.0 * np.cos(2.0 * angle)

    integrals = [quad(lambda x, n=n: torque(x) ** n * weight(x), 0.0, np.pi, epsabs=1e-12)[0] for n in range(3)]
    mean, square = integrals[1] / integrals[0], integrals[2] / integrals[0]
    peaks = ls.peaks(scene, ["T12_mean", "T12_rms", "omega3"], theta2=theta2)
    assert float(peaks.T12_mean) == pytest.approx(mean, rel=1e-6)
    assert float(peaks.T12_rms) == pytest.approx(np.sqrt(square), rel=1e-6)
    motor = ls.motor_load(scene, ls.Motor((0.0, 900.0), (9.0, 9.0)), theta2=theta2)
    assert float(motor.motor_torque_rms) == pytest.approx(np.sqrt(square), rel=1e-6)
    assert float(ls.peaks(scene, ["T12_mean"], theta2=[30.0]).T12_mean) == pytest.approx(7.0, rel=1e-12)


def test_even_samples_of_a_whole_turn_count_alike():
    """However they are stated, and where they begin: to the last digit."""
    for omega2 in (MEAN, uneven):
        scene = replace(PRESS, omega2=omega2)
        count, angles = (ls.peaks(scene, ["T12_rms"], theta2=each) for each in (90, np.arange(90) * 4.0))
        assert float(count.T12_rms) == float(angles.T12_rms)


def test_the_mean_at_one_angle_is_the_value_there_however_often_it_is_asked_for():
    motor = ls.Motor(speeds=[0.0, 100.0], torques=[50.0, 50.0])
    for angles in ([30.0], [30.0, 30.0], [30.0, 390.0]):
        load = ls.motor_load(PRESS, motor, theta2=angles)
        assert float(load.motor_torque_rms) == pytest.approx(abs(float(load.motor_torque[0])), rel=1e-12)


def test_sizes_before_and_after_are_over_time():
    result = ls.compare(pressing(), pressing(), of=["F32_rms", "T12_ripple"], theta2=360)
    squared = over_time(lambda angle: pressed(angle) ** 2)
    np.testing.assert_allclose(result.F32_rms, float(mp.sqrt(squared)), rtol=1e-11)
    peaks = ls.peaks(pressing(), ["T12_mean", "T12_rms"])
    ripple = np.sqrt(float(peaks.T12_rms) ** 2 - float(peaks.T12_mean) ** 2)
    np.testing.assert_allclose(result.T12_ripple, ripple, rtol=1e-9)


def test_sizes_without_a_count_of_angles_are_exact():
    """A triangle 0.1 degrees wide and 3000 N high, between two samples, on a crank without mass; then half of it."""
    angles = np.union1d(np.arange(0.0, 361.0, 20.0), [200.2, 200.25, 200.3])
    pulse = xr.DataArray(np.where(angles == 200.25, 3000.0, 0.0), {"theta2": angles}, "theta2")
    before, after = (
        ls.Scene(LIGHT, MEAN, loads=[ls.Load("crank", force=(part * pulse, 0.0), interpolation="linear")])
        for part in (1.0, 0.5)
    )
    mean, square = 0.05 / 360.0, 0.1 / 3.0 / 360.0
    sizes = ls.compare(before, after, of=["F12_peak", "F12_rms", "F12_ripple"])
    for name, size in {"peak": 1.0, "rms": np.sqrt(square), "ripple": np.sqrt(square - mean**2)}.items():
        np.testing.assert_allclose(sizes[f"F12_{name}"], [3000.0 * size, 1500.0 * size], rtol=1e-9)
    sampled = ls.compare(before, after, of=["F12_peak"], theta2=720)
    assert float(sampled.F12_peak.max()) < 1e-9  # at half degrees there is none


def test_a_steady_torque_has_no_ripple_and_an_unbounded_one_has():
    steady = ls.Scene(LIGHT, MEAN, loads=[ls.Load("crank", torque=-12.0)])
    toggling = ls.Scene(ls.FourBar(*(ls.Bar(a, 0.02, 0.02, 7750.0) for a in (0.1, 0.12, 0.12)), ground=0.2), MEAN)
    sizes = ls.compare(steady, toggling, of=["T12_peak", "T12_rms", "T12_ripple"])
    assert float(ls.compare(toggling, toggling, of=["F12_ripple"]).F12_ripple.min()) == np.inf
    np.testing.assert_allclose(sizes.to_array().sel(balance="before"), [12.0, 12.0, 0.0], rtol=1e-14)
    assert np.isposinf(sizes.to_array().sel(balance="after")).all()


def test_counterweights_are_best_over_time():
    """No other masses near the best ones have less: sizes as `compare` computes them."""
    scene = replace(PRESS, omega2=uneven)
    weights = ls.best_counterweights(scene, {"Fs_rms": 1.0}, radius=0.06, theta2=180)

    def size(weights):
        return float(ls.compare(scene, ls.with_counterweights(scene, weights), of=["Fs_rms"], theta2=180).Fs_rms[1])

    best = size(weights)
    for k, weight in enumerate(weights):
        for change in (0.98, 1.02):
            other = replace(weight, mass=weight.mass * change, inertia=weight.inertia * change)
            assert size([*weights[:k], other, *weights[k + 1 :]]) > best


def reached(rocker: float) -> tuple[float, float]:
    """Angles [rad] between which a crank of 0.3 m moves, with a coupler of 0.22 m on a ground of 0.2 m: in both,
    coupler and rocker lie in one line."""
    ends = (abs(0.22 - rocker), 0.22 + rocker)
    cosines = [(0.3**2 + 0.2**2 - distance**2) / (2 * 0.3 * 0.2) for distance in ends]
    return math.acos(min(1.0, cosines[0])), math.acos(cosines[1])


@pytest.mark.parametrize(("part", "error"), [({}, 1e-12), ({"between": (0, 360)}, 1e-12), ({"theta2": 36_000}, 1e-3)])
@pytest.mark.parametrize("omega2", [10.0, lambda theta2: 10.0 + np.cos(np.radians(theta2))])
@pytest.mark.parametrize("rocker", [0.18, 0.25, 0.1])
def test_what_knows_the_crank_alone_counts_where_the_machine_closes(rocker, omega2, part, error):
    """Bx = a cos θ2 between two toggles; its mean over time is (∫ Bx/ω dθ)/(∫ 1/ω dθ)."""
    machine = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in (0.3, 0.22, rocker)), ground=0.2)
    ds = ls.peaks(ls.Scene(machine, omega2), of=["Bx", "Bx_mean"], **part)
    first, last = reached(rocker)
    pace = omega2 if callable(omega2) else lambda theta2: omega2
    moment, time = (
        quad(lambda t, n=n: math.cos(t) ** n / pace(math.degrees(t)), first, last, epsabs=1e-13)[0] for n in (1, 0)
    )
    expected = 0.3 * math.cos(first), 0.3 * math.cos(last), 0.3 * moment / time
    assert [ds[name].item() for name in ("Bx_max", "Bx_min", "Bx_mean")] == pytest.approx(expected, abs=error)
