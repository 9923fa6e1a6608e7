"""Wheels that gears turn, beside the multibody reference and closed forms."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from benchmarks.stress.linkages.__main__ import checked, missed

WHEEL = ls.Link(0.05, 0.3, 4e-4, 0.02, 30.0)


def geared(ratio, pressure_angle=None, drive=""):
    """Return a crank and a wheel, braked."""
    machine = ls.Linkage(
        f"crank A-B, wheel D-E : {ratio} crank",
        ground={"A": (0.1, 0.0), "D": (0.3, 0.05)},
        crank=ls.Link(0.04, 0.0, 0.0),
        wheel=WHEEL,
        gears={"wheel": ls.Gears(phase=20.0, pressure_angle=pressure_angle)},
    )
    return ls.Scene(machine, omega2=20.0, alpha2=5.0, drive=drive, loads=[ls.Load("wheel", torque=-12.0)])


@pytest.mark.parametrize("name", ["geared five-bar", "geared five-bar, wheel drives"])
def test_beside_the_reference(name):
    assert missed(name, checked(name, 10, 7)) == []


@pytest.mark.parametrize("ratio", [-3, -1, 2, 5])
def test_the_wheel_turns_by_its_ratio(ratio):
    cycle = ls.sweep(geared(ratio), 36, of=["theta3", "omega3", "alpha3", "Ex", "Ey", "T12", "T32", "power_residual"])
    angle = np.radians(ratio * cycle.theta2 + 20.0)
    np.testing.assert_allclose(cycle.Ex, 0.2 + 0.05 * np.cos(angle), rtol=0, atol=1e-15)
    np.testing.assert_allclose(cycle.Ey, 0.05 + 0.05 * np.sin(angle), rtol=0, atol=1e-15)
    assert cycle.omega3 == ratio * 20.0 and cycle.alpha3 == ratio * 5.0
    inertia = 4e-4 + 0.3 * 0.02**2
    np.testing.assert_allclose(cycle.T12, ratio * (12.0 + inertia * ratio * 5.0), rtol=1e-14)
    np.testing.assert_allclose(cycle.T32, -cycle.T12, rtol=1e-15)
    assert abs(cycle.power_residual).max() < 1e-15


@pytest.mark.parametrize(("ratio", "parts"), [(-2, 1.0), (3, -1.0)])
def test_teeth_push_at_the_pressure_angle(ratio, parts):
    """Across the line of pivots with the torque over the radius; along it, external gears part by the tangent."""
    cycle = ls.sweep(geared(ratio, 20.0), 12, of=["F32x", "F32y", "F32", "T32", "F12x", "F12y"])
    line = np.array([0.2, 0.05])
    radius = np.hypot(*line) * ratio / (ratio - 1.0)
    unit = line / np.hypot(*line)
    along = cycle.F32x * unit[0] + cycle.F32y * unit[1]
    across = cycle.F32y * unit[0] - cycle.F32x * unit[1]
    np.testing.assert_allclose(across, cycle.T32 / radius, rtol=1e-14)
    np.testing.assert_allclose(along, -parts * abs(across) * np.tan(np.radians(20.0)), rtol=1e-13)
    np.testing.assert_allclose(cycle.F12x, -cycle.F32x, rtol=1e-13)


@pytest.mark.parametrize("pressure_angle", [None, 20.0])
def test_dense_and_fast_agree(pressure_angle):
    scene = geared(-2, pressure_angle, drive="wheel")
    names = scene.mechanism.unknowns("wheel")
    assert "T32" in names
    fast, dense = (ls.sweep(scene, 13, of=names, solver=solver) for solver in ("fast", "dense"))
    for name in names:
        np.testing.assert_allclose(dense[name], fast[name], rtol=0, atol=1e-11, err_msg=name)


def test_what_gears_cannot_be_is_refused():
    angle = r"gears\.wheel\.pressure_angle = 20 degree"
    with pytest.raises(ValueError, match=rf"{angle}: wheels of ratio 1 have no pitch point; leave it out"):
        geared(1, 20.0)


def on_one_shaft(pressure_angle):
    """Return a crank and a wheel on its pivot, braked."""
    gears, bar = {"wheel": ls.Gears(pressure_angle=pressure_angle)}, ls.Link(0.05, 0.3, 4e-4)
    return ls.Linkage(
        "crank A-B, wheel A-E : -2 crank, left B-C, right E-C",
        ground={"A": (0.1, 0.0)},
        gears=gears,
        crank=bar,
        wheel=WHEEL,
        left=ls.Link(0.18, 0.2, 1e-4),
        right=ls.Link(0.17, 0.2, 1e-4),
    )


def test_wheels_on_one_shaft_have_no_pitch_point():
    """A train that leads back to the crank's pivot passes on a torque; no single force at a distance has one."""
    angle = r"gears\.wheel\.pressure_angle"
    with pytest.raises(ValueError, match=rf"{angle} = 20 degree: wheels on one shaft have no pitch point; leave it"):
        on_one_shaft(20.0)
    with pytest.raises(ValueError, match=rf"{angle}: wheels on one shaft have no pitch point; leave it out"):
        on_one_shaft(xr.DataArray([14.5, 20.0], dims="design"))
    cycle = ls.sweep(ls.Scene(on_one_shaft(None), omega2=3.0, gravity=(0.0, -9.81)), 8, of=["T32", "power_residual"])
    assert abs(cycle.T32).max() > 0.1 and abs(cycle.power_residual).max() < 1e-12
