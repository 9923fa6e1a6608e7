"""Time derivatives to ten parameters: their kernel against that of the quantity alone, and those of an exact peak."""

from __future__ import annotations

from functools import partial

import linksweep as ls
from benchmarks.cases import Size
from benchmarks.speed.kernel import kernel_of, way
from benchmarks.timing import SHARE, Row, race
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.results.compute import compute
from linksweep.scene.derivatives.differentiated import differentiated, number_problem
from linksweep.scene.parameters import free

GOALS = {"press": 5.0, "engine": 5.0, "watt-2": 5.0, "jansen-leg": 5.0}
"""Times of the quantity alone that it and its ten derivatives may take, by example."""
PARAMETERS = 10
"""Number of parameters: the first ones of the links, which change everything."""


def rows(size: Size) -> list[Row]:
    return [_row(name, goal, size) for name, goal in GOALS.items()]


def _row(name: str, goal: float, size: Size) -> Row:
    """Return the row of an example: its second pin force squared, with derivatives and without."""
    scene = ls.example(name)
    force = f"{scene.mechanism.peak_quantities(scene.drive)[1]}_squared"
    paths = tuple(path for path in free(scene) if path.partition(".")[0] in scene.mechanism.roles)
    paths = tuple(path for path in paths if not number_problem(scene, path))[:PARAMETERS]
    angles = max(size.angles // 10, 1)
    grid = scene.grid(angles)
    sampled, own = scene.at(grid), differentiated(scene, (force,), paths).at(grid)
    every = (force, *(derivative_of(force, path) for path in paths))
    plain, slopes = f"{name}, {force}", f"{name}, {force} and {len(paths)} derivatives"
    with way("compiled"):
        alone = kernel_of(partial(compute, sampled, grid, (force,), 1))
        both = kernel_of(partial(compute, own, grid, every, 1))
        timed = race({slopes: both.call, plain: alone.call}, size, angles)
    return timed.row(SHARE, slopes, plain, goal)
