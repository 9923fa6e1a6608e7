"""Pipes, devices, huge and damaged text files: one clear message, in short time."""

import os
import resource
import subprocess
import sys
import tomllib
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.base import memory
from linksweep.cli.main import main
from linksweep.scene.file import csv_table, text_file
from linksweep.scene.file.errors import _key_lines

PRESS = (files("linksweep.scene.examples") / "press.toml").read_text()
ENGINE = (files("linksweep.scene.examples") / "engine.toml").read_text()
LOAD = '\n[[loads]]\nlink = "coupler"\ntorque = {csv = "a.csv"}\n'


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refusal(text: str, csv: str | None = None) -> str:
    """Return the message with which a scene file is refused."""
    Path("scene.toml").write_text(text)
    if csv is not None:
        Path("a.csv").write_text(csv)
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        ls.sweep(ls.load_scene("scene.toml"), 7)
    assert type(refused.value) is ValueError
    assert len(str(refused.value)) < 500
    return str(refused.value)


# --------------------------------------------------------------------------------------------------- no files at all


def test_a_pipe_as_a_scene_is_refused_without_waiting(here):
    for name in ("a.toml", "a.nc"):
        os.mkfifo(name)
        with pytest.raises(ValueError, match=rf"{name}: cannot be read: it is a pipe, no file"):
            ls.load_scene(name)


def test_a_pipe_as_a_study_is_refused_without_waiting(here):
    os.mkfifo("a.nc")
    with pytest.raises(ValueError, match=r"a.nc: there is no such file"):
        ls.open_study("a.nc")


def test_a_device_as_a_csv_is_not_read(here):
    assert refusal(PRESS + LOAD.replace("a.csv", "/dev/zero")).endswith(
        "torque.csv: /dev/zero: cannot be read: it is a device, no file"
    )


# ------------------------------------------------------------------------------------------------------------- sizes


def test_a_file_too_large_is_refused(here, monkeypatch):
    monkeypatch.setattr(text_file, "LARGEST", 2**20)
    assert refusal("#" * 2**20 + "\n").startswith("scene.toml: has more than 1 MB")


def test_a_cell_too_long_is_refused(here):
    longest = csv_table.LONGEST_CELL
    assert "a.csv:2: a cell has more than 1000 char" in refusal(PRESS + LOAD, f"theta2,P\n0,{'1' * (longest + 1)}\n")
    assert "a.csv:2: cannot be read as CSV: field larger than" in refusal(
        PRESS + LOAD, f"theta2,P\n0,{'1' * 200_000}\n"
    )


@pytest.mark.parametrize("unit", ["m" * 61, "m" * 1_000_000])
def test_a_unit_too_long_is_refused(here, unit):
    assert "characters: must have at most" in refusal(PRESS.replace('"20 cm"', f'"20 {unit}"'))
    array = {"dims": "d", "attrs": {"units": unit}}
    with pytest.raises(ValueError, match=r'ground has attrs\["units"\] = "mmm.{53}\.\.\.: must be in m'):
        ls.Scene(ls.FourBar(*(ls.Link(0.2, 1.0, 0.1),) * 3, ground=xr.DataArray([0.2, 0.3], **array)), omega2=1.0)


def test_errors_after_a_long_value_are_located_in_one_pass(here, monkeypatch):
    """Each piece of the file is parsed once: a piece for each of its keys and headers, however many lines it has."""
    text = 'bogus = """' + "a\n" * 50_000 + '"""\n' + PRESS
    parsed = []
    monkeypatch.setattr(
        "linksweep.scene.file.errors.tomllib.loads", lambda piece, do=tomllib.loads: parsed.append(piece) or do(piece)
    )
    assert "scene.toml:1: bogus: unknown key" in refusal(text)
    assert sum(map(len, parsed)) == 2 * len(text)


def test_line_numbers_after_every_kind_of_value():
    text = (
        'a = """x\n# [ "\\""""\nb = \'\'\'y\n[\'\'\'\nc = [1, # ]\n 2]\n[[d]]\ne = "]"\n[[d]]\n[d.f]\ng = {h = \'"\'}\n'
    )
    assert _key_lines(text) == {
        (): 1, ("a",): 1, ("b",): 3, ("c",): 5, ("c", 0): 5, ("c", 1): 5, ("d",): 7, ("d", 0): 7, ("d", 0, "e"): 8,
        ("d", 1): 9, ("d", 1, "f"): 10, ("d", 1, "f", "g"): 11, ("d", 1, "f", "g", "h"): 11,
    }  # fmt: skip


