"""Commands for a machine on its motor, its run-up and its run-down, and the options that describe the motor."""

from __future__ import annotations

import argparse
from dataclasses import MISSING, fields
from typing import TYPE_CHECKING, Any

import linksweep as ls
from linksweep.cli.options import RESULTS, Commands, a_file, a_number, add_angles, add_of, add_plot, number_or_text
from linksweep.cli.running import one_design, print_answer, show

if TYPE_CHECKING:
    import xarray as xr

    from linksweep.analysis.drive.motors.motor import AnyMotor

MOTORS = {"induction": "InductionMotor", "dc": "DCMotor", "governed": "GovernedMotor", "curve": "Motor"}
"""Public class of each kind of motor."""
NUMBERS = {
    "induction": "synchronous_speed breakdown_torque, with rated_torque rated_speed or breakdown_slip",
    "dc": "stall_torque no_load_speed",
    "governed": "torque cut_from cut_to",
    "curve": 'speeds torques, as in speeds="0, 1400, 1500 rpm"',
}
"""Words of the help on the numbers of each kind, besides its inertia."""


TRAIN = ("ratio", "flywheel", "efficiency")
"""Options for what is between the motor and the crank."""


def add_motor_commands(commands: Commands) -> None:
    """Add these commands to those of the command line."""
    text = "the speed of the crank on its motor, over the cycle that repeats; torque, power and heat of the motor"
    cycle = commands.add("steady", _steady, text, task="Drive")
    add_motor(cycle)
    add_angles(cycle, "number of angles (720)", default=720)
    cycle.add_argument("-o", "--output", type=a_file(RESULTS), help="cycle to write: .nc, .csv or .xlsx")
    add_plot(cycle)

    text = "from rest on the motor: time, heat of the motor, largest forces on the way; or that it does not start"
    start = commands.add("run-up", _run_up, text, task="Drive")
    add_motor(start)
    _add_run(start, "speed that ends it, per that of the operating point (0.99)", until=0.99)

    text = "after the motor is switched off: time and turns until the crank stands, largest forces on the way"
    stop = commands.add("run-down", _run_down, text, task="Drive")
    add_motor(stop, required=False)
    _add_run(stop, "speed that ends it, per omega2 of the scene; 0 for standstill (0.01)", until=0.01)


def add_motor(parser: argparse.ArgumentParser, *, required: bool = True) -> None:
    """Add the options for a motor, its gear and its flywheel; `motor_of` makes the motor."""
    kinds = "; ".join(f"{kind}: {numbers}" for kind, numbers in NUMBERS.items())
    text = f'kind and numbers, as in dc stall_torque="10 N m" no_load_speed="1500 rpm"; {kinds}; of each its inertia'
    parser.add_argument("--motor", nargs="+", required=required, metavar=("KIND", "NAME=VALUE"), help=text)
    parser.add_argument("--ratio", type=float, default=1.0, help="speed of the motor per that of the crank (1)")
    lossy = "efficiency of the gear (1)"
    parser.add_argument("--efficiency", type=float, default=1.0, metavar="ETA", help=lossy)
    wheel = 'moment of inertia of a flywheel on the crank, such as "0.2 kg m^2" (0)'
    parser.add_argument("--flywheel", type=a_number("inertia"), default=0.0, metavar="INERTIA", help=wheel)


def _add_run(parser: argparse.ArgumentParser, text: str, until: float) -> None:
    """Add the options of a run from one speed to another."""
    parser.add_argument("--until", type=float, default=until, metavar="PART", help=text)
    angle = 'crank angle at its start, such as "90 deg" (0)'
    parser.add_argument("--start", type=a_number("angle"), default=0.0, metavar="ANGLE", help=angle)
    parser.add_argument(
        "--turns", type=float, default=200.0, help="turns of the crank after which it is given up (200)"
    )
    add_of(parser)
    parser.add_argument("-o", "--output", type=a_file(RESULTS), help="run to write, step by step: .nc, .csv or .xlsx")
    add_plot(parser)


def motor_of(words: list[str]) -> AnyMotor:
    """Return the motor of the words after --motor: its kind, and its numbers as NAME=VALUE.

    Raises ValueError for an unknown kind, for words that are no numbers of this kind, and where one is missing.
    """
    from linksweep.base.validate import did_you_mean

    kind, *pairs = words
    if kind not in MOTORS:
        kinds = ", ".join(MOTORS)
        raise ValueError(f'--motor "{kind}": must begin with a kind: {kinds}{did_you_mean(kind, MOTORS)}')
    motor: Any = getattr(ls, MOTORS[kind])
    needed = {field.name: field.default is MISSING for field in fields(motor)}
    values: dict[str, Any] = {}
    for pair in pairs:
        name, equals, text = pair.partition("=")
        if name in TRAIN:
            raise ValueError(f"--motor {kind}: {name} is no number of the motor itself: write it as --{name} {text}")
        if not equals and name in needed:
            raise ValueError(f"--motor {kind}: {name}: has no value; write it as {name}=VALUE")
        if not equals or name not in needed or name in values:
            once = f"must be one of {', '.join(needed)}, each once, as NAME=VALUE"
            raise ValueError(f'--motor {kind}: "{pair}": {once}{did_you_mean(name, needed)}')
        values[name] = _points(text) if name in ("speeds", "torques") else number_or_text(text)
    missing = [name for name, always in needed.items() if always and name not in values]
    if missing:
        raise ValueError(f"--motor {kind}: needs {' and '.join(missing)}, each as NAME=VALUE")
    return motor(**values)


def _points(text: str) -> list[float | str]:
    """Return the numbers of a list with commas; the unit at its end is that of all."""
    *first, last = text.split(",")
    number, _, unit = last.strip().partition(" ")
    return [number_or_text(f"{each.strip()} {unit}".strip()) for each in (*first, number)]


def _steady(options: argparse.Namespace) -> None:
    scene, motor = one_design(options.scene), motor_of(options.motor)
    cycle = ls.steady_cycle(scene, motor, **_train(options), theta2=options.angles)
    _answer(options, cycle)
    show(options, lambda: ls.plot.steady_cycle(cycle))


def _run_up(options: argparse.Namespace) -> None:
    scene, motor = one_design(options.scene), motor_of(options.motor)
    run = ls.run_up(scene, motor, **_train(options), **_run(options))
    _answer(options, run)
    show(options, lambda: ls.plot.run_up(run))


def _run_down(options: argparse.Namespace) -> None:
    scene, motor = one_design(options.scene), motor_of(options.motor) if options.motor else None
    run = ls.run_down(scene, motor, **_train(options), **_run(options))
    _answer(options, run)
    show(options, lambda: ls.plot.run_up(run))


def _train(options: argparse.Namespace) -> dict[str, Any]:
    return {name: getattr(options, name) for name in TRAIN}


def _run(options: argparse.Namespace) -> dict[str, Any]:
    return {"until": options.until, "start": options.start, "of": options.of, "turns": options.turns}


def _answer(options: argparse.Namespace, ds: xr.Dataset) -> None:
    """Print the tables of a result, and write it to the file that the option -o names, if any."""
    print_answer(ds)
    if options.output:
        ls.save(ds, options.output)
        print(f"\nwritten: {options.output}")
