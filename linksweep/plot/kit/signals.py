"""Signals of a cycle for plots: one design, sorted by crank angle, closed to a full turn, with its gaps."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.validate import one_text_problems, refuse
from linksweep.chains.between_links import force_name, pair_of, reaction
from linksweep.plot.kit.drawings import drawing_of_results, efforts
from linksweep.results.compute import require_results
from linksweep.scene.grid import whole_turns
from linksweep.scene.shown_units import UnitSystem
from linksweep.tables.cells import digits
from linksweep.tables.cells import number as number

INDEX = "theta2"
WHOLE_TURN = "whole_turn"  # attribute of a cycle whose angles are no even grid, though they go all the way round
MOST_LINES = 6  # designs that one plot still tells apart
MOST_LABELS = 8  # forces whose labels all find room


class Gap(NamedTuple):
    """Crank angles [degree] between which there is no result, and the reason."""

    start: float
    stop: float
    reason: str

    @property
    def width(self) -> float:
        return self.stop - self.start


class Peak(NamedTuple):
    """The largest value of a signal: crank angle [degree], value, and whether the cycle has a gap or a pole beside
    it."""

    angle: float
    value: float
    beside_gap: bool


def components(ds: xr.Dataset, pin: str) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the components x and y of a pin force; of F23 as well where the Dataset has only F32."""
    _known_force(ds, pin)
    for name, sign in ((pin, 1.0), (reaction(pin), -1.0)):
        if f"{name}x" in ds and f"{name}y" in ds:
            x, y = (ds[f"{name}{axis}"] for axis in "xy")
            return x.copy(data=x.data * sign), y.copy(data=y.data * sign)  # older xarray drops attributes of a product
    raise ValueError(f"the Dataset has no {pin}x and {pin}y: sweep with of=[..., {pin + 'x'!r}, {pin + 'y'!r}]")


def magnitude(ds: xr.Dataset, pin: str) -> xr.DataArray:
    """Return the magnitude of a pin force: the Dataset's own, or from its components."""
    _known_force(ds, pin)
    for name in (pin, reaction(pin)):
        if name in ds:
            return ds[name]
    x, y = components(ds, pin)
    return xr.apply_ufunc(np.hypot, x, y, keep_attrs=True)


def has_pin(ds: xr.Dataset, pin: str) -> bool:
    return any(name in ds or (f"{name}x" in ds and f"{name}y" in ds) for name in (pin, reaction(pin)))


def force_named(ds: xr.Dataset, name: str) -> str:
    """Return the name of a force, or of the one in a pin: "B" is F32."""
    refuse(one_text_problems("of", name, "the name of a force, such as F32"))
    joints = drawing_of_results(ds).joints
    return force_name(*joints[name]) if name in joints else name


def _known_force(ds: xr.Dataset, pin: str) -> None:
    known = drawing_of_results(ds).joint_of
    if pin not in known:
        raise ValueError(f"of = {pin!r}: must be one of {', '.join(known)}")


def drive_name(ds: xr.Dataset) -> str:
    """Return the drive's torque or force: the scene states which, for a T14 may be the moment of a guide."""
    names = efforts(ds)
    for name in names:
        if name in ds:
            return name
    raise ValueError(f"the Dataset has no {' nor '.join(names)}: sweep with of=[..., {names[0]!r}]")


def unit(signal: xr.DataArray, default: str) -> str:
    return signal.attrs.get("units", default)


def require_angles(ds: xr.Dataset) -> None:
    drawing_of_results(ds)  # which refuses mechanisms that there are no plots of
    require_results(ds, "ls.sweep")
    if INDEX not in ds.dims:
        raise ValueError("the Dataset has no dimension theta2: plots over the revolution take what ls.sweep returns")


def require_one_design(signals: Iterable[xr.DataArray]) -> None:
    """Raise ValueError where signals have other dims than theta2."""
    sizes = {dim: n for signal in signals for dim, n in signal.sizes.items() if dim != INDEX}
    over = ", ".join(f"{dim} ({n})" for dim, n in sizes.items())
    choice = f"choose it, such as ds.isel({dict.fromkeys(sizes, 0)})"  # names such as coupler.length are no keywords
    refuse([f"there are several designs, over {over}: a plot shows one; {choice}"] if sizes else [])


def designs(signal: xr.DataArray, system: UnitSystem) -> dict[str, dict[str, int]]:
    """Return the place of each design of a signal by its label: one, or up to six along one dim.

    Raises ValueError for more. Labels are in the units in which results are shown.
    """
    extra = [dim for dim in signal.dims if dim != INDEX]
    if len(extra) != 1 or signal.sizes[extra[0]] > MOST_LINES:
        require_one_design([signal])
        return {"": {}}
    dim = str(extra[0])
    labels = signal[dim].values  # positions where the dim has no coordinate
    units = signal[dim].attrs.get("units", "") if dim in signal.coords else ""
    numbers = system.value(labels, units) if labels.dtype.kind == "f" else labels
    return {f"{dim} = {label_text(v)} {system.unit(units)}".rstrip(): {dim: k} for k, v in enumerate(numbers)}


