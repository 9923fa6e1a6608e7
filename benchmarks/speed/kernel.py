"""Select linksweep's way to run (interpreted or compiled); extract compiled kernels without the Python around them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import NamedTuple
from unittest import mock

import numpy as np

import linksweep as ls
from benchmarks.timing import Call
from linksweep.engine import run
from linksweep.engine.linear.solve import unknowns
from linksweep.engine.peaks import laid_out
from linksweep.engine.threads import at_most
from linksweep.results.system import sampled_systems


class Kernel(NamedTuple):
    """A compiled kernel: its sources, as `engine.kernel.compile` takes them, and a call bound to all its arguments."""

    sources: tuple[str, ...]
    call: Call


@contextmanager
def way(name: str) -> Iterator[None]:
    """Run all requests "compiled" from their first sample, or "interpreted" always."""
    most = {"compiled": -1, "interpreted": math.inf}[name]
    with mock.patch.object(run, "COMPILE_AFTER", most), mock.patch.object(laid_out, "INTERPRETED_DESIGNS", most):
        yield


def kernel_of(call: Call) -> Kernel:
    """Return the largest kernel that a call runs, for all its samples: equal inputs, equal buffers, no labels."""
    kernels: list[Kernel] = []
    compiled = run.compiled

    def recording(*sources: str) -> Callable:
        def kernel(*arguments) -> None:
            kernels.append(Kernel(sources, partial(compiled(*sources), *arguments)))
            kernels[-1].call()

        return kernel

    with mock.patch.object(run, "compiled", recording), way("compiled"):
        call()
    sources = max((kernel.sources for kernel in kernels), key=lambda sources: len(sources[0]))
    parts = [kernel.call for kernel in kernels if kernel.sources == sources]
    return Kernel(sources, lambda: [part() for part in parts])


def eliminations(scene: ls.Scene, angles: int) -> tuple[Call, Call]:
    """Return two solutions of a scene's square systems, by linksweep from their terms and by numpy from their matrices:
    no kinematics, no labels."""
    grid = scene.grid(angles)
    systems, page = sampled_systems(scene.at(grid), grid), ls.system(scene, grid.angles)
    matrix, rhs = (np.ascontiguousarray(page[part].values) for part in ("matrix", "rhs"))

    def ours() -> np.ndarray:
        with at_most(1):
            return unknowns(systems.structure, systems.values)

    return ours, lambda: np.linalg.solve(matrix, rhs[..., None])
