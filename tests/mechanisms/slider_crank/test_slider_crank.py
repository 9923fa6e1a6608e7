"""Every number of random slider-cranks against 60-digit arithmetic with both signs of the guide's force tried.

Errors are relative to the largest of their kind at the same position, as in `test_accuracy`.
"""

from dataclasses import replace
from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np
import pytest
import xarray as xr
from long import long_but
from oracle import torque_name
from oracle_slider_crank import (
    DRIVES,
    KINDS,
    Jammed,
    SliderCrankData,
    TwoSolutions,
    largest_torque,
    random_data,
    random_theta2,
    solve,
    to_scene,
    toggle_margin,
)
from references import BRANCHES, DeadPoint, LinkData, LoadData, Unassemblable, largest_force, mp
from stacked import assert_each_is_as_alone, stacked

import linksweep as ls
from linksweep.engine import run
from linksweep.results.compute import compute

EPS = float(np.finfo(float).eps)
KINEMATICS = ("theta3", "omega3", "alpha3", "x_slider", "v_slider", "a_slider", "transmission_angle")
PLACES = ("Bx", "By", "Cx", "Cy", "aG2x", "aG2y", "aG3x", "aG3y", "aG4x", "aG4y")
ARMS = tuple(f"R{pair}{axis}" for pair in (12, 32, 23, 43, 34) for axis in "xy")
PINS = ("F12", "F32", "F43", "F14")
FORCES = tuple(pin + part for pin in PINS for part in ("x", "y", ""))
REACTIONS = {f"F{name[2]}{name[1]}{name[3:]}": name for name in FORCES}
GUIDE = ("T14", "normal_force", "friction_force", "friction_power")


class Case(NamedTuple):
    """A random scene, crank angles [degree], and the reference results, rounded once."""

    data: SliderCrankData
    theta2: list[float]
    results: dict[str, np.ndarray]


def unknowns(data: SliderCrankData) -> tuple[str, ...]:
    return (*(pin + axis for pin in PINS for axis in "xy"), torque_name(data))


def all_names(data: SliderCrankData) -> tuple[str, ...]:
    return (*KINEMATICS, *PLACES, *ARMS, *FORCES, *REACTIONS, *GUIDE, torque_name(data), "power")


def reference_results(data: SliderCrankData, theta2: float) -> dict:
    """Return the reference results, which name one of action and reaction and count lost power as positive."""
    result = solve(data, theta2)
    result |= {back: -result[name] if name[3:] else result[name] for back, name in REACTIONS.items()}
    sizes = {"largest_force": largest_force(result), "largest_torque": largest_torque(result, data)}
    return result | sizes | {"friction_power": -result["friction_power"]}


def random_case(rng: np.random.Generator, angles: int, **parameters) -> Case:
    """Angles away from toggles (sines above 0.1), dead centres and the edge of wedging, and not jammed."""
    data = random_data(rng, **parameters)
    return solved(data, [random_theta2(rng, data, jammed=False) for _ in range(angles)])


def solved(data: SliderCrankData, theta2: list[float]) -> Case:
    results = [reference_results(data, angle) for angle in theta2]
    return Case(data, theta2, {name: np.array([float(one[name]) for one in results]) for name in results[0]})


@cache
def cases() -> list[Case]:
    """72 scenes: nine of each kind, branch and drive; two thirds with friction up to 0.8."""
    rng = np.random.default_rng(1)
    sorts = product(KINDS, BRANCHES, DRIVES, (0.0, 0.1, 0.8) * 3)
    return [
        random_case(rng, 3, kind=kind, branch=branch, drive=drive, friction=float(rng.uniform(0, 1) * most))
        for kind, branch, drive, most in sorts
    ]


