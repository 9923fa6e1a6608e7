"""fuse(plan): the source of one kernel that does the plan, nothing else.

Design dimensions become nested loops, the index the inner loop. An operation is done in the loop of its own
dimensions: what depends on no angle once per design, what depends on angle in the inner loop, and what
is shared by deeper loops is kept in a row of `scratch` and read back from cache. Row views are taken before a
plain inner loop over contiguous rows: that is what vectorises.

    kernel(first, last, samples, sizes, parameters, parameter_at, profiles, profile_at,
           block, block_at, single, single_at, scratch, angles, period, work)

`parameters` holds the inputs that depend on no angle, flat; `profiles` those that do, one row a sample line; each
input starts at its `_at`. Results go to rows of `block`, or flat into `single`. `first, last` bound the outermost
design loop (the samples, where there is none), so that a pool of threads can share the work.
"""

from __future__ import annotations

import inspect
import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from linksweep.engine import reduce
from linksweep.engine.plan import Plan
from linksweep.engine.trace import Node

ARGUMENTS = (
    "first, last, samples, sizes, parameters, parameter_at, profiles, profile_at, "
    "block, block_at, single, single_at, scratch, angles, period, work"
)
INFIX = {"+", "-", "*", "/", "<"}


@dataclass(frozen=True)
class Reduction:
    """A row's summary by a function of engine.reduce: `kind` of the output `name`, as two numbers in `single`."""

    kind: str
    name: str


@dataclass(frozen=True, eq=False)
class Fused:
    """A kernel's source and the order in which its arguments hold inputs, rows and single results."""

    source: str
    parameters: tuple[Node, ...]
    profiles: tuple[Node, ...]
    rows: tuple[Node, ...]
    singles: tuple[Node, ...]
    reductions: tuple[Reduction, ...]
    scratch_rows: int


