"""Write the source of one kernel that evaluates one plan.

Design dims become nested loops (dims beyond Python's nesting limit share one loop), the index the inner loop. An
operation is done in the loop of its own dims: once per design if it depends on no angle, else in the inner loop. If
deeper loops share its result, that is kept: in `values`, or, per sample, in a row of `scratch`.

    kernel(first, last, samples, room, apart, sizes, parameters, parameter_at, profiles, profile_at,
           block, block_at, single, single_at, scratch, values, angles, work)

`parameters` holds the inputs that depend on no angle, flat; `profiles` those that do, one row per design; each input
starts at its `_at`. Results go to rows of `block`, or flat into `single`. From one row to the next are `room` numbers,
in `scratch` `apart`. `first, last` bound the outermost design loop (the samples, where there is none), so that a pool
of threads can share the work.

The kernel itself holds the design loops. All arithmetic is in functions that it calls, marked `@vectorised`, whose
instructions `engine.kernel.vectors` writes: of each level, one for its single values and one for its rows.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from linksweep.engine.kernel.pipeline import Pipeline, pipeline
from linksweep.engine.once import once
from linksweep.engine.trace.graph import Node, in_order, leading_to, operands
from linksweep.engine.trace.plan import Plan

ARGUMENTS = (
    "first, last, samples, room, apart, sizes, parameters, parameter_at, profiles, profile_at, "
    "block, block_at, single, single_at, scratch, values, angles, work"
)
INFIX = {"+", "-", "*", "/", "<"}
DEEPEST = 16
"""Most nested design loops: Python allows 20 nested blocks. Further dims share the innermost loop."""


@dataclass(frozen=True)
class Reduction:
    """A row's summary by a function of `engine.kernel.reduce`: `kind` of the output `name`, two numbers in `single`."""

    kind: str
    name: str


