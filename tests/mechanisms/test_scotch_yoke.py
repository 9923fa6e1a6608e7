"""A machine that is made here, of some 100 lines and one entry in the register, against closed forms.

The closed forms are written in complex numbers and by virtual work; they share no formula with the machine's rows.
"""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest
import scotch_yoke
import xarray as xr
from scotch_yoke import ScotchYoke

import linksweep as ls
from linksweep.mechanisms.mechanism import MECHANISMS, register

G = 9.81  # m/s²
CRANK = ls.Link(length=0.10, mass=2.0, inertia=0.01, cg_distance=0.03, cg_angle=20.0)
YOKE = ScotchYoke(CRANK, yoke_mass=5.0, yoke_cg_distance=0.2, yoke_cg_angle=30.0)
PUSH = ls.Load("yoke", force=(-100.0, 5.0), at=(0.3, 10.0))
BRAKE = ls.Load("crank", torque=-2.0)


@pytest.fixture(autouse=True)
def registered():
    with scotch_yoke.registered():
        yield


@pytest.fixture
def scene() -> ls.Scene:
    return ls.Scene(YOKE, omega2=20.0, alpha2=3.0, gravity=(0.0, -G), loads=[PUSH, BRAKE])


def closed_form(theta2: np.ndarray, w: float = 20.0, alpha: float = 3.0) -> SimpleNamespace:
    """Return motion, forces and torque: Newton and Euler for the yoke and the crank, virtual work for the torque."""
    turn = np.exp(1j * np.radians(theta2))
    pin, cg = 0.10 * turn, 0.03 * np.exp(1j * np.radians(20.0)) * turn
    point, yoke_cg = 0.3 * np.exp(1j * np.radians(10.0)), 0.2 * np.exp(1j * np.radians(30.0))
    swing = 1j * alpha - w**2  # acceleration of a point of the crank, divided by its position
    a = (swing * pin).real
    on_yoke = 5.0 * a + 100.0  # of the crank's pin
    gravity_torque = (np.conj(cg) * (-2.0j * G)).imag
    inertia = 0.01 + 2.0 * 0.03**2
    return SimpleNamespace(
        Cx=pin.real,
        v_yoke=(1j * w * pin).real,
        a_yoke=a,
        F42x=-on_yoke,
        F14y=5.0 * G - 5.0,
        F12=2.0 * swing * cg + 2.0j * G + on_yoke,
        T12=inertia * alpha - gravity_torque + on_yoke * (1j * pin).real + 2.0,
        # moments on the yoke about C: guide, load, weight, pin, and those of m·a
        T14=-((np.conj(point) * (-100.0 + 5.0j)).imag - 5.0 * G * yoke_cg.real - pin.imag * on_yoke)
        - 5.0 * a * yoke_cg.imag,
    )


def test_motion_forces_and_torque(scene):
    cycle = ls.sweep(scene, 360)
    form = closed_form(cycle.theta2.values)
    for name in ("Cx", "v_yoke", "a_yoke", "F42x", "F14y", "T12", "T14"):
        scale = np.abs(getattr(form, name)).max()
        np.testing.assert_allclose(cycle[name], getattr(form, name), rtol=0.0, atol=1e-14 * scale, err_msg=name)
    np.testing.assert_allclose(cycle.F12x + 1j * cycle.F12y, form.F12, atol=1e-12)


def test_energy_and_the_dense_solution(scene):
    cycle = ls.sweep(scene, 360, of=["power_residual", *YOKE.unknowns("crank")])
    assert abs(cycle.power_residual).max() < 1e-14
    dense = ls.sweep(scene, 360, solver="dense")
    for name in YOKE.unknowns("crank"):
        np.testing.assert_allclose(dense[name], cycle[name], atol=1e-12)
    assert ls.system(scene, 45.0).matrix.shape == (1, 6, 6)


def test_exact_peaks_are_those_of_the_closed_form():
    """With F the push and A = M·a²·ω²: T12 = A sin θ cos θ + F·a sin θ, extreme where 2A c² + F·a·c − A = 0."""
    wheel = ls.Disk(length=0.10, radius=0.12, thickness=0.02, density=7800)
    push = 300.0
    scene = ls.Scene(ScotchYoke(wheel, yoke_mass=5.0), omega2=20.0, loads=[ls.Load("yoke", force=(push, 0.0))])
    A, B = 5.0 * 0.10**2 * 20.0**2, push * 0.10
    c = (-B + np.sqrt(B * B + 8.0 * A * A)) / (4.0 * A)
    highest = np.sqrt(1.0 - c * c) * (A * c + B)
    peaks = ls.peaks(scene, of=["T12", "F42", "F12"])
    assert float(peaks.T12_max) == pytest.approx(highest, rel=1e-13)
    assert float(peaks.T12_max_at) == pytest.approx(np.degrees(np.arccos(c)), abs=1e-5)
    assert float(peaks.T12_min) == pytest.approx(-highest, rel=1e-13)
    assert float(peaks.F42_peak) == pytest.approx(push + 5.0 * 0.10 * 20.0**2, rel=1e-14)
    assert float(peaks.F42_peak_at) == 0.0
    assert int(peaks.status) == 0


