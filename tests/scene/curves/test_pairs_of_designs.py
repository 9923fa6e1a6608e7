"""Arrays over designs and angles, evaluated at pairs of both: as of each design alone, to the bit."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.scene.curves.interpolation import INTERPOLATIONS, PeriodicCurve
from linksweep.scene.pairs import changes_by_pairs, quantities_at
from linksweep.scene.parameters import replaced

RANDOM = np.random.default_rng(15)
KNOWN = np.sort(RANDOM.uniform(-20.0, 690.0, 14))
PLACES = np.append(RANDOM.uniform(-900.0, 1500.0, 200), KNOWN)
ANGLES = np.arange(0.0, 720.0, 30.0)
BAR = {"width": 0.02, "thickness": 0.02, "density": 7750}


def over_angles(mean, dim, count):
    waves = np.cos(np.radians(ANGLES * 0.5) + RANDOM.uniform(0.0, 6.0, (count, 1)))
    values = mean * (1.0 + 0.3 * waves * waves)
    return xr.DataArray(values, {"theta2": ANGLES}, (dim, "theta2"))


def four_bar():
    lengths = xr.DataArray([0.18, 0.19, 0.20], dims="size")
    links = (ls.Bar(length, **BAR) for length in (0.08, 0.22, lengths))
    push = ls.Load("rocker", torque=over_angles(3.0, "case", 2), interpolation="pchip")
    return ls.Scene(ls.FourBar(*links, 0.20), omega2=over_angles(20.0, "size", 3), loads=[push])


def excavator():
    scene = ls.example("excavator")
    curves = {path: array for path, array in scene.arrays.items() if "theta2" in array.dims}
    assert any("length" in path for path in curves)
    more = xr.DataArray([1.0, 1.001], dims="case")
    return replaced(scene, {path: array * (more if "length" in path else 1.0) for path, array in curves.items()})


@pytest.mark.parametrize("order", range(4))
@pytest.mark.parametrize("kind", INTERPOLATIONS)
def test_one_column_at_each_angle_has_the_bits_of_all(kind, order):
    curve = PeriodicCurve(KNOWN, RANDOM.normal(size=(14, 3, 2)), 720.0, kind)
    columns = RANDOM.integers(0, 6, len(PLACES))
    of_all = curve(PLACES) if order == 0 else curve.slope(PLACES, order)
    own = curve(PLACES, columns) if order == 0 else curve.slope(PLACES, order, columns)
    np.testing.assert_array_equal(own, of_all.reshape(len(PLACES), 6)[np.arange(len(PLACES)), columns])


@pytest.mark.parametrize("angles", [np.array([15.0, 733.0, -10.0, 402.5]), ANGLES[[1, 20, 3, 1]]], ids=str)
@pytest.mark.parametrize(("machine", "names"), [(four_bar, ("alpha3", "F32", "T12")), (excavator, ("aG3x", "F32"))])
def test_pairs_have_the_bits_of_each_design_alone(machine, names, angles):
    scene = machine()
    assert changes_by_pairs(scene)
    sizes = scene.at_one_angle.inputs.sizes
    designs = np.arange(len(angles)) % np.prod([*sizes.values()])
    values = quantities_at(scene, names, designs, angles)
    for design, angle, own in zip(designs, angles, values.T, strict=True):
        place = dict(zip(sizes, np.unravel_index(design, tuple(sizes.values())), strict=True))
        alone = ls.sweep(ls.scene_at(scene, **place), [angle], of=list(names))
        assert own.tolist() == [alone[name].item() for name in names]
