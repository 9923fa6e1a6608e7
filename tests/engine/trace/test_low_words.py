"""Low words of sums and products are exact; interpreted and compiled, by other operations, they have equal bits."""

from fractions import Fraction

import numpy as np
import pytest

from linksweep.base import low_words
from linksweep.engine.kernel import compile
from linksweep.engine.trace.graph import LOW_WORDS
from linksweep.engine.trace.simplified import Simplified

KERNEL = """
@vectorised
def rows(samples, x, y, low):
    for j in in_vectors(0, samples, samples):
        p = x[j]
        q = y[j]
        pq = LOW(p, q)
        low[j] = pq


def kernel(samples, x, y, low):
    rows(samples, x, y, low)
"""
SPECIAL = (0.0, -0.0, 1.0, -1.0, 2.0, -0.5, 3.0, 2.0**27 + 1.0, 1.0 + 2.0**-52, float("nan"), float("inf"))


def factors() -> tuple[np.ndarray, np.ndarray]:
    draw = np.random.default_rng(5)
    x, y = draw.standard_normal((2, 5000)) * 10.0 ** draw.integers(-60, 60, (2, 5000))
    special = np.array(np.meshgrid(SPECIAL, SPECIAL)).reshape(2, -1)
    return np.concatenate([x, special[0]]), np.concatenate([y, special[1]])


def numbers(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs for a low word: those of an ordered sum have the larger first, and no infinite part."""
    x, y = factors()
    if name == "ordered_low":
        x, y = np.where(abs(x) >= abs(y), x, y), np.where(abs(x) >= abs(y), y, x)
    return x, y


@pytest.mark.parametrize("name", sorted(LOW_WORDS))
def test_compiled_and_plain_have_equal_bits(name):
    kernel = compile.compiled.__wrapped__(KERNEL.replace("LOW", name), kinds=(compile.INTEGER, *[compile.FLOATS] * 3))
    x, y = numbers(name)
    result = np.empty(len(x))
    kernel(len(x), x, y, result)
    with np.errstate(invalid="ignore"):
        expected = getattr(low_words, name)(x, y)
    np.testing.assert_array_equal(np.isnan(result), np.isnan(expected))
    number = ~np.isnan(expected)
    np.testing.assert_array_equal(result[number].view(np.int64), expected[number].view(np.int64))  # signs of 0, too


EXACT = {
    "sum_low": lambda x, y: x + y,
    "ordered_low": lambda x, y: x + y,
    "difference_low": lambda x, y: x - y,
    "product_low": lambda x, y: x * y,
}


@pytest.mark.parametrize("name", sorted(LOW_WORDS))
def test_high_and_low_word_are_the_exact_result(name):
    for x, y in zip(*(z[:500].tolist() for z in numbers(name)), strict=True):
        low = getattr(low_words, name)(x, y)
        assert Fraction(EXACT[name](x, y)) + Fraction(low) == EXACT[name](Fraction(x), Fraction(y))


@pytest.mark.parametrize("name", sorted(LOW_WORDS))
def test_fractions_have_no_low_word(name):
    assert getattr(low_words, name)(Fraction(1, 3), Fraction(2, 7)) == 0


def test_traced_the_low_word_of_a_product_is_one_operation():
    graph = Simplified()
    x, y = graph.input("x", ()), graph.input("y", ())
    low = graph.product_low(x, y)
    assert low.operator == "product_low"
    assert graph.product_low(y, x) is low
    assert graph.product_low(-x, y) is -low
    assert graph.product_low(x, -y) is -low
    assert graph.product_low(x, graph.constant(1.0)).is_constant(0.0)
    assert graph.product_low(x, graph.constant(0.0)).is_constant(0.0)


def test_traced_the_low_word_of_a_sum_is_one_operation():
    graph = Simplified()
    x, y = graph.input("x", ()), graph.input("y", ())
    low, of_difference = graph.sum_low(x, y), graph.sum_low(x, -y)
    assert low.operator == "sum_low"
    assert graph.sum_low(y, x) is low
    assert graph.sum_low(-x, -y) is -low
    assert of_difference.operator == "difference_low"
    assert of_difference.operands == (x, y)
    assert graph.sum_low(-y, x) is of_difference
    for name in ("sum_low", "ordered_low"):
        assert getattr(graph, name)(x, graph.constant(0.0)).is_constant(0.0)
