"""Tables of balancing: counterweights, before and after, and orders."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from linksweep.analysis.balance.counterweights import Counterweight
from linksweep.scene.shown_units import UnitSystem
from linksweep.tables.cells import digits, meanings, unit_of
from linksweep.tables.table import Row, Table

ROUNDING = 1e-12
"""Part of a size beside which less than this is rounding."""
BALANCED = 100.0
"""Sizes before balancing that what is left after is compared with: the roundings of several links add up."""


def zero_of_rounding(value: float, beside: float) -> float:
    """Return a value, 0 where it is only rounding beside another value."""
    return 0.0 if abs(value) <= ROUNDING * beside < np.inf else value


def without_rounding(value: float, beside: float) -> str:
    """Format a value with five digits: 0 where it is only rounding beside another value, "none" for NaN."""
    return "none" if np.isnan(value) else digits(zero_of_rounding(value, beside), 5)


def weight_table(weights: Iterable[Counterweight], system: UnitSystem) -> Table:
    """Return the table of counterweights: link, mass and place."""
    mass, distance = system.unit("kg"), system.unit("m")
    header = ("counterweight on", f"mass [{mass}]", f"distance [{distance}]", "angle [°]")
    rows: list[Row] = []
    for weight in weights:
        numbers = system.value(weight.mass, "kg"), system.value(weight.at[0], "m"), weight.at[1]
        rows.append((weight.link, *(digits(float(size), 5) for size in numbers)))
    return Table(header, rows, right=(1, 2, 3))


def balance_table(ds: xr.Dataset) -> Table:
    """Return the table of sizes before and after, with 0 for a force that is balanced away."""
    rows: list[Row] = []
    for name, values in ds.data_vars.items():
        before, after = (float(values.sel(balance=when)) for when in ("before", "after"))
        rows.append((str(name), digits(before, 5), without_rounding(after, BALANCED * before), unit_of(values)))
    return Table(("quantity", "before", "after", "unit"), rows, right=(1, 2), meanings=meanings(ds))


def order_table(ds: xr.Dataset) -> Table:
    """Return the table of amplitudes, a line for each order."""
    amplitudes = [values for name, values in ds.data_vars.items() if str(name).endswith("_amplitude")]
    titles = (f"{str(each.name).removesuffix('_amplitude')} [{unit_of(each)}]" for each in amplitudes)
    largest = [float(abs(each).max()) for each in amplitudes]
    rows: list[Row] = []
    for k, order in enumerate(ds["order"].values):
        values = (without_rounding(float(each[k]), most) for each, most in zip(amplitudes, largest, strict=True))
        rows.append((f"{order:g}", *values))
    return Table(("order", *titles), rows, right=range(len(amplitudes) + 1))
