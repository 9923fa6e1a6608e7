"""Load of a motor behind a gear at every crank angle, beside the motor's curve."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.drive.motors.motor import AnyMotor, motor_problems
from linksweep.base.checked_number import checked_number
from linksweep.base.validate import Number, Rule, quote, refuse
from linksweep.chains.between_links import pair_of
from linksweep.results.compute import require
from linksweep.results.dataset import with_units
from linksweep.results.over_time import mean_over_time
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene

RATIO = Rule("dimensionless", above=0.0)
EFFICIENCY = Rule("dimensionless", above=0.0)


def motor_load(
    scene: Scene,
    motor: AnyMotor,
    *,
    ratio: Number = 1.0,
    efficiency: Number = 1.0,
    theta2: Any = 720,
    threads: int | None = None,
) -> xr.Dataset:
    """Compute speed and torque of a motor that drives a machine through a gear, and its margin.

    Parameters
    ----------
    scene : Scene
        Scene driven by the torque on one of its links.
    motor : Motor, InductionMotor, DCMotor or GovernedMotor
        Motor with its torque over speed.
    ratio : float or DataArray, default 1.0
        Ratio of the gear: the motor's speed per that of the driven link [1].
    efficiency : float or DataArray, default 1.0
        Efficiency of the gear, in (0, 1] [1]: power is lost on the way to the machine, and again on the way back.
    theta2 : int or array_like, default 720
        Count of crank angles, or angles [degree], as in `linksweep.sweep`.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over the dims of a sweep (and those of ratio and efficiency):

        - `motor_speed` [rad/s] and `motor_torque` [N m], the rotor's own inertia included
        - `available_torque` [N m]: the largest torque of the motor at that speed
        - `torque_margin` [N m]: available less ``|motor_torque|``; negative where the motor is too weak
        - `reflected_inertia` [kg m²]: the rotor's inertia at the driven link, inertia·ratio²
        - `motor_torque_rms` [N m]: root mean square over time, which heats the motor.

    Raises
    ------
    ValueError
        If the drive is no torque on a link, or a number is out of bounds.

    Notes
    -----
    motor_torque = T/(ratio·η) + inertia·ratio·α where the drive feeds the machine, T·η/ratio + … where the machine
    drives it. Source: R. L. Norton, Design of Machinery, chapters "Kinematics Fundamentals" (motors and drivers) and
    "Dynamics Fundamentals" (inertia seen through a gear).

    Examples
    --------
    >>> import linksweep as ls
    >>> servo = ls.Motor(speeds=(0.0, 300.0, 600.0), torques=(4.0, 4.0, 1.0), inertia=2e-4)
    >>> load = ls.motor_load(ls.example("press"), servo, ratio=10.0)
    >>> bool((load.torque_margin > 0.0).all()), round(float(load.reflected_inertia), 9)
    (True, 0.02)
    """
    require(scene, "drives")
    refuse(_problems(scene, motor))
    ratio, efficiency = checked_number("ratio", ratio, RATIO), checked_number("efficiency", efficiency, EFFICIENCY)
    refuse([f"efficiency = {quote(efficiency)}: must be at most 1"] if np.any(efficiency > 1.0) else [])
    torque = scene.mechanism.drives[scene.drive]
    _, link = pair_of(torque) or (1, 2)
    omega, alpha = f"omega{link}", f"alpha{link}"
    cycle = sweep(scene, theta2, of=[torque, omega, alpha], threads=threads)
    index = scene.mechanism.index
    T, speed = cycle[torque].broadcast_like(cycle[index]), ratio * cycle[omega]
    fed = T * cycle[omega] > 0.0
    needed = xr.where(fed, T / efficiency, T * efficiency) / ratio + motor.inertia * ratio * cycle[alpha]
    available = motor.torque_at(abs(speed))
    results = {
        "motor_speed": (speed, "rad/s", "angular velocity of the motor"),
        "motor_torque": (needed, "N m", "torque of the motor, in the direction of the torque on the driven link"),
        "available_torque": (available, "N m", "largest torque of the motor at its speed"),
        "torque_margin": (available - abs(needed), "N m", "available torque less the magnitude of the motor's"),
        "reflected_inertia": (motor.inertia * ratio**2, "kg m^2", "rotor inertia at the driven link"),
        "motor_torque_rms": (np.sqrt(mean_over_time(needed**2, cycle, index)), "N m", "rms over time of motor_torque"),
    }
    return cycle[["status"]].assign(with_units(results)).assign_attrs(command="linksweep.motor_load(scene, ...)")


def _problems(scene: Scene, motor: Any) -> list[str]:
    problems = motor_problems(motor)
    if pair_of(scene.mechanism.drives[scene.drive]) is None:
        problems.append(f'drive = "{scene.drive}": must be the torque on a link, for a motor to turn it')
    return problems
