"""Open brackets about all places where a signal may have its peak, where trials about the best summit do not settle it.

All is plain Python that is translated to machine code.
"""

import math

from linksweep.engine.peaks.brackets import BEYOND, NOISE, PEAK, PEAK_FAR, PEAK_X, RISE, open_bracket


def open_brackets(samples, signal, lane, known, even, close, tag, brackets, count, best):
    """Open brackets about all summits of a signal that may exceed its peak so far, that of the `known` summit, or else
    its highest sample (−1: none is known); return their number. `even` signals are the same on both halves. A `close`
    look also finds summits between neighbours, where samples may lie too far apart.

    Samples are a row for each place, the places, the samples on either side of the middle of each half turn, and the
    numbers of lanes and of columns, those of all signals.
    """
    (_rows, x, half, lanes, _columns), confirmed = samples, known >= 0
    column = signal * lanes + lane
    if not confirmed:
        note_highest(samples, column, tag, best)
    top = best[PEAK, tag]
    if not abs(top) < math.inf:
        return count
    first, last = (half, 3 * half) if even else (0, 4 * half - 1)
    before = sample_of(samples, first - 2, column)
    left, value = sample_of(samples, first - 1, column), sample_of(samples, first, column)
    for j in range(first, last + 1):
        right = sample_of(samples, j + 1, column)
        stands = left < value and value >= right
        if close or (stands and j != known):
            floor = noise(left, value, right)
            least = top + (RISE * abs(top) if confirmed else 10.0 * floor)
            far = j // (2 * half)
            at = (j + 2 * far) * lanes + lane
            start, middle, end = (x[at], left), (x[at + lanes], value), (x[at + 2 * lanes], right)
            if stands and j != known and might_reach(left, value, right, 1.0) > least:
                open_bracket(brackets, count, start, middle, end, far, signal, tag, floor)
                count += 1
            if close and (j > first or not even) and might_reach_between(before, left, value, right) > least:
                unknown = 0.5 * (x[at] + x[at + lanes]), -math.inf
                open_bracket(brackets, count, start, unknown, middle, far, signal, tag, floor)
                count += 1
        before, left, value = left, value, right
    return count


def note_highest(samples, column, tag, best):
    """Write the highest sample of a signal as its peak so far."""
    rows, x, half, lanes, columns = samples
    top, at = -math.inf, 0
    for j in range(4 * half):
        if rows[j * columns + column] > top:
            top, at = rows[j * columns + column], j
    floor = noise(sample_of(samples, at - 1, column), top, sample_of(samples, at + 1, column))
    best[PEAK, tag], best[BEYOND, tag] = top if top > -math.inf else math.nan, 10.0 * floor
    far = at // (2 * half)
    best[PEAK_X, tag], best[PEAK_FAR, tag] = x[(at + 1 + 2 * far) * lanes + column % lanes], far


def might_reach(left, value, right, ratio):
    """Return an upper estimate of the peak about a sample above its neighbours: add the rises that both extended
    secants allow. The right neighbour is `ratio` times as far away as the left one."""
    return value + ((value - left) * ratio + (value - right) / ratio)


def noise(left, value, right):
    """Return the rounding noise of a signal about a sample, by its size there: elsewhere it may tend to −∞."""
    return NOISE * max(abs(left) if left > -math.inf else 0.0, abs(value), abs(right) if right > -math.inf else 0.0)


def might_reach_between(before, left, value, right):
    """Return the height that a summit between two samples may reach, by tangents of the cubic through four; −inf where
    it does not turn, or where the secants about the higher sample allow as much."""
    return by_tangents(before, left, value, right, slopes_between(before, left, value, right), 1.0, 1.0)


def by_tangents(before, left, value, right, slopes, back, ahead):
    """Return `might_reach_between` from the slopes of the cubic at two samples, by the step between them; the outer
    ones are `back` and `ahead` times as far away."""
    rise, fall = slopes
    if left < value:
        outer, beside, top, beyond, from_beside, from_top = before, left, value, right, left + rise, value - fall
        ratio = ahead
    else:
        outer, beside, top, beyond, from_beside, from_top = right, value, left, before, value - fall, left + rise
        ratio = back
    if not (outer < beside < top < from_top):
        return -math.inf
    if top < beyond:
        return from_beside
    return from_top if might_reach(beside, top, beyond, ratio) < from_top else -math.inf


def slopes_between(before, left, value, right):
    """Return the slopes of the cubic through four samples at the two in the middle, by their step."""
    at_left = (6.0 * value - 3.0 * left - 2.0 * before - right) / 6.0
    return at_left, (before + 2.0 * right + 3.0 * value - 6.0 * left) / 6.0


def uneven_slopes(before, left, value, right, back, ahead):
    """Return `slopes_between` where the outer samples are `back` and `ahead` times as far away."""
    first, middle, last = (left - before) / back, value - left, (right - value) / ahead
    bend, next_bend = (middle - first) / (back + 1.0), (last - middle) / (1.0 + ahead)
    third = (next_bend - bend) / (back + 1.0 + ahead)
    return first + back * (bend - third), last - ahead * (next_bend + third)


def sample_of(samples, j, column):
    """Return a sample of one signal and lane, around the turn; −inf where there is no value."""
    rows, _x, half, _lanes, columns = samples
    around = 4 * half if j < 0 else -4 * half if j >= 4 * half else 0
    value = rows[(j + around) * columns + column]
    return value if value == value else -math.inf
