"""Find the machine whose results a Dataset holds, and its drawing."""

from __future__ import annotations

import tomllib
from functools import lru_cache
from typing import Any

import xarray as xr

from linksweep.base.validate import refuse
from linksweep.mechanisms import MECHANISMS, Mechanism
from linksweep.mechanisms.capabilities import lack
from linksweep.mechanisms.drawing import Drawing
from linksweep.results.compute import require_dataset
from linksweep.scene.file.reading import mechanism_of

LOST = Drawing(joints={"A": (1, 2), "B": (3, 2), "C": (4, 3), "ground": (1, 4)})
"""Drawing for a Dataset that has lost its scene, which alone states how link 4 is held."""
LOST_DRIVES = ("T12", "T13", "T14", "cylinder_force")
"""Torques and forces of a drive for such a Dataset."""


def joints_of(machine: Mechanism) -> Drawing:
    """Return the drawing of a machine, or where it has none the joints that are its pins.

    Raises ValueError for a machine without pins.
    """
    return Drawing(machine.pins, machine.journals) if machine.pins and not machine.drawing else drawing_of(machine)


def drawing_of(machine: Mechanism) -> Drawing:
    """Return the drawing of a machine. Raises ValueError where it has none."""
    if machine.drawing is None:
        raise ValueError(f"cannot draw {lack(machine, 'drawing')}")
    return machine.drawing


def drawing_of_results(ds: xr.Dataset) -> Drawing:
    """Return the joints of the machine whose results a Dataset holds; `LOST` where it has lost its scene."""
    machine = machine_of_results(ds)
    return LOST if machine is None else joints_of(machine)


def machine_of_results(ds: xr.Dataset) -> Mechanism | None:
    """Return the machine whose results a Dataset holds, for its names alone; None where it has lost its scene."""
    name, known = _scene_parameters(ds).get("mechanism", {}).get("type"), ", ".join(MECHANISMS)
    refuse([] if name is None or name in MECHANISMS else [f"ds: is of a {name}; registered are {known}: register it"])
    return None if name is None else _machine(ds.attrs["scene"])


def efforts(ds: xr.Dataset) -> list[str]:
    """Return the torque or force of the drive of a Dataset's scene; every possible one where it has lost it."""
    machine, drive = machine_of_results(ds), _scene_parameters(ds).get("drive", "")
    if machine is None:
        return list(LOST_DRIVES)
    return [machine.drives[drive]] if drive in machine.drives else list(machine.drives.values())


def _scene_parameters(ds: xr.Dataset) -> dict[str, Any]:
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
