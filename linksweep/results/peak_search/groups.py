"""Divide the designs of a scene into groups that are searched together, by their assembly."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import singledispatch
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.engine.peaks.roles import WIDTHS
from linksweep.engine.quantity import Table
from linksweep.engine.run import Field, Fields, Places, evaluate
from linksweep.engine.trace.plan import InputForms, Plan, plan
from linksweep.results.peak_search.between import EVERYWHERE, ONE, PARTLY, designs_on, number_of, one_by_one
from linksweep.results.peak_search.limits import Limits, limits_of, signals_of
from linksweep.scene.pairs import Array, changes_by_pairs, different_designs, places_of, quantities_at, some_of
from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene

AT_ONCE = 256
"""Designs searched together whose motion repeats every turn, so that the memory for it does not grow with a study."""
OWN_AT_ONCE = 64
"""Designs searched together where loads change over the angle and over designs at once, as those over a position do:
each is sampled at all designs' angles, so that the memory for it grows with the square of this number, here to some 30
MB. Arrays alone are evaluated for each pair of both."""
COMBINED = "_combined"
"""Dim that combines the design dims of loads over the angle."""


class Group(NamedTuple):
    """Some designs of a scene, searched together.

    `scene` may be another scene that has only these designs (see `_with_own_loads`): `designs` are their numbers in
    `scene`, `places` their indices along the dims of the original scene. `quick` are the crank angles [degree] at which
    some load or speed over the angle changes quickly, in any design of the original scene. `limits` are those of the
    designs, None where closed forms take their place.
    """

    scene: Scene
    designs: Array
    places: Places
    quick: Array
    limits: Limits | None = None

    def some(self, rows: Array) -> Group:
        """Return the designs in these rows of the group."""
        places = {dim: at[rows] for dim, at in self.places.items()}
        limits = self.limits and some_of(self.limits, rows)
        return self._replace(designs=self.designs[rows], places=places, limits=limits)

    def values(self, names: tuple[str, ...], rows: Array, angles: Array) -> Array:
        """Return values (names, pairs) at pairs of a design of the group, by its row, and an angle [degree]."""
        return quantities_at(self.scene, names, self.designs[rows], angles)

    def of(self, name: str, rows: Array) -> Callable[[Array, Array], Array]:
        """Return the function that evaluates a quantity of some of the designs in these rows at an angle [degree] of
        each."""
        return lambda which, angles: self.values((name,), rows[which], angles)[0]

    def constants(self, *names: str) -> Array:
        """Return values (names, designs) of quantities that depend on no angle."""
        grid, count = self.scene.grid(1), len(self.designs)
        values = evaluate(*designs_on(self.scene, self.designs, names, grid), grid, {ONE: count})
        return np.stack([np.broadcast_to(values[name].values, count) for name in names])

    def assembly(self) -> Array:
        """Return the assembly of each design: `EVERYWHERE`, `PARTLY` or `NEVER`."""
        return self.constants("assembly")[0] if self.limits is None else self.limits.assembly

    def near_toggles(self) -> tuple[Array, Array]:
        """Return the angles of near-toggles (design, nth) from the mechanism's `near_toggle_angle` [degree], and their
        half-widths as tangents of half the angle; NaN where other designs have more."""
        if self.limits is not None:
            middle = self.number(self.scene.mechanism.near_toggle_angle)
            return self.limits.near_toggle - middle[:, None], self.limits.near_toggle_width
        widths = self.constants(*WIDTHS).T
        return np.broadcast_to([0.0, 180.0], widths.shape), widths

    def zeros(self, kind: str) -> Array:
        """Return the angles (design, nth) [degree] of one kind of zeros that a search has located."""
        if self.limits is None:
            return np.empty((len(self.designs), 0))
        return self.limits.zeros_of(self.scene.table.limits or (), kind)

    def one_by_one(
        self, table: Table, names: tuple[str, ...], own: Fields, places: InputForms = ()
    ) -> tuple[Plan, Fields]:
        """Return `one_by_one` of the group's designs."""
        return one_by_one(self.scene, self.designs, table, names, own, places)

    def number(self, number: Any) -> Array:
        """Return a parameter of the scene, or a number computed from parameters, for each of these designs."""
        return number_of(self.scene, number, self.designs)


def all_at_once(scene: Scene, designs: Array) -> Group:
    """Return designs as one group, of which only numbers of designs are computed."""
    places = places_of(scene.at_one_angle.inputs.sizes, designs)
    return Group(scene, designs, places, np.empty(0), _limits(scene, designs))


@singledispatch
def groups(scene: Any, designs: Array, at_once: int = AT_ONCE, own_at_once: int = OWN_AT_ONCE) -> Iterator[Any]:
    """Yield designs in groups small enough to be searched together."""
    inputs = scene.at_one_angle.inputs
    own = _change_together(scene)
    turns = round(scene.period_of_motion / scene.mechanism.period)
    step = max(1, (min(at_once, own_at_once) if own else at_once) // turns)
    limits = _limits(scene, designs)  # of all groups at once: to find them, all numbers of all designs are read
    for first in range(0, len(designs), step):
        part = slice(first, first + step)
        places = places_of(inputs.sizes, designs[part])
        group = _with_own_loads(scene, places) if own else Group(scene, designs[part], places, scene.quick.angles)
        yield group._replace(limits=limits and some_of(limits, part))


def assembled_groups(
    scene: Any, designs: Array, kinds: tuple[float, ...] = (EVERYWHERE, PARTLY), at_once: int = AT_ONCE
) -> Iterator[tuple[float, Any]]:
    """Yield those designs that have one of these kinds of assembly, with the kind, in groups."""
    for group in groups(scene, designs, at_once):
        assembly = group.assembly()
        for kind in kinds:
            if np.any(assembly == kind):
                yield kind, group.some(assembly == kind)


@singledispatch
def different(scene: Any, names: tuple[str, ...]) -> Array:
    """Return one design for all that share the values of these quantities, and where they close."""
    return different_designs(scene, with_assembly(scene, names))


def with_assembly(scene: Scene, names: tuple[str, ...]) -> tuple[str, ...]:
    """Return names of quantities and that of the assembly, or those of the limits' signals where it is no quantity."""
    limits = scene.table.limits
    return (*names, *(("assembly",) if limits is None else signals_of(limits)))


def _limits(scene: Scene, designs: Array) -> Limits | None:
    """Return the limits of these designs; None where closed forms take their place."""
    if scene.table.limits is None:
        return None
    sizes, limits = limits_of(scene.unloaded)
    places = places_of(scene.at_one_angle.inputs.sizes, designs)
    if not sizes:
        return some_of(limits, np.zeros(len(designs), int))
    return some_of(limits, np.ravel_multi_index([places[dim] for dim in sizes], tuple(sizes.values())))


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


def _change_together(scene: Scene) -> bool:
    """Return whether inputs change over the angle and over designs at once, besides arrays that are evaluated for pairs
    of both."""
    first = {dim: np.zeros(1, dtype=int) for dim in scene.at_one_angle.inputs.sizes}
    at_one_angle = scene.at(scene.grid(1), first) if changes_by_pairs(scene) else scene.at_one_angle
    fields = at_one_angle.inputs.fields.values()
    return any(scene.mechanism.index in field.dims and len(field.dims) > 1 for field in fields)


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
