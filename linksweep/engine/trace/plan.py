"""Plan a request: select the operations that it needs, and decide how often each is done.

The plan walks back from the requested names to the inputs and keeps the operations on the way. An operation's dims are
the union of its operands' dims, so operations that depend on geometry alone are shared by all masses.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache

from linksweep.base.memory import without_collecting
from linksweep.engine.quantity import Row, Table, Total
from linksweep.engine.trace.contraction import contracted
from linksweep.engine.trace.graph import Graph, Node, in_order, leading_to
from linksweep.engine.trace.operators import traced_arctangent
from linksweep.engine.trace.simplified import Simplified

INSTRUCTIONS = {"sum_low": 5, "difference_low": 5, "ordered_low": 2}
"""Instructions of operations that take more than one, besides the sum itself."""

LOW_WORD = "_lo"
"""Ending of the names of low words."""


def instructions(operator: str) -> int:
    """Return how many instructions an operation takes."""
    if operator == "atan2":
        return sum(1 for node in traced_arctangent().nodes if node.operands)
    return INSTRUCTIONS.get(operator, 1)


@dataclass(frozen=True, eq=False)
class Plan:
    """A request traced into operations: `nodes` in order, `outputs` by name, `functions` traced, in the order of
    tracing."""

    index: str
    outputs: Mapping[str, Node]
    functions: tuple[str, ...]

    @cached_property
    def nodes(self) -> tuple[Node, ...]:
        return tuple(leading_to(self.outputs.values()))

    @cached_property
    def input_nodes(self) -> tuple[Node, ...]:
        return tuple(node for node in self.nodes if node.operator == "input")

    @cached_property
    def inputs(self) -> tuple[str, ...]:
        return tuple(node.value for node in self.input_nodes)

    @cached_property
    def constants(self) -> tuple[Node, ...]:
        return tuple(node for node in self.nodes if node.operator == "constant")

    @cached_property
    def loops(self) -> tuple[str, ...]:
        """Return the design dims, outermost first: dims that most operations depend on are outside, to share those
        operations."""
        counts = Counter(node.dims for node in self.nodes)

        def number(*dims: str) -> int:
            return sum(count for of_node, count in counts.items() if of_node.issuperset(dims))

        dims = frozenset[str]().union(*counts) - {self.index}
        return tuple(sorted(dims, key=lambda dim: (-number(dim, self.index), -number(dim), dim)))

    @cached_property
    def dims_of_outputs(self) -> Mapping[str, tuple[str, ...]]:
        return {name: self.dims(node) for name, node in self.outputs.items()}

    @cached_property
    def stored(self) -> tuple[Node, ...]:
        """Return the nodes that are outputs, but constants."""
        return tuple(in_order({node for node in self.outputs.values() if node.operator != "constant"}))

    def operations(self, *dims: str) -> Counter:
        """Return how many operations of each kind are done once per sample of these dims (no dims: once in all)."""
        return Counter(node.operator for node in self.nodes if node.dims == frozenset(dims) and node.operands)

    def instructions(self, *dims: str) -> int:
        """Return how many instructions that takes: a low word of a sum and an arctangent take several."""
        return sum(count * instructions(operator) for operator, count in self.operations(*dims).items())

    def only(self, names: tuple[str, ...]) -> Plan:
        """Return the plan of some of the outputs."""
        return _only(self, names)

    def with_arctangents_expanded(self) -> Plan:
        """Return the plan with the operations of each arctangent in its place."""
        graph, copies = Simplified(), dict[Node, Node]()
        for node in self.nodes:
            operands = tuple(copies[x] for x in node.operands)
            copies[node] = _arctangent(*operands) if node.operator == "atan2" else graph.copy(node, operands)
        return Plan(self.index, {name: copies[node] for name, node in self.outputs.items()}, self.functions)

    def dims(self, node: Node) -> tuple[str, ...]:
        """Return a node's dims in the order of its results: loops outermost first, the index last."""
        return tuple(dim for dim in (*self.loops, self.index) if dim in node.dims)


def _arctangent(y: Node, x: Node) -> Node:
    """Return an arctangent by its operations."""
    (inputs, nodes, (angle,)), graph = traced_arctangent(), y.graph
    copies = dict(zip(inputs, (y, x), strict=True))
    for node in nodes:
        copies[node] = graph.copy(node, tuple(copies[operand] for operand in node.operands))
    return copies[angle]


@lru_cache(maxsize=256)
def _only(whole: Plan, names: tuple[str, ...]) -> Plan:
    return Plan(whole.index, {name: whole.outputs[name] for name in names}, whole.functions)


InputForms = tuple[tuple[str, tuple[str, ...] | float], ...]
"""Each input by name: its dims, or its value where that is a constant (0 or 1) that shortens the plan."""


@lru_cache(maxsize=256)
@without_collecting()
def plan(table: Table, request: tuple[str, ...], inputs: InputForms) -> Plan:
    """Trace `request` through `table`, starting from `inputs`.

    Raises KeyError for a name that no row makes, and ValueError for one that is made of itself.
    """
    graph = Graph()
    known = {name: form for name, form in inputs if isinstance(form, float)}
    values = {name: graph.input(name, () if isinstance(form, float) else form) for name, form in inputs}
    _mark_low_words(graph, values)
    made_by: dict[str, range] = {}
    for name in request:
        _trace(name, table, graph, values, made_by)
    done = contracted([values[name] for name in request], known)
    outputs = {name: done.values[values[name]] for name in request}
    alive = {done.made[node].position for node in leading_to(outputs.values())}
    functions = tuple(name for name, made in made_by.items() if not alive.isdisjoint(made))
    return Plan(table.index, outputs, functions)


def _trace(name: str, table: Table, graph: Graph, values: dict[str, Node], made_by: dict[str, range]) -> None:
    """Trace the row that makes a name, after the rows that make its inputs: a chain of links may be a long way."""
    waiting, opened = [name], set[str]()
    while waiting:
        if waiting[-1] in values:
            waiting.pop()
            continue
        row: Row | Total = table.maker[waiting[-1]]
        missing = [source for source in row.wiring if isinstance(source, str) and source not in values]
        if missing:
            if waiting[-1] in opened:
                raise ValueError(f"the table makes {waiting[-1]} of itself")
            opened.add(waiting[-1])
            waiting.extend(reversed(missing))
            continue
        before = len(graph.nodes)
        made = row.function(*(values[x] if isinstance(x, str) else graph.node(x) for x in row.wiring))
        made = made if isinstance(made, tuple) else (made,)
        values.update((output, graph.node(x).rounded()) for output, x in zip(row.outputs, made, strict=True))
        _mark_low_words(graph, {output: values[output] for output in row.outputs})
        made_by[f"{row.function.__name__} → {', '.join(row.outputs)}"] = range(before, len(graph.nodes))


def _mark_low_words(graph: Graph, values: Mapping[str, Node]) -> None:
    """Mark the values whose names say that they are low words of double-doubles."""
    graph.low_words |= {node for name, node in values.items() if name.endswith(LOW_WORD)}
