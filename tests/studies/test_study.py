"""Studies: the numbers of peaks, the output of the command, and progress."""

import io
import os
import random
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr
from studies import SCENES, assert_same, grid, many

import linksweep as ls
from linksweep.cli.main import main
from linksweep.engine.threads import most_threads
from linksweep.scene.designs.selection import blocks
from linksweep.studies import assemble
from linksweep.studies import job as chunk_module
from linksweep.studies import study as study_module

# ------------------------------------------------------------------------------------ the numbers of peaks


@pytest.mark.parametrize(
    ("scene", "chunk"),
    [
        *((scene, 2) for scene in SCENES),
        pytest.param("grid", 5, marks=pytest.mark.long),
        pytest.param("grid", 50_000, marks=pytest.mark.long),
    ],
)
def test_a_study_equals_peaks(scene, chunk, tmp_path):
    scene = SCENES[scene]()
    expected = ls.peaks(scene)
    assert_same(ls.study(scene, tmp_path / "study.nc", chunk=chunk).load(), expected)
    with xr.open_dataset(tmp_path / "study.nc") as plain:
        assert_same(plain.load(), expected)
    assert os.listdir(tmp_path) == ["study.nc"]


@pytest.mark.parametrize("scene", ["grid", "loop"])
def test_the_scene_of_a_study_is_read(scene, tmp_path):
    scene = SCENES[scene]()
    ls.study(scene, tmp_path / "study.nc", chunk=4)
    assert ls.load_scene(tmp_path / "study.nc") == scene


def test_a_variable_has_only_the_dims_that_it_depends_on(tmp_path):
    study = ls.study(grid(), tmp_path / "study.nc", chunk=4)
    assert {*study.status.dims} <= {*study.F32_peak.dims}
    assert {*study.F32_peak.dims} == {"size", "branch", "case", "omega2"}


def test_options_of_peaks_are_passed_on(tmp_path):
    angles = np.array([0.0, 10.0, 20.0, 30.0])
    study = ls.study(many(), tmp_path / "study.nc", of="T12_mean", chunk=7, theta2=angles)
    assert study.attrs["command"].startswith("linksweep.study(scene, of=['T12_mean'], theta2=array([ 0., 10.")
    assert study.T12_mean.identical(ls.peaks(many(), "T12_mean", theta2=angles).T12_mean)


def test_threads_are_limited_in_every_chunk(tmp_path, monkeypatch):
    seen = []
    peaks = chunk_module.peaks
    monkeypatch.setattr(chunk_module, "peaks", lambda *a, **b: seen.append(most_threads()) or peaks(*a, **b))
    ls.study(many(), tmp_path / "study.nc", of=["F32"], chunk=30, threads=2)
    assert seen == [2, 2, 2]  # the first is the one design that is tried out


def test_blocks_cover_all_designs_once_within_their_size():
    rng = random.Random(3)
    for _ in range(200):
        sizes = {dim: rng.randint(1, 9) for dim in "abc"[: rng.randint(1, 3)]}
        limit, counts = rng.randint(1, 60), np.zeros(list(sizes.values()), dtype=int)
        for block in blocks(sizes, limit):
            part = counts[tuple(block.get(dim, slice(None)) for dim in sizes)]
            assert 1 <= part.size <= limit
            part += 1
        assert (counts == 1).all()


def test_variables_that_differ_between_chunks_have_the_chunked_dims():
    def parts(second: float):
        for start, value in ((0, 1.0), (2, second)):
            ds = xr.Dataset({"a": ("n", [1.0, 2.0]), "b": value}, attrs={"scene": ""})
            yield {"n": slice(start, start + 2)}, ds

    assert assemble.layout_of(parts(1.0), {"n": 4}).dims == {"a": ("n",), "b": ()}
    assert assemble.layout_of(parts(7.0), {"n": 4}).dims == {"a": ("n",), "b": ("n",)}
    assert assemble.merged(("a", "c"), ("a", "b", "c")) == ("a", "b", "c")
    assert assemble.merged(("b",), ("a", "b", "d")) == ("a", "b", "d")


def test_all_numbers_have_checksums(tmp_path):
    ls.study(grid(), tmp_path / "study.nc", chunk=20)
    with netCDF4.Dataset(tmp_path / "study.nc") as file:
        covered = {name for name, stored in file.variables.items() if stored.filters()["fletcher32"]}
        assert {name for name, stored in file.variables.items() if stored.dtype is not str} == covered
        assert file["F32_peak"].coordinates == "crank.length coupler.mass"


# ---------------------------------------------------------------------------------------------- progress


