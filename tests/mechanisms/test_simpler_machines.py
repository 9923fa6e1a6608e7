"""Four-bars that are simpler machines, whose forces are known by hand or in closed form.

The parallelogram, massless links, and the slider that a long rocker becomes.
"""

from dataclasses import replace
from itertools import pairwise, product

import numpy as np
import pytest
import xarray as xr
from four_bars import links_changed, random_case, swept
from oracle import LINKS, NUMBER
from references import BRANCHES, LoadData

import linksweep as ls

# ---- parallelogram -----

OPPOSITE_SIDES = [(2.0, 5.0), (0.08, 0.2), (0.1, 0.3), (0.07, 0.13), (1 / 3, 0.7)]


def parallelogram(**changes) -> ls.Scene:
    """Crank and rocker 0.2 m, coupler and ground 0.5 m; by default massless and at rest."""
    links = {name: ls.Link(length, 0.0, 0.0) for name, length in zip(LINKS, (0.2, 0.5, 0.2), strict=True)}
    frame = {"ground": 0.5, "branch": "open"}
    frame |= {name: changes.pop(name) for name in (*LINKS, "ground", "branch", "ground_angle") if name in changes}
    return ls.Scene(ls.FourBar(**links | frame), **{"omega2": 0.0} | changes)


def test_weight_on_a_parallelogram_by_hand():
    """Half of 8 N rests on each side; the free rocker takes force along itself only, the drive holds the sway."""
    theta2 = np.array([20.0, 60.0, 90.0, 135.0, 160.0])
    cycle = ls.sweep(parallelogram(loads=ls.Load("coupler", force=(0.0, -8.0), at=(0.25, 0.0))), theta2)
    sway = 4.0 / np.tan(np.radians(theta2))
    expected = {"F43x": sway, "F43y": 4.0, "F14x": sway, "F14y": 4.0, "F32x": sway, "F32y": -4.0}
    expected |= {"F12x": -sway, "F12y": 4.0, "T12": 8.0 * 0.2 * np.cos(np.radians(theta2))}
    for name, value in expected.items():
        np.testing.assert_allclose(cycle[name], np.broadcast_to(value, 5), rtol=0.0, atol=1e-13, err_msg=name)


def with_mass(length: float) -> ls.Link:
    return ls.Link(length, 1.0, 0.01 * length**2, cg_distance=0.4 * length)


def heavy_parallelogram(short: float, long: float, **changes) -> ls.Scene:
    links = {name: with_mass(x) for name, x in zip(LINKS, (short, long, short), strict=True)}
    return parallelogram(**links, ground=long, omega2=3.0, alpha2=-4.0, gravity=(0.0, -9.81), **changes)


@pytest.mark.parametrize("ground_angle", [0.0, 33.3])
@pytest.mark.parametrize(("branch", "first"), [("open", 0.0), ("open", 180.0)])
def test_parallelogram_turns_as_one(branch, first, ground_angle):
    """The coupler without rotation, the rocker with the crank, on one branch all the way round."""
    theta2 = first + ground_angle + np.arange(10.0, 171.0, 20.0)
    cycle = ls.sweep(parallelogram(omega2=3.0, alpha2=-4.0, branch=branch, ground_angle=ground_angle), theta2)
    same = {"theta3": ground_angle, "omega3": 0.0, "omega4": 3.0, "alpha3": 0.0, "alpha4": -4.0}
    same["theta4"] = (theta2 + 180.0) % 360.0 - 180.0
    for name, value in same.items():
        np.testing.assert_allclose(cycle[name], np.broadcast_to(value, 9), rtol=0.0, atol=1e-11, err_msg=name)


