"""Trace physics functions into a graph of single operations.

A function called with traced values records each + - * /, square root and low word once (equal operations
are shared) and leaves out trivial operations: 0·x, 0 + x, 1·x. That changes no bit of any result: each remaining
operation is rounded as IEEE prescribes, never contracted or reordered, so every path that evaluates the graph returns
equal bits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

COMMUTATIVE = {"+", "*", "sum_low", "product_low"}
LOW_WORDS = {"sum_low": "+", "difference_low": "-", "ordered_low": "+", "product_low": "*"}
"""Operations that give what the rounded result of another one misses: error bounds and derivatives leave them out."""
FOLDABLE: dict[str, Callable[..., float]] = {
    "<": lambda x, y: float(x < y),
    "abs": abs,
    "where": lambda c, x, y: x if c else y,
}
"""Operations computed while tracing where their operands are constants."""


def _traced(name: str, reflected: bool = False) -> Callable[..., Node]:
    """Return an operator of nodes, or of a number and a node, that traces the operation of this name."""

    def operator(self: Node, other: Node | float) -> Node:
        x, y = (other, self) if reflected else (self, other)
        return getattr(self.graph, name)(self.graph.node(x), self.graph.node(y))

    return operator


class Node:
    """One operation (or input, or constant) of a graph, with the dimensions that its value depends on."""

    __slots__ = ("dims", "graph", "operands", "operator", "position", "value")

    def __init__(self, graph: Graph, operator: str, operands: tuple[Node, ...], dims: frozenset[str], value):
        self.graph, self.operator, self.operands, self.dims, self.value = graph, operator, operands, dims, value
        self.position = len(graph.nodes)
        graph.nodes.append(self)

    __add__, __radd__ = _traced("add"), _traced("add", reflected=True)
    __sub__, __rsub__ = _traced("subtract"), _traced("subtract", reflected=True)
    __mul__, __rmul__ = _traced("multiply"), _traced("multiply", reflected=True)
    __truediv__, __rtruediv__ = _traced("divide"), _traced("divide", reflected=True)

    def __neg__(self):
        return self.graph.negate(self)

    def __abs__(self):
        return self.graph.operation("abs", self)

    def __lt__(self, other):
        return self.graph.operation("<", self, self.graph.node(other))

    def __gt__(self, other):
        return self.graph.node(other) < self

    def sqrt(self):
        return self.graph.operation("sqrt", self)

    def atan2(self, x):
        return self.graph.operation("atan2", self, self.graph.node(x))

    def low_word(self, name, x, y):
        return getattr(self.graph, name)(self.graph.node(x), self.graph.node(y))

    def marked_low(self) -> Node:
        """Mark as the low word of a double-double, which has no derivative."""
        self.graph.low_words.add(self)
        return self

    @property
    def read(self) -> tuple[Node, ...]:
        """The operands, and last the rounded result whose low word this is, if that was traced before."""
        high = self.graph.find(LOW_WORDS.get(self.operator, ""), *self.operands)
        return (*self.operands, high) if high and high.position < self.position else self.operands

    def where(self, x, y):
        x, y = self.graph.node(x), self.graph.node(y)
        return x if x is y else self.graph.operation("where", self, x, y)

    def is_constant(self, value: float) -> bool:
        return self.operator == "constant" and self.value == value


class Graph:
    """Nodes in order of creation, so that operands precede the operations that use them."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self.low_words: set[Node] = set()
        self._known: dict[tuple[str, tuple[int, ...], object], Node] = {}

    def node(self, value: Node | float) -> Node:
        return value if isinstance(value, Node) else self.constant(float(value))

    def constant(self, value: float) -> Node:
        return self._make("constant", (), frozenset(), value)

    def input(self, name: str, dims: tuple[str, ...]) -> Node:
        return self._make("input", (), frozenset(dims), name)

    def operation(self, operator: str, *operands: Node) -> Node:
        if operands[0].operator == "constant" and operator in FOLDABLE:
            if all(x.operator == "constant" for x in operands):
                return self.constant(FOLDABLE[operator](*(x.value for x in operands)))
            if operator == "where":
                return operands[1] if operands[0].value else operands[2]
        return self._make(operator, operands, frozenset().union(*(x.dims for x in operands)), None)

    def copy(self, node: Node, operands: tuple[Node, ...]) -> Node:
        """Return a copy of a node of another graph, with operands of this one."""
        return self._make(node.operator, operands, node.dims, node.value)

    def find(self, operator: str, *operands: Node) -> Node | None:
        """Return the node of an operation on these operands, if there is one."""
        return self._known.get(_key(operator, operands, None))

    def _make(self, operator: str, operands: tuple[Node, ...], dims: frozenset[str], value) -> Node:
        key = _key(operator, operands, value)
        if key not in self._known:
            self._known[key] = Node(self, operator, operands, dims, value)
        return self._known[key]

    def add(self, x: Node, y: Node) -> Node:
        if x.is_constant(0.0):
            return y
        if y.is_constant(0.0):
            return x
        if y.operator == "negate":
            return self.subtract(x, y.operands[0])
        if x.operator == "negate":
            return self.subtract(y, x.operands[0])
        return self.operation("+", x, y)

    def subtract(self, x: Node, y: Node) -> Node:
        if y.is_constant(0.0):
            return x
        if x.is_constant(0.0):
            return self.negate(y)
        if y.operator == "negate":
            return self.add(x, y.operands[0])
        if x.operator == "negate":
            return self.negate(self.add(x.operands[0], y))
        return self.operation("-", x, y)

    def multiply(self, x: Node, y: Node) -> Node:
        if x.is_constant(0.0) or y.is_constant(0.0):
            return self.constant(0.0)
        if x.is_constant(1.0):
            return y
        if y.is_constant(1.0):
            return x
        if x.operator == "negate":
            return self.negate(self.multiply(x.operands[0], y))
        if y.operator == "negate":
            return self.negate(self.multiply(x, y.operands[0]))
        return self.operation("*", x, y)

    def sum_low(self, x: Node, y: Node) -> Node:
        """Return what the rounded sum misses of x + y."""
        if x.is_constant(0.0) or y.is_constant(0.0):
            return self.constant(0.0)
        if x.operator == "negate" == y.operator:
            return self.negate(self.sum_low(x.operands[0], y.operands[0]))
        if y.operator == "negate":
            return self.operation("difference_low", x, y.operands[0])
        if x.operator == "negate":
            return self.operation("difference_low", y, x.operands[0])
        return self.operation("sum_low", x, y)

    def ordered_low(self, x: Node, y: Node) -> Node:
        """Return what the rounded sum misses of x + y, where |x| ≥ |y| or x = 0."""
        if x.is_constant(0.0) or y.is_constant(0.0):
            return self.constant(0.0)
        return self.operation("ordered_low", x, y)

    def product_low(self, x: Node, y: Node) -> Node:
        """Return what the rounded product misses of x·y."""
        if any(z.is_constant(value) for z in (x, y) for value in (0.0, 1.0)):
            return self.constant(0.0)
        if x.operator == "negate":
            return self.negate(self.product_low(x.operands[0], y))
        if y.operator == "negate":
            return self.negate(self.product_low(x, y.operands[0]))
        return self.operation("product_low", x, y)

    def divide(self, x: Node, y: Node) -> Node:
        if x.is_constant(0.0) or y.is_constant(1.0):
            return x
        if x.operator == "negate":
            return self.negate(self.divide(x.operands[0], y))
        return self.operation("/", x, y)

    def negate(self, x: Node) -> Node:
        """Return −x, with the sign moved outward until a sum absorbs it: rounding is symmetric, so no bit changes."""
        if x.operator == "constant":
            return self.constant(-x.value if x.value else 0.0)
        if x.operator == "negate":
            return x.operands[0]
        return self.operation("negate", x)


def operands(nodes: Iterable[Node]) -> set[Node]:
    """Return the operands of nodes."""
    return {x for node in nodes for x in node.operands}


def in_order(nodes: Iterable[Node]) -> list[Node]:
    """Return nodes in the order in which they were traced."""
    return sorted(nodes, key=lambda node: node.position)


def leading_to(nodes: Iterable[Node]) -> list[Node]:
    """Return nodes and all on which they depend, in order."""
    known, waiting = set[Node](), [*nodes]
    while waiting:
        node = waiting.pop()
        if node not in known:
            known.add(node)
            waiting.extend(node.operands)
    return in_order(known)


def _key(operator: str, operands: tuple[Node, ...], value: object) -> tuple[str, tuple[int, ...], object]:
    """Return what equal operations have in common."""
    positions = tuple(x.position for x in operands)
    return operator, tuple(sorted(positions)) if operator in COMMUTATIVE else positions, value
