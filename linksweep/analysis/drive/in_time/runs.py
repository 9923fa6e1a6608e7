"""A scene's designs on their motor, run from one speed to another, and the Dataset of such a run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.drive.drive_train import DriveTrain, lost_part
from linksweep.analysis.drive.in_time.motion_in_time import ANGLE, HEAT, LOSS, SPEED, WORK, Crank, Drive, Run
from linksweep.analysis.drive.in_time.peaks_in_time import peaks_in_time
from linksweep.analysis.drive.motors.motor import AnyMotor
from linksweep.base.checked_number import checked_number, one_number
from linksweep.base.fields import declared
from linksweep.base.frozen import with_sound
from linksweep.base.validate import Number, Rule, refuse
from linksweep.chains.between_links import force_name
from linksweep.results.compute import quantity_problems, requested_some
from linksweep.results.dataset import design_coordinates, flags, provenance, with_units
from linksweep.scene.at_sections import link_of
from linksweep.scene.pairs import Array, by_row
from linksweep.scene.scene import Scene

START = Rule("angle")
TURNS = Rule("dimensionless", above=0.0)
Names = str | Iterable[str] | None
Results = dict[str, tuple[Array, str, str]]
"""Numbers of all designs, unit and description by name."""
STEP = "step"
"""Dim of the ends of steps in time."""


class Designs:
    """All designs of a scene on its motor, in one row."""

    def __init__(self, scene: Scene, train: DriveTrain, start: Number, speed: Number = 0.0) -> None:
        self.train = train
        over_start = replace(train.scene, omega2=train.scene.omega2 + 0.0 * start)
        # over all design dims; not validated: a speed from `grid` has a dim omega2, and that of another is over it here
        self.scene = with_sound(over_start, omega2=over_start.omega2 + 0.0 * speed)
        self.sizes = self.scene.at_one_angle.inputs.sizes
        self.order = tuple(dict.fromkeys((*scene.at_one_angle.inputs.sizes, *self.sizes)))
        self.count = int(np.prod([*self.sizes.values()], dtype=int))
        self.start, self.ratio = self.flat(start), self.flat(train.ratio)
        self.rotor, self.efficiency = self.ratio**2 * self.flat(train.motor.inertia), self.flat(train.efficiency)
        self.inertia = self.flat(train.flywheel) + self.rotor

    @property
    def top_speed(self) -> Array:
        """Speeds of the cranks at which their motors no longer drive [rad/s]."""
        return abs(self.flat(self.scene.omega2))

    def flat(self, number: Any) -> Array:
        """Return a number, or an array with design dims, for each design."""
        variable = number.variable if isinstance(number, xr.DataArray) else xr.Variable((), number)
        return variable.set_dims(self.sizes).transpose(*self.sizes).values.astype(float).ravel()

    def over_dims(self, values: Array, attributes: Mapping[str, Any] | None = None) -> xr.Variable:
        """Return numbers of all designs over the design dims, and over steps if there is a second axis."""
        dims = (*self.sizes, STEP)[: len(self.sizes) + values.ndim - 1]
        over = xr.Variable(dims, values.reshape((*self.sizes.values(), *values.shape[1:])), attributes)
        return over.transpose(*(dim for dim in (*self.order, STEP) if dim in dims))

    def crank(self, powered: bool = True) -> Crank:
        """Return the cranks of all designs, at rest or turning; without power the motor's rotor turns along."""

        def idle(rows: Array, speed: Array) -> Array:
            return 0.0 * speed

        def heat(rows: Array, speed: Array) -> Array:
            return np.nan_to_num(self.heat(rows, speed))

        def loss(rows: Array, speed: Array, rise: Array) -> Array:
            passed = torque(rows, speed) - self.rotor[rows] * rise
            return lost_part(passed, self.efficiency[rows]) * passed

        torque = self.torque if powered else idle
        drive = Drive(torque, heat if powered else idle, self.inertia, None if self.train.lossless else loss)
        way = np.full(self.count, self.train.direction)
        return Crank(self.scene, drive, way, self.start)

    def torque(self, rows: Array, speed: Array) -> Array:
        """Return the torque of the motors of some designs on the crank's shaft [N m]."""
        ratio = self.ratio[rows]
        return ratio * self._motor(rows).torque_at(ratio * speed)

    def heat(self, rows: Array, speed: Array) -> Array:
        """Return the power that they turn into heat [W]."""
        return self._motor(rows).heat_at(self.ratio[rows] * speed)

    def kinetic_energy(self, angle: Array, speed: Array) -> Array:
        """Return the kinetic energy of all designs, of flywheel and rotor too [J], at φ [rad] and w [rad/s]."""
        crank = self.crank()
        (inertia,) = crank.values(("reduced_inertia",), crank.at(np.arange(self.count), angle), speed, 0.0 * speed)
        return 0.5 * (inertia + self.inertia) * speed**2

    @cached_property
    def _numbers(self) -> dict[str, Array]:
        """Parameters of the motor over designs, flat."""
        fields = ((name, getattr(self.train.motor, name)) for name, *_ in declared(self.train.motor))
        return {name: self.flat(value) for name, value in fields if isinstance(value, xr.DataArray)}

    def _motor(self, rows: Array) -> AnyMotor:
        return with_sound(self.train.motor, **{name: values[rows] for name, values in self._numbers.items()})


