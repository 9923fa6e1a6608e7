"""Find the dips of signals on pieces of a turn: where they come nearest to zero, beyond it too, and how narrow that is.

A sample nearer to zero than those beside it lies in a dip, a bracket of which is refined as those of peaks are. A dip
beyond zero has a zero on either side. Else, from its least value x on, the signal is about x + y·tan²((θ − θ0)/2): its
half-width is √(x/y), a tangent of half an angle. Where samples beside it do not fit, there may be another dip: as of a
flat place, another look shows.

All is plain Python that is translated to machine code. The nth dip of a lane is in column n·lanes + lane of `dips`.
"""

import math

from linksweep.engine.kernel.instructions import call
from linksweep.engine.near_zero.crossings import FLAT, open_crossing
from linksweep.engine.near_zero.places import next_place
from linksweep.engine.near_zero.samples import MOST, SPARE, noise, note, place, sample, used_columns
from linksweep.engine.peaks.brackets import (
    BRACKET_ROWS,
    DONE,
    F1,
    F2,
    FAR,
    FB,
    ROUNDS,
    SIGNAL,
    TOP_X,
    X1,
    X2,
    evaluate_trials,
    insert_trials,
    open_bracket,
    place_trials,
)
from linksweep.engine.peaks.lanewise import lanewise

TOGGLE, BOUND, JUMP = 0.0, 1.0, 2.0
"""Kinds of signals: those whose zeros are sought, and dips on their positive side, where a machine closes; those whose
zeros and dips are sought on both sides; and those whose zeros alone are."""
WIDEST = math.tan(0.3)
"""Half-width from which on a dip is as smooth as the motion of the links."""
HARDLY_LESS = 0.9
"""Least value of a parabola, relative to the sample in its middle, from which on a dip does not reach zero: beside a
toggle, where a signal is steep, a dip fell by 2.3 times as much as its parabola."""
UNLIKE = 4.0
"""Ratio of rises beside a dip, in units of those of its parabola, from which on the dip may be two."""
SMOOTH = 0.1
"""By how much the root of such a rise exceeds 1 where nothing but the motion of the links bends a signal."""
KNOWN = 1e-2
"""Distance of two dips that are the same, relative to the bracket of one."""
WIDTH_STEPS = 5
"""Steps towards the half-width of a dip."""
# rows of `dips` besides those of brackets: the samples beside it; the number of its signal; its place, the value there,
# its half-width, the one before and the rise over that; whether it counts
A, F_A, C, F_C, OWN, TOP, F_TOP, BROAD, LAST, STEEP, COUNTS = range(BRACKET_ROWS, BRACKET_ROWS + 11)
DIP_ROWS = BRACKET_ROWS + 11


def look_for_dips(samples, noted, half, signal, signals, kind, dips, counts, owner, results):
    """Open brackets of a signal's dips about places on a piece; values that are noise apart are the same."""
    places = samples[2]
    for step in range(places - 2 * SPARE):
        if noted < 1.0:
            break
        j, noted = next_place(noted, step)
        before, here, after = sample(samples, j - 1, signal), sample(samples, j, signal), sample(samples, j + 1, signal)
        side = 1.0 if here > 0.0 else -1.0
        sought = JUMP if kind == TOGGLE and side < 0.0 else kind
        if SPARE <= j < places - SPARE and side * here <= side * before and side * here < side * after:
            higher, i, k = side * here + noise(samples, j, signal, signals), j - 1, j + 1
            while i > 0 and side * sample(samples, i, signal) <= higher:
                i -= 1
            while k < places - 1 and side * sample(samples, k, signal) <= higher:
                k += 1
            a, b, c = place(samples, i), place(samples, j), place(samples, k)
            f_a, f_b, f_c = side * sample(samples, i, signal), side * here, side * sample(samples, k, signal)
            if f_a > higher and f_c > higher and may_matter(a, f_a, b, f_b, c, f_c, sought):
                number = float(signal + signals) if side > 0.0 else float(signal)  # dips are peaks of opposites
                bracket = (a, -f_a), (b, -f_b), (c, -f_c)
                open_dip(dips, counts, samples[4], samples[5], bracket, half, number, signal, owner, results)


