"""Peaks of an engine of several cylinders: of its sums over the continuous cycle, and of each cylinder's pins."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from linksweep.base.validate import name_problems
from linksweep.results.compute import assembly_of, requested
from linksweep.results.cylinders.cylinders_between import exact_peaks_together
from linksweep.results.cylinders.multi_cylinder import SHAKING, MultiCylinder
from linksweep.results.dataset import design_coordinates, joined, origin_attributes, variable
from linksweep.results.peak_search.exact import Found
from linksweep.results.peak_search.quadrature import means_at
from linksweep.results.peaks import STATUS_ANGLES, Averages, Wanted, named, peaks, status_of, wanted
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene


def peaks_of_cylinders(machine: MultiCylinder, of: Iterable[str] | None, threads: int | None = None) -> xr.Dataset:
    """Return the worst of each quantity of an engine, as `linksweep.peaks` does.

    Forces in the pins of the cylinders are over the dim `cylinder`, counted from 1.
    """
    names = [name for name in SHAKING if name not in ("Fsx", "Fsy")] if of is None else requested("of", of)
    pins = [name for name in names if name.partition("_")[0] in machine.pin_forces and name not in machine.quantity]
    sums = wanted(
        machine.quantity,
        [name for name in names if name not in pins],
        lambda name: name_problems("of", name, [*machine.quantity, *machine.pin_forces]),
    )
    found = _of_sums(machine, sums, threads)
    if pins:
        each = _of_each(machine, pins, threads)
        status = xr.where(each["status"] > found["status"], each["status"], found["status"], keep_attrs=True)
        found = found.assign(each.drop_vars("status").data_vars).assign(status=status)
    return found.assign_attrs(command=f"linksweep.peaks(engine{'' if of is None else f', of={names}'})")


def _of_sums(machine: MultiCylinder, sums: list[Wanted], threads: int | None) -> xr.Dataset:
    signals = tuple(dict.fromkeys(signal for item in sums for signal in item.signals))
    powers = tuple(dict.fromkeys(power for item in sums for power in item.powers))
    found = exact_peaks_together(machine, signals, threads) if signals else {}
    averages = means_at((), machine, powers, threads) if powers else {}
    each = [_status(scene, found, averages, threads) for scene in machine.cylinders]
    sampled = machine.engine.at_one_angle
    order, spot = tuple(sampled.inputs.sizes), sampled.mechanism.spot
    variables = {
        name: variable(field, units, said, order)
        for item in sums
        for name, field, units, said in named(item, found, averages, spot)
    }
    worst = xr.Variable(each[0].dims, np.max([status.values for status in each], axis=0), each[0].attrs)
    return xr.Dataset(
        variables | {"status": worst}, design_coordinates(sampled), origin_attributes(machine.engine, "")
    ).assign_attrs(title="linksweep: MultiCylinder")


def _status(scene: Scene, found: dict[str, Found], averages: Averages, threads: int | None) -> xr.Variable:
    """Return the status of the sums by one cylinder; where it has none that is ok, they become NaN."""
    grid = crank_grid(STATUS_ANGLES, scene.period)
    return status_of(scene, scene.at_one_angle, grid, assembly_of(scene, threads), found, averages, threads)


def _of_each(machine: MultiCylinder, names: list[str], threads: int | None) -> xr.Dataset:
    """Return peaks of each cylinder's own pin forces, at crank angles of the engine."""
    once = {scene: peaks(scene, names, threads=threads) for scene in machine.cylinders}
    each = [_ahead(once[s], t.ahead, machine.period) for s, t in zip(machine.cylinders, machine.throws, strict=True)]
    labels = np.arange(1, len(each) + 1)
    found = {str(name): joined([one[name] for one in each], "cylinder", labels) for name in each[0].data_vars}
    found = {name: values.assign_attrs(each[0][name].attrs) for name, values in found.items()}
    return xr.Dataset(found | {"status": found["status"].max("cylinder").assign_attrs(each[0]["status"].attrs)})


def _ahead(found: xr.Dataset, ahead: float, period: float) -> xr.Dataset:
    """Return peaks of a cylinder with their angles counted by the engine's crank."""
    at = [name for name in found.data_vars if str(name).endswith("_at")]
    return found.assign({name: ((found[name] - ahead) % period).assign_attrs(found[name].attrs) for name in at})
