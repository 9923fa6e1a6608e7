"""Bound the rounding error of a result by running error analysis of the traced graph.

Each operation passes on the errors of its operands and adds its own, half a unit in the last place of its result, u|z|:

    z = x ± y    |δz| ≤ δx + δy + u|z|
    z = x·y      |δz| ≤ |x|δy + (|y| + δy)δx + u|z|
    z = x/y      |δz| ≤ (δx + |z|δy)/(|y| − δy) + u|z|
    z = √x       |δz| ≤ δx/z + u|z|
    low word z of x ± y or x·y    |δz| ≤ |z|, as the exact sum or product is one word

(N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., section 3.3.) The bound holds for these very
numbers, not on average, and costs about three times the operations of the result itself, only when requested. Exact
inputs have no error; others are cosines, sines and products, wrong by a few roundings. Operations count as they are
written, though some products are rounded only in the sums that take them, and products with 1 not at all: so the bound
is the same alone and among other designs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from linksweep.engine.trace.graph import LOW_WORDS, Node, depth_first

UNIT = 2.0**-53 * (1.0 + 2.0**-20)
"""Half a unit in the last place; the factor beyond 1 covers the rounding of the bound itself."""
INPUT = 4.0 * UNIT
"""Relative error of an inexact input: the square of a cosine, a cosine times a length."""
PAIR = 2.0**-86
"""Absolute error of a double-double cosine, and of the difference of two."""


def relative_bound(
    results: tuple[Node, ...], exact: Callable[[str], bool], certain: Mapping[Node, Node | float]
) -> Node:
    """Return a bound on the largest error of these results, relative to the largest of them.

    `exact(name)` tells whether an input is exact. Nodes in `certain` are computed in double-double. This analysis would
    take each of their operations for a rounded one, so it treats them as inputs, with the error of a double-double
    cosine, relative to the number that `certain` has for each, in addition.
    """
    known = {node: INPUT * abs(node) + PAIR * unit for node, unit in certain.items()}
    largest_error, largest = _zero(results[0]), _zero(results[0])
    for result in results:
        error, size = _bound(result, known, exact), abs(result)
        largest_error = (largest_error < error).where(error, largest_error)
        largest = (largest < size).where(size, largest)
    return (largest > 0.0).where(largest_error / largest, largest_error)


def _bound(result: Node, known: dict[Node, Node], exact: Callable[[str], bool]) -> Node:
    """Return a bound on the absolute error of a result; `known` keeps those of all operations on the way."""
    for node in depth_first({result} - known.keys(), {*result.graph.nodes} - known.keys()):
        known[node] = _propagated(node, [known[x] for x in node.operands], exact)
    return known[result]


def _propagated(z: Node, errors: list[Node], exact: Callable[[str], bool]) -> Node:
    zero = _zero(z)
    if z.operator == "constant" or z.operator == "<":
        return zero
    if z.operator == "input":
        return zero if exact(z.value) else INPUT * abs(z)
    if z.operator in LOW_WORDS:
        return abs(z)
    if z.operator in ("negate", "abs", "rounded"):
        return errors[0]
    if z.operator == "where":
        return z.operands[0].where(errors[1], errors[2])
    return _OPERATIONS[z.operator](z, *z.operands, *errors) + UNIT * abs(z)


def _quotient(z: Node, x: Node, y: Node, dx: Node, dy: Node) -> Node:
    divisor = abs(y) - dy
    return (divisor > 0.0).where((dx + abs(z) * dy) / divisor, math.inf)


_OPERATIONS: dict[str, Callable[..., Node]] = {
    "+": lambda z, x, y, dx, dy: dx + dy,
    "-": lambda z, x, y, dx, dy: dx + dy,
    "*": lambda z, x, y, dx, dy: abs(x) * dy + (abs(y) + dy) * dx,
    "/": _quotient,
    "sqrt": lambda z, x, dx: dx / z,
}


def _zero(node: Node) -> Node:
    return node.graph.constant(0.0)
