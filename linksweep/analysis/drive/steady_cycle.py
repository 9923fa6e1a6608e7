"""The steady cycle of a machine on its motor: the speed that the crank takes by itself, over the whole cycle."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from linksweep.analysis.drive.collocation import POINTS, Array, integral, turning_points
from linksweep.analysis.drive.drive_train import MOTION, DriveTrain, drive_train
from linksweep.analysis.drive.motors.curve import Motor
from linksweep.analysis.drive.motors.induction import InductionMotor
from linksweep.analysis.drive.motors.motor import AnyMotor
from linksweep.analysis.drive.periodic import OK, STATUS, Motion, periodic
from linksweep.base.frozen import with_sound
from linksweep.base.validate import Number, count_problems, refuse
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import sample_status
from linksweep.results.dataset import design_coordinates, flags, index_coordinate, kept_beside, origin_attributes
from linksweep.scene.designs.selection import blocks, design_sizes
from linksweep.scene.dimensions import aligned
from linksweep.scene.file.writing import write_scene
from linksweep.scene.scene import Scene

TOGETHER = 32
"""Designs that are solved together, over the same elements."""
ROUNDING = 1e-9
"""Degrees by which the ends of elements may miss the angles of the results."""
EXTREMES = {
    "motor_torque_max": (1.0, False),
    "motor_torque_min": (-1.0, False),
    "motor_power_max": (1.0, True),
    "motor_power_min": (-1.0, True),
}
"""Sign that makes each a largest value, and whether it is one of the power."""
PLACES, NARROWINGS = 33, 13
"""Speeds among which an extreme is sought, and times that their range is narrowed: to 1e-15 of the first."""
COMMAND = "linksweep.steady_cycle(scene, ...)"
OVER_ANGLES = ("omega2", "alpha2", "motor_speed", "motor_torque", "motor_power", "slip", "drive_torque")
TEXTS = {
    "omega2": ("rad/s", "angular velocity of the crank on its motor, positive counter-clockwise"),
    "alpha2": ("rad/s^2", "angular acceleration of the crank on its motor, positive counter-clockwise"),
    "motor_speed": ("rad/s", "angular velocity of the motor, positive in the direction in which it drives"),
    "motor_torque": ("N m", "torque of the motor, positive where it drives"),
    "motor_power": ("W", "power of the motor's shaft, negative where the machine drives it"),
    "slip": ("1", "slip of the motor: how far its speed is below the synchronous speed, as a part of that"),
    "drive_torque": ("N m", "torque on the crank without rotor and flywheel, positive counter-clockwise"),
    "speed_mean": ("rad/s", "mean speed of the crank over time, never negative"),
    "speed_max": ("rad/s", "largest speed of the crank"),
    "speed_min": ("rad/s", "least speed of the crank"),
    "fluctuation": ("1", "coefficient of fluctuation of the speed: (largest - least)/mean of the two"),
    "cycle_time": ("s", "time of a cycle"),
    "motor_work": ("J", "work of the motor in a cycle, which loads, friction and the gear take"),
    "gear_loss": ("J", "work that the gear takes in a cycle"),
    "motor_torque_max": ("N m", "largest torque of the motor"),
    "motor_torque_min": ("N m", "least torque of the motor, negative where it brakes"),
    "motor_torque_rms": ("N m", "root mean square over time of the motor's torque"),
    "motor_power_max": ("W", "largest power of the motor"),
    "motor_power_min": ("W", "least power of the motor, negative where the machine drives it"),
    "motor_power_mean": ("W", "mean power of the motor over time"),
    "motor_heat_mean": ("W", "mean power over time that turns into heat in the motor (induction: in its rotor alone)"),
    "deviation_factor": ("1", "factor by which a deviation of the speed shrinks from cycle to cycle"),
    "energy_residual": ("J", "energy of a cycle that the computed motion leaves unbalanced, at most"),
}


@limits_threads
def steady_cycle(
    scene: Scene,
    motor: AnyMotor,
    *,
    ratio: Number = 1.0,
    flywheel: Number = 0.0,
    efficiency: Number = 1.0,
    theta2: int = 720,
    threads: int | None = None,
) -> xr.Dataset:
    """Compute the speed of a machine on its motor over the cycle that repeats.

    Parameters
    ----------
    scene : Scene
        Scene driven at its crank; of its omega2 the sign alone counts, and alpha2 does not.
    motor : Motor, InductionMotor, DCMotor or GovernedMotor
        Motor with its torque over speed, and the inertia of its rotor.
    ratio : float or DataArray, default 1.0
        Ratio of the gear: the motor's speed per that of the crank [1].
    flywheel : float or DataArray, default 0.0
        Moment of inertia of a flywheel on the crank's shaft [kg m²].
    efficiency : float or DataArray, default 1.0
        Efficiency of the gear, in (0, 1] [1]: power is lost on the way to the machine, and again on the way back.
    theta2 : int, default 720
        Count of crank angles over the cycle.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over the design dims of scene, motor, gear and flywheel; over theta2 those that change:

        - `omega2` [rad/s] and `alpha2` [rad/s²] of the crank: ``ds.linksweep.scene`` is the scene with this motion,
          which `linksweep.sweep`, `linksweep.peaks` and all others take; see the notes on loads that jump
        - `motor_speed` [rad/s], `motor_torque` [N m], `motor_power` [W]; of an induction motor `slip` [1]
        - `drive_torque` [N m] on the crank: what inverse dynamics asks for
        - `speed_mean` over time, `speed_max` and `speed_min` [rad/s], `fluctuation` [1], `cycle_time` [s]
        - `motor_torque_max` and `motor_torque_min` [N m], `motor_power_max` and `motor_power_min` [W]: exact extremes
        - `motor_work` and `gear_loss` [J] in a cycle; over time `motor_power_mean` [W], `motor_torque_rms` [N m] and
          `motor_heat_mean` [W], which is NaN for motors that do not tell it
        - `deviation_factor` [1]: a deviation of the speed shrinks by it from cycle to cycle
        - `energy_residual` [J]: by so much energy, at most, the motion misses its equation over the cycle
        - `status`: not_whole (no whole revolution), stalls (the motor is too weak), runs_away (the loads drive the
          machine, and no speed makes the motor brake them), unstable (a deviation would grow), not_found (no motion
          that repeats, as where no torque depends on the speed); where it is not ok, values are NaN.

        Of designs that are not all ok, take those that are for the scene: ``ds.isel(design=ds.status == 0)``.

    Raises
    ------
    ValueError
        If the crank is not driven or stands still, the motor is none, a number is out of bounds, or arrays over one dim
        differ in length or labels.

    Notes
    -----
    The motion is the periodic solution of T(θ, ω, α) + J_s α + L = i·M(i·ω), with the torque T of inverse dynamics,
    the inertia J_s of flywheel and rotor, and the torque L that the gear takes: see
    `linksweep.analysis.drive.drive_train`. Loads, dampers and friction act at the speeds of the motion itself.

    The scene joins omega2 and alpha2 between the angles theta2 by splines. Where loads or friction jump, alpha2 jumps,
    which a spline cannot do: there results of the scene are right at the angles theta2 alone, as of
    ``linksweep.sweep(ds.linksweep.scene, ds.theta2.values)``. Its exact peaks are those of the spline, which beside a
    jump err by a part of the jump, however many the angles are. `motor_torque_max` and all else of the cycle in this
    Dataset have the jumps in.

    Sources: R. Eksergian, Dynamical Analysis of Machines (1930); F. Wittenbauer, Graphische Dynamik (1923).

    Examples
    --------
    >>> import linksweep as ls
    >>> motor = ls.InductionMotor("1500 rpm", "15 N m", rated_torque="6 N m", rated_speed="1425 rpm", inertia=0.004)
    >>> cycle = ls.steady_cycle(ls.example("press"), motor, ratio=5.0, flywheel=0.2, theta2=72)
    >>> print(f"{float(cycle.speed_mean):.3f} rad/s, fluctuation {float(cycle.fluctuation):.4f}")
    31.405 rad/s, fluctuation 0.0542
    >>> ls.sweep(cycle.linksweep.scene, of="T12").sizes["theta2"]  # with the fluctuation in
    720
    """
    train = drive_train(scene, motor, ratio, flywheel, efficiency)
    refuse(count_problems("theta2", theta2) + _curve_problems(motor))
    sizes = {dim: n for dim, n in design_sizes(train.scene).items() if dim in train.dims}
    numbers = {name: np.full((*train.shape, theta2 if name in OVER_ANGLES else 1), np.nan) for name in TEXTS}
    numbers["status"] = np.zeros((*train.shape, 1), dtype=np.int8)
    for block in blocks(sizes, TOGETHER):
        place = tuple(block.get(dim, slice(None)) for dim in train.dims)
        for name, values in _solved(train.part(block), theta2).items():
            numbers[name][place] = values
    return _described(train, numbers, theta2)


def _curve_problems(motor: AnyMotor) -> list[str]:
    """Return the problem of a motor's curve that ends with a torque, which no speed beyond balances."""
    sudden = isinstance(motor, Motor) and motor.torques[-1] > 0.0
    return ["motor.torques: must end with 0, at the speed at which the motor no longer drives"] if sudden else []


