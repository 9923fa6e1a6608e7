"""Laws that any four-bar obeys, on random scenes: one result predicts another.

Mirror, rotation, units, superposition, time reversal, statics, and the drive that takes over another's torque.
"""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import xarray as xr
from four_bars import (
    ANGLES,
    COMPONENTS,
    PINS,
    RATES,
    VECTORS,
    links_changed,
    longest_link,
    random_case,
    random_scenes,
    swept,
)
from long import long_but
from oracle import LINKS, NUMBER, FourBarData, motion, random_data, to_scene, toggle_margin
from references import load_force, load_point, mp, random_load

import linksweep as ls


def assert_equal(result: xr.Dataset, expected: xr.Dataset) -> None:
    for name in expected.data_vars:
        np.testing.assert_array_equal(result[name].values, expected[name].values, err_msg=name)


def kind(name: str) -> str:
    """Return the scale that a quantity is compared with: F for F12x and F43 alike."""
    return name.rstrip("xy0123456789")


def sizes(cycle: xr.Dataset, data: FourBarData) -> dict[str, np.ndarray | float]:
    """The largest of each kind at each angle; torques are measured by the largest force times the longest link."""
    largest = np.maximum.reduce
    omega = largest([np.full(5, abs(data.omega2)), abs(cycle.omega3), abs(cycle.omega4)])
    alpha = largest([np.full(5, data.omega2**2 + abs(data.alpha2)), abs(cycle.alpha3), abs(cycle.alpha4)])
    force, longest = largest([cycle[pin] for pin in PINS]), longest_link(data)
    result = {"theta": 180.0, "transmission_angle": 180.0, "omega": omega, "alpha": alpha, "aG": alpha * longest}
    result |= {"B": longest, "C": longest, "F": force, "T": force * longest}
    return result | {"power": force * longest * omega}


def assert_close(result: xr.Dataset, expected: xr.Dataset, data: FourBarData) -> None:
    """Within 1e-11 of the largest of its kind; `data` is the scene of what is expected."""
    size = sizes(expected, data)
    for name in expected.data_vars:
        error = np.abs(result[name].values - expected[name].values) / size[kind(name)]
        assert np.all(error < 1e-11), (name, error)


# ---- symmetries -----


def mirrored(data: FourBarData) -> FourBarData:
    """Return the scene in a mirror that lies along x."""
    return replace(
        data,
        **links_changed(data, lambda link: replace(link, cg_angle=-link.cg_angle)),
        branch={"open": "crossed", "crossed": "open"}[data.branch],
        ground_angle=-data.ground_angle,
        omega2=-data.omega2,
        alpha2=-data.alpha2,
        gravity=(data.gravity[0], -data.gravity[1]),
        loads=tuple(
            replace(
                load,
                force=(load.force[0], -load.force[1]),
                at=(load.at[0], -load.at[1]),
                torque=-load.torque,
            )
            for load in data.loads
        ),
    )


@random_scenes
def test_mirror(branch, drive, seed):
    """Angles, rates, torques and y turn their signs, the branch swaps; not a bit changes otherwise."""
    data, theta2 = random_case(branch, drive, seed)
    turned = (*ANGLES, *RATES, "T", *(name for name in COMPONENTS if name.endswith("y")))
    expected = swept(data, theta2).map(lambda value: -value if value.name in turned else value)
    assert_equal(swept(mirrored(data), -theta2), expected)


def rotated(data: FourBarData, angle: float) -> FourBarData:
    """The scene turned about A, with its gravity and the loads in ground axes."""

    def turned(vector):
        z = complex(*vector) * np.exp(1j * np.radians(angle))
        return z.real, z.imag

    return replace(
        data,
        ground_angle=data.ground_angle + angle,
        gravity=turned(data.gravity),
        loads=tuple(replace(load, force=turned(load.force)) if load.frame == "ground" else load for load in data.loads),
    )


@random_scenes
def test_rotation(branch, drive, seed):
    data, theta2 = random_case(branch, drive, seed)
    angle = float(np.random.default_rng(seed).uniform(-300, 300))
    expected = swept(data, theta2)
    for name in ANGLES:
        expected[name] = (expected[name] + angle + 180.0) % 360.0 - 180.0
    for vector in VECTORS:
        z = (expected[f"{vector}x"] + 1j * expected[f"{vector}y"]) * np.exp(1j * np.radians(angle))
        expected[f"{vector}x"], expected[f"{vector}y"] = z.real, z.imag
    assert_close(swept(rotated(data, angle), theta2 + angle), expected, data)


