"""The report page: numbers of peaks, check and duty; one self-contained file; warnings at the top."""

import base64
import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from unittest import mock

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from html_page import Page

import linksweep as ls
from linksweep.cli.main import main
from linksweep.reports import figures as page_figures
from linksweep.reports import scene_tables
from linksweep.reports.markup import Markup, tag
from linksweep.reports.page import page
from linksweep.scene.file.reading import parse_scene

STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750}


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def undrawn_figures():
    """Replace the drawing of figures, which takes long."""
    return mock.patch.object(page_figures, "_image", lambda figure, title: tag("img", src="data:,", alt=title))


@pytest.fixture
def undrawn():
    with undrawn_figures():
        yield


@cache
def text_of(name: str) -> str:
    with undrawn_figures():
        return page(ls.example(name), f"{name} <small> & Söhne")


def demo(name: str) -> Page:
    return Page(text_of(name))


@pytest.fixture(scope="module")
def press() -> str:
    return text_of("press")


def bar(length: float) -> ls.Bar:
    return ls.Bar(length, **STEEL)


def double_rocker(**words) -> ls.Scene:
    return ls.Scene(ls.FourBar(bar(0.20), bar(0.22), bar(0.18), ground=0.45), omega2=10.0, **words)


def read_back(text: str) -> float:
    """Return the value of a printed number."""
    raised = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
    mantissa, _, power = text.replace("\u202f", "").replace("−", "-").replace("∞", "inf").partition("·10")
    return float(mantissa) * 10.0 ** int(power.translate(raised) or 0)


# --------------------------------------------------------------------------------------------- numbers


def assert_peaks_are(report: Page, peaks: xr.Dataset, forces: dict[str, str]) -> None:
    """Check that the table's rows, in order, have the values and angles of `peaks`."""
    rows = iter(report.sections["Peaks"][1:])
    for name, title in forces.items():
        for ending in ("_max", "_min") if f"{name}_max" in peaks else ("_peak",):
            row = next(rows)
            assert row[0][0] == title
            assert row[2][1] == [float(peaks[name + ending])]
            assert row[3][1] == [float(peaks[f"{name}{ending}_at"])]
    assert next(rows, None) is None


@pytest.mark.parametrize(
    ("name", "forces"),
    [
        ("engine", {"F12": "F₁₂", "F32": "F₃₂", "F43": "F₄₃", "F14": "F₁₄", "T12": "T₁₂"}),
        ("quick-return", {"F12": "F₁₂", "F32": "F₃₂", "F43": "F₄₃", "F14": "F₁₄", "T43": "T₄₃", "T12": "T₁₂"}),
        ("loop", {"normal_force": "normal force"}),
    ],
)
def test_the_table_of_peaks_equals_peaks(name, forces):
    assert_peaks_are(demo(name), ls.peaks(ls.example(name)), forces)


def test_a_press_in_numbers(press):
    scene, report = ls.example("press"), Page(press)
    forces = {"F12": "F₁₂", "F32": "F₃₂", "F43": "F₄₃", "F14": "F₁₄", "T12": "T₁₂"}
    assert_peaks_are(report, ls.peaks(scene), forces)
    summaries = ls.peaks(scene, of=["F43_bound", "F43_mean", "F43_rms"])
    row = report.rows("Peaks")["F₄₃"]
    assert row[0][0] == "pin C: rocker on coupler"
    assert [row[k][1][0] for k in (3, 4, 5)] == [float(summaries[f"F43_{kind}"]) for kind in ("bound", "mean", "rms")]
    checks, check = report.rows("Checks"), ls.check(scene)
    assert checks["Grashof class"][0][0] == "crank-rocker"
    assert checks["transmission angle"][0][1][0] == pytest.approx(float(check.transmission_angle_min), rel=1e-9)
    assert checks["transmission angle"][1][0] == "caution"  # 33° are less than the usual 40°
    assert checks["toggles"] == [("none", []), ("ok", [])]
    duty, drive = ls.duty(scene), report.rows("Drive")
    assert drive["power"][0][1] == pytest.approx([float(duty.power_min), float(duty.power_max)], rel=1e-9)
    assert drive["work fed in a cycle"][0][1] == [float(duty.work_fed)]
    wheel = ls.flywheel(scene, fluctuation=0.02)
    assert drive["flywheel for 2 % fluctuation"][0][1] == [pytest.approx(float(wheel.flywheel_inertia), rel=1e-12)]
    geometry = ls.geometry(scene)
    assert report.rows("Geometry")["swing of the rocker"][0][1] == [float(geometry.swing)]
    assert report.rows("Geometry")["turns round at"][0][1] == geometry.reversal_angle.values.tolist()
    shaking = ls.peaks(scene, of=["Fs", "Fs_rms"])
    force = [float(shaking.Fs_peak), float(shaking.Fs_peak_at), float(shaking.Fs_rms)]
    assert report.rows("Shaking, by the inertia of the links")["force"][0][1] == force


