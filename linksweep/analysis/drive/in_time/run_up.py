"""Run-up of a machine from rest on its motor: how long it takes, how hot the motor gets, how hard its pins are loaded.

Equations: `linksweep.analysis.drive.in_time.motion_in_time`.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from linksweep.analysis.drive.drive_train import drive_train
from linksweep.analysis.drive.in_time.motion_in_time import LASTS, NOT_STARTED, REACHED, SETTLES, STOPS, Run
from linksweep.analysis.drive.in_time.runs import Designs, Names, checked, described, fed, turned
from linksweep.analysis.drive.in_time.time_steps import GIVEN_UP
from linksweep.analysis.drive.motors.motor import AnyMotor
from linksweep.analysis.drive.operating_point import operating_speed
from linksweep.base.checked_number import one_number
from linksweep.base.validate import Number, Rule
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import require
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.scene import Scene

UNTIL = Rule("dimensionless", above=0.0, at_most=1.0)
OUTCOMES = {
    REACHED: "ok",
    NOT_STARTED: "does_not_start",
    STOPS: "stalls",
    SETTLES: "settles_below",
    LASTS: "takes_more_turns",
    GIVEN_UP: "breaks_off",
}


@limits_threads
def run_up(
    scene: Scene,
    motor: AnyMotor,
    *,
    ratio: Number = 1.0,
    flywheel: Number = 0.0,
    efficiency: Number = 1.0,
    until: float = 0.99,
    start: Number = 0.0,
    of: Names = None,
    turns: float = 200.0,
    threads: int | None = None,
) -> xr.Dataset:
    """Compute the run-up of a machine from rest on its motor, with the largest pin forces on the way.

    Parameters
    ----------
    scene : Scene
        Machine driven by its crank; the sign of omega2 is the direction in which it starts.
    motor : InductionMotor, DCMotor, GovernedMotor or Motor
        Motor, switched on at rest.
    ratio : float or DataArray, default 1.0
        Ratio of the gear: the motor's speed per that of the crank [1].
    flywheel : float or DataArray, default 0.0
        Moment of inertia of a flywheel on the crank's shaft [kg m²].
    efficiency : float or DataArray, default 1.0
        Efficiency of the gear, in (0, 1] [1]: power is lost on the way to the machine, and again on the way back.
    until : float, default 0.99
        Speed at which the run-up is over, per that of the operating point [1]: there the motor gives the mean torque
        that the machine takes over a cycle at constant speed, or brakes it as much as its loads drive it. A machine
        without one is to reach that part of the speed at which its motor no longer drives.
    start : float or DataArray, default 0.0
        Crank angle from which it starts [degree].
    of : str or iterable of str, default None
        Names of quantities whose largest magnitudes on the way are wanted; None for all pin forces and the torque on
        the crank.
    turns : float, default 200.0
        Turns of the crank after which a run-up is given up, rounded up to whole cycles [1].
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over the design dims:

        - `duration` [s] and `turns` [1] until the speed is first reached; `operating_speed` [rad/s]
        - `gear_loss` [J]: work that the gear takes
        - `motor_work`, `motor_heat`, `kinetic_energy` [J]: work on the motor's shaft, heat in its rotor or winding (NaN
          of a motor whose curve does not tell), and energy of the machine with flywheel and rotor at the end
        - of each quantity `F32_peak`, the largest magnitude on the way, `F32_peak_at` [degree] and `F32_peak_time` [s]
        - `time` [s], `angle` [degree], `speed` [rad/s], `acceleration` [rad/s²] and `motor_torque` [N m] over `step`,
          the ends of the steps of integration; NaN after the last one. Crank angles count whole turns, from `start` on
        - `status`: `ok`; `does_not_start`: at rest the motor does not overcome weights, loads and friction; `stalls`:
          the crank comes to rest on its way; `settles_below`: its speed repeats from cycle to cycle, below the one that
          is sought; `takes_more_turns`; `breaks_off`: the machine does not turn fully, jams, or nothing that turns
          with its crank has inertia. All but the steps is NaN where it is not ok.

    Raises
    ------
    ValueError
        If the drive is no torque on the crank, omega2 is 0 or changes its sign, a number is out of bounds, or arrays
        over one dim differ in length or labels.

    Notes
    -----
    The motor's torque is that of its speed: its electrical transients, which last some periods of the mains, are left
    out. A crank that its weights would turn backwards does not start. Time and speed are accurate to about 1e-9, with
    steps that end where loads jump or change quickly; quantities are sampled at 144 places a turn or more, and the
    highest refined to the same accuracy.

    Examples
    --------
    >>> import linksweep as ls
    >>> motor = ls.InductionMotor("1500 rpm", "15 N m", rated_torque="6 N m", rated_speed="1425 rpm", inertia=0.004)
    >>> start = ls.run_up(ls.example("press"), motor, ratio=5.0, of=["F32"])
    >>> print(f"{float(start.duration):.3f} s, {float(start.motor_heat):.1f} J of heat in the rotor")
    0.106 s, 71.9 J of heat in the rotor
    >>> print(f"F32 up to {float(start.F32_peak):.0f} N on the way")
    F32 up to 238 N on the way
    """
    require(scene, "drives")
    scene, until = in_memory(scene), one_number("until", until, UNTIL)
    start, turns, names = checked(scene, start, turns, of)
    designs = Designs(scene, drive_train(scene, motor, ratio, flywheel, efficiency, start), start)
    usual, top = operating_speed(designs), designs.top_speed
    target = until * np.where(np.isfinite(usual), usual, top)
    run = Run(designs.crank(), np.zeros(designs.count), target, 1.0, turns, top)
    results = turned(run) | fed(designs, run)
    results["operating_speed"] = (
        usual,
        "rad/s",
        "speed at which the motor gives the mean torque that the machine takes",
    )
    return described(scene, designs, run, names, OUTCOMES, results, "linksweep.run_up(scene, ...)")
