"""Tables of sensitivities, and of what tolerances do to results."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from linksweep.tables.cells import unit_of
from linksweep.tables.table import Part, Row, Table


def sensitivity_parts(ds: xr.Dataset) -> Iterator[Part]:
    """Yield a table for each result: derivatives and elasticities by parameter, the largest elasticity first."""
    for name in _results(ds, "_derivative"):
        yield f"{name} = {float(ds[name]):.6g} {unit_of(ds[name])}{_remark(ds, name)}"
        slopes, elasticity = (ds[f"{name}_{word}"].values for word in ("derivative", "elasticity"))
        order = np.argsort(-np.nan_to_num(np.abs(elasticity)), kind="stable")
        rows: list[Row] = [
            (
                str(ds["parameter"].values[k]),
                f"{elasticity[k]:+.3f}",
                f"{slopes[k]:.5g}",
                f"{unit_of(ds[name])} per {ds['parameter_unit'].values[k]}",
            )
            for k in order
        ]
        yield Table(("parameter", "% per %", "derivative", ""), rows, right=(1, 2))


def tolerance_parts(ds: xr.Dataset) -> Iterator[Part]:
    """Yield a table for each result: its spread, and the share of each parameter, the largest first."""
    for name in _results(ds, "_share"):
        unit, value = unit_of(ds[name]), float(ds[name])
        yield f"{name} = {value:.6g} {unit}, sigma {float(ds[f'{name}_sigma']):.3g} {unit}{_remark(ds, name)}"
        numbers = {word: float(ds[f"{name}_{word}"]) for word in ("worst_least", "worst_largest")}
        yield f"worst case, linear: {numbers['worst_least']:.6g} to {numbers['worst_largest']:.6g} {unit}"
        if f"{name}_drawn_sigma" in ds:
            sigma, least, most = (float(ds[f"{name}_drawn_{word}"]) for word in ("sigma", "least", "largest"))
            yield f"drawn designs, exact: sigma {sigma:.3g}, {least:.6g} to {most:.6g} {unit}"
        share, lower, upper = (ds[f"{name}_{word}"].values for word in ("share", "lower", "upper"))
        rows: list[Row] = [
            (str(ds["parameter"].values[k]), f"{100.0 * share[k]:.1f} %", f"{lower[k]:+.3g}", f"{upper[k]:+.3g}", unit)
            for k in np.argsort(-np.nan_to_num(share), kind="stable")
        ]
        yield Table(("parameter", "of the variance", "at lower", "at upper limit", ""), rows, right=(1, 2, 3))


def _results(ds: xr.Dataset, ending: str) -> list[str]:
    return [str(key).removesuffix(ending) for key in ds.data_vars if str(key).endswith(ending)]


def _remark(ds: xr.Dataset, name: str) -> str:
    """Return why a result has no derivatives; "" where it has."""
    status = ds[f"{name}_status"]
    word = str(status.attrs["flag_meanings"]).split()[int(status)]
    return "" if word == "ok" else f": no derivatives ({word})"
