"""Loads over the position of a link: tables over `position`, and functions of it, evaluated at positions.

Between its positions a table goes straight, or as the load's interpolation says; before the first and after the last
one their values hold.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import Rule, is_array, number_problems, quote, refuse
from linksweep.scene.curves.acceleration import ROUNDING, STEPS, limit
from linksweep.scene.curves.interpolation import curve_through

Curve = Callable[[np.ndarray], np.ndarray]

POSITION = "position"
KINDS = ("linear", "pchip", "step")
"""Interpolations of a table over positions, the default first."""


def is_table(value: Any) -> bool:
    return is_array(value) and POSITION in value.dims


def is_function(value: Any) -> bool:
    return callable(value) and not is_array(value)


def table_problems(path: str, value: Any) -> list[str]:
    """Return the problems of a number of a load that follows a position."""
    if is_array(value) and "theta2" in value.dims:
        return [f'{path} depends on theta2, but the load on a position: give it dims="{POSITION}", or leave out over']
    if not is_table(value):
        return []
    if value.dims != (POSITION,) or POSITION not in value.coords:
        shape = f'dims {value.dims}: must be over its positions alone, xarray.DataArray(values, {{"{POSITION}": [...]}}'
        return [f'{path} has {shape}, "{POSITION}")']
    places = value[POSITION].values
    if places.dtype.kind not in "fiu" or not np.isfinite(places).all() or np.unique(places).size < max(2, places.size):
        return [f"{path} has {POSITION} = {quote(places.tolist())}: must hold two or more different finite numbers"]
    return []


def at_positions(path: str, value: Any, rule: Rule, positions: Any, kind: str, interpolation: str | None) -> Any:
    """Return a table or function of positions at some of them, over their dims; any other number as it is.

    Angles (`kind`) are taken by whole turns to the table's middle; a function has them in (-180, 180]. Positions with
    slopes give loads with slopes; those of a function are limits of central differences.

    Raises
    ------
    ValueError
        For a function that fails, or returns what is no number for each position.
    """
    if is_table(value):
        known, values = _sorted(value)
        look_up = partial(_looked_up, known, values, interpolation or KINDS[0], kind == "angle")
        return _through(positions, look_up, partial(look_up, order=1))
    if is_function(value):
        call = partial(_called, path, value, rule)
        return _through(positions, call, partial(_slope, call))
    return value


def _through(positions: Any, curve: Curve, slope: Curve) -> Any:
    """Return a curve at positions, DataArrays or numbers with slopes."""
    if hasattr(positions, "through"):
        return positions.through(curve, slope)
    return positions.copy(data=curve(positions.values))


def _slope(call: Curve, positions: np.ndarray) -> np.ndarray:
    """Return the slope of a function of positions, the limit of central differences."""
    size = np.max(np.abs(positions), initial=0.0, where=np.isfinite(positions)) or 1.0
    steps = size * STEPS / 360.0
    sides = (call((positions.ravel()[:, None] + sign * steps).ravel()).reshape(-1, len(steps)) for sign in (1.0, -1.0))
    after, before = sides
    noise = ROUNDING * np.nanmax(np.abs(after), initial=0.0) / steps
    slopes = limit((after - before) / (2.0 * steps), np.broadcast_to(noise, after.shape))
    return slopes.reshape(positions.shape)


def corners(value: Any, interpolation: str | None) -> list[float]:
    """Return the positions at which a table jumps or bends; beyond its ends a value holds."""
    if not is_table(value):
        return []
    known, values = _sorted(value)
    jumps = np.append(False, np.diff(values) != 0.0)
    if interpolation == "pchip":
        return known[[0, -1]].tolist()
    return known[jumps].tolist() if interpolation == "step" else known.tolist()


def _sorted(table: xr.DataArray) -> tuple[np.ndarray, np.ndarray]:
    ordered = table.sortby(POSITION)
    return ordered[POSITION].values.astype(float), ordered.values.astype(float)


def _looked_up(
    known: np.ndarray, values: np.ndarray, interpolation: str, turns: bool, positions: np.ndarray, order: int = 0
) -> np.ndarray:
    """Return a table at positions, or its derivative of this order."""
    middle = 0.5 * (known[0] + known[-1])
    near = middle + np.mod(positions - middle + 180.0, 360.0) - 180.0 if turns else positions
    held = np.clip(near, known[0], known[-1])
    if interpolation == "step":  # the last value holds, too
        known, values = np.append(known, known[-1] + 1.0), np.append(values, values[-1])
    curve = curve_through(interpolation, known, values)
    return curve(held, order) * (held == near) if order else curve(held)


def _called(path: str, function: Any, rule: Rule, positions: np.ndarray) -> np.ndarray:
    known = np.isfinite(positions)
    loads = np.full(known.shape, np.nan)
    if not known.any():  # it is assembled at none of the angles
        return loads
    try:
        values = np.broadcast_to(np.asarray(function(positions[known])), known.sum())
    except Exception as error:
        text = " ".join(f"{type(error).__name__}: {error}".split())
        raise ValueError(
            f"{path}: the function failed on an array of positions ({text}); "
            f"write it with numpy, as in lambda x: np.where(x < 0.012, -5000.0, 0.0)"
        ) from error
    refuse(number_problems(path, xr.DataArray(values, dims=POSITION), rule))
    loads[known] = values
    return loads
