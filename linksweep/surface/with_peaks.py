"""A cycle as it is drawn: with samples of its own where its scene's exact peaks are, so that these are marked.

Peaks lie between samples, and of a jump a sample has one side at most. A cycle of one design holds its scene; so the
angles of the exact peaks of all pins and of the drive are added to it, with one just before and one just behind each.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import xarray as xr

from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.scene.choose import design_labels
from linksweep.scene.scene import Scene
from linksweep.surface.signals import INDEX, WHOLE_TURN, full_turn
from linksweep.surface.storage import scene_of

ASIDE = 1e-7
"""Degrees beside a peak, where its one-sided limit is told in all the digits that a plot shows."""
SHAKING = ("Fsx", "Fsy")
EQUAL = 1e-9
"""Of its largest value: how far a sample may be from that of the scene; else the numbers are not the scene's."""


def with_peaks(ds: xr.Dataset) -> xr.Dataset:
    """Return a cycle with samples at its exact peaks; itself where it is no whole cycle of one design, or altered."""
    if {*ds.dims} != {INDEX} or WHOLE_TURN in ds.attrs:
        return ds
    try:
        scene = scene_of(ds)
    except ValueError:  # it has lost its scene, or some of it
        return ds
    angles, period = ds[INDEX].values.astype(float), scene.period
    if full_turn(np.sort(angles)) != period or design_labels(scene):
        return ds
    found = _peaks(scene, tuple(name for name in ["Fs"] if {*SHAKING} <= {*ds.variables}))
    new = np.setdiff1d(_around(found, angles.min(), period), angles)
    names = [str(name) for name in ds.data_vars if name in scene.table.quantity]
    if not len(new) or not names:
        return ds
    own = ds[[*names, *(["status"] if "status" in ds else [])]]
    more = _samples(scene, own, new)
    if more is None:
        return ds
    bare = [part.reset_coords(drop=True) for part in (own, more)]
    joined = xr.concat([part.broadcast_like(part[INDEX]) for part in bare], INDEX).sortby(INDEX)
    labels = {name: label for name, label in ds.coords.items() if not label.dims}
    return joined.assign_coords(labels).assign_attrs({**ds.attrs, WHOLE_TURN: period})


def _samples(scene: Scene, own: xr.Dataset, angles: np.ndarray) -> xr.Dataset | None:
    """Return the same variables at other angles; None where one that is there is not the scene's, but was altered."""
    k = int(np.argmax((own["status"] == 0).values)) if "status" in own else 0
    names = [str(name) for name in own.data_vars]
    more = sweep(scene, np.append(own[INDEX].values[k], angles), names)[names]
    if not _equal(own.isel({INDEX: k}, missing_dims="ignore"), more.isel({INDEX: 0}, missing_dims="ignore")):
        return None
    return more.isel({INDEX: slice(1, None)}, missing_dims="ignore")


def _around(found: xr.Dataset, first: float, period: float) -> np.ndarray:
    """Angles [degree] of peaks that are finite, and beside them, in the period that begins with the first."""
    names = [str(name) for name in found.data_vars if str(name).endswith("_at")]
    at = np.array([float(found[name]) for name in names if np.isfinite(found[name.removesuffix("_at")])])
    return first + np.mod((at[:, None] + np.array([-ASIDE, 0.0, ASIDE])).ravel() - first, period)


def _equal(one: xr.Dataset, other: xr.Dataset) -> bool:
    size = max((float(abs(one[name]).max()) for name in one.data_vars), default=0.0)
    return all(abs(float(one[name]) - float(other[name])) <= EQUAL * size for name in one.data_vars)


@lru_cache(maxsize=8)
def _peaks(scene: Scene, more: tuple[str, ...]) -> xr.Dataset:
    return peaks(scene, [*scene.mechanism.peak_quantities(scene.drive), *more])
