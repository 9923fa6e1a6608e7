"""Derivatives to theta2 of a length that changes over the revolution, such as that of a cylinder.

Of an array they are those of its spline. Of a function they are limits of central differences; see `acceleration`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import Number, Rule
from linksweep.engine.run import Grid, Places
from linksweep.scene.curves.acceleration import ROUNDING, STEPS, limit
from linksweep.scene.curves.over_angle import ArrayCurve, at_angles, called, over_grid, period_of_function


def with_derivatives(
    path: str, value: Any, rule: Rule, grid: Grid, turn: float, curve: ArrayCurve | None, places: Places | None
) -> tuple[Number, Number, Number]:
    """Return a function or an array of theta2 at the grid's angles, and its first two derivatives [1/rad, 1/rad²].

    `curve` and `places` are as of `at_angles`.

    Raises
    ------
    ValueError
        For an array that does not go all the way round, and as `over_angle.at_angles`.
    """
    if not hasattr(value, "dims"):
        return _of_function(path, value, rule, grid, period_of_function(value, turn))
    array = value if "theta2" in value.coords else value.assign_coords(theta2=grid.angles)
    curve = curve or ArrayCurve(path, array, turn)
    slope, curvature = (curve.slope(grid, order, places) for order in (1, 2))
    return at_angles(path, value, rule, grid, curve, places), slope, curvature


def third_derivative(
    path: str, value: Any, rule: Rule, grid: Grid, turn: float, curve: ArrayCurve | None, places: Places | None
) -> xr.DataArray:
    """Return the third derivative to theta2 of a function or an array at the grid's angles [1/rad³].

    Arguments are as of `with_derivatives`.
    """
    if curve is not None:
        return curve.slope(grid, 3, places)
    middle = called(path, value, rule, grid.angles)
    after, before = _beside(path, value, rule, grid, period_of_function(value, turn))
    rise, width, noise = after - before, np.radians(STEPS[1:]), ROUNDING * np.max(abs(middle.values))
    thirds = (rise[:, :-1] - 2.0 * rise[:, 1:]) / (2.0 * width**3)  # each step is twice the next one
    return over_grid(limit(thirds, np.broadcast_to(3.0 * noise / width**3, thirds.shape)), middle, grid)


def _of_function(path: str, function: Any, rule: Rule, grid: Grid, period: float) -> tuple[Number, Number, Number]:
    middle = called(path, function, rule, grid.angles)
    after, before = _beside(path, function, rule, grid, period)
    own, width, noise = middle.values[:, None], np.radians(STEPS), ROUNDING * np.max(abs(middle.values))
    slope = limit((after - before) / (2.0 * width), np.broadcast_to(noise / width, before.shape))
    curvature = limit((after - own + before - own) / width**2, np.broadcast_to(4.0 * noise / width**2, before.shape))
    return middle, over_grid(slope, middle, grid), over_grid(curvature, middle, grid)


def _beside(path: str, function: Any, rule: Rule, grid: Grid, period: float) -> np.ndarray:
    """Return a function's values (side, angle, step) at all steps after and before the grid's angles."""
    at = np.mod(np.stack([grid.angles[:, None] + STEPS, grid.angles[:, None] - STEPS]), period)
    different, place = np.unique(at, return_inverse=True)
    return called(path, function, rule, different).values[place.reshape(at.shape)]
