"""The flywheel that keeps a crank's speed within bounds, and that speed over the cycle.

A drive of constant torque T_d, the work of a cycle over its angle, and a mechanism that resists by T_s(θ) at rest:

    d/dθ [½ (J_f + J(θ)) ω²] = T_d − T_s(θ)        so that        ½ (J_f + J) ω² = E0 + E(θ),   E = ∫ (T_d − T_s) dθ

With ω between Ω1 = ω2 (1 + δ/2) and Ω2 = ω2 (1 − δ/2), touching both, E0 falls out of the two extremes, and exactly

    J_f = (max(E − ½ J Ω1²) − min(E − ½ J Ω2²)) / (δ ω2²)

the two tangents of Wittenbauer's diagram. Source: F. Wittenbauer, Graphische Dynamik (1923); R. L. Norton, Design of
Machinery, chapter "Dynamic Force Analysis" (flywheels), which neglects how J changes the speed.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.drive.duty import steady_problems
from linksweep.base.checked_number import checked_number
from linksweep.base.validate import Number, Rule, quote, refuse
from linksweep.engine.run import Field
from linksweep.results.compute import require
from linksweep.results.cylinders.multi_cylinder import MultiCylinder, one_cylinder
from linksweep.results.dataset import with_units
from linksweep.results.derivatives.samples import sample_derivatives
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene

FLUCTUATION = Rule("dimensionless", above=0.0)
INERTIA = Rule("inertia", at_least=0.0)
ENERGY = "greatest less least work of the drive's constant torque ahead of the work needed at constant speed"
BISECTIONS = 60


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
        Count of crank angles over the cycle.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over the design dims:

        - `flywheel_inertia` [kg m²], of the masses that turn with the crank besides its own; 0 where none is needed
        - `speed` [rad/s] of the crank over theta2, with the drive's torque constant
        - `fluctuation` [1]: the coefficient that results; smaller than the allowed one where no flywheel is needed
        - `drive_torque` [N m]: that constant torque, on the crank
        - `energy_fluctuation` [J]: greatest less least stored energy at constant speed.

        NaN where a revolution is not whole, and where the mean speed cannot be kept: the crank would stall on the way.

    Raises
    ------
    ValueError
        If fluctuation and inertia are both given or both left out, a number is out of bounds, or the crank stands still
        or changes its speed.

    Notes
    -----
    Loads, friction and dampers are taken at their values at the mean speed; where they do not depend on the speed, the
    result is that of the equation of motion, to the fourth order in the step (at jumps of loads, to the first).

    Examples
    --------
    >>> import linksweep as ls
    >>> wheel = ls.flywheel(ls.example("press"), fluctuation=0.05)
    >>> wheel.flywheel_inertia.units, round(float(wheel.fluctuation), 12)
    ('kg m^2', 0.05)
    """
    require(one_cylinder(scene), "drives")
    refuse(_problems(one_cylinder(scene), fluctuation, inertia))
    if inertia is None:
        fluctuation = checked_number("fluctuation", fluctuation, FLUCTUATION)
        stalls = [f"fluctuation = {quote(fluctuation)}: must be less than 2"]  # else it stands still, or turns back
        refuse(stalls if np.any(fluctuation >= 2.0) else [])
    else:
        inertia = checked_number("inertia", inertia, INERTIA)
    cycle, one = _at_constant_speed(scene, theta2, threads), one_cylinder(scene)
    index, mean = one.mechanism.index, abs(one.omega2)
    J, torque = (cycle[name].broadcast_like(cycle[index]) for name in ("reduced_inertia", "reduced_torque"))
    stored, drive = _work(torque, one.period, index)
    E = stored + 0.5 * mean**2 * J
    size = _inertia(E, J, mean, fluctuation, index) if inertia is None else inertia + 0.0 * drive
    speed = _speed(E, J, size, mean, index)
    (fastest, slowest), (most, least) = _extremes(speed, index), _extremes(stored, index)
    spread = (fastest - slowest) / mean
    results = {
        "flywheel_inertia": (size, "kg m^2", "moment of inertia of the flywheel about the crank's axis"),
        "speed": (np.sign(one.omega2) * speed, "rad/s", "angular velocity of the crank with the flywheel"),
        "fluctuation": (spread, "1", "coefficient of fluctuation of the speed: (largest - least)/mean"),
        "drive_torque": (drive, "N m", "constant torque of the drive on the crank, positive counter-clockwise"),
        "energy_fluctuation": (most - least, "J", ENERGY),
    }
    return cycle[["status"]].assign(with_units(results)).assign_attrs(command="linksweep.flywheel(scene, ...)")


