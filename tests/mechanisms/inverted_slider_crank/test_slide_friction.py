"""Friction in the slide of an inverted slider-crank, against 60 digits, by hand, in limits, and as laws ask."""

from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
import pytest
import xarray as xr
from oracle_inverted_slider_crank import (
    DRIVES,
    KINDS,
    UNKNOWN,
    InvertedSliderCrankData,
    random_data,
    random_rubbing_theta2,
    solve,
    to_scene,
)
from oracle_slider_crank import Jammed, TwoSolutions
from references import BRANCHES, FORCES, LoadData
from test_inverted_slider_crank import Case, assert_bits, mirrored, pythagoras, worst_error

import linksweep as ls
from linksweep.engine import run

COMPONENTS = tuple(force + axis for force in FORCES for axis in "xy")
FORCES_OF_SLIDE = ("F43n", "T43", "friction_force")
JAM = {Jammed: 4, TwoSolutions: 6}


def names(data: InvertedSliderCrankData) -> tuple[str, ...]:
    return (*COMPONENTS, *FORCES, *FORCES_OF_SLIDE, "power", UNKNOWN[data.drive])


@cache
def cases() -> list[Case]:
    """72 scenes: four of each kind, branch and drive, at angles where nothing jams."""
    rng, drawn = np.random.default_rng(31), []
    for kind, branch, drive, _ in product(KINDS, BRANCHES, DRIVES, range(4)):
        data = random_data(rng, kind=kind, branch=branch, drive=drive, friction=float(rng.uniform(0.05, 0.6)))
        theta2 = [random_rubbing_theta2(rng, data) for _ in range(3)]
        drawn.append(Case(data, theta2, [solve(data, angle) for angle in theta2]))
    return drawn


def test_every_force_against_60_digits():
    for case in cases():
        cycle = ls.sweep(to_scene(case.data), case.theta2, of=(*names(case.data), "friction_power"))
        assert not cycle.status.any()
        wrong = {name: error for name in names(case.data) if (error := worst_error(cycle, case, name)) > 1e-11}
        assert not wrong, case.data
        np.testing.assert_allclose(cycle.friction_power, cycle.friction_force * cycle_velocity(case), rtol=1e-12)


def cycle_velocity(case: Case) -> list[float]:
    return [float(result["slide_velocity"]) for result in case.results]


def test_the_square_system_against_60_digits():
    for case in cases()[::3]:
        scene = to_scene(case.data)
        quantities = (*COMPONENTS, "F43n", "T43", UNKNOWN[case.data.drive])
        dense = ls.sweep(scene, case.theta2, of=quantities, solver="dense")
        assert max(worst_error(dense, case, name) for name in quantities) < 1e-11
        page = ls.system(scene, case.theta2)
        assert page.matrix.shape == (3, 9, 9)
        for k, result in enumerate(case.results):
            solution = np.array([float(result[name]) for name in page.unknown.values])
            matrix, rhs = page.matrix.values[k], page.rhs.values[k]
            assert np.all(np.abs(matrix @ solution - rhs) <= 1e-11 * (np.abs(matrix) @ np.abs(solution)).max())


def test_powers_balance_and_friction_only_takes():
    for case in cases():
        cycle = ls.sweep(to_scene(case.data), 36, of=["power_residual", "friction_power"])
        ok = cycle.status == 0
        assert (abs(cycle.power_residual.where(ok, 0.0)) < 1e-11).all()
        assert (cycle.friction_power.where(ok, 0.0) <= 0.0).all()


# ---- by hand: D-B is (4, 3), the block moves towards D -----


@pytest.mark.parametrize(("offset", "lever"), [(0.0, 5.0), (3.0, 4.0), (-3.0, 4.0)])
@pytest.mark.parametrize("torque", [10.0, -10.0])
@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_the_normal_force_under_a_torque_on_the_rocker(offset, lever, torque, turn):
    """s·N − e·f = −M: friction opposes the block's way, and with an offset changes the normal force itself."""
    mu, v = 0.25, -turn  # towards D while the crank turns counter-clockwise
    scene = to_scene(pythagoras(offset=offset, omega2=turn, friction=mu, loads=(LoadData("rocker", torque=torque),)))
    cycle = ls.sweep(scene, [90.0])
    plain = torque / lever
    normal = plain / (1.0 + np.sign(plain) * mu * v * offset / lever)
    assert cycle.F43n.item() == pytest.approx(normal, rel=1e-14)
    along = ls.sweep(scene, [90.0], of=["friction_force"]).friction_force.item()
    assert along == pytest.approx(-mu * abs(normal) * v, rel=1e-14)
    assert lever * normal - offset * along == pytest.approx(torque, rel=1e-14)


