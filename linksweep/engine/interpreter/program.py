"""Write programs of the interpreter: the operations of a plan that have the same dims, as one program each."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from linksweep.engine.interpreter.machine import CODES, COLUMNS
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import Plan


@dataclass(frozen=True, eq=False)
class Program:
    """Operations of the same dims: `numbers` of a design fill the first registers, `rows` are read, `results` made.

    Where the dims include the index, rows are along that, else along all dims together, as for one design.
    """

    dims: tuple[str, ...]
    numbers: tuple[Node, ...]
    rows: tuple[Node, ...]
    results: tuple[Node, ...]
    code: np.ndarray
    registers: int


@lru_cache(maxsize=256)
def programs(plan: Plan) -> tuple[Program, ...]:
    """Return the programs of all that a plan stores, those of fewer dims first: later ones read what they need."""
    work = [node for node in plan.nodes if node.operands]
    output = {*plan.stored} | {x for node in work for x in node.operands if x.dims != node.dims}
    groups = sorted({node.dims for node in work}, key=lambda dims: (len(dims), sorted(dims)))
    return tuple(_program(plan, [node for node in work if node.dims == dims], output) for dims in groups)


def _program(plan: Plan, work: list[Node], output: set[Node]) -> Program:
    own = set(work)
    read = dict.fromkeys(x for node in work for x in node.operands if x not in own)
    along = {plan.index} if plan.index in work[0].dims else work[0].dims
    numbers = tuple(node for node in read if not along & node.dims)
    rows = tuple(node for node in read if along & node.dims)
    results = tuple(node for node in work if node in output)
    registers = _Registers(work, numbers)
    place = {node: k for k, node in enumerate((*rows, *results))}
    code: list[list[int]] = []
    for step, node in enumerate(work):
        for x in node.operands:
            if x not in registers.of:
                code.append([CODES["load"], registers.take(x), place[x]])
        operands = [registers.of[x] for x in node.operands]
        registers.release(node.operands, step)
        code.append([CODES[node.operator], registers.take(node), *operands])
        if node in output:
            code.append([CODES["store"], place[node], registers.of[node]])
        registers.release([node], step)
    table = np.array([row + [0] * (COLUMNS - len(row)) for row in code], dtype=np.int64)
    return Program(plan.dims(work[0]), numbers, rows, results, table, registers.count)


class _Registers:
    """Registers of the values that are still needed; those of `numbers` are kept throughout."""

    def __init__(self, work: list[Node], numbers: tuple[Node, ...]) -> None:
        self.of = {node: k for k, node in enumerate(numbers)}
        self.count, self._kept, self._free = len(numbers), set(numbers), list[int]()
        self._last = {x: step for step, node in enumerate(work) for x in node.operands}

    def take(self, node: Node) -> int:
        if not self._free:
            self._free.append(self.count)
            self.count += 1
        self.of[node] = self._free.pop()
        return self.of[node]

    def release(self, nodes: Iterable[Node], step: int) -> None:
        """Free the registers of nodes that no later step reads."""
        for node in nodes:
            if self._last.get(node, -1) <= step and node in self.of and node not in self._kept:
                self._free.append(self.of.pop(node))
