"""Cells of tables: numbers, units, angles and flags in words."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np
import xarray as xr

PLAIN_UNITS = {"degree": "°", "1": ""}
"""Units as they follow a number, where that is not their own spelling."""
NO_VALUE = "no value"
"""Word for a flag that is NaN."""


def digits(value: float, significant: int = 6) -> str:
    """Return a number with so many significant digits, 0 without a sign."""
    return f"{value + 0.0:.{significant}g}"


def fixed(value: float, decimals: int, sign: str = "") -> str:
    """Return a number with so many decimals, 0 without a minus; a `sign` "+" stands before all others."""
    return f"{round(value, decimals) + 0.0:{sign}.{decimals}f}"


def number(value: float, significant: int = 4) -> str:
    """Format a number with so many significant digits."""
    if value == 0.0:
        return "0"
    if np.isinf(value):
        return "∞" if value > 0.0 else "−∞"
    if not 1e-3 <= abs(value) < 1e7:
        return f"{value:.{significant - 1}e}".replace("-", "−")
    text = np.format_float_positional(value, precision=significant, unique=False, fractional=False, trim="k")
    return text.rstrip(".").replace("-", "−")


def finite_or_inf(value: float) -> str:
    """Return a number as figures show it, but infinity in letters that every terminal has; nothing for NaN."""
    return "" if np.isnan(value) else f"{value:g}" if np.isinf(value) else number(value)


def handy_unit(values: xr.DataArray) -> tuple[str, float]:
    """Return the unit in which a table shows a variable, as MPa for Pa, and its size in the variable's own unit."""
    unit = unit_of(values)
    if unit.partition(" ")[0] == "Pa":
        return f"M{unit}", 1e6
    return "°" if unit == "degree" else unit, 1.0


def unit_of(values: xr.DataArray) -> str:
    """Return the unit that a variable states; "" where it states none."""
    return str(values.attrs.get("units", ""))


def plain_unit(values: xr.DataArray) -> str:
    """Return the unit of a variable as a table shows it: the sign of degrees, nothing for a ratio."""
    return PLAIN_UNITS.get(unit_of(values), unit_of(values))


def with_unit(value: float, units: str, significant: int = 6) -> str:
    """Return a number with its unit, "12.3 N m" or "45°"."""
    unit = PLAIN_UNITS.get(units, units)
    return digits(value, significant) + (unit if unit in ("", "°") else f" {unit}")


def at(values: xr.DataArray, place: Mapping[Any, int]) -> float:
    """Return the number at a place, of an array over some of its dims; in numpy, since xarray would import dask."""
    return float(values.values[tuple(place[dim] for dim in values.dims)])


def place_of_worst(values: xr.DataArray) -> Mapping[Any, int]:
    """Return the place of the largest value of a maximum, the least of a minimum, the largest magnitude of all else.

    Infinity is the worst of all; there must be a number.
    """
    name = str(values.name)
    size = values.values  # in numpy: xarray's arithmetic would import dask
    size = size if name.endswith("_max") else -size if name.endswith("_min") else np.abs(size)
    place = np.unravel_index(np.nanargmax(size), size.shape)
    return dict(zip(values.dims, map(int, place), strict=True))


def label(ds: xr.Dataset, dim: Hashable, k: Any) -> str:
    """Return the label of a place along a dim, or its position; "any" where the place is None."""
    if k is None:
        return "any"
    value = ds[dim].values[int(k)] if dim in ds.coords else int(k)
    return digits(float(value)) if isinstance(value, float | np.floating) else str(value)


def words(flag: xr.DataArray) -> list[str]:
    """Return the meanings of a flag's values."""
    return str(flag.attrs["flag_meanings"]).replace("_", "-").split()


def counts_of_words(flag: xr.DataArray) -> dict[str, int]:
    """Return how often a flag has each of its values, by the word for it; NaN is no value, as of `Dataset.where`."""
    meaning = dict(zip(np.atleast_1d(flag.attrs["flag_values"]).tolist(), words(flag), strict=True))
    values, counts = np.unique(flag.values, return_counts=True)
    names = [NO_VALUE if np.isnan(value) else meaning.get(value, str(value)) for value in values.tolist()]
    return dict(zip(names, counts.tolist(), strict=True))


def in_words(flag: xr.DataArray) -> str:
    """Return a flag in words: that of its value, or how often it has each."""
    counts = counts_of_words(flag)
    return next(iter(counts)) if len(counts) == 1 else ", ".join(f"{word} {n}" for word, n in counts.items())


def meanings(ds: xr.Dataset) -> dict[str, str]:
    """Return the description of each variable, by name."""
    return {str(name): str(values.attrs.get("long_name", "")) for name, values in ds.variables.items()}
