"""Compute the errors of linksweep's results for random linkages against the multibody reference."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.decimals import Array, exactly, fifty_digits
from benchmarks.stress.linkages.multibody import JAMMED, JAMMED_TWO_SOLUTIONS, Solution, lines, solve
from benchmarks.stress.linkages.results import Results, named
from benchmarks.stress.linkages.scene import scene_of
from benchmarks.stress.linkages.scenes import chosen

KINDS = {
    "force": r"F\d.*|force_.*|normal_force",
    "torque": r"T\d.*",
    "angle": r"theta\d+|a_total_angle",
    "rate": r"omega\d+",
    "second rate": r"alpha\d+",
    "velocity": r"v.*|rate_.*|speed",
    "acceleration": r"a.*",
    "position": r".*",
}
"""Kinds of results by their names."""
LEAST = 1e-17
"""Bound that every machine has."""
LARGE = 2e-12
"""Error of forces above which the effect of a last digit of the lengths is computed, to compare."""
OF_THE_SCENE = {"theta2", "omega2", "alpha2"}
"""Results of the reference that are parameters."""


class Errors(NamedTuple):
    """Errors of the designs whose status is ok, the number of those whose status is wrong or whose values are none, and
    the results of the reference that linksweep does not have.

    Each number's error is relative to the largest of its kind in the machine: forces and torques to the largest force,
    and it times the longest length. `over_bound` is the largest force's over `bound`, which is `error_bound`;
    `over_digit`, where it is above `LARGE`, over the change of the exact forces when the lengths of all links change by
    their last digit.
    """

    designs: int
    force: Array
    torque: Array
    motion: Array
    over_bound: Array
    over_digit: Array
    bound: Array
    power: Array
    wrong: int
    missing: frozenset[str]


def errors_of(solution: Solution) -> Errors:
    """Return the errors of linksweep's results for solved linkages."""
    scene, exact = scene_of(solution.assembly.linkages), named(solution)
    names = [name for name in exact if name in scene.table.quantity.keys() - OF_THE_SCENE]
    cycle = ls.sweep(scene, [solution.assembly.linkages.theta2], of=[*names, "error_bound", "power_residual"])
    status = _values(cycle, "status", solution)
    ok = (solution.status == 0) & (status == 0)
    scales = _scales(exact)
    errors = {name: (_error(name, _values(cycle, name, solution), exact) / scales[kind(name)])[ok] for name in names}
    force, torque = (_largest(errors, kind) for kind in ({"force"}, {"torque"}))
    motion = _largest(errors, KINDS.keys() - {"force", "torque"})
    bound, power = (_values(cycle, name, solution)[ok] for name in ("error_bound", "power_residual"))
    none = ~np.isfinite(force + torque + motion + bound + power)
    wrong = int((~same_status(status, solution)).sum() + none.sum())
    missing = frozenset(exact.keys() - {*names} - OF_THE_SCENE)
    over_bound = force / np.maximum(bound, LEAST)
    over_digit = np.zeros_like(force)
    large = force > LARGE
    if large.any():
        over_digit[large] = force[large] / effect_of_a_digit(solution, np.flatnonzero(ok)[large])
    return Errors(len(ok), force, torque, motion, over_bound, over_digit, bound, np.abs(power), wrong, missing)


def effect_of_a_digit(solution: Solution, designs: Array) -> Array:
    """Return the change of the exact forces, relative to the largest, when each length changes by its last digit: the
    sum of the changes that each length causes alone."""
    linkages = chosen(solution.assembly.linkages, designs)
    exact = named(solve(linkages))
    change = np.zeros(len(designs))
    for role, part in linkages.parts.items():
        if "length" in part:
            longer = {**part, "length": np.nextafter(part["length"], np.inf)}
            changed = named(solve(replace(linkages, parts={**linkages.parts, role: longer})))
            change += _largest({name: _difference(changed[name], exact[name]) for name in exact}, {"force"})
    return change / _scales(exact)["force"]


def same_status(status: Array, solution: Solution) -> Array:
    """Return where a status is that of the reference.

    Status 6 is that of the first dyad that jams: alone it has two solutions. Where a slide of a later dyad jams with
    either of them, the whole has none, which is the reference's status 4.
    """
    nested = (status == JAMMED_TWO_SOLUTIONS) & (solution.status == JAMMED)
    return (status == solution.status) | (nested & (len(lines(solution.assembly)) > 1))


def kind(name: str) -> str:
    return next(kind for kind, pattern in KINDS.items() if re.fullmatch(pattern, name))


def _values(cycle: xr.Dataset, name: str, solution: Solution) -> Array:
    values = cycle[name]
    return np.broadcast_to(values.isel(theta2=0) if "theta2" in values.dims else values, len(solution.status))


def _error(name: str, values: Array, exact: Results) -> Array:
    """Return the absolute error; of an angle [rad]."""
    with fifty_digits():
        error = abs(exactly(values) - exact[name]).astype(float)
    return np.radians(np.minimum(error, np.abs(360.0 - error))) if kind(name) == "angle" else error


def _difference(first: Array, second: Array) -> Array:
    with fifty_digits():
        return abs(first - second).astype(float)


def _largest(errors: Mapping[str, Array], kinds: set[str]) -> Array:
    nothing = np.zeros_like(next(iter(errors.values())))
    return np.max([nothing, *(error for name, error in errors.items() if kind(name) in kinds)], axis=0)


def _scales(exact: Results) -> dict[str, Array]:
    """Return the largest number of each kind; of motions at least that of the longest length at the highest rate."""
    size = {one: np.zeros(len(exact["omega2"])) for one in KINDS}
    for name, values in exact.items():
        size[kind(name)] = np.maximum(size[kind(name)], np.abs(values.astype(float)))
    rates = size["rate"] ** 2 + size["second rate"]
    return size | {
        "torque": np.maximum(size["torque"], size["force"] * size["position"]),
        "angle": np.ones_like(rates),
        "second rate": rates,
        "velocity": size["rate"] * size["position"],
        "acceleration": rates * size["position"],
    }
