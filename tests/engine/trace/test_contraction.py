"""A product written in a sum is rounded with it, once, by a rule that sees what is written and nothing else."""

from fractions import Fraction

import numpy as np
import pytest
from fused import EVERY

import linksweep as ls
from linksweep.engine.quantity import Row, Table
from linksweep.engine.trace.contraction import contracted
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.engine.trace.graph import Graph, leading_to
from linksweep.engine.trace.operators import interpret
from linksweep.engine.trace.plan import plan
from linksweep.engine.trace.simplified import COMMUTATIVE
from linksweep.physics.algebra import double_double
from linksweep.scene.derivatives.differentiated import differentiated
from linksweep.scene.parameters import free

NAMES = ("a", "b", "c", "d")
SUMS = {
    "a·b + c": lambda a, b, c, d: a * b + c,
    "c + a·b": lambda a, b, c, d: c + a * b,
    "a·b − c": lambda a, b, c, d: a * b - c,
    "c − a·b": lambda a, b, c, d: c - a * b,
    "−a·b + c": lambda a, b, c, d: -a * b + c,
    "−(a·b) − c": lambda a, b, c, d: -(a * b) - c,
    "c − a·(−b)": lambda a, b, c, d: c - a * -b,
    "−c − a·b": lambda a, b, c, d: -c - a * b,
}


def numbers(seed: int, count: int = len(NAMES)) -> list[float]:
    return np.random.default_rng(seed).normal(size=count).tolist()


def evaluated(function, values: dict[str, float], known=()) -> float:
    """Return a function's value by its operations; `known` names the numbers that are known while tracing."""
    graph = Graph()
    result = graph.node(function(*(graph.input(name, ()) for name in values)))
    value = contracted([result], {name: values[name] for name in known}).values[result]
    needed = leading_to([value])
    inputs = {node: np.float64(values[node.value]) for node in needed if node.operator == "input"}
    return float(interpret(needed, inputs, EVERY)[value])


def operators(function) -> set[str]:
    """Return the operators of the operations that a function comes to."""
    result = function(*map(Graph().input, NAMES, [()] * len(NAMES)))
    return {node.operator for node in leading_to([contracted([result], {}).values[result]]) if node.operands}


@pytest.mark.parametrize("name", SUMS)
def test_a_sum_with_a_product_is_rounded_once(name):
    for seed in range(50):
        a, b, c, d = numbers(seed)
        exact = SUMS[name](*map(Fraction, (a, b, c, d)))
        assert evaluated(SUMS[name], {"a": a, "b": b, "c": c, "d": d}) == float(exact)
    assert operators(SUMS[name]) - {"negate"} in ({"fma"}, {"fnma"})


def test_of_two_products_the_second_is_taken_into_the_sum():
    for seed in range(50):
        a, b, c, d = numbers(seed)
        expected = float(Fraction(a * b) - Fraction(c) * Fraction(d))
        assert evaluated(lambda a, b, c, d: a * b - c * d, {"a": a, "b": b, "c": c, "d": d}) == expected


def test_the_difference_of_a_product_and_itself_is_zero():
    for seed in range(50):
        a, b, c, d = numbers(seed)
        for function in (lambda a, b, c, d: a * b - a * b, lambda a, b, c, d: a * b - b * a):
            assert evaluated(function, {"a": a, "b": b, "c": c, "d": d}) == 0.0


def test_words_of_double_doubles_remain_exact():
    """Both words add up to the exact result if the high word is a rounded sum or product."""

    def product_and_sum(a, b, c, d):
        high, low = double_double.two_product(a, b)
        total, missed = double_double.two_sum(c * d, high)
        return total, missed, low

    for seed in range(50):
        a, b, c, d = numbers(seed)
        values = dict(zip(NAMES, (a, b, c, d), strict=True))
        words = [evaluated(lambda *x, k=k: product_and_sum(*x)[k], values) for k in range(3)]
        assert sum(map(Fraction, words)) == Fraction(a) * Fraction(b) + Fraction(c * d)
        assert evaluated(lambda *x: x[2] - double_double.two_product(*x[:2])[0], values) == c - a * b


def test_a_named_value_is_a_number_of_its_own():
    """Whichever rows take it, and whether it is asked for or not."""
    rows = (
        Row(lambda a, b: a * b, ("product",)),
        Row(lambda product: -product, ("opposite",)),
        Row(lambda product, c: product + c, ("total",)),
        Row(lambda opposite, c: opposite + c, ("difference",)),
    )
    for name in ("total", "difference"):
        request = plan(Table("theta2", rows), (name,), tuple((name, ()) for name in NAMES))
        assert {node.operator for node in request.nodes if node.operands} == {"*", "+" if name == "total" else "-"}


def test_another_row_with_the_same_sum_the_other_way_round_changes_nothing():
    rows = Row(lambda a, b, c, d: a * b + c * d, ("one",)), Row(lambda a, b, c, d: c * d + a * b, ("other",))
    forms = tuple((name, ()) for name in NAMES)
    for request in (("one", "other"), ("other", "one")):
        together = plan(Table("theta2", rows), request, forms)
        for name in request:
            alone = plan(Table("theta2", rows), (name,), forms)
            assert written(together.outputs[name]) == written(alone.outputs[name])


@pytest.mark.parametrize("name", ["press", "pump-jack", "scotch-yoke"])
def test_no_request_changes_a_quantity_or_a_derivative(name):
    """Whatever is traced before it, in whichever order."""
    scene = ls.example(name)
    paths = [path for path in free(scene) if path.endswith((".length", ".mass", ".cg_angle", ".width"))][:3]
    quantities = tuple(scene.mechanism.unknowns(scene.drive))[::3]
    sampled = differentiated(scene, quantities, paths).at(scene.grid(5))
    every = [*quantities, *(derivative_of(name, path) for name in quantities for path in paths)]
    forms = sampled.inputs.forms
    alone = {name: written(plan(sampled.table, (name,), forms).outputs[name]) for name in every}
    for request in (every, every[::-1], np.random.default_rng(1).permutation(every).tolist()):
        together = plan(sampled.table, tuple(request), forms).outputs
        assert {name: written(together[name]) for name in every} == alone


def written(node) -> int:
    """Return a number that differs where the operations that lead to a node do, or the order of operands."""
    known = {}
    for x in leading_to([node]):
        operands = [known[y] for y in x.operands]
        free_order = 2 if x.operator in COMMUTATIVE else 0
        known[x] = hash((x.operator, x.value, *sorted(operands[:free_order]), *operands[free_order:]))
    return known[node]


def drawn_function(draw: np.random.Generator, operations: int = 25):
    """Return a function of random sums, products and signs."""
    steps = [(draw.choice(["+", "-", "*", "*", "negate"]), *draw.integers(0, 6 + k, 2)) for k in range(operations)]

    def function(*numbers):
        values = list(numbers)
        for operator, i, j in steps:
            x, y = values[i], values[j]
            values.append({"+": x + y, "-": x - y, "*": x * y, "negate": -x}[operator])
        return values[-1]

    return function


@pytest.mark.parametrize("seed", range(300))
def test_numbers_that_are_known_to_be_0_or_1_change_no_bit(seed):
    """A design alone, whose zeros and ones are left out, has the bits that it has among others."""
    draw = np.random.default_rng(seed)
    function, values = drawn_function(draw), {f"x{k}": x for k, x in enumerate(draw.normal(size=6))}
    known = [f"x{k}" for k in range(6) if draw.random() < 0.5]
    values |= {name: float(draw.integers(2)) for name in known}
    assert evaluated(function, values, known) == evaluated(function, values)
