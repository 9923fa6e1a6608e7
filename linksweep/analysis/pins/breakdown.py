"""breakdown(scene, "F32"): why is a pin loaded? The share of each link's inertia, of gravity, each load, friction.

Forces are linear in these sources, so each share comes from the same plan with the other sources set to zero. Friction
alone is not: its share is the force with friction less that without, which is what the friction force that acts would
do as a load on a slider without friction.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import count_problems, refuse
from linksweep.results.changed import quantities_with
from linksweep.results.compute import quantity_problems, requested, require
from linksweep.results.sweep import sweep
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

FRICTIONLESS = {"friction": 0.0}
FORCE = re.compile("[FT][0-9][0-9][a-z]?")
"""Names of forces and torques between two links, as F32x, T12."""


def breakdown(
    scene: Scene, of: str | Iterable[str] | None = None, *, theta2: Any = 720, threads: int | None = None
) -> xr.Dataset:
    """The share of each source in pin forces and in the drive's torque.

    Parameters
    ----------
    scene : Scene of a machine with a crank
    of : names of pin forces, of their components, or of the drive's torque or force; default: all pins and the torque
    theta2 : a count of angles, or any array of angles [degree], as in `sweep`; ``[peaks.F32_peak_at]`` for the worst
    threads : at most so many (default: all cores)

    Returns
    -------
    Dataset over `source` and the dims of a sweep. Sources are "crank inertia", "coupler inertia", …, "gravity", each
    load ("load1 (coupler)", …) and "friction", those that the scene has. The shares of a component or a torque add
    up to it. Of a magnitude F32 they are the sources' forces along the direction of the whole force, so that they add
    up to it too; a negative share relieves the pin. `status` as in `sweep`.

    Raises
    ------
    ValueError
        For names that are no forces, and for a car in a loop.

    Notes
    -----
    Inertia is that at the scene's own omega2 and alpha2. Friction's share is the force with friction less that without.
    Sums agree with `sweep` to 1e-13 of the largest share.

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
    refuse(count_problems("threads", threads))
    names = _names(scene, of)
    grid = crank_grid(theta2, scene.period, scene.mechanism.index)
    sampled = scene.at(grid)
    parts = tuple(dict.fromkeys(part for name in names for part in _parts(scene, name)))
    cycle = sweep(scene, theta2, of=dict.fromkeys([*names, *parts]), threads=threads)
    shares = {
        source: quantities_with(changed, single, grid, parts, threads)
        for source, (single, changed) in _sources(sampled).items()
    }
    if has_friction(scene):
        whole, smooth = (quantities_with(changed, sampled, grid, parts, threads) for changed in ({}, FRICTIONLESS))
        shares["friction"] = {part: whole[part] - smooth[part] for part in parts}
    stacked = {part: _stacked(part, shares) for part in parts}
    made = {name: _described(cycle[name], _share(cycle, name, stacked)) for name in names}
    found = cycle[["status"]].assign(made).transpose("source", ...).assign_coords(source=list(shares))
    return found.assign_attrs(cycle.attrs | {"command": f"linksweep.breakdown(scene, {list(names)}, ...)"})


def _names(scene: Scene, of: Any) -> tuple[str, ...]:
    if of is None:
        return scene.mechanism.peak_quantities(scene.drive)
    names = requested("of", of)
    refuse([problem for name in names for problem in quantity_problems("of", name, forces_of(scene), scene)])
    return tuple(names)


def forces_of(scene: Scene) -> list[str]:
    """Names of what is linear in the sources: the unknowns of the square system, and what is made of them."""
    drive = scene.mechanism.drives[scene.drive]
    numbered = [name for name in scene.table.quantity if FORCE.fullmatch(name)]
    return list(dict.fromkeys([*numbered, drive, "reduced_torque"]))


def _parts(scene: Scene, name: str) -> tuple[str, ...]:
    """Of a magnitude, the components."""
    return (f"{name}x", f"{name}y") if scene.table.quantity[name].squared else (name,)


def has_friction(scene: Scene) -> bool:
    return bool(np.any(scene.mechanism.friction != 0.0))


def _sources(sampled: Scene) -> dict[str, tuple[Scene, dict[str, float]]]:
    """For each source the scene with no loads but its own, and the parameters that silence the other sources."""
    links = sampled.mechanism.links
    weightless = FRICTIONLESS | {"gravity_x": 0.0, "gravity_y": 0.0}
    bare = replace(sampled, loads=())
    found = {
        f"{link} inertia": (bare, weightless | _massless(other for other in links if other != link)) for link in links
    }
    if any(np.any(component != 0.0) for component in sampled.gravity):
        found["gravity"] = (bare, FRICTIONLESS | {"omega2": 0.0, "alpha2": 0.0})
    for k, load in enumerate(sampled.loads, 1):
        alone = replace(sampled, loads=(load,))
        found[f"load{k} ({load.form.place})"] = (alone, weightless | _massless(links))
    return found


def _massless(links: Iterable[str]) -> dict[str, float]:
    return {f"{link}_{kind}": 0.0 for link in links for kind in ("mass", "inertia")}


def _stacked(name: str, shares: Mapping[str, dict[str, xr.DataArray]]) -> xr.DataArray:
    arrays = xr.broadcast(*(found[name] for found in shares.values()))
    return xr.concat(arrays, "source", coords="minimal", compat="override", join="override")


def _share(cycle: xr.Dataset, name: str, stacked: Mapping[str, xr.DataArray]) -> xr.DataArray:
    """Shares of a component as they are; of a magnitude along the direction of the whole force, where it has one."""
    if name in stacked:
        return stacked[name]
    x, y, size = cycle[f"{name}x"], cycle[f"{name}y"], cycle[name]
    along = stacked[f"{name}x"] * (x / size) + stacked[f"{name}y"] * (y / size)
    return along.where(size != 0.0, 0.0)


def _described(whole: xr.DataArray, share: xr.DataArray) -> xr.DataArray:
    said = {"units": whole.attrs["units"], "long_name": f"share of each source in: {whole.attrs['long_name']}"}
    return share.where(whole.notnull()).assign_attrs(said)
