"""Laws that any linkage obeys, on random linkages of every topology: mirror, units, time reversal, rotation."""

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from random_linkages import assert_equal, changed, cycle_of_case, random_case, random_linkages, swept, unwarned

import linksweep as ls
from linksweep.base.validate import UNITS

pytestmark = unwarned


def units_of(value: xr.DataArray) -> str:
    return value.attrs.get("units", "1")


# ---- mirror -----

TURNED = re.compile(r".*(angle|phase|omega2|alpha2|torque|(ground\.\w+|points\.\w+|through|gravity|force|at)\[2\])")
TURNED_END = re.compile(r".*(from_|to)\[3\]")


def mirrored(scene: ls.Scene) -> ls.Scene:
    """Return the scene in a mirror that lies along x; a pin of two links then is on the other side of their line."""

    def number(path, value, kind):
        turns = TURNED.fullmatch(path) or TURNED_END.fullmatch(path)
        return -value if turns and not path.endswith("pressure_angle") else value

    other, machine = changed(scene, number), scene.mechanism
    of_two_links = [step.name for step in machine.topology.steps if type(step).__name__ == "RRR"]
    turned = {pin: {"open": "crossed", "crossed": "open"}[machine.branch.get(pin, "open")] for pin in of_two_links}
    return replace(other, mechanism=replace(other.mechanism, branch={**machine.branch, **turned}))


def turns(value: xr.DataArray) -> bool:
    """Return whether a quantity turns its sign in the mirror."""
    name, units = re.sub(r"_link\d+$", "", str(value.name)), units_of(value)
    component = units in ("m", "m/s^2", "N") and name.endswith("y")
    angle = units in ("rad/s", "rad/s^2", "N m", "kg m^2/rad") or name.startswith("theta")
    return component or angle or re.fullmatch(r"F\d+n", name) is not None


def held(value):
    """Return a value at the first of its angles, as a spline rounds another way in the mirror."""
    return value.isel(theta2=0, drop=True) if "theta2" in getattr(value, "dims", ()) else value


@random_linkages
def test_mirror(name):
    """Angles, rates, torques, y and normal forces turn their signs; not a bit changes otherwise.

    Only the bound on the error does, which counts a product by the branch's sign −1 as rounded, and by 1 as none.
    """
    loaded, theta2 = random_case(name)
    scene = changed(loaded, lambda path, value, kind: held(value))
    expected = swept(scene, theta2).map(lambda value: -value if turns(value) else value)
    result = swept(mirrored(scene), -theta2)
    np.testing.assert_allclose(result.error_bound, expected.error_bound, rtol=0.25)
    assert_equal(result.drop_vars("error_bound"), expected.drop_vars("error_bound"))


# ---- units -----

BASE = {
    "1": (0, 0, 0),
    "rad": (0, 0, 0),
    "degree": (0, 0, 0),
    "m": (1, 0, 0),
    "kg": (0, 1, 0),
    "s": (0, 0, 1),
    "N": (1, 1, -2),
    "J": (2, 1, -2),
    "W": (2, 1, -3),
}
"""Exponents of length, mass and time in each unit."""


def factor(units: str, *scales: float) -> float:
    """Return the number of smaller units, by these factors of length, mass and time, in one unit such as "kg m^2"."""
    above, _, below = units.replace("^", "").partition("/")
    powers = [(*re.fullmatch(r"(\w+?)(-?\d)?", word).groups("1"), 1) for word in above.split() if word != "1"]
    powers += [(*re.fullmatch(r"(\w+?)(-?\d)?", word).groups("1"), -1) for word in below.split()]
    exponents = [sign * int(power) * np.array(BASE[unit]) for unit, power, sign in powers]
    return float(np.prod(np.array(scales) ** np.sum([np.zeros(3), *exponents], axis=0)))


def test_factors_of_units():
    assert factor("N m s/rad", 2.0, 0.25, 8.0) == 2.0**2 * 0.25 / 8.0
    assert factor("kg m^2/rad", 2.0, 0.25, 8.0) == 1.0
    assert factor("rad/s^2", 2.0, 0.25, 8.0) == 1.0 / 64.0
    assert factor("1", 2.0, 0.25, 8.0) == 1.0


def in_units(cycle: xr.Dataset, scales: tuple[float, float, float]) -> xr.Dataset:
    return cycle.map(lambda value: value * factor(units_of(value), *scales))


