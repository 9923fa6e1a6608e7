"""Reduce rows to single numbers, for peaks and means: plain Python that is translated and that also runs as is."""

import math

from linksweep.engine.kernel.instructions import REGISTER
from linksweep.engine.kernel.translate import written_by

WORK = 80
"""Numbers of working memory for a reduction: 64 lanes and 16 to fold them into."""


def largest_sample(row, angles, work):
    """Return the largest sample of a row and its angle; NaN samples are skipped, all NaN gives NaN."""
    at = place_of_largest(row, work)
    return (row[at], angles[at]) if at >= 0 else (math.nan, math.nan)


def least_sample(row, angles, work):
    """Return the least sample of a row and its angle; NaN samples are skipped, all NaN gives NaN."""
    at = -1
    for j in range(len(row)):
        if row[j] == row[j] and (at < 0 or row[j] < row[at]):
            at = j
    return (row[at], angles[at]) if at >= 0 else (math.nan, math.nan)


def place_of_largest(row, work):
    """Return the position of the largest sample, the first of equals; −1 where all are NaN.

    Lane k of `work` keeps the largest of samples k, k + 64, …. Only the lanes that hold the peak are then searched for
    its position.
    """
    n = len(row)
    whole = n - n % 64
    fill_lanes(row, whole, work)
    for k in range(n - whole):
        value = row[whole + k]
        work[k] = value if value > work[k] else work[k]
    peak = largest_lane(work)
    at = n
    for folded in range(16):
        if work[64 + folded] == peak:
            for k in range(folded, 64, 16):
                if work[k] == peak:
                    at = min(at, first_in_lane(row, k, peak, at))
    return at if at < n and peak > -math.inf else -1


def _write_fill_lanes(vectors, row, whole, work):
    builder, places = vectors.builder, [vectors.integer(k) for k in range(0, 64, REGISTER)]
    lanes = [vectors.slot(vectors.wide(vectors.double(-math.inf))) for _ in places]
    with vectors.loop(vectors.integer(0), whole, 64) as (start, _):
        for lane, place in zip(lanes, places, strict=True):
            value, largest = vectors.load(row.data, builder.add(start, place)), builder.load(lane)
            builder.store(builder.select(builder.fcmp_ordered(">", value, largest), value, largest), lane)
    for lane, place in zip(lanes, places, strict=True):
        vectors.store(builder.load(lane), work.data, place)


@written_by(_write_fill_lanes)
def fill_lanes(row, whole, work):
    """Fill the lanes with the largest of their samples, of whole blocks of 64; −inf without any."""
    for k in range(64):
        work[k] = -math.inf
    for start in range(0, whole, 64):
        for k in range(64):
            value = row[start + k]
            work[k] = value if value > work[k] else work[k]


def first_in_lane(row, k, peak, end):
    """Return the first position among k, k + 64, … whose sample equals the peak, or one not below `end`."""
    j = k
    while j < end and row[j] != peak:
        j += 64
    return j


def largest_lane(work):
    """Return the largest of the 64 lanes, by folding them into 16."""
    for k in range(16):
        work[64 + k] = work[k]
    for start in range(16, 64, 16):
        for k in range(16):
            value = work[start + k]
            work[64 + k] = value if value > work[64 + k] else work[64 + k]
    peak = -math.inf
    for k in range(64, 80):
        peak = work[k] if work[k] > peak else peak
    return peak


def mean(row, angles, work):
    """Return the mean of the samples that are not NaN, and their number."""
    return mean_of_powers(row, 1)


def mean_square(row, angles, work):
    """Return the mean of the squares of the samples that are not NaN, and their number."""
    return mean_of_powers(row, 2)


def mean_of_powers(row, power):
    """Return the mean of a power, 1 or 2, of the samples that are not NaN, and their number."""
    total, count = 0.0, 0
    for j in range(len(row)):
        if row[j] == row[j]:
            total += row[j] if power == 1 else row[j] * row[j]
            count += 1
    return (total / count if count else math.nan), float(count)
