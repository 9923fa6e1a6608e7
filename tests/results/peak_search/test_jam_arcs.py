"""Arcs on which friction jams linkages, and dead centres of their drives, beside closed forms and references."""

import re

import numpy as np
import pytest
import xarray as xr
from linkage_reference import as_data

import linksweep as ls
from benchmarks.speed.kernel import way
from benchmarks.stress.linkages import multibody
from linksweep.tables.of_check import check_table

STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
CRANK = ls.Link(0.08, 0.4, 3e-4, 0.03, 20.0)
ROD, ROCKER = ls.Bar(0.22, **STEEL), ls.Bar(0.18, **STEEL)


@pytest.fixture(autouse=True)
def uncompiled():
    with way("interpreted"):
        yield


def shaper(friction, push=-60.0):
    machine = ls.Linkage(
        "crank A-B, arm D-E past B, block F on arm, ram F on slide",
        ground={"A": (0.0, 0.0), "D": (0.0, -0.2)},
        crank=CRANK,
        arm=ls.Bar(0.5, **STEEL),
        block=ls.Slider(0.5),
        ram=ls.Slider(3.0),
        guides={
            "slide": ls.Guide((0.0, 0.2), 0.0, friction),
            "arm": ls.Guide((0.0, 0.0), 0.0, friction, of="arm"),
        },
    )
    return ls.Scene(machine, omega2=20.0, gravity=(0.0, -9.81), loads=[ls.Load("ram", force=(push, 0.0))])


def yoke(friction, slot_friction, slot_angle):
    machine = ls.Linkage(
        "crank A-B, yoke on slide past B",
        ground={"A": (0.1, 0.0)},
        guides={"slide": ls.Guide((0.01, 0.03), 30.0, friction)},
        crank=CRANK,
        yoke=ls.Slider(5.0, cg_distance=0.1, cg_angle=40.0, slot_angle=slot_angle, slot_friction=slot_friction),
    )
    load = ls.Load("yoke", force=(-100.0, 40.0), at=(0.1, 20.0))
    return ls.Scene(machine, omega2=20.0, alpha2=30.0, gravity=(0.0, -9.81), loads=[load])


def test_two_slides_jam_where_their_lines_come_within_both_angles_of_friction():
    """The line D-B, at β from upright, passes A at 0.2 sin β: the crank is acos(0.2 sin β/0.08) from its normal."""
    beta = 90.0 - 2.0 * np.degrees(np.arctan(0.7))
    half = np.degrees(np.arccos(0.2 * np.sin(np.radians(beta)) / 0.08))
    limits = ls.check(shaper(0.7))
    np.testing.assert_allclose(limits.jam_start, [180.0 + beta - half, 360.0 - beta - half], rtol=0, atol=1e-9)
    np.testing.assert_allclose(limits.jam_end, [180.0 + beta + half, 360.0 - beta + half], rtol=0, atol=1e-9)
    np.testing.assert_array_equal(limits.jam_place, 2)
    assert limits.jam_place.flag_meanings == "none arm F"


@pytest.mark.parametrize("scene", [shaper(0.7), *(yoke(0.9, 0.8, angle) for angle in (30.0, 75.0, 140.0))])
def test_ends_of_jams_are_those_of_the_reference_in_50_digits(scene):
    limits, aside = ls.check(scene), 1e-5
    assert limits.sizes["jam"] > 0
    for start, end in zip(limits.jam_start.values, limits.jam_end.values, strict=True):
        angles = [start - aside, start + aside, end - aside, end + aside]
        jammed = [multibody.solve(as_data(scene, angle)).status[0] in (4, 6) for angle in angles]
        assert jammed == [False, True, True, False]


