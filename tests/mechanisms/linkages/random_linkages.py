"""Random linkages of every topology of the stress test, swept for every quantity without compiling."""

from functools import cache
from itertools import count

import numpy as np
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from benchmarks.speed.kernel import way
from benchmarks.stress.linkages.scene import scene_of
from benchmarks.stress.linkages.scenes import drawn
from benchmarks.stress.linkages.topologies import AWAY_FROM_TOGGLES
from linksweep.scene.parameters import replaced

FIRST = ("pins in other orders", "Whitworth", "shaper with two slides", "held cylinder")
random_linkages = pytest.mark.parametrize("name", long_but(AWAY_FROM_TOGGLES, *FIRST))
unwarned = pytest.mark.filterwarnings("ignore:held.length")


@cache
def random_case(name: str, designs: int = 2) -> tuple[ls.Scene, np.ndarray]:
    """Return loaded linkages along "design", not all jammed, and a crank angle at which they are away from toggles."""
    draws = (drawn(AWAY_FROM_TOGGLES[name], np.random.default_rng([len(name), seed]), designs) for seed in count(7))
    linkages = next(solution.assembly.linkages for solution in draws if (solution.status == 0).any())
    return scene_of(linkages), np.array([linkages.theta2])


@cache
def cycle_of_case(name: str) -> xr.Dataset:
    """Return all quantities of such linkages."""
    return swept(*random_case(name))


def swept(scene: ls.Scene, theta2, names=()) -> xr.Dataset:
    """Return all quantities but the condition number, which LAPACK computes; by position along theta2.

    Without the numbers of the scene, which xarray would copy in every comparison.
    """
    every = [name for name in scene.table.quantity if name not in ("cond", "theta2")]
    with way("interpreted"):
        return ls.sweep(scene, theta2, of=names or every).reset_coords(drop=True).drop_vars("theta2")


def changed(scene: ls.Scene, change) -> ls.Scene:
    """Return a scene with every number changed by its path and kind."""
    numbers = {path: change(path, value, kind) for path, (value, kind) in scene.numbers.items() if value is not None}
    return replaced(scene, numbers)


def assert_equal(result: xr.Dataset, expected: xr.Dataset) -> None:
    """Equal values, where one may depend on fewer dims."""
    assert set(result.data_vars) == set(expected.data_vars)
    for name in expected.data_vars:
        both = result.variables[name], expected.variables[name]
        sizes = {**both[0].sizes, **both[1].sizes}
        assert both[0].sizes.items() <= sizes.items(), name
        np.testing.assert_array_equal(*(value.set_dims(sizes) for value in both), err_msg=str(name))
