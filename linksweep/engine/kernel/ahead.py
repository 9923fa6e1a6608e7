"""Choose the operations that a loop over samples does one vector ahead.

A processor that waits for the divisions and roots of one vector has too few operations of its own to fill the time: the
first half of the next vector's is independent of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import instructions

SLOW = {"/", "sqrt"}
"""Operations that take several times as long as others."""
GAIN = range(50, 301)
"""Instructions of loops with slow operations that gain by it: most took 0.83 to 0.98 of the time, shorter ones up to
1.04, and longer ones, whose values do not fit into the registers, up to 1.16 (AMD Zen 4)."""


def first_half(work: Sequence[Node]) -> list[Node]:
    """Return the half of a loop's operations with the shortest chains of operations before them; none where the loop
    gains nothing."""
    chain: dict[Node, int] = {}
    for node in work:
        chain[node] = 1 + max(chain.get(x, 0) for x in node.operands)
    by_chain = sorted(work, key=lambda node: (chain[node], node.position))
    count = [instructions(node.operator) for node in by_chain]
    gains = sum(count) in GAIN and any(node.operator in SLOW for node in work)
    half = sum(count) / 2 if gains else 0
    return [node for node, so_far in zip(by_chain, accumulate(count), strict=True) if so_far <= half]
