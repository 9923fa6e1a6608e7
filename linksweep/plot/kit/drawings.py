"""Find the machine whose results a Dataset holds, and its drawing."""

from __future__ import annotations

import xarray as xr

from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.capabilities import lack
from linksweep.mechanisms.drawing import Drawing
from linksweep.results.origin.machine_of_results import machine_of_results, parameters_of_scene

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


def efforts(ds: xr.Dataset) -> list[str]:
    """Return the torque or force of the drive of a Dataset's scene; every possible one where it has lost it."""
    machine, drive = machine_of_results(ds), parameters_of_scene(ds).get("drive", "")
    if machine is None:
        return list(LOST_DRIVES)
    return [machine.drives[drive]] if drive in machine.drives else list(machine.drives.values())
