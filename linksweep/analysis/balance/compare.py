"""compare(before, after, of=[...]): sizes of quantities of two scenes side by side."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import count_problems, refuse
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import quantity_problems, requested_some, require_scene
from linksweep.results.dataset import joined, origin_attributes
from linksweep.results.over_time import mean_over_time
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene

SIZES = {
    "peak": "largest magnitude",
    "rms": "root mean square over time",
    "ripple": "root mean square over time about its mean",
}


@limits_threads
def compare(before: Scene, after: Scene, *, of: Any, theta2: int = 720, threads: int | None = None) -> xr.Dataset:
    """Compare sizes of quantities of two scenes, as before and after balancing.

    Parameters
    ----------
    before : Scene
        Scene before the change.
    after : Scene
        Scene after the change.
    of : str, list of str or mapping
        Quantities with one of the endings `_peak` (largest magnitude), `_rms` and `_ripple` (root mean square about the
        mean), such as "F32_peak"; or a mapping with such names as keys.
    theta2 : int, default 720
        Count of crank angles over the cycle.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Sizes of the samples over (…, balance), `balance` being before and after.

    Raises
    ------
    ValueError
        If a name is unknown, there is none, or theta2 is no count.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> balanced = ls.with_counterweights(scene, ls.counterweights(scene, radius=0.06))
    >>> print(ls.compare(scene, balanced, of=["Fs_peak", "T12_ripple"]).linksweep)
    quantity    before   after  unit
    Fs_peak     166.43       0  N
    T12_ripple  14.047  14.194  N m
    """
    require_scene(before)
    require_scene(after)
    refuse(count_problems("theta2", theta2))
    sizes = sizes_named("of", before, requested_some("of", of, before))
    outputs = [*(name for name, _ in sizes), before.mechanism.pace]
    sides = [_sizes(scene, sweep(scene, theta2, of=outputs), sizes) for scene in (before, after)]
    table = {name: joined([side[name] for side in sides], "balance", ("before", "after")) for name in sides[0]}
    quantity = before.table.quantity
    for name, word in sizes:
        attributes = {"units": quantity[name].units, "long_name": f"{SIZES[word]} of the {quantity[name].long_name}"}
        table[f"{name}_{word}"] = table[f"{name}_{word}"].transpose(..., "balance").assign_attrs(attributes)
    return xr.Dataset(table, attrs=origin_attributes(before, "linksweep.compare(before, after, ...)"))


def _sizes(scene: Scene, cycle: xr.Dataset, sizes: list[tuple[str, str]]) -> dict[str, xr.DataArray]:
    """Return the sizes of one cycle by name."""
    index, values = scene.mechanism.index, {}
    mean = partial(mean_over_time, cycle=cycle, index=index, pace=scene.mechanism.pace)
    for name, word in sizes:
        signal = cycle[name].broadcast_like(cycle[index])
        signal = signal - mean(signal) if word == "ripple" else signal
        size = abs(signal).max(index) if word == "peak" else np.sqrt(mean(signal * signal))
        values[f"{name}_{word}"] = xr.DataArray(size)
    return values


def sizes_named(path: str, scene: Scene, names: Iterable[Any]) -> list[tuple[str, str]]:
    """Return quantity and kind of each size by name, F32 and peak of F32_peak; raise ValueError for unknown names."""
    names = list(names)
    known = [f"{name}_{size}" for name in scene.table.quantity for size in SIZES]
    refuse([problem for name in names for problem in quantity_problems(path, name, known, scene)])
    parts = [name.rpartition("_") for name in names]
    return [(name, word) for name, _, word in parts]