# ----------------------------------------------------------------------------------------------------- huge numbers

FINITE = "must be a finite number, at most 1.8e308"
RATIO = "compression_ratio = 1e+300: compresses to more than 1.8e308 Pa; reduce it, or gamma"


def test_a_number_that_overflows_is_refused(here):
    assert refusal(PRESS.replace('"20 cm"', f'"{"1" * 400} 1/3 in"')).endswith(FINITE)
    assert "has 4007 characters: must have at most 1000" in refusal(PRESS.replace('"20 cm"', f'"{"1" * 4000} 1/3 in"'))


def test_an_integer_that_overflows_is_refused(here):
    assert f"ground = <int>: {FINITE}" in refusal(PRESS.replace('"20 cm"', "0x1" + "0" * 9999))


def test_a_compression_ratio_that_overflows_is_refused(here):
    assert RATIO in refusal(ENGINE.replace("compression_ratio = 10", "compression_ratio = 1e300"))
    engine = ls.example("engine")
    for cycle in (ls.OttoCycle(1e300, 5e6), ls.DieselCycle(xr.DataArray([18.0, 1e300], dims="d"), 2.0)):
        with pytest.raises(ValueError) as refused:  # noqa: PT011
            replace(engine, loads=[ls.GasPressure(0.1, cycle)])
        assert RATIO in str(refused.value)


def test_a_column_whose_slope_overflows_is_refused(here):
    column = "theta2,P\n" + "".join(f"{angle},{1e308 if angle == 90 else -1e308}\n" for angle in range(0, 360, 30))
    assert refusal(PRESS + LOAD, column) == "loads[3].torque holds 1e+308: is interpolated, so it must be below 1e+290"


@pytest.mark.parametrize("interpolation", ["periodic cubic", "pchip", "linear", "step"])
def test_angles_that_coincide_a_period_later_are_refused(here, interpolation):
    column = "theta2,P\n0,1\n1e-320,2\n" + "".join(f"{angle},1\n" for angle in range(30, 360, 30))
    kind = f'interpolation = "{interpolation}"\n'
    assert refusal(PRESS + LOAD + kind, column).startswith(
        "loads[3].torque: two of its angles are 9.99989e-321 degrees apart"
    )


def test_lengths_at_the_limits_of_float64():
    engine = ls.example("engine")
    loop = ls.Scene(ls.LoopTrack(1e308, 700.0), speed=100.0, thrust=1e4, profile="energy")
    for scene in (
        ls.Scene(ls.SliderCrank(engine.mechanism.crank, ls.Link(1e300, 1.0, 1.0), 0.5), 30.0, loads=engine.loads),
        ls.Scene(ls.SliderCrank(engine.mechanism.crank, engine.mechanism.rod, 0.5, friction=1e300), omega2=30.0),
        loop,
    ):
        ls.check(scene)
        assert (ls.sweep(scene, 6).status != 0).any() or scene is loop


def test_a_value_too_large_in_its_unit_is_refused_with_file_and_line(here):
    rows = "theta2,P\n0,1\n90,2\n180,1e307\n270,2\n"
    message = refusal(PRESS + LOAD.replace("}", ', unit = "kN m"}'), rows)
    assert "torque.csv: a.csv:4: 1e+307: must be a finite number" in message


def test_a_long_key_is_cut(here):
    assert "xxx...: unknown key" in refusal(f"{'x' * 100_000} = 1\n{PRESS}")


# ----------------------------------------------------------------------------------------------- files of others


@pytest.mark.parametrize("text", ["root:x:0:0:secret\nmore\n", "secret,P\n0,1\n", "secret\n", '"secret', "0,secret\n"])
def test_a_message_quotes_nothing_of_a_file_that_is_not_csv(here, text):
    message = refusal(PRESS + LOAD, text)
    assert "secret" not in message
    assert "the first line must name the columns, the first of them theta2" in message


# ------------------------------------------------------------------------------------------------------------- output


def test_a_label_is_not_written_as_a_formula(here):
    labels = ["=cmd|'/c calc'!A1", "+1+1", "-1+1", "@sum", "\tx", "\rx", "-5", "plain"]
    scene = replace(ls.example("press"), omega2=xr.DataArray(np.arange(8.0), dims="speed"))
    peaks = ls.peaks(scene, ["T12"], theta2=8).rename(speed="=dim").assign_coords({"=dim": labels})
    peaks.linksweep.to_csv("a.csv")
    with open("a.csv", newline="") as file:
        rows = list(csv_table.csv.reader(file))
    assert rows[0][0] == "'=dim"
    assert [row[0] for row in rows[1:]] == [*(f"'{label}" for label in labels[:5]), "'\nx", "-5", "plain"]


