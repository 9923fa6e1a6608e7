"""Acceleration of a crank whose speed changes with its angle: α = ω·dω/dθ.

Of an array, ω and dω/dθ are those of one spline. Of a function, α = d(½ω²)/dθ is a limit of central differences D(h) at
steps h, h/2, h/4, … (R. Richardson's extrapolation in h², in C. J. F. Ridders' tableau): of its entries that whose
neighbours agree with it best, so that smooth functions are differentiated over wide steps and others over narrow ones.

Source: C. J. F. Ridders, "Accurate computation of F′(x) and F′(x)F″(x)", Advances in Engineering Software 4 (1982) 75.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import Rule, refuse
from linksweep.engine.run import Grid, Places
from linksweep.scene.curves.interpolation import derivative_at
from linksweep.scene.curves.over_angle import (
    ArrayCurve,
    called,
    knots,
    period_of_function,
)

WIDEST = 7.25
"""First step [degree]; no small order of a turn is 0 at it and at its half, which would look like convergence."""
STEPS = WIDEST * 0.5 ** np.arange(14)
ROUNDING = 2.0**-51
"""Rounding of ω², relative to the largest in reach."""
JUMP = 1e-6
"""Least change of ω² over the least step (0.001 degree) at a jump, relative to the largest ω²."""


def acceleration_of_function(path: str, omega: Any, rule: Rule, grid: Grid, turn: float) -> xr.DataArray:
    """Return ω·dω/dθ [rad/s²] at the grid's angles, of a speed that is a function of theta2.

    It errs by 1e-9 of its largest value where the function is smooth over half a degree. At a corner it is the mean of
    both sides, at a jump infinite. Raises ValueError as `over_angle.called`.
    """
    period = period_of_function(omega, turn)
    sides = grid.angles[:, None] + STEPS, grid.angles[:, None] - STEPS
    at = np.mod(np.stack(sides), period)
    different, place = np.unique(at, return_inverse=True)
    energy = 0.5 * called(path, omega, rule, different).values[place.reshape(at.shape)] ** 2
    rise, width, most = energy[0] - energy[1], np.radians(sides[0] - sides[1]), energy.max(axis=(0, 2))
    slopes = rise / width
    jumps = (abs(rise[:, -1]) > JUMP * most) & (abs(slopes[:, -1]) > 1.5 * abs(slopes[:, -2]))
    limits = np.where(jumps, np.copysign(np.inf, rise[:, -1]), limit(slopes, ROUNDING * most[:, None] / width))
    return xr.DataArray(limits, {"theta2": grid.angles}, "theta2")


def acceleration_of_array(
    path: str,
    omega: xr.DataArray,
    speed: xr.DataArray,
    grid: Grid,
    turn: float,
    curve: ArrayCurve | None,
    places: Places | None,
) -> xr.DataArray:
    """Return ω·dω/dθ [rad/s²] at the grid's angles, of a speed that is an array over theta2; `speed` is ω there.

    dω/dθ is that of the periodic spline; at the angles of a part of a turn, of the spline through these alone. `curve`
    and `places` are as of `at_angles`. Raises ValueError for an array that does not tell its slope at these angles.
    """
    from scipy.interpolate import CubicSpline

    omega = omega if "theta2" in omega.coords else omega.assign_coords(theta2=grid.angles)
    curve = curve or ArrayCurve(path, omega, turn)
    if not curve.problems:
        slope = curve.slope(grid, 1, places)
    elif omega.sizes["theta2"] > 1 and np.isin(grid.angles, omega["theta2"].values).all():
        spline = CubicSpline(*knots(omega))
        slope = curve.over(grid, places, lambda angles, own: np.degrees(derivative_at(spline, angles, 1, own)))
    else:
        refuse([f"{problem}; or give alpha2" for problem in curve.problems])
    return speed.copy(deep=False, data=(speed.variable * slope.variable).values)


def acceleration_problems(acceleration: xr.DataArray) -> list[str]:
    """List why an acceleration cannot be that of a crank."""
    infinite = np.isinf(acceleration.transpose("theta2", ...).values).reshape(acceleration.sizes["theta2"], -1)
    at = acceleration["theta2"].values[infinite.any(axis=1)]
    advice = "give alpha2, or a ramp in place of the jump"
    return [f"omega2: jumps at theta2 = {at[0]:g} degrees; {advice}"] if len(at) else []


def limit(column: np.ndarray, rounding: np.ndarray) -> np.ndarray:
    """Return the limit (angle) of values (angle, step) at steps that halve, each with so much rounding.

    An entry of the tableau errs by no more than it differs from its neighbours, rounding aside, if it also agrees with
    the values at the least steps: wider ones may have passed over what is narrower.
    """
    least, doubt = column[:, -1:], 4.0 * rounding[:, -1:]
    best, error, weight = column[:, -1], np.full(len(column), np.inf), 1.0
    while column.shape[1] > 1:
        weight, rounding = 4.0 * weight, rounding[:, 1:]
        better = column[:, 1:] + (column[:, 1:] - column[:, :-1]) / (weight - 1.0)
        errors = np.maximum(abs(better - column[:, 1:]), abs(better - column[:, :-1])) + rounding
        errors += np.maximum(abs(better - least) - doubt, 0.0)
        k = np.argmin(errors, axis=1)[:, None]
        lowest, chosen = (np.take_along_axis(numbers, k, axis=1)[:, 0] for numbers in (errors, better))
        best, error = np.where(lowest < error, chosen, best), np.minimum(lowest, error)
        column = better
    return best
