"""Choose the operations that a loop over samples does one vector ahead, and the order of all.

A processor that waits for the divisions and roots of one vector has too few operations of its own to fill the time:
those of the next vector are independent of them. The operations that begin the longest chains of others come first.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linksweep.engine.trace.graph import Node

SLOW = {"/", "sqrt"}
"""Operations that take several times as long as others."""
GAIN = range(50, 301)
"""Numbers of operations of loops with slow ones that gain by it: most took 0.77 to 1.01 of the time, shorter ones up to
1.14 (AMD Zen 4). Longer ones, whose values do not fit into the registers, go through `engine.kernel.pipeline`."""

ORDERED = 1000
"""Most instructions of a block that gains by another order: with more, loops took up to 1.09 of the time."""


def done_ahead(work: Sequence[Node]) -> list[Node]:
    """Return the operations of a loop that begin chains of more than half the longest one's length; none where the
    loop gains nothing."""
    if len(work) not in GAIN or not any(node.operator in SLOW for node in work):
        return []
    length = chains(work)
    return [node for node in work if length[node] > max(length.values()) / 2]


def longest_chains_first(block: Any) -> None:
    """Order a block's instructions; a store remains behind what comes before it, so no load may read what one stores.

    Blocks of more than `ORDERED` keep their order: their values would wait in memory.
    """
    if len(block.instructions) <= ORDERED:
        length = chains(block.instructions)
        block.instructions.sort(key=lambda x: -length[x])


def chains(work: Sequence[Any]) -> dict[Any, int]:
    """Return the length of the longest chain, each the operand of the next, that each of some operations begins."""
    length = dict.fromkeys(work, 1)
    for operation in reversed(work):
        for x in operation.operands:
            if x in length:
                length[x] = max(length[x], length[operation] + 1)
    return length
