"""Search for the peaks of designs on their pieces, several designs side by side, one in each lane.

A turn follows each piece there and back, so the samples on the way there show everything. Those of all pieces of a few
designs are taken first, and the best summit of each signal on each piece noted. Only a summit that may exceed all other
samples of its design is confirmed by trials, as in `engine.peaks.turns`: such summits of any pieces and signals side
by side.

`search` is plain Python that is translated to machine code.
"""

import math

from linksweep.engine.kernel.instructions import call
from linksweep.engine.peaks.brackets import BEYOND, EVALUATIONS, PEAK, gather, refine
from linksweep.engine.peaks.samples import FEW, HALF
from linksweep.engine.peaks.summits import open_brackets
from linksweep.engine.peaks.turns import (
    CONFIRMED,
    FINAL,
    NUMBER,
    OTHER,
    REACH,
    SUMMIT,
    comparison_of_half,
    pick_sample,
    place_samples,
    try_vertices,
)

OF_PIECE = EVALUATIONS + 1
"""Row of `best` after those of a peak: the number of the piece."""
# rows of `summits`: piece, signal, and place in `highest`; the best summit's number, the heights that it and any other
# may reach
PLACE, SIGNAL, OF_DESIGN, AT, HEIGHT, NEXT = range(6)
SUMMIT_ROWS = 6
HIDDEN_RISE = 0.1
"""Most that a signal may rise between a sample and its neighbours if these are as high, relative to the fall to the
next ones. About the end of a piece signals are even, and a quartic rises by 1/48."""

compare_few, compare_many = comparison_of_half(FEW), comparison_of_half(HALF)


