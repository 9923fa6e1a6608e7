"""A study in chunks: what is asked of a scene, how its designs are cut, and the peaks of one chunk."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Generator, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.conversion import all_to_float64
from linksweep.results.peaks import peaks
from linksweep.scene.curves.over_position import is_function
from linksweep.scene.curves.tabulated import values_at
from linksweep.scene.designs.selection import Block, blocks, design_sizes, selected
from linksweep.scene.file.toml import write_scene
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

STEP = 0.05
"""Of the angles [degree] at whose values a function of theta2 is known again."""


def chunk_of_peaks(
    scene: Scene, of: Iterable[str] | None, block: Block, threads: int | None = None, **options: Any
) -> xr.Dataset:
    """Peaks of some designs of a scene, as `linksweep.peaks` gives them; nothing else goes in or out.

    Examples
    --------
    >>> import linksweep as ls
    >>> chunk_of_peaks(ls.example("press"), ["T12"], {}).equals(ls.peaks(ls.example("press"), of=["T12"]))
    True
    """
    return peaks(selected(scene, block), of, threads=threads, **options)


@dataclass(frozen=True, eq=False)
class Job:
    """The peaks asked of a scene: `of` and the other words of `linksweep.peaks`, in chunks of so many designs."""

    scene: Scene
    of: list[str] | None
    options: Mapping[str, Any]
    chunk: int

    @cached_property
    def sizes(self) -> dict[str, int]:
        return design_sizes(self.scene)

    @cached_property
    def blocks(self) -> list[Block]:
        return blocks(self.sizes, self.chunk)

    @property
    def words(self) -> str:
        """The request, as it stands in a call."""
        given = ({} if self.of is None else {"of": self.of}) | dict(self.options)
        return ", ".join(["scene", *(f"{word}={value!r}" for word, value in given.items())])

    @cached_property
    def result(self) -> dict[str, Any]:
        """What makes two jobs give the same numbers: digest of the scene, and the request."""
        options = {word: np.asarray(all_to_float64(value, "angle")).tolist() for word, value in self.options.items()}
        return {"scene": scene_digest(self.scene), "request": {"of": self.of, **options}}

    def designs(self, block: Block) -> int:
        """How many designs a block has."""
        return prod(block[dim].stop - block[dim].start if dim in block else n for dim, n in self.sizes.items())

    def compute(self, block: Block, threads: int | None) -> xr.Dataset:
        return chunk_of_peaks(self.scene, self.of, block, threads, **self.options)

    def chunks(self, numbers: Iterable[int], threads: int | None) -> Generator[tuple[int, xr.Dataset], None, None]:
        """Number and peaks of these chunks, one after the other."""
        for number in numbers:
            yield number, self.compute(self.blocks[number], threads)

    def try_out(self) -> None:
        """Compute one design, so that what is wrong with the request is said before anything is written."""
        self.compute({dim: slice(0, 1) for dim in self.sizes}, 1)


def scene_digest(scene: Scene) -> str:
    """SHA-256 of all that makes a scene: its text, its arrays and their labels; functions by their values.

    Functions of a position by those that the first design has all the way round.
    """
    digest = hashlib.sha256(write_scene(scene, elsewhere=scene.arrays).encode())
    angles = np.arange(0.0, scene.period, STEP)
    for function in scene.functions.values():  # also of one that the text cannot hold
        digest.update(values_at(function, angles).tobytes())
    if any(is_function(curve) for load in scene.loads for curve in load.over_positions):
        first = selected(scene, {dim: slice(0, 1) for dim in design_sizes(scene)})
        for array in first.at(crank_grid(len(angles), scene.period)).arrays.values():
            digest.update(np.ascontiguousarray(array.values, dtype=float).tobytes())
    for path, array in scene.arrays.items():
        labels = {str(dim): array[dim].values.tolist() for dim in array.dims if dim in array.coords}
        digest.update(json.dumps([path, array.dims, array.shape, labels], default=str).encode())
        digest.update(np.ascontiguousarray(array.values, dtype=float).tobytes())
    return digest.hexdigest()
