"""Functions of theta2 as samples, which is how a file holds them.

Samples every half degree are joined by the periodic cubic spline of `linksweep.scene.curves.over_angle`; where the
function leaves it, samples are added halfway between, until it does so nowhere. About a kink they crowd; a jump has no
such samples.
"""

from __future__ import annotations

from collections.abc import Hashable
from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr

from linksweep.scene.curves.interpolation import PeriodicCurve
from linksweep.scene.curves.over_angle import period_of_function

STEP = 0.5
"""Degrees between samples of a function that changes slowly."""
ACCURACY = 1e-9
"""How far a function may be from its samples' spline, in parts of its largest value."""
CLOSEST = 1e-9
"""Degrees between samples below which a rough place is a jump."""
MOST = 20_000
"""Samples of a turn that a file holds at most."""
BETWEEN = np.arange(0.05, 1.0, 0.1)
"""Places between two samples where function and spline are compared, as fractions of their distance."""


def values_at(function: Any, angles: np.ndarray) -> np.ndarray:
    """Return the function's values at angles [degree], in the shape of these."""
    values = np.broadcast_to(np.asarray(function(angles.ravel()), dtype=float), angles.size)
    return np.array(values).reshape(angles.shape)


def tabulated(function: Any, turn: float) -> xr.DataArray | None:
    """Return a DataArray over theta2 that is interpolated to the function, within `ACCURACY` of its largest value.

    Parameters
    ----------
    function : of theta2 [degree], in arrays
    turn : degrees of one turn

    Returns
    -------
    DataArray over one period, which may be two turns; None for a function that jumps, or that changes too quickly.

    Examples
    --------
    >>> tabulated(lambda theta2: np.cos(np.radians(theta2)), 360.0).sizes
    Frozen({'theta2': 720})
    >>> tabulated(lambda theta2: np.where(theta2 < 180.0, -80.0, 0.0), 360.0) is None
    True
    """
    period = period_of_function(function, turn)
    angles = np.arange(0.0, period, STEP)
    find = _kept if isinstance(function, Hashable) else _tabulated
    return find(function, period, turn, values_at(function, angles).tobytes())


def _tabulated(function: Any, period: float, turn: float, first_values: bytes) -> xr.DataArray | None:
    """Compute `tabulated`; the values at the first angles are part of the key under which the result is cached."""
    angles = np.arange(0.0, period, STEP)
    while len(angles) <= MOST * period / turn:
        values, steps = values_at(function, angles), np.diff(angles, append=period)
        between = angles[:, None] + steps[:, None] * BETWEEN
        spline = PeriodicCurve(angles, values, period)
        error = np.abs(spline.slope(between, 0) - values_at(function, between)).max(axis=1)
        rough = error > ACCURACY * np.abs(values).max()
        if not rough.any():
            return xr.DataArray(values, {"theta2": angles}, "theta2")
        if steps[rough].min() < CLOSEST:
            return None
        angles = np.sort(np.concatenate([angles, (angles + 0.5 * steps)[rough]]))
    return None


_kept = lru_cache(maxsize=64)(_tabulated)
