"""The car in the loop: document 3's example 17-4, work and energy by quadrature, and where it leaves or stalls."""

import re
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
import xarray as xr
from refusals import refusal

import linksweep as ls
from linksweep.base.units import quantity
from linksweep.cli.main import main
from linksweep.scene.file.reading import parse_scene

mp.mp.dps = 50
G = (0.0, -9.81)
CAR = ls.LoopTrack(radius=30.0, mass=700.0)
EXAMPLE = ls.Scene(CAR, speed=100.0, thrust=10_000.0, gravity=G)
ALL = ("speed", "a_radial", "a_tangential", "normal_force", "a_total", "a_total_angle")


def energy(speed, thrust=0.0, gravity=G, mechanism=CAR) -> ls.Scene:
    return ls.Scene(mechanism, speed=speed, thrust=thrust, gravity=gravity, profile="energy")


def random_scenes(count: int, seed: int = 17):
    """Cars that get round and cars that do not, gravity at any angle, thrust forwards, backwards and none."""
    rng = np.random.default_rng(seed)
    for k in range(count):
        radius, mass = rng.uniform(0.1, 50.0), rng.uniform(0.1, 2000.0)
        pull, towards = rng.uniform(1.0, 20.0), np.radians(-90.0 + 180.0 * rng.uniform(-1, 1) * (k % 3 == 0))
        thrust = rng.uniform(-1.0, 1.0) * mass * pull * (k % 4 > 0)
        speed = np.sqrt(rng.uniform(0.2, 8.0) * radius * pull)
        gravity = (pull * np.cos(towards), pull * np.sin(towards))
        yield energy(speed, thrust, gravity, ls.LoopTrack(radius, mass))


def numbers(scene):
    return (float(x) for x in (scene.mechanism.radius, scene.mechanism.mass, scene.speed, scene.thrust, *scene.gravity))


# ---------------------------------------------------------------------------------------------- example 17-4


def test_example_17_4_from_exact_arithmetic():
    cos, sin = mp.sqrt(3) / 2, mp.mpf(1) / 2  # of 30 degrees
    g = mp.mpf(9.81)  # the float that the scene holds
    a_radial, a_tangential = mp.mpf(10000) / 30, mp.mpf(10000) / 700 - g * sin
    expected = {
        "speed": 100,
        "a_radial": a_radial,
        "a_tangential": a_tangential,
        "normal_force": 700 * (g * cos + a_radial),
        "a_total": mp.hypot(a_radial, a_tangential),
        "a_total_angle": 120 - mp.degrees(mp.atan2(a_tangential, a_radial)),
    }
    cycle = ls.sweep(EXAMPLE, theta=[30.0], of=ALL)
    for name, value in expected.items():
        assert float(cycle[name][0]) == pytest.approx(float(value), rel=1e-13), name
    # as printed, with the digits of the page and a few more
    assert float(cycle.normal_force[0]) == pytest.approx(239_280, abs=0.5)
    assert float(cycle.a_tangential[0]) == pytest.approx(9.3807, abs=5e-5)
    assert float(cycle.a_total[0]) == pytest.approx(333.465, abs=5e-4)


def test_the_system_is_the_page():
    page = ls.system(EXAMPLE, 30.0).isel(theta=0)
    assert list(page.unknown.values) == ["normal_force", "a_tangential"]
    np.testing.assert_array_equal(page.matrix, np.eye(2))
    right = [700.0 * (9.81 * np.cos(np.pi / 6.0) + 100.0**2 / 30.0), -9.81 * 0.5 + 10_000.0 / 700.0]
    np.testing.assert_allclose(page.rhs, right, rtol=1e-14)
    dense, fast = (ls.sweep(EXAMPLE, theta=90, solver=solver) for solver in ("dense", "fast"))
    xr.testing.assert_allclose(dense, fast, rtol=1e-15)


def test_exact_at_the_quarters():
    """Bottom, side, top, side, in rational numbers."""
    cycle = ls.sweep(EXAMPLE, theta=4)
    centripetal, g, push = Fraction(10000, 30), Fraction(9.81), Fraction(10000, 700)
    force = [700 * (centripetal + part) for part in (g, 0, -g, 0)]
    np.testing.assert_allclose(cycle.normal_force, [float(value) for value in force], rtol=4e-16)
    np.testing.assert_allclose(cycle.a_tangential, [float(push + part) for part in (0, -g, 0, g)], rtol=4e-16)


# ---------------------------------------------------------------------------------------------- work and energy


