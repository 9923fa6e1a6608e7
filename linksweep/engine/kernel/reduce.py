"""Reduce rows to single numbers, for peaks and means: plain Python that numba compiles and that also runs as is."""

import math

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

    Lane k of `work` keeps the largest of samples k, k + 64, …: that compiles to vector instructions. Only the lanes
    that hold the peak are then searched for its position.
    """
    n = len(row)
    for k in range(64):
        work[k] = -math.inf
    whole = n - n % 64
    for start in range(0, whole, 64):
        for k in range(64):
            value = row[start + k]
            work[k] = value if value > work[k] else work[k]
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
    total, count = 0.0, 0
    for j in range(len(row)):
        if row[j] == row[j]:
            total += row[j]
            count += 1
    return (total / count if count else math.nan), float(count)


def mean_square(row, angles, work):
    """Return the mean of the squares of the samples that are not NaN, and their number."""
    total, count = 0.0, 0
    for j in range(len(row)):
        if row[j] == row[j]:
            total += row[j] * row[j]
            count += 1
    return (total / count if count else math.nan), float(count)