@random_linkages
@pytest.mark.parametrize("units", [(2.0**-30, 1.0, 1.0), (1.0, 2.0**21, 1.0), (1.0, 1.0, 2.0**9), (8.0, 0.25, 16.0)])
def test_change_of_units_by_powers_of_two_changes_no_digit(name, units):
    """No noise floor has a dimension: bound on the error, power residual and status are equal, too."""
    scene, theta2 = random_case(name)
    other = changed(scene, lambda path, value, kind: value * factor(UNITS[kind], *units))
    assert_equal(swept(other, theta2), in_units(cycle_of_case(name), units))


# ---- time reversal -----


@random_linkages
def test_time_reversal(name):
    """A film run backwards shows the same forces, without friction and dampers; bit for bit."""
    loaded, theta2 = random_case(name)
    losses = ("friction", "coefficient")
    scene = changed(loaded, lambda path, value, kind: 0.0 * value if path.endswith(losses) else value)
    turned = ("rad/s", "m/s", "W")
    expected = swept(scene, theta2).map(lambda value: -value if units_of(value) in turned else value)
    fed, back = expected.power_fed, expected.power_regenerated
    expected = expected.assign(power_residual=-expected.power_residual, power_fed=-back, power_regenerated=-fed)
    assert_equal(swept(replace(scene, omega2=-scene.omega2), theta2), expected)


# ---- rotation -----


VECTOR = re.compile(r"(.*)x(_link\d+)?")


@random_linkages
def test_rotation(name):
    """The whole machine turned about the crank's pivot, with gravity and loads: components turn, the rest stays."""
    scene, theta2 = random_case(name)
    angle = 37.3
    expected, result = cycle_of_case(name), swept(turned(scene, angle), theta2 + angle)
    size: dict[str, float] = {}
    for value in expected.values():
        size[units_of(value)] = max(size.get(units_of(value), 0.0), float(abs(value).max()))
    turn = np.exp(1j * np.radians(angle))
    for stem, link in (match.groups("") for match in map(VECTOR.fullmatch, map(str, expected)) if match):
        x, y = f"{stem}x{link}", f"{stem}y{link}"
        z = (expected[x] + 1j * expected[y]) * (1.0 if link else turn)
        assert abs(result[x] + 1j * result[y] - z).max() < 2e-12 * size[units_of(expected[x])], x
    for name in (name for name in map(str, expected) if re.match(r"theta\d", name)):
        assert abs(np.exp(1j * np.radians(result[name] - expected[name] - angle)) - 1.0).max() < 1e-12, name
    for name in (name for name in map(str, expected) if re.match(r"T\d|reduced_torque", name)):
        assert abs(result[name] - expected[name]).max() < 1e-11 * size["N"] * size["m"], name


def turned(scene: ls.Scene, angle: float) -> ls.Scene:
    """Return the scene turned about the crank's pivot."""
    numbers = {path: value for path, (value, kind) in scene.numbers.items() if value is not None}
    for path, value in numbers.items():
        if "theta2" in getattr(value, "dims", ()):
            numbers[path] = value.assign_coords(theta2=(value.theta2 + angle) % 360.0).sortby("theta2")
    vectors = [["gravity[1]", "gravity[2]"]]
    vectors += [[f"ground.{pin}[1]", f"ground.{pin}[2]"] for pin in scene.mechanism.ground]
    for name, guide in scene.mechanism.guides.items():
        if guide.of == "ground":
            vectors.append([f"guides.{name}.through[1]", f"guides.{name}.through[2]"])
            numbers[f"guides.{name}.angle"] = guide.angle + angle
    for wheel, ratio in scene.mechanism.topology.gears.items():  # whose angle is the ratio times theta2, and the phase
        if f"gears.{wheel}.phase" in numbers:
            numbers[f"gears.{wheel}.phase"] = numbers[f"gears.{wheel}.phase"] + angle * (1.0 - float(ratio))
    for k, load in enumerate(scene.loads, 1):
        if isinstance(load, ls.Load) and load.frame == "ground" and load.force is not None:
            vectors.append([f"loads[{k}].force[1]", f"loads[{k}].force[2]"])
        if getattr(load, "from_", " ")[0] == "ground":
            vectors.append([f"loads[{k}].from_[2]", f"loads[{k}].from_[3]"])
    for x, y in vectors:
        z = (numbers[x] + 1j * numbers[y]) * np.exp(1j * np.radians(angle))
        numbers |= {x: z.real, y: z.imag}
    return changed(scene, lambda path, value, kind: numbers[path])
