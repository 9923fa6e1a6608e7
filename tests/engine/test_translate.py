"""Plain Python, translated to machine code, does what Python does, to the last bit."""

import math
from fractions import Fraction

import numpy as np
import pytest

from linksweep.engine.kernel.machine_code import address
from linksweep.engine.kernel.translate import translated

MOST = 5
HALF = 0.5
PAIR = (1.0, 2.0)


def arithmetic(x, k, result):
    """Compute with numbers of both kinds."""
    total, count = 0.0, k - k
    for j in range(len(x)):
        total += (x[j] * HALF - 3) / (k + 0.25) + j
        count += (j * j - 7) // k + (k - 3 * j) % k - (k - 3 * j) // -k - (j - 3) % -k
    result[0], result[1], result[2] = total, count, -total + -count
    result[3] = abs(x[0]) + float(k) + int(x[1]) / 4
    result[4] = min(k, 3, len(x)) + max(x[0], x[1], 0.0) + max(k, 2 * MOST)
    return count


def conditions(x, k, result):
    """Compare, also numbers that are none."""
    for j in range(len(x)):
        value = x[j]
        result[j, 0] = 1.0 if value < 0.0 else 2.0 if value == 0.0 else 3
        result[j, 1] = value <= 0.0 or (value > 2.0 and not k > 1)
        result[j, 2] = value >= 1.0 or (value != value and k > 1)
        result[j, 3] = -1.0 < value <= 1.0
        result[j, 4] = not k or (j == 2) == (value < 0.5)
        if k and j:
            result[j, 5] = 1.0
        elif j < 1:
            result[j, 5] = -math.inf
        else:
            result[j, 5] = math.nan


def loops(x, k, result):
    """Loop upwards, downwards, over tuples and until something happens."""
    at = 0
    for j in range(MOST, -1, -2):
        for start in (0, k):
            for i in range(start, len(x), 3):
                if x[i] > 1.5:
                    break
                result[at] += x[i] + j
            at += 1
    while at < len(result) and x[at % len(x)] < 2.0:
        at += 1
    return at


def first_above(row, least):
    """Return a sample's place and value."""
    for j in range(len(row)):
        if row[j] > least:
            return j, row[j]
    return -1, math.nan


def parts(x, k, result):
    """Work on parts of arrays, and call functions that return several numbers, from several places."""
    table, (rows, columns) = x, x.shape[:2]
    where = first_above(table[k], 0.5)
    result[0], result[1] = where
    for j in range(rows):
        row = table[j, 1:columns]
        (at, value), beside = first_above(row, *where[1:]), len(row[1:])
        result[2 + j] += at + value + beside
    result[1:][1] += x[1:][0, 2]


RANDOM = np.random.default_rng(5).normal(0.5, 1.5, (7, 9))
NUMBERS = np.array([-1.0, 0.0, 1.0, math.nan, math.inf, -math.inf, 2.5])
CASES = {
    arithmetic: [(row, k, np.zeros(5)) for row in RANDOM for k in (1, 2, 5)],
    conditions: [(NUMBERS, k, np.zeros((7, 6))) for k in (0, 1, 2)],
    loops: [(row, k, np.zeros(40)) for row in RANDOM for k in (1, 4)],
    parts: [(np.ascontiguousarray(RANDOM[:k]), k - 2, np.zeros(9)) for k in (2, 5, 7)],
}


@pytest.mark.parametrize("function", CASES)
def test_machine_code_does_what_python_does(function):
    x, _, result = CASES[function][0]
    kinds = {1: "f8[:]", 2: "f8[:, :]"}
    compiled = translated(function, (kinds[x.ndim], "i8", kinds[result.ndim]))
    for x, k, result in CASES[function]:
        python, machine = result.copy(), result.copy()
        with np.errstate(all="ignore"):
            returned = function(x, k, python)
        assert compiled(x, k, machine) == (returned or 0)
        np.testing.assert_array_equal(machine, python)


def quotients(pairs, result):
    for j in range(len(pairs)):
        result[j, 0], result[j, 1] = pairs[j, 0] // pairs[j, 1], pairs[j, 0] % pairs[j, 1]


def test_quotients_of_integers_are_exact():
    """Beyond 2⁵³, and rounded down, for all signs."""
    random = np.random.default_rng(7)
    pairs = random.integers(-(2**62), 2**62, (200, 2))
    pairs[:, 1] >>= random.integers(1, 60, 200)
    pairs[pairs == 0] = 1
    result = np.empty_like(pairs)
    translated(quotients, ("i8[:, :]", "i8[:, :]"))(pairs, result)
    for (x, y), (quotient, rest) in zip(pairs.tolist(), result.tolist(), strict=True):
        assert quotient == math.floor(Fraction(x, y)) and rest == x - quotient * y


@pytest.mark.parametrize(
    "wrong", [np.zeros((4, 4))[:, ::2], np.zeros((4, 4)), np.zeros(4, dtype=int), np.zeros(8)[::2]]
)
def test_an_array_of_another_kind_is_refused(wrong):
    compiled = translated(arithmetic, ("f8[:]", "i8", "f8[:]"))
    with pytest.raises(TypeError, match="no array of kind f8"):
        compiled(wrong, 1, np.zeros(5))


@pytest.mark.parametrize("array", [np.zeros(3), np.arange(24.0).reshape(4, 6)[1:, 2:], np.empty((0, 2))])
def test_an_array_lies_where_numpy_says(array):
    assert address(array) == array.__array_interface__["data"][0]


def with_a_list(x):
    x[0] = sum([x[0], x[1]])


def with_two_types(x):
    k = 0
    for j in range(len(x)):
        k = x[j]
    x[0] = k


@pytest.mark.parametrize(
    ("function", "text"),
    [
        (with_a_list, r"'\[x\[0\], x\[1\]\]'"),
        (with_two_types, r"'k = x\[j\]' \(double in place of i64\)"),
    ],
)
def test_what_has_no_translation_is_named(function, text):
    with pytest.raises(SyntaxError, match=rf"test_translate, line \d+: no translation for {text}"):
        translated(function, ("f8[:]",))


def first_of_pair(row):
    """Take a number out of a constant tuple."""
    row[0] = PAIR[0]


def test_a_constant_that_changes_makes_other_machine_code(monkeypatch):
    """Code is kept on disk, by a text that differs wherever the function does."""
    row = np.zeros(1)
    for number in PAIR:
        monkeypatch.setitem(first_of_pair.__globals__, "PAIR", (number, 7.0))
        translated.__wrapped__(first_of_pair, ("f8[:]",))(row)
        assert row[0] == number