def search(
    first, last, together, lanes, counts, sizes, parameters, parameter_at, grades, prepare, enter, sample, evaluate,
    constants, x, rows, state, trials, highest, summits, brackets, gathered, tops, best
):  # fmt: skip
    """Write the peaks of blocks `first` … `last` of designs, so many `together`, to `best`: a column for each design of
    each signal, one signal after the other.

    `counts` are the numbers of the designs' pieces. Those of a block are searched one after the other: a row of
    `constants` and of other tables for each, and in `tops` a column for each piece of each signal. `highest` are levels
    for each design of each signal, one signal after the other; peaks that lie lower matter to nobody.
    """
    designs, pieces, columns, half = len(counts), len(constants) // together, state.shape[1], grades.shape[1] - 1
    of_designs, tables = (sizes, parameters, parameter_at), (constants, x, rows)
    sampling = grades, prepare, enter, sample
    for start in range(first, last, together):
        stop, count = min(start + together, last), 0
        for block in range(start, stop):
            front = block * lanes
            for piece in range(largest_count(counts, front, lanes)):
                row = (block - start) * pieces + piece
                sample_piece(front, piece, designs, lanes, of_designs, sampling, tables, row)
                compare(rows[row], columns, half, state)
                for lane in range(min(lanes, designs - front)):
                    if piece < counts[front + lane]:
                        place, own = row * lanes + lane, (front + lane, designs)
                        count = note_summits(rows[row], state, lanes, place, half, own, highest, summits, count, tops)
        count = drop_lower(summits, count, highest)
        confirm(summits, count, lanes, half, tables, evaluate, trials, brackets, gathered, tops)
        for design in range(start * lanes, min(stop * lanes, designs)):
            place = (design // lanes - start) * pieces * lanes + design % lanes
            keep_highest(tops, place, lanes, counts[design], best, design, designs)


def largest_count(counts, front, lanes):
    """Return the largest of the numbers that are counted for designs side by side."""
    most = 0
    for design in range(front, min(front + lanes, len(counts))):
        most = max(most, counts[design])
    return most


def sample_piece(front, piece, designs, lanes, of_designs, sampling, tables, row):
    """Sample a piece of designs side by side, into a row of tables that follows those of their earlier pieces."""
    (grades, prepare, enter, sample), (constants, x, rows) = sampling, tables
    if piece == 0:
        call(prepare, (front, designs, *of_designs, constants[row]))
    for k in range(constants.shape[1] if piece > 0 else 0):
        constants[row, k] = constants[row - piece, k]
    call(enter, (front, piece, *of_designs, constants[row]))
    place_samples(constants[row], lanes, grades, 1.0, x[row])
    call(sample, (constants[row], x[row], rows[row]))


def compare(rows, columns, half, state):
    """Note the best summit of each signal on pieces side by side, and how high that and any other may reach."""
    if half == FEW:
        compare_few(rows[(FEW - 1) * columns :], 2 * FEW + 4, columns, state)
    else:
        compare_many(rows[(HALF - 1) * columns :], 2 * HALF + 4, columns, state)


def note_summits(rows, state, lanes, place, half, own, highest, summits, count, tops):
    """Note the best summit of each signal on a piece, and its highest sample; return how many summits there are."""
    columns, lane, (design, designs) = state.shape[1], place % lanes, own
    signals = columns // lanes
    width = tops.shape[1] // signals
    for signal in range(signals):
        k, tag, of_design = signal * lanes + lane, signal * width + place, signal * designs + design
        value, height = rows[int(state[SUMMIT, k]) * columns + k], math.inf
        if state[REACH, k] > -math.inf:  # else nothing is known
            height = max(state[REACH, k], hidden_height(rows, int(state[SUMMIT, k]), columns, k))
        if value > highest[of_design]:
            highest[of_design] = value
        summits[PLACE, count], summits[SIGNAL, count], summits[OF_DESIGN, count] = place, signal, of_design
        summits[AT, count], summits[HEIGHT, count], summits[NEXT, count] = state[SUMMIT, k], height, state[OTHER, k]
        tops[PEAK, tag], tops[BEYOND, tag], tops[EVALUATIONS, tag] = value, 0.0, 4 * half
        count += 1
    return count


def hidden_height(rows, at, columns, k):
    """Return the height that a signal may reach between a sample and neighbours as high: by the fall beyond them."""
    value = rows[at * columns + k]
    fall = max(0.0, max(value - rows[(at - 2) * columns + k], value - rows[(at + 2) * columns + k]))
    return value + HIDDEN_RISE * fall


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


def confirm(summits, count, lanes, half, tables, evaluate, trials, brackets, gathered, tops):
    """Write the peaks about summits: those that trials confirm, or else those of brackets."""
    constants, x, rows = tables
    width, opened = len(constants) * lanes, 0
    columns = tops.shape[1] // width * lanes
    for front in range(0, count, lanes):
        for lane in range(lanes):
            k = min(front + lane, count - 1)
            place, signal = int(summits[PLACE, k]), int(summits[SIGNAL, k])
            gather(constants, place, lanes, gathered, lane)
            trials[SUMMIT, lane], trials[OTHER, lane], trials[NUMBER, lane] = summits[AT, k], summits[NEXT, k], signal
            samples = rows[place // lanes], x[place // lanes], half, lanes, columns
            pick_sample(samples, signal * lanes + place % lanes, trials, lane)
        try_vertices(gathered, trials, lanes, lanes, NUMBER, evaluate)
        for lane in range(min(lanes, count - front)):
            place, signal = int(summits[PLACE, front + lane]), int(summits[SIGNAL, front + lane])
            tag = signal * width + place
            for number in range(len(tops)):
                tops[number, tag] = trials[number, lane]
            tops[EVALUATIONS, tag] += 4 * half
            if trials[FINAL, lane] == 0.0:
                if 2 * (opened + 4 * half) > brackets.shape[1]:
                    refine(brackets, opened, lanes, width, 0, constants, gathered, evaluate, tops)
                    opened = 0
                known = int(trials[SUMMIT, lane]) if trials[CONFIRMED, lane] > 0.0 else -1
                samples = rows[place // lanes], x[place // lanes], half, lanes, columns
                opened = open_brackets(samples, signal, place % lanes, known, True, True, tag, brackets, opened, tops)
    refine(brackets, opened, lanes, width, 0, constants, gathered, evaluate, tops)


def keep_highest(tops, place, lanes, pieces, best, design, designs):
    """Write the highest peak of each signal on the pieces of a design, of equal ones the first; NaN where there is
    none."""
    signals = best.shape[1] // designs
    width = tops.shape[1] // signals
    for signal in range(signals):
        winner, of_piece, reach, evaluations = -1, 0, -math.inf, 0.0
        for piece in range(pieces):
            k = signal * width + place + piece * lanes
            value = tops[PEAK, k]
            evaluations += tops[EVALUATIONS, k]
            if value + tops[BEYOND, k] > reach:
                reach = value + tops[BEYOND, k]
            if value == value and (winner < 0 or value > tops[PEAK, max(winner, 0)]):
                winner, of_piece = k, piece
        tag = signal * designs + design
        for row in range(len(best)):
            best[row, tag] = math.nan
        if winner >= 0:
            for row in range(len(tops)):
                best[row, tag] = tops[row, winner]
            best[BEYOND, tag] = reach - best[PEAK, tag] if abs(best[PEAK, tag]) < math.inf else 0.0
            best[EVALUATIONS, tag], best[OF_PIECE, tag] = evaluations, float(of_piece)