def may_matter(a, f_a, b, f_b, c, f_c, kind):
    """Return whether three points may lie in a narrow dip, or in one beyond zero, by the parabola through them."""
    fall, rise = (f_a - f_b) / (b - a), (f_c - f_b) / (c - b)
    slope, curvature = (rise * (b - a) - fall * (c - b)) / (c - a), (fall + rise) / (c - a)
    wide = WIDEST * (1.0 + b * b)
    least = f_b - 0.25 * slope * slope / curvature
    return least < (HARDLY_LESS * f_b if kind == JUMP else 2.0 * curvature * wide * wide)


def open_dip(dips, counts, lanes, lane, bracket, half, number, signal, owner, results):
    """Open the bracket of a dip."""
    nth = counts[lane]
    if nth == MOST:
        results[1][owner] = 1.0
    else:
        k, (before, top, after) = nth * lanes + lane, bracket
        counts[lane] += 1
        open_bracket(dips, k, before, top, after, half, number, owner, 0.0)
        (dips[A, k], dips[F_A, k]), (dips[C, k], dips[F_C, k]) = before, after
        dips[OWN, k], dips[COUNTS, k] = signal, 1.0


def refine_dips(dips, counts, lanes, own, evaluate):
    """Refine all brackets of dips."""
    columns = used_columns(counts, lanes)
    for k in range(columns):
        if k // lanes >= counts[k % lanes]:
            dips[COUNTS, k] = 0.0
    still_open = columns
    for _ in range(ROUNDS):
        if still_open == 0:
            break
        place_trials(dips, columns)
        evaluate_trials(dips, 0, columns, own, evaluate)
        insert_trials(dips, columns)
        still_open = 0
        for k in range(columns):
            if dips[COUNTS, k] > 0.0 and dips[DONE, k] > 0.0:
                dips[TOP, k], dips[F_TOP, k], dips[COUNTS, k] = dips[TOP_X, k], dips[FB, k], 0.0
            still_open += 1 if dips[COUNTS, k] > 0.0 else 0


def check_noise(dips, counts, lanes, signals, own, evaluate, front, results):
    """Leave designs with a dip that noise may take beyond zero."""
    columns = used_columns(counts, lanes)
    for k in range(columns):
        dips[X1, k], dips[X2, k] = dips[TOP, k], dips[OWN, k] + 2.0 * signals
    call(evaluate, (own, dips, X1, F1, FAR, X2, 0, columns))
    for k in range(columns):
        value = -dips[F_TOP, k] if dips[SIGNAL, k] >= signals else dips[F_TOP, k]
        if k // lanes < counts[k % lanes] and not dips[F1, k] - value < abs(value):
            results[1][front + k % lanes] = 1.0


def open_sides(dips, counts, lanes, signals, kinds, crossings, crossed, front, results):
    """Open brackets of the zeros on both sides of dips beyond zero; the others count, but those of jumps, and those of
    toggles where the machine does not close."""
    for lane in range(lanes):
        for nth in range(counts[lane]):
            k, owner = nth * lanes + lane, front + lane
            top, f_top, signal, half = dips[TOP, k], dips[F_TOP, k], dips[OWN, k], dips[FAR, k]
            kind, new = kinds[int(signal)], not is_known(dips, nth, lanes, lane)
            sign = -1.0 if dips[SIGNAL, k] >= signals else 1.0
            matters = kind == BOUND or (kind == TOGGLE and sign < 0.0)
            dips[COUNTS, k] = 1.0 if new and f_top <= 0.0 and matters else 0.0
            if new and f_top > 0.0:
                for end, at_end in ((dips[A, k], dips[F_A, k]), (dips[C, k], dips[F_C, k])):
                    bracket = top, sign * f_top, end, sign * at_end
                    open_crossing(crossings, crossed, lanes, lane, bracket, half, signal, owner, results)


def is_known(dips, nth, lanes, lane):
    """Return whether a dip is one of those before: about the end of a piece, the pieces on both sides find it."""
    k, known = nth * lanes + lane, False
    for other in range(nth):
        p = other * lanes + lane
        top = dips[TOP, p] if dips[FAR, p] == dips[FAR, k] else -1.0 / dips[TOP, p]
        if dips[OWN, p] == dips[OWN, k] and abs(top - dips[TOP, k]) < KNOWN * (dips[C, k] - dips[A, k]):
            known = True
    return known


