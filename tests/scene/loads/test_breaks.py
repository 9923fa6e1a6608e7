"""Breaks of a load: angles named by the user, at which exact peaks are evaluated, and which files store."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.file.writing import write_scene

ENGINE = ls.SliderCrank(ls.Link(0.04, 1.0, 0.0), ls.Link(0.14, 1.0, 0.0), slider_mass=0.5)


def pushed(force, breaks=()) -> ls.Scene:
    return ls.Scene(ENGINE, omega2=30.0, loads=[ls.Load("slider", force=force, breaks=breaks)])


def spike(width: float, at: float = 77.7):
    """Return a force that reaches -1000 N at one angle, zero beyond `width` degrees from it."""
    return lambda theta2: -1000.0 * np.exp(-(((theta2 - at) / width) ** 2))


@pytest.mark.parametrize("width", [1e-2, 1e-4, 1e-6])
def test_exact_peaks_see_a_narrow_load_at_its_break(width):
    """The spike reaches -1000 N: the exact peak is at least the pin force there, and hardly larger."""
    top = ls.sweep(pushed(-1000.0), [77.7], of=["F43y", "F32"])
    peaks = ls.peaks(pushed(spike(width), breaks=[77.7]), of=["F32"])
    assert peaks.F32_peak == pytest.approx(top.F32.item(), rel=2e-6 if width > 1e-3 else 1e-7)
    assert peaks.F32_peak >= top.F32.item() * (1.0 - 1e-10)
    assert peaks.F32_peak_at == pytest.approx(77.7, abs=width)


def test_breaks_of_any_sequence_type_compare_equal():
    one, other = pushed(1.0, [10, 20.5]), pushed(1.0, np.array([10.0, 20.5]))
    assert one == other and hash(one) == hash(other)
    assert one != pushed(1.0)
    assert "breaks=(10.0, 20.5)" in repr(one)
    assert one.jumps() == (10.0, 20.5)


def test_files_keep_breaks_and_read_units():
    torque = xr.DataArray(np.zeros(4), {"theta2": [0.0, 90.0, 180.0, 270.0]}, "theta2")
    gas = ls.GasPressure(bore=0.08, pressure=1e5, breaks=[12.5])
    scene = ls.Scene(ENGINE, omega2=30.0, loads=[ls.Load("crank", torque=torque, breaks=[90.0, 180.0]), gas])
    text = write_scene(scene)
    assert parse_scene(text) == scene
    turned = text.replace("breaks = [90.0, 180.0]", f'breaks = ["{np.pi / 2!r} rad", "180 deg"]')
    assert turned != text
    assert parse_scene(turned).jumps() == pytest.approx((90.0, 180.0, 12.5))
    assert "breaks" not in write_scene(pushed(1.0))


def test_breaks_over_a_position_are_positions():
    """By definition 30 mm are 0.03 m, and a quarter of a turn 90 degrees."""
    on_slider = ls.Load("slider", force=-1.0, over="slider.to_end", breaks=["30 mm", 0.05])
    assert on_slider.breaks == (0.03, 0.05)
    swinging = ls.Load("rocker", torque=-1.0, over="rocker.angle", breaks=["0.25 rev"])
    assert swinging.breaks == (90.0,)
    scene = ls.Scene(ENGINE, omega2=30.0, loads=[on_slider])
    written = write_scene(scene).replace("breaks = [0.03, ", 'breaks = ["30 mm", ')
    assert "30 mm" in written
    assert parse_scene(written) == scene
    with pytest.raises(ValueError, match=r'^loads\[1\].breaks\[2\] = "9 deg": deg is a unit of angle, not of length'):
        ls.Scene(ENGINE, omega2=30.0, loads=[ls.Load("slider", force=-1.0, over="slider.to_end", breaks=[0, "9 deg"])])


@pytest.mark.parametrize(
    ("breaks", "problem"),
    [
        (30.0, r"loads\[1\].breaks = 30.0: must be a list, each item a number in degrees"),
        ([10.0, np.nan], r"loads\[1\].breaks\[2\] = nan degree: must be finite"),
        (["30 degs"], r'loads\[1\].breaks\[1\] = "30 degs": "degs" is not an accepted unit of angle'),
        ([xr.DataArray([1.0], dims="a")], r"loads\[1\].breaks\[1\] is an array: must be a number in degrees, for all"),
    ],
)
def test_breaks_that_are_not_angles_are_refused(breaks, problem):
    with pytest.raises(ValueError, match=problem):
        pushed(1.0, breaks)
    with pytest.raises(ValueError, match=problem):
        ls.Scene(ENGINE, omega2=30.0, loads=[ls.GasPressure(bore=0.08, pressure=1e5, breaks=breaks)])
