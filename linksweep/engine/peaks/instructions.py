"""Emit operations of a graph as vector instructions, within functions that numba compiles.

A value is a vector of `WIDTH` doubles; where a processor has narrower registers, the compiler splits it. Each operation
is emitted as it stands in the graph: none is contracted or reordered, so results have the bits of any other path.
"""

from __future__ import annotations

import inspect
import math
import sys
from collections.abc import Callable, Iterable
from typing import Any

from linksweep.engine.trace.graph import Node

WIDTH = 8
"""Lanes of a vector: 8 doubles fill a 512-bit register."""

SOURCE = inspect.getsource(sys.modules[__name__])
"""All that enters the instructions besides the nodes."""

Values = dict[Node, Any]
"""Emitted values of nodes: vectors of doubles, or of bits for comparisons."""


class Emitter:
    """Emitter of vector instructions at the place of an `llvmlite` builder."""

    def __init__(self, builder: Any) -> None:
        from llvmlite import ir

        self.ir, self.builder = ir, builder
        self.vector = ir.VectorType(ir.DoubleType(), WIDTH)
        self.operations: dict[str, Callable[..., Any]] = {
            "+": builder.fadd,
            "-": builder.fsub,
            "*": builder.fmul,
            "/": builder.fdiv,
            "negate": builder.fneg,
            "<": lambda x, y: builder.fcmp_ordered("<", x, y),
            "abs": lambda x: self._intrinsic("fabs", x),
            "sqrt": lambda x: self._intrinsic("sqrt", x),
            "where": self._where,
            "atan2": self._atan2,
            "product_low": lambda x, y: self._intrinsic("fma", x, y, builder.fneg(builder.fmul(x, y))),
        }

    def emit(self, nodes: Iterable[Node], values: Values) -> Values:
        """Emit nodes in order, where they have no value yet; return the values of all."""
        for node in nodes:
            if node.operator == "constant":
                values[node] = self.constant(node.value)
            elif node not in values:
                values[node] = self.operation(node, [values[x] for x in node.operands])
        return values

    def operation(self, node: Node, operands: list[Any]) -> Any:
        return self.operations[node.operator](*operands)

    def constant(self, number: float) -> Any:
        """Return a vector of one number."""
        return self.ir.Constant(self.vector, [float(number)] * WIDTH)

    def spread(self, scalar: Any) -> Any:
        """Return a vector of a scalar."""
        index = self.ir.Constant(self.ir.IntType(32), 0)
        first = self.builder.insert_element(self.constant(math.nan), scalar, index)
        places = self.ir.Constant(self.ir.VectorType(self.ir.IntType(32), WIDTH), [0] * WIDTH)
        return self.builder.shuffle_vector(first, first, places)

    def load(self, start: Any, at: Any) -> Any:
        """Return the vector that starts at a position of an array."""
        return self.builder.load(self._place(start, at), align=8)

    def store(self, value: Any, start: Any, at: Any) -> None:
        """Store a vector, a comparison as 1 and 0, from a position of an array on."""
        if value.type != self.vector:
            value = self.builder.uitofp(value, self.vector)
        self.builder.store(value, self._place(start, at), align=8)

    def integer(self, number: int) -> Any:
        return self.ir.Constant(self.ir.IntType(64), number)

    def _place(self, start: Any, at: Any) -> Any:
        return self.builder.bitcast(self.builder.gep(start, [at]), self.vector.as_pointer())

    def _intrinsic(self, name: str, *x: Any) -> Any:
        kind = self.ir.FunctionType(self.vector, [self.vector] * len(x))
        return self.builder.call(self._function(f"llvm.{name}.v{WIDTH}f64", kind), x)

    def _where(self, condition: Any, x: Any, y: Any) -> Any:
        if condition.type == self.vector:
            condition = self.builder.fcmp_unordered("!=", condition, self.constant(0.0))
        return self.builder.select(condition, x, y)

    def _atan2(self, y: Any, x: Any) -> Any:
        """Call the scalar function for each lane: there is no vector instruction."""
        number = self.ir.DoubleType()
        function = self._function("atan2", self.ir.FunctionType(number, [number, number]))
        angles = self.constant(0.0)
        for k in range(WIDTH):
            lane = self.ir.Constant(self.ir.IntType(32), k)
            one = self.builder.call(function, [self.builder.extract_element(v, lane) for v in (y, x)])
            angles = self.builder.insert_element(angles, one, lane)
        return angles

    def _function(self, name: str, kind: Any) -> Any:
        from numba.core import cgutils

        return cgutils.get_or_insert_function(self.builder.module, kind, name)
