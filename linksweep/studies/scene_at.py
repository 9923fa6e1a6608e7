"""scene_at(study, design=17): select one design of a study as a scene."""

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


def scene_at(ds: xr.Dataset | Scene, where: Mapping[str, Any] | None = None, /, **labels: Any) -> Scene:
    """Select one design of a study as a scene of plain numbers.

    Parameters
    ----------
    ds : Dataset or Scene
        Dataset of linksweep over designs (peaks, a cycle, a Pareto front), or a scene over designs. One joined of
        several scenes' results, as by `xarray.concat`, holds the scene of the first alone.
    where : mapping, default None
        Labels by dim, for names that are no Python words.
    **labels
        Labels as keywords: ``design=17``, ``branch="open"``, ``crank_length=0.08``. For a dim without labels, the
        position from 0. Numbers must match to twelve digits; the nearest is not taken instead. Other dims stay.

    Returns
    -------
    Scene
        Scene whose sweep and peaks equal those of the design in the study, bit for bit; but of a Dataset, functions of
        theta2 come back as splines, as from `linksweep.load_scene`.

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
    named = where is None or isinstance(where, Mapping)
    refuse([] if named else [f"where = {quote(where)}: must name the dim of each label, as in design=17"])
    request = {**(where or {}), **labels}
    if isinstance(ds, Scene):
        return chosen(ds, request)
    if not isinstance(ds, xr.Dataset):
        raise ValueError(f"ds = {quote(ds)}: must be a Dataset of linksweep, or a Scene")
    known = _labels(ds)
    one = ds.isel(places({dim: label for dim, label in request.items() if dim in known}, known))
    scene = scene_of(one)
    remaining = {dim: label for dim, label in request.items() if dim not in known}
    return chosen(scene, remaining | _chosen_already(scene, one, request))


def _chosen_already(scene: Scene, one: xr.Dataset, request: Mapping[str, Any]) -> dict[str, Any]:
    """Return labels along dims without labels that the Dataset has lost; loads over theta2 still have these dims."""
    gone = [dim for dim in design_labels(scene) if dim not in one.dims]
    advice = "name it here, or give the dimension labels before you select"
    refuse([f"{dim}: the Dataset does not say which one it is of; {advice}" for dim in gone if dim not in request])
    return {dim: request[dim] for dim in gone}


def _labels(ds: xr.Dataset) -> dict[str, np.ndarray]:
    """Return the labels of a Dataset's design dims; positions where a dim has none."""
    sizes = {str(dim): n for dim, n in ds.sizes.items() if dim not in indices()}
    return {dim: ds[dim].values if dim in ds.coords else np.arange(n) for dim, n in sizes.items()}
