"""Exact peaks and means over a part of the cycle, against closed forms by hand and against dense samples."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from refusals import refusal

import linksweep as ls
from linksweep.cli.main import main
from linksweep.scene.parameters import replaced

FREE = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18)), ground=0.2)
WAVE = ls.Scene(
    FREE, 20.0, loads=[ls.Load("crank", torque=lambda theta2: -4.0 - 6.0 * np.sin(np.radians(2.0 * theta2)))]
)
"""Whose drive gives T12 = 4 + 6 sin 2θ."""
ROOT = np.sqrt(3.0)


@pytest.mark.parametrize(
    ("between", "largest", "least"),
    [
        ((0, 30), (4.0 + 3.0 * ROOT, 30.0, 2), (4.0, 0.0, 1)),
        ((30, 60), (10.0, 45.0, 0), (4.0 + 3.0 * ROOT, 30.0, 1)),
        ((60, 150), (4.0 + 3.0 * ROOT, 60.0, 1), (-2.0, 135.0, 0)),
        ((-60, 44), (4.0 + 6.0 * np.sin(np.radians(88.0)), 44.0, 2), (-2.0, -45.0, 0)),
        ((330, 420), (10.0, 405.0, 0), (4.0 - 3.0 * ROOT, 330.0, 1)),
        ((-390, -375), (1.0, -375.0, 2), (4.0 - 3.0 * ROOT, -390.0, 1)),
    ],
)
def test_a_wave_by_hand(between, largest, least):
    ds = ls.peaks(WAVE, of=["T12"], between=between)
    for end, (value, at, flag) in {"max": largest, "min": least}.items():
        assert float(ds[f"T12_{end}"]) == pytest.approx(value, rel=1e-10, abs=1e-10)
        assert float(ds[f"T12_{end}_at"]) == pytest.approx(at, abs=1e-4 if flag == 0 else 0.0)
        assert int(ds[f"T12_{end}_at_end"]) == flag
    assert ds.T12_max_at_end.attrs["flag_meanings"].split()[largest[2]] in ("inside", "first", "last")
    assert ("At an end of the part" in str(ds.linksweep)) == bool(largest[2] or least[2])


def test_means_of_a_part_by_hand():
    """From 0 to 90 degrees 4 + 6 sin 2θ has the mean 4 + 12/π, and its square 16 + 96/π + 18."""
    ds = ls.peaks(WAVE, of=["T12_mean", "T12_rms"], between=(0.0, 90.0))
    np.testing.assert_allclose(ds.T12_mean, 4.0 + 12.0 / np.pi, rtol=1e-9)
    np.testing.assert_allclose(ds.T12_rms**2, 34.0 + 96.0 / np.pi, rtol=1e-9)


@pytest.mark.parametrize("omega2", [25.0, -25.0])
@pytest.mark.parametrize("first", [-400.0, 100.0, 350.0])
def test_designs_by_dense_samples(first, omega2):
    """The largest of samples and the vertex of the parabola through it and its neighbours; ends as sampled."""
    length = xr.DataArray([0.17, 0.18, 0.2], dims="rocker")
    press = ls.example("press")
    machine = replace(press.mechanism, rocker=replace(press.mechanism.rocker, length=length))
    scene, last = replace(press, mechanism=machine, omega2=omega2), first + 63.0
    ds = ls.peaks(scene, of=["F32", "T12"], between=(first, last))
    dense = ls.sweep(scene, np.linspace(first, last, 6301), of=["F32", "T12"])
    for name, values in {"F32_peak": dense.F32, "T12_max": dense.T12, "T12_min": -dense.T12}.items():
        rows = values.transpose("rocker", "theta2").values
        at = rows.argmax(axis=1)
        inside = (at > 0) & (at < rows.shape[1] - 1)
        before, top, after = (np.take_along_axis(rows, np.clip(at + k, 0, 6300)[:, None], 1)[:, 0] for k in (-1, 0, 1))
        with np.errstate(invalid="ignore"):
            top = np.where(inside, top + (after - before) ** 2 / (8.0 * (2.0 * top - before - after)), top)
        np.testing.assert_allclose(np.abs(ds[name]), np.abs(top), rtol=1e-8)
        np.testing.assert_allclose(ds[f"{name}_at"], dense.theta2.values[at], atol=0.011)
        np.testing.assert_array_equal(ds[f"{name}_at_end"], np.where(inside, 0, np.where(at == 0, 1, 2)))


def test_parts_of_a_cycle_of_two_turns_and_their_whole():
    engine = ls.example("engine")
    whole = ls.peaks(engine, of=["F32", "T12"])
    parts = [ls.peaks(engine, of=["F32", "T12"], between=(a, a + 240.0)) for a in (-100.0, 140.0, 380.0)]
    assert max(float(part.F32_peak) for part in parts) == pytest.approx(float(whole.F32_peak), rel=1e-10)
    assert min(float(part.T12_min) for part in parts) == pytest.approx(float(whole.T12_min), rel=1e-10)
    every = ls.peaks(engine, of=["F32", "T12"], between=(-100.0, 620.0))
    assert float(every.T12_max) == pytest.approx(float(whole.T12_max), rel=1e-10)


def test_a_car_in_a_loop_between_two_positions():
    """At constant speed the track bears m (v²/R + g cos θ): least at the end that is farther from the bottom."""
    car = ls.Scene(ls.LoopTrack(radius=30.0, mass=700.0), speed=50.0, gravity=(0.0, -9.81))
    ds = ls.peaks(car, of=["normal_force"], between=(-20.0, 60.0))
    np.testing.assert_allclose(ds.normal_force_max, 700.0 * (2500.0 / 30.0 + 9.81), rtol=1e-10)
    np.testing.assert_allclose(ds.normal_force_min, 700.0 * (2500.0 / 30.0 + 0.5 * 9.81), rtol=1e-10)
    assert (int(ds.normal_force_max_at_end), int(ds.normal_force_min_at_end)) == (0, 2)


@pytest.mark.parametrize("machine", ["four-bar", "linkage"])
def test_the_status_is_that_of_the_part(machine):
    """The crank reaches 72.8 degrees: (0.12 + 0.15)² = 0.2² + 0.25² − 2·0.2·0.25·cos θ."""
    links = [ls.Link(length, 1.0, 1e-3) for length in (0.2, 0.12, 0.15)]
    rocker = ls.FourBar(*links, ground=0.25)
    if machine == "linkage":
        parts = dict(zip(("crank", "coupler", "rocker"), links, strict=True))
        rocker = ls.Linkage("crank A-B, coupler B-C, rocker D-C", ground={"A": (0, 0), "D": (0.25, 0)}, **parts)
    scene = ls.Scene(rocker, 3.0)
    parts = {(60.0, 72.7): (0, 2), (60.0, 100.0): (3, 0), (100.0, 170.0): (2, 3)}
    for between, (status, flag) in parts.items():
        ds = ls.peaks(scene, of=["F32"], between=between)
        assert (int(ds.status), int(ds.F32_peak_at_end)) == (status, flag)
        assert np.isnan(ds.F32_peak) == (status == 2)
    assert int(ls.peaks(scene, of=["theta4"], between=(60.0, 100.0)).status) == 1


def test_a_part_in_which_no_design_closes_has_no_peak_with_a_spring_either():
    wipers = ls.example("wipers")
    long = replaced(wipers, {"crank.length": 0.4})
    sprung = replace(long, loads=[ls.Spring(("ground", 0.1, 0.1), ("rod", 0.05, 20.0), 100.0, 0.05)])
    ds = ls.peaks(sprung, of=["F12", "F12_mean"], between=(10.0, 40.0))
    assert np.isnan([ds.F12_peak, ds.F12_peak_at, ds.F12_mean]).all()
    assert ds.status.attrs["flag_meanings"].split()[int(ds.status)] == "cannot_assemble"


def test_the_command_prints_the_peaks_of_a_part(capsys):
    assert main(["peaks", "press", "--between", "-60", "60", "--of", "F32", "T12"]) == 0
    expected = ls.peaks(ls.example("press"), of=["F32", "T12"], between=(-60, 60))
    assert capsys.readouterr().out.strip() == str(expected.linksweep).strip()


FOUR = ls.MultiCylinder(ls.example("engine"), [0, 540, 180, 360])


@pytest.mark.parametrize(
    ("scene", "words", "message"),
    [
        (WAVE, {"between": (60, -60)}, "first less than last by at most 360 degrees; from 60 on to -60 is (60, 300)"),
        (WAVE, {"between": (0, 361)}, "between = (0, 361): must be a pair (first, last), first less than last by at"),
        (WAVE, {"between": 60}, "between = 60: must be a pair (first, last) crank angle in degrees"),
        (WAVE, {"between": (0, 2 * np.pi)}, "between is in radians: it ends at 6.28318530717959, which is 2π"),
        (WAVE, {"between": (0, np.inf)}, "between[2] = inf degree: must be finite"),
        (WAVE, {"between": (0, xr.DataArray([30.0, 60.0], dims="part"))}, "between is over designs: must be the same"),
        (WAVE, {"between": (0, 60), "theta2": 36}, "between = (0, 60): is of exact peaks, theta2 of samples: give one"),
        (FOUR, {"between": (0, 60)}, "between = (0, 60): must be left out: peaks of several cylinders are those of"),
    ],
)
def test_refusals(scene, words, message):
    assert message in refusal(lambda: ls.peaks(scene, **words))[0]


def test_peaks_of_a_part_have_the_same_bits_among_designs_with_more_jams():
    """Friction wedges the rougher designs at angles which the others do not have."""
    rough = {"guides.slide.friction": xr.DataArray(np.geomspace(1e-3, 1.0, 20), dims="d")}
    compare_alone(
        replaced(ls.example("crank-shaper"), rough), (3, 10, 19), ["F43", "F43_samples"], between=(313.6, 517.2)
    )


def test_means_have_the_same_bits_among_designs_with_more_near_toggles():
    crank = {"crank.length": xr.DataArray(0.12 * np.linspace(0.5, 1.3, 12), dims="d")}
    compare_alone(replaced(ls.example("whitworth"), crank), (0, 5, 9), ["F12_mean", "T12_rms"])


def compare_alone(scene, designs, of, **part):
    every = ls.peaks(scene, of, **part)
    for design in designs:
        alone = ls.peaks(ls.scene_at(scene, d=design), of, **part)
        for name in alone.data_vars:
            np.testing.assert_array_equal(every[name].isel(d=design, missing_dims="ignore"), alone[name], err_msg=name)


@pytest.mark.parametrize("between", [(10, 60), (0, 359), (-100, 170), (20, 200)])
def test_a_force_that_is_0_but_for_rounding_errors_is_not_infinite_at_the_ends_of_a_part(between):
    """Across a coupler without mass there is no force."""
    machine = ls.FourBar(
        ls.Link(0.1, 1.0, 0.01, 0.05), ls.Link(0.28, 0.0, 0.0), ls.Link(0.28, 1.0, 0.02, 0.1), ground=0.25
    )
    ds = ls.peaks(ls.Scene(machine, omega2=30.0), of=["F43y_link3", "F43"], between=between)
    assert float(ds.F43y_link3_peak) < 1e-14 * float(ds.F43_peak) and int(ds.status) == 0
    ds = ls.peaks(ls.example("whitworth"), of=["aG5y"], between=between)  # of a ram that moves along x
    assert float(ds.aG5y_peak) < 1e-12 and int(ds.status) == 0
