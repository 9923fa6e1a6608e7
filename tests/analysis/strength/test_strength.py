"""Strength of links and pins: closed forms, and the largest of many samples at many sections."""

import re
from dataclasses import replace
from functools import partial

import numpy as np
import pint
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from linksweep.analysis.strength.criteria import fatigue_safety

STEEL = ls.material("S235")
THREAD = {"width": 1e-6, "thickness": 1e-6, "density": 0.0}
BAR = {"width": 0.03, "thickness": 0.012, "density": 7850.0}


def turning(width=0.03, omega2=50.0, **loads):
    """Return a bar that turns on a fixed pin, its coupler and rocker without mass."""
    crank = ls.Bar(0.3, width=width, thickness=0.012, density=7850.0)
    return ls.Scene(ls.FourBar(crank, ls.Bar(0.8, **THREAD), ls.Bar(0.7, **THREAD), ground=0.6), omega2=omega2, **loads)


def test_a_turning_bar_has_the_stress_of_the_textbooks():
    """σ = ρ ω² L²/2 at its pivot, whatever its section; three times as much beside its eye."""
    ds = ls.strength(turning(), STEEL, links="crank", stress_concentration=3.0).sel(link="crank")
    expected = 7850.0 * 50.0**2 * 0.3**2 / 2.0
    assert float(ds.stress) == pytest.approx(3.0 * expected, rel=1e-12)
    assert float(ds.stress_section) == 0.0 and float(ds.compression) < 1e-12
    assert float(ds.yield_safety) == pytest.approx(235e6 / (3.0 * expected), rel=1e-12)
    assert float(ds.goodman_safety) == pytest.approx(360e6 / (3.0 * expected), rel=1e-9)  # a steady stress
    assert float(ds.soderberg_safety) == pytest.approx(235e6 / (3.0 * expected), rel=1e-9)


def test_a_connecting_rod_whips_as_in_the_textbooks():
    """M = m ω² r L/(9√3) at L/√3 from the small end, of a long rod across its crank; σ = 4.593 m ω² r L/(1000 t³).

    V. B. Bhandari, Design of Machine Elements, chapter "Design of IC Engine Components": an I-section 4t wide and 5t
    high, of area 11t² and second moment 419t⁴/12.
    """
    t, r, length, omega, mass = 0.008, 0.1375, 1375.0, 52.36, 1.6
    section = ls.IBeam(height=5 * t, width=4 * t, web=t, flange=t)
    assert section.area == pytest.approx(11 * t**2) and section.second_moment == pytest.approx(419 * t**4 / 12)
    rod = ls.Link(length, mass, mass * length**2 / 12.0, cg_distance=0.5 * length, section=section)
    machine = ls.SliderCrank(ls.Link(r, 0.0, 0.0), rod, slider_mass=0.0)
    across = 90.0 - np.degrees(np.arctan(r / length))  # crank at right angles to the rod
    shares = xr.DataArray(np.linspace(0.0, 1.0, 2001), dims="section")
    scene = ls.Scene(machine, omega2=omega, section=shares)
    moment = abs(ls.sweep(scene, [across], of=["bending_moment3"]).bending_moment3.isel(theta2=0))
    expected = mass * omega**2 * r * length / (9.0 * np.sqrt(3.0))
    assert float(moment.max()) == pytest.approx(expected, rel=1e-6)
    assert 1.0 - float(shares[int(np.argmax(moment.values))]) == pytest.approx(1.0 / np.sqrt(3.0), abs=1e-3)
    whip = 4.593 * mass * omega**2 * r * 1e3 * length * 1e3 / (1000.0 * (1e3 * t) ** 3)  # N, mm; the book's 4.593
    assert float(moment.max()) / section.modulus == pytest.approx(1e3 * whip, rel=1e-3)


