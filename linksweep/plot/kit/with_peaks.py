"""Cycle for plots, with additional samples at the exact peaks of its scene, so that plots mark these.

Peaks lie between samples, and a sample at a jump has the value of one side at most. A cycle of one design holds its
scene: so the angles of the exact peaks of all pins and of the drive are added to it, with one just before and one just
after each.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.degrees import signed_distance
from linksweep.engine.quantity import opposite_of
from linksweep.files.netcdf import scene_of
from linksweep.plot.kit.signals import INDEX, WHOLE_TURN, full_turn, require_angles
from linksweep.results.compute import angles_missing
from linksweep.results.origin.in_shown_units import results_in_shown_units
from linksweep.results.peak_search.paths import Part
from linksweep.results.peak_search.singular.poles import poles_of_one_design
from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.scene.changes import ASIDE
from linksweep.scene.designs.choose import design_labels
from linksweep.scene.scene import Scene

EQUAL = 1e-9
"""Largest difference between a sample and its scene's value, relative to the signal's largest; an altered one has
more."""


class Pole(NamedTuple):
    """An angle [degree] beside which a quantity grows without bound, towards +inf or -inf by its sign."""

    name: str
    sign: float
    angle: float


def with_peaks(ds: xr.Dataset, *more: str) -> xr.Dataset:
    """Return a cycle, or a part of it, with samples at its exact peaks, in the units in which it is shown.

    `more` are quantities besides those whose peaks `linksweep.peaks` returns by default. To a Dataset that was altered,
    or has several designs, no samples are added.

    Raises ValueError for a Dataset that is not over the crank angle.
    """
    require_angles(ds)
    return results_in_shown_units(_with_samples(ds, more))


def _with_samples(ds: xr.Dataset, more: tuple[str, ...]) -> xr.Dataset:
    """Return a cycle with samples at its exact peaks, where its scene has them."""
    if {*ds.dims} != {INDEX} or WHOLE_TURN in ds.attrs:
        return ds
    try:
        scene = scene_of(ds)
    except ValueError:  # it holds no scene, or only a part of it
        return ds
    angles = ds[INDEX].values.astype(float)
    if len(angles) < 2 or design_labels(scene) or angles_missing(scene):
        return ds
    turn = full_turn(np.sort(angles))
    ends = float(angles.min()), float(angles.min() + turn if turn else angles.max())
    part = None if ends[1] - ends[0] >= scene.period else ends
    known = tuple(name for name in more if name in scene.table.quantity)
    worst, poles = marked_peaks(scene, known, part), _poles(scene, known)
    new = np.setdiff1d(_around(worst, poles, ends, scene.period), angles)
    names = [str(name) for name in ds.data_vars if name in scene.table.quantity]
    if not len(new) or not names:
        return ds
    own = ds[[*names, *(["status"] if "status" in ds else [])]]
    added = _samples(scene, own, new)
    if added is None:
        return ds
    bare = [part.reset_coords(drop=True) for part in (own, added)]
    joined = xr.concat([part.broadcast_like(part[INDEX]) for part in bare], INDEX).sortby(INDEX)
    labels = {name: label for name, label in ds.coords.items() if not label.dims}
    _raise_to_infinity(joined, [*_infinite(worst), *poles], scene.period)
    if "status" in joined:
        joined = joined.isel({INDEX: (joined["status"] == 0).values | np.isin(joined[INDEX], angles)})
    return joined.assign_coords(labels).assign_attrs({**ds.attrs, WHOLE_TURN: turn or 0.0})


def _samples(scene: Scene, own: xr.Dataset, angles: np.ndarray) -> xr.Dataset | None:
    """Return a cycle's own variables at other angles; None where any of its samples was altered."""
    names, count = [str(name) for name in own.data_vars], own.sizes[INDEX]
    both = sweep(scene, np.append(own[INDEX].values, angles), of=names)[names]
    unaltered, more = (both.isel({INDEX: part}, missing_dims="ignore") for part in (slice(count), slice(count, None)))
    return more if _equal(own, unaltered) else None


def _infinite(worst: xr.Dataset) -> list[Pole]:
    """Return the places of infinite peaks."""
    names = [str(name) for name in worst.data_vars if f"{name}_at" in worst and np.isinf(worst[name])]
    return [Pole(name.rpartition("_")[0], float(np.sign(worst[name])), float(worst[f"{name}_at"])) for name in names]


def _raise_to_infinity(ds: xr.Dataset, poles: list[Pole], period: float) -> None:
    """Make the largest samples beside poles infinite: only their angle has a meaning."""
    for name, sign, angle in poles:
        parts = [ds[part] for part in ([name] if name in ds else [f"{name}x", f"{name}y"]) if part in ds]
        near = np.abs(signed_distance(ds[INDEX].values, angle, period)) < 2.0 * ASIDE
        if not parts or not near.any():
            continue
        size = np.nan_to_num(np.hypot(*(part.values for part in parts)) if len(parts) == 2 else sign * parts[0].values)
        k = int(np.argmax(np.where(near, size, -np.inf)))
        for part in parts:
            part.values[k] = np.copysign(np.inf, part.values[k])
        if "status" in ds:
            ds["status"].values[k] = 0


def _around(worst: xr.Dataset, poles: list[Pole], ends: Part, period: float) -> np.ndarray:
    """Return the angles [degree] of peaks and poles, and beside them, between two ends and in the period that begins
    with the first."""
    names = [str(name) for name in worst.data_vars if str(name).endswith("_at")]
    at = np.array([*(float(worst[name]) for name in names), *(pole.angle for pole in poles)])
    return between((at[np.isfinite(at), None] + np.array([-ASIDE, 0.0, ASIDE])).ravel(), ends, period)


def between(angles: np.ndarray, ends: Part, period: float) -> np.ndarray:
    """Return those angles [degree] that lie between two ends, in the period that begins with the first."""
    away = np.mod(angles - ends[0], period)
    return ends[0] + away[away <= ends[1] - ends[0]]


def _equal(one: xr.Dataset, other: xr.Dataset) -> bool:
    rows = [(one[name].values, other[name].values) for name in one.data_vars]
    sizes = (float(np.max(np.abs(row), initial=0.0, where=np.isfinite(row))) for _, row in rows)
    return all(
        np.allclose(*pair, rtol=0.0, atol=EQUAL * size, equal_nan=True) for pair, size in zip(rows, sizes, strict=True)
    )


@lru_cache(maxsize=8)
def marked_peaks(scene: Scene, more: tuple[str, ...], part: Part | None) -> xr.Dataset:
    """Return the peaks at which a cycle, or a part of it, gets samples."""
    return peaks(scene, [*scene.mechanism.peak_quantities(scene.drive), *more], between=part)


@lru_cache(maxsize=8)
def _poles(scene: Scene, more: tuple[str, ...]) -> list[Pole]:
    """Return all poles of a period: a peak that is infinite is at one of them."""
    ends: dict[str, tuple[str, float]] = {}
    for name in [*scene.mechanism.peak_quantities(scene.drive), *more]:
        squared = scene.table.quantity[name].squared
        ends |= {squared: (name, 1.0)} if squared else {name: (name, 1.0), opposite_of(name): (name, -1.0)}
    return [Pole(*ends[signal], angle) for signal, angle in poles_of_one_design(scene, tuple(ends))]