def scales(case: Case) -> dict[str, np.ndarray]:
    """The largest of each kind at each angle, by how the names of the kind begin."""
    data, results = case.data, case.results
    omega = np.maximum(abs(data.omega2), np.abs(results["omega3"]))
    alpha = np.maximum(data.omega2**2 + abs(data.alpha2), np.abs(results["alpha3"]))
    longest = np.full_like(omega, max(data.crank.length, data.rod.length, abs(data.offset)))
    force, torque = results["largest_force"], results["largest_torque"]
    result = {"theta": np.full_like(omega, 180.0), "transmission": np.full_like(omega, 180.0)}
    result |= {"omega": omega, "alpha": alpha, "aG": alpha * longest, "B": longest, "C": longest, "R": longest}
    result |= {"x_": longest, "v_": omega * longest, "a_": alpha * longest}
    return result | {"F": force, "normal": force, "friction_force": force, "T": torque, "": torque * omega}


def errors(cycle: xr.Dataset, names: tuple[str, ...], case: Case) -> dict[str, float]:
    """Largest relative error of each quantity over the angles; NaN counts as infinite."""
    by_kind, result = scales(case), {}
    for name in names:
        size = next(size for start, size in by_kind.items() if name.startswith(start))
        error = np.abs(cycle[name].broadcast_like(cycle.theta2).values - case.results[name]) / size
        result[name] = float(np.nan_to_num(error, nan=np.inf).max())
    return result


def worst(scenes: list[dict[str, float]]) -> dict[str, float]:
    return {name: max(scene.get(name, 0.0) for scene in scenes) for scene in scenes for name in scene}


def test_fast_path_agrees_with_the_reference():
    """Promised: 1e-11. Reached: 2e-13 on 3000 positions, less on these."""
    result = []
    for case in cases():
        names = all_names(case.data)
        cycle = ls.sweep(to_scene(case.data), theta2=case.theta2, of=names)
        assert not cycle.status.any(), case
        result.append(errors(cycle, names, case))
    assert max(worst(result).values()) < 1e-11, worst(result)


def test_power_balances_at_every_sample():
    """Drive, friction, loads, gravity and inertia, of which none knows of the others."""
    for case in cases():
        cycle = ls.sweep(to_scene(case.data), theta2=case.theta2, of=["power_residual", "friction_power"])
        assert abs(cycle.power_residual).max() < 1e-12, case
        assert (cycle.friction_power <= 0.0).all()


def test_dense_path_agrees_with_the_reference_and_with_the_fast_path():
    result = []
    for case in cases()[::2]:
        names = unknowns(case.data)
        dense = ls.sweep(to_scene(case.data), case.theta2, of=[*names, "cond"], solver="dense")
        fast = ls.sweep(to_scene(case.data), case.theta2, of=names)
        for name in names:
            size = case.results["largest_torque" if name.startswith("T") else "largest_force"]
            assert (abs(dense[name] - fast[name]) / size <= np.minimum(1e-10, EPS * dense.cond)).all(), (name, case)
        assert any((dense[name] != fast[name]).any() for name in names)  # or one stands in for the other
        result.append(errors(dense, names, case))
    assert max(worst(result).values()) < 1e-11, worst(result)


def near_toggles(data: SliderCrankData) -> list[float]:
    """Crank angles from 1e-2 to 1e-10 degree inside each limit of assembly: the crank's height e ± b, in 60 digits."""
    a, b, e = map(mp.mpf, (data.crank.length, data.rod.length, data.offset))
    result = []
    for height, inwards in ((e + b, -1), (e - b, 1)):
        if abs(height) < a:
            limit = mp.degrees(mp.asin(height / a))
            result += [float(limit + inwards * mp.mpf(10) ** -k) for k in (2, 4, 6, 8, 10)]
    return result


