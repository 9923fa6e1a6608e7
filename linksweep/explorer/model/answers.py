"""Answers about a scene: the numbers from which the page draws a cycle, and exact peaks and checks as text."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from linksweep.explorer.model.controls import written
from linksweep.mechanisms.drawing import Drawing
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import force_color
from linksweep.plot.kit.drawings import drawing_of
from linksweep.plot.kit.load_symbols import LoadSymbol, load_symbols
from linksweep.plot.kit.shape import axes_of, centres_of, curve_of, places_of, positions
from linksweep.results.check import check
from linksweep.results.origin.in_shown_units import in_shown_units
from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import SI, UnitSystem
from linksweep.tables.of_check import check_table

ANGLES = 720  # in a turn


def cycle(scene: Scene, system: UnitSystem = SI) -> dict[str, Any]:
    """Return a cycle of a scene of one design, for the page to draw, in its units.

    Returns
    -------
    dict
        ``step`` and ``turn`` [degree]; ``pins``, ``curve``, ``blocks``: places and directions at each angle of the
        motion; ``forces`` and ``drive`` at each angle of the cycle. Arrays are float32, (2, angles) for x and y; of
        what stands still (2, 1). NaN where there is no result.
    """
    drawing = drawing_of(scene.mechanism)
    motion = positions(scene, drawing, [])
    places = places_of(scene, drawing, motion)
    still = drawing.fixed(scene.mechanism)
    turn = scene.period
    drive = scene.mechanism.drives[scene.drive]
    effort = sweep(
        scene, round(ANGLES * turn / 360.0), of=[*(f"{f}{axis}" for f in drawing.forces for axis in "xy"), drive]
    )
    count = effort.sizes["theta2"]
    metre, newton, of_drive = (system.size(unit) for unit in ("m", "N", scene.table.quantity[drive].units))
    return {
        "step": 360.0 / ANGLES,
        "turn": turn,
        "pins": {pin: _packed((place[:, :1] if pin in still else place) / metre) for pin, place in places.items()},
        "curve": _packed(curve_of(scene, drawing, motion, places) / metre),
        "blocks": [_packed(axes_of(scene, motion, block.sides)) for block in drawing.blocks],
        "rails": [_rail(scene, block.guide, metre) for block in drawing.blocks],
        "wheels": [[pin, float(radius) / metre] for pin, radius in drawing.wheels(scene.mechanism)],
        "forces": {force: _packed(_force(effort, force, count) / newton) for force in drawing.forces},
        "centres": [_packed(place / metre) for place in centres_of(scene, drawing, motion, places).values()],
        "loads": [_load(load, metre, newton) for load in load_symbols(scene, drawing, motion, places, count)],
        "drive": _packed(signals.spread(effort[drive], count) / of_drive),
        "rate": float(np.nanmean(scene.omega2)) if not callable(scene.omega2) else 1.0,
        "problem": _gaps(effort),
    }


def picture(scene: Scene, system: UnitSystem = SI) -> dict[str, Any]:
    """Return the parts of a machine that the page draws, with their names and units, whatever its numbers are."""
    drawing = drawing_of(scene.mechanism)
    drive = scene.mechanism.drives[scene.drive]
    return {
        "links": [{"number": number, "pins": list(pins)} for number, pins in drawing.bars.items()],
        "ground": list(drawing.fixed(scene.mechanism)),
        "blocks": [{"number": b.number, "pin": b.pin, "on": list(b.on) if b.on else None} for b in drawing.blocks],
        "cylinders": [list(ends) for ends in drawing.telescopes],
        "forces": [_named(drawing, force) for force in drawing.forces],
        "drive": {"name": drive, "unit": written(system.unit(scene.table.quantity[drive].units))},
        "units": {"length": written(system.unit("m")), "force": written(system.unit("N"))},
    }


def exact(scene: Scene, system: UnitSystem = SI) -> dict[str, Any]:
    """Return exact peaks and checks of a scene, as rows for tables."""
    findings = check_table(in_shown_units(check(scene), system)).rows
    return {
        "peaks": [*_peaks(in_shown_units(peaks(scene), system))],
        "checks": [(title.strip().removesuffix(":"), text) for title, text in findings if text != "none"],
    }


def _packed(values: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(values, dtype=np.float32)


def _rail(scene: Scene, guide: Any, metre: float) -> list[list[float]] | None:
    """Return a point and the direction of a guide on the ground."""
    if guide is None:
        return None
    rail = guide(scene.mechanism)
    return [[float(number) for number in part] for part in (rail.point / metre, rail.along)]


def _load(load: LoadSymbol, metre: float, newton: float) -> dict[str, Any]:
    """Return the symbol of a load: its kind, place, and what else it has; of a torque only the sense matters."""
    parts = {"place": (load.place, metre), "force": (load.force, newton), "end": (load.end, metre)}
    arrays = {name: _packed(row / size) for name, (row, size) in parts.items() if row is not None}
    sense = {} if load.torque is None else {"torque": _packed(load.torque)}
    return {"name": load.name, "kind": load.kind, **arrays, **sense}


def _force(cycle: xr.Dataset, force: str, count: int) -> np.ndarray:
    return np.array([signals.spread(cycle[f"{force}{axis}"], count) for axis in "xy"])


def _named(drawing: Drawing, force: str) -> dict[str, Any]:
    joint = drawing.joint_text(force)
    return {"name": force, "pin": drawing.start_of(force), "joint": joint, "color": force_color(force)}


def _gaps(cycle: xr.Dataset) -> str:
    """Return where a cycle has no result, in a sentence; "" where it is whole."""
    status = signals.spread(cycle["status"], cycle.sizes["theta2"]).astype(int)
    words = str(cycle["status"].attrs["flag_meanings"]).split()
    lost = [word.replace("_", " ") for k, word in enumerate(words) if k and np.any(status == k)]
    share = np.count_nonzero(status) / status.size
    return f"no result at {share:.0%} of the angles: {', '.join(lost)}" if lost else ""


def _peaks(ds: xr.Dataset) -> Iterator[dict[str, Any]]:
    """Yield a row for each peak of a magnitude, and for maximum and minimum of a signed quantity."""
    for name in map(str, ds.data_vars):
        quantity, _, end = name.rpartition("_")
        signed = f"{quantity}_max" in ds
        if f"{name}_at" in ds and (end != "peak" or not signed):
            row = {
                "name": quantity,
                "end": end if signed else "",
                "value": float(ds[name]),
                "at": float(ds[f"{name}_at"]),
            }
            yield row | {"unit": written(str(ds[name].attrs["units"]))}
