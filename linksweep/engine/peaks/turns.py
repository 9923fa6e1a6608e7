"""Search for the peaks of several designs side by side, one in each lane.

All signals of a few designs are evaluated at the samples of the turn. One pass keeps each signal's best summit: the
sample whose neighbours allow the highest peak. The quartic through five samples about it predicts the peak, and four
evaluations confirm it. Where they do not, where another summit may be as high, or hide between samples that are far
apart or level, or where signals jump, brackets about all summits that may be the highest are refined
(`engine.peaks.brackets`): those of many designs at once.

`search` is plain Python that is translated to machine code. Arithmetic in lanes is traced and written as vector
instructions. A design has the same bits whichever others stand beside it, and where nothing is compiled.
"""

import math

from linksweep.engine.kernel.instructions import call
from linksweep.engine.peaks.brackets import BEYOND, EVALUATIONS, NOISE, PEAK, PEAK_FAR, PEAK_X, RISE, larger, refine
from linksweep.engine.peaks.lanewise import around, copy_lanes, lanewise
from linksweep.engine.peaks.samples import HALF, SAMPLES, grade
from linksweep.engine.peaks.summits import might_reach, open_brackets, slopes_between
from linksweep.engine.trace.arctangent import arctangent
from linksweep.engine.trace.graph import Node

PEAK_ANGLE = PEAK_X
"""Row of `best` that has angles from the near-toggle [degree], in place of tangents, once a search of turns is done."""
CLOSER = 0.125
"""Part of the width of a near-toggle by which samples are placed where they may lie too far apart."""
BLOCKS = 32
"""Blocks of designs whose brackets are refined together."""
NARROW_TOGGLE = 1e-3
"""Half-width of a near-toggle below which samples may lie too far apart: each is then 1.4 to 2.4 times as far from the
near-toggle as the last one, and two of a million searches missed a summit between neighbours."""
ROOM = 8 * SAMPLES
"""Brackets that are refined together, at most: half of them, each of which may be divided once."""
CAUTION = 3.0
"""Third derivatives that the error of a vertex allows for, of those that the samples show."""

# rows of `state`, a column for each lane of each signal: results, in the order of the rows of `best`; whether they are
# final, or confirmed while another summit may be higher
FINAL, CONFIRMED = range(EVALUATIONS + 1, EVALUATIONS + 3)
# the number of the best summit, the height that it may reach, and any other; that of one between samples beside it
SUMMIT, REACH, OTHER, HIDDEN = range(EVALUATIONS + 3, EVALUATIONS + 7)
SAMPLED = EVALUATIONS + 7  # seven samples about the summit
PLACES = SAMPLED + 7  # the tangents at three of them
HALF_TURN, NUMBER = range(PLACES + 3, PLACES + 5)  # the half turn of the summit; the number of the signal
# vertex of the quartic through the samples, curvature there, third derivative; all steps are those between samples
VERTEX, CURVATURE, THIRD = range(PLACES + 5, PLACES + 8)
# trials: steps from the summit, tangents, and values
Z_LEFT, X_LEFT, F_LEFT, Z_RIGHT, X_RIGHT, F_RIGHT = range(PLACES + 8, PLACES + 14)
Z_MIDDLE, X_MIDDLE, F_MIDDLE, Z_LAST, X_LAST, F_LAST = range(PLACES + 14, PLACES + 20)
# slope and second difference of the parabola through three trials, the rise to its vertex, what an error of its place
# costs, and whether it is sound
SLOPE, BEND, GAIN, LOSS, SOUND = range(PLACES + 20, PLACES + 25)
BEFORE = PLACES + 25  # the first of the last two samples
STATE_ROWS = PLACES + 26

SEVEN, THREE = tuple(range(SAMPLED, SAMPLED + 7)), tuple(range(PLACES, PLACES + 3))
FIVE = SEVEN[1:6]
NOTHING_YET = {SUMMIT: 0.0, REACH: -math.inf, OTHER: -math.inf}


