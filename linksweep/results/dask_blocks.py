"""Compute scenes of lazy numbers block by block: Datasets of dask arrays, one task a block of designs.

A block's task makes the scene of its designs, checks it in the constructor, and calls the function that any scene goes
to: so the numbers are the same, to the bit. One design of made-up numbers shows what the results look like.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import wraps
from typing import Any, ParamSpec

import numpy as np
import xarray as xr

from linksweep.engine.threads import threads_of_a_task
from linksweep.engine.trace.plan import plan
from linksweep.results.dataset import design_coordinates, kept_beside
from linksweep.scene.at_sections import with_sections
from linksweep.scene.designs.lazy import in_memory, lazy_paths, stand_in
from linksweep.scene.designs.selection import design_sizes
from linksweep.scene.file.writing import write_scene
from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene

Dims = Mapping[Any, tuple[Any, ...]]
Known = Mapping[Any, xr.Variable]


P = ParamSpec("P")
Function = Callable[P, xr.Dataset]


@dataclass(frozen=True, eq=False)
class Task:
    """A function and its arguments, for the numbers of one block: all that two requests may differ in.

    dask takes it as it is, where it would look into a tuple, and for a Scene, which has a hash by content, among its
    keys.
    """

    scene: Scene
    function: Callable[..., xr.Dataset]
    arguments: tuple[Any, ...]
    options: Mapping[str, Any]
    dims: Dims
    sizes: Mapping[Any, int]
    labels: list[Any]

    def __call__(self, numbers: xr.Dataset) -> xr.Dataset:
        """Return the result of one block, each variable over the dims that it has in the whole."""
        index = self.scene.mechanism.index
        arrays = {path: _renamed(numbers[path], _along(path), index) for path in self.scene.arrays}
        ds = self.function(replaced(self.scene, arrays), *self.arguments, **self.options)
        sizes = {**self.sizes, **numbers.sizes}
        shapes = {name: {dim: sizes[dim] for dim in dims} for name, dims in self.dims.items()}
        variables = {name: ds[name].variable.set_dims(shape) for name, shape in shapes.items()}
        return xr.Dataset(variables, {name: ds[name].variable for name in self.labels})


def by_blocks(*, of_samples: bool) -> Callable[[Function[P]], Function[P]]:
    """Decorate a function of a scene: where numbers of the scene are lazy, so is the Dataset that it returns.

    Blocks are the chunks of the lazy parameters, each computed by one thread unless `threads` says otherwise. A lazy
    number without dims, or one over a dim of its own name, which xarray holds in memory, is computed at once, and so
    is a scene of one design, which has no blocks. The function checks its arguments itself: it is called at once in any
    case, for one design where numbers are lazy.

    Parameters
    ----------
    of_samples : bool
        True where each number belongs to one sample: designs that share a variable then share its non-NaN value.
        Otherwise dims along which designs share something are not cut, and the dims of `status` depend on the numbers:
        lazy, it has all that it could have.
    """

    def decorate(function: Function[P]) -> Function[P]:
        @wraps(function)
        def computed(*arguments: P.args, **options: P.kwargs) -> xr.Dataset:
            scene = arguments[0] if arguments else options.get("scene")
            if not isinstance(scene, Scene) or not lazy_paths(scene):
                return function(*arguments, **options)
            scene = with_sections(scene, _requested(arguments, options))
            others = {n: list(v) if isinstance(v, Iterator) else v for n, v in options.items() if n != "scene"}
            return _lazily(computed, function, scene, arguments[1:], others, of_samples)

        return computed

    return decorate


def _requested(arguments: tuple[Any, ...], options: Mapping[str, Any]) -> Any:
    """Return the names of quantities among arguments, as far as a text or a list has them."""
    named = next((options[word] for word in ("of", "outputs") if options.get(word) is not None), arguments[-1])
    return named if isinstance(named, str | list | tuple) else None


def _lazily(
    computed: Callable,
    function: Callable,
    scene: Scene,
    arguments: tuple[Any, ...],
    options: dict[str, Any],
    of_samples: bool,
) -> xr.Dataset:
    """Return the lazy result of a decorated function, `computed`, from the function itself of one design."""
    one_design = not design_sizes(scene)
    alone = [path for path in lazy_paths(scene) if one_design or scene.arrays[path].dims in ((), (path,))]
    scene = in_memory(scene, alone)
    if not lazy_paths(scene):
        return computed(scene, *arguments, **options)
    options["threads"] = threads_of_a_task() if options.get("threads") is None else options["threads"]
    one, order, deciding = _looks(lambda scene: function(scene, *arguments, **options), scene)
    known = _known(scene, one)
    dims: Dims = {name: v.dims for name, v in one.variables.items() if name not in known}
    dims = dims if of_samples else {**dims, "status": order}
    shared = {name: [dim for dim in deciding if dim not in own] for name, own in dims.items()}
    numbers = _numbers(scene, uncut=() if of_samples else {dim for beyond in shared.values() for dim in beyond})
    spread = {name: (*own, *shared[name]) for name, own in dims.items()}
    task = Task(stand_in(scene), computed, arguments, options, spread, dict(one.sizes), list(one.indexes))
    blocks = xr.map_blocks(_compute, numbers, kwargs={"task": task}, template=_template(one, spread, known, numbers))
    variables = known | {name: _any(blocks[name].variable, shared[name]) for name in dims}
    data, coordinates = ({name: variables[name] for name in part} for part in (one.data_vars, one.coords))
    return xr.Dataset(data, coordinates, _attributes(scene, one))


def _looks(
    function: Callable[[Scene], xr.Dataset], scene: Scene
) -> tuple[xr.Dataset, tuple[str, ...], tuple[str, ...]]:
    """Return the result of one design; the design dims in their order; and those that decide if a sample is ok."""
    import dask  # here and below: only those who have dask arrays have dask

    # No work for a cluster, and no numbers. Beside a cluster, older dask warns of a scheduler that is named by a word.
    with dask.config.set(scheduler=dask.get), np.errstate(all="ignore"):
        first = stand_in(scene)
        inputs = first.at_one_angle.inputs
        request = plan(first.table, ("status",), inputs.forms)
        dims = request.dims(request.outputs["status"])
        return function(first), tuple(inputs.sizes), tuple(dim for dim in dims if dim != request.index)


def _compute(numbers: xr.Dataset, task: Task) -> xr.Dataset:
    return task(numbers)  # to dask, two tasks differ by their arguments, not by their function


def _any(variable: xr.Variable, shared: list[str]) -> xr.Variable:
    """Reduce over the dims in `shared`, keeping any non-NaN value."""
    if not shared:
        return variable
    import dask.array

    axes = tuple(variable.dims.index(dim) for dim in shared)
    data = dask.array.reduction(variable.data, chunk=_not_nan, aggregate=_not_nan, axis=axes, dtype=variable.dtype)
    return xr.Variable([dim for dim in variable.dims if dim not in shared], data, variable.attrs)


def _not_nan(values: np.ndarray, axis: tuple[int, ...], keepdims: Any) -> np.ndarray:
    return np.fmax.reduce(values, axis=axis, keepdims=keepdims)


def _known(scene: Scene, one: xr.Dataset) -> dict[Any, xr.Variable]:
    """Return the variables that take no blocks: labels, and the scene's own parameters."""
    parameters = {name: values for name, values in design_coordinates(scene).items() if name in one.coords}
    return {name: one.variables[name] for name in one.indexes} | parameters


