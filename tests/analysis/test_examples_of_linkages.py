"""Laws of the analyses of any linkage, on examples with slides, cylinders, gears and a line past a pin."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import xarray as xr
from refusals import refusal

import linksweep as ls
from linksweep.scene.parameters import replaced

NAMES = ("watt-2", "knuckle-press", "excavator", "whitworth", "geared-five-bar", "scotch-yoke")
THETA2 = 24
BEARING = ls.Bearing(diameter=0.004, friction=0.05)
machines = pytest.mark.parametrize("name", NAMES)


@cache
def example(name: str) -> ls.Scene:
    return ls.example(name)


@cache
def smooth(name: str) -> ls.Scene:
    """Return the example without friction in its slides."""
    return replaced(example(name), {path: 0.0 for path in example(name).numbers if path.endswith("friction")})


def without_pressure(scene: ls.Scene) -> ls.Scene:
    gears = {role: replace(pair, pressure_angle=None) for role, pair in scene.mechanism.gears.items()}
    return replace(scene, mechanism=replace(scene.mechanism, gears=gears))


def designs(name: str) -> ls.Scene:
    return replace(example(name), omega2=example(name).omega2 * xr.DataArray([1.0, 1.1, 1.3], dims="pace"))


def forces_of(name: str) -> list[str]:
    """Return some forces at pins and slides, and the drive's unknown."""
    machine = example(name).mechanism
    slides = [f"F{i}{j}n" for i, j in machine.topology.slides.values()]
    return [*machine.unknowns(example(name).drive)[:4], *slides, machine.drives[example(name).drive]]


def assert_close(result, expected, digits=1e-11) -> None:
    size = float(abs(expected).max())
    np.testing.assert_allclose(*xr.broadcast(result, expected), rtol=digits, atol=digits * size)


@machines
def test_shares_of_the_sources_add_up(name):
    """Also with friction and teeth, in which forces are not linear."""
    cycle = ls.sweep(example(name), THETA2, of=forces_of(name))
    shares = ls.breakdown(example(name), forces_of(name), theta2=THETA2)
    for quantity in forces_of(name):
        assert_close(shares[quantity].sum("source", skipna=False), cycle[quantity])


@machines
def test_forces_are_linear_in_the_masses(name):
    scene = without_pressure(smooth(name))
    cycle = ls.sweep(scene, THETA2, of=forces_of(name))
    linear = ls.regressor(scene, forces_of(name), theta2=THETA2)
    for quantity in forces_of(name):
        total = (linear[quantity] * linear.value).sum("parameter", skipna=False) + linear[f"{quantity}_of_loads"]
        assert_close(total, cycle[quantity], 1e-10)


def test_teeth_with_a_pressure_angle_are_not_linear():
    """They part whichever way they drive."""
    assert refusal(ls.regressor, smooth("geared-five-bar"), ["T12"], theta2=THETA2) == [
        "scene is of a Linkage with pressure angles of gears: forces are not linear in the masses then; make it 0, or "
        "leave it out"
    ]
    with pytest.raises(
        ValueError, match=r"mechanism\.gears: teeth with a pressure angle part whichever way they drive"
    ):
        ls.speed_separation(smooth("geared-five-bar"))


@machines
def test_a_bearing_has_the_force_of_its_pin(name):
    scene = example(name)
    bearings = ls.bearings(scene, dict.fromkeys(scene.mechanism.pins, BEARING), theta2=THETA2)
    cycle = ls.sweep(scene, THETA2)
    for pin, (i, j) in scene.mechanism.pins.items():
        assert_close(bearings.F.sel(pin=pin, drop=True), cycle[f"F{i}{j}"])


@machines
def test_friction_in_the_pins_takes_power_from_the_drive(name):
    """At each angle, as the motion is the same; a cylinder whose length changes with the crank feeds power, too."""
    scene, held = smooth(name), smooth(name).mechanism.topology.struts
    of = ["power", *(f"{word}_{cylinder}" for cylinder in held for word in ("force", "rate"))]
    rubbing = ls.pin_friction(scene, dict.fromkeys(scene.mechanism.pins, BEARING), theta2=THETA2, of=of)

    def fed(cycle: xr.Dataset) -> xr.DataArray:
        return cycle.power + sum(cycle[f"force_{cylinder}"] * cycle[f"rate_{cylinder}"] for cylinder in held)

    losses, plain = rubbing.friction_loss.sum("pin"), fed(ls.sweep(scene, THETA2, of=of))
    ok = rubbing.convergence == 0
    assert int(ok.sum()) > THETA2 // 2 and float(losses.max()) > 0.0
    extra = (fed(rubbing) - plain).where(ok, drop=True)
    np.testing.assert_allclose(extra, losses.where(ok, drop=True), atol=1e-7 * float(abs(plain).max()))


@machines
def test_a_counterweight_changes_the_shaking_force_as_its_mass_turns(name):
    """A mass m at r on the crank turns with r ω²: only its own −m·a is added."""
    scene = replace(smooth(name), alpha2=0.0)
    mass, distance = 0.3, 0.02
    weights = [ls.Counterweight(scene.mechanism.roles[0], mass=mass, at=(distance, 0.0))]
    before, after = (ls.sweep(s, THETA2, of=["Fsx", "Fsy"]) for s in (scene, ls.with_counterweights(scene, weights)))
    size, theta = mass * distance * float(scene.omega2) ** 2, np.radians(before.theta2)
    np.testing.assert_allclose(
        after.Fsx - before.Fsx, size * np.cos(theta), atol=1e-9 * max(size, float(after.Fsx.max()))
    )
    np.testing.assert_allclose(
        after.Fsy - before.Fsy, size * np.sin(theta), atol=1e-9 * max(size, float(after.Fsy.max()))
    )


@machines
def test_orders_add_up_to_the_signal(name):
    """An odd count of samples has half as many orders, and no more."""
    cycle = ls.sweep(example(name), 49, of=["Fsx"])
    orders = ls.orders(cycle, "Fsx", n=24)
    waves = orders.Fsx_amplitude * np.cos(np.radians(orders.order * cycle.theta2 - orders.Fsx_phase))
    assert_close(waves.sum("order"), cycle.Fsx)


@machines
def test_files_give_scene_and_numbers_back(name, tmp_path):
    cycle = ls.sweep(designs(name), THETA2)
    ls.save(cycle, tmp_path / "cycle.nc")
    again = ls.load_scene(tmp_path / "cycle.nc")
    assert again == designs(name)
    with xr.open_dataset(tmp_path / "cycle.nc") as stored:
        xr.testing.assert_equal(stored.load(), cycle)
    xr.testing.assert_equal(ls.sweep(again, THETA2), cycle)


@machines
def test_a_study_and_an_objective_give_the_peaks(name, tmp_path):
    scene, of = designs(name), forces_of(name)[-1:]
    peaks = ls.peaks(scene, of=of, theta2=THETA2)
    with ls.study(scene, tmp_path / "study.nc", of=of, theta2=THETA2) as study:
        xr.testing.assert_equal(study.load(), peaks)
    speed, aim = float(example(name).omega2), f"{of[0]}_peak"
    aims = ls.objective(example(name), {"omega2": (0.5 * speed, 2.0 * speed)}, minimize=aim, theta2=THETA2)
    values = aims(np.array([[speed, 1.1 * speed, 1.3 * speed]]))
    np.testing.assert_array_equal(values, peaks[aim].where(peaks.status == 0, np.inf))
