"""Compute a scene's quantities at any pairs of a design and a crank angle, also between the samples of a grid.

Designs are counted row-major over the scene's design dims. Each pair is one sample of a sweep whose parameters all
change from sample to sample, so that the plan and the kernels of `sweep` serve here, too.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from linksweep.base.frozen import cached_beside
from linksweep.engine.run import Field, Fields, Grid, Places, evaluate
from linksweep.engine.trace.plan import plan

if TYPE_CHECKING:
    from linksweep.scene.inputs import Inputs
    from linksweep.scene.scene import Scene

Array = np.ndarray
Table = TypeVar("Table", bound=NamedTuple)


def quantities_at(scene: Scene, names: tuple[str, ...], designs: Array, angles: Array) -> Array:
    """Return values (names, pairs) at pairs of a design and an angle [degree]."""
    return Pairs(scene, designs, angles, loaded=changes(scene, names)).values(names)


def changing_inputs_at(scene: Scene, designs: Array, angles: Array) -> dict[str, Array]:
    """Return the inputs that change over the angle, by name, at pairs of a design and an angle [degree]."""
    inputs, grid, sample = _inputs_at(scene, designs, angles, True)
    places = places_of(scene.at_one_angle.inputs.sizes, designs) | {grid.dim: sample}
    fields = {name: field for name, field in inputs.fields.items() if grid.dim in field.dims}
    return {name: field.values.ravel()[flat_index(field, places, len(angles))] for name, field in fields.items()}


def changes(scene: Scene, names: tuple[str, ...]) -> bool:
    """Return whether any of these quantities depends on an input that changes over the angle."""
    if scene.steady:
        return False
    inputs = scene.at_one_angle.inputs
    changing = {name for name, field in inputs.fields.items() if scene.mechanism.index in field.dims}
    return not changing.isdisjoint(plan(scene.table, names, inputs.forms).inputs)


class Pairs:
    """Pairs of a design and an angle [degree] of a scene, whose loads are evaluated there once, unless `loaded` tells
    that no quantity depends on them."""

    def __init__(self, scene: Scene, designs: Array, angles: Array, loaded: bool = True) -> None:
        self.scene, self.designs, self.count = scene, designs, len(angles)
        if self.count:
            self.inputs, self.grid, self.sample = _inputs_at(scene, designs, angles, loaded)

    def values(self, names: tuple[str, ...], motion: Mapping[str, Array] | None = None) -> Array:
        """Return values (names, pairs) of quantities.

        `motion` are parameters that each pair has of its own, in place of the scene's, such as omega2 and alpha2.
        """
        if not self.count:
            return np.empty((len(names), 0))
        motion, inputs, dim = motion or {}, self.inputs, self.grid.dim
        own = {name for name, form in inputs.forms if (isinstance(form, tuple) and form) or name in motion}
        forms = tuple((name, (dim,) if name in own else form) for name, form in inputs.forms)
        request = plan(self.scene.table, names, forms)
        places = places_of(self.scene.at_one_angle.inputs.sizes, self.designs) | {dim: self.sample}
        fields = {name: inputs.fields[name] for name in request.inputs if name in inputs.fields and name not in motion}
        alike = {name: field for name, field in fields.items() if not field.dims}
        changing = {name: field for name, field in fields.items() if field.dims}
        rows = {name: row for name, row in motion.items() if name in request.inputs}
        values = evaluate(request, alike, _with_rows(self.grid, changing, places, rows), {})
        return np.stack([np.broadcast_to(values[name].values, self.count) for name in names])


def _inputs_at(scene: Scene, designs: Array, angles: Array, loaded: bool) -> tuple[Inputs, Grid, Array]:
    """Return a scene's inputs at angles of a period, the grid of all angles, and the index of each among the former.

    Designs share their even samples: loads and cosines are thus evaluated once for each distinct angle, but for arrays
    of designs of their own (`changes_by_pairs`).
    """
    if scene.steady or not loaded:
        return scene.at_one_angle.inputs, scene.grid(angles), np.empty(0, dtype=int)
    if changes_by_pairs(scene):
        known, places = scene.grid(angles), places_of(scene.at_one_angle.inputs.sizes, designs)
        inputs = scene.at(known._replace(angles=in_period(angles, scene.period)), places).inputs
        return inputs, known, np.arange(len(angles))
    different = np.unique(angles)
    sample = np.searchsorted(different, angles)  # faster than numpy's own inverse, for few different angles
    known = scene.grid(different)
    folded, first, place = np.unique(in_period(different, scene.period), return_index=True, return_inverse=True)
    inputs = scene.at(known._replace(angles=folded, table=known.table.take(first, axis=1))).inputs
    return inputs, known._replace(angles=angles, table=known.table.take(sample, axis=1)), place[sample]


def _with_rows(grid: Grid, fields: Fields, places: Places, rows: Mapping[str, Array]) -> Grid:
    """Return the grid of pairs with rows for the inputs of each, fields at its places and rows: kernels read them there
    without another copy."""
    known, count = len(grid.table), len(grid.angles)
    table = np.empty((known + len(fields) + len(rows), count))
    table[:known] = grid.table
    over = {field.dims: field for field in fields.values()}
    index = {dims: flat_index(field, places, count) for dims, field in over.items()}
    for row, field in zip(table[known:], fields.values(), strict=False):
        np.take(field.values.ravel(), index[field.dims], out=row, mode="clip")  # to raise takes longer; none is outside
    for row, values in zip(table[known + len(fields) :], rows.values(), strict=True):
        row[:] = values
    return grid._replace(names=(*grid.names, *fields, *rows), table=table)


@cached_beside
def changes_by_pairs(scene: Scene) -> bool:
    """Return whether designs have arrays over the angle of their own, but no function, which all would call at the
    angles of each."""
    own = (scene.mechanism.index in array.dims and array.ndim > 1 for array in scene.arrays.values())
    return any(own) and not scene.functions


def in_period(angle: Array, period: float) -> Array:
    """Return angles reduced to [0, period)."""
    folded = np.array(angle, dtype=float)
    folded += 0.0  # never -0
    folded += np.multiply(folded < 0.0, period)
    folded -= np.multiply(folded >= period, period)
    outside = ~((folded >= 0.0) & (folded < period))
    if outside.any():
        within = np.mod(np.asarray(angle, dtype=float)[outside], period) + 0.0  # slow
        folded[outside] = np.where(within < period, within, 0.0 * within)  # mod rounds -1e-20 up to the period itself
    return folded


def places_of(sizes: Mapping[str, int], designs: Array) -> dict[str, Array]:
    """Return the indices of designs along each dim."""
    if not sizes:
        return {}
    return dict(zip(sizes, np.unravel_index(designs, tuple(sizes.values())), strict=True))


def flat_index(field: Field, places: Places, count: int) -> Array:
    """Return the row-major index into a field's values of each of `count` places."""
    if not field.dims:
        return np.zeros(count, dtype=int)
    if len(field.dims) == 1:
        return places[field.dims[0]]  # as it is: numpy would copy it
    return np.ravel_multi_index(tuple(places[dim] for dim in field.dims), field.values.shape)