def search(
    first, last, designs, lanes, smooth, sparse, sizes, parameters, parameter_at, grades, prepare, share, sample,
    evaluate, constants, x, rows, state, brackets, gathered, best
):  # fmt: skip
    """Write the peaks of blocks `first` … `last` of designs to `best`: a column for each design of each signal, one
    signal after the other, each filled up to whole blocks. A peak's place is its angle from the near-toggle. `sparse`
    tells that samples may lie too far apart in every design, as they do in those with narrow near-toggles."""
    columns = state.shape[1]
    signals, samples = columns // lanes, (rows, x, HALF, lanes, columns)
    width = best.shape[1] // signals
    for signal in range(signals):
        for lane in range(lanes):
            state[NUMBER, signal * lanes + lane] = signal
    for start in range(first, last, BLOCKS):
        stop = min(start + BLOCKS, last)
        count = 0
        for block in range(start, stop):
            own = constants[block - start]
            call(prepare, (block * lanes, designs, sizes, parameters, parameter_at, own))
            if place_samples(own, lanes, grades, CLOSER if sparse else 1.0, x) > 0:
                call(share, (own, x))
            call(sample, (own, x, rows))
            confirm_summits(samples, own, state, evaluate)
            for signal in range(signals):
                column, tag = signal * lanes, signal * width + block * lanes
                for row in range(EVALUATIONS + 1):
                    copy_lanes(state, row, column, best, tag, lanes)
                for lane in range(lanes):
                    close = sparse or min(own[lane], own[lanes + lane]) < NARROW_TOGGLE
                    if close or not smooth or state[FINAL, column + lane] == 0.0:
                        if 2 * (count + 2 * SAMPLES) > brackets.shape[1]:
                            refine(brackets, count, lanes, width, start * lanes, constants, gathered, evaluate, best)
                            count = 0
                        trusted, of = smooth and not sparse, tag + lane
                        count = open_unsettled(samples, signal, lane, trusted, close, state, of, brackets, count, best)
        refine(brackets, count, lanes, width, start * lanes, constants, gathered, evaluate, best)
        for signal in range(signals):
            place_angles(best, signal * width + start * lanes, signal * width + stop * lanes)


def confirm_summits(samples, constants, state, evaluate):
    """Predict the peak of each signal of designs side by side from its best summit, and confirm it by trials."""
    rows, _x, _half, lanes, columns = samples
    compare_samples(rows, SAMPLES, columns, state)
    for k in range(columns):
        pick_sample(samples, k, state, k)
    look_beside(state, columns)
    try_vertices(constants, state, columns, lanes, -1, evaluate)


def open_unsettled(samples, signal, lane, trusted, close, state, tag, brackets, count, best):
    """Open brackets of a signal whose peak is not final, or may lie between samples; return their number."""
    k = signal * samples[3] + lane
    known = int(state[SUMMIT, k]) if trusted and state[CONFIRMED, k] > 0.0 else -1
    hidden = close or best[PEAK, tag] < state[HIDDEN, k]
    return open_brackets(samples, signal, lane, known, False, hidden, tag, brackets, count, best)


def try_vertices(constants, state, columns, lanes, number, evaluate):
    """Predict the peaks from five samples about summits, and settle them by trials."""
    predict_vertices(state, columns)
    call(evaluate, (constants, state, X_LEFT, F_LEFT, HALF_TURN, number, 0, columns))
    call(evaluate, (constants, state, X_RIGHT, F_RIGHT, HALF_TURN, number, 0, columns))
    step_to_vertices(state, columns)
    call(evaluate, (constants, state, X_MIDDLE, F_MIDDLE, HALF_TURN, number, 0, columns))
    correct_vertices(state, columns)
    for k in range(0, columns, lanes):
        if last_trials(state, k, lanes) > 0:
            call(evaluate, (constants, state, X_LAST, F_LAST, HALF_TURN, NUMBER, k, k + lanes))
    settle_peaks(state, columns)


def place_samples(constants, lanes, grades, part, x):
    """Place the samples of each half turn by a part of its near-toggle's width, with one more on either side; those of
    the last block may be the right ones. Return the number of lanes that got others."""
    changed, half = 0, grades.shape[1] - 1
    placed = 2 * half + 2
    for far in range(2):
        middle = (far * placed + 1 + half) * lanes
        for lane in range(lanes):
            own = grade(part * constants[far * lanes + lane], 1.0)
            if x[middle + lanes + lane] != grades[own, 1]:
                changed += 1
                for k in range(half + 1):
                    x[middle - k * lanes + lane] = -grades[own, k]
                    x[middle + k * lanes + lane] = grades[own, k]
    for far in range(2):  # measured from the other middle, 180 degrees away, a tangent is minus its inverse
        for lane in range(lanes):
            x[far * placed * lanes + lane] = -1.0 / x[((1 - far) * placed + 2 * half) * lanes + lane]
    return changed


@around(NOTHING_YET)
def compare_samples(left, first, second, right, number, summit, reach, other):
    """Note the best summit, and the heights that it and any other summit may reach."""
    height, number = summit_of(left, first, second, right, number)
    return with_summit(height, number, summit, reach, other)


def comparison_of_half(half):
    """Return the same for signals that are the same on both halves of a turn, of the samples of one, and the one before
    and two after them, which are no summits. These may lie too far apart: summits between neighbours are noted, too."""

    @around({**NOTHING_YET, BEFORE: math.nan})
    def compare(left, first, second, right, number, summit, reach, other, before):
        heights, noted = [summit_of(left, first, second, right, number)], (summit, reach, other)
        for at, four in ((number, (before, left, first, second)), (number + 1.0, (left, first, second, right))):
            heights.append(((at < 2.0).where(-math.inf, height_between(*four)), at))
        for height, at in heights:
            noted = with_summit(on_half(at, half, height), at + (half - 1.0), *noted)
        return *noted, first

    return compare


