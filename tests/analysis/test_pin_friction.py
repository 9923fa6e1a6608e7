"""pin_friction: the friction circle of single pins, energy over the cycle, and the message where a machine locks."""

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
    """A load at A loads that pin only: the drive torque is r·sin φ·F, tan φ = μ, against either rotation."""
    for omega2 in (20.0, -20.0):
        scene = replace(massless(ls.Load("crank", force=(300.0, -400.0))), omega2=omega2)
        cycle = ls.pin_friction(scene, {"A": ls.Bearing(diameter=0.04, friction=0.15)}, theta2=24)
        radius = 0.02 * np.sin(np.arctan(0.15))
        np.testing.assert_allclose(cycle.T12, np.sign(omega2) * radius * 500.0, rtol=1e-12)
        np.testing.assert_allclose(cycle.friction_loss.sel(pin="A"), radius * 500.0 * 20.0, rtol=1e-12)
        assert float(cycle.efficiency) == pytest.approx(0.0, abs=1e-12)  # all of it is lost as heat


def test_the_force_in_a_massless_rod_touches_both_friction_circles():
    """Tangent to circles of radius r·sin φ, its line crosses the line of pins or runs parallel to it."""
    radius = {"B": np.sin(np.arctan(0.1)) * 0.015, "C": np.sin(np.arctan(0.2)) * 0.010}
    pins = {"B": ls.Bearing(diameter=0.03, friction=0.1), "C": ls.Bearing(diameter=0.02, friction=0.2)}
    scene = massless(ls.Load("slider", force=-1000.0))
    cycle = ls.pin_friction(scene, pins, theta2=720, of=["F43x", "F43y", "F43", "theta3", "omega3", "omega2"])
    theta3 = np.radians(cycle.theta3)
    across = np.cos(theta3) * cycle.F43y - np.sin(theta3) * cycle.F43x
    at_b, at_c = np.sign(cycle.omega2 - cycle.omega3), np.sign(cycle.omega3)
    # about B: the crank's pin drags the rod along with +ρF, the slider holds it back with −ρF
    expected = (at_c * radius["C"] - at_b * radius["B"]) / 0.2
    np.testing.assert_allclose(across / cycle.F43, expected, atol=1e-12)


@pytest.mark.parametrize(
    "scene",
    [
        PRESS,
        SHAPER,
        replace(PRESS, omega2=-20.0),
        pytest.param(replace(PRESS, drive="rocker"), marks=pytest.mark.long),
    ],
)
def test_energy_balance_with_friction(scene):
    """Over a cycle at steady speed the friction loss is the drive's extra work."""
    pins = dict.fromkeys(scene.mechanism.pins, RUBBING)
    with_friction = ls.pin_friction(scene, pins, theta2=360, of=["power"])
    without = ls.sweep(scene, theta2=360, of=["power"])
    ok = (without.status == 0) & (with_friction.convergence == 0)
    more = (with_friction.power - without.power).where(ok)
    np.testing.assert_allclose(more, with_friction.friction_loss.sum("pin").where(ok), rtol=1e-9, atol=1e-9)
    assert (with_friction.friction_loss.where(ok, 0.0) >= 0.0).all()
    assert float(ok.mean()) > 0.9


def test_efficiency_of_the_engine():
    """An engine drives its load: efficiency is the work at the crank over the work of the gas."""
    pins = dict.fromkeys("ABC", ls.Bearing(diameter=0.05, friction=0.01))
    ideal = replace(ENGINE, mechanism=replace(ENGINE.mechanism, friction=0.0))
    gas = -float(ls.sweep(ideal, of=["power"]).power.mean())
    for scene in (ideal, ENGINE):
        arrives = -float(ls.pin_friction(scene, pins, of=["power"]).power.mean())
        assert float(ls.pin_friction(scene, pins).efficiency) == pytest.approx(arrives / gas, rel=1e-9)
        assert 0.8 < arrives / gas < 1.0


def test_cylinders_that_change_their_length_feed_and_return_energy_too():
    """An excavator's three, of which one is the drive: 1 less the friction loss over all that is fed."""
    digger, count = ls.example("excavator"), 60
    pins = dict.fromkeys("ACHI", ls.Bearing(diameter=0.1, friction=0.2))
    of = ["power", "force_c2", "rate_c2", "force_c3", "rate_c3"]
    cycle, free = ls.pin_friction(digger, pins, theta2=count, of=of), ls.sweep(digger, count, of=["load_power"])
    powers = [cycle.power, cycle.force_c2 * cycle.rate_c2, cycle.force_c3 * cycle.rate_c3, free.load_power]
    energies = [float(power.mean()) for power in powers]
    lost = float(cycle.friction_loss.sum("pin").mean())
    assert sum(energies) == pytest.approx(lost, rel=0.01)
    assert float(cycle.efficiency) == pytest.approx(1.0 - lost / sum(max(one, 0.0) for one in energies), rel=1e-9)


def test_zero_friction_changes_no_bit():
    cycle = ls.pin_friction(PRESS, {"A": ls.Bearing(diameter=0.02, friction=1e-300)}, theta2=36)
    without = ls.sweep(PRESS, theta2=36)
    for name in ("theta4", "F32x", "F14y", "T12"):
        np.testing.assert_array_equal(cycle[name], without[name])


