"""sweep(scene): the kinematics and forces of a scene at many crank angles, as a Dataset."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from linksweep.base.validate import choice_problems, refuse
from linksweep.chains.between_links import force_name
from linksweep.engine.run import Field, Grid
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import (
    angles_of,
    blank,
    compute,
    either,
    quantity_problems,
    requested,
    require_scene,
    sample_status,
)
from linksweep.results.dask_blocks import by_blocks
from linksweep.results.dataset import STATUS_AT_LONG_NAME, described, flags, plain
from linksweep.results.system import condition_number, dense_unknowns
from linksweep.scene.at_sections import with_sections
from linksweep.scene.scene import Scene

COUNT = 720
"""Angles of a turn where none are named."""
STATUS_AT = "status_at"
DENSE = ("dense", "refined")
SOLVERS = ("fast", "superposed", *DENSE)


@by_blocks(of_samples=True)
@limits_threads
def sweep(
    scene: Scene,
    angles: ArrayLike | None = None,
    *,
    theta2: ArrayLike | None = None,
    theta: ArrayLike | None = None,
    of: str | Iterable[str] | None = None,
    outputs: str | Iterable[str] | None = None,
    solver: str = "fast",
    threads: int | None = None,
) -> xr.Dataset:
    """Compute the kinematics and forces of a scene at many crank angles.

    Parameters
    ----------
    scene : Scene
        Scene of any number of designs.
    angles : int or array_like, default None
        Count N of crank angles, for the grid arange(N)·360/N (·720/N where a load or gears take two turns, as in a
        four-stroke engine), or the angles themselves [degree]; None for 720. ``sweep(scene, 360)`` is short for
        ``sweep(scene, theta2=360)``.
    theta2 : int or array_like, default None
        Count of crank angles, or the angles [degree].
    theta : int or array_like, default None
        Count of positions of a car in a loop, or the positions [degree], 0 at the bottom.
    of : str or iterable of str, default None
        Names of quantities, as `linksweep.quantities` lists them: only what they need is computed. None for the
        kinematics, the unknown forces and torque, and the magnitudes of the pin forces.
    outputs : str or iterable of str, default None
        Another name of `of`.
    solver : {"fast", "superposed", "dense", "refined"}, default "fast"
        "fast": the square system eliminated by hand, dyad by dyad. "superposed": along a design dim of masses, loads,
        speeds … over one geometry a few cycles are added up, which is faster and rounds a little differently. "dense":
        the full system of `linksweep.system`, 9×9 for a four-bar, eliminated with partial pivoting, as a check.
        "refined": the same, then one step of iterative refinement with residuals in twice the precision.
    threads : int, default None
        Largest number of threads; None for all cores. Results do not depend on it.

    Returns
    -------
    Dataset
        Over (design dims…, theta2); each variable has only the dims that it depends on, with unit and sign in its
        attributes. `status` states for each sample whether it is ok; where it is not 0 (ok), values are NaN. For a
        linkage, `status_at`, where requested, states what fails first: 0 for nothing, else the number of a pin, or of a
        link past a pin, in the `flag_meanings` of its attributes.

    Raises
    ------
    ValueError
        If a name is unknown, an angle is no finite number, angles end at π, 2π or 4π (radians), `theta` is passed for a
        machine with a crank or `theta2` for a car in a loop, or the `error_bound` of superposed sums is requested.

    Notes
    -----
    Fij is the force of link i on link j in ground axes. Equations: document 2 (ME 470), with the misprints mended,
    and gravity.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> cycle = ls.sweep(scene, theta2=360, of=["T12", "F32"])
    >>> dict(cycle.sizes)
    {'theta2': 360}
    >>> float(cycle.F32.sel(theta2=90.0).round(3)), cycle.F32.units
    (181.633, 'N')
    """
    require_scene(scene)
    refuse(choice_problems("solver", solver, SOLVERS))
    word, quantities = either(of=of, outputs=outputs)
    names = default_names(scene) if quantities is None else _names(scene, word, requested(word, quantities, scene))
    with_place, names = STATUS_AT in names, tuple(name for name in names if name != STATUS_AT)
    angles = angles_of(scene, angles=angles, theta2=theta2, theta=theta)
    angles = COUNT if angles is None else angles
    scene = with_sections(scene, names)
    grid = scene.grid(angles)
    refuse(_bound_missing(names, solver))
    sampled = scene.at(grid)
    status = sample_status(sampled, grid)
    known = dense_unknowns(sampled, grid, solver == "refined") if solver in DENSE else {}
    if "cond" in names:
        known["cond"] = condition_number(sampled, grid)
    fields = compute(sampled, grid, names, known, solver)
    blank(fields, status)
    command = _command(grid.dim, angles, None if quantities is None else names, solver)
    cycle = described(scene, sampled, grid, fields, status, command)
    return cycle.assign(status_at=_status_at(sampled, grid)) if with_place else cycle


def default_names(scene: Scene) -> tuple[str, ...]:
    """Return the names of the quantities that a sweep computes by default: magnitudes of pin forces, too."""
    mechanism = scene.mechanism
    magnitudes = tuple(force_name(i, j) for i, j in mechanism.pins.values())
    return mechanism.kinematics() + mechanism.dynamics(scene.drive) + magnitudes


def _names(scene: Scene, word: str, names: list[str]) -> tuple[str, ...]:
    known = [*scene.table.quantity, "status", *([STATUS_AT] if scene.mechanism.places else [])]
    refuse([problem for name in names for problem in quantity_problems(word, name, known, scene)])
    return tuple(name for name in names if name != "status")


def _status_at(sampled: Scene, grid: Grid) -> xr.Variable:
    """Return the place that fails first at each sample, 0 where none does."""
    place = compute(sampled, grid, (STATUS_AT,))[STATUS_AT]
    attributes = flags(STATUS_AT_LONG_NAME, ("none", *sampled.mechanism.places))
    return plain(Field(place.dims, place.values.astype(np.int8)), attributes)


def _bound_missing(names: Iterable[str], solver: str) -> list[str]:
    problem = 'of: error_bound is of what solver="fast" does, not of superposed sums: leave one of the two out'
    return [problem] if solver == "superposed" and "error_bound" in names else []


def _command(index: str, angles: Any, names: Iterable[str] | None, solver: str) -> str:
    grid = angles if isinstance(angles, int | np.integer) else f"<{np.size(angles)} angles>"
    of = "" if names is None else f", of={list(names)}"
    return f"linksweep.sweep(scene, {index}={grid}{of}" + (")" if solver == "fast" else f", solver={solver!r})")