def test_jams_lie_between_the_angles_at_which_a_slider_crank_wedges():
    friction, offset = xr.DataArray([0.0, 1.5, 2.4, 5.0], dims="design"), 0.03
    engine = ls.SliderCrank(CRANK, ROD, slider_mass=2.0, offset=offset, friction=friction)
    machine = ls.Linkage(
        "crank A-B, rod B-C, ram C on slide",
        ground={"A": (0.0, 0.0)},
        guides={"slide": ls.Guide((0.0, offset), friction=friction)},
        crank=CRANK,
        rod=ROD,
        ram=ls.Slider(2.0),
    )
    limits = ls.check(ls.Scene(machine, omega2=10.0, loads=[ls.Load("ram", force=(-900.0, 0.0))]))
    expected = np.sort(ls.check(ls.Scene(engine, omega2=10.0)).jam_angle.values, axis=1)
    angles = np.sort(np.mod(np.concatenate([limits.jam_start, limits.jam_end], axis=1), 360.0), axis=1)
    np.testing.assert_allclose(angles, expected[:, : angles.shape[1]], rtol=0, atol=1e-9)
    assert np.isfinite(angles).sum(axis=1).tolist() == [0, 0, 2, 4]


def test_jams_have_the_dims_of_loads_and_each_its_own():
    push = xr.DataArray([-60.0, 0.0, 900.0], dims="push")
    limits = ls.check(shaper(xr.DataArray([0.0, 0.7], dims="friction"), push))
    assert {*limits.jam_start.dims} == {"push", "friction", "jam"}
    assert not limits.jam_start.isel(friction=0).notnull().any()
    assert limits.jam_start.isel(friction=1).notnull().any("jam").all()


def test_a_machine_that_jams_at_every_angle():
    limits = ls.check(yoke(2.0, 2.0, 90.0))
    assert (limits.jam_start.values.tolist(), limits.jam_end.values.tolist()) == ([0.0], [360.0])


def test_dead_centres_of_a_driven_rocker_are_those_of_the_closed_form():
    machine = ls.FourBar(CRANK, ROD, ROCKER, 0.2)
    by_branch = ls.check(ls.Scene(machine, omega2=10.0, drive="rocker")).dead_centre_angle
    expected = by_branch.sel(dead_centre=["open_stretched", "open_folded"])
    linkage = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.0)},
        crank=CRANK,
        coupler=ROD,
        rocker=ROCKER,
    )
    angles = ls.check(ls.Scene(linkage, omega2=10.0, drive="rocker")).dead_centre_angle
    np.testing.assert_allclose(angles, np.sort(expected), rtol=0, atol=1e-9)
    assert "dead_centre_angle" not in ls.check(ls.Scene(linkage, omega2=10.0))


def test_dead_centres_of_a_cylinder_are_nearest_and_farthest():
    linkage = ls.Linkage("crank A-B, jack D~B", ground={"A": (0.0, 0.0), "D": (0.3, 0.3)}, crank=CRANK)
    angles = ls.check(ls.Scene(linkage, omega2=10.0, drive="jack")).dead_centre_angle
    np.testing.assert_allclose(angles, [45.0, 225.0], rtol=0, atol=1e-9)


def test_transmission_angle_of_a_slot_is_its_angle_to_the_guide():
    limits = ls.check(yoke(0.1, 0.2, 140.0))
    assert float(limits.transmission_angle_min.sel(pin="yoke")) == pytest.approx(40.0, abs=1e-12)
    assert float(limits.transmission_angle_max.sel(pin="yoke")) == pytest.approx(40.0, abs=1e-12)


def test_jams_on_the_command_line():
    text = str(check_table(ls.check(shaper(0.7))))
    assert re.search(r"friction jams from: +168\.85", text)
    assert "° (F) and 308.82" in text
    assert "jam_start" not in text
    assert re.search("friction jams from: +nowhere", str(check_table(ls.check(shaper(0.1)))))
    batch = ls.check(shaper(xr.DataArray([0.1, 0.7, 0.8], dims="friction")))
    assert re.search("friction jams: +2 of 3 designs", str(check_table(batch)))


def test_jams_in_a_report(tmp_path):
    page = tmp_path / "report.html"
    for friction, words in ((0.7, "jams at F from 168.85"), (0.1, "jams no slide")):
        ls.report(shaper(friction), page)
        assert words in re.sub("<[^>]*>", "", page.read_text(encoding="utf-8"))
