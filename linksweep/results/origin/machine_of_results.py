"""Find the machine whose results a Dataset holds, its cycle and its drive."""

from __future__ import annotations

import tomllib
from functools import lru_cache
from typing import Any

import xarray as xr

from linksweep.base.validate import refuse
from linksweep.mechanisms import MECHANISMS, Mechanism
from linksweep.results.compute import force_in, require_dataset
from linksweep.results.dataset import CYCLE
from linksweep.scene.file.reading import mechanism_of, parse_scene
from linksweep.scene.pairs import changes


def machine_of_results(ds: xr.Dataset) -> Mechanism | None:
    """Return the machine whose results a Dataset holds, for its names alone; None where it has lost its scene."""
    name, known = parameters_of_scene(ds).get("mechanism", {}).get("type"), ", ".join(MECHANISMS)
    refuse([] if name is None or name in MECHANISMS else [f"ds: is of a {name}; registered are {known}: register it"])
    return None if name is None else _machine(ds.attrs["scene"])


def cycle_of_results(ds: xr.Dataset, names: list[str]) -> float | None:
    """Return the cycle [degree] after which some results of a Dataset repeat: that of the motion where no load enters
    them, or where arrays of loads were dropped; None where it has lost its scene and its attributes."""
    machine = machine_of_results(ds)
    if machine is None:
        return max((ds[name].attrs[CYCLE] for name in names if CYCLE in ds[name].attrs), default=None)
    arrays = {str(path): ds[path].reset_coords(drop=True) for path in ds.variables}
    try:
        scene = parse_scene(ds.attrs["scene"], "ds", arrays, whole=False)
    except ValueError:
        return machine.period * machine.turns
    known = scene.table.quantity.keys() >= {*names}
    return scene.period_of_motion if known and not changes(scene, tuple(names)) else scene.period


def name_in_results(ds: xr.Dataset, name: Any) -> Any:
    """Return the name of a variable; of the letter of a pin, which a Dataset has no variable of, that of its force:
    "B_peak" is F32_peak."""
    if not isinstance(name, str) or not isinstance(ds, xr.Dataset) or name in ds.variables:
        return name
    machine = machine_of_results(ds)
    return name if machine is None else force_in(name, machine.pins)


def parameters_of_scene(ds: xr.Dataset) -> dict[str, Any]:
    """Return the parameters in a Dataset's scene text, which suffice for names even where arrays were dropped."""
    require_dataset(ds, "ls.sweep")
    text = ds.attrs.get("scene")
    return _parsed(text) if isinstance(text, str) else {}


@lru_cache(maxsize=16)
def _parsed(text: str) -> dict[str, Any]:
    return tomllib.loads(text)


@lru_cache(maxsize=16)
def _machine(text: str) -> Mechanism:
    return mechanism_of(_parsed(text))
