"""A bracket keeps its highest point in the middle, and closes on the peak, wherever trials fall."""

import itertools
from collections.abc import Callable

import numpy as np
import pytest

from linksweep.engine.peaks import brackets as b
from linksweep.engine.peaks import paths
from linksweep.engine.peaks.summits import slopes_between, uneven_slopes

TRIALS = list(itertools.product((-2.0, -0.5, 0.0, 0.3, 2.0), (0.5, 1.0, 1.5, np.nan, np.inf)))


def one(points: tuple[float, ...]) -> np.ndarray:
    table = np.zeros((b.BRACKET_ROWS, b.in_blocks(1)))
    table[list(b.POINTS), 0], table[b.WIDTH, 0], table[b.FIRST_WIDTH, 0] = points, 4.0 * (points[4] - points[0]), 2.0
    return table


def refine(table: np.ndarray, best: np.ndarray, height: Callable[[np.ndarray], np.ndarray]) -> None:
    count = 1
    for _ in range(b.ROUNDS):
        b.place_trials(table, count)
        table[list(b.VALUES), :count] = height(table[list(b.TRIALS), :count])
        every = b.divide(table, count)
        with np.errstate(all="ignore"):
            b.insert_trials(table, count)
        if not (count := b.advance(table, count, every, best)):
            return


@pytest.mark.parametrize(("place", "value"), TRIALS)
def test_one_more_point(place, value):
    """Against the definition: of the old and the new points, the highest and those beside it."""
    table = one((-1.0, 0.0, 0.0, 1.0, 1.0, -np.inf))
    table[list(b.TRIALS), 0], table[list(b.VALUES), 0] = place, value
    with np.errstate(all="ignore"):
        b.insert_trials(table, 1)
    points = [(-1.0, 0.0), (0.0, 1.0), (1.0, -np.inf)]
    if -1.0 < place < 1.0 and place != 0.0:
        points = sorted([*points, (place, -np.inf if np.isnan(value) else value)])
    middle = max(range(1, len(points) - 1), key=lambda k: (points[k][1], points[k] == (0.0, 1.0)))
    expected = [number for point in points[middle - 1 : middle + 2] for number in point]
    np.testing.assert_array_equal(table[list(b.POINTS), 0], expected)


@pytest.mark.parametrize("order", [*itertools.permutations(range(3))])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_highest_of_three_trials_is_kept_beyond_a_lower_one(side, order):
    """Between it, at 0.8, and the middle, at 0, a lower trial would end the bracket before it."""
    table = one((-1.0, 0.0, 0.0, 1.0, 1.0, 0.0))
    trials = np.array([[0.3, 0.5], [0.8, 2.0], [-0.6, 0.2]])[list(order)]
    table[list(b.TRIALS), 0], table[list(b.VALUES), 0] = side * trials[:, 0], trials[:, 1]
    b.insert_trials(table, 1)
    assert (table[b.XB, 0], table[b.FB, 0]) == (side * 0.8, 2.0)
    assert sorted(table[[b.XA, b.XC], 0] * side) == [0.3, 1.0]


@pytest.mark.parametrize("peak", [-0.7, 0.0, 0.123456, 0.999])
@pytest.mark.parametrize("shape", [np.cos, lambda x: -np.abs(x), lambda x: -np.abs(x) - 1e3 * (x > 0.0)])
def test_brackets_close_on_smooth_peaks_kinks_and_jumps(peak, shape):
    def height(x):
        return 5.0 + shape(x - peak)

    start = 0.5 * (peak - 1.0)
    table, best = one((-1.0, height(-1.0), start, height(start), 1.0, height(1.0))), np.zeros((b.BEST_ROWS, 1))
    if height(start) < max(height(-1.0), height(1.0)):
        table[[b.XB, b.FB], 0] = peak - 1e-3, height(peak - 1e-3)
    refine(table, best, height)
    value, place, _, beyond = best[:, 0]
    assert value <= 5.0 + shape(0.0) + 1e-15
    assert 5.0 + shape(0.0) - value <= max(beyond, 1e-12)
    assert abs(place - peak) < 1e-6


