"""The tables of a report: peaks, drive, geometry, motion, shaking."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from linksweep.reports.markup import NONE, Markup, angle, joined, number, symbol, table, tag, tiny
from linksweep.reports.results_of_page import Results
from linksweep.reports.units_of_page import distance, measure, stress
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import UnitSystem

NOISE = 1e-12  # of the terms of a mean: the rounding of a sum that cancels
WORKS = {
    "work_fed": "work fed in a cycle",
    "work_regenerated": "work taken back or braked",
    "work_of_loads": "work of the loads",
    "work_of_friction": "work of friction",
}
JOINT = re.compile(r"\((.*?)\) on link .*?\((.*?)\) at (?:pin (\w+)|the ([^:,]+))")
"""Two links, and the pin or the slide at which the first acts on the second, in the words of a quantity."""
FIBRES = "Largest stress of the extreme fibres, without concentration at eyes, and safeties against failure."
SHAKEN = {"Fs": "N", "Ms": "N m"}


def peaks(results: Results) -> Markup:
    """Return the table of peaks: value, angle, bound, and for a whole revolution the means."""
    more = [kind for kind in ("bound", "mean", "rms") if f"{results.forces[0]}_{kind}" in results.peaks]
    header = ("", "", "peak", f"at {symbol(results.scene.mechanism.index.replace('theta', 'θ'))}", *more)
    rows = [row for name in results.forces for row in _peak(results, name, more)]
    return table(header, rows, class_="peaks")


def _peak(results: Results, name: str, more: list[str]) -> Iterator[tuple[Any, ...]]:
    """Yield a row for a magnitude; for a signed quantity one for its largest and one for its least value."""
    worst, quantity = results.peaks, results.scene.table.quantity[name]
    size, in_unit = float(worst[f"{name}_peak"]), partial(_of, unit=quantity.units, system=results.system)
    bound = partial(results.system.value, si=quantity.units)
    rest = [_summary(size, kind, float(worst[f"{name}_{kind}"]), in_unit, bound) for kind in more]
    ends = {"_max": ", largest", "_min": ", least"} if f"{name}_max" in worst else {"_peak": ""}
    for ending, suffix in ends.items():
        value, spot = float(worst[name + ending]), float(worst[f"{name}{ending}_at"])
        what = tag("span", _where(results.scene, name) + suffix, title=quantity.long_name)
        yield symbol(name), what, in_unit(size, value), angle(spot), *(rest if ending != "_min" else [""] * len(rest))


def _summary(
    size: float, kind: str, value: float, in_unit: Callable[[float, float], Markup], bound: Callable[[float], float]
) -> str:
    if kind == "bound":
        return tiny(bound(value)) if np.isfinite(size) else NONE
    return in_unit(size, value)


def _where(scene: Scene, name: str) -> str:
    """Return the joint of a force and its two links, "pin B: coupler on crank"; else the quantity's name."""
    name_in_words = scene.table.quantity[name].long_name
    if name in scene.mechanism.drives.values():
        return f"drive of the {scene.drive}" if name.startswith("T") else "drive, positive where it pushes"
    joint = JOINT.search(name_in_words)
    if not joint:
        return name_in_words.split(" on the ")[0].split(" about ")[0]
    here, there, pin, slide = joint.groups()
    return f"{f'pin {pin}' if pin else slide}: {here} on {there}"


def drive(results: Results) -> Markup:
    """Return the table of power; for a whole revolution work as well, for a steady crank its flywheel."""
    if "power_peak" not in results.peaks:
        return Markup()
    system = results.system
    ends = _range(float(results.peaks["power_min"]), float(results.peaks["power_max"]), "W", system)
    of_cycle = [] if results.duty is None else works(results.duty, system)
    return table((), [("power", ends), *of_cycle, *flywheels(results.flywheel, system)], class_="numbers")


def works(work: xr.Dataset, system: UnitSystem) -> list[tuple[Any, ...]]:
    """Return the rows of the mean power and of the works of a cycle."""
    most = max(abs(float(work[f"power_{end}"])) for end in ("max", "min"))
    turned = float(abs(work["work_fed"]) + abs(work["work_regenerated"]))
    rows = [(title, _of(turned, float(work[name]), "J", system)) for name, title in WORKS.items() if name in work]
    return [("mean power", _of(most, float(work["power_mean"]), "W", system)), *rows]


def flywheels(sizes: xr.Dataset | None, system: UnitSystem) -> Iterator[tuple[Any, ...]]:
    """Yield a row for each flywheel that can be made."""
    for one in sizes["target"].values if sizes is not None else ():
        size = float(sizes["flywheel_inertia"].sel(target=one))  # type: ignore[index]
        if np.isfinite(size):
            yield joined(f"flywheel for {100.0 * one:g} % fluctuation"), measure(size, "kg m^2", system)


def geometry(results: Results) -> Markup:
    """Return the table of swing, stroke, time ratio and reversals; empty where nothing swings or slides."""
    shape = results.geometry
    rows: list[tuple[Any, ...]] = []
    if shape is None:
        return Markup()
    if "swing" in shape:
        rows.append(("swing of the rocker", angle(float(shape["swing"]), 2)))
    if "stroke" in shape:
        rows.append(("stroke of the slider", distance(float(shape["stroke"]), results.system)))
    rows += [
        _travel(shape, str(name).removesuffix("_travel"), results.system)
        for name in shape
        if str(name).endswith("_travel")
    ]
    if "time_ratio" in shape:
        rows.append(("time ratio", number(float(shape["time_ratio"]))))
        turns = [angle(float(one), 2) for one in _reversals(results) if np.isfinite(one)]
        rows.append(("turns round at", Markup(", ".join(turns)) if turns else NONE))
    return table((), _there(rows), class_="numbers") if _there(rows) else Markup()


