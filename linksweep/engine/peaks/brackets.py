"""Refine brackets of peaks, each a column of a table, many side by side.

             b            a < b < c bracket a peak. Each round evaluates the signal at three trials about the vertex
        a    |            of the parabola through them, and keeps the best point with its neighbours. Where that
        |    |    c       converges slowly (a kink, a jump), the two sides of b are bisected instead, and so
                          they are at first: if these trials show a second top, it gets a bracket of its own.

A bracket closes when its extended secants allow no further rise: a concave curve lies below them.
"""

import math

from linksweep.engine.kernel.instructions import REGISTER, call
from linksweep.engine.peaks.lanewise import lanewise

ROUNDS = 400
"""Rounds, at most: more than bisecting a bracket down to its last digit takes."""
NARROW = 1e-4
"""Width, relative to the first, down to which a bracket is refined at least: its parabola then places the peak to 1e-5
degree."""
NEARBY = 1e-3
"""Distance from the middle of a bracket, relative to its width, below which no trial is made: rounding alone would tell
its value from that in the middle, and the secant through both would allow no rise."""
RISE = 1e-11
"""Rise that may remain possible when a bracket closes, relative to the peak: a tenth of the promised 1e-10."""
NOISE = 1e-15
"""Rounding noise of a signal, relative to its largest magnitude."""

# rows of `brackets`: the three points; half turn, number of the signal, column of `best`; width, at the last round and
# at first; noise of the signal. These last from round to round
XA, FA, XB, FB, XC, FC, FAR, SIGNAL, TAG, WIDTH, FIRST_WIDTH, FLOOR = range(12)
LASTING_ROWS = 12
# trials and their values; the rise that remains possible, whether the bracket is done, and its result if it is
X1, X2, X3, F1, F2, F3, REMAINING, DONE, TOP_X, TOP_BEYOND = range(LASTING_ROWS, LASTING_ROWS + 10)
BRACKET_ROWS = LASTING_ROWS + 10
POINTS, TRIALS, VALUES = (XA, FA, XB, FB, XC, FC), (X1, X2, X3), (F1, F2, F3)
# rows of `best`, for each signal: the peak, its place and half turn, and how much higher it might be
PEAK, PEAK_X, PEAK_FAR, BEYOND = range(4)
BEST_ROWS = 4
EVALUATIONS = BEST_ROWS
"""Row of `best` after those, of searches of designs side by side: the number of evaluations of a signal."""


