"""Commands for analyses: tables with the library's numbers, and clear errors."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from drawn import closed_figures  # noqa: F401

import linksweep as ls
from linksweep.cli.main import main
from linksweep.cli.parser import Program
from linksweep.scene.file.writing import write_scene

PRESS = ls.example("press")
ENGINE = ls.example("engine")
RADIUS = ["--radius", "6 cm"]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Enter a working folder with the example scenes as files."""
    monkeypatch.chdir(tmp_path)
    for name in ("press", "engine", "loop"):
        source = Path(ls.scene.examples.__file__).with_name(f"{name}.toml")
        Path(f"{name}.toml").write_bytes(source.read_bytes())
    return tmp_path


@pytest.fixture
def table(capsys):
    """Return a function that runs a command and returns its printed table by the first cell of its lines."""

    def run(*arguments: str) -> dict[str, list[str]]:
        assert main(list(arguments)) == 0
        cells = [re.split(r" {2,}", line.strip()) for line in capsys.readouterr().out.splitlines() if line]
        return {first: rest for first, *rest in cells}

    return run


def number(text):
    return float(text.replace("−", "-").split()[0])


def test_bearings(table):
    sizes = ["--diameter", "20 mm", "--length", "0.03", "--capacity", "5 kN"]
    bearings = ls.bearings(PRESS, dict.fromkeys("ABCD", ls.Bearing(diameter=0.02, length=0.03, capacity=5000.0)))
    rows = table("bearings", "press.toml", *sizes)
    titles = ["largest [N]", "mean [N]", "equivalent [N]", "turns [°]", "pressure [MPa]", "PV of samples [MPa m/s]"]
    titles += ["L10h [h]"]
    assert rows["pin"] == titles
    for k, pin in enumerate("ABCD"):
        one = bearings.isel(pin=k)
        load, life = [float(one.F.max()), float(one.F.mean())], float(one.L10h)
        expected = [*load, float(one.equivalent_load), float(one.rotation)]
        expected += [load[0] / (0.02 * 0.03) / 1e6, float(one.pv.max()) / 1e6, life]
        np.testing.assert_allclose([number(text) for text in rows[pin]], expected, rtol=6e-4)
    assert table("bearings", "press.toml")["pin"] == titles[:4]  # quantities without data have no column


