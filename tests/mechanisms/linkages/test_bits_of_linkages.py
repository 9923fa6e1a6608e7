"""Results of linkages are equal to the last bit, compiled or not, by one thread or several, in any order of dims."""

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from benchmarks.speed.kernel import way
from linksweep.engine import run
from linksweep.scene.parameters import replaced

NAMES = ("watt-2", "knuckle-press", "excavator", "whitworth", "geared-five-bar", "scotch-yoke")
THETA2 = np.linspace(3.0, 38.0, 8)
machines = pytest.mark.parametrize("name", long_but(NAMES, "knuckle-press"))


def designs(name: str) -> ls.Scene:
    """Return an example over lengths of the crank and speeds."""
    scene = ls.example(name)
    crank = f"{scene.mechanism.roles[0]}.length"
    lengths = xr.DataArray([1.0, 0.99, 0.97], dims="length") * scene.numbers[crank][0]
    speeds = xr.DataArray([1.0, 1.2], dims="speed") * scene.omega2
    return replaced(replace(scene, omega2=speeds), {crank: lengths})


def bits(cycle: xr.Dataset) -> dict[str, tuple]:
    return {str(name): (array.dims, array.values.tobytes()) for name, array in cycle.data_vars.items()}


@machines
def test_each_way_to_compute_has_the_same_bits(name):
    scene = designs(name)
    with way("interpreted"):
        expected = bits(ls.sweep(scene, THETA2))
    assert len(expected) > 15
    with way("compiled"), mock.patch.object(run, "SAMPLES_PER_THREAD", 4):
        for threads in (1, 2, 3):
            assert bits(ls.sweep(scene, THETA2, threads=threads)) == expected


@pytest.mark.parametrize("name", NAMES)
def test_the_order_of_dims_has_no_effect(name):
    """One parameter over both dims, in either order."""
    scene = designs(name)
    both = scene.omega2 * (1.0 + 0.01 * xr.DataArray(np.arange(3.0), dims="length"))
    forth, back = (replace(scene, omega2=both.transpose(*dims)) for dims in (("speed", "length"), ("length", "speed")))
    with way("interpreted"):
        one, other = (ls.sweep(each, THETA2) for each in (forth, back))
    assert bits(one) == bits(other.map(lambda array: array.transpose(*one[array.name].dims)))


@pytest.mark.parametrize("name", NAMES)
def test_each_design_is_what_it_is_alone(name):
    scene = designs(name)
    with way("interpreted"):
        every = ls.sweep(scene, THETA2)
        for length in (0, 2):
            crank = f"{scene.mechanism.roles[0]}.length"
            numbers = {crank: float(scene.numbers[crank][0][length]), "omega2": float(scene.omega2[1])}
            alone = ls.sweep(replaced(scene, numbers), THETA2)
            part = every.isel(length=length, speed=1, missing_dims="ignore")
            assert {name: item[1] for name, item in bits(alone).items()} == {
                name: item[1] for name, item in bits(part).items()
            }
