"""compare(before, after, of=[...]): sizes of quantities of two scenes side by side."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import refuse
from linksweep.results.compute import quantity_problems, require_scene
from linksweep.results.dataset import joined, origin_attributes
from linksweep.results.over_time import mean_over_time
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene

SIZES = {
    "peak": "largest magnitude",
    "rms": "root mean square over time",
    "ripple": "root mean square over time about its mean",
}


def compare(before: Scene, after: Scene, of: Any, theta2: int = 720, threads: int | None = None) -> xr.Dataset:
    """Sizes of quantities of two scenes side by side, as before and after balancing.

    Parameters
    ----------
    before, after : Scene
    of : names of sizes, "F32_peak", "T12_ripple", "Fs_rms", or a mapping of which they are the keys
    theta2 : count of crank angles over the cycle
    threads : at most so many (default: all cores)

    Returns
    -------
    Dataset over (…, balance), `balance` being before and after. Sizes are those of the samples.

    Raises
    ------
    ValueError
        For unknown names.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> balanced = ls.with_counterweights(scene, ls.counterweights(scene, radius=0.06))
    >>> table = ls.compare(scene, balanced, of=["Fs_peak", "T12_ripple"])
    >>> table.Fs_peak.round(6).values.tolist()
    [166.43115, 0.0]
    """
    require_scene(before)
    require_scene(after)
    wanted = sizes_named("of", before, [of] if isinstance(of, str) else of)
    outputs = [*(name for name, _ in wanted), before.mechanism.pace]
    sides = [_sizes(scene, sweep(scene, theta2, outputs, threads=threads), wanted) for scene in (before, after)]
    found = {name: joined([side[name] for side in sides], "balance", ("before", "after")) for name in sides[0]}
    quantity = before.table.quantity
    for name, word in wanted:
        said = {"units": quantity[name].units, "long_name": f"{SIZES[word]} of the {quantity[name].long_name}"}
        found[f"{name}_{word}"] = found[f"{name}_{word}"].transpose(..., "balance").assign_attrs(said)
    return xr.Dataset(found, attrs=origin_attributes(before, "linksweep.compare(before, after, ...)"))


def _sizes(scene: Scene, cycle: xr.Dataset, wanted: list[tuple[str, str]]) -> dict[str, xr.DataArray]:
    found, index = {}, scene.mechanism.index
    mean = partial(mean_over_time, cycle=cycle, index=index, pace=scene.mechanism.pace)
    for name, word in wanted:
        signal = cycle[name].broadcast_like(cycle[index])
        signal = signal - mean(signal) if word == "ripple" else signal
        size = abs(signal).max(index) if word == "peak" else np.sqrt(mean(signal * signal))
        found[f"{name}_{word}"] = xr.DataArray(size)
    return found


def sizes_named(path: str, scene: Scene, names: Iterable[Any]) -> list[tuple[str, str]]:
    """Quantity and kind of each size by name: F32 and peak of F32_peak. ValueError for unknown names."""
    names = list(names)
    known = [f"{name}_{size}" for name in scene.table.quantity for size in SIZES]
    refuse([problem for name in names for problem in quantity_problems(path, name, known, scene)])
    parts = [name.rpartition("_") for name in names]
    return [(name, word) for name, _, word in parts]
