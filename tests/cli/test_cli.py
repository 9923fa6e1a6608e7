"""The command line: its output, its files, and its error messages."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import linksweep as ls
from linksweep.cli.main import main

PRESS = """\
omega2 = "300 rpm"
gravity = [0, -9.81]

[mechanism]
type = "FourBar"
ground = "20 cm"
crank = {type = "Bar", length = "8 cm", width = "2 cm", thickness = "2 cm", density = 7750}
coupler = {length = 0.22, mass = 0.7, inertia = 3e-3, cg_distance = "11 cm"}
rocker = {type = "Bar", length = "18 cm", width = "2 cm", thickness = "2 cm", density = 7750}

[[loads]]
link = "coupler"
force = [0, "-80 lbf"]
at = ["10 cm", 15]
"""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch) -> Path:
    """Enter an empty working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def press(folder) -> str:
    return scene_file("press.toml")


def scene_file(name: str, old: str = "", new: str = "") -> str:
    assert old in PRESS
    Path(name).write_text(PRESS.replace(old, new), encoding="utf-8")
    return name


BATCH = ('length = "8 cm"', 'length = {dim = "crank", values = ["6 cm", "8 cm", "12 cm", "25 cm", "90 cm"]}')


def rows(text: str) -> dict[str, list[str]]:
    """Return a printed table by the first cell of its lines; cells are two spaces apart."""
    cells = [re.split(r" {2,}", line.strip()) for line in text.splitlines() if "  " in line]
    return {first: rest for first, *rest in cells}


def assert_table_is(text: str, peaks: xr.Dataset) -> None:
    table = rows(text)
    angles = {name: name.removesuffix("_at") for name in map(str, peaks.data_vars) if name.endswith("_at")}
    assert list(table) == ["quantity", *angles.values()]
    for at, name in angles.items():
        value, unit, angle = table[name]
        assert value == f"{float(peaks[name]):.6g}"
        assert unit == peaks[name].attrs["units"]
        assert angle == f"{float(peaks[at]):.2f}°"


def is_png(path) -> bool:
    return Path(path).read_bytes().startswith(b"\x89PNG\r\n")


# ------------------------------------------------------------------------------------------------ demo


def test_demo_prints_the_peaks_and_writes_data_and_picture(capsys):
    assert main(["demo"]) == 0
    out, err = capsys.readouterr()
    assert_table_is(out, ls.peaks(ls.example("press")))
    assert err == ""
    assert sorted(os.listdir()) == ["demo.nc", "demo.png"]
    assert is_png("demo.png")
    with xr.open_dataset("demo.nc") as ds:
        xr.testing.assert_equal(ds.load(), ls.sweep(ls.example("press")))
    assert ls.load_scene("demo.nc") == ls.example("press")


def test_demo_writes_to_the_requested_files(capsys):
    Path("results").mkdir()
    assert main(["demo", "-o", "results/press.v2"]) == 0
    assert sorted(os.listdir("results")) == ["press.v2.nc", "press.v2.png"]
    assert "results/press.v2.nc" in capsys.readouterr().out


# ----------------------------------------------------------------------------------------------- sweep


def test_sweep_writes_the_cycle_and_a_picture_of_it(press, capsys):
    assert main(["sweep", press, "-o", "cycle.nc", "--plot", "cycle.png", "--theta2", "48"]) == 0
    assert capsys.readouterr().out.splitlines() == ["written: cycle.nc", "written: cycle.png"]
    assert is_png("cycle.png")
    with xr.open_dataset("cycle.nc") as ds:
        xr.testing.assert_equal(ds.load(), ls.sweep(ls.load_scene(press), 48))
    assert sorted(os.listdir()) == ["cycle.nc", "cycle.png", "press.toml"]


@pytest.mark.parametrize(("ending", "begins"), [(".pdf", b"%PDF"), (".svg", b"<?xml"), (".PNG", b"\x89PNG")])
def test_pictures_of_other_kinds(press, ending, begins, capsys):
    picture = "cycle" + ending
    assert main(["sweep", press, "-o", "cycle.nc", "--plot", picture, "--theta2", "24"]) == 0
    assert Path(picture).read_bytes().startswith(begins)
    assert pyplot.get_fignums() == []


def test_sweep_writes_only_the_requested_variables(press, capsys):
    arguments = ["sweep", press, "-o", "cycle.nc", "--outputs", "T12, F32,", "--theta2", "24", "--plot", "c.png"]
    assert main(arguments) == 0
    with xr.open_dataset("cycle.nc") as ds:
        assert set(ds.data_vars) == {"T12", "F32", "status"}
    assert is_png("c.png")  # the picture does not depend on the variables


