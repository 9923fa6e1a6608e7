"""Search for the peaks of designs on their pieces, several pieces side by side, one in each lane.

A turn follows each piece there and back, so the samples on the way there show everything. Those of all pieces of a few
designs are taken first, and the best summit of each signal on each piece noted. Only a summit that may exceed all other
samples of its design is confirmed by trials, as in `engine.peaks.abreast`: such summits of any pieces and signals side
by side.

`search` is plain Python that is translated to machine code.
"""

import math

from linksweep.engine.kernel.instructions import call
from linksweep.engine.peaks.abreast import (
    CONFIRMED,
    EVALUATIONS,
    FINAL,
    NUMBER,
    OTHER,
    REACH,
    SUMMIT,
    close_comparison_of_half,
    comparison_of_half,
    pick_sample,
    place_samples,
    refine,
    try_vertices,
)
from linksweep.engine.peaks.brackets import BEYOND, PEAK
from linksweep.engine.peaks.search import FEW, HALF
from linksweep.engine.peaks.stragglers import open_brackets

# rows of `summits`: piece, signal, and place in `highest`; the best summit's number, the heights that it and any other
# may reach
PIECE, SIGNAL, OF_DESIGN, AT, HEIGHT, NEXT = range(6)
SUMMIT_ROWS = 6
HIDDEN = 0.1
"""Most that a signal may rise between a sample and its neighbours if these are as high, relative to the fall to the
next ones. About the end of a piece signals are even, and a quartic rises by 1/48."""

NARROW = 0.5
"""Width of a near-toggle below which samples may lie too far apart to show every summit."""

compare_samples_of_half, compare_samples_of_few = (comparison_of_half(half) for half in (HALF, FEW))
compare_closely = close_comparison_of_half(HALF)


def search(
    first, last, bounds, owners, lanes, sizes, parameters, parameter_at, grades, prepare, share, sample, evaluate,
    constants, x, rows, state, trials, highest, summits, brackets, gathered, best
):  # fmt: skip
    """Write the peaks of groups `first` … `last` of designs to `best`: a column for each piece of each signal, one
    signal after the other.

    A group has the pieces between two `bounds`; `owners` are their designs, in order.
    """
    columns, half = state.shape[1], grades.shape[1] - 1
    signals = columns // lanes
    width = best.shape[1] // signals
    for group in range(first, last):
        start, stop = bounds[group], bounds[group + 1]
        for k in range((owners[stop - 1] - owners[start] + 1) * signals):
            highest[k] = -math.inf
        count = 0
        for block in range((stop - start + lanes - 1) // lanes):
            front = start + block * lanes
            call(prepare, (front, stop, sizes, parameters, parameter_at, constants[block]))
            if place_samples(constants[block], lanes, grades, x[block]) > 0:
                call(share, (constants[block], x[block]))
            call(sample, (constants[block], x[block], rows[block]))
            if half == FEW:
                compare_samples_of_few(rows[block, (FEW - 1) * columns :], 2 * FEW + 4, state, columns)
            elif narrowest(constants[block], lanes) < NARROW:
                compare_closely(rows[block, (HALF - 1) * columns :], 2 * HALF + 4, state, columns)
            else:
                compare_samples_of_half(rows[block, (HALF - 1) * columns :], 2 * HALF + 4, state, columns)
            for signal in range(signals):
                for lane in range(min(lanes, stop - front)):
                    piece, k = front + lane, signal * lanes + lane
                    of_design, tag = (owners[piece] - owners[start]) * signals + signal, signal * width + piece
                    value, height = rows[block, int(state[SUMMIT, k]) * columns + k], math.inf
                    if state[REACH, k] > -math.inf:  # else nothing is known
                        height = max(state[REACH, k], hidden_height(rows[block], int(state[SUMMIT, k]), columns, k))
                    if value > highest[of_design]:
                        highest[of_design] = value
                    summits[PIECE, count], summits[SIGNAL, count] = piece, signal
                    summits[OF_DESIGN, count], summits[AT, count] = of_design, state[SUMMIT, k]
                    summits[HEIGHT, count], summits[NEXT, count] = height, state[OTHER, k]
                    best[PEAK, tag], best[BEYOND, tag], best[EVALUATIONS, tag] = value, 0.0, 4 * half
                    count += 1
        count = drop_lower(summits, count, highest)
        confirm(
            start, count, lanes, half, width, evaluate, constants, x, rows, columns, trials, summits, brackets,
            gathered, best
        )  # fmt: skip


def narrowest(constants, lanes):
    """Return the least width of a near-toggle about either end of pieces side by side."""
    least = math.inf
    for k in range(2 * lanes):
        least = min(least, constants[k])
    return least


def hidden_height(rows, at, columns, k):
    """Return the height that a signal may reach between a sample and neighbours as high: by the fall beyond them."""
    value = rows[at * columns + k]
    fall = max(0.0, max(value - rows[(at - 2) * columns + k], value - rows[(at + 2) * columns + k]))
    return value + HIDDEN * fall


def drop_lower(summits, count, highest):
    """Keep the summits that may exceed all samples of their design, and pieces without any; return how many."""
    kept = 0
    for k in range(count):
        height = summits[HEIGHT, k]
        if not height < highest[int(summits[OF_DESIGN, k])]:
            for row in range(SUMMIT_ROWS):
                summits[row, kept] = summits[row, k]
            kept += 1
    return kept


def confirm(
    start, count, lanes, half, width, evaluate, constants, x, rows, columns, trials, summits, brackets, gathered, best
):
    """Write the peaks about summits: those that trials confirm, or else those of brackets."""
    opened = 0
    for front in range(0, count, lanes):
        for lane in range(lanes):
            k = min(front + lane, count - 1)
            piece, signal = int(summits[PIECE, k]) - start, int(summits[SIGNAL, k])
            block, its = piece // lanes, piece % lanes
            for row in range(len(gathered) // lanes):
                gathered[row * lanes + lane] = constants[block, row * lanes + its]
            trials[SUMMIT, lane], trials[OTHER, lane], trials[NUMBER, lane] = summits[AT, k], summits[NEXT, k], signal
            pick_sample(rows[block], x[block], half, lanes, columns, signal * lanes + its, its, lane, trials)
        try_vertices(gathered, trials, lanes, lanes, evaluate)
        for lane in range(min(lanes, count - front)):
            piece, signal = int(summits[PIECE, front + lane]), int(summits[SIGNAL, front + lane])
            block, its, tag = (piece - start) // lanes, (piece - start) % lanes, signal * width + piece
            for row in range(len(best)):
                best[row, tag] = trials[row, lane]
            best[EVALUATIONS, tag] += 4 * half
            if trials[FINAL, lane] == 0.0:
                if opened + 2 * half > brackets.shape[1]:
                    refine(brackets, opened, lanes, width, start, constants, gathered, evaluate, best)
                    opened = 0
                known = int(trials[SUMMIT, lane]) if trials[CONFIRMED, lane] > 0.0 else -1
                opened = open_brackets(
                    rows[block], x[block], half, lanes, columns, signal * lanes + its, its, known, True, signal, tag,
                    brackets, opened, best,
                )  # fmt: skip
    refine(brackets, opened, lanes, width, start, constants, gathered, evaluate, best)
