"""The inverted slider-crank against 60-digit arithmetic, hand calculations, and laws that any such machine obeys.

Errors are relative to the largest of their kind at the same position: forces to the largest, torques to that force
times the longest length, rates to the fastest link's, places to the longest length.
"""

from dataclasses import replace
from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np
import pytest
import xarray as xr
from long import long_but
from oracle_inverted_slider_crank import (
    DRIVES,
    KINDS,
    LINKS,
    UNKNOWN,
    InvertedSliderCrankData,
    kind_of,
    largest_torque,
    longest,
    motion,
    random_data,
    random_theta2,
    solve,
    to_scene,
    toggle_margin,
)
from references import BRANCHES, FORCES, LinkData, LoadData, Unassemblable, largest_force

import linksweep as ls
from linksweep.engine import run

ANGLES = ("theta3", "theta4")
RATES = ("omega3", "omega4", "alpha3", "alpha4")
SLIDE = ("slide", "slide_velocity", "slide_acceleration")
COMPONENTS = tuple(vector + axis for vector in ("B", "aG2", "aG3", "aG4", *FORCES) for axis in "xy")
ARMS = tuple(f"R{pair}{axis}" for pair in (12, 32, 23, 14) for axis in "xy")
EVERYTHING = (*ANGLES, *RATES, *SLIDE, *COMPONENTS, *ARMS, *FORCES, "F43n", "T43", "transmission_angle", "power")


class Case(NamedTuple):
    """A random scene, crank angles away from its toggles [degree], and the reference results."""

    data: InvertedSliderCrankData
    theta2: list[float]
    results: list[dict]


@cache
def cases() -> list[Case]:
    """144 scenes: eight of each kind, branch and drive."""
    rng, result = np.random.default_rng(11), []
    for kind, branch, drive, _ in product(KINDS, BRANCHES, DRIVES, range(8)):
        data = random_data(rng, kind=kind, branch=branch, drive=drive)
        theta2 = [random_theta2(rng, data) for _ in range(4)]
        result.append(Case(data, theta2, [solve(data, angle) for angle in theta2]))
    return result


def few_cases() -> list[Case]:
    return cases()[::7]


def names(data: InvertedSliderCrankData) -> tuple[str, ...]:
    return (*EVERYTHING, UNKNOWN[data.drive])


def size(name: str, data: InvertedSliderCrankData, result: dict) -> float:
    """The largest of a quantity's kind."""
    omega = max(abs(data.omega2), abs(result["omega4"]))
    alpha = max(data.omega2**2 + abs(data.alpha2), abs(result["alpha4"]))
    length, force, torque = longest(data), largest_force(result), largest_torque(result, data)
    by_start = {"theta": 180.0, "transmission": 180.0, "omega": omega, "alpha": alpha, "B": length, "R": length}
    by_start |= {"slide_velocity": omega * length, "slide_acceleration": alpha * length, "slide": length}
    by_start |= {"aG": alpha * length, "T": torque, "power": torque * omega}
    by_start |= dict.fromkeys(("F", "cylinder", "friction"), force)
    return float(next(scale for start, scale in by_start.items() if name.startswith(start)))


def worst_error(cycle: xr.Dataset, case: Case, name: str) -> float:
    values = np.broadcast_to(cycle[name].values, len(case.theta2))
    scales = [size(name, case.data, result) for result in case.results]
    errors = [abs(value - float(r[name])) / s for value, r, s in zip(values, case.results, scales, strict=True)]
    return float(np.nan_to_num(errors, nan=np.inf).max())


# ---- against the reference -----


def test_every_number_against_60_digits():
    for case in cases():
        cycle = ls.sweep(to_scene(case.data), case.theta2, of=names(case.data))
        assert not cycle.status.any()
        wrong = {name: error for name in names(case.data) if (error := worst_error(cycle, case, name)) > 1e-11}
        assert not wrong, case.data


def test_dense_solution_against_60_digits():
    for case in few_cases():
        scene = to_scene(case.data)
        expected = (*(name for name in COMPONENTS if name[0] == "F"), "F43n", "T43", UNKNOWN[case.data.drive])
        cycle = ls.sweep(scene, case.theta2, of=(*expected, "cond"), solver="dense")
        assert max(worst_error(cycle, case, name) for name in expected) < 1e-11
        page = ls.system(scene, case.theta2)
        assert page.matrix.shape == (4, 9, 9)
        for k, result in enumerate(case.results):
            solution = np.array([float(result[name]) for name in page.unknown.values])
            matrix, rhs = page.matrix.values[k], page.rhs.values[k]
            assert np.all(np.abs(matrix @ solution - rhs) <= 1e-11 * (np.abs(matrix) @ np.abs(solution)).max())