def _solved(train: DriveTrain, count: int) -> dict[str, Array]:
    """Return all numbers of some designs, (*designs, angles or 1)."""
    result = periodic(train, count, _whole(train, count))
    ok = result.status == OK
    motion = result.motion._replace(w=np.where(ok[:, None], result.motion.w, np.nan))
    with np.errstate(invalid="ignore"):
        numbers = _over_angles(train, motion, count) | _over_cycle(train, motion)
    numbers |= {"deviation_factor": np.where(ok, result.factor, np.nan)}
    numbers |= {"energy_residual": np.where(ok, result.defect, np.nan), "status": result.status.astype(np.int8)}
    return {name: values.reshape(*train.shape, -1) for name, values in numbers.items()}


def _whole(train: DriveTrain, count: int) -> Array:
    """Return of each design whether its crank can turn all the way round."""
    grid = train.scene.grid(count)
    status = sample_status(train.scene.at(grid), grid)
    known = np.broadcast_to(aligned(status, (*train.dims, grid.dim)) == 0, (*train.shape, count))
    return known.all(axis=-1).ravel()


def _over_angles(train: DriveTrain, motion: Motion, count: int) -> dict[str, Array]:
    """Return the results at the angles theta2."""
    angles = np.arange(count) * (train.scene.period / count)
    travelled = np.searchsorted(motion.travel, angles - ROUNDING)
    order = travelled if train.direction > 0.0 else np.roll(travelled[::-1], 1)
    speed = np.sqrt(2.0 * motion.w[:, order]).reshape(*train.shape, count)
    acceleration = train.at(count).acceleration(speed)
    ratio = train.plain_ratio
    torque, lost = train.drive_torque(speed), train.gear_loss(speed, acceleration)
    results = {
        "omega2": train.direction * speed,
        "alpha2": train.direction * acceleration,
        "motor_speed": ratio * speed,
        "motor_torque": torque / ratio,
        "motor_power": torque * speed,
        "drive_torque": train.direction * (torque - train.shaft_inertia * acceleration - lost),
    }
    if isinstance(train.plain_motor, InductionMotor):
        results["slip"] = train.plain_motor.slip_at(ratio * speed)
    return results


