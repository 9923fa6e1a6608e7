"""Derivatives to theta2 of a length that changes over the revolution, such as that of a cylinder.

Of an array they are those of its spline. Of a function they are limits of central differences; see `acceleration`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

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


def _of_function(path: str, function: Any, rule: Rule, grid: Grid, period: float) -> tuple[Number, Number, Number]:
    middle = called(path, function, rule, grid.angles)
    at = np.mod(np.stack([grid.angles[:, None] + STEPS, grid.angles[:, None] - STEPS]), period)
    different, place = np.unique(at, return_inverse=True)
    after, before = called(path, function, rule, different).values[place.reshape(at.shape)]
    own, width, noise = middle.values[:, None], np.radians(STEPS), ROUNDING * np.max(abs(middle.values))
    slope = limit((after - before) / (2.0 * width), np.broadcast_to(noise / width, before.shape))
    curvature = limit((after - own + before - own) / width**2, np.broadcast_to(4.0 * noise / width**2, before.shape))
    return middle, over_grid(slope, middle, grid), over_grid(curvature, middle, grid)
