"""Forces that have limits, beside angles at which others grow without bound: rounding errors are no peaks of theirs."""

import math

import numpy as np
import pytest
from linkage_reference import solved
from oracle import FourBarData, LinkData, solve, to_scene

import linksweep as ls
from benchmarks.stress.linkages.topologies import AWAY_FROM_TOGGLES
from benchmarks.stress.six_bars import any_linkage
from linksweep.results.peak_search.singular.rounding_errors import Singular, clear_of

SINGULAR = np.array([[100.0, 40.0], [350.0, math.nan]])
"""Angles of singular places, of two designs."""
PARTS = {
    None: [[(40.01, 99.99), (100.01, 399.99)], [(350.01, 709.99)]],
    (0.0, 90.0): [[(0.0, 39.99), (40.01, 90.0)], [(0.0, 90.0)]],
    (340.0, 405.0): [[(340.0, 399.99), (400.01, 405.0)], [(340.0, 349.99), (350.01, 405.0)]],
}
"""Parts between them of a turn, or of a part of it."""


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


def test_a_torque_with_a_summit_much_narrower_than_its_distance_from_a_change_point():
    """The rocker of almost a kite swings the second four-bar past a near-toggle of its own, 0.0025° from the change
    point and 2e-6° wide, against multibody equations in 50 digits."""
    parts = {
        "crank": ls.Link(1.083021049277583, 1.5576597795167386, 0.05084291120642651, 0.05350589231451206, -67.5),
        "coupler": ls.Link(2.118635938859966, 0.5262411991178174, 0.23724229059896837, 2.356590666695914, 167.0),
        "rocker": ls.Link(2.118557928126381, 0.7853491741578915, 0.2421135934391274, 2.057800883862827),
        "rod": ls.Link(1.3877914660987059, 1.782110641502837, 0.6015654563391276, 0.14224282707116231, 153.6),
        "output": ls.Link(0.5500014372121467, 0.9245485498543777, 0.04406808820562005, 0.17030045586894055),
    }
    machine = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F",
        ground={"A": (0.0, 0.0), "D": (1.0829430385297039, 0.0), "G": (1.1254930845849316, -0.534824208346242)},
        points={"E": (1.4012784213912406, -24.037647027785596)},
        branch={"C": "crossed", "F": "open"},
        **parts,
    )
    scene = ls.Scene(machine, -1.640532108631156, -81.05416211657598, (0.0, -9.81), [ls.Load("output", torque=3.0)])
    peaks = ls.peaks(scene, of=["T12"])
    at, torque = float(peaks.T12_max_at), float(peaks.T12_max)
    before, there, after = (solved(scene, at + step)[0]["T12"] for step in (-1e-6, 0.0, 1e-6))
    assert torque == pytest.approx(there, rel=1e-10) and torque > 3e15 and max(before, after) < 0.95 * torque


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


def shaper(*loads):
    """Return a shaper moved by its arm, at two toggles of which the forces at its ram grow as 1/distance⁴."""
    machine = ls.Linkage(
        "crank A-B, arm D-E past B, block F on arm, ram F on slide",
        ground={"A": (0.0, 0.0), "D": (0.2145, 0.1493)},
        guides={"arm": ls.Guide((0.7768, 0.0), of="arm"), "slide": ls.Guide((-0.1451, 0.9255), 232.0)},
        branch={"arm": "crossed"},
        crank=ls.Link(0.936, 0.434, 0.163, 0.1),
        arm=ls.Link(2.13, 0.335, 0.755, 2.49, 156.0),
        block=ls.Slider(9.97, 0.688),
        ram=ls.Slider(2.32, 0.229),
    )
    return ls.Scene(machine, -38.6, loads=loads, drive="arm")


def test_a_crank_that_carries_nothing_beside_forces_that_grow_as_the_fourth_power():
    """Their rounding errors exceed 1 N at 0.15 degrees before a toggle, and grow as evenly where each is one digit."""
    peaks = ls.peaks(shaper(), of=["F12", "F43"])
    assert float(peaks.F12_peak) == pytest.approx(0.434 * 0.1 * 38.6**2, rel=1e-7)
    assert float(peaks.F43_peak) == math.inf


def test_a_force_that_grows_without_bound_as_shows_clear_of_rounding_errors_alone():
    """A damper from the block, whose speed grows without bound, pulls at the crank."""
    peaks = ls.peaks(shaper(ls.Damper(("block", 0.25, 131.0), ("crank", 0.417, 70.0), 21.5)), of=["F12"])
    assert float(peaks.F12_peak) == math.inf


def test_rounding_errors_that_jump_at_the_end_of_an_arc_are_no_growth():
    """Both ends have limits, from which the crank's pin force falls with the root of the distance; closer than 5e-6
    degrees its samples jump to twice as much, and rise to 148 N."""
    designs = any_linkage(AWAY_FROM_TOGGLES["Whitworth, jack drives"], np.random.default_rng(11), 30)
    scene = ls.scene_at(designs, design=25)
    end, distance = float(ls.check(scene).arc_end.max()), np.array([1e-4, 1e-3])
    near, far = ls.sweep(scene, theta2=end - distance, of=["F12"]).F12.values
    limit = near + (near - far) * math.sqrt(1e-4) / (math.sqrt(1e-3) - math.sqrt(1e-4))
    peaks = ls.peaks(scene, of=["F12", "F12_bound"])
    peak, bound = float(peaks.F12_peak), float(peaks.F12_bound)
    assert near < peak < 1.001 * limit and peak + bound > 0.999 * limit and bound < 0.02 * limit


@pytest.mark.parametrize("part", PARTS)
def test_parts_clear_of_singular_places(part):
    starts, ends = clear_of(SINGULAR, np.full(SINGULAR.shape, 0.01), part, 360.0)
    for k, expected in enumerate(PARTS[part]):
        parts = [(start, end) for start, end in zip(starts[:, k], ends[:, k], strict=True) if start < end]
        np.testing.assert_allclose(parts, expected, rtol=1e-12)


def test_a_search_close_to_one_place_keeps_clear_of_those_that_it_was_too_far_from_before():
    """Design 3 has another place 1.5 degrees away, across 0, design 7 one 40 degrees away."""
    places = Singular(np.array([3, 3, 5, 7, 7]), np.array([359.5, 1.0, 1.0, 20.0, 60.0]), np.zeros(5, dtype=bool))
    angles, distances = places.close_to(np.array([3, 7]), np.array([10.24, 0.0, 0.0, 0.0, 0.01]), 360.0)
    np.testing.assert_array_equal(angles, [[359.5, 1.0], [math.nan, 60.0]])
    np.testing.assert_array_equal(distances, [[10.24, 10.24], [0.0, 0.01]])
