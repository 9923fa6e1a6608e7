"""Write arithmetic of numbers, conditions and arrays by their types; numbers that are known by now remain Python's."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from itertools import zip_longest
from typing import Any

from linksweep.engine.kernel.instructions import Instructions
from linksweep.engine.kernel.machine_code import Array

ARITHMETIC: Mapping[type, tuple[str, Callable[[Any, Any], Any]]] = {
    ast.Add: ("+", operator.add),
    ast.Sub: ("-", operator.sub),
    ast.Mult: ("*", operator.mul),
    ast.Div: ("/", operator.truediv),
    ast.FloorDiv: ("//", operator.floordiv),
    ast.Mod: ("%", operator.mod),
}
"""Arithmetic: by the name of its instructions, and of Python's numbers."""
COMPARISONS: Mapping[type, tuple[str, Callable[[Any, Any], Any]]] = {
    ast.Lt: ("<", operator.lt),
    ast.LtE: ("<=", operator.le),
    ast.Gt: (">", operator.gt),
    ast.GtE: (">=", operator.ge),
    ast.Eq: ("==", operator.eq),
    ast.NotEq: ("!=", operator.ne),
}


def each(function: Callable[..., Any], *trees: Any) -> Any:
    """Apply a function to the parts of values: those of a tuple, and of an array, where it starts and its shape."""
    if not isinstance(trees[0], tuple):
        return function(*trees)
    parts = [each(function, *parts) for parts in zip(*trees, strict=True)]
    return Array(*parts) if isinstance(trees[0], Array) else tuple(parts)


class Values:
    """Writer of instructions on values, in the place of a builder."""

    def __init__(self, builder: Any) -> None:
        self.builder, self.write = builder, Instructions(builder)

    def typed(self, value: Any) -> Any:
        """Return a value of LLVM for a number of Python."""
        if isinstance(value, bool):
            return self.write.condition(value)
        return self.write.integer(value) if isinstance(value, int) else self.write.value(value)

    def is_whole(self, value: Any) -> bool:
        """Return whether a value is an integer or a condition."""
        return self.typed(value).type in (self.write.integer, self.write.condition)

    def common(self, x: Any, y: Any) -> Any:
        """Return the type that two values can take."""
        kinds = [self.typed(value).type for value in (x, y)]
        order = [self.write.vector, self.write.double, self.write.integer, self.write.condition]
        return min(kinds, key=order.index) if all(kind in order for kind in kinds) else kinds[0]

    def converted(self, kind: Any, value: Any) -> Any:
        """Return a value as one of another type, where that loses nothing."""
        value, write = self.typed(value), self.write
        if value.type == kind:
            return value
        if kind == write.double and value.type == write.integer:
            return self.builder.sitofp(value, kind)
        if kind == write.double and value.type == write.condition:
            return self.builder.uitofp(value, kind)
        if kind == write.integer and value.type == write.condition:
            return self.builder.zext(value, kind)
        raise TypeError(f"{value.type} in place of {kind}")

    def integer(self, value: Any) -> Any:
        return self.converted(self.write.integer, value)

    def number(self, value: Any) -> Any:
        """Return a number that is no integer: a double, or a vector of them."""
        return self.converted(self.write.double, value) if self.is_whole(value) else value

    def truth(self, value: Any) -> Any:
        """Return whether a number is not 0."""
        value = self.typed(value)
        return value if value.type == self.write.condition else self.compared(ast.NotEq, value, 0)

    # ------------------------------------------------------------------------------------------ arithmetic

    def arithmetic(self, operation: type, x: Any, y: Any) -> Any:
        """Return the sum, difference, … of two numbers: an integer of integers."""
        name, of_python = ARITHMETIC[operation]
        if isinstance(x, int | float) and isinstance(y, int | float):
            return of_python(x, y)
        if name != "/" and self.is_whole(x) and self.is_whole(y):
            return self._whole(name, self.integer(x), self.integer(y))
        return self.write.operators[name](self.number(x), self.number(y))

    def _whole(self, name: str, x: Any, y: Any) -> Any:
        """Write arithmetic of integers; quotients are rounded down, as in Python."""
        builder = self.builder
        if name in ("+", "-", "*"):
            return {"+": builder.add, "-": builder.sub, "*": builder.mul}[name](x, y, flags=("nsw",))
        rest, none = builder.srem(x, y), x.type(0)
        other_sign = builder.icmp_signed("<", builder.xor(rest, y), none)
        below = builder.and_(builder.icmp_signed("!=", rest, none), other_sign)
        if name == "%":
            return builder.select(below, builder.add(rest, y), rest)
        return builder.sub(builder.sdiv(x, y), self.integer(below))

    def compared(self, comparison: type, x: Any, y: Any) -> Any:
        """Return whether two numbers compare so."""
        name, of_python = COMPARISONS[comparison]
        if isinstance(x, int | float) and isinstance(y, int | float):
            return of_python(x, y)
        if self.is_whole(x) and self.is_whole(y):
            return self.builder.icmp_signed(name, self.integer(x), self.integer(y))
        return self.write.operators[name](self.number(x), self.number(y))

    def extreme(self, comparison: type, x: Any, y: Any) -> Any:
        """Return the first of two values, or the second where that compares so to the first."""
        kind = self.common(x, y)
        x, y = self.converted(kind, x), self.converted(kind, y)
        return self.builder.select(self.compared(comparison, y, x), y, x)

    # ---------------------------------------------------------------------------------------------- arrays

    def place(self, array: Array, indices: tuple[Any, ...]) -> Any:
        """Return a pointer to an element, or to where a part begins."""
        at: Any = self.write.integer(0)
        for length, index in zip_longest(array.shape, indices, fillvalue=0):
            at = self.arithmetic(ast.Add, self.arithmetic(ast.Mult, at, length), index)
        return self.builder.gep(array.data, [at])

    def part(self, array: Array, indices: tuple[Any, ...]) -> Array:
        """Return a row of an array, or, where the last index is a slice, some numbers of a row, or some rows."""
        *first, last = indices
        if not isinstance(last, slice):
            return Array(self.place(array, indices), array.shape[len(indices) :])
        _, length, *rest = array.shape[len(first) - 1 :] if first else (None, *array.shape)
        start, stop = last.start or 0, length if last.stop is None else last.stop
        length = self.arithmetic(ast.Sub, stop, self.integer(start))
        return Array(self.place(array, (*first, start)), (length, *rest))
