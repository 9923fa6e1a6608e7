"""Rows to single numbers, for peaks. Plain Python that numba compiles into a kernel, and that also runs as it stands."""

import math

LANES = 64


def largest(row, sign, angles, period, lanes):
    """Largest sample of sign·row and its angle, improved by the parabola through it and its two neighbours.

    NaN samples are passed over; all NaN gives NaN. `period` joins the row's ends [as `angles`]; 0 leaves them apart.
    `lanes` (2, 64) keeps the running maxima, and where they were, so that the search compiles to vector instructions.
    """
    n = len(row)
    best, block = lanes[0], lanes[1]
    for k in range(64):
        best[k] = -math.inf
        block[k] = -1.0
    whole = n - n % 64
    for start in range(0, whole, 64):
        for k in range(64):
            value = sign * row[start + k]
            better = value > best[k]
            best[k] = value if better else best[k]
            block[k] = start if better else block[k]
    peak = -math.inf
    at = -1
    for k in range(64):
        if block[k] >= 0.0 and (best[k] > peak or (best[k] == peak and block[k] + k < at)):
            peak = best[k]
            at = int(block[k]) + k
    for j in range(whole, n):
        if sign * row[j] > peak:
            peak = sign * row[j]
            at = j
    if at < 0:
        return math.nan, math.nan
    return parabola_peak(row, sign, angles, period, at)


def parabola_peak(row, sign, angles, period, at):
    """Vertex of the parabola through a largest sample and its neighbours; the sample itself where there is none."""
    n = len(row)
    x, y = angles[at], sign * row[at]
    if n < 3 or (period == 0.0 and (at == 0 or at == n - 1)):
        return sign * y, x
    left = at - 1 if at > 0 else n - 1
    right = at + 1 if at < n - 1 else 0
    before = (x - angles[left]) + (period if at == 0 else 0.0)
    after = (angles[right] - x) + (period if at == n - 1 else 0.0)
    fall_before = (y - sign * row[left]) / before
    fall_after = (y - sign * row[right]) / after
    bend = fall_before + fall_after
    if not (bend > 0.0 and bend < math.inf):
        return sign * y, x
    slope = (fall_before * after - fall_after * before) / (before + after)
    shift = 0.5 * slope * (before + after) / bend
    angle = x + shift
    if period > 0.0:
        angle = angle - period if angle >= period else (angle + period if angle < 0.0 else angle)
    return sign * (y + 0.5 * slope * shift), angle


def mean(row, sign, angles, period, lanes):
    """Mean of the samples that are not NaN, and how many they are."""
    total, count = 0.0, 0
    for j in range(len(row)):
        if row[j] == row[j]:
            total += row[j]
            count += 1
    return (total / count if count else math.nan), float(count)


def mean_square(row, sign, angles, period, lanes):
    """Mean of the squares of the samples that are not NaN, and how many they are."""
    total, count = 0.0, 0
    for j in range(len(row)):
        if row[j] == row[j]:
            total += row[j] * row[j]
            count += 1
    return (total / count if count else math.nan), float(count)
