"""Search for exact peaks, in plain Python that numba compiles into a kernel and that also runs as is.

A signal is evaluated at samples x along a path. Each sample above its neighbours opens a lane (a bracket under
refinement), unless its curvature rules out that it exceeds the largest sample:

             b            a < b < c bracket a peak. Each round evaluates the signal at three trials about the vertex
        a    |            of the parabola through them, all lanes side by side, and keeps the best point with its
        |    |    c       neighbours. Where that converges slowly (a kink, a jump), the two sides of b are bisected
                          instead.

A lane closes when its extended secants allow no further rise: a concave curve lies below them.

The path of a whole turn is split into two halves, each parametrised by the tangent x of half its angle from its own
middle (`far` is 0 on one half, 1 on the other), so that x runs from −1 to 1 on both. Samples follow a sinh grade, dense
about x = 0 where a near-toggle is narrow.
"""

import math

HALF = 24
"""Samples on either side of the middle of each half turn. With 96 a turn, `benchmarks.accuracy.missed` finds no design
of a million whose peak the search misses."""
SAMPLES = 4 * HALF
GRADES = 27
"""Scales of the sinh grade: 1, 1/2, 1/4, … The finest, 2⁻²⁶, is narrower than any near-toggle that is not yet a toggle
by its status (8e-8 rad)."""
ROUNDS = 400
"""Rounds, at most: more than bisecting a bracket down to its last digit takes."""

# rows of `lanes`: the three points of a bracket; its half turn and signal; its width, at the last round and at first;
# noise of the signal, rise that remains possible, whether it is done
XA, FA, XB, FB, XC, FC, FAR, TAG, WIDTH, FIRST_WIDTH, FLOOR, REMAINING, DONE = range(13)
LANE_ROWS, LASTING_ROWS = 13, 11  # a lane carries the first 11 from round to round
TRIALS = 3
"""Trials per lane and round."""
# rows of `trials`: place, half turn, signal, value
X, TRIAL_FAR, TRIAL_TAG, VALUE = range(4)
TRIAL_ROWS = 4
# rows of `best`, for each signal: the peak, its place and half turn, and how much higher it might be
PEAK, PEAK_X, PEAK_FAR, BEYOND = range(4)
BEST_ROWS = 4

BLOCK = 8
"""Lanes per block: 8 doubles fill a 512-bit register. Loops run over whole blocks, so that they become vector
instructions; unused lanes of the last block hold arbitrary numbers."""

NARROW = 1e-4
"""Width, relative to the first, down to which a bracket is refined at least: its parabola then places the peak to 1e-5
degree."""
RISE = 1e-11
"""Rise that may remain possible when a lane closes, relative to the peak: a tenth of the promised 1e-10."""
NOISE = 1e-15
"""Rounding noise of a signal, relative to its largest magnitude."""


def open_lanes(row, x, before, after, joined, tag, lanes, count, best, flags):
    """Note a signal's largest sample and open a lane at each that could lead higher; return the number of lanes.

    `joined` tells whether the path's ends meet; `before` and `after` are the places of the samples' neighbours.
    """
    n = len(row)
    summits = find_summits(row, joined, flags)
    top, at = -math.inf, 0
    for k in range(summits if summits else n):  # a flat or falling signal has no summit
        j = flags[k] if summits else k
        if row[j] > top:
            top, at = row[j], j
    quarter = n // 4  # a few samples suffice for the signal's magnitude
    floor = NOISE * max(abs(top), abs(row[0]), abs(row[quarter]), abs(row[2 * quarter]), abs(row[3 * quarter]))
    best[PEAK, tag], best[BEYOND, tag] = top if top > -math.inf else math.nan, 10.0 * floor
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
        if might_reach(left, value, right, ratio) > top + 10.0 * floor:
            lanes[XA, count], lanes[FA, count] = before[first], left
            lanes[XB, count], lanes[FB, count] = x[j], value
            lanes[XC, count], lanes[FC, count] = after[j], right
            lanes[TAG, count] = float(tag)
            width = after[j] - before[first]
            lanes[WIDTH, count], lanes[FIRST_WIDTH, count] = 4.0 * width, width  # 4.0: not counted as slow at first
            lanes[FLOOR, count] = floor
            count += 1
    return count