@pytest.mark.parametrize("away", [0.02, 0.096 / np.sqrt(2.002), 0.2])
def test_two_equal_peaks_are_found_from_the_dip_between_them(away):
    """The second round's trials fall 0.096 from the dip, where the curve is as high as the dip if away = 0.096/√2."""

    def height(x):
        square = (x / away) ** 2
        return 5.0 + 5e-9 * square * (2.0 - square)

    table, best = one((-1.0, height(-1.0), 0.0, 5.0, 1.0, height(1.0))), np.zeros((b.BEST_ROWS, 1))
    refine(table, best, height)
    value, place, _, beyond = best[:, 0]
    assert 5.0 + 5e-9 - value <= min(beyond, 5e-11)
    assert abs(place) == pytest.approx(away, rel=1e-3)


@pytest.mark.parametrize("places", [(-0.4, 0.55), (-0.6, 0.3), (-0.35, 0.9), (-0.95, 0.2)])
@pytest.mark.parametrize("higher", [0, 1])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_of_two_tops_in_one_bracket_the_higher_one_is_found(places, higher, side):
    """The tops are so narrow that each leaves the other as it is. A bracket holds one of them alone: the first trials,
    in the valley between them, show the other, as a trial or as a rise to an end."""
    heights = 5.0 + 1e-6 * np.eye(2)[higher]

    def height(x):
        return sum(h * np.exp(-(((side * x - place) / 0.15) ** 2)) for h, place in zip(heights, places, strict=True))

    start = side * (places[1 - higher] + 0.02)
    table, best = one((-1.0, height(-1.0), start, height(start), 1.0, height(1.0))), np.zeros((b.BEST_ROWS, 1))
    table[b.WIDTH] = table[b.FIRST_WIDTH]
    refine(table, best, height)
    assert best[b.PEAK, 0] == pytest.approx(5.0 + 1e-6, rel=2e-11)
    assert best[b.PEAK_X, 0] == pytest.approx(side * places[higher], abs=1e-4)


@pytest.mark.parametrize("place", [-0.7, -0.1, 0.3, 0.8])
def test_a_bracket_whose_middle_is_unknown_keeps_both_its_sides(place):
    """The first trial always exceeds an unknown middle, on whichever side the peak may be."""

    def height(x):
        return 5.0 - (x - place) ** 2 / (1.0 + 0.3 * x)

    table, best = one((-1.0, height(-1.0), 0.0, -np.inf, 1.0, height(1.0))), np.zeros((b.BEST_ROWS, 1))
    refine(table, best, height)
    assert best[b.PEAK, 0] == pytest.approx(5.0, rel=1e-10)
    assert best[b.PEAK_X, 0] == pytest.approx(place, abs=1e-4)


def test_no_trial_lies_so_close_to_the_middle_that_rounding_alone_tells_them_apart():
    """A peak was missed where one fell 7e-7 of the width from the middle: the secant through both allowed no rise."""
    columns = 100_000
    table, middle = np.zeros((b.BRACKET_ROWS, columns)), np.linspace(-0.9, 0.9, columns)
    table[[b.XA, b.XC]], table[b.XB] = [[-1.0], [1.0]], middle
    table[[b.FA, b.FB, b.FC]] = [[-1.0], [0.0], [-1.5]]
    table[b.WIDTH], table[b.FIRST_WIDTH] = 8.0, 2.0
    b.place_trials(table, columns)
    away = np.abs(table[list(b.TRIALS)] - middle)
    assert ((away == 0.0) | (away >= b.NEARBY * 2.0)).all()
    assert (away == 0.0).any()


