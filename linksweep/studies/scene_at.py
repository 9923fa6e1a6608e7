"""scene_at(study, design=17): one design of a study as a scene of its own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import quote, refuse
from linksweep.files.netcdf import scene_of
from linksweep.mechanisms import indices
from linksweep.scene.designs.choose import chosen, design_labels, places
from linksweep.scene.scene import Scene


def scene_at(study: xr.Dataset | Scene, where: Mapping[str, Any] | None = None, /, **labels: Any) -> Scene:
    """One design of a study as a scene of plain numbers.

    Parameters
    ----------
    study : Dataset of linksweep over designs (peaks, a cycle, a Pareto front), or a scene over designs
    where : labels by dimension, for names that are no Python words
    **labels : the same as keywords, ``design=17``, ``branch="open"``, ``crank_length=0.08``. A dim without labels takes
        the position, from 0. Numbers match to twelve digits; the nearest is not taken in their place. Dims that are
        not named stay

    Returns
    -------
    Scene whose sweep and peaks equal those of the design in the study, bit for bit.

    Raises
    ------
    ValueError
        For an unknown dim or label, a Dataset that has lost its scene, and a design that cannot be assembled at all.

    Examples
    --------
    >>> import linksweep as ls
    >>> study = ls.peaks(ls.sample(ls.example("press"), {"coupler.length": (0.2, 0.24)}, n=8), of=["F32"])
    >>> best = ls.scene_at(study, design=study.F32_peak.idxmin())
    >>> bool(ls.peaks(best).F32_peak == study.F32_peak.min())
    True
    """
    wanted = {**(where or {}), **labels}
    if isinstance(study, Scene):
        return chosen(study, wanted)
    if not isinstance(study, xr.Dataset):
        raise ValueError(f"study = {quote(study)}: must be a Dataset of linksweep, or a Scene")
    known = _labels(study)
    one = study.isel(places({dim: label for dim, label in wanted.items() if dim in known}, known))
    scene = scene_of(one)
    left = {dim: label for dim, label in wanted.items() if dim not in known}
    return chosen(scene, left | _chosen_already(scene, one, wanted))


def _chosen_already(scene: Scene, one: xr.Dataset, wanted: Mapping[str, Any]) -> dict[str, Any]:
    """Return positions along dims without labels that the Dataset no longer has: loads over theta2 still have them."""
    gone = [dim for dim in design_labels(scene) if dim not in one.dims]
    advice = "name it here, or give the dimension labels before you select"
    refuse([f"{dim}: the Dataset does not say which one it is of; {advice}" for dim in gone if dim not in wanted])
    return {dim: wanted[dim] for dim in gone}


def _labels(ds: xr.Dataset) -> dict[str, np.ndarray]:
    """The labels of a Dataset's design dims; positions where a dim has none."""
    sizes = {str(dim): n for dim, n in ds.sizes.items() if dim not in indices()}
    return {dim: ds[dim].values if dim in ds.coords else np.arange(n) for dim, n in sizes.items()}
