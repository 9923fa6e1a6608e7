"""Results read well: the accessor prints what the command line prints, in the units that were chosen."""

import re
from dataclasses import replace

import numpy as np
import pint
import pytest
import xarray as xr

import linksweep as ls
from linksweep.cli.main import main
from linksweep.scene.shown_units import unit_system
from linksweep.tables.table import Table

PRESS = ls.example("press")
BEARINGS = dict.fromkeys("ABCD", ls.Bearing(capacity=5000.0))


def cells(text: str) -> list[list[str]]:
    """Return the cells of each line, which are two spaces apart."""
    return [re.split(r" {2,}", line.strip()) for line in text.splitlines()]


ANSWERS = {
    "peaks": lambda: ls.peaks(PRESS),
    "check": lambda: ls.check(PRESS),
    "bearings": lambda: ls.bearings(PRESS, BEARINGS),
    "orders": lambda: ls.orders(ls.sweep(PRESS, of=["Fsx", "Fsy"]), ["Fsx", "Fsy"]),
}
OPTIONS = {"bearings": ["--capacity", "5 kN"]}


@pytest.mark.parametrize("command", ANSWERS)
def test_a_result_prints_as_the_command_does(command, capsys):
    assert main([command, "press", *OPTIONS.get(command, [])]) == 0
    assert f"{ANSWERS[command]().linksweep}\n" == capsys.readouterr().out


def test_a_notebook_shows_the_same_cells():
    peaks = ls.peaks(PRESS, of=["F32", "T12"]).linksweep
    page = peaks._repr_html_()
    lines = [re.findall(r"<t[hd][^>]*>([^<]*)</t[hd]>", line) for line in re.findall(r"<tr>(.*?)</tr>", page)]
    assert lines == cells(repr(peaks))
    assert 'title="largest magnitude of the force of link 3 (coupler) on link 2 (crank) at pin B"' in page


def test_text_of_a_page_is_escaped():
    page = Table(("<b>",), [("a & b",)], meanings={"a & b": 'say "no"'}).html()
    assert "&lt;b&gt;" in page and "a &amp; b" in page and "say &quot;no&quot;" in page


def test_values_angles_and_flags_of_any_result():
    swing = cells(repr(ls.geometry(PRESS).linksweep))
    motion = ls.geometry(PRESS)
    assert ["swing", f"{float(motion.swing):.6g}", "°"] in swing
    assert ["reversal_angle (folded)", f"{float(motion.reversal_angle[1]):.6g}", "°"] in swing
    least = f"{float(motion.transmission_angle_min):.6g}"
    assert ["transmission_angle_min", least, "°", f"{float(motion.transmission_angle_min_at):.2f}°"] in swing
    cycle = ls.sweep(PRESS, of=["T12"])
    lowest, highest = int(cycle.T12.argmin("theta2")), int(cycle.T12.argmax("theta2"))
    ends = (f"{float(cycle.T12[k]):.6g}" for k in (lowest, highest))
    angles = (f"{0.5 * k:.2f}°" for k in (lowest, highest))
    row = [cell for pair in zip(ends, angles, strict=True) for cell in pair]
    assert cells(repr(cycle.linksweep)) == [
        ["quantity", "least", "at theta2", "largest", "at theta2", "unit"],
        ["T12", *row, "N m"],
        [""],
        ["status:", "ok"],
    ]


def test_flags_that_differ_are_counted():
    rocker = replace(PRESS, mechanism=replace(PRESS.mechanism, crank=ls.Bar(0.25, 0.02, 0.02, 7750.0)))
    cycle = ls.sweep(rocker, 360, of=["T12"])
    failed = int((cycle.status == 1).sum())
    assert 0 < failed < 360
    assert f"status:  ok {360 - failed}, cannot-assemble {failed}" in repr(cycle.linksweep)


def test_designs_left_out_by_a_condition_have_no_value():
    """`Dataset.where` makes the status of what it leaves out NaN, and a number of the others."""
    designs = ls.peaks(ls.grid(PRESS, {"coupler.length": [0.2, 0.22, 0.24]}), of=["F32"])
    some = designs.where(designs["coupler.length"] < 0.23)
    assert repr(some.linksweep).splitlines()[-1] == "designs: 3 (coupler.length 3): ok 2, no value 1"
    none = ls.pareto(designs.where(designs.F32_peak < 0.0), minimize="F32_peak").linksweep
    assert ["F32_peak", "none"] in cells(repr(none)) and "designs: 0 (coupler.length 0): none" in repr(none)
    cycle = ls.sweep(PRESS, 12, of=["F32"])
    assert "status:  ok 3, no value 9" in repr(cycle.where(cycle.theta2 < 90.0).linksweep)


