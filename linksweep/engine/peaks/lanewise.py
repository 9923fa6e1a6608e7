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
from linksweep.engine.trace.graph import Graph, Node
from linksweep.engine.trace.operators import OPERATORS, interpret

Values = dict[Node, Any]
"""Values of nodes: numbers, arrays, or instructions that compute vectors."""
SOURCE = inspect.getsource(sys.modules[__name__])
"""All that enters the machine code besides nodes and instructions."""
ABREAST = 3
"""Vectors of lanes that go around a turn together: one alone waits for its own results."""


class Lanewise:
    """A function without branches, from rows of a table to rows of it; a column is a lane.

    Called, it is interpreted by numpy; `compiled` is the same on a table whose columns fill vectors.
    """

    def __init__(self, function: Callable[..., tuple[Node, ...]], inputs: tuple[int, ...], outputs: tuple[int, ...]):
        self.function, self.rows, self.outputs = function, inputs, outputs

    @cached_property
    def traced(self) -> tuple[list[Node], list[Node]]:
        """The operations and the results of the function."""
        graph = Graph()
        inputs = [graph.input(f"row {k}", ("lane",)) for k in range(len(self.rows))]
        results = [graph.node(result) for result in self.function(*inputs)]
        return graph.nodes, results

    @property
    def inputs(self) -> list[Node]:
        return self.traced[0][: len(self.rows)]

    @property
    def nodes(self) -> list[Node]:
        return self.traced[0][len(self.rows) :]

    @property
    def results(self) -> list[Node]:
        return self.traced[1]

    def __call__(self, table: np.ndarray, columns: int) -> None:
        inputs = (table[row, :columns].copy() for row in self.rows)
        values = interpret(self.nodes, dict(zip(self.inputs, inputs, strict=True)))
        for row, node in zip(self.outputs, self.results, strict=True):
            table[row, :columns] = values[node]

    def compiled(self) -> MachineCode:
        """Return the function of a table and the number of its first columns that count as machine code."""
        return machine_code(self.emit, (TABLE, INTEGER), self.text)

    @property
    def text(self) -> str:
        """A text that differs wherever the function does."""
        place = {node: k for k, node in enumerate([*self.inputs, *self.nodes])}
        lines = [(node.operator, node.value, [place[x] for x in node.operands]) for node in self.nodes]
        return f"{SOURCE} {self.rows} {self.outputs} {lines} {[place[node] for node in self.results]}"

    def emit(self, builder: Any, table: Any, columns: Any) -> None:
        vectors = Instructions(builder)
        with vectors.loop(vectors.integer(0), columns, LANES) as (k, _):
            loaded = [vectors.load(table.data, place) for place in _places(vectors, table, self.rows, k)]
            values = interpret(self.nodes, dict(zip(self.inputs, loaded, strict=True)), vectors.operators)
            self._store(vectors, table, k, [values[node] for node in self.results])

    def _store(self, vectors: Instructions, table: Any, k: Any, values: list[Any]) -> None:
        for place, value in zip(_places(vectors, table, self.outputs, k), values, strict=True):
            vectors.store(value, table.data, place)


def _places(vectors: Instructions, table: Any, rows: tuple[int, ...], k: Any) -> list[Any]:
    """Return the positions of a column in rows of a table."""
    builder = vectors.builder
    return [builder.add(builder.mul(table.shape[1], vectors.integer(row)), k) for row in rows]