@pytest.mark.parametrize("seed", range(8))
def test_errors_near_a_toggle_grow_as_they_must(seed):
    """An angle of θ2 known to ε leaves ε/μ in θ3, and ε/μ² in rates and forces; μ down to 1e-6 here."""
    data = random_data(np.random.default_rng(seed), kind="limited", drive="crank", scale=1.0, loads=1, friction=0.0)
    data = replace(data, slide_angle=0.0)
    names = (*KINEMATICS, *unknowns(data))
    assert near_toggles(data)
    for angle in near_toggles(data):
        mu = toggle_margin(data, angle)
        assert 0.0 < mu < 0.2
        case = solved(data, [angle])
        cycle = errors(ls.sweep(to_scene(data), [angle], of=names), names, case)
        for name, error in cycle.items():
            allowed = 40.0 * EPS / mu if name in ("theta3", "transmission_angle", "x_slider") else 400.0 * EPS / mu**2
            assert error < allowed, (name, error / EPS, mu)


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize("miss", [2.0**-20, 2.0**-30, 2.0**-40])
@pytest.mark.parametrize(("offset", "square"), [(2.0, 270.0), (-2.0, 90.0)])
def test_near_a_fold_no_digit_is_lost(offset, square, miss, branch):
    """Crank 3, offset 2, a rod of 5 but for a trifle: where it stands all but square to the guide."""
    links = (LinkData(length, 1.0, 0.1, cg_distance=0.4, cg_angle=20.0) for length in (3.0, 5.0 + miss))
    data = SliderCrankData(*links, 1.0, offset=offset, branch=branch, omega2=3.0, gravity=(0.0, -9.81))
    names = (*KINEMATICS, *unknowns(data))
    assert 0.0 < toggle_margin(data, square) < 2e-3
    cycle = errors(ls.sweep(to_scene(data), [square], of=names), names, solved(data, [square]))
    assert max(cycle.values()) < 1e-13, cycle


# ---- status -----


def reference_status(data: SliderCrankData, theta2: float) -> str:
    try:
        solve(data, theta2)
    except Unassemblable:
        return "cannot_assemble"
    except DeadPoint:
        return "dead_centre"
    except Jammed:
        return "jammed"
    except TwoSolutions:
        return "jammed_two_solutions"
    return "ok"


def meanings(status: xr.DataArray) -> list[str]:
    words = status.attrs["flag_meanings"].split()
    return [words[k] for k in status.values]


@cache
def jamming() -> dict[str, list[SliderCrankData]]:
    """Designs with friction for each drive, each on one branch; loads of the same forms for all."""
    rng = np.random.default_rng(5)
    return {drive: [loaded(random_data(rng, drive=drive, loads=0), rng) for _ in range(12)] for drive in DRIVES}


def loaded(data: SliderCrankData, rng: np.random.Generator) -> SliderCrankData:
    """A load on every link, random numbers in fixed forms on the scale of the inertia forces; more friction."""
    length = data.rod.length
    force = data.rod.mass * data.omega2**2 * length
    fx, fy, gx, gy, px, py, moment, torque = (float(x) for x in rng.uniform(-2, 2, 8) * force)
    loads = (
        LoadData("crank", (fx, fy), at=(0.5 * length, float(rng.uniform(-180, 180))), torque=moment * length),
        LoadData("rod", (gx, gy), at=(length, 30.0), frame="link", origin="cg"),
        LoadData("slider", (px, py), at=(0.3 * length, 80.0), frame="link"),
        LoadData("slider", torque=torque * length),
    )
    return replace(data, loads=loads, friction=float(rng.uniform(0.2, 1.5)), slider_cg_distance=0.1 * length)


FRAME = ("slider_mass", "offset", "friction", "slide_angle", "slider_cg_distance", "slider_cg_angle")
BATCH = (ls.SliderCrank, ("crank", "rod"), *FRAME)


@pytest.mark.parametrize("drive", DRIVES)
def test_status_is_right_at_every_sample(drive):
    """Alone and in a batch, where a jammed sample spoils no other."""
    designs, theta2 = jamming()[drive], np.random.default_rng(2).uniform(-180, 540, 9)
    batch = ls.sweep(stacked(designs, *BATCH), theta2, of=["F14x", "status"])
    seen = set()
    for k, data in enumerate(designs):
        expected = [reference_status(data, angle) for angle in theta2]
        alone = ls.sweep(to_scene(data), theta2, of=["F14x", "status"])
        together = batch.isel(design=k).sel(branch=data.branch)
        for result in (alone, together):
            assert meanings(result.status) == expected, data
            np.testing.assert_array_equal(np.isnan(result.F14x), [word != "ok" for word in expected])
        seen.update(expected)
    assert seen == {"ok", "jammed", "jammed_two_solutions", "cannot_assemble"}


