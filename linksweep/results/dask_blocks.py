"""Results of scenes whose numbers are yet to be computed: Datasets of dask arrays, one task a block of designs.

A block's task makes the scene of its designs, checks it at the door, and does with it what is done with any scene: so
the numbers are the same, to the bit. What results look like is known from one design of made-up numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.engine.trace.plan import plan
from linksweep.results.dataset import design_coordinates, kept_beside
from linksweep.scene.designs.lazy import in_memory, lazy_paths, stand_in
from linksweep.scene.designs.selection import design_sizes
from linksweep.scene.file.toml import write_scene
from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene

Dims = Mapping[Any, tuple[Any, ...]]
Known = Mapping[Any, xr.Variable]


@dataclass(frozen=True, eq=False)
class Task:
    """What is done with the numbers of a block: all that the results of two requests may differ in.

    dask takes it as it is, where it would look into a tuple, and for a Scene, which has a hash by content, among its
    keys.
    """

    scene: Scene
    function: Callable
    options: Mapping[str, Any]
    dims: Dims
    sizes: Mapping[Any, int]
    labels: list[Any]

    def __call__(self, numbers: xr.Dataset) -> xr.Dataset:
        """The result of one block, each variable over the dims that it has in the whole."""
        index = self.scene.mechanism.index
        arrays = {path: _renamed(numbers[path], _along(path), index) for path in self.scene.arrays}
        found = self.function(replaced(self.scene, arrays), **self.options)
        sizes = {**self.sizes, **numbers.sizes}
        shapes = {name: {dim: sizes[dim] for dim in dims} for name, dims in self.dims.items()}
        variables = {name: found[name].variable.set_dims(shape) for name, shape in shapes.items()}
        return xr.Dataset(variables, {name: found[name].variable for name in self.labels})


def by_blocks(function: Callable, scene: Scene, of_samples: bool, **options: Any) -> xr.Dataset:
    """function(scene, **options); where some of the scene's numbers are lazy, block by block, when they are asked for.

    Blocks are the chunks of the lazy parameters, each computed by one thread unless `threads` says otherwise. A lazy
    number without dims, or one over a dim of its own name, which xarray holds in memory, is computed at once.

    Parameters
    ----------
    function : of a scene and options, that gives a Dataset
    of_samples : whether its numbers are of one sample each. Then what designs share is what any of them has. Otherwise
        dims along which they share something are not cut; and the dims of `status` depend on the numbers: lazy, it has
        all that it could have
    """
    lazy = lazy_paths(scene)
    at_once = [path for path in lazy if scene.arrays[path].dims in ((), (path,))]
    scene = in_memory(scene, at_once)
    if lazy == at_once:
        return function(scene, **options)
    options["threads"] = options["threads"] or 1
    one, order, judged = _looks(function, scene, options)
    known = _known(scene, one)
    dims: Dims = {name: v.dims for name, v in one.variables.items() if name not in known}
    dims = dims if of_samples else {**dims, "status": order}
    shared = {name: [dim for dim in judged if dim not in own] for name, own in dims.items()}
    numbers = _numbers(scene, uncut=() if of_samples else {dim for beyond in shared.values() for dim in beyond})
    spread = {name: (*own, *shared[name]) for name, own in dims.items()}
    task = Task(stand_in(scene), function, options, spread, dict(one.sizes), list(one.indexes))
    found = xr.map_blocks(_done, numbers, kwargs={"task": task}, template=_template(one, spread, known, numbers))
    variables = known | {name: _any(found[name].variable, shared[name]) for name in dims}
    data, coordinates = ({name: variables[name] for name in part} for part in (one.data_vars, one.coords))
    return xr.Dataset(data, coordinates, _attributes(scene, one))


class Looks(NamedTuple):
    """The result of one design; the design dims in their order; and those that decide whether a sample is ok."""

    one: xr.Dataset
    order: tuple[str, ...]
    judged: tuple[str, ...]


def _looks(function: Callable, scene: Scene, options: Mapping[str, Any]) -> Looks:
    import dask  # here and below: only those who have dask arrays have dask

    with dask.config.set(scheduler="synchronous"), np.errstate(all="ignore"):  # no work for a cluster, and no numbers
        first = stand_in(scene)
        inputs = first.at_one_angle.inputs
        judged = plan(first.table, ("status",), inputs.forms)
        dims = judged.dims(judged.outputs["status"])
        return Looks(function(first, **options), tuple(inputs.sizes), tuple(d for d in dims if d != judged.index))


def _done(numbers: xr.Dataset, task: Task) -> xr.Dataset:
    return task(numbers)  # to dask, two tasks differ by their words, not by their function


def _any(variable: xr.Variable, shared: list[str]) -> xr.Variable:
    """What any of the designs has that share it."""
    if not shared:
        return variable
    import dask.array

    axes = tuple(variable.dims.index(dim) for dim in shared)
    data = dask.array.reduction(variable.data, chunk=_not_nan, aggregate=_not_nan, axis=axes, dtype=variable.dtype)
    return xr.Variable([dim for dim in variable.dims if dim not in shared], data, variable.attrs)


def _not_nan(values: np.ndarray, axis: tuple[int, ...], keepdims: Any) -> np.ndarray:
    return np.fmax.reduce(values, axis=axis, keepdims=keepdims)


def _known(scene: Scene, one: xr.Dataset) -> dict[Any, xr.Variable]:
    """What takes no blocks: labels, and the parameters as they were given."""
    given = design_coordinates(scene)
    return {name: one.variables[name] for name in one.indexes} | {k: v for k, v in given.items() if k in one.coords}


def _numbers(scene: Scene, uncut: Iterable[str]) -> xr.Dataset:
    """All arrays of the scene in one Dataset, cut alike along the design dims, but for some, and whole along the index.

    Designs without labels are counted, so that messages say which one it is.
    """
    index, sizes = scene.mechanism.index, design_sizes(scene)
    plain = {path: array.drop_vars({*array.coords} - {*array.dims}) for path, array in scene.arrays.items()}
    numbers = xr.Dataset({path: _renamed(array, index, _along(path)) for path, array in plain.items()})
    counted = {dim: np.arange(n) for dim, n in sizes.items() if dim not in numbers.coords}
    whole = {dim: -1 for dim in numbers.dims if dim not in sizes or dim in uncut}
    return numbers.assign_coords(counted).chunk(whole).unify_chunks()


def _along(path: str) -> str:
    """The dim of one array over the index: each is given at angles of its own."""
    return f"{path} along the index"


def _renamed(array: xr.DataArray, dim: str, name: str) -> xr.DataArray:
    return array.rename({dim: name}) if dim in array.dims else array


def _template(one: xr.Dataset, dims: Dims, known: Known, numbers: xr.Dataset) -> xr.Dataset:
    """What the blocks give together."""
    import dask.array

    sizes = {**one.sizes, **numbers.sizes}
    variables = {}
    for name, own in dims.items():
        chunks = [numbers.chunks.get(dim, (sizes[dim],)) for dim in own]
        data = dask.array.empty([sizes[dim] for dim in own], dtype=one[name].dtype, chunks=chunks)
        variables[name] = xr.Variable(own, data, one[name].attrs)
    return xr.Dataset(variables, {name: known[name] for name in one.indexes})


def _attributes(scene: Scene, one: xr.Dataset) -> dict[str, Any]:
    """Those of the whole: with the scene as text, unless some of it is lazy and not among the coordinates."""
    beside = kept_beside(scene, one.coords)
    if not {*lazy_paths(scene)} <= {*beside}:
        return {name: value for name, value in one.attrs.items() if name != "scene"}
    return one.attrs | {"scene": write_scene(scene, beside)}