def test_printed_numbers_are_rounded_values(press):
    numbers = Page(press).numbers
    assert len(numbers) > 50
    for text, value in numbers:
        if text == "0":  # terms that cancel: work and mean torque of a press without friction
            assert abs(value) < 1e-10
        else:
            assert read_back(text) == pytest.approx(value, rel=0.03 if "·10" in text else 6e-4, abs=0.051)


def test_the_table_of_links_has_the_sliders_centre_of_gravity():
    """The row has number, length, mass, inertia and position."""
    crank, rod = ls.Bar(0.05, **STEEL), ls.Bar(0.15, **STEEL)
    for place, text in (((0.0, 0.0), "on its pin"), ((0.02, 30.0), "20 mm at 30°")):
        slider = dict(zip(("slider_cg_distance", "slider_cg_angle"), place, strict=True))
        table = scene_tables.links(ls.Scene(ls.SliderCrank(crank, rod, 0.5, **slider), 30.0))
        cells = re.findall("<td>(.*?)</td>", str(table).replace("\u202f", " "))
        assert text in cells


def test_inputs_are_printed_in_readable_units(press):
    report = Page(press)
    links = {row[0][0]: [cell[0].replace("\u202f", " ") for cell in row[1:]] for row in report.sections["Machine"]}
    # 7750 kg/m³ · 80 mm · 20 mm · 20 mm; m (L² + w²)/12
    assert links["2 crank"] == ["80 mm", "0.248 kg", "1.4053·10⁻⁴ kg m²", "40 mm at 0°", "bar 20 × 20 mm, 7750 kg/m³"]
    rows = report.rows("Motion") | report.rows("Machine")
    text = {key: cells[0][0].replace("\u202f", " ") for key, cells in rows.items()}
    assert text["ground"] == "200 mm"
    assert text["speed of the crank"] == "300 rpm (31.416 rad/s) counter-clockwise"
    assert text["gravity"] == "9.81 m/s² down"
    assert text["load 1"] == "(0, −355.86) N on the coupler, 100 mm at 15° from its first pin"  # 80 lbf
    assert text["load 2"] == "−12 N m on the rocker"


def test_loads_of_all_kinds_are_described():
    machine = ls.example("press").mechanism
    loads = [
        ls.Spring(("ground", 0.3, 0.0), ("rocker", 0.1, 0.0), rate=2000.0, free_length=0.05),
        ls.TorsionDamper("ground", "crank", coefficient=0.2),
        ls.Load("rocker", torque=lambda theta2: 3.0 * np.sin(np.radians(theta2))),
    ]
    scene = ls.Scene(machine, omega2=-20.0, alpha2=5.0, loads=loads)
    rows = Page(tag("h2", "All") + scene_tables.settings(scene) + scene_tables.loads(scene)).rows("All")
    text = {key: cells[0][0].replace("\u202f", " ") for key, cells in rows.items()}
    assert text["speed of the crank"] == "190.99 rpm (20 rad/s) clockwise"
    assert text["its acceleration"] == "5 rad/s²"
    ends = "from ground at (300 mm, 0 mm), to rocker, 100 mm at 0° from its first pin"
    assert text["load 1"] == f"Spring ({ends}, rate 2 N/mm, free length 50 mm)"
    assert text["load 2"] == "Torsion damper (from ground, to crank, coefficient 0.2 N m s/rad)"
    assert text["load 3"] == "−3 to 3 N m on the rocker"
    assert text["gravity"] == "none"


