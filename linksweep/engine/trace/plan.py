"""plan(table, request): which operations the request needs, and how often each must be done.

The plan walks back from the names asked for to the inputs and keeps what it meets on the way. An operation's
dimensions are the union of its operands', so what depends on geometry alone is known to be shared by all masses.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache

from linksweep.engine.quantity import Row, Table, Total
from linksweep.engine.trace.graph import Graph, Node

LATE = {"atan2"}
"""Operations done by numpy on stored rows after the kernel: much faster there than compiled."""


@dataclass(frozen=True, eq=False)
class Plan:
    """What to compute: `nodes` in order, `outputs` by name, `functions` that they came from, outermost loop first."""

    index: str
    outputs: Mapping[str, Node]
    functions: tuple[str, ...]

    @cached_property
    def nodes(self) -> tuple[Node, ...]:
        alive: set[Node] = set()
        waiting = list(self.outputs.values())
        while waiting:
            node = waiting.pop()
            if node not in alive:
                alive.add(node)
                waiting.extend(node.operands)
        return tuple(sorted(alive, key=lambda node: node.position))

    @cached_property
    def inputs(self) -> tuple[str, ...]:
        return tuple(node.value for node in self.nodes if node.operator == "input")

    @cached_property
    def loops(self) -> tuple[str, ...]:
        """Design dimensions, outermost first: what most operations depend on is outside, so that it is shared."""
        weight = Counter(dim for node in self.nodes if self.index in node.dims for dim in sorted(node.dims))
        every = Counter(dim for node in self.nodes for dim in sorted(node.dims))
        dims = [dim for dim in every if dim != self.index]
        return tuple(sorted(dims, key=lambda dim: (-weight[dim], -every[dim], dim)))

    @cached_property
    def late(self) -> tuple[Node, ...]:
        """Nodes left to numpy, on what the kernel has stored."""
        late: set[Node] = set()
        for node in self.nodes:
            if node.operator in LATE or not late.isdisjoint(node.operands):
                late.add(node)
        return tuple(node for node in self.nodes if node in late)

    @cached_property
    def stored(self) -> tuple[Node, ...]:
        """Nodes that the kernel stores: outputs, and what the late nodes start from."""
        late = set(self.late)
        wanted = [node for node in self.outputs.values() if node not in late]
        wanted += [x for node in self.late for x in node.operands if x not in late]
        return tuple(sorted({node for node in wanted if node.operator != "constant"}, key=lambda n: n.position))

    def operations(self, *dims: str) -> Counter:
        """How many operations of each kind are done once per sample of these dims (none: once in all)."""
        return Counter(
            node.operator
            for node in self.nodes
            if node.dims == frozenset(dims) and node.operator not in ("input", "constant")
        )

    def dims(self, node: Node) -> tuple[str, ...]:
        """A node's dimensions in the order in which results are laid out: loops outermost first, the index last."""
        return tuple(dim for dim in (*self.loops, self.index) if dim in node.dims)


InputForms = tuple[tuple[str, tuple[str, ...] | float], ...]
"""Each input by name: the dims it carries, or its value where that is a constant (0 or 1) worth knowing."""


@lru_cache(maxsize=256)
def plan(table: Table, request: tuple[str, ...], inputs: InputForms) -> Plan:
    """Trace what `request` needs from `table`, starting from `inputs`. Raises KeyError for a name nobody makes."""
    graph = Graph()
    values: dict[str, Node] = {
        name: graph.constant(form) if isinstance(form, float) else graph.input(name, form) for name, form in inputs
    }
    made_by: dict[str, range] = {}
    for name in request:
        _trace(name, table, graph, values, made_by)
    outputs = {name: values[name] for name in request}
    alive = {node.position for node in Plan(table.index, outputs, ()).nodes}
    functions = tuple(name for name, made in made_by.items() if not alive.isdisjoint(made))
    return Plan(table.index, outputs, functions)


def _trace(name: str, table: Table, graph: Graph, values: dict[str, Node], made_by: dict[str, range]) -> Node:
    if name not in values:
        row: Row | Total = table.maker[name]
        arguments = [
            _trace(source, table, graph, values, made_by) if isinstance(source, str) else graph.node(source)
            for source in row.wiring
        ]
        before = len(graph.nodes)
        made = row.function(*arguments)
        made = made if isinstance(made, tuple) else (made,)
        values.update(zip(row.outputs, map(graph.node, made), strict=True))
        made_by[f"{row.function.__name__} → {', '.join(row.outputs)}"] = range(before, len(graph.nodes))
    return values[name]
