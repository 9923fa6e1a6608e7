"""Open brackets about the samples of a path that may lead to a peak: plain Python that is translated to machine code.

A signal is evaluated at samples x along a path. Each sample above its neighbours opens a bracket (`engine.peaks.
brackets`), unless its curvature rules out that it exceeds the largest sample.

The path of a whole turn is split into two halves, each parametrised by the tangent x of half its angle from its own
middle (`far` is 0 on one half, 1 on the other), so that x runs from −1 to 1 on both. Samples are graded: dense about
x = 0 where a near-toggle is narrow.
"""

import math

from linksweep.engine.peaks.brackets import (
    BEYOND,
    BLOCK,
    FA,
    FB,
    FC,
    FIRST_WIDTH,
    FLOOR,
    NOISE,
    PEAK,
    PEAK_X,
    TAG,
    WIDTH,
    XA,
    XB,
    XC,
    in_blocks,
)

HALF = 24
"""Samples on either side of the middle of each half turn. With 96 a turn, `benchmarks.accuracy.missed` finds no design
of a million whose peak the search misses."""
FEW = 8
"""Samples on either side of the middle of a short piece of a turn, on which a signal has few summits."""
EVENLY = 0.12
"""Share of the samples that are spread evenly over x, whatever the scale of the grade: without them the search missed 2
peaks of a million, between samples 20 degrees apart."""
SAMPLES = 4 * HALF
PLACED = 2 * HALF + 2
"""Places of each half turn: its samples, and one before and after."""
GRADES = 27
"""Scales of the grade: 1, 1/2, 1/4, … The finest, 2⁻²⁶, is narrower than any near-toggle that is not yet a toggle
by its status (8e-8 rad)."""


def open_on_path(row, x, before, after, joined, tag, brackets, count, best, flags):
    """Note a signal's largest sample and open a bracket at each that could lead higher; return their number.

    `joined` tells whether the path's ends meet; `before` and `after` are the places of the samples' neighbours.
    """
    n = len(row)
    summits = find_summits(row, joined, flags)
    top, at = -math.inf, 0
    for k in range(summits if summits else n):  # a flat or falling signal has no summit
        j = flags[k] if summits else k
        if row[j] > top:
            top, at = row[j], j
    around_top = neighbour(row, at, -1, joined), top, neighbour(row, at, 1, joined)
    best[PEAK, tag], best[BEYOND, tag] = top if top > -math.inf else math.nan, 10.0 * noise(*around_top)
    best[PEAK_X, tag] = x[at]
    if abs(top) == math.inf:
        return count
    for k in range(summits):
        j = flags[k]
        first = j
        while first > 0 and x[first - 1] == x[j]:
            first -= 1
        left, value, right = neighbour(row, first, -1, joined), row[j], neighbour(row, j, 1, joined)
        ratio = (after[j] - x[j]) / (x[j] - before[first])
        floor = noise(left, value, right)
        if might_reach(left, value, right, ratio) > top + 10.0 * floor:
            brackets[XA, count], brackets[FA, count] = before[first], left
            brackets[XB, count], brackets[FB, count] = x[j], value
            brackets[XC, count], brackets[FC, count] = after[j], right
            brackets[TAG, count] = float(tag)
            width = after[j] - before[first]
            brackets[WIDTH, count], brackets[FIRST_WIDTH, count] = (
                4.0 * width,
                width,
            )  # 4.0: not counted as slow at first
            brackets[FLOOR, count] = floor
            count += 1
    return count


def might_reach(left, value, right, ratio):
    """Return an upper estimate of the peak about a sample above its neighbours: add the rises that both extended
    secants allow. The right neighbour is `ratio` times as far away as the left one."""
    return value + ((value - left) * ratio + (value - right) / ratio)


def noise(left, value, right):
    """Return the rounding noise of a signal about a sample, by its size there: elsewhere it may tend to −∞."""
    return NOISE * max(abs(left) if left > -math.inf else 0.0, abs(value), abs(right) if right > -math.inf else 0.0)


def find_summits(row, joined, flags):
    """Write the positions of all samples that exceed their neighbours to `flags`; return their number."""
    n, summits = len(row), 0
    for j in range(1, n - 1):
        below = (row[j] < row[j - 1]) | (row[j] <= row[j + 1]) | (row[j] != row[j])  # a NaN is below, and none above
        flags[j] = 0 if below else 1
    for j in (0, n - 1):
        stands = row[j] >= neighbour(row, j, -1, joined) and row[j] > neighbour(row, j, 1, joined)
        flags[j] = 1 if stands else 0
    for j in range(n, in_blocks(n)):
        flags[j] = 0
    for start in range(0, n, BLOCK):
        total = 0
        for k in range(BLOCK):
            total += flags[start + k]
        if total > 0:
            for j in range(start, start + BLOCK):
                more = flags[j]
                flags[summits] = j  # without a branch: it would often be mispredicted
                summits += more
    return summits


def neighbour(row, j, side, joined):
    """Return the sample beside another; −inf where there is none."""
    k, last = j + side, len(row) - 1
    if k < 0 or k > last:
        k = last if k < 0 else 0
        return row[k] if joined and row[k] == row[k] else -math.inf
    return row[k] if row[k] == row[k] else -math.inf


def open_on_paths(rows, x, before, after, joined, brackets, best, flags):
    """Open the brackets of all signals on all paths: rows (path, signal, sample), tagged path by path."""
    count = 0
    paths, signals = rows.shape[:2]
    for path in range(paths):
        for k in range(signals):
            where = x[path], before[path], after[path]
            count = open_on_path(rows[path, k], *where, joined, path * signals + k, brackets, count, best, flags)
    return count
