"""Write vector instructions: the functions of a kernel's source that are marked `@vectorised`.

Such a function is straight-line arithmetic on numbers, elements and rows of arrays:

    @vectorised
    def rows_1(samples, profiles, block, values):
        x5 = values[3]
        for j in in_vectors(0, samples, samples):
            cos2 = profiles[0, j]
            x7 = cos2 * x5
            block[2, j] = x7

Run on arrays (`IN_PYTHON`), it works on whole rows. Run on the values of this module, each operation writes one LLVM
instruction, on as many samples side by side as the processor takes: nothing is left to a compiler that may or may not
vectorise a loop. No instruction is contracted or reordered, so results have the bits of numpy, for any width. The last
vector of a row ends with the row, and so repeats samples of the vector before it: rows have at least `LANES` samples,
and no function changes a row that it reads.
"""

from __future__ import annotations

import inspect
import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from types import FunctionType
from typing import Any

import numpy as np

from linksweep.base import product_low as dekker

LANES = 16
"""Samples side by side on processors with the widest registers; the least length of a row."""
SOURCE = inspect.getsource(sys.modules[__name__]) + inspect.getsource(dekker)
"""All that enters the machine code besides the functions themselves."""
IN_PYTHON: dict[str, Any] = {
    "vectorised": lambda function: function,
    "in_vectors": lambda first, last, samples: [slice(first, last)],
    "number": np.float64,
    "sqrt": np.sqrt,
    "atan2": np.vectorize(math.atan2, otypes=[float]),
    "where": np.where,
    "product_low": dekker.product_low,
    "math": math,
}
"""Names for source that runs as Python."""


def processor() -> tuple[int, bool]:
    """Return how many samples the processor that numba compiles for takes side by side, and whether it has fma.

    That is two registers of them: one alone would wait for the results of its own operations.
    """
    from numba.core.registry import cpu_target

    triple, _, listed = cpu_target.target_context.codegen().magic_tuple()
    features = listed.split(",")
    width = 16 if "+avx512f" in features else 8 if "+avx" in features else 4
    return width, "+fma" in features or triple.startswith(("aarch64", "arm64"))


def intrinsic(function: FunctionType) -> Callable:
    """Return a function as instructions that numba puts in place of its calls."""
    import numba.extending
    from numba.core import types

    parameters = list(inspect.signature(function).parameters.values())

    def instructions(typing_context, *arguments):
        def write(context, builder, signature, operands):
            writer = _Writer(context, builder, *processor())
            namesake = FunctionType(function.__code__, writer.names())
            namesake(*map(writer.argument, arguments, operands))
            return context.get_dummy_value()

        return types.void(*arguments), write

    first = inspect.Parameter("typing_context", inspect.Parameter.POSITIONAL_OR_KEYWORD)
    instructions.__signature__ = inspect.Signature([first, *parameters])  # type: ignore[attr-defined]
    return numba.extending.intrinsic(instructions)


def _infix(name: str, reflected: bool = False) -> Callable[[Any, Any], _Value]:
    def operation(self: _Value, other: _Value | float) -> _Value:
        return self.writer.infix(name, *((other, self) if reflected else (self, other)))

    return operation


class _Value:
    """A number, integer or condition in machine code, or a vector of them; operations on it write instructions."""

    def __init__(self, writer: _Writer, llvm: Any) -> None:
        self.writer, self.llvm = writer, llvm

    __add__, __radd__ = _infix("add"), _infix("add", reflected=True)
    __sub__, __rsub__ = _infix("sub"), _infix("sub", reflected=True)
    __mul__, __rmul__ = _infix("mul"), _infix("mul", reflected=True)
    __truediv__, __rtruediv__ = _infix("div"), _infix("div", reflected=True)
    __lt__, __gt__ = _infix("lt"), _infix("lt", reflected=True)

    def __neg__(self) -> _Value:
        return _Value(self.writer, self.writer.builder.fneg(self.llvm))

    def __abs__(self) -> _Value:
        return self.writer.call("fabs", self)


class _Array:
    """An array in machine code: elements are loaded and stored, or, within a loop, vectors of rows."""

    def __init__(self, writer: _Writer, struct: Any) -> None:
        self.writer, self.struct = writer, struct

    def __getitem__(self, index: Any) -> _Value:
        return _Value(self.writer, self.writer.load(*self._pointer(index)))

    def __setitem__(self, index: Any, value: _Value | float) -> None:
        self.writer.store(value, *self._pointer(index))

    def _pointer(self, index: Any) -> tuple[Any, bool]:
        """Return a pointer to an element or a vector, and whether it is the latter."""
        writer, (*row, last) = self.writer, index if isinstance(index, tuple) else (index,)
        in_loop = last is writer.sample
        with writer.before_loop():  # where rows start does not change in it
            row_length = [_Value(writer, writer.builder.extract_value(self.struct.shape, 1)) for _ in row]
            start = sum((x * length for x, length in zip(row, row_length, strict=True)), 0 if in_loop else last)
            pointer = writer.builder.gep(self.struct.data, [writer.integer(start)])
        if in_loop:
            sample = writer.builder.gep(pointer, [writer.integer(last)])
            pointer = writer.builder.bitcast(sample, writer.vector.as_pointer())
        return pointer, in_loop


