"""Open brackets about all places where a signal may have its peak, where trials about the best summit do not settle it.

All is plain Python that is translated to machine code.
"""

import math

from linksweep.engine.peaks.brackets import (
    BEYOND,
    FA,
    FAR,
    FB,
    FC,
    FIRST_WIDTH,
    FLOOR,
    PEAK,
    PEAK_FAR,
    PEAK_X,
    RISE,
    SIGNAL,
    TAG,
    WIDTH,
    XA,
    XB,
    XC,
)
from linksweep.engine.peaks.search import might_reach, noise


def open_brackets(rows, x, half, lanes, columns, k, lane, known, even, signal, tag, brackets, count, best):
    """Open brackets about all summits of a signal that may exceed its peak so far, that of the `known` summit, or else
    its highest sample (−1: none is known); return their number. `even` signals are the same on both halves."""
    samples, confirmed = 4 * half, known >= 0
    if not confirmed:
        note_highest(rows, x, half, lanes, columns, k, lane, tag, best)
    top = best[PEAK, tag]
    if not abs(top) < math.inf:
        return count
    first, last = (half, 3 * half) if even else (0, samples - 1)
    before = sample_of(rows, first - 2, samples, columns, k)
    left, value = sample_of(rows, first - 1, samples, columns, k), sample_of(rows, first, samples, columns, k)
    for j in range(first, last + 1):
        right = sample_of(rows, j + 1, samples, columns, k)
        stands = left < value and value >= right
        if j != known and (even or stands):
            floor = noise(left, value, right)
            least = top + (RISE * abs(top) if confirmed else 10.0 * floor)
            summit = stands and might_reach(left, value, right, 1.0) > least
            between = even and j > first and might_reach_between(before, left, value, right) > least
            if summit or between:
                far = j // (2 * half)
                at = (j + 2 * far) * lanes + lane
                brackets[XA, count], brackets[XB, count], brackets[XC, count] = x[at], x[at + lanes], x[at + 2 * lanes]
                brackets[FA, count], brackets[FB, count], brackets[FC, count] = left, value, right
                if between:
                    brackets[XB, count], brackets[FB, count] = 0.5 * (x[at] + x[at + lanes]), -math.inf
                    brackets[XC, count], brackets[FC, count] = x[at + lanes], value
                brackets[FAR, count], brackets[SIGNAL, count] = float(far), float(signal)
                brackets[TAG, count], brackets[FLOOR, count] = tag, floor
                width = brackets[XC, count] - brackets[XA, count]
                brackets[WIDTH, count], brackets[FIRST_WIDTH, count] = 4.0 * width, width  # 4.0: not counted as slow
                count += 1
        before, left, value = left, value, right
    return count


def note_highest(rows, x, half, lanes, columns, k, lane, tag, best):
    """Write the highest sample of a signal as its peak so far."""
    samples = 4 * half
    top, at = -math.inf, 0
    for j in range(samples):
        if rows[j * columns + k] > top:
            top, at = rows[j * columns + k], j
    floor = noise(sample_of(rows, at - 1, samples, columns, k), top, sample_of(rows, at + 1, samples, columns, k))
    best[PEAK, tag], best[BEYOND, tag] = top if top > -math.inf else math.nan, 10.0 * floor
    far = at // (2 * half)
    best[PEAK_X, tag], best[PEAK_FAR, tag] = x[(at + 1 + 2 * far) * lanes + lane], float(far)


def might_reach_between(before, left, value, right):
    """Return the height that a summit between two samples may reach, of four that all rise or all fall: by tangents of
    the cubic through these, −inf where it does not turn."""
    rise, fall = slopes_between(before, left, value, right)
    if left < value:
        return left + rise if before < left and value < right and fall < 0.0 else -math.inf
    return value - fall if before > left > value > right and rise > 0.0 else -math.inf


def slopes_between(before, left, value, right):
    """Return the slopes of the cubic through four samples at the two in the middle, by their step."""
    at_left = (6.0 * value - 3.0 * left - 2.0 * before - right) / 6.0
    return at_left, (before + 2.0 * right + 3.0 * value - 6.0 * left) / 6.0


def sample_of(rows, j, samples, columns, k):
    """Return a sample of one signal and lane, around the turn; −inf where there is no value."""
    around = samples if j < 0 else -samples if j >= samples else 0
    value = rows[(j + around) * columns + k]
    return value if value == value else -math.inf