@pytest.mark.parametrize("name", long_but(["press", "watt-2", "crank-shaper"], "press"))
def test_the_worst_of_many_samples_is_no_worse(name):
    scene = ls.example(name)
    parts = {role: ls.Bar(scene.mechanism.parts[role].length, **BAR) for role in scene.mechanism.topology.links}
    scene = replace(scene, mechanism=replace(scene.mechanism, **parts))
    ds = ls.strength(scene, STEEL)
    many = replace(scene, section=xr.DataArray(np.linspace(0.0, 1.0, 201), dims="section"))
    for role in ds.link.values:
        k, one = scene.mechanism.topology.number(str(role)), ds.sel(link=role)
        cycle = ls.sweep(many, 360, of=[f"stress{k}_left", f"stress{k}_right", f"axial_force{k}"])
        fibres = xr.concat([cycle[f"stress{k}_left"], cycle[f"stress{k}_right"]], "fibre")
        top, low = fibres.max("theta2"), fibres.min("theta2")
        goodman = 1.0 / ((top - low) / 2.0 / 180e6 + np.maximum((top + low) / 2.0, 0.0) / 360e6)
        soderberg = 1.0 / ((top - low) / 2.0 / 180e6 + np.maximum((top + low) / 2.0, 0.0) / 235e6)
        sampled = {"stress": abs(fibres).max(), "compression": (-cycle[f"axial_force{k}"]).max()}
        for quantity, most in sampled.items():
            assert -1e-9 < float(one[quantity] / most) - 1.0 < 1e-2, (role, quantity)
        for quantity, least in {"goodman": goodman.min(), "soderberg": soderberg.min()}.items():
            assert -1e-2 < float(one[f"{quantity}_safety"] / least) - 1.0 < 1e-9, (role, quantity)


def test_the_section_worst_by_soderberg_is_its_own():
    """A mean counts more than by Goodman; against 801 sections, between which the safety varies by less than 1e-5."""
    sizes = (0.242, 0.0141, 0.0285), (0.694, 0.0349, 0.0908), (0.496, 0.0905, 0.0887)
    machine = ls.FourBar(*(ls.Bar(*each, density=7800.0) for each in sizes), ground=0.9207)
    scene = ls.Scene(machine, 20.6, gravity=(0.0, -9.81), loads=[ls.Load("rocker", torque=-219.2)])
    sections = xr.DataArray(np.linspace(1e-9, 1.0 - 1e-9, 801), dims="section")
    ds = ls.peaks(replace(scene, section=sections), of=["stress4_left", "stress4_right"])
    ends = [(ds[f"stress4_{fibre}_max"], ds[f"stress4_{fibre}_min"]) for fibre in ("left", "right")]
    worst = max(float(((top - low) / 360e6 + np.maximum(top + low, 0.0) / 470e6).max()) for top, low in ends)
    safety = ls.strength(scene, STEEL, links="rocker").soderberg_safety.item()
    assert safety == pytest.approx(1.0 / worst, rel=2e-5)


def test_a_mean_in_compression_neither_helps_nor_harms():
    assert fatigue_safety(-100e6, 50e6, 100e6, 400e6) == 2.0
    assert fatigue_safety(100e6, 50e6, 100e6, 400e6) == pytest.approx(1.0 / (0.5 + 0.25), rel=1e-15)


def test_a_slender_rod_buckles_by_euler_and_a_stocky_one_by_johnson():
    for width, law in ((0.004, "euler"), (0.06, "johnson")):
        machine = ls.FourBar(
            ls.Bar(0.05, **BAR), ls.Bar(0.3, width=width, thickness=0.02, density=0.0), ls.Bar(0.2, **BAR), ground=0.25
        )
        scene = ls.Scene(machine, omega2=10.0, loads=[ls.Load("rocker", torque=50.0)])
        ds = ls.strength(scene, STEEL, links=["coupler"], effective_length=(1.0, 0.5)).sel(link="coupler")
        squared = 12.0 * (0.3 / width) ** 2
        expected = {
            "euler": np.pi**2 * 210e9 * width * 0.02 / squared,
            "johnson": width * 0.02 * 235e6 * (1.0 - 235e6 * squared / (4.0 * np.pi**2 * 210e9)),
        }
        assert float(ds.buckling_load.sel(plane="motion")) == pytest.approx(expected[law], rel=1e-12)
        worst = float(ls.peaks(scene, of=["F32"]).F32_peak)  # a coupler without mass bears along its line alone
        assert float(ds.compression) == pytest.approx(worst, rel=1e-9)
        assert float(ds.buckling_safety.min()) == pytest.approx(float(ds.buckling_load.min()) / worst, rel=1e-9)


