"""Between the samples: a scene's quantities at any pairs of a design and a crank angle.

Designs are counted row-major over the scene's design dims. Each pair is one sample of a sweep whose parameters all
change from sample to sample, so the same plan and the same kernels do the work.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import singledispatch
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.engine.run import Field, Grid, evaluate
from linksweep.engine.trace.plan import plan
from linksweep.scene.dimensions import laid
from linksweep.scene.grid import crank_grid
from linksweep.scene.inputs import Inputs
from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene

Array = np.ndarray
Places = Mapping[str, Array]
"""Along each dim, where each of some designs is."""

AT_ONCE = 256
"""Designs looked at together: the memory that this takes does not grow with a study."""
OWN_AT_ONCE = 16
"""The same where each design has loads over the angle of its own, which are sampled at the angles of all of these."""
CHOSEN = "_chosen"
"""Dimension of designs that are looked at at the same angles."""
COMBINED = "_combined"
"""Dimension of the designs of such loads, when they are taken together."""


class Group(NamedTuple):
    """Some designs of a scene: as designs of `scene`, which may be another one, and where they are in the first.

    `quick` are the crank angles at which what changes over the revolution is quick, in any design of the first."""

    scene: Scene
    designs: Array
    places: Places
    quick: Array

    def some(self, rows: Array) -> Group:
        return self._replace(designs=self.designs[rows], places={dim: at[rows] for dim, at in self.places.items()})

    def values(self, names: tuple[str, ...], rows: Array, angles: Array, threads: int | None = None) -> Array:
        """Values (names, pairs) at pairs of one of these designs and an angle [degree]."""
        return quantities_at(self.scene, names, self.designs[rows], angles, threads)

    def constants(self, *names: str) -> Array:
        """Values (names, designs) of what depends on no angle."""
        return self.values(names, np.arange(len(self.designs)), np.zeros(len(self.designs)))

    def number(self, number: Any) -> Array:
        """A parameter of the scene, or what was made of some, for each of these designs."""
        if not hasattr(number, "dims"):
            return np.full(len(self.designs), float(number))
        places = places_of(self.scene.at_one_angle.inputs.sizes, self.designs)
        return number.values[tuple(places[str(dim)] for dim in number.dims)] + np.zeros(len(self.designs))


@singledispatch
def groups(scene: Any, names: tuple[str, ...], designs: Array | None = None, at_once: int = AT_ONCE) -> Iterator[Any]:
    """Designs in groups small enough to be looked at together: these, or one of all that share these quantities."""
    inputs, index = scene.at_one_angle.inputs, scene.mechanism.index
    own = any(index in field.dims and len(field.dims) > 1 for field in inputs.fields.values())
    chosen = _different(scene, names) if designs is None else designs
    step = min(at_once, OWN_AT_ONCE) if own else at_once
    for first in range(0, len(chosen), step):
        part = chosen[first : first + step]
        places = places_of(inputs.sizes, part)
        yield _with_own_loads(scene, places) if own else Group(scene, part, places, scene.quick.angles)


@singledispatch
def empty(scene: Any, names: tuple[str, ...]) -> dict[str, Field]:
    """Fields of NaN for each of these quantities, over its design dims."""
    inputs, index = scene.at_one_angle.inputs, scene.mechanism.index
    request = plan(scene.table, names, inputs.forms)
    dims = {name: tuple(dim for dim in request.dims(request.outputs[name]) if dim != index) for name in names}
    return {name: Field(own, np.full(tuple(inputs.sizes[dim] for dim in own), np.nan)) for name, own in dims.items()}


def _different(scene: Scene, names: tuple[str, ...]) -> Array:
    """One design of all those that share these quantities."""
    inputs = scene.at_one_angle.inputs
    loops = plan(scene.table, names, inputs.forms).loops
    designs = np.arange(math.prod(inputs.sizes.values())).reshape(tuple(inputs.sizes.values()))
    return designs[tuple(slice(None if dim in loops else 1) for dim in inputs.sizes)].ravel()


def _with_own_loads(scene: Scene, places: Places) -> Group:
    """A group as a scene of its own: each load over the angle is then brought to the angles of its group alone."""
    index = scene.mechanism.index
    own = [dim for dim in places if any(dim in array.dims for array in scene.arrays.values())]
    combined, which = np.unique(np.stack([places[dim] for dim in own]), axis=1, return_inverse=True)
    picked = {dim: xr.DataArray(row, dims=COMBINED) for dim, row in zip(own, combined, strict=True)}
    arrays = {
        path: array.drop_vars([name for name in array.coords if name != index]).isel(picked, missing_dims="ignore")
        for path, array in scene.arrays.items()
    }
    part = replaced(scene, arrays)
    sizes = part.at_one_angle.inputs.sizes
    inside = {COMBINED: which.ravel()} | {dim: at for dim, at in places.items() if dim not in own}
    designs = np.ravel_multi_index(tuple(inside[dim] for dim in sizes), tuple(sizes.values()))
    return Group(part, designs, places, scene.quick.angles)


def quantities_at(
    scene: Scene, names: tuple[str, ...], designs: Array, angles: Array, threads: int | None = None
) -> Array:
    """Values (names, pairs) at pairs of a design and an angle [degree]."""
    if not len(angles):
        return np.empty((len(names), 0))
    inputs, grid, sample = _inputs_at(scene, angles)
    forms = tuple((name, (grid.dim,) if isinstance(form, tuple) and form else form) for name, form in inputs.forms)
    request = plan(scene.table, names, forms)
    places = places_of(inputs.sizes, designs) | {grid.dim: sample}
    needed = {name: inputs.fields[name] for name in request.inputs if name in inputs.fields}
    fields = {name: _paired(field, places, grid.dim) for name, field in needed.items()}
    found = evaluate(request, fields, grid, {}, threads)
    return np.stack([np.broadcast_to(found[name].values, angles.shape) for name in names])


def positions_at(scene: Scene, names: tuple[str, ...], designs: Array, angles: Array) -> Array:
    """Return values (names, designs, angles) of what the position alone decides, at the same angles [degree] for all
    of these designs."""
    grid, inputs = crank_grid(angles, scene.period, scene.mechanism.index), scene.at_one_angle.inputs
    forms = tuple(
        (name, (CHOSEN,) if isinstance(form, tuple) and form and name not in grid.names else form)
        for name, form in inputs.forms
    )
    request, places = plan(scene.table, names, forms), places_of(inputs.sizes, designs)
    needed = {name: inputs.fields[name] for name in request.inputs if name in inputs.fields}
    fields = {name: _paired(field, places, CHOSEN) for name, field in needed.items()}
    found = evaluate(request, fields, grid, {CHOSEN: len(designs)})
    shape = len(designs), len(angles)
    return np.stack([np.broadcast_to(laid(found[name], (CHOSEN, grid.dim)), shape) for name in names])


Point = tuple[Array, Array]
"""Angles [degree], and the values of a quantity there."""


def crossing(group: Group, name: str, rows: Array, start: Point, end: Point, steps: int) -> Array:
    """Return angles near which a quantity of these designs crosses 0 between two points, by Illinois's false position.

    Source: Dowell and Jarratt, A modified regula falsi method, BIT 11 (1971).
    """
    (a, f_a), (b, f_b) = start, end
    for _ in range(steps):
        x = b - f_b * (b - a) / (f_b - f_a)
        (f,) = group.values((name,), rows, x)
        beyond = (f < 0.0) == (f_b < 0.0)
        a, f_a = np.where(beyond, a, b), np.where(beyond, 0.5 * f_a, f_b)
        b, f_b = x, f
    return b


def _inputs_at(scene: Scene, angles: Array) -> tuple[Inputs, Grid, Array]:
    """Return a scene's numbers at the different ones of these angles, the grid of all, and which of those each is."""
    period, index = scene.period, scene.mechanism.index
    if scene.steady:
        return scene.inputs, crank_grid(angles, period, index), np.empty(0, dtype=int)
    different, sample = np.unique(angles, return_inverse=True)
    known = crank_grid(different, period, index)
    inputs = scene.at(known._replace(angles=in_period(different, period))).inputs
    return inputs, known._replace(angles=angles, table=known.table.take(sample, axis=1)), sample


def in_period(angle: Array, period: float) -> Array:
    """The same angles in [0, period)."""
    folded = np.mod(angle, period)
    return np.where(folded < period, folded, 0.0 * folded)


def places_of(sizes: Mapping[str, int], designs: Array) -> dict[str, Array]:
    if not sizes:
        return {}
    return dict(zip(sizes, np.unravel_index(designs, tuple(sizes.values())), strict=True))


def _paired(field: Field, places: Places, index: str) -> Field:
    if not field.dims:
        return field
    return Field((index,), field.values[tuple(places[dim] for dim in field.dims)])
