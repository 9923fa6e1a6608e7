"""Derivatives of results where forces jump at angles that parameters move, by differences of computed results."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.results.derivatives.of_peaks import MEANINGS
from linksweep.scene.parameters import free, replaced

BARS = ls.Bar(0.05, 0.03, 0.02, 7850.0), ls.Bar(0.20, 0.03, 0.02, 7850.0)
PISTON = ls.SliderCrank(*BARS, slider_mass=4.0, offset=0.01)
PUSH = xr.DataArray([-200.0, -150.0, 0.0], {"position": [0.0, 0.16, 0.2]}, "position")
FOLLOWING = ls.Load("slider", force=PUSH, over="slider.position", while_="closing", interpolation="linear")
OUT_OF_REACH = ls.Scene(PISTON, omega2=10.0, loads=[FOLLOWING])
"""The slider goes from 0.15 to 0.25 m, and does not reach the first position of the table."""


def result(scene, name):
    if name == "flywheel_inertia":
        return ls.flywheel(scene, fluctuation=0.02)[name]
    return ls.peaks(scene, of=[name])[name]


def differences(scene, name, path, step):
    """Return differences forward and backward, each of two steps: without their error of first order."""
    value = free(scene)[path][0] or 0.0
    away = xr.DataArray([0.0, 1.0, 2.0, -1.0, -2.0], dims="away")
    own, one, two, back, far = result(replaced(scene, {path: value + step * away}), name).transpose("away", ...).values
    return (4.0 * one - two - 3.0 * own) / (2.0 * step), (3.0 * own - 4.0 * back + far) / (2.0 * step)


def has_those_of_differences(scene, names, steps, rel=1e-5):
    ds = ls.sensitivities(scene, of=names, to=list(steps))
    for name in names:
        assert MEANINGS[int(ds[f"{name}_status"])] == "ok", name
        for path, step in steps.items():
            ours = float(ds[f"{name}_derivative"].sel(parameter=path))
            two_sided = float(np.mean(differences(scene, name, path, step)))
            assert ours == pytest.approx(two_sided, rel=rel), (name, path)


def test_a_position_that_is_not_reached_moves_nothing():
    has_those_of_differences(OUT_OF_REACH, ["T12_rms", "F32_mean", "flywheel_inertia"], {"crank.length": 1e-4})


def test_a_search_goes_on_where_a_position_is_not_reached():
    """A shorter crank works less against the load: the least torque has the shortest."""
    least = ls.objective(OUT_OF_REACH, {"crank.length": (0.03, 0.07)}, minimize="T12_rms").optimum()
    assert least.success and least.x == pytest.approx([0.03], rel=1e-6)


def test_what_is_zero_has_no_derivative_and_a_search_there_no_success():
    light = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18)), ground=0.2)
    scene = ls.Scene(light, omega2=3.0)
    ds = ls.sensitivities(scene, of=["T12_rms", "F32_rms"], to=["ground"])
    for name in ("T12_rms", "F32_rms"):
        assert ds[name] == 0.0 and np.isnan(ds[f"{name}_derivative"]).all()
        assert MEANINGS[int(ds[f"{name}_status"])] == "zero_magnitude"
    most = ls.objective(scene, {"ground": (0.19, 0.21)}, maximize="T12_rms").optimum()
    assert not most.success and "not known" in most.message
