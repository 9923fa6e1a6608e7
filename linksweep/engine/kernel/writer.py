"""Write the source of one kernel that evaluates one plan.

Design dims become nested loops (dims beyond Python's nesting limit share one loop), the index the inner loop. An
operation is done in the loop of its own dims: once per design if it depends on no angle, else in the inner loop; if
deeper loops share its result, that is kept in a row of `scratch` and read back from cache.

Two choices let LLVM vectorise the inner loop, and losing that costs eightfold: row views are taken before a plain loop
over contiguous rows; and rows of `scratch`, which is flat, lie a distance apart that is a literal in the source, so
that they provably do not overlap. Where a loop has more result rows than the compiler will check for overlap, each
group of rows has a loop of its own, which repeats the operations that groups share: where these are few, that takes
less time than to write all rows to `scratch` and copy them.

    kernel(first, last, samples, sizes, parameters, parameter_at, profiles, profile_at,
           block, block_at, single, single_at, scratch, angles, work)

`parameters` holds the inputs that depend on no angle, flat; `profiles` those that do, one row per design; each input
starts at its `_at`. Results go to rows of `block`, or flat into `single`. `first, last` bound the outermost design loop
(the samples, where there is none), so that a pool of threads can share the work.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from functools import cached_property

from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import Plan

ARGUMENTS = (
    "first, last, samples, sizes, parameters, parameter_at, profiles, profile_at, "
    "block, block_at, single, single_at, scratch, angles, work"
)
INFIX = {"+", "-", "*", "/", "<"}
COMPARISONS = 128
"""Pairs of rows, at most, whose overlap the compiler checks at run time before a vectorised loop."""
COPY = 15
"""Operations that take as long as to write a row to scratch and copy it."""
DEEPEST = 16
"""Most nested design loops: Python allows 20 nested blocks, and a search has two more inside. Further dims share the
innermost loop."""


@dataclass(frozen=True)
class Reduction:
    """A row's summary by a function of `engine.kernel.reduce`: `kind` of the output `name`, two numbers in `single`."""

    kind: str
    name: str


