"""Cycles of more than two turns: gears between the machine and its load."""

import numpy as np
import pytest
import xarray as xr

import linksweep as ls


def scene(*loads: ls.Load) -> ls.Scene:
    """Return a machine of massless links, whose drive torque is opposite to the load on the crank."""
    crank, coupler, rocker = (ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18))
    return ls.Scene(ls.FourBar(crank, coupler, rocker, ground=0.2), omega2=10.0, loads=loads)


def torque_of(turns: int, largest: float = 10.0) -> ls.Load:
    return ls.Load("crank", torque=lambda theta2: largest * np.cos(np.radians(theta2 / turns)))


@pytest.mark.parametrize("turns", [3, 5, 12])
def test_the_period_of_a_function_is_found_over_several_turns(turns):
    made = scene(torque_of(turns))
    assert made.period == 360.0 * turns
    cycle = ls.sweep(made, theta2=36 * turns, of=["T12"])
    assert cycle.theta2.values[-1] == 360.0 * turns - 10.0
    np.testing.assert_allclose(cycle.T12, -10.0 * np.cos(np.radians(cycle.theta2 / turns)), atol=1e-12)
    peaks = ls.peaks(made, of=["T12", "T12_mean"])
    assert peaks.T12_max.item() == pytest.approx(10.0, rel=1e-10)
    assert peaks.T12_max_at.item() == pytest.approx(180.0 * turns, abs=1e-4 * turns)
    assert peaks.T12_mean.item() == pytest.approx(0.0, abs=1e-12)


def test_the_period_is_the_least_common_multiple_of_all_loads():
    made = scene(torque_of(2), torque_of(3, largest=4.0))
    assert made.period == 6 * 360.0
    angles = np.radians(np.arange(0.0, 2160.0, 0.01))
    brute = -(10.0 * np.cos(angles / 2) + 4.0 * np.cos(angles / 3))
    peaks = ls.peaks(made, of=["T12"])
    assert peaks.T12_min.item() == pytest.approx(brute.min(), rel=1e-9)
    assert peaks.T12_max.item() == pytest.approx(brute.max(), rel=1e-7) and peaks.T12_max.item() >= brute.max()


def test_an_array_and_a_table_span_several_turns(tmp_path):
    angles = np.arange(0.0, 4 * 360.0, 10.0)
    values = 3.0 * np.sin(np.radians(angles / 4))
    array = xr.DataArray(values, {"theta2": angles}, "theta2")
    made = scene(ls.Load("crank", torque=array))
    assert made.period == 1440.0
    assert ls.peaks(made, of=["T12"]).T12_peak.item() == pytest.approx(3.0, rel=1e-6)
    rows = "\n".join(f"{angle},{value!r}" for angle, value in zip(angles.tolist(), values.tolist(), strict=True))
    (tmp_path / "torque.csv").write_text(f"theta2,T\n{rows}\n")
    ls.save(scene(ls.Load("crank", torque=1.0)), tmp_path / "machine.toml")
    text = (tmp_path / "machine.toml").read_text().replace("torque = 1.0", 'torque = {csv = "torque.csv"}')
    (tmp_path / "machine.toml").write_text(text)
    again = ls.load_scene(tmp_path / "machine.toml")
    assert again.period == 1440.0
    assert ls.peaks(again, of=["T12"]).equals(ls.peaks(made, of=["T12"]))


def test_orders_of_a_long_cycle_are_fractions():
    cycle = ls.sweep(scene(torque_of(3)), theta2=108, of=["T12"])
    orders = ls.orders(cycle, "T12", n=1)
    np.testing.assert_allclose(orders.order, [0, 1 / 3, 2 / 3, 1])
    np.testing.assert_allclose(orders.T12_amplitude, [0.0, 10.0, 0.0, 0.0], atol=1e-12)


def test_a_long_cycle_round_trips_through_files(tmp_path):
    made = scene(torque_of(3))
    ls.save(ls.peaks(made, of=["T12"]), tmp_path / "peaks.nc")
    again = ls.load_scene(tmp_path / "peaks.nc")
    assert again.period == 1080.0
    assert ls.peaks(again, of=["T12"]).T12_peak.item() == pytest.approx(10.0, rel=1e-8)
