"""The largest samples of many designs are sought with the designs side by side, and θ and −θ together: with the bits of
one sample after the other."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from benchmarks.cases import ALL, GENERAL, MASSES, batch, scene
from benchmarks.speed.kernel import kernel_of, way
from linksweep.engine.kernel.side_by_side import parity

DESIGNS = 25
PRESS, ENGINE = ls.example("press"), ls.example("engine")
general = scene(batch(DESIGNS, *ALL))
factor = xr.DataArray(np.linspace(0.8, 1.2, DESIGNS), dims="mass")
grounds = xr.DataArray([0.19, 0.2, 0.21], dims="ground")


def of_mechanism(machine: ls.Scene, **changes) -> ls.Scene:
    return replace(machine, mechanism=replace(machine.mechanism, **changes))


def ripple(theta2):
    return 30.0 + 2.0 * np.cos(np.radians(theta2 - 20.0))


MACHINES = {
    "all numbers": general,
    "as much at −θ as at θ": replace(
        of_mechanism(ENGINE, friction=0.0, offset=0.0, slider_mass=0.5 * factor),
        omega2=100.0,
        alpha2=0.0,
        gravity=(0.0, 0.0),
        loads=(),
    ),
    "a turned frame": of_mechanism(general, ground_angle=20.0),
    "a torque over the angle": replace(general, loads=[ls.Load("rocker", torque=ripple)]),
    "parts of turns": scene(replace(GENERAL, b=0.1 * np.linspace(1.0, 2.5, DESIGNS)[:, None])),
    "friction": of_mechanism(ENGINE, friction=0.2 * factor),
    "masses on one geometry": scene(batch(DESIGNS, *MASSES)),
    "masses on three": of_mechanism(
        PRESS, ground=grounds, rocker=replace(PRESS.mechanism.rocker, density=7e3 * factor)
    ),
}
"""Scenes with at least one and a half vectors of designs in the innermost loop."""
FEW = 12
"""Designs in the innermost loop that do not fill a vector."""
OF = {"masses on one geometry": ("F32", "F32_mean", "T12_rms", "T12")}


@pytest.mark.parametrize("name", long_but(MACHINES, "as much at −θ as at θ", "parts of turns", "masses on three"))
def test_designs_side_by_side_have_the_bits_of_those_interpreted(name):
    def largest(threads=1):
        return ls.peaks(MACHINES[name], OF.get(name), theta2=72, threads=threads)

    with way("interpreted"):
        expected = largest()
    with way("compiled"):
        assert 'running("largest_sample"' in kernel_of(largest).sources[0]
        xr.testing.assert_identical(largest(), expected)
        xr.testing.assert_identical(largest(threads=2), expected)


def test_designs_that_do_not_fill_a_vector_have_their_own_results():
    """Lanes without a design would write behind the last one, to the results of other designs and signals."""
    few = replace(scene(batch(2, *ALL)), omega2=xr.DataArray(np.linspace(10.0, 30.0, FEW), dims="speed"))
    with way("interpreted"):
        expected = ls.peaks(few, ("F32", "T12"), theta2=72)
    with way("compiled"):
        xr.testing.assert_identical(ls.peaks(few, ("F32", "T12"), theta2=72, threads=1), expected)


def test_samples_are_the_same_or_opposite_at_minus_theta_by_their_bits():
    turn = np.radians(5.0 * np.arange(72.0))
    even = np.concatenate([np.cos(turn[:37]), np.cos(turn[35:0:-1])])
    odd = np.concatenate([np.sin(turn[:37]), -np.sin(turn[35:0:-1])])
    assert [parity(row) for row in (even, odd, even + odd, even[:71], even[:2])] == [1, -1, 0, 0, 0]
    even[3] = np.nextafter(even[3], 2.0)
    assert parity(even) == 0
    odd[0] = odd[36] = 7.0  # the samples at 0 and 180 degrees stand alone
    assert parity(odd) == -1
