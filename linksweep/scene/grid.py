"""The angles of a sweep, with the cosines and sines from which the kernels start."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from linksweep.base.conversion import all_to_float64
from linksweep.base.degrees import cos_sin_low_words
from linksweep.base.memory import require_memory
from linksweep.base.units import unit_problems
from linksweep.base.validate import quote, refuse
from linksweep.engine.run import Grid

NAMES = ("cos2", "sin2", "cos2_lo", "sin2_lo", "radians2")
"""Rows of a grid's table."""


def crank_grid(angles: Any, period: float, dim: str = "theta2") -> Grid:
    """Return the grid of a count (arange(N)·360/N) or of angles themselves, in degrees or as quantities of pint.

    Raises ValueError for anything else, naming the parameter `dim`.
    """
    if isinstance(angles, int | np.integer) and not isinstance(angles, bool | np.timedelta64):
        if angles < 1:
            raise ValueError(f"{dim} = {quote(angles)}: a count of angles must be at least 1")
        require_memory(f"{dim} = {quote(angles)}", 8.0 * angles * (1 + len(NAMES)))
        return _uniform(int(angles), period, dim)
    return _grid(_angles(angles, dim), 0.0, dim)


def whole_turns(angles: np.ndarray, turn: float) -> float | None:
    """Return the whole turns [degree] that angles in order divide evenly; None where they divide none."""
    steps = np.diff(angles)
    period = turn * round((angles[-1] - angles[0] + steps.mean()) / turn)
    even = period > 0.0 and np.allclose(steps, period / len(angles), rtol=0.0, atol=1e-9)
    return period if even else None


@lru_cache(maxsize=8)
def _uniform(count: int, period: float, dim: str) -> Grid:
    return _grid(np.arange(count) * (period / count), period, dim)


def _angles(values: Any, name: str) -> np.ndarray:
    """Return a list of angles as float64 [degree]."""
    refuse(unit_problems(name, getattr(values, "attrs", {}).get("units"), "angle"))
    try:
        angles = np.asarray(all_to_float64(values, "angle"))
    except ValueError:  # rows that differ in length
        angles = np.empty(0)
    if angles.dtype.kind not in "fiu" or angles.ndim > 1 or angles.size == 0:
        raise ValueError(f"{name} = {quote(values)}: must be a count of angles, or a list of angles in degrees")
    if angles.ndim == 0:
        raise ValueError(f"{name} = {quote(values)}: a count is a whole number; for one angle write [{angles}]")
    angles = angles.astype(float)
    sound = np.isfinite(angles)
    if not sound.all():
        k = int(np.argmin(sound))
        raise ValueError(f"{name}[{k}] = {angles[k]}: every angle must be a finite number of degrees")
    return angles


def in_order(grid: Grid) -> Grid:
    """Return the grid with its angles sorted, each once, as the search for peaks between neighbours needs them."""
    return grid if (np.diff(grid.angles) > 0.0).all() else _grid(np.unique(grid.angles), grid.period, grid.dim)


def _grid(angles: np.ndarray, period: float, dim: str) -> Grid:
    """Return a grid with its table."""
    table = np.array([*cos_sin_low_words(angles), np.radians(np.mod(angles, 360.0))])
    return Grid(dim, angles, period, NAMES, table)
