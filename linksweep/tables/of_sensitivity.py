"""Tables of sensitivities, and of what tolerances do to results."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from linksweep.tables.cells import PLAIN_UNITS, digits, fixed, unit_of, with_unit
from linksweep.tables.of_balance import ROUNDING
from linksweep.tables.table import Part, Row, Table


def sensitivity_parts(ds: xr.Dataset) -> Iterator[Part]:
    """Yield a table for each result: derivatives and elasticities by parameter, the largest elasticity first."""
    for name in _results(ds, "_derivative"):
        yield f"{name} = {with_unit(float(ds[name]), unit_of(ds[name]))}{_remark(ds, name)}"
        slopes, elasticity = (ds[f"{name}_{word}"].values for word in ("derivative", "elasticity"))
        rounding = (np.abs(elasticity) <= ROUNDING) & (np.abs(slopes) <= ROUNDING * abs(float(ds[name])))
        slopes = np.where(rounding, 0.0, slopes)
        order = np.argsort(-np.nan_to_num(np.abs(elasticity)), kind="stable")
        rows: list[Row] = [
            (
                str(ds["parameter"].values[k]),
                fixed(elasticity[k], 3, "+"),
                digits(slopes[k], 5),
                f"{unit_of(ds[name])} per {ds['parameter_unit'].values[k]}",
            )
            for k in order
        ]
        yield Table(("parameter", "% per %", "derivative", ""), rows, right=(1, 2))


def tolerance_parts(ds: xr.Dataset) -> Iterator[Part]:
    """Yield a table for each result: its spread, and the share of each parameter, the largest first."""
    for name in _results(ds, "_share"):
        unit, number = unit_of(ds[name]), _numbers(ds, name)
        plain = PLAIN_UNITS.get(unit, unit)
        known = np.isfinite(number["sigma"])
        sigma = f", sigma {with_unit(number['sigma'], unit, 3)}" if known else ""
        yield f"{name} = {with_unit(float(ds[name]), unit)}{sigma}{_remark(ds, name)}"
        if known:
            yield f"worst case, linear: {digits(number['worst_least'])} to {with_unit(number['worst_largest'], unit)}"
        if "drawn_sigma" in number:
            yield f"drawn designs, exact: {_drawn(number, unit)}"
        share, lower, upper = (ds[f"{name}_{word}"].values + 0.0 for word in ("share", "lower", "upper"))
        rows: list[Row] = []
        for k in np.argsort(-np.nan_to_num(share), kind="stable"):
            numbers = f"{100.0 * share[k]:.1f} %", f"{lower[k]:+.3g}", f"{upper[k]:+.3g}", plain
            rows.append((str(ds["parameter"].values[k]), *(numbers if known else ("none", "none", "none", ""))))
        yield Table(("parameter", "of the variance", "at lower", "at upper limit", ""), rows, right=(1, 2, 3))


def _drawn(number: dict[str, float], unit: str) -> str:
    """Return the spread of drawn designs in words; some may have no finite result."""
    ends = f"{digits(number['drawn_least'])} to {with_unit(number['drawn_largest'], unit)}"
    if np.isfinite(number["drawn_sigma"]):
        return f"sigma {digits(number['drawn_sigma'], 3)}, {ends}"
    return f"{ends}, not finite in all of them" if np.isfinite(number["drawn_least"]) else "not finite in any of them"


def _results(ds: xr.Dataset, ending: str) -> list[str]:
    return [str(key).removesuffix(ending) for key in ds.data_vars if str(key).endswith(ending)]


def _numbers(ds: xr.Dataset, name: str) -> dict[str, float]:
    """Return the numbers that stand beside a result without a parameter, by the rest of their names."""
    beside = {str(key).removeprefix(f"{name}_"): ds[key] for key in ds.data_vars if str(key).startswith(f"{name}_")}
    return {word: float(values) for word, values in beside.items() if not values.dims}


def _remark(ds: xr.Dataset, name: str) -> str:
    """Return why a result has no derivatives; "" where it has."""
    status = ds[f"{name}_status"]
    word = str(status.attrs["flag_meanings"]).split()[int(status)]
    return "" if word == "ok" else f": no derivatives ({word})"