def flywheel_slopes(
    scene: Scene, to: tuple[str, ...], *, fluctuation: float, theta2: int = 720, threads: int | None = None
) -> tuple[xr.DataArray, dict[str, xr.DataArray]]:
    """Return the inertia of the flywheel [kg m²] for a coefficient of fluctuation, and its derivatives to parameters.

    Both extremes of the module's equation stay at their angles; the work of a torque is linear in it.
    """
    size = flywheel(scene, fluctuation=fluctuation, theta2=theta2, threads=threads).flywheel_inertia
    steady = replace(scene, alpha2=0.0)
    grid, index, names = steady.grid(theta2), steady.mechanism.index, ("reduced_torque", "reduced_inertia")
    samples = sample_derivatives(steady, grid, names, tuple(path for path in to if path != "alpha2"), threads)
    angles = xr.Variable(index, grid.angles)

    def over_angles(field: Field) -> xr.DataArray:
        return xr.DataArray(xr.Variable(*field), {index: angles} if index in field.dims else None) + 0.0 * xr.DataArray(
            angles, {index: angles}
        )

    torque, J = (over_angles(samples.values[name]) for name in names)
    mean, stored = abs(steady.omega2), _work(torque, steady.period, index)[0]
    fast, slow = 1.0 + 0.5 * fluctuation, 1.0 - 0.5 * fluctuation
    high, low = (stored + 0.5 * mean**2 * J * (1.0 - part**2) for part in (fast, slow))
    known = np.isfinite(size)
    at_high, at_low = high.fillna(0.0).argmax(index), low.fillna(0.0).argmin(index)
    slopes = dict.fromkeys(to, 0.0 * size)
    for path in to:
        if path == "alpha2":
            continue
        d_torque, dJ = (over_angles(samples.derivatives[name, path]) for name in names)
        of_speed = np.sign(steady.omega2) if path == "omega2" else 0.0
        work = _work(d_torque, steady.period, index)[0]
        d_high, d_low = (
            work + 0.5 * mean**2 * dJ * (1.0 - part**2) + mean * of_speed * J * (1.0 - part**2) for part in (fast, slow)
        )
        rise = d_high.isel({index: at_high}, drop=True) - d_low.isel({index: at_low}, drop=True)
        slope = rise / (fluctuation * mean**2) - 2.0 * of_speed * size / mean
        slopes[path] = slope.where(size > 0.0, 0.0).where(known).reset_coords(drop=True)
    return size, slopes


def _at_constant_speed(scene: Scene | MultiCylinder, theta2: int, threads: int | None) -> xr.Dataset:
    names = ["reduced_torque", "reduced_inertia"]
    if isinstance(scene, MultiCylinder):
        return replace(scene, engine=replace(scene.engine, alpha2=0.0)).sweep(theta2, of=names, threads=threads)
    return sweep(replace(scene, alpha2=0.0), theta2, of=names, threads=threads)


def _problems(scene: Scene, fluctuation: Any, inertia: Any) -> list[str]:
    problems = steady_problems(scene)
    if (fluctuation is None) == (inertia is None):
        problems.append("give either fluctuation, as in fluctuation=0.02, or inertia [kg m^2]")
    return problems


def _work(torque: xr.DataArray, period: float, index: str) -> tuple[xr.DataArray, xr.DataArray]:
    """Return ∫ (T_d − T) dθ from the first angle on, at every angle, and T_d; by the periodic cubic spline."""
    from scipy.interpolate import CubicSpline

    torque = torque.transpose(..., index)
    angle = np.radians(np.append(torque[index].values, torque[index].values[0] + period))
    closed = np.concatenate([torque.values, torque.values[..., :1]], axis=-1)
    whole = np.isfinite(closed).all(axis=-1, keepdims=True)
    integral = CubicSpline(angle, np.where(whole, closed, 0.0), axis=-1, bc_type="periodic").antiderivative()(angle)
    integral = np.where(whole, integral - integral[..., :1], np.nan)
    mean = integral[..., -1] / (angle[-1] - angle[0])
    stored = mean[..., None] * (angle[:-1] - angle[0]) - integral[..., :-1]
    return torque.copy(data=stored), torque.isel({index: 0}, drop=True).copy(data=mean)


def _inertia(E: xr.DataArray, J: xr.DataArray, mean: Number, fluctuation: Number, index: str) -> xr.DataArray:
    """Return J_f of the module's equation, 0 where none is needed."""
    fast, slow = mean * (1.0 + 0.5 * fluctuation), mean * (1.0 - 0.5 * fluctuation)
    highest, lowest = (E - 0.5 * J * fast**2).max(index, skipna=False), (E - 0.5 * J * slow**2).min(index, skipna=False)
    size = (highest - lowest) / (fluctuation * mean**2)
    return size.where(~(size < 0.0), 0.0)


def _speed(E: xr.DataArray, J: xr.DataArray, size: xr.DataArray, mean: Number, index: str) -> xr.DataArray:
    """Return the speed at every angle whose largest and least have this mean; E0 by bisection."""
    total = size + J
    low = -E.min(index, skipna=False)
    stalls = _middle(E + low, total, index) > mean
    high = (0.5 * total * mean**2 - E).max(index, skipna=False)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        above = _middle(E + middle, total, index) > mean
        low, high = low.where(above, middle), high.where(~above, middle)
    return ((2.0 * (E + high).clip(min=0.0) / total) ** 0.5).where(~stalls)


def _middle(energy: xr.DataArray, total: xr.DataArray, index: str) -> xr.DataArray:
    """Return the mean of largest and least speed."""
    fastest, slowest = _extremes((2.0 * energy.clip(min=0.0) / total) ** 0.5, index)
    return 0.5 * (fastest + slowest)


def _extremes(values: xr.DataArray, index: str) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the largest and the least over the index; NaN where one value is."""
    return values.max(index, skipna=False), values.min(index, skipna=False)