def run(*words: str, **surroundings: str) -> subprocess.CompletedProcess:
    Path("press.toml").write_text(PRESS)
    environment = os.environ | surroundings
    return subprocess.run(
        [sys.executable, "-m", "linksweep", *words], capture_output=True, env=environment, check=False
    )


def test_an_ascii_terminal_shows_question_marks(here):
    ran = run("peaks", "press.toml", "--theta2", "36", PYTHONIOENCODING="ascii", PYTHONUTF8="0")
    assert (ran.returncode, ran.stderr) == (0, b"")
    assert b"0.00?" in ran.stdout


@pytest.mark.parametrize("buffered", ["", "1"])
def test_a_closed_pipe_ends_the_command_quietly(here, buffered):
    Path("press.toml").write_text(PRESS)
    reading, writing = os.pipe()
    os.close(reading)
    ran = subprocess.run(
        [sys.executable, "-m", "linksweep", "check", "press.toml"],
        stdout=writing, stderr=subprocess.PIPE, env=os.environ | {"PYTHONUNBUFFERED": buffered}, check=False,
    )  # fmt: skip
    os.close(writing)
    assert (ran.returncode, ran.stderr) == (141, b"")


def test_output_closed_before_the_start(here, monkeypatch):
    Path("press.toml").write_text(PRESS)
    monkeypatch.setattr(sys, "stdout", None)  # as Python starts after ">&-"
    assert main(["check", "press.toml"]) == 0


def test_a_file_name_with_an_invalid_byte(here, capsys):
    name = os.fsdecode(b"scene\xff.toml")
    Path(name).write_text(PRESS)
    assert main(["report", name, "-o", "report.html"]) == 0
    assert "<h1>scene?</h1>" in Path("report.html").read_text()
    assert main(["peaks", name + "l"]) == 2
    assert "there is no such file" in capsys.readouterr().err


# ------------------------------------------------------------------------------------------------------------- memory


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("sweep press.toml -o a.nc --theta2 1000000000000", "--theta2 1000000000000: needs 4.8e+04 GB of memory"),
        ("peaks press.toml --theta2 1000000000000", "--theta2 1000000000000: needs 4.8e+04 GB of memory"),
        ("orders press.toml -n 1000000000", "-n 1000000000: must be less than 360, half the samples of a turn"),
        ("animate press.toml -o a.gif --frames 1000000000", "--frames 1000000000: needs 3.11e+05 GB of memory"),
    ],
)
def test_a_request_that_needs_too_much_memory_is_refused(here, capsys, words, message):
    Path("press.toml").write_text(PRESS)
    assert main(words.split()) == 2
    assert capsys.readouterr().err.startswith(f"linksweep: {message}")
    assert os.listdir() == ["press.toml"]


def test_designs_and_classes_that_need_too_much_memory_are_refused():
    scene = ls.example("press")
    with pytest.raises(ValueError, match=r"n = 1000000000000: needs 1.6e\+04 GB of memory"):
        ls.sample(scene, {"ground": (0.19, 0.21)}, n=10**12)
    bearings = ls.bearings(scene, {"B": ls.Bearing(diameter=0.02, length=0.03)}, theta2=12)
    with pytest.raises(ValueError, match=r"classes = 1000000000000: needs .* GB of memory"):
        ls.load_spectrum(bearings, classes=10**12)


def test_results_that_do_not_fit_in_memory_are_refused(monkeypatch):
    monkeypatch.setattr(memory, "free_memory", lambda: 3e8)
    scene = ls.example("press")
    with pytest.raises(
        ValueError, match=r"100000000 numbers \(results × designs × angles\).* needs 0.8 GB of memory, of"
    ):
        ls.sweep(ls.Scene(scene.mechanism, omega2=xr.DataArray(np.arange(1e4), dims="d")), 10_000, of=["T12"])


def test_free_memory_is_the_less_of_machine_and_limit():
    limit = resource.getrlimit(resource.RLIMIT_AS)
    total = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    assert 0.0 < memory.free_memory() < 4.0 * total
    resource.setrlimit(resource.RLIMIT_AS, (memory._own_pages(0) + 2**30, limit[1]))
    try:
        assert 0.0 < memory.free_memory() <= 2**30
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limit)