def rescaled(data: FourBarData, length: float, mass: float, time: float) -> FourBarData:
    """Return the machine in units that are smaller by these factors."""
    force = mass * length / time**2
    return replace(
        data,
        **links_changed(
            data,
            lambda link: replace(
                link,
                length=link.length * length,
                mass=link.mass * mass,
                inertia=link.inertia * (mass * length**2),
                cg_distance=link.cg_distance * length,
            ),
        ),
        ground=data.ground * length,
        omega2=data.omega2 / time,
        alpha2=data.alpha2 / time**2,
        gravity=tuple(g * (length / time**2) for g in data.gravity),
        loads=tuple(
            replace(
                load,
                force=tuple(f * force for f in load.force),
                at=(load.at[0] * length, load.at[1]),
                torque=load.torque * (force * length),
            )
            for load in data.loads
        ),
    )


def in_units(cycle: xr.Dataset, length: float, mass: float, time: float) -> xr.Dataset:
    force = mass * length / time**2
    factors = {"theta": 1.0, "transmission_angle": 1.0, "omega": 1 / time, "alpha": 1 / time**2}
    factors |= {"B": length, "C": length, "aG": length / time**2}
    factors |= {"F": force, "T": force * length, "power": force * length / time}
    return cycle.map(lambda value: value * factors[kind(value.name)])


@random_scenes
@pytest.mark.parametrize("units", [(2.0**-30, 1.0, 1.0), (1.0, 2.0**21, 1.0), (1.0, 1.0, 2.0**9), (8, 0.25, 16)])
def test_change_of_units_by_powers_of_two_changes_no_digit(branch, drive, seed, units):
    data, theta2 = random_case(branch, drive, seed)
    assert_equal(swept(rescaled(data, *units), theta2), in_units(swept(data, theta2), *units))


@random_scenes
@pytest.mark.parametrize("units", [(3.7, 1.0, 1.0), (1.0, 3.7, 1.0), (1.0, 1.0, 3.7)])
def test_change_of_units(branch, drive, seed, units):
    data, theta2 = random_case(branch, drive, seed)
    changed = rescaled(data, *units)
    assert_close(swept(changed, theta2), in_units(swept(data, theta2), *units), changed)


@random_scenes
def test_time_reversal(branch, drive, seed):
    """A film run backwards shows the same forces: velocities turn, accelerations do not; bit for bit."""
    data, theta2 = random_case(branch, drive, seed)
    turned = ("omega3", "omega4", "power")
    expected = swept(data, theta2).map(lambda value: -value if value.name in turned else value)
    assert_equal(swept(replace(data, omega2=-data.omega2), theta2), expected)


@random_scenes
def test_superposition_of_loads(branch, drive, seed):
    """Forces and torque are affine in the loads."""
    rng = np.random.default_rng(seed)
    data, theta2 = random_case(branch, drive, seed, loads=0)
    force = data.coupler.mass * data.omega2**2 * longest_link(data)
    first, second = (random_load(rng, LINKS, force, longest_link(data)) for _ in range(2))
    twice = replace(first, force=tuple(2.5 * f for f in first.force), torque=2.5 * first.torque)
    names = [name for name in COMPONENTS if name.startswith("F")]
    none, one, other, both = (
        swept(replace(data, loads=loads), theta2, names) for loads in ((), (first,), (second,), (twice, second))
    )
    expected = none + 2.5 * (one - none) + (other - none)
    size = max(float(abs(cycle[name]).max()) for cycle in (none, one, other, both) for name in names)
    for name in (*names, "T"):
        error = abs(both[name] - expected[name]) / (size * longest_link(data) if name == "T" else size)
        assert error.max() < 1e-12, (name, error)


# ---- statics -----