class _Writer:
    """Writer of one function's instructions."""

    def __init__(self, context: Any, builder: Any, width: int, fma: bool) -> None:
        from llvmlite import ir

        self.context, self.builder, self.width, self.fma, self.ir = context, builder, width, fma, ir
        self.double, self.int64, self.condition = ir.DoubleType(), ir.IntType(64), ir.IntType(1)
        self.vector = ir.VectorType(self.double, width)
        self.head: Any = None
        """The block before the loop that is being written."""
        self.sample: _Value | None = None
        """The first of the samples that the loop works on."""

    def names(self) -> dict[str, Any]:
        """Return the functions that a function's source may use."""
        own = ("in_vectors", "number", "sqrt", "atan2", "where", "product_low")
        return {"math": math} | {name: getattr(self, name) for name in own}

    def argument(self, kind: Any, llvm: Any) -> _Value | _Array:
        if hasattr(kind, "ndim"):
            return _Array(self, self.context.make_array(kind)(self.context, self.builder, llvm))
        return _Value(self, llvm)

    # ------------------------------------------------------------------------------------------ loops

    def in_vectors(self, first: _Value | int, last: _Value | int, samples: _Value | int) -> Iterator[_Value]:
        """Write a loop over the samples, with the instructions that are written until the next value is asked for."""
        from numba.core import cgutils

        builder, step = self.builder, self.int64(self.width)
        first, last, samples = map(self.integer, (first, last, samples))
        latest = builder.sub(self._larger(samples, self.int64(LANES)), step)
        self.head = builder.block
        with cgutils.for_range_slice(builder, first, last, step, self.int64) as (j, _):
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

    # ------------------------------------------------------------------------------------------ operations

    def infix(self, name: str, x: _Value | float, y: _Value | float) -> _Value:
        p, q = self._alike(x, y)
        if p.type == self.int64:
            with self.before_loop():
                return _Value(self, getattr(self.builder, name)(p, q))
        if name == "lt":
            return _Value(self, self.builder.fcmp_ordered("<", p, q))
        return _Value(self, getattr(self.builder, f"f{name}")(p, q))

    def call(self, name: str, *operands: _Value | float) -> _Value:
        """Call LLVM's own function of this name, on numbers or vectors."""
        from numba.core import cgutils

        values = self._alike(*operands)
        kind = values[0].type
        function = self.ir.FunctionType(kind, [kind] * len(values))
        suffix = "f64" if kind == self.double else f"v{self.width}f64"
        called = cgutils.get_or_insert_function(self.builder.module, function, f"llvm.{name}.{suffix}")
        return _Value(self, self.builder.call(called, values))

    def number(self, value: float) -> _Value:
        return _Value(self, self.double(value))

    def sqrt(self, x: _Value) -> _Value:
        return self.call("sqrt", x)

    def product_low(self, x: _Value, y: _Value) -> _Value:
        """x·y − fl(x·y) is a number, so one fused multiply-add computes it exactly."""
        return self.call("fma", x, y, -(x * y)) if self.fma else dekker.product_low(x, y)

    def where(self, condition: _Value, x: _Value | float, y: _Value | float) -> _Value:
        chosen, p, q = self._alike(condition, x, y)
        if self._kind(chosen) == self.double:  # a condition that was stored
            chosen = self.builder.fcmp_unordered("!=", chosen, chosen.type(None))
        return _Value(self, self.builder.select(chosen, p, q))

    def atan2(self, y: _Value, x: _Value) -> _Value:
        from numba.core import types, typing

        angle = self.context.get_function(math.atan2, typing.signature(*[types.float64] * 3))
        p, q = self._alike(y, x)
        if p.type == self.double:
            return _Value(self, angle(self.builder, (p, q)))
        result = p
        for lane in map(self.int64, range(self.width)):
            pair = [self.builder.extract_element(value, lane) for value in (p, q)]
            result = self.builder.insert_element(result, angle(self.builder, pair), lane)
        return _Value(self, result)

    # ------------------------------------------------------------------------------------------ values

    def integer(self, value: _Value | int) -> Any:
        return value.llvm if isinstance(value, _Value) else self.int64(value)

    def _kind(self, llvm: Any) -> Any:
        """Return the type of a value, or of a vector's elements."""
        return llvm.type.element if isinstance(llvm.type, self.ir.VectorType) else llvm.type

    def _alike(self, *operands: _Value | float) -> list[Any]:
        """Return operands in machine code: all as vectors where one of them is."""
        known = [x.llvm for x in operands if isinstance(x, _Value)]
        number = self.int64 if all(x.type == self.int64 for x in known) else self.double
        every = [x.llvm if isinstance(x, _Value) else number(x if number is self.int64 else float(x)) for x in operands]
        return [self._wide(x) for x in every] if any(self._kind(x) != x.type for x in known) else every

    def _wide(self, llvm: Any) -> Any:
        """Return a vector that repeats a single value; of a vector itself."""
        if self._kind(llvm) != llvm.type:
            return llvm
        kind = self.ir.VectorType(llvm.type, self.width)
        places = self.ir.VectorType(self.ir.IntType(32), self.width)(None)
        first = self.builder.insert_element(kind(self.ir.Undefined), llvm, self.int64(0))
        return self.builder.shuffle_vector(first, kind(self.ir.Undefined), places)

    def load(self, pointer: Any, vector: bool) -> Any:
        if vector:
            return self.builder.load(pointer, align=8)
        with self.before_loop():
            return self.builder.load(pointer)

    def store(self, value: _Value | float, pointer: Any, vector: bool) -> None:
        (llvm,) = self._alike(value) if isinstance(value, _Value) else (self.double(value),)
        llvm = self._wide(llvm) if vector else llvm
        if self._kind(llvm) == self.condition:  # stored as 0 or 1
            llvm = self.builder.uitofp(llvm, self.vector if vector else self.double)
        self.builder.store(llvm, pointer, align=8)