def label_text(value: object) -> str:
    """Format the label of a design, a number with six digits at most."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def revolution(ds: xr.Dataset, *signals: xr.DataArray) -> tuple[np.ndarray, ...]:
    """Return angles and signals as arrays, sorted by angle; the grid of a whole cycle ends with its first sample."""
    rows = by_angle(ds, *signals)
    period = ds.attrs.get(WHOLE_TURN) or full_turn(rows[0])
    if period is None:
        return rows
    return (np.append(rows[0], rows[0][0] + period), *(np.append(row, row[0]) for row in rows[1:]))


def by_angle(ds: xr.Dataset, *signals: xr.DataArray) -> tuple[np.ndarray, ...]:
    """Return angles and signals as arrays sorted by angle."""
    angles = ds[INDEX].values.astype(float)
    order = np.argsort(angles, kind="stable")
    return (angles[order], *(spread(signal, len(angles))[order] for signal in signals))


def spread(signal: xr.DataArray, count: int) -> np.ndarray:
    """Return values at every angle, also of a signal that does not depend on it."""
    require_one_design([signal])
    return np.broadcast_to(signal.values.astype(float), (count,))


def full_turn(angles: np.ndarray) -> float | None:
    """Return the whole turns of the crank [degree] that sorted angles divide evenly; None where they divide none."""
    return whole_turns(angles, 360.0) if len(angles) > 2 else None


def gaps(ds: xr.Dataset, signal: xr.DataArray) -> list[Gap]:
    """Return the gaps of a cycle: by the status, NaN where it is masked, or without one by the signal's NaN."""
    status = ds["status"] if "status" in ds else xr.where(np.isnan(signal), 1, 0)
    angles, bad = revolution(ds, status)
    reasons = ds["status"].attrs.get("flag_meanings", "").split() if "status" in ds else []
    bad = np.nan_to_num(bad, nan=len(reasons) or 1)
    edges = np.flatnonzero(np.diff(bad, prepend=0.0, append=0.0) != 0.0)
    intervals = []
    for start, stop in pairwise(edges.tolist()):
        if code := int(bad[start]):
            reason = reasons[code].replace("_", " ") if code < len(reasons) else "no result"
            intervals.append(Gap(angles[max(start - 1, 0)], angles[min(stop, len(angles) - 1)], reason))
    return intervals


def reasons(ds: xr.Dataset, signal: xr.DataArray) -> str:
    """Return the reasons for the gaps of a cycle, each once."""
    return ", ".join(dict.fromkeys(gap.reason for gap in gaps(ds, signal)))


def peak(angles: np.ndarray, values: np.ndarray) -> Peak | None:
    """Return the largest sample, or None where there is no result at all."""
    if np.isnan(values).all():
        return None
    k = int(np.nanargmax(values))
    beside = values[max(k - 1, 0) : k + 2]
    return Peak(float(angles[k]), float(values[k]), bool(np.isnan(beside).any() or np.isinf(values[k])))


def peaks(angles: np.ndarray, values: np.ndarray) -> list[Peak]:
    """Return the largest sample, or every infinite one; none where there is no result at all."""
    poles = [Peak(float(angles[k]), np.inf, True) for k in np.flatnonzero(np.isposinf(values))]
    return poles or [largest for largest in [peak(angles, values)] if largest]


def tip(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the components (x, y) of the largest force; of an infinite one, those beside it, which have its
    direction."""
    sizes = np.hypot(x, y)
    k = int(np.nanargmax(sizes))
    if np.isinf(sizes[k]):
        beside = [j for j in (k - 1, k + 1) if 0 <= j < len(sizes) and np.isfinite(sizes[j])]
        k = max(beside, key=lambda j: float(sizes[j]))
    return np.array([x[k], y[k]])


def scale(rows: Sequence[tuple[np.ndarray, np.ndarray]], peaks: Iterable[Peak | None]) -> float:
    """Return the largest size that a plot of these rows, of angles and values, should show.

    Beside a toggle or a dead centre forces grow without bound, and the largest sample only measures how near the grid
    came to it. Where that sample would flatten all others, the scale is theirs, and larger values are marked as off the
    scale.
    """
    largest = max((float(np.max(np.abs(row), initial=0.0, where=np.isfinite(row))) for _, row in rows), default=0.0)
    usual = max((_largest_away_from_gaps(angles, np.abs(row)) for angles, row in rows), default=0.0)
    runaway = any(peak and peak.beside_gap and abs(peak.value) > 3.0 * usual for peak in peaks)
    return usual if runaway and usual > 0.0 else largest


def _largest_away_from_gaps(angles: np.ndarray, sizes: np.ndarray) -> float:
    """Return the largest of a row without the fifths of each arc before gaps and poles, where forces grow."""
    there = np.isfinite(sizes)
    edges = np.flatnonzero(np.diff(there, prepend=False, append=False)).tolist()
    kept = [0.0]
    for start, stop in zip(edges[::2], edges[1::2], strict=True):
        arc, (first, last) = slice(start, stop), angles[[start, stop - 1]]
        near = (last - first) / 5.0
        low, high = first + near * (start > 0), last - near * (stop < len(sizes))
        kept.append(float(np.max(sizes[arc], initial=0.0, where=(low <= angles[arc]) & (angles[arc] <= high))))
    return max(kept)


def labelled(sizes: Sequence[float]) -> list[bool]:
    """Return which of some forces get a label: all of a few, of many those of at least half of the largest."""
    least = 0.5 * max(sizes, default=0.0) if len(sizes) > MOST_LABELS else 0.0
    return [size >= least for size in sizes]


def angle_text(angle: float) -> str:
    return f"{digits(round(angle, 2), 5)}°".replace("-", "−")


def symbol(name: str) -> str:
    """Return F32 in mathtext, F11_3 with a comma; nothing for a name in words."""
    return f"${name[0]}_{{{name[1:].replace('_', ',')}}}$" if pair_of(name) else ""


def force_symbol(name: str) -> str:
    """Return a force in mathtext, also a shaking force or a component: Fs, F43x, F1_12y with a comma."""
    return f"$F_{{{name[1:].strip('_').replace('_', ',')}}}$"


def drive_kind(name: str) -> str:
    """Return "drive torque", or a name in words without its underscores, "cylinder force"."""
    return "drive torque" if symbol(name) else name.replace("_", " ")