def _over_cycle(train: DriveTrain, motion: Motion) -> dict[str, Array]:
    """Return the results of the whole cycle: extremes, and integrals over its time or angle."""
    shape, widths = motion.a.shape, motion.widths
    speed = np.sqrt(2.0 * motion.inside(POINTS)[0])
    over_designs, acceleration = (each.reshape(*train.shape, -1) for each in (speed, motion.a))
    torque, heat = (of(over_designs).reshape(shape) for of in (train.drive_torque, train.motor_heat))
    lost = train.gear_loss(over_designs, acceleration).reshape(shape)
    ratio = train.plain_ratio.ravel()
    time, work = integral(1.0 / speed, widths), integral(torque, widths)
    w = turning_points(motion.w, motion.a, widths)
    fastest, slowest = (np.sqrt(2.0 * extreme(w, axis=(1, 2))) for extreme in (np.max, np.min))
    return _motor_extremes(train, slowest, fastest) | {
        "speed_mean": widths.sum() / time,
        "speed_max": fastest,
        "speed_min": slowest,
        "fluctuation": (fastest - slowest) / (0.5 * (fastest + slowest)),
        "cycle_time": time,
        "motor_work": work,
        "gear_loss": integral(lost, widths),
        "motor_power_mean": work / time,
        "motor_torque_rms": np.sqrt(integral(torque * torque / speed, widths) / time) / ratio,
        "motor_heat_mean": integral(heat / speed, widths) / time,
    }