@pytest.mark.parametrize("drive", long_but(DRIVES, "crank"))
def test_compiled_batch_has_the_bits_of_interpreted_single_designs(drive, monkeypatch):
    """With friction, also among jammed samples and those that cannot be assembled."""
    designs, theta2 = jamming()[drive][:6], np.random.default_rng(2).uniform(-180, 540, 11)
    names = (*KINEMATICS, *unknowns(designs[0]), *GUIDE, "F32", "Bx", "aG4x", "power_residual")
    monkeypatch.setattr(run, "COMPILE_AFTER", -1)
    batch = ls.sweep(stacked(designs, *BATCH), theta2, of=names)
    monkeypatch.setattr(run, "COMPILE_AFTER", np.inf)
    assert {0, 1, 4} <= set(batch.status.values.flat)
    assert_each_is_as_alone(batch, designs, to_scene, names)


def plain(rod=5.0, **changes) -> ls.Scene:
    """Crank 3 m, rod 5 m, in line, unless changed."""
    state = {name: changes.pop(name) for name in ("drive", "loads", "omega2") if name in changes}
    crank, rod = ls.Link(3.0, 2.0, 1.0, 1.0, 40.0), ls.Link(rod, 3.0, 2.0, 2.0, -15.0)
    return ls.Scene(ls.SliderCrank(crank, rod, 1.5, **changes), **{"omega2": 2.0, "gravity": (0.5, -9.81)} | state)


@pytest.mark.parametrize("slide_angle", [0.0, 25.0, -90.0])
def test_toggles_and_gaps(slide_angle):
    """Rod 2, guide 5 m off: B reaches to 2 m, a rod, at the top alone; and a rod that is as long as the crank."""
    touch = plain(rod=2.0, offset=5.0, slide_angle=slide_angle)
    theta2 = [90.0 + slide_angle, 89.0 + slide_angle, 270.0 + slide_angle]
    assert meanings(ls.sweep(touch, theta2).status) == ["toggle", "cannot_assemble", "cannot_assemble"]
    equal = plain(rod=3.0, slide_angle=slide_angle)
    assert meanings(ls.sweep(equal, theta2).status) == ["toggle", "ok", "toggle"]
    short = plain(rod=2.0, slide_angle=slide_angle)
    beyond = float(np.degrees(np.arcsin(2 / 3)))
    theta2 = [sign * beyond + slide_angle + aside for sign, aside in product((1, -1), (-1e-9, 1e-9))]
    assert meanings(ls.sweep(short, theta2).status) == ["ok", "cannot_assemble", "cannot_assemble", "ok"]


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("slide_angle", [0.0, 17.0])
def test_a_rod_that_does_not_turn_cannot_drive(friction, slide_angle):
    """The crank stands square to the guide."""
    scene = plain(drive="coupler", friction=friction, slide_angle=slide_angle)
    status = ls.sweep(scene, [90.0 + slide_angle, 20.0 + slide_angle, 270.0 + slide_angle]).status
    assert meanings(status) == ["dead_centre", "ok", "dead_centre"]


@pytest.mark.parametrize("slide_angle", [0.0, 33.0, -71.3])
@pytest.mark.parametrize(("offset", "dead"), [(0.0, (0.0, 180.0)), (1.0, None), (-1.0, None)])
@pytest.mark.parametrize("branch", BRANCHES)
def test_no_friction_where_the_slider_stands(slide_angle, offset, dead, branch):
    """Rod in line with the crank: 0 at the sample, full friction of opposite signs on either side."""
    stretched, folded = (float(np.degrees(np.arcsin(offset / reach))) for reach in (8.0, 2.0))
    dead = dead or ((stretched, 180.0 + folded) if branch == "open" else (180.0 - stretched, -folded))
    scene = plain(offset=offset, slide_angle=slide_angle, friction=0.2, branch=branch)
    for angle in dead:
        beside = np.array([-1e-9, 0.0, 1e-9]) + angle + slide_angle
        names = ["friction_force", "normal_force", "v_slider", "F14x", "F14y"]
        before, there, after = ls.sweep(scene, beside, of=names).transpose("theta2").to_dataframe().itertuples()
        assert there.friction_force == 0.0
        assert abs(there.normal_force) == pytest.approx(np.hypot(there.F14x, there.F14y), rel=1e-14)
        assert np.sign(before.friction_force) == -np.sign(after.friction_force) != 0.0
        for side in (before, after):
            assert side.friction_force == -0.2 * abs(side.normal_force) * np.sign(side.v_slider)


