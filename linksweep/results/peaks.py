"""peaks(scene): the worst of each quantity over the revolution, and where it is.

Still the largest sample of a grid, improved by the parabola through it and its neighbours: an estimate, which misses a
spike near a dead point that fits between two samples. `engine.reduce` is where an exact search belongs.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr

from linksweep.engine.fuse import Reduction
from linksweep.engine.plan import plan
from linksweep.engine.quantity import Quantity, opposite_of
from linksweep.engine.run import Field, reduce_rows
from linksweep.mechanisms.validate import count_problems, name_problems, refuse
from linksweep.results.compute import requested, require_scene, surely_ok
from linksweep.results.jumps import with_one_sided_limits
from linksweep.results.record import design_coordinates, flags, provenance, variable
from linksweep.scene.grid import crank_grid, in_order
from linksweep.scene.scene import Scene

ASSEMBLY = Reduction("largest_sample", "assembly")
WORST_STATUS = Reduction("largest_sample", "status")
SUMMARIES = ("mean", "rms")


def peaks(scene: Scene, of: Iterable[str] | None = None, theta2: Any = 720, threads: int | None = None) -> xr.Dataset:
    """Worst case of each quantity over the revolution.

    The largest sample of the grid, improved by a local parabola: an estimate, whose error falls with the number of
    angles. A narrow spike between two samples can be missed; compare two grids where transmission angles get small.
    Where friction jumps, no parabola holds: there it is the largest sample, or the larger one-sided limit at a jump.

    Parameters
    ----------
    scene : Scene
    of : names of quantities; "F32_mean", "T12_rms" give mean and root mean square instead. Default: all pins and the
        torque
    theta2 : a count of angles, or any array of angles [degree] (then its ends are not joined)
    threads : at most so many (default: all cores); the numbers do not depend on it

    Returns
    -------
    Dataset over the design dims. A magnitude gives `F32_peak` [N] and `F32_peak_at` [degree]; a signed quantity
    `T12_max`, `T12_max_at`, `T12_min`, `T12_min_at` and `T12_peak` (largest |T12|). `status`: ok, partial_revolution
    (peaks are those of the angles that can be assembled) or cannot_assemble (NaN).

    Raises
    ------
    ValueError
        For an unknown name or angles that are no angles.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> worst = ls.peaks(scene, of=["F32"])
    >>> sorted(worst.data_vars)
    ['F32_peak', 'F32_peak_at', 'status']
    """
    require_scene(scene)
    refuse(count_problems("threads", threads))
    names = None if of is None else requested("of", of)
    grid = in_order(crank_grid(theta2, scene.period, scene.mechanism.index))
    sampled = scene.at(grid)
    wanted = _wanted(scene, names)
    checked = [ASSEMBLY] if surely_ok(sampled) else [ASSEMBLY, WORST_STATUS]
    reductions = tuple(dict.fromkeys([*(reduction for _, _, own in wanted for reduction in own), *checked]))
    signals = tuple(dict.fromkeys(reduction.name for reduction in reductions))
    request = plan(scene.table, signals, sampled.inputs.forms)
    found = reduce_rows(request, reductions, sampled.inputs.fields, grid, sampled.inputs.sizes, threads)
    found = with_one_sided_limits(scene, found, grid, threads)
    order = tuple(sampled.inputs.sizes)
    variables: dict[str, xr.Variable] = {}
    for quantity, summary, own in wanted:
        variables |= {
            name: variable(field, units, said, order)
            for name, field, units, said in _named(quantity, summary, [found[r] for r in own], scene.mechanism.spot)
        }
    variables["status"] = _status(found, order, flags(scene.mechanism.round_trip, scene.mechanism.round_meanings))
    command = f"linksweep.peaks(scene{'' if names is None else f', of={names}'}, theta2={np.size(grid.angles)})"
    coordinates = design_coordinates(sampled)
    return xr.Dataset(variables, coordinates, provenance(sampled, command, coordinates))


def _status(found: dict[Reduction, tuple[Field, Field]], order: tuple[str, ...], attributes: dict) -> xr.Variable:
    """0 where every sample is ok, 1 where some are, 2 where the mechanism cannot be assembled at all."""
    status = variable(found[ASSEMBLY][0], "1", "", order)
    if WORST_STATUS in found:
        not_ok = variable(found[WORST_STATUS][0], "1", "", order) > 0.0
        status = xr.where(not_ok & (status == 0.0), 1.0, status)
    dims = tuple(dim for dim in order if dim in status.dims)
    return xr.Variable(dims, status.transpose(*dims).values.astype(np.int8), attributes)


def _wanted(scene: Scene, names: list[str] | None) -> list[tuple[Quantity, str, list[Reduction]]]:
    """Each name's quantity, the summary asked for, and the reductions that it takes."""
    quantities = scene.table.quantity
    search = "largest_sample" if scene.jumps() else "largest"
    found, problems = [], []
    for name in scene.mechanism.peak_quantities(scene.drive) if names is None else names:
        stem, _, ending = name.rpartition("_")
        stem, ending = (stem, ending) if stem in quantities and ending in SUMMARIES else (name, "peak")
        if stem not in quantities or stem == "cond":
            problems += name_problems("of", name, [known for known in quantities if known != "cond"])
        else:
            found.append((quantities[stem], ending, _reductions(quantities[stem], ending, search)))
    refuse(problems)
    return found


def _reductions(quantity: Quantity, summary: str, search: str) -> list[Reduction]:
    if summary == "mean":
        return [Reduction("mean", quantity.name)]
    if summary == "rms":
        return [Reduction("mean", quantity.squared) if quantity.squared else Reduction("mean_square", quantity.name)]
    if quantity.squared:
        return [Reduction(search, quantity.squared)]
    return [Reduction(search, quantity.name), Reduction(search, opposite_of(quantity.name))]


def _named(quantity: Quantity, summary: str, found: list[tuple[Field, Field]], spot: str):
    """Names, fields, units and words of what a quantity's reductions give."""
    name, units, said = quantity.name, quantity.units, quantity.long_name
    value, angle = found[0]
    if summary == "mean":
        yield f"{name}_mean", value, units, f"mean over the revolution of: {said}"
    elif summary == "rms":
        yield f"{name}_rms", _map(np.sqrt, value), units, f"root mean square over the revolution of: {said}"
    elif quantity.squared:
        yield f"{name}_peak", _map(np.sqrt, value), units, f"largest {said}"
        yield f"{name}_peak_at", angle, "degree", f"{spot} of the largest {said}"
    else:
        least, least_at = _map(lambda value: 0.0 - value, found[1][0]), found[1][1]
        yield f"{name}_max", value, units, f"largest {said}"
        yield f"{name}_max_at", angle, "degree", f"{spot} of the largest {said}"
        yield f"{name}_min", least, units, f"least {said}"
        yield f"{name}_min_at", least_at, "degree", f"{spot} of the least {said}"
        magnitude = Field(value.dims, np.maximum(np.abs(value.values), np.abs(least.values)))
        yield f"{name}_peak", magnitude, units, f"largest magnitude of the {said}"


def _map(function, field: Field) -> Field:
    return Field(field.dims, function(field.values))
