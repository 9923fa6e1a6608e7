"""What changes over the revolution: functions and DataArrays of theta2, brought to the angles of a sweep."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from linksweep.engine.run import Grid
from linksweep.mechanisms.validate import Rule, number_problems, refuse

TWO_TURNS = np.arange(0.0, 720.0, 0.5)
"""Angles [degree] at whose values a function of theta2 is known again."""


def period_of_function(function: Any, turn: float) -> float:
    """Two turns for a function of theta2 that repeats after two turns but not after one; else one."""
    angles = turn * np.array([0.11, 0.32, 0.53, 0.74, 0.95])
    try:
        first, second, third = (np.asarray(function(angles + k * turn), dtype=float) for k in range(3))
    except Exception:  # what is wrong with it is said when it is swept
        return turn
    near = 1e-9 * np.max(np.abs([first, second, third]), initial=0.0)
    repeats = np.all(np.abs(third - first) <= near) and not np.all(np.abs(second - first) <= near)
    return 2.0 * turn if repeats else turn


def period_of(value: Any, shortest: float) -> float:
    """Period [degree] of a DataArray over theta2: two turns where its angles span more than one."""
    if "theta2" not in value.coords:
        return shortest  # its values are those of the sweep's own angles
    return shortest if np.ptp(value["theta2"].values) <= shortest else 2.0 * shortest


def tabulated(function: Any) -> xr.DataArray:
    """A function of theta2 as a DataArray of its values over two turns."""
    values = np.broadcast_to(np.asarray(function(TWO_TURNS.copy()), dtype=float), TWO_TURNS.shape)
    return xr.DataArray(values, {"theta2": TWO_TURNS}, "theta2")


def at_angles(path: str, value: Any, rule: Rule, grid: Grid, period: float) -> Any:
    """A function or DataArray of theta2 as a DataArray over the grid's angles; any other number as it is.

    At angles that a DataArray does not hold it is interpolated by a periodic cubic spline (scipy's CubicSpline,
    bc_type="periodic"), over `period` degrees (one turn) or, where its angles span more, two turns; at angles that it
    holds, or that are whole periods from them, its values come back to the bit.

    Raises
    ------
    ValueError
        For values of the wrong shape or not finite, and for an array that cannot be brought to these angles.
    """
    if callable(value) and not hasattr(value, "dims"):
        return _called(path, value, rule, grid)
    if "theta2" not in getattr(value, "dims", ()):
        return value
    if "theta2" not in value.coords:
        return _as_it_stands(path, value, grid)
    known = value["theta2"].values
    if len(known) == len(grid.angles) and np.array_equal(known, grid.angles):
        return value
    place = {angle: k for k, angle in enumerate(known)}
    if all(angle in place for angle in grid.angles):
        return value.isel(theta2=[place[angle] for angle in grid.angles])
    return _spline(path, value, grid, period)


def _called(path: str, function: Any, rule: Rule, grid: Grid) -> xr.DataArray:
    try:
        values = np.asarray(function(grid.angles.copy()))
    except Exception as error:
        said = " ".join(f"{type(error).__name__}: {error}".split())
        raise ValueError(
            f"{path}: the function failed on an array of theta2 in degrees ({said}); "
            f"write it with numpy, as in lambda theta2: 5 * np.cos(np.radians(theta2))"
        ) from error
    if values.shape not in ((), grid.angles.shape):
        raise ValueError(
            f"{path}: the function returned shape {values.shape} for {len(grid.angles)} angles; "
            f"it must return {rule.number} for each angle"
        )
    sampled = xr.DataArray(np.broadcast_to(values, grid.angles.shape), {"theta2": grid.angles}, "theta2")
    refuse([f"{problem}; its function returned it" for problem in number_problems(path, sampled, rule)])
    return sampled.astype(float)


def _as_it_stands(path: str, value: xr.DataArray, grid: Grid) -> xr.DataArray:
    if value.sizes["theta2"] != len(grid.angles):
        raise ValueError(
            f"{path} has {value.sizes['theta2']} values over theta2 but no theta2 coordinate, and the sweep has "
            f'{len(grid.angles)} angles: give it its angles with coords={{"theta2": degrees}}'
        )
    return value


def _spline(path: str, value: xr.DataArray, grid: Grid, period: float) -> xr.DataArray:
    from scipy.interpolate import CubicSpline

    order = np.argsort(value["theta2"].values, kind="stable")
    known = value["theta2"].values[order].astype(float)
    values = np.moveaxis(value.values, value.dims.index("theta2"), 0)[order]
    span, period = known[-1] - known[0], period_of(value, period)
    knots, at_knots = known, values
    if span < period:
        knots, at_knots = np.append(known, known[0] + period), np.concatenate([values, values[:1]])
    refuse(_period_problems(path, known, knots, at_knots, period))
    spline = CubicSpline(knots, at_knots, bc_type="periodic")
    found = spline(known[0] + np.mod(grid.angles - known[0], period))
    place = {angle: k for k, angle in enumerate(np.mod(known, period).tolist())}
    held = np.array([place.get(angle, -1) for angle in np.mod(grid.angles, period).tolist()])
    found[held >= 0] = values[held[held >= 0]]
    others = [dim for dim in value.dims if dim != "theta2"]
    labels = {dim: value[dim].variable for dim in others if dim in value.coords}
    return xr.DataArray(found, {"theta2": grid.angles, **labels}, ("theta2", *others), attrs=value.attrs)


def _period_problems(path: str, known: np.ndarray, knots: np.ndarray, at_knots: np.ndarray, period: float) -> list[str]:
    """Why values at known angles cannot be joined to a periodic curve."""
    said = f"{path}: its {len(known)} angles from {known[0]:g} to {known[-1]:g} degrees"
    if len(knots) < 4 or knots[-1] - knots[0] > period:
        return [f"{said} cannot be joined; give at least 3 different angles within one period of {period:g} degrees"]
    if not np.array_equal(at_knots[0], at_knots[-1]):
        return [
            f"{path}: its values at {knots[0]:g} and {knots[-1]:g} degrees differ, but they are the same position; "
            f"make them equal or leave one out"
        ]
    gap = np.diff(knots).max()
    if gap > 0.5 * period:
        return [f"{said} leave {gap:g} of {period:g} degrees open; give values all the way round"]
    return []
