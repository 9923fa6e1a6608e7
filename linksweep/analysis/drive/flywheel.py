"""The flywheel that keeps a crank's speed within bounds, and that speed over the cycle.

A drive of constant torque T_d, the work of a cycle over its angle, and a mechanism that resists by T_s(θ) at rest:

    d/dθ [½ (J_f + J(θ)) ω²] = T_d − T_s(θ)        so that        ½ (J_f + J) ω² = E0 + E(θ),   E = ∫ (T_d − T_s) dθ

With ω between Ω1 = ω2 (1 + δ/2) and Ω2 = ω2 (1 − δ/2), touching both, E0 falls out of the two extremes, and exactly

    J_f = (max(E − ½ J Ω1²) − min(E − ½ J Ω2²)) / (δ ω2²)

the two tangents of Wittenbauer's diagram; `linksweep.analysis.drive.wittenbauer` finds those of the continuous cycle.
Source: F. Wittenbauer, Graphische Dynamik (1923); R. L. Norton, Design of Machinery, chapter "Dynamic Force Analysis"
(flywheels), which neglects how J changes the speed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.drive.duty import steady_problems
from linksweep.analysis.drive.piecewise import piecewise
from linksweep.analysis.drive.wittenbauer import NAMES, Turning, ahead
from linksweep.base.checked_number import checked_number
from linksweep.base.validate import Number, Rule, count_problems, quote, refuse
from linksweep.engine.threads import limits_threads
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.results.compute import require
from linksweep.results.cylinders.multi_cylinder import MultiCylinder, one_cylinder
from linksweep.results.dataset import with_units
from linksweep.results.derivatives.jumps import known_jumps
from linksweep.results.derivatives.samples import pairs_over
from linksweep.results.derivatives.sides import BESIDE
from linksweep.results.peak_search.between import EVERYWHERE
from linksweep.results.peak_search.groups import assembled_groups, different, empty, empty_over_all
from linksweep.results.sweep import sweep
from linksweep.scene.derivatives.differentiated import Differentiated, differentiated
from linksweep.scene.dimensions import argument_problems
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene

FLUCTUATION = Rule("dimensionless", above=0.0)
INERTIA = Rule("inertia", at_least=0.0)
ENERGY = "greatest less least work of the drive's constant torque ahead of the work needed at constant speed"
TEXTS = {
    "flywheel_inertia": ("kg m^2", "moment of inertia of the flywheel about the crank's axis"),
    "speed": ("rad/s", "angular velocity of the crank with the flywheel"),
    "speed_max": ("rad/s", "largest angular velocity of the crank with the flywheel"),
    "speed_max_at": ("degree", "crank angle of the largest angular velocity of the crank with the flywheel"),
    "speed_min": ("rad/s", "least angular velocity of the crank with the flywheel"),
    "speed_min_at": ("degree", "crank angle of the least angular velocity of the crank with the flywheel"),
    "fluctuation": ("1", "coefficient of fluctuation of the speed: (largest - least)/mean"),
    "drive_torque": ("N m", "constant torque of the drive on the crank, positive counter-clockwise"),
    "energy_fluctuation": ("J", ENERGY),
}
JUMPING = ("reduced_torque", "reduced_inertia_slope")
OF_TORQUE = ("drive_torque", "energy_fluctuation")
"""Results that do not depend on the flywheel."""


@limits_threads
def flywheel(
    scene: Scene | MultiCylinder,
    *,
    fluctuation: Number | None = None,
    inertia: Number | None = None,
    theta2: int = 720,
    threads: int | None = None,
) -> xr.Dataset:
    """Compute the flywheel for a coefficient of fluctuation, or the fluctuation that a flywheel leaves.

    Parameters
    ----------
    scene : Scene or MultiCylinder
        Machine whose omega2 is the mean speed, (largest + least)/2.
    fluctuation : float or DataArray, default None
        Coefficient of fluctuation that is allowed, (largest − least speed)/mean [1]; give it or the inertia.
    inertia : float or DataArray, default None
        Moment of inertia of a flywheel about the crank's axis [kg m²]; 0 for none.
    theta2 : int, default 720
        Count of crank angles of `speed` over the cycle.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over the design dims:

        - `flywheel_inertia` [kg m²], of the masses that turn with the crank besides its own; 0 where none is needed
        - `speed` [rad/s] of the crank over theta2, with the drive's torque constant; `speed_max`, `speed_min` [rad/s],
          its exact extremes, and `speed_max_at`, `speed_min_at` [degree]
        - `fluctuation` [1]: the coefficient that results; smaller than the allowed one where no flywheel is needed
        - `drive_torque` [N m]: that constant torque, on the crank
        - `energy_fluctuation` [J]: greatest less least stored energy at constant speed.

        NaN where a revolution is not whole, and where the mean speed cannot be kept: the crank would stall on the way.

    Raises
    ------
    ValueError
        If fluctuation and inertia are both given or both left out, a number is out of bounds, theta2 is no count, the
        crank stands still, changes its speed or has an alpha2, or arrays over one dim differ in length or labels.

    Notes
    -----
    Loads, friction and dampers are taken at their values at the mean speed; where they do not depend on the speed, the
    result is that of the equation of motion, to 1e-10: integrals and extremes are those of the continuous cycle, and do
    not depend on the count of angles.

    Examples
    --------
    >>> import linksweep as ls
    >>> wheel = ls.flywheel(ls.example("press"), fluctuation=0.05)
    >>> print(f"{float(wheel.flywheel_inertia):.4f} kg m²")
    0.7967 kg m²
    >>> print(f"{float(wheel.speed_min):.2f} to {float(wheel.speed_max):.2f} rad/s")
    30.63 to 32.20 rad/s
    """
    require(one_cylinder(scene), "drives")
    refuse(_problems(one_cylinder(scene), fluctuation, inertia) + count_problems("theta2", theta2))
    if inertia is None:
        fluctuation = checked_fluctuation(fluctuation)
    else:
        inertia = checked_number("inertia", inertia, INERTIA)
    refuse(argument_problems(one_cylinder(scene).arrays, fluctuation=fluctuation, inertia=inertia))
    steady = _at_constant_speed(scene)
    cycle, index = _cycle(steady, theta2), one_cylinder(scene).mechanism.index
    sum_of_both = cycle[NAMES[0]] + cycle[NAMES[1]] + 0.0 * cycle[index]
    known = sum_of_both.sum(index, skipna=False) + 0.0 * one_cylinder(scene).omega2  # NaN where it does not turn fully
    number = fluctuation if inertia is None else inertia
    arrays = _arrays(steady, known, cycle[index], number, inertia is None)
    results = {name: (arrays[name], *text) for name, text in TEXTS.items()}
    return cycle[["status"]].assign(with_units(results)).assign_attrs(command="linksweep.flywheel(scene, ...)")


def checked_fluctuation(value: Any) -> Number:
    """Return coefficients of fluctuation; ValueError for one at which the crank stands still, or turns back."""
    fluctuation = checked_number("fluctuation", value, FLUCTUATION)
    refuse([f"fluctuation = {quote(fluctuation)}: must be less than 2"] if np.any(fluctuation >= 2.0) else [])
    return fluctuation


def _problems(scene: Scene, fluctuation: Any, inertia: Any) -> list[str]:
    problems = steady_problems(scene)
    if (fluctuation is None) == (inertia is None):
        problems.append("give either fluctuation, as in fluctuation=0.02, or inertia [kg m^2]")
    return problems


def _at_constant_speed(scene: Scene | MultiCylinder) -> Scene | MultiCylinder:
    if isinstance(scene, MultiCylinder):
        return replace(scene, engine=replace(scene.engine, alpha2=0.0))
    return replace(scene, alpha2=0.0)


def _cycle(steady: Scene | MultiCylinder, theta2: int) -> xr.Dataset:
    if isinstance(steady, MultiCylinder):
        return steady.sweep(theta2, of=NAMES[:2])
    return sweep(steady, theta2, of=NAMES[:2])


# -------------------------------------------------------------------------------------------- arrays over the designs


def _arrays(
    steady: Scene | MultiCylinder, known: xr.DataArray, angles: xr.DataArray, number: Any, sized: bool
) -> dict[str, xr.DataArray]:
    """Return all results by name, NaN where a design is not `known`, for a number: the fluctuation (`sized`), or the
    inertia."""
    number = xr.align(known, xr.DataArray(number), join="left")[1]
    own = empty_over_all(steady, NAMES).dims
    frame = (0.0 * known + 0.0 * number).transpose(*own, ...)
    shape = tuple(frame.sizes[dim] for dim in own)
    numbers = number.broadcast_like(frame).transpose(*frame.dims).values.reshape(math.prod(shape), -1)
    values = {name: np.full((*numbers.shape, angles.size if name == "speed" else 1), np.nan) for name in TEXTS}
    for _, group in assembled_groups(steady, different(steady, NAMES), (EVERYWHERE,)):
        at = np.ravel_multi_index([group.places[dim] for dim in own], shape) if own else np.zeros(1, dtype=int)
        turning = Turning.of(group.some(np.arange(len(at))))
        for k in range(numbers.shape[1]):
            for name, row in _results(turning, numbers[at, k], sized, angles.values).items():
                values[name][at, k] = row
    results = {name: frame + frame.copy(data=row[..., 0].reshape(frame.shape)) for name, row in values.items()}
    results["speed"] = frame + xr.DataArray(
        values["speed"].reshape(*frame.shape, -1), {**frame.coords, **angles.coords}, (*frame.dims, *angles.dims)
    )
    of_torque = empty(steady, NAMES[:1])[NAMES[0]].dims
    for name in OF_TORQUE:
        results[name] = results[name].max([dim for dim in frame.dims if dim not in of_torque])
    return results


def _results(turning: Turning, number: Array, sized: bool, angles: Array) -> dict[str, Array]:
    """Return the results of some designs, (design, angles or 1), for a fluctuation (`sized`) or an inertia of each."""
    size, s = number, 0.5 * number
    if sized:
        size = turning.size(s)
        size = np.where(size < 0.0, 0.0, size)
    if not sized or (size == 0.0).any():
        s = np.where(sized & (size > 0.0), s, turning.half_fluctuation(size))
    tangents, way = turning.tangents(s), np.sign(turning.omega2)
    at_high, at_low = (
        np.where(np.isnan(s), np.nan, turning.cycle.angles(place)) for place in (tangents.at_high, tangents.at_low)
    )
    fast, slow = turning.omega2 * (1.0 + s), turning.omega2 * (1.0 - s)
    results = {
        "flywheel_inertia": size,
        "speed_max": np.maximum(fast, slow),
        "speed_max_at": np.where(way > 0.0, at_high, at_low),
        "speed_min": np.minimum(fast, slow),
        "speed_min_at": np.where(way > 0.0, at_low, at_high),
        "fluctuation": 2.0 * s,
        "drive_torque": turning.drive,
        "energy_fluctuation": turning.energy_fluctuation,
    }
    speed = way[:, None] * turning.speed(size, s, angles)
    return {name: values[:, None] for name, values in results.items()} | {"speed": speed}


# ------------------------------------------------------------------------------------------------------ derivatives


class MovingJump(NamedTuple):
    """A jump of the torque that parameters move: its angle [degree], the torque before and after it [N m], dJ/dθ there,
    and dθ*/dp [rad], each for every design."""

    angle: Array
    before: Array
    after: Array
    inertia_slope: Array
    moves: Mapping[str, Array]

    def rise(self, turning: Turning, angle: Array, factor: float) -> Array:
        """Return dG/dθ* at an angle of each design, of G = S + factor·ω2² J; one within `BESIDE` goes along with θ*."""
        first, period = turning.cycle.start[:, 0], turning.cycle.period
        own, jump = (np.mod(each - first, period) for each in (angle, self.angle))
        along = np.abs(own - jump) < 10.0 * BESIDE
        slope = turning.drive - self.before + factor * turning.omega2**2 * self.inertia_slope
        drop = self.before - self.after
        return drop * (own / period - ((own > jump) & ~along)) + np.where(along, slope, 0.0)


def flywheel_slopes(
    scene: Scene, to: tuple[str, ...], *, fluctuation: float
) -> tuple[xr.DataArray, dict[str, xr.DataArray]]:
    """Return the inertia of the flywheel [kg m²] for a coefficient of fluctuation, and its derivatives to parameters.

    Both extremes of the module's equation stay at their angles (the envelope theorem); the work of a torque is linear
    in it. A jump that moves by dθ* adds (T(θ*−) − T(θ*+))·dθ* to the work, and takes an extreme at it along.
    """
    size = flywheel(scene, fluctuation=fluctuation).flywheel_inertia.reset_coords(drop=True)
    paths = tuple(path for path in to if path != "alpha2")
    own = differentiated(replace(scene, alpha2=0.0), NAMES[:2], paths)
    names = tuple(derivative_of(name, path) for path in paths for name in NAMES[:2])
    fields = {path: empty_over_all(own, (*NAMES, *names)) for path in paths}
    for _, group in assembled_groups(own, different(own, (*NAMES, *names)), (EVERYWHERE,)) if paths else ():
        slopes = _slopes(group, own, names, 0.5 * fluctuation)
        for path, field in fields.items():
            field.values[tuple(group.places[dim] for dim in field.dims)] = (
                slopes[path] if field.dims else slopes[path][0]
            )
    arrays = {path: xr.DataArray(field.values, dims=field.dims) for path, field in fields.items()}
    every = {path: 0.0 * size + arrays.get(path, 0.0) for path in to}
    return size, {path: slope.where(size > 0.0, 0.0).where(np.isfinite(size)) for path, slope in every.items()}


def _slopes(group: Any, own: Differentiated, names: tuple[str, ...], s: float) -> dict[str, Array]:
    """Return the derivatives of the inertia of each design by parameter; `names` are those of torque and inertia."""
    turning, changes, jumps = Turning.of(group), piecewise(group, names), _moving_jumps(group, own)
    square, tangents = turning.omega2**2, turning.tangents(np.full(len(group.designs), s))
    size = (tangents.high - tangents.low) / (2.0 * s * square)
    ends = (1.0, tangents.at_high, -s * (1.0 + 0.5 * s)), (-1.0, tangents.at_low, s * (1.0 - 0.5 * s))
    slopes = {}
    for k, path in enumerate(own.to):
        faster = 2.0 * turning.omega2 if path == "omega2" else 0.0  # derivative of the square of the speed
        work, _ = ahead(changes, 2 * k)
        rise = np.zeros(len(size))
        for sign, place, factor in ends:
            angle = turning.cycle.angles(place)
            of_work, of_inertia = (changes.at(each, angle[:, None])[:, 0] for each in (work, changes.terms[2 * k + 1]))
            rise += sign * (of_work + factor * (square * of_inertia + faster * turning.inertia_at(place)))
            rise += sign * sum(jump.rise(turning, angle, factor) * jump.moves.get(path, 0.0) for jump in jumps)
        slopes[path] = (rise / (2.0 * s) - size * faster) / square
    return slopes


def _moving_jumps(group: Any, own: Differentiated) -> list[MovingJump]:
    """Return the jumps of the torque that parameters move."""
    pairs = pairs_over(own, tuple(own.at_one_angle.inputs.sizes))
    known, rows, jumps = known_jumps(pairs), np.arange(len(group.designs)), []

    def numbers(row: Array) -> Array:
        return group.number(xr.Variable(*pairs.field(row)))

    for angles, moved in zip(known.angles, known.moves, strict=True):
        there = np.isfinite(numbers(angles))
        angle = np.nan_to_num(numbers(angles))  # of designs without it, where nothing moves it
        moves = {path: np.radians(np.where(there, numbers(row), 0.0)) for path, row in zip(own.to, moved, strict=True)}
        before, after = (group.values(JUMPING, rows, angle + side) for side in (-BESIDE, BESIDE))
        jumps.append(MovingJump(angle, before[0], after[0], before[1], moves))
    return jumps
