"""The findings of a check as a table: a line for each, in words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from linksweep.scene.curves.interpolation import RINGING
from linksweep.tables.cells import digits, fixed, in_words, unit_of, with_unit, words
from linksweep.tables.table import Table

JAMS = ("jam_start", "jam_end", "jam_place")
"""Findings on the arcs on which friction jams a slide of a linkage."""
ENDS = ("min", "max")
"""Extremes of a transmission angle, as the names of their findings end."""
TITLES = {
    "assembly": "can be assembled",
    "fails_at": "does not close at",
    "arc_start": "at theta2 from",
    "arc_end": "to",
    "toggle_angle": "toggles at theta2",
    "dead_centre_angle": "dead centres at theta2",
    "reversal_angle": "reverses at theta2",
    "transmission_angle_min": "least transmission angle",
    "transmission_angle_max": "largest transmission angle",
    "jam_angle": "friction jams at theta2",
    "friction_to_jam": "least friction that jams",
}
"""Titles of findings; others have their names."""
WIDTH = 24
"""Characters of the titles' column, at least."""

Line = tuple[str, str]


def check_table(ds: xr.Dataset) -> Table:
    """Return the findings of a check, a row for each."""
    return Table((), [(f"{title}:".ljust(WIDTH), text) for title, text in _lines(ds)], right=())


def _lines(ds: xr.Dataset) -> Iterator[Line]:
    if "grashof" not in ds:
        of_pins = [*_of_pins(ds)]
        left_out = {"overshoot", *JAMS} | (set() if "fails_at" in ds and ds.fails_at.any() else {"fails_at"})
        others = [str(name) for name in ds.data_vars if name not in left_out]
        others = [name for name in others if not (of_pins and name.startswith("transmission_angle"))]
        yield from (line for name in others for line in _finding(ds, name))
        yield from of_pins
        yield from _of_jams(ds)
    else:
        yield from _of_a_batch(ds) if ds.arc_start.ndim > 1 else _of_one(ds)
        yield from _of_acceleration(ds)
    yield from _of_splines(ds)


def _finding(ds: xr.Dataset, name: str) -> Iterator[Line]:
    """Yield a finding; the two ends of the arcs of one design are one line."""
    if name == "arc_start" and ds.arc_start.ndim == 1:
        yield TITLES[name], _arcs(ds)
    elif name != "arc_end" or ds.arc_end.ndim > 1:
        yield TITLES.get(name, name.replace("_", " ")), _summary(ds[name])


def _arcs(ds: xr.Dataset) -> str:
    """Return the arcs on which one design can be assembled."""
    ends = zip(ds.arc_start.values, ds.arc_end.values, strict=True)
    arcs = [f"{fixed(start, 4)}° to {fixed(end, 4)}°" for start, end in ends if np.isfinite(start)]
    return " and ".join(arcs) or "nowhere"


def _of_pins(ds: xr.Dataset) -> Iterator[Line]:
    """Yield the range of the transmission angle at each pin of one design, with its crank angles where it changes."""
    if "transmission_angle_min_at" not in ds or ds.transmission_angle_min.dims != ("pin",):
        return
    for pin in ds.pin.values:
        one = ds.sel(pin=pin)
        ends = [(float(one[f"transmission_angle_{end}"]), float(one[f"transmission_angle_{end}_at"])) for end in ENDS]
        texts = [f"{digits(value)}°" + (f" at {fixed(at, 4)}°" if np.isfinite(at) else "") for value, at in ends]
        if np.isfinite(ends[0][0]):
            yield f"transmission angle of {pin}", " to ".join(dict.fromkeys(texts))


def _of_jams(ds: xr.Dataset) -> Iterator[Line]:
    """Yield where friction jams a slide: the arcs of one design, or the number of designs."""
    if not ds.keys() >= {*JAMS}:
        return
    start, end, place = (ds[name] for name in JAMS)
    if start.ndim == 1:
        names = words(place)
        jams = zip(start.values, end.values, place.values, strict=True)
        arcs = (f"{fixed(a, 4)}° to {fixed(b, 4)}° ({names[k]})" for a, b, k in jams)
        yield "friction jams from", " and ".join(arcs) or "nowhere"
    else:
        jammed = start.notnull().any("jam")
        yield "friction jams", f"{int(jammed.sum())} of {jammed.size} designs"


def _of_splines(ds: xr.Dataset) -> Iterator[Line]:
    """Yield the splines through loads that ring."""
    ringing = ds.overshoot.where(ds.overshoot > RINGING, drop=True) if "overshoot" in ds else ()
    for overshoot in ringing:
        yield "a spline rings", f"{overshoot.spline.item()} by {100.0 * float(overshoot):.2g} % of its range"


def _summary(finding: xr.DataArray) -> str:
    """Return a finding in words: the number of designs with each meaning, or the range of its values."""
    if "flag_meanings" in finding.attrs:
        return in_words(finding)
    units = unit_of(finding)
    ends = np.unique(finding.values[np.isfinite(finding.values)])
    if len(ends) > 4:
        return f"{with_unit(ends[0], units)} to {with_unit(ends[-1], units)}"
    return ", ".join(_labelled(finding) or (with_unit(value, units) for value in ends)) or "none"


def _labelled(finding: xr.DataArray) -> list[str]:
    """Return the values of one design, each with its label where they have labels."""
    if finding.ndim != 1 or finding[finding.dims[0]].dtype.kind != "U":
        return []
    pairs = zip(finding.values, finding[finding.dims[0]].values, strict=True)
    units = unit_of(finding)
    return [f"{with_unit(value, units)} ({str(name).replace('_', ' ')})" for value, name in pairs if np.isfinite(value)]


def _of_acceleration(ds: xr.Dataset) -> Iterator[Line]:
    if "alpha2_difference" in ds:
        worst, at = (_summary(ds[f"alpha2_difference{end}"]) for end in ("", "_at"))
        yield "alpha2", f"differs from that of omega2 by up to {worst}, at {at}"


def _of_one(ds: xr.Dataset) -> Iterator[Line]:
    angles = zip(ds.toggle.values, ds.toggle_angle.values, strict=True)
    toggles = [f"{fixed(angle, 4)}° ({str(name).replace('_', ', ')})" for name, angle in angles if np.isfinite(angle)]
    yield "Grashof class", words(ds.grashof)[int(ds.grashof)]
    yield "can be assembled", words(ds.assembly)[int(ds.assembly)]
    yield "at theta2 from", _arcs(ds)
    yield "toggles at theta2", ", ".join(toggles) or "none"
    yield "least transmission angle", f"{fixed(float(ds.transmission_angle_min), 4)}°"


def _of_a_batch(ds: xr.Dataset) -> Iterator[Line]:
    design = ds.arc_start.isel(arc=0)
    yield "designs", f"{design.size} ({', '.join(f'{dim} {n}' for dim, n in design.sizes.items())})"
    for title, flag in (("Grashof class", ds.grashof), ("can be assembled", ds.assembly)):
        names, values = words(flag), flag.broadcast_like(design).values
        counts = np.bincount(values.reshape(-1), minlength=len(names))
        yield title, ", ".join(f"{word} {n}" for word, n in zip(names, counts, strict=True) if n)
    least = ds.transmission_angle_min.min()  # where there is one
    if np.isfinite(least):
        yield "least transmission angle", f"{fixed(float(least), 4)}°"
