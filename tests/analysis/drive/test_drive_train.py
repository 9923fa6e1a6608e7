"""A machine on its motor: its balance of torques against sweep and closed forms, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from refusals import array, refusal

import linksweep as ls
from linksweep.analysis.drive.drive_train import drive_train

MOTOR = ls.InductionMotor("1500 rpm", 15.0, rated_torque=6.0, rated_speed="1425 rpm", inertia=0.004)
ANGLES = np.arange(0.0, 720.0, 7.5)
PRESS = ls.example("press")
FALLING, RISING = array(3.0, 2.0, 1.0, design=[3, 2, 1]), array(1.0, 2.0, 3.0, design=[1, 2, 3])


@pytest.mark.parametrize("name", ["press", "engine", "quick-return", "crank-shaper", "jansen-leg", "geared-five-bar"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_torque_is_that_of_inverse_dynamics(name, sign):
    """With damper and friction, at any speed and acceleration, in either direction of the crank."""
    damper = ls.Damper(("ground", 0.3, 40.0), ("crank", 0.05, 20.0), coefficient=30.0)
    scene = ls.example(name)
    scene = replace(scene, omega2=sign * 25.0, alpha2=None, loads=[*scene.loads, damper])
    drive = drive_train(scene, MOTOR, 5.0, 0.1)
    rng = np.random.default_rng(3)
    speed, rise = 20.0 + 5.0 * rng.random(96), 50.0 * rng.standard_normal(96)
    lack = drive.at(ANGLES).balance(speed, rise).lack
    omega, alpha = (xr.DataArray(sign * each, {"theta2": ANGLES}, "theta2") for each in (speed, rise))
    torque = ls.sweep(replace(scene, omega2=omega, alpha2=alpha), ANGLES, of=["T12"]).T12.values
    expected = sign * torque + (0.1 + 25.0 * 0.004) * rise - 5.0 * MOTOR.torque_at(5.0 * speed)
    np.testing.assert_allclose(lack, expected, rtol=0.0, atol=1e-13 * abs(torque).max())


def test_derivatives_are_those_of_the_balance():
    drive = drive_train(ls.example("engine"), MOTOR, 5.0, 0.1)
    at, speed, rise, step = drive.at(ANGLES), np.full(96, 28.0), np.linspace(-40.0, 40.0, 96), 1e-4
    middle = at.balance(speed, rise)
    for slope, moved in ((middle.to_speed, (step, 0.0)), (middle.to_acceleration, (0.0, step))):
        ahead, behind = (at.balance(speed + s * moved[0], rise + s * moved[1]).lack for s in (1.0, -1.0))
        np.testing.assert_allclose(slope, (ahead - behind) / (2.0 * step), rtol=0.0, atol=1e-7 * abs(slope).max())


def test_the_acceleration_leaves_nothing_lacking():
    """An engine with friction, and a bare disk on a motor that is cut off: J α = −c ω."""
    drive = drive_train(ls.example("engine"), MOTOR, 5.0, 0.1)
    speed = np.linspace(1.0, 31.0, 96)
    balance = drive.at(ANGLES).balance(speed, drive.at(ANGLES).acceleration(speed))
    assert abs(balance.lack).max() < 1e-12 * MOTOR.breakdown_torque * 5.0
    weightless = [ls.Link(length, 0.0, 0.0, 0.0) for length in (0.08, 0.22, 0.18)]
    disk = replace(weightless[0], inertia=0.5)
    brake = ls.TorsionDamper("ground", "crank", coefficient=0.3)
    scene = ls.Scene(ls.FourBar(disk, *weightless[1:], ground=0.2), 30.0, loads=[brake])
    drive = drive_train(scene, MOTOR, xr.DataArray([1.0, 5.0], dims="ratio"), 0.1)
    speed = np.broadcast_to(speed, (2, 96))
    slowing = drive.at(ANGLES).acceleration(speed, powered=False)
    np.testing.assert_allclose(slowing, -0.3 * speed / np.array([[0.604], [0.7]]), rtol=1e-14)


def test_designs_of_scene_motor_gear_and_flywheel_are_those_one_by_one():
    gravity, torque = xr.DataArray([-9.81, 0.0], dims="g"), xr.DataArray([15.0, 20.0, 30.0], dims="size")
    ratio = xr.DataArray([5.0, 6.0], {"gear": ["low", "high"]}, "gear")

    def at(g, size, gear):
        motor = ls.InductionMotor("1500 rpm", size, breakdown_slip=0.2, inertia=0.002)
        drive = drive_train(replace(ls.example("press"), gravity=(0.0, g)), motor, gear, 0.1)
        return drive, drive.at(ANGLES).acceleration(np.full((*drive.shape, 96), 25.0))

    drive, many = at(gravity, torque, ratio)
    assert sorted(zip(drive.dims, drive.shape, strict=True)) == [("g", 2), ("gear", 2), ("size", 3)]
    many = xr.DataArray(many, dims=(*drive.dims, "theta2"))
    for g in range(2):
        for size in range(3):
            _, one = at(float(gravity[g]), float(torque[size]), 6.0)
            np.testing.assert_array_equal(many.isel(g=g, size=size, gear=1), one)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"motor": 3.0}, "motor = 3.0: must be a Motor, InductionMotor, DCMotor or GovernedMotor"),
        ({"ratio": 0.0}, "ratio = 0: must be greater than 0"),
        ({"flywheel": -1.0}, r"flywheel = -1 kg m\^2: must be at least 0"),
        ({"scene": replace(ls.example("press"), drive="rocker")}, 'drive = "rocker": must be the crank'),
        ({"scene": replace(ls.example("press"), omega2=0.0)}, "omega2 = 0 rad/s: must turn"),
        ({"scene": replace(ls.example("press"), omega2=xr.DataArray([3.0, -3.0], dims="x"))}, "has both signs; give"),
        ({"scene": ls.example("loop")}, "which has no crank"),
    ],
)
def test_refused_machines_on_a_motor(words, message):
    with pytest.raises(ValueError, match=message):
        drive_train(**{"scene": ls.example("press"), "motor": MOTOR, "ratio": 5.0, "flywheel": 0.0} | words)


@pytest.mark.parametrize(
    ("run", "line"),
    [
        (lambda: ls.run_up(replace(PRESS, omega2=RISING), MOTOR, flywheel=FALLING), "flywheel {} omega2"),
        (lambda: ls.run_down(replace(PRESS, omega2=RISING), ratio=FALLING), "ratio {} omega2"),
        (
            lambda: ls.steady_cycle(replace(PRESS, omega2=RISING), MOTOR, flywheel=FALLING, theta2=8),
            "flywheel {} omega2",
        ),
        (lambda: ls.run_up(PRESS, MOTOR, flywheel=FALLING, start=RISING), "start {} flywheel"),
        (lambda: ls.run_up(PRESS, MOTOR, ratio=FALLING, efficiency=RISING / 3.0), "efficiency {} ratio"),
        (lambda: ls.run_up(PRESS, replace(MOTOR, inertia=RISING), ratio=FALLING), "ratio {} motor.inertia"),
        (
            lambda: ls.run_up(PRESS, MOTOR, ratio=RISING, start=FALLING.assign_coords(design=[2, 3, 4])),
            "start {} ratio",
        ),
    ],
)
def test_labels_of_one_dimension_that_differ_are_refused(run, line):
    """As a scene's own arrays are: they were taken by place, a flywheel of one design for another."""
    words = "has labels along design that are not those of"
    assert refusal(run) == [f"{line.format(words)}: make them equal, or rename one dimension"]