def _numbers(scene: Scene, uncut: Iterable[str]) -> xr.Dataset:
    """Return the arrays of the scene in one Dataset, chunked alike along all design dims but those in `uncut`.

    Designs without labels are counted, so that messages say which one it is.
    """
    index, sizes = scene.mechanism.index, design_sizes(scene)
    plain = {path: array.drop_vars({*array.coords} - {*array.dims}) for path, array in scene.arrays.items()}
    numbers = xr.Dataset({path: _renamed(array, index, _along(path)) for path, array in plain.items()})
    counted = {dim: np.arange(n) for dim, n in sizes.items() if dim not in numbers.coords}
    whole = {dim: -1 for dim in numbers.dims if dim not in sizes or dim in uncut}
    return numbers.assign_coords(counted).chunk(whole).unify_chunks()


def _along(path: str) -> str:
    """Return the dim of one array over the index: each has angles of its own."""
    return f"{path} along the index"


def _renamed(array: xr.DataArray, dim: str, name: str) -> xr.DataArray:
    return array.rename({dim: name}) if dim in array.dims else array


def _template(one: xr.Dataset, dims: Dims, known: Known, numbers: xr.Dataset) -> xr.Dataset:
    """Return a Dataset that looks like all blocks together."""
    import dask.array

    sizes = {**one.sizes, **numbers.sizes}
    variables = {}
    for name, own in dims.items():
        chunks = [numbers.chunks.get(dim, (sizes[dim],)) for dim in own]
        data = dask.array.empty([sizes[dim] for dim in own], dtype=one[name].dtype, chunks=chunks)
        variables[name] = xr.Variable(own, data, one[name].attrs)
    return xr.Dataset(variables, {name: known[name] for name in one.indexes})


def _attributes(scene: Scene, one: xr.Dataset) -> dict[str, Any]:
    """Return the attributes of the whole: with the scene as text, unless the coordinates lack a lazy parameter."""
    beside = kept_beside(scene, one.coords)
    if not {*lazy_paths(scene)} <= {*beside}:
        return {name: value for name, value in one.attrs.items() if name != "scene"}
    return one.attrs | {"scene": write_scene(scene, beside)}