@pytest.mark.parametrize(("stated", "missing"), [("--diameter", "--length"), ("--length", "--diameter")])
def test_one_size_of_a_bush_yields_no_pressure(stated, missing, capsys):
    assert main(["bearings", "press", stated, "20 mm"]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err == f"linksweep: {missing}: missing; a pressure needs --diameter and --length\n"


def test_an_example_is_taken_by_its_name_unless_a_file_has_it(table, capsys):
    assert table("check", "press") == table("check", "press.toml") and table("orders", "watt-2")
    Path("press").write_text("omega2 = 30")
    assert main(["check", "press"]) == 2 and "press: cannot be read as NetCDF" in capsys.readouterr().err
    with pytest.raises(ValueError, match=r'watt-2: there is no such file; of the example write ls.example\("watt-2"\)'):
        ls.load_scene("watt-2")


def test_check_states_the_transmission_angle_of_each_pin_in_a_line(capsys):
    assert main(["check", "whitworth"]) == 0
    lines = dict(line.split(":") for line in capsys.readouterr().out.splitlines())
    assert lines["transmission angle of arm"].strip() == "90°"
    limits = ls.check(ls.example("whitworth")).sel(pin="E")
    least, where, most, *_ = map(float, re.findall("[0-9.]+", lines["transmission angle of E"]))
    for value, name in ((least, "min"), (where, "min_at"), (most, "max")):
        assert value == pytest.approx(float(limits[f"transmission_angle_{name}"]), rel=1e-5)


def test_bearings_over_part_of_a_turn_and_of_a_machine_with_toggles(table):
    rows = table("bearings", "press.toml", "--capacity", "5 kN", "--theta2", "10", "60")
    bearings = ls.bearings(PRESS, dict.fromkeys("ABCD", ls.Bearing(capacity=5000.0)), theta2=(10, 60))
    for k, pin in enumerate("ABCD"):
        assert number(rows[pin][-1]) == pytest.approx(float(bearings.L10h[k]), rel=6e-4)
    links = (ls.Link(length, 0.0, 0.0) for length in (0.12, 0.15, 0.25))
    scene = ls.Scene(ls.FourBar(*links, ground=0.2), omega2=5.0, loads=[ls.Load("rocker", torque=-8.0)])
    Path("stuck.toml").write_text(write_scene(scene))
    rows = table("bearings", "stuck.toml", "--capacity", "5 kN")
    for pin in "ABCD":
        assert rows[pin][0] == rows[pin][2] == "inf"
        assert rows[pin][-2:] == ["0", "unbounded load"]


def test_a_part_of_a_turn_is_stated_alike_for_every_command(capsys):
    page, life = ["-o", "page.html"], ["--life", "9000 h"]
    for word, option, *more in (
        ["bearings", "--theta2"],
        ["choose-bearings", "--theta2", *life],
        ["report", "--theta2", *page],
        ["peaks", "--between"],
    ):
        assert main([word, "press.toml", option, "60", "10", *more]) == 2
        out, err = capsys.readouterr()
        assert out == "" and err == (
            f"linksweep: {option} (60, 10): must be a pair (first, last), first less than last by at most 360 degrees; "
            "from 60 on to 10 is (60, 370)\n"
        )


def test_breakdown_adds_up_at_the_worst_angle(table):
    rows = table("breakdown", "press.toml", "F32")
    peak = ls.peaks(PRESS, of=["F32"])
    assert f"F32 at theta2 = {float(peak.F32_peak_at):.2f}°" in rows
    *shares, (whole, all_of_it) = list(rows.values())[1:]
    assert number(whole) == pytest.approx(float(peak.F32_peak), rel=1e-4)
    assert sum(number(share) for share, _ in shares) == pytest.approx(number(whole), rel=1e-4)
    sizes = [abs(number(share)) for share, _ in shares]
    assert sizes == sorted(sizes, reverse=True)
    assert "crank inertia" not in rows  # its centre of gravity is at rest
    assert all_of_it == "100.0 %"


def test_balance(table):
    rows = table("balance", "press.toml", *RADIUS)
    weights = ls.counterweights(PRESS, radius=0.06)
    for weight in weights:
        assert [number(text) for text in rows[weight.link]] == pytest.approx([weight.mass, *weight.at], rel=1e-4)
    balanced = ls.with_counterweights(PRESS, weights)
    assert rows["Fs_peak"][1:] == ["0", "N"]
    for name, key in (("T12_peak", "T12"), ("F43_peak", "F43")):
        largest = [float(abs(ls.sweep(scene, of=[key])[key]).max()) for scene in (PRESS, balanced)]
        assert [number(text) for text in rows[name][:2]] == pytest.approx(largest, rel=1e-4)


def test_a_fraction_of_an_engine_is_balanced(table):
    rows = table("balance", "engine.toml", *RADIUS, "--fraction", "1")
    assert number(rows["crank"][0]) == pytest.approx(
        ls.counterweights(ENGINE, radius=0.06, fraction=1.0)[0].mass, rel=1e-4
    )


def test_orders(table):
    rows = table("orders", "engine.toml", "-n", "2")
    orders = ls.orders(ls.sweep(ENGINE, of=["Fsx", "Fsy"]), ["Fsx", "Fsy"], n=2)
    assert list(rows) == ["order", "0", "0.5", "1", "1.5", "2"]
    assert rows["order"] == ["Fsx [N]", "Fsy [N]"]
    for order in (1, 2):
        expected = [float(orders[f"{name}_amplitude"].sel(order=order)) for name in ("Fsx", "Fsy")]
        np.testing.assert_allclose([number(text) for text in rows[str(order)]], expected, rtol=1e-4, atol=1e-6)
    assert rows["1.5"] == ["0", "0"]  # no rounding errors are printed
    assert table("orders", "press.toml", "T12", "-n", "1")["order"] == ["T12 [N m]"]


def test_orders_of_the_force_in_a_pin(table):
    """B stands for F32, in a cycle that is whole and in the check that it is."""
    assert table("orders", "press.toml", "B", "T12") == table("orders", "press.toml", "F32,T12")
    assert table("orders", "press.toml", "B")["order"] == ["F32 [N]"]


@pytest.mark.parametrize("fluctuation", ["0.05", "5 %"])
def test_flywheel(table, fluctuation):
    rows = table("flywheel", "press.toml", "--fluctuation", fluctuation)
    work, wheel = ls.duty(PRESS), ls.flywheel(PRESS, fluctuation=0.05)
    assert number(rows["largest torque"][0]) == pytest.approx(float(work.effort_peak), rel=1e-4)
    assert number(rows["work fed"][0]) == pytest.approx(float(work.work_fed), rel=1e-4)
    assert rows["mean torque"] == ["0", "N m"]  # constant loads take no work in a cycle
    assert number(rows["its inertia"][0]) == pytest.approx(float(wheel.flywheel_inertia), rel=1e-4)
    assert rows["fluctuation"] == ["0.05"]
    speeds = [number(rows[f"{word} speed"][0]) for word in ("least", "largest")]
    assert (speeds[1] - speeds[0]) / np.mean(speeds) == pytest.approx(0.05, abs=1e-4)
    assert np.mean(speeds) == pytest.approx(float(PRESS.omega2), rel=1e-4)


@pytest.mark.parametrize(
    "arguments",
    [
        ["bearings", "engine.toml", "--frame", "journal"],
        ["breakdown", "press.toml", "T12"],
        ["balance", "engine.toml", *RADIUS],
        ["orders", "engine.toml", "-n", "4"],
        ["flywheel", "engine.toml"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_each_draws_its_figure(arguments, capsys):
    assert main([*arguments, "--plot", "figure.svg"]) == 0
    assert capsys.readouterr().out.endswith("\nwritten: figure.svg\n")
    assert Path("figure.svg").read_text("utf-8").count("<path") > 30


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["bearings", "loop.toml"], "LoopTrack, which has no pins"),
        (["breakdown", "press.toml", "F99"], "nothing is named 'F99'"),
        (["balance", "loop.toml", *RADIUS], "LoopTrack, which has no links"),
        (["balance", "press.toml", "--radius", "-6 cm"], "--radius -0.06 m: must be greater than 0"),
        (["balance", "press.toml", *RADIUS, "--fraction", "1"], "--fraction 1.0: must be left out"),
        (["orders", "press.toml", "T99"], "nothing is named 'T99'"),
        (["orders", "press.toml", "status"], "NAME 'status': is a code without orders; name quantities, such as F32"),
        (["orders", "loop.toml"], "NAME: missing; a LoopTrack has no shaking force; name quantities, such as speed"),
        (["orders", "press.toml", "-n", "1000"], "-n 1000: must be less than 360, half the samples of a turn\n"),
        (["flywheel", "press.toml", "--fluctuation", "3"], "--fluctuation 3.0: must be less than 2"),
        (["flywheel", "pres"], 'pres: there is no such file; did you mean "press'),
        (["flywheel", "pres.toml"], "pres.toml: there is no such file"),
        (["animate", "press.toml", "-o", "none/film.gif", "--frames", "2"], "there is no folder none"),
    ],
)
def test_errors_are_one_line_without_a_traceback(arguments, message, capsys):
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("linksweep: ") and message in err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["balance", "press.toml", "--radius", "six"], '"six": must be a number, a space and a unit'),
        (["flywheel", "press.toml", "--plot", "figure.txt"], "its ending must be .png or .pdf or .svg"),
        (["bearings", "press.toml", "--diameter", "20 kg"], "20 kg"),
    ],
)
def test_arguments_that_cannot_be_read(arguments, message, capsys):
    with pytest.raises(SystemExit):
        main(arguments)
    assert message in capsys.readouterr().err