def test_a_part_of_a_result_has_the_table_of_any():
    assert cells(repr(ls.peaks(PRESS)[["F32_peak"]].linksweep))[0] == ["quantity", "value", "unit"]
    assert repr(ls.peaks(PRESS)[["status"]].linksweep) == "status:  ok"


def test_a_breakdown_of_samples_says_that_its_angle_is_one_of_them():
    press = ls.example("press")
    samples, exact = (str(ls.breakdown(press, "F32", theta2=theta2).linksweep) for theta2 in (720, [300.2727]))
    assert "F32 at theta2 = 300.50°, largest of 720 samples" in samples
    assert "F32 at theta2 = 300.27°  share" in exact


def test_a_sampled_study_names_its_best_and_worst():
    study = ls.peaks(ls.sample(PRESS, {"omega2": (20.0, 30.0)}, n=8), of=["F32"])
    text = repr(study.linksweep)
    assert ["F32_peak", f"{float(study.F32_peak.min()):.6g}", "N", str(np.argmin(study.F32_peak.values))] in cells(text)
    assert text.endswith("designs: 8 (design 8): ok 8")


def test_lazy_results_are_not_computed():
    dask = pytest.importorskip("dask")
    lazy = ls.sweep(PRESS, 24).chunk({"theta2": 12})
    with dask.config.set(scheduler=lambda *graph, **options: pytest.fail("computed")):
        assert repr(lazy.linksweep).endswith("Not computed yet: call .compute().")


# ------------------------------------------------------------------------------------------- units


SHOWN = [
    ("US", "m", "in"), ("US", "N m", "lbf in"), ("US", "kg m^2", "lb in^2"), ("US", "N m s/rad", "lbf in s/rad"),
    ("US", "kg/m^3", "lb/in^3"), ("US", "Pa m/s", "psi in/s"), ("US", "rad/s", "rpm"), ("US", "W", "hp"),
    ("US", "N s^2/rad^2", "lbf s^2/rad^2"), ("US", "J", "lbf in"), ("US", "kg m", "lb in"), ("US", "1", "1"),
    ("mm", "m", "mm"), ("mm", "N m", "N m"), ("mm", "m/s^2", "m/s^2"), ("mm", "N/m", "N/mm"), ("mm", "Pa", "MPa"),
    ("ft, lbf, slug", "kg m^2/rad", "slug ft^2/rad"), ("cm, N", "N m", "N cm"), ("lbf ft", "N m", "lbf ft"),
    ("SI", "kg m^2", "kg m^2"), ("US", "degree", "degree"), ("US", "megarevolution", "megarevolution"),
]  # fmt: skip


@pytest.mark.parametrize(("system", "si", "unit"), SHOWN)
def test_units_follow_from_those_chosen(system, si, unit):
    """pint agrees about the size of each unit, which is put together from its factors."""
    pints = pint.UnitRegistry()
    made = unit_system(system)
    assert made.unit(si) == unit
    expected = 1.0 if si == unit else float(pints.Quantity(1.0, unit).to(si).magnitude)
    assert made.size(si) == pytest.approx(expected, rel=1e-14)
    assert made.value(12.5, si) == pytest.approx(12.5 / expected, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("in, lbd", r'units: "lbd" is no unit; did you mean "lb"\?; write "SI", "US", "mm", or units as in'),
        ("in, mm", 'units = "in, mm": "in" and "mm" are both units of length; keep one'),
        (3, "units: 3 is no unit"),
        (["in", "lbf"], r'units: \["in", "lbf"\] is no unit; write "SI", "US", "mm", or units as in'),
    ],
)
def test_units_that_are_none_are_refused(text, message):
    with pytest.raises(ValueError, match=message):
        ls.units(text)
    with pytest.raises(ValueError, match=message):
        replace(PRESS, units=text)


def test_a_session_has_units_and_gives_them_back():
    force = ls.peaks(PRESS, of=["F32"])
    before = repr(force.linksweep)
    with ls.units("US") as chosen:
        assert "lbf in" in repr(chosen)
        pounds = f"{float(force.F32_peak) / 4.4482216152605:.6g}"
        assert cells(repr(force.linksweep))[1][:3] == ["F32_peak", pounds, "lbf"]
        with ls.units(None):
            assert repr(force.linksweep) == before
        assert repr(force.linksweep) != before
    assert repr(force.linksweep) == before
    assert force.F32_peak.units == "N"  # the Dataset stays as it is