def test_lengths_of_one_dimension_that_differ_are_refused():
    (line,) = refusal(ls.run_up, replace(PRESS, omega2=RISING), MOTOR, flywheel=array(1.0, 2.0))
    assert line.startswith("flywheel has 2 values along design, but omega2 has 3: one dimension has one length")


@pytest.mark.parametrize(
    ("unit", "request_for"),
    [
        ("1", lambda array: {"ratio": array}),
        ("1", lambda array: {"efficiency": (array / 7.0).assign_attrs(array.attrs)}),
        ("kg m^2", lambda array: {"flywheel": array}),
        ("degree", lambda array: {"start": array}),
        ("kg m^2", lambda array: {"motor": replace(MOTOR, inertia=array)}),
    ],
)
def test_arrays_may_state_their_units(unit, request_for):
    """xarray passes attributes on to sums and products: the scene's omega2 was in kg m², and refused."""
    array = xr.DataArray([5.0, 6.0], dims="design")
    plain, stated = (
        ls.run_up(PRESS, **{"motor": MOTOR, "ratio": 5.0, "flywheel": 0.3, "turns": 1} | request_for(each))
        for each in (array, array.assign_attrs(units=unit))
    )
    xr.testing.assert_identical(stated.drop_attrs(), plain.drop_attrs())
    assert stated.speed.units == "rad/s"
