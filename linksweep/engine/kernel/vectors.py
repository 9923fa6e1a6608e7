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
last vector of a row ends with the row, and so repeats samples of the vector before it: rows have at least `WIDEST`
samples, and no function changes a row that it reads.

Of a longer loop, a pass does the last operations of one vector between earlier ones of others. What is read later is
kept until the next pass, or it waits in memory, at one of 4 places for 2 vectors each:

    kept, waiting = places(1), memory(4, 2)
    for j0, j1 in in_stages(0, samples, samples, 2):
        x7_1 = kept[0]
        x3_1 = waiting[0, 1]
        block[2, j1] = x7_1 * x3_1
        cos2 = profiles[0, j0]
        x3 = cos2 * cos2
        waiting[0] = x3
        x7 = x3 * x5
        kept[0] = x7

Designs stand side by side in the same way, with their samples one after the other, and running summaries of these:

    for i0 in in_vectors(first, last, sizes[0]):
        x5 = parameters[i0]
        s0 = running("largest_sample", values, 0)
        for j in each(0, samples):
            s0.take(profiles[0, j] * x5, j)
        s0.write_to(single, i0, sizes[0] + i0, angles)
"""

from __future__ import annotations

import inspect
import math
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import partial
from types import FunctionType
from typing import Any

from linksweep.engine.kernel import instructions, reduce, running, translate
from linksweep.engine.kernel.instructions import REGISTER, Instructions, longest_chains_first
from linksweep.engine.kernel.machine_code import ROW, Array, new_function, processor, write_call

WIDEST = 2 * REGISTER
"""Samples side by side on processors with the widest registers, two of these; the least length of a row."""
VECTORS, ONE_BY_ONE = "by vectors", "one by one"
"""How loops count."""
ROW_LENGTHS = {"profiles": "room", "block": "room", "scratch": "apart"}
"""Names of tables, and of the count of numbers from one of their rows to the next."""
SUMMARIES = {kind: getattr(reduce, kind) for kind in running.KINDS}
"""Functions of a row."""
SOURCE = inspect.getsource(sys.modules[__name__]) + "".join(
    (running.SOURCE, instructions.SOURCE, translate.SOURCE, inspect.getsource(reduce))
)
"""All that enters the machine code besides the functions themselves."""


def width() -> int:
    """Return how many samples the processor takes side by side: two registers of them, as one alone would wait for the
    results of its own operations."""
    features = processor()[1].split(",")
    return WIDEST if "+avx512f" in features else 8 if "+avx" in features else 4


def width_in_stages() -> int:
    """Return how many samples a loop in stages takes side by side: one register of them, as many values are under
    way."""
    return width() // 2


def write_function(builder: Any, function: FunctionType, passed: Mapping[str, Any], streamed: str) -> None:
    """Write the instructions of a function of these arguments; rows of the array that is `streamed` are stored past the
    caches, in vectors that fill lines of them."""
    writer, arguments = _Writer(builder, max(width(), REGISTER) if streamed else width()), list[Any]()
    for name, llvm in passed.items():
        row = passed.get(ROW_LENGTHS.get(name, "")), name == streamed
        arguments.append(_Array(writer, llvm, *row) if llvm.type.is_pointer else _Value(writer, llvm))
    FunctionType(function.__code__, writer.names())(*arguments)


def _align_stack(function: Any) -> None:
    """Let vectors that wait in memory begin with a line of the cache: across two, kernels took up to a third longer,
    in three processes of four."""
    function.attributes.alignstack = 64
    function.attributes.add("noinline")  # what inlined it would have a stack of its own


def _operation(name: str, reflected: bool = False) -> Callable[..., _Value]:
    def operation(self: _Value, *others: _Value | float) -> _Value:
        return self.writer.operation(name, *((*others, self) if reflected else (self, *others)))

    return operation


class _Value:
    """A number, integer or condition in machine code, or a vector of them; operations on it write instructions.

    An integer that a loop changes is `counted`: by vectors, or one by one.
    """

    def __init__(self, writer: _Writer, llvm: Any, counted: str = "") -> None:
        self.writer, self.llvm, self.counted = writer, llvm, counted

    __add__, __radd__ = _operation("+"), _operation("+", reflected=True)
    __sub__, __rsub__ = _operation("-"), _operation("-", reflected=True)
    __mul__, __rmul__ = _operation("*"), _operation("*", reflected=True)
    __truediv__, __rtruediv__ = _operation("/"), _operation("/", reflected=True)
    __floordiv__, __mod__ = _operation("//"), _operation("%")
    __lt__, __gt__ = _operation("<"), _operation(">")
    __neg__, __abs__ = _operation("negate"), _operation("abs")


class _Array:
    """An array in machine code: elements are loaded and stored, or, where a loop counts by vectors, vectors.

    `length` is that of its rows, or of itself where somebody asks for it.
    """

    def __init__(self, writer: _Writer, data: Any, length: Any, streamed: bool = False) -> None:
        self.writer, self.data, self.length, self.streamed = writer, data, length, streamed

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, tuple) and isinstance(index[1], slice):
            return _Array(self.writer, self._place((index[0], 0))[0], self.writer.integer(index[1].stop))
        start, at = self._place(index)
        return _Value(self.writer, self.writer.load(start, at))

    def __setitem__(self, index: Any, value: _Value | float) -> None:
        self.writer.store(value, *self._place(index), self.streamed)

    def _place(self, index: Any) -> tuple[Any, _Value | None]:
        """Return a pointer to an element, or to the start of a row and the place in it that a loop has reached."""
        writer, (*row, last) = self.writer, index if isinstance(index, tuple) else (index,)
        in_loop = isinstance(last, _Value) and last.counted
        with writer.before_loop():  # where rows start does not change in it
            start = sum((x * _Value(writer, self.length) for x in row), 0 if in_loop else last)
            pointer = writer.builder.gep(self.data, [writer.integer(start)])
        return pointer, last if in_loop else None


class _Places:
    """Places of vectors in memory, zero at first: what one pass of a loop writes, the next one reads."""

    def __init__(self, writer: _Writer, count: int) -> None:
        self.writer, vector = writer, writer.instructions.vector
        self.places = [writer.instructions.slot(vector(None)) for _ in range(count)]

    def __getitem__(self, k: int) -> _Value:
        return _Value(self.writer, self.writer.builder.load(self.places[k]))

    def __setitem__(self, k: int, value: _Value) -> None:
        write = self.writer.instructions
        self.writer.builder.store(write.wide(write.as_number(value.llvm)), self.places[k])


class _Memory:
    """Places in memory, each for values of so many `vectors`: as many passes of a loop store in turn.

    LLVM, which does not know that what is read is what was stored, leaves the values there.
    """

    def __init__(self, writer: _Writer, places: int, vectors: int) -> None:
        self.writer, write = writer, writer.instructions
        with writer.builder.goto_entry_block():
            memory = writer.builder.alloca(write.double, places * vectors * write.width)
        memory.align = 64
        starts = [writer.builder.gep(memory, [self._at(places * k)]) for k in range(vectors)]
        self.slots = [write.slot(write.unknown(start)) for start in (*starts, memory)]

    def begin_pass(self) -> None:
        """Take the places that were stored to so many passes ago, 0 and more, and those to store to."""
        *self.read, self.stored = map(self.writer.builder.load, self.slots)

    def end_pass(self) -> None:
        *others, oldest = self.read
        for start, slot in zip((oldest, *others, self.writer.instructions.unknown(oldest)), self.slots, strict=True):
            self.writer.builder.store(start, slot)

    def __getitem__(self, at: tuple[int, int]) -> _Value:
        """Return the value at a place that was stored so many passes ago."""
        place, passes = at
        return _Value(self.writer, self.writer.instructions.load(self.read[passes % len(self.read)], self._at(place)))

    def __setitem__(self, place: int, value: _Value) -> None:
        self.writer.instructions.store(value.llvm, self.stored, self._at(place))

    def _at(self, place: int) -> Any:
        return self.writer.integer(place * self.writer.instructions.width)


class _Writer:
    """Writer of one function's instructions."""

    def __init__(self, builder: Any, width: int) -> None:
        self.builder, self.instructions = builder, Instructions(builder, width)
        _align_stack(builder.function)
        self.head: Any = None
        """The block before the outermost loop that is being written."""
        self.memories: list[_Memory] = []
        """Memory in which values of the loop in stages wait."""

    def names(self) -> dict[str, Any]:
        """Return the functions that a function's source may use."""
        operations = {name: partial(self.operation, name) for name in self.instructions.operators}
        loops = {"in_vectors": self.in_vectors, "in_stages": self.in_stages, "each": self.each}
        loops |= {"places": self.places, "memory": self.memory}
        summaries = {kind: partial(self.summary, function) for kind, function in SUMMARIES.items()}
        return {"math": math, "number": self.number, "running": self.running} | loops | operations | summaries

    # ------------------------------------------------------------------------------------------ loops

    def in_vectors(self, first: _Value | int, last: _Value | int, samples: _Value | int) -> Iterator[_Value]:
        """Write a loop over the samples, with the instructions that are written until the next value is asked for; it
        yields the first of those in a vector."""
        place = self._place_of_vector(samples)
        loop = self.instructions.loop(self.integer(first), self.integer(last), self.instructions.width)
        for j, _ in self._inside(loop):
            yield place(j)

    def places(self, count: int) -> _Places:
        """Return places for what passes of a loop in stages keep."""
        self.instructions = Instructions(self.builder, width_in_stages())
        return _Places(self, count)

    def memory(self, places: int, vectors: int) -> _Memory:
        """Return places for what waits longer."""
        self.memories.append(_Memory(self, places, vectors))
        return self.memories[-1]

    def in_stages(
        self, first: _Value | int, last: _Value | int, samples: _Value | int, stages: int
    ) -> Iterator[list[_Value]]:
        """Write a loop over the samples that has a vector in each of its stages; it yields the first sample of each,
        the newest vector's first.

        The first passes end vectors that were never begun. What they store, in the place of the first vector, is
        overwritten by that.
        """
        place, step, first = self._place_of_vector(samples), self.instructions.width, self.integer(first)
        ahead = [self.integer(step * k) for k in reversed(range(stages))]
        loop = self.instructions.loop(self.builder.sub(first, ahead[0]), self.integer(last), step)
        for j, _ in self._inside(loop):
            for memory in self.memories:
                memory.begin_pass()
            yield [place(self.instructions.larger(self.builder.add(j, more), first)) for more in ahead]
            for memory in self.memories:
                memory.end_pass()

    def _place_of_vector(self, samples: _Value | int) -> Callable[[Any], _Value]:
        """Return a function of a loop's counter: where its vector begins, which must end with the row."""
        write, step = self.instructions, self.integer(self.instructions.width)
        latest = self.builder.sub(write.larger(self.integer(samples), self.integer(WIDEST)), step)
        return lambda j: _Value(self, write.smaller(j, latest), VECTORS)

    def each(self, first: _Value | int, last: _Value | int) -> Iterator[_Value]:
        """Write a loop over samples one by one, as `in_vectors` does."""
        loop = self.instructions.loop(self.integer(first), self.integer(last))
        for j, _ in self._inside(loop):
            body = self.builder.block
            yield _Value(self, j, ONE_BY_ONE)
            longest_chains_first(body)

    def _inside(self, loop: AbstractContextManager[Any]) -> Iterator[Any]:
        """Yield what a loop yields, while it is being written."""
        outermost = self.head is None
        self.head = self.head or self.builder.block
        with loop as yielded:
            yield yielded
        self.head = None if outermost else self.head

    def running(self, kind: str, memory: _Array, place: int) -> Any:
        """Return a summary of samples to come, kept in an array from this place on."""
        pointer = self.builder.gep(memory.data, [self.integer(place)])
        return running.KINDS[kind](self.instructions, pointer)

    def summary(self, function: FunctionType, row: _Array, angles: _Array, work: _Array) -> tuple[_Value, ...]:
        """Write the call of a summary of a row, which is translated once in a module."""
        module, name = self.builder.module, f"{function.__module__}.{function.__name__}"

        def emit(builder: Any, *arrays: Array) -> None:
            translator = translate.Translator(builder)
            for place, result in enumerate(translator.of_call(function, arrays)):
                builder.store(result, builder.gep(arrays[-1].data, [translator.integer(place)]))

        called = module.globals.get(name) or new_function(module, emit, name, (ROW, ROW, ROW))
        called.linkage = "internal"
        write_call(self.builder, called, tuple(Array(x.data, (row.length,)) for x in (row, angles, work)))
        return work[0], work[1]

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
            return self._whole(name, *operands)
        return _Value(self, self.instructions.operators[name](*values))

    def _whole(self, name: str, *operands: _Value | float) -> _Value:
        """Write an operation on integers: before the loop, unless the loop counts one of them."""
        builder, counted = self.builder, {x.counted for x in operands if isinstance(x, _Value) and x.counted}
        function = {"+": builder.add, "-": builder.sub, "*": builder.mul, "//": builder.sdiv, "%": builder.srem}[name]
        with nullcontext() if counted else self.before_loop():
            return _Value(self, function(*(self.integer(x) for x in operands)), *counted)

    def number(self, value: float) -> _Value:
        return _Value(self, self.instructions.double(value))

    def integer(self, value: _Value | float) -> Any:
        return value.llvm if isinstance(value, _Value) else self.instructions.integer(int(value))

    def load(self, pointer: Any, at: _Value | None) -> Any:
        if at is None:
            with self.before_loop():
                return self.builder.load(pointer)
        if at.counted == VECTORS:
            return self.instructions.load(pointer, at.llvm)
        return self.builder.load(self.builder.gep(pointer, [at.llvm]))

    def store(self, value: _Value | float, pointer: Any, at: _Value | None, streamed: bool) -> None:
        llvm = value.llvm if isinstance(value, _Value) else value
        if at is None:
            self.builder.store(self.instructions.as_number(llvm), pointer)
        else:
            write = self.instructions.stream if streamed else self.instructions.store
            write(llvm, pointer, at.llvm)