def test_pressures_are_in_megapascals_in_every_length():
    """A pressure times a speed in cm/s is 100 times that in m/s."""
    bush = {"B": ls.Bearing(diameter=0.02, length=0.03)}
    rows = {}
    for units in ("SI", "kN, cm"):
        with ls.units(units):
            head, _, row, *_ = cells(repr(ls.bearings(PRESS, bush, theta2=36).linksweep))
        rows |= {title: float(number) for title, number in zip(head[-2:], row[-2:], strict=True)}
    assert rows["PV of samples [MPa cm/s]"] == pytest.approx(100.0 * rows["PV of samples [MPa m/s]"], rel=1e-3)
    assert len(rows) == 3 and "pressure [MPa]" in rows


def test_a_scene_states_its_own_units(tmp_path, monkeypatch, capsys):
    scene = replace(PRESS, units="in, lbf, rpm")
    ls.save(scene, tmp_path / "press.toml")
    assert ls.load_scene(tmp_path / "press.toml") == scene != PRESS
    results = [ls.peaks(scene), ls.duty(scene), ls.compare(scene, scene, of=["F32_peak"], theta2=24)]
    assert all("lbf" in repr(ds.linksweep) and " N" not in repr(ds.linksweep) for ds in results)
    with ls.units("SI"):
        assert not any("lbf" in repr(ds.linksweep) for ds in results)
    assert main(["peaks", str(tmp_path / "press.toml")]) == 0
    assert capsys.readouterr().out == f"{results[0].linksweep}\n"
    np.testing.assert_array_equal(results[0].F32_peak, ls.peaks(PRESS).F32_peak)  # in SI, to the bit
    ls.save(results[0], tmp_path / "peaks.nc")
    assert ls.load_scene(tmp_path / "peaks.nc") == scene


def test_every_machine_is_checked_in_the_same_words():
    """The arcs of one design are one line, on every machine the four-bar's."""
    for name in ("press", "engine", "quick-return", "knuckle-press"):
        titles = {title.removesuffix(":"): text for title, text in cells(str(ls.check(ls.example(name)).linksweep))}
        assert titles["can be assembled"] == "everywhere"
        assert titles["at theta2 from"] == "0.0000° to 360.0000°"
        assert titles["toggles at theta2"] == "none"


def test_the_worst_of_designs_is_one_whose_force_is_unbounded():
    """The crank meets toggles where the shortest and the longest link are longer than the others together."""
    lengths = [0.2, 0.09, 0.24]
    (rocking,) = (coupler for coupler in lengths if coupler + 0.18 < 0.08 + 0.2)
    rows = cells(repr(ls.peaks(ls.grid(PRESS, {"coupler.length": lengths}), of=["F32", "T12"]).linksweep))
    worst = {name: (value, rest[-1]) for name, value, *rest in rows[1:4]}
    values = {"F32_peak": "inf", "T12_max": "inf", "T12_min": "-inf"}
    assert worst == {name: (value, f"{rocking}") for name, value in values.items()}
    best = next(row for row in rows[4:] if row[0] == "F32_peak")
    assert np.isfinite(float(best[1])) and best[-1] in ("0.2", "0.24")


def test_places_along_a_link_are_no_designs():
    lengths = [0.2, 0.22]
    moments = [
        ls.sweep(replace(PRESS, mechanism=replace(PRESS.mechanism, coupler=bar)), 3600, of=["bending_moment3"])
        for bar in (ls.Bar(length, 0.02, 0.02, 7750.0) for length in lengths)
    ]
    largest = [float(ds.bending_moment3.max()) for ds in moments]
    table = repr(ls.peaks(PRESS, of=["bending_moment3"]).linksweep)
    header, row = cells(table)[:2]
    assert header == ["quantity", "value", "unit", "at theta2", "at section"]
    assert float(row[1]) == pytest.approx(largest[1], rel=1e-5)
    assert row[-1] == f"{float(moments[1].bending_moment3.max('theta2').idxmax()):g}"
    assert "best" not in table and "designs" not in table
    table = repr(ls.peaks(ls.grid(PRESS, {"coupler.length": lengths}), of=["bending_moment3"]).linksweep)
    least = next(row for row in cells(table) if row[0] == "bending_moment3_peak")
    assert float(least[1]) == pytest.approx(min(largest), rel=1e-5)
    assert least[-1] == f"{lengths[int(np.argmin(largest))]}"
    assert table.splitlines()[-1] == "designs: 2 (coupler.length 2): ok 2"
    short = replace(PRESS, mechanism=replace(PRESS.mechanism, coupler=ls.Bar(0.09, 0.02, 0.02, 7750.0)))
    assert "Some quantity grows without bound" in repr(ls.peaks(short, of=["bending_moment3"]).linksweep)


