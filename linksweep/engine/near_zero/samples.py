"""Place samples on pieces of a turn, as dense about their ends as near-toggles there are narrow, and note events.

A turn has two half turns. A place on one is the tangent of half the angle from its middle; the middle of the second one
is `FAR_HALF`, so that places go on from one half turn to the other.

    samples = rows, x, places, columns, lanes, lane      a lane's samples: signals, `columns` of them at each place, and
                                                         the places, then their half turns
    results = events, left                               dips, zeros and flat places of designs, and 1 for those that
                                                         are left

All is plain Python that is translated to machine code.
"""

from linksweep.engine.peaks.on_pieces import largest_count
from linksweep.engine.peaks.samples import grade

HALF, EVENLY = 40, 0.4
"""Samples on either side of the middle of a piece of a turn that is divided at near-toggles, and the share of them that
are spread evenly: they lie no farther apart than those of a turn that is not."""
SPARE, FARTHER = 2, 8
"""Samples beyond either end of a piece, and how many steps from there the farther one lies; the other lies one away."""
BORDER = 1.0837
"""Tangent at the end of a half turn: off round angles, where machines have their toggles, and signals their zeros."""
FAR_HALF = BORDER + 1.0 / BORDER
ENDS = (-1.0 / BORDER, BORDER, FAR_HALF + BORDER)
"""Places of the ends of half turns."""
AT, AT_WIDTH = range(2)
"""Rows of ends of pieces (row, design, nth), in order: their places, and the half-widths of near-toggles there, 0 of
toggles."""
INSIDE = 1e-11
"""Distance of the first sample of a piece from a toggle at its end, relative to half of its length."""
PLACE, HALF_TURN, NUMBER, HALF_WIDTH = range(4)
"""Rows of events (row, design, nth): tangent, half turn and number of the signal; half-width of a dip, 0 of a zero,
and −1 times that of a flat place."""
EVENT_ROWS = 4
MOST = 24
"""Events of a design, dips that are refined, and zeros, at most."""
SAME_ZERO = 1e-10
"""Distance of two zeros that are one."""
NOISE_SHARE = 0.04
"""Noise of a sample, in units of that for which its upper bound allows."""


def place_samples(ends, owner, nth, lanes, lane, places, grades, x):
    """Place the samples of a piece, and more beyond its ends; return 1, or 0 where a design has no such piece."""
    start, end, steps = ends[AT, owner, nth], ends[AT, owner, nth + 1], grades.shape[1] - 1
    if end != end:
        return 0
    half = 1.0 if start >= BORDER else 0.0
    start, end = start - half * FAR_HALF, end - half * FAR_HALF
    reach = 0.5 * (end - start)
    near, far = grade(ends[AT_WIDTH, owner, nth], reach), grade(ends[AT_WIDTH, owner, nth + 1], reach)
    for k in range(steps + 1):
        x[(SPARE + k) * lanes + lane] = start + reach * grades[near, k]
    for k in range(steps + 1):
        x[(places - 1 - SPARE - k) * lanes + lane] = end - reach * grades[far, k]
    if ends[AT_WIDTH, owner, nth] == 0.0:
        x[SPARE * lanes + lane] = start + reach * INSIDE
    if ends[AT_WIDTH, owner, nth + 1] == 0.0:
        x[(places - 1 - SPARE) * lanes + lane] = end - reach * INSIDE
    for k, step in ((0, FARTHER), (1, 1)):
        x[k * lanes + lane] = start - reach * grades[near, step]
        x[(places - 1 - k) * lanes + lane] = end + reach * grades[far, step]
    for k in range(places):
        x[(places + k) * lanes + lane] = half
    return 1


def sample(samples, j, signal):
    """Return a sample of a signal."""
    rows, _x, _places, columns, lanes, lane = samples
    return rows[j * columns + signal * lanes + lane]


def place(samples, j):
    """Return where a sample lies."""
    _rows, x, _places, _columns, lanes, lane = samples
    return x[j * lanes + lane]


def upper_bound(samples, j, signal, signals):
    """Return the highest value that a signal may have at a sample: the third of its signals, after the opposites."""
    return sample(samples, j, signal + 2 * signals)


def noise(samples, j, signal, signals):
    """Return the noise of a sample."""
    return NOISE_SHARE * (upper_bound(samples, j, signal, signals) - sample(samples, j, signal))


def note(results, owner, tangent, half, signal, width):
    """Note an event of a design after those that are known, on the half turn that has its place.

    A zero is noted once: that of a dip at the end of a piece may be known from the next piece.
    """
    (events, left), nth, known = results, 0, False
    if tangent < ENDS[0] or tangent > BORDER:
        tangent, half = -1.0 / tangent, 1.0 - half
    while nth < MOST and events[PLACE, owner, nth] == events[PLACE, owner, nth]:
        if width == 0.0 and events[HALF_WIDTH, owner, nth] == 0.0 and events[NUMBER, owner, nth] == signal:
            away = abs(events[PLACE, owner, nth] - tangent)
            known = known or (events[HALF_TURN, owner, nth] == half and away < SAME_ZERO)
        nth += 1
    if nth == MOST and not known:
        left[owner] = 1.0
    if nth < MOST and not known:
        events[PLACE, owner, nth], events[HALF_TURN, owner, nth] = tangent, half
        events[NUMBER, owner, nth], events[HALF_WIDTH, owner, nth] = float(signal), width


def used_columns(counts, lanes):
    """Return the number of columns that hold the counted ones of all lanes: the nth of a lane is in n·lanes + lane."""
    return largest_count(counts, 0, lanes) * lanes
