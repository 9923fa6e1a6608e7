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
from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene

SIZES = {
    "peak": "largest magnitude",
    "rms": "root mean square over time",
    "ripple": "root mean square over time about its mean",
}
ROUNDING = 1e-14
"""Part of a mean square below which its difference from the square of the mean is rounding."""


@limits_threads
def compare(
    before: Scene, after: Scene, *, of: Any, theta2: int | None = None, threads: int | None = None
) -> xr.Dataset:
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
    theta2 : int, default None
        Count of crank angles over the cycle, for the sizes of these samples; None for exact ones of the continuous
        cycle, as in `linksweep.peaks`.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Sizes over (…, balance), `balance` being before and after. What grows without bound has the exact size inf, even
        if it is only rounding of a force that is balanced away.

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
    Fs_peak     166.44       0  N
    T12_ripple  14.047  14.194  N m
    """
    require_scene(before)
    require_scene(after)
    refuse([] if theta2 is None else count_problems("theta2", theta2))
    sizes = sizes_named("of", before, requested_some("of", of, before))
    sides = [_exact(scene, sizes) if theta2 is None else _sampled(scene, theta2, sizes) for scene in (before, after)]
    table = {name: joined([side[name] for side in sides], "balance", ("before", "after")) for name in sides[0]}
    quantity = before.table.quantity
    for name, word in sizes:
        attributes = {"units": quantity[name].units, "long_name": f"{SIZES[word]} of the {quantity[name].long_name}"}
        table[f"{name}_{word}"] = table[f"{name}_{word}"].transpose(..., "balance").assign_attrs(attributes)
    return xr.Dataset(table, attrs=origin_attributes(before, "linksweep.compare(before, after, ...)"))


def _exact(scene: Scene, sizes: list[tuple[str, str]]) -> dict[str, xr.DataArray]:
    """Return the sizes of the continuous cycle by name."""
    words = {"peak": ("peak",), "rms": ("rms",), "ripple": ("rms", "mean")}
    ds = peaks(scene, of=dict.fromkeys(f"{name}_{each}" for name, word in sizes for each in words[word]))
    ripples = {name: _ripple(ds[f"{name}_rms"], ds[f"{name}_mean"]) for name, word in sizes if word == "ripple"}
    return {f"{name}_{word}": ripples[name] if word == "ripple" else ds[f"{name}_{word}"] for name, word in sizes}


def _ripple(rms: xr.DataArray, mean: xr.DataArray) -> xr.DataArray:
    """Return the root mean square about the mean: 0 of a steady quantity, of which the difference is rounding."""
    square = rms * rms - mean * mean
    square = xr.where(square <= ROUNDING * rms * rms, 0.0, square)
    return (square**0.5).where(np.isfinite(rms), rms)


def _sampled(scene: Scene, theta2: int, sizes: list[tuple[str, str]]) -> dict[str, xr.DataArray]:
    """Return the sizes of the samples of a cycle by name."""
    cycle = sweep(scene, theta2, of=[*(name for name, _ in sizes), scene.mechanism.pace])
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
