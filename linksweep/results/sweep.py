"""sweep(scene): the kinematics and forces of a scene at many crank angles, as a Dataset."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from linksweep.base.validate import choice_problems, count_problems, refuse
from linksweep.results.compute import blank, compute, quantity_problems, requested, require_scene, sample_status
from linksweep.results.dask_blocks import by_blocks
from linksweep.results.dataset import described
from linksweep.results.system import dense_solution
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

SOLVERS = ("fast", "superposed", "dense")


@by_blocks(of_samples=True)
def sweep(
    scene: Scene,
    theta2: ArrayLike = 720,
    outputs: str | Iterable[str] | None = None,
    solver: str = "fast",
    threads: int | None = None,
) -> xr.Dataset:
    """Sweep a scene over crank angles.

    Parameters
    ----------
    scene : Scene
    theta2 : a count N, for the grid arange(N)·360/N, or any array of angles [degree]; where a load takes two turns, as
        in a four-stroke engine, the grid is arange(N)·720/N. For a car in a loop these are positions, `theta`
    outputs : names of the variables wanted; only what they need is computed. Default: the kinematics and the nine
        unknowns
    solver : "fast" (the 9×9 eliminated by hand), "superposed" (the same; along a design dim that carries masses, loads,
        speeds … over one geometry it adds up a few cycles, which is faster and rounds a little otherwise) or "dense"
        (the full 9×9 by LAPACK with partial pivoting, as a check)
    threads : at most so many (default: all cores); the numbers do not depend on it

    Returns
    -------
    Dataset over (design dims…, theta2). Each variable has only the dims that it depends on; units and sign in its
    attributes. `status` says what happened at each sample; where it is not 0 (ok) the values are NaN.

    Raises
    ------
    ValueError
        For an unknown name or angles that are no angles; for an `error_bound` of what is superposed.

    Notes
    -----
    Fij is the force of link i on link j in ground axes. Equations: document 2 (ME 470), with the misprints mended,
    and gravity.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> cycle = ls.sweep(scene, theta2=360, outputs=["T12", "F32"])
    >>> dict(cycle.sizes), cycle.T12.units
    ({'theta2': 360}, 'N m')
    """
    require_scene(scene)
    refuse([*choice_problems("solver", solver, SOLVERS), *count_problems("threads", threads)])
    grid = crank_grid(theta2, scene.period, scene.mechanism.index)
    names = default_names(scene) if outputs is None else _names(scene, requested("outputs", outputs))
    refuse(_bound_missing(names, solver))
    sampled = scene.at(grid)
    status = sample_status(sampled, grid, threads)
    known = {}
    if solver == "dense" or "cond" in names:
        solution = dense_solution(sampled, grid, status, threads)
        known = solution if solver == "dense" else {"cond": solution["cond"]}
    fields = compute(sampled, grid, names, threads, known, solver)
    blank(fields, status)
    command = _command(theta2, None if outputs is None else names, solver)
    return described(scene, sampled, grid, fields, status, command)


def default_names(scene: Scene) -> tuple[str, ...]:
    """Return the names of the quantities that a sweep computes where none are given."""
    return scene.mechanism.kinematics() + scene.mechanism.dynamics(scene.drive)


def _names(scene: Scene, names: list[str]) -> tuple[str, ...]:
    known = [*scene.table.quantity, "status"]
    refuse([problem for name in names for problem in quantity_problems("outputs", name, known, scene)])
    return tuple(name for name in names if name != "status")


def _bound_missing(names: Iterable[str], solver: str) -> list[str]:
    said = 'outputs: error_bound is of what solver="fast" does, not of superposed sums: leave one of the two out'
    return [said] if solver == "superposed" and "error_bound" in names else []


def _command(theta2: Any, names: Iterable[str] | None, solver: str) -> str:
    angles = theta2 if isinstance(theta2, int | np.integer) else f"<{np.size(theta2)} angles>"
    wanted = "" if names is None else f", outputs={list(names)}"
    return f"linksweep.sweep(scene, theta2={angles}{wanted}" + (")" if solver == "fast" else f", solver={solver!r})")
