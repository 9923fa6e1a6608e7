"""Figures mark the exact peak that the table beside it has, at jumps, too."""

from dataclasses import replace

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from drawn import texts

import linksweep as ls
from linksweep.surface.signals import number
from linksweep.surface.with_peaks import with_peaks

mpl.use("Agg")


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def pump() -> ls.Scene:
    """A slider-crank with friction: its forces jump at the dead centres, so that a sample has one side of them."""
    machine = ls.SliderCrank(
        ls.Bar(0.05, 0.02, 0.02, 7750), ls.Bar(0.2, 0.02, 0.02, 7750), 1.5, friction=0.15, offset=0.004
    )
    return ls.Scene(machine, omega2=40.0, gravity=(0.0, -9.81), loads=[ls.Load("slider", force=-300.0)])


def said_at_peaks(ax, units: str) -> str:
    return "\n".join(texts(ax)).replace(f" {units}", "")


@pytest.mark.parametrize("count", [36, 90, 720])
def test_every_figure_marks_what_the_table_says(count):
    scene = pump()
    cycle, worst = ls.sweep(scene, count), ls.peaks(scene)
    assert float(cycle.T12.max()) < float(worst.T12_max)  # the samples miss it
    said = said_at_peaks(ls.plot.torque(cycle), "N m")
    assert f"max {number(float(worst.T12_max))} at" in said
    assert f"min {number(float(worst.T12_min))} at" in said
    said = said_at_peaks(ls.plot.forces(cycle), "N")
    for pin in ("F12", "F32", "F43", "F14"):
        assert f"$F_{{{pin[1:]}}}$ {number(float(worst[f'{pin}_peak']))} at" in said
        if pin != "F14":
            assert f" = {number(float(worst[f'{pin}_peak']))}" in said_at_peaks(ls.plot.bearing(cycle, pin), "N")
    shaking = ls.sweep(scene, count, ["Fsx", "Fsy"])
    fs = number(float(ls.peaks(scene, of=["Fs"]).Fs_peak))
    assert f"$F_{{s}}$ = {fs}" in said_at_peaks(ls.plot.hodograph(shaking), "N")


def test_the_samples_stay_and_peaks_come_between_them():
    cycle = ls.sweep(pump(), 90)
    more = with_peaks(cycle)
    xr.testing.assert_equal(
        more.sel(theta2=cycle.theta2)[["T12", "F32x"]], cycle[["T12", "F32x"]].reset_coords(drop=True)
    )
    worst = ls.peaks(pump())
    assert float(np.hypot(more.F32x, more.F32y).max()) == pytest.approx(float(worst.F32_peak), rel=1e-9)
    assert with_peaks(more) is more


def test_numbers_that_are_not_the_scenes_are_drawn_as_they_are():
    cycle = ls.sweep(pump(), 90)
    with xr.set_options(keep_attrs=True):
        doubled = cycle.assign(T12=2.0 * cycle.T12)
    lost = cycle.drop_attrs()
    part = ls.sweep(pump(), np.arange(10.0, 60.0))
    speeds = ls.sweep(replace(pump(), omega2=xr.DataArray([20.0, 40.0], dims="speed")), 90)
    jumps = replace(pump(), loads=[ls.Load("slider", force=lambda a: np.where(np.mod(a, 360.0) < 180.0, 0.0, -300.0))])
    for ds in (doubled, lost, part, speeds, ls.sweep(jumps, 90)):
        assert with_peaks(ds) is ds
    ls.plot.cycle(ls.sweep(jumps, 90))


def test_one_of_several_designs_is_marked_exactly():
    scene = replace(pump(), omega2=xr.DataArray([20.0, 40.0], {"speed": [1, 2]}, "speed"))
    said = said_at_peaks(ls.plot.torque(ls.sweep(scene, 90).isel(speed=1)), "N m")
    assert f"max {number(float(ls.peaks(pump()).T12_max))} at" in said