def might_reach(left, value, right, ratio):
    """Return an upper estimate of the peak about a sample above its neighbours: add the rises that both extended
    secants allow. The right neighbour is `ratio` times as far away as the left one."""
    return value + ((value - left) * ratio + (value - right) / ratio)


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
                stands = flags[j]
                flags[summits] = j  # without a branch: it would often be mispredicted
                summits += stands
    return summits


def neighbour(row, j, side, joined):
    """Return the sample beside another; −inf where there is none."""
    k, last = j + side, len(row) - 1
    if k < 0 or k > last:
        k = last if k < 0 else 0
        return row[k] if joined and row[k] == row[k] else -math.inf
    return row[k] if row[k] == row[k] else -math.inf


def open_path_lanes(rows, x, before, after, joined, lanes, best, flags):
    """Open the lanes of all signals on all paths: rows (path, signal, sample), tagged path by path."""
    count = 0
    paths, signals = rows.shape[:2]
    for path in range(paths):
        for k in range(signals):
            where = x[path], before[path], after[path]
            count = open_lanes(rows[path, k], *where, joined, path * signals + k, lanes, count, best, flags)
    return count


def in_blocks(count):
    """Return the length of whole blocks that hold `count` lanes: second trials start there, third ones at twice as
    much."""
    return (count + BLOCK - 1) // BLOCK * BLOCK


def place_trials(lanes, trials, count):
    """Place three trials per lane: about the vertex of its parabola, or, where the last round shrank it little,
    bisecting both sides."""
    xa, fa, xb, fb, xc, fc = lanes[XA], lanes[FA], lanes[XB], lanes[FB], lanes[XC], lanes[FC]
    width, first_width, far, tag = lanes[WIDTH], lanes[FIRST_WIDTH], lanes[FAR], lanes[TAG]
    x, trial_far, trial_tag, room = trials[X], trials[TRIAL_FAR], trials[TRIAL_TAG], in_blocks(count)
    for k in range(room):
        before, after, wide = xb[k] - xa[k], xc[k] - xb[k], xc[k] - xa[k]
        rise, fall = (fb[k] - fa[k]) / before, (fb[k] - fc[k]) / after
        vertex = xb[k] + 0.5 * (rise * after - fall * before) / (rise + fall)
        spread = 0.3 * wide * wide / first_width[k]  # a parabola's vertex errs by the square of the bracket's width
        reach = spread if spread < 0.2 * wide else 0.2 * wide
        reach = reach if reach > 1e-6 * first_width[k] else 1e-6 * first_width[k]
        sound = (wide < 0.6 * width[k]) & (vertex - reach > xa[k]) & (vertex + reach < xc[k])
        longer = -0.25 * before if before > after else 0.25 * after
        x[k] = vertex if sound else xb[k] + longer
        x[room + k] = vertex - reach if sound else xb[k] - 0.5 * before
        x[2 * room + k] = vertex + reach if sound else xb[k] + 0.5 * after
        trial_far[k], trial_far[room + k], trial_far[2 * room + k] = far[k], far[k], far[k]
        trial_tag[k], trial_tag[room + k], trial_tag[2 * room + k] = tag[k], tag[k], tag[k]
        width[k] = wide


