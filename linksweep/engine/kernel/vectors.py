"""Write vector instructions: the functions of a kernel's source that are marked `@vectorised`.

Such a function is straight-line arithmetic on numbers, elements and rows of arrays:

    @vectorised
    def rows_1(samples, profiles, block, values):
        x5 = values[3]
        for j in in_vectors(0, samples, samples):
            cos2 = profiles[0, j]
            x7 = cos2 * x5
            block[2, j] = x7

Run on the values of this module, each operation writes one instruction (`engine.kernel.instructions`), on as many
samples side by side as the processor takes: nothing is left to a compiler that may or may not vectorise a loop. The
last vector of a row ends with the row, and so repeats samples of the vector before it: rows have at least `LANES`
samples, and no function changes a row that it reads.
"""

from __future__ import annotations

import inspect
import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import partial
from types import FunctionType
from typing import Any

from linksweep.engine.kernel import instructions
from linksweep.engine.kernel.instructions import REGISTER, Instructions

LANES = 2 * REGISTER
"""Samples side by side on processors with the widest registers; the least length of a row."""
SOURCE = inspect.getsource(sys.modules[__name__]) + instructions.SOURCE
"""All that enters the machine code besides the functions themselves."""


def width() -> int:
    """Return how many samples the processor that numba compiles for takes side by side: two registers of them, as one
    alone would wait for the results of its own operations."""
    from numba.core.registry import cpu_target

    features = cpu_target.target_context.codegen().magic_tuple()[2].split(",")
    return 16 if "+avx512f" in features else 8 if "+avx" in features else 4


def intrinsic(function: FunctionType, streamed: str = "") -> Callable:
    """Return a function as instructions that numba puts in place of its calls; rows of the array that is `streamed` are
    stored past the caches."""
    names = list(inspect.signature(function).parameters)

    def emit(builder: Any, *arguments: Any) -> None:
        writer = _Writer(builder)
        passed = [writer.argument(x, name == streamed) for name, x in zip(names, arguments, strict=True)]
        FunctionType(function.__code__, writer.names())(*passed)

    return instructions.intrinsic(emit, names)


def _operation(name: str, reflected: bool = False) -> Callable[..., _Value]:
    def operation(self: _Value, *others: _Value | float) -> _Value:
        return self.writer.operation(name, *((*others, self) if reflected else (self, *others)))

    return operation


class _Value:
    """A number, integer or condition in machine code, or a vector of them; operations on it write instructions."""

    def __init__(self, writer: _Writer, llvm: Any) -> None:
        self.writer, self.llvm = writer, llvm

    __add__, __radd__ = _operation("+"), _operation("+", reflected=True)
    __sub__, __rsub__ = _operation("-"), _operation("-", reflected=True)
    __mul__, __rmul__ = _operation("*"), _operation("*", reflected=True)
    __truediv__, __rtruediv__ = _operation("/"), _operation("/", reflected=True)
    __lt__, __gt__ = _operation("<"), _operation(">")
    __neg__, __abs__ = _operation("negate"), _operation("abs")


class _Array:
    """An array in machine code: elements are loaded and stored, or, within a loop, vectors of rows."""

    def __init__(self, writer: _Writer, struct: Any, streamed: bool) -> None:
        self.writer, self.struct, self.streamed = writer, struct, streamed

    def __getitem__(self, index: Any) -> _Value:
        start, at = self._place(index)
        return _Value(self.writer, self.writer.load(start, at))

    def __setitem__(self, index: Any, value: _Value | float) -> None:
        self.writer.store(value, *self._place(index), self.streamed)

    def _place(self, index: Any) -> tuple[Any, Any]:
        """Return a pointer to an element, or to the start of a row and the sample of it where a vector begins."""
        writer, (*row, last) = self.writer, index if isinstance(index, tuple) else (index,)
        in_loop = last is writer.sample
        with writer.before_loop():  # where rows start does not change in it
            row_length = [_Value(writer, writer.builder.extract_value(self.struct.shape, 1)) for _ in row]
            start = sum((x * length for x, length in zip(row, row_length, strict=True)), 0 if in_loop else last)
            pointer = writer.builder.gep(self.struct.data, [writer.integer(start)])
        return pointer, last.llvm if in_loop else None


class _Writer:
    """Writer of one function's instructions."""

    def __init__(self, builder: Any) -> None:
        self.builder, self.instructions = builder, Instructions(builder, width())
        self.head: Any = None
        """The block before the loop that is being written."""
        self.sample: _Value | None = None
        """The first of the samples that the loop works on."""

    def names(self) -> dict[str, Any]:
        """Return the functions that a function's source may use."""
        operations = {name: partial(self.operation, name) for name in self.instructions.operators}
        return {"math": math, "in_vectors": self.in_vectors, "number": self.number} | operations

    def argument(self, llvm: Any, streamed: bool) -> _Value | _Array:
        return _Array(self, llvm, streamed) if hasattr(llvm, "data") else _Value(self, llvm)

    # ------------------------------------------------------------------------------------------ loops

    def in_vectors(self, first: _Value | int, last: _Value | int, samples: _Value | int) -> Iterator[_Value]:
        """Write a loop over the samples, with the instructions that are written until the next value is asked for."""
        from numba.core import cgutils

        builder, step = self.builder, self.integer(self.instructions.width)
        first, last, samples = map(self.integer, (first, last, samples))
        latest = builder.sub(self._larger(samples, self.integer(LANES)), step)
        self.head = builder.block
        with cgutils.for_range_slice(builder, first, last, step, step.type) as (j, _):
            self.sample = _Value(self, builder.select(builder.icmp_signed("<", j, latest), j, latest))
            yield self.sample
        self.head = None

    def _larger(self, x: Any, y: Any) -> Any:
        return self.builder.select(self.builder.icmp_signed(">", x, y), x, y)

    @contextmanager
    def before_loop(self) -> Iterator[None]:
        """Write what follows before the loop, if one is being written."""
        inside = self.head and self.builder.block is not self.head
        with self.builder.goto_block(self.head) if inside else nullcontext():
            yield

    # ------------------------------------------------------------------------------------------ values

    def operation(self, name: str, *operands: _Value | float) -> _Value:
        values = [x.llvm if isinstance(x, _Value) else x for x in operands]
        if any(getattr(x, "type", None) == self.instructions.integer for x in values):
            with self.before_loop():
                whole = {"+": self.builder.add, "*": self.builder.mul}[name]
                return _Value(self, whole(*(self.integer(x) for x in operands)))
        return _Value(self, self.instructions.operators[name](*values))

    def number(self, value: float) -> _Value:
        return _Value(self, self.instructions.double(value))

    def integer(self, value: _Value | float) -> Any:
        return value.llvm if isinstance(value, _Value) else self.instructions.integer(int(value))

    def load(self, pointer: Any, sample: Any) -> Any:
        if sample is not None:
            return self.instructions.load(pointer, sample)
        with self.before_loop():
            return self.builder.load(pointer)

    def store(self, value: _Value | float, pointer: Any, sample: Any, streamed: bool) -> None:
        llvm = value.llvm if isinstance(value, _Value) else value
        if sample is not None:
            write = self.instructions.stream if streamed else self.instructions.store
            write(llvm, pointer, sample)
        else:
            self.builder.store(self.instructions.as_number(llvm), pointer)