@pytest.mark.parametrize(("angle", "ends"), [(180.0, (-0.03, 0.0)), (0.0, (0.02, 0.051))])
def test_both_sides_of_an_eye_count_wherever_it_lies(angle, ends):
    """σ = k F/A in a massless crank that two forces pull apart, of which only the outer end lies at an eye."""
    lengths = xr.DataArray(np.arange(60, 92) / 1000.0, dims="design")
    thread = {"width": 0.01, "thickness": 0.01, "density": 0.0}
    machine = ls.Linkage(
        "crank A-B-K, coupler B-C, rocker D-C",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.0)},
        points={"K": (0.051, angle)},
        crank=ls.Bar(lengths, width=0.02, thickness=0.01, density=0.0),
        coupler=ls.Bar(0.4, **thread),
        rocker=ls.Bar(0.4, **thread),
    )
    pull = [
        ls.Load("crank", force=(way * 1000.0, 0.0), at=(abs(at), 180.0 * (at < 0.0)), frame="link")
        for way, at in zip((-1.0, 1.0), ends, strict=True)
    ]
    ds = ls.strength(ls.Scene(machine, omega2=10.0, loads=pull), STEEL, links="crank", stress_concentration=3.0)
    np.testing.assert_allclose(ds.stress, 3.0 * 1000.0 / (0.02 * 0.01), rtol=1e-12)


def test_designs_are_independent_and_sections_may_lack_moments():
    press = ls.example("press")
    lengths = xr.DataArray([0.2, 0.22, 0.24], dims="design")
    many = replace(press, mechanism=replace(press.mechanism, coupler=replace(press.mechanism.coupler, length=lengths)))
    ds = ls.strength(many, STEEL, stress_concentration=2.0)
    one = ls.strength(ls.scene_at(many, design=1), STEEL, stress_concentration=2.0)
    for name in one.data_vars:
        xr.testing.assert_equal(one[name].reset_coords(drop=True), ds[name].isel(design=1).reset_coords(drop=True))
    rod = ls.Link(0.22, 0.68, 2.8e-3, cg_distance=0.11, section=ls.Section(4e-4, 1.3e-6))
    plain = replace(press, mechanism=replace(press.mechanism, coupler=rod))
    assert np.isnan(ls.strength(plain, STEEL, links="coupler").buckling_safety).all()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"links": "coupler"}, "links: coupler of this FourBar is no beam: it has no cross-section"),
        ({"material": "S235"}, "material = 'S235': must be a Material"),
        ({"material": {"crank": STEEL}}, "material: none for rocker"),
        ({"stress_concentration": 0.5}, "stress_concentration = 0.5: must be at least 1"),
        ({"effective_length": 1.0}, "effective_length = 1.0: must be two, in and across the plane"),
        ({"links": []}, r"links = \[\]: names no link; leave it out for all"),
    ],
)
def test_bad_requests_are_refused_in_a_sentence(change, sentence):
    press = ls.example("press")
    scene = replace(press, mechanism=replace(press.mechanism, coupler=ls.Link(0.22, 0.68, 2.8e-3)))
    with pytest.raises(ValueError, match=sentence.replace("(", r"\(")):
        ls.strength(scene, **{"material": STEEL, **change})


def test_a_report_has_the_strength_of_links_where_a_material_is_stated(tmp_path):
    press = ls.example("press")
    ls.report(press, tmp_path / "page.html", material=STEEL)
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    stresses = ls.strength(press, STEEL).stress.values
    assert all(f'value="{stress / 1e6!r}"' in page for stress in map(float, stresses))
    assert page.count("Bending moment of the") == 3
    with pytest.raises(ValueError, match="material: strength is of the whole cycle; leave out theta2"):
        ls.report(press, tmp_path / "page.html", material=STEEL, theta2=(10.0, 50.0))


def test_pins_reach_their_allowable_stresses():
    press, eye, arm = ls.example("press"), 0.02, 0.008
    limits = {"shear": 60e6, "pressure": 15e6, "bending": 120e6}
    ds = ls.size_pins(press, allowable=limits, eye=eye, fork=dict.fromkeys("ABCD", arm))
    force = ls.peaks(press, of=["F32"]).F32_peak
    d = ds.diameter_for.sel(pin="B")
    reached = {
        "shear": 2.0 * force / (np.pi * d.sel(criterion="shear") ** 2),
        "pressure": force / (2.0 * arm * d.sel(criterion="pressure")),
        "bending": 32.0 * force * (eye + 2.0 * arm) / 8.0 / (np.pi * d.sel(criterion="bending") ** 3),
    }
    for name, limit in limits.items():
        assert float(reached[name]) == pytest.approx(limit, rel=1e-12)
    assert str(ds.criterion.values[int(ds.governing.sel(pin="B"))]) == "bending"


