"""Time derivatives: their kernels against those of the quantity alone, to ten parameters and to the crank angle.

The latter is what a Newton step of the peak search would take, of which the row's note says how many it could save.
"""

from __future__ import annotations

from functools import partial

import numpy as np

import linksweep as ls
from benchmarks.cases import Size
from benchmarks.speed.exact import crank_rockers
from benchmarks.speed.kernel import kernel_of, way
from benchmarks.timing import SHARE, Row, race
from linksweep.engine.peaks.samples import SAMPLES
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.engine.trace.plan import plan
from linksweep.results.compute import compute
from linksweep.scene.derivatives.differentiated import ANGLE, differentiated, number_problem
from linksweep.scene.parameters import free

GOALS = {"press": 5.0, "engine": 5.0, "watt-2": 5.0, "jansen-leg": 5.0}
"""Times of the quantity alone that it and its ten derivatives may take, by example."""
PARAMETERS = 10
"""Number of parameters: the first ones of the links, which change everything."""


def rows(size: Size) -> list[Row]:
    return [*(_row(name, goal, size) for name, goal in GOALS.items()), _newton_step(size)]


def _row(name: str, goal: float, size: Size) -> Row:
    """Return the row of an example: its second pin force squared, with derivatives and without."""
    scene = ls.example(name)
    force = f"{scene.mechanism.peak_quantities(scene.drive)[1]}_squared"
    paths = tuple(path for path in free(scene) if path.partition(".")[0] in scene.mechanism.roles)
    paths = tuple(path for path in paths if not number_problem(scene, path))[:PARAMETERS]
    return _against_itself(scene, force, paths, f"{len(paths)} derivatives", goal, size, name)


def _newton_step(size: Size) -> Row:
    """Return the row of a force with its slope to the crank angle, and how many evaluations follow the samples of a
    search, of random crank-rockers."""
    taken = ls.peaks(crank_rockers(max(size.designs // 10, 1), 20.0), of=["F32_samples"]).F32_samples.values
    note = f"a search takes {SAMPLES} samples and {np.mean(taken) - SAMPLES:.1f} evaluations after them"
    return _against_itself(ls.example("press"), "F32_squared", (ANGLE,), "its slope", None, size, "press", note)


def _against_itself(
    scene: ls.Scene,
    force: str,
    paths: tuple[str, ...],
    words: str,
    goal: float | None,
    size: Size,
    name: str,
    *notes: str,
) -> Row:
    """Return the row of a quantity and its derivatives against the quantity alone."""
    angles = max(size.angles // 10, 1)
    grid = scene.grid(angles)
    sampled, own = scene.at(grid), differentiated(scene, (force,), paths).at(grid)
    every = (force, *(derivative_of(force, path) for path in paths))
    plain, slopes = f"{name}, {force}", f"{name}, {force} and {words}"
    with way("compiled"):
        alone = kernel_of(partial(compute, sampled, grid, (force,)))
        both = kernel_of(partial(compute, own, grid, every))
        timed = race({slopes: both.call, plain: alone.call}, size, angles)
    ours, theirs = _instructions(own, every), _instructions(sampled, (force,))
    return timed.row(SHARE, slopes, plain, goal, note="; ".join([f"{ours} against {theirs} instructions", *notes]))


def _instructions(scene: ls.Scene, names: tuple[str, ...]) -> int:
    """Return the number of instructions per angle of a scene's quantities."""
    return plan(scene.table, names, scene.inputs.forms).instructions(scene.mechanism.index)
