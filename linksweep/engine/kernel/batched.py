"""Kernels that process several designs side by side.

Where designs share much of their work, as many masses on one geometry do, a kernel spends most of its time per design
on reading shared rows. So the innermost design loop takes a batch of designs: each sample of a shared row is read once
for all of them.
"""

from __future__ import annotations

from collections.abc import Iterator

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

    def __init__(self, plan: Plan, reductions: tuple[Reduction, ...], room: int) -> None:
        super().__init__(plan, reductions, room)
        self.own = [node for node in self.scratch if self.level(node) == self.innermost]
        self.scratch_size += (BATCH - 1) * len(self.own) * room
        self.design = 0

    def name(self, node: Node) -> str:
        return super().name(node) + (f"_{self.design}" if self.level(node) == self.innermost else "")

    def counter(self, loop: int) -> str:
        return super().counter(loop) + (f"_{self.design}" if loop == self.innermost - 1 else "")

    def row_number(self, node: Node) -> int:
        if self.design and node in self.own:
            return len(self.scratch) + (self.design - 1) * len(self.own) + self.own.index(node)
        return super().row_number(node)

    def _design_loop(self, level: int) -> None:
        if level < self.innermost:
            super()._design_loop(level)
            return
        first, last = self._bounds(level)
        self.write(level, f"for front in range({first}, {last}, {BATCH}):")
        for _ in self._designs(level):
            self.write(level + 1, f"{self.counter(level - 1)} = min(front + {self.design}, {last} - 1)")

    def _single_values(self, level: int) -> None:
        for _ in self._designs(level):
            super()._single_values(level)

    def _views(self, depth: int, read: list[Node], written: list[Node]) -> None:
        for _ in self._designs(self.level(written[0])):
            super()._views(depth, self._once(read), written)

    def _one_sample(self, depth: int, read: list[Node], work: list[Node], written: list[Node]) -> None:
        for _ in self._designs(self.level(written[0])):
            super()._one_sample(depth, self._once(read), work, written)

    def _reductions(self, level: int) -> None:
        for _ in self._designs(level):
            super()._reductions(level)

    def _designs(self, level: int) -> Iterator[int]:
        """Yield the designs of a batch; names belong to the current one."""
        for design in range(BATCH if level == self.innermost else 1):
            self.design = design
            yield design

    def _once(self, read: list[Node]) -> list[Node]:
        """Return the nodes to read: shared rows only with the first design."""
        return [node for node in read if self.design == 0 or self.level(node) == self.innermost]