def test_measures_may_have_units():
    unit, press = pint.UnitRegistry(), ls.example("press")
    plain = ls.size_pins(
        press, allowable={"shear": 60e6, "pressure": 15e6}, eye=0.02, fork=dict.fromkeys("ABCD", 0.0127)
    )
    limits = {"shear": "60 MPa", "pressure": 15.0 * unit.MPa}
    sized = ls.size_pins(press, allowable=limits, eye=20.0 * unit.mm, fork=dict.fromkeys("ABCD", "0.5 in"))
    xr.testing.assert_allclose(sized, plain, rtol=1e-15)
    gap = ls.contact_loss(press, {"B": 50.0 * unit.um}, theta2=4).knock
    xr.testing.assert_allclose(gap, ls.contact_loss(press, {"B": "0.05 mm"}, theta2=4).knock, rtol=1e-15)
    steel = ls.Material(210.0 * unit.GPa, "235 MPa", 360.0 * unit.MPa, "180 MPa")
    assert steel == STEEL


def test_what_governs_a_pin_is_a_word_in_any_units():
    limits = {"shear": 60e6, "bending": 120e6}
    ds = ls.size_pins(ls.example("press"), allowable=limits, eye=0.02)
    assert "units" not in ds.governing.attrs
    with ls.units("US"):
        assert re.search(r"governing: +bending\n", str(ds.linksweep))


def test_a_bar_that_only_its_own_inertia_loads_reaches_no_other_safety():
    scene = turning()
    light = replace(scene, mechanism=replace(scene.mechanism, coupler=ls.Bar(0.8, 1e-3, 1e-3, 0.0)))
    ds = ls.size_links(light, STEEL, safety=1e3, links="crank")
    assert int(ds.status.sel(link="crank")) == 1 and np.isnan(ds.thickness).all()


def test_a_link_of_a_machine_that_cannot_be_assembled_has_no_place_of_its_largest_stress():
    press = ls.example("press")
    crank = replace(press.mechanism.crank, length=xr.DataArray([0.08, 5.0], dims="k"))
    ds = ls.strength(replace(press, mechanism=replace(press.mechanism, crank=crank)), STEEL).sel(link="coupler")
    np.testing.assert_array_equal(ds.status, [0, 2])
    for name in ("stress", "stress_section", "stress_at", "fatigue_section"):
        np.testing.assert_array_equal(np.isnan(ds[name]), [False, True])


def test_each_of_many_designs_is_sized_as_one():
    press = replace(ls.example("press"), omega2=xr.DataArray([30.0, 100.0], dims="speed"))
    safeties = xr.DataArray([2.0, 1.5], dims="required")
    many = ls.size_links(press, STEEL, safety=safeties, stress_concentration=2.5)
    one = ls.size_links(ls.scene_at(press, speed=1), STEEL, safety=1.5, stress_concentration=2.5)
    assert (many.status == 0).all()
    np.testing.assert_allclose(many.thickness.sel(speed=1, required=1), one.thickness, rtol=1e-6)


def test_an_unbounded_cycle_of_stress_has_no_safety():
    """A crank longer than all others moves over part of a turn, between toggles at which forces are unbounded."""
    crank, coupler, rocker = (ls.Bar(length, 0.02, 0.02, 7850.0) for length in (0.2, 0.12, 0.18))
    scene = ls.Scene(ls.FourBar(crank, coupler, rocker, ground=0.15), omega2=10.0, gravity=(0.0, -9.81))
    ds = ls.strength(scene, STEEL)
    assert np.isinf(ds.stress).all()
    for safety in (ds.yield_safety, ds.goodman_safety, ds.soderberg_safety):
        assert (safety == 0.0).all()


@pytest.mark.parametrize("size", [ls.strength, partial(ls.size_links, safety=2.0)])
def test_both_branches_are_refused(size):
    press = ls.example("press")
    with pytest.raises(ValueError, match=r'branch = "both": must be one of open, crossed; take one with ls.scene_at'):
        size(replace(press, mechanism=replace(press.mechanism, branch="both")), STEEL)


