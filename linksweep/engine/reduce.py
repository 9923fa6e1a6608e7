"""Rows to single numbers, for peaks. Plain Python that numba compiles into a kernel, and that also runs as it
stands."""

import math

WORK = 80
"""Numbers of working memory that a reduction may use: 64 lanes and 16 to fold them into."""


def largest(row, angles, period, work):
    """Largest sample of a row and its angle, improved by the parabola through it and its two neighbours.

    NaN samples are passed over; all NaN gives NaN. `period` joins the row's ends [as `angles`]; 0 leaves them apart.
    """
    at = place_of_largest(row, work)
    return parabola_peak(row, angles, period, at) if at >= 0 else (math.nan, math.nan)


def largest_sample(row, angles, period, work):
    """Largest sample of a row and its angle as they stand: for rows that may jump, where no parabola holds."""
    at = place_of_largest(row, work)
    return (row[at], angles[at]) if at >= 0 else (math.nan, math.nan)


def place_of_largest(row, work):
    """Where the largest sample is, the first of equals; -1 where all are NaN.

    Lane k of `work` keeps the largest of samples k, k + 64, …: that compiles to vector instructions, and the winning
    lane says where to look for its sample.
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
    for k in range(64):
        if work[k] == peak:
            j = k
            while j < at and row[j] != peak:
                j += 64
            at = min(at, j)
    return at if at < n and peak > -math.inf else -1


def largest_lane(work):
    """The largest of the 64 lanes, by folding them into 16."""
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


def parabola_peak(row, angles, period, at):
    """Vertex of the parabola through a largest sample and its neighbours; the sample itself where there is none.

    Nor is there one beside a jump or a kink: the curve must bend the same way at both neighbours.
    """
    n = len(row)
    x, y = angles[at], row[at]
    if n < 3 or (period == 0.0 and (at == 0 or at == n - 1)):
        return y, x
    left = at - 1 if at > 0 else n - 1
    right = at + 1 if at < n - 1 else 0
    before = (x - angles[left]) + (period if at == 0 else 0.0)
    after = (angles[right] - x) + (period if at == n - 1 else 0.0)
    fall_before = (y - row[left]) / before
    fall_after = (y - row[right]) / after
    bend = fall_before + fall_after
    if not (bend > 0.0 and bend < math.inf):
        return y, x
    if n > 4 and not (bends_down(row, angles, period, left) and bends_down(row, angles, period, right)):
        return y, x
    slope = (fall_before * after - fall_after * before) / (before + after)
    shift = 0.5 * slope * (before + after) / bend
    angle = x + shift
    if period > 0.0:
        angle = angle + period if angle < 0.0 else angle
        angle = angle - period if angle >= period else angle
    return y + 0.5 * slope * shift, angle


def bends_down(row, angles, period, at):
    """Whether a sample lies on or above the line through its neighbours; true at an end that has only one."""
    n = len(row)
    if period == 0.0 and (at == 0 or at == n - 1):
        return True
    left = at - 1 if at > 0 else n - 1
    right = at + 1 if at < n - 1 else 0
    before = (angles[at] - angles[left]) + (period if at == 0 else 0.0)
    after = (angles[right] - angles[at]) + (period if at == n - 1 else 0.0)
    return (row[at] - row[left]) * after >= (row[right] - row[at]) * before


def mean(row, angles, period, work):
    """Mean of the samples that are not NaN, and how many they are."""
    total, count = 0.0, 0
    for j in range(len(row)):
        if row[j] == row[j]:
            total += row[j]
            count += 1
    return (total / count if count else math.nan), float(count)


def mean_square(row, angles, period, work):
    """Mean of the squares of the samples that are not NaN, and how many they are."""
    total, count = 0.0, 0
    for j in range(len(row)):
        if row[j] == row[j]:
            total += row[j] * row[j]
            count += 1
    return (total / count if count else math.nan), float(count)