def checked(scene: Scene, start: Any, turns: Any, of: Names) -> tuple[Number, float, tuple[str, ...]]:
    """Return the start [degree], the most turns and the names of quantities, as they are to be."""
    start, turns = checked_number("start", start, START), one_number("turns", turns, TURNS)
    names = requested_some("of", pins_and_torque(scene) if of is None else of, scene)
    unknown = [problem for name in names for problem in quantity_problems("of", name, scene.table.quantity, scene)]
    along = [name for name in names if link_of(name)]
    refuse(unknown or [f"of: {name} is along a link: a run has none; ask for it with ls.peaks" for name in along])
    return start, turns, tuple(names)


def pins_and_torque(scene: Scene) -> list[str]:
    """Return the names of the magnitudes of all pin forces, and of the drive's torque."""
    machine = scene.mechanism
    return [*(force_name(i, j) for i, j in machine.pins.values()), machine.drives[scene.drive]]


def described(
    scene: Scene,
    designs: Designs,
    run: Run,
    names: tuple[str, ...],
    outcomes: Mapping[int, str],
    results: Results,
    command: str,
) -> xr.Dataset:
    """Return the Dataset of a run: its steps, the results of each design, and peaks on the way.

    `outcomes` are the words for what may become of a design, the first of them for one that reaches its speed; the
    results of others are NaN.
    """
    status = np.array([[*outcomes].index(outcome) for outcome in run.trace.outcome], dtype=np.int8)
    of_designs = results | _peaks(scene, designs, run, names)
    known: Results = {name: (np.where(status == 0, a, np.nan), u, text) for name, (a, u, text) in of_designs.items()}
    every = (_steps(designs, run) | known).items()
    variables = with_units({name: (designs.over_dims(values), units, text) for name, (values, units, text) in every})
    words = flags("what became of the crank; results are NaN where it is not ok", outcomes.values())
    coordinates = {**designs.scene.labels, **design_coordinates(scene)}
    attributes = provenance(scene, command, coordinates)
    return xr.Dataset({**variables, "status": designs.over_dims(status, words)}, coordinates, attributes)


def _steps(designs: Designs, run: Run) -> Results:
    """Return the motion at the ends of steps: (design, step), NaN after a design's last one."""
    trace, crank = run.trace, run.crank
    way = crank.direction[trace.rows]
    speed, rise = trace.state[:, SPEED], trace.slope[:, SPEED]
    torque = crank.drive.torque(trace.rows, speed) / designs.ratio[trace.rows]
    ends = {
        "time": (trace.time, "s", "time from the start"),
        "angle": (crank.angles(trace.rows, trace.state[:, ANGLE]), "degree", "crank angle, whole turns counted"),
        "speed": (way * speed, "rad/s", "angular velocity of the crank"),
        "acceleration": (way * rise, "rad/s^2", "angular acceleration of the crank"),
        "motor_torque": (torque, "N m", "torque of the motor in its direction, that on its own rotor included"),
    }
    return {
        name: (by_row(trace.rows, values, designs.count), unit, text) for name, (values, unit, text) in ends.items()
    }


def _peaks(scene: Scene, designs: Designs, run: Run, names: tuple[str, ...]) -> Results:
    """Return the largest magnitude of each quantity on the way, and its angle and time."""
    peaks, rows = peaks_in_time(run, names), np.arange(designs.count)
    results: Results = {}
    for name, value, time, angle in zip(names, *peaks, strict=True):
        quantity = scene.table.quantity[name]
        text = f"largest magnitude on the way of {quantity.long_name}"
        results[f"{name}_peak"] = (value, quantity.units, text)
        results[f"{name}_peak_at"] = (run.crank.angles(rows, angle), "degree", f"crank angle at {name}_peak")
        results[f"{name}_peak_time"] = (time, "s", f"time at {name}_peak")
    return results


def ends_of(run: Run) -> tuple[Array, Array]:
    """Return the time and the state of each design at its end."""
    last = {int(row): k for k, row in enumerate(run.trace.rows)}  # the last step of each
    at = [last[row] for row in range(len(run.target))]
    return run.trace.time[at], run.trace.state[at]


def turned(run: Run) -> Results:
    """Return how long a run takes: time, and turns of the crank."""
    time, state = ends_of(run)
    return {
        "duration": (time, "s", "time until the speed is reached"),
        "turns": (state[:, ANGLE] / (2.0 * np.pi), "1", "turns of the crank until then"),
        "gear_loss": (state[:, LOSS], "J", "work that the gear takes until then"),
    }


def fed(designs: Designs, run: Run) -> Results:
    """Return what a run takes from the motor: its work, its heat; and the kinetic energy at the end."""
    _, state = ends_of(run)
    known = np.isfinite(designs.heat(np.arange(designs.count), state[:, SPEED]))
    energy = designs.kinetic_energy(state[:, ANGLE], state[:, SPEED])
    return {
        "motor_work": (state[:, WORK], "J", "work of the motor on its shaft until then"),
        "motor_heat": (
            np.where(known, state[:, HEAT], np.nan),
            "J",
            "energy that the motor turns into heat until then",
        ),
        "kinetic_energy": (energy, "J", "kinetic energy then, of flywheel and rotor too"),
    }
