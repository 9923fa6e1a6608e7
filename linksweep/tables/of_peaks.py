"""Peaks as a table: of one design, of the worst of many, and of the best of a study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import prod
from typing import Any

import numpy as np
import xarray as xr

from linksweep.chains.rows.beams import SECTION
from linksweep.mechanisms import Mechanism
from linksweep.tables.cells import (
    at,
    counts_of_words,
    digits,
    fixed,
    label,
    meanings,
    place_of_worst,
    plain_unit,
    unit_of,
)
from linksweep.tables.of_balance import ROUNDING
from linksweep.tables.table import Part, Row, Table

ANGLE, SIGNED = "transmission_angle", "_signed"
"""Beginning of the names of angles of which the largest minimum is the best, and the word of those with a sign."""


def peak_parts(ds: xr.Dataset, machine: type[Mechanism] | Mechanism) -> Iterator[Part]:
    """Yield the table of peaks: quantity, value, unit, angle; of a batch, the worst design of each; and remarks."""
    names = [str(name) for name in ds.data_vars if f"{name}_at" in ds or str(name).endswith(("_mean", "_rms"))]
    places = (f"at {dim}" if dim == SECTION else f"worst {dim}" for dim in ds.sizes)
    header = ("quantity", "value", "unit", f"at {machine.index}", *places)
    yield Table(header, [_row(ds, name) for name in names], meanings=meanings(ds))
    yield "\n".join(_remarks(ds, machine))


def study_parts(ds: xr.Dataset, machine: type[Mechanism] | Mechanism) -> Iterator[Part]:
    """Yield the tables of a study: the worst and the best design of each peak, the designs of the largest transmission
    angles, and the number of designs by status."""
    if SECTION in ds.status.dims:
        ds = ds.assign(status=ds.status.max(SECTION, keep_attrs=True))
    yield from peak_parts(ds, machine)
    sizes = {dim: n for dim, n in ds.sizes.items() if dim != SECTION}
    if not sizes:
        return
    names = [str(name) for name in ds.data_vars if SIGNED not in str(name)]
    angles = [name for name in names if name.startswith(ANGLE) and name.endswith("_min")]
    peaks = [name for name in names if name.endswith("_peak") and not name.startswith(ANGLE)]
    for title, each, sign in (("least peak", peaks, 1.0), ("largest", angles, -1.0)):
        rows = [_best(ds, name, sign) for name in each]
        header = ("quantity", title, "unit", *(f"best {dim}" for dim in sizes))
        yield Table(header, [*filter(None, rows)], meanings=meanings(ds))
    shape = ", ".join(f"{dim} {n}" for dim, n in sizes.items())
    designs = prod(sizes.values())
    shared = designs // (ds.status.size or 1)
    counts_text = ", ".join(f"{word} {n * shared}" for word, n in counts_of_words(ds.status).items())
    yield f"designs: {designs} ({shape}): {counts_text or 'none'}"


def _row(ds: xr.Dataset, name: str) -> Row:
    values = ds[name]
    if np.isnan(values.values).all():
        return name, "none", "", "", *("" for _ in ds.sizes)
    place = place_of_worst(values)
    angle = f"{fixed(at(ds[f'{name}_at'], place), 2)}°" if f"{name}_at" in ds else ""
    labels = (label(ds, dim, place.get(dim)) for dim in ds.sizes)
    return name, digits(_without_rounding(ds, name, place)), plain_unit(values), angle, *labels


def _without_rounding(ds: xr.Dataset, name: str, place: Mapping[Any, int]) -> float:
    """Return an extreme at a place; 0 where it is only rounding beside the largest magnitude of its unit there."""
    value, peaks = at(ds[name], place), [values for key, values in ds.data_vars.items() if str(key).endswith("_peak")]
    alike = [peak for peak in peaks if unit_of(peak) == unit_of(ds[name]) and {*peak.dims} <= {*place}]
    largest = np.fmax.reduce([0.0, *(at(peak, place) for peak in alike)])
    return 0.0 if abs(value) <= ROUNDING * largest < np.inf else value


def _remarks(ds: xr.Dataset, machine: type[Mechanism] | Mechanism) -> list[str]:
    """Return the meaning of the status of peaks in sentences, where it is not ok throughout."""
    status = np.asarray(ds.status.values).reshape(-1)
    partly, never, unbounded = (int((status == k).sum()) for k in (1, 2, 3))
    who, which, none = "It does", "", "It has"
    if status.size > 1:
        who, which = f"{partly} of {status.size} designs do", f" of {unbounded} of {status.size} designs"
        none = f"{never} of {status.size} designs have"
    infinite = "grows without bound at a toggle, where it wedges or at a dead centre: its peak is inf."
    lines = {
        f"{who} not {machine.runs} all the way round: peaks are those of the {machine.spot}s that are ok.": partly,
        f"{none} no result at any {machine.spot}: {machine.round_meanings[2].replace('_', ' ')}.": never,
        f"Some quantity{which} {infinite}": unbounded,
    }
    ends = [str(name).removesuffix("_at_end") for name in ds.data_vars if _at_an_end(ds, str(name))]
    beyond = f"At an end of the part, beyond which there may be more: {', '.join(ends)}."
    return [*(line for line, count in lines.items() if count), *([beyond] if ends else [])]


def _at_an_end(ds: xr.Dataset, name: str) -> bool:
    """Return whether a variable says of an extreme that it stands at an end of a part, in some design."""
    return name.endswith("_at_end") and bool(ds[name].isin((1, 2)).any())


def _best(ds: xr.Dataset, name: str, sign: float) -> Row:
    """Return a result where it is least, with sign −1 largest, of the designs that are ok all the way round, along a
    link its largest; empty where there is none."""
    values = sign * ds[name].where(ds.status == 0)
    values = values.max(SECTION) if SECTION in values.dims else values
    size = values.where(np.isfinite(values), np.inf)
    if not np.isfinite(size).any():
        return ()
    place = size.argmin(...)
    labels = (label(ds, dim, place.get(dim)) for dim in ds.sizes if dim != SECTION)
    return name, digits(sign * float(size.min())), plain_unit(ds[name]), *labels
