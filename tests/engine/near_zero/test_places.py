"""Places at which signals may have a dip or a zero, against plain loops over the samples of each."""

import numpy as np
import pytest

from linksweep.engine.near_zero import places
from linksweep.engine.near_zero.samples import HALF, SPARE
from linksweep.engine.peaks.samples import HALF as HALF_OF_TURN

COUNT, COLUMNS = 24, 8


def listed(note, rows):
    """Return the places that are noted of each column, in order."""
    table = np.zeros((1, rows.shape[1]))
    with np.errstate(all="ignore"):
        note(rows.ravel(), len(rows), rows.shape[1], table)
    digits = []
    for noted in table[places.NOTES]:
        assert noted < places.TOO_MANY
        digits.append([])
        while noted >= 1.0:
            place, noted = places.next_place(noted, 0)
            digits[-1].insert(0, place)
    return digits


def smooth_samples(seed):
    """Return samples of curves with a few extremes and zeros each, some without a value, some equal to the next."""
    random = np.random.default_rng(seed)
    angles = np.linspace(0.0, 6.0, COUNT)[:, None] + random.uniform(0.0, 6.0, COLUMNS)
    rows = np.sin(angles) + random.uniform(-1.2, 1.2, COLUMNS)
    rows[random.random(rows.shape) < 0.02] = np.nan
    ties = random.random(rows.shape) < 0.04
    return np.where(ties, np.roll(rows, 1, axis=0), rows)


@pytest.mark.parametrize("seed", range(20))
def test_each_dip_is_noted(seed):
    """Neighbours of the other sign lie beyond zero, and below it."""
    rows = smooth_samples(seed)
    for column, noted in zip(rows.T, listed(places.note_dips, rows), strict=True):
        for j in range(SPARE, COUNT - SPARE):
            before, here, after = column[j - 1 : j + 2] * (1.0 if column[j] > 0.0 else -1.0)
            if here <= before and here < after:
                assert j in noted
            elif not np.isnan(column[j - 1 : j + 2]).any():
                assert j not in noted


@pytest.mark.parametrize("seed", range(20))
def test_each_change_of_sign_is_noted(seed):
    rows = smooth_samples(seed)
    for column, noted in zip(rows.T, listed(places.note_crossings, rows), strict=True):
        changes = 1 + np.flatnonzero(np.diff(column < 0.0))
        assert [j for j in noted if j > 0] == changes.tolist()


def test_a_digit_holds_every_place_of_a_piece():
    assert 2 * (max(HALF, HALF_OF_TURN) + SPARE) + 1 < places.BASE


def test_more_places_than_a_number_holds_are_all_looked_at():
    rows = np.where(np.arange(COUNT) % 2, 1.0, -1.0)[:, None]
    table = np.zeros((1, 1))
    places.note_crossings(rows.ravel(), COUNT, 1, table)
    assert table[0, 0] >= places.TOO_MANY
    looked_at = [places.next_place(table[0, 0], step)[0] for step in range(COUNT - 2 * SPARE)]
    assert looked_at == list(range(SPARE, COUNT - SPARE))
    assert places.next_place(table[0, 0], 3)[1] == table[0, 0]
