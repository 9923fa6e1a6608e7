"""Functions of numbers, done in all lanes of a table at once: traced, then interpreted or written as vectors."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from linksweep.engine.kernel.instructions import REGISTER as LANES
from linksweep.engine.kernel.instructions import Instructions
from linksweep.engine.kernel.machine_code import INTEGER, ROW, TABLE, MachineCode, machine_code
from linksweep.engine.kernel.translate import written_by
from linksweep.engine.once import once
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.operators import OPERATORS, Traced, interpret, traced

Values = dict[Node, Any]
"""Values of nodes: numbers, arrays, or instructions that compute vectors."""
SOURCE = inspect.getsource(sys.modules[__name__])
"""All that enters the machine code besides nodes and instructions."""
ABREAST = 3
"""Vectors of lanes that go around a turn together: one alone waits for its own results."""


class Lanewise:
    """A function without branches, from rows of a table to rows of it; a column is a lane.

    Called with a table and the bounds of a range of its columns, it is interpreted by numpy; `compiled` is the same of
    the first columns, which fill vectors.
    """

    def __init__(self, function: Callable[..., tuple[Node, ...]], inputs: tuple[int, ...], outputs: tuple[int, ...]):
        self.function, self.rows, self.outputs = function, inputs, outputs

    @once
    def traced(self) -> Traced:
        return traced(self.function, len(self.rows))

    def __call__(self, table: np.ndarray, *bounds: int) -> None:
        (inputs, nodes, results), columns = self.traced, slice(*bounds)
        values = interpret(nodes, {x: table[row, columns].copy() for x, row in zip(inputs, self.rows, strict=True)})
        for row, node in zip(self.outputs, results, strict=True):
            table[row, columns] = values[node]

    @cached_property
    def compiled(self) -> MachineCode:
        """The function of a table and the number of its first columns that count as machine code."""
        return machine_code(self.emit, (TABLE, INTEGER), self.text)

    @property
    def text(self) -> str:
        """A text that differs wherever the function does."""
        inputs, nodes, results = self.traced
        place = {node: k for k, node in enumerate([*inputs, *nodes])}
        lines = [(node.operator, node.value, [place[x] for x in node.operands]) for node in nodes]
        return f"{SOURCE} {self.rows} {self.outputs} {lines} {[place[node] for node in results]}"

    def emit(self, builder: Any, table: Any, *bounds: Any) -> None:
        vectors, (inputs, nodes, results) = Instructions(builder), self.traced
        first, last = (vectors.integer(0), *bounds)[-2:]
        with vectors.loop(first, last, LANES) as (k, _):
            loaded = [vectors.load(table.data, _place(vectors, table, row, k)) for row in self.rows]
            values = interpret(nodes, dict(zip(inputs, loaded, strict=True)), vectors.operators)
            self._store(vectors, table, k, [values[node] for node in results])

    def _store(self, vectors: Instructions, table: Any, k: Any, values: list[Any]) -> None:
        for row, value in zip(self.outputs, values, strict=True):
            vectors.store(value, table.data, _place(vectors, table, row, k))


def _place(vectors: Instructions, table: Any, row: int | Any, column: Any) -> Any:
    """Return the position of a column in a row of a table."""
    row = vectors.integer(row) if isinstance(row, int) else row
    return vectors.builder.add(vectors.builder.mul(table.shape[1], row), column)


def _write_copy(vectors: Instructions, table: Any, row: Any, column: Any, other: Any, place: Any, _lanes: Any) -> None:
    lanes = vectors.load(table.data, _place(vectors, table, row, column))
    vectors.store(lanes, other.data, _place(vectors, other, row, place))


@written_by(_write_copy)
def copy_lanes(table, row, column, other, place, lanes):
    """Copy lanes of a row of a table to the same row of another one."""
    other[row, place : place + lanes] = table[row, column : column + lanes]


class Around(Lanewise):
    """A function of every two samples around a turn: of the one before them, both, the one after, the number of the
    first, and of rows of a table that it updates from their `start` on.

    Called with the samples, row after row of so many columns, their even number, that of the columns, and the table:
    its columns are those of the first samples of each row.
    """

    def __init__(self, function: Callable[..., tuple[Node, ...]], start: dict[int, float]):
        super().__init__(function, (-5, -4, -3, -2, -1, *start), tuple(start))
        self.start = tuple(start.values())

    @cached_property
    def of_samples(self) -> list[Node]:
        """The nodes that depend on samples alone."""
        known = set(self.traced.inputs[:5])
        for node in self.traced.nodes:
            known.update({node} if known.issuperset(node.operands) else ())
        return [node for node in self.traced.nodes if node in known]

    def __call__(self, samples: np.ndarray, count: int, columns: int, table: np.ndarray) -> None:  # type: ignore[override]
        inputs, nodes, results = self.traced
        every_two = samples[: count * columns].reshape(-1, 2, columns)[..., : table.shape[1]]
        first, second = every_two.swapaxes(0, 1)
        number = np.arange(0.0, count, 2.0)[:, None]
        around = np.roll(second, 1, axis=0), first, second, np.roll(first, -1, axis=0), number
        every = interpret(self.of_samples, dict(zip(inputs, around, strict=False)))
        now: tuple[Any, ...] = self.start
        running = [(OPERATORS[node.operator], node) for node in nodes if node not in every]
        used = {x for _, node in running for x in node.operands if x in every}
        samplewise = {node: np.broadcast_to(every[node], first.shape) for node in used}
        values: Values = {}
        with np.errstate(all="ignore"):
            for j in range(count // 2):
                values.update({node: value[j] for node, value in samplewise.items()})
                values.update(zip(inputs[5:], now, strict=True))
                for function, node in running:
                    values[node] = function(*[values[x] for x in node.operands])
                now = tuple(values[node] for node in results)
        for k, value in zip(self.outputs, now, strict=True):
            table[k] = value

    @property
    def text(self) -> str:
        return f"{super().text} {self.start}"

    @cached_property
    def compiled(self) -> MachineCode:
        return machine_code(self.emit, (ROW, INTEGER, INTEGER, TABLE), self.text)

    def emit(self, builder: Any, samples: Any, count: Any, columns: Any, table: Any) -> None:  # type: ignore[override]
        vectors, (inputs, nodes, results) = Instructions(builder), self.traced
        none, one, two = (vectors.integer(k) for k in range(3))
        last, latest = builder.sub(count, one), builder.sub(table.shape[1], vectors.integer(LANES))
        start = [vectors.wide(vectors.double(number)) for number in self.start]
        carried = [*inputs[:2], *inputs[5:]]

        def sample(j: Any, k: Any) -> Any:
            return vectors.load(samples.data, builder.add(builder.mul(columns, j), k))

        with vectors.loop(none, table.shape[1], ABREAST * LANES) as (first, _):
            starts = (builder.add(first, vectors.integer(k * LANES)) for k in range(ABREAST))
            blocks = [vectors.smaller(k, latest) for k in starts]
            running = [[*map(vectors.slot, (sample(last, k), sample(none, k), *start))] for k in blocks]
            with vectors.loop(none, count, 2) as (j, _):
                second, after = builder.add(j, one), builder.add(j, two)
                after = builder.select(builder.icmp_signed("<", after, count), after, none)
                number = builder.sitofp(j, vectors.double)
                for k, cells in zip(blocks, running, strict=True):
                    values = dict(zip(carried, map(builder.load, cells), strict=True))
                    new = sample(second, k), sample(after, k)
                    values |= dict(zip(inputs[2:5], (*new, number), strict=True))
                    interpret(nodes, values, vectors.operators)
                    for value, cell in zip((*new, *(values[node] for node in results)), cells, strict=True):
                        builder.store(value, cell)
            for k, cells in zip(blocks, running, strict=True):
                self._store(vectors, table, k, [*map(builder.load, cells[2:])])


def lanewise(inputs: tuple[int, ...], outputs: tuple[int, ...]) -> Callable[[Callable[..., Any]], Lanewise]:
    """Decorate a function of numbers as one from rows of a table to rows of it."""
    return lambda function: Lanewise(function, inputs, outputs)


def around(start: dict[int, float]) -> Callable[[Callable[..., Any]], Around]:
    """Decorate a function of two samples, their neighbours and their number, and of rows of a table that it updates
    from these values on."""
    return lambda function: Around(function, start)
