"""Dips, zeros and flat places of known functions of the angle, wherever pieces of the turn end."""

import numpy as np
import pytest

from linksweep.engine.near_zero import dips, samples, search
from linksweep.engine.peaks.samples import grades
from linksweep.engine.peaks.zeros import ZERO_ROWS

BORDER = 2.0 * np.arctan(samples.BORDER)
ANGLES = [0.0, 0.3, 0.5 * np.pi, BORDER, BORDER + 0.004, np.pi, 4.0, 1.5 * np.pi, BORDER + np.pi - 1e-13]
NOISE = 1e-15


def near_zero(height, kind, cuts=(), noise=NOISE):
    """Return angles [rad] and half-widths of what is found of a function, on pieces that end at cuts as well: angles
    and half-widths; and whether it is left."""

    def values(angle):
        signal = height(angle)
        return np.stack([signal, -signal, signal + 100.0 * noise])

    def prepare(first, designs, sizes, parameters, parameter_at, constants):
        constants[:] = 1.0

    def sample(constants, x, rows):
        places, half = x.reshape(2, -1)
        rows[: 3 * len(places)] = values(2.0 * np.arctan(places) + np.pi * half).T.ravel()

    def evaluate(constants, table, x, value, far, signal, first, last):
        at = table[:, first:last]
        at[value] = np.choose(at[signal].astype(int), values(2.0 * np.arctan(at[x]) + np.pi * at[far]))

    ends = np.array(sorted([(place, 1.0) for place in samples.ENDS] + [(place_of(a), width) for a, width in cuts]))
    half = samples.HALF if len(cuts) else 24
    places, one = 2 * (half + samples.SPARE) + 1, np.ones(1, dtype=np.int64)
    events, left = np.full((samples.EVENT_ROWS, 1, samples.MOST), np.nan), np.zeros(1)
    with np.errstate(all="ignore"):
        search.find_near_zero(
            0, 1, 1, 1, one, np.zeros(1), 0 * one, grades(half, samples.EVENLY), prepare, lambda *_: None, sample,
            evaluate, np.zeros((1, 2)), np.zeros(2 * places), np.zeros(3 * places), ends.T[:, None, :],
            np.array([kind]), *np.zeros((2, 1, 1)), np.zeros((dips.DIP_ROWS, samples.MOST)), 0 * one,
            np.zeros((ZERO_ROWS, samples.MOST)), 0 * one, events, left,
        )  # fmt: skip
    place, far, _, width = events[:, 0, np.isfinite(events[0, 0])]
    assert ((place >= samples.ENDS[0]) & (place <= samples.BORDER)).all()
    return 2.0 * np.arctan(place) + np.pi * far, width, left[0] > 0.0


def place_of(angle):
    angle = np.mod(angle + np.pi - BORDER, 2.0 * np.pi) - np.pi + BORDER
    return np.tan(0.5 * (angle - np.pi)) + samples.FAR_HALF if angle > BORDER else np.tan(0.5 * angle)


def away(angles, middle):
    return np.mod(angles - middle + np.pi, 2.0 * np.pi) - np.pi


@pytest.mark.parametrize("middle", ANGLES)
@pytest.mark.parametrize("cut", [(), (0.0, 1e-3), (1e-4, 1e-3), (-3e-3, 1e-6)])
def test_one_narrow_dip_and_its_half_width(middle, cut):
    """x cos²(ψ/2) + y sin²(ψ/2) is 2x at tan(ψ/2) = √(x/(y − 2x))."""
    x, y = 1e-6, 1.0
    cuts = [(middle + cut[0], cut[1])] if cut else []
    angles, widths, left = near_zero(
        lambda angle: x * np.cos(0.5 * (angle - middle)) ** 2 + y * np.sin(0.5 * (angle - middle)) ** 2,
        dips.TOGGLE,
        cuts,
    )
    assert not left and len(angles) == 1
    np.testing.assert_allclose(away(angles, middle), 0.0, atol=1e-8)
    np.testing.assert_allclose(widths, np.sqrt(x / (y - 2.0 * x)), rtol=1e-5)


