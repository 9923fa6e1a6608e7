"""Peaks where the forces of two rubbing contacts of a dyad change their signs, or jam."""

import numpy as np
import pytest

import linksweep as ls
from benchmarks.speed.kernel import way
from linksweep.results.peak_search.friction.jams import jammed_designs
from linksweep.results.peak_search.groups import groups
from linksweep.results.peak_search.paths import distinct, jump_angles

CRANK = ls.Link(0.08, 0.4, 3e-4)
STEEL = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
INERTIA = 5.0 * 0.08 * 20.0**2
"""Largest inertial force of the yoke [N]."""

OFF_ROUND = (np.arange(40_000) + 0.3) * (360.0 / 40_000)
"""Crank angles away from those at which the yoke stands still, where there is no friction."""


@pytest.fixture(autouse=True)
def uncompiled():
    with way("interpreted"):
        yield


def yoke(friction, slot_friction, push, slot_angle=90.0):
    machine = ls.Linkage(
        "crank A-B, yoke on slide past B",
        ground={"A": (0.0, 0.0)},
        guides={"slide": ls.Guide(friction=friction)},
        crank=CRANK,
        yoke=ls.Slider(5.0, slot_angle=slot_angle, slot_friction=slot_friction),
    )
    return ls.Scene(machine, omega2=20.0, loads=[ls.Load("yoke", force=push)])


def shaper(friction=0.3, pivot=(0.0, -0.2), angle=0.0):
    """Return a shaper of which block, ram and arm turn round together."""
    machine = ls.Linkage(
        "crank A-B, arm D-E past B, block F on arm, ram F on slide",
        ground={"A": (0.0, 0.0), "D": pivot},
        crank=CRANK,
        arm=ls.Bar(0.5, **STEEL),
        block=ls.Slider(0.5),
        ram=ls.Slider(3.0),
        guides={
            "slide": ls.Guide((0.0, 0.2), angle, friction),
            "arm": ls.Guide((0.0, 0.0), 0.0, friction, of="arm"),
        },
    )
    return ls.Scene(machine, omega2=20.0, gravity=(0.0, -9.81), loads=[ls.Load("ram", force=(-60.0, 0.0))])


def test_a_contact_bears_nothing_where_the_force_lies_on_the_edge_of_the_others_cone():
    """In a scotch yoke, P + m r ω² cos θ ± μ V = 0 for the slot, V ± μ' (P + m r ω² cos θ) = 0 for the guide."""
    along, across = 10.0, -60.0
    (group,) = groups(yoke(0.4, 0.9, (along, across)), np.array([0]))
    shares = np.array([0.4, -0.4, 1.0 / 0.9, -1.0 / 0.9]) * across
    angles = np.degrees(np.arccos(-(along + shares) / INERTIA))
    turns_round = [0.0, 90.0, 180.0, 270.0]
    expected = np.sort(np.concatenate([angles, 360.0 - angles, turns_round]))
    angles = np.unique(np.round(np.mod(jump_angles(group)[0] + 1e-9, 360.0), 7))
    np.testing.assert_allclose(angles, expected, rtol=0, atol=1e-7)


@pytest.mark.parametrize("slot_friction", [0.8, 2.5])
@pytest.mark.parametrize("slot_angle", [30.0, 90.0, 140.0])
def test_peaks_of_a_yoke_that_jams_exceed_those_of_dense_samples_by_little(slot_friction, slot_angle):
    scene = yoke(0.9, slot_friction, (-100.0, 40.0), slot_angle)
    exact, dense = ls.peaks(scene), ls.peaks(scene, theta2=OFF_ROUND)
    status = ls.sweep(scene, OFF_ROUND, of=["status"]).status
    assert int(exact.status) == bool((status > 3).any())
    for name in ("F12_peak", "F32_peak", "T12_max"):
        if (status > 3).all():
            assert np.isnan(exact[name]), name
        else:
            assert 0.0 <= float(exact[name] - dense[name]) < 1e-3 * float(exact[name]), name


def test_slides_that_turn_round_together_hide_no_peak_beside():
    """At the same angle but for rounding: samples on both sides of each show no slope between them."""
    scene = shaper(pivot=(0.031, -0.187), angle=7.0)
    merged = distinct(np.array([[10.0, 50.0, 10.0 + 1e-12, np.nan, 10.0 - 1e-13, 50.0 + 1e-6]]))
    np.testing.assert_array_equal(merged, [[10.0 - 1e-13] * 3 + [50.0, 50.0 + 1e-6, np.nan]])
    exact, dense = (ls.peaks(scene, **at) for at in ({}, {"theta2": OFF_ROUND}))
    peaks = [name for name in exact if name.endswith("_peak")]
    assert len(peaks) > 5
    for name in peaks:
        assert 0.0 <= float(exact[name] - dense[name]) <= 1e-4 * float(exact[name]), name


def test_a_jam_between_samples_of_the_status_counts():
    """Arm and guide come nearest to each other where sin = 0.08/0.2: there friction wedges for a tenth of a degree."""
    scene = shaper(np.tan(np.radians((90.0 - np.degrees(np.arcsin(0.4)) + 1e-5) / 2.0)))
    assert (ls.sweep(scene, 720, of=["status"]).status == 0).all()
    assert (ls.sweep(scene, 203.578 + np.linspace(-0.04, 0.04, 9), of=["status"]).status > 3).any()
    assert bool(jammed_designs(scene).values)
    peaks = ls.peaks(scene, of=["F54"])
    assert int(peaks.status) == 3 and np.isinf(peaks.F54_peak)


def test_largest_samples_are_those_of_angles_that_are_ok():
    """A lever that closes at some angles only leaves the forces of the yoke finite at the others."""
    machine = ls.Linkage(
        "crank A-B-C, yoke on slide past B, rod C-E, lever D-E",
        ground={"A": (0.0, 0.0), "D": (0.3, 0.0)},
        points={"C": (0.1, 90.0)},
        guides={"slide": ls.Guide(friction=0.2)},
        crank=CRANK,
        yoke=ls.Slider(5.0, slot_friction=0.1),
        rod=ls.Bar(0.2, **STEEL),
        lever=ls.Bar(0.15, **STEEL),
    )
    scene = ls.Scene(machine, omega2=20.0, loads=[ls.Load("yoke", force=(10.0, -40.0))])
    samples, cycle = ls.peaks(scene, of=["F32", "F32n_rms"], theta2=720), ls.sweep(scene, 720, of=["F32", "F32n"])
    assert 100 < int((cycle.status == 0).sum()) < 600
    assert float(samples.F32_peak) == float(cycle.F32.max())
    assert float(samples.F32n_rms) == pytest.approx(float((cycle.F32n**2).mean() ** 0.5), rel=1e-13)
