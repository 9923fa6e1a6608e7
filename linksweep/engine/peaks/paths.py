"""Search for peaks along paths: open brackets about samples that may lead to a peak, and refine them.

A signal is evaluated at samples x along a path. Each sample above its neighbours opens a bracket (`engine.peaks.
brackets`), unless its curvature rules out that it exceeds the largest sample.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from linksweep.engine.kernel.machine_code import INTEGER, INTEGERS, TABLE
from linksweep.engine.kernel.translate import translated
from linksweep.engine.patience import Patience
from linksweep.engine.peaks import brackets
from linksweep.engine.peaks.brackets import BEYOND, PEAK, PEAK_X, open_bracket
from linksweep.engine.peaks.summits import by_tangents, might_reach, noise, uneven_slopes

SEARCHES, INTERPRETED = Patience(), 100_000
"""Count of samples and brackets that searches along paths have interpreted so far, and the most of them: they take a
tenth of a second, as their machine code does to be made."""
TWIN, SMOOTH = 1e-6, 1000.0
"""Distance between two samples, relative to that of the next, and difference of a signal there, in units of its noise,
below which they are the two sides of a break at which it does not jump: rounding tells which of them is higher, and the
bracket about one reaches beyond the other."""
UNEVEN = 4.0
"""Ratio of neighbouring steps below which the cubic through samples tells whether a summit hides between them."""
OF_PATHS = ("f8[:, :, :]", TABLE, TABLE, TABLE, INTEGER, TABLE, TABLE, INTEGERS)
OF_DIVISION, OF_ADVANCE = (TABLE, INTEGER), (TABLE, INTEGER, INTEGER, TABLE)
"""Kinds of the arguments of `open_on_paths`, and of `brackets.divide` and `advance`."""

Array = np.ndarray
Values = Callable[[Array, Array], Array]
"""A function of tags and places that returns the values of the tagged signals there."""


def open_brackets(rows: Array, x: Array, before: Array, after: Array, joined: bool, table: Array, best: Array) -> int:
    """Note the largest sample of each signal on each path, and open a bracket at each that could lead higher; return
    their number. Signals are counted path by path.

    Samples `rows` (path, signal, sample) are at `x` (path, sample), their neighbours at `before` and `after`. `joined`
    tells whether the ends of a path meet.
    """
    interpret = SEARCHES.should_interpret(rows.size, INTERPRETED)
    run: Callable = open_on_paths if interpret else translated(open_on_paths, OF_PATHS)
    arrays, places = map(np.ascontiguousarray, (rows, x, before, after)), np.empty(x.shape[1], dtype=np.int64)
    return run(*arrays, joined, table, best, places)


def refine(table: Array, count: int, best: Array, values: Values) -> None:
    """Refine brackets, the first `count` of a table, until none is left; `best` takes the peaks of their tags."""
    interpret = SEARCHES.should_interpret(count, INTERPRETED)
    steps = brackets.place_trials, brackets.insert_trials
    place_trials, insert_trials = (step if interpret else step.compiled for step in steps)
    divide: Callable = brackets.divide if interpret else translated(brackets.divide, OF_DIVISION)
    advance: Callable = brackets.advance if interpret else translated(brackets.advance, OF_ADVANCE)
    trials, values_there = (slice(first, first + len(brackets.TRIALS)) for first in (brackets.X1, brackets.F1))
    for _ in range(brackets.ROUNDS):
        if not count:
            return
        place_trials(table, count)
        tag = np.tile(table[brackets.TAG, :count].astype(int), len(brackets.TRIALS))
        table[values_there, :count] = values(tag, table[trials, :count].ravel()).reshape(-1, count)
        every = divide(table, count)
        insert_trials(table, count)
        count = advance(table, count, every, best)


# ------------------------------------------------------------------ plain Python that is translated to machine code


def open_on_paths(rows, x, before, after, joined, brackets, best, places):
    """Open the brackets of all signals on all paths: rows (path, signal, sample), tagged path by path."""
    count = 0
    paths, signals = rows.shape[:2]
    for path in range(paths):
        for k in range(signals):
            where = x[path], before[path], after[path]
            count = open_on_path(rows[path, k], *where, joined, path * signals + k, brackets, count, best, places)
    return count


def open_on_path(row, x, before, after, joined, tag, brackets, count, best, places):
    """Note a signal's largest sample and open a bracket at each that could lead higher; return their number.

    `joined` tells whether the path's ends meet; `before` and `after` are the places of the samples' neighbours.
    """
    n = len(row)
    summits = find_summits(row, joined, places)
    top, at = -math.inf, 0
    for k in range(summits if summits else n):  # a flat or falling signal has no summit
        j = places[k] if summits else k
        if row[j] > top:
            top, at = row[j], j
    around_top = neighbour(row, at, -1, joined), top, neighbour(row, at, 1, joined)
    best[PEAK, tag], best[BEYOND, tag] = top if top > -math.inf else math.nan, 10.0 * noise(*around_top)
    best[PEAK_X, tag] = x[at]
    if abs(top) == math.inf:
        return count
    for k in range(summits):
        j = places[k]
        first = last = j
        while first > 0 and x[first - 1] == x[j]:
            first -= 1
        left, value, right = neighbour(row, first, -1, joined), row[j], neighbour(row, j, 1, joined)
        floor, back, ahead = noise(left, value, right), x[j] - before[first], after[j] - x[j]
        if first > 0 and back < TWIN * ahead and value - left < SMOOTH * floor:
            first -= 1
            left = neighbour(row, first, -1, joined)
        elif last < n - 1 and ahead < TWIN * back and value - right < SMOOTH * floor:
            last += 1
            right = neighbour(row, last, 1, joined)
        ratio = (after[last] - x[j]) / (x[j] - before[first])
        if might_reach(left, value, right, ratio) > top + 10.0 * floor:
            start, end = (before[first], left), (after[last], right)
            open_bracket(brackets, count, start, (x[j], value), end, 0, 0, tag, floor)
            count += 1
    return open_between(row, x, x[n - 1] - before[0] if joined else 0.0, tag, brackets, count, top)


def open_between(row, x, period, tag, brackets, count, top):
    """Open a bracket between all neighbours between which a summit may hide, by the cubic through them and the next
    ones, where these are not much closer or farther; return their number. The ends of a path meet after its period, 0
    for never."""
    n = len(row)
    x0 = x1 = x2 = x3 = -math.inf
    f0 = f1 = f2 = f3 = math.nan
    for j in range(n + 3 if period > 0.0 else n):
        at = x[j] if j < n else x[j - n] + period
        if at > x3:
            x0, x1, x2, x3 = x1, x2, x3, at
            f0, f1, f2, f3 = f1, f2, f3, row[j] if j < n else row[j - n]
            back, ahead = (x1 - x0) / (x2 - x1), (x3 - x2) / (x2 - x1)
            if 1.0 / UNEVEN < back < UNEVEN and 1.0 / UNEVEN < ahead < UNEVEN:
                reach = by_tangents(f0, f1, f2, f3, uneven_slopes(f0, f1, f2, f3, back, ahead), back, ahead)
                floor = noise(f1, f2, f2)
                if reach > top + 10.0 * floor:
                    middle = 0.5 * (x1 + x2), -math.inf
                    open_bracket(brackets, count, (x1, f1), middle, (x2, f2), 0, 0, tag, floor)
                    count += 1
    return count


def find_summits(row, joined, places):
    """Write the positions of all samples that exceed their neighbours to `places`; return their number."""
    summits = 0
    for j in range(len(row)):
        if row[j] >= neighbour(row, j, -1, joined) and row[j] > neighbour(row, j, 1, joined):
            places[summits] = j
            summits += 1
    return summits


def neighbour(row, j, side, joined):
    """Return the sample beside another; −inf where there is none."""
    k, last = j + side, len(row) - 1
    if k < 0 or k > last:
        k = last if k < 0 else 0
        return row[k] if joined and row[k] == row[k] else -math.inf
    return row[k] if row[k] == row[k] else -math.inf
