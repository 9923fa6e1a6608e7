"""Every variable scales with length, mass and time as its unit says, and says what it is."""

import numpy as np
import pint
import pytest

import linksweep as ls

LENGTH, MASS, TIME = 4.0, 8.0, 0.5
"""Powers of two, so that scaled values agree to the bit."""


def scene(length=1.0, mass=1.0, time=1.0):
    """The same machine in other units: each number multiplied by what its dimension says."""
    inertia, acceleration, force = mass * length**2, length / time**2, mass * length / time**2

    def link(size, weight, about, distance, angle):
        return ls.Link(size * length, weight * mass, about * inertia, distance * length, angle)

    bars = ls.FourBar(
        link(0.08, 0.5, 1e-3, 0.03, 20.0),
        link(0.22, 0.7, 3e-3, 0.1, -10.0),
        link(0.18, 0.6, 2e-3, 0.08, 5.0),
        0.2 * length,
    )
    push = ls.Load("coupler", force=(3.0 * force, -80.0 * force), at=(0.1 * length, 15.0))
    turn = ls.Load("rocker", torque=-12.0 * force * length)
    gravity = (1.0 * acceleration, -9.81 * acceleration)
    return ls.Scene(bars, omega2=30.0 / time, alpha2=7.0 / time**2, gravity=gravity, loads=[push, turn])


NAMES = [name for name in scene().table.quantity if name != "cond"]  # as printed it mixes forces and moments


@pytest.mark.parametrize("name", NAMES)
def test_scales_as_its_unit_says(name):
    one, other = (ls.sweep(s, theta2=24, outputs=[name])[name] for s in (scene(), scene(LENGTH, MASS, TIME)))
    dimension = pint.UnitRegistry().parse_units(_pint(one.attrs["units"])).dimensionality
    factor = LENGTH ** dimension["[length]"] * MASS ** dimension["[mass]"] * TIME ** dimension["[time]"]
    np.testing.assert_array_equal(other.values, one.values * factor)
    assert np.abs(one.values).max() > 0.0


def _pint(udunits):
    """UDUNITS spelling, "rad s-2", as pint reads it."""
    factors = [f"{factor[:-2]}**{factor[-2:]}" if factor[-2:-1] == "-" else factor for factor in udunits.split()]
    return " * ".join(factors) if udunits != "1" else "dimensionless"


@pytest.mark.parametrize("name", NAMES)
def test_says_what_it_is(name):
    quantity = scene().table.quantity[name]
    assert len(quantity.long_name) > 10
    assert quantity.units
