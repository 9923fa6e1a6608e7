"""Checks of linkages, by search, agree with the closed forms of the machines that they can also be written as."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from benchmarks.accuracy import missed

DESIGNS = 40
LENGTHS = {"crank": 0.08, "coupler": 0.22, "rocker": 0.18, "rod": 0.20, "output": 0.15}


def scene_of(name):
    return missed.FAMILIES[name].scene(np.random.default_rng(8), DESIGNS)


def four_bar(scene):
    machine = scene.mechanism
    return ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C",
        ground={"A": (0.0, 0.0), "D": (machine.ground, 0.0)},
        branch={"C": machine.branch},
        **machine.parts,
    )


def slider_crank(scene):
    machine = scene.mechanism
    return ls.Linkage(
        "crank A-B, rod B-C, slider C on slide",
        ground={"A": (0.0, 0.0)},
        guides={"slide": ls.Guide(through=(0.0, machine.offset), friction=machine.friction)},
        branch={"C": machine.branch},
        slider=ls.Slider(machine.slider_mass),
        **machine.parts,
    )


@pytest.mark.parametrize(
    ("name", "linkage"),
    [("four-bar", four_bar), ("four-bar of any lengths", four_bar), ("slider-crank", slider_crank)],
)
def test_limits_are_those_of_the_closed_forms(name, linkage):
    scene = scene_of(name)
    expected, limits = ls.check(scene), ls.check(ls.Scene(linkage(scene), 1.0))
    np.testing.assert_array_equal(limits.assembly, expected.assembly)
    order = np.argsort(expected.arc_start.values, axis=-1)
    for variable in ("arc_start", "arc_end"):
        arcs = np.take_along_axis(expected[variable].values, order, axis=-1)[:, : limits.sizes["arc"]]
        np.testing.assert_allclose(limits[variable], arcs, rtol=0, atol=1e-11)
    least = limits.transmission_angle_min.sel(pin="C")
    np.testing.assert_allclose(least, expected.transmission_angle_min, rtol=1e-10, atol=1e-6)


def test_toggles_bound_the_arcs():
    limits = ls.check(ls.Scene(four_bar(scene_of("four-bar of any lengths")), 1.0))
    part = limits.where(limits.assembly == 1, drop=True)
    ends = np.mod(np.concatenate([part.arc_start.values, part.arc_end.values], axis=1), 360.0)
    toggles = np.sort(part.toggle_angle.sel(pin="C").values, axis=1)
    np.testing.assert_array_equal(toggles, np.sort(ends, axis=1)[:, : toggles.shape[1]])
    whole = limits.where(limits.assembly == 0, drop=True)
    assert np.isnan(whole.toggle_angle).all()


@pytest.mark.parametrize(
    ("name", "linkage", "jams"),
    [
        ("four-bar", four_bar, 0.0),
        ("slider-crank with friction", slider_crank, 0.0),
        ("slider-crank with friction", slider_crank, 0.3),
    ],
)
def test_peaks_are_those_of_the_machine_with_closed_forms(name, linkage, jams):
    """Friction, too, and a slider that it wedges: unbounded."""
    scene = scene_of(name)
    if jams:
        rough = scene.mechanism.friction + xr.DataArray(np.where(np.arange(DESIGNS) < 15, jams, 0.0), dims="design")
        scene = ls.Scene(
            replace(scene.mechanism, friction=rough), scene.omega2, scene.alpha2, scene.gravity, scene.loads
        )
    expected = ls.peaks(scene)
    peaks = ls.peaks(ls.Scene(linkage(scene), scene.omega2, scene.alpha2, scene.gravity, scene.loads))
    assert (expected.status == 3).any() == (jams > 0.0)
    for variable in ("F12_peak", "F32_peak", "F43_peak", "T12_max", "T12_min", "status"):
        np.testing.assert_allclose(peaks[variable], expected[variable], rtol=1e-10, err_msg=variable)


def test_peaks_with_a_table_of_a_load_are_those_of_the_machine_with_closed_forms():
    """Six designs had peaks up to 28 times as large: where a near-toggle, found by search, lies a rounding error
    before the end of the turn, a piece of no length took the table's values from another turn."""
    theta2 = np.arange(0.0, 360.0, 15.0)
    torque = xr.DataArray(10.0 + 3.0 * np.sin(np.radians(theta2)), {"theta2": theta2}, "theta2")
    scene = replace(scene_of("four-bar"), loads=[ls.Load("rocker", torque=torque)])
    expected, peaks = ls.peaks(scene), ls.peaks(replace(scene, mechanism=four_bar(scene)))
    for variable in ("F12_peak", "F32_peak", "F43_peak", "T12_max", "T12_min"):
        np.testing.assert_allclose(peaks[variable], expected[variable], rtol=1e-10, err_msg=variable)


