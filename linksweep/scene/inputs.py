"""A scene as the engine takes it: numbers as fields over dims, and their forms for the planner."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from linksweep.base.validate import refuse, repeated
from linksweep.chains.rows.crank import OverDesigns
from linksweep.engine.run import Field
from linksweep.engine.trace.plan import InputForms
from linksweep.scene.dimensions import side_by_side
from linksweep.scene.grid import rows

if TYPE_CHECKING:
    from linksweep.scene.scene import Scene


class Inputs(NamedTuple):
    """Numbers with dims, their forms for the planner, and the size of each dim."""

    fields: Mapping[str, Field]
    forms: InputForms
    sizes: Mapping[str, int]


def engine_inputs(scene: Scene) -> Inputs:
    """Return the inputs of a scene whose parameters have been evaluated at the angles of a grid."""
    fields = {name: as_field(value) for name, value in _named_values(scene).items()}
    if twice := scene.table.made.intersection(fields):
        refuse(scene.mechanism.clash_problems(twice, (*scene.table.made, *fields)))
    grid_rows = tuple((name, (scene.mechanism.index,)) for name in rows(scene.mechanism.geared))
    forms = (*((name, form_of(field)) for name, field in fields.items()), *grid_rows)
    arrays = (field for field in fields.values() if field.dims)
    sizes = {dim: n for field in arrays for dim, n in zip(field.dims, field.values.shape, strict=True)}
    sizes.pop(scene.mechanism.index, None)
    return Inputs(fields, forms, sizes)


def _named_values(scene: Scene) -> dict[str, Any]:
    """Return the numbers of motion, machine and loads under the names that the physics takes."""
    machine, beams = scene.mechanism.engine_parameters, "section" in scene.motion
    numbers = [
        scene.motion,
        machine,
        scene.mechanism.beam_numbers() if beams else {},
        over_designs(scene.mechanism.driven_numbers(scene.motion)),
        *(load.parameters(f"load{k}", machine) for k, load in enumerate(scene.loads, 1)),
    ]
    values: dict[str, Any] = {}
    for of_part in numbers:
        values |= of_part
    if len(values) < sum(map(len, numbers)):
        names = [*chain.from_iterable(numbers)]
        refuse(scene.mechanism.clash_problems(repeated(names), names))
    return values


def over_designs(functions: OverDesigns) -> dict[str, Field]:
    """Evaluate functions of numbers over the dims of these numbers."""
    fields: dict[str, Field] = {}
    for function, numbers in functions:
        dims, arrays = side_by_side(numbers)
        results: Mapping[str, Any] = function(*arrays)
        fields |= {name: Field(dims, values) for name, values in results.items()}
    return fields


def as_field(value: Any) -> Field:
    """Return a number as the engine takes it."""
    if type(value) is float:
        return Field((), np.array(value))
    if isinstance(value, Field):
        return value
    if hasattr(value, "dims"):
        return Field(tuple(map(str, value.dims)), np.asarray(value.values, dtype=float))
    return Field((), np.asarray(float(value)))


def form_of(field: Field) -> tuple[str, ...] | float:
    """Return the dims of a number; of a plain 0 or 1 the number itself, so that its products can be left out."""
    if not field.dims and (number := field.values.item()) in (0.0, 1.0):
        return number
    return field.dims