@pytest.mark.parametrize("pull", [8.0, -8.0])
def test_a_driven_rocker_pulls_the_crank_through_friction(pull):
    """8 N m on the crank (0, 3), line (4, 3)/5: N·9/5 − f·12/5 = −8, T14 as the powers balance."""
    mu = 0.25
    data = pythagoras(friction=mu, drive="rocker", loads=(LoadData("crank", torque=pull),))
    cycle = ls.sweep(to_scene(data), [90.0], of=["F43n", "friction_force", "T14", "omega4", "slide_velocity"])
    normal, along = cycle.F43n.item(), cycle.friction_force.item()
    assert along == pytest.approx(mu * abs(normal), rel=1e-14)  # the block moves towards D
    assert 1.8 * normal - 2.4 * along == pytest.approx(-pull, rel=1e-14)
    fed = cycle.T14 * cycle.omega4 + pull * 1.0 + along * cycle.slide_velocity
    assert fed.item() == pytest.approx(0.0, abs=1e-13)


def test_a_cylinder_overcomes_friction_and_no_pin_feels_it():
    smooth = replace(cases()[0].data, drive="cylinder", friction=0.0)
    theta2 = cases()[0].theta2
    quantities = (*COMPONENTS, "F43n", "T43")
    rough = ls.sweep(to_scene(replace(smooth, friction=5.0)), theta2, of=(*quantities, "friction_force"))
    plain = ls.sweep(to_scene(smooth), theta2, of=quantities)
    assert not rough.status.any()
    assert_bits(rough, plain)
    force = [ls.sweep(to_scene(replace(smooth, friction=mu)), theta2).cylinder_force for mu in (0.0, 5.0)]
    np.testing.assert_allclose(force[0] - force[1], rough.friction_force, rtol=1e-9)


# ---- where it wedges -----


def test_status_of_a_wedged_block():
    """Both kinds are met, by crank and by rocker, as the two signs of the normal force have it."""
    rng, met = np.random.default_rng(5), set()
    for drive, branch, _ in product(("crank", "rocker"), BRANCHES, range(6)):
        data = random_data(rng, kind="limited", branch=branch, drive=drive, loads=2, friction=3.0)
        theta2 = random_rubbing_theta2(rng, data, jammed=True)
        with pytest.raises((Jammed, TwoSolutions)) as stuck:
            solve(data, theta2)
        cycle = ls.sweep(to_scene(data), [theta2])
        assert cycle.status.item() == JAM[stuck.type]
        assert np.isnan(cycle.F43n.item()) and np.isnan(cycle.F12x.item())
        met.add((drive, stuck.type))
    assert met == set(product(("crank", "rocker"), JAM))


@pytest.mark.parametrize("ground", [2.0, 6.0])
@pytest.mark.parametrize("drive", ["crank", "rocker"])
@pytest.mark.parametrize("offset", [0.5, -0.5])
def test_jam_angles_are_where_the_status_changes(ground, drive, offset):
    """Just beside each of them the block jams on one side and does not on the other; a toggle is no jam."""
    mu = 2.5
    data = pythagoras(ground=ground, offset=offset, ground_angle=20.0, friction=mu, drive=drive)
    loaded = replace(data, loads=(LoadData("rocker", torque=5.0), LoadData("crank", torque=3.0)))
    checked = ls.check(to_scene(loaded))
    angles = checked.jam_angle.values[np.isfinite(checked.jam_angle.values)]
    grid = np.arange(3600) * 0.1 + 0.05  # no sample at a dead centre, where the block stands and cannot wedge
    jams = ls.sweep(to_scene(loaded), grid).status >= 4
    assert bool(jams.any()) == bool(mu > float(checked.friction_to_jam))
    changes = 0
    for angle in angles:
        beside = ls.sweep(to_scene(loaded), [angle - 1e-6, angle + 1e-6]).status.values >= 4
        changes += beside[0] != beside[1]
    steps = int((jams.astype(int).diff("theta2") != 0).sum()) + int(jams[0] != jams[-1])
    assert changes == steps


@pytest.mark.parametrize(("drive", "ground"), [("crank", 6.0), ("crank", 2.0), ("rocker", 2.0)])
def test_the_least_friction_that_jams(drive, ground):
    data = pythagoras(ground=ground, offset=0.5, drive=drive, loads=(LoadData("rocker", torque=5.0),))
    least = float(ls.check(to_scene(data)).friction_to_jam)
    for factor, jams in ((0.999, False), (1.001, True)):
        cycle = ls.sweep(to_scene(replace(data, friction=factor * least)), 7200)
        assert bool((cycle.status >= 4).any()) == jams


