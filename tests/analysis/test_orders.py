"""Fourier orders of a cycle's signals."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures, plt  # noqa: F401

import linksweep as ls

CRANK, ROD = ls.Link(0.05, 1.0, 1e-3), ls.Link(0.2, 0.0, 0.0)
PUMP = ls.SliderCrank(CRANK, ROD, slider_mass=0.5)


def signal(angles, *parts):
    """Return a Dataset of Σ A cos(kθ − φ), parts being (k, A, φ)."""
    angles = np.asarray(angles, dtype=float)
    values = sum(A * np.cos(np.radians(k * angles - phase)) for k, A, phase in parts)
    return xr.Dataset({"T12": ("theta2", values, {"units": "N m", "long_name": "torque"})}, {"theta2": angles})


def test_amplitudes_and_phases_are_recovered():
    parts = [(0, 3.0, 0.0), (1, 5.0, 30.0), (2, 0.25, -120.0), (7, 1e-3, 170.0)]
    orders = ls.orders(signal(np.arange(64) * 5.625, *parts), "T12", n=8)
    assert orders.order.values.tolist() == list(range(9))
    for k, A, phase in parts:
        np.testing.assert_allclose(orders.T12_amplitude.sel(order=k), A, atol=1e-14)
        np.testing.assert_allclose(orders.T12_phase.sel(order=k), phase, atol=1e-9)
    assert float(orders.T12_amplitude.sel(order=[3, 4, 5, 6, 8]).max()) < 1e-14
    assert orders.T12_amplitude.attrs["units"] == orders.T12_cos.attrs["units"] == "N m"
    assert orders.T12_phase.attrs["units"] == "degree"


def test_orders_add_up_to_the_signal():
    ds = ls.sweep(ls.Scene(PUMP, 100.0), 180, of=["a_slider"])
    orders = ls.orders(ds, "a_slider", n=40)
    waves = np.radians(orders.order * ds.theta2)
    again = (orders.a_slider_cos * np.cos(waves) + orders.a_slider_sin * np.sin(waves)).sum("order")
    np.testing.assert_allclose(again, ds.a_slider, atol=1e-10 * float(abs(ds.a_slider).max()))


def test_orders_are_independent_of_the_grids_start_and_order():
    ds = ls.sweep(ls.Scene(PUMP, 100.0), 72, of=["Fsx"])
    shuffled = ls.sweep(ls.Scene(PUMP, 100.0), (np.arange(72) * 5.0 + 2.0)[::-1], of=["Fsx"])
    one, other = (ls.orders(each, "Fsx", n=6).Fsx_amplitude for each in (ds, shuffled))
    np.testing.assert_allclose(other, one, atol=1e-12 * float(one.max()))


def test_a_pistons_shaking_has_the_known_series():
    """Fx = m r ω² (cos θ + A2 cos 2θ − A4 cos 4θ + …), A2 = λ + λ³/4 + 15λ⁵/128, A4 = λ³/4 + 3λ⁵/16 (C. F. Taylor)."""
    orders = ls.orders(ls.sweep(ls.Scene(PUMP, 100.0), of=["Fsx", "Fsy"]), ["Fsx", "Fsy"], n=6)
    unit, L = 0.5 * 0.05 * 100.0**2, 0.25
    expected = [0.0, unit, unit * (L + L**3 / 4 + 15 * L**5 / 128), 0.0, -unit * (L**3 / 4 + 3 * L**5 / 16), 0.0]
    np.testing.assert_allclose(orders.Fsx_cos.values[:6], expected, atol=2.0 * unit * L**7)
    np.testing.assert_allclose(orders.Fsx_sin, 0.0, atol=1e-11 * unit)
    assert float(orders.Fsy_amplitude.max()) == 0.0  # a crank and a rod without mass or balanced


def test_a_four_stroke_cycle_has_half_orders():
    orders = ls.orders(ls.sweep(ls.example("engine"), of=["T12", "Fsy"]), ["T12", "Fsy"], n=2)
    assert orders.order.values.tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    assert float(orders.T12_amplitude.sel(order=0.5)) > 10.0
    assert float(orders.Fsy_amplitude.sel(order=0.5)) < 1e-9 * float(orders.Fsy_amplitude.max())


@pytest.mark.parametrize("form", [lambda torque, angles: torque, lambda torque, angles: torque(angles)])
def test_loads_over_two_turns_have_half_orders_and_one_turn_is_refused(form):
    """A torque of 6 (1 - cos θ/2) against a crank alone: 6 N m at the orders 0 and 1/2."""
    angles = xr.DataArray(np.arange(0.0, 720.0, 5.0), dims="theta2")
    angles = angles.assign_coords(theta2=angles)
    torque = form(lambda theta2: -6.0 * (1.0 - np.cos(np.radians(theta2 / 2.0))), angles)
    light = ls.SliderCrank(CRANK, ROD, slider_mass=0.0)
    scene = ls.Scene(light, 10.0, loads=[ls.Load("crank", torque=torque)])
    orders = ls.orders(ls.sweep(scene, 144, of=["T12"]), "T12", n=1)
    np.testing.assert_allclose(orders.T12_cos.sel(order=[0.0, 0.5, 1.0]), [6.0, -6.0, 0.0], atol=1e-12)
    with pytest.raises(ValueError, match="theta2 covers 360 degrees, but motion and loads repeat after 720: sweep"):
        ls.orders(ls.sweep(scene, np.arange(0.0, 360.0, 5.0), of=["T12"]), "T12", n=1)


def test_half_a_cycle_of_an_engine_has_orders_of_what_no_gas_enters_alone():
    """A four-stroke cylinder fires in one of its two turns; its shaking force is the same in both."""
    engine = ls.example("engine")
    gas = ls.GasPressure(0.086, ls.OttoCycle(compression_ratio=10.0, peak_pressure=60e5))
    one = ls.MultiCylinder(replace(engine, loads=[gas]), crank_angles=[0])
    half = one.sweep(np.arange(0.0, 360.0, 0.5), of=["T12", "Fsy"])
    with pytest.raises(ValueError, match="theta2 covers 360 degrees, but motion and loads repeat after 720: sweep"):
        ls.orders(half, ["Fsy", "T12"])
    both = ls.orders(one.sweep(1440, of=["Fsy"]), "Fsy", n=4).sel(order=range(5))
    np.testing.assert_allclose(ls.orders(half, "Fsy", n=4).Fsy_amplitude, both.Fsy_amplitude, atol=1e-8)
    assert ls.orders(one.sweep(1440, of=["T12"]), "T12", n=2).order.values.tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]


def test_designs_keep_their_dims_and_a_broken_one_changes_no_other():
    rods = xr.DataArray([0.02, 0.2, 0.3], dims="rod")
    ds = ls.sweep(ls.Scene(ls.SliderCrank(CRANK, ls.Link(rods, 1.0, 0.0), 0.5), 100.0), 36, of=["Fsx"])
    orders = ls.orders(ds, "Fsx", n=3)
    assert orders.Fsx_amplitude.dims == ("rod", "order")
    assert np.isnan(orders.Fsx_amplitude.values).all(axis=1).tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("angles", "of", "n", "message"),
    [
        (np.arange(8) * 45.0, "T12", 4, "n = 4: must be less than 4, half the samples of a turn; or sweep"),
        (np.arange(8) * 45.0, "status", 2, "of = 'status': is a code without orders; name quantities"),
        (np.arange(8) * 45.0, "T12", 0, "n = 0: must be a whole number"),
        (np.arange(8) * 45.0, "F32", 2, "of: nothing is named 'F32'"),
        (np.linspace(0.0, 360.0, 9), "T12", 2, "orders take a whole cycle in equal steps; sweep with a count"),
        ([0.0, 10.0, 350.0], "T12", 1, "whole cycle"),
    ],
)
def test_refusals_of_orders(angles, of, n, message):
    with pytest.raises(ValueError, match="ds has no dimension theta2"):
        ls.orders(xr.Dataset({"T12": 1.0}), "T12")
    with pytest.raises(ValueError, match=message):
        ls.orders(signal(angles, (1, 1.0, 0.0)), of, n=n)


def test_bars_show_the_amplitudes():
    orders = ls.orders(ls.sweep(ls.Scene(PUMP, 100.0), of=["Fsx", "Fsy"]), ["Fsx", "Fsy"], n=4)
    ax = ls.plot.orders(orders)
    heights = [bar.get_height() for bar in ax.patches]
    assert heights == [*orders.Fsx_amplitude.values, *orders.Fsy_amplitude.values]
    sentence = [text.get_text() for text in ax.get_legend().get_texts()]
    size = f"{float(orders.Fsx_amplitude.sel(order=1)):#.4g}".rstrip(".")  # that of order 1 is the largest
    assert sentence == [f"$F_{{sx}}$, largest {size} N at order 1", "$F_{sy}$"]
    with pytest.raises(ValueError, match="there are no orders of T12; there are Fsx, Fsy"):
        ls.plot.orders(orders, ["T12"])


def test_shaking_knows_no_load_and_repeats_after_the_turn_of_the_motion():
    engine = ls.example("engine")
    assert engine.period == 720.0
    one, both = (ls.orders(ls.sweep(engine, angles, of=["Fsx"]), "Fsx", n=4) for angles in (np.arange(360.0), 720))
    whole = both.sel(order=one.order)
    assert one.Fsx_amplitude.values == pytest.approx(
        whole.Fsx_amplitude.values, abs=1e-9 * float(whole.Fsx_amplitude.max())
    )
