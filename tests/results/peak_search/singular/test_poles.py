"""Forces grow without bound at dead centres of every drive in any frame, jams and change points, and nowhere else."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but
from oracle import FourBarData, LinkData, LoadData, solve, to_scene

import linksweep as ls
from linksweep.results.peak_search.singular.poles import CLOSEST, Candidates, poles

PINS = ("F12", "F32", "F43", "F14")
PARTIAL, UNBOUNDED = 1, 3
FRAMES = (0.0, 17.3, 30.0, -45.0, 90.0, 120.0)
CRANK, ROD, ARM = ls.Link(0.05, 1.0, 1e-3), ls.Link(0.15, 0.6, 2e-3, 0.05), ls.Link(0.12, 0.8, 2e-3, 0.05, 30.0)


def machines(frame: float, branch: str = "open") -> dict:
    """One of each kind by each drive that comes to a dead centre."""
    engine = ls.SliderCrank(CRANK, ROD, slider_mass=0.5, slide_angle=frame, branch=branch)
    press = ls.FourBar(CRANK, ROD, ARM, 0.14, branch, ground_angle=frame)
    shaper = ls.InvertedSliderCrank(CRANK, ARM, 0.14, 0.5, 1e-3, branch=branch, ground_angle=frame)
    return {
        "omega3 of the engine": (engine, "coupler", "omega3"),
        "omega3 of the press": (press, "coupler", "omega3"),
        "omega4 of the press": (press, "rocker", "omega4"),
        "omega4 of the shaper": (shaper, "rocker", "omega4"),
        "slide of the shaper": (shaper, "cylinder", "slide_velocity"),
    }


CASES = tuple(machines(0.0))
STEADY = 3.0


def over_the_angle(theta2):
    return STEADY + np.cos(np.radians(theta2))


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("torque", long_but([STEADY, over_the_angle], STEADY))
def test_forces_at_dead_centres_are_unbounded_in_any_frame(case, torque):
    for frame in FRAMES:
        mechanism, drive, _ = machines(frame)[case]
        scene = ls.Scene(mechanism, 30.0, loads=[ls.Load("crank", torque=torque)], drive=drive)
        peaks = ls.peaks(scene, of=[*PINS, "F32_mean", "F32_rms"])
        assert int(peaks.status) == UNBOUNDED
        values = [float(peaks[name]) for name in (*(f"{pin}_peak" for pin in PINS), "F32_mean", "F32_rms")]
        assert values == [math.inf] * 6, f"{frame} degree"
        at = ls.check(scene).dead_centre_angle.values
        assert min(abs(at - float(peaks.F32_peak_at))) < 1e-9


@pytest.mark.parametrize("turn", [0, 1])
@pytest.mark.parametrize("case", CASES)
def test_a_load_of_one_turn_in_two_is_unbounded_at_its_dead_centres(case, turn):
    mechanism, drive, _ = machines(17.3)[case]
    links = {name: ls.Link(link.length, 0.0, 0.0) for name, link in mechanism.parts.items() if hasattr(link, "length")}
    masses = {name: 0.0 for name in ("slider_mass", "block_mass", "block_inertia") if hasattr(mechanism, name)}
    angles = np.arange(0.0, 720.0, 90.0)
    torque = xr.DataArray(np.where(angles // 360.0 == turn, STEADY, 0.0), {"theta2": angles}, "theta2")
    load = ls.Load("crank", torque=torque, interpolation="step")
    scene = ls.Scene(replace(mechanism, **links, **masses), 30.0, loads=[load], drive=drive)
    peaks = ls.peaks(scene, of=["F32"])
    assert (float(peaks.F32_peak), int(peaks.status)) == (math.inf, UNBOUNDED)
    assert 360.0 * turn <= float(peaks.F32_peak_at) < 360.0 * (turn + 1)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_check_tells_where_the_drive_stands_still(case, branch):
    mechanism, drive, rate = machines(17.3, branch)[case]
    at = ls.check(ls.Scene(mechanism, 1.0, drive=drive)).dead_centre_angle
    own = at[[branch in label for label in at.dead_centre.values]] if "open" in str(at.dead_centre.values) else at
    assert own.size == 2
    moves = ls.sweep(ls.Scene(mechanism, 1.0), np.add.outer(own.values, [-1e-3, 0.0, 1e-3]).ravel(), of=[rate])[rate]
    before, there, after = moves.values.reshape(2, 3).T
    assert (before * after < 0.0).all()
    assert (abs(there) < 1e-9 * abs(before)).all()


def test_a_study_knows_its_unbounded_designs_and_pareto_leaves_them_out():
    frames = xr.DataArray(np.linspace(-170.0, 170.0, 12), dims="turned")
    torque = xr.DataArray([0.0, 2.0], dims="torque")
    massless = ls.Link(0.05, 0.0, 0.0), ls.Link(0.15, 0.0, 0.0)
    engine = ls.SliderCrank(*massless, slider_mass=0.0, slide_angle=frames)
    scene = ls.Scene(engine, 30.0, loads=[ls.Load("crank", torque=torque)], drive="coupler")
    study = ls.peaks(scene, of=["F32"])
    assert (study.F32_peak.sel(torque=0) == 0.0).all() and np.isinf(study.F32_peak.sel(torque=1)).all()
    assert study.status.transpose(..., "torque").values.tolist() == [[PARTIAL, UNBOUNDED]] * 12
    assert ls.pareto(study, minimize=["F32_peak"]).F32_peak.max() == 0.0


@pytest.mark.parametrize("drive", ["rocker", "coupler"])
@pytest.mark.parametrize("margin", [1e-3, 1e-6, 1e-10])
def test_large_but_finite(drive, margin):
    """A double crank close to its change point, whose driven link keeps moving, against 60-digit arithmetic."""
    links = (LinkData(length, 1.0, 0.01, 0.4 * length, 33.0) for length in (0.3, 0.35, 0.32))
    ground = 0.3 + 0.32 - 0.35 - margin
    torque = LoadData("crank", torque=2.0)
    data = FourBarData(*links, ground, omega2=3.0, drive=drive, ground_angle=17.3, loads=(torque,))
    peaks = ls.peaks(to_scene(data), of=["F32", "F32_bound"])
    assert int(peaks.status) == 0
    assert float(peaks.F32_peak) == pytest.approx(float(solve(data, float(peaks.F32_peak_at))["F32"]), rel=1e-12)
    assert 0.1 / margin < float(peaks.F32_peak) < 1e1 / margin


@pytest.mark.parametrize("lengths", [(0.3, 0.1 + 0.2, 0.7, 0.7), (0.1, 0.2, 0.3, 0.4)])
def test_change_points_within_the_rounding_of_lengths(lengths):
    """0.1 + 0.2 is 0.3 but for its last digit: a kite."""
    *links, ground = lengths
    press = ls.FourBar(*(ls.Link(length, 1.0, 0.01, 0.3 * length, 20.0) for length in links), ground=ground)
    peaks = ls.peaks(ls.Scene(press, 10.0, gravity=(0.0, -9.81)), of=["F32"])
    assert (float(peaks.F32_peak), int(peaks.status)) == (math.inf, UNBOUNDED)


@pytest.mark.parametrize("slide_angle", FRAMES)
def test_where_friction_wedges(slide_angle):
    """The guide's force grows as 1/(1 − μ·tan ψ) where friction and normal force drive each other up."""
    engine = ls.SliderCrank(CRANK, ls.Link(0.06, 0.6, 2e-3, 0.03), 0.5, friction=0.8, slide_angle=slide_angle)
    scene = ls.Scene(engine, 10.0, loads=[ls.Load("slider", force=(40.0, 0.0), frame="link")])
    result, beside = ls.peaks(scene, of=["F14"]), np.array([1e-4, 1e-6])
    sides = [at + side * beside for at in ls.check(scene).jam_angle.values for side in (-1.0, 1.0)]
    growth = [np.divide(*ls.sweep(scene, side, of=["F14"]).F14.values[::-1]) for side in sides]
    assert np.nanmax(growth) == pytest.approx(100.0, rel=0.01)
    assert (float(result.F14_peak), int(result.status)) == (math.inf, UNBOUNDED)
    assert min(abs(ls.check(scene).jam_angle.values - float(result.F14_peak_at))) < 1e-9


