"""Kinds of assembly, positions of designs at shared crank angles, and tables of numbers that belong to designs."""

from __future__ import annotations

import numpy as np

from linksweep.engine.run import evaluate
from linksweep.engine.trace.plan import plan
from linksweep.scene.dimensions import aligned
from linksweep.scene.pairs import Array, inputs_along, places_of, quantities_at
from linksweep.scene.scene import Scene

EVERYWHERE, PARTLY, NEVER = 0.0, 1.0, 2.0
"""Assembly of a design: at every crank angle, at some, or at none."""
CHOSEN = "_chosen"
"""Dim of designs that are computed at the same angles."""


def positions_at(scene: Scene, names: tuple[str, ...], designs: Array, angles: Array) -> Array:
    """Return values (names, designs, angles) of functions of the position, at angles [degree] shared by all designs."""
    grid, inputs = scene.grid(angles), scene.at_one_angle.inputs
    forms = tuple(
        (name, (CHOSEN,) if isinstance(form, tuple) and form and name not in grid.names else form)
        for name, form in inputs.forms
    )
    request, places = plan(scene.table, names, forms), places_of(inputs.sizes, designs)
    if any(grid.dim in inputs.fields[name].dims for name in request.inputs if name in inputs.fields):
        # as of the length of a cylinder that is moved
        pairs = np.repeat(designs, len(angles)), np.tile(angles, len(designs))
        return quantities_at(scene, names, *pairs).reshape(len(names), len(designs), len(angles))
    values = evaluate(request, inputs_along(CHOSEN, request, inputs, places), grid, {CHOSEN: len(designs)})
    shape = len(designs), len(angles)
    return np.stack([np.broadcast_to(aligned(values[name], (CHOSEN, grid.dim)), shape) for name in names])