class Writer:
    """Writer of one kernel, level by level: level k is the body of the k-th design loop, level 0 encloses all loops.

    `room` is the distance between the starts of two rows of scratch.
    """

    PLACED: tuple[str, ...] = ()
    """Inputs per sample that the kernel itself writes to rows of scratch."""

    def __init__(self, plan: Plan, reductions: tuple[Reduction, ...], room: int) -> None:
        self.plan, self.reductions, self.room = plan, reductions, room
        self.innermost = min(len(plan.loops), DEEPEST)
        late = set(self._late(plan))
        self.nodes = [node for node in plan.nodes if node not in late]
        stored = () if reductions else plan.stored
        self.rows = tuple(node for node in stored if self.per_sample(node))
        self.singles = tuple(node for node in stored if not self.per_sample(node))
        inputs = [node for node in self.nodes if node.operator == "input"]
        self.parameters = tuple(node for node in inputs if not self.per_sample(node))
        self.placed = frozenset(node for node in inputs if node.value in self.PLACED)
        self.profiles = tuple(node for node in inputs if self.per_sample(node) and node not in self.placed)
        self.surplus: frozenset[Node] = frozenset()
        self.surplus = self._surplus()
        self.copied = frozenset(self.rows) & self._read_back() | self.surplus
        self.scratch = {node: k for k, node in enumerate(self._kept_in_scratch())}
        self.named = {*self.rows, *self.singles, *self.scratch}
        self.uses = Counter(x for node in self.nodes for x in node.operands)
        self.scratch_size = len(self.scratch) * room
        self.lines: list[str] = []

    def _late(self, plan: Plan) -> tuple[Node, ...]:
        """Return the nodes left to numpy, after the kernel."""
        return plan.late

    def per_sample(self, node: Node) -> bool:
        return self.plan.index in node.dims

    def level(self, node: Node) -> int:
        """Return the number of design loops around a node's operation."""
        deepest = max((k + 1 for k, dim in enumerate(self.plan.loops) if dim in node.dims), default=0)
        return min(deepest, self.innermost)

    def _read_back(self) -> set[Node]:
        """Return the rows that deeper loops read back."""
        return {
            x
            for node in self.nodes
            for x in node.operands
            if self.per_sample(x) and x.operator != "input" and self.level(x) < self.level(node)
        }

    def _kept_in_scratch(self) -> list[Node]:
        """Return the nodes with rows in scratch: read back by deeper loops, reduced, placed here, or copied."""
        signals = {self.plan.outputs[reduction.name] for reduction in self.reductions}
        kept = self._read_back() | signals | self.placed | self.copied
        return sorted(kept, key=lambda node: node.position)

    def write(self, depth: int, line: str) -> None:
        self.lines.append("    " * depth + line)

    @cached_property
    def source(self) -> str:
        """Return the source of the kernel."""
        self._begin()
        for level in range(self.innermost + 1):
            if level:
                self._design_loop(level)
            self._body(level)
        return "\n".join(self.lines) + "\n"

    def _begin(self) -> None:
        self.write(0, f"def kernel({ARGUMENTS}):")
        self.write(1, "pass" if self.plan.loops else "start, samples = first, last - first")

    def _design_loop(self, level: int) -> None:
        if level < len(self.plan.loops) and level == self.innermost:
            self._folded_loop(level)
        else:
            self.write(level, f"for {self.counter(level - 1)} in range({', '.join(self._bounds(level))}):")

    def _folded_loop(self, level: int) -> None:
        """Write one loop over the designs of all remaining dims, the last dim fastest."""
        first, *others = range(level - 1, len(self.plan.loops))
        sizes = " * ".join(f"sizes[{loop}]" for loop in (first, *others))
        self.write(level, f"for folded in range({sizes}):")
        self.write(level + 1, f"{self.counter(first)} = folded")
        for loop in reversed(others):
            left, size = self.counter(first), f"sizes[{loop}]"
            self.write(level + 1, f"{self.counter(loop)}, {left} = {left} % {size}, {left} // {size}")

    def _bounds(self, level: int) -> tuple[str, str]:
        """Return the first and last design of a loop; for the outermost loop, those of this call."""
        return ("first", "last") if level == 1 else ("0", f"sizes[{level - 1}]")

    def counter(self, loop: int) -> str:
        return f"i{loop}"

    def _body(self, level: int) -> None:
        self._single_values(level)
        self._sample_loop(level)
        self._reductions(level)

    def _of_designs(self, level: int) -> list[Node]:
        """Return a level's operations that depend on no angle."""
        work = (node for node in self.nodes if node.operator not in ("input", "constant"))
        return [node for node in work if self.level(node) == level and not self.per_sample(node)]

    def _single_values(self, level: int) -> None:
        """Write the operations that depend on no angle."""
        depth = level + 1
        for k, node in enumerate(self.parameters):
            if self.level(node) == level:
                self.write(depth, f"{self.name(node)} = parameters[{self._at('parameter', k, node)}]")
        self._assign(self._of_designs(level), depth)
        for k, node in enumerate(self.singles):
            if self.level(node) == level:
                self.write(depth, f"single[{self._at('single', k, node)}] = {self.name(node)}")

    def _sample_loop(self, level: int) -> None:
        """Write the inner loops over the samples, with the rows that they read and write."""
        depth = level + 1
        for written in self._groups(level):
            work = [node for node in self._needed(written) if self.level(node) == level]
            met = {*written, *(x for node in work for x in node.operands)}
            read = sorted((node for node in met - set(work) if self.per_sample(node)), key=lambda node: node.position)
            self._views(depth, read, written)
            self.write(depth, "for j in range(samples):")
            self._one_sample(depth + 1, read, work, written)
            self._copies(depth, [node for node in written if node in self.copied])

    def _groups(self, level: int) -> list[list[Node]]:
        """Return the rows that a level writes, in groups with a loop each: as many as the compiler will compare."""
        most = self._most(level)
        written = [node for node in {**dict.fromkeys(self.rows), **self.scratch} if self.level(node) == level]
        written = sorted((node for node in written if node not in self.placed), key=lambda node: node.position)
        kept, direct = ([node for node in written if (node in self.scratch) == inside] for inside in (True, False))
        if len(direct) + len((self.copied - self.surplus).intersection(kept)) <= most:
            return [written] if written else []
        return [group for group in (kept, *(direct[k : k + most] for k in range(0, len(direct), most))) if group]

    def _most(self, level: int) -> int:
        """Return the number of rows that a loop of a level may write, as the compiler will compare."""
        read = len(self.profiles) + sum(self.level(node) < level for node in self._read_back())
        return max((n for n in range(2, COMPARISONS) if n * (n - 1) // 2 + n * read <= COMPARISONS), default=1)

    def _surplus(self) -> frozenset[Node]:
        """Return the rows of loops with too many, where to copy them takes less time than to repeat operations."""
        surplus: set[Node] = set()
        for level in range(self.innermost + 1):
            rows = [node for node in self.rows if self.level(node) == level]
            most = self._most(level)
            repeated = {*self._needed(rows[:most])} & {*self._needed(rows[most:])}
            if sum(self.level(node) == level for node in repeated) > COPY * len(rows):
                surplus.update(rows)
        return frozenset(surplus)

    def _needed(self, rows: list[Node]) -> list[Node]:
        """Return all operations per sample on which rows depend, of every level."""
        needed: set[Node] = set()
        waiting = list(rows)
        while waiting:
            node = waiting.pop()
            if node not in needed and self.per_sample(node) and node.operator not in ("input", "constant"):
                needed.add(node)
                waiting.extend(node.operands)
        return sorted(needed, key=lambda node: node.position)

    def _views(self, depth: int, read: list[Node], written: list[Node]) -> None:
        """Write views of the rows that are not in scratch."""
        for node in read:
            if self._is_profile(node):
                row = self._at("profile", self.profiles.index(node), node)
                self.write(depth, f"read_{self.name(node)} = profiles[{row}]{self._part}")
        for node in written:
            if node not in self.scratch:
                self.write(depth, f"written_{self.name(node)} = {self._block_row(node)}")

    def _is_profile(self, node: Node) -> bool:
        return node.operator == "input" and node not in self.placed

    def _one_sample(self, depth: int, read: list[Node], work: list[Node], written: list[Node]) -> None:
        for node in read:
            cell = f"read_{self.name(node)}[j]" if self._is_profile(node) else self._scratch_cell(node)
            self.write(depth, f"{self.name(node)} = {cell}")
        self._assign(work, depth)
        for node in written:
            cell = self._scratch_cell(node) if node in self.scratch else f"written_{self.name(node)}[j]"
            self.write(depth, f"{cell} = {self.name(node)}")

    def _copies(self, depth: int, copied: list[Node]) -> None:
        for node in copied:
            self.write(depth, f"row = {self._block_row(node)}")
            self.write(depth, "for j in range(samples):")
            self.write(depth + 1, f"row[j] = {self._scratch_cell(node)}")

    def _scratch_cell(self, node: Node) -> str:
        return f"scratch[{self.row_number(node) * self.room} + j]"

    def row_number(self, node: Node) -> int:
        """Return the number of a node's row in scratch."""
        return self.scratch[node]

    def _block_row(self, node: Node) -> str:
        return f"block[{self._at('block', self.rows.index(node), node)}]{self._part}"

    @property
    def _part(self) -> str:
        """Return the slice of a row: without design loops, the samples of this call."""
        return "" if self.plan.loops else "[start:start + samples]"

    def _row(self, node: Node) -> str:
        """Return a node's row of scratch."""
        return self._scratch_row(self.row_number(node))

    def _scratch_row(self, k: int) -> str:
        return f"scratch[{k * self.room}:{k * self.room} + samples]"

    def _at(self, table: str, k: int, node: Node) -> str:
        """Return the position of a node's value for the current design: row-major over the node's own loops."""
        place = ""
        for i, dim in enumerate(self.plan.loops):
            if dim in node.dims:
                place = f"({place}) * sizes[{i}] + {self.counter(i)}" if place else self.counter(i)
        return f"{table}_at[{k}]" + (f" + {place}" if place else "")

    def _assign(self, work: list[Node], depth: int) -> None:
        """Write one line per node that is used more than once or elsewhere; inline the others into their only use."""
        used_here = {x for node in work for x in node.operands}
        inlined = {node for node in work if self.uses[node] == 1 and node in used_here and node not in self.named}
        for node in work:
            if node not in inlined:
                self.write(depth, f"{self.name(node)} = {self.expression(node, inlined)}")

    def name(self, node: Node) -> str:
        if node.operator == "constant":
            return repr(node.value) if math.isfinite(node.value) else f"math.{node.value}"
        return node.value if node.operator == "input" else f"x{node.position}"

    def expression(self, node: Node, inlined: set[Node]) -> str:
        """Return an operation as Python source, with operands that only it uses inlined."""
        x = [f"({self.expression(y, inlined)})" if y in inlined else self.name(y) for y in node.operands]
        if node.operator in INFIX:
            return f"{x[0]} {node.operator} {x[1]}"
        if node.operator == "negate":
            return f"-{x[0]}"
        if node.operator == "where":
            return f"{x[1]} if {x[0]} else {x[2]}"
        return f"{node.operator}({', '.join(x)})"

    def _reductions(self, level: int) -> None:
        depth = level + 1
        for k, reduction in enumerate(self.reductions):
            node = self.plan.outputs[reduction.name]
            if self.level(node) == level:
                self.write(depth, f"value, at = {reduction.kind}({self._row(node)}, angles, work)")
                self.write(depth, f"single[{self._at('single', 2 * k, node)}] = value")
                self.write(depth, f"single[{self._at('single', 2 * k + 1, node)}] = at")