@pytest.mark.parametrize("ground_angle", [0.0, 10.0, 33.3])
@pytest.mark.parametrize(("short", "long"), OPPOSITE_SIDES)
def test_fold_of_a_parallelogram_is_a_toggle(short, long, ground_angle):
    """Flat, it can leave on two branches: no rates, no forces, whatever its lengths are rounded to."""
    fold = ground_angle + np.array([0.0, 180.0, -180.0, 360.0])
    cycle = ls.sweep(heavy_parallelogram(short, long, ground_angle=ground_angle), fold)
    assert set(cycle.status.values) == {cycle.status.attrs["flag_meanings"].split().index("toggle")}
    assert cycle.T12.isnull().all()


CHANGE_POINTS = [  # in mm, where two links together are as long as the other two; and the angle at which they lie flat
    ((221, 98, 115, 204), 0.0),
    ((100, 200, 150, 150), 0.0),
    ((103, 210, 190, 297), 180.0),
    ((33, 270, 61, 298), 180.0),
]


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize(("lengths", "flat"), CHANGE_POINTS)
def test_change_point_is_a_toggle(lengths, flat, branch):
    """In metres the lengths no longer add up to the last bit; what happens there is the same."""
    crank, coupler, rocker, ground = (length / 1000 for length in lengths)
    bars = ls.FourBar(*map(with_mass, (crank, coupler, rocker)), ground=ground, branch=branch)
    cycle = ls.sweep(ls.Scene(bars, omega2=3.0), [flat, flat + 360.0])
    assert set(cycle.status.values) == {cycle.status.attrs["flag_meanings"].split().index("toggle")}
    assert cycle.F32x.isnull().all()


@pytest.mark.parametrize(("short", "long"), OPPOSITE_SIDES)
def test_coupler_of_a_parallelogram_cannot_drive(short, long):
    """It does not turn, so no torque on it can balance anything."""
    cycle = ls.sweep(heavy_parallelogram(short, long, drive="coupler"), np.arange(10.0, 171.0, 20.0))
    assert set(cycle.status.values) == {cycle.status.attrs["flag_meanings"].split().index("dead_centre")}
    assert cycle.T13.isnull().all()


# ---- massless links -----


def massless(branch: str, seed: int, load: LoadData) -> xr.Dataset:
    data, theta2 = random_case(branch, "crank", seed, scale=1.0)
    data = replace(data, **links_changed(data, lambda link: replace(link, mass=0.0, inertia=0.0)), loads=(load,))
    return swept(data, theta2)


def pin_force(cycle: xr.Dataset, pin: str) -> np.ndarray:
    return (cycle[f"{pin}x"] + 1j * cycle[f"{pin}y"]).values


def direction(cycle: xr.Dataset, link: str) -> np.ndarray:
    return np.exp(1j * np.radians(cycle[f"theta{NUMBER[link]}"].values))


massless_scenes = pytest.mark.parametrize(("branch", "seed"), list(product(BRANCHES, range(4))))


@massless_scenes
def test_torque_on_the_rocker_of_massless_links(branch, seed):
    """The coupler is a two-force rod: it pushes along itself, with M/(c sin μ)."""
    data, _ = random_case(branch, "crank", seed, scale=1.0)
    cycle = massless(branch, seed, LoadData("rocker", torque=3.0))
    F43, F32, F12, F14 = (pin_force(cycle, pin) for pin in ("F43", "F32", "F12", "F14"))
    size = abs(F43)
    arm = data.rocker.length * np.sin(np.radians(cycle.transmission_angle.values))
    np.testing.assert_allclose(size, 3.0 / arm, rtol=1e-12)
    assert np.all(abs((F43 * direction(cycle, "coupler").conj()).imag) < 1e-12 * size)
    for other in (F32, -F12, F14):
        np.testing.assert_array_equal(other, F43)
    np.testing.assert_allclose(cycle["T"], -3.0 * cycle.omega4 / data.omega2, rtol=1e-12)