def advance(lanes, trials, count, best):
    """Insert the trials' values into the brackets, note the best, close lanes that are done; return how many remain."""
    update_brackets(lanes, trials, count)
    for k in range(count):
        tag = int(lanes[TAG, k])
        if lanes[FB, k] > best[PEAK, tag]:
            best[PEAK, tag], best[PEAK_X, tag], best[PEAK_FAR, tag] = lanes[FB, k], lanes[XB, k], lanes[FAR, k]
    still_open = 0
    for k in range(count):
        tag = int(lanes[TAG, k])
        if lanes[DONE, k] > 0.0 or lanes[FB, k] + 2.0 * lanes[REMAINING, k] < best[PEAK, tag]:
            close_lane(lanes, k, best, tag)
        else:
            if still_open < k:
                for row in range(LASTING_ROWS):
                    lanes[row, still_open] = lanes[row, k]
            still_open += 1
    return still_open


def update_brackets(lanes, trials, count):
    """Insert the trials of each lane into its bracket, and compute the rise that remains possible."""
    xa, fa, xb, fb, xc, fc = lanes[XA], lanes[FA], lanes[XB], lanes[FB], lanes[XC], lanes[FC]
    first_width, floor, remaining, done = lanes[FIRST_WIDTH], lanes[FLOOR], lanes[REMAINING], lanes[DONE]
    x, value, room = trials[X], trials[VALUE], in_blocks(count)
    for k in range(room):
        bracket = insert_point((xa[k], fa[k], xb[k], fb[k], xc[k], fc[k]), x[k], value[k])
        bracket = insert_point(bracket, x[room + k], value[room + k])
        a, f_a, b, f_b, c, f_c = insert_point(bracket, x[2 * room + k], value[2 * room + k])
        xa[k], fa[k], xb[k], fb[k], xc[k], fc[k] = a, f_a, b, f_b, c, f_c
        remaining[k], done[k] = remaining_rise(a, f_a, b, f_b, c, f_c, first_width[k], floor[k])


def insert_point(bracket, x, f):
    """Return a bracket with another point: as its middle, if it is higher, else as its nearer end."""
    a, f_a, b, f_b, c, f_c = bracket
    f = f if f == f else -math.inf
    inside, higher, before = (x > a) & (x < c) & (x != b), f > f_b, x < b
    to_a, to_b, to_c = inside & (higher != before), inside & higher, inside & (higher == before)
    end, f_end = b if higher else x, f_b if higher else f
    return (
        end if to_a else a, f_end if to_a else f_a,
        x if to_b else b, f if to_b else f_b,
        end if to_c else c, f_end if to_c else f_c,
    )  # fmt: skip


def remaining_rise(a, f_a, b, f_b, c, f_c, first_width, floor):
    """Return how far a bracket's extended secants rise above its middle; and 1 if it has converged, 2 if empty."""
    top = f_b - 0.5 * RISE * abs(f_b)  # lowered by half the tolerance
    forward, backward = (top - f_a) * ((c - b) / (b - a)), (top - f_c) * ((b - a) / (c - b))
    rise = forward if forward > backward else backward
    tolerance = RISE * abs(f_b) if RISE * abs(f_b) > floor else floor
    empty = c - a <= 1e-15 * (1e-9 + abs(b))  # no number lies between its points
    return rise, (2.0 if empty else (1.0 if (rise <= tolerance) & (c - a <= NARROW * first_width) else 0.0))


def close_lane(lanes, k, best, tag):
    """Note the result of a lane: its peak, the place, and the rise that remains possible."""
    height, remaining, place = lanes[FB, k], lanes[REMAINING, k], lanes[XB, k]
    if height < best[PEAK, tag]:
        return
    before, after = place - lanes[XA, k], lanes[XC, k] - place
    if lanes[DONE, k] == 2.0:  # at a jump or a kink
        remaining = height - max(lanes[FA, k], lanes[FC, k])
    else:
        rise, fall = (height - lanes[FA, k]) / before, (height - lanes[FC, k]) / after
        step = 0.5 * (rise * after - fall * before) / (rise + fall)
        place += step if -before < step < after else 0.0
    best[PEAK_X, tag], best[PEAK_FAR, tag] = place, lanes[FAR, k]
    best[BEYOND, tag] = max(remaining, 0.0) + RISE * abs(height)