@pytest.mark.parametrize("middle", ANGLES)
@pytest.mark.parametrize("kind", [dips.TOGGLE, dips.BOUND, dips.JUMP])
def test_both_zeros_beside_a_dip_that_lies_between_samples(middle, kind):
    for depth, cuts in ((1e-6, []), (1e-6, [(middle, 1e-3)]), (0.5, [(middle, 1e-5)])):
        angles, widths, left = near_zero(lambda angle, depth=depth: 1.0 - np.cos(angle - middle) - depth, kind, cuts)
        expected = np.arccos(1.0 - depth)
        zeros = np.sort(away(angles[widths == 0.0], middle))
        np.testing.assert_allclose(zeros, [-expected, expected], atol=1e-9)
        assert not left


@pytest.mark.parametrize("zero", ANGLES)
def test_a_zero_where_a_piece_ends_is_found_once(zero):
    for cuts in ([], [(zero, 1e-9)], [(zero - 1e-12, 1e-9), (zero + 3e-12, 1e-3)]):
        angles, widths, left = near_zero(lambda angle: np.sin(0.5 * away(angle, zero)), dips.JUMP, cuts)
        angles = angles[np.abs(away(angles, zero)) < 3.0]  # the sine of half the angle jumps opposite
        np.testing.assert_allclose(away(angles, zero), 0.0, atol=1e-13)
        assert len(angles) == 1 and not left and (widths == 0.0).all()


@pytest.mark.parametrize("middle", ANGLES)
@pytest.mark.parametrize("tilt", [0.0, 4.0, -4.0])
def test_three_zeros_between_two_samples_are_found_at_the_second_look(middle, tilt):
    """Also of a signal that is steeper on one side of them."""

    def height(angle):
        sine = np.sin(0.5 * away(angle, middle))
        return sine * (sine * sine - 1e-4) * np.cos(0.5 * away(angle, middle)) * (1.0 + tilt * sine)

    angles, widths, _ = near_zero(height, dips.JUMP)
    zeros, flat = away(angles[widths == 0.0], middle), angles[widths < 0.0]
    assert np.sum(np.abs(zeros) < 0.1) == 3 or len(flat)
    angles, widths, _ = near_zero(height, dips.JUMP, [(at, 1e-3) for at in flat])
    zeros = np.sort(away(angles[widths == 0.0], middle))
    np.testing.assert_allclose(
        zeros[np.abs(zeros) < 0.1], [-2.0 * np.arcsin(0.01), 0.0, 2.0 * np.arcsin(0.01)], atol=1e-12
    )


@pytest.mark.parametrize("mirrored", [False, True])
def test_three_zeros_that_samples_show_as_one_beside_a_toggle(mirrored):
    """Two samples on one side of zero have the first two of them between them, the third is beyond the second: the
    signal falls steeply there, and samples are graded about the toggle, where a piece ends."""
    zeros, toggle, side = np.array([0.0350, 0.0479, 0.0626]), 2.2, -1.0 if mirrored else 1.0
    for scale in np.geomspace(0.2, 2.0, 60):

        def height(angle, scale=scale):
            x = side * away(angle, toggle)
            signal = np.prod([np.tan(0.5 * x) - np.tan(0.5 * zero) for zero in scale * zeros], axis=0)
            return np.where((x > 0.0) & (x < 2.0), signal / np.tan(0.5 * x) ** 2, np.nan)

        cuts = [(toggle, 0.0)]
        for _ in range(3):
            angles, widths, left = near_zero(height, dips.BOUND, cuts)
            cuts += [(at, 1e-3) for at in angles[widths < 0.0]]
        places = np.sort(side * away(angles[widths == 0.0], toggle))
        np.testing.assert_allclose(places, scale * zeros, rtol=1e-9)
        assert not left


