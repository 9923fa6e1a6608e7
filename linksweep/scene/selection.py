"""Some of the designs of a scene, and the texts of such parts put together again."""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Mapping, Sequence
from itertools import product
from math import prod
from typing import Any

import numpy as np

from linksweep.scene.file import dumped
from linksweep.scene.paths import replaced
from linksweep.scene.scene import Scene

Block = dict[str, slice]
"""A part of each of some design dims."""


def design_sizes(scene: Scene) -> dict[str, int]:
    """Sizes of the design dims that a scene's arrays bring, in the order in which its parameters do."""
    index = scene.mechanism.index
    return {str(dim): n for array in scene.arrays.values() for dim, n in array.sizes.items() if dim != index}


def selected(scene: Scene, block: Block) -> Scene:
    """The scene of some designs only; every dim stays, however short.

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
    """Parts of at most `limit` designs that together are all of them; the longest dims are cut first.

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


def joined_text(texts: Sequence[tuple[Block, str]], sizes: Mapping[str, int]) -> str:
    """The text of a whole scene from the texts of its parts: only what stands in a text over a cut dim differs."""
    first = texts[0][1]
    if all(text == first for _, text in texts):
        return first
    return dumped(_joined([(block, tomllib.loads(text)) for block, text in texts], sizes))


def _joined(parts: list[tuple[Block, Any]], sizes: Mapping[str, int]) -> Any:
    block, first = parts[0]
    if isinstance(first, list):
        return [_joined([(block, part[k]) for block, part in parts], sizes) for k in range(len(first))]
    if not isinstance(first, dict):
        return first
    dims = first.get("dims", [first.get("dim")])
    if "values" in first and block.keys() & {*dims}:
        return _joined_array(parts, dims, sizes)
    return {key: _joined([(block, part[key]) for block, part in parts], sizes) for key in first}


def _joined_array(parts: list[tuple[Block, Any]], dims: list[str], sizes: Mapping[str, int]) -> dict[str, Any]:
    """A design axis over cut dims; numbers stay of the kind that they are written as."""
    first = parts[0][1]
    coords = {
        dim: _filled([(block, part["coords"][dim]) for block, part in parts], [dim], sizes) for dim in first["coords"]
    }
    return first | {
        "values": _filled([(block, part["values"]) for block, part in parts], dims, sizes),
        "coords": coords,
    }


def _filled(parts: list[tuple[Block, list]], dims: Collection[str], sizes: Mapping[str, int]) -> list:
    shape = np.array(parts[0][1], dtype=object).shape
    cut = parts[0][0].keys()
    whole = np.empty([sizes[dim] if dim in cut else n for dim, n in zip(dims, shape, strict=True)], dtype=object)
    for block, values in parts:
        whole[tuple(block.get(dim, slice(None)) for dim in dims)] = np.array(values, dtype=object)
    listed: list = whole.tolist()
    return listed
