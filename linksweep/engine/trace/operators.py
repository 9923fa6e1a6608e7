"""Evaluate traced operations on numpy arrays, or on any numbers that have operators of their own."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from linksweep.base import low_words
from linksweep.engine.trace.arctangent import arctangent
from linksweep.engine.trace.contraction import contracted
from linksweep.engine.trace.graph import LOW_WORDS, Graph, Node, leading_to
from linksweep.engine.trace.simplified import Simplified

OPERATORS: Mapping[str, Callable[..., Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "<": operator.lt,
    "negate": operator.neg,
    "abs": operator.abs,
    "sqrt": np.sqrt,
    "where": np.where,
    **{name: getattr(low_words, name) for name in LOW_WORDS},
}
"""Operations on arrays, but fma and what is made of it, which numpy lacks. On numpy scalars, Python's own operators
give numpy's results, and much faster."""


def interpret(nodes: Iterable[Node], values: dict[Node, Any], operators=OPERATORS) -> dict[Node, Any]:
    """Evaluate nodes in order; `values` has those of the inputs, and gets all others."""
    with np.errstate(all="ignore"):
        for node in nodes:
            if node.operator == "constant":
                values[node] = np.float64(node.value)
            elif node.operator != "input":
                values[node] = operators[node.operator](*[values[x] for x in node.operands])
    return values


class Traced(NamedTuple):
    """A function as a graph: its inputs, its constants and operations in order, and its results."""

    inputs: list[Node]
    nodes: list[Node]
    results: list[Node]


def traced(function: Callable[..., Iterable[Node | float]], count: int, kind: type[Graph] = Simplified) -> Traced:
    """Trace a function of so many numbers into a graph of this kind."""
    graph = kind()
    inputs = [graph.input(f"input {k}", ()) for k in range(count)]
    results = [graph.node(result) for result in function(*inputs)]
    return Traced(inputs, graph.nodes[count:], results)


@cache
def traced_arctangent() -> Traced:
    """Return the arctangent of y and x as traced operations, contracted."""
    written = traced(lambda y, x: [arctangent(y, x, Node.where)], 2, Graph)
    values = contracted((*written.inputs, *written.results), {}).values
    inputs, results = ([values[node] for node in nodes] for nodes in (written.inputs, written.results))
    return Traced(inputs, [node for node in leading_to(results) if node not in inputs], results)
