"""Contract sums: z + x·y, where the product is written in the sum, becomes one operation, rounded once.

    fma    z + x·y          fnma    z − x·y

Of two products the second one is taken into the sum. The difference of a product and itself is 0 and stays so.

This rule sees a sum as it is written and its operands, nothing else. Inputs known to be 0 or 1, and the operations that
these make trivial, are left out only afterwards: hence a design has the same bits alone and among others, and a
quantity in any request.
A value that a row of the table has given a name is a number of its own, and so are the words of double-doubles
(`Node.rounded`): no sum takes such a product.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from linksweep.engine.trace.graph import Node, leading_to
from linksweep.engine.trace.simplified import Simplified


class Contracted(NamedTuple):
    """A graph that is contracted and simplified: its `values` by written nodes, and of each of its nodes the written
    one that `made` it."""

    values: dict[Node, Node]
    made: dict[Node, Node]


def contracted(results: Iterable[Node], known: Mapping[str, float]) -> Contracted:
    """Contract and simplify the graph of what these results are written with, of inputs that are `known` by name."""
    graph, values, made = Simplified(), dict[Node, Node](), dict[Node, Node]()
    for node in leading_to(results):
        before = len(graph.nodes)
        if node.operator == "input" and node.value in known:
            values[node] = graph.constant(known[node.value])
        else:
            values[node] = _value(graph, node, values) if node.operands else graph.copy(node, ())
        for new in graph.nodes[before:]:
            made[new] = node
    return Contracted(values, made)


def _value(graph: Simplified, node: Node, values: dict[Node, Node]) -> Node:
    """Return the value of a written operation, from those of its operands."""
    operands = [values[x] for x in node.operands]
    if node.operator in ("+", "-"):
        (x, x_minus), (y, y_minus) = map(_unsigned, node.operands)
        if "*" in (x.operator, y.operator) and not _equal_products(x, y):
            before, after = operands
            if node.operator == "-":
                after, y_minus = -after, not y_minus
            product, minus, other = (y, y_minus, before) if y.operator == "*" else (x, x_minus, after)
            factors = (values[factor] for factor in product.operands)
            return graph.apply("fnma" if minus else "fma", *factors, other)
    return graph.apply(node.operator, *operands)


def _equal_products(x: Node, y: Node) -> bool:
    """Return whether two nodes are products of the same factors."""
    return x.operator == y.operator == "*" and {*x.operands} == {*y.operands}


def _unsigned(node: Node) -> tuple[Node, bool]:
    """Return a node without its sign, and whether that is a minus."""
    minus = False
    while node.operator == "negate":
        (node,), minus = node.operands, not minus
    return node, minus
