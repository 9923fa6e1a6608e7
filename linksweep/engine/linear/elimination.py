"""Solve square systems by elimination with partial pivoting; plain Python that is translated and that also runs as is.

Every value is a row of lanes (`engine.linear.lanes`), one number of each system. A step that differs from system to
system, such as the exchange of two rows, is done in all of them, and each lane chooses which number it keeps. A step is
left out only where it changes no number of any lane, so none depends on its neighbours: zeros are positive, and systems
with numbers that are not finite have no solution.

A system is a list of terms, the entries of its matrix that are not always zero and those of its right side:

    terms[e] = row, column, source, beside      coefficients[e] · values[source], or the coefficient alone (source < 0)

The right side is column n, after the n unknowns. `beside` marks arms of forces in the rows of torques. Rows of `work`
hold numbers of terms, rows or columns, by the names below.
"""

import math

from linksweep.engine.linear.lanes import anywhere, choose, everywhere, load, scale_of, store

ROW, COLUMN, SOURCE, BESIDE = range(4)
# rows of `work`: terms; largest arm; scales of rows, columns and unknowns; unknowns; residual, high and low word
TERM, ARM, ROW_SCALE, COLUMN_SCALE, UNKNOWN_SCALE, UNKNOWN, HIGH, LOW = range(8)
WORK_ROWS = 8
SPLITTER = 134217729.0
"""2²⁷ + 1: splits a double into two halves whose products are exact."""


def solve(values, terms, coefficients, torques, matrix, work, solution):
    """Solve the systems of each block of lanes; `work` is room for what its rows hold."""
    for block in range(values.shape[1]):
        read_terms(values, block, terms, coefficients, work)
        equilibrate(terms, torques, work)
        finite = fill(terms, work, matrix)
        regular = eliminate(matrix)
        substitute(matrix)
        for i in range(len(matrix)):
            store(work, UNKNOWN, i, load(matrix, i, len(matrix)))
        write_unknowns(work, finite, regular, block, solution)


def solve_refined(values, terms, coefficients, torques, matrix, work, solution):
    """Solve the systems of each block of lanes, then once more for the residual."""
    for block in range(values.shape[1]):
        read_terms(values, block, terms, coefficients, work)
        equilibrate(terms, torques, work)
        for i in range(len(matrix)):
            store(work, UNKNOWN, i, everywhere(0.0))
        for _ in range(2):
            finite = fill(terms, work, matrix)
            replace_right_side(terms, work, matrix)
            regular = eliminate(matrix)
            substitute(matrix)
            for i in range(len(matrix)):
                store(work, UNKNOWN, i, load(work, UNKNOWN, i) + load(matrix, i, len(matrix)))
        write_unknowns(work, finite, regular, block, solution)


def write_unknowns(work, finite, regular, block, solution):
    """Write the unknowns in their own units; NaN for systems that are not finite or not regular."""
    nan = everywhere(math.nan)
    for i in range(len(solution)):
        x = load(work, UNKNOWN, i) * load(work, UNKNOWN_SCALE, i)
        store(solution, i, block, choose(finite, choose(regular, x, nan), nan))


def condition(values, terms, coefficients, torques, matrix, work, solution):
    """Compute the 1-norm condition number of the scaled matrices; `matrix` has room for the inverse."""
    for block in range(values.shape[1]):
        read_terms(values, block, terms, coefficients, work)
        equilibrate(terms, torques, work)
        fill(terms, work, matrix)
        norm = norm_of(matrix, 0)
        regular = eliminate(matrix)
        substitute(matrix)
        cond = norm * norm_of(matrix, len(matrix) + 1)
        store(solution, 0, block, choose(regular, cond, everywhere(math.inf)))


def larger(a, b):
    """Return the larger of two values; the first where they are equal, or where the second is NaN."""
    return choose(b > a, b, a)


def read_terms(values, block, terms, coefficients, work):
    """Compute the terms of one block of systems, and the largest arm beside a torque."""
    arm = everywhere(0.0)
    for e in range(len(terms)):
        term = everywhere(coefficients[e])
        if terms[e, SOURCE] >= 0:
            term = term * load(values, terms[e, SOURCE], block)
        if terms[e, BESIDE]:
            arm = larger(arm, abs(term))
        store(work, TERM, e, term)
    store(work, ARM, 0, arm)


def equilibrate(terms, torques, work):
    """Scale rows, then columns by powers of two, so that their largest entries lie in [1/2, 1) and no digit changes.

    Columns of torques are first scaled by the largest arm: the unit of length does not decide the pivots either.
    """
    n, arm = len(torques), load(work, ARM, 0)
    unit = choose(arm > everywhere(0.0), everywhere(1.0) / scale_of(arm), everywhere(1.0))
    for k in range(n):
        store(work, ROW_SCALE, k, everywhere(0.0))
        store(work, COLUMN_SCALE, k, everywhere(0.0))
    for e in range(len(terms)):
        i, j, term = terms[e, ROW], terms[e, COLUMN], load(work, TERM, e)
        if j < n:
            if torques[j]:
                term = term * unit
                store(work, TERM, e, term)
            store(work, ROW_SCALE, i, larger(load(work, ROW_SCALE, i), abs(term)))
    for i in range(n):
        store(work, ROW_SCALE, i, scale_of(load(work, ROW_SCALE, i)))
    for e in range(len(terms)):
        i, j = terms[e, ROW], terms[e, COLUMN]
        term = load(work, TERM, e) * load(work, ROW_SCALE, i)
        store(work, TERM, e, term)
        if j < n:
            store(work, COLUMN_SCALE, j, larger(load(work, COLUMN_SCALE, j), abs(term)))
    for j in range(n):
        scale = scale_of(load(work, COLUMN_SCALE, j))
        store(work, COLUMN_SCALE, j, scale)
        store(work, UNKNOWN_SCALE, j, scale * unit if torques[j] else scale)
    store(work, COLUMN_SCALE, n, everywhere(1.0))


