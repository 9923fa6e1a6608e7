"""A machine on its motor as one body: the balance of torques on its crank, for equations of motion.

The drive of a machine that turns at ω with α must give the torque T(θ, ω, α) of inverse dynamics, as `sweep` computes
it: it has the inertia of all links in it (Eksergian's J α + ½ J' ω²), weights, loads, springs, dampers and friction. A
motor behind a gear of the ratio i, and the inertias J_s on the crank's shaft, give

    T(θ, ω, α) + J_s α + L = i M(i ω),        J_s = J_flywheel + i² J_rotor

an equation for α at each angle and speed. A gear of the efficiency η passes the torque P = i M − i² J_rotor α to the
crank's shaft and takes from it L = (1 − η) P where the motor drives, L = (1 − 1/η) P where the machine does. T and its
exact derivatives to ω and α come from one kernel, so no term of it is written a second time here. Source: R. Eksergian,
Dynamical Analysis of Machines (1930).

For `steady_cycle` and `run_up`: `drive_train` checks a request, `DriveTrain.at` takes any list of angles, `balance` and
`acceleration` evaluate arrays (*designs, angles). Speed and acceleration are those along the crank's travel φ, which
goes in the direction of omega2: speed = dφ/dt ≥ 0, acceleration = d²φ/dt², and with w = speed²/2 that is dw/dφ.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.drive.duty import turning_problems
from linksweep.analysis.drive.motors.motor import AnyMotor, motor_problems
from linksweep.base.checked_number import checked_number
from linksweep.base.fields import numbers
from linksweep.base.frozen import bare, with_arrays
from linksweep.base.validate import Number, Rule, is_array, quote, refuse
from linksweep.chains.between_links import pair_of
from linksweep.engine.run import Field, Grid, evaluate
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.engine.trace.plan import InputForms, Plan, plan
from linksweep.results.compute import require
from linksweep.scene.derivatives.differentiated import MOTION, Differentiated, differentiated
from linksweep.scene.designs.selection import Block, selected
from linksweep.scene.dimensions import aligned, argument_problems
from linksweep.scene.scene import Scene

RATIO = Rule("dimensionless", above=0.0)
INERTIA = Rule("inertia", at_least=0.0)
EFFICIENCY = Rule("dimensionless", above=0.0, at_most=1.0)
ROUNDS = 8
"""Newton steps for an acceleration: the torque is a straight line over it, with corners where friction turns round."""

Array = np.ndarray


class Balance(NamedTuple):
    """Torque on the crank that is lacking, T + J_s α + L − i M [N m], and its derivatives to speed and acceleration."""

    lack: Array
    to_speed: Array
    to_acceleration: Array


@dataclass(frozen=True)
class DriveTrain:
    """A scene of one or many designs on its motor; made by `drive_train`.

    Parameters
    ----------
    scene : scene whose omega2 is the speed at which the motor no longer drives, over all designs, and alpha2 is 0
    motor, ratio, flywheel : motor, its speed per that of the crank, inertia of the flywheel on the crank's shaft
    efficiency : efficiency of the gear
    direction : 1 for a crank that turns counter-clockwise, -1 for clockwise
    plans : plans of the torque that have been made, by the forms of their inputs: one for all angles and blocks
    """

    scene: Scene
    motor: AnyMotor
    ratio: Number
    flywheel: Number
    efficiency: Number
    direction: float
    plans: dict[InputForms, Plan] = field(default_factory=dict)

    @cached_property
    def machine(self) -> Differentiated:
        """Scene with the torque on the crank, and its derivatives to speed and acceleration."""
        return differentiated(self.scene, (self.torque,), MOTION)

    @property
    def torque(self) -> str:
        """Name of the torque on the crank."""
        return self.scene.mechanism.drives[self.scene.drive]

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of that torque, and of its derivatives."""
        return (self.torque, *(derivative_of(self.torque, path) for path in MOTION))

    @cached_property
    def dims(self) -> tuple[str, ...]:
        """Design dims on which the motion depends."""
        inputs = self.machine.at_one_angle.inputs
        torque = plan(self.machine.table, (self.torque,), inputs.forms).outputs[self.torque]
        own = torque.dims | {*getattr(self.scene.omega2, "dims", ())}
        return tuple(dim for dim in inputs.sizes if dim in own)

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """Sizes of these dims."""
        sizes = self.machine.at_one_angle.inputs.sizes
        return tuple(sizes[dim] for dim in self.dims)

    @cached_property
    def top_speed(self) -> Array:
        """Speed of the crank at which the motor no longer drives [rad/s], over the designs."""
        return self.over_designs(abs(bare(self.scene.omega2)))

    @cached_property
    def shaft_inertia(self) -> Array:
        """Inertia of flywheel and rotor about the crank's axis [kg m²], over the designs."""
        ratio = bare(self.ratio)
        return self.over_designs(bare(self.flywheel) + ratio * ratio * bare(self.motor.inertia))

    def at(self, angles: int | Array) -> TrainAtAngles:
        """Return the machine at a count of even angles over the cycle, or at angles [degree]."""
        return TrainAtAngles(self, self.scene.grid(angles))

    def part(self, block: Block) -> DriveTrain:
        """Return the machine of some designs only."""

        def some(array: xr.DataArray) -> xr.DataArray:
            return array.isel({dim: part for dim, part in block.items() if dim in array.dims})

        names = ("motor", "ratio", "flywheel", "efficiency")
        return replace(
            self, scene=selected(self.scene, block), **{name: with_arrays(getattr(self, name), some) for name in names}
        )

    @cached_property
    def plain_ratio(self) -> Array:
        """Ratio over the designs."""
        return self.over_designs(bare(self.ratio))

    @cached_property
    def rotor_inertia(self) -> Array:
        """Inertia of the rotor at the crank's shaft, i² J_rotor [kg m²], over the designs."""
        return self.plain_ratio**2 * self.over_designs(bare(self.motor.inertia))

    @cached_property
    def lossless(self) -> bool:
        """True where the gear of every design passes on all of its power."""
        return bool(np.all(np.asarray(self.efficiency) == 1.0))

    @cached_property
    def plain_efficiency(self) -> Array:
        """Efficiency of the gear over the designs."""
        return self.over_designs(bare(self.efficiency))

    @cached_property
    def plain_motor(self) -> AnyMotor:
        """Motor with its numbers as plain arrays over the designs."""
        return with_arrays(self.motor, lambda number: self.over_designs(number.variable))

    def drive_torque(self, speed: Array) -> Array:
        """Return the motor's torque on the crank's shaft, i·M(i·ω) [N m], at speeds (*designs, angles) [rad/s]."""
        return self.plain_ratio * self.plain_motor.torque_at(self.plain_ratio * speed)

    def drive_slope(self, speed: Array) -> Array:
        """Return the derivative of that torque to the speed of the crank, i²·M'(i·ω) [N m s/rad]."""
        ratio = self.plain_ratio
        return ratio * ratio * self.plain_motor.torque_slope_at(ratio * speed)

    def gear_loss(self, speed: Array, acceleration: Array) -> Array:
        """Return the torque on the crank's shaft that the gear takes [N m], never negative."""
        passed = self.drive_torque(speed) - self.rotor_inertia * acceleration
        return lost_part(passed, self.plain_efficiency) * passed

    def motor_heat(self, speed: Array) -> Array:
        """Return the power that the motor turns into heat [W]."""
        return self.plain_motor.heat_at(self.plain_ratio * speed)

    def over_designs(self, number: Any) -> Array:
        """Return a number, or an array of some dims, over all design dims and an axis of length 1 for the angles."""
        variable = number if hasattr(number, "dims") else xr.Variable((), number)
        some = variable.set_dims(dict(zip(self.dims, self.shape, strict=True)))
        return np.asarray(some.transpose(*self.dims).values, dtype=float)[..., None]