def test_two_dips_between_two_samples_are_found_at_the_second_look():
    def height(angle):
        return (np.sin(0.5 * (angle - 1.0)) ** 2 - 1e-4) ** 2 + 1e-12

    angles, widths, _ = near_zero(height, dips.TOGGLE)
    assert (widths < 0.0).any()
    angles, widths, _ = near_zero(height, dips.TOGGLE, [(at, 1e-3) for at in angles[widths < 0.0]])
    expected = 1.0 + 2.0 * np.arcsin(0.01) * np.array([-1.0, 1.0])
    np.testing.assert_allclose(np.sort(angles[widths > 0.0]), expected, atol=1e-6)


def test_the_first_look_finds_both_of_two_dips_or_notes_a_flat_place():
    for apart in np.arange(0.012, 0.1, 0.008):
        sine = np.sin(0.25 * apart)
        for middle in np.linspace(0.3, 0.6, 24):

            def height(angle, middle=middle, sine=sine):
                return (np.sin(0.5 * (angle - middle)) ** 2 - sine * sine) ** 2 + 3.6e-5 * sine * sine

            angles, widths, left = near_zero(height, dips.TOGGLE)
            expected = middle + 0.5 * apart * np.array([-1.0, 1.0])
            both = [np.abs(away(angles[widths > 0.0], at)).min() < 1e-6 for at in expected]
            assert not left and (all(both) or (widths < 0.0).any())


def test_more_dips_and_zeros_on_a_half_turn_than_are_noted_apart_are_all_found():
    """Ten and nine on each half turn."""
    for height, kind, expected in (
        (lambda angle: 1e-3 + 1.0 - np.cos(20.0 * angle), dips.TOGGLE, np.radians(18.0) * np.arange(20)),
        (lambda angle: np.sin(9.0 * angle), dips.JUMP, np.radians(20.0) * np.arange(18)),
    ):
        angles, _, left = near_zero(height, kind)
        np.testing.assert_allclose(np.sort(np.mod(angles + 0.1, 2.0 * np.pi)), expected + 0.1, atol=1e-6)
        assert not left


def test_rounding_makes_no_dips():
    random = np.random.default_rng(1)

    def height(angle):
        return 1e-3 + np.sin(0.5 * (angle - 1.0)) ** 2 + 1e-9 * random.uniform(-1.0, 1.0, np.shape(angle))

    cuts = [(1.0, 1e-7), (1.0 + 1e-9, 1e-7), (2.0, 1e-8)]
    angles, _, left = near_zero(height, dips.TOGGLE, cuts, noise=1e-9)
    np.testing.assert_allclose(away(angles, 1.0), 0.0, atol=1e-3)
    assert len(angles) <= 2 and not left


@pytest.mark.parametrize("least", [-1e-14, 0.0, 1e-14])
def test_designs_that_touch_zero_but_for_noise_are_left(least):
    assert near_zero(lambda angle: least + np.sin(0.5 * (angle - 1.0)) ** 2, dips.TOGGLE)[2]


def test_a_dip_where_the_machine_does_not_close_is_no_near_toggle():
    angles, _, left = near_zero(lambda angle: -1e-6 - np.sin(0.5 * (angle - 1.0)) ** 2, dips.TOGGLE)
    assert not len(angles) and not left


def test_what_ends_at_a_toggle_is_found_up_to_there():
    """Beyond a toggle at 1 rad another part varies as the root of the angle from there: its zero lies close to it."""
    for away in (1e-9, 1e-6, 1e-3, 0.5):

        def height(angle, away=away):
            return np.sqrt(np.sin(0.5 * (angle - 1.0))) - np.sqrt(np.sin(0.5 * away))

        angles, widths, left = near_zero(height, dips.TOGGLE, [(1.0, 0.0)])
        near = angles[np.abs(angles - 1.0) < 1.0]
        np.testing.assert_allclose(near - 1.0, away, rtol=1e-5)
        assert len(near) == 1 and not left and (widths == 0.0).all()