def test_a_crank_with_alpha2_beside_a_constant_speed_has_no_work_of_a_cycle(tmp_path):
    ls.report(replace(ls.example("press"), alpha2=-40.0), tmp_path / "page.html")
    drive = Page((tmp_path / "page.html").read_text("utf-8")).rows("Drive")
    assert "power" in drive and "work fed in a cycle" not in drive


def test_the_page_contains_the_scene(press):
    assert parse_scene(Page(press).texts["pre"]) == ls.example("press")


@pytest.mark.parametrize(("name", "is_named"), [("press", True), ("loop", False)])
def test_the_page_names_the_command_that_changes_its_numbers(name, is_named):
    assert ("<code>linksweep explore scene.toml</code>" in text_of(name)) == is_named


# ------------------------------------------------------------------------------------- contents


@pytest.mark.parametrize("name", ["press", "loop"])
def test_the_page_is_self_contained(name):
    with mock.patch.object(page_figures, "of_bearings_and_shaking", return_value=Markup()):  # four are enough
        text = page(ls.example(name))
    report = Page(text)
    assert text.startswith("<!DOCTYPE html>\n")
    assert not report.tags & {"script", "link", "iframe", "object", "embed", "base"}
    assert len(report.references) == {"press": 4, "loop": 1}[name]
    assert all(reference.startswith("data:image/svg+xml;base64,") for reference in report.references)
    assert "http:" not in text and "https:" not in text and "@import" not in text and "url(" not in text
    assert "default-src 'none'" in text
    for source in report.images.values():
        drawn = base64.b64decode(source.partition(",")[2]).decode()
        assert drawn.rstrip().endswith("</svg>")
        assert all(target.startswith(("#", "data:")) for target in re.findall(r'href="([^"]*)"', drawn))


def test_figures_of_a_press(press):
    assert list(Page(press).images) == [
        "Largest pin force: F₄₃ at θ₂ = 17.6°",
        "Forces in the joints",
        "Drive torque",
        "Where the load of pin C comes from: F₄₃",
        *(f"Load of pin {pin}" for pin in ("A: F₁₂", "B: F₃₂", "C: F₄₃", "D: F₁₄")),
        "Shaking force",
        "Orders of the shaking force",
    ]


def test_names_are_escaped(press):
    assert "<h1>press &lt;small&gt; &amp; Söhne</h1>" in press
    assert Page(press).texts["h1"] == "press <small> & Söhne"


@pytest.mark.parametrize(("name", "figures"), {"press": 10, "engine": 9, "quick-return": 9, "loop": 1}.items())
def test_each_demo_has_its_sections_and_figures(name, figures):
    report = demo(name)
    linkage = {"Machine", "Motion", "Checks", "Peaks", "Geometry", "Drive"}
    shaking = "Shaking, by the inertia of the links"
    expected = {"Machine", "Checks", "Peaks", "Motion"} if name == "loop" else linkage | {shaking}
    assert report.sections.keys() == expected
    assert len(report.images) == figures
    assert not report.warning
    assert "nan" not in report.texts.get("td", "") and "–" not in report.texts["data"]
    verdicts = {row[-1][0] for row in report.sections["Checks"]}
    assert verdicts <= {"ok", "caution", ""} or name == "loop"


def test_a_report_of_an_engine_has_stroke_and_friction():
    report = demo("engine")
    assert report.rows("Geometry")["stroke of the slider"][0][0] == "86.00\u202fmm"
    assert report.rows("Drive")["work of friction"][0][1] == [float(ls.duty(ls.example("engine")).work_of_friction)]
    assert report.rows("Checks")["friction"][0][1] == [float(ls.check(ls.example("engine")).friction_to_jam), 0.05]
    assert "2 turns" in report.rows("Motion")["cycle"][0][0]