@dataclass(frozen=True)
class TrainAtAngles:
    """A machine on its motor at the angles of a grid."""

    train: DriveTrain
    grid: Grid

    def balance(self, speed: Array, acceleration: Array, *, powered: bool = True) -> Balance:
        """Return the torque that a motion lacks, and its derivatives.

        Parameters
        ----------
        speed, acceleration : array (*designs, angles)
            Speed [rad/s] and acceleration [rad/s²] along the crank's travel.
        powered : bool, default True
            Whether the motor gives its torque; its rotor turns along without it, too.
        """
        train, sign = self.train, self.train.direction
        dims = (*train.dims, self.grid.dim)
        motion = {name: Field(dims, sign * value) for name, value in zip(MOTION, (speed, acceleration), strict=True)}
        inputs = self._sampled.inputs
        fields = evaluate(self._plan, {**inputs.fields, **motion}, self.grid, inputs.sizes)
        torque, to_speed, to_acceleration = (
            np.broadcast_to(aligned(fields[name], dims), speed.shape) for name in train.names
        )
        lack = sign * torque + train.shaft_inertia * acceleration
        to_acceleration = to_acceleration + train.shaft_inertia
        supply, slope = (train.drive_torque(speed), train.drive_slope(speed)) if powered else (0.0, 0.0)
        lack, to_speed = lack - supply, to_speed - slope
        if train.lossless:
            return Balance(lack, to_speed, to_acceleration)
        passed = supply - train.rotor_inertia * acceleration
        part = lost_part(passed, train.plain_efficiency)
        return Balance(lack + part * passed, to_speed + part * slope, to_acceleration - part * train.rotor_inertia)

    def acceleration(self, speed: Array, *, powered: bool = True) -> Array:
        """Return the acceleration that the motor's torque gives the machine at a speed [rad/s²]."""
        acceleration = np.zeros_like(speed)
        for _ in range(ROUNDS):
            lack, _, slope = self.balance(speed, acceleration, powered=powered)
            step = lack / slope
            acceleration = acceleration - step
            if np.all(~(abs(step) > 1e-15 * abs(acceleration))):
                break
        return acceleration

    @cached_property
    def _sampled(self) -> Scene:
        return self.train.machine.at(self.grid)

    @property
    def _plan(self) -> Plan:
        dims = (*self.train.dims, self.grid.dim)
        forms = tuple((name, dims if name in MOTION else form) for name, form in self._sampled.inputs.forms)
        plans = self.train.plans
        if forms not in plans:
            plans[forms] = plan(self._sampled.table, self.train.names, forms)
        return plans[forms]


