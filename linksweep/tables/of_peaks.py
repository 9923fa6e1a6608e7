"""Results as text for a terminal."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping
from math import prod
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.text_table import aligned
from linksweep.mechanisms import Mechanism
from linksweep.scene.curves.interpolation import RINGING

JAMS = ("jam_start", "jam_end", "jam_place")
"""Findings on the arcs on which friction jams a slide of a linkage."""


ENDS = ("min", "max")
"""Extremes of a transmission angle, as the names of their findings end."""


def peak_table(ds: xr.Dataset, machine: Mechanism) -> str:
    """Return the peaks of a scene as a table: quantity, value, unit, angle; of a batch, the worst design of each."""
    rows = [("quantity", "value", "unit", f"at {machine.index}", *(f"worst {dim}" for dim in ds.sizes))]
    for name in map(str, ds.data_vars):
        if f"{name}_at" in ds or name.endswith(("_mean", "_rms")):
            rows.append(_row(ds, name))
    return "\n".join([*aligned(rows), *_remarks(ds, machine)])


def _row(ds: xr.Dataset, name: str) -> tuple[str, ...]:
    values = ds[name]
    place = _worst(values)
    angle = f"{_number(ds[f'{name}_at'], place):.2f}°" if f"{name}_at" in ds else ""
    labels = (_label(ds, dim, place.get(dim)) for dim in ds.sizes)
    return name, f"{_number(values, place):.6g}", _unit(values), angle, *labels


def _number(values: xr.DataArray, place: Mapping[Any, int]) -> float:
    """Return the number at a place, of an array over some of its dims; in numpy, since xarray would import dask."""
    return float(values.values[tuple(place[dim] for dim in values.dims)])


def _worst(values: xr.DataArray) -> Mapping[Any, int]:
    """Place of the largest value of a maximum, the least of a minimum, the largest magnitude of all else."""
    name = str(values.name)
    size = values.values  # in numpy: xarray's arithmetic would import dask
    size = size if name.endswith("_max") else -size if name.endswith("_min") else np.abs(size)
    place = np.unravel_index(np.argmax(np.where(np.isfinite(size), size, -np.inf)), size.shape)
    return dict(zip(values.dims, map(int, place), strict=True))


def _label(ds: xr.Dataset, dim: Hashable, k: Any) -> str:
    if k is None:
        return "any"
    value = ds[dim].values[int(k)] if dim in ds.coords else int(k)
    return f"{value:.6g}" if isinstance(value, float | np.floating) else str(value)


def _unit(values: xr.DataArray) -> str:
    return str(values.attrs["units"])


def _remarks(ds: xr.Dataset, machine: Mechanism) -> list[str]:
    """Return the meaning of the status of peaks in sentences, where it is not ok throughout."""
    status = np.asarray(ds.status.values).reshape(-1)
    partly, never, unbounded = (int((status == k).sum()) for k in (1, 2, 3))
    who, which = "It does", ""
    if status.size > 1:
        who, which = f"{partly} of {status.size} designs do", f" of {unbounded} of {status.size} designs"
    infinite = "grows without bound at a toggle, where it wedges or at a dead centre: its peak is inf."
    lines = {
        f"{who} not {machine.runs} all the way round: peaks are those of the {machine.spot}s that are ok.": partly,
        f"{never} of {status.size} designs: no result at any {machine.spot}, {machine.round_meanings[2]}.": never,
        f"Some quantity{which} {infinite}": unbounded,
    }
    remarks = [line for line, count in lines.items() if count]
    return ["", *remarks] if remarks else []


def study_report(ds: xr.Dataset, machine: Mechanism) -> str:
    """Return a summary of a study: the worst and the best design of each peak, and the number of designs by status."""
    text = peak_table(ds, machine)
    if not ds.sizes:
        return text
    rows = [_best(ds, name) for name in map(str, ds.data_vars) if name.endswith("_peak")]
    header = ("quantity", "least peak", "unit", *(f"best {dim}" for dim in ds.sizes))
    tables = [text, "", *aligned([header, *filter(None, rows)]), ""] if any(rows) else [text, ""]
    shape = ", ".join(f"{dim} {n}" for dim, n in ds.sizes.items())
    designs = prod(ds.sizes.values())
    counts = np.bincount(ds.status.values.reshape(-1)) * (designs // ds.status.size)
    counts_text = ", ".join(f"{word} {n}" for word, n in zip(_words(ds.status), counts, strict=False) if n)
    return "\n".join([*tables, f"designs: {designs} ({shape}): {counts_text}"])


def _best(ds: xr.Dataset, name: str) -> tuple[str, ...]:
    """Return a peak where it is least, of the designs that are ok all the way round; empty where there is none."""
    values = ds[name].where(ds.status == 0)
    size = values.where(np.isfinite(values), np.inf)
    if not np.isfinite(size).any():
        return ()
    place = size.argmin(...)
    labels = (_label(ds, dim, place.get(dim)) for dim in ds.sizes)
    return name, f"{float(size.min()):.6g}", _unit(ds[name]), *labels


def check_lines(ds: xr.Dataset) -> list[str]:
    """Return the findings of a check, a line for each."""
    lines: Iterable[tuple[str, str]]
    if "grashof" not in ds:
        of_pins = [*_of_pins(ds)]
        others = [str(name) for name in ds.data_vars if name not in ("overshoot", *JAMS)]
        others = [name for name in others if not (of_pins and name.startswith("transmission_angle"))]
        lines = (*((name.replace("_", " "), _summary(ds[name])) for name in others), *of_pins, *_of_jams(ds))
    else:
        lines = (*(_of_a_batch(ds) if ds.arc_start.ndim > 1 else _of_one(ds)), *_of_acceleration(ds))
    lines = (*lines, *_of_splines(ds))
    width = max(26, *(len(f"{title}: ") for title, _ in lines))
    return [f"{title + ':':<{width}}{text}" for title, text in lines]


def _of_pins(ds: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Yield the range of the transmission angle at each pin of one design, with its crank angles where it changes."""
    if "transmission_angle_min_at" not in ds or ds.transmission_angle_min.dims != ("pin",):
        return
    for pin in ds.pin.values:
        one = ds.sel(pin=pin)
        ends = [(float(one[f"transmission_angle_{end}"]), float(one[f"transmission_angle_{end}_at"])) for end in ENDS]
        texts = [f"{value:.6g}° at {at:.6g}°" if np.isfinite(at) else f"{value:.6g}°" for value, at in ends]
        if np.isfinite(ends[0][0]):
            yield f"transmission angle of {pin}", " to ".join(dict.fromkeys(texts))


