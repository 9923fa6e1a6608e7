"""Every number of random scenes against 60-digit arithmetic: fast path, dense path, compiled batches.

Errors are relative to the largest of their kind at the same position: forces to the largest pin force, torques to that
force times the longest link, rates to the fastest link's, places to the longest link.
"""

from dataclasses import fields, replace
from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np
import pytest
import xarray as xr
from oracle import (
    BRANCHES,
    KINDS,
    LINKS,
    FourBarData,
    LinkData,
    LoadData,
    largest_force,
    largest_torque,
    log_uniform,
    motion,
    mp,
    random_data,
    random_theta2,
    solve,
    system,
    to_scene,
    torque_name,
)

import linksweep as ls
from linksweep.engine import run

EPS = float(np.finfo(float).eps)
KINEMATICS = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4", "transmission_angle")
PLACES = ("Bx", "By", "Cx", "Cy", "aG2x", "aG2y", "aG3x", "aG3y", "aG4x", "aG4y")
PINS = ("F12", "F32", "F43", "F14")
FORCES = tuple(pin + part for pin in PINS for part in ("x", "y", ""))
REACTIONS = {f"F{name[2]}{name[1]}{name[3:]}": name for name in FORCES}


class Case(NamedTuple):
    """A random scene, crank angles away from its toggles [degree], and the judge's results there, rounded once."""

    data: FourBarData
    theta2: list[float]
    results: dict[str, np.ndarray]


def unknowns(data: FourBarData) -> tuple[str, ...]:
    return (*(pin + axis for pin in PINS for axis in "xy"), torque_name(data))


def all_names(data: FourBarData) -> tuple[str, ...]:
    return (*KINEMATICS, *PLACES, *FORCES, *REACTIONS, torque_name(data), "power")


def solved(data: FourBarData, theta2: list[float]) -> Case:
    """The judge's results; it names only one of action and reaction."""
    results = [solve(data, angle) for angle in theta2]
    both = [
        result
        | {"largest_force": largest_force(result), "largest_torque": largest_torque(result, data)}
        | {back: -result[name] if name[3:] else result[name] for back, name in REACTIONS.items()}
        for result in results
    ]
    return Case(data, theta2, {name: np.array([float(one[name]) for one in both]) for name in both[0]})


def random_case(rng: np.random.Generator, angles: int, **given) -> Case:
    data = random_data(rng, **given)
    return solved(data, [random_theta2(rng, data) for _ in range(angles)])


@cache
def cases() -> list[Case]:
    """240 scenes: ten of each kind, branch and drive."""
    rng = np.random.default_rng(1)
    sorts = product(KINDS, BRANCHES, LINKS, range(10))
    return [random_case(rng, 4, kind=kind, branch=branch, drive=drive) for kind, branch, drive, _ in sorts]


def scales(data: FourBarData, results: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The largest of each kind at each angle, by how the names of the kind begin."""
    omega = np.max([*np.broadcast_arrays(abs(data.omega2), abs(results["omega3"]), abs(results["omega4"]))], 0)
    prescribed = data.omega2**2 + abs(data.alpha2)
    alpha = np.max([*np.broadcast_arrays(prescribed, abs(results["alpha3"]), abs(results["alpha4"]))], 0)
    longest = max(data.ground, *(getattr(data, link).length for link in LINKS))
    angle = np.full_like(omega, 180.0)
    found = {"theta": angle, "transmission": angle, "omega": omega, "alpha": alpha, "aG": alpha * longest}
    found |= {"B": np.full_like(omega, longest), "C": np.full_like(omega, longest)}
    found |= {"F": results["largest_force"], "T": results["largest_torque"]}
    return found | {"power": results["largest_torque"] * omega}


def errors(cycle: xr.Dataset, names: tuple[str, ...], case: Case) -> dict[str, float]:
    """Largest relative error of each quantity over the angles; NaN counts as infinite."""
    by_kind = scales(case.data, case.results)
    found = {}
    for name in names:
        kind = next(size for start, size in by_kind.items() if name.startswith(start))
        error = np.abs(cycle[name].broadcast_like(cycle.theta2).values - case.results[name]) / kind
        found[name] = float(np.nan_to_num(error, nan=np.inf).max())
    return found


def worst(scenes: list[dict[str, float]]) -> dict[str, float]:
    """Largest over the scenes."""
    found: dict[str, float] = {}
    for name, error in (item for scene in scenes for item in scene.items()):
        found[name] = max(found.get(name, 0.0), error)
    return found