# ---- limits, mirrors, bits -----


def test_peaks_of_many_offsets_are_those_of_each():
    """Friction jumps where the block turns round: at angles of each design, none where the block is out of reach."""
    offsets = [0.01, 0.2, 0.3]
    many, quantities = machine(friction=0.1, offset=xr.DataArray(offsets, dims="offset")), ["F43n", "T12"]
    peaks = ls.peaks(ls.Scene(many, omega2=3.0), of=quantities)
    for k, offset in enumerate(offsets):
        one = ls.peaks(ls.Scene(machine(friction=0.1, offset=offset), omega2=3.0), of=quantities)
        xr.testing.assert_allclose(peaks.isel(offset=k, drop=True), one, rtol=1e-12)


def test_peaks_that_do_not_depend_on_the_frame_lie_at_angles_that_do():
    """The slide is longest where the crank points away from D, whichever way the frame lies."""
    frame = xr.DataArray([0.0, 23.0, -90.0], dims="turned")
    peaks = ls.peaks(ls.Scene(machine(friction=0.0, ground_angle=frame), omega2=3.0), of=["slide"])
    np.testing.assert_allclose(peaks.slide_max, np.sqrt(0.48**2 - 0.04**2), rtol=1e-14)
    np.testing.assert_allclose(peaks.slide_max_at, [180.0, 203.0, 90.0], rtol=0, atol=1e-9)


def test_friction_that_vanishes():
    """Forces tend to those without friction in proportion to it."""
    for case in cases()[::5]:
        quantities = names(case.data)[:-2]
        plain, small, half = (
            ls.sweep(to_scene(replace(case.data, friction=mu)), case.theta2, of=quantities) for mu in (0.0, 1e-6, 5e-7)
        )
        for force in ("F43n", "F32x", "F14y"):
            size = float(np.abs(plain.F32).max())
            slope, again = (small[force] - plain[force]) / 1e-6, (half[force] - plain[force]) / 5e-7
            np.testing.assert_allclose(slope, again, rtol=1e-4, atol=1e-4 * size)


def test_mirror():
    turned = {"F43n", "T43", "T12", "T14", *(name for name in COMPONENTS if name.endswith("y"))}
    for case in cases():
        quantities = names(case.data)
        here = ls.sweep(to_scene(case.data), case.theta2, of=quantities).drop_vars("theta2")
        there = ls.sweep(to_scene(mirrored(case.data)), [-x for x in case.theta2], of=quantities).drop_vars("theta2")
        assert_bits(there, here.map(lambda x: -x if x.name in turned else x))


def test_turned_backwards_friction_turns_its_sign():
    """Massless: N·(1 + k) forwards and N·(1 − k) backwards are the same frictionless normal force."""
    load = LoadData("rocker", torque=7.0)
    data = pythagoras(offset=2.0, friction=0.3, loads=(load,))
    forwards, backwards = (
        ls.sweep(to_scene(replace(data, omega2=w)), 24, of=["F43n", "friction_force"]) for w in (1.0, -1.0)
    )
    plain = ls.sweep(to_scene(replace(data, friction=0.0)), 24).F43n
    ok = (forwards.status == 0) & (forwards.friction_force != 0.0)
    assert float(ok.mean()) > 0.4
    k = (plain / forwards.F43n - 1.0).where(ok)
    np.testing.assert_allclose(plain / backwards.F43n.where(ok), 1.0 - k, rtol=1e-12)
    assert (np.sign(forwards.friction_force) == -np.sign(backwards.friction_force)).where(ok, True).all()


def machine(**changes) -> ls.InvertedSliderCrank:
    crank, rocker = ls.Link(0.12, 2.0, 0.02, 0.03, 33.0), ls.Link(0.7, 18.0, 0.8, 0.35, -12.0)
    return ls.InvertedSliderCrank(crank, rocker, 0.36, 1.5, 0.01, **({"offset": 0.04, "friction": 0.2} | changes))


LOADS = (ls.Load("block", (30.0, -20.0), (0.01, 5.0), "link"), ls.Load("rocker", (50.0, 90.0), (0.7, 0.0)))


def working(drive="crank", **changes) -> ls.Scene:
    return ls.Scene(machine(**changes), omega2=8.0, gravity=(0.0, -9.81), drive=drive, loads=LOADS)


