"""Write instructions on vectors of numbers: LLVM's own, by the names of a graph's operations.

A processor with narrower registers gets several instructions for one, one without fused multiply-add calls the C
library's. No compiler contracts or reorders them, so results have the same bits for any width, on any processor.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import Any

from linksweep.engine.trace import arctangent
from linksweep.engine.trace.operators import interpret, traced_arctangent

REGISTER = 8
"""Doubles that fill a register of 512 bits."""
ORDERED = 1000
"""Most instructions of a block that gains by another order: with more, loops took up to 1.09 of the time."""
SOURCE = "".join(map(inspect.getsource, (sys.modules[__name__], arctangent)))
"""All that enters the machine code besides what is asked for."""


def call(function: Callable[..., None], arguments: tuple[Any, ...]) -> None:
    """Call a function that is an argument itself."""
    function(*arguments)


class Instructions:
    """Instructions on numbers and on vectors of `width` doubles, at the place of an `llvmlite` builder.

    Operands are LLVM's values, or Python's numbers. Where one is a vector, all are repeated to be vectors.
    """

    def __init__(self, builder: Any, width: int = REGISTER) -> None:
        from llvmlite import ir

        self.ir, self.builder, self.width = ir, builder, width
        self.double, self.condition = ir.DoubleType(), ir.IntType(1)
        self.integer = ir.IntType(64)
        """Type of an integer; called with one, its constant."""
        self.vector = ir.VectorType(self.double, width)
        functions: dict[str, Callable[..., Any]] = {
            "+": builder.fadd,
            "-": builder.fsub,
            "*": builder.fmul,
            "/": builder.fdiv,
            **{sign: partial(builder.fcmp_ordered, sign) for sign in ("<", "<=", ">", ">=", "==")},
            "!=": partial(builder.fcmp_unordered, "!="),
            "negate": builder.fneg,
            "abs": partial(self._call, "fabs"),
            "sqrt": partial(self._call, "sqrt"),
            "fma": partial(self._call, "fma"),
            "fnma": lambda x, y, z: self._call("fma", builder.fneg(x), y, z),
            "sum_low": partial(self._sum_low, builder.fadd, builder.fsub),
            "difference_low": partial(self._sum_low, builder.fsub, builder.fadd),
            "ordered_low": lambda x, y, high=None: builder.fsub(y, builder.fsub(high or builder.fadd(x, y), x)),
            "product_low": lambda x, y, high=None: self._call("fma", x, y, builder.fneg(high or builder.fmul(x, y))),
            "where": self._where,
            "atan2": self._atan2,
        }
        self.operators = {name: partial(self._alike, function) for name, function in functions.items()}
        """Operations by name."""

    def _alike(self, function: Callable[..., Any], *operands: Any) -> Any:
        values = [self.value(x) for x in operands]
        vectors = any(isinstance(x.type, self.ir.VectorType) for x in values)
        return function(*map(self.wide, values) if vectors else values)

    def value(self, number: Any) -> Any:
        """Return a constant for Python's number; of LLVM's value itself."""
        return number if isinstance(number, self.ir.Value) else self.double(float(number))

    def wide(self, value: Any) -> Any:
        """Return a vector that repeats a number; of a vector itself."""
        if isinstance(value.type, self.ir.VectorType):
            return value
        kind = self.ir.VectorType(value.type, self.width)
        places = self.ir.VectorType(self.ir.IntType(32), self.width)(None)
        first = self.builder.insert_element(kind(self.ir.Undefined), value, self.integer(0))
        return self.builder.shuffle_vector(first, kind(self.ir.Undefined), places)

    @contextmanager
    def loop(self, first: Any, last: Any, step: int | Any = 1) -> Iterator[tuple[Any, Any]]:
        """Write a loop over integers; what is written in this context is done in each pass.

        It yields the integer, and the block after the loop. Downwards where the step is a negative number of Python's.
        """
        builder, before = self.builder, self.builder.block
        head, body, after = (builder.append_basic_block() for _ in range(3))
        builder.branch(head)
        builder.position_at_end(head)
        k = builder.phi(self.integer)
        k.add_incoming(first, before)
        downwards = isinstance(step, int) and step < 0
        builder.cbranch(builder.icmp_signed(">" if downwards else "<", k, last), body, after)
        builder.position_at_end(body)
        yield k, after
        if not builder.block.is_terminated:
            following = builder.add(k, self.integer(step) if isinstance(step, int) else step, flags=("nsw",))
            k.add_incoming(following, builder.block)
            builder.branch(head)
        builder.position_at_end(after)

    @contextmanager
    def loop_ahead(
        self, first: Any, last: Any, step: int, start: Callable[[Any], Iterable[Any]]
    ) -> Iterator[tuple[Any, list[Any]]]:
        """Write a loop over integers, as `loop` does; it yields the integer and the vectors that `start` writes for it.

        Each pass starts the next one: divisions and roots take long, and nothing of this pass waits for them. Both are
        written as one, the longest chains of instructions first. No pass may read what it stores.
        """
        builder = self.builder
        kept = [self.slot(self.wide(self.as_number(x))) for x in start(first)]
        with self.loop(first, last, step) as (k, _):
            values = [builder.load(place) for place in kept]
            following = builder.add(k, self.integer(step))
            following = builder.select(builder.icmp_signed("<", following, last), following, k)
            for x, place in zip(start(following), kept, strict=True):
                builder.store(self.wide(self.as_number(x)), place)
            body = builder.block
            yield k, values
            longest_chains_first(body)

    def each_ahead(self, counters: list[Any], start: Callable[[Any], list[Any]]) -> Iterator[tuple[Any, list[Any]]]:
        """Write the passes of such a loop one after the other; it yields each integer with what `start` writes."""
        kept = start(counters[0]) if counters else []
        for k, following in zip(counters, [*counters[1:], None], strict=False):
            self.builder.branch(block := self.builder.append_basic_block())
            self.builder.position_at_end(block)
            of_next = start(following) if following else []
            yield k, kept
            longest_chains_first(block)
            kept = of_next

    def smaller(self, x: Any, y: Any) -> Any:
        """Return the smaller of two integers."""
        return self.builder.select(self.builder.icmp_signed("<", x, y), x, y)

    def larger(self, x: Any, y: Any) -> Any:
        """Return the larger of two integers."""
        return self.builder.select(self.builder.icmp_signed(">", x, y), x, y)

    def slot(self, value: Any) -> Any:
        """Return a place in memory that holds a value."""
        with self.builder.goto_entry_block():
            place = self.builder.alloca(value.type)
        self.builder.store(value, place)
        return place

    def unknown(self, pointer: Any) -> Any:
        """Return a pointer of which LLVM does not know that it is the same."""
        kind = self.ir.FunctionType(pointer.type, [pointer.type])
        return self.builder.asm(kind, "", "=r,0", [pointer], side_effect=True)

    def load(self, start: Any, at: Any) -> Any:
        """Return the vector from a position of an array on."""
        return self.builder.load(self._place(start, at), align=8)

    def store(self, value: Any, start: Any, at: Any) -> None:
        """Store a vector, or a number repeated, from a position of an array on."""
        self.builder.store(self.wide(self.as_number(value)), self._place(start, at), align=8)

    def gather(self, start: Any, at: Any) -> Any:
        """Return the vector of the numbers at a vector of positions of an array."""
        numbers = self.vector(self.ir.Undefined)
        for k in map(self.integer, range(self.width)):
            number = self.builder.load(self.builder.gep(start, [self.builder.extract_element(at, k)]))
            numbers = self.builder.insert_element(numbers, number, k)
        return numbers

    def prefetch(self, start: Any, at: Any) -> None:
        """Fetch the line of a position of an array into the caches."""
        place = self.builder.bitcast(self.builder.gep(start, [at]), self.ir.IntType(8).as_pointer())
        number = self.ir.IntType(32)
        kind = self.ir.FunctionType(self.ir.VoidType(), [place.type, number, number, number])
        to_read, often, data = number(0), number(3), number(1)
        self.builder.call(self._declared("llvm.prefetch.p0i8", kind), [place, to_read, often, data])

    def stream(self, value: Any, start: Any, at: Any) -> None:
        """Store a vector past the caches, which would first read what it replaces; it begins with a line of them."""
        stored = self.builder.store(self.wide(self.as_number(value)), self._place(start, at), align=64)
        stored.set_metadata("nontemporal", self.builder.module.add_metadata([self.ir.IntType(32)(1)]))

    def anywhere(self, conditions: Any) -> Any:
        """Return whether any of a vector of conditions holds."""
        bits = self.builder.bitcast(conditions, self.ir.IntType(self.width))
        return self.builder.icmp_unsigned("!=", bits, bits.type(0))

    def as_number(self, value: Any) -> Any:
        """Return 1 and 0 for a condition; of numbers themselves."""
        value = self.value(value)
        vector = isinstance(value.type, self.ir.VectorType)
        holds = (value.type.element if vector else value.type) == self.condition
        return self.builder.uitofp(value, self.vector if vector else self.double) if holds else value

    def _place(self, start: Any, at: Any) -> Any:
        return self.builder.bitcast(self.builder.gep(start, [at]), self.vector.as_pointer())

    def _call(self, name: str, *x: Any) -> Any:
        """Call LLVM's own function of this name."""
        suffix = "f64" if x[0].type == self.double else f"v{self.width}f64"
        kind = self.ir.FunctionType(x[0].type, [one.type for one in x])
        return self.builder.call(self._declared(f"llvm.{name}.{suffix}", kind), x)

    def _declared(self, name: str, kind: Any) -> Any:
        """Return a function of LLVM's own, declared once in a module."""
        module = self.builder.module
        return module.globals.get(name) or self.ir.Function(module, kind, name)

    def _sum_low(self, plus: Callable[..., Any], minus: Callable[..., Any], x: Any, y: Any, high: Any = None) -> Any:
        """Write Knuth's way to what a rounded sum or difference misses (`base.low_words`); that itself may be known."""
        subtract = self.builder.fsub
        high = high or plus(x, y)
        part = subtract(high, x)
        return plus(subtract(x, subtract(high, part)), minus(y, part))

    def _where(self, condition: Any, x: Any, y: Any) -> Any:
        if condition.type == x.type:  # a condition that was stored
            condition = self.builder.fcmp_unordered("!=", condition, condition.type(None))
        return self.builder.select(condition, x, y)

    def _atan2(self, y: Any, x: Any) -> Any:
        """Write the operations of `engine.trace.arctangent`: there is no instruction."""
        inputs, nodes, (angle,) = traced_arctangent()
        return interpret(nodes, dict(zip(inputs, (y, x), strict=True)), self.operators)[angle]


def longest_chains_first(block: Any) -> None:
    """Order a block's instructions; a store remains behind what comes before it, so no load may read what one stores.

    Blocks of more than `ORDERED` keep their order: their values would wait in memory.
    """
    if len(block.instructions) <= ORDERED:
        length = _chains(block.instructions)
        block.instructions.sort(key=lambda x: -length[x])


def _chains(work: Sequence[Any]) -> dict[Any, int]:
    """Return the length of the longest chain, each the operand of the next, that each of some instructions begins."""
    length = dict.fromkeys(work, 1)
    for instruction in reversed(work):
        for x in instruction.operands:
            if x in length:
                length[x] = max(length[x], length[instruction] + 1)
    return length