def test_speed_follows_the_work_of_thrust_and_gravity():
    """v dv = a_T R dθ, integrated with 50 digits, in gravity at any angle."""
    for scene in random_scenes(6):
        R, m, v0, F, gx, gy = map(mp.mpf, numbers(scene))
        cycle = ls.sweep(scene, theta=48)
        there = cycle.where(cycle.status == 0, drop=True)
        assert there.sizes["theta"] > 2
        for theta in there.theta.values[:: max(1, there.sizes["theta"] // 4)]:
            end = mp.radians(mp.mpf(theta))
            work = mp.quad(lambda a: F / m + gx * mp.cos(a) + gy * mp.sin(a), [0, end])  # noqa: B023
            squared = v0**2 + 2 * R * work
            force = m * (squared / R - (gy * mp.cos(end) - gx * mp.sin(end)))
            matches = there.sel(theta=theta)
            assert float(matches.speed) == pytest.approx(float(mp.sqrt(squared)), rel=1e-12)
            assert float(matches.normal_force) == pytest.approx(float(force), abs=1e-12 * float(m * v0**2 / R))


def test_theta_is_a_place_on_one_lap():
    scene = energy(45.0, 3000.0)
    once, again = ls.sweep(scene, theta=[30.0, 330.0]), ls.sweep(scene, theta=[390.0, -30.0])
    for name in ("speed", "normal_force", "a_tangential"):
        np.testing.assert_allclose(again[name], once[name], rtol=1e-14)


def test_constant_speed_is_energy_where_nothing_does_work():
    scenes = (ls.Scene(CAR, speed=12.0, profile=profile) for profile in ("constant", "energy"))
    constant, by_energy = (ls.sweep(scene, of=ALL) for scene in scenes)
    xr.testing.assert_equal(constant.broadcast_like(by_energy), by_energy)


# ---------------------------------------------------------------------------------------------- leaving and stalling


def test_textbook_limits_without_thrust():
    g, R = 9.81, 30.0
    speeds = np.sqrt(g * R * np.array([0.5, 1.9, 2.1, 3.0, 4.9, 5.1]))
    limits = ls.check(energy(xr.DataArray(speeds, dims="entry")))
    assert [limits["lap"].attrs["flag_meanings"].split()[k] for k in limits["lap"].values] == [
        *["stalls"] * 2,
        *["leaves_track"] * 3,
        "whole",
    ]
    ratio = speeds**2 / (g * R)
    stalls, leaves = np.degrees(np.arccos(1.0 - ratio[:2] / 2.0)), np.degrees(np.arccos((2.0 - ratio[2:5]) / 3.0))
    np.testing.assert_allclose(limits.stalls_at, [*stalls, *[np.nan] * 4], rtol=1e-13)
    np.testing.assert_allclose(limits.leaves_track_at, [np.nan, np.nan, *leaves, np.nan], rtol=1e-13)
    np.testing.assert_allclose(limits.least_entry_speed, np.sqrt(5.0 * g * R), rtol=1e-14)


def test_at_a_constant_speed_every_position_stands_for_itself():
    scene = ls.Scene(CAR, speed=10.0, gravity=G)
    cycle = ls.sweep(scene)
    needed = 100.0 / 30.0 + 9.81 * np.cos(np.radians(cycle.theta.values)) < 0.0
    np.testing.assert_array_equal(cycle.status, needed.astype(int))
    assert cycle.normal_force.isnull().values.tolist() == needed.tolist()
    assert float(ls.check(scene).least_entry_speed) == pytest.approx(np.sqrt(9.81 * 30.0), rel=1e-14)


def test_status_is_what_the_way_there_says():
    """Against walking the lap in 72 000 steps and stopping at the first failure."""
    outcomes = set()
    for scene in random_scenes(60, seed=3):
        R, m, v0, F, gx, gy = numbers(scene)
        a = np.radians(np.arange(72_000) * 0.005)
        squared = v0**2 + 2.0 * R * (F / m * a + gx * np.sin(a) + gy * (1.0 - np.cos(a)))
        force = squared / R - (gy * np.cos(a) - gx * np.sin(a))
        failed = (squared < 0.0) | (force < 0.0)
        k = int(np.argmax(failed)) if failed.any() else len(a)
        status = ls.sweep(scene, theta=720).status.values
        word = 0 if k == len(a) else 2 if squared[k] < 0.0 else 1
        expected = np.where(np.arange(720) * 100 < k, 0, word)
        differ = np.flatnonzero(status != expected)
        assert all(abs(j * 100 - k) <= 1 for j in differ)  # but for the step at which it happens
        assert int(ls.check(scene)["lap"]) == word
        outcomes.add(word)
    assert outcomes == {0, 1, 2}


def test_the_least_entry_speed_is_the_least():
    for scene in random_scenes(20, seed=5):
        least = float(ls.check(scene).least_entry_speed)
        assert least > 0.0
        for factor, goes_round in ((1.0 + 1e-9, True), (1.0 - 1e-9, False)):
            limits = ls.check(energy(least * factor, scene.thrust, scene.gravity, scene.mechanism))
            assert (int(limits["lap"]) == 0) == goes_round


# ---------------------------------------------------------------------------------------------- peaks, studies, files


def test_peaks_are_those_of_the_whole_lap():
    for scene in random_scenes(12, seed=7):
        fine = ls.sweep(scene, theta=36_000, of=["normal_force", "speed", "a_tangential"])
        coarse = ls.peaks(scene, of=["normal_force", "speed", "a_tangential"])
        for name, samples in fine.data_vars.items():
            if name != "status":
                size = float(abs(samples).max())
                for end, limit in (("max", samples.max()), ("min", samples.min())):
                    peaks = float(coarse[f"{name}_{end}"])
                    beyond = peaks - float(limit) if end == "max" else float(limit) - peaks
                    assert -1e-8 * size <= beyond < 0.05 * size, (name, end)  # between samples, never short of them
    peaks = ls.peaks(EXAMPLE)
    assert float(peaks.normal_force_max) == pytest.approx(700.0 * (9.81 + 1e4 / 30.0), rel=1e-14)
    names = {f"normal_force_{end}" for end in ("max", "max_at", "min", "min_at", "peak")}
    assert set(peaks.data_vars) == names | {"status"}
    assert peaks.status.attrs["flag_meanings"] == "ok partial_lap never_on_track"
    assert int(ls.peaks(energy(30.0)).status) == 1


@pytest.mark.parametrize("speed", [0.05, 0.1067, 1.0])
def test_a_lap_that_stalls_soon_has_its_extremes_at_its_end(speed):
    """At the stall v is 0, so that a = |F/m − g sin θ| and F_N = m g cos θ: no sample of a turn lies on these laps."""
    thrust, mass, g, R = 20.0, 200.0, mp.mpf(9.81), 30
    squared = lambda a: mp.mpf(speed) ** 2 + 2 * R * (thrust / mass * a - g * (1 - mp.cos(a)))  # noqa: E731
    stall = mp.findroot(squared, (mp.mpf("1e-3"), mp.mpf("0.14")), solver="anderson")
    worst = ls.peaks(energy(speed, thrust, mechanism=ls.LoopTrack(R, mass)), of=ALL[:5])
    assert float(worst.a_total_peak) == pytest.approx(float(abs(thrust / mass - g * mp.sin(stall))), rel=1e-12)
    assert float(worst.a_total_peak_at) == pytest.approx(float(mp.degrees(stall)), rel=1e-12)
    assert float(worst.normal_force_min) <= float(mass * g * mp.cos(stall)) * (1.0 + 1e-14)
    assert float(worst.speed_min) == pytest.approx(0.0, abs=1e-6 * speed)
    assert float(worst.a_radial_min) == pytest.approx(0.0, abs=1e-13)


def study() -> ls.Scene:
    mass = xr.DataArray([600.0, 700.0], {"m": [600.0, 700.0]}, "m")
    return energy(xr.DataArray([20.0, 30.0, 45.0], dims="entry"), 200.0, mechanism=ls.LoopTrack(30.0, mass))


def test_a_study_is_its_designs():
    scene = study()
    cycle, worst, result = ls.sweep(scene, of=ALL), ls.peaks(scene), ls.check(scene)
    assert cycle.a_tangential.sizes == {"entry": 3, "m": 2, "theta": 720}
    for i, speed in enumerate((20.0, 30.0, 45.0)):
        for j, mass in enumerate((600.0, 700.0)):
            one = energy(speed, 200.0, mechanism=ls.LoopTrack(30.0, mass))
            for batch, single in ((cycle, ls.sweep(one, of=ALL)), (worst, ls.peaks(one)), (result, ls.check(one))):
                for name in single.data_vars:
                    np.testing.assert_array_equal(batch[name].isel(entry=i, m=j), single[name], err_msg=str(name))


@pytest.mark.parametrize("scene", [EXAMPLE, energy(30.0), study()], ids=["example", "energy", "study"])
def test_files_give_the_scene_back(scene, tmp_path):
    for made in (ls.sweep(scene), ls.peaks(scene), ls.system(scene, [30.0, 60.0])):
        ls.save(made, tmp_path / "loop.nc")
        assert ls.load_scene(tmp_path / "loop.nc") == scene
    with xr.open_dataset(tmp_path / "loop.nc") as stored:
        assert stored.theta.attrs["units"] == "degree" and "loop" in stored.theta.attrs["long_name"]


def test_the_example_scene_is_the_documents():
    assert ls.example("loop") == EXAMPLE


# ---------------------------------------------------------------------------------------------- input


def test_each_mechanism_takes_its_own_words():
    bar = ls.Bar(0.1, 0.02, 0.02, 7800.0)
    four_bar = ls.FourBar(bar, bar, bar, 0.1)
    assert refusal(ls.Scene, CAR, omega2=30.0, drive="crank", loads=[ls.Load("crank", torque=1.0)]) == [
        "omega2 = 30.0: is no parameter of LoopTrack; give its own: speed, thrust, profile, gravity",
        "drive = 'crank': is no parameter of LoopTrack; give its own: speed, thrust, profile, gravity",
        "loads = (Load(link='crank', torque=1.0),): is no parameter of LoopTrack; "
        "give its own: speed, thrust, profile, gravity",
        "speed: missing; give LoopTrack a number in m/s",
    ]
    assert refusal(ls.Scene, four_bar, speed=3.0) == [
        "speed = 3.0: is no parameter of FourBar; give its own: omega2, alpha2, drive, loads, section, gravity",
        "omega2: missing; give FourBar a number in rad/s",
    ]
    assert refusal(ls.Scene, CAR, speed=3.0, profile="energie") == [
        "profile = 'energie': must be one of constant, energy; did you mean \"energy\"?"
    ]
    theta = xr.DataArray([1.0, 2.0], dims="theta")
    assert refusal(ls.Scene, CAR, speed=theta) == ["speed depends on theta: it must be the same at every position"]
    over_speed = xr.DataArray([1.0, 2.0], dims="speed")
    assert refusal(ls.Scene, CAR, speed=over_speed) == [
        'speed has a dimension "speed": that is the name of a result; rename it'
    ]


def test_speeds_have_units():
    assert quantity("36 km/h", "velocity") == 10.0
    assert quantity("60 mph", "velocity") == 26.8224
    assert quantity("10 ft/s", "velocity") == 3.048


FILE = 'speed = "72 km/h"\nprofile = "energy"\n[mechanism]\ntype = "LoopTrack"\nradius = "30 m"\nmass = "0.7 tonne"\n'


def test_a_scene_file():
    assert parse_scene(FILE) == ls.Scene(CAR, speed=20.0, profile="energy")
    with pytest.raises(ValueError, match=r'^scene:1: speed: missing; write speed = "100 km/h", or a number in m/s$'):
        parse_scene(FILE.replace('speed = "72 km/h"\n', ""))
    with pytest.raises(ValueError, match=r"^scene:1: mass: belongs to the mechanism, right below \[mechanism\]$"):
        parse_scene('mass = "700 kg"\n' + FILE.replace('mass = "0.7 tonne"\n', ""))


def test_a_bar_with_a_mass_is_refused_with_its_parameters():
    text = 'omega2 = 3\n[mechanism]\ntype = "FourBar"\nground = 1\n' + "".join(
        f'[mechanism.{role}]\ntype = "Bar"\nlength = 1\nwidth = 1\nthickness = 1\ndensity = 1\n'
        for role in ("crank", "coupler", "rocker")
    )
    with pytest.raises(ValueError, match=r"^scene:23: rocker.mass: unknown key; a Bar has length, width, thickness"):
        parse_scene(text + "mass = 3\n")


# ---------------------------------------------------------------------------------------------- plot, command line


def test_the_plot_shows_the_force_and_where_it_ends():
    cycle = ls.sweep(energy(30.0))
    track, force = cycle.linksweep.loop().axes
    (line,) = [line for line in force.lines if line.get_label() == "_normal_force"]
    np.testing.assert_array_equal(line.get_ydata(), cycle.normal_force)
    assert [text.get_text() for text in force.texts] == ["left track"]
    (driven,) = [line for line in track.lines if line.get_label() == "_driven"]
    x, y = driven.get_data()
    last = np.flatnonzero(np.isfinite(x))[-1]
    assert np.degrees(np.arctan2(x[last], -y[last])) == pytest.approx(float(cycle.theta[cycle.status == 0][-1]))
    (level,) = [
        line for line in ls.plot.loop(ls.sweep(ls.Scene(CAR, speed=12.0))).axes[1].lines if len(line.get_xdata()) == 720
    ]
    assert set(level.get_ydata()) == {3360.0}
    with pytest.raises(ValueError, match="several designs, over entry"):
        ls.plot.loop(ls.sweep(study()))
    with pytest.raises(ValueError, match="no force of a track"):
        ls.plot.loop(ls.sweep(ls.example("press")))


def test_the_command_line(capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert main(["demo", "loop"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("The rocket car in the loop") and "at theta\n" in text and "normal_force_max" in text
    assert (tmp_path / "demo.png").read_bytes().startswith(b"\x89PNG")
    (tmp_path / "loop.toml").write_text(FILE)
    assert main(["check", "loop.toml"]) == 0
    text = capsys.readouterr().out
    assert "least_entry_speed" in text and re.search(r"leaves_track_at\s+none", text)
