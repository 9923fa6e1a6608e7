"""superposed(plan): take linear dependence on design dims out of the inner loops.

Forces are affine in every mass, inertia and load, in gravity, in ω² and α. So along a design dim that carries only such
numbers, each quantity is a sum of a few cycles, computed once, times weights that depend on no angle:

    F(θ, m₃) = F₀(θ) + m₃ F₁(θ)          F(θ, ω₂) = F₀(θ) + ω₂² F₁(θ)

Linearity is detected in the operations themselves: a value that depends on the dim is kept as such a sum through + − *
/ as long as these are linear in it, and added up before any other operation (a root, a product of two sums). Such a sum
rounds differently from the operations it replaces, by some ε of its largest term; therefore it is used only on request.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from functools import lru_cache, partial

from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import Plan
from linksweep.engine.trace.simplified import Simplified

Weight = frozenset[tuple[Node, int]]
"""A product of powers of numbers that depend on no angle."""
Sum = dict[Weight, Node]
"""Cycles, each times its weight; a value that is not split is one cycle times the empty product."""

ONE: Weight = frozenset()
MOST_TERMS = 16
"""Longest sum kept: longer ones cost as much as the operations they replace."""


@lru_cache(maxsize=256)
def superposed(plan: Plan) -> Plan:
    """Return the plan with each dim superposed where that leaves fewer operations per sample and design."""
    for dim in reversed(plan.loops):
        candidate = _Superposition(plan, dim).result()
        if _work(candidate, dim) < _work(plan, dim):
            plan = candidate
    return plan


def _work(plan: Plan, dim: str) -> int:
    """Return the number of operations per sample of each design along a dim."""
    return sum({plan.index, dim} <= node.dims for node in plan.nodes if node.operands)


class _Superposition:
    """A plan traced again, with every value that depends on one dim as a sum of cycles."""

    def __init__(self, plan: Plan, dim: str) -> None:
        self.plan, self.dim, self.graph = plan, dim, Simplified()
        self.sums: dict[Node, Sum] = {}

    def result(self) -> Plan:
        for node in self.plan.nodes:
            self.sums[node] = self._sum(node)
        outputs = {name: self._value(self.sums[node]) for name, node in self.plan.outputs.items()}
        return Plan(self.plan.index, outputs, self.plan.functions)

    def _sum(self, node: Node) -> Sum:
        if not node.operands:
            return self._whole(self.graph.copy(node, ()))
        operands = [self.sums[x] for x in node.operands]
        if self.dim in node.dims and node.operator in _LINEAR:
            terms = _LINEAR[node.operator](*operands)
            if terms is not None and len(terms) <= MOST_TERMS:
                return terms
        return self._whole(self.graph.copy(node, tuple(map(self._value, operands))))

    def _whole(self, node: Node) -> Sum:
        """Return a node as a sum of one term: a weight if it depends on the dim and no angle, else a cycle."""
        if self.dim in node.dims and self.plan.index not in node.dims:
            return {frozenset({(node, 1)}): self.graph.constant(1.0)}
        return {ONE: node}

    def _value(self, terms: Sum) -> Node:
        """Return a sum as one node."""
        total = self.graph.constant(0.0)
        for weight, cycle in terms.items():
            total = total + self._product(weight) * cycle
        return total

    def _product(self, weight: Weight) -> Node:
        numerator, denominator = self.graph.constant(1.0), self.graph.constant(1.0)
        for factor, power in sorted(weight, key=lambda item: item[0].position):
            for _ in range(abs(power)):
                if power > 0:
                    numerator = numerator * factor
                else:
                    denominator = denominator * factor
        return numerator / denominator


def _added(x: Sum, y: Sum) -> Sum:
    total = dict(x)
    for weight, cycle in y.items():
        total[weight] = total[weight] + cycle if weight in total else cycle
    return total


def _with_product(x: Sum, y: Sum, z: Sum, minus: bool = False) -> Sum | None:
    product = _multiplied(x, y)
    return product and _added(z, _opposite(product) if minus else product)


def _opposite(x: Sum) -> Sum:
    return {weight: -cycle for weight, cycle in x.items()}


def _multiplied(x: Sum, y: Sum) -> Sum | None:
    """Return the product, or None where both sums have several terms: the square of a sum would cancel where the sum
    does."""
    if len(x) > 1:
        x, y = y, x
    if len(x) > 1:
        return None
    ((weight, cycle),) = x.items()
    return {_times(weight, other): cycle * factor for other, factor in y.items()}


def _divided(x: Sum, y: Sum) -> Sum | None:
    if len(y) > 1:
        return None
    ((weight, cycle),) = y.items()
    return {_times(other, weight, -1): part / cycle for other, part in x.items()}


def _times(x: Weight, y: Weight, power: int = 1) -> Weight:
    powers = Counter(dict(x))
    for factor, exponent in y:
        powers[factor] += power * exponent
    return frozenset((factor, exponent) for factor, exponent in powers.items() if exponent)


_LINEAR: dict[str, Callable[..., Sum | None]] = {
    "+": _added,
    "-": lambda x, y: _added(x, _opposite(y)),
    "negate": _opposite,
    "*": _multiplied,
    "fma": _with_product,
    "fnma": partial(_with_product, minus=True),
    "/": _divided,
}