@pytest.mark.parametrize("joined", [True, False])
def test_searches_along_paths_have_the_same_bits_compiled_and_interpreted(joined, monkeypatch):
    x, signal = np.sort(np.random.default_rng(3).uniform(0.0, 6.0, (5, 60)), axis=1), np.arange(2.0)
    before, after = np.append(x[:, -1:] - 6.0, x[:, :-1], axis=1), np.append(x[:, 1:], x[:, :1] + 6.0, axis=1)

    def of(path, k, at):
        return np.sin((2.0 + path) * at + k) * np.exp(np.cos(at))

    def peaks(interpreted):
        monkeypatch.setattr(paths.SEARCHES, "waited", interpreted)
        table, best = np.zeros((b.BRACKET_ROWS, b.in_blocks(640))), np.zeros((b.BEST_ROWS, 10))
        rows = of(np.arange(5.0)[:, None, None], signal[:, None], x[:, None, :])
        count = paths.open_brackets(rows, x, before, after, joined, table, best)
        paths.refine(table, count, best, lambda tag, at: of(tag // 2, tag % 2, at))
        return best[[b.PEAK, b.PEAK_X, b.BEYOND]], paths.SEARCHES.waited

    (interpreted, waited), (compiled, beyond) = map(peaks, (0, paths.INTERPRETED))
    assert 0 < waited <= paths.INTERPRETED < beyond
    np.testing.assert_array_equal(compiled, interpreted)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_peak_beside_a_break_without_a_jump_is_found_on_either_side(side):
    """1 − (x + 0.3)², which rounding makes higher on the far side of a break at 0; and the same mirrored."""
    x = np.sort(side * np.array([-1.0, -1e-14, 0.0, 1.0]))[None]
    values = 1.0 - (x + side * 0.3) ** 2
    values[0, x[0] == 0.0] = values[0, 1:3].max() * (1.0 + 1e-15)
    before, after = np.append(x[:, :1] - 1e-9, x[:, :-1], axis=1), np.append(x[:, 1:], x[:, -1:] + 1e-9, axis=1)
    table, best = np.zeros((b.BRACKET_ROWS, b.in_blocks(1))), np.empty((b.BEST_ROWS, 1))
    count = paths.open_brackets(values[None], x, before, after, False, table, best)
    paths.refine(table, count, best, lambda tag, at: 1.0 - (at + side * 0.3) ** 2)
    assert best[b.PEAK, 0] == pytest.approx(1.0, rel=1e-11)
    assert best[b.PEAK_X, 0] == pytest.approx(-side * 0.3, abs=1e-5)


@pytest.mark.parametrize(
    ("joined", "start"), [(False, -3.0), *((True, start) for start in (-3.0, -1.0, 0.0, 1.6, 2.4))]
)
@pytest.mark.parametrize("turned", [1.0, -1.0])
def test_of_two_summits_the_one_between_samples_that_fall_is_found(joined, start, turned):
    """0.1·x − (x² − 1)² is −1 at 0 and −2.3 at 1.6, but higher at 1 than at −1; on a path that meets its ends, too."""
    x = np.array([-3.0, -2.0, -1.0, 0.0, 1.6, 2.4])
    x = np.sort(turned * np.where(x < start, x + 6.0, x))[None]

    def signal(_tag, at):
        at = np.mod(turned * at + 3.0, 6.0) - 3.0
        return 0.1 * at - (at**2 - 1.0) ** 2

    before, after = np.append(x[:, -1:] - 6.0, x[:, :-1], axis=1), np.append(x[:, 1:], x[:, :1] + 6.0, axis=1)
    table, best = np.zeros((b.BRACKET_ROWS, b.in_blocks(9))), np.empty((b.BEST_ROWS, 1))
    count = paths.open_brackets(signal(0, x)[None], x, before, after, joined, table, best)
    paths.refine(table, count, best, signal)
    place = max(np.polynomial.Polynomial([0.1, 4.0, 0.0, -4.0]).roots())
    assert best[b.PEAK, 0] == pytest.approx(signal(0, turned * place), rel=1e-10)


def test_slopes_of_the_cubic_through_uneven_samples():
    """At two of 0, 0.4, 1.3 and 3: those of the cubic itself, by their step."""
    cubic, at = np.polynomial.Polynomial([3.0, 1.0, -2.0, 0.7]), np.array([0.0, 0.4, 1.3, 3.0])
    slopes = uneven_slopes(*cubic(at), 0.4 / 0.9, 1.7 / 0.9)
    np.testing.assert_allclose(slopes, 0.9 * cubic.deriv()(at[1:3]), rtol=1e-12)
    assert uneven_slopes(1.0, 2.0, 4.0, 3.0, 1.0, 1.0) == pytest.approx(slopes_between(1.0, 2.0, 4.0, 3.0))
