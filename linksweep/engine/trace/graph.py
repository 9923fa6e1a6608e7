"""Trace physics functions into a graph of the operations that they are written with.

A function called with traced values records each + - * /, square root and low word once: equal operations are shared.
`engine.trace.simplified` leaves out those that are trivial, `engine.trace.contraction` makes one operation of a product
and the sum that takes it. Every path that evaluates what remains does the same operations, each rounded as IEEE
prescribes, so all return equal bits.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable
from operator import attrgetter

LOW_WORDS = {"sum_low": "+", "difference_low": "-", "ordered_low": "+", "product_low": "*"}
"""Operations that give what the rounded result of another one misses: error bounds and derivatives leave them out."""


def _traced(operator: str, reflected: bool = False) -> Callable[..., Node]:
    """Return a method of nodes, for another node or a number, that traces this operation."""

    def method(self: Node, other: Node | float) -> Node:
        other = self.graph.node(other)
        return self.graph.apply(operator, other, self) if reflected else self.graph.apply(operator, self, other)

    return method


class Node:
    """One operation (or input, or constant) of a graph, with the dimensions that its value depends on."""

    __slots__ = ("dims", "graph", "operands", "operator", "position", "value")

    def __init__(self, graph: Graph, operator: str, operands: tuple[Node, ...], dims: frozenset[str], value):
        self.graph, self.operator, self.operands, self.dims, self.value = graph, operator, operands, dims, value
        self.position = len(graph.nodes)
        graph.nodes.append(self)

    __add__, __radd__ = _traced("+"), _traced("+", reflected=True)
    __sub__, __rsub__ = _traced("-"), _traced("-", reflected=True)
    __mul__, __rmul__ = _traced("*"), _traced("*", reflected=True)
    __truediv__, __rtruediv__ = _traced("/"), _traced("/", reflected=True)
    __lt__, __gt__ = _traced("<"), _traced("<", reflected=True)
    atan2 = _traced("atan2")

    def __neg__(self):
        return self.graph.apply("negate", self)

    def __abs__(self):
        return self.graph.apply("abs", self)

    def sqrt(self):
        return self.graph.apply("sqrt", self)

    def low_word(self, name, x, y):
        return self.graph.apply(name, self.graph.node(x), self.graph.node(y))

    def where(self, x, y):
        return self.graph.apply("where", self, self.graph.node(x), self.graph.node(y))

    def rounded(self) -> Node:
        """Return the value as a rounded number: no sum takes it as an exact product."""
        return self.graph.apply("rounded", self)

    def marked_low(self) -> Node:
        """Mark as the low word of a double-double, which has no derivative."""
        self.graph.low_words.add(self)
        return self

    @property
    def read(self) -> tuple[Node, ...]:
        """The operands, and last the rounded result whose low word this is, if that was traced before."""
        high = self.graph.find(LOW_WORDS.get(self.operator, ""), *self.operands)
        return (*self.operands, high) if high and high.position < self.position else self.operands

    def is_constant(self, value: float) -> bool:
        return self.operator == "constant" and self.value == value


Key = tuple[str, tuple[Node, ...], object]
"""Operator, operands and value of a node: those of equal nodes are the same."""


class Graph:
    """Nodes in order of creation, so that operands precede the operations that use them."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self.low_words: set[Node] = set()
        self._known: dict[Key, Node] = {}

    def node(self, value: Node | float) -> Node:
        return value if isinstance(value, Node) else self.constant(float(value))

    def constant(self, value: float) -> Node:
        return self._make("constant", (), value, frozenset())

    def input(self, name: str, dims: tuple[str, ...]) -> Node:
        return self._make("input", (), name, frozenset(dims))

    def apply(self, operator: str, *operands: Node) -> Node:
        """Return the value of an operation."""
        return self._make(operator, operands)

    def copy(self, node: Node, operands: tuple[Node, ...]) -> Node:
        """Return a copy of a node of another graph, with operands of this one."""
        return self._make(node.operator, operands, node.value, None if operands else node.dims)

    def find(self, operator: str, *operands: Node) -> Node | None:
        """Return the node of an operation on these operands, if there is one."""
        return self._known.get(self._key(operator, operands, None))

    def _make(
        self, operator: str, operands: tuple[Node, ...], value: object = None, dims: frozenset[str] | None = None
    ) -> Node:
        """Return a node, a new one if there is none that is equal; an operation has the dims of its operands."""
        key = self._key(operator, operands, value)
        node = self._known.get(key)
        if node is None:
            dims = _dims(operands) if dims is None else dims
            node = self._known[key] = Node(self, operator, operands, dims, value)
        return node

    def _key(self, operator: str, operands: tuple[Node, ...], value: object) -> Key:
        """Return the key that equal nodes share."""
        return operator, operands, value


def _dims(operands: tuple[Node, ...]) -> frozenset[str]:
    """Return the dims that any of these operands depends on."""
    dims = operands[0].dims
    for x in operands:
        if not x.dims <= dims:
            dims |= x.dims
    return dims


def operands(nodes: Iterable[Node]) -> set[Node]:
    """Return the operands of nodes."""
    return {x for node in nodes for x in node.operands}


def in_order(nodes: Iterable[Node]) -> list[Node]:
    """Return nodes in the order in which they were traced."""
    return sorted(nodes, key=attrgetter("position"))


def depth_first(last: Iterable[Node], among: Container[Node] | None = None) -> list[Node]:
    """Return nodes and those on which they depend, of all or among some, each operand soon before what takes it: few
    values wait for their use, and no other request changes the order."""
    order, waiting = dict[Node, None](), [*last][::-1]
    while waiting:
        missing = [x for x in waiting[-1].operands if x not in order and (among is None or x in among)]
        if missing:
            waiting.extend(reversed(missing))
        else:
            order[waiting.pop()] = None
    return [*order]


def leading_to(nodes: Iterable[Node]) -> list[Node]:
    """Return nodes and all on which they depend, in order."""
    known, waiting = set[Node](), [*nodes]
    while waiting:
        node = waiting.pop()
        if node not in known:
            known.add(node)
            waiting.extend(node.operands)
    return in_order(known)
