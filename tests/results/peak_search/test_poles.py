"""Forces grow without bound at dead centres of every drive in any frame, jams and change points, and nowhere else."""

import math

import numpy as np
import pytest
import xarray as xr
from long import long_but
from oracle import FourBarData, LinkData, LoadData, solve, to_scene

import linksweep as ls
from benchmarks.stress.linkages.topologies import AWAY_FROM_TOGGLES
from benchmarks.stress.six_bars import any_linkage

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
    frames = xr.DataArray(np.linspace(-170.0, 170.0, 12), dims="frame")
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


def test_forces_that_have_a_limit_at_a_change_point_are_not_rounding_errors():
    """With ground and crank of one length, the rocker turns at half the crank's speed, and B passes through its pivot.

    The moment of gravity about D, m·g·r·sin(ψ/2), is that of F43 on the arm 2·a·sin(ψ/2).
    """
    a, r = 0.15, 0.05
    links = ls.Link(a, 1.0, 0.01, 0.03, 20.0), ls.Link(0.3, 1.0, 0.01, r)
    machine = ls.InvertedSliderCrank(*links, ground=a, block_mass=2.0)
    peaks = ls.peaks(ls.Scene(machine, 30.0, gravity=(0.0, -9.81)), of=["F43"])
    assert float(peaks.F43_peak) == pytest.approx(9.81 * r / (2.0 * a), abs=1e-5)  # other pins bear 290 N


def test_a_crank_that_carries_nothing_past_dead_centres_and_jams_of_the_jack():
    """The jack moves all other links: at constant speed the crank's pin bears the crank's own inertia alone."""
    scene = any_linkage(AWAY_FROM_TOGGLES["Whitworth, jack drives"], np.random.default_rng(5), 20)
    crank, passing = scene.mechanism.crank, [1, 5, 11, 13]  # dead centres; jams: 5, 13
    inertia = crank.mass * crank.cg_distance * scene.omega2**2
    peaks = ls.peaks(scene, of=["F12"]).F12_peak
    np.testing.assert_allclose(peaks[passing], inertia[passing], rtol=1e-9)


def test_a_torque_with_summits_close_to_a_change_point():
    """Almost a parallelogram, its crank and ground in one line: within 0.01° of a change point that cannot be told from
    a toggle, the torque rises to 1e12 N·m, and falls, against 60-digit arithmetic."""
    lengths = 0.5, 0.5 + 5e-5 + 4e-7, 0.5 + 4e-7 + 1e-11
    data = FourBarData(*(LinkData(length, 1.0, 0.01, 0.3 * length, 20.0) for length in lengths), 0.5 + 5e-5, omega2=4.0)
    peaks = ls.peaks(to_scene(data), of=["T12"])
    at, torque = float(peaks.T12_max_at), float(peaks.T12_max)
    before, there, after = (float(solve(data, at + step)["T12"]) for step in (-1e-4, 0.0, 1e-4))
    assert torque == pytest.approx(there, rel=1e-12) and torque > 1e12 and max(before, after) < torque
    assert float(peaks.T12_min) < float(solve(data, -1e-5)["T12"]) < -1e14


@pytest.mark.parametrize(
    ("direction", "friction"), [(-60.0, 0.1), (120.0, 0.1), (-150.0, 0.1), (-90.0, 0.1), (0.0, 0.2)]
)
def test_crank_and_rod_of_a_press_by_its_upper_link(direction, friction):
    """Without a torque at the crank, crank and rod bear what they bear in the four-bar of the press, which has no ram;
    the ram's friction jams the press at both ends of its arc, and its own forces grow without bound there."""
    crank, rod, upper = ls.Link(0.9, 0.65, 0.1, 0.2), ls.Link(2.1, 0.93, 0.74, 2.0), ls.Link(2.4, 1.5, 1.0, 1.0)
    press = ls.Linkage(
        "crank A-B, rod B-C, upper D-C, lower C-E, ram E on slide",
        ground={"A": (0.0, 0.0), "D": (0.43, 0.0)},
        guides={"slide": ls.Guide((0.43, 0.0), direction, friction)},
        branch={"C": "open", "E": "crossed"},
        crank=crank,
        rod=rod,
        upper=upper,
        lower=ls.Link(1.3, 1.0, 0.2, 0.6),
        ram=ls.Slider(0.6),
    )
    scene = ls.Scene(press, 11.6, gravity=(0.0, -9.81), drive="upper")
    four_bar = ls.Scene(ls.FourBar(crank, rod, upper, ground=0.43), 11.6, gravity=(0.0, -9.81), drive="rocker")
    compare_with_four_bar(scene, four_bar, ["F12", "F32"])


@pytest.mark.parametrize("drive", ["output", "rocker"])
def test_crank_and_coupler_of_a_six_bar_by_its_output(drive):
    """Likewise where a second dyad on the rocker ends the arcs: the drive's torque and the other forces are unbounded
    there."""
    crank, coupler = ls.Link(2.49, 1.41, 0.903, 0.825), ls.Link(2.38, 1.46, 1.15, 0.845, 105.0)
    rocker = ls.Link(2.7, 1.5, 0.293, 2.39, 60.9)
    six_bar = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F",
        ground={"A": (0.0, 0.0), "D": (0.45, 0.0), "G": (-1.36, 0.866)},
        points={"E": (0.97, -92.0)},
        branch={"C": "open", "F": "crossed"},
        crank=crank,
        coupler=coupler,
        rocker=rocker,
        rod=ls.Link(0.573, 1.43, 0.073, 0.624, -154.0),
        output=ls.Link(0.65, 0.283, 0.0092, 0.34),
    )
    four_bar = ls.Scene(ls.FourBar(crank, coupler, rocker, 0.45), 12.3, -70.9, drive="rocker")
    scene = ls.Scene(six_bar, 12.3, -70.9, drive=drive)
    assert float(ls.peaks(scene, of=["F65"]).F65_peak) == math.inf
    compare_with_four_bar(scene, four_bar, ["F12", "F32", "F43"])


def compare_with_four_bar(scene, four_bar, forces):
    """Peaks are the four-bar's forces at their angles, and no lower than its samples where the machine moves."""
    peaks, moves = ls.peaks(scene, of=forces), ls.sweep(scene, 5760, of=["status"]).status == 0
    samples = ls.sweep(four_bar, 5760, of=forces).where(moves).max()
    for force in forces:
        peak, at = float(peaks[f"{force}_peak"]), [float(peaks[f"{force}_peak_at"])]
        assert peak == pytest.approx(float(ls.sweep(four_bar, at, of=[force])[force][0]), rel=1e-8)
        assert peak > float(samples[force]) * (1.0 - 1e-9)


def test_torque_ratio_is_unbounded_where_the_output_stands_still():
    """The torque ratio is the inverse of the rocker's rate, which changes sign where it turns round."""
    mechanism = machines(17.3)["omega4 of the press"][0]
    peaks = ls.peaks(ls.Scene(mechanism, 1.0), of=["torque_ratio", "mechanical_advantage"])
    assert float(peaks.torque_ratio_max) == math.inf and float(peaks.torque_ratio_min) == -math.inf
    assert float(peaks.mechanical_advantage_peak) == math.inf
