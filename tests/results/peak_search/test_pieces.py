"""Peaks of machines with friction, searched on pieces of the turn on which all forces are smooth."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.engine.peaks import laid_out, on_pieces, zeros
from linksweep.engine.peaks.brackets import BRACKET_ROWS, PEAK, PEAK_X
from linksweep.engine.peaks.evaluators import Functions
from linksweep.engine.peaks.samples import HALF, SAMPLES, grades
from linksweep.engine.peaks.turns import EVALUATIONS, ROOM, STATE_ROWS
from linksweep.physics.closures.crank_angle import place_on_piece
from linksweep.results.peak_search import pieces
from linksweep.results.peak_search.groups import groups
from linksweep.scene.parameters import replaced

DESIGNS = 12
FORCES = ("F12", "F32", "F43", "F14", "T12")


def numbers(seed: int, *ends: float) -> xr.DataArray:
    return xr.DataArray(np.random.default_rng(seed).uniform(*ends, DESIGNS), dims="design")


def engines(**changes) -> ls.Scene:
    crank = ls.Link(numbers(1, 0.03, 0.06), numbers(2, 0.5, 1.5), 1e-3, cg_distance=0.01, cg_angle=30.0)
    rod = ls.Link(numbers(3, 0.12, 0.2), numbers(4, 0.3, 1.0), 2e-3, cg_distance=0.05, cg_angle=-5.0)
    offset, friction = numbers(5, -0.02, 0.02), numbers(6, 0.0, 0.3)
    mechanism = ls.SliderCrank(crank, rod, 0.5, offset, friction, slide_angle=20.0)
    push = ls.Load("slider", force=(numbers(7, -90.0, 90.0), numbers(8, -90.0, 90.0)))
    return ls.Scene(replace(mechanism, **changes), numbers(9, -30.0, 30.0), 20.0, (0.0, -9.81), [push])


def inverted() -> ls.Scene:
    crank = ls.Link(numbers(1, 0.05, 0.1), 0.5, 1e-3)
    rocker = ls.Link(0.4, numbers(2, 0.5, 1.0), 5e-3, cg_distance=0.1)
    mechanism = ls.InvertedSliderCrank(
        crank, rocker, 0.2, 0.3, 1e-4, numbers(3, -0.03, 0.03), friction=numbers(4, 0.0, 0.3)
    )
    return ls.Scene(mechanism, 20.0, gravity=(0.0, -9.81), loads=[ls.Load("rocker", torque=numbers(5, -9.0, 9.0))])


def test_a_guide_that_bears_nothing_at_any_angle_has_no_kinks():
    """A weightless ram and rod, without load: neither the normal force nor the friction changes with the angle."""
    light = dict.fromkeys(("lower.mass", "lower.inertia", "ram.mass"), 0.0)
    press = replaced(replace(ls.example("knuckle-press"), loads=[]), light)
    free = replaced(press, {"guides.slide.friction": 0.0})
    peaks, dense = ls.peaks(press, of=["F16n", "F32"]), ls.peaks(free, of=["F32"], theta2=3600)
    assert float(peaks.F16n_peak) == 0.0
    assert float(peaks.F32_peak) == pytest.approx(float(dense.F32_peak), rel=1e-5)


@pytest.mark.parametrize("scene", [engines(branch="crossed"), inverted()])
def test_peaks_reach_the_densest_samples_and_are_values_of_the_signal(scene):
    """The samples are those of a dense sweep; beside a jump they fall short of the one-sided limit."""
    peaks, dense = ls.peaks(scene, of=FORCES), ls.peaks(scene, of=FORCES, theta2=5760)
    assert (peaks.status == 0).all()
    for name in (*(f"{force}_peak" for force in FORCES), "T12_max", "T12_min"):
        sign, size = -1.0 if name.endswith("min") else 1.0, dense[f"{name.split('_')[0]}_peak"]
        excess = sign * (peaks[name] - dense[name]) / size
        assert excess.min() > -1e-11 and excess.max() < 5e-3, name
    for k in range(0, DESIGNS, 5):
        at = float(peaks.F32_peak_at[k])
        beside = ls.sweep(scene, [at - 1e-7, at, at + 1e-7], of="F32").F32.isel(design=k)
        assert float(beside.max()) == pytest.approx(float(peaks.F32_peak[k]), rel=1e-8)


@pytest.mark.parametrize(
    ("scene", "motion"), [(engines(), "x_slider"), (engines(), "a_slider"), (inverted(), "theta4")]
)
def test_friction_changes_no_bit_and_no_sample_of_a_motion(scene, motion):
    """No jump of friction is in it: alone or beside forces, it is searched as if nothing rubbed."""
    smooth = replace(scene, mechanism=replace(scene.mechanism, friction=0.0))
    of = [motion, f"{motion}_samples"]
    alone, beside, free = ls.peaks(scene, of=of), ls.peaks(scene, of=[*of, "F32"]), ls.peaks(smooth, of=of)
    for name in (f"{motion}_{summary}" for summary in ("max", "max_at", "min", "min_at", "samples")):
        np.testing.assert_array_equal(alone[name], beside[name], err_msg=name)
        np.testing.assert_array_equal(alone[name], free[name], err_msg=name)


def test_the_slider_turns_round_and_the_guide_bears_nothing_only_at_ends_of_pieces():
    scene = engines()
    (group,) = groups(scene, np.arange(DESIGNS))
    every = pieces._pieces(group, HALF)
    row, nth = np.nonzero(every.exist)
    start, end, directions = every.start[row, nth], every.end[row, nth], every.directions[:, row, nth]
    np.testing.assert_allclose(np.bincount(row, end - start), 360.0, rtol=1e-14)
    middle = group.number(scene.mechanism.near_toggle_angle)[row]
    signs = [
        np.sign(group.values(("direction", "normal_force"), row, middle + start + share * (end - start)))
        for share in np.linspace(1e-6, 1.0 - 1e-6, 41)
    ]
    assert np.ptp(np.array(signs), axis=0).max() == 0.0
    np.testing.assert_array_equal(np.sign(directions[0]), signs[0][0])


def one_engine(friction: float | xr.DataArray) -> ls.Scene:
    crank, rod = ls.Link(0.05, 1.2, 1e-3), ls.Link(0.15, 0.6, 2e-3, cg_distance=0.05)
    return ls.Scene(ls.SliderCrank(crank, rod, 0.5, 0.01, friction), 20.0, gravity=(0.0, -9.81))


def test_jammed_designs_among_others_are_searched_along_paths():
    friction = xr.DataArray([0.1, 9.0], dims="mu")
    every = ls.peaks(one_engine(friction), of=["T12", "theta3"])
    free, jammed = (ls.peaks(one_engine(float(own)), of=["T12", "theta3"]) for own in friction.values)
    for name, values in free.data_vars.items():
        np.testing.assert_array_equal(values, every[name].isel(mu=0, missing_dims="ignore"), err_msg=name)
    for name in ("T12_max", "T12_max_at", "T12_min", "T12_min_at", "T12_peak", "status"):
        np.testing.assert_array_equal(jammed[name], every[name].isel(mu=1), err_msg=name)
    # the rod's angle, which they share, is that of the free design; alone the other jams where its tangent is 1/μ
    assert float(jammed.theta3_max) == pytest.approx(math.degrees(math.atan(1.0 / 9.0)), rel=1e-10)


def test_compiled_and_interpreted_searches_of_pieces_give_the_same_bits(monkeypatch):
    scene, results = one_engine(numbers(1, 0.0, 0.3)), []
    for most in (math.inf, -1):
        monkeypatch.setattr(laid_out, "INTERPRETED_DESIGNS", most)
        results.append(ls.peaks(scene, of=["T12"]))
    xr.testing.assert_identical(*results)


@pytest.mark.parametrize(("start", "end"), [(0.0, 1.0), (-0.7, 0.2), (0.3, 1.7)])
def test_a_turn_follows_a_piece_there_and_back(start, end):
    x = np.linspace(-1.0, 1.0, 41)
    near, far = (place_on_piece(x, side, start, end) for side in (0.0, 1.0))
    share = np.sin(np.arctan(x)) ** 2
    np.testing.assert_allclose(near, start + (end - start) * share, rtol=1e-14, atol=1e-16)
    np.testing.assert_allclose(far, end - (end - start) * share, rtol=1e-14, atol=1e-16)
    assert near[20] == start and far[20] == end


def zeros_of(height) -> np.ndarray:
    """Return the zeros [rad] of a function of the angle that follows a piece."""

    def prepare(first, designs, sizes, parameters, parameter_at, constants):
        constants[:] = 1.0

    def enter(first, piece, sizes, parameters, parameter_at, constants):
        pass

    def sample(constants, x, rows):
        angles = 2.0 * np.arctan(x.reshape(2, 2 * HALF + 2)[:, 1:-1]) + [[0.0], [np.pi]]
        rows[:SAMPLES] = height(angles.ravel())

    def evaluate(constants, table, x, value, far, signal, first, last):
        at = table[:, first:last]
        at[value] = height(2.0 * np.arctan(at[x]) + np.pi * at[far])

    one, places = np.zeros(1, dtype=np.int64), np.full((2, 1, zeros.MOST_ZEROS), np.nan)
    with np.errstate(all="ignore"):
        zeros.find_zeros(
            0, 1, 1, 1, one + 1, one + 1, np.zeros(1), one, grades(), prepare, enter, sample, evaluate,
            np.zeros((1, 2)), np.zeros((1, 4 * HALF + 4)), np.zeros((1, SAMPLES + 1)),
            np.zeros((zeros.ZERO_ROWS, 99)), np.zeros(2), places,
        )  # fmt: skip
    angles = 2.0 * np.arctan(places[0, 0]) + np.pi * places[1, 0]
    return np.sort(angles[np.isfinite(angles)])


@pytest.mark.parametrize("at", [[], [0.3], [1.57, 1.58], [0.4, 0.41, 2.9], [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]])
def test_zeros_also_two_between_the_same_samples(at):
    for kink in (1.0, 1e-3):
        height = lambda angle, kink=kink: bent(np.prod([np.cos(angle) - np.cos(zero) for zero in at], axis=0), kink)  # noqa: E731
        np.testing.assert_allclose(zeros_of(height), at, atol=2e-12)


def bent(values: np.ndarray, kink: float) -> np.ndarray:
    return np.where(values < 0.0, kink * values, values)


def rocking() -> ls.Scene:
    """Four-bars of any lengths: cranks that move over part of a turn, between toggles."""
    random = np.random.default_rng(8)
    lengths = np.exp(random.uniform(-1.5, 1.5, (4, 12)))
    lengths = np.minimum(lengths, 0.98 * (lengths.sum(axis=0) - lengths.max(axis=0)))
    a, b, c, d = (xr.DataArray(length, dims="design") for length in lengths)
    links = (ls.Link(length, 1.0, 0.1, 0.3 * length, 20.0) for length in (a, b, c))
    return ls.Scene(ls.FourBar(*links, ground=d), 10.0, gravity=(0.0, -9.81))


def test_what_is_unbounded_at_toggles_is_infinite_and_has_its_other_extreme_between_them():
    """The acceleration of the rocker: unbounded at all toggles, mostly in the same direction at both."""
    scene = rocking()
    part = np.flatnonzero(ls.check(scene).assembly.values == 1)
    peaks, dense = ls.peaks(scene, of=["alpha4", "F12x"]), ls.peaks(scene, of=["alpha4", "F12x"], theta2=20_000)
    bounded = 0
    for name, sign in (("alpha4_max", 1.0), ("alpha4_min", -1.0), ("F12x_max", 1.0), ("F12x_min", -1.0)):
        peak, sample = (sign * ds[name].values[part] for ds in (peaks, dense))
        finite = np.isfinite(peak)
        excess = (peak - sample)[finite] / np.abs(peak[finite])
        assert (peak[~finite] == np.inf).all() and (excess > -1e-10).all() and (excess < 1e-4).all()
        bounded += finite.sum()
    assert bounded > len(part) > 5
    assert (peaks.alpha4_peak.values[part] == np.inf).all() and (peaks.status.values[part] == 3).all()


def test_of_pieces_with_several_summits_the_highest_is_the_peak():
    """−cos 3φ and a little of cos φ along each piece, φ from 0 at its start to π at its end: two summits, of which that
    at π/3 is higher by little, and the pieces of a design differ by as little. The second design has two pieces."""
    heights = np.array([[0.0, 3e-7, 1e-7, 2e-7], [0.0, -1.0, 9.0, 9.0]])
    counts, half, little, results = np.array([4, 2]), HALF, 1e-6, []

    def height(phi, of_piece):
        return 5.0 + of_piece - np.cos(3.0 * phi) + little * np.cos(phi)

    def prepare(front, designs, sizes, parameters, parameter_at, constants):
        constants[:] = 1.0, 1.0, math.nan

    def enter(front, piece, sizes, parameters, parameter_at, constants):
        constants[2] = parameters.reshape(sizes)[piece, front]

    def sample(constants, x, rows):
        angles = 2.0 * np.arctan(x.reshape(2, -1)[:, 1:-1]) + [[0.0], [np.pi]]
        rows[: angles.size] = height(angles.ravel(), constants[2])

    def evaluate(constants, table, x, value, far, signal, first, last):
        at = table[:, first:last]
        at[value] = height(2.0 * np.arctan(at[x]) + np.pi * at[far], constants[2])

    for together in (1, 2):
        functions = Functions(1, 3, 0, prepare, print, sample, evaluate, enter)
        pieces = laid_out.LaidOut(("height",), functions, (4, 2), (heights.T.ravel(), np.zeros(1, dtype=int)), half)
        best, room = np.empty((on_pieces.OF_PIECE + 1, 2)), 4 * together
        with np.errstate(all="ignore"):
            on_pieces.search(
                0, 2, together, 1, counts, *pieces.arguments_of_pieces(together), np.zeros((STATE_ROWS, 1)),
                np.zeros((STATE_ROWS, 1)), np.full(2, -np.inf), np.zeros((on_pieces.SUMMIT_ROWS, room)),
                np.zeros((BRACKET_ROWS, ROOM)), pieces.gathered, np.zeros((on_pieces.OF_PIECE, room)), best,
            )  # fmt: skip
        results.append(best)
        np.testing.assert_allclose(best[PEAK], [6.0 + 3e-7 + 0.5 * little, 6.0 + 0.5 * little], rtol=1e-12)
        np.testing.assert_allclose(best[PEAK_X], np.tan(np.pi / 6.0), atol=1e-5)
        np.testing.assert_array_equal(best[on_pieces.OF_PIECE], [1, 0])
        samples = best[EVALUATIONS] - 4 * half * counts
        assert samples[0] > samples[1] > 0.0  # the last piece of the second design is too low for trials
    np.testing.assert_array_equal(*results)