def measure_widths(dips, counts, lanes, own, evaluate, front, results):
    """Note the narrow dips with their half-widths, and where there may be another dip."""
    columns = used_columns(counts, lanes)
    width_of_parabola(dips, columns)
    for _ in range(WIDTH_STEPS):
        place_beside(dips, columns)
        call(evaluate, (own, dips, X1, F1, FAR, SIGNAL, 0, columns))
        call(evaluate, (own, dips, X2, F2, FAR, SIGNAL, 0, columns))
        measure_width(dips, columns)
    for k in range(columns):
        if dips[COUNTS, k] > 0.0 and dips[BROAD, k] < WIDEST:
            owner, top, half, signal = front + k % lanes, dips[TOP, k], dips[FAR, k], dips[OWN, k]
            note(results, owner, top, half, signal, dips[BROAD, k])
            if may_be_two(dips, k):
                note(results, owner, top, half, signal, -FLAT)


@lanewise((TOP, F_TOP, A, F_A, C, F_C), (BROAD, LAST, STEEP))
def width_of_parabola(top, f_top, a, f_a, c, f_c):
    """Return the half-width of the parabola through a dip and the samples beside it."""
    back, ahead = (top - a) / (1.0 + top * a), (c - top) / (1.0 + top * c)
    curvature = ((f_top - f_a) / back + (f_top - f_c) / ahead) / (back + ahead)
    return (-f_top / curvature).sqrt(), 0.0 * f_top, 0.0 * f_top


@lanewise((TOP, BROAD), (BROAD, X1, X2))
def place_beside(top, width):
    """Place trials at the half-width on either side."""
    width = (width < WIDEST).where(width, WIDEST)
    return width, (top - width) / (1.0 + top * width), (top + width) / (1.0 - top * width)


@lanewise((F_TOP, F1, F2, BROAD, LAST, STEEP), (BROAD, LAST, STEEP))
def measure_width(f_top, before, after, width, last, last_steep):
    """Return the half-width at which the signal has twice its least value, by the steepness of the rise to the trials
    and to those before: it is taken as linear in the width, 0 at first, as that of a parabola. A trial beyond a toggle
    has no value."""
    before, after = (before < math.inf).where(before, after), (after < math.inf).where(after, before)
    depth, steep = -f_top, (f_top - 0.5 * (before + after)) / width
    bend = (steep - last_steep) / (width - last)
    start = steep - bend * width
    root = 2.0 * depth / (start + (start * start + 4.0 * bend * depth).sqrt())
    plain = (steep > 0.0).where((width * depth / steep).sqrt(), WIDEST)
    linear = (abs(width - last) > 0.01 * width).where(root, plain)
    return (linear > 0.0).where(linear, plain), width, steep


def may_be_two(dips, k):
    """Return whether there may be another dip beside a dip, by the samples on either side.

    With another one at a distance d the signal rises as x²·(1 − x/d)². In units of the parabola that is (1 + a/d)² at a
    sample at a distance a on the side away from it, and (1 − c/d)² at a sample at c on its own side.
    """
    a, c = distance(dips, k, A), distance(dips, k, C)
    depth, around = -dips[F_TOP, k], 0.5 * (a + c)
    at_a, at_c = (depth + dips[F_A, k]) / -(depth * a * a), (depth + dips[F_C, k]) / -(depth * c * c)
    most_at_a, most_at_c = 1.0 + SMOOTH + a / (c + around), 1.0 + SMOOTH + c / (a + around)
    few = at_a < most_at_a * most_at_a and at_c < most_at_c * most_at_c
    return not (few and max(1.0, at_a, at_c) < UNLIKE * min(1.0, at_a, at_c))


def distance(dips, k, end):
    """Return how far a sample lies from a dip, in half-widths of the dip."""
    return abs((dips[end, k] - dips[TOP, k]) / (1.0 + dips[end, k] * dips[TOP, k])) / dips[BROAD, k]
