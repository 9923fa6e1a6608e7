"""The low word of a product is exact, and its two ways, splitting and fused multiply-add, give equal bits."""

from fractions import Fraction

import numpy as np

from linksweep.base.product_low import product_low
from linksweep.engine.kernel import compile
from linksweep.engine.trace.graph import Graph

KERNEL = """
@vectorised
def rows(samples, x, y, low):
    for j in in_vectors(0, samples, samples):
        p = x[j]
        q = y[j]
        pq = product_low(p, q)
        low[j] = pq


def kernel(x, y, low):
    rows(len(x), x, y, low)
"""
SPECIAL = (0.0, -0.0, 1.0, -1.0, 2.0, -0.5, 3.0, 2.0**27 + 1.0, 1.0 + 2.0**-52, float("nan"), float("inf"))


def factors() -> tuple[np.ndarray, np.ndarray]:
    draw = np.random.default_rng(5)
    x, y = draw.standard_normal((2, 5000)) * 10.0 ** draw.integers(-60, 60, (2, 5000))
    special = np.array(np.meshgrid(SPECIAL, SPECIAL)).reshape(2, -1)
    return np.concatenate([x, special[0]]), np.concatenate([y, special[1]])


def test_compiled_and_plain_have_equal_bits():
    kernel = compile.compiled.__wrapped__(KERNEL, "", "void(f8[::1], f8[::1], f8[::1])")
    x, y = factors()
    result = np.empty(len(x))
    kernel(x, y, result)
    with np.errstate(invalid="ignore"):
        expected = product_low(x, y)
    np.testing.assert_array_equal(np.isnan(result), np.isnan(expected))
    number = ~np.isnan(expected)
    np.testing.assert_array_equal(result[number].view(np.int64), expected[number].view(np.int64))  # signs of 0, too


def test_high_and_low_word_are_the_product():
    for x, y in zip(*(z[:500].tolist() for z in factors()), strict=True):
        assert Fraction(x * y) + Fraction(product_low(x, y)) == Fraction(x) * Fraction(y)


def test_fractions_have_no_low_word():
    assert product_low(Fraction(1, 3), Fraction(2, 7)) == 0


def test_traced_it_is_one_operation():
    graph = Graph()
    x, y = graph.input("x", ()), graph.input("y", ())
    low = x.product_low(y)
    assert low.operator == "product_low"
    assert y.product_low(x) is low
    assert (-x).product_low(y) is -low
    assert x.product_low(-y) is -low
    assert x.product_low(1.0).is_constant(0.0)
    assert x.product_low(0.0).is_constant(0.0)
