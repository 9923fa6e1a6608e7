"""Choose the values of a loop in stages that wait in memory, so that all others fit into the registers.

A compiler would choose them too, but more of them, and store many at once: stores take two cycles each, and where they
crowd, all else waits. So a value that waits is stored as soon as it is known, and read back by who needs it. As in
Belady's rule (1966), those wait that are not needed for the longest time.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from linksweep.engine.trace.graph import Node

REGISTERS = 30
"""Values in registers at a time: of the widest processors' 32, two are left to numbers that are read and used once."""
SHORTEST = 12
"""Cycles of the shortest wait: a number that has just been stored takes about as long to be read."""


class Gap(NamedTuple):
    """Gap between two uses of a value: its cycles, and the operation that reads the value after it."""

    value: Node
    reader: Node
    first: int
    last: int

    @property
    def cycles(self) -> range:
        return range(self.first, self.last)

    def passes(self, length: int) -> range:
        """Return the passes, of so many cycles, that begin within the gap."""
        return range(self.first // length + 1, self.last // length + 1)


def gaps(start: Mapping[Node, int]) -> list[Gap]:
    """Return the gaps between the uses of all values, from the cycles in which operations start."""
    gaps, used = [], dict(start)
    for reader in sorted(start, key=lambda node: start[node]):
        for value in dict.fromkeys(reader.read):
            if value in start:
                gaps.append(Gap(value, reader, used[value], start[reader]))
                used[value] = start[reader]
    return gaps


def in_memory(gaps: Sequence[Gap], length: int) -> dict[Gap, None]:
    """Return the gaps in which values wait in memory, where a pass of `length` cycles would need too many registers."""
    numbers = [gap for gap in gaps if gap.value.operator != "<"]  # conditions have registers of their own
    held = Counter(cycle % length for gap in numbers for cycle in gap.cycles)
    others = [gap for gap in numbers if len(gap.cycles) >= SHORTEST]
    chosen, stored = set[Gap](), set[Node]()
    while held and max(held.values()) > REGISTERS:
        fullest = max(held, key=lambda cycle: held[cycle])
        over = [gap for gap in others if (fullest - gap.first) % length < len(gap.cycles)]
        if not over:
            break
        longest = max(over, key=lambda gap: (gap.value in stored, len(gap.cycles)))  # a stored value waits for nothing
        held.subtract(cycle % length for cycle in longest.cycles)
        others.remove(longest)
        chosen.add(longest)
        stored.add(longest.value)
    return {gap: None for gap in gaps if gap in chosen}
