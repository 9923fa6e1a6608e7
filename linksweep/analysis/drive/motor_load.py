"""Load of a motor behind a gear at every crank angle, beside the motor's curve."""

from __future__ import annotations

import math
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.drive.drive_train import EFFICIENCY, RATIO
from linksweep.analysis.drive.motors.motor import AnyMotor, motor_problems
from linksweep.base.checked_number import checked_number
from linksweep.base.frozen import with_arrays
from linksweep.base.validate import Number, refuse
from linksweep.chains.between_links import pair_of
from linksweep.engine.quantity import opposite_of
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import names_unless_jammed, require
from linksweep.results.dataset import with_units
from linksweep.results.over_time import mean_over_time
from linksweep.results.peak_search.along_paths import PathsOf, angle_in_period, highest
from linksweep.results.peak_search.arcs import arcs_within
from linksweep.results.peak_search.exact import paths_of
from linksweep.results.peak_search.groups import Group, assembled_groups, different, empty_over_all
from linksweep.results.peak_search.paths import Part, Paths, reversals
from linksweep.results.peak_search.singular.poles import may_have_poles, poles
from linksweep.results.sweep import sweep
from linksweep.scene.dimensions import argument_problems
from linksweep.scene.grid import crank_grid
from linksweep.scene.pairs import Array, in_period
from linksweep.scene.scene import Scene

ROW, PAIR = "_row", "_pair"
"""Dims of designs on their motors, and of pairs of one of these and an angle."""


class GearedMotor(NamedTuple):
    """A motor behind a gear."""

    motor: AnyMotor
    ratio: Number
    efficiency: Number

    def torque(self, torque: Any, omega: Any, alpha: Any) -> Any:
        """Return the torque of the motor [N m] for a torque on the driven link that turns with omega and alpha."""
        fed = torque * omega > 0.0
        through = xr.where(fed, torque / self.efficiency, torque * self.efficiency)
        return through / self.ratio + self.motor.inertia * self.ratio * alpha

    def available(self, omega: Any) -> Any:
        """Return the largest torque of the motor where the driven link turns with omega."""
        return self.motor.torque_at(abs(self.ratio * omega))

    def some(self, places: dict[str, xr.DataArray]) -> GearedMotor:
        """Return the drives at places along dims."""
        return GearedMotor(*(
            with_arrays(number, lambda a: a.isel({dim: at for dim, at in places.items() if dim in a.dims}))
            for number in self
        ))  # fmt: skip


@limits_threads
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
        - `torque_margin_min` [N m] and `torque_margin_min_at` [degree]: the exact least margin of the continuous cycle,
          or between the least and the largest of several angles; -inf where the torque grows without bound
        - `reflected_inertia` [kg m²]: the rotor's inertia at the driven link, inertia·ratio²
        - `motor_torque_rms` [N m]: root mean square over time, which heats the motor: of the samples at theta2, each
          for half the way to its neighbours, between which a narrow load may lie. `effort_rms` of `linksweep.duty` is
          exact, of the torque on the driven link.

    Raises
    ------
    ValueError
        If the drive is no torque on a link, a number is out of bounds, or arrays over one dim differ in length or
        labels.

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
    >>> print(f"{float(load.torque_margin_min):.3f} N m to spare at {float(load.torque_margin_min_at):.1f} degrees")
    1.736 N m to spare at 183.2 degrees
    """
    require(scene, "drives")
    refuse(_problems(scene, motor))
    ratio, efficiency = checked_number("ratio", ratio, RATIO), checked_number("efficiency", efficiency, EFFICIENCY)
    refuse(argument_problems(scene.arrays, motor=motor, ratio=ratio, efficiency=efficiency))
    torque = scene.mechanism.drives[scene.drive]
    _, link = pair_of(torque) or (1, 2)
    omega, alpha = f"omega{link}", f"alpha{link}"
    cycle = sweep(scene, theta2, of=[torque, omega, alpha])
    index = scene.mechanism.index
    drive, T = GearedMotor(motor, ratio, efficiency), cycle[torque].broadcast_like(cycle[index])
    speed, needed = ratio * cycle[omega], drive.torque(T, cycle[omega], cycle[alpha])
    available = drive.available(cycle[omega])
    margin = available - abs(needed)
    least, at = _least_margin(scene, (torque, omega, alpha), drive, margin, _part(theta2, scene))
    results = {
        "motor_speed": (speed, "rad/s", "angular velocity of the motor"),
        "motor_torque": (needed, "N m", "torque of the motor, in the direction of the torque on the driven link"),
        "available_torque": (available, "N m", "largest torque of the motor at its speed"),
        "torque_margin": (margin, "N m", "available torque less the magnitude of the motor's"),
        "torque_margin_min": (least, "N m", "least available torque less the magnitude of the motor's"),
        "torque_margin_min_at": (at, "degree", f"{scene.mechanism.spot} of the least margin of the motor's torque"),
        "reflected_inertia": (motor.inertia * ratio**2, "kg m^2", "rotor inertia at the driven link"),
        "motor_torque_rms": (
            np.sqrt(mean_over_time(needed**2, cycle, index)),
            "N m",
            "rms over time of motor_torque, of its samples",
        ),
    }
    return cycle[["status"]].assign(with_units(results)).assign_attrs(command="linksweep.motor_load(scene, ...)")


def _problems(scene: Scene, motor: Any) -> list[str]:
    problems = motor_problems(motor)
    if pair_of(scene.mechanism.drives[scene.drive]) is None:
        problems.append(f'drive = "{scene.drive}": must be the torque on a link, for a motor to turn it')
    return problems


# ------------------------------------------------------------------------------------------------ the least margin


class Loaded(NamedTuple):
    """Designs of a group, each on motors of its own, as a group for the search for peaks. Its one signal is the torque
    that a motor lacks.

    Its rows are designs on one motor each, `motors` of them for every design of the group; `drives` have arrays over
    the dim `ROW` alone.
    """

    group: Group
    names: tuple[str, ...]
    drives: GearedMotor
    motors: int

    @property
    def scene(self) -> Scene:
        return self.group.scene

    def values(self, names: tuple[str, ...], rows: Array, angles: Array) -> Array:
        """Return the torque that is lacking, negative where there is a margin (1, pairs), at pairs of a row and an
        angle [degree]."""
        values = self.group.values(self.names, rows // self.motors, angles)
        torque, omega, alpha = (xr.DataArray(row, dims=PAIR) for row in values)
        drives = self.drives.some({ROW: xr.DataArray(rows, dims=PAIR)})
        lacking = abs(drives.torque(torque, omega, alpha)) - drives.available(omega)
        return np.broadcast_to(lacking.values, (len(names), len(rows)))

    def along(self, paths: Paths) -> Paths:
        """Return paths of the group's designs as paths of the rows."""
        every = np.repeat(np.arange(len(paths.row)), self.motors)
        motor = np.tile(np.arange(self.motors), len(paths.row))
        return paths.some(every)._replace(row=paths.row[every] * self.motors + motor)


