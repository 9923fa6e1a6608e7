"""The machine on its motor on the command line: the motor's kind and numbers, the table, the file, and clear errors."""

from dataclasses import MISSING, fields, replace

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures  # noqa: F401

import linksweep as ls
from linksweep.cli.main import main
from linksweep.cli.motors import MOTORS, NUMBERS, motor_of

PRESS = ls.example("press")
DC = ["--motor", "dc", "stall_torque=53.1 lbf in", "no_load_speed=160"]


@pytest.mark.parametrize(
    ("words", "motor"),
    [
        ("dc stall_torque=10 no_load_speed=160", ls.DCMotor(10.0, 160.0)),
        ("dc|stall_torque=10 N m|no_load_speed=1500 rpm|inertia=4 kg cm^2", ls.DCMotor(10.0, "1500 rpm", 4e-4)),
        ("governed|torque=40 N m|cut_from=1500 rpm|cut_to=1590 rpm", ls.GovernedMotor(40.0, "1500 rpm", "1590 rpm")),
        ("curve|speeds=0, 1400, 1500 rpm|torques=10,9,0", ls.Motor([0, "1400 rpm", "1500 rpm"], [10.0, 9.0, 0.0])),
        (
            "induction synchronous_speed=150 breakdown_torque=15 breakdown_slip=0.2",
            ls.InductionMotor(150.0, 15.0, breakdown_slip=0.2),
        ),
        (
            "induction|synchronous_speed=1500 rpm|breakdown_torque=15|rated_torque=6|rated_speed=1425 rpm",
            ls.InductionMotor("1500 rpm", 15.0, rated_torque=6.0, rated_speed="1425 rpm"),
        ),
    ],
)
def test_a_motor_is_its_kind_and_its_numbers(words, motor):
    assert motor_of(words.split("|") if "|" in words else words.split()) == motor


def test_the_help_has_every_number_of_every_kind():
    assert {*MOTORS} == {*NUMBERS}
    for kind, name in MOTORS.items():
        own = {field.name for field in fields(getattr(ls, name))} - {"inertia"}
        assert own <= {*NUMBERS[kind].replace(",", " ").split()}
        assert any(field.default is MISSING for field in fields(getattr(ls, name)))


def test_steady_prints_the_table_and_writes_the_cycle_and_its_figure(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    files = ["-o", "cycle.nc", "--plot", "cycle.svg"]
    train = ["--ratio", "5", "--efficiency", "0.9", "--flywheel", "2000 kg cm^2", "--theta2", "72"]
    assert main(["steady", "press", *DC, *train, *files]) == 0
    motor = ls.DCMotor("53.1 lbf in", 160.0)
    cycle = ls.steady_cycle(PRESS, motor, ratio=5.0, efficiency=0.9, flywheel=0.2, theta2=72)
    out = capsys.readouterr().out
    assert "lost in the gear" in out and out == f"{cycle.linksweep}\n\nwritten: cycle.nc\n\nwritten: cycle.svg\n"
    assert (tmp_path / "cycle.svg").read_text("utf-8").count("<path") > 30
    with xr.open_dataset(tmp_path / "cycle.nc") as ds:
        np.testing.assert_array_equal(ds.omega2, cycle.omega2)
        assert ds.linksweep.scene == cycle.linksweep.scene


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["press", "--motor", "ac"], '--motor "ac": must begin with a kind: induction, dc, governed, curve'),
        (["press", "--motor", "dc", "stall=6"], '--motor dc: "stall=6": must be one of stall_torque, no_load_speed,'),
        (["press", *DC, "no_load_speed=9"], '"no_load_speed=9": must be one of stall_torque, no_load_speed, inertia,'),
        (["press", "--motor", "dc", "6 N m"], '"6 N m": must be one of'),
        (
            ["press", "--motor", "dc", "stall_torque=9", "no_load_speed"],
            "--motor dc: no_load_speed: has no value; write it as no_load_speed=VALUE\n",
        ),
        (["press", *DC, "ratio=5"], "--motor dc: ratio is no number of the motor itself: write it as --ratio 5\n"),
        (["press", "--motor", "dc"], "--motor dc: needs stall_torque and no_load_speed, each as NAME=VALUE"),
        (
            ["press", "--motor", "dc", "stall_torque=6 m", "no_load_speed=9"],
            'stall_torque = "6 m": m is a unit of leng',
        ),
        (["press", "--motor", "curve", "speeds=0,9", "torques=1,1"], "torques: must end with 0"),
        (
            ["press", "--motor", "curve", "speeds=0,9 rpm,12 rpm", "torques=1,1,0"],
            "speeds[2] = '9 rpm rpm': must be a number in rad/s",
        ),
        (["press", *DC, "--ratio", "-1"], "--ratio -1: must be greater than 0"),
        (["press", *DC, "--theta2", "0"], "--theta2 0: must be a whole number, 1 or more"),
        (["press", *DC, "--ratio", "5", "--theta2", "12", "-o", "none/cycle.nc"], "there is no folder none"),
        (["loop", *DC], "LoopTrack"),
    ],
)
def test_errors_are_one_line(words, message, capsys):
    assert main(["steady", *words]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("linksweep: ") and err.count("\n") == 1
    assert message in err


def test_a_motor_too_weak_is_a_table_and_has_no_figure(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    scene = ls.Scene(PRESS.mechanism, 30.0, loads=[ls.Load("crank", torque=-8.0)])
    ls.save(scene, "heavy.toml")
    words = ["steady", "heavy.toml", "--motor", "dc", "stall_torque=6", "no_load_speed=160", "--theta2", "36"]
    assert main(words) == 0 and "stalls" in capsys.readouterr().out
    assert main([*words, "--plot", "cycle.png"]) == 2
    assert "on its motor the machine stalls" in capsys.readouterr().err


def test_a_machine_that_does_not_turn_fully_has_no_figure_either(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    ls.save(replace(PRESS, mechanism=replace(PRESS.mechanism, ground=0.33)), "partly.toml")
    assert main(["steady", "partly.toml", *DC, "--plot", "cycle.png"]) == 2
    out, err = capsys.readouterr()
    assert "the machine does not turn fully" in out
    assert err == "linksweep: nothing to draw: the machine does not turn fully\n"