def fill(terms, work, matrix):
    """Write terms to the matrix, beside it the right side and, where there is room, the unit matrix; return whether all
    are finite."""
    n, width = matrix.shape[:2]
    for i in range(n):
        for j in range(width):
            store(matrix, i, j, everywhere(1.0 if j == n + 1 + i else 0.0))
    total, zero = everywhere(0.0), everywhere(0.0)
    for e in range(len(terms)):
        i, j = terms[e, ROW], terms[e, COLUMN]
        entry = load(work, TERM, e) * load(work, COLUMN_SCALE, j) + zero  # −0 + 0 is 0
        total = total + abs(entry)
        store(matrix, i, j, entry)
    return everywhere(math.inf) > total


def eliminate(matrix):
    """Bring the matrix to triangular form, the columns beside it along; return whether no pivot is 0."""
    n, width = matrix.shape[:2]
    zero, least = everywhere(0.0), everywhere(math.inf)
    for k in range(n):
        exchange_rows(matrix, k, pivot_row(matrix, k))
        pivot = load(matrix, k, k)
        least = choose(least > abs(pivot), abs(pivot), least)
        inverse = everywhere(1.0) / pivot
        for i in range(k + 1, n):
            factor = load(matrix, i, k) * inverse
            if anywhere(abs(factor) > zero):
                for j in range(k + 1, width):
                    store(matrix, i, j, load(matrix, i, j) - factor * load(matrix, k, j))
    return least > zero


def pivot_row(matrix, k):
    """Return the number of the row, from k on, with the largest magnitude in column k: the first, as in LAPACK."""
    largest, row = abs(load(matrix, k, k)), everywhere(float(k))
    for i in range(k + 1, len(matrix)):
        size = abs(load(matrix, i, k))
        larger = size > largest
        largest, row = choose(larger, size, largest), choose(larger, everywhere(float(i)), row)
    return row


def exchange_rows(matrix, k, row):
    """Exchange row k with a row of each lane's own, from column k on."""
    n, width = matrix.shape[:2]
    for i in range(k + 1, n):
        here = row == everywhere(float(i))
        if anywhere(here):
            for j in range(k, width):
                upper, lower = load(matrix, k, j), load(matrix, i, j)
                store(matrix, k, j, choose(here, lower, upper))
                store(matrix, i, j, choose(here, upper, lower))


def substitute(matrix):
    """Solve the triangular system for each column beside it, which takes the solution."""
    n, width = matrix.shape[:2]
    for k in range(n - 1, -1, -1):
        for j in range(n, width):
            x = load(matrix, k, j) / load(matrix, k, k)
            store(matrix, k, j, x)
            for i in range(k):
                store(matrix, i, j, load(matrix, i, j) - load(matrix, i, k) * x)


def norm_of(matrix, first):
    """Return the 1-norm of the square matrix that starts at a column: the largest sum of magnitudes in a column."""
    n = len(matrix)
    norm = everywhere(0.0)
    for j in range(first, first + n):
        total = everywhere(0.0)
        for i in range(n):
            total = total + abs(load(matrix, i, j))
        norm = larger(norm, total)
    return norm


def replace_right_side(terms, work, matrix):
    """Replace the right side by the residual of the solution so far, summed in twice the precision."""
    n = len(matrix)
    for i in range(n):
        store(work, HIGH, i, everywhere(0.0))
        store(work, LOW, i, everywhere(0.0))
    for e in range(len(terms)):
        i, j = terms[e, ROW], terms[e, COLUMN]
        term = load(work, TERM, e) * load(work, COLUMN_SCALE, j)
        x = load(work, UNKNOWN, j) if j < n else everywhere(-1.0)
        high, low = minus_product(load(work, HIGH, i), load(work, LOW, i), term, x)
        store(work, HIGH, i, high)
        store(work, LOW, i, low)
    for i in range(n):
        store(matrix, i, n, load(work, HIGH, i) + load(work, LOW, i))


def minus_product(high, low, a, b):
    """Return high + low − a·b as a sum of two numbers: the errors of product and sum, exact by Dekker and Knuth, go to
    the low one."""
    product = a * b
    a_head, b_head = head(a), head(b)
    a_tail, b_tail = a - a_head, b - b_head
    error = ((a_head * b_head - product) + a_head * b_tail + a_tail * b_head) + a_tail * b_tail
    total = high - product
    step = total - high
    return total, low + (((high - (total - step)) - (product + step)) - error)


def head(a):
    """Return the leading half of a number's digits."""
    big = everywhere(SPLITTER) * a
    return big - (big - a)