def test_a_scene_gives_the_same_bytes_whatever_the_settings():
    ls.report(ls.example("loop"), "once.html")
    with mpl.rc_context({"lines.linewidth": 9.0, "axes.facecolor": "red", "font.family": "monospace"}):
        ls.report(ls.example("loop"), "again.html")
        assert mpl.rcParams["lines.linewidth"] == 9.0
    assert Path("once.html").read_bytes() == Path("again.html").read_bytes()


# ------------------------------------------------------------------------------- warnings


def test_a_partial_revolution_is_a_warning_at_the_top(undrawn):
    scene = double_rocker()
    text = page(scene)
    report, check = Page(text), ls.check(scene)
    assert text.index('class="warning"') < text.index("<h2>")
    assert "It does not run all the way round." in report.warning
    toggle = np.degrees(np.arccos((0.20**2 + 0.45**2 - (0.22 + 0.18) ** 2) / (2.0 * 0.20 * 0.45)))
    assert f"cannot assemble from {toggle:.2f}° to {360.0 - toggle:.2f}°" in report.warning
    assert "the peak is infinite: F₁₂, F₃₂, F₄₃, F₁₄, T₁₂." in report.warning
    limits = [float(check.arc_start[0]), float(check.arc_end[0]) % 360.0]
    assert report.rows("Checks")["assembly"][0][1] == limits
    assert report.rows("Checks")["assembly"][1][0] == "caution"
    assert sorted(report.rows("Checks")["toggles"][0][1]) == sorted(limits)
    assert report.rows("Peaks")["F₁₂"][1] == ("∞\u202fN", [np.inf])
    assert [cell[0] for cell in report.sections["Peaks"][0]] == ["", "", "peak", "at θ₂", "bound"]  # there is no mean
    assert "Geometry" not in report.sections
    assert list(report.rows("Drive")) == ["power"]
    assert "Orders of the shaking force" not in report.images


def test_a_car_that_leaves_the_track(undrawn):
    car = ls.LoopTrack(radius=30.0, mass=700.0)
    scene = ls.Scene(car, speed=30.0, gravity=(0.0, -9.81), profile="energy")
    report = Page(page(scene))
    # v² = v0² − 2 R g (1 − cos θ), and the force ends where v² = −R g cos θ: cos θ = (2 − v0²/(R g))/3
    leaves = np.degrees(np.arccos((2.0 - 30.0**2 / (30.0 * 9.81)) / 3.0))
    assert report.rows("Checks")["leaves track at"][0][1] == [pytest.approx(leaves, abs=1e-9)]
    assert "does not stay on the track" in report.warning
    assert f"left track from {leaves:.2f}° to 360.0°" in report.warning


def test_a_report_without_a_result_at_any_angle(undrawn, monkeypatch):
    """The part lies where friction jams."""
    engine = ls.SliderCrank(ls.Link(0.04, 1.0, 1e-3), ls.Link(0.14, 0.5, 1e-3), slider_mass=0.5, friction=5.0)
    report = Page(page(ls.Scene(engine, omega2=100.0), part=(70.0, 75.0)))
    assert "There is no result at any angle." in report.warning
    assert "jammed" in report.warning
    assert not report.images


def test_part_of_a_turn(undrawn):
    scene = double_rocker(gravity=(0.0, -9.81))
    report = Page(page(scene, part=(-50.0, 50.0)))
    assert not report.warning
    assert report.rows("Checks")["assembly"][1][0] == report.rows("Checks")["toggles"][1][0] == "ok"
    expected = ls.peaks(scene, between=(-50.0, 50.0))
    sampled = ls.peaks(scene, theta2=np.linspace(-50.0, 50.0, 1001))
    assert float(expected.F32_peak) == pytest.approx(float(sampled.F32_peak), rel=1e-4)
    assert float(expected.F32_peak) >= float(sampled.F32_peak)
    assert_peaks_are(report, expected, {"F12": "F₁₂", "F32": "F₃₂", "F43": "F₄₃", "F14": "F₁₄", "T12": "T₁₂"})
    assert len(report.images) == 9
    beyond = Page(page(scene, part=(-70.0, 50.0)))
    assert beyond.rows("Checks")["toggles"][1][0] == "caution"
    assert "cannot assemble from −70.0° to −62.72°" in beyond.warning  # the other toggle is at 62.72°


