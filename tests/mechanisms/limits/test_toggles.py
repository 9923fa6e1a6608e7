"""Near toggles no digit is lost: forces against 60-digit arithmetic, cosines and pairs of numbers against exact ones.

A toggle's angle is known to 60 digits, so that it can be approached from 1e-1 to 1e-9 rad. Errors are relative to the
largest force of the sample.
"""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

import numpy as np
import oracle_inverted_slider_crank as inverted
import oracle_slider_crank as slider
import pytest
import xarray as xr
from oracle import FourBarData, random_data, solve, to_scene
from references import LinkData, largest_force, mp

import linksweep as ls
from linksweep.base.degrees import cos_sin_low_words
from linksweep.physics.algebra import double_double as pairs

FORCES = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y")
AWAY = [10.0**-k for k in (1, 3, 5, 6, 7, 8, 9)]
"""From a toggle [rad]."""
EPS = 2.0**-52


def force_error(data, angles: list[float], solve=solve, to_scene=to_scene, names=FORCES) -> float:
    """Largest error of a force over the angles, relative to the sample's largest; all of them must be ok."""
    cycle = ls.sweep(to_scene(data), angles, of=names)
    assert not cycle.status.any(), cycle.status.values
    values = {name: cycle[name].broadcast_like(cycle.theta2).values.tolist() for name in names}
    worst = 0.0
    for k, angle in enumerate(angles):
        exact = solve(data, angle)
        errors = [abs(mp.mpf(values[name][k]) - exact[name]) for name in names]
        worst = max(worst, float(max(errors) / largest_force(exact)))
    return worst


def near(cosine, middle: float, inwards: int, away: list[float] = AWAY) -> Iterator[float]:
    """Return angles [degree] inside both toggles at which the crank's cosine from the middle has this value, if any."""
    if abs(cosine) < 1:
        toggle = mp.acos(cosine)
        for side in (1, -1):
            yield from (float(middle + side * mp.degrees(toggle + inwards * mp.mpf(x))) for x in away)


def near_four_bar_toggles(data: FourBarData) -> list[float]:
    a, b, c, d = map(mp.mpf, (data.crank.length, data.coupler.length, data.rocker.length, data.ground))
    cosines = [((a**2 + d**2 - f**2) / (2 * a * d), inwards) for f, inwards in ((b + c, -1), (b - c, 1))]
    return [angle for cosine, inwards in cosines for angle in near(cosine, data.ground_angle, inwards)]


@pytest.mark.parametrize("ground_angle", [0.0, 33.3, -171.7])
@pytest.mark.parametrize(("seed", "kind"), [(0, "triple_rocker"), (1, "triple_rocker"), (2, "double_rocker")])
def test_forces_of_a_four_bar_keep_their_digits_near_a_toggle(seed, kind, ground_angle):
    """Reached: 1e-14 at every distance; cosines of 53 bits would lose 8e-10 at 1e-6 rad, 2e-6 at 1e-9 rad."""
    data = random_data(np.random.default_rng(seed), kind=kind, drive="crank", scale=1.0, loads=1)
    data = replace(data, ground_angle=ground_angle)
    angles = near_four_bar_toggles(data)
    assert len(angles) >= 2 * len(AWAY)
    assert force_error(data, angles) < 1e-13


def triangle(largest: float) -> FourBarData:
    """Folded over its rocker, the coupler reaches D at ψ = 60°: a number that the angle itself does not have."""
    links = (LinkData(length, 1.0, 0.1, cg_distance=0.3 * length, cg_angle=20.0) for length in (2.0, 5.0, largest))
    return FourBarData(*links, ground=2.0, omega2=3.0, gravity=(0.0, -9.81))


def test_a_toggle_at_a_round_angle_is_one():
    """f = |b − c| = 2 at exactly 60 and 300 degrees; the next angles on the one side are ok, on the other cannot be."""
    scene = to_scene(triangle(3.0))
    at, above, below = (list(np.nextafter([60.0, 300.0], towards)) for towards in ([60.0, 300.0], 180.0, [0.0, 360.0]))
    status = ls.sweep(scene, at, of="status").status
    assert status.values.tolist() == [2, 2]
    beside = 1e-12 * np.array([1.0, -1.0])
    assert ls.sweep(scene, list(at + beside), of="status").status.values.tolist() == [0, 0]
    assert ls.sweep(scene, list(at - beside), of="status").status.values.tolist() == [1, 1]
    assert ls.sweep(scene, [*above, *below], of="status").status.values.tolist() == [2] * 4