def _motor_extremes(train: DriveTrain, slowest: Array, fastest: Array) -> dict[str, Array]:
    """Return the extremes of the motor's torque and power: those over all speeds between the least and the largest.

    The machine runs through all of these. The range around the best of evenly spaced ones is narrowed until it is a
    point, which may be a corner of the motor's curve.
    """
    low, high = (np.repeat(each.reshape(*train.shape, 1), len(EXTREMES), axis=-1) for each in (slowest, fastest))
    sign, of_power = (np.array(each)[:, None] for each in zip(*EXTREMES.values(), strict=True))
    for _ in range(NARROWINGS):
        speed = low[..., None] + (high - low)[..., None] * np.linspace(0.0, 1.0, PLACES)
        torque = train.drive_torque(speed.reshape(*train.shape, -1)).reshape(speed.shape)
        values = sign * np.where(of_power, torque * speed, torque / train.plain_ratio[..., None])
        best = np.argmax(values, axis=-1, keepdims=True)
        low, high = (
            np.take_along_axis(speed, np.clip(best + step, 0, PLACES - 1), axis=-1)[..., 0] for step in (-1, 1)
        )
    extremes = (sign * np.take_along_axis(values, best, axis=-1)).reshape(-1, len(EXTREMES))
    return dict(zip(EXTREMES, extremes.T, strict=True))


def _described(train: DriveTrain, numbers: dict[str, Array], count: int) -> xr.Dataset:
    """Return the results as a Dataset, with the scene in its own motion."""
    scene, index = train.scene, train.scene.mechanism.index
    axes = index_coordinate(scene, scene.grid(count))
    variables = {
        name: xr.Variable(
            (*train.dims, index) if name in OVER_ANGLES else train.dims,
            values if name in OVER_ANGLES else values[..., 0],
            flags("what the machine does on its motor; values are NaN where it is not ok", STATUS)
            if name == "status"
            else dict(zip(("units", "long_name"), TEXTS[name], strict=True)),
        )
        for name, values in numbers.items()
        if name != "slip" or isinstance(train.motor, InductionMotor)
    }
    moving = with_sound(scene, **{name: _labelled(variables[name], scene.labels | axes) for name in MOTION})
    coordinates = design_coordinates(moving)
    text = write_scene(moving, (*kept_beside(moving, coordinates), *MOTION))
    return xr.Dataset(variables, coordinates | axes, origin_attributes(moving, COMMAND) | {"scene": text})


def _labelled(variable: xr.Variable, labels: Mapping[str, xr.Variable]) -> xr.DataArray:
    return xr.DataArray(variable, {str(dim): labels[str(dim)] for dim in variable.dims if dim in labels})
