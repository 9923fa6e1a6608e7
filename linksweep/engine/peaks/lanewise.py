"""Functions of numbers, done in all lanes of a table at once: traced, then interpreted or written as vectors."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from linksweep.engine.kernel.compile import compiled_vectors
from linksweep.engine.kernel.instructions import REGISTER as LANES
from linksweep.engine.kernel.instructions import Instructions
from linksweep.engine.run import interpret
from linksweep.engine.trace.graph import Graph, Node

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
        self.__name__, self.rows, self.outputs = function.__name__, inputs, outputs
        graph = Graph()
        self.inputs = [graph.input(f"row {row}", ("lane",)) for row in inputs]
        self.results = [graph.node(result) for result in function(*self.inputs)]
        self.nodes = [node for node in graph.nodes if node.operator != "input"]

    def __call__(self, table: np.ndarray, columns: int) -> None:
        self._interpret({node: table[row].copy() for node, row in zip(self.inputs, self.rows, strict=True)}, table)

    def _interpret(self, values: Values, table: np.ndarray) -> None:
        values = interpret(self.nodes, values)
        for row, node in zip(self.outputs, self.results, strict=True):
            table[row] = values[node]

    def compiled(self) -> Callable[..., None]:
        """Return the function of a table and the number of its columns as machine code."""
        return compiled_vectors(self._emit, "void(f8[:, ::1], i8)", self.text)

    @property
    def text(self) -> str:
        """A text that differs wherever the function does."""
        place = {node: k for k, node in enumerate([*self.inputs, *self.nodes])}
        lines = [(node.operator, node.value, [place[x] for x in node.operands]) for node in self.nodes]
        return f"{SOURCE} {self.rows} {self.outputs} {lines} {[place[node] for node in self.results]}"

    def _emit(self, builder: Any, table: Any, columns: Any) -> None:
        from numba.core import cgutils

        vectors = Instructions(builder)
        with cgutils.for_range_slice(builder, vectors.integer(0), columns, vectors.integer(LANES)) as (k, _):
            read, written = (_places(vectors, columns, rows, k) for rows in (self.rows, self.outputs))
            loaded = [vectors.load(table.data, place) for place in read]
            values = interpret(self.nodes, dict(zip(self.inputs, loaded, strict=True)), vectors.operators)
            for place, node in zip(written, self.results, strict=True):
                vectors.store(values[node], table.data, place)


class Around(Lanewise):
    """A function of each sample around a turn: of its neighbour before, itself, the one after, and its number; and of
    rows of a table that it updates.

    Called with the samples (row after row of lanes), their number, the table and the number of its columns.
    """

    def __init__(self, function: Callable[..., tuple[Node, ...]], rows: tuple[int, ...]):
        super().__init__(function, (-4, -3, -2, -1, *rows), rows)

    def __call__(self, samples: np.ndarray, count: int, table: np.ndarray, columns: int) -> None:  # type: ignore[override]
        row = samples[: count * columns].reshape(count, columns)
        for j in range(count):
            now = (row[j - 1], row[j], row[(j + 1) % count], np.float64(j), *(table[k].copy() for k in self.outputs))
            self._interpret(dict(zip(self.inputs, now, strict=True)), table)

    def compiled(self) -> Callable[..., None]:
        return compiled_vectors(self._emit_around, "void(f8[::1], i8, f8[:, ::1], i8)", self.text)

    def _emit_around(self, builder: Any, samples: Any, count: Any, table: Any, columns: Any) -> None:
        from numba.core import cgutils

        vectors = Instructions(builder)
        none, one = vectors.integer(0), vectors.integer(1)
        last, latest = builder.sub(count, one), builder.sub(columns, vectors.integer(LANES))

        def sample(j: Any, k: Any) -> Any:
            return vectors.load(samples.data, builder.add(builder.mul(columns, j), k))

        with cgutils.for_range_slice(builder, none, columns, vectors.integer(ABREAST * LANES)) as (first, _):
            blocks = [builder.add(first, vectors.integer(k * LANES)) for k in range(ABREAST)]
            blocks = [builder.select(builder.icmp_signed("<", k, latest), k, latest) for k in blocks]
            kept = [_places(vectors, columns, self.outputs, k) for k in blocks]
            running = [
                [cgutils.alloca_once_value(builder, value) for value in (sample(last, k), sample(none, k), *loaded)]
                for k, loaded in zip(blocks, [[vectors.load(table.data, x) for x in row] for row in kept], strict=True)
            ]
            with cgutils.for_range(builder, count) as (j, _):
                following = builder.select(builder.icmp_signed("==", j, last), none, builder.add(j, one))
                number = builder.sitofp(j, vectors.double)
                for k, block in zip(blocks, running, strict=True):
                    before, here, *rest = map(builder.load, block)
                    after = sample(following, k)
                    now = zip(self.inputs, (before, here, after, number, *rest), strict=True)
                    values = interpret(self.nodes, dict(now), vectors.operators)
                    for place, value in zip(block, (here, after, *(values[x] for x in self.results)), strict=True):
                        builder.store(value, place)
            for places, block in zip(kept, running, strict=True):
                for place, value in zip(places, block[2:], strict=True):
                    vectors.store(builder.load(value), table.data, place)


def _places(vectors: Instructions, columns: Any, rows: tuple[int, ...], k: Any) -> list[Any]:
    """Return the positions of a column in rows of a table."""
    builder = vectors.builder
    return [builder.add(builder.mul(columns, vectors.integer(row)), k) for row in rows]


def lanewise(inputs: tuple[int, ...], outputs: tuple[int, ...]) -> Callable[[Callable[..., Any]], Lanewise]:
    """Decorate a function of numbers as one from rows of a table to rows of it."""
    return lambda function: Lanewise(function, inputs, outputs)


def around(*rows: int) -> Callable[[Callable[..., Any]], Around]:
    """Decorate a function of a sample, its neighbours and its number, and of rows of a table that it updates."""
    return lambda function: Around(function, rows)
