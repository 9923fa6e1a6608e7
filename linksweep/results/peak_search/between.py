"""Compute a scene's quantities at any pairs of a design and a crank angle, also between the samples of a grid.

Designs are counted row-major over the scene's design dims. Each pair is one sample of a sweep whose parameters all
change from sample to sample, so that the plan and the kernels of `sweep` serve here, too.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import singledispatch
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.engine.run import Field, Grid, evaluate
from linksweep.engine.trace.plan import Plan, plan
from linksweep.scene.dimensions import aligned
from linksweep.scene.grid import crank_grid
from linksweep.scene.inputs import Inputs
from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene

Array = np.ndarray
Places = Mapping[str, Array]
"""Indices of some designs along each design dim."""

EVERYWHERE, PARTLY, NEVER = 0.0, 1.0, 2.0
"""Assembly of a design: at every crank angle, at some, or at none."""
AT_ONCE = 256
"""Designs searched together, so that the memory for it does not grow with a study."""
OWN_AT_ONCE = 16
"""Designs searched together where loads over the angle have design dims: each load is sampled at all designs' angles,
so the memory grows with the square of this number."""
CHOSEN = "_chosen"
"""Dim of designs that are computed at the same angles."""
COMBINED = "_combined"
"""Dim that combines the design dims of loads over the angle."""


class Group(NamedTuple):
    """Some designs of a scene, searched together.

    `scene` may be another scene that has only these designs (see `_with_own_loads`): `designs` are their numbers in
    `scene`, `places` their indices along the dims of the original scene. `quick` are the crank angles [degree] at which
    some load or speed over the angle changes quickly, in any design of the original scene.
    """

    scene: Scene
    designs: Array
    places: Places
    quick: Array

    def some(self, rows: Array) -> Group:
        """Return the designs in these rows of the group."""
        return self._replace(designs=self.designs[rows], places={dim: at[rows] for dim, at in self.places.items()})

    def values(self, names: tuple[str, ...], rows: Array, angles: Array, threads: int | None = None) -> Array:
        """Return values (names, pairs) at pairs of a design of the group, by its row, and an angle [degree]."""
        return quantities_at(self.scene, names, self.designs[rows], angles, threads)

    def constants(self, *names: str) -> Array:
        """Return values (names, designs) of quantities that depend on no angle."""
        return self.values(names, np.arange(len(self.designs)), np.zeros(len(self.designs)))

    def number(self, number: Any) -> Array:
        """Return a parameter of the scene, or a number computed from parameters, for each of these designs."""
        if not hasattr(number, "dims"):
            return np.full(len(self.designs), float(number))
        places = places_of(self.scene.at_one_angle.inputs.sizes, self.designs)
        return number.values[tuple(places[str(dim)] for dim in number.dims)] + np.zeros(len(self.designs))


@singledispatch
def groups(scene: Any, names: tuple[str, ...], designs: Array | None = None, at_once: int = AT_ONCE) -> Iterator[Any]:
    """Yield designs in groups small enough to be searched together.

    Without `designs`, one design stands for all that share the values of these quantities.
    """
    inputs, index = scene.at_one_angle.inputs, scene.mechanism.index
    own = any(index in field.dims and len(field.dims) > 1 for field in inputs.fields.values())
    chosen = _different(scene, names) if designs is None else designs
    step = min(at_once, OWN_AT_ONCE) if own else at_once
    for first in range(0, len(chosen), step):
        part = chosen[first : first + step]
        places = places_of(inputs.sizes, part)
        yield _with_own_loads(scene, places) if own else Group(scene, part, places, scene.quick.angles)


def assembled_groups(
    scene: Any, names: tuple[str, ...], kinds: tuple[float, ...] = (EVERYWHERE, PARTLY)
) -> Iterator[tuple[float, Any]]:
    """Yield the designs of each of these kinds of assembly, with the kind, in groups."""
    for group in groups(scene, (*names, "assembly")):
        (assembly,) = group.constants("assembly")
        for kind in kinds:
            if np.any(assembly == kind):
                yield kind, group.some(assembly == kind)


@singledispatch
def empty(scene: Any, names: tuple[str, ...]) -> dict[str, Field]:
    """Return a Field of NaN for each of these quantities, over its design dims."""
    inputs, index = scene.at_one_angle.inputs, scene.mechanism.index
    request = plan(scene.table, names, inputs.forms)
    dims = {name: tuple(dim for dim in request.dims(request.outputs[name]) if dim != index) for name in names}
    return {name: Field(own, np.full(tuple(inputs.sizes[dim] for dim in own), np.nan)) for name, own in dims.items()}


def empty_over_all(scene: Any, names: tuple[str, ...]) -> Field:
    """Return a Field of NaN over all design dims that some of these quantities have."""
    fields = empty(scene, names).values()
    sizes = {dim: n for field in fields for dim, n in zip(field.dims, field.values.shape, strict=True)}
    return Field(tuple(sizes), np.full(tuple(sizes.values()), np.nan))


def _different(scene: Scene, names: tuple[str, ...]) -> Array:
    """Return the numbers of designs, one for each set of designs that share the values of all these quantities."""
    inputs = scene.at_one_angle.inputs
    loops = plan(scene.table, names, inputs.forms).loops
    designs = np.arange(math.prod(inputs.sizes.values())).reshape(tuple(inputs.sizes.values()))
    return designs[tuple(slice(None if dim in loops else 1) for dim in inputs.sizes)].ravel()


def _with_own_loads(scene: Scene, places: Places) -> Group:
    """Return designs as a scene of their own, so that only their own loads are interpolated at their angles."""
    index = scene.mechanism.index
    own = [dim for dim in places if any(dim in array.dims for array in scene.arrays.values())]
    combined, inverse = np.unique(np.stack([places[dim] for dim in own]), axis=1, return_inverse=True)
    picked = {dim: xr.DataArray(row, dims=COMBINED) for dim, row in zip(own, combined, strict=True)}
    arrays = {
        path: array.drop_vars([name for name in array.coords if name != index]).isel(picked, missing_dims="ignore")
        for path, array in scene.arrays.items()
    }
    part = replaced(scene, arrays)
    sizes = part.at_one_angle.inputs.sizes
    inside = {COMBINED: inverse.ravel()} | {dim: at for dim, at in places.items() if dim not in own}
    designs = np.ravel_multi_index(tuple(inside[dim] for dim in sizes), tuple(sizes.values()))
    return Group(part, designs, places, scene.quick.angles)


def quantities_at(
    scene: Scene, names: tuple[str, ...], designs: Array, angles: Array, threads: int | None = None
) -> Array:
    """Return values (names, pairs) at pairs of a design and an angle [degree]."""
    if not len(angles):
        return np.empty((len(names), 0))
    inputs, grid, sample = _inputs_at(scene, angles)
    forms = tuple((name, (grid.dim,) if isinstance(form, tuple) and form else form) for name, form in inputs.forms)
    request = plan(scene.table, names, forms)
    places = places_of(inputs.sizes, designs) | {grid.dim: sample}
    values = evaluate(request, _inputs_along(grid.dim, request, inputs, places), grid, {}, threads)
    return np.stack([np.broadcast_to(values[name].values, angles.shape) for name in names])


def positions_at(scene: Scene, names: tuple[str, ...], designs: Array, angles: Array) -> Array:
    """Return values (names, designs, angles) of functions of the position, at angles [degree] shared by all designs."""
    grid, inputs = crank_grid(angles, scene.period, scene.mechanism.index), scene.at_one_angle.inputs
    forms = tuple(
        (name, (CHOSEN,) if isinstance(form, tuple) and form and name not in grid.names else form)
        for name, form in inputs.forms
    )
    request, places = plan(scene.table, names, forms), places_of(inputs.sizes, designs)
    values = evaluate(request, _inputs_along(CHOSEN, request, inputs, places), grid, {CHOSEN: len(designs)})
    shape = len(designs), len(angles)
    return np.stack([np.broadcast_to(aligned(values[name], (CHOSEN, grid.dim)), shape) for name in names])


Point = tuple[Array, Array]
"""Angles [degree], and the values of a quantity there."""


def crossing(group: Group, name: str, rows: Array, start: Point, end: Point, steps: int) -> Array:
    """Return angles near which a quantity of these designs crosses 0 between two points, by the Illinois method.

    All designs take the same number of steps: one step evaluates them together.

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
    """Return a scene's inputs at the distinct angles of a period, the grid of all angles, and the index of each angle
    among the distinct ones.

    Designs share their even samples: loads and cosines are thus evaluated once for each distinct angle.
    """
    period, index = scene.period, scene.mechanism.index
    if scene.steady:
        return scene.inputs, crank_grid(angles, period, index), np.empty(0, dtype=int)
    different, sample = np.unique(angles, return_inverse=True)
    known = crank_grid(different, period, index)
    folded, first, place = np.unique(in_period(different, period), return_index=True, return_inverse=True)
    inputs = scene.at(known._replace(angles=folded, table=known.table[:, first])).inputs
    return inputs, known._replace(angles=angles, table=known.table.take(sample, axis=1)), place[sample]


