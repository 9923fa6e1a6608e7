"""Extremes of quantities that grow without bound the other way, at the toggles that end an arc."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls

DESIGNS = 16


def number(random: np.random.Generator, least: float, largest: float) -> xr.DataArray:
    return xr.DataArray(random.uniform(least, largest, DESIGNS), dims="design")


def link(length: xr.DataArray) -> ls.Link:
    return ls.Link(length, 1.0, 0.1, 0.3 * length, 20.0)


def sprung() -> ls.Scene:
    random = np.random.default_rng(1)
    crank, coupler, rocker = (link(number(random, *ends)) for ends in ((0.5, 1.0), (0.3, 0.6), (0.3, 0.9)))
    spring = ls.Spring(("rocker", 0.5, 10.0), ("ground", 0.3, 0.2), rate=100.0, free_length=0.2)
    mechanism = ls.FourBar(crank, coupler, rocker, ground=number(random, 0.6, 0.9))
    return ls.Scene(mechanism, 10.0, gravity=(0.0, -9.81), loads=[spring])


def rubbing() -> ls.Scene:
    random = np.random.default_rng(2)
    crank, rod = link(number(random, 0.3, 0.5)), link(number(random, 0.2, 0.3))
    mechanism = ls.SliderCrank(crank, rod, 2.0, offset=0.1, friction=number(random, 0.01, 0.2))
    return ls.Scene(mechanism, 10.0, gravity=(0.0, -9.81))


def watt() -> ls.Scene:
    random = np.random.default_rng(3)
    ends = {"crank": (0.3, 1.2), "coupler": (0.8, 2.0), "rocker": (0.5, 2.0), "rod": (0.5, 2.0), "output": (0.5, 2.0)}
    links = {name: link(number(random, *of_link)) for name, of_link in ends.items()}
    text = "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F"
    pins = {"A": (0.0, 0.0), "D": (number(random, 0.5, 2.5), 0.0), "G": (3.0, 0.2)}
    mechanism = ls.Linkage(text, ground=pins, points={"E": (0.6, -35.0)}, **links)
    return ls.Scene(mechanism, 10.0, gravity=(0.0, -9.81))


@pytest.mark.parametrize(
    ("scene", "rates"),
    [(sprung(), "alpha4"), (rubbing(), "alpha3"), (watt(), "alpha4")],
    ids=["spring", "slide", "watt"],
)
@pytest.mark.parametrize("part", [None, (-100.0, 120.0)], ids=["cycle", "part"])
def test_finite_extremes_of_what_is_unbounded_at_toggles(scene, rates, part):
    """They reach the densest samples, up to 1e-10, and are values of the quantity at their angle."""
    of, step = [rates, "F12x"], 0.05
    first, last = part or (0.0, 360.0)
    peaks = ls.peaks(scene, of=of, between=part)
    dense, bounded = ls.peaks(scene, of=of, theta2=np.arange(first + 0.3 * step, last, step)), 0
    for name in (f"{quantity}_{end}" for quantity in of for end in ("max", "min")):
        value, sample, sign = peaks[name].values, dense[name].values, 1.0 if name.endswith("max") else -1.0
        known = np.flatnonzero(np.isfinite(value) & (peaks.status.values == 3))
        excess = sign * (value - sample)[known] / np.abs(value[known])
        assert (excess > -1e-10).all(), name
        at, quantity = peaks[f"{name}_at"].values[known], name.rpartition("_")[0]
        swept = (
            ls.sweep(scene, np.append(at % 360.0, 0.0), of=[quantity])[quantity].transpose("design", "theta2").values
        )
        inside = swept[known, np.arange(len(known))]
        moves = np.isfinite(inside)  # not at the end of an arc
        np.testing.assert_allclose(inside[moves], value[known][moves], rtol=1e-9)
        bounded += moves.sum()
    assert bounded > 5


def test_a_force_that_rises_only_just_before_friction_jams_the_machine():
    """Within the last 0.01 of 181 degrees; its largest value is its limit at the jam."""
    crank, rod = ls.Link(0.2871, 1.239, 0.0122, 0.0072, 131.8), ls.Link(0.205, 1.61, 0.00207, 0.1282, 133.8)
    mechanism = ls.SliderCrank(crank, rod, slider_mass=1.928, offset=0.2009, friction=0.03956)
    scene = ls.Scene(mechanism, -7.294, 69.64, (0.0, -9.81), [ls.Load("slider", force=(-18.86, 43.55))])
    jam = np.nanmin(ls.check(scene).jam_angle)
    beside = ls.sweep(scene, [jam - 0.03, jam - 0.01, jam - 1e-8, jam + 0.01], of=["F12x"]).F12x
    assert beside[0] < beside[1] < 0.0 < 20_000.0 < beside[2] and np.isnan(beside[3])
    peaks = ls.peaks(scene, of=["F12x"])
    assert float(peaks.F12x_max) == pytest.approx(float(beside[2]), rel=1e-5)
    assert float(peaks.F12x_max_at) == pytest.approx(jam, abs=1e-6) and peaks.F12x_max >= beside[2]


def test_trials_that_differ_by_rounding_alone_hide_no_peak():
    """A piece that starts at a narrow near-toggle shows the summit beside it twice, around a dip."""
    crank = ls.Link(0.38446641709615703, 1.1643321338097556, 0.01219397584956949, 0.3090761981568982, 69.68720050624808)
    rod = ls.Link(0.38446905430651646, 1.9101761165790034, 0.03101184082502945, 0.2769315663345262, 0.0)
    machine = ls.SliderCrank(crank, rod, 0.3653730903321438, 0.0, 0.000778554849111484, branch="crossed")
    push = ls.Load("slider", force=(-23.4225323, 24.73770321))
    scene = ls.Scene(machine, -18.81017668, 44.76925696, (0.0, -9.81), [push])
    beside = ls.sweep(scene, 270.0 + np.linspace(0.0, 1e-4, 201), of=["F43"]).F43
    assert float(beside.max()) <= float(ls.peaks(scene, of=["F43"]).F43_peak) * (1.0 + 1e-11)