class Writer:
    """Writer of one kernel, level by level: level k is the body of the k-th design loop, level 0 encloses all loops.
    Long loops over samples are done in stages where they may be `staged`."""

    def __init__(self, plan: Plan, reductions: tuple[Reduction, ...], staged: bool = True) -> None:
        self.plan, self.reductions, self.staged = plan, reductions, staged
        self.innermost = min(len(plan.loops), DEEPEST)
        stored = () if reductions else plan.stored
        self.rows = tuple(node for node in stored if self.per_sample(node))
        self.singles = tuple(node for node in stored if not self.per_sample(node))
        self.parameters = tuple(node for node in plan.input_nodes if not self.per_sample(node))
        self.profiles = tuple(node for node in plan.input_nodes if self.per_sample(node))
        self.scratch = {node: k for k, node in enumerate(self._kept_in_scratch())}
        values = (node for node in plan.nodes if node.operands and not self.per_sample(node))
        self.values = {node: k for k, node in enumerate(values)}
        self.kernel: list[str] = []
        self.functions: list[str] = []
        self.known: set[str] = set()
        self.stages: Mapping[Node, int] = {}
        """Stages of the operations of a loop in stages, while it is written."""
        self.stage = 0
        """The stage of which an operation is written."""

    def per_sample(self, node: Node) -> bool:
        return self.plan.index in node.dims

    def level(self, node: Node) -> int:
        """Return the number of design loops around a node's operation."""
        deepest = max((k + 1 for k, dim in enumerate(self.plan.loops) if dim in node.dims), default=0)
        return min(deepest, self.innermost)

    def _kept_in_scratch(self) -> list[Node]:
        """Return the nodes with rows in scratch: read back by deeper loops, or reduced."""
        signals = {self.plan.outputs[reduction.name] for reduction in self.reductions}
        read_back = {
            x
            for node in self.plan.nodes
            for x in node.operands
            if self.per_sample(x) and x.operator != "input" and self.level(x) < self.level(node)
        }
        return in_order(read_back | signals)

    @property
    def unit(self) -> int:
        """Designs of the outermost loop that are done together."""
        return 1

    @property
    def value_count(self) -> int:
        return len(self.values)

    def write(self, depth: int, line: str) -> None:
        self.kernel.append("    " * depth + line)

    @once
    def source(self) -> str:
        """Return the source of the kernel."""
        self.write(0, f"def kernel({ARGUMENTS}):")
        self.write(1, "pass")
        for level in range(self.innermost + 1):
            self._level(level)
        return "\n".join([*self.functions, "", *self.kernel]) + "\n"

    def _level(self, level: int) -> None:
        """Write a level: the head of its loop, and calls of the functions with its arithmetic."""
        if level:
            self._design_loop(level)
        self._single_values(level)
        self._sample_loop(level)
        self._reductions(level)

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

    # ------------------------------------------------------------------------------- functions of arithmetic

    def _function(self, name: str, level: int) -> None:
        """Begin a function, and call it with the arguments of the kernel and the counters of the loops."""
        loops = range(level if level < self.innermost else len(self.plan.loops))
        self._begin(f"{name}_{level}", [self.counter(loop) for loop in loops], level + 1)

    def _begin(self, name: str, counters: Iterable[str], depth: int) -> None:
        call = f"{name}({', '.join([ARGUMENTS, *counters])})"
        self.functions += ["", "", "@vectorised", f"def {call}:"]
        self.write(depth, call)
        self.known = set()

    def _line(self, depth: int, line: str) -> None:
        self.functions.append("    " * depth + line)

    def _define(self, depth: int, node: Node, expression: str) -> None:
        """Write the line that defines a node's name, once in a function."""
        if self.name(node) not in self.known:
            self.known.add(self.name(node))
            self._line(depth, f"{self.name(node)} = {expression}")

    def _single_values(self, level: int) -> None:
        """Write the operations that depend on no angle."""
        work = [node for node in self.values if self.level(node) == level]
        singles = [node for node in self.singles if self.level(node) == level]
        if not work and not singles:
            return
        self._function("values", level)
        self._read_singles({*singles, *operands(work)} - set(work))
        for node in work:
            self._define(1, node, self._expression(node))
            self._line(1, f"{self._single(node)} = {self.name(node)}")
        for node in singles:
            self._line(1, f"single[{self._at('single', self.singles.index(node), node)}] = {self.name(node)}")

    def _read_singles(self, nodes: Iterable[Node], depth: int = 1) -> None:
        """Write the lines that read those of the nodes which depend on no angle."""
        for node in in_order(nodes):
            if node in self.values or node in self.parameters:
                self._define(depth, node, self._single(node))

    def _single(self, node: Node) -> str:
        """Return the place of a number that depends on no angle."""
        if node in self.values:
            return f"values[{self.values[node]}]"
        return f"parameters[{self._at('parameter', self.parameters.index(node), node)}]"

    def _sample_loop(self, level: int) -> None:
        """Write the loop over the samples."""
        written = [node for node in {**dict.fromkeys(self.rows), **self.scratch} if self.level(node) == level]
        if not written:
            return
        work = [node for node in self._needed(written) if self.level(node) == level]
        self._function("rows", level)
        self._read_singles({*written, *operands(work)} - set(work))
        bounds = "0, samples" if self.plan.loops else "first, last"
        if loop := pipeline(work) if self.staged else None:
            self._in_stages(bounds, loop, {*written})
        else:
            self._line(1, f"for j in in_vectors({bounds}, samples):")
            self._operations(work, written)

    def _in_stages(self, bounds: str, loop: Pipeline, written: set[Node]) -> None:
        """Write a loop whose operations are done in this order, each in its stage of another vector."""
        self.stages = loop.stages
        counters = [f"j{k}" for k in range(1 + max(loop.stages.values()))]
        self._line(1, f"kept = places({len(loop.kept)})")
        for vectors, places in Counter(place.vectors for place in loop.places.values()).items():
            self._line(1, f"waiting_{vectors} = memory({places}, {vectors})")
        self._line(1, f"for {', '.join(counters)}, in in_stages({bounds}, samples, {len(counters)}):")
        for k, (x, self.stage) in enumerate(loop.kept):
            self._define(2, x, f"kept[{k}]")
        for node, stage in loop.stages.items():
            self.stage = stage
            for x in loop.read.get(node, ()):
                number, vectors = loop.places[x]
                self._line(2, f"{self.name(x)} = waiting_{vectors}[{number}, {stage - loop.stages[x]}]")
                self.known.add(self.name(x))
            self._operations([node], {node} & written)
            if place := loop.places.get(node):
                self._line(2, f"waiting_{place.vectors}[{place.number}] = {self.name(node)}")
        self._operations([], written - loop.stages.keys())
        for k, (x, stage) in enumerate(loop.kept):
            self.stage = stage - 1
            self._line(2, f"kept[{k}] = {self.name(x)}")
        self.stages, self.stage = {}, 0

    def _operations(self, work: list[Node], written: Iterable[Node]) -> None:
        """Write operations on samples, what they read, and where it is to be stored."""
        for node in in_order({*written, *operands(work), *work}):
            if self.per_sample(node) and self.name(node) not in self.known:
                self._define(2, node, self._expression(node) if node in work else self._sample(node))
            for cell in self._cells(node) if node in written else ():
                self._line(2, f"{cell} = {self.name(node)}")

    def _needed(self, rows: Iterable[Node]) -> list[Node]:
        """Return all operations per sample on which rows depend, of every level."""
        return [node for node in leading_to(rows) if self.per_sample(node) and node.operands]

    @property
    def number(self) -> str:
        """The name of the number of a loop's sample, or of the first one in a vector."""
        return f"j{self.stage}" if self.stages else "j"

    def _sample(self, node: Node, number: str = "") -> str:
        """Return the place from which a sample is read."""
        number = number or self.number
        if node in self.scratch:
            return f"scratch[{self.scratch[node]}, {number}]"
        return f"profiles[{self._at('profile', self.profiles.index(node), node)}, {number}]"

    def _cells(self, node: Node) -> Iterator[str]:
        """Yield the places where a sample is stored."""
        if node in self.scratch:
            yield f"scratch[{self.scratch[node]}, {self.number}]"
        if node in self.rows:
            yield f"block[{self._at('block', self.rows.index(node), node)}, {self.number}]"

    def _at(self, table: str, k: int, node: Node) -> str:
        """Return the position of a node's value for the current design: row-major over the node's own loops."""
        place = ""
        for i, dim in enumerate(self.plan.loops):
            if dim in node.dims:
                place = f"({place}) * sizes[{i}] + {self.counter(i)}" if place else self.counter(i)
        return f"{table}_at[{k}]" + (f" + {place}" if place else "")

    def name(self, node: Node) -> str:
        if node.operator == "constant":
            return repr(node.value) if math.isfinite(node.value) else f"math.{node.value}"
        passes = self.stage - self.stages.get(node, 0) if self.stages and self.per_sample(node) else 0
        age = f"_{passes}" if passes else ""
        own = node.operator == "input" and node.value.isidentifier()
        return f"{node.value if own else f'x{node.position}'}{age}"

    def _expression(self, node: Node) -> str:
        """Return an operation as Python source."""
        x = [self.name(y) for y in node.read if y in node.operands or y in self.stages]
        if all(y.operator == "constant" for y in node.operands):  # else Python would compute, and refuse 1/0
            x[0] = f"number({x[0]})"
        if node.operator in INFIX:
            return f"{x[0]} {node.operator} {x[1]}"
        return f"-{x[0]}" if node.operator == "negate" else f"{node.operator}({', '.join(x)})"

    def _reduced(self, level: int) -> dict[int, Node]:
        """Return the signals of a level's reductions, by the numbers of these."""
        signals = {k: self.plan.outputs[reduction.name] for k, reduction in enumerate(self.reductions)}
        return {k: node for k, node in signals.items() if self.level(node) == level}

    def _reductions(self, level: int) -> None:
        own = self._reduced(level)
        if own:
            self._function("reductions", level)
        for k, node in own.items():
            value, at = (f"single[{self._at('single', 2 * k + i, node)}]" for i in range(2))
            row = f"scratch[{self.scratch[node]}, :samples]"
            self._line(1, f"{value}, {at} = {self.reductions[k].kind}({row}, angles, work)")
