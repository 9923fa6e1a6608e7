"""Find the zeros of a signal on pieces of the turn, those of several designs side by side, one in each lane.

The signal is evaluated at the samples on the way from a piece's start to its end. Neighbours of opposite signs bracket
a zero, and so do a sample that is nearest to zero and the vertex of the parabola about it, where that lies beyond. The
Illinois method refines the brackets of many pieces at once.

`find_zeros` is plain Python that is translated to machine code.

Source: Dowell and Jarratt, A modified regula falsi method, BIT 11 (1971).
"""

import math

from linksweep.engine.kernel.instructions import call
from linksweep.engine.peaks.brackets import gather
from linksweep.engine.peaks.lanewise import lanewise
from linksweep.engine.peaks.on_pieces import largest_count, sample_piece

MOST_ZEROS = 12
"""Zeros of one piece, at most."""
STEPS = 100
"""Steps to each zero, at most: more than it takes beside a kink."""
CLOSED = 1e-15
"""Step, as a tangent, that ends the search for a zero."""

# rows of `zeros_at`: two ends of each bracket with their values, a trial with its value; half turn, number of the
# signal, row and lane of the piece; whether the bracket holds a zero
START, AT_START, STOP, AT_STOP, TRIAL, AT_TRIAL, SIDE, SIGNAL_NUMBER, OWNER, HOLDS = range(10)
ZERO_ROWS = 10
UNKNOWN, NONE, OPEN, SETTLED = range(4)


def find_zeros(
    first, last, together, lanes, counts, sizes, parameters, parameter_at, grades, prepare, enter, sample, evaluate,
    constants, x, rows, zeros_at, gathered, zeros
):  # fmt: skip
    """Write the zeros of the pieces of designs in blocks `first` … `last`, so many `together`, to `zeros` (number,
    piece of all, nth): tangents, half turns. `counts` are the numbers of the designs' pieces."""
    designs, pieces, half = len(counts), len(constants) // together, grades.shape[1] - 1
    of_designs, tables = (sizes, parameters, parameter_at), (constants, x, rows)
    sampling = grades, prepare, enter, sample
    for start in range(first, last, together):
        count = 0
        for block in range(start, min(start + together, last)):
            front = block * lanes
            for piece in range(largest_count(counts, front, lanes)):
                row = (block - start) * pieces + piece
                sample_piece(front, piece, designs, lanes, of_designs, sampling, tables, row)
                for lane in range(min(lanes, designs - front)):
                    if piece < counts[front + lane]:
                        count = open_zeros(rows[row], x[row], half, lanes, row * lanes + lane, zeros_at, count)
        evaluate_trials(zeros_at, count, lanes, constants, gathered, evaluate)
        keep_vertices(zeros_at, count)
        count = drop_closed(zeros_at, count, start, lanes, pieces, zeros)
        for _ in range(STEPS):
            if count == 0:
                break
            place_on_lines(zeros_at, count)
            evaluate_trials(zeros_at, count, lanes, constants, gathered, evaluate)
            narrow(zeros_at, count)
            count = drop_closed(zeros_at, count, start, lanes, pieces, zeros)


def open_zeros(rows, x, half, lanes, owner, zeros_at, count):
    """Open brackets of zeros between samples of a piece, and beside samples that are nearest to zero; return their
    number."""
    lane = owner % lanes
    for j in range(half, 3 * half):
        far = j // (2 * half)
        at = (j + 1 + 2 * far) * lanes + lane
        here, ahead = rows[j * lanes + lane], rows[(j + 1) * lanes + lane]
        if here == 0.0 or here * ahead < 0.0:
            bracket = x[at], here, x[at + lanes], ahead
            count = open_zero(zeros_at, count, bracket, x[at], far, 0, owner, OPEN)
        before = rows[(j - 1) * lanes + lane]
        if before * here > 0.0 and here * ahead > 0.0 and abs(here) < abs(before) and abs(here) < abs(ahead):
            step = 0.5 * (before - ahead) / (before + ahead - 2.0 * here)
            if abs(here) < 0.5 * abs(step * (ahead - before)):  # twice what the vertex lies nearer to zero
                vertex = x[at] + step * 0.5 * (x[at + lanes] - x[at - lanes])
                for side in (-1, 1):
                    end = at + side * lanes
                    value = before if side < 0 else ahead
                    count = open_zero(zeros_at, count, (vertex, here, x[end], value), vertex, far, 0, owner, UNKNOWN)
    return count


