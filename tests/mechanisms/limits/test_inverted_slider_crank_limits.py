"""`check` of an inverted slider-crank against sweeps and closed forms; its peaks, example, files and refusals."""

import re

import numpy as np
import pytest
import xarray as xr
from oracle_inverted_slider_crank import random_data, to_scene
from references import BRANCHES

import linksweep as ls


def machine(crank: float, ground: float, offset: float = 0.0, **changes) -> ls.Scene:
    bars = ls.Link(crank, 1.0, 0.01), ls.Link(1.0, 2.0, 0.2, cg_distance=0.4)
    return ls.Scene(ls.InvertedSliderCrank(*bars, ground, 0.5, offset=offset, **changes), omega2=1.0)


@pytest.mark.parametrize(("crank", "ground", "motion", "swing"), [(0.2, 0.4, 0, 60.0), (0.4, 0.2, 1, np.nan)])
def test_quick_return_of_two_to_one(crank, ground, motion, swing):
    """asin(1/2) = 30 degrees: the crank's turn divides into 240 and 120."""
    limits = ls.check(machine(crank, ground))
    assert limits.rocker_motion.item() == motion and limits.assembly.item() == 0
    assert abs(limits.time_ratio.item() - 2.0) < 1e-14
    np.testing.assert_allclose(limits.swing, swing, rtol=1e-14)


@pytest.mark.parametrize("offset", [0.0, 0.11, -0.11])
@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize("ground_angle", [0.0, 71.0])
def test_reversals_swing_and_time_ratio(offset, branch, ground_angle):
    """The rocker turns round where check says, by what it says, and the crank takes that long."""
    scene = machine(0.2, 0.4, offset, branch=branch, ground_angle=ground_angle)
    limits = ls.check(scene)
    greatest, least = (limits.reversal_angle.sel(reversal=f"{branch}_{end}").item() for end in ("greatest", "least"))
    ends = ls.sweep(scene, [greatest, least], of=["theta4", "omega4"])
    assert np.all(np.abs(ends.omega4) < 1e-14)
    assert abs((ends.theta4[0] - ends.theta4[1]).item() % 360.0 - limits.swing.item()) < 1e-12
    rising = (greatest - least) % 360.0
    assert abs(max(rising, 360.0 - rising) / min(rising, 360.0 - rising) - limits.time_ratio.item()) < 1e-12
    middle = ls.sweep(scene, [least + 0.5 * rising], of=["omega4"])
    assert middle.omega4.item() > 0.0


@pytest.mark.parametrize("offset", [0.0, 0.11, -0.11])
def test_time_ratio_of_a_rocker_that_turns_fully(offset):
    """Half a turn of the rocker, from square to the frame line to square, as the sweep shows it."""
    scene = machine(0.4, 0.2, offset)
    grid = np.arange(3600) / 10.0
    theta4 = ls.sweep(scene, grid, of=["theta4"]).theta4.values
    slow = np.count_nonzero(np.cos(np.radians(theta4)) < 0.0) / len(grid)
    assert abs(slow / (1.0 - slow) - ls.check(scene).time_ratio.item()) < 5e-3
    assert np.isnan(ls.check(scene).reversal_angle).all()


@pytest.mark.parametrize("ground_angle", [0.0, 200.0])
@pytest.mark.parametrize("offset", [0.5, -0.5])
def test_arc_that_can_be_assembled(offset, ground_angle):
    scene = machine(0.4, 0.2, offset, ground_angle=ground_angle)
    limits = ls.check(scene)
    assert (
        limits.assembly.item() == 1 and limits.rocker_motion.item() == 2 and limits.transmission_angle_min.item() == 0
    )
    start, end = limits.arc_start.item(), limits.arc_end.item()
    cos = (0.4**2 + 0.2**2 - 0.5**2) / (2 * 0.4 * 0.2)
    assert abs(end - start - (360.0 - 2 * np.degrees(np.arccos(cos)))) < 1e-12
    np.testing.assert_allclose(limits.toggle_angle, [start % 360.0, end % 360.0], rtol=0, atol=1e-12)
    beside = [start - 1e-6, start + 1e-6, end - 1e-6, end + 1e-6]
    assert ls.sweep(scene, beside).status.values.tolist() == [1, 0, 0, 1]


