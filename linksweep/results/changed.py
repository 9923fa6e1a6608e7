"""Quantities of a scene with some of its numbers changed: what if it had no mass, no weight, no friction?"""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr

from linksweep.engine.run import Grid, evaluate
from linksweep.engine.trace.plan import plan
from linksweep.scene.scene import Scene


def quantities_with(
    changed: Mapping[str, float], scene: Scene, grid: Grid, names: tuple[str, ...], threads: int | None = None
) -> dict[str, xr.DataArray]:
    """Quantities of a scene brought to the grid's angles, with other numbers under the names that the physics wires by.

    What a number of 0 multiplies is not computed. Nothing is blanked where a sample is not ok.
    """
    inputs = scene.inputs
    forms = tuple((name, changed.get(name, form)) for name, form in inputs.forms)
    fields = {name: field for name, field in inputs.fields.items() if name not in changed}
    found = evaluate(plan(scene.table, names, forms), fields, grid, inputs.sizes, threads)
    return {name: xr.DataArray(field.values, dims=field.dims) for name, field in found.items()}
