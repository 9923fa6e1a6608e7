"""Leave out trivial operations: 0·x, 0 + x, 1·x, −(−x), and choices that are known while tracing.

That changes no bit of a finite result. Signs are moved outward until a sum absorbs them: rounding is symmetric.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from linksweep.engine.trace.graph import Graph, Key, Node

COMMUTATIVE = {"+", "*", "sum_low", "product_low", "fma", "fnma"}
"""Operations of which the first two operands may change places."""
KNOWN: Mapping[str, Callable[..., float]] = {"<": lambda x, y: float(x < y), "abs": abs}
"""Operations that are computed where their operands are constants."""


class Simplified(Graph):
    """Graph without trivial operations."""

    def apply(self, operator: str, *operands: Node) -> Node:
        if operator in KNOWN and all(x.operator == "constant" for x in operands):
            return self.constant(KNOWN[operator](*(x.value for x in operands)))
        rule = RULES.get(operator)
        return rule(self, *operands) if rule else super().apply(operator, *operands)

    def _key(self, operator: str, operands: tuple[Node, ...], value: object) -> Key:
        """Return the key that equal nodes share, also those whose operands have changed places."""
        if operator in COMMUTATIVE and operands[0].position > operands[1].position:
            operands = (operands[1], operands[0], *operands[2:])
        return operator, operands, value

    def add(self, x: Node, y: Node) -> Node:
        if x.is_constant(0.0):
            return y
        if y.is_constant(0.0):
            return x
        if y.operator == "negate":
            return self.subtract(x, y.operands[0])
        if x.operator == "negate":
            return self.subtract(y, x.operands[0])
        return super().apply("+", x, y)

    def subtract(self, x: Node, y: Node) -> Node:
        if y.is_constant(0.0):
            return x
        if x.is_constant(0.0):
            return self.negate(y)
        if y.operator == "negate":
            return self.add(x, y.operands[0])
        if x.operator == "negate":
            return self.negate(self.add(x.operands[0], y))
        return super().apply("-", x, y)

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
        return super().apply("*", x, y)

    def add_product(self, x: Node, y: Node, z: Node, minus: bool = False) -> Node:
        """Return z + x·y, or z − x·y, rounded once."""
        if x.is_constant(0.0) or y.is_constant(0.0):
            return z
        if z.is_constant(0.0):
            product = self.multiply(x, y)
            return self.negate(product) if minus else product
        for factor, other in ((x, y), (y, x)):
            if factor.is_constant(1.0):
                return self.subtract(z, other) if minus else self.add(z, other)
            if factor.operator == "negate":
                return self.add_product(factor.operands[0], other, z, not minus)
        if z.operator == "negate":
            return self.negate(self.add_product(x, y, z.operands[0], not minus))
        return super().apply("fnma" if minus else "fma", x, y, z)

    def divide(self, x: Node, y: Node) -> Node:
        if x.is_constant(0.0) or y.is_constant(1.0):
            return x
        if x.operator == "negate":
            return self.negate(self.divide(x.operands[0], y))
        return super().apply("/", x, y)

    def negate(self, x: Node) -> Node:
        if x.operator == "constant":
            return self.constant(-x.value if x.value else 0.0)
        if x.operator == "negate":
            return x.operands[0]
        return super().apply("negate", x)

    def choose(self, condition: Node, x: Node, y: Node) -> Node:
        if condition.operator == "constant":
            return x if condition.value else y
        return x if x is y else super().apply("where", condition, x, y)

    def sum_low(self, x: Node, y: Node) -> Node:
        """Return what the rounded sum misses of x + y."""
        if x.is_constant(0.0) or y.is_constant(0.0):
            return self.constant(0.0)
        if x.operator == "negate" == y.operator:
            return self.negate(self.sum_low(x.operands[0], y.operands[0]))
        if y.operator == "negate":
            return super().apply("difference_low", x, y.operands[0])
        if x.operator == "negate":
            return super().apply("difference_low", y, x.operands[0])
        return super().apply("sum_low", x, y)

    def ordered_low(self, x: Node, y: Node) -> Node:
        """Return what the rounded sum misses of x + y, where |x| ≥ |y| or x = 0."""
        if x.is_constant(0.0) or y.is_constant(0.0):
            return self.constant(0.0)
        return super().apply("ordered_low", x, y)

    def product_low(self, x: Node, y: Node) -> Node:
        """Return what the rounded product misses of x·y."""
        if any(z.is_constant(value) for z in (x, y) for value in (0.0, 1.0)):
            return self.constant(0.0)
        if x.operator == "negate":
            return self.negate(self.product_low(x.operands[0], y))
        if y.operator == "negate":
            return self.negate(self.product_low(x, y.operands[0]))
        return super().apply("product_low", x, y)


RULES: Mapping[str, Callable[..., Node]] = {
    "+": Simplified.add,
    "-": Simplified.subtract,
    "*": Simplified.multiply,
    "/": Simplified.divide,
    "fma": Simplified.add_product,
    "fnma": partial(Simplified.add_product, minus=True),
    "negate": Simplified.negate,
    "where": Simplified.choose,
    "rounded": lambda graph, x: x,
    "sum_low": Simplified.sum_low,
    "ordered_low": Simplified.ordered_low,
    "product_low": Simplified.product_low,
}
"""Ways to the values of operations."""
