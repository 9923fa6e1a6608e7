"""Tables of links as beams: their worst stress, and their safety."""

from __future__ import annotations

from collections.abc import Iterator

import xarray as xr

from linksweep.tables.cells import finite_or_inf, handy_unit
from linksweep.tables.table import Part, Row, Table

SAFETIES = {"yield": "yield_safety", "Goodman": "goodman_safety", "Soderberg": "soderberg_safety"}


def strength_parts(ds: xr.Dataset) -> Iterator[Part]:
    """Yield the table of links: the worst stress with its place and angle, the safeties, and a life if there is one."""
    unit, size = handy_unit(ds["stress"])
    buckling = ds["buckling_safety"].min("plane").values
    rows: list[Row] = []
    for k, link in enumerate(ds["link"].values):
        one = {
            name: float(ds[name].values[k]) for name in ("stress", "stress_section", "stress_at", *SAFETIES.values())
        }
        place = (f"{100.0 * one['stress_section']:.1f}", f"{one['stress_at']:.1f}")
        safeties = (finite_or_inf(value) for value in (*(one[name] for name in SAFETIES.values()), float(buckling[k])))
        life = (finite_or_inf(float(ds["life"].values[k])),) if "life" in ds else ()
        rows.append((str(link), finite_or_inf(one["stress"] / size), *place, *safeties, *life))
    of_life = ("life [cycles]",) if "life" in ds else ()
    header = ("link", f"stress [{unit}]", "at [%]", "at [°]", *SAFETIES, "buckling", *of_life)
    yield Table(header, rows, right=range(1, len(header)))
