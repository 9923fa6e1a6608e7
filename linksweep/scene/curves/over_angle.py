"""Evaluate functions and DataArrays of theta2, which change over the revolution, at the angles of a sweep."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.frozen import cached_beside
from linksweep.base.validate import Rule, is_quantity, refuse, value_problems
from linksweep.engine.run import Grid, Places
from linksweep.scene.curves.interpolation import CUBIC, RINGING, OvershootWarning, PeriodicCurve

ValuesAt = Callable[[np.ndarray, Any], np.ndarray]
"""A function of angles [degree], and of the column of values at each, None for all, that returns values there."""
LARGEST = 1e290
"""Values from here on are not interpolated."""
CLOSEST = 1e-9
"""Least distance between two angles of an array [degree]: they must still differ a period later."""
TURNS = range(1, 13)
"""Numbers of turns of the crank after which a function may repeat."""
WITHIN = np.append(0.0, np.arange(0.37, 360.0) / 360.0)
"""Places, as fractions of a turn, at which the turns of a function are compared; it may jump at the first."""


def turns_of_function(function: Any, turn: float) -> int | None:
    """Return the number of turns of the crank after which a function of theta2 repeats; None if it is not in `TURNS`.

    A function counts as repeating, too, if from then on it keeps its first value, as np.interp does beyond its data, or
    if it has its first value there. For a function that fails, or is not finite, the number is 1: its problem is
    reported when it is swept.
    """
    angles = turn * (np.arange(2 * max(TURNS))[:, None] + WITHIN)
    try:
        with np.errstate(all="ignore"):
            returned = function(angles.ravel())
            values = np.broadcast_to(np.asarray(getattr(returned, "magnitude", returned), dtype=float), angles.size)
    except Exception:
        return 1
    values = values.reshape(angles.shape)
    near = 1e-9 * np.max(np.abs(values[: max(TURNS)]))

    def same(some: np.ndarray, others: np.ndarray) -> bool:
        return bool((np.abs(some - others) <= near).all())

    first, within = values[0, 0], values[:, 1:]
    tests: tuple[Callable[[int], bool], ...] = (
        lambda n: same(within[n:], within[:-n]),
        lambda n: same(values[n:], first),
        lambda n: same(values[n, 0], first),
    )
    return next((n for test in tests for n in TURNS if test(n)), None) if np.isfinite(values).all() else 1


def turning_problems(path: str, function: Any, turn: float) -> list[str]:
    """Return the problem of a function of theta2 that does not repeat, such as one of radians."""
    if turns_of_function(function, turn):
        return []
    angles = turn * np.arange(3)
    gives = ", ".join(f"{value:.6g} at {angle:g}" for value, angle in zip(function(angles), angles, strict=True))
    return [
        f"{path}: the function gives {gives} degrees: it must repeat after some turns, at most {max(TURNS)}; "
        f"theta2 is in degrees, so write np.sin(np.radians(theta2)), or np.mod(theta2, {turn:g}) to start anew"
    ]


def period_of_function(function: Any, turn: float) -> float:
    """Return the period [degree] of a function of theta2."""
    return turn * (turns_of_function(function, turn) or 1)


def period_of(value: Any, shortest: float) -> float:
    """Return the period [degree] of a DataArray over theta2: as many turns as its angles span."""
    if "theta2" not in value.coords:
        return shortest  # its values are those of the sweep's own angles
    return shortest * max(np.ceil(np.ptp(value["theta2"].values) / shortest), 1.0)


def at_angles(
    path: str, value: Any, rule: Rule, grid: Grid, curve: ArrayCurve | None = None, places: Places | None = None
) -> Any:
    """Evaluate a function or DataArray of theta2 at the grid's angles; return any other number as it is.

    At angles that a DataArray does not hold its `curve` is evaluated; at angles that it holds, or that are whole
    periods from them, its values come back to the bit. With `places`, those of the design of each angle alone.

    Raises
    ------
    ValueError
        For values of the wrong shape or not finite, and for an array that cannot be interpolated at these angles.

    Warns
    -----
    OvershootWarning
        Where a spline leaves its data's range, once for each curve.
    """
    if callable(value) and not hasattr(value, "dims"):
        return called(path, value, rule, grid.angles)
    if "theta2" not in getattr(value, "dims", ()):
        return value
    if "theta2" not in value.coords:
        return _as_it_stands(path, value, grid)
    known = value["theta2"].values
    if places is None and len(known) == len(grid.angles) and np.array_equal(known, grid.angles):
        return value
    place = {angle: k for k, angle in enumerate(known)}
    if all(angle in place for angle in grid.angles):
        picked = {"theta2": [place[angle] for angle in grid.angles], **(places or {})}
        return value.isel({dim: xr.Variable("theta2", at) for dim, at in picked.items()}, missing_dims="ignore")
    assert curve is not None, path
    return curve.at(grid, places)


def called(path: str, function: Any, rule: Rule, angles: np.ndarray) -> xr.DataArray:
    """Evaluate a function of theta2 [degree] at these angles. Raises ValueError as `at_angles`."""
    try:
        returned = function(angles.copy())
        values = np.asarray(getattr(returned, "magnitude", returned))
    except Exception as error:
        text = " ".join(f"{type(error).__name__}: {error}".split())
        raise ValueError(
            f"{path}: the function failed on an array of theta2 in degrees ({text}); "
            f"write it with numpy, as in lambda theta2: 5 * np.cos(np.radians(theta2))"
        ) from error
    if is_quantity(returned):
        raise ValueError(f"{path}: the function returned a quantity in {returned.units}; it must return {rule.number}")
    if values.shape not in ((), angles.shape):
        raise ValueError(
            f"{path}: the function returned shape {values.shape} for {len(angles)} angles; "
            f"it must return {rule.number} for each angle"
        )
    sampled = _labelled(angles).copy(deep=False, data=np.broadcast_to(values, angles.shape))
    refuse([f"{problem}; its function returned it" for problem in value_problems(path, sampled, rule)])
    return sampled.astype(float)


def _as_it_stands(path: str, value: xr.DataArray, grid: Grid) -> xr.DataArray:
    if value.sizes["theta2"] != len(grid.angles):
        raise ValueError(
            f"{path} has {value.sizes['theta2']} values over theta2 but no theta2 coordinate, and the sweep has "
            f'{len(grid.angles)} angles: give it its angles with coords={{"theta2": degrees}}'
        )
    return value


def _slope_problems(path: str, known: np.ndarray, values: np.ndarray) -> list[str]:
    """Return the problem of values at angles in order between which slopes would overflow."""
    largest, closest = float(np.max(np.abs(values))), float(np.min(np.diff(known), initial=np.inf))
    if largest >= LARGEST:
        return [f"{path} holds {largest:.15g}: is interpolated, so it must be below {LARGEST:g}"]
    return [f"{path}: two of its angles are {closest:g} degrees apart; give one"] if closest < CLOSEST else []


@dataclass(frozen=True, eq=False)
class ArrayCurve:
    """The periodic curve through an array over theta2, a cubic spline unless `interpolation` states another.

    Its period is as many turns of `turn` degrees as the array's angles span. Its two properties are caches: the curve
    is computed when it is first needed.
    """

    path: str
    array: xr.DataArray
    turn: float
    interpolation: str | None = None

    @cached_property
    def problems(self) -> list[str]:
        """Reasons why the curve does not go all the way round."""
        period, interpolation = period_of(self.array, self.turn), self.interpolation or CUBIC
        return period_problems(self.path, *knots(self.array), period, interpolation)

    @cached_property
    def unwarned(self) -> PeriodicCurve:
        """The curve, without a warning where it leaves the range of the array.

        Raises ValueError where its angles do not go all the way round.
        """
        known, values = knots(self.array)
        period, interpolation = period_of(self.array, self.turn), self.interpolation or CUBIC
        refuse(_slope_problems(self.path, known, values) or self.problems)
        last = -1 if known[-1] - known[0] == period else None  # repeats the first
        return PeriodicCurve(known[:last], values[:last], period, interpolation)

    @cached_property
    def periodic(self) -> PeriodicCurve:
        """The curve, with a warning where it leaves the range of the array."""
        _warn_of_overshoot(self.path, self.unwarned.overshoot)
        return self.unwarned

    def at(self, grid: Grid, places: Places | None = None) -> xr.DataArray:
        """Return values at the angles of a grid; with `places`, of the design of each angle alone."""
        return self.over(grid, places, self.periodic)

    def slope(self, grid: Grid, order: int = 1, places: Places | None = None) -> xr.DataArray:
        """Return derivatives at the angles of a grid [1/rad^order], as `at`."""
        per_radian = np.degrees(1.0) ** order
        return self.over(grid, places, lambda angles, own: per_radian * self.unwarned.slope(angles, order, own))

    def over(self, grid: Grid, places: Places | None, values_at: ValuesAt) -> xr.DataArray:
        """Return what a function of angles and columns, as those of `PeriodicCurve`, returns at those of a grid."""
        dims = [str(dim) for dim in self.array.dims if dim != "theta2"]
        if places is None or not dims:
            return over_grid(values_at(grid.angles, None), self.array, grid)
        columns = np.ravel_multi_index(tuple(places[dim] for dim in dims), tuple(self.array.sizes[dim] for dim in dims))
        return over_grid(values_at(grid.angles, columns), self.array[dict.fromkeys(dims, 0)], grid)

    @property
    def overshoot(self) -> float | None:
        """Distance by which a spline leaves the range of the array, relative to it; None where there is no spline."""
        try:
            return self.unwarned.overshoot if self.interpolation in (None, CUBIC) else None
        except ValueError:  # angles that do not go all the way round
            return None


def _warn_of_overshoot(path: str, overshoot: float) -> None:
    if overshoot <= RINGING:
        return
    instead = 'give its load interpolation = "pchip" (or "linear", "step"), or give it at more angles'
    of_motion = "give it at more angles, or as a function; where it jumps, as alpha2 of a steady cycle with the loads, "
    of_motion += "results are right at its own angles alone: sweep at these, theta2 = scene.alpha2.theta2"
    instead = instead if path.startswith("loads") else of_motion
    text = f"{path}: the spline through its values leaves their range by {100.0 * overshoot:.2g} % of it; {instead}"
    warnings.warn(text, OvershootWarning, stacklevel=2)


def corners(value: Any, interpolation: str | None) -> tuple[float, ...]:
    """Return the angles [degree] at which an array over theta2 jumps (interpolation "step") or bends ("linear")."""
    if interpolation not in ("step", "linear") or "theta2" not in getattr(value, "coords", ()):
        return ()
    known, values = knots(value)
    jumps = (values != np.roll(values, 1, axis=0)).reshape(len(known), -1).any(axis=1)
    return tuple(known[jumps if interpolation == "step" else jumps | np.roll(jumps, -1)].tolist())


def knots(value: xr.DataArray) -> tuple[np.ndarray, np.ndarray]:
    """Return the angles [degree] of an array over theta2 in order, and its values with theta2 as their first axis."""
    order = np.argsort(value["theta2"].values, kind="stable")
    known = value["theta2"].values[order].astype(float)
    return known, np.moveaxis(value.values.astype(float), value.dims.index("theta2"), 0)[order]


def over_grid(values: np.ndarray, like: xr.DataArray, grid: Grid) -> xr.DataArray:
    """Return values at the grid's angles, theta2 as their first axis, as an array with the other dims of `like`."""
    others = [dim for dim in like.dims if dim != "theta2"]
    if not others:
        made = _labelled(grid.angles).copy(deep=False, data=values)
        made.attrs.update(like.attrs)
        return made
    labels = {dim: like[dim].variable for dim in others if dim in like.coords}
    coordinates = _labelled(grid.angles).coords
    return xr.DataArray(values, coordinates.assign(labels), ("theta2", *others), attrs=like.attrs)