@pytest.mark.parametrize("drive", DRIVES)
def test_batched_and_compiled_bits(drive, monkeypatch):
    """Each design alone, all together, by numpy and compiled."""
    mu, offset = xr.DataArray([0.05, 0.1, 0.9, 8.0], dims="mu"), xr.DataArray([0.0, 0.04, -0.2, 0.3], dims="e")
    quantities = (*COMPONENTS, "F43n", "friction_force", "friction_power", UNKNOWN[drive])
    together = []
    for after in (-1, np.inf):
        monkeypatch.setattr(run, "COMPILE_AFTER", after)
        together.append(ls.sweep(working(drive, friction=mu, offset=offset), 24, of=quantities))
    assert_bits(*together)
    for i, k in product(range(4), range(4)):
        alone = ls.sweep(working(drive, friction=float(mu[i]), offset=float(offset[k])), 24, of=quantities)
        for name in quantities:
            batched = together[0][name]
            at = {dim: index for dim, index in (("mu", i), ("e", k)) if dim in batched.dims}
            np.testing.assert_array_equal(*np.broadcast_arrays(batched.isel(at), alone[name]), err_msg=name)


# ---- what rests on it -----


@pytest.mark.parametrize(("drive", "offset"), [("crank", 0.04), ("crank", -0.1)])
def test_exact_peaks_see_both_sides_of_the_jumps(drive, offset):
    scene = working(drive, offset=offset)
    of = ["F43", "F43n", "T12"]
    exact, fine = ls.peaks(scene, of=of), ls.sweep(scene, 72_000, of=of)
    jumps = scene.mechanism.jumps()
    sides = ls.sweep(scene, [angle + d for angle in jumps for d in (-1e-9, 1e-9)], of=of)
    for name in of:
        sampled = max(float(abs(cycle[name]).max()) for cycle in (fine, sides))
        assert sampled * (1.0 - 1e-9) <= float(exact[f"{name}_peak"]) <= sampled * (1.0 + 1e-6)


def test_peaks_are_unbounded_where_it_jams():
    exact = ls.peaks(working(friction=10.0), of=["F43"])
    assert float(exact.F43_peak) == np.inf and exact.status.item() == 3


def test_breakdown_has_the_share_of_friction():
    scene = working()
    shares = ls.breakdown(scene, "F43x", theta2=36)
    total = ls.sweep(scene, 36).F43x
    np.testing.assert_allclose(shares.F43x.sum("source"), total, rtol=1e-9)
    smooth = ls.sweep(working(friction=0.0), 36).F43x
    np.testing.assert_allclose(shares.F43x.sel(source="friction"), total - smooth, rtol=1e-9, atol=1e-9)


def test_work_of_friction_in_a_cycle():
    scene = working()
    cycle = ls.sweep(scene, 36_000, of=["friction_power"])
    mean = ls.peaks(scene, of=["friction_power_mean"])
    assert float(mean.friction_power_mean) == pytest.approx(float(cycle.friction_power.mean()), rel=1e-3)
    assert float(mean.friction_power_mean) < 0.0


def test_a_file_keeps_friction(tmp_path):
    path = tmp_path / "rubs.toml"
    ls.save(working(), path)
    assert ls.load_scene(path) == working()


def test_the_error_bound_holds():
    for case in cases()[::4]:
        cycle = ls.sweep(to_scene(case.data), case.theta2, of=[*COMPONENTS, "error_bound"])
        worst = max(worst_error(cycle, case, name) for name in COMPONENTS)
        assert worst <= float(np.max(cycle.error_bound))


def test_negative_friction_is_refused():
    with pytest.raises(ValueError, match=r"friction = -0\.1"):
        machine(friction=-0.1)


def test_a_block_on_a_pin_without_offset_feels_friction_in_the_torque_alone():
    """e = 0 leaves the normal force of no friction; T12 rises by what friction takes."""
    rough, smooth = (
        ls.sweep(working(offset=0.0, friction=mu), 36, of=["F43n", "power", "friction_power"]) for mu in (0.3, 0.0)
    )
    np.testing.assert_array_equal(rough.F43n, smooth.F43n)
    np.testing.assert_allclose(rough.power - smooth.power, -rough.friction_power, rtol=1e-9, atol=1e-9)


def test_a_machine_at_rest_has_no_friction():
    still = pythagoras(friction=0.3, loads=(LoadData("rocker", torque=1.0),), omega2=0.0)
    assert ls.sweep(to_scene(still), [90.0], of=["friction_force"]).friction_force.item() == 0.0