def test_a_crank_that_stands_feels_no_friction():
    """Statics with omega2 = 0: nothing slides, nothing jams, whatever the friction."""
    names = [*unknowns(random_data(np.random.default_rng(0), drive="crank")), "status"]
    rough, smooth = (ls.sweep(plain(omega2=0.0, friction=mu), 48, of=names) for mu in (5.0, 0.0))
    assert not rough.status.any()
    for name in names:
        np.testing.assert_array_equal(rough[name], smooth[name])


def test_friction_at_the_quarter_turn_by_hand():
    """Crank 4 upright, rod (3, -4), slider towards A, P = ±5 N: T12 = 4·P/(1 ∓ 4μ/3)."""
    bars, mu = (ls.Link(4.0, 0.0, 0.0), ls.Link(5.0, 0.0, 0.0)), 0.25
    for P in (5.0, -5.0):
        scene = ls.Scene(ls.SliderCrank(*bars, 0.0, friction=mu), 2.0, loads=[ls.Load("slider", force=(P, 0.0))])
        cycle = ls.sweep(scene, [90.0], of=["T12", "F14x", "F14y", "T14", "friction_power"]).isel(theta2=0)
        pull = P / (1 - np.sign(P) * mu * 4 / 3)
        across = 4 * pull / 3
        expected = {"T12": 4 * pull, "F14y": -across, "F14x": mu * abs(across), "T14": 0.0}
        for name, value in (expected | {"friction_power": -8 * mu * abs(across)}).items():
            assert cycle[name].item() == pytest.approx(value, rel=1e-14), name


@pytest.mark.parametrize("rod", [3.0, 3.5, 2.5])
@pytest.mark.parametrize("drive", DRIVES)
def test_a_peak_is_that_of_a_sample_that_moves(rod, drive):
    """Nothing is known while friction wedges the slider; the crank's own length is a rod that folds over it."""
    scene = plain(rod=rod, offset=0.25, friction=0.9, drive=drive)
    torque = scene.mechanism.drives[drive]
    assert {"ok", "jammed"} <= set(meanings(ls.sweep(scene, 360, of=["status"]).status))
    worst = ls.peaks(scene, of=[torque, "F14"], theta2=360)
    for name, quantity in ((f"{torque}_max", torque), (f"{torque}_min", torque), ("F14_peak", "F14")):
        there = ls.sweep(scene, [worst[f"{name}_at"].item()], of=[quantity])
        assert meanings(there.status) == ["ok"], name
        assert worst[name].item() == pytest.approx(there[quantity].item(), rel=1e-9), name


@pytest.mark.parametrize("angle", [0.0, 23.0])
def test_a_rod_far_shorter_than_the_crank_is_rigid(angle):
    """Its component across the guide is a difference of far larger numbers: 1e-11 of the rod once was rounding."""
    machine = ls.SliderCrank(ls.Bar(0.7, 0.01, 0.01, 7850.0), ls.Link(2e-5, 1.0, 1e-10), 0.5, offset=0.4)
    machine = replace(machine, slide_angle=angle)
    reach = np.degrees(np.arcsin((0.4 + 2e-5 * np.linspace(-0.99, 0.99, 50)) / 0.7)) + angle
    scene = ls.Scene(machine, omega2=10.0)
    grid = scene.grid(reach)
    status, x, y = (compute(scene.at(grid), grid, (name,))[name].values for name in ("status", "r3x", "r3y"))
    assert not status.any()
    np.testing.assert_allclose(np.hypot(x, y), 2e-5, rtol=4.0 * EPS)
