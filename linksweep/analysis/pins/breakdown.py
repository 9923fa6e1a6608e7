"""Breakdown of a pin's load: the share of each link's inertia, of gravity, each load, and friction.

Forces are linear in these sources, so each share comes from the same plan with the other sources set to zero. Friction
is not: its share is the force with friction less the force without, the effect of the acting friction force as a load
on a slider without friction. Nor are teeth, which part whichever way they drive: their share is likewise the effect of
their force's component across the pitch circle.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import refuse
from linksweep.chains.between_links import pair_of
from linksweep.engine.threads import limits_threads
from linksweep.results.changed import quantities_with
from linksweep.results.compute import quantity_problems, requested_some, require
from linksweep.results.dataset import joined
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene


@limits_threads
def breakdown(
    scene: Scene, of: str | Iterable[str] | None = None, *, theta2: Any = 720, threads: int | None = None
) -> xr.Dataset:
    """Compute the share of each source in pin forces and in the drive's torque.

    Parameters
    ----------
    scene : Scene
        Scene of a machine with pins.
    of : str or iterable of str, default None
        Names of pin forces, of their components, or of the drive's torque or force; None for all pins and the torque.
    theta2 : int or array_like, default 720
        Count of crank angles, or angles [degree], as in `linksweep.sweep`; ``[peaks.F32_peak_at]`` for the worst.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Shares over `source` and the dims of a sweep. Sources are "crank inertia", "coupler inertia", …, "gravity", each
        load ("load1 (coupler)", …), "friction" and "teeth", as the scene has them. The shares of a component or a
        torque add up to it. Of a magnitude F32 they are the sources' forces along the direction of the whole force, so
        that they add up to it too; a negative share relieves the pin. `status` as in `linksweep.sweep`.

    Raises
    ------
    ValueError
        If a name is no force of the scene, there is none, or the machine has no pins.

    Notes
    -----
    Inertia is that at the scene's own omega2 and alpha2. Friction's share is the force with friction less the force
    without, and so is that of teeth with a pressure angle. Sums agree with `linksweep.sweep` to 1e-13 of the largest
    share.

    Examples
    --------
    >>> import linksweep as ls
    >>> shares = ls.breakdown(ls.example("press"), "F32", theta2=[53.0])
    >>> shares.F32.round(0).to_series()
    source           theta2
    crank inertia    53.0        0.0
    coupler inertia  53.0       30.0
    rocker inertia   53.0       12.0
    gravity          53.0        3.0
    load1 (coupler)  53.0      135.0
    load2 (rocker)   53.0       42.0
    Name: F32, dtype: float64
    """
    require(scene, "pins")
    names = _names(scene, of)
    grid = scene.grid(theta2)
    sampled = scene.at(grid)
    parts = tuple(dict.fromkeys(part for name in names for part in scene.table.quantity[name].components))
    cycle = sweep(scene, theta2, of=dict.fromkeys([*names, *parts]))
    shares = {
        source: quantities_with(changed, single, grid, parts) for source, (single, changed) in _sources(sampled).items()
    }
    silent: dict[str, float] = {}
    for source, silenced in _beside(scene).items():
        before = quantities_with(silent, sampled, grid, parts)
        silent = silent | silenced
        after = quantities_with(silent, sampled, grid, parts)
        shares[source] = {part: before[part] - after[part] for part in parts}
    stacked = {part: joined([forces[part] for forces in shares.values()], "source", shares) for part in parts}
    described = {name: _described(cycle[name], _share(cycle, name, stacked)) for name in names}
    ds = cycle[["status"]].assign(described).transpose("source", ...)
    return ds.assign_attrs(command=f"linksweep.breakdown(scene, {list(names)}, ...)")


def _names(scene: Scene, of: Any) -> tuple[str, ...]:
    if of is None:
        return scene.mechanism.peak_quantities(scene.drive)
    names = requested_some("of", of, scene)
    refuse([problem for name in names for problem in quantity_problems("of", name, forces_of(scene), scene)])
    return tuple(names)


def forces_of(scene: Scene) -> list[str]:
    """Return the names of forces that are linear in the sources: unknowns of the square system, and their sums."""
    drive = scene.mechanism.drives[scene.drive]
    numbered = [name for name in scene.table.quantity if pair_of(name.rstrip("xynt"))]
    return list(dict.fromkeys([*numbered, drive, "reduced_torque"]))


def _beside(scene: Scene) -> dict[str, dict[str, float]]:
    """Return the sources in which forces are not linear, and the parameters that silence each."""
    teeth = {"teeth": dict.fromkeys(scene.mechanism.teeth, 0.0)} if scene.mechanism.teeth else {}
    return ({"friction": frictionless(scene)} if scene.mechanism.rubs else {}) | teeth


def frictionless(scene: Scene) -> dict[str, float]:
    """Return the parameters that silence friction."""
    return dict.fromkeys(scene.mechanism.frictions, 0.0)


def _sources(sampled: Scene) -> dict[str, tuple[Scene, dict[str, float]]]:
    """Return for each source a scene with its loads alone, and the parameters that silence the other sources."""
    links = sampled.mechanism.roles
    smooth = frictionless(sampled) | dict.fromkeys(sampled.mechanism.teeth, 0.0)
    weightless = smooth | {"gravity_x": 0.0, "gravity_y": 0.0}
    bare = replace(sampled, loads=())
    sources = {f"{link} inertia": (bare, weightless | _massless({*links} - {link})) for link in links}
    if any(np.any(component != 0.0) for component in sampled.gravity):
        sources["gravity"] = (bare, smooth | {"omega2": 0.0, "alpha2": 0.0})
    for k, load in enumerate(sampled.loads, 1):
        alone = replace(sampled, loads=(load,))
        sources[f"load{k} ({load.form.place})"] = (alone, weightless | _massless(links))
    return sources


def _massless(links: Iterable[str]) -> dict[str, float]:
    return {f"{link}_{kind}": 0.0 for link in links for kind in ("mass", "inertia")}


def _share(cycle: xr.Dataset, name: str, stacked: Mapping[str, xr.DataArray]) -> xr.DataArray:
    """Return the shares of a component as they are; of a magnitude, along the direction of the whole force."""
    if name in stacked:
        return stacked[name]
    x, y, size = cycle[f"{name}x"], cycle[f"{name}y"], cycle[name]
    along = stacked[f"{name}x"] * (x / size) + stacked[f"{name}y"] * (y / size)
    return along.where(size != 0.0, 0.0)


def _described(whole: xr.DataArray, share: xr.DataArray) -> xr.DataArray:
    attributes = {"units": whole.attrs["units"], "long_name": f"share of each source in: {whole.attrs['long_name']}"}
    return share.where(whole.notnull()).assign_attrs(attributes)
