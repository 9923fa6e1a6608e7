"""pin_friction: the friction circle of single pins, energy over the cycle, and what is said where it holds fast."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from refusals import refusal

import linksweep as ls

PRESS, ENGINE, SHAPER = (ls.example(name) for name in ("press", "engine", "quick-return"))
RUBBING = ls.Bearing(diameter=0.012, friction=0.1)


def massless(load, friction=0.0, **more):
    crank, rod = ls.Link(0.05, 0.0, 0.0), ls.Link(0.2, 0.0, 0.0)
    return ls.Scene(ls.SliderCrank(crank, rod, slider_mass=0.0, friction=friction), omega2=20.0, loads=[load], **more)


def test_the_main_bearing_alone():
    """A load at A is borne there alone: the drive gives r·sin φ·F, tan φ = μ, against either rotation."""
    for omega2 in (20.0, -20.0):
        scene = replace(massless(ls.Load("crank", force=(300.0, -400.0))), omega2=omega2)
        found = ls.pin_friction(scene, {"A": ls.Bearing(diameter=0.04, friction=0.15)}, theta2=24)
        radius = 0.02 * np.sin(np.arctan(0.15))
        np.testing.assert_allclose(found.T12, np.sign(omega2) * radius * 500.0, rtol=1e-12)
        np.testing.assert_allclose(found.friction_loss.sel(pin="A"), radius * 500.0 * 20.0, rtol=1e-12)
        assert float(found.efficiency) == pytest.approx(0.0, abs=1e-12)  # all of it warms the bearing


def test_the_force_in_a_massless_rod_touches_both_friction_circles():
    """Tangent to circles of r·sin φ its line crosses the line of pins, or runs beside it."""
    radius = {"B": np.sin(np.arctan(0.1)) * 0.015, "C": np.sin(np.arctan(0.2)) * 0.010}
    pins = {"B": ls.Bearing(diameter=0.03, friction=0.1), "C": ls.Bearing(diameter=0.02, friction=0.2)}
    scene = massless(ls.Load("slider", force=-1000.0))
    found = ls.pin_friction(scene, pins, theta2=720, of=["F43x", "F43y", "F43", "theta3", "omega3", "omega2"])
    theta3 = np.radians(found.theta3)
    across = np.cos(theta3) * found.F43y - np.sin(theta3) * found.F43x
    at_b, at_c = np.sign(found.omega2 - found.omega3), np.sign(found.omega3)
    # about B: the crank's pin drags the rod along with +ρF, the slider holds it back with −ρF
    expected = (at_c * radius["C"] - at_b * radius["B"]) / 0.2
    np.testing.assert_allclose(across / found.F43, expected, atol=1e-12)


@pytest.mark.parametrize(
    "scene",
    [
        PRESS,
        SHAPER,
        replace(PRESS, omega2=-20.0),
        pytest.param(replace(PRESS, drive="rocker"), marks=pytest.mark.long),
    ],
)
def test_energy_in_is_energy_out_and_friction(scene):
    """Friction takes just what the drive gives more than without it; at a steady speed, over a cycle."""
    pins = dict.fromkeys(scene.mechanism.pins, RUBBING)
    with_friction = ls.pin_friction(scene, pins, theta2=360, of=["power"])
    without = ls.sweep(scene, theta2=360, of=["power"])
    ok = (without.status == 0) & (with_friction.convergence == 0)
    more = (with_friction.power - without.power).where(ok)
    np.testing.assert_allclose(more, with_friction.friction_loss.sum("pin").where(ok), rtol=1e-9, atol=1e-9)
    assert (with_friction.friction_loss.where(ok, 0.0) >= 0.0).all()
    assert float(ok.mean()) > 0.9


def test_efficiency_of_the_engine():
    """An engine feeds its drive: efficiency is what arrives over what the gas gives."""
    pins = dict.fromkeys("ABC", ls.Bearing(diameter=0.05, friction=0.01))
    ideal = replace(ENGINE, mechanism=replace(ENGINE.mechanism, friction=0.0))
    gas = -float(ls.sweep(ideal, of=["power"]).power.mean())
    for scene in (ideal, ENGINE):
        arrives = -float(ls.pin_friction(scene, pins, of=["power"]).power.mean())
        assert float(ls.pin_friction(scene, pins).efficiency) == pytest.approx(arrives / gas, rel=1e-9)
        assert 0.8 < arrives / gas < 1.0


def test_without_friction_nothing_changes():
    found = ls.pin_friction(PRESS, {"A": ls.Bearing(diameter=0.02, friction=1e-300)}, theta2=36)
    without = ls.sweep(PRESS, theta2=36)
    for name in ("theta4", "F32x", "F14y", "T12"):
        np.testing.assert_array_equal(found[name], without[name])


def test_designs_go_along():
    friction = xr.DataArray([0.05, 0.1], dims="oil")
    several = ls.pin_friction(PRESS, {"C": ls.Bearing(diameter=0.02, friction=friction)}, theta2=36)
    for k in range(2):
        one = ls.pin_friction(PRESS, {"C": ls.Bearing(diameter=0.02, friction=float(friction[k]))}, theta2=36)
        np.testing.assert_allclose(several.T12.isel(oil=k), one.T12, rtol=1e-10)
        np.testing.assert_allclose(several.efficiency.isel(oil=k), one.efficiency, rtol=1e-10)


def test_what_holds_fast_says_so():
    """Friction circles wider than the rod is long."""
    found = ls.pin_friction(
        massless(ls.Load("slider", force=-1000.0)), {"C": ls.Bearing(diameter=1.0, friction=0.9)}, theta2=36
    )
    fast = found.convergence == 1
    assert fast.any()
    assert np.isnan(found.T12.where(fast, drop=True)).all()
    assert np.isfinite(found.theta3).all()


def test_its_scene_is_the_one_with_friction_as_loads():
    found = ls.pin_friction(PRESS, {"B": RUBBING}, theta2=36)
    again = ls.sweep(found.linksweep.scene, theta2=36)
    np.testing.assert_array_equal(again.T12, found.T12)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"B": ls.Bearing(diameter=0.01)}, "pins: no pin has friction"),
        ({"B": ls.Bearing(friction=0.1)}, "pins.B has friction but no diameter: give it"),
        ({"X": RUBBING}, "pins: nothing is named 'X'"),
    ],
)
def test_refusals(given, said):
    (line,) = refusal(ls.pin_friction, PRESS, given)
    assert said in line


def test_both_branches_are_refused():
    both = replace(PRESS, mechanism=replace(PRESS.mechanism, branch="both"))
    (line,) = refusal(ls.pin_friction, both, {"B": RUBBING})
    assert 'branch = "both"' in line
