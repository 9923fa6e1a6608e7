"""Strength of links and pins against worked examples that are published."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.analysis.strength.criteria import buckling_load

NOTHING = {"width": 1e-3, "thickness": 1e-3, "density": 0.0}


def test_the_connecting_rod_of_a_textbook_whips():
    """Khurmi and Gupta, A Textbook of Machine Design, example 32.3: 51.3 N m and 10.7 MPa, with Z = 4792 mm³.

    Rod 380 mm, stroke 190 mm, 1800 rpm, I-section with t = 7 mm of 8000 kg/m³. The book then takes the rod's mass,
    1.64 kg, for that of a metre of it, and so do these numbers. It neglects the piston's acceleration across the rod.
    """
    t, r, length, omega = 0.007, 0.095, 0.38, 60.0 * np.pi
    section = ls.IBeam(height=5 * t, width=4 * t, web=t, flange=t)
    assert section.area * length * 8000.0 == pytest.approx(1.64, rel=2e-3)
    assert section.modulus == pytest.approx(4792e-9, rel=5e-4)
    assert section.second_moment_across == pytest.approx(131.0 / 12.0 * t**4, rel=1e-14)
    mass = 1.64 * length
    rod = ls.Link(length, mass, mass * length**2 / 12.0, cg_distance=0.5 * length, section=section)
    machine = ls.SliderCrank(ls.Link(r, 0.0, 0.0), rod, slider_mass=0.0)
    across = 90.0 - np.degrees(np.arctan(r / length))  # crank at right angles to the rod
    scene = ls.Scene(machine, omega2=omega, section=xr.DataArray(np.linspace(0.0, 1.0, 401), dims="section"))
    cycle = ls.sweep(scene, [across], of=["bending_moment3"])
    moment = float(abs(cycle.bending_moment3).max())
    assert moment == pytest.approx(51.3, rel=5e-3) and moment / section.modulus == pytest.approx(10.7e6, rel=5e-3)


def test_the_rod_of_a_control_linkage_buckles():
    """Ugural, Mechanical Design of Machine Components, problem 11.16: P = 2.692 kN, F = 317 N with a safety of 1.7.

    A rod of 10 mm and 0.6 m stands at right angles to an arm, 40 mm from its pivot; F presses 200 mm from it.
    """
    rod = ls.Link(0.6, 0.0, 0.0, section=ls.Tube(0.01))
    ground, angle = np.hypot(0.6, 0.03), np.degrees(np.arctan2(-0.03, 0.6))
    machine = ls.FourBar(ls.Bar(0.01, **NOTHING), rod, ls.Bar(0.04, **NOTHING), ground, ground_angle=angle)
    push = ls.Load("rocker", force=(-317.0, 0.0), at=(0.2, 0.0))
    scene = ls.Scene(machine, omega2=0.0, loads=[push], section=0.5)
    steel = ls.Material(E=200e9, yield_strength=345e6, tensile_strength=480e6, endurance=240e6)
    load = float(ls.strength(scene, steel, links="coupler").buckling_load.sel(plane="motion").item())
    assert load == pytest.approx(2692.0, rel=2e-4)
    pressed = -float(ls.sweep(scene, [90.0], of=["axial_force3"]).axial_force3.item())
    assert pressed == pytest.approx(317.0 * 200.0 / 40.0, rel=1e-12)
    assert load / pressed == pytest.approx(1.7, rel=2e-3)


def test_a_round_column_carries_its_load():
    """amesweb.info, Column Buckling Example of a Solid Bar: 31.04 kN, of 50 mm and 2 m, A588, with a safety of 5."""
    bar = ls.Tube(0.05)
    load = buckling_load(bar.area, xr.DataArray(bar.second_moment), 2.0, 205e9, 345e6)
    assert float(load) / 5.0 == pytest.approx(31.04e3, rel=2e-4)


def test_the_pin_of_a_knuckle_joint():
    """A knuckle joint for 15 kN, as colleges teach it: 12.61 mm by 60 MPa in double shear; 46.88 MPa on 16 × 20 mm."""
    machine = ls.FourBar(*(ls.Bar(length, **NOTHING) for length in (0.1, 0.3, 0.3)), ground=0.3)
    pull = ls.Load("crank", force=(15e3, 0.0), at=(0.0, 0.0))  # in pin A
    scene = ls.Scene(machine, omega2=0.0, loads=[pull])
    ds = ls.size_pins(scene, allowable={"shear": 60e6, "pressure": 46.88e6}, eye=0.02).sel(pin="A")
    assert float(ds.diameter_for.sel(criterion="shear")) == pytest.approx(12.61e-3, rel=1e-3)
    assert float(ds.diameter_for.sel(criterion="pressure")) == pytest.approx(16e-3, rel=2e-4)
