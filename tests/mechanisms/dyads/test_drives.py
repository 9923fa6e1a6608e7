"""Cylinders of given length, and drives other than the crank, beside the multibody reference."""

import numpy as np
import pytest

import linksweep as ls
from benchmarks.stress.linkages.__main__ import checked, missed

BAR = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
PARTS = {"crank": 0.08, "rod": 0.22, "rocker": 0.18}
MOTION = {"omega2": 20.0, "alpha2": 30.0, "gravity": (0.0, -9.81)}


def boom(drive="", friction=0.0, length=None, text=""):
    """Return a four-bar with a cylinder to its pin C, and what else is written."""
    machine = ls.Linkage(
        f"crank A-B, rod B-C, rocker D-C, c1 P~C, tip C-E, ram E on slide{text}",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.0), "P": (0.3, -0.2)},
        **{role: ls.Bar(value, **BAR) for role, value in PARTS.items()},
        tip=ls.Bar(0.4, **BAR),
        ram=ls.Slider(2.0),
        guides={"slide": ls.Guide(angle=10.0, friction=friction)},
    )
    return ls.Scene(machine, drive=drive, loads=[ls.Load("rocker", torque=-12.0)], **MOTION)


@pytest.mark.parametrize(
    "name",
    [
        *("held cylinder", "held cylinder, jack drives", "held cylinder, rocker drives"),
        *("scotch yoke, lever drives", "knuckle-joint press, upper drives"),
    ],
)
def test_beside_the_reference(name):
    assert missed(name, checked(name, 10, 7)) == []


def test_the_crank_of_another_drive_needs_no_torque():
    """The moments on the crank add up to zero without one: of F12 and F32, weight and inertia."""
    for drive in ("rocker", "c1"):
        scene = boom(drive, friction=0.2)
        cycle = ls.sweep(scene, 24, of=["F32x", "F32y", "Bx", "By", "power_residual"])
        mass = 0.08 * 0.02 * 0.02 * 7750.0
        inertia = mass * (0.08**2 + 0.02**2) / 12.0 + mass * 0.04**2
        weight = 0.5 * cycle.Bx * mass * -9.81
        moment = cycle.Bx * cycle.F32y - cycle.By * cycle.F32x + weight
        np.testing.assert_allclose(moment, inertia * 30.0, rtol=0, atol=1e-10)
        assert abs(cycle.power_residual).max() < 1e-14


def test_powers_of_all_drives_are_one():
    """Without friction, work is the same whatever drives."""
    powers = [ls.sweep(boom(drive), 24, of=["power"]).power for drive in ("crank", "rocker", "c1")]
    for power in powers[1:]:
        np.testing.assert_allclose(power, powers[0], rtol=1e-12)


def test_dense_and_fast_agree_with_cylinders():
    for drive in ("rocker", "c1"):
        scene = boom(drive)
        names = scene.mechanism.unknowns(drive)
        fast, dense = (ls.sweep(scene, 13, of=names, solver=solver) for solver in ("fast", "dense"))
        for name in names:
            assert abs(fast[name] - dense[name]).max() < 1e-11 * abs(fast[names[0]]).max(), name


def test_a_drive_at_rest_is_a_dead_centre():
    """The rocker stands still where crank and rod lie in one line: cos of the angle there, by the cosine rule."""
    a, b, c, d = 0.08, 0.22, 0.18, 0.2
    stretched = np.degrees(np.arccos((d * d + (a + b) ** 2 - c * c) / (2.0 * d * (a + b))))
    for angle, status in ((stretched, 3), (stretched + 1.0, 0)):
        cycle = ls.sweep(boom("rocker"), [angle], of=["T14", "status"])
        assert cycle.status.item() == status
        assert np.isnan(cycle.T14.item()) == bool(status)


def test_friction_beyond_the_driven_link_is_known_before_its_torque():
    assert abs(ls.sweep(boom("rocker", 0.3), 12, of=["power_residual"]).power_residual).max() < 1e-14


def with_held_cylinder(length) -> ls.Linkage:
    """Return a rocker and an arm whose ends a cylinder holds at a length."""
    return ls.Linkage(
        "crank A-B, rod B-C, rocker D-C, held C~K, arm G-K",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.0), "G": (0.5, 0.0)},
        **{role: ls.Bar(value, **BAR) for role, value in PARTS.items()},
        arm=ls.Bar(0.25, **BAR),
        held=ls.Cylinder(length=length),
    )


def test_a_held_cylinder_neither_lengthens_nor_extends():
    """No rounding decides whether a load that acts while it extends is there."""
    machine = with_held_cylinder(0.3)
    while_extending = ls.Load("arm", torque=9.0, over="held.length", while_="extending")
    free, loaded = (ls.Scene(machine, drive="arm", loads=loads, **MOTION) for loads in ([], [while_extending]))
    cycle, other = (ls.sweep(scene, 36, of=["rate_held", "length_held", "F12", "status"]) for scene in (free, loaded))
    assert np.all(cycle.status == 0) and np.all(cycle.rate_held == 0.0) and np.all(cycle.length_held == 0.3)
    np.testing.assert_array_equal(cycle.F12, other.F12)
    moved = ls.Scene(with_held_cylinder(lambda theta2: 0.3 + 0.01 * np.cos(np.radians(theta2))), **MOTION)
    rate = ls.sweep(moved, 36, of=["rate_held"]).rate_held
    expected = -0.01 * np.sin(np.radians(rate.theta2)) * MOTION["omega2"]
    np.testing.assert_allclose(rate, expected, rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize("length", [0.3, lambda theta2: 0.3 + 0.01 * np.cos(np.radians(theta2))])
def test_a_drive_that_loads_a_cylinder_of_given_length(length):
    """The arm's torque decides the cylinder's force, whose work enters the torque: all agree with the dense system."""
    machine = with_held_cylinder(length)
    scene = ls.Scene(machine, drive="arm", **MOTION)
    names = machine.unknowns("arm")
    fast, dense = (ls.sweep(scene, 36, of=[*names, "power_residual"], solver=solver) for solver in ("fast", "dense"))
    assert np.all(fast.status == 0) and abs(fast.power_residual).max() < 1e-13
    for name in names:
        assert abs(fast[name] - dense[name]).max() < 1e-11 * max(abs(fast[other]).max() for other in names), name
