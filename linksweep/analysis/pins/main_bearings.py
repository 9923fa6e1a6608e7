"""Bearings of a crankshaft's mains, of an engine of several cylinders: loads by the lever rule, exact peaks, and life.

Model and source of the loads: `linksweep.results.cylinders.cylinder_sums`; of life:
`linksweep.analysis.pins.bearing_life`.
"""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr

from linksweep.analysis.pins.bearing import (
    TEXTS,
    Bearing,
    bearing_problems,
    exact_loads,
    journal_results,
    load_results,
    side_by_side,
)
from linksweep.analysis.pins.bearing_life import rotation_under_load
from linksweep.base.degrees import cos_sin
from linksweep.base.validate import count_problems, refuse
from linksweep.results.cylinders import cylinders_between  # noqa: F401  (registers the sums that integrals are of)
from linksweep.results.cylinders.cylinder_sums import main
from linksweep.results.cylinders.multi_cylinder import NO_MAINS, MultiCylinder
from linksweep.results.dataset import by_command, joined

FRAMES = ("ground", "journal")
MAIN_TEXTS = TEXTS | {
    "F": ("N", "magnitude of the force of the main bearing on the crankshaft"),
    "Fx": ("N", "force of the main bearing on the crankshaft, component along the x axis of the frame"),
    "Fy": ("N", "force of the main bearing on the crankshaft, component along the y axis of the frame"),
    "rotation_speed": ("rad/s", "angular velocity of the crankshaft, positive counter-clockwise"),
}


def main_bearings(machine: MultiCylinder, pins: Mapping[str, Bearing] | None, theta2: int) -> xr.Dataset:
    """Return loads, rotation, friction and life of main bearings, as `linksweep.bearings` does of pins."""
    refuse(count_problems("theta2", theta2) + ([] if machine.mains else [f"main_positions: {NO_MAINS}"]))
    mains = {main(k): f"F_{main(k)}" for k in range(1, len(machine.mains) + 1)}
    refuse(bearing_problems(pins, mains, machine.engine))
    fitted = {name: (pins or {}).get(name, Bearing()) for name in mains}
    components = [f"{force}{axis}" for force in mains.values() for axis in ("", "x", "y")]
    cycle = machine.sweep(theta2, of=components)
    rotation = rotation_under_load(machine, mains, {name: b.exponent for name, b in fitted.items()})
    exact = exact_loads(machine, mains.values())
    speed = xr.DataArray(machine.engine.omega2)
    parts = [
        {"F": cycle[force]}
        | load_results(exact, force, fitted[name])
        | _in_frames(cycle, force)
        | journal_results(cycle, force, speed, xr.ones_like(cycle["theta2"]), fitted[name])
        | rotation.life(name, fitted[name].capacity, fitted[name].exponent)
        for name, force in mains.items()
    ]
    results = side_by_side(parts, "main", mains, MAIN_TEXTS)
    place = xr.DataArray(list(machine.mains), dims="main", attrs={"units": "m", "long_name": "place along the shaft"})
    attributes = cycle.attrs | by_command(f"linksweep.bearings(engine, ..., theta2={theta2})")
    coordinates = {**cycle.coords, "main_position": place}
    return xr.Dataset({**results, "status": cycle["status"]}, coordinates, attributes)


def _in_frames(cycle: xr.Dataset, force: str) -> dict[str, xr.DataArray]:
    """Return components in axes of the ground, which the bearing has, and of the crankshaft, which turn by theta2."""
    x, y = cycle[f"{force}x"], cycle[f"{force}y"]
    cos, sin = (xr.DataArray(wave, dims="theta2") for wave in cos_sin(cycle["theta2"].values))
    return {
        "Fx": joined([x, cos * x + sin * y], "frame", FRAMES),
        "Fy": joined([y, cos * y - sin * x], "frame", FRAMES),
    }