def on_half(number, half, height):
    """Return a height about a sample of one half of a turn; −inf about the one before these and those after them."""
    return (number < 1.0).where(-math.inf, (number > 2.0 * half + 1.0).where(-math.inf, height))


def summit_of(left, first, second, right, number):
    """Return the height that a summit about one of two samples may reach, −inf if neither is one, and its number.

    Two neighbours of equal height from different pairs both count: trials then settle neither.
    """
    rises = first < second
    value, beside, beyond = rises.where(second, first), rises.where(first, second), rises.where(right, left)
    height = might_reach(beside, value, beyond, 1.0)
    return (value < beyond).where(-math.inf, height), rises.where(number + 1.0, number)


def height_between(before, left, value, right):
    """Return the height that a summit between two samples may reach, by tangents of the cubic through four; −inf where
    it does not turn, or where the secants about the higher sample allow as much."""
    rise, fall = slopes_between(before, left, value, right)
    rises, rising, falling = left < value, left + rise, value - fall
    outer, beside = rises.where(before, right), rises.where(left, value)
    top, beyond = rises.where(value, left), rises.where(right, before)
    from_beside, from_top, slopes = rises.where(rising, falling), rises.where(falling, rising), top < beyond
    height, secants = slopes.where(from_beside, from_top), might_reach(beside, top, beyond, 1.0)
    for sound in (outer < beside, beside < top, top < from_top, slopes.where(-math.inf, secants) < height):
        height = sound.where(height, -math.inf)
    return height


def with_summit(height, number, summit, reach, other):
    """Return the best summit, and the heights that it and any other may reach, with one more; beside a sample without a
    value, as in a dead centre, its height is NaN, and may be any."""
    best = reach < height
    less = best.where(reach, height)
    less = (less < math.inf).where(less, math.inf)
    return best.where(number, summit), best.where(height, reach), (other < less).where(less, other)


def pick_sample(samples, column, state, k):
    """Copy seven of the samples in a column, those about the best summit, and the places of three; no peak is final
    near the ends of a half turn."""
    rows, x, half, lanes, columns = samples
    j = int(state[SUMMIT, k])
    far = 1 if j >= 2 * half else 0
    inside = 2 <= j - 2 * half * far < 2 * half - 2
    j, far = (j, far) if inside else (half, 0)
    state[HALF_TURN, k], state[SOUND, k] = far, inside
    for near in range(7):
        state[SAMPLED + near, k] = rows[(j + near - 3) % (4 * half) * columns + column]
    for near in range(3):
        state[PLACES + near, k] = x[(j + near + 2 * far) * lanes + column % lanes]


@lanewise((*SEVEN, OTHER), (HIDDEN, OTHER))
def look_beside(f0, f1, f2, f3, f4, f5, f6, other):
    """Note the height that a summit beside the best one may reach: on a level top, between samples that rise to it."""
    hidden = larger(height_between(f0, f1, f2, f3), height_between(f3, f4, f5, f6))
    return hidden, larger(hidden, other)


@lanewise((*FIVE, *THREE), (VERTEX, CURVATURE, THIRD, Z_LEFT, X_LEFT, Z_RIGHT, X_RIGHT))
def predict_vertices(f0, f1, f2, f3, f4, *places):
    """Predict the vertex by the quartic through five samples: two Newton steps from that of the parabola. Place trials
    about it, their distance by what the quartic corrected."""
    d1 = (f0 - f4 + 8.0 * (f3 - f1)) / 12.0
    d2 = (16.0 * (f1 + f3) - f0 - f4 - 30.0 * f2) / 12.0
    d3, d4 = 0.5 * (f4 - f0) + (f1 - f3), f4 + f0 - 4.0 * (f3 + f1) + 6.0 * f2
    plain = vertex = 0.5 * (f1 - f3) / (f1 + f3 - 2.0 * f2)
    for _ in range(2):
        slope = d1 + vertex * (d2 + vertex * (0.5 * d3 + vertex * d4 / 6.0))
        vertex = vertex - slope / (d2 + vertex * (d3 + 0.5 * vertex * d4))
    spread = 0.02 * abs(vertex - plain) + 5e-3
    left, right = vertex - spread, vertex + spread
    curvature = d2 + vertex * (d3 + 0.5 * vertex * d4)
    return vertex, curvature, d3, left, place_at(left, *places), right, place_at(right, *places)


def place_at(step, x1, x2, x3):
    """Return the tangent some steps from the middle one of three samples, on the parabola through them."""
    return x2 + step * (0.5 * (x3 - x1) + step * (0.5 * ((x3 - x2) - (x2 - x1))))


