"""The Pareto front: the designs that no other design beats in every objective."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import name_problems, refuse
from linksweep.mechanisms import indices
from linksweep.results.compute import requested, require_dataset
from linksweep.results.front import front, has_peaks, objective_attributes
from linksweep.results.origin.machine_of_results import name_in_results

FRONT = "front"
"""Dimension of a front whose designs lie along several dims."""


def pareto(ds: xr.Dataset, *, minimize: Iterable[str] = (), maximize: Iterable[str] = ()) -> xr.Dataset:
    """Select the Pareto front of a study: no other design is as good in every objective and better in one.

    Parameters
    ----------
    ds : Dataset
        Designs, as from `peaks`.
    minimize : iterable of str, default ()
        Names of its variables or coordinates ("F32_peak", "coupler.length"); add others first, as
        ``ds.assign(weight=...)``.
    maximize : iterable of str, default ()
        Names of those that are to be large.

    Returns
    -------
    Dataset
        Same variables at those designs alone, the best in the first objective first, then in the second, and so on.
        Equal designs are all kept. A design whose status is neither ok (0) nor partial_revolution (1), or with an
        objective that is not finite, is never among them; of designs that must turn fully, give ``ds.where(ds.status ==
        0)``. One design dim keeps its name; of several the designs lie along `front`, and their labels with them.
        `linksweep.scene_at` makes scenes of them.

    Raises
    ------
    ValueError
        If a name is unknown, holds no numbers, or changes over the revolution.

    Notes
    -----
    Two objectives take one sort; more take a pass over the designs for each design of the front.

    Examples
    --------
    >>> import linksweep as ls
    >>> designs = ls.sample(ls.example("press"), {"coupler.length": (0.2, 0.24), "omega2": (20, 30)}, n=64)
    >>> study = ls.peaks(designs, theta2=360)
    >>> front = ls.pareto(study, minimize=["F32_peak"], maximize=["omega2"])
    >>> bool((front.omega2.diff("design") > 0).all())  # in order of F32_peak: a larger force buys more speed
    True
    """
    require_dataset(ds, "ls.peaks of several designs")
    small, large = (
        [name_in_results(ds, name) for name in requested(path, names)]
        for path, names in (("minimize", minimize), ("maximize", maximize))
    )
    objectives = _objectives(ds, small, large)
    *together, sound_status = xr.broadcast(*objectives, has_peaks(ds))
    dims, shape = sound_status.dims, sound_status.shape
    refuse([] if dims else ["ds holds one design: there is nothing to choose from; give it a dimension of designs"])
    costs = np.stack([item.values.reshape(-1).astype(float) for item in together], axis=-1)
    sound = np.isfinite(costs).all(axis=1) & sound_status.values.reshape(-1)
    designs = np.flatnonzero(sound)
    designs = designs[front(costs[designs])]
    chosen = _at(ds, {str(dim): at for dim, at in zip(dims, np.unravel_index(designs, shape), strict=True)})
    others = {name: text for name, text in ds.attrs.items() if name not in ("minimize", "maximize")}
    chosen.attrs = others | objective_attributes(small, large)
    return chosen


def _objectives(ds: xr.Dataset, minimize: list[str], maximize: list[str]) -> list[xr.DataArray]:
    """Return the objectives, all to be small."""
    objectives = [("minimize", name) for name in minimize] + [("maximize", name) for name in maximize]
    refuse([] if objectives else ['minimize: is empty; give names of variables, as in ["F32_peak", "T12_peak"]'])
    refuse([problem for path, name in objectives for problem in variable_problems(ds, path, name, numbers="fiu")])
    return [-ds[name].astype(float) if path == "maximize" else ds[name] for path, name in objectives]


def variable_problems(ds: xr.Dataset, path: str, name: Any, numbers: str = "") -> list[str]:
    """Return the problems of a name that must stand for one value for each design.

    `numbers` are the kinds of dtype that are allowed; "" allows all.
    """
    if problems := name_problems(path, name, map(str, ds.variables)):
        return problems
    if numbers and ds[name].dtype.kind not in numbers:
        return [f"{path}: {name} holds {ds[name].dtype} values, which must be numbers"]
    over = [dim for dim in indices() if dim in ds[name].dims]
    advice = f'ls.peaks(scene, of=["{name}"]) has one number for each design; take those'
    return [f"{path}: {name} depends on {over[0]}, and must not; {advice}"] if over else []


def _at(ds: xr.Dataset, designs: dict[str, np.ndarray]) -> xr.Dataset:
    """Return a Dataset at positions along its design dims, taken together; dims without labels get their positions."""
    ds = ds.assign_coords({dim: np.arange(ds.sizes[dim]) for dim in designs if dim not in ds.coords})
    along = next(iter(designs)) if len(designs) == 1 else FRONT
    return ds.isel({dim: xr.Variable(along, at) for dim, at in designs.items()})
