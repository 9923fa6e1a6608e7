"""Where a force jumps: samples just before and just after, so that peaks see both one-sided limits.

Friction changes sign where a slider turns round. Those crank angles differ from design to design, so here the crank
angle itself has the design dims: each design gets its own few samples, evaluated by the same plan as the grid.
"""

from __future__ import annotations

import warnings

import numpy as np
import xarray as xr

from linksweep.engine.fuse import Reduction
from linksweep.engine.plan import plan
from linksweep.engine.run import Field, Grid, evaluate
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

ASIDE = 1e-7
"""How far before and after a jump a one-sided limit is taken [degree]: 2e-9 rad, so the error is about 1e-9."""


def with_one_sided_limits(
    scene: Scene, found: dict[Reduction, tuple[Field, Field]], grid: Grid, threads: int | None = None
) -> dict[Reduction, tuple[Field, Field]]:
    """The peaks found on a grid, raised where a one-sided limit at a jump is larger."""
    jumps = scene.jumps()
    searched = [reduction for reduction in found if reduction.kind == "largest_sample"]
    if not jumps or not searched:
        return found
    index = scene.mechanism.index
    angles = _beside(jumps, scene.period, grid)
    values = _signals_at(scene, angles, [reduction.name for reduction in searched], threads)
    return found | {r: _larger(found[r], values[r.name], angles, index) for r in searched}


def _beside(jumps: tuple, period: float, grid: Grid) -> xr.DataArray:
    """Angles just before and after every jump, in every turn of the period, over (design dims…, index).

    Of a grid that is no whole period only those inside count; its first angle, which adds nothing, stands for others.
    """
    # a design whose crank does not turn fully may have none: any angle does for it
    every = [xr.DataArray(jump).fillna(0.0) + 360.0 * turn for jump in jumps for turn in range(round(period / 360.0))]
    first = 0.0 if grid.period else float(grid.angles[0])
    sides = [first + (angle + aside - first) % period for angle in every for aside in (-ASIDE, ASIDE)]
    angles = xr.concat(xr.broadcast(*sides), grid.dim).transpose(..., grid.dim)
    return angles if grid.period else angles.where(angles <= grid.angles[-1], first)


def _signals_at(scene: Scene, angles: xr.DataArray, names: list[str], threads: int | None) -> dict[str, xr.DataArray]:
    """Signals at angles that have design dims."""
    different, places = np.unique(angles.values, return_inverse=True)
    grid = crank_grid(different, scene.period, scene.mechanism.index)
    sampled = scene.at(grid)
    place = angles.copy(data=places.reshape(angles.shape)).drop_vars(angles.coords)
    rows = dict(zip(grid.names, grid.table, strict=True))
    fields = {name: _moved(field, place, grid.dim) for name, field in sampled.inputs.fields.items()}
    fields |= {name: _moved(Field((grid.dim,), row), place, grid.dim) for name, row in rows.items()}
    known = dict(sampled.inputs.forms)
    forms = tuple((name, known[name] if isinstance(known[name], float) else fields[name].dims) for name in known)
    count = angles.sizes[grid.dim]
    samples = Grid(grid.dim, np.arange(float(count)), 0.0, (), np.empty((0, count)))
    request = plan(scene.table, tuple(dict.fromkeys(names)), forms)
    found = evaluate(request, fields, samples, sampled.inputs.sizes, threads)
    return {name: xr.DataArray(field.values, dims=field.dims) for name, field in found.items()}


def _moved(field: Field, place: xr.DataArray, index: str) -> Field:
    """A field of all the angles in one row, with each design's own angles picked."""
    if index not in field.dims:
        return field
    picked = xr.DataArray(field.values, dims=field.dims).isel({index: place})
    return Field(tuple(map(str, picked.dims)), picked.values)


def _larger(peak: tuple[Field, Field], values: xr.DataArray, angles: xr.DataArray, index: str) -> tuple[Field, Field]:
    """The larger of a peak and of the one-sided limits, with its angle."""
    value, at = (xr.DataArray(field.values, dims=field.dims) for field in peak)
    limits, places = xr.broadcast(values, angles.drop_vars(angles.coords))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # all NaN: this design has no such sample
        best = limits.max(index)
        where = places.isel({index: limits.fillna(-np.inf).argmax(index)})
    beyond = best > value
    dims = peak[0].dims
    return (
        Field(dims, xr.where(beyond, best, value).transpose(*dims).values),
        Field(dims, xr.where(beyond, where, at).transpose(*dims).values),
    )
