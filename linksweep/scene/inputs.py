"""Numbers of a scene as the engine takes them: fields over dims, and what planning knows of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from linksweep.engine.run import Field
from linksweep.engine.trace.plan import InputForms
from linksweep.mechanisms.rows.crank import OverDesigns
from linksweep.scene.dimensions import side_by_side


class Inputs(NamedTuple):
    """A scene as the engine takes it: numbers with dims, their forms for the planner, and the size of each dim."""

    fields: Mapping[str, Field]
    forms: InputForms
    sizes: Mapping[str, int]


def over_designs(functions: OverDesigns) -> dict[str, Any]:
    """Return what functions of numbers return, with the dims of their numbers."""
    found: dict[str, Any] = {}
    for function, given in functions:
        dims, arrays = side_by_side(given)
        returned: Mapping[str, Any] = function(*arrays)
        found |= {name: Field(dims, values) for name, values in returned.items()}
    return found


def as_field(value: Any) -> Field:
    """Return a number as the engine takes it."""
    if isinstance(value, Field):
        return value
    if hasattr(value, "dims"):
        return Field(tuple(map(str, value.dims)), np.asarray(value.values, dtype=float))
    return Field((), np.asarray(float(value)))


def form_of(field: Field) -> tuple[str, ...] | float:
    """Return the dims of a number, or itself where it is just 0 or 1: what it multiplies can then be left out."""
    return float(field.values) if not field.dims and field.values in (0.0, 1.0) else field.dims