def test_a_result_file_is_accepted_as_a_scene(press, capsys):
    assert main(["sweep", press, "-o", "first.nc", "--theta2", "24"]) == 0
    assert main(["sweep", "first.nc", "-o", "second.nc", "--theta2", "24"]) == 0
    with xr.open_dataset("first.nc") as first, xr.open_dataset("second.nc") as second:
        xr.testing.assert_identical(first.load(), second.load())


# ----------------------------------------------------------------------------------------------- peaks


def test_peaks_prints_a_table_and_writes_a_file(press, capsys):
    assert main(["peaks", press]) == 0
    assert_table_is(capsys.readouterr().out, ls.peaks(ls.load_scene(press)))
    assert os.listdir() == [press]
    assert main(["peaks", press, "--of", "F14,T12_mean", "-o", "peaks.nc", "--theta2", "90"]) == 0
    out = capsys.readouterr().out
    expected = ls.peaks(ls.load_scene(press), of=["F14", "T12_mean"], theta2=90)
    assert rows(out)["T12_mean"] == [f"{float(expected.T12_mean):.6g}", "N m"]
    assert list(rows(out)) == ["quantity", "F14_peak", "T12_mean"]
    assert out.endswith("\nwritten: peaks.nc\n")
    with xr.open_dataset("peaks.nc") as ds:
        xr.testing.assert_equal(ds.load(), expected)


def test_peaks_of_a_batch_name_the_worst_design(capsys):
    scene = scene_file("batch.toml", *BATCH)
    assert main(["peaks", scene, "--of", "F32,T12", "By", "T12_mean,theta4"]) == 0
    out = capsys.readouterr().out
    peaks = ls.peaks(ls.load_scene(scene), of=["F32", "T12", "By", "T12_mean", "theta4"])
    table = rows(out.partition("\n\n")[0])
    assert table["quantity"] == ["value", "unit", "at theta2", "worst crank"]
    for name, worst in {
        "F32_peak": peaks.F32_peak.argmax("crank"),
        "T12_max": peaks.T12_max.argmax("crank"),
        "T12_min": peaks.T12_min.argmin("crank"),
        "By_min": peaks.By_min.argmin("crank"),
        "theta4_max": peaks.theta4_max.argmax("crank"),
    }.items():
        place = {"crank": int(worst)}
        assert table[name][0] == f"{float(peaks[name].isel(place)):.6g}"
        assert table[name][2] == f"{float(peaks[f'{name}_at'].isel(place)):.2f}°"
        assert table[name][3] == f"{float(peaks.crank.isel(place)):.6g}"
    assert table["T12_mean"][-1] == f"{float(peaks.crank[int(abs(peaks.T12_mean).argmax('crank'))]):.6g}"
    assert "Some quantity of 1 of 5 designs grows without bound at a toggle" in out
    assert "1 of 5 designs have no result at any crank angle: cannot assemble." in out


def test_a_quantity_independent_of_a_dimension_is_worst_at_any(capsys):
    scene = scene_file("batch.toml", "mass = 0.7", 'mass = {dim = "mass", values = [0.5, 0.9]}')
    assert main(["peaks", scene, "--of", "F32,theta4"]) == 0
    table = rows(capsys.readouterr().out.partition("\n\n")[0])
    assert table["theta4_max"][-1] == "any"
    assert table["F32_peak"][-1] == "0.9"


# ----------------------------------------------------------------------------------------------- check


def test_check_prints_its_findings(press, capsys):
    assert main(["check", press]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "Grashof class:             crank-rocker",
        "can be assembled:          everywhere",
        "at theta2 from:            0.0000° to 360.0000°",
        "toggles at theta2:         none",
        "least transmission angle:  33.0302°",
    ]


def test_check_of_a_rocker_prints_its_limits(capsys):
    scene = scene_file("rocker.toml", 'length = "8 cm"', 'length = "25 cm"')
    assert main(["check", scene]) == 0
    text = dict(re.split(r": +", line) for line in capsys.readouterr().out.splitlines())
    checks = ls.check(ls.load_scene(scene))
    folded, stretched, mirrored, also_mirrored = checks.toggle_angle.values
    assert np.isfinite([folded, stretched, mirrored, also_mirrored]).sum() == 2
    assert text["Grashof class"] == "triple-rocker"
    assert text["can be assembled"] == "partly"
    assert text["toggles at theta2"] == f"{stretched:.4f}° (stretched), {mirrored:.4f}° (stretched, mirrored)"
    assert text["at theta2 from"] == f"{mirrored:.4f}° to {stretched + 360.0:.4f}°"


