"""Random four-bars for tests of laws, swept for all quantities."""

from itertools import product

import numpy as np
import pytest
import xarray as xr
from oracle import LINKS, FourBarData, random_data, random_theta2, to_scene, torque_name
from references import BRANCHES

import linksweep as ls

SEEDS = [
    pytest.param(branch, drive, seed, id=f"{branch}-{drive}-{seed}", marks=[pytest.mark.long] if seed else [])
    for branch, drive, seed in product(BRANCHES, LINKS, range(3))
]
random_scenes = pytest.mark.parametrize(("branch", "drive", "seed"), SEEDS)
ANGLES = ("theta3", "theta4")
PINS = ("F12", "F32", "F43", "F14")
VECTORS = ("B", "C", "aG2", "aG3", "aG4", *PINS)
COMPONENTS = tuple(vector + axis for vector in VECTORS for axis in "xy")
RATES = ("omega3", "omega4", "alpha3", "alpha4")
EVERYTHING = (*ANGLES, *RATES, "transmission_angle", *COMPONENTS, *PINS, "power")


def random_case(branch: str, drive: str, seed: int, **parameters) -> tuple[FourBarData, np.ndarray]:
    """Return a scene and five crank angles away from its toggles."""
    rng = np.random.default_rng([seed, BRANCHES.index(branch), LINKS.index(drive)])
    data = random_data(rng, branch=branch, drive=drive, **parameters)
    return data, np.array([random_theta2(rng, data) for _ in range(5)])


def swept(data: FourBarData, theta2, names=EVERYTHING) -> xr.Dataset:
    """Return all quantities, by position along theta2 instead of by angle; the drive's torque is called T."""
    torque = torque_name(data)
    cycle = ls.sweep(to_scene(data), theta2, of=(*names, torque))
    assert not cycle.status.any()
    return cycle.rename({torque: "T"}).drop_vars(["status", "theta2"])


def links_changed(data: FourBarData, change) -> dict:
    return {name: change(getattr(data, name)) for name in LINKS}


def longest_link(data: FourBarData) -> float:
    return max(data.ground, *(getattr(data, name).length for name in LINKS))
