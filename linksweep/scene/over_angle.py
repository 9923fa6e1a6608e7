"""What changes over the revolution: functions and DataArrays of theta2, brought to the angles of a sweep."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from linksweep.engine.run import Grid
from linksweep.mechanisms.validate import UNITS, Rule, number_problems


def at_angles(path: str, value: Any, rule: Rule, grid: Grid, period: float) -> xr.DataArray:
    """A function or DataArray of theta2 as a DataArray over the grid's angles.

    At angles that a DataArray does not hold it is interpolated by a periodic cubic spline (scipy's CubicSpline,
    bc_type="periodic"), over 360 degrees or, where its angles run further, 720.

    Raises
    ------
    ValueError
        For values of the wrong shape or not finite, and for an array that cannot be brought to these angles.
    """
    if callable(value) and not hasattr(value, "dims"):
        return _called(path, value, rule, grid)
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
        values = np.asarray(function(grid.angles.copy()), dtype=float)
    except Exception as error:
        raise ValueError(
            f"{path}: the function failed on an array of theta2 in degrees ({type(error).__name__}: {error}); "
            f"write it with numpy, as in lambda theta2: 5 * np.cos(np.radians(theta2))"
        ) from error
    if values.shape not in ((), grid.angles.shape):
        raise ValueError(
            f"{path}: the function returned shape {values.shape} for {len(grid.angles)} angles; "
            f"it must return one number in {UNITS[rule.kind]} for each angle"
        )
    sampled = xr.DataArray(np.broadcast_to(values, grid.angles.shape), {"theta2": grid.angles}, "theta2")
    found = number_problems(path, sampled, rule)
    if found:
        raise ValueError("\n".join(found))
    return sampled


def _as_it_stands(path: str, value: xr.DataArray, grid: Grid) -> xr.DataArray:
    if value.sizes["theta2"] != len(grid.angles):
        raise ValueError(
            f"{path} has {value.sizes['theta2']} values over theta2 but no theta2 coordinate, and the sweep has "
            f'{len(grid.angles)} angles: give it its angles with coords={{"theta2": degrees}}'
        )
    return value


def _spline(path: str, value: xr.DataArray, grid: Grid, period: float) -> xr.DataArray:
    from scipy.interpolate import CubicSpline

    value = value.sortby("theta2").transpose("theta2", ...)
    angles, values = value["theta2"].values, value.values
    if angles[-1] - angles[0] > period:
        period = 2.0 * period
    if angles[-1] - angles[0] < period:
        angles = np.append(angles, angles[0] + period)
        values = np.concatenate([values, values[:1]])
    if len(angles) < 4 or angles[-1] - angles[0] > period or (np.diff(angles) <= 0.0).any():
        raise ValueError(
            f"{path}: its {len(angles) - 1} angles from {angles[0]:g} to {angles[-2]:g} degrees cannot be joined; "
            f"give at least 3 different angles within one period of {period:g} degrees"
        )
    if not np.array_equal(values[0], values[-1]):
        raise ValueError(
            f"{path}: its values at {angles[0]:g} and {angles[-1]:g} degrees differ, but they are the same position; "
            f"make them equal or leave one out"
        )
    spline = CubicSpline(angles, values, bc_type="periodic")
    wanted = angles[0] + np.mod(grid.angles - angles[0], period)
    found = value.isel(theta2=0, drop=True).expand_dims(theta2=grid.angles).copy(data=spline(wanted))
    place = {angle: k for k, angle in enumerate(value["theta2"].values)}
    held = np.array([place.get(angle, -1) for angle in wanted])
    found.values[held >= 0] = value.values[held[held >= 0]]
    return found