def test_check_of_a_linkage_keeps_titles_and_values_apart(capsys):
    ls.save(ls.example("watt-2"), "watt.toml")
    assert main(["check", "watt.toml"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert all(re.fullmatch(r"[A-Za-z0-9 ]+: +\S.*", line) for line in lines)
    assert len({re.search(r": +", line).end() for line in lines}) == 1


def test_check_counts_the_designs_of_a_batch(capsys):
    assert main(["check", scene_file("batch.toml", *BATCH)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "designs:                   5 (crank 5)",
        "Grashof class:             crank-rocker 3, triple-rocker 2",
        "can be assembled:          everywhere 3, partly 1, never 1",
        "least transmission angle:  0.0000°",
    ]
    tilted = scene_file("tilt.toml", '"20 cm"', '"20 cm"\nground_angle = {dim = "tilt", values = [0, 90, 180]}')
    assert main(["check", tilted]) == 0
    assert "can be assembled:          everywhere 3" in capsys.readouterr().out


# ------------------------------------------------------------------------------------------ errors


def refused(arguments: list[str], capsys) -> list[str]:
    """Run a command that must be refused, with exit code 2 and no output or file; return the lines of its message."""
    before = sorted(os.listdir())
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert "Traceback" not in err
    assert err.startswith("linksweep: ")
    assert sorted(os.listdir()) == before
    return err.removeprefix("linksweep: ").splitlines()


def test_all_errors_of_a_scene_file_with_their_lines(capsys):
    scene = scene_file("bad.toml", 'omega2 = "300 rpm"', 'omega2 = "300 rmp"\ndrive = "crnk"')
    for command in (["check"], ["peaks"], ["sweep", "-o", "cycle.nc"]):
        first, second = refused([command[0], scene, *command[1:]], capsys)
        assert first.startswith(
            'bad.toml:1: omega2 = "300 rmp": "rmp" is not an accepted unit of angular velocity; did'
        )
        assert second == "bad.toml:2: drive = 'crnk': must be one of crank, coupler, rocker; did you mean \"crank\"?"


def test_geometry_that_never_closes_is_refused(capsys):
    scene = scene_file("far.toml", '"20 cm"', '"50 cm"')
    assert refused(["check", scene], capsys) == [
        "far.toml:6: ground = 0.5 m is 0.02 m longer than crank + coupler + rocker: "
        "the mechanism cannot be assembled at any angle; shorten it or lengthen the others"
    ]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["check", "pres.toml"], 'pres.toml: there is no such file; did you mean "press.toml"?'),
        (["check", "no.nc"], "no.nc: there is no such file"),
        (["peaks", "press.toml", "--of", "F32,T21"], "--of: nothing is named 'T21'; did you mean \"T12\"?"),
        (["peaks", "press.toml", "--theta2", "0"], "--theta2 0: a count of angles must be at least 1"),
        (["peaks", "press.toml", "--theta2", "-3"], "--theta2 -3: a count of angles must be at least 1"),
        (
            ["sweep", "press.toml", "-o", "c.nc", "--outputs", "t12"],
            "--of: nothing is named 't12'; did you mean",
        ),
        (["sweep", "press.toml", "-o", "no/c.nc"], "no/c.nc: there is no folder no; make it first"),
        (["demo", "-o", "no/demo"], "no/demo.nc: there is no folder no; make it first"),
    ],
)
def test_bad_arguments_are_refused(arguments, message, press, capsys):
    if arguments[0] == "demo":  # its output came before
        assert main(arguments) == 2
        assert capsys.readouterr().err == f"linksweep: {message}\n"
    else:
        (line,) = refused(arguments, capsys)
        assert line.startswith(message)


def test_a_file_that_is_neither_scene_nor_result_is_refused(capsys):
    Path("notes.nc").write_text("crank 8 cm")
    (message,) = refused(["peaks", "notes.nc"], capsys)
    assert message == "notes.nc: cannot be read as NetCDF (NetCDF: Unknown file format); a scene file ends in .toml"


def test_a_batch_cannot_be_drawn_and_writes_no_file(capsys):
    (message,) = refused(["sweep", scene_file("b.toml", *BATCH), "-o", "c.nc", "--plot", "c.png"], capsys)
    assert "crank (5)" in message


