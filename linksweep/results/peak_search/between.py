"""Kinds of assembly, half turns, and quantities of designs of a scene, each with its own value of every parameter."""

from __future__ import annotations

from typing import Any

import numpy as np

from linksweep.engine.quantity import Table
from linksweep.engine.run import Field, Fields, Grid, evaluate
from linksweep.engine.trace.plan import InputForms, Plan, plan
from linksweep.scene.dimensions import aligned
from linksweep.scene.pairs import Array, changes, places_of, quantities_at
from linksweep.scene.scene import Scene

EVERYWHERE, PARTLY, NEVER = 0.0, 1.0, 2.0
"""Assembly of a design: at every crank angle, at some, or at none."""
ONE = "_one"
"""Dim of designs, or of pieces of their turns, each with its own value of every parameter."""


def half_turn_of(angle: Array) -> Array:
    """Return 0 or 1 for the half turn in which an angle from the near-toggle [degree] lies: about 0, or about 180."""
    return np.floor(np.mod(angle + 90.0, 360.0) / 180.0)


def half_tangent(angle: Array, half: Array) -> Array:
    """Return the tangent of half an angle [degree] as seen from the middle of such a half turn."""
    away = np.mod(angle - 180.0 * half + 180.0, 360.0) - 180.0  # 0 where the distance is less than a turn's rounding
    return np.tan(np.radians(0.5 * away))


def driven_elsewhere(scene: Scene) -> bool:
    """Return whether another part than the crank drives."""
    return scene.drive != scene.mechanism.defaults.get("drive", "")


def one_by_one(
    scene: Scene, designs: Array, table: Table, names: tuple[str, ...], own: Fields, places: InputForms
) -> tuple[Plan, Fields]:
    """Return the plan of quantities of a table, and its inputs: a value for each of these designs along the dim `ONE`,
    and `own` ones besides; `places` are the forms of inputs that place samples. Others that change over the angle are
    left to the table."""
    inputs, index = scene.at_one_angle.inputs, scene.mechanism.index
    forms = tuple(
        (name, (ONE,) if isinstance(form, tuple) and form else form)
        for name, form in inputs.forms
        if not (isinstance(form, tuple) and index in form)
    )
    request = plan(table, names, (*forms, *((name, field.dims) for name, field in own.items()), *places))
    at = places_of(inputs.sizes, designs)
    fields = {
        name: Field((ONE,), field.values[tuple(at[dim] for dim in field.dims)]) if field.dims else field
        for name, field in inputs.fields.items()
        if name in request.inputs and name not in own
    }
    return request, {**fields, **own}


def designs_on(scene: Scene, designs: Array, names: tuple[str, ...], grid: Grid) -> tuple[Plan, Fields]:
    """Return the plan of quantities for which nothing but the angles of a grid changes from sample to sample, and its
    inputs: a value for each of these designs along the dim `ONE`."""
    rows = tuple((name, form) for name, form in scene.at_one_angle.inputs.forms if name in grid.names)
    return one_by_one(scene, designs, scene.table, names, {}, rows)


def number_of(scene: Scene, number: Any, designs: Array) -> Array:
    """Return a parameter of a scene, or a number computed from parameters, for each of these designs."""
    if not hasattr(number, "dims"):
        return np.full(len(designs), float(number))
    places = places_of(scene.at_one_angle.inputs.sizes, designs)
    return number.values[tuple(places[str(dim)] for dim in number.dims)] + np.zeros(len(designs))


def positions_at(scene: Scene, names: tuple[str, ...], designs: Array, angles: Array) -> Array:
    """Return values (names, designs, angles) of functions of the position, at angles [degree] shared by all designs."""
    if changes(scene, names):  # as of the length of a cylinder that is moved
        pairs = np.repeat(designs, len(angles)), np.tile(angles, len(designs))
        return quantities_at(scene, names, *pairs).reshape(len(names), len(designs), len(angles))
    grid, shape = scene.grid(angles), (len(designs), len(angles))
    values = evaluate(*designs_on(scene, designs, names, grid), grid, {ONE: len(designs)})
    return np.stack([np.broadcast_to(aligned(values[name], (ONE, grid.dim)), shape) for name in names])