def test_the_best_transmission_angle_is_the_largest_of_the_least():
    """The least angle is that of the crank in line with the ground, by the law of cosines."""
    lengths = [0.18, 0.2, 0.22]
    table = repr(ls.peaks(ls.grid(PRESS, {"coupler.length": lengths}), of=["transmission_angle"]).linksweep)
    crank, rocker, ground = 0.08, 0.18, 0.2

    def least(coupler: float) -> float:
        squares = ((ground + sign * crank) ** 2 for sign in (1, -1))
        angles = [np.degrees(np.arccos((coupler**2 + rocker**2 - s) / (2.0 * coupler * rocker))) for s in squares]
        return min(min(angle, 180.0 - angle) for angle in angles)

    best = max(lengths, key=least)
    assert ["transmission_angle_min", f"{least(best):.6g}", "°", f"{best}"] in cells(table)
    assert "least peak" not in table


def test_a_machine_that_reaches_its_toggle_has_an_acute_angle_of_0_there():
    short = ls.FourBar(*(ls.Bar(length, 0.02, 0.02, 7750.0) for length in (0.08, 0.1, 0.1)), ground=0.2)
    rows = cells(repr(ls.peaks(ls.Scene(short, omega2=30.0), of=["transmission_angle"]).linksweep))
    assert ["transmission_angle_min", "0", "°"] in [row[:3] for row in rows]


def test_a_machine_that_cannot_be_assembled_has_no_peaks():
    apart = replace(PRESS, mechanism=replace(PRESS.mechanism, ground=xr.DataArray([5.0], dims="place")))
    table = repr(ls.peaks(apart, of=["F32"]).linksweep)
    assert ["F32_peak", "none"] in cells(table)
    assert "It has no result at any crank angle: cannot assemble." in table


def test_a_torque_that_is_only_rounding_prints_as_zero():
    """A press whose loads do no work needs no mean torque; a crank without flywheel and motor carries none."""
    assert ["constant torque", "0", "N m"] in cells(str(ls.flywheel(PRESS, fluctuation=0.05).linksweep))
    assert ["T12_peak", "0", "N m"] in cells(str(ls.run_down(PRESS, of=["T12"]).linksweep))


def test_a_crank_that_does_not_come_round_has_no_work_and_no_flywheel():
    """Pins that would be 0.28 m apart, of two links of 0.1 m each, part: forces are without bound there, not 0."""
    short = ls.FourBar(*(ls.Bar(length, 0.02, 0.02, 7750.0) for length in (0.08, 0.1, 0.1)), ground=0.2)
    scene, sentence = ls.Scene(short, omega2=30.0), "It does not turn all the way round at that speed"
    duty, wheel = str(ls.duty(scene).linksweep), str(ls.flywheel(scene, fluctuation=0.02).linksweep)
    assert ["largest torque", "inf", "N m"] in cells(duty) and ["work in a cycle", "none", "J"] in cells(duty)
    assert ["its inertia", "none", "kg m^2"] in cells(wheel) and ["least speed", "none", "rad/s"] in cells(wheel)
    assert duty.splitlines()[-1].startswith(sentence) and wheel.splitlines()[-1].startswith(sentence)


def test_a_flywheel_too_small_to_pass_a_cycle_is_said_to_stall():
    """A torque of 40 N m that takes and gives 80 J, on a crank whose whole kinetic energy is less than 1 J."""
    pulsing = ls.Load("crank", torque=lambda theta2: 40.0 * np.sin(np.radians(theta2)))
    table = str(ls.flywheel(ls.Scene(PRESS.mechanism, omega2=0.3, loads=[pulsing]), inertia=1e-9).linksweep)
    assert ["fluctuation", "none"] in cells(table)
    assert table.splitlines()[-1] == "Its mean speed cannot be kept: the crank would stall on the way."