def test_a_picture_that_fails_leaves_no_file(press, monkeypatch, capsys):
    def broken(figure, path):
        path.write_bytes(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("linksweep.cli.running._write_png", broken)
    Path("cycle.png").write_bytes(b"old")
    assert main(["sweep", press, "-o", "cycle.nc", "--plot", "cycle.png"]) == 2
    assert "No space left on device" in capsys.readouterr().err
    assert Path("cycle.png").read_bytes() == b"old"
    assert pyplot.get_fignums() == []
    assert sorted(os.listdir()) == ["cycle.nc", "cycle.png", "press.toml"]


def test_ctrl_c_prints_no_traceback(press, monkeypatch, capsys):
    def stopped(scene):
        raise KeyboardInterrupt

    monkeypatch.setattr(ls, "check", stopped)
    assert main(["check", press]) == 130
    assert capsys.readouterr().err == "linksweep: stopped\n"


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["--help"], 0, "demo.*sweep.*peaks.*check"),
        (["--version"], 0, rf"^linksweep {re.escape(ls.__version__)}$"),
        (["sweep", "--help"], 0, "--output.*--plot.*--outputs"),
        (["peaks", "--help"], 0, "--theta2.*--of"),
        (["chek", "press.toml"], 2, "invalid choice: 'chek'"),
        (["sweep", "press.toml"], 2, "the following arguments are required: -o/--output"),
        (
            ["sweep", "press.toml", "-o", "c.nc", "--plot", "c.xyz"],
            2,
            r"c.xyz: its ending must be \.png or \.pdf or \.svg",
        ),
        (["peaks", "press.toml", "--of", " ,"], 2, "argument --of: must be names, such as F32 T12"),
        (["peaks", "press.toml", "--theta2", "many"], 2, "argument --theta2/--theta: invalid int value: 'many'"),
    ],
)
def test_help_and_usage(arguments, code, message, capsys):
    with pytest.raises(SystemExit) as stopped:
        main(arguments)
    assert stopped.value.code == code
    out, err = capsys.readouterr()
    assert re.search(message, out + err, re.DOTALL)


def test_without_arguments_it_prints_its_help(capsys):
    assert main([]) == 0
    alone = capsys.readouterr()
    with pytest.raises(SystemExit):
        main(["--help"])
    assert alone == capsys.readouterr()


def test_quantities_prints_the_table(press, capsys):
    assert main(["quantities", press]) == 0
    printed = rows(capsys.readouterr().out)
    table = ls.quantities(ls.load_scene(press))
    assert [*printed] == ["name", *table.names]
    assert printed["F32x"] == ["N", "theta2", "yes", table["F32x"].long_name]
    assert main(["quantities", press, "shaking", "moment"]) == 0
    assert [*rows(capsys.readouterr().out)] == ["name", "Ms"]


def test_quantities_without_a_match_prints_a_message(press, capsys):
    assert main(["quantities", press, "torqe"]) == 2
    text = 'linksweep: press.toml: no quantity has "torqe" in its name, unit or meaning\n'
    assert capsys.readouterr() == ("", text)


def test_a_demo_imports_neither_dask_nor_rooms_that_it_leaves_alone(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    unused = {"dask.array", "distributed", "linksweep.reports.page", "linksweep.studies.study", "linksweep.plot.drives"}
    code = "import sys; from linksweep.cli.program import run; code = run(); print(*sys.modules, file=sys.stderr)"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}; sys.exit(code)", "demo", "loop"], capture_output=True, text=True
    )
    assert done.returncode == 0 and (tmp_path / "demo.png").exists()
    assert unused.isdisjoint(done.stderr.split())


def test_the_program_ends_at_once_after_what_is_to_be_done_at_the_end():
    code = "import atexit, sys; from linksweep.cli import program; atexit.register(print, 'last words'); "
    code += "program.run = lambda: print('result') or 3; program.start(); print('never')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (3, "result\nlast words\n", "")


def test_the_command_runs_as_a_module(press):
    def run(*arguments):
        return subprocess.run([sys.executable, "-m", "linksweep", *arguments], capture_output=True, text=True)

    good = run("check", press)
    assert (good.returncode, good.stderr) == (0, "")
    assert good.stdout.startswith("Grashof class:             crank-rocker\n")
    bad = run("check", "missing")
    assert (bad.returncode, bad.stdout) == (2, "")
    assert bad.stderr == "linksweep: missing: there is no such file\n"
