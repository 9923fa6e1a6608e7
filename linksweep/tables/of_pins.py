"""Tables of pins: their bearings, and the sources of a force."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from linksweep.analysis.pins.bearing_life import UNBOUNDED
from linksweep.tables.cells import finite_or_inf, fixed, handy_unit, unit_of
from linksweep.tables.table import Part, Row, Table

BEARING = {
    "largest": "F_peak",
    "mean": "F_mean",
    "equivalent": "equivalent_load",
    "turns": "rotation",
    "pressure": "pressure_peak",
    "PV of samples": "pv",
    "L10h": "L10h",
}
"""Columns of a pin, and their variables."""


def bearing_parts(ds: xr.Dataset) -> Iterator[Part]:
    """Yield the table of bearings, a line for each pin, with the reason why a life is not of a whole cycle."""
    dim = str(ds["life_status"].dims[-1]) if ds["life_status"].dims else "pin"
    columns = dict(_column(ds, dim, title, name) for title, name in BEARING.items() if name in ds)
    columns = {title: column for title, column in columns.items() if not np.isnan(column).all()}
    status = ds["life_status"]
    words = [word.replace("_", " ") for word in str(status.attrs["flag_meanings"]).split()]
    of_pins = np.broadcast_to(status.values, ds.sizes[dim])
    rows: list[Row] = []
    for k, pin in enumerate(ds[dim].values):
        numbers = (finite_or_inf(float(column[k])) for column in columns.values())
        rows.append((str(pin), *numbers, words[of_pins[k]] if of_pins[k] else ""))
    header = (dim, *columns, "status")
    cut = len(header) if of_pins.any() else len(header) - 1
    yield Table(header[:cut], [row[:cut] for row in rows], right=range(1, len(columns) + 1))


def choice_parts(ds: xr.Dataset) -> Iterator[Part]:
    """Yield the table of chosen bearings, a line for each pin: its loads, the ratings that it needs, the bearing."""
    columns = {"largest": "F_peak", "equivalent": "equivalent_load", "C ≥": "required_capacity"}
    columns |= {"C0 ≥": "required_static_capacity"}
    loads = {f"{title} [{unit_of(ds[name])}]": ds[name].values for title, name in columns.items()}
    numbers = [[finite_or_inf(float(load[k])) for load in loads.values()] for k in range(ds.sizes["pin"])]
    header: Row = ("pin", *loads)
    rows = [(str(pin), *cells) for pin, cells in zip(ds["pin"].values, numbers, strict=True)]
    if "choice" in ds:  # of rollers there is no catalogue
        unit, size = ("mm", 1e-3) if unit_of(ds["bore"]) == "m" else (unit_of(ds["bore"]), 1.0)
        header += ("bearing", f"size [{unit}]", "L10h [h]", "s0")
        rows = [(*row, *_chosen(ds, k, size)) for k, row in enumerate(rows)]
    yield Table(header, rows, right=(1, 2, 3, 4, 7, 8))


def _chosen(ds: xr.Dataset, k: int, unit: float) -> Row:
    """Return designation, size, life and static safety of the bearing in a pin."""
    name = str(ds["choice"].attrs["flag_meanings"]).split()[int(ds["choice"].values[k])]
    size = [float(ds[each].values[k]) / unit for each in ("bore", "outside", "width")]
    text = "" if np.isnan(size).any() else " × ".join(f"{each:.4g}" for each in size)
    return name, text, *(finite_or_inf(float(ds[each].values[k])) for each in ("L10h", "static_safety"))


def _column(ds: xr.Dataset, dim: str, title: str, name: str) -> tuple[str, np.ndarray]:
    """Return the title of a column with its unit, and a number for each pin, of samples the largest."""
    values = ds[name]
    unit, size = handy_unit(values)
    if "theta2" in values.dims:
        values = values.max("theta2")
        values = values.where((ds["life_status"] != UNBOUNDED) | values.isnull(), np.inf)
    return f"{title} [{unit}]", np.broadcast_to(values.values, ds.sizes[dim]) / size


def share_parts(ds: xr.Dataset) -> Iterator[Part]:
    """Yield, for each force, the table of its sources at its worst angle, the largest first, and their sum."""
    for name in map(str, ds.data_vars):
        if "source" in ds[name].dims:
            shares = ds[name].broadcast_like(ds["theta2"])
            size = np.abs(shares.sum("source", skipna=False).values)
            if not np.isnan(size).all():
                yield _share_table(shares.isel(theta2=int(np.nanargmax(size))), size.size)


def _share_table(shares: xr.DataArray, count: int) -> Table:
    values, name = shares.values, str(shares.name)
    whole, size = float(values.sum()), float(np.abs(values).max()) or 1.0
    order = np.argsort(-np.abs(values), kind="stable")
    sources = {str(shares["source"].values[k]): float(values[k]) for k in order if values[k]}
    rows: list[Row] = []
    for source, share in {**sources, "all together": whole}.items():
        part = f"{fixed(100.0 * share / whole, 1)} %" if abs(whole) > 1e-9 * size else ""
        rows.append((source, f"{share:.5g}", part))
    of_samples = f", largest of {count} samples" if count > 1 else ""
    title = f"{name} at theta2 = {fixed(float(shares.theta2), 2)}°{of_samples}"
    header = (title, f"share [{unit_of(shares)}]", "of the whole")
    return Table(header, rows, right=(1, 2))