def test_least_transmission_angle():
    scene = machine(0.2, 0.5, 0.1)
    least = ls.sweep(scene, 720, of=["transmission_angle"]).transmission_angle.min().item()
    assert abs(least - ls.check(scene).transmission_angle_min.item()) < 1e-12
    assert abs(least - np.degrees(np.arccos(1 / 3))) < 1e-12


def test_studies_hold_every_kind():
    """One design that never closes spoils no other, in check as in peaks."""
    offset = xr.DataArray([0.0, 0.25, 0.9], dims="design")
    scene = machine(0.4, 0.2, offset)
    result, peaks = ls.check(scene), ls.peaks(scene)
    assert result.assembly.values.tolist() == [0, 1, 2]
    assert np.isnan(result.arc_start.values[2]).all() and np.isfinite(result.arc_start.values[:2]).all()
    assert np.isfinite(peaks.F43_peak.values[0]) and np.isnan(peaks.F43_peak.values[2])


def test_peaks_are_those_of_a_fine_sweep():
    scene = ls.example("quick-return")
    cycle, peaks = ls.sweep(scene, 7200, of=["F43", "T12", "T43"]), ls.peaks(scene)
    assert abs(peaks.F43_peak.item() - cycle.F43.max().item()) < 1e-6 * cycle.F43.max().item()
    assert abs(peaks.T12_max.item() - cycle.T12.max().item()) < 1e-6 * cycle.T12.max().item()


# ---- files and refusals -----


def test_example_cuts_on_the_slow_stroke():
    """Against the tool the rocker turns to the left; the crank's work in a turn is the tool's, whatever the masses."""
    scene = ls.example("quick-return")
    third = np.degrees(np.arcsin(1 / 3))
    assert abs(ls.check(scene).time_ratio.item() - (90 + third) / (90 - third)) < 1e-12
    cycle = ls.sweep(scene, 1440, of=["theta4", "omega4", "T12"])
    force = ls.sweep(scene, 1440, of=["F43n"])  # the same grid, for its coordinate of the force
    cutting = force["loads[1].force[1]"].values
    assert np.all(cycle.omega4.values[cutting > 100.0] > 0.0)
    turn = np.radians(0.25) / scene.omega2
    tool = cutting * 0.7 * np.sin(np.radians(cycle.theta4.values)) * cycle.omega4.values
    assert abs((cycle.T12.values * scene.omega2).sum() * turn - tool.sum() * turn) < 1e-9 * abs(tool).sum() * turn


def test_scene_file_and_dataset_give_the_scene_back(tmp_path):
    scene = to_scene(random_data(np.random.default_rng(2), kind="limited", loads=3))
    ls.save(ls.sweep(scene, 8), tmp_path / "cycle.nc")
    assert ls.load_scene(tmp_path / "cycle.nc") == scene


@pytest.mark.parametrize("turn", [0.0, 30.0, -90.0])
def test_a_single_toggle_where_the_block_passes_the_rockers_pin_leaves_a_whole_turn(turn):
    """Crank and ground are as long as each other, the rocker's line goes through D: the arc is all but that angle."""
    limits = ls.check(machine(1.0, 1.0, ground_angle=turn))
    assert limits.assembly.item() == 1
    assert limits.arc_start.item() == turn % 360.0 and limits.arc_end.item() == turn % 360.0 + 360.0
    np.testing.assert_array_equal(limits.toggle_angle, 2 * [turn % 360.0])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"offset": 0.7}, "offset = 0.7 m is 0.1 m beyond the reach of crank + ground"),
        ({"ground": 0.0}, "ground = 0 m: must be greater than 0"),
        ({"block_mass": -1.0}, "block_mass = -1 kg: must be at least 0"),
        ({"branch": "left"}, "branch = 'left'"),
        ({"rocker": 3.0}, "rocker = 3.0: must be a Link, Bar or Disk"),
    ],
)
def test_refused_at_the_door(changes, message):
    good = {"crank": ls.Link(0.2, 1, 1), "rocker": ls.Link(1, 1, 1), "ground": 0.4, "block_mass": 1.0}
    with pytest.raises(ValueError, match=re.escape(message)):
        ls.InvertedSliderCrank(**good | changes)
