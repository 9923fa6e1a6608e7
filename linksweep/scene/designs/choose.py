"""One design out of a scene over many: by the labels of its dimensions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import did_you_mean, quote, refuse
from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene


def chosen(scene: Scene, where: Mapping[str, Any]) -> Scene:
    """Return the scene at one label of each dimension named; an array without dims left becomes a plain number.

    Raises ValueError for an unknown dimension or label, and where the scene of plain numbers is refused.
    """
    labels = design_labels(scene)
    at = places(where, labels)
    values = {path: _number(array.isel(at, missing_dims="ignore")) for path, array in scene.arrays.items()}
    branches = scene.mechanism.both_branches.items()
    values |= {path: str(labels[dim][at[dim]]) for dim, path in branches if dim in at}
    return replaced(scene, values)


def design_labels(scene: Scene) -> dict[str, np.ndarray]:
    """Return the labels of a scene's design dims; positions, from 0, where a dim has none."""
    sizes = {str(dim): n for array in scene.arrays.values() for dim, n in array.sizes.items()}
    sizes.pop(scene.mechanism.index, None)
    return {dim: np.arange(n) for dim, n in sizes.items()} | {dim: item.values for dim, item in scene.labels.items()}


def places(where: Mapping[str, Any], labels: Mapping[str, np.ndarray]) -> dict[str, int]:
    """Return the position of one label of each dimension named."""
    at, problems = {}, []
    for dim, label in where.items():
        try:
            at[dim] = _place(label, labels[dim])
        except KeyError:
            there = f"; its dims are {', '.join(labels)}" if labels else "; it is one design, without dims"
            unknown = f"{dim} = {quote(label)}: no dim of the designs is {dim!r}"
            problems.append(unknown + (did_you_mean(dim, labels) or there))
        except ValueError as error:
            problems.append(f"{dim} = {error}")
    refuse(problems)
    return at


def _place(label: Any, labels: np.ndarray) -> int:
    """Return the position of a label: of the equal one, or for a number the one that agrees to twelve digits."""
    requested = np.asarray(getattr(label, "values", label))
    if requested.ndim or isinstance(label, slice):
        raise ValueError(f"{quote(label)}: must be one label")
    numeric = requested.dtype.kind in "fiu" and labels.dtype.kind in "fiu"
    one_kind = requested.dtype.kind != "b" or labels.dtype.kind == "b"  # numpy takes True for 1
    matches = np.flatnonzero((labels == requested) & one_kind)
    if numeric and not matches.size:
        matches = np.flatnonzero(np.isclose(labels, requested, rtol=1e-12, atol=0.0))
    if matches.size == 1:
        return int(matches[0])
    text = quote(requested.item())
    if not labels.size:
        raise ValueError(f"{text}: there are no designs along it: choose from results that have some")
    if matches.size:
        raise ValueError(f"{text}: {matches.size} designs have this label; give them labels of their own")
    one = f"first is {quote(labels[:1].tolist()[0])}"
    if numeric:
        one = f"nearest is {labels[np.argmin(abs(labels - requested))]}"
    raise ValueError(f"{text}: must be one of its {labels.size} labels, of which the {one}")


def _number(array: xr.DataArray) -> Any:
    return array.reset_coords(drop=True) if array.dims else float(array)
