"""Machine code that interprets programs of vector instructions, compiled once on a machine and kept.

A program is a table of integers, one row for each operation: its code, the register of its result, and those of its
operands. A register holds `TILE` samples; the whole program runs on one tile after the other, so that registers stay in
the cache, and then on the next design, whose own numbers fill the first registers. Operations are written by
`engine.kernel.instructions`, so results have the bits of any compiled kernel.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from linksweep.engine.kernel.instructions import REGISTER, Instructions
from linksweep.engine.kernel.machine_code import INTEGER, INTEGERS, ROW, MachineCode, address, machine_code
from linksweep.engine.trace.graph import LOW_WORDS

TILE = 8 * REGISTER
"""Samples of a register: enough to make the choice of an operation cheap, few enough for the fastest cache."""
OPERATORS = ("+", "-", "*", "/", "<", "negate", "abs", "sqrt", "atan2", "where", *sorted(LOW_WORDS))
OPERANDS = {"negate": 1, "abs": 1, "sqrt": 1, "where": 3}
"""Operands of those operations that have not two."""
CODES = {name: code for code, name in enumerate([*OPERATORS, "load", "store"])}
COLUMNS = 5
"""Code of the operation, register of the result, registers of up to three operands; `load` and `store` have the number
of a row in place of their operand and their result."""
SOURCE = inspect.getsource(sys.modules[__name__])


def interpret(program: np.ndarray, registers: np.ndarray, numbers: np.ndarray, rows: np.ndarray, samples: int) -> None:
    """Run a program (operation, column) on registers (register, sample of a tile), for each of some designs.

    `numbers` (design, number) fill the first registers; `rows` has, for each row of at least `REGISTER` samples, its
    address and by how many bytes that of the next design lies behind it.
    """
    arrays = map(address, (program, registers, numbers, rows))
    _function().function(*arrays, len(program), *numbers.shape, samples)


@cache
def _function() -> MachineCode:
    """Return the interpreter."""
    return machine_code(_interpreter, (INTEGERS, ROW, ROW, INTEGERS, *[INTEGER] * 4), SOURCE)


def _interpreter(builder: Any, *arguments: Any) -> None:
    """Write the one function."""
    program, registers, numbers, rows = (array.data for array in arguments[:4])
    length, designs, kept, samples = arguments[4:]
    write = Instructions(builder)
    integer, double = write.integer, write.double
    last = builder.sub(samples, integer(REGISTER))

    def smaller(x: Any, y: Any) -> Any:
        return builder.select(builder.icmp_signed("<", x, y), x, y)

    def at(register: Any, k: Any) -> Any:
        return builder.add(builder.mul(register, integer(TILE)), k)

    def operation(design: Any, tile: Any, row: Any) -> None:
        """Write the choice of an operation, and each operation on a tile."""
        start = builder.mul(row, integer(COLUMNS))
        code, *place = (builder.load(builder.gep(program, [builder.add(start, integer(k))])) for k in range(COLUMNS))
        done = builder.append_basic_block()
        choice = builder.switch(code, done)

        def vectors(name: str, body: Callable[[Any], None]) -> None:
            choice.add_case(CODES[name], builder.append_basic_block(name))
            builder.position_at_end(choice.cases[-1][1])
            for k in range(0, TILE, REGISTER):  # all of the tile: beyond the row, numbers that nobody reads
                body(integer(k))
            builder.branch(done)

        def row_start(number: Any) -> Any:
            place = builder.mul(number, integer(2))
            start, apart = (builder.load(builder.gep(rows, [builder.add(place, integer(k))])) for k in range(2))
            return builder.inttoptr(builder.add(start, builder.mul(design, apart)), double.as_pointer())

        for name in OPERATORS:
            operands = place[1 : 1 + OPERANDS.get(name, 2)]

            def operate(k: Any, name: str = name, operands: list[Any] = operands) -> None:
                values = [write.load(registers, at(x, k)) for x in operands]
                write.store(write.operators[name](*values), registers, at(place[0], k))

            vectors(name, operate)
        here = lambda k: smaller(builder.add(tile, k), last)  # noqa: E731  # the last vector ends with the row
        vectors("load", lambda k: write.store(write.load(row_start(place[1]), here(k)), registers, at(place[0], k)))
        vectors("store", lambda k: write.store(write.load(registers, at(place[1], k)), row_start(place[0]), here(k)))
        builder.position_at_end(done)

    def fill(design: Any, number: Any) -> None:
        """Write one register full of a design's own number."""
        value = builder.load(builder.gep(numbers, [builder.add(builder.mul(design, kept), number)]))
        _loop(builder, integer(0), integer(TILE), REGISTER, lambda k: write.store(value, registers, at(number, k)))

    def run(design: Any) -> None:
        _loop(builder, integer(0), kept, 1, lambda number: fill(design, number))
        _loop(builder, integer(0), samples, TILE, lambda tile: run_tile(design, tile))

    def run_tile(design: Any, tile: Any) -> None:
        _loop(builder, integer(0), length, 1, lambda row: operation(design, tile, row))

    _loop(builder, integer(0), designs, 1, run)


def _loop(builder: Any, first: Any, last: Any, step: int, body: Callable[[Any], None]) -> None:
    """Write a loop; `body(k)` writes what is done in each pass."""
    before, inside, after = builder.block, builder.append_basic_block(), builder.append_basic_block()
    builder.cbranch(builder.icmp_signed("<", first, last), inside, after)
    builder.position_at_end(inside)
    k = builder.phi(first.type)
    k.add_incoming(first, before)
    body(k)
    following = builder.add(k, first.type(step))
    k.add_incoming(following, builder.block)
    builder.cbranch(builder.icmp_signed("<", following, last), inside, after)
    builder.position_at_end(after)
