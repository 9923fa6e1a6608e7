"""Derivatives of quantities to parameters, at the angles of a grid and at pairs of a design and an angle."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from linksweep.engine.run import Field, Grid
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.results.compute import blank, compute, sample_status
from linksweep.scene.derivatives.differentiated import Differentiated, differentiated
from linksweep.scene.dimensions import aligned
from linksweep.scene.pairs import Array, quantities_at
from linksweep.scene.scene import Scene


class Samples(NamedTuple):
    """Values and derivatives of quantities over a grid, by name and by name and parameter, and the status."""

    values: Mapping[str, Field]
    derivatives: Mapping[tuple[str, str], Field]
    status: Field


def sample_derivatives(scene: Scene, grid: Grid, names: tuple[str, ...], to: tuple[str, ...]) -> Samples:
    """Return quantities at the angles of a grid, and their derivatives to parameters; NaN where not ok."""
    sampled = differentiated(scene, names, to).at(grid)
    named = {(name, path): derivative_of(name, path) for name in names for path in to}
    fields = compute(sampled, grid, (*names, *named.values()))
    status = sample_status(scene.at(grid), grid)
    blank(fields, status)
    return Samples({name: fields[name] for name in names}, {key: fields[own] for key, own in named.items()}, status)


class Pairs(NamedTuple):
    """Designs of a scene over some of its dims, row-major: `designs` are their numbers in the whole scene, `places`
    those over these dims."""

    scene: Differentiated
    dims: tuple[str, ...]
    shape: tuple[int, ...]
    designs: Array
    places: Array

    def some(self, rows: Array) -> Pairs:
        """Return the designs in these rows, each as often as it is named."""
        return self._replace(designs=self.designs[rows], places=self.places[rows])

    def numbers(self, field: Field) -> Array:
        """Return a number for each design, of a field over some of the dims."""
        return np.broadcast_to(aligned(field, self.dims), self.shape).ravel()[self.places].astype(float)

    def at(self, names: tuple[str, ...], angles: Array) -> Array:
        """Return values (names, designs) of quantities at an angle [degree] of each design; NaN where the angle is."""
        known = np.isfinite(angles)
        values = np.full((len(names), len(angles)), np.nan)
        if names:
            values[:, known] = quantities_at(self.scene, names, self.designs[known], angles[known])
        return values

    def field(self, values: Array) -> Field:
        """Return numbers of the designs over their dims."""
        return Field(self.dims, values.reshape(self.shape))


def pairs_over(scene: Differentiated, dims: tuple[str, ...]) -> Pairs:
    """Return the designs of a scene that differ along these dims."""
    sizes = scene.at_one_angle.inputs.sizes
    ordered = tuple(dim for dim in sizes if dim in dims)
    every = np.arange(int(np.prod(tuple(sizes.values()), dtype=int))).reshape(tuple(sizes.values()))
    some = every[tuple(slice(None) if dim in dims else 0 for dim in sizes)]
    return Pairs(scene, ordered, some.shape, some.ravel(), np.arange(some.size))