class _Writer:
    def __init__(self, plan: Plan, reductions: tuple[Reduction, ...]) -> None:
        self.plan, self.reductions = plan, reductions
        late = set(plan.late)
        self.nodes = [node for node in plan.nodes if node not in late]
        stored = () if reductions else plan.stored
        self.rows = tuple(node for node in stored if self.per_sample(node))
        self.singles = tuple(node for node in stored if not self.per_sample(node))
        inputs = [node for node in self.nodes if node.operator == "input"]
        self.parameters = tuple(node for node in inputs if not self.per_sample(node))
        self.profiles = tuple(node for node in inputs if self.per_sample(node))
        self.signals = {plan.outputs[reduction.name] for reduction in reductions}
        self.scratch = self._nodes_kept_in_scratch()
        self.uses = Counter(x for node in self.nodes for x in node.operands)
        self.lines: list[str] = []

    def per_sample(self, node: Node) -> bool:
        return self.plan.index in node.dims

    def level(self, node: Node) -> int:
        """Number of design loops around a node's work."""
        return max((k + 1 for k, dim in enumerate(self.plan.loops) if dim in node.dims), default=0)

    def _nodes_kept_in_scratch(self) -> dict[Node, int]:
        deeper = {
            x
            for node in self.nodes
            for x in node.operands
            if self.per_sample(x) and x.operator != "input" and self.level(x) < self.level(node)
        }
        kept = (deeper | {s for s in self.signals if self.per_sample(s)}) - set(self.rows)
        return {node: k for k, node in enumerate(sorted(kept, key=lambda node: node.position))}

    def write(self, depth: int, *lines: str) -> None:
        self.lines += ["    " * depth + line for line in lines]

    def kernel(self) -> str:
        self.write(0, f"def kernel({ARGUMENTS}):")
        if not self.plan.loops:
            self.write(1, "samples = last - first")
        for level in range(len(self.plan.loops) + 1):
            if level:
                bounds = "first, last" if level == 1 else f"sizes[{level - 1}]"
                self.write(level, f"for i{level - 1} in range({bounds}):")
            self._level(level, level + 1)
        return "\n".join(self.lines) + "\n"

    def _level(self, level: int, depth: int) -> None:
        self._single_values(level, depth)
        self._sample_loop(level, depth)
        self._reduce(level, depth)
        self.write(depth, "pass") if not level else None

    def _single_values(self, level: int, depth: int) -> None:
        here = [node for node in self.nodes if not self.per_sample(node) and self.level(node) == level]
        for k, node in enumerate(self.parameters):
            if self.level(node) == level:
                self.write(depth, f"{name(node)} = parameters[{self._at('parameter', k, node)}]")
        self._assign([node for node in here if node.operator not in ("input", "constant")], depth)
        for k, node in enumerate(self.singles):
            if self.level(node) == level:
                self.write(depth, f"single[{self._at('single', k, node)}] = {name(node)}")

    def _sample_loop(self, level: int, depth: int) -> None:
        work = [
            node
            for node in self.nodes
            if self.per_sample(node) and self.level(node) == level and node.operator not in ("input", "constant")
        ]
        results = [node for node in self.rows if self.level(node) == level]
        if not work and not results:
            return
        kept = [node for node in self.scratch if self.level(node) == level]
        outside = {x for node in work for x in node.operands if self.per_sample(x)} - set(work)
        outside |= {node for node in results if node.operator == "input"}
        read = sorted(outside, key=lambda node: node.position)
        for node in read:
            self.write(depth, f"row_{name(node)} = {self._row(node)}")
        for node in (*results, *kept):
            self.write(depth, f"out_{name(node)} = {self._row(node, out=True)}")
        self.write(depth, "for j in range(samples):")
        for node in read:
            self.write(depth + 1, f"{name(node)} = row_{name(node)}[j]")
        self._assign(work, depth + 1, keep={*results, *kept})
        for node in (*results, *kept):
            self.write(depth + 1, f"out_{name(node)}[j] = {name(node)}")

    def _row(self, node: Node, out: bool = False) -> str:
        """A row view; with no design loop around, only the samples that this call is to do."""
        return self._whole_row(node, out) + ("" if self.plan.loops else "[first:last]")

    def _whole_row(self, node: Node, out: bool) -> str:
        if node in self.rows and (out or node.operator != "input"):
            return f"block[{self._at('block', self.rows.index(node), node)}]"
        if node in self.scratch:
            return f"scratch[{self.scratch[node]}]"
        return f"profiles[{self._at('profile', self.profiles.index(node), node)}]"

    def _at(self, table: str, k: int, node: Node) -> str:
        """Where a node's value of the current design is: row-major over the node's own loops."""
        place = ""
        for i, dim in enumerate(self.plan.loops):
            if dim in node.dims:
                place = f"({place}) * sizes[{i}] + i{i}" if place else f"i{i}"
        return f"{table}_at[{k}]" + (f" + {place}" if place else "")

    def _assign(self, work: list[Node], depth: int, keep: Iterable[Node] = ()) -> None:
        """One line for each node used more than once or elsewhere; the others are written into their only use."""
        group, inlined = set(work), set()
        users = {x: node for node in work for x in node.operands}
        for node in work:
            if self.uses[node] == 1 and users.get(node) in group and node not in keep:
                inlined.add(node)
        for node in work:
            if node not in inlined:
                self.write(depth, f"{name(node)} = {expression(node, inlined)}")

    def _reduce(self, level: int, depth: int) -> None:
        for k, reduction in enumerate(self.reductions):
            node = self.plan.outputs[reduction.name]
            if self.level(node) != level or node.operator == "constant":
                continue
            if self.per_sample(node):
                call = f"{reduction.kind}({self._row(node)}, angles, period, work)"
            else:
                call = f"({name(node)}, angles[0])"
            self.write(depth, f"value, at = {call}")
            self.write(depth, f"single[{self._at('single', 2 * k, node)}] = value")
            self.write(depth, f"single[{self._at('single', 2 * k + 1, node)}] = at")


def name(node: Node) -> str:
    if node.operator == "constant":
        return "math.nan" if math.isnan(node.value) else repr(node.value)
    return node.value if node.operator == "input" else f"x{node.position}"


def expression(node: Node, inlined: set[Node]) -> str:
    """An operation in Python, with the operations that only it uses written inside."""
    x = [f"({expression(y, inlined)})" if y in inlined else name(y) for y in node.operands]
    if node.operator in INFIX:
        return f"{x[0]} {node.operator} {x[1]}"
    if node.operator == "negate":
        return f"-{x[0]}"
    if node.operator == "where":
        return f"{x[1]} if {x[0]} else {x[2]}"
    return f"{node.operator}({', '.join(x)})"


def fuse(plan: Plan, reductions: tuple[Reduction, ...] = ()) -> Fused:
    """Write the kernel that stores the plan's outputs, or that reduces them row by row."""
    writer = _Writer(plan, reductions)
    body = writer.kernel()
    return Fused(
        source=body,
        parameters=writer.parameters,
        profiles=writer.profiles,
        rows=writer.rows,
        singles=writer.singles,
        reductions=reductions,
        scratch_rows=len(writer.scratch),
    )


def reductions_source() -> str:
    return inspect.getsource(reduce)