class Around(Lanewise):
    """A function of each sample around a turn: of its neighbour before, itself, the one after, its number, and of rows
    of a table that it updates from their `start` on.

    Called with the samples (row after row of lanes), their number, the table and the number of its columns.
    """

    def __init__(self, function: Callable[..., tuple[Node, ...]], start: dict[int, float]):
        super().__init__(function, (-4, -3, -2, -1, *start), tuple(start))
        self.start = tuple(start.values())

    @cached_property
    def of_samples(self) -> list[Node]:
        """The nodes that depend on samples alone."""
        known = set(self.inputs[:4])
        for node in self.nodes:
            known.update({node} if known.issuperset(node.operands) else ())
        return [node for node in self.nodes if node in known]

    @cached_property
    def ahead(self) -> dict[Node, Node]:
        """The nodes that are those of the sample before, by what they will be at the next one."""
        graph, ahead = self.inputs[0].graph, dict(zip(self.inputs[:2], self.inputs[1:3], strict=True))
        for node in self.of_samples:
            if node.operands and ahead.keys() >= set(node.operands):
                later = graph.find(node.operator, *(ahead[x] for x in node.operands))
                ahead |= {node: later} if later else {}
        return ahead

    def __call__(self, samples: np.ndarray, count: int, table: np.ndarray, columns: int) -> None:  # type: ignore[override]
        row = samples[: count * columns].reshape(count, columns)
        around = np.roll(row, 1, axis=0), row, np.roll(row, -1, axis=0), np.arange(count, dtype=float)[:, None]
        every = interpret(self.of_samples, dict(zip(self.inputs, around, strict=False)))
        now: tuple[Any, ...] = self.start
        running = [(OPERATORS[node.operator], node) for node in self.nodes if node not in every]
        used = {x for _, node in running for x in node.operands if x in every}
        samplewise = {node: np.broadcast_to(every[node], row.shape) for node in used}
        values: Values = {}
        with np.errstate(all="ignore"):
            for j in range(count):
                values.update({node: value[j] for node, value in samplewise.items()})
                values.update(zip(self.inputs[4:], now, strict=True))
                for function, node in running:
                    values[node] = function(*[values[x] for x in node.operands])
                now = tuple(values[node] for node in self.results)
        for k, value in zip(self.outputs, now, strict=True):
            table[k, :columns] = value

    @property
    def text(self) -> str:
        return f"{super().text} {self.start}"

    def compiled(self) -> MachineCode:
        return machine_code(self.emit, (ROW, INTEGER, TABLE, INTEGER), self.text)

    def emit(self, builder: Any, samples: Any, count: Any, table: Any, columns: Any) -> None:  # type: ignore[override]
        vectors = Instructions(builder)
        none, one = vectors.integer(0), vectors.integer(1)
        last, latest = builder.sub(count, one), builder.sub(columns, vectors.integer(LANES))
        start = [vectors.wide(vectors.double(number)) for number in self.start]

        def sample(j: Any, k: Any) -> Any:
            return vectors.load(samples.data, builder.add(builder.mul(columns, j), k))

        def first_values(k: Any) -> Values:
            values = dict(zip(self.inputs, (sample(last, k), sample(none, k)), strict=False))
            interpret([node for node in self.ahead if node.operands], values, vectors.operators)
            return values | dict(zip(self.inputs[4:], start, strict=True))

        with vectors.loop(none, columns, ABREAST * LANES) as (first, _):
            blocks = [builder.add(first, vectors.integer(k * LANES)) for k in range(ABREAST)]
            blocks = [builder.select(builder.icmp_signed("<", k, latest), k, latest) for k in blocks]
            running = [{node: vectors.slot(value) for node, value in first_values(k).items()} for k in blocks]
            with vectors.loop(none, count) as (j, _):
                following = builder.select(builder.icmp_signed("==", j, last), none, builder.add(j, one))
                number = builder.sitofp(j, vectors.double)
                for k, cells in zip(blocks, running, strict=True):
                    values = {node: builder.load(cell) for node, cell in cells.items()}
                    values |= dict(zip(self.inputs[2:4], (sample(following, k), number), strict=True))
                    interpret([node for node in self.nodes if node not in cells], values, vectors.operators)
                    now = self.ahead | dict(zip(self.inputs[4:], self.results, strict=True))
                    for node, cell in cells.items():
                        builder.store(values[now[node]], cell)
            for k, cells in zip(blocks, running, strict=True):
                self._store(vectors, table, k, [builder.load(cells[node]) for node in self.inputs[4:]])


def lanewise(inputs: tuple[int, ...], outputs: tuple[int, ...]) -> Callable[[Callable[..., Any]], Lanewise]:
    """Decorate a function of numbers as one from rows of a table to rows of it."""
    return lambda function: Lanewise(function, inputs, outputs)


def around(start: dict[int, float]) -> Callable[[Callable[..., Any]], Around]:
    """Decorate a function of a sample, its neighbours and its number, and of rows of a table that it updates from these
    values on."""
    return lambda function: Around(function, start)