@massless_scenes
def test_force_on_the_coupler_of_massless_links(branch, seed):
    """The rocker is a two-force rod; the coupler's three forces add to nothing and meet in a point."""
    data, _ = random_case(branch, "crank", seed, scale=1.0)
    cycle = massless(branch, seed, LoadData("coupler", (2.0, -5.0), at=(0.3, 40.0)))
    F43, F32, F12, F14 = (pin_force(cycle, pin) for pin in ("F43", "F32", "F12", "F14"))
    size = np.maximum(abs(F43), abs(F32))
    assert np.all(abs((F43 * direction(cycle, "rocker").conj()).imag) < 1e-12 * size)
    np.testing.assert_array_equal(F14, F43)
    np.testing.assert_array_equal(F12, -F32)
    P, coupler = complex(2.0, -5.0), direction(cycle, "coupler")
    assert np.all(abs(F43 + P - F32) < 1e-12 * size)
    about_B = data.coupler.length * coupler.conj() * F43 + 0.3 * np.exp(-1j * np.radians(40)) * coupler.conj() * P
    assert np.all(abs(about_B.imag) < 1e-12 * size)


# ---- a long rocker as a slider -----


def almost_slider(rocker: float, theta2: np.ndarray, load: float) -> dict[str, np.ndarray]:
    """Slider-crank with its slider of 2 kg on the tip of a rocker that hangs from far above x = 1.1 m."""
    bars = ls.FourBar(
        crank=ls.Link(0.3, 0.0, 0.0),
        coupler=ls.Link(1.0, 0.0, 0.0),
        rocker=ls.Link(rocker, 2.0, 0.0, cg_distance=rocker),
        ground=np.hypot(1.1, rocker),
        ground_angle=float(np.degrees(np.arctan2(rocker, 1.1))),
        branch="crossed",
    )
    push = ls.Load("rocker", force=(load, 0.0), at=(rocker, 0.0))
    names = ("Cx", "theta3", "omega3", "alpha3", "aG4x", "F43x", "F43y", "F32x", "F14y", "F14x", "T12")
    cycle = ls.sweep(ls.Scene(bars, omega2=5.0, alpha2=3.0, loads=push), theta2, of=names)
    return {name: cycle[name].values for name in names}


def slider_crank(theta2: np.ndarray, load: float) -> dict[str, np.ndarray]:
    """Closed form: massless crank a and rod b, slider m on the x axis under a force along x, no friction."""
    a, b, m, omega, alpha = 0.3, 1.0, 2.0, 5.0, 3.0
    sin, cos = np.sin(np.radians(theta2)), np.cos(np.radians(theta2))
    sin3 = -a * sin / b
    cos3 = np.sqrt(1.0 - sin3**2)
    omega3 = -omega * a * cos / (b * cos3)
    alpha3 = (-a * alpha * cos + a * omega**2 * sin + b * omega3**2 * sin3) / (b * cos3)
    acceleration = -a * (alpha * sin + omega**2 * cos) - b * (alpha3 * sin3 + omega3**2 * cos3)
    F43x = load - m * acceleration
    F43y = F43x * sin3 / cos3
    return {
        "Cx": a * cos + b * cos3,
        "theta3": np.degrees(np.arctan2(sin3, cos3)),
        "omega3": omega3,
        "alpha3": alpha3,
        "aG4x": acceleration,
        "F43x": F43x,
        "F43y": F43y,
        "F32x": F43x,
        "F14y": F43y,
        "F14x": np.zeros_like(sin),
        "T12": -a * (cos * F43y - sin * F43x),
    }


def test_a_long_rocker_is_a_slider():
    """The difference that the rocker's arc makes falls with its length."""
    theta2 = np.arange(0.0, 360.0, 7.5)
    expected = slider_crank(theta2, -40.0)
    rockers = (1e2, 1e3, 1e4, 1e5)
    off = [almost_slider(rocker, theta2, -40.0) for rocker in rockers]
    for name, value in expected.items():
        errors = [np.abs(result[name] - value).max() for result in off]
        assert errors[-1] < 1e-4 * max(1.0, abs(value).max()), name
        for before, after in pairwise(errors):
            assert 9.0 < before / after < 11.0, (name, errors)
