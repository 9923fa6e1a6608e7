"""Designs side by side: the same bits compiled and interpreted, alone and in company."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.engine.near_zero import places
from linksweep.engine.peaks import on_pieces, turns, zeros
from linksweep.engine.peaks.brackets import BEST_ROWS, BRACKET_ROWS, PEAK
from linksweep.engine.peaks.evaluators import Evaluators
from linksweep.engine.peaks.lanewise import Around, Lanewise
from linksweep.engine.peaks.samples import HALF, SAMPLES, grades
from linksweep.engine.peaks.summits import might_reach_between
from linksweep.engine.trace.plan import plan

PLACED = 2 * HALF + 2
LANEWISE = {
    name: value
    for module in (turns, on_pieces, zeros, places)
    for name, value in vars(module).items()
    if isinstance(value, Lanewise)
}
SPECIAL = (0.0, -0.0, 1.0, np.inf, -np.inf, np.nan)


def table(seed: int, columns: int = 240) -> np.ndarray:
    random = np.random.default_rng(seed)
    numbers = random.normal(size=(turns.STATE_ROWS, columns)) * 10.0 ** random.integers(-3, 4, columns)
    special = random.random(numbers.shape) < 0.05
    numbers[special] = random.choice(SPECIAL, special.sum())
    return numbers


@pytest.mark.parametrize("name", LANEWISE)
def test_lanes_have_the_same_bits_compiled_and_interpreted(name):
    function, columns = LANEWISE[name], 240
    compiled, interpreted = table(3), table(3)
    samples = np.random.default_rng(4).normal(size=SAMPLES * columns), SAMPLES, columns
    for lanes, numbers in ((function.compiled, compiled), (function, interpreted)):
        with np.errstate(all="ignore"):
            lanes(*samples, numbers) if isinstance(function, Around) else lanes(numbers, columns)
    np.testing.assert_array_equal(compiled, interpreted)
    assert not np.array_equal(compiled, table(3), equal_nan=True)


def test_a_constant_is_stored_in_all_lanes():
    table = np.ones((2, 16))
    Lanewise(lambda x: (2.5, x < 0.0), (0,), (0, 1)).compiled(table, 16)
    np.testing.assert_array_equal(table, np.repeat([[2.5], [0.0]], 16, axis=1))


def test_the_best_summit_and_the_next_are_those_of_a_search_one_by_one():
    """Against a plain loop over the samples of each signal."""
    columns, state = 8, np.zeros((turns.STATE_ROWS, 8))
    rows = np.random.default_rng(1).normal(size=(SAMPLES, columns))
    turns.compare_samples(rows.ravel(), SAMPLES, columns, state)
    before, after = np.roll(rows, 1, axis=0), np.roll(rows, -1, axis=0)
    reach = np.where((before < rows) & (after <= rows), 3.0 * rows - before - after, -np.inf)
    ranked = np.sort(reach, axis=0)
    np.testing.assert_array_equal(state[turns.SUMMIT], reach.argmax(axis=0))
    np.testing.assert_allclose(state[turns.REACH], ranked[-1], rtol=1e-15)
    np.testing.assert_allclose(state[turns.OTHER], ranked[-2], rtol=1e-15)


def test_beside_a_sample_without_a_value_a_summit_of_any_height_may_hide():
    columns, state = 8, np.zeros((turns.STATE_ROWS, 8))
    rows = np.random.default_rng(1).normal(size=(SAMPLES, columns))
    for lane, none in enumerate((0, 7, HALF, SAMPLES - 1)):
        rows[none, lane], rows[(none + 1) % SAMPLES, lane] = np.nan, 3.0
        rows[(none + 11) % SAMPLES, lane] = 4.0
    turns.compare_samples(rows.ravel(), SAMPLES, columns, state)
    assert (np.isposinf(state[turns.OTHER]) == [True] * 4 + [False] * 4).all()
    assert np.isfinite(state[turns.REACH]).all()


@pytest.mark.parametrize(("top", "dip"), [(0.4, 1.1), (0.5, 1.2), (0.8, 1.3), (-0.5, 3.5), (1.2, 1.8)])
@pytest.mark.parametrize("turned", [False, True])
def test_a_top_between_two_of_four_samples_that_rise_or_fall_is_noted(top, dip, turned):
    """Samples of cubics at −1, 0, 1 and 2: with a top between 0 and 1 the height allowed is at least that."""
    curve = np.polyint(np.poly([top, dip]))
    samples = np.polyval(curve, [-1.0, 0.0, 1.0, 2.0])
    samples = samples[::-1] if turned else samples
    reach = might_reach_between(*samples)
    assert (reach >= np.polyval(curve, top)) if 0.0 < top < 1.0 else (reach == -np.inf)
    table = np.append(samples, 0.0)[:, None]
    Lanewise(lambda *four: (turns.height_between(*four),), (0, 1, 2, 3), (4,))(table, 1)
    assert table[4] == reach
    for before in (3, 4):  # the samples are compared two by two
        state, padded = np.zeros((turns.STATE_ROWS, 1)), np.full((2 * HALF + 4, 1), samples.min() - 1.0)
        padded[before : before + 4, 0] = samples
        on_pieces.compare_many(padded.ravel(), len(padded), 1, state)
        assert reach in [*state[[turns.REACH, turns.OTHER], 0], -np.inf]


@pytest.mark.parametrize(
    ("samples", "height"),
    [
        ((0.0, 12.0, 12.2, 12.19), 12.2 - (2.0 * 12.19 + 3.0 * 12.2 - 6.0 * 12.0) / 6.0),  # steep, then level
        ((0.0, 0.8, 1.0, 0.6), -np.inf),  # nearly a parabola: the secants about the summit allow as much
    ],
)
@pytest.mark.parametrize("turned", [False, True])
def test_a_top_beside_a_summit_is_noted_where_the_flank_before_it_is_steep(samples, height, turned):
    """By the tangent of the cubic through the samples, at the summit: it falls there."""
    samples = samples[::-1] if turned else samples
    assert might_reach_between(*samples) == pytest.approx(height)
    table = np.append(samples, 0.0)[:, None]
    Lanewise(lambda *four: (turns.height_between(*four),), (0, 1, 2, 3), (4,))(table, 1)
    assert table[4] == might_reach_between(*samples)


def four_bars(designs: int) -> ls.Scene:
    random = np.random.default_rng(7)

    def link(shortest: float, longest: float) -> ls.Link:
        length, mass, inertia = (
            random.uniform(*ends, designs) for ends in ((shortest, longest), (0.5, 2.0), (1e-3, 5e-3))
        )
        numbers = (length, mass, inertia, 0.4 * length, random.uniform(-30.0, 30.0, designs))
        return ls.Link(*(xr.DataArray(number, dims="design") for number in numbers))

    mechanism = ls.FourBar(link(0.05, 0.1), link(0.2, 0.25), link(0.18, 0.22), ground=0.22)
    return ls.Scene(mechanism, omega2=30.0, alpha2=5.0, gravity=(0.0, -9.81))


def masses(designs: int) -> ls.Scene:
    """Return masses of the coupler, each with its own centre of gravity, on one geometry."""
    crank, coupler, rocker = (ls.Link(length, 1.0, 2e-3, 0.4 * length, 20.0) for length in (0.08, 0.22, 0.2))
    mass, distance = (xr.DataArray(np.linspace(*ends, designs), dims="design") for ends in ((0.5, 2.0), (0.02, 0.2)))
    coupler = replace(coupler, mass=mass, cg_distance=distance)
    return ls.Scene(ls.FourBar(crank, coupler, rocker, 0.22), omega2=30.0, alpha2=5.0, gravity=(0.0, -9.81))


@pytest.mark.parametrize("one_geometry", [False, True])
def test_evaluators_have_the_same_bits_compiled_and_interpreted(one_geometry):
    """Also at the samples that share operations with those on the other side of the middle, or with those of other
    designs, and where the last design stands in lanes that have none of their own; designs have two dims."""
    scene, front, designs = masses(5) if one_geometry else four_bars(5), 8, 15
    scene = replace(scene, omega2=xr.DataArray([20.0, 30.0, 40.0], dims="speed"))
    forms = tuple((name, form) for name, form in scene.inputs.forms if name not in scene.grid(1).names)
    forms += (("half_tangent", ("theta2",) if one_geometry else ("theta2", "design")), ("far_half", ("theta2",)))
    signals = ("F32", "T12", "F14y") if one_geometry else ("F32", "T12", "theta4")
    request = plan(scene.table.between_samples, (*signals, "near_toggle_near", "near_toggle_far"), forms)
    evaluators = Evaluators(request, signals)
    compiled, interpreted = evaluators.compiled, evaluators.interpreted
    assert (compiled.shared > 0) == one_geometry
    lanes, places = compiled.lanes, 2 * PLACED * compiled.lanes
    of_turn = np.zeros(places + compiled.shared)
    assert turns.place_samples(np.repeat([0.2, 1.0], lanes), lanes, grades(), 1.0, of_turn) == 2 * lanes
    assert turns.place_samples(np.repeat([0.2, 1.0], lanes), lanes, grades(), 1.0, of_turn) == 0
    values = [scene.inputs.fields[node.value].values for node in evaluators.inputs]
    starts = np.cumsum([0, *(value.size for value in values[:-1])])
    parameters = np.array([scene.inputs.sizes[dim] for dim in request.loops]), np.concatenate(values, axis=None), starts
    constants, rows = np.empty(len(evaluators.constants) * lanes), np.empty((SAMPLES + 1) * len(signals) * lanes)
    compiled.prepare(front, designs, *parameters, constants)
    compiled.share(constants, of_turn)
    compiled.sample(constants, of_turn, rows)
    trials = np.array([np.linspace(-0.9, 0.9, lanes), np.zeros(lanes), np.arange(lanes) % 2.0, np.arange(lanes) % 3.0])
    table = trials.copy()
    compiled.evaluate(constants, table, 0, 1, 2, 3, 0, lanes)
    for lane in range(lanes):
        own, own_rows = np.empty(interpreted.constants), np.empty(SAMPLES * len(signals))
        interpreted.prepare(min(front + lane, designs - 1), designs, *parameters, own)
        interpreted.sample(own, of_turn[lane:places:lanes].copy(), own_rows)
        interpreted.evaluate(own, trials, 0, 1, 2, 3, lane, lane + 1)
        np.testing.assert_array_equal(constants.reshape(-1, lanes)[:2, lane], own[:2])
        np.testing.assert_array_equal(rows.reshape(SAMPLES + 1, -1, lanes)[:SAMPLES, :, lane].ravel(), own_rows)
    np.testing.assert_array_equal(table, trials)
    wide = np.tile(trials, 3)
    wide[3] = np.repeat([0.0, 1.0, 2.0], lanes)
    alone, wide[1] = wide.copy(), np.nan
    compiled.evaluate(constants, wide, 0, 1, 2, 3, 0, 3 * lanes)
    compiled.evaluate(constants, alone, 0, 1, 2, -1, 0, 3 * lanes)
    np.testing.assert_array_equal(alone, wide)
    np.testing.assert_array_equal(alone[1, [0, lanes + 1]], trials[1, :2])


def test_numbers_that_designs_share_are_the_same_as_their_own():
    """Compiled for the same operations, but for parameters of other dims."""
    slow = four_bars(50)
    fast = replace(slow, omega2=40.0)
    mixed = replace(slow, omega2=xr.DataArray(np.tile([30.0, 40.0], 25), dims="design"))
    both = replace(slow, omega2=xr.DataArray([30.0, 40.0], dims="speed"))
    peaks = [ls.peaks(scene, of=["F32", "T12"]).drop_vars("omega2", errors="ignore") for scene in (slow, fast, mixed)]
    *shared, own = (one.drop_attrs() for one in peaks)
    of_both = ls.peaks(both, of=["F32", "T12"]).drop_vars("omega2").drop_attrs()
    for speed, alone in enumerate(shared):
        every_other = {"design": slice(speed, None, 2)}
        xr.testing.assert_identical(own.isel(every_other), alone.isel(every_other))
        xr.testing.assert_identical(of_both.isel(speed=speed), alone)


def test_designs_on_one_geometry_have_the_bits_of_those_on_equal_ones():
    on_one = replace(
        masses(50), loads=(ls.Load("rocker", torque=xr.DataArray(np.linspace(-9.0, 9.0, 50), dims="design")),)
    )
    ground = xr.DataArray(np.full(50, 0.22), dims="design")
    on_equal = replace(on_one, mechanism=replace(on_one.mechanism, ground=ground))
    one, equal = (ls.peaks(scene).drop_vars("ground", errors="ignore").drop_attrs() for scene in (on_one, on_equal))
    xr.testing.assert_identical(one.drop_vars("status"), equal.drop_vars("status"))


def test_samples_are_placed_by_the_near_toggles_with_one_more_on_either_side():
    x, widths = np.empty(2 * PLACED), np.array([0.01, 1.0])
    turns.place_samples(widths, 1, grades(), 1.0, x)
    near, far = 2.0 * np.degrees(np.arctan(x.reshape(2, PLACED)))
    for angles, other in ((near, far), (far, near)):
        assert angles[1] == -90.0 and angles[1 + HALF] == 0.0 and angles[-1] == 90.0
        np.testing.assert_array_equal(angles[1:], -angles[:0:-1])
        np.testing.assert_allclose(angles[0], other[-2] - 180.0, rtol=1e-14)
    assert near[2 + HALF] < 0.3 * far[2 + HALF]


def test_of_three_summits_nearly_as_high_the_highest_is_the_peak():
    """cos 3θ and a little of cos θ: samples may show any of three summits as the best, by more than they differ."""
    phase = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    little = 1e-6

    def height(angle, phase):
        return 5.0 + np.cos(3.0 * (angle - phase)) + little * np.cos(angle - phase)

    def prepare(front, designs, sizes, parameters, parameter_at, constants):
        constants[:] = 1.0, 1.0, parameters[front]

    def share(constants, x):
        assert len(x) == 2 * PLACED

    def sample(constants, x, rows):
        angles = 2.0 * np.arctan(x.reshape(2, PLACED)[:, 1:-1]) + [[0.0], [np.pi]]
        rows[:SAMPLES] = height(angles.ravel(), constants[2])

    def evaluate(constants, table, x, value, far, signal, first, last):
        at = table[:, first:last]
        at[value] = height(2.0 * np.arctan(at[x]) + np.pi * at[far], constants[2])

    best = np.empty((BEST_ROWS + 1, len(phase)))
    one = np.array([0], dtype=np.int64)
    with np.errstate(all="ignore"):
        turns.search(
            0, len(phase), len(phase), 1, True, False, np.array([len(phase)]), phase, one, grades(), prepare, share,
            sample, evaluate, np.zeros((turns.BLOCKS, 3)), np.zeros(2 * PLACED), np.zeros(SAMPLES + 1),
            np.zeros((turns.STATE_ROWS, 1)), np.zeros((BRACKET_ROWS, turns.ROOM)), np.zeros(3), best,
        )  # fmt: skip
    np.testing.assert_allclose(best[PEAK], 6.0 + little, rtol=2e-11)
    np.testing.assert_allclose(np.cos(np.radians(best[turns.PEAK_ANGLE]) - phase), 1.0, atol=1e-9)
