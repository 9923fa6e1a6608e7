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
        return called(path, value, rule, grid.angles)
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


def called(path: str, function: Any, rule: Rule, angles: np.ndarray) -> xr.DataArray:
    """Values of a function of theta2 [degree] at these angles. Raises ValueError as `at_angles`."""
    try:
        values = np.asarray(function(angles.copy()))
    except Exception as error:
        said = " ".join(f"{type(error).__name__}: {error}".split())
        raise ValueError(
            f"{path}: the function failed on an array of theta2 in degrees ({said}); "
            f"write it with numpy, as in lambda theta2: 5 * np.cos(np.radians(theta2))"
        ) from error
    if values.shape not in ((), angles.shape):
        raise ValueError(
            f"{path}: the function returned shape {values.shape} for {len(angles)} angles; "
            f"it must return {rule.number} for each angle"
        )
    sampled = xr.DataArray(np.broadcast_to(values, angles.shape), {"theta2": angles}, "theta2")
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
    known, values = knots(value)
    period = period_of(value, period)
    refuse(period_problems(path, known, values, period))
    found = periodic_spline(known, values, period)(known[0] + np.mod(grid.angles - known[0], period))
    place = {angle: k for k, angle in enumerate(np.mod(known, period).tolist())}
    held = np.array([place.get(angle, -1) for angle in np.mod(grid.angles, period).tolist()])
    found[held >= 0] = values[held[held >= 0]]
    return over_grid(found, value, grid)


def knots(value: xr.DataArray) -> tuple[np.ndarray, np.ndarray]:
    """Angles [degree] of an array over theta2 in order, and its values with theta2 as their first axis."""
    order = np.argsort(value["theta2"].values, kind="stable")
    known = value["theta2"].values[order].astype(float)
    return known, np.moveaxis(value.values, value.dims.index("theta2"), 0)[order]


def periodic_spline(known: np.ndarray, values: np.ndarray, period: float) -> Any:
    """Periodic cubic spline through values at angles in order [degree]."""
    from scipy.interpolate import CubicSpline

    return CubicSpline(*_closed(known, values, period), bc_type="periodic")


def over_grid(values: np.ndarray, like: xr.DataArray, grid: Grid) -> xr.DataArray:
    """Values at the grid's angles, theta2 as their first axis, with the other dims of an array."""
    others = [dim for dim in like.dims if dim != "theta2"]
    labels = {dim: like[dim].variable for dim in others if dim in like.coords}
    return xr.DataArray(values, {"theta2": grid.angles, **labels}, ("theta2", *others), attrs=like.attrs)


def _closed(known: np.ndarray, values: np.ndarray, period: float) -> tuple[np.ndarray, np.ndarray]:
    """Knots and values with the first again a period later, unless it stands there."""
    if known[-1] - known[0] >= period:
        return known, values
    return np.append(known, known[0] + period), np.concatenate([values, values[:1]])


def period_problems(path: str, known: np.ndarray, values: np.ndarray, period: float) -> list[str]:
    """Why values at angles in order cannot be joined to a periodic curve."""
    knots, at_knots = _closed(known, values, period)
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
