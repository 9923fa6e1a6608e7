"""Spread designs along up to thirty dims over several parameters: each must get the numbers that it gets alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.attacks import Outcome

TITLE = "up to thirty dims over several parameters: the bits of each design alone"
ROUNDS = 300
SMALL = 5

Random = np.random.Generator
DIMS = [f"d{k}" for k in range(30)]
LONG = 3
"""Most dims with more than one design."""
OF = ["F32", "T12"]


def attack(random: Random, rounds: int) -> Outcome:
    failures = []
    for k in range(rounds):
        scene = _scene(random)
        place = {dim: int(random.integers(size)) for dim, size in _sizes(scene).items()}
        together, alone = ls.peaks(scene, of=OF).isel(place), ls.peaks(_one(scene, place), of=OF)
        if any(float(together[name]) != float(alone[name]) for name in alone.data_vars):
            failures.append(f"round {k}: dims {_sizes(scene)} at {place}: another peak than alone")
    return Outcome(rounds, failures)


def _scene(random: Random) -> ls.Scene:
    """Return a press with speed, mass and gravity over some dims each, which they may share."""
    sizes = dict.fromkeys(DIMS, 1) | dict.fromkeys(map(str, random.choice(DIMS, LONG)), 2)
    press = ls.example("press")
    coupler = ls.Link(0.22, _over(random, sizes, 0.5, 1.0), 2e-3, 0.11)
    mechanism = replace(press.mechanism, coupler=coupler)
    return replace(press, mechanism=mechanism, omega2=_over(random, sizes, 10.0, 40.0))


def _over(random: Random, sizes: dict[str, int], least: float, most: float) -> xr.DataArray:
    dims = [dim for dim in sizes if random.random() < random.choice([0.1, 0.6, 0.9])]
    return xr.DataArray(random.uniform(least, most, [sizes[dim] for dim in dims]), dims=dims)


def _sizes(scene: ls.Scene) -> dict[str, int]:
    arrays = scene.omega2, scene.mechanism.coupler.mass
    return {str(dim): size for array in arrays for dim, size in array.sizes.items()}


def _one(scene: ls.Scene, place: dict[str, int]) -> ls.Scene:
    coupler = scene.mechanism.coupler
    mass, speed = (float(array.isel(place, missing_dims="ignore")) for array in (coupler.mass, scene.omega2))
    mechanism = replace(scene.mechanism, coupler=replace(coupler, mass=mass))
    return replace(scene, mechanism=mechanism, omega2=speed)
