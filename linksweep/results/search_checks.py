"""Check by search where a machine closes that has no closed form of it, where its drive stands still and friction jams
it, and how well it transmits, pin by pin."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from linksweep.chains.finding import ASSEMBLY, Array
from linksweep.engine.quantity import opposite_of
from linksweep.engine.run import Field
from linksweep.results.compute import counts_without_angles
from linksweep.results.dataset import flags
from linksweep.results.peak_search.between import NEVER
from linksweep.results.peak_search.exact import exact_peaks
from linksweep.results.peak_search.friction.jams import jam_tables, may_jam
from linksweep.results.peak_search.limits import Limits, assembly_of, limits_of, signals_of
from linksweep.scene.dimensions import aligned
from linksweep.scene.pairs import different_designs, quantities_at
from linksweep.scene.scene import Scene

FAILING = 72
"""Crank angles at which a design that never closes is asked where it fails."""
STEADY = 1e-9
"""Change of a transmission angle that is rounding [degree]: such an angle is the same throughout."""


def search_checks(scene: Scene) -> dict[str, xr.Variable]:
    """Return assembly, arcs, toggles and extreme transmission angles by pin, dead centres of the drive, and jams;
    nothing where closed forms exist."""
    if scene.table.limits is None:
        return {}
    pins = [name for name in scene.mechanism.places if f"transmission_angle_{name}" in scene.table.quantity]
    variables = _of_motion(scene, pins)
    if pins:
        variables |= _transmission_angles(scene.unloaded, pins)
    if may_jam(scene) and not counts_without_angles(scene):
        variables |= _jams(scene)
    return variables


def _of_motion(scene: Scene, pins: list[str]) -> dict[str, xr.Variable]:
    """Return assembly, arcs, toggles by pin, and dead centres of a drive other than the crank."""
    sizes, limits = limits_of(scene.unloaded)
    tables = {
        "arc_start": (limits.arc_start, ("arc",), "crank angle at which an assembled arc starts"),
        "arc_end": (limits.arc_end, ("arc",), f"crank angle at which it ends (may pass {scene.period_of_motion:g})"),
        "toggle_angle": (
            _numbers(_toggles(scene, limits, pins)),
            ("pin", "toggle"),
            "crank angle of a toggle at this pin",
        ),
    }
    if scene.drive != scene.mechanism.roles[0]:
        dead_centres = _numbers(limits.zeros_of(scene.table.limits or (), "dead_centre"))
        tables["dead_centre_angle"] = dead_centres, ("dead_centre",), f"crank angle at which {scene.drive} stands still"
    assembly = np.reshape(limits.assembly, tuple(sizes.values())).astype(np.int8)
    meanings = flags("crank angles at which it can be assembled", ASSEMBLY)
    variables = {"assembly": xr.Variable(tuple(sizes), assembly, meanings), "pin": xr.Variable("pin", pins)}
    words = "pin, or link past a pin, that fails first at most crank angles where a design never closes"
    fails_at = _fails_at(scene.unloaded, limits.assembly).reshape(assembly.shape)
    variables["fails_at"] = xr.Variable(tuple(sizes), fails_at, flags(words, ("none", *scene.mechanism.places)))
    for name, (table, dims, words) in tables.items():
        values = table.reshape(*sizes.values(), *table.shape[1:])
        variables[name] = xr.Variable((*sizes, *dims), values, {"units": "degree", "long_name": words})
    return variables


def _fails_at(unloaded: Scene, assembly: Array) -> Array:
    """Return the number of the place at which each design that never closes fails first at most crank angles, as
    `status_at` counts them; 0 for others."""
    fails_at, never = np.zeros(len(assembly), dtype=np.int8), np.flatnonzero(assembly == NEVER)
    if len(never):
        designs = different_designs(unloaded, signals_of(unloaded.table.limits or ()))[never]
        angles = np.arange(FAILING) * (unloaded.period_of_motion / FAILING)
        pairs = np.repeat(designs, FAILING), np.tile(angles, len(never))
        place = quantities_at(unloaded, ("status_at",), *pairs).reshape(len(never), FAILING)
        counts = [np.count_nonzero(place == k, axis=1) for k in range(1, 1 + len(unloaded.mechanism.places))]
        fails_at[never] = 1 + np.argmax(counts, axis=0)
    return fails_at


def _toggles(scene: Scene, limits: Limits, pins: list[str]) -> Array:
    """Return the toggles (design, pin, nth) of pins; NaN for those that close at every angle, and for none."""
    toggles = np.full((len(limits.zeros), len(pins), limits.zeros.shape[2]), np.nan)
    for k, limit in enumerate(scene.table.limits or ()):
        if limit.zeros == "toggle":
            toggles[:, pins.index(limit.name)] = limits.zeros[:, k]
    return toggles


def _numbers(table: Array) -> Array:
    """Return a table without those columns that hold no number."""
    return table[..., ~np.isnan(table).all(axis=tuple(range(table.ndim - 1)))]


def _jams(scene: Scene) -> dict[str, xr.Variable]:
    """Return the arcs of crank angles at which friction jams a slide, and its place."""
    dims, start, end, place = jam_tables(scene)
    places = flags("pin, or link past a pin, whose slide friction jams on this arc", ("none", *scene.mechanism.places))
    degrees = {"units": "degree"}
    words = {"start": "crank angle at which friction begins to jam a slide", "end": "crank angle at which that ends"}
    return {
        "jam_start": xr.Variable((*dims, "jam"), start, degrees | {"long_name": words["start"]}),
        "jam_end": xr.Variable(
            (*dims, "jam"), end, degrees | {"long_name": f"{words['end']} (may pass {scene.period:g})"}
        ),
        "jam_place": xr.Variable((*dims, "jam"), np.nan_to_num(place).astype(np.int8), places),
    }


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
    dims = tuple(dim for dim in scene.at_one_angle.inputs.sizes if any(dim in field.dims for field in fields))
    return Field((*dims, "pin"), np.stack(np.broadcast_arrays(*(aligned(field, dims) for field in fields)), axis=-1))
