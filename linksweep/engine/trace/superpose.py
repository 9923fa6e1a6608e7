"""superposed(plan): the same results, with what enters linearly taken out of the inner loops.

Forces are affine in every mass, inertia and load, in gravity, in ω² and α. So along a design dimension that carries
such numbers only, each quantity is a sum of a few cycles, computed once, times weights that depend on no angle:

    F(θ, m₃) = F₀(θ) + m₃ F₁(θ)          F(θ, ω₂) = F₀(θ) + ω₂² F₁(θ)

Which numbers these are is found in the operations themselves: what depends on the dimension is kept as such a sum
through + − * / as long as these are linear in it, and summed up where something else is done to it (a root, a product
of two sums). A sum of products rounds otherwise than the operations that it stands for, by some ε of its largest
term; therefore it is done only where asked for.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from functools import lru_cache

from linksweep.engine.trace.graph import Graph, Node
from linksweep.engine.trace.plan import Plan

Weight = frozenset[tuple[Node, int]]
"""A product of powers of numbers that depend on no angle."""
Sum = dict[Weight, Node]
"""Cycles, each times its weight; what is not taken apart is one cycle times the empty product."""

ONE: Weight = frozenset()
MOST_TERMS = 16
"""Longer sums are no less work than what they stand for."""


@lru_cache(maxsize=256)
def superposed(plan: Plan) -> Plan:
    """The plan with each dimension superposed along which that leaves less to do for each sample and design."""
    for dim in reversed(plan.loops):
        candidate = _Superposition(plan, dim).result()
        if _work(candidate, dim) < _work(plan, dim):
            plan = candidate
    return plan


def _work(plan: Plan, dim: str) -> int:
    """Operations done for each sample of each design along a dimension."""
    return sum({plan.index, dim} <= node.dims for node in plan.nodes if node.operands)


class _Superposition:
    """A plan traced again, with whatever depends on one dimension as a sum of cycles."""

    def __init__(self, plan: Plan, dim: str) -> None:
        self.plan, self.dim, self.graph = plan, dim, Graph()
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
            found = _LINEAR[node.operator](*operands)
            if found is not None and len(found) <= MOST_TERMS:
                return found
        return self._whole(self.graph.copy(node, tuple(map(self._value, operands))))

    def _whole(self, node: Node) -> Sum:
        """A node that is not taken apart: a cycle, or a weight if it depends on the dimension and no angle."""
        if self.dim in node.dims and self.plan.index not in node.dims:
            return {frozenset({(node, 1)}): self.graph.constant(1.0)}
        return {ONE: node}

    def _value(self, terms: Sum) -> Node:
        """The sum as a node."""
        total = self.graph.constant(0.0)
        for weight, cycle in terms.items():
            total = total + self._product(weight) * cycle
        return total

    def _product(self, weight: Weight) -> Node:
        above, below = self.graph.constant(1.0), self.graph.constant(1.0)
        for factor, power in sorted(weight, key=lambda item: item[0].position):
            for _ in range(abs(power)):
                above, below = (above * factor, below) if power > 0 else (above, below * factor)
        return above / below


def _added(x: Sum, y: Sum) -> Sum:
    total = dict(x)
    for weight, cycle in y.items():
        total[weight] = total[weight] + cycle if weight in total else cycle
    return total


def _opposite(x: Sum) -> Sum:
    return {weight: -cycle for weight, cycle in x.items()}


def _multiplied(x: Sum, y: Sum) -> Sum | None:
    """Of two sums, one must be a single term: the square of a sum would cancel where the sum does."""
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
    "/": _divided,
}
