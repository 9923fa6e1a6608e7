"""Motors: torque over speed against what their equations say, its derivative in 50 digits, and refusals."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from mpmath import mp
from refusals import array

import linksweep as ls

INDUCTION = ls.InductionMotor("1500 rpm", "15 N m", rated_torque="6 N m", rated_speed="1425 rpm", inertia=0.004)
DC = ls.DCMotor(stall_torque=2.0, no_load_speed=400.0)
GOVERNED = ls.GovernedMotor(40.0, cut_from=150.0, cut_to=160.0)
CURVE = ls.Motor(speeds=(0.0, 100.0, 200.0), torques=(3.0, 2.0, 0.0))
MOTORS = {"induction": INDUCTION, "dc": DC, "governed": GOVERNED, "curve": CURVE}


def test_an_induction_motor_has_the_torques_of_its_nameplate():
    sync = float(INDUCTION.synchronous_speed)
    breakdown = sync * (1.0 - INDUCTION.slip_at_breakdown)
    np.testing.assert_allclose(INDUCTION.torque_at(np.array([breakdown, INDUCTION.rated_speed, sync])), [15, 6, 0])
    np.testing.assert_allclose(INDUCTION.torque_slope_at(breakdown), 0.0, atol=1e-14)
    assert INDUCTION.torque_at(1.01 * sync) < 0.0  # a generator
    assert abs(INDUCTION.slip_at(INDUCTION.rated_speed) - 0.05) < 1e-15
    same = ls.InductionMotor("1500 rpm", 15.0, breakdown_slip=INDUCTION.slip_at_breakdown)
    np.testing.assert_allclose(same.torque_at(120.0), INDUCTION.torque_at(120.0), rtol=1e-15)


def kloss(speed):
    """Return Kloss's torque of the motor above in 50 digits, written as 2 M_b/(s/s_b + s_b/s)."""
    sync = 50 * mp.pi
    slip, overload = (sync - speed) / sync, mp.mpf(15) / 6
    breakdown = mp.mpf(5) / 100 * (overload + mp.sqrt(overload**2 - 1))
    return 30 / (slip / breakdown + breakdown / slip)


def test_kloss_and_its_slope_in_50_digits():
    with mp.workdps(50):
        speeds = [5.0, 118.0, 121.0, 150.0, 165.0, -20.0]
        torques = [float(kloss(mp.mpf(speed))) for speed in speeds]
        slopes = [float(mp.diff(kloss, mp.mpf(speed))) for speed in speeds]
    np.testing.assert_allclose(INDUCTION.torque_at(np.array(speeds)), torques, rtol=1e-14)
    np.testing.assert_allclose(INDUCTION.torque_slope_at(np.array(speeds)), slopes, rtol=1e-12)


@pytest.mark.parametrize("name", MOTORS)
def test_the_slope_is_that_of_the_torque(name):
    motor, speeds = MOTORS[name], xr.DataArray([1.0, 40.0, 99.0, 101.0, 151.0, 159.9, 199.0], dims="speed")
    step = 1e-3
    differences = (motor.torque_at(speeds + step) - motor.torque_at(speeds - step)) / (2.0 * step)
    slopes = motor.torque_slope_at(speeds)
    assert slopes.dims == ("speed",)
    np.testing.assert_allclose(slopes, differences, rtol=1e-7, atol=1e-9)
    assert abs(motor.torque_at(motor.top_speed)) < 1e-15


def test_a_direct_current_motor_by_hand():
    """24 V on 0.6 ohm are 40 A held, 2 N m; at half speed 20 A, which heat 0.6 ohm by 240 W."""
    motor = ls.DCMotor.from_winding("24 V", "600 mohm", "0.05 N m/A", inertia="40 g cm^2")
    np.testing.assert_allclose([motor.stall_torque, motor.no_load_speed, motor.inertia], [2.0, 480.0, 4e-6], rtol=1e-15)
    np.testing.assert_allclose([motor.torque_at(240.0), motor.heat_at(240.0)], [1.0, 240.0])