def different_designs(scene: Scene, names: tuple[str, ...]) -> Array:
    """Return the numbers of designs, one for each set of designs that share the values of all these quantities."""
    inputs = scene.at_one_angle.inputs
    loops = plan(scene.table, names, inputs.forms).loops
    designs = np.arange(math.prod(inputs.sizes.values())).reshape(tuple(inputs.sizes.values()))
    return designs[tuple(slice(None if dim in loops else 1) for dim in inputs.sizes)].ravel()


def some_of(table: Table, which: Array | slice) -> Table:
    """Return the rows of a table, a named tuple of equally long arrays, with these indices."""
    return table._make(numbers[which] for numbers in table)


def joined(tables: Iterable[Table]) -> Table:
    """Return several tables of one kind as one."""
    first, *others = tables
    return first._make(map(np.concatenate, zip(first, *others, strict=True)))


def by_row(rows: Array, values: Array, count: int) -> Array:
    """Return a table (row, nth value of the row, …) of values that belong to rows, NaN where others have more."""
    order = np.argsort(rows, kind="stable")
    rows = rows[order]
    nth = np.arange(len(rows)) - np.searchsorted(rows, rows)
    table = np.full((count, nth.max(initial=-1) + 1, *values.shape[1:]), np.nan)
    table[rows, nth] = values[order]
    return table


def with_repeated(table: Array, again: Array) -> Array:
    """Return a table in which each number that is marked `again` repeats the last one of its row that is not."""
    own = np.where(again, 0, np.arange(table.shape[1]))
    return np.take_along_axis(table, np.maximum.accumulate(own, axis=1), axis=1)


def in_order(table: Array) -> Array:
    """Return a table with the numbers of each row in order; each NaN becomes another of the row's last number."""
    return np.fmax.accumulate(np.sort(table, axis=1), axis=1)
