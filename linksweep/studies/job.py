"""A study as a job: the request, its designs split into chunks, and the peaks of one chunk."""

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
from linksweep.scene.file.writing import write_scene
from linksweep.scene.scene import Scene

STEP = 0.05
"""Step of the angles [degree] at which a function of theta2 is sampled for the scene's digest."""


@dataclass(frozen=True, eq=False)
class Job:
    """The peaks requested of a scene (`of` and other options of `linksweep.peaks`), in chunks of `chunk` designs."""

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
        """The request as arguments of a call."""
        options = ({} if self.of is None else {"of": self.of}) | dict(self.options)
        return ", ".join(["scene", *(f"{word}={value!r}" for word, value in options.items())])

    @cached_property
    def result(self) -> dict[str, Any]:
        """Identity of the result, equal for jobs that give equal numbers: digest of the scene, and the request."""
        every = self.options.items()
        options = {word: np.asarray(all_to_float64(word, value, "angle")).tolist() for word, value in every}
        return {"scene": scene_digest(self.scene), "request": {"of": self.of, **options}}

    def designs(self, block: Block) -> int:
        """Return the number of designs in a block."""
        return prod(block[dim].stop - block[dim].start if dim in block else n for dim, n in self.sizes.items())

    def compute(self, block: Block) -> xr.Dataset:
        """Return the peaks of the designs of a block, which depend on nothing else."""
        return peaks(selected(self.scene, block), self.of, **self.options)

    def chunks(self, numbers: Iterable[int]) -> Generator[tuple[int, xr.Dataset], None, None]:
        """Yield number and peaks of these chunks, one after the other."""
        for number in numbers:
            yield number, self.compute(self.blocks[number])

    def try_out(self) -> None:
        """Compute one design, so that problems of the request are raised before anything is written."""
        self.compute({dim: slice(0, 1) for dim in self.sizes})


def scene_digest(scene: Scene) -> str:
    """Return the SHA-256 of a whole scene: its text, its arrays and their labels; functions by sampled values.

    Functions of a position are sampled where the first design takes them over a whole cycle.
    """
    digest = hashlib.sha256(write_scene(scene, elsewhere=scene.arrays).encode())
    angles = np.arange(0.0, scene.period, STEP)
    for function in scene.functions.values():  # also a function that the text cannot hold
        digest.update(values_at(function, angles).tobytes())
    if any(is_function(curve) for load in scene.loads for curve in load.over_positions):
        first = selected(scene, {dim: slice(0, 1) for dim in design_sizes(scene)})
        for array in first.at(scene.grid(len(angles))).arrays.values():
            digest.update(np.ascontiguousarray(array.values, dtype=float).tobytes())
    for path, array in scene.arrays.items():
        labels = {str(dim): array[dim].values.tolist() for dim in array.dims if dim in array.coords}
        digest.update(json.dumps([path, array.dims, array.shape, labels], default=str).encode())
        digest.update(np.ascontiguousarray(array.values, dtype=float).tobytes())
    return digest.hexdigest()