def test_sweep_balances_power():
    for case in cases():
        cycle = ls.sweep(to_scene(case.data), case.theta2, of=["power_residual"])
        assert np.all(np.abs(cycle.power_residual) < 1e-12)


def test_close_to_a_toggle():
    """B passes 1e-4 and less of the ground from D: the block's place is known to all digits, however short D-B."""
    for gap, angle in product((1e-4, 1e-7), (0.0, 0.003)):
        data = InvertedSliderCrankData(LinkData(1.0 - gap, 0.0, 0.0), LinkData(1.0, 0.0, 0.0), 1.0, 1.0, omega2=1.0)
        result = solve(data, angle)
        cycle = ls.sweep(to_scene(data), [angle], of=["slide", "omega4", "slide_velocity"])
        for name in ("slide", "omega4", "slide_velocity"):
            assert abs(cycle[name].item() - float(result[name])) <= 1e-14 * max(abs(float(result[name])), gap)


# ---- status -----


def assembles(data: InvertedSliderCrankData, theta2: float) -> bool:
    try:
        motion(data, theta2)
    except Unassemblable:
        return False
    return True


def test_status_at_every_sample():
    grid = np.arange(72) * 5.0
    for case in cases()[::3]:
        data = replace(case.data, ground_angle=case.data.ground_angle + 0.123)  # no sample at a limit
        cycle = ls.sweep(to_scene(data), grid)
        expected = [0 if assembles(data, angle) else 1 for angle in grid]
        np.testing.assert_array_equal(cycle.status.values, expected)
        for name in ("theta4", "F43n", UNKNOWN[data.drive]):
            np.testing.assert_array_equal(np.isnan(np.broadcast_to(cycle[name], 72)), cycle.status.values != 0)


@pytest.mark.parametrize(
    ("offset", "ground", "theta2"),
    [(0.0, 3.0, 0.0), (1.0, 2.0, 0.0), (-1.0, 2.0, 0.0), (-5.0, 2.0, 180.0), (5.0, 4.0, 90.0), (-5.0, 4.0, 270.0)],
)
@pytest.mark.parametrize("ground_angle", [0.0, 33.0, -120.0, 200.3])
def test_toggle_where_the_line_just_reaches_b(offset, ground, theta2, ground_angle):
    data = pythagoras(ground=ground, offset=offset, ground_angle=ground_angle)
    assert ls.sweep(to_scene(data), [theta2 + ground_angle]).status.item() == 2


def test_dead_centre_of_a_driven_rocker():
    """No torque on the rocker can drive where it turns round; beside it, it can."""
    data = pythagoras(ground=6.0, ground_angle=0.0, drive="rocker")  # sin 30 = 3/6
    cycle = ls.sweep(to_scene(data), [60.0, 60.001, 180.0, 300.0])
    assert cycle.status.values.tolist() == [3, 0, 0, 3]
    assert not ls.sweep(to_scene(replace(data, drive="crank")), [60.0, 300.0]).status.any()


# ---- by hand: crank 3 upright, D four to the left -----


def pythagoras(**changes) -> InvertedSliderCrankData:
    """Massless and turning at 1 rad/s unless changed; D-B is (4, 3)."""
    bars = LinkData(3.0, 0.0, 0.0), LinkData(5.0, 0.0, 0.0)
    data = InvertedSliderCrankData(*bars, ground=4.0, block_mass=0.0, ground_angle=180.0, omega2=1.0)
    return replace(data, **changes)


def test_kinematics_by_hand():
    """Line (4, 3)/5 through D: omega4 = v.n/5 with v = (-3, 0)."""
    expected = {"omega4": 0.36, "alpha4": -0.1344, "slide": 5.0, "slide_velocity": -2.4, "slide_acceleration": -1.152}
    expected |= {"theta4": np.degrees(np.arctan2(3, 4)), "transmission_angle": 90.0, "aG4x": 0.0, "Bx": 0.0, "By": 3.0}
    cycle = ls.sweep(to_scene(pythagoras()), [90.0], of=tuple(expected))
    for name, value in expected.items():
        assert abs(cycle[name].item() - value) <= 1e-15 * max(1.0, abs(value)), name
        assert abs(float(solve(pythagoras(), 90.0)[name]) - value) <= 1e-15 * max(1.0, abs(value)), name