def test_a_peak_beside_a_dead_centre_is_found_where_no_force_is_unbounded():
    """Without loads, and its rocker's line through D, the machine passes its dead centres: no sample is ok at 0."""
    links = ls.Link(0.1, 0.0, 0.0), ls.Link(0.3, 1.0, 0.02, 0.1, 3.0)
    scene = ls.Scene(ls.InvertedSliderCrank(*links, ground=0.4, block_mass=0.5), 30.0, drive="cylinder")
    peak, beside = ls.peaks(scene, of=["F14"]), ls.sweep(scene, np.linspace(0.5, 1.5, 1001), of=["F14"]).F14
    assert float(peak.F14_peak) == pytest.approx(float(beside.max()), rel=1e-6)
    assert float(peak.F14_peak) >= float(beside.max()) * (1.0 - 1e-12)
    assert float(peak.F14_peak_at) == pytest.approx(float(beside.idxmax()), abs=1e-3)


def test_torque_ratio_is_unbounded_where_the_output_stands_still():
    """The torque ratio is the inverse of the rocker's rate, which changes sign where it turns round."""
    mechanism = machines(17.3)["omega4 of the press"][0]
    peaks = ls.peaks(ls.Scene(mechanism, 1.0), of=["torque_ratio", "mechanical_advantage"])
    assert float(peaks.torque_ratio_max) == math.inf and float(peaks.torque_ratio_min) == -math.inf
    assert float(peaks.mechanical_advantage_peak) == math.inf


@pytest.mark.parametrize(("factor", "infinite"), [(1.0, False), (1.1, True)])
def test_rounding_errors_of_a_constant_are_no_growth_though_they_double_evenly(factor, infinite):
    """A constant that is the difference of two forces which grow as 1/x⁴ errs by one digit of these: at distances that
    double, by the same digit, sixteen times as large each time. The difference of unlike forces does grow."""

    class Group:
        def values(self, _signals, _rows, x):
            return np.abs(5.0 + factor * 1.2e9 / (x * x * x * x) - 1.2e9 / (x * x) / (x * x))[None]

    *_, at_poles = poles(Group(), ("F12",), Candidates(np.zeros(1, dtype=int), np.zeros(1), np.array([CLOSEST])))
    assert at_poles.item() is infinite
