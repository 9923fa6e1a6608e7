"""Every variable scales with length, mass and time as its unit says, and states its meaning."""

import numpy as np
import pint
import pytest

import linksweep as ls

LENGTH, MASS, TIME = 4.0, 8.0, 0.5
"""Powers of two, so that scaled values agree to the bit."""


def four_bar(length=1.0, mass=1.0, time=1.0):
    """Return the machine in other units: each number multiplied by the factors of its dimension."""
    bars = ls.FourBar(
        link(0.08, 0.5, 1e-3, 0.03, 20.0, length, mass),
        link(0.22, 0.7, 3e-3, 0.1, -10.0, length, mass),
        link(0.18, 0.6, 2e-3, 0.08, 5.0, length, mass),
        0.2 * length,
    )
    return scene(bars, "coupler", "rocker", length, mass, time)


def slider_crank(length=1.0, mass=1.0, time=1.0):
    crank, rod = link(0.08, 0.5, 1e-3, 0.03, 20.0, length, mass), link(0.22, 0.7, 3e-3, 0.1, -10.0, length, mass)
    slider = {"slider_mass": 0.4 * mass, "slider_cg_distance": 0.03 * length, "slider_cg_angle": 40.0}
    mechanism = ls.SliderCrank(crank, rod, **slider, offset=0.02 * length, friction=0.1, slide_angle=15.0)
    return scene(mechanism, "rod", "slider", length, mass, time)


def inverted_slider_crank(length=1.0, mass=1.0, time=1.0):
    crank, rocker = link(0.08, 0.5, 1e-3, 0.03, 20.0, length, mass), link(0.3, 0.7, 3e-3, 0.1, -10.0, length, mass)
    block = {"block_mass": 0.4 * mass, "block_inertia": 1e-4 * mass * length**2}
    block |= {"block_cg_distance": 0.02 * length, "block_cg_angle": -50.0}
    mechanism = ls.InvertedSliderCrank(
        crank, rocker, 0.2 * length, **block, offset=0.02 * length, ground_angle=15.0, friction=0.1
    )
    return scene(mechanism, "rocker", "block", length, mass, time)


def link(size, weight, about, distance, angle, length, mass):
    return ls.Link(size * length, weight * mass, about * (mass * length**2), distance * length, angle)


def scene(mechanism, pushed, turned, length, mass, time):
    acceleration, force = length / time**2, mass * length / time**2
    push = ls.Load(pushed, force=(3.0 * force, -80.0 * force), at=(0.1 * length, 15.0))
    turn = ls.Load(turned, torque=-12.0 * force * length)
    gravity = (1.0 * acceleration, -9.81 * acceleration)
    return ls.Scene(mechanism, omega2=30.0 / time, alpha2=7.0 / time**2, gravity=gravity, loads=[push, turn])


QUANTITIES = [
    pytest.param(machine, name, id=f"{machine.__name__}-{name}")
    for machine in (four_bar, slider_crank, inverted_slider_crank)
    for name in machine().table.quantity
    if name not in ("cond", "error_bound")  # they are of the numbers as they stand
]


@pytest.fixture(scope="module")
def units():
    return pint.UnitRegistry()


@pytest.mark.parametrize(("machine", "name"), QUANTITIES)
def test_scales_as_its_unit_says(machine, name, units):
    one, other = (ls.sweep(s, theta2=24, of=[name])[name] for s in (machine(), machine(LENGTH, MASS, TIME)))
    dimension = units.parse_units(one.attrs["units"]).dimensionality
    factor = LENGTH ** dimension["[length]"] * MASS ** dimension["[mass]"] * TIME ** dimension["[time]"]
    np.testing.assert_array_equal(other.values, one.values * factor)
    assert np.abs(one.values).max() > 0.0


@pytest.mark.parametrize(("machine", "name"), QUANTITIES)
def test_says_what_it_is(machine, name):
    quantity = machine().table.quantity[name]
    assert len(quantity.long_name) > 10
    assert quantity.units