BY_HAND = [  # offset, omega4, normal force for 10 N m on the rocker, line's angle
    (0.0, 0.36, 2.0, np.degrees(np.arctan2(3, 4))),
    (3.0, 0.0, 2.5, 0.0),
    (-3.0, 0.72, 2.5, np.degrees(np.arctan2(24, 7))),
]


@pytest.mark.parametrize(("offset", "omega4", "normal", "theta4"), BY_HAND)
@pytest.mark.parametrize("link", ["rocker", "block"])
def test_statics_by_hand(offset, omega4, normal, theta4, link):
    """The normal force on the lever s answers 10 N m, on the block through T43; the crank does the opposite work."""
    data = pythagoras(offset=offset, loads=(LoadData(link, torque=10.0),))
    cycle = ls.sweep(to_scene(data), [90.0])
    n = np.array([-np.sin(np.radians(theta4)), np.cos(np.radians(theta4))])
    expected = {"F43n": normal, "T43": -10.0 if link == "block" else 0.0, "T12": -10.0 * omega4, "theta4": theta4}
    expected |= {
        f"F{ij}{axis}": sign * normal * part
        for ij, sign in (("43", 1), ("32", 1), ("14", 1), ("12", -1))
        for axis, part in zip("xy", n, strict=True)
    }
    for name, value in expected.items():
        assert abs(cycle[name].item() - value) <= 1e-14 * max(10.0, abs(value)), name
        assert abs(float(solve(data, 90.0)[name]) - value) <= 1e-14 * max(10.0, abs(value)), name


def test_axes_of_the_block_are_the_rockers():
    """7 N along the line are the crank's and the drive's alone: nothing presses on the rocker; 3 N across do."""
    along = ls.sweep(to_scene(pythagoras(loads=(LoadData("block", force=(7.0, 0.0), frame="link"),))), [90.0])
    assert abs(along.F43n.item()) < 1e-14 and abs(along.F14x.item()) < 1e-14
    assert abs(along.T12.item() - 2.4 * 7.0) < 1e-14
    across = ls.sweep(to_scene(pythagoras(loads=(LoadData("block", (0.0, 3.0), (2.0, 0.0), "link"),))), [90.0])
    assert abs(across.T43.item() + 6.0) < 1e-14 and abs(across.F43n.item() - 1.2) < 1e-14


# ---- the same numbers, however computed -----


@pytest.mark.parametrize("drive", long_but(DRIVES, "crank"))
def test_compiled_and_interpreted_agree_to_the_bit(drive, monkeypatch):
    count = 60
    rng = np.random.default_rng(5)
    length, ground, offset, speed = (
        xr.DataArray(rng.uniform(*bounds, count), dims="design")
        for bounds in ((0.1, 1), (0.1, 1), (-0.5, 0.5), (-9, 9))
    )
    crank, rocker = ls.Link(length, 2.0, 0.02, 0.1, 33.0), ls.Link(1.2, 3.0, 0.4, 0.5, -12.0)
    machine = ls.InvertedSliderCrank(crank, rocker, ground, 0.7, 0.01, offset, "both", 25.0)
    loads = [ls.Load("block", (3.0, -2.0), (0.1, 5.0), "link"), ls.Load("rocker", (1.0, 5.0), (1.2, 0.0), torque=2.0)]
    scene = ls.Scene(machine, omega2=speed, alpha2=3.0, gravity=(0.3, -9.81), loads=loads, drive=drive)
    cycles = []
    for after in (-1, np.inf):
        monkeypatch.setattr(run, "COMPILE_AFTER", after)
        cycles.append(ls.sweep(scene, 48, of=(*EVERYTHING, "power_residual")))
    compiled, interpreted = cycles
    assert set(np.unique(compiled.status)) >= {0, 1}
    for name in compiled.data_vars:
        np.testing.assert_array_equal(compiled[name].values, interpreted[name].values, err_msg=name)


def swept(data: InvertedSliderCrankData, theta2) -> xr.Dataset:
    """Everything by position along theta2."""
    return ls.sweep(to_scene(data), theta2, of=names(data)).drop_vars("theta2")


def assert_bits(result: xr.Dataset, expected: xr.Dataset) -> None:
    for name in expected.data_vars:
        np.testing.assert_array_equal(result[name].values, expected[name].values, err_msg=name)