def open_zero(zeros_at, k, bracket, trial, half, signal, owner, holds):
    """Note a bracket, two ends with their values, in column k, if there is room; return the number of the next one."""
    if k == zeros_at.shape[1]:
        return k
    zeros_at[START, k], zeros_at[AT_START, k], zeros_at[STOP, k], zeros_at[AT_STOP, k] = bracket
    zeros_at[TRIAL, k], zeros_at[SIDE, k], zeros_at[SIGNAL_NUMBER, k] = trial, half, signal
    zeros_at[OWNER, k], zeros_at[HOLDS, k] = owner, holds
    return k + 1


def evaluate_trials(zeros_at, count, lanes, constants, gathered, evaluate):
    """Evaluate the signal at the trials of all brackets."""
    for front in range(0, count, lanes):
        for lane in range(lanes):
            owner = int(zeros_at[OWNER, min(front + lane, count - 1)])
            gather(constants, owner, lanes, gathered, lane)
        call(evaluate, (gathered, zeros_at, TRIAL, AT_TRIAL, SIDE, SIGNAL_NUMBER, front, front + lanes))


def keep_vertices(zeros_at, count):
    """Make the vertices the ends of their brackets; those that lie beyond zero hold a zero."""
    for k in range(count):
        beyond = zeros_at[AT_TRIAL, k] * zeros_at[AT_STOP, k] < 0.0
        if zeros_at[HOLDS, k] == UNKNOWN:
            zeros_at[AT_START, k], zeros_at[HOLDS, k] = zeros_at[AT_TRIAL, k], OPEN if beyond else NONE


@lanewise((START, AT_START, STOP, AT_STOP), (TRIAL,))
def place_on_lines(a, f_a, b, f_b):
    """Place trials where the lines through the ends of brackets are zero."""
    step = f_b * (b - a) / (f_b - f_a)
    return ((abs(step) < math.inf).where(b - step, b),)


@lanewise((START, AT_START, STOP, AT_STOP, TRIAL, AT_TRIAL, HOLDS), (START, AT_START, STOP, AT_STOP, HOLDS))
def narrow(a, f_a, b, f_b, x, f, holds):
    """Make the trials of open brackets their ends, by the Illinois method; one is closed where that hardly moves the
    end."""
    f = (f < 0.0).where(f, (f > 0.0).where(f, 0.0))  # where there is no value, the place itself is near enough
    closed = (abs(f) > 0.0).where((abs(x - b) < CLOSED).where(SETTLED, holds), SETTLED)
    ends = zip((a, 0.5 * f_a), (b, f_b), strict=True)
    start = (by_signs(f, f_b, same, other) for same, other in ends)
    new, old = (*start, x, f, closed), (a, f_a, b, f_b, holds)
    return tuple((holds > NONE).where((holds < SETTLED).where(p, q), q) for p, q in zip(new, old, strict=True))


def by_signs(x, y, same, other):
    """Return the one where both of two numbers are negative, or neither, else the other."""
    return (x < 0.0).where((y < 0.0).where(same, other), (y < 0.0).where(other, same))


def drop_closed(zeros_at, count, start, lanes, pieces, zeros):
    """Note the zeros that are found; return how many brackets remain."""
    still_open = 0
    for k in range(count):
        if zeros_at[HOLDS, k] == SETTLED:
            row, lane = int(zeros_at[OWNER, k]) // lanes, int(zeros_at[OWNER, k]) % lanes
            design = (start + row // pieces) * lanes + lane
            note_zero(zeros, design * pieces + row % pieces, zeros_at[STOP, k], zeros_at[SIDE, k])
        elif zeros_at[HOLDS, k] == OPEN:
            for row in range(ZERO_ROWS):
                zeros_at[row, still_open] = zeros_at[row, k]
            still_open += 1
    return still_open


def note_zero(zeros, owner, tangent, half):
    """Note a zero of a piece after those that are known."""
    for nth in range(zeros.shape[2]):
        if zeros[0, owner, nth] != zeros[0, owner, nth]:
            zeros[0, owner, nth], zeros[1, owner, nth] = tangent, half
            return