def test_a_batch_is_refused(capsys):
    text = Path("press.toml").read_text("utf-8")
    speed = re.search(r"^omega2 = .*$", text, re.MULTILINE).group()
    Path("batch.toml").write_text(text.replace(speed, 'omega2 = {dim = "speed", values = [10, 20]}'), "utf-8")
    assert main(["flywheel", "batch.toml"]) == 2
    assert "batch.toml: has several designs, over speed (2)" in capsys.readouterr().err


def test_a_partial_revolution_has_no_worst_angle_and_no_cycle(capsys):
    swing = ls.Scene(ls.FourBar(*(ls.Link(length, 1.0, 0.01) for length in (0.08, 0.12, 0.11)), ground=0.22), 20.0)
    ls.save(ls.sweep(swing, theta2=36), "swing.nc")
    assert main(["breakdown", "swing.nc", "F32"]) == 2
    assert "F32: has no largest value" in capsys.readouterr().err
    for word, *options in (["flywheel"], ["orders"], ["balance", *RADIUS]):
        assert main([word, "swing.nc", *options]) == 2
        assert "swing.nc: does not run all the way round" in capsys.readouterr().err


def test_tolerances_of_results_that_are_not_finite_have_no_numbers(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    press = ls.example("press")
    ls.save(replace(press, mechanism=replace(press.mechanism, ground=0.33)), "partly.toml")
    words = ["--of", "F32_peak", "--tol", "ground"]
    assert main(["tolerance", "partly.toml", *words, "js9", "--plot", "t.png"]) == 2
    out, err = capsys.readouterr()
    first, _, drawn, _, _, row = out.splitlines()
    assert first == "F32_peak = inf N: no derivatives (unbounded)"
    assert drawn == "drawn designs, exact: not finite in any of them" and row.split() == ["ground", *["none"] * 3]
    assert err == "linksweep: nothing to draw: the result has no derivatives\n"
    assert main(["tolerance", "press", *words, "-0.1", "0.1"]) == 0
    out = capsys.readouterr().out
    assert " to inf N, not finite in all of them" in out and "nan" not in out


def test_each_result_of_a_tolerance_has_a_panel(capsys):
    names = ["--of", "F32_peak", "T12_peak", "--tol", "ground", "js9", "-n", "0"]
    assert main(["tolerance", "press.toml", *names, "--plot", "figure.svg"]) == 0
    titles = re.findall(r"<!-- (\w+) \[.*\] -->", Path("figure.svg").read_text("utf-8"))
    assert titles == ["F32_peak", "T12_peak"]


def test_the_guide_lists_the_commands_that_draw_figures():
    guide = Path(__file__).parents[2] / ".docs" / "guide" / "command_line.md"
    listed = guide.read_text("utf-8").split("draws those of ")[1].split(". ")[0]
    drawing = [name for name, parser in Program().commands.by_name.items() if "--plot" in parser.format_help()]
    assert sorted(re.findall(r"`([\w-]+)`", listed)) == sorted(drawing)