@lanewise((VERTEX, CURVATURE, Z_LEFT, F_LEFT, Z_RIGHT, F_RIGHT, *THREE), (Z_MIDDLE, X_MIDDLE))
def step_to_vertices(vertex, curvature, left, f_left, right, f_right, *places):
    """Place a trial by a Newton step, with the slope of the two trials and the curvature of the quartic."""
    middle = vertex - (f_right - f_left) / ((right - left) * curvature)
    return middle, place_at(middle, *places)


def parabola(x, f, y, g, z, h):
    """Return the slope and the second difference of the parabola through three points: the slope from x to z."""
    slope = (h - f) / (z - x)
    return slope, ((g - h) / (y - z) - slope) / (y - x)


@lanewise(
    (Z_LEFT, F_LEFT, Z_RIGHT, F_RIGHT, Z_MIDDLE, F_MIDDLE, VERTEX, CURVATURE, THIRD, SOUND, *THREE),
    (Z_LAST, X_LAST, F_LAST, SLOPE, BEND, GAIN, LOSS, SOUND),
)
def correct_vertices(
    left, f_left, right, f_right, middle, f_middle, predicted, curvature, third, sound, *places
):  # fmt: skip
    """Place the last trial: at the vertex of the parabola through three, where that promises more than they have."""
    slope, bend = parabola(left, f_left, right, f_right, middle, f_middle)
    vertex = middle - 0.5 * (slope + (middle - left) * bend) / bend
    gain = abs(bend) * (vertex - middle) * (vertex - middle)
    away = abs((vertex - left) * (vertex - right)) / 6.0 * (1.0 + 0.5 * CAUTION * abs(third / bend))
    loss = abs(bend) * away * away
    tolerance = RISE * abs(f_middle)
    last = (gain + loss < tolerance).where(middle, vertex)
    near = larger(abs(vertex - predicted), abs(middle - predicted)) < 0.3  # else three points say little about the top
    for condition in (bend < 0.0, curvature < 0.0, abs(vertex) < 1.0, near, loss < tolerance):
        sound = condition.where(sound, 0.0)
    return last, place_at(last, *places), f_middle, slope, bend, gain, loss, sound


def last_trials(state, column, lanes):
    """Return the number of lanes of a signal whose last trial is not the middle one."""
    count = 0
    for k in range(column, column + lanes):
        count += 1 if state[Z_LAST, k] != state[Z_MIDDLE, k] else 0
    return count


@lanewise(
    (
        *(Z_LEFT, F_LEFT, Z_RIGHT, F_RIGHT, Z_MIDDLE, F_MIDDLE, Z_LAST, F_LAST, *FIVE[1:4]),
        *(HALF_TURN, OTHER, THIRD, SLOPE, BEND, GAIN, LOSS, SOUND, *THREE),
    ),
    (PEAK, PEAK_X, PEAK_FAR, BEYOND, EVALUATIONS, FINAL, CONFIRMED),
)
def settle_peaks(
    left, f_left, right, f_right, middle, f_middle, last, f_last, f1, f2, f3, far, other, third, slope, bend, gain,
    loss, sound, *places
):  # fmt: skip
    """Note the peaks, whether the trials confirm them, and whether no other summit may be higher either."""
    to_left, to_right = middle - left, middle - right
    step = (slope + to_left * bend + third / 6.0 * to_left * to_right) / (
        2.0 * bend + third / 3.0 * (to_left + to_right)
    )
    vertex = (abs(step) < 0.01).where(middle - step, last)
    best = (f_last < f_middle).where(f_middle, f_last)
    tolerance = RISE * abs(best)
    confirmed = (f_last < f_middle).where((gain < tolerance).where(sound, 0.0), sound)
    confirmed = (best < f2).where(0.0, confirmed)
    tried = (gain + loss < RISE * abs(f_middle)).where(3.0, 4.0)
    final = (best + tolerance < other).where(0.0, confirmed)
    best = larger(f_right, larger(f_left, best))
    floor = NOISE * larger(abs(f1), larger(abs(f2), abs(f3)))
    beyond = larger(gain + loss, floor) + tolerance
    return best, place_at(vertex, *places), far, beyond, tried, final, confirmed


@lanewise((PEAK, PEAK_X, PEAK_FAR, EVALUATIONS), (PEAK_ANGLE, EVALUATIONS))
def place_angles(peak, tangent, far, trials):
    """Replace the tangents of peaks by their angles from the near-toggle, from 0 to 360, and count the samples."""
    half_angle = arctangent(tangent, tangent.graph.constant(1.0), Node.where)
    angle = math.degrees(2.0) * half_angle + 180.0 * far
    angle = (angle < 0.0).where(angle + 360.0, angle)
    return (-math.inf < peak).where(angle, math.nan), trials + SAMPLES