def virtual_work(data: FourBarData, theta2: float):
    """Work of weights and loads per radian of the crank, and turn of the driven link, by numerical differentiation."""
    now = motion(data, theta2)

    def rate(of):
        return mp.diff(lambda angle: of(motion(data, mp.degrees(angle))), mp.radians(theta2))

    def turn_of(link):
        return rate(lambda move: mp.arg(move.line[link] / now.line[link]))

    work = mp.mpf(0)
    for name in LINKS:
        weight = mp.mpf(getattr(data, name).mass) * mp.mpc(*data.gravity)
        work += (weight.conjugate() * rate(lambda move, name=name: move.G[name])).real
    for load in data.loads:
        step = rate(lambda move, load=load: load_point(move, load))
        work += (load_force(now, load).conjugate() * step).real + load.torque * turn_of(load.link)
    return work, turn_of(data.drive)


@random_scenes
def test_a_machine_at_rest_is_balanced_by_virtual_work(branch, drive, seed):
    """Only positions enter the expected torque."""
    moving, theta2 = random_case(branch, drive, seed, loads=2)
    data = replace(moving, omega2=0.0, alpha2=0.0)
    rest = swept(data, theta2[:2])
    for name in (*RATES, "aG2x", "aG3y", "aG4x", "power"):
        assert not rest[name].any(), name
    for k, angle in enumerate(theta2[:2]):
        work, turn = virtual_work(data, float(angle))
        size = max(float(rest[pin][k]) for pin in PINS) * longest_link(data)
        assert float(rest["T"][k]) == pytest.approx(float(-work / turn), rel=0.0, abs=1e-11 * size)


# ---- one drive's torque as a load of another -----


def case_of_two_drives(seed: int, drives: tuple[str, str]) -> tuple[FourBarData, np.ndarray]:
    """A scene driven by the first, and crank angles where either could drive."""
    rng = np.random.default_rng(seed)
    data = random_data(rng, drive=drives[0])
    tried = rng.uniform(-180, 540, 400)
    held = [x for x in tried if all(toggle_margin(replace(data, drive=drive), x) > 0.1 for drive in drives)]
    return data, np.array(held[:5])


def as_load(link: str, cycle: xr.Dataset) -> ls.Load:
    """Return the computed torque of a drive, as a known torque on its link."""
    return ls.Load(link, torque=cycle[f"T1{NUMBER[link]}"])


def largest_force(cycle: xr.Dataset) -> float:
    return max(float(abs(cycle[f"{pin}{axis}"]).max()) for pin in PINS for axis in "xy")


other_drives = pytest.mark.parametrize(("driver", "other"), [(a, b) for a, b in product(LINKS, LINKS) if a != b])


@other_drives
@pytest.mark.parametrize("seed", long_but(range(3), 0))
def test_a_known_torque_leaves_nothing_for_another_drive(driver, other, seed):
    """With the torque of one drive as a load another drive needs no torque, at equal pin forces."""
    data, theta2 = case_of_two_drives(seed, (driver, other))
    scene = to_scene(data)
    driven = ls.sweep(scene, theta2)
    idle = ls.sweep(replace(scene, drive=other, loads=(*scene.loads, as_load(driver, driven))), theta2)
    size = largest_force(driven)
    assert theta2.size == 5
    assert not idle.status.any()
    for name in (name for name in COMPONENTS if name.startswith("F")):
        assert abs(idle[name] - driven[name]).max() < 1e-11 * size, name
    assert abs(idle[f"T1{NUMBER[other]}"]).max() < 1e-11 * size * longest_link(data)


@other_drives
def test_two_drives_share_the_work(driver, other):
    """One drives against a known brake on the other, then the other against that torque: the brake comes back."""
    data, theta2 = case_of_two_drives(5, (driver, other))
    scene = to_scene(data)
    free = ls.sweep(scene, theta2)[f"T1{NUMBER[driver]}"]
    brake = free.copy(data=float(abs(free).max()) * np.linspace(-1.0, 1.0, theta2.size))
    cycle = ls.sweep(replace(scene, loads=(*scene.loads, ls.Load(other, torque=brake))), theta2)
    back = ls.sweep(replace(scene, drive=other, loads=(*scene.loads, as_load(driver, cycle))), theta2)
    error = abs(back[f"T1{NUMBER[other]}"] - brake).max()
    assert theta2.size == 5
    assert error < 1e-11 * largest_force(cycle) * longest_link(data)