@pytest.mark.parametrize("turn", [0.0, 12.5])
@pytest.mark.parametrize("offset", [0.0, 0.03])
def test_forces_of_a_slider_crank_keep_their_digits_near_a_toggle(turn, offset):
    links = (LinkData(0.3, 0.5, 2e-3, 0.1, 25.0), LinkData(0.2, 0.4, 1e-3, 0.07, -10.0))
    data = slider.SliderCrankData(*links, slider_mass=0.6, offset=offset, slide_angle=turn, omega2=20.0, alpha2=3.0)
    a, b, e = mp.mpf(0.3), mp.mpf(0.2), mp.mpf(offset)
    upright = turn + 90.0
    angles = [*near((e + b) / a, upright, 1), *near((e - b) / a, upright, -1)]
    assert len(angles) == 4 * len(AWAY)
    assert force_error(data, angles, slider.solve, slider.to_scene) < 1e-13


@pytest.mark.parametrize("turn", [0.0, -25.0])
def test_forces_of_an_inverted_slider_crank_keep_their_digits_near_a_toggle(turn):
    links = {"crank": LinkData(0.3, 0.5, 2e-3, 0.1, 25.0), "rocker": LinkData(0.7, 0.4, 1e-3, 0.07, -10.0)}
    data = inverted.InvertedSliderCrankData(
        **links, ground=0.36, offset=0.2, block_mass=0.3, block_inertia=1e-3, ground_angle=turn, omega2=20.0
    )
    a, d, e = mp.mpf(0.3), mp.mpf(0.36), mp.mpf(0.2)
    angles = list(near((a**2 + d**2 - e**2) / (2 * a * d), turn, 1))
    assert len(angles) == 2 * len(AWAY)
    names = ("F12x", "F12y", "F32x", "F32y", "F14x", "F14y")
    assert force_error(data, angles, inverted.solve, inverted.to_scene, names) < 1e-13


# ---- cosines to 90 bits -----


def angles_of_all_sizes() -> np.ndarray:
    rng = np.random.default_rng(4)
    small = rng.uniform(-1.0, 1.0, 200) * 10.0 ** rng.uniform(-12.0, 0.0, 200)
    middles = rng.choice([0.0, 45.0, 90.0, 180.0, -270.0], 200)
    return np.concatenate([rng.uniform(-720.0, 720.0, 500), small, middles + small])


def test_cosines_and_sines_with_their_rests_against_60_digits():
    angles = angles_of_all_sizes()
    cos, sin, cos_lo, sin_lo = cos_sin_low_words(angles)
    for k, angle in enumerate(angles.tolist()):
        turn = mp.expjpi(mp.mpf(angle) / 180)
        for exact, high, rest in ((turn.real, cos[k], cos_lo[k]), (turn.imag, sin[k], sin_lo[k])):
            assert abs(exact - mp.mpf(float(high)) - mp.mpf(float(rest))) < 2.0**-87, angle
            assert abs(float(exact) - high) <= np.spacing(abs(high)), angle
            assert abs(rest) <= 0.51 * np.spacing(abs(high)), angle


def test_one_minus_a_cosine_is_known_to_the_last_digit():
    for angle in 10.0 ** np.linspace(-12.0, 1.5, 60):
        cos, _, rest, _ = cos_sin_low_words(float(angle))
        lacks = 1 - mp.cospi(mp.mpf(float(angle)) / 180)
        assert abs((1.0 - cos) - rest - lacks) < 4.0 * EPS * lacks


def test_round_angles_have_no_lo():
    assert [cos_sin_low_words(angle) for angle in (0.0, 90.0, 180.0, -90.0)] == [
        (1.0, 0.0, 0.0, 0.0),
        (0.0, 1.0, 0.0, 0.0),
        (-1.0, 0.0, 0.0, 0.0),
        (0.0, -1.0, 0.0, 0.0),
    ]
    assert cos_sin_low_words(60.0)[0] == 0.5
    assert cos_sin_low_words(1e6 * 360.0 + 30.0)[1] == 0.5


# ---- pairs of numbers -----


def drawn(count: int) -> list[float]:
    rng = np.random.default_rng(5)
    numbers = rng.uniform(-1.0, 1.0, count) * 10.0 ** rng.integers(-9, 10, count)
    return [*numbers.tolist(), 0.0, 1.0, -1.0, 1.0 / 3.0]


def exactly(pair: tuple[float, float]) -> Fraction:
    return Fraction(pair[0]) + Fraction(pair[1])


def test_sums_and_products_of_two_numbers_are_exact():
    numbers = drawn(60)
    for x in numbers:
        for y in numbers:
            assert exactly(pairs.two_sum(x, y)) == Fraction(x) + Fraction(y)
            assert exactly(pairs.two_product(x, y)) == Fraction(x) * Fraction(y)
            assert pairs.two_sum(x, y)[0] == x + y
            assert pairs.two_product(x, y)[0] == x * y
            if abs(x) >= abs(y) or x == 0.0:
                assert exactly(pairs.ordered_sum(x, y)) == Fraction(x) + Fraction(y)