def in_blocks(count):
    """Return the number of columns, in whole registers, that hold `count` brackets: the last ones hold any numbers."""
    return -(-count // REGISTER) * REGISTER


def open_bracket(brackets, k, before, middle, after, far, signal, tag, floor):
    """Write a bracket of three points, each with its value, to a column."""
    brackets[XA, k], brackets[FA, k] = before
    brackets[XB, k], brackets[FB, k] = middle
    brackets[XC, k], brackets[FC, k] = after
    brackets[FAR, k], brackets[SIGNAL, k], brackets[TAG, k], brackets[FLOOR, k] = far, signal, tag, floor
    width = brackets[XC, k] - brackets[XA, k]
    # counted as slow: both sides are bisected first, for a bracket may hold two tops
    brackets[WIDTH, k], brackets[FIRST_WIDTH, k] = width, width


def divide(brackets, count):
    """Open another bracket for each whose first trials show a second top; return how many there are."""
    every = count
    for k in range(count):
        first, known = brackets[WIDTH, k] == brackets[FIRST_WIDTH, k], brackets[FB, k] > -math.inf
        if first and known and every < brackets.shape[1]:
            every = open_second(brackets, k, every)
    return every


def open_second(brackets, k, new):
    """Open a bracket about the second top of six points, those of a bracket and its trials, or between it and its
    neighbour where it is an end; return how many brackets there are."""
    p, f_p, q, f_q = brackets[X1, k], brackets[F1, k], brackets[XB, k], brackets[FB, k]
    if q < p:
        p, f_p, q, f_q = q, f_q, p, f_p
    a, c = brackets[XA, k], brackets[XC, k]
    left, right = (brackets[X2, k], brackets[F2, k]), (brackets[X3, k], brackets[F3, k])
    top, second = max(left[1], f_p, f_q, right[1]), -math.inf
    u, f_u, v, f_v = a, -math.inf, a, -math.inf  # two points before the first, and of no value
    for w, f_w in ((a, brackets[FA, k]), left, (p, f_p), (q, f_q), right, (c, brackets[FC, k]), (c, -math.inf)):
        lower = f_v - max(RISE * abs(f_v), brackets[FLOOR, k])
        if f_u < lower and f_w < lower and second < f_v and f_v < top:
            second = f_v
            start, middle, end = (u, f_u), (v, f_v), (w, f_w)
            if u == v:
                start, middle = (v, f_v), (0.5 * (v + w), -math.inf)
            if v == w:
                middle, end = (0.5 * (u + v), -math.inf), (v, f_v)
        u, f_u, v, f_v = v, f_v, w, f_w
    if second == -math.inf:
        return new
    far, signal, tag, floor = brackets[FAR, k], brackets[SIGNAL, k], brackets[TAG, k], brackets[FLOOR, k]
    open_bracket(brackets, new, start, middle, end, far, signal, tag, floor)
    brackets[FIRST_WIDTH, new] = brackets[FIRST_WIDTH, k]  # wider than it is: it is not divided again
    brackets[X1, new], brackets[X2, new], brackets[X3, new] = middle[0], middle[0], middle[0]
    return new + 1


def evaluate_trials(brackets, first, last, constants, evaluate):
    """Evaluate signals at the trials of brackets side by side."""
    for x, f in ((X1, F1), (X2, F2), (X3, F3)):
        call(evaluate, (constants, brackets, x, f, FAR, SIGNAL, first, last))


def gather(constants, place, lanes, gathered, lane):
    """Copy the constants of the design at a place, counted lane by lane and row by row, to a lane of others."""
    row, own = place // lanes, place % lanes
    for k in range(len(gathered) // lanes):
        gathered[k * lanes + lane] = constants[row, k * lanes + own]


@lanewise((*POINTS, WIDTH, FIRST_WIDTH), (*TRIALS, WIDTH))
def place_trials(a, f_a, b, f_b, c, f_c, last_width, first_width):
    """Place trials about the vertex of the parabola, or, where the last round shrank the bracket little, bisect."""
    before, after, width = b - a, c - b, c - a
    step = vertex_step(a, f_a, b, f_b, c, f_c)
    vertex = b + step
    spread = 0.3 * width * width / first_width  # a parabola's vertex errs by the square of the bracket's width
    reach = larger((spread < 0.2 * width).where(spread, 0.2 * width), 1e-6 * first_width)
    longer = (after < before).where(-0.25 * before, 0.25 * after)
    trials, bisecting = (vertex, vertex - reach, vertex + reach), (b + longer, b - 0.5 * before, b + 0.5 * after)
    for sound in (width < 0.6 * last_width, a < vertex - reach, vertex + reach < c):
        trials = tuple(sound.where(x, y) for x, y in zip(trials, bisecting, strict=True))
    return *((abs(x - b) < NEARBY * width).where(b, x) for x in trials), width


@lanewise((*POINTS, *TRIALS, *VALUES, FIRST_WIDTH, FLOOR), (*POINTS, REMAINING, DONE, TOP_X, TOP_BEYOND))
def insert_trials(a, f_a, b, f_b, c, f_c, x1, x2, x3, f1, f2, f3, first_width, floor):
    """Insert the trials of each bracket, and note the rise that remains possible, and whether it has converged."""
    bracket = a, f_a, b, f_b, c, f_c
    for x, f in (highest((x1, f1), (x2, f2), (x3, f3)), (x1, f1), (x2, f2), (x3, f3)):
        bracket = insert_point(bracket, x, f)  # the highest first: beyond a lower one it would lie outside
    a, f_a, b, f_b, c, f_c = bracket
    top = f_b - 0.5 * RISE * abs(f_b)  # lowered by half the tolerance
    rise = larger((top - f_a) * ((c - b) / (b - a)), (top - f_c) * ((b - a) / (c - b)))
    rise = larger(rise, 0.0)  # below 0, `advance` would drop the highest bracket while it is wide: b may be in a dip
    tolerance = larger(RISE * abs(f_b), floor)
    converged = (tolerance < rise).where(0.0, (NARROW * first_width < c - a).where(0.0, 1.0))
    empty = c - a < 1e-15 * (1e-9 + abs(b))  # at a jump or a kink: no number lies between its points
    step = vertex_step(*bracket)
    place = (a - b < step).where((step < c - b).where(b + step, b), b)
    beyond = empty.where(f_b - larger(f_a, f_c), rise) + RISE * abs(f_b)
    return *bracket, rise, empty.where(1.0, converged), empty.where(b, place), beyond


def insert_point(bracket, x, f):
    """Return a bracket with another point: as its middle, if it is higher, else as its nearer end. A middle of unknown
    value, −∞, becomes no end: the other side may be as high."""
    a, f_a, b, f_b, c, f_c = bracket
    f = (f > -math.inf).where(f, -math.inf)  # where there is no value
    higher, known, new = f > f_b, f_b > -math.inf, (x, f)
    low, high = ([known.where(*pair) for pair in ((b, end), (f_b, f_end))] for end, f_end in ((a, f_a), (c, f_c)))
    before = zip((a, f_a, *new, *high), (*new, b, f_b, c, f_c), strict=True)
    after = zip((*low, *new, c, f_c), (a, f_a, b, f_b, *new), strict=True)
    return tuple(
        (a < x).where((x < b).where(higher.where(*p), (b < x).where((x < c).where(higher.where(*q), old), old)), old)
        for p, q, old in zip(before, after, bracket, strict=True)
    )


def highest(first, *others):
    """Return the point of largest value."""
    for point in others:
        higher = point[1] > first[1]
        first = tuple(higher.where(*pair) for pair in zip(point, first, strict=True))
    return first


def vertex_step(a, f_a, b, f_b, c, f_c):
    """Return the step from the middle of a bracket to the vertex of its parabola."""
    rise, fall = (f_b - f_a) / (b - a), (f_b - f_c) / (c - b)
    return 0.5 * (rise * (c - b) - fall * (b - a)) / (rise + fall)


def larger(x, y):
    """Return the larger of two values; the second where the first is NaN."""
    return (x > y).where(x, y)


def advance(brackets, count, every, best):
    """Note the highest points, and the results of brackets that are done; return how many remain, with all new ones,
    which follow the first `count`."""
    for k in range(count):
        tag = int(brackets[TAG, k])
        if brackets[FB, k] > best[PEAK, tag]:
            best[PEAK, tag], best[PEAK_X, tag], best[PEAK_FAR, tag] = brackets[FB, k], brackets[XB, k], brackets[FAR, k]
    still_open = 0
    for k in range(every):
        tag, height = int(brackets[TAG, k]), brackets[FB, k]
        if k < count and (brackets[DONE, k] > 0.0 or height + 2.0 * brackets[REMAINING, k] < best[PEAK, tag]):
            if height >= best[PEAK, tag]:
                best[PEAK_X, tag], best[PEAK_FAR, tag] = brackets[TOP_X, k], brackets[FAR, k]
                best[BEYOND, tag] = brackets[TOP_BEYOND, k]
        else:
            if still_open < k:
                for row in range(LASTING_ROWS):
                    brackets[row, still_open] = brackets[row, k]
            still_open += 1
    return still_open


def refine(brackets, count, lanes, width, start, constants, gathered, evaluate, best):
    """Refine all brackets, several side by side, until none is left."""
    for _ in range(ROUNDS):
        if count == 0:
            break
        place_trials(brackets, count)
        for front in range(0, count, lanes):
            for lane in range(lanes):
                tag = int(brackets[TAG, min(front + lane, count - 1)])
                gather(constants, tag % width - start, lanes, gathered, lane)
                if front + lane < count:
                    best[EVALUATIONS, tag] += 3
            evaluate_trials(brackets, front, front + lanes, gathered, evaluate)
        every = divide(brackets, count)
        insert_trials(brackets, count)
        count = advance(brackets, count, every, best)