def test_the_force_of_a_turning_bar_turns_with_it():
    """γ' = ω, γ'/F = 2/(m ω L) and knock = m c ω²/F = 2c/L at the pivot of a turning bar."""
    scene = turning()
    ds = ls.contact_loss(scene, {"A": 1e-4}, theta2=24).sel(pin="A")
    assert np.allclose(ds.turning_rate, 50.0, rtol=1e-9) and np.allclose(ds.knock, 2e-4 / 0.3, rtol=1e-9)
    mass = scene.mechanism.crank.mass
    assert np.allclose(ds.turning_per_force, 2.0 / (mass * 50.0 * 0.3), rtol=1e-9)


@pytest.mark.parametrize("beside", [0.3, 0.045, 1e-3, 1e-4])
def test_forces_turn_faster_towards_the_end_of_an_arc(beside):
    """A little further on the machine does not close; the rate is that of the angle between two forces close by."""
    press = ls.example("press")
    half = replace(press, mechanism=replace(press.mechanism, ground=0.45))
    in_line = (0.08**2 + 0.45**2 - (0.22 + 0.18) ** 2) / (2.0 * 0.08 * 0.45)  # coupler and rocker
    angle, step = np.degrees(np.arccos(in_line)) - beside, 1e-3 * beside
    around = ls.sweep(half, [angle - step, angle + step], of=["F43x", "F43y"])
    before, after = np.arctan2(around.F43y, around.F43x).values
    expected = (after - before) / np.radians(2.0 * step) * press.omega2
    ds = ls.contact_loss(half, {"C": 5e-5}, theta2=[angle])
    assert (ds.status == 0).all()
    assert float(ds.turning_rate.sel(pin="C")[0]) == pytest.approx(expected, rel=1e-4)


def test_a_pin_without_a_clearance_knocks_nowhere():
    """Also where its force vanishes."""
    light = ls.Bar(0.2, **THREAD)
    scene = ls.Scene(ls.FourBar(light, replace(light, length=0.3), replace(light, length=0.3), ground=0.25), omega2=9.0)
    knock = ls.contact_loss(scene, {"B": 5e-5}, theta2=4).knock
    assert np.isinf(knock.sel(pin="B")).all()
    assert knock.sel(pin=["A", "C", "D"]).isnull().all()


def test_the_tube_and_the_bar_have_the_moments_of_their_shapes():
    tube, rod = ls.Tube(0.03, inner=0.02), ls.Tube(0.03)
    assert tube.second_moment == pytest.approx(np.pi / 64 * (0.03**4 - 0.02**4), rel=1e-14)
    assert rod.modulus == pytest.approx(np.pi / 32 * 0.03**3, rel=1e-14)
    bar = ls.Bar(0.2, width=0.03, thickness=0.01, density=1.0).section
    assert bar.modulus == pytest.approx(0.01 * 0.03**2 / 6) and bar.second_moment_across == pytest.approx(
        0.03 * 0.01**3 / 12
    )
    with pytest.raises(ValueError, match=r"inner = 0\.03 m: must be less than outer = 0\.03 m"):
        ls.Tube(0.03, inner=0.03)


def test_flanges_of_half_the_height_leave_no_room_for_a_web():
    with pytest.raises(ValueError, match=r"^flange = 0\.05 m: must be less than half the height = 0\.05 m$"):
        ls.IBeam(0.1, 0.05, 0.005, 0.05)
    some = xr.DataArray([0.02, 0.05], dims="design")
    with pytest.raises(ValueError, match=r"^flange = .*: must be less than half the height = 0\.05 m$"):
        ls.IBeam(0.1, 0.05, 0.005, some)
    assert ls.IBeam(0.1, 0.05, 0.005, 0.0499).area == pytest.approx(2 * 0.05 * 0.0499 + 0.005 * 0.0002, rel=1e-12)


@pytest.mark.parametrize("value", [None, True, [0.1], (0.1,), {}, 1j, np.array([0.1, 0.2]), b"1", ls.Tube], ids=repr)
def test_the_machine_says_which_measure_of_a_section_is_no_number(value):
    for name, section in (
        ("outer", ls.Tube(value)), ("inner", ls.Tube(0.1, value)), ("height", ls.IBeam(value, 0.05, 0.005, 0.008)),
        ("web", ls.IBeam(0.1, 0.05, value, 0.008)), ("flange", ls.IBeam(0.1, 0.05, 0.005, value)),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=rf"^crank\.section\.{name}\b"):
            replace(ls.example("press").mechanism, crank=ls.Link(0.08, 0.4, 3e-4, section=section))