def test_a_machine_without_mass_and_load(undrawn):
    massless = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18)), ground=0.2)
    report = Page(page(ls.Scene(massless, omega2=0.0)))
    assert report.rows("Peaks")["F₁₂"][1][1] == [0.0]
    assert "Shaking force" not in report.images
    assert list(report.rows("Drive")) == ["power"]


# ----------------------------------------------------------------------------------------------- refusals


def refused(*arguments, **words) -> str:
    with pytest.raises(ValueError, match=r".") as text:
        ls.report(*arguments, **words)
    assert not list(Path().iterdir())
    return str(text.value)


def test_a_scene_over_designs_is_refused_with_the_remedy():
    scene = ls.sample(ls.example("press"), {"coupler.length": (0.2, 0.24)}, n=8)
    message = refused(scene, "report.html")
    assert "over several designs, design (8)" in message
    assert "ls.report(ls.scene_at(scene, {'design': 0}), ...)" in message and "isel" in message
    press = ls.example("press").mechanism
    both = ls.Scene(ls.FourBar(press.crank, press.coupler, press.rocker, press.ground, branch="both"), omega2=1.0)
    assert "{'branch': 'open'}" in refused(both, "report.html")


def test_one_design_of_a_study(undrawn):
    scene = ls.sample(ls.example("press"), {"coupler.length": (0.2, 0.24)}, n=4)
    study = ls.peaks(scene, of=["F32"])
    ls.report(study.isel(design=2), "report.html")
    assert Page(Path("report.html").read_text(encoding="utf-8")).rows("Peaks")["F₃₂"][1][1] == [
        study.F32_peak.values[2]
    ]


def test_refusals_of_report():
    scene = ls.example("loop")
    assert "its ending must be .html or .htm: a report is a page" in refused(scene, "report.pdf")
    assert "scene is a str: must be a Scene, as from ls.load_scene, or a Dataset" in refused(
        "press.toml", "report.html"
    )
    assert "theta2 = (50, 10): must be a pair (first, last), first less than last" in refused(
        scene, "report.html", theta2=(50.0, 10.0)
    )
    assert "theta2 = 720: must be a pair" in refused(scene, "report.html", theta2=720)
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        ls.report(scene, "missing/report.html")


# ------------------------------------------------------------------------------------------- command line


def test_command_line(undrawn, capsys):
    Path("car <1>.toml").write_text('speed = 100\n[mechanism]\ntype = "LoopTrack"\nradius = 30\nmass = 700\n')
    assert main(["report", "car <1>.toml", "-o", "report.html"]) == 0
    assert capsys.readouterr().out == "written: report.html\n"
    assert "<h1>car &lt;1&gt;</h1>" in Path("report.html").read_text(encoding="utf-8")
    assert main(["report", "car <1>.toml", "-o", "half.html", "--title", "Half", "--theta2", "0", "90"]) == 0
    half = Page(Path("half.html").read_text(encoding="utf-8"))
    assert half.texts["h1"] == "Half" and "Peaks are exact" in half.texts["p"]
    assert main(["report", "car <1>.toml", "-o", "report.pdf"]) == 2
    assert capsys.readouterr().err.startswith("linksweep: report.pdf: its ending must be .html or .htm")
    assert sorted(path.name for path in Path().iterdir()) == ["car <1>.toml", "half.html", "report.html"]


def test_a_link_may_have_the_name_of_a_method_of_the_machine():
    with undrawn_figures():
        report = Page(page(ls.example("drag-link-press")))
    assert [text for text, _ in report.rows("Machine")["4 driven"]][:2] == ["115\u202fmm", "60\u202fkg"]
    least = report.rows("Checks")["least transmission angle of C"][0][1][0]
    assert least == pytest.approx(float(ls.check(ls.example("drag-link-press")).transmission_angle_min.sel(pin="C")))
    assert "transmission angle max" not in report.rows("Checks")
