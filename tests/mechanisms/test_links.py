"""Mass properties of bars and disks, against sums over small squares of them."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.base.fields import is_plain

DENSITY, THICKNESS = 7800.0, 0.013


def summed(width: float, height: float, inside, n: int = 2000) -> tuple[float, float]:
    """Mass and moment of inertia about the middle of the part of a plate for which inside(x, y) holds."""
    middles = (np.arange(n) + 0.5) / n - 0.5
    x, y = np.meshgrid(width * middles, height * middles)
    mass = DENSITY * THICKNESS * (width / n) * (height / n) * inside(x, y)
    return mass.sum(), (mass * (x**2 + y**2)).sum()


def test_a_bar_is_what_its_parts_add_up_to():
    bar = ls.Bar(length=0.3, width=0.04, thickness=THICKNESS, density=DENSITY)
    expected = summed(0.3, 0.04, lambda x, y: np.ones_like(x))
    assert (bar.mass, bar.inertia) == pytest.approx(expected, rel=1e-5)
    assert (bar.cg_distance, bar.cg_angle) == (0.15, 0.0)


def test_a_disk_is_what_its_parts_add_up_to():
    disk = ls.Disk(length=0.05, radius=0.08, thickness=THICKNESS, density=DENSITY)
    expected = summed(0.16, 0.16, lambda x, y: x**2 + y**2 < 0.08**2)
    assert (disk.mass, disk.inertia) == pytest.approx(expected, rel=1e-4)
    assert disk.cg_distance == 0.0


def test_an_eccentric_disk_turns_about_its_pin_as_its_parts_do():
    """Without all other masses T12 = J·α, J about the pin A, 3 cm off the centre at 50° from A–B."""
    eccentric = ls.Disk(0.05, radius=0.08, thickness=THICKNESS, density=DENSITY, cg_distance=0.03, cg_angle=50.0)
    light = ls.Link(0.2, 0.0, 0.0)
    machine = ls.FourBar(eccentric, light, light, ground=0.2)
    spun = ls.sweep(ls.Scene(machine, omega2=0.0, alpha2=7.0), theta2=8, of=["T12"])
    mass, about_pin = summed(0.24, 0.24, lambda x, y: (x - 0.03) ** 2 + y**2 < 0.08**2)
    np.testing.assert_allclose(spun.T12, 7.0 * about_pin, rtol=1e-4)
    at_rest = ls.sweep(ls.Scene(machine, omega2=0.0, gravity=(0.0, -9.81)), theta2=[0.0, 40.0], of=["T12"])
    lever = 0.03 * np.cos(np.radians([50.0, 90.0]))
    np.testing.assert_allclose(at_rest.T12, mass * 9.81 * lever, rtol=1e-4, atol=1e-12)


def test_a_link_whose_section_is_left_out_counts_as_plain_numbers():
    masses = xr.DataArray([1.0, 2.0], dims="mass")
    assert is_plain(ls.Link(0.2, 1.0, 0.003))
    assert not is_plain(ls.Link(0.2, masses, 0.003))
    assert not is_plain(ls.Link(0.2, 1.0, 0.003, section=ls.Section(area=4e-4, modulus=1.3e-6)))