def test_pairs_keep_twice_the_digits():
    numbers = drawn(40)
    some = [pairs.ordered_sum(x, 0.3 * EPS * x) for x in numbers]
    for p, q in zip(some, reversed(some), strict=True):
        x, y = exactly(p), exactly(q)
        bound = Fraction(2.0**-100)
        assert abs(exactly(pairs.add(p, q)) - (x + y)) <= bound * (abs(x) + abs(y))
        assert abs(exactly(pairs.multiply(p, q)) - x * y) <= bound * abs(x * y)
        assert abs(exactly(pairs.dot(p, q, q, p)) - 2 * x * y) <= bound * abs(x * y)
        assert abs(Fraction(pairs.cross(p, q, p, q))) <= bound * abs(x * y)
        if y:
            assert abs(exactly(pairs.divide(p, q)) - x / y) <= bound * abs(x / y)


def test_a_difference_that_cancels_keeps_its_digits():
    """Two numbers that agree in all 53 bits, and differ beyond."""
    p, q = (1.0 / 3.0, 3e-20), (1.0 / 3.0, 1e-20)
    assert pairs.difference(p, q) == pytest.approx(2e-20, rel=1e-15)
    assert pairs.cross(p, (1.0, 0.0), q, (1.0, 0.0)) == pytest.approx(2e-20, rel=1e-15)


# ---- lengths at the ends of what a number can hold -----


@pytest.mark.parametrize("length", [1e-160, 1e-200, 1e-300, 1e-310])
@pytest.mark.parametrize("role", ["crank", "ground"])
def test_lengths_whose_squares_underflow_are_toggles(role, length):
    scene = ls.Scene(replace(ls.example("press").mechanism, **too_short(role, length)), omega2=30.0)
    cycle = ls.sweep(scene, 4)
    assert cycle.status.attrs["flag_meanings"].split()[2] == "toggle"
    assert cycle.status.values.tolist() == [2, 2, 2, 2]
    assert np.isnan(cycle.F32x).all() and int(ls.peaks(scene).status) != 0


def too_short(role, length) -> dict:
    return {role: length if role == "ground" else ls.Link(length, 0.2, 1e-4)}


@pytest.mark.parametrize("length", [1e-300, 1e-160, 1e160, 1e300])
def test_a_rod_beyond_all_sizes(length):
    engine = ls.SliderCrank(ls.Link(0.05, 0.2, 1e-4), ls.Link(length, 0.2, 1e-4), slider_mass=0.5)
    cycle = ls.sweep(ls.Scene(engine, 30.0), 7)
    assert (cycle.status != 0).all() and int(ls.peaks(ls.Scene(engine, 30.0)).status) != 0


def test_a_derived_number_that_overflows_is_refused():
    bar = ls.Bar(1e120, 0.02, 0.02, 7750.0)
    with pytest.raises(ValueError, match=r"^rod: its moment of inertia is more than a number can hold"):
        ls.SliderCrank(ls.Link(0.05, 0.2, 1e-4), bar, slider_mass=0.5)
    gas = ls.GasPressure(bore=1.7e308, pressure=1e5)
    with pytest.raises(ValueError, match=r"^loads\[1\].bore: its square is more than a number can hold"):
        ls.Scene(ls.example("engine").mechanism, omega2=30.0, loads=[gas])


def test_a_machine_that_closes_at_one_angle_only():
    """Coupler and rocker reach the crank's end where it points to D, and there only: a toggle, without a warning."""
    links = (ls.Link(length, 1.0, 0.01) for length in (0.25, 0.125, 0.125))
    peaks = ls.peaks(ls.Scene(ls.FourBar(*links, ground=0.5), omega2=30.0))
    assert np.isnan(peaks.F32_peak) and int(peaks.status) == 1


def test_a_linkage_that_hardly_moves_is_sampled_for_its_toggles():
    turn, crank = np.radians(123.0), 1e-12
    links = {
        role: ls.Link(x, 1.0, 0.01)
        for role, x in zip(("crank", "coupler", "rocker"), (crank, 1.3 - crank, 0.3), strict=True)
    }
    pins = {"A": (0.0, 0.0), "D": (np.cos(turn), np.sin(turn))}
    scene = ls.Scene(ls.Linkage("crank A-B, coupler B-C, rocker D-C", ground=pins, **links), 5.0)
    assert (ls.sweep(scene, 720).status > 0).any() and ls.peaks(scene).status == 1


def test_a_yoke_along_its_guide_is_in_a_toggle_at_every_angle():
    parts = {
        "crank": ls.Link(0.08, 1.0, 0.01),
        "yoke": ls.Slider(2.0, slot_angle=xr.DataArray([0.0, 90.0, 1e-14, 45.0], dims="design")),
    }
    machine = ls.Linkage(
        "crank A-B, yoke on slide past B", ground={"A": (0.0, 0.0)}, guides={"slide": ls.Guide(angle=10.0)}, **parts
    )
    peaks = ls.peaks(ls.Scene(machine, 5.0), of=["F12"])
    assert peaks.status.values.tolist() == [2, 0, 2, 0]
    np.testing.assert_array_equal(np.isnan(peaks.F12_peak), peaks.status > 0)