def mirrored(data: InvertedSliderCrankData) -> InvertedSliderCrankData:
    """Return the machine in a mirror along x: the offset changes sides, the branch does not."""

    def load(one):
        (Fx, Fy), (distance, angle) = one.force, one.at
        return replace(one, force=(Fx, -Fy), at=(distance, -angle), torque=-one.torque)

    bars = {name: replace(getattr(data, name), cg_angle=-getattr(data, name).cg_angle) for name in ("crank", "rocker")}
    turned = {name: -getattr(data, name) for name in ("offset", "ground_angle", "omega2", "alpha2", "block_cg_angle")}
    gravity = data.gravity[0], -data.gravity[1]
    return replace(data, **bars, **turned, gravity=gravity, loads=tuple(map(load, data.loads)))


@pytest.mark.parametrize("some", long_but([few_cases, cases], few_cases))
def test_mirror(some):
    """Angles, rates, torques, normal force and y turn their signs; not a bit changes otherwise."""
    turned = {*ANGLES, *RATES, "F43n", "T43", "T12", "T14"}
    turned |= {name for name in (*COMPONENTS, *ARMS) if name.endswith("y")}
    for case in some():
        expected = swept(case.data, case.theta2).map(lambda x: -x if x.name in turned else x)
        assert_bits(swept(mirrored(case.data), [-angle for angle in case.theta2]), expected)


@pytest.mark.parametrize(("metre", "kilogram"), [(2.0**10, 1.0), (2.0**-20, 2.0**7), (1.0, 2.0**-9)])
def test_units(metre, kilogram):
    """Units that are powers of two of others: exponents change, and not a bit besides."""
    newton, joule = metre * kilogram, metre * metre * kilogram
    factors = {"B": metre, "R": metre, "slide": metre, "aG": metre, "F": newton, "cylinder": newton}
    factors |= {"T": joule, "power": joule}
    for case in few_cases():
        data = case.data
        bars = {
            name: replace(
                bar,
                length=bar.length * metre,
                mass=bar.mass * kilogram,
                inertia=bar.inertia * joule,
                cg_distance=bar.cg_distance * metre,
            )
            for name in ("crank", "rocker")
            for bar in [getattr(data, name)]
        }
        loads = tuple(
            replace(
                one,
                force=(one.force[0] * newton, one.force[1] * newton),
                at=(one.at[0] * metre, one.at[1]),
                torque=one.torque * joule,
            )
            for one in data.loads
        )
        scaled = replace(
            data,
            **bars,
            loads=loads,
            ground=data.ground * metre,
            offset=data.offset * metre,
            block_mass=data.block_mass * kilogram,
            block_inertia=data.block_inertia * joule,
            block_cg_distance=data.block_cg_distance * metre,
            gravity=(data.gravity[0] * metre, data.gravity[1] * metre),
        )

        def by_kind(x):
            return x * next((factor for start, factor in factors.items() if x.name.startswith(start)), 1.0)

        assert_bits(swept(scaled, case.theta2), swept(data, case.theta2).map(by_kind))


def test_both_branches_and_the_line_reversed():
    """branch="both" holds each; without offset the crossed one is the open one with its line reversed."""
    data = replace(cases()[0].data, drive="crank", loads=())
    for offset in (0.0, data.offset):
        one = {branch: swept(replace(data, offset=offset, branch=branch), 24) for branch in BRANCHES}
        both = swept(replace(data, offset=offset, branch="both"), 24)
        for branch in BRANCHES:
            result = both.sel(branch=branch)
            for name in one[branch].data_vars:
                expected = one[branch][name].values
                np.testing.assert_array_equal(
                    np.broadcast_to(result[name].values, expected.shape), expected, err_msg=name
                )
    opened, crossed = (swept(replace(data, offset=0.0, branch=branch), 24) for branch in BRANCHES)
    assert np.allclose(np.abs(opened.theta4 - crossed.theta4), 180.0, rtol=0.0, atol=1e-12)
    np.testing.assert_array_equal(opened.omega4, crossed.omega4)
    np.testing.assert_array_equal(opened.slide, -crossed.slide)


def test_random_scenes_cover_what_they_promise():
    scenes = [case.data for case in cases()]
    assert {(kind_of(s.crank.length, s.ground, s.offset), s.branch, s.drive) for s in scenes} == set(
        product(KINDS, BRANCHES, DRIVES)
    )
    assert {np.sign(s.offset) for s in scenes} == {-1, 0, 1} == {np.sign(s.omega2) for s in scenes} | {0}
    assert {load.link for s in scenes for load in s.loads} == set(LINKS)
    assert min(s.ground for s in scenes) < 1e-4 and max(s.ground for s in scenes) > 10
    assert all(toggle_margin(case.data, angle) > 0.1 for case in cases() for angle in case.theta2)
