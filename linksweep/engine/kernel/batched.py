"""Kernels that process several designs side by side.

Where designs share much of their work, as many masses on one geometry do, a kernel spends most of its time per design
on reading shared rows. So the innermost design loop takes a batch of designs: each sample of a shared row is read once
for all of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from linksweep.engine.kernel.writer import Reduction, Writer
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import Plan

BATCH = 4
"""Designs processed side by side; the last batch is filled up with the last design."""
SHARED = 8
"""Operations, at most, per shared row for batching to pay: with more of them, reading no longer dominates."""


def shares_rows(writer: Writer) -> bool:
    """Return whether the innermost loop reduces rows and mostly reads rows that outer loops have computed."""
    innermost = writer.innermost
    if innermost < len(writer.plan.loops):
        return False
    work = [node for node in writer.nodes if writer.per_sample(node) and writer.level(node) == innermost]
    read = {x for node in work for x in node.operands if x in writer.scratch and writer.level(x) < innermost}
    return bool(writer.reductions and read) and SHARED * len(read) >= len(work)


class BatchedWriter(Writer):
    """Writer of a kernel whose innermost loop does `BATCH` designs; names of a design's values end in its number."""

    def __init__(self, plan: Plan, reductions: tuple[Reduction, ...]) -> None:
        super().__init__(plan, reductions)
        self.design = 0

    @property
    def scratch_rows(self) -> int:
        return len(self.scratch) + (BATCH - 1) * len(self._own(self.scratch))

    @property
    def value_count(self) -> int:
        return len(self.values) + (BATCH - 1) * len(self._own(self.values))

    def _own(self, kept: Mapping[Node, int]) -> list[Node]:
        """Return the nodes kept for each design of a batch."""
        return [node for node in kept if self.level(node) == self.innermost]

    def _number(self, kept: Mapping[Node, int], node: Node) -> int:
        own = self._own(kept)
        if self.design and node in own:
            return len(kept) + (self.design - 1) * len(own) + own.index(node)
        return kept[node]

    def row_number(self, node: Node) -> int:
        return self._number(self.scratch, node)

    def value_number(self, node: Node) -> int:
        return self._number(self.values, node)

    def name(self, node: Node) -> str:
        own = self.level(node) == self.innermost and node.operator != "constant"
        return super().name(node) + (f"_{self.design}" if own else "")

    def counter(self, loop: int) -> str:
        return super().counter(loop) + (f"_{self.design}" if loop == self.innermost - 1 else "")

    def _design_loop(self, level: int) -> None:
        if level < self.innermost:
            super()._design_loop(level)
            return
        first, last = self._bounds(level)
        self.write(level, f"for front in range({first}, {last}, {BATCH}):")
        for _ in self.designs(level):
            self.write(level + 1, f"{self.counter(level - 1)} = min(front + {self.design}, {last} - 1)")

    def designs(self, level: int) -> Iterator[int]:
        for design in range(BATCH if level == self.innermost else 1):
            self.design = design
            yield design
