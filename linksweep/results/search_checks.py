"""Check by search where a machine closes that has no closed form of it, and how well it transmits, pin by pin."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from linksweep.chains.finding import ASSEMBLY, Array
from linksweep.engine.quantity import opposite_of
from linksweep.engine.run import Field
from linksweep.results.dataset import flags
from linksweep.results.peak_search.exact import exact_peaks
from linksweep.results.peak_search.limits import assembly_of, limits_of
from linksweep.scene.dimensions import aligned
from linksweep.scene.scene import Scene

STEADY = 1e-9
"""Change of a transmission angle that is rounding [degree]: such an angle is the same throughout."""


def search_checks(scene: Scene) -> dict[str, xr.Variable]:
    """Return assembly, arcs, toggles and extreme transmission angles by pin; nothing where closed forms exist."""
    if scene.table.limits is None:
        return {}
    toggles = [k for k, limit in enumerate(scene.table.limits) if limit.zeros == "toggle"]
    pins = [scene.table.limits[k].name for k in toggles]
    sizes, limits = limits_of(scene.unloaded)
    tables = {
        "arc_start": (limits.arc_start, ("arc",), "crank angle at which an assembled arc starts"),
        "arc_end": (limits.arc_end, ("arc",), f"crank angle at which it ends (may pass {scene.period_of_motion:g})"),
        "toggle_angle": (_numbers(limits.zeros[:, toggles]), ("pin", "toggle"), "crank angle of a toggle at this pin"),
    }
    assembly = np.reshape(limits.assembly, tuple(sizes.values())).astype(np.int8)
    meanings = flags("crank angles at which it can be assembled", ASSEMBLY)
    variables = {"assembly": xr.Variable(tuple(sizes), assembly, meanings), "pin": xr.Variable("pin", pins)}
    for name, (table, dims, words) in tables.items():
        values = table.reshape(*sizes.values(), *table.shape[1:])
        variables[name] = xr.Variable((*sizes, *dims), values, {"units": "degree", "long_name": words})
    return variables | (_transmission_angles(scene.unloaded, pins) if pins else {})


def _numbers(table: Array) -> Array:
    """Return a table without those columns that hold no number."""
    return table[..., ~np.isnan(table).all(axis=(0, 1))]


def _transmission_angles(scene: Scene, pins: Iterable[str]) -> dict[str, xr.Variable]:
    """Return the extreme transmission angles of the continuous revolution at these pins, and their crank angles."""
    names = [f"transmission_angle_{pin}" for pin in pins]
    peaks = exact_peaks(scene, (*names, *map(opposite_of, names)), assembly_of(scene))
    variables = {}
    kinds = {"max": ("largest", names), "min": ("smallest", [*map(opposite_of, names)])}
    most, least = (_by_pin(scene, [peaks[signal][0] for signal in signals]) for _, signals in kinds.values())
    steady = most.values + least.values <= STEADY
    for kind, (extreme, signals) in kinds.items():
        words = f"{extreme} acute transmission angle at this pin"
        value, angle = (_by_pin(scene, [peaks[signal][k] for signal in signals]) for k in (0, 1))
        attributes = {"units": "degree", "long_name": words}
        variables[f"transmission_angle_{kind}"] = xr.Variable(value.dims, abs(value.values), attributes)
        attributes = {"units": "degree", "long_name": f"crank angle of the {words}"}
        variables[f"transmission_angle_{kind}_at"] = xr.Variable(
            angle.dims, np.where(steady, np.nan, angle.values), attributes
        )
    return variables


def _by_pin(scene: Scene, fields: list[Field]) -> Field:
    """Return the fields of all pins, which may lack dims of each other, as one over the dim `pin` as well."""
    dims = tuple(dim for dim in scene.inputs.sizes if any(dim in field.dims for field in fields))
    return Field((*dims, "pin"), np.stack(np.broadcast_arrays(*(aligned(field, dims) for field in fields)), axis=-1))