def test_means_are_those_of_the_closed_form():
    """Without loads T12 = ½ M·a²·ω²·sin 2θ, F42x = M·a·ω²·cos θ."""
    scene = ls.Scene(ScotchYoke(ls.Link(0.10, 0.0, 0.01), yoke_mass=5.0), omega2=20.0)
    means = ls.peaks(scene, of=["T12_rms", "T12_mean", "F42_rms"])
    assert float(means.T12_rms) == pytest.approx(0.5 * 5.0 * 0.01 * 400.0 / np.sqrt(2.0), rel=1e-12)
    assert float(means.T12_mean) == pytest.approx(0.0, abs=1e-12)
    assert float(means.F42_rms) == pytest.approx(5.0 * 0.10 * 400.0 / np.sqrt(2.0), rel=1e-12)


def test_designs_files_and_checks(scene, tmp_path):
    ls.save(scene, tmp_path / "yoke.toml")
    assert ls.load_scene(tmp_path / "yoke.toml") == scene
    masses = xr.DataArray([4.0, 5.0], {"mass": [4.0, 5.0]}, "mass")
    designs = ls.Scene(ScotchYoke(CRANK, yoke_mass=masses, yoke_cg_distance=0.2, yoke_cg_angle=30.0), omega2=20.0)
    study = ls.study(designs, tmp_path / "study.nc", of=["F42", "T12"])
    xr.testing.assert_equal(study[["F42_peak"]].load(), ls.peaks(designs, of=["F42"])[["F42_peak"]])
    assert ls.scene_at(study, mass=5.0).mechanism == YOKE
    assert float(ls.check(scene).stroke) == 0.20
    study.close()


def test_numbers_out_of_bounds_are_refused_like_those_of_any_machine():
    with pytest.raises(ValueError, match=r"crank\.length = -0\.1 m: must be greater than 0"):
        ScotchYoke(ls.Link(-0.10, 1.0, 0.0), yoke_mass=1.0)
    with pytest.raises(ValueError, match=r"yoke_mass = -1 kg: must be at least 0"):
        ScotchYoke(CRANK, yoke_mass=-1.0)


def test_the_register_holds_it_only_here():
    assert MECHANISMS["ScotchYoke"] is ScotchYoke


def test_the_file_knows_it_no_more(scene, tmp_path):
    text = scene.to_toml()
    del MECHANISMS["ScotchYoke"]
    (tmp_path / "yoke.toml").write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match="ScotchYoke"):
        ls.load_scene(tmp_path / "yoke.toml")
    MECHANISMS["ScotchYoke"] = ScotchYoke


def test_a_machine_with_a_field_of_no_stated_kind_is_not_registered():
    @dataclass(frozen=True, eq=False, repr=False)
    class Undeclared(ScotchYoke):
        stroke: float = 0.1

    with pytest.raises(ValueError, match=r"^Undeclared\.stroke: must state what it holds: parameter"):
        register(Undeclared)
    assert "Undeclared" not in MECHANISMS


def test_one_number_and_gas_press_along_the_guide_of_any_slider():
    area, excess = 0.25 * np.pi * 0.05**2, 4e5
    gas = ls.GasPressure(0.05, 101325.0 + excess, link="yoke")
    forces = [ls.Load("yoke", force=-area * excess), ls.Load("yoke", force=(-area * excess, 0.0)), gas]
    torques = [ls.sweep(ls.Scene(YOKE, 20.0, loads=[load]), 36).T12.values for load in forces]
    np.testing.assert_allclose(torques[0], torques[1], rtol=1e-15)
    np.testing.assert_allclose(torques[2], torques[1], rtol=1e-12, atol=1e-12)
    with pytest.raises(ValueError, match=r"^loads\[1\].link = 'slider': must be one of yoke"):
        ls.Scene(YOKE, 20.0, loads=[ls.GasPressure(0.05, 2e5)])
    with pytest.raises(ValueError, match=r"^loads\[1\].pressure is a cycle, which takes a SliderCrank, not a S"):
        ls.Scene(YOKE, 20.0, loads=[ls.GasPressure(0.05, ls.OttoCycle(10.0, 6e6), link="yoke")])
