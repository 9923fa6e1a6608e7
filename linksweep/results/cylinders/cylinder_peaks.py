"""Compute the peaks of an engine of several cylinders: of its sums over the cycle, and of each cylinder's pins."""

from __future__ import annotations

import numpy as np
import xarray as xr

from linksweep.results.cylinders.cylinders_between import exact_peaks_of_sums
from linksweep.results.cylinders.multi_cylinder import SHAKING, MultiCylinder, attributes_of, quantity_problems
from linksweep.results.dataset import design_coordinates, joined
from linksweep.results.peak_search.along_paths import angle_in_period
from linksweep.results.peak_search.limits import assembly_of
from linksweep.results.peak_search.quadrature import means
from linksweep.results.scene_peaks import (
    STATUS_ANGLES,
    Request,
    Result,
    labelled,
    needed,
    parsed_requests,
    peaks_of_scene,
    status_of,
)
from linksweep.scene.grid import crank_grid


def peaks_of_cylinders(machine: MultiCylinder, of: list[str] | None) -> xr.Dataset:
    """Return the peaks of an engine, as `linksweep.peaks` does.

    Forces in the pins of the cylinders are over the dim `cylinder`, counted from 1.
    """
    names = [name for name in SHAKING if name not in ("Fsx", "Fsy")] if of is None else of
    pins = [name for name in names if name.partition("_")[0] in machine.pin_forces and name not in machine.quantity]
    sums = parsed_requests(
        machine.quantity,
        [name for name in names if name not in pins],
        lambda name: quantity_problems(machine, "of", name, *machine.pin_forces),
    )
    ds = _of_sums(machine, sums)
    if pins:
        each = _of_pins(machine, pins)
        status = xr.where(each["status"] > ds["status"], each["status"], ds["status"], keep_attrs=True)
        ds = ds.assign(each.drop_vars("status").data_vars).assign(status=status)
    return ds.assign_attrs(command=f"linksweep.peaks(engine{'' if of is None else f', of={names}'})")


def _of_sums(machine: MultiCylinder, sums: list[Request]) -> xr.Dataset:
    """Return the peaks and means of sums over the cylinders."""
    (signals, powers), grid = needed(sums), crank_grid(STATUS_ANGLES, machine.period)
    largest = exact_peaks_of_sums(machine, signals) if signals else {}
    averages = means(machine, powers, (), None) if powers else {}
    results = [
        Result(s.at_one_angle, grid, assembly_of(s), s.table.limits is not None, largest, averages)
        for s in machine.cylinders
    ]
    # sums become NaN where none of a cylinder's samples is ok
    each = [status_of(*pair) for pair in zip(machine.cylinders, results, strict=True)]
    worst = xr.Variable(each[0].dims, np.max([status.values for status in each], axis=0), each[0].attrs)
    variables, coordinates = labelled(sums, results[0]) | {"status": worst}, design_coordinates(results[0].sampled)
    return xr.Dataset(variables, coordinates, attributes_of(machine, ""))


def _of_pins(machine: MultiCylinder, names: list[str]) -> xr.Dataset:
    """Return the peaks of each cylinder's own pin forces, at crank angles of the engine."""
    once = {scene: peaks_of_scene(scene, names) for scene in machine.cylinders}  # cylinders of a bank are equal
    each = [_shifted(once[s], t.ahead, machine.period) for s, t in zip(machine.cylinders, machine.throws, strict=True)]
    labels = np.arange(1, len(each) + 1)
    arrays = {str(name): joined([one[name] for one in each], "cylinder", labels) for name in each[0].data_vars}
    arrays = {name: values.assign_attrs(each[0][name].attrs) for name, values in arrays.items()}
    return xr.Dataset(arrays | {"status": arrays["status"].max("cylinder").assign_attrs(each[0]["status"].attrs)})


def _shifted(peaks_ds: xr.Dataset, ahead: float, period: float) -> xr.Dataset:
    """Return a cylinder's peaks with their angles counted by the engine's crank."""
    at = {name: angle for name, angle in peaks_ds.data_vars.items() if str(name).endswith("_at")}
    return peaks_ds.assign({n: a.copy(data=angle_in_period(a.values - ahead, period)) for n, a in at.items()})
