"""Loads and speeds over the angle as polynomials between the angles of tables, or the breaks of functions."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from scipy.interpolate import CubicSpline

import linksweep as ls
from linksweep.physics.closures.crank_angle import angle_on_piece
from linksweep.scene.curves.polynomials import polynomials
from linksweep.scene.pairs import places_of

pytestmark = pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")
KINDS = ("periodic cubic", "pchip", "linear", "step")
DESIGNS = 3


def table(turns: int = 1) -> xr.DataArray:
    """Values of no order at angles that are not even, a value of each design."""
    random = np.random.default_rng(1)
    angles = np.sort((np.arange(30) + random.uniform(0.0, 0.8, 30)) * 12.0 * turns)
    return xr.DataArray(random.normal(size=(DESIGNS, 30)), {"theta2": angles}, ("design", "theta2"))


def scene(load: ls.Load, **changes) -> ls.Scene:
    links = (ls.Link(length, 1.0, 1e-3) for length in (0.1, 0.3, 0.2))
    turned = xr.DataArray([10.0, 130.0, -40.0], dims="design")
    return ls.Scene(ls.FourBar(*links, ground=0.25, ground_angle=turned), **{"omega2": 10.0, "loads": [load]} | changes)


def excesses(peaks: xr.Dataset, dense: xr.Dataset) -> Iterator[tuple[str, xr.DataArray]]:
    """Yield the name of each peak, and by how much it exceeds the largest sample, relative to that of its quantity."""
    for name in (name for name in map(str, peaks.data_vars) if name.endswith(("_peak", "_max", "_min"))):
        sign, size = -1.0 if name.endswith("min") else 1.0, dense[f"{name.split('_')[0]}_peak"]
        yield name, sign * (peaks[name] - dense[name]) / size


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("turns", [1, 2])
def test_cubics_on_pieces_are_the_load(kind, turns):
    """At places of pieces with several knots, measured from any frame, against the curves of scipy."""
    loaded = scene(ls.Load("rocker", torque=table(turns), interpolation=kind))
    known = polynomials(loaded)
    edges = np.append(known.cuts, known.cuts[0] + loaded.period)
    assert np.diff(edges).max() <= 30.0 and (known.per_piece == 1) == (kind != "periodic cubic")
    assert known.per_piece in range(1, 13) and loaded.period == 360.0 * turns
    designs = np.arange(DESIGNS).repeat(len(known.cuts))
    first, last = np.tile(edges[:-1], DESIGNS), np.tile(edges[1:], DESIGNS)
    start, length = first + 0.25 * (last - first), 0.7 * (last - first)
    places = places_of(loaded.at_one_angle.inputs.sizes, designs)
    numbers = known.on_pieces(start - loaded.period, length, places)
    (row,) = known.rows("angle")
    of_load = [numbers[name] for name in row.inputs[1:]]
    for share in (0.01, 0.3, 0.8, 0.99):
        away = (share - 0.5) * length
        middle, place = (np.tan(np.radians(0.5 * x - 20.0)) for x in (0.0 * away, away))
        angle = angle_on_piece(place, middle)
        np.testing.assert_allclose(angle, np.radians(away), atol=1e-15)
        values = [row.function(*map(float, (angle[k], *(x[k] for x in of_load)))) for k in range(len(angle))]
        curve = loaded.curves["loads[1].torque"].periodic(start + share * length)
        np.testing.assert_allclose(values, curve[np.arange(len(angle)), designs], atol=2e-12)


def test_what_is_no_cubic_is_none():
    """Functions that bend, ideal cycles; and scenes without loads over the angle."""
    assert polynomials(scene(ls.Load("rocker", torque=lambda theta2: abs(np.cos(np.radians(theta2 + 10.3)))))) is None
    assert polynomials(scene(ls.Load("rocker", torque=1.0))) is None
    engine = ls.SliderCrank(ls.Link(0.04, 1.0, 0.0), ls.Link(0.14, 1.0, 0.0), slider_mass=0.5)
    gas = ls.GasPressure(
        bore=0.086,
        pressure=ls.OttoCycle(compression_ratio=10.0, peak_pressure=6e6),
        crankcase=table().isel(design=0) + 1e5,
    )
    assert polynomials(ls.Scene(engine, omega2=300.0, loads=[gas])) is None


@pytest.mark.parametrize("kind", KINDS)
def test_peaks_with_tables_reach_the_densest_samples(kind):
    """Test a machine whose frame is turned, and an engine that rubs with the gas pressure of two turns."""
    rough = scene(ls.Load("rocker", torque=table(), interpolation=kind), gravity=(0.0, -9.81))
    engine = ls.SliderCrank(
        ls.Link(xr.DataArray([0.03, 0.04, 0.05], dims="design"), 1.0, 1e-3), ls.Link(0.14, 1.0, 1e-3), 0.5, friction=0.1
    )
    pressure = (1e5 * (3.0 + table(2).isel(design=0))).assign_attrs(interpolation=kind)
    fired = replace(rough, mechanism=engine, loads=[ls.GasPressure(bore=0.05, pressure=pressure)])
    for each, of in ((rough, ["F12", "F14", "T12"]), (fired, ["F12", "F32", "F14y", "T12"])):
        assert polynomials(each) is not None
        peaks, dense = ls.peaks(each, of=of), ls.peaks(each, of=of, theta2=15_000)
        assert (peaks.status == 0).all()
        between = {"linear": 1e-3, "step": 2e-2}.get(kind, 1e-4)  # a peak at a corner or a jump lies between samples
        for name, excess in excesses(peaks, dense):
            assert excess.min() > -1e-10 and excess.max() < between, (of, name)
        at = peaks.T12_max_at.values
        beside = ls.sweep(each, np.mod(np.concatenate([at - 1e-7, at, at + 1e-7]), each.period), of="T12").T12
        beside = beside.transpose("design", "theta2").values[np.arange(DESIGNS)[:, None], np.arange(9).reshape(3, 3).T]
        np.testing.assert_allclose(beside.max(axis=1), peaks.T12_max, rtol=1e-6)


def test_status_and_samples_of_tables_are_those_of_other_loads():
    """A design that cannot turn fully is searched on its arcs, with the same table."""
    crank = xr.DataArray([0.1, 0.4, 2.0], dims="design")
    links = (ls.Link(crank, 1.0, 1e-3), ls.Link(0.3, 1.0, 1e-3), ls.Link(0.2, 1.0, 1e-3))
    mixed = ls.Scene(ls.FourBar(*links, ground=0.25), 10.0, loads=[ls.Load("rocker", torque=table().isel(design=0))])
    peaks = ls.peaks(mixed, of=["T12", "T12_samples"])
    assert peaks.status.values.tolist() == [0, 3, 2]
    assert math.isnan(peaks.T12_peak[2]) and peaks.T12_samples[0] > 100


def jumping(theta2):
    """Jump at a break, and where they begin anew after two turns."""
    angle = np.radians(theta2)
    return np.where(theta2 % 720.0 < 77.7, 3.0, np.cos(0.5 * angle) + np.sin(6.0 * angle))


def test_smooth_functions_are_polynomials_between_their_breaks():
    """Against the function itself, at both sides of the break too; and a multiple of it of each design."""
    loaded = scene(ls.Load("rocker", torque=jumping, breaks=[77.7]))
    known = polynomials(loaded)
    assert loaded.period == 720.0 and known.per_piece == 1 and 77.7 in known.cuts
    (row,) = known.rows("angle")
    start, length = known.knots[:-1], np.diff(known.knots)
    numbers = known.on_pieces(start, length, {})
    for share in (1e-9, 0.3, 0.62, 1.0 - 1e-9):
        values = row.function(np.radians((share - 0.5) * length), *(numbers[name] for name in row.inputs[1:]))
        np.testing.assert_allclose(values, jumping(start + share * length), atol=2e-12)
    bore = xr.DataArray([0.05, 0.06, 0.07], dims="design")
    engine = ls.SliderCrank(ls.Link(0.04, 1.0, 0.0), ls.Link(0.14, 1.0, 0.0), slider_mass=0.5)
    gas = ls.GasPressure(bore=bore, pressure=lambda theta2: 2e5 + 1e5 * np.cos(np.radians(theta2)))
    of_gas = polynomials(ls.Scene(engine, omega2=300.0, loads=[gas])).inputs["load1_force_x"]
    assert of_gas.dims == ("design",)
    at_middles = of_gas.values[:, 0]
    np.testing.assert_allclose(at_middles, np.outer(at_middles[:, 0], (bore / 0.05) ** 2), rtol=1e-12)


def wave(theta2):
    return 10.0 + 3.0 * np.sin(np.radians(theta2)) - np.cos(np.radians(1.5 * theta2))


@pytest.mark.parametrize("kind", ["table", "function"])
def test_speeds_over_the_angle_are_polynomials_with_their_accelerations(kind):
    """Test speeds of two turns against splines of scipy, and against a function and its derivative by hand."""
    speed = 10.0 + 0.1 * table(2) if kind == "table" else wave
    known = polynomials(scene(ls.Load("rocker", torque=3.0), omega2=speed))
    assert known.per_piece == 1 and known.knots[-1] - known.knots[0] == 720.0
    ((row,), designs) = known.rows("angle"), np.repeat(np.arange(DESIGNS), len(known.knots) - 1)
    start, length = np.tile(known.knots[:-1], DESIGNS), np.tile(np.diff(known.knots), DESIGNS)
    numbers = known.on_pieces(start, length, {"design": designs})
    assert row.outputs == ("omega2", "alpha2")
    for share in (1e-9, 0.3, 0.62, 1.0 - 1e-9):
        angle = start + share * length
        both = row.function(np.radians((share - 0.5) * length), *(numbers[name] for name in row.inputs[1:]))
        if kind == "table":
            values = np.concatenate([speed, speed[:, :1]], axis=1)
            angles = np.append(speed.theta2, speed.theta2[0] + 720.0)
            spline = CubicSpline(angles, values, axis=1, bc_type="periodic")
            omega, slope = (spline(angle, nu)[designs, np.arange(len(angle))] for nu in (0, 1))
        else:
            omega, turns = wave(angle), np.radians(angle)
            slope = np.radians(3.0 * np.cos(turns) + 1.5 * np.sin(1.5 * turns))
        np.testing.assert_allclose(both[0], omega, atol=2e-12)
        np.testing.assert_allclose(both[1], omega * np.degrees(slope), atol=1e-9)


def test_an_acceleration_of_its_own_stays_what_it_is():
    known = polynomials(scene(ls.Load("rocker", torque=3.0), omega2=wave, alpha2=lambda theta2: wave(2.0 * theta2)))
    assert [row.outputs for row in known.rows("angle")] == [("omega2",), ("alpha2",)]


@pytest.mark.parametrize("machine", ["four-bar", "slider-crank with friction"])
@pytest.mark.parametrize("speed", ["table", "function", "turning round"])
def test_peaks_at_speeds_that_change_reach_the_densest_samples(machine, speed):
    """Test speeds of two turns, and a table of which two designs turn round, with their sliders, and one does not."""
    round_and_not = table() * xr.DataArray([1.5, 1.5, 0.3], dims="design") + [[0.0], [0.0], [10.0]]
    omega2 = {"table": 10.0 + 0.3 * table(2), "function": wave, "turning round": round_and_not}[speed]
    moved = scene(ls.Load("rocker", torque=3.0), omega2=omega2, gravity=(0.0, -9.81))
    if machine != "four-bar":
        links = ls.Link(0.1, 1.0, 1e-3, 0.05), ls.Link(0.3, 1.0, 1e-3, 0.1)
        slider = ls.SliderCrank(*links, slider_mass=0.5, offset=0.02, friction=0.1)
        moved = replace(moved, mechanism=slider, loads=[ls.Load("slider", force=(5.0, 2.0))])
    known = polynomials(moved)
    assert known is not None
    one_way = {"table": [True] * DESIGNS, "function": True, "turning round": [False, False, True]}[speed]
    assert known.turns_one_way().values.tolist() == one_way
    peaks, dense = ls.peaks(moved, of=["F12", "F14y", "T12"]), ls.peaks(moved, of=["F12", "F14y", "T12"], theta2=30_000)
    assert (peaks.status == 0).all()
    for name, excess in excesses(peaks, dense):
        assert excess.min() > -1e-10 and excess.max() < 1e-3, name


def test_a_table_at_a_change_point_has_peaks():
    """Test a machine whose pieces end at a toggle, and one a little off it: no width of a near-toggle is NaN there."""
    links = (ls.Link(length, 1.0, 0.01) for length in (1.0, 2.0, 2.0))
    angles = np.arange(0.0, 360.0, 10.0)
    push = xr.DataArray(50.0 + 10.0 * np.cos(np.radians(3.0 * angles)), {"theta2": angles}, "theta2")
    ground = xr.DataArray([3.0, 2.9], dims="design")
    peaks = ls.peaks(ls.Scene(ls.FourBar(*links, ground=ground), 1.0, loads=[ls.Load("rocker", torque=push)]))
    assert peaks.F12_peak[0] == np.inf and 0.0 < peaks.F12_peak[1] < 1e3


def test_functions_without_declared_breaks_or_with_narrow_bumps_are_searched_along_paths():
    for torque in (
        lambda theta2: jumping(theta2 + 20.0),
        lambda theta2: np.exp(-((theta2 % 360.0 - 180.0) ** 2) / 1e-4),
    ):
        assert polynomials(scene(ls.Load("rocker", torque=torque))) is None


def test_peaks_with_functions_reach_the_densest_samples():
    """With a table besides, too; peaks of a constant load are those that a function of the same value has."""
    bent = table().isel(design=0).assign_attrs(interpolation="linear")
    function = ls.Load("rocker", torque=jumping, breaks=[77.7])
    for loads in ([function], [function, ls.Load("coupler", torque=bent)]):
        loaded = replace(scene(function), loads=loads, gravity=(0.0, -9.81))
        assert polynomials(loaded) is not None
        peaks, dense = ls.peaks(loaded, of=["F12", "T12"]), ls.peaks(loaded, of=["F12", "T12"], theta2=30_000)
        assert (peaks.status == 0).all()
        for name, excess in excesses(peaks, dense):
            assert excess.min() > -1e-10 and excess.max() < 1e-3, name
    same = (scene(ls.Load("rocker", torque=torque)) for torque in (7.0, lambda theta2: 0.0 * theta2 + 7.0))
    xr.testing.assert_allclose(*(ls.peaks(each, of="T12").T12_peak for each in same), rtol=1e-12)
