"""Run-up and run-down on the command line: the table, the steps in a file, failures in a sentence, and clear errors."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures  # noqa: F401

import linksweep as ls
from linksweep.cli.main import main

PRESS = ls.example("press")
DC = ["--motor", "dc", "stall_torque=6 N m", "no_load_speed=160"]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Enter a working folder with a press that a damper brakes."""
    monkeypatch.chdir(tmp_path)
    ls.save(ls.Scene(PRESS.mechanism, "-300 rpm", loads=[ls.TorsionDamper("ground", "crank", 0.5)]), "braked.toml")


def test_run_up_prints_the_table_and_writes_the_steps_and_their_figure(tmp_path, capsys):
    """Each option reaches the run, in its unit."""
    gear = ["--ratio", "5", "--efficiency", "0.9"]
    options = [*gear, "--flywheel", "500 kg cm^2", "--until", "0.5", "--start", "0.5 rad", "--of", "F32,T12"]
    assert main(["run-up", "press", *DC, *options, "-o", "run.nc", "--plot", "run.svg"]) == 0
    train = {"ratio": 5.0, "efficiency": 0.9, "flywheel": 0.05}
    run = ls.run_up(PRESS, ls.DCMotor(6.0, 160.0), **train, until=0.5, start="0.5 rad", of=["F32", "T12"])
    out = capsys.readouterr().out
    assert out == f"{run.linksweep}\n\nwritten: run.nc\n\nwritten: run.svg\n"
    assert "it takes" in out and "heat in the motor" in out and "lost in the gear" in out and "F32_peak" in out
    assert (tmp_path / "run.svg").read_text("utf-8").count("<path") > 20
    with xr.open_dataset("run.nc") as ds:
        np.testing.assert_array_equal(ds.speed, run.speed)
        np.testing.assert_allclose(ds.angle[0], np.degrees(0.5))


def test_run_down_needs_no_motor(capsys):
    scene, train = ls.load_scene("braked.toml"), {"flywheel": 0.2, "until": 0.2, "of": ["F32"]}
    options = ["--flywheel", "0.2", "--until", "0.2", "--of", "F32", "--plot", "stop.png"]
    rotor = ls.DCMotor(6.0, 160.0, inertia=0.01)
    for words, motor in (([], {}), ([*DC, "inertia=0.01", "--ratio", "5"], {"motor": rotor, "ratio": 5.0})):
        assert main(["run-down", "braked.toml", *words, *options]) == 0
        assert capsys.readouterr().out.startswith(f"{ls.run_down(scene, **motor, **train).linksweep}\n")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["run-up", "press", "--motor", "dc", "stall_torque=0.1", "no_load_speed=160"], "The motor does not start it"),
        (
            ["run-down", "press", "--flywheel", "0.3"],
            "It keeps turning: over a cycle, friction, dampers and loads take no energy away.",
        ),
        (["run-down", "braked.toml", "--flywheel", "9", "--turns", "2"], "It takes more turns than it was allowed."),
    ],
)
def test_a_run_that_comes_to_nothing_is_a_sentence_and_its_end(words, sentence, capsys):
    assert main([*words, "--of", "F32"]) == 0
    out = capsys.readouterr().out
    assert out.startswith(sentence) and "where it ends" in out and "F32" not in out


def test_a_run_backwards_that_does_not_start_ends_at_a_speed_without_a_sign():
    brake = ls.Load("crank", torque=50.0)
    run = ls.run_up(replace(PRESS, omega2=-30.0, loads=[brake]), ls.DCMotor(0.1, 160.0))
    assert np.signbit(run.speed[-1])
    ends = [line.split() for line in str(run.linksweep).splitlines()[-2:]]
    assert ends == [["angle", "0", "°"], ["speed", "0", "rad/s"]]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["run-up", "press", *DC, "--until", "2"], "--until 2: must be greater than 0 and at most 1"),
        (["run-down", "press", "--until", "1"], "--until 1.0: must be less than 1"),
        (["run-up", "press", *DC, "--turns", "0"], "--turns 0: must be greater than 0"),
        (["run-up", "press", *DC, "--of", "F99"], "--of: nothing is named 'F99'"),
        (["run-up", "press", *DC, "--ratio", "-1"], "--ratio -1: must be greater than 0"),
        (["run-down", "press", "--motor", "ac"], '--motor "ac": must begin with a kind'),
        (["run-up", "loop", *DC], "LoopTrack"),
    ],
)
def test_errors_are_one_line(words, message, capsys):
    assert main(words) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("linksweep: ") and err.count("\n") == 1
    assert message in err