def test_extreme_transmission_angles_are_those_of_a_dense_sweep():
    bars = {name: ls.Link(length, 1.0, 0.01) for name, length in LENGTHS.items()}
    machine = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F",
        ground={"A": (0.0, 0.0), "D": (0.20, 0.0), "G": (0.42, 0.05)},
        points={"E": (0.12, -35.0)},
        branch={"F": "crossed"},
        **bars,
    )
    scene = ls.Scene(machine, 1.0)
    limits = ls.check(scene)
    for pin in "CF":
        angle = ls.sweep(scene, 36_000, of=[f"transmission_angle_{pin}"])[f"transmission_angle_{pin}"]
        for kind, extreme, at in (("min", angle.min(), angle.idxmin()), ("max", angle.max(), angle.idxmax())):
            own = limits.sel(pin=pin)
            np.testing.assert_allclose(own[f"transmission_angle_{kind}"], extreme, atol=5e-3)
            away = np.mod(own[f"transmission_angle_{kind}_at"] - at + 180.0, 360.0) - 180.0
            assert abs(away) < 0.02 or abs(float(extreme) - 90.0) < 5e-3


def test_status_of_the_largest_samples_is_that_of_exact_peaks():
    scene = scene_of("four-bar of any lengths")
    machine = scene.mechanism
    length = machine.rocker.length.copy(data=np.where(np.arange(DESIGNS) < 3, 100.0, machine.rocker.length))
    machine = replace(machine, rocker=replace(machine.rocker, length=length))
    scene = ls.Scene(four_bar(replace(scene, mechanism=machine)), 1.0)
    exact, samples = ls.peaks(scene), ls.peaks(scene, theta2=720)
    assert (samples.status[:3] == 2).all()
    assert {0, 1, 2} == {*samples.status.values.tolist()}
    np.testing.assert_array_equal(samples.status, exact.status.where(exact.status != 3, 1))


def test_a_machine_without_toggles_closes_everywhere():
    yoke = ls.example("scotch-yoke")
    limits = ls.check(yoke)
    assert (limits.assembly, limits.arc_start.item(), limits.arc_end.item()) == (0, 0.0, 360.0)
    assert limits.sizes["toggle"] == 0
    assert ls.peaks(yoke, of=["T12"]).status == 0


def test_limits_have_the_dims_of_lengths_alone():
    ground = {"A": (0.0, 0.0), "D": (0.20, 0.0), "G": (xr.DataArray([0.42, 0.5, 0.9], dims="x"), 0.05)}
    bars = {name: ls.Link(length, 1.0, 0.01) for name, length in LENGTHS.items()}
    bars["output"] = ls.Link(LENGTHS["output"], xr.DataArray([0.5, 1.0], dims="mass"), 0.01, 0.05)
    text, points = "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F", {"E": (0.12, -35.0)}
    machine = ls.Linkage(text, ground=ground, points=points, branch={"C": "both", "F": "both"}, **bars)
    scene = ls.Scene(machine, 30.0)
    limits, peaks = ls.check(scene), ls.peaks(scene, of=["F65"])
    assert limits.arc_start.dims == ("x", "branch_C", "arc")
    assert limits.toggle_angle.dims == ("x", "branch_C", "pin", "toggle")
    assert {*peaks.F65_peak.dims} == {"x", "branch_C", "branch_F", "mass"}
    never = (limits.assembly == 2).broadcast_like(peaks.F65_peak)
    np.testing.assert_array_equal(peaks.F65_peak.isnull(), never.transpose(*peaks.F65_peak.dims))
    assert never.any() and not never.all()


def test_a_linkage_that_never_closes_names_the_pin_that_fails_first():
    """No more than 0.08 + 0.30 m from A, E is out of reach of rod and output where G lies 2 m away, 0.20 + 0.15 m; C is
    where D does, before F is."""
    far = xr.DataArray([0.4, 2.0], dims="G"), xr.DataArray([0.2, 2.0], dims="D")
    parts = {name: ls.Link(length, 0.0, 0.0) for name, length in LENGTHS.items()}
    machine = ls.Linkage(
        "crank A-B, coupler B-C-E, rocker D-C, rod E-F, output G-F",
        ground={"A": (0.0, 0.0), "G": (far[0], 0.0), "D": (far[1], 0.0)},
        points={"E": (0.30, 0.0)},
        **parts,
    )
    check = ls.check(ls.Scene(machine, omega2=1.0))
    assert check.fails_at.attrs["flag_meanings"] == "none C F"
    assert check.fails_at.transpose("D", "G").values.tolist()[1] == [1, 1]
    assert check.fails_at.sel(D=0, G=1) == 2 and check.fails_at.where(check.assembly < 2, 0).max() == 0
    lines = repr(
        ls.check(ls.Scene(replace(machine, ground={"A": (0.0, 0.0), "D": (2.0, 0.0), "G": (0.4, 0.0)}), 1.0)).linksweep
    )
    assert "does not close at:" in lines and lines.split("does not close at:")[1].split()[0] == "C"