def in_period(angle: Array, period: float) -> Array:
    """Return angles reduced to [0, period)."""
    folded = np.mod(angle, period)
    return np.where(folded < period, folded, 0.0 * folded)  # mod rounds -1e-20 up to the period itself


def places_of(sizes: Mapping[str, int], designs: Array) -> dict[str, Array]:
    """Return the indices of designs along each dim."""
    if not sizes:
        return {}
    return dict(zip(sizes, np.unravel_index(designs, tuple(sizes.values())), strict=True))


def by_row(rows: Array, values: Array, count: int) -> Array:
    """Return a table (row, nth value of the row, …) of values that belong to rows, NaN where others have more."""
    order = np.argsort(rows, kind="stable")
    rows = rows[order]
    nth = np.arange(len(rows)) - np.searchsorted(rows, rows)
    table = np.full((count, nth.max(initial=-1) + 1, *values.shape[1:]), np.nan)
    table[rows, nth] = values[order]
    return table


def _inputs_along(dim: str, request: Plan, inputs: Inputs, places: Places) -> dict[str, Field]:
    """Return the inputs that a plan takes, those with dims as one number for each place along `dim`."""
    return {
        name: Field((dim,), field.values[tuple(places[own] for own in field.dims)]) if field.dims else field
        for name, field in inputs.fields.items()
        if name in request.inputs
    }
