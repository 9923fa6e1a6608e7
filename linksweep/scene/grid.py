"""The angles of a sweep, with the cosines and sines from which the kernels start."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from linksweep.base.conversion import all_to_float64
from linksweep.base.degrees import cos_sin_low_words
from linksweep.base.memory import require_memory
from linksweep.base.units import unit_problems
from linksweep.base.validate import quote, radian_problems, refuse
from linksweep.chains.gears import Geared, geared_rows
from linksweep.engine.run import Grid
from linksweep.physics.algebra.double_double import two_product, two_sum

NAMES = ("cos2", "sin2", "cos2_lo", "sin2_lo", "radians2")
"""Rows of a grid's table, but for those of wheels."""


TEXTS = '(numbers, or texts such as "90 deg" and "1.5 rad")'


def rows(geared: Geared) -> tuple[str, ...]:
    """Return the names of the rows of a grid's table, those of wheels last."""
    return (*NAMES, *(name for role, _ in geared for name in geared_rows(role)))


def crank_grid(angles: Any, period: float, dim: str = "theta2", geared: Geared = ()) -> Grid:
    """Return the grid of a count (arange(N)·period/N) or of angles themselves, in degrees or as quantities of pint.

    Raises ValueError for anything else, naming the parameter `dim`.
    """
    if isinstance(angles, int | np.integer) and not isinstance(angles, bool | np.timedelta64):
        if angles < 1:
            raise ValueError(f"{dim} = {quote(angles)}: a count of angles must be at least 1")
        return _uniform(int(angles), period, dim, geared)
    return _grid(_angles(angles, dim), 0.0, dim, geared)


def whole_turns(angles: np.ndarray, turn: float) -> float | None:
    """Return the whole turns [degree] that angles in order divide evenly; None where they divide none."""
    steps = np.diff(angles)
    period = turn * round((angles[-1] - angles[0] + steps.mean()) / turn)
    even = period > 0.0 and np.allclose(steps, period / len(angles), rtol=0.0, atol=1e-9)
    return period if even else None


@lru_cache(maxsize=8)
def _uniform(count: int, period: float, dim: str, geared: Geared) -> Grid:
    require_memory(f"{dim} = {count}", 8.0 * count * (1 + len(rows(geared))))
    return _grid(np.arange(count) * (period / count), period, dim, geared)


def _angles(values: Any, name: str) -> np.ndarray:
    """Return a list of angles as float64 [degree]."""
    refuse(unit_problems(name, getattr(values, "attrs", {}).get("units"), "angle"))
    converted = all_to_float64(name, values, "angle")
    try:
        angles = np.asarray(converted)
    except ValueError:  # rows that differ in length
        angles = np.empty(0)
    if angles.dtype.kind not in "fiu" or angles.ndim > 1 or angles.size == 0:
        raise ValueError(f"{name} = {quote(values)}: must be a count of angles, or a list of angles in degrees {TEXTS}")
    if angles.ndim == 0:
        raise ValueError(f"{name} = {quote(values)}: a count is a whole number; for one angle write [{angles}]")
    angles = angles.astype(float)
    sound = np.isfinite(angles)
    if not sound.all():
        k = int(np.argmin(sound))
        raise ValueError(f"{name}[{k}] = {angles[k]}: every angle must be a finite number of degrees")
    refuse(radian_problems(f"{name} is", angles))
    return angles


def in_order(grid: Grid) -> Grid:
    """Return the grid with its angles sorted, each once, as the search for peaks between neighbours needs them."""
    if grid.period or (np.diff(grid.angles) > 0.0).all():
        return grid
    angles, first = np.unique(grid.angles, return_index=True)
    return grid._replace(angles=angles, table=grid.table.take(first, axis=1))


def _grid(angles: np.ndarray, period: float, dim: str, geared: Geared) -> Grid:
    """Return a grid with its table."""
    of_crank = *cos_sin_low_words(angles), np.radians(np.mod(angles, 360.0))
    of_wheels = (row for _, ratio in geared for row in cos_sin_of_multiple(angles, ratio))
    return Grid(dim, angles, period, rows(geared), np.array([*of_crank, *of_wheels]))


def cos_sin_of_multiple(angles: np.ndarray, ratio: Fraction) -> tuple[np.ndarray, ...]:
    """Return cosine and sine of ratio·angle, angles in degrees, then the low word of each.

    The multiple is reduced to one turn, without rounding, before it is divided; what the quotient misses turns the
    direction further by so small an angle t that cos(x + t) = cos x − t·sin x to all digits.
    """
    p, q = float(ratio.numerator), float(ratio.denominator)
    product, product_lo = two_product(p, np.fmod(angles, 360.0 * q))
    product = np.fmod(product, 360.0 * q)
    quotient = product / q
    exact, exact_lo = two_product(quotient, q)
    quotient, missing = two_sum(quotient, ((product - exact) - exact_lo + product_lo) / q)
    t = np.radians(missing)
    cos, sin, cos_lo, sin_lo = cos_sin_low_words(quotient)
    (cos, cos_lo), (sin, sin_lo) = two_sum(cos, cos_lo - t * sin), two_sum(sin, sin_lo + t * cos)
    return cos, sin, cos_lo, sin_lo