def _travel(shape: xr.Dataset, name: str, system: UnitSystem) -> tuple[str, Any]:
    """Return the row of a position's travel: its size, the time ratio, and the crank angles of its ends."""
    size, ratio = float(shape[f"{name}_travel"]), float(shape[f"{name}_time_ratio"])
    ends = sorted(float(shape[f"{name}_{end}_at"]) for end in ("min", "max"))
    _, _, title = str(shape[f"{name}_travel"].attrs["long_name"]).partition(": ")
    of_length = shape[f"{name}_travel"].attrs["units"] == "m"
    text = distance(size, system) if of_length else angle(size, 2)
    turns = joined(angle(ends[0], 2), " and ", angle(ends[1], 2))
    words = joined("travel ", text, ", time ratio ", number(ratio), ", turns round at ", turns)
    return title.split(",")[0].split(" from ")[0], words if np.isfinite(size) else NONE


def _reversals(results: Results) -> Iterable[float]:
    """Return the crank angles of reversal on the machine's own branch."""
    angles: xr.DataArray = results.geometry["reversal_angle"]  # type: ignore[index]
    branch = results.scene.mechanism.branch
    labels = angles[angles.dims[0]].values
    own = [label for label in labels if str(label).startswith(branch)] or list(labels)
    return angles.sel({angles.dims[0]: own}).values


def shaking(results: Results) -> Markup:
    """Return the table of the force and the moment of the links' inertia on the ground."""
    worst = results.peaks
    if not {"Fs_peak", "Ms_peak"} <= {*worst}:
        return Markup()
    at = float(worst["Fs_peak_at"])
    at = at % results.inertia_period if results.part is None else at
    force = joined(measure(float(worst["Fs_peak"]), "N", results.system), " at ", angle(at))
    moment = _range(float(worst["Ms_min"]), float(worst["Ms_max"]), "N m", results.system)
    rows = {"Fs": ("force", force), "Ms": ("moment about A", moment)}
    return table((), (_with_rms(results, name, row) for name, row in rows.items()), class_="numbers")


def _with_rms(results: Results, name: str, row: tuple[str, Markup]) -> tuple[str, Markup]:
    """Append the root mean square, for a whole revolution."""
    if not results.whole:
        return row
    size, mean = (float(results.peaks[f"{name}_{kind}"]) for kind in ("peak", "rms"))
    rms = _of(size, mean, SHAKEN[name], results.system)
    return row[0], joined(row[1], ", rms ", rms)


def strength(results: Results) -> Markup:
    """Return the table of the links' worst stress and safeties; empty where no material is stated."""
    ds = results.strength
    if ds is None:
        return Markup()
    least = ds["buckling_safety"].min("plane")
    rows = []
    for link in map(str, ds["link"].values):
        one = {str(name): float(ds[name].sel(link=link)) for name in ds.data_vars if ds[name].dims == ("link",)}
        place = joined(f"{100.0 * one['stress_section']:.0f} % of its length, ", angle(one["stress_at"]))
        numbers = [one[f"{name}_safety"] for name in ("yield", "goodman", "soderberg")]
        numbers += [float(least.sel(link=link)), *([one["life"]] if "life" in one else [])]
        rows.append((link, stress(one["stress"], results.system), place, *map(number, numbers)))
    header = ("link", "stress", "at", "yield", "Goodman", "Soderberg", "buckling", "life in cycles")
    of_links = table(header[: len(rows[0])], rows)
    return joined(of_links, tag("p", FIBRES, class_="note"))


def highlights(results: Results) -> Markup:
    """Return the table of a mechanism's highlights: the range of a signed quantity, the peak of a magnitude."""
    rows = [(title, _highlight(results, name)) for name, title in results.scene.mechanism.highlights.items()]
    return table((), rows, class_="numbers") if rows else Markup()


def _highlight(results: Results, name: str) -> Markup:
    peaks, system, unit = results.peaks, results.system, results.scene.table.quantity[name].units
    if f"{name}_min" in peaks:
        ends = (measure(float(peaks[f"{name}_{end}"]), unit, system) for end in ("min", "max"))
        return joined(next(ends), " to ", next(ends))
    return joined(measure(float(peaks[f"{name}_peak"]), unit, system), " at ", angle(float(peaks[f"{name}_peak_at"])))


def _range(low: float, high: float, unit: str, system: UnitSystem) -> Markup:
    """Return two numbers with their one unit."""
    return joined(number(float(system.value(low, unit))), " to ", measure(high, unit, system))


def _of(size: float, value: float, unit: str, system: UnitSystem) -> Markup:
    """Return a number, 0 where it is the rounding of terms of this size."""
    return measure(value, unit, system, "0" if abs(value) <= NOISE * size else "")


def _there(rows: list[tuple[Any, ...]]) -> list[tuple[Any, ...]]:
    """Return the rows that have a number."""
    return [row for row in rows if row[1] != NONE]