def lost_part(passed: Array, efficiency: Array) -> Array:
    """Return the part of a torque that a gear takes, of one that it passes to the machine or, negative, from it."""
    return np.where(passed > 0.0, 1.0 - efficiency, 1.0 - 1.0 / efficiency)


def drive_train(
    scene: Scene, motor: AnyMotor, ratio: Any, flywheel: Any, efficiency: Any = 1.0, start: Number = 0.0
) -> DriveTrain:
    """Return a scene on its motor, for runs that start at a crank angle.

    Raises
    ------
    ValueError
        For a machine whose crank is not driven, or whose omega2 has no sign; for anything but a motor; for a ratio, an
        inertia or an efficiency that is out of bounds; and for arrays of other lengths or labels.
    """
    require(scene, "drives")
    refuse(_problems(scene, motor))
    ratio, flywheel = checked_number("ratio", ratio, RATIO), checked_number("flywheel", flywheel, INERTIA)
    efficiency = checked_number("efficiency", efficiency, EFFICIENCY)
    own = {"motor": motor, "ratio": ratio, "flywheel": flywheel, "efficiency": efficiency, "start": start}
    refuse(argument_problems(scene.arrays, **own))  # from here on they are arrays without labels
    direction = 1.0 if np.all(np.asarray(scene.at(scene.grid(1)).omega2) > 0.0) else -1.0
    designs = sum(0.0 * number for _, number, _ in numbers(motor) if is_array(number))
    designs = designs + 0.0 * flywheel + 0.0 * (efficiency - 1.0)
    top = direction * (motor.top_speed / ratio) + designs
    speed = top.drop_attrs(deep=False) if is_array(top) else top  # in rad/s, not in the unit of what else has its dims
    return DriveTrain(replace(scene, omega2=speed, alpha2=0.0), motor, ratio, flywheel, efficiency, direction)


def _problems(scene: Scene, motor: Any) -> list[str]:
    """List why a scene and a motor make no machine that runs by itself."""
    problems = motor_problems(motor)
    if pair_of(scene.mechanism.drives[scene.drive]) != (1, 2):
        problems.append(f'drive = "{scene.drive}": must be the crank, for its motor to turn it')
    turning = turning_problems(scene)
    omega2 = np.asarray(scene.at(scene.grid(1)).omega2)
    if not turning and np.any(omega2 > 0.0) and np.any(omega2 < 0.0):
        turning = [f"omega2 = {quote(scene.omega2)}: has both signs; give all designs one direction"]
    return problems + turning