def test_results_of_arrays_have_units_of_their_own():
    """xarray passes attributes on: torques were in rad/s, and a no-load speed in V was refused."""
    voltage = xr.DataArray([12.0, 24.0], dims="supply", attrs={"units": "V"})
    motor = ls.DCMotor.from_winding(voltage, "0.6 ohm", xr.DataArray(0.05, attrs={"units": "N m/A"}))
    np.testing.assert_allclose(motor.no_load_speed, [240.0, 480.0])
    speed = xr.DataArray([100.0, 150.0], dims="speed", attrs={"units": "rad/s", "long_name": "speed"})
    for each in (*MOTORS.values(), motor):
        results = each.torque_at(speed), each.torque_slope_at(speed), each.heat_at(speed)
        assert [result.attrs for result in results] == [{"units": unit} for unit in ("N m", "N m s/rad", "W")]
    assert INDUCTION.slip_at(speed).attrs == {"units": "1"}
    rated = xr.DataArray([140.0, 150.0], dims="size", attrs={"units": "rad/s"})
    assert replace(INDUCTION, rated_speed=rated).slip_at_breakdown.attrs == {"units": "1"}


def test_heat_is_supplied_power_less_shaft_power():
    np.testing.assert_allclose(INDUCTION.heat_at(100.0), INDUCTION.torque_at(100.0) * (50.0 * np.pi - 100.0))
    assert np.isnan(CURVE.heat_at(100.0)) and np.isnan(GOVERNED.heat_at(100.0))


def test_a_curve_and_a_governor_have_no_torque_beyond():
    assert CURVE.torque_at(-50.0) == CURVE.torque_at(50.0) == 2.5
    assert CURVE.torque_slope_at(-50.0) == -CURVE.torque_slope_at(50.0) == 0.01
    assert CURVE.torque_at(300.0) == CURVE.torque_slope_at(300.0) == 0.0
    assert CURVE.torque_slope_at(100.0) == -0.02  # a corner: that of the faster side
    assert ls.Motor((0.0, 1.0, 2.0, 3.0), (1.0, 1.0, 0.0, 0.0)).top_speed == 2.0
    np.testing.assert_array_equal(GOVERNED.torque_at(np.array([0.0, 155.0, 170.0])), [40.0, 20.0, 0.0])


def test_designs_are_those_one_by_one():
    speeds = xr.DataArray([20.0, 100.0, 156.0], dims="speed")
    torque = xr.DataArray([9.0, 15.0, 30.0], dims="size")
    many = ls.InductionMotor("1500 rpm", torque, breakdown_slip=0.2)
    for k, one in enumerate(torque.values):
        alone = ls.InductionMotor("1500 rpm", one, breakdown_slip=0.2)
        np.testing.assert_array_equal(many.torque_at(speeds).isel(size=k), alone.torque_at(speeds))
        np.testing.assert_array_equal(many.torque_slope_at(speeds).isel(size=k), alone.torque_slope_at(speeds))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ls.InductionMotor(157.0, 15.0, rated_torque=6.0), "give both rated_torque and rated_speed, or break"),
        (lambda: ls.InductionMotor(157.0, 15.0, rated_torque=6.0, rated_speed=158.0), "rated_speed = 158 rad.s: must"),
        (lambda: ls.InductionMotor(157.0, 5.0, rated_torque=6.0, rated_speed=150.0), "rated_torque = 6 N m: must be l"),
        (lambda: ls.InductionMotor("12 N m", 5.0, breakdown_slip=0.2), 'synchronous_speed = "12 N m": N m is a unit'),
        (lambda: ls.DCMotor(0.0, 400.0), "stall_torque = 0 N m: must be greater than 0"),
        (lambda: ls.DCMotor.from_winding(24.0, -1.0, 0.05), "resistance = -1 ohm: must be greater than 0"),
        (lambda: ls.GovernedMotor(4.0, cut_from=9.0, cut_to=9.0), "cut_from = 9 rad.s: must be less than cut_to = 9"),
        (lambda: ls.GovernedMotor(4.0, 1.0, 9.0, inertia=xr.DataArray([0.1, -0.1], dims="x")), r"inertia = -0.1 kg m"),
        (lambda: ls.GovernedMotor(4.0, array(1.0, 2.0), array(8.0, 9.0, 9.0)), "cut_to has 3 values along design, but"),
        (
            lambda: ls.InductionMotor(
                array(150.0, 160.0, design=[1, 2]), array(30.0, 20.0, design=[2, 1]), breakdown_slip=0.2
            ),
            "breakdown_torque has labels along design that are not those of synchronous_speed: make them equal",
        ),
        (
            lambda: ls.DCMotor.from_winding(array(24.0, 48.0, design=[1, 2]), 0.6, array(0.05, 0.1, design=[2, 3])),
            "constant has labels along design that are not those of voltage: make them equal",
        ),
    ],
)
def test_refused_motors(make, message):
    with pytest.raises(ValueError, match=message):
        make()
