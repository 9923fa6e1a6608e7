"""Compute quantities of a scene with some of its numbers changed: without masses, weight or friction, say."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr

from linksweep.engine.run import Grid, evaluate
from linksweep.engine.trace.plan import plan
from linksweep.scene.scene import Scene


def quantities_with(
    changed: Mapping[str, float], scene: Scene, grid: Grid, names: tuple[str, ...]
) -> dict[str, xr.DataArray]:
    """Return quantities of a scene that is sampled at the grid's angles, with some inputs of the physics replaced.

    `changed` has the new numbers by the names of the physics' arguments; terms that a 0 multiplies are not computed.
    Samples that are not ok are not made NaN.
    """
    inputs = scene.inputs
    forms = tuple((name, changed.get(name, form)) for name, form in inputs.forms)
    fields = {name: field for name, field in inputs.fields.items() if name not in changed}
    results = evaluate(plan(scene.table, names, forms), fields, grid, inputs.sizes)
    return {name: xr.DataArray(field.values, dims=field.dims) for name, field in results.items()}