def test_friction_in_its_pins_bends_a_massless_rod():
    """Each end bears the moment of its own pin, and between them the bending moment changes evenly; the stress is the
    largest of N/A + M/W at the ends."""
    crank, rod = (ls.Bar(size, width=0.02, thickness=0.01, density=0.0) for size in (0.05, 0.2))
    machine = ls.SliderCrank(crank, rod, slider_mass=2.0)
    scene = ls.Scene(machine, omega2=20.0, section=xr.DataArray([0.0, 0.3, 1.0], dims="section"))
    scene = replace(scene, loads=[ls.Load("slider", force=(-1000.0, 300.0), frame="ground")])
    pins = {"B": ls.Bearing(diameter=0.03, friction=0.1), "C": ls.Bearing(diameter=0.02, friction=0.2)}
    cycle = ls.pin_friction(scene, pins, theta2=720, of=["bending_moment2", "bending_moment3", "axial_force3"])
    at_b, at_c = (cycle.friction_torque.sel(pin=pin) for pin in pins)  # of link 3 on link 2, of link 4 on link 3
    size = float(abs(cycle.friction_torque).max())
    expected = (1.0 - scene.section) * at_b + scene.section * at_c
    assert float(abs(cycle.bending_moment3 - expected).max()) < 1e-11 * size
    assert float(abs(cycle.bending_moment2.isel(section=2) - at_b).max()) < 1e-11 * size
    stress = abs(cycle.axial_force3) / (0.02 * 0.01) + 6.0 * abs(expected) / (0.01 * 0.02**2)
    worst = ls.strength(cycle.linksweep.scene, ls.material("S235"), links="rod").stress.item()
    assert worst == pytest.approx(float(stress.max()), rel=1e-3)


@pytest.mark.parametrize("angle", [0.0, 180.0])
def test_friction_acts_at_each_of_three_pins(angle):
    """The bending moment jumps there by the moment of friction, also where the first pin lies between two others."""
    lengths = {"crank": 0.05, "coupler": 0.22, "rocker": 0.17, "rod": 0.25}
    machine = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, ram F on slide",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.0)},
        points={"E": (0.06, angle)},
        guides={"slide": ls.Guide(through=(0.2, -0.15), angle=0.0)},
        **{role: ls.Bar(length, width=0.02, thickness=0.02, density=7850.0) for role, length in lengths.items()},
        ram=ls.Slider(mass=1.0),
    )
    inner, ends, start = ("D", "CE", -0.06) if angle else ("E", "CD", 0.0)
    share = ((0.0 if angle else 0.06) - start) / (0.17 - start)
    sections = xr.DataArray([0.0, share - 1e-9, share + 1e-9, 1.0], dims="section")
    scene = ls.Scene(machine, omega2=20.0, section=sections, loads=[ls.Load("ram", force=-200.0)])
    pins = dict.fromkeys("CDE", ls.Bearing(diameter=0.02, friction=0.2))
    cycle = ls.pin_friction(scene, pins, theta2=24, of=["bending_moment4"])
    sign = {"C": -1.0, "D": 1.0, "E": 1.0}  # of the force of each pin on the rocker: F43, F14, F54
    on_rocker = {pin: sign[pin] * cycle.friction_torque.sel(pin=pin) for pin in pins}
    first, before, after, last = cycle.bending_moment4.transpose("section", ...)
    for got, expected in (
        (first, -on_rocker[ends[1]]),
        (before - after, on_rocker[inner]),
        (last, on_rocker[ends[0]]),
    ):
        assert float(abs(expected).max()) > 0.1
        np.testing.assert_allclose(got, expected, atol=1e-6)


def test_designs_are_batched():
    friction = xr.DataArray([0.05, 0.1], dims="oil")
    several = ls.pin_friction(PRESS, {"C": ls.Bearing(diameter=0.02, friction=friction)}, theta2=36)
    for k in range(2):
        one = ls.pin_friction(PRESS, {"C": ls.Bearing(diameter=0.02, friction=float(friction[k]))}, theta2=36)
        np.testing.assert_allclose(several.T12.isel(oil=k), one.T12, rtol=1e-10)
        np.testing.assert_allclose(several.efficiency.isel(oil=k), one.efficiency, rtol=1e-10)


def test_a_locked_machine_warns():
    """The friction circles are wider than the rod is long."""
    cycle = ls.pin_friction(
        massless(ls.Load("slider", force=-1000.0)), {"C": ls.Bearing(diameter=1.0, friction=0.9)}, theta2=36
    )
    fast = cycle.convergence == 1
    assert fast.any()
    assert np.isnan(cycle.T12.where(fast, drop=True)).all()
    assert np.isfinite(cycle.theta3).all()


def test_its_scene_has_friction_as_loads():
    cycle = ls.pin_friction(PRESS, {"B": RUBBING}, theta2=36)
    again = ls.sweep(cycle.linksweep.scene, theta2=36)
    np.testing.assert_array_equal(again.T12, cycle.T12)


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ({"B": ls.Bearing(diameter=0.01)}, "pins: no pin has friction"),
        (None, "pins: no pin has friction"),
        ({"B": ls.Bearing(friction=0.1)}, "pins.B has friction but no diameter: give it"),
        ({"X": RUBBING}, "pins: nothing is named 'X'"),
    ],
)
def test_refusals(inputs, message):
    (line,) = refusal(ls.pin_friction, PRESS, inputs)
    assert message in line


def test_both_branches_are_refused():
    both = replace(PRESS, mechanism=replace(PRESS.mechanism, branch="both"))
    (line,) = refusal(ls.pin_friction, both, {"B": RUBBING})
    assert 'branch = "both"' in line


def test_pins_of_a_machine_at_rest_take_no_power():
    still = ls.pin_friction(replace(PRESS, omega2=0.0), {"B": ls.Bearing(diameter=0.02, friction=0.1)}, theta2=24)
    assert (still.friction_torque == 0.0).all() and (still.friction_loss == 0.0).all() and np.isnan(still.efficiency)