class Screen(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_terminal_shows_progress(tmp_path, monkeypatch):
    screen = Screen()
    monkeypatch.setattr("linksweep.files.progress.SHOWN_AFTER", 0.0)
    with monkeypatch.context() as patch:
        patch.setattr(sys, "stderr", screen)
        ls.study(many(), tmp_path / "study.nc", of=["F32"], chunk=6)
    assert re.search(r"60\.0/60\.0", screen.getvalue())
    assert " designs/s]" in screen.getvalue()


def test_slow_designs_come_in_smaller_chunks(tmp_path, monkeypatch):
    """Larger chunks would show no progress, and store nothing, for minutes."""
    chunks = []
    run = study_module._run
    monkeypatch.setattr(study_module, "SLOW_CHUNK", 25)
    monkeypatch.setattr(study_module, "_run", lambda job, *words: chunks.append(len(job.blocks)) or run(job, *words))
    smooth, bent = (
        replace(many(), loads=[ls.Load("rocker", torque=torque)])
        for torque in (lambda theta2: np.cos(np.radians(theta2)), lambda theta2: abs(np.cos(np.radians(theta2 + 7.0))))
    )
    cases = ("a", many(), {}), ("b", smooth, {}), ("c", bent, {}), ("d", bent, {"theta2": 36})
    for name, scene, words in cases:
        ls.study(scene, tmp_path / f"{name}.nc", of=["F32"], **words)
    assert chunks == [1, 1, 3, 1]  # of 60 designs


def test_no_progress_without_a_terminal(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("linksweep.files.progress.SHOWN_AFTER", 0.0)
    ls.study(many(), tmp_path / "study.nc", of=["F32"], chunk=6)
    assert capsys.readouterr() == ("", "")


# ------------------------------------------------------------------------------------------- command line

SCENE = """\
omega2 = {dim = "speed", start = "100 rpm", stop = "300 rpm", num = 30}

[mechanism]
type = "FourBar"
ground = "20 cm"
crank = {type = "Bar", length = {dim = "a", values = [0.06, 0.08, 0.25, 0.9]}, width = 1, thickness = 1, density = 1}
coupler = {length = 0.22, mass = 0.7, inertia = 3e-3, cg_distance = "11 cm"}
rocker = {type = "Bar", length = "18 cm", width = "2 cm", thickness = "2 cm", density = 7750}
"""


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(SCENE)
    return tmp_path


def test_the_command_prints_the_worst_and_the_best(folder, capsys):
    assert main(["study", "scene.toml", "-o", "study.nc", "--of", "F32", "T12,By", "--chunk", "50"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    expected = ls.peaks(ls.load_scene("scene.toml"), ["F32", "T12", "By"])
    assert_same(ls.open_study("study.nc").load(), expected)
    worst, best = (re.findall(r"^F32_peak .*$", out, re.MULTILINE)[k].split() for k in (0, 1))
    assert worst[1] == f"{float(expected.F32_peak.max()):.6g}" == "inf"  # of 30 designs
    least = expected.F32_peak.where(expected.status == 0)
    place = least.argmin(["a", "speed"])
    assert best[1:] == [f"{float(least.min()):.6g}", "N", *(f"{float(least[place][d]):.6g}" for d in expected.sizes)]
    assert "designs: 120 (" in out
    assert out.splitlines()[-3].endswith(": ok 60, cannot-assemble 30, unbounded 30")
    assert out.endswith("\nwritten: study.nc\n")
    assert main(["study", "scene.toml", "-o", "study.nc", "--of", "F32,T12", "By"]) == 0
    assert capsys.readouterr().out == out.replace("written:", "was done already:")


def test_the_command_of_one_design_prints_its_peaks(folder, capsys):
    Path("one.toml").write_text(
        SCENE.replace('{dim = "speed", start = "100 rpm", stop = "300 rpm", num = 30}', "30").replace(
            '{dim = "a", values = [0.06, 0.08, 0.25, 0.9]}', '"8 cm"'
        )
    )
    assert main(["study", "one.toml", "-o", "one.nc"]) == 0
    assert "designs" not in capsys.readouterr().out
    assert_same(ls.open_study("one.nc").load(), ls.peaks(ls.load_scene("one.toml")))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["scene.toml", "-o", "scene.toml"], "scene.toml: its ending must be .nc: a study file is NetCDF"),
        (["scene.toml", "-o", "no/study.nc"], "no/study.nc: there is no folder no; make it first"),
        (["scene.toml", "-o", "study.nc", "--of", "F33"], "--of: nothing is named 'F33'"),
        (["scene.toml", "-o", "study.nc", "--chunk", "0"], "--chunk 0: must be a whole number"),
        (["scen.toml", "-o", "study.nc"], "scen.toml: there is no such file; did you mean"),
    ],
)
def test_the_command_refuses_bad_arguments(folder, arguments, message, capsys):
    assert main(["study", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"linksweep: {message}")
    assert os.listdir() == ["scene.toml"]


INTERRUPTED = """
import signal, sys
from linksweep.cli.main import main
from studies import hang_after
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
hang_after(20)
sys.exit(main())
"""


@pytest.mark.long
def test_ctrl_c_states_how_to_continue(folder, capsys):
    words = ["study", "scene.toml", "-o", "study.nc", "--chunk", "2"]
    process = subprocess.Popen(
        [sys.executable, "-c", INTERRUPTED, *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        text=True,
    )
    while process.poll() is None and not list(folder.glob("study.nc.partial/000002*.npz")):
        time.sleep(0.005)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate()
    assert (process.returncode, out) == (130, "")
    text = re.fullmatch(
        r"linksweep: stopped; (\d+) of 60 chunks are done: to go on from there, run the same again\n", err
    )
    assert 2 <= int(text[1]) <= 20  # the signal may come before the last file counts
    assert main(words) == 0
    assert main([*words[:3], "whole.nc", *words[4:]]) == 0
    assert Path("study.nc").read_bytes() == Path("whole.nc").read_bytes()
