"""Compute the peaks of an engine of several cylinders: of its sums over the cycle, and of each cylinder's pins."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from linksweep.base.validate import name_problems
from linksweep.results.compute import assembly_of, requested
from linksweep.results.cylinders.cylinders_between import exact_peaks_of_sums
from linksweep.results.cylinders.multi_cylinder import SHAKING, MultiCylinder
from linksweep.results.dataset import design_coordinates, joined, origin_attributes, variable
from linksweep.results.peak_search.along_paths import SignalPeak
from linksweep.results.peak_search.quadrature import means_at
from linksweep.results.peaks import STATUS_ANGLES, Averages, Request, named, parsed_requests, peaks, status_of
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene


def peaks_of_cylinders(machine: MultiCylinder, of: Iterable[str] | None, threads: int | None = None) -> xr.Dataset:
    """Return the peaks of an engine, as `linksweep.peaks` does.

    Forces in the pins of the cylinders are over the dim `cylinder`, counted from 1.
    """
    names = [name for name in SHAKING if name not in ("Fsx", "Fsy")] if of is None else requested("of", of)
    pins = [name for name in names if name.partition("_")[0] in machine.pin_forces and name not in machine.quantity]
    sums = parsed_requests(
        machine.quantity,
        [name for name in names if name not in pins],
        lambda name: name_problems("of", name, [*machine.quantity, *machine.pin_forces]),
    )
    ds = _of_sums(machine, sums, threads)
    if pins:
        each = _of_pins(machine, pins, threads)
        status = xr.where(each["status"] > ds["status"], each["status"], ds["status"], keep_attrs=True)
        ds = ds.assign(each.drop_vars("status").data_vars).assign(status=status)
    return ds.assign_attrs(command=f"linksweep.peaks(engine{'' if of is None else f', of={names}'})")


def _of_sums(machine: MultiCylinder, sums: list[Request], threads: int | None) -> xr.Dataset:
    """Return the peaks and means of sums over the cylinders."""
    signals = tuple(dict.fromkeys(signal for item in sums for signal in item.signals))
    powers = tuple(dict.fromkeys(power for item in sums for power in item.powers))
    extremes = exact_peaks_of_sums(machine, signals, threads) if signals else {}
    averages = means_at((), machine, powers, threads) if powers else {}
    each = [_status(scene, extremes, averages, threads) for scene in machine.cylinders]
    sampled = machine.engine.at_one_angle
    order, spot = tuple(sampled.inputs.sizes), sampled.mechanism.spot
    variables = {
        name: variable(field, units, long_name, order)
        for item in sums
        for name, field, units, long_name in named(item, extremes, averages, spot)
    }
    worst = xr.Variable(each[0].dims, np.max([status.values for status in each], axis=0), each[0].attrs)
    return xr.Dataset(
        variables | {"status": worst}, design_coordinates(sampled), origin_attributes(machine.engine, "")
    ).assign_attrs(title="linksweep: MultiCylinder")


def _status(scene: Scene, extremes: dict[str, SignalPeak], averages: Averages, threads: int | None) -> xr.Variable:
    """Return the status of one cylinder, and make the sums NaN where none of its samples is ok."""
    grid = crank_grid(STATUS_ANGLES, scene.period)
    return status_of(scene, scene.at_one_angle, grid, assembly_of(scene, threads), extremes, averages, threads)


def _of_pins(machine: MultiCylinder, names: list[str], threads: int | None) -> xr.Dataset:
    """Return the peaks of each cylinder's own pin forces, at crank angles of the engine."""
    once = {scene: peaks(scene, names, threads=threads) for scene in machine.cylinders}  # cylinders of a bank are equal
    each = [_shifted(once[s], t.ahead, machine.period) for s, t in zip(machine.cylinders, machine.throws, strict=True)]
    labels = np.arange(1, len(each) + 1)
    arrays = {str(name): joined([one[name] for one in each], "cylinder", labels) for name in each[0].data_vars}
    arrays = {name: values.assign_attrs(each[0][name].attrs) for name, values in arrays.items()}
    return xr.Dataset(arrays | {"status": arrays["status"].max("cylinder").assign_attrs(each[0]["status"].attrs)})


def _shifted(peaks_ds: xr.Dataset, ahead: float, period: float) -> xr.Dataset:
    """Return a cylinder's peaks with their angles counted by the engine's crank."""
    at = {name: angle for name, angle in peaks_ds.data_vars.items() if str(name).endswith("_at")}
    return peaks_ds.assign({name: ((angle - ahead) % period).assign_attrs(angle.attrs) for name, angle in at.items()})
