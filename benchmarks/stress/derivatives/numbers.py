"""Numbers of scenes in 50 digits, by path: of each design a pair of columns for each parameter, which is moved in them
to either side by so little that the difference of their results is a derivative to 25 digits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from decimal import Decimal
from functools import cached_property

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.decimals import Array, exact, exactly
from linksweep.scene.parameters import free, replaced

DESIGN = "design"
RADIAN_IN_DEGREES = 57.29577951308232


@dataclass(frozen=True, eq=False)
class Numbers:
    """Numbers of a scene whose only dim may be `design`; the columns are (design, parameter, way), row by row."""

    scene: ls.Scene
    moved: tuple[str, ...]
    step: Decimal = Decimal("1e-15")
    """Distance to either side, of the parameter's size."""
    repeated: int = 1
    """Times that all columns stand one behind the other, as for several angles."""

    @cached_property
    def designs(self) -> int:
        return max((array.sizes[DESIGN] for array in self.scene.arrays.values() if DESIGN in array.dims), default=1)

    @property
    def shape(self) -> tuple[int, int, int]:
        return self.designs, len(self.moved), 2

    def __len__(self) -> int:
        return self.repeated * int(np.prod(self.shape))

    def times(self, count: int) -> Numbers:
        """Return the numbers in so many times the columns."""
        return replace(self, repeated=self.repeated * count)

    def __contains__(self, path: str) -> bool:
        return path in self.values

    @cached_property
    def values(self) -> dict[str, Array]:
        """Numbers that do not change over the cycle, as floats over the designs."""
        numbers = {path: value for path, (value, _) in free(self.scene).items()}
        alone = {path: value for path, value in numbers.items() if isinstance(value, float) or _over_designs(value)}
        return {path: np.broadcast_to(np.asarray(value, dtype=float), self.designs) for path, value in alone.items()}

    def sizes(self, path: str) -> Array:
        """Return the size of a parameter in each design: of an angle a radian, of what is 0 a size of its kind."""
        kind = free(self.scene)[path][1]
        if kind == "angle":
            return np.full(self.designs, RADIAN_IN_DEGREES)
        values = np.abs(self.values[path])
        others = {"length": self.values.get("crank.length", values + 1.0), "acceleration": values + 9.81}
        return np.where(values == 0.0, others.get(kind, np.ones(self.designs)), values)

    def __call__(self, path: str, default: float = 0.0) -> Array:
        """Return a number in all columns, moved in those of its own."""
        if path not in self.values:
            return exact(default, len(self))
        columns = np.repeat(exactly(self.values[path]), 2 * len(self.moved)).reshape(self.shape)
        for k, moved in enumerate(self.moved):
            if moved == path:
                away = self.away(path)
                columns[:, k, 0] += away
                columns[:, k, 1] -= away
        return np.tile(columns.ravel(), self.repeated)

    def away(self, path: str) -> Array:
        return exactly(self.sizes(path)) * self.step

    def columns(self, values: Array) -> Array:
        """Return numbers of the designs for all their columns."""
        return np.tile(np.repeat(values, 2 * len(self.moved)), self.repeated)

    @property
    def design(self) -> Array:
        """The design of each column."""
        return self.columns(np.arange(self.designs))

    def derivatives(self, results: Array) -> Array:
        """Return the derivatives (design, parameter) of results in all columns."""
        above, below = np.moveaxis(results.reshape(self.shape), 2, 0)
        return (above - below) / (2 * np.stack([self.away(path) for path in self.moved], axis=1))

    def sides(self, results: Array) -> Array:
        """Return the derivatives (side, design, parameter) to either side of the scene itself."""
        middle, away = self.middle(results)[:, None], np.stack([self.away(path) for path in self.moved], axis=1)
        above, below = np.moveaxis(results.reshape(self.shape), 2, 0)
        return np.stack([(above - middle) / away, (middle - below) / away])

    def middle(self, results: Array) -> Array:
        """Return the results (design,) of the scene itself."""
        return results.reshape(self.shape)[:, 0].sum(axis=1) / 2


class AtRest(Numbers):
    """Numbers of a scene whose slides stand still, so that none of them rubs."""

    def __call__(self, path: str, default: float = 0.0) -> Array:
        return exact(0.0, len(self)) if path.endswith("friction") else super().__call__(path, default)


def some(scene: ls.Scene, rows: Array, count: int) -> ls.Scene:
    """Return the scene of some designs."""
    if len(rows) == count:
        return scene
    arrays = {path: array for path, array in scene.arrays.items() if DESIGN in array.dims}
    return replaced(scene, {path: array.isel({DESIGN: rows}) for path, array in arrays.items()})


def over_designs(array: xr.DataArray, designs: int, **sizes: int) -> Array:
    """Return values over the designs, and over other dims of these sizes."""
    sizes = {DESIGN: designs, **sizes}
    return array.variable.set_dims({**sizes, **array.sizes}).transpose(*sizes).values


def turning_point(
    function: Callable[[Array], Array], near: Array, steps: tuple[str, ...] = ("1e-6", "1e-10")
) -> tuple[Array, Array]:
    """Return the angles [degree] near these at which a function of angles turns round, and its values there: the
    vertices of parabolas through three points, the last ones so close that they are exact to 20 digits."""
    at, value = near, near
    for step in map(Decimal, steps):
        before, middle, after = np.split(function(np.concatenate([at - step, at, at + step])), 3)
        bend = after - 2 * middle + before
        value = middle - (after - before) ** 2 / (8 * bend)
        at = at - step * (after - before) / (2 * bend)
    return at, value


def _over_designs(value: object) -> bool:
    return isinstance(value, xr.DataArray) and {*value.dims} <= {DESIGN}