@cached_beside
def _labelled(angles: np.ndarray) -> xr.DataArray:
    """Return an array over these angles, whose index all arrays over them share: to make one takes xarray longer than
    the rest of a curve."""
    own = angles.copy()  # what is kept must not hold the object beside which it is kept
    return xr.DataArray(own, {"theta2": own}, "theta2")


def period_problems(
    path: str, known: np.ndarray, values: np.ndarray, period: float, interpolation: str = CUBIC
) -> list[str]:
    """Return the problem of values at angles in order that cannot be joined to a periodic curve.

    Steps need no angles all the way round: each holds up to the next.
    """
    beginning = f"{path}: its {len(known)} angles from {known[0]:g} to {known[-1]:g} degrees"
    span, steps = known[-1] - known[0], interpolation == "step"
    least = 2 if steps else 3
    if span == period and not np.array_equal(values[0], values[-1]):
        return [
            f"{path}: its values at {known[0]:g} and {known[-1]:g} degrees differ, but they are the same position; "
            f"make them equal or leave one out"
        ]
    if len(known) < least + (span == period) or span > period:
        angles = f"{least} different angles within one period of {period:g} degrees"
        return [f"{beginning} cannot be joined; give at least {angles}"]
    gap = np.diff(known, append=known[0] + period).max()
    if gap > 0.5 * period and not steps:
        return [f"{beginning} leave {gap:g} of {period:g} degrees open; give values all the way round"]
    return []
