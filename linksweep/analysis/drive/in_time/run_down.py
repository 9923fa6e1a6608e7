"""Run-down of a machine whose motor is switched off: how long and how far its crank still turns.

Equations: `linksweep.analysis.drive.in_time.motion_in_time`.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from linksweep.analysis.drive.drive_train import drive_train
from linksweep.analysis.drive.in_time.motion_in_time import LASTS, REACHED, SETTLES, Run
from linksweep.analysis.drive.in_time.runs import Designs, Names, checked, described, turned
from linksweep.analysis.drive.in_time.time_steps import GIVEN_UP
from linksweep.analysis.drive.motors.direct_current import DCMotor
from linksweep.analysis.drive.motors.motor import AnyMotor
from linksweep.base.checked_number import one_number
from linksweep.base.validate import Number, Rule, quote, refuse
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import require
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.scene import Scene

UNTIL = Rule("dimensionless", at_least=0.0)
OUTCOMES = {REACHED: "ok", SETTLES: "keeps_turning", LASTS: "takes_more_turns", GIVEN_UP: "breaks_off"}
NO_MOTOR = DCMotor(stall_torque=1.0, no_load_speed=1.0)
"""A motor without inertia: its power is cut, so that nothing else of it matters."""


@limits_threads
def run_down(
    scene: Scene,
    motor: AnyMotor | None = None,
    *,
    ratio: Number = 1.0,
    flywheel: Number = 0.0,
    efficiency: Number = 1.0,
    until: float = 0.01,
    start: Number = 0.0,
    of: Names = None,
    turns: float = 200.0,
    threads: int | None = None,
) -> xr.Dataset:
    """Compute the run-down of a machine after its motor is switched off, with the largest pin forces on the way.

    Parameters
    ----------
    scene : Scene
        Machine driven by its crank, which turns at omega2 when the motor is switched off.
    motor : InductionMotor, DCMotor, GovernedMotor or Motor, default None
        Motor whose rotor turns along; None for none.
    ratio : float or DataArray, default 1.0
        Ratio of the gear: the motor's speed per that of the crank [1].
    flywheel : float or DataArray, default 0.0
        Moment of inertia of a flywheel on the crank's shaft [kg m²].
    efficiency : float or DataArray, default 1.0
        Efficiency of the gear, in (0, 1] [1]: power is lost on the way to the machine, and again on the way back.
    until : float, default 0.01
        Speed at which the run-down is over, per that at its start [1]; 0 for standstill, which dampers alone never
        bring about.
    start : float or DataArray, default 0.0
        Crank angle at which the motor is switched off [degree].
    of : str or iterable of str, default None
        Names of quantities whose largest magnitudes on the way are wanted; None for all pin forces and the torque on
        the crank, which is that of flywheel and rotor.
    turns : float, default 200.0
        Turns of the crank after which a run-down is given up, rounded up to whole cycles [1].
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over the design dims:

        - `duration` [s] and `turns` [1] until the speed is first reached; `kinetic_energy` [J] at the start, of the
          machine with flywheel and rotor; `gear_loss` [J], the part of the rotor's energy that the gear
          takes
        - of each quantity `F32_peak`, the largest magnitude on the way, `F32_peak_at` [degree] and `F32_peak_time` [s]
        - `time` [s], `angle` [degree], `speed` [rad/s] and `acceleration` [rad/s²] over `step`, the ends of the steps
          of integration; NaN after the last one. Crank angles count whole turns, from `start` on
        - `status`: `ok`; `keeps_turning`: a cycle takes no speed away, as without friction and dampers;
          `takes_more_turns`; `breaks_off`: the machine does not turn fully, jams, or nothing that turns with its crank
          has inertia. All but the steps is NaN where it is not ok.

    Raises
    ------
    ValueError
        If the drive is no torque on the crank, omega2 is 0 or changes its sign, a number is out of bounds, or arrays
        over one dim differ in length or labels.

    Notes
    -----
    Time and speed are accurate to about 1e-9, with steps that end where loads jump or change quickly; quantities are
    sampled at 144 places a turn or more, and the highest refined to the same accuracy. Where a crank swings back after
    its standstill is not computed.

    Examples
    --------
    >>> import linksweep as ls
    >>> from dataclasses import replace
    >>> press = ls.example("press")
    >>> off = replace(press, loads=[ls.TorsionDamper("ground", "crank", coefficient=0.05)])
    >>> stop = ls.run_down(off, flywheel=0.2, of=["F32"])
    >>> print(f"{float(stop.duration):.1f} s, {float(stop.turns):.1f} turns")
    15.0 s, 20.0 turns
    """
    require(scene, "drives")
    scene, until = in_memory(scene), one_number("until", until, UNTIL)
    refuse([f"until = {quote(until)}: must be less than 1"] if until >= 1.0 else [])
    start, turns, names = checked(scene, start, turns, of)
    train = drive_train(scene, NO_MOTOR if motor is None else motor, ratio, flywheel, efficiency, start)
    omega2 = _speed(scene, start)
    designs = Designs(scene, train, start, omega2)
    speed = designs.flat(omega2)
    run = Run(designs.crank(powered=False), speed, until * speed, -1.0, turns, speed)
    energy = designs.kinetic_energy(np.zeros(designs.count), speed)
    results = turned(run) | {"kinetic_energy": (energy, "J", "kinetic energy at the start, of flywheel and rotor too")}
    command = "linksweep.run_down(scene, ...)"
    return described(scene, designs, run, names, OUTCOMES, results, command).drop_vars("motor_torque")


def _speed(scene: Scene, start: Number) -> Number:
    """Return the size of omega2 at the start."""
    index = scene.mechanism.index
    changes = scene.changes_speed and np.ndim(start) > 0
    refuse([f"start: has {np.ndim(start)} dims, but omega2 changes with {index}: give one number"] if changes else [])
    omega2 = scene.at(scene.grid([float(start)])).omega2 if scene.changes_speed else scene.omega2
    return abs(omega2.isel({index: 0}, drop=True) if scene.changes_speed else omega2)
