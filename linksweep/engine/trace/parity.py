"""Find which operations give the same, or opposite, results where some inputs change their sign."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from linksweep.engine.trace.graph import Node

SUMS = {"+", "-", "sum_low", "difference_low", "ordered_low"}


def parities(nodes: Iterable[Node], of_inputs: Mapping[Node, int]) -> dict[Node, int]:
    """Return 1 for nodes with the same value once the inputs are mirrored, −1 for those with the opposite one, else 0.

    `of_inputs` are the parities of inputs; all others stay the same. Rounding is symmetric, so this holds for all bits.
    """
    parity: dict[Node, int] = {}
    for node in nodes:
        x = [parity[operand] for operand in node.operands]
        if node in of_inputs or not x:
            parity[node] = of_inputs.get(node, 1)
        elif node.operator in ("*", "/", "product_low"):
            parity[node] = x[0] * x[1]
        elif node.operator in ("fma", "fnma"):
            parity[node] = x[2] if x[0] * x[1] == x[2] else 0
        elif node.operator == "negate" or (node.operator in SUMS and x[0] == x[1]):
            parity[node] = x[0]
        elif node.operator == "where" and x[0] == 1 and x[1] == x[2]:
            parity[node] = x[1]
        elif node.operator == "abs":
            parity[node] = x[0] * x[0]
        else:
            parity[node] = 1 if all(each == 1 for each in x) else 0
    return parity
