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
from linksweep.engine.kernel.machine_code import INTEGER, TABLE, MachineCode, machine_code
from linksweep.engine.trace.graph import LOW_WORDS

TILE = 8 * REGISTER
"""Samples of a register: enough to make the choice of an operation cheap, few enough for the fastest cache."""
ABREAST = 2
"""Vectors of a pass through a register: one would wait for its own results, all eight take half as long again to
compile."""
OPERATORS = ("+", "-", "*", "/", "<", "negate", "abs", "sqrt", "atan2", "where", "fma", "fnma", *sorted(LOW_WORDS))
OPERANDS = {"negate": 1, "abs": 1, "sqrt": 1, "where": 3, "fma": 3, "fnma": 3}
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
    _function()(program, registers, numbers, rows, samples)


@cache
def _function() -> MachineCode:
    """Return the interpreter."""
    return machine_code(_interpreter, ("i8[:, :]", TABLE, TABLE, "i8[:, :]", INTEGER), SOURCE)


def _interpreter(builder: Any, program: Any, registers: Any, numbers: Any, rows: Any, samples: Any) -> None:
    """Write the one function."""
    (length, _), (designs, kept) = program.shape, numbers.shape
    program, registers, numbers, rows = (array.data for array in (program, registers, numbers, rows))
    write = Instructions(builder)
    integer, double = write.integer, write.double
    last = builder.sub(samples, integer(REGISTER))

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
            # all of the tile: beyond the row, numbers that nobody reads
            with write.loop(integer(0), integer(TILE), ABREAST * REGISTER) as (first, _):
                for k in range(0, ABREAST * REGISTER, REGISTER):
                    body(builder.add(first, integer(k)))
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
        here = lambda k: write.smaller(builder.add(tile, k), last)  # noqa: E731  # the last vector ends with the row
        vectors("load", lambda k: write.store(write.load(row_start(place[1]), here(k)), registers, at(place[0], k)))
        vectors("store", lambda k: write.store(write.load(registers, at(place[1], k)), row_start(place[0]), here(k)))
        builder.position_at_end(done)

    def fill(design: Any, number: Any) -> None:
        """Write one register full of a design's own number."""
        value = builder.load(builder.gep(numbers, [builder.add(builder.mul(design, kept), number)]))
        with write.loop(integer(0), integer(TILE), REGISTER) as (k, _):
            write.store(value, registers, at(number, k))

    with write.loop(integer(0), designs) as (design, _):
        with write.loop(integer(0), kept) as (number, _):
            fill(design, number)
        with (
            write.loop(integer(0), samples, TILE) as (tile, _),
            write.loop(integer(0), length) as (row, _),
        ):
            operation(design, tile, row)
