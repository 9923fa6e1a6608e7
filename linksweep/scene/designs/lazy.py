"""Scenes whose numbers are yet to be computed: DataArrays that are dask's.

The constructor does not check such numbers; they are checked once computed. The form of results does not depend on
them, so that one design of made-up numbers shows it.
"""

from __future__ import annotations

from collections.abc import Iterable

from linksweep.base.validate import is_lazy
from linksweep.scene.designs.selection import design_sizes
from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene


def lazy_paths(scene: Scene) -> list[str]:
    """Return the paths of the parameters whose numbers are yet to be computed."""
    return [path for path, array in scene.arrays.items() if is_lazy(array)]


def in_memory(scene: Scene, paths: Iterable[str] | None = None) -> Scene:
    """Compute these parameters of a scene, by default all that are lazy; the scene itself where there are none.

    Raises ValueError where their numbers are not allowed.
    """
    paths = lazy_paths(scene) if paths is None else list(paths)
    if not paths:
        return scene
    import dask  # here: only those who have dask arrays have dask

    return replaced(scene, dict(zip(paths, dask.compute(*(scene.arrays[path] for path in paths)), strict=True)))


def stand_in(scene: Scene) -> Scene:
    """Return the first design with made-up lazy numbers in place of lazy ones, so that none is checked."""
    import dask.array

    sizes, made = design_sizes(scene), {}
    for k, (path, array) in enumerate(scene.arrays.items(), 1):
        first = array.isel({dim: slice(0, 1) for dim in array.dims if dim in sizes})
        numbers = dask.array.full(first.shape, 0.7 + 0.01 * k)  # 0 and 1 are worth knowing when planning
        made[path] = first.copy(data=numbers) if is_lazy(array) else first
    return replaced(scene, made)