def _of_jams(ds: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Yield where friction jams a slide: the arcs of one design, or the number of designs."""
    if not ds.keys() >= {*JAMS}:
        return
    start, end, place = (ds[name] for name in JAMS)
    if start.ndim == 1:
        words = _words(place)
        arcs = (
            f"{a:.4f}° to {b:.4f}° ({words[k]})" for a, b, k in zip(start.values, end.values, place.values, strict=True)
        )
        yield "friction jams from", " and ".join(arcs) or "nowhere"
    else:
        jammed = start.notnull().any("jam")
        yield "friction jams", f"{int(jammed.sum())} of {jammed.size} designs"


def _of_splines(ds: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Yield the splines through loads that ring."""
    ringing = ds.overshoot.where(ds.overshoot > RINGING, drop=True) if "overshoot" in ds else ()
    for overshoot in ringing:
        yield "a spline rings", f"{overshoot.spline.item()} by {100.0 * float(overshoot):.2g} % of its range"


def _summary(finding: xr.DataArray) -> str:
    """Return a finding in words: the number of designs with each meaning, or the range of its values."""
    if "flag_meanings" in finding.attrs:
        words, counts = _words(finding), np.bincount(finding.values.reshape(-1))
        counted = [(word, n) for word, n in zip(words, counts, strict=False) if n]
        return counted[0][0] if finding.size == 1 else ", ".join(f"{word} {n}" for word, n in counted)
    unit = {"degree": "°", "1": ""}.get(_unit(finding), f" {_unit(finding)}")
    ends = [f"{value:.6g}{unit}" for value in np.unique(finding.values[np.isfinite(finding.values)])]
    if len(ends) > 4:
        return f"{ends[0]} to {ends[-1]}"
    return ", ".join(_labelled(finding, unit) or ends) or "none"


def _labelled(finding: xr.DataArray, unit: str) -> list[str]:
    """Return the values of one design, each with its label where they have labels."""
    if finding.ndim != 1 or finding[finding.dims[0]].dtype.kind != "U":
        return []
    pairs = zip(finding.values, finding[finding.dims[0]].values, strict=True)
    return [f"{value:.6g}{unit} ({str(label).replace('_', ' ')})" for value, label in pairs if np.isfinite(value)]


def _of_acceleration(ds: xr.Dataset) -> Iterator[tuple[str, str]]:
    if "alpha2_difference" in ds:
        worst, at = (_summary(ds[f"alpha2_difference{end}"]) for end in ("", "_at"))
        yield "alpha2", f"differs from that of omega2 by up to {worst}, at {at}"


def _of_one(ds: xr.Dataset) -> Iterator[tuple[str, str]]:
    ends = zip(ds.arc_start.values, ds.arc_end.values, strict=True)
    arcs = [f"{start:.4f}° to {end:.4f}°" for start, end in ends if np.isfinite(start)]
    angles = zip(ds.toggle.values, ds.toggle_angle.values, strict=True)
    toggles = [f"{angle:.4f}° ({str(name).replace('_', ', ')})" for name, angle in angles if np.isfinite(angle)]
    yield "Grashof class", _words(ds.grashof)[int(ds.grashof)]
    yield "can be assembled", _words(ds.assembly)[int(ds.assembly)]
    yield "at theta2 from", " and ".join(arcs) or "nowhere"
    yield "toggles at theta2", ", ".join(toggles) or "none"
    yield "least transmission angle", f"{float(ds.transmission_angle_min):.4f}°"


def _of_a_batch(ds: xr.Dataset) -> Iterator[tuple[str, str]]:
    design = ds.arc_start.isel(arc=0)
    yield "designs", f"{design.size} ({', '.join(f'{dim} {n}' for dim, n in design.sizes.items())})"
    for title, flag in (("Grashof class", ds.grashof), ("can be assembled", ds.assembly)):
        words, values = _words(flag), flag.broadcast_like(design).values
        counts = np.bincount(values.reshape(-1), minlength=len(words))
        yield title, ", ".join(f"{word} {n}" for word, n in zip(words, counts, strict=True) if n)
    least = ds.transmission_angle_min.min()  # where there is one
    if np.isfinite(least):
        yield "least transmission angle", f"{float(least):.4f}°"


def _words(flag: xr.DataArray) -> list[str]:
    """Return the meanings of a flag's values."""
    return str(flag.attrs["flag_meanings"]).replace("_", "-").split()
