"""Some of the designs of a scene."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from math import prod

from linksweep.scene.parameters import replaced
from linksweep.scene.scene import Scene

Block = dict[str, slice]
"""A part of each of some design dims."""


def design_sizes(scene: Scene) -> dict[str, int]:
    """Return the sizes of the design dims of a scene's arrays, in the order of its parameters."""
    index = scene.mechanism.index
    return {str(dim): n for array in scene.arrays.values() for dim, n in array.sizes.items() if dim != index}


def selected(scene: Scene, block: Block) -> Scene:
    """Return the scene of some designs only; every dim stays, however short.

    Examples
    --------
    >>> import linksweep as ls
    >>> import xarray as xr
    >>> from dataclasses import replace
    >>> scene = replace(ls.example("press"), omega2=xr.DataArray([10.0, 20.0, 30.0], dims="speed"))
    >>> selected(scene, {"speed": slice(1, 3)}).omega2.values.tolist()
    [20.0, 30.0]
    """
    parts = {
        path: array.isel({dim: part for dim, part in block.items() if dim in array.dims})
        for path, array in scene.arrays.items()
        if block.keys() & {*array.dims}
    }
    return replaced(scene, parts)


def blocks(sizes: Mapping[str, int], limit: int) -> list[Block]:
    """Return parts of at most `limit` designs that together are all of them; the longest dims are cut first.

    Examples
    --------
    >>> blocks({"a": 5, "b": 2}, 4)
    [{'a': slice(0, 2, None)}, {'a': slice(2, 4, None)}, {'a': slice(4, 5, None)}]
    """
    steps = dict(sizes)
    while prod(steps.values()) > limit:
        longest = max(steps, key=lambda dim: steps[dim])
        others = prod(steps.values()) // steps[longest]
        steps[longest] = max(1, limit // others)
    cut = {dim: step for dim, step in steps.items() if step < sizes[dim]}
    parts = [[slice(k, min(k + step, sizes[dim])) for k in range(0, sizes[dim], step)] for dim, step in cut.items()]
    return [dict(zip(cut, part, strict=True)) for part in product(*parts)]
