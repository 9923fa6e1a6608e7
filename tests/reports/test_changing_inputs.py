"""Numbers that change over the revolution stand in a report as the least and largest that their own definition has."""

import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.reports import scene_tables


def load_in_words(scene: ls.Scene) -> str:
    """Return the last load of a scene in words."""
    return re.findall("<td[^>]*>(.*?)</td>", str(scene_tables.loads(scene)).replace("\u202f", " "))[-1]


def with_load(name: str = "press", **load) -> ls.Scene:
    scene = ls.example(name)
    return replace(scene, loads=[*scene.loads, ls.Load(**load)])


def over_angle() -> xr.DataArray:
    """Return an array over theta2 that is 0 but in a tenth of a degree."""
    angles = np.array([0.0, 100.0, 200.1, 200.2, 200.3, 200.4, 300.0])
    return xr.DataArray([0.0, 0.0, 0.0, -3000.0, -3000.0, 0.0, 0.0], {"theta2": angles}, "theta2")


@pytest.mark.parametrize("interpolation", ["linear", "step", "pchip"])
def test_a_narrow_load_is_stated_with_its_largest_value(interpolation):
    scene = with_load(link="coupler", force=(0.0, over_angle()), interpolation=interpolation)
    assert load_in_words(scene).startswith("(0, −3000 to 0) N on the coupler")


def test_a_narrow_function_is_stated_with_its_largest_value():
    """The bell of 7 N m is 0.05 degrees wide; the step of 9 N m is narrower, but between its breaks."""
    bell = with_load(link="rocker", torque=lambda theta2: 7.0 * np.exp(-(((theta2 - 100.26) / 0.05) ** 2)))
    low, _, high = load_in_words(bell).removesuffix(" N m on the rocker").partition(" to ")
    assert float(low) == pytest.approx(0.0, abs=1e-9) and float(high) == pytest.approx(7.0, rel=1e-2)

    def push(theta2):
        return np.where((theta2 > 100.26) & (theta2 < 100.271), 9.0, 0.0)

    step = with_load(link="rocker", torque=push, breaks=[100.26, 100.271])
    assert load_in_words(step) == "0 to 9 N m on the rocker; breaks at 100.26°, 100.27°"


def test_a_load_over_a_narrow_part_of_a_stroke_is_stated_with_its_largest_value():
    """One degree before the dead centre the slider is 9 µm away, and at the dead centre itself it rests."""
    push = xr.DataArray([-5000.0, 0.0], {"position": [0.0, 1e-7]}, "position")
    scene = with_load("engine", link="slider", force=push, over="slider.to_end", while_="closing", interpolation="step")
    assert load_in_words(scene).startswith("(−5000 to 0, 0) N on the slider")


def test_a_narrow_speed_is_stated_with_its_largest_value():
    angles = np.union1d(np.arange(0.0, 360.0, 5.0), 100.26 + np.linspace(-0.4, 0.4, 41))
    speed = 30.0 + 3.0 * np.exp(-(((angles - 100.26) / 0.08) ** 2))
    scene = replace(ls.example("press"), omega2=xr.DataArray(speed, {"theta2": angles}, "theta2"), alpha2=0.0)
    words = str(scene_tables.settings(scene)).replace("\u202f", " ")
    assert "286.48 to 315.13 rpm (30 to 33 rad/s)" in words  # 30·30/π, 33·30/π


def test_a_notebook_shows_a_scene_whose_speed_jumps_between_samples():
    """Results refuse it: its acceleration is infinite."""
    scene = replace(
        ls.example("press"), omega2=lambda theta2: np.where(np.abs(theta2 % 360.0 - 100.0) < 0.26, 31.0, 30.0)
    )
    with pytest.raises(ValueError, match=r"omega2: jumps at theta2 = 99\.74 degrees"):
        ls.peaks(scene, of=["F12"])
    assert "30 to 31 rad/s" in scene._repr_html_()