@reversals.register
def _reversals(loaded: Loaded) -> Array:
    return np.repeat(reversals(loaded.group), loaded.motors, axis=0)


def _part(theta2: Any, scene: Scene) -> Part | None:
    """Return the first and the last of angles that are no whole cycle."""
    grid = crank_grid(theta2, scene.period)
    return None if grid.period else (float(grid.angles.min()), float(grid.angles.max()))


def _least_margin(
    scene: Scene, names: tuple[str, ...], drive: GearedMotor, margin: xr.DataArray, part: Part | None
) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the least margin of each design, and its angle [degree], by the search for peaks."""
    index = scene.mechanism.index
    designs = margin.min(index)  # without the coordinates over the index, which are those of its samples
    if part is not None and not 0.0 < part[1] - part[0] <= scene.period:  # one angle, or several cycles: of the samples
        return designs, margin.fillna(np.inf).idxmin(index)
    signals = tuple(names_unless_jammed(scene.at_one_angle, names).values())
    own = empty_over_all(scene, signals).dims
    least, at = np.full((2, designs.size), np.nan)
    for kind, group in assembled_groups(scene, different(scene, signals)):
        loaded, place = _loaded(group, signals, drive, designs, own)
        searches: tuple[PathsOf, ...] = paths_of(scene, kind) if part is None else (partial(arcs_within, part),)
        for paths in (loaded.along(paths_of_group(group)) for paths_of_group in searches):
            if len(paths.row):
                none = np.full((len(paths.row), 1), -np.inf)
                lacking, angle, *_ = (numbers[:, 0] for numbers in highest(loaded, ("lacking",), paths, none))
                order = np.argsort(lacking)  # the highest of a design is written last
                order = order[(lacking[order] > -np.inf) & ~(least[place[paths.row[order]]] <= -lacking[order])]
                where = place[paths.row[order]]
                least[where], at[where] = -lacking[order], angle[order]
        row, angle = _poles(group, names[0], part)
        where = place.reshape(-1, loaded.motors)[row]
        least[where], at[where] = -np.inf, angle[:, None]
    if part is not None:
        middle, half = 0.5 * (part[0] + part[1]), 0.5 * (part[1] - part[0])
        at = middle + np.clip(np.mod(at - middle + 0.5 * scene.period, scene.period) - 0.5 * scene.period, -half, half)
    return designs.copy(data=least.reshape(designs.shape)), designs.copy(data=at.reshape(designs.shape))


def _poles(group: Group, torque: str, part: Part | None) -> tuple[Array, Array]:
    """Return the row of a design and the angle [degree] of each pole of its torque."""
    signals = torque, opposite_of(torque)
    if not may_have_poles(group.scene, signals):
        return np.empty(0, dtype=int), np.empty(0)
    row, angle, infinite = poles(group, signals)
    there = infinite.any(axis=1)
    if part is not None:
        there &= in_period(angle - part[0], group.scene.period) <= part[1] - part[0]
    return row[there], angle_in_period(angle[there], group.scene.period)


def _loaded(
    group: Group, names: tuple[str, ...], drive: GearedMotor, designs: xr.DataArray, own: tuple[str, ...]
) -> tuple[Loaded, Array]:
    """Return a group's designs on their motors, and the row-major place of each row among all `designs`; the scene's
    own dims are those of the group."""
    others = {str(dim): n for dim, n in designs.sizes.items() if dim not in own}
    motors = math.prod(others.values())
    row = np.arange(len(group.designs) * motors)
    places = {dim: group.places[dim][row // motors] for dim in own}
    places |= dict(zip(others, np.unravel_index(row % motors, tuple(others.values())), strict=True)) if others else {}
    drives = drive.some({dim: xr.DataArray(at, dims=ROW) for dim, at in places.items()})
    order = tuple(places[str(dim)] for dim in designs.dims)
    return Loaded(group, names, drives, motors), np.ravel_multi_index(order, designs.shape) if order else row
