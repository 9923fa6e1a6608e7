"""Functions of numbers, done in all lanes of a table at once: traced, then interpreted or written as vectors."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from linksweep.engine.kernel.compile import compiled_vectors
from linksweep.engine.peaks import instructions
from linksweep.engine.peaks.instructions import WIDTH, Emitter, Values
from linksweep.engine.run import interpret
from linksweep.engine.trace.graph import Graph, Node

SOURCE = inspect.getsource(sys.modules[__name__]) + instructions.SOURCE
"""All that enters the machine code besides the nodes."""
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

        emitter = Emitter(builder)
        with cgutils.for_range_slice(builder, emitter.integer(0), columns, emitter.integer(WIDTH)) as (k, _):
            loaded = {
                node: emitter.load(table, _place(emitter, columns, row, k))
                for node, row in zip(self.inputs, self.rows, strict=True)
            }
            values = emitter.emit(self.nodes, loaded)
            for row, node in zip(self.outputs, self.results, strict=True):
                emitter.store(values[node], table, _place(emitter, columns, row, k))


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

        emitter = Emitter(builder)
        last = builder.sub(count, emitter.integer(1))
        latest = builder.sub(columns, emitter.integer(WIDTH))
        with cgutils.for_range_slice(builder, emitter.integer(0), columns, emitter.integer(ABREAST * WIDTH)) as (
            first,
            _,
        ):
            blocks = [builder.add(first, emitter.integer(k * WIDTH)) for k in range(ABREAST)]
            blocks = [builder.select(builder.icmp_signed("<", k, latest), k, latest) for k in blocks]

            def sample(j: Any, k: Any) -> Any:
                return emitter.load(samples, builder.add(builder.mul(columns, j), k))

            kept = [[_place(emitter, columns, row, k) for row in self.outputs] for k in blocks]
            start = [
                [sample(last, k), sample(emitter.integer(0), k), *(emitter.load(table, place) for place in places)]
                for k, places in zip(blocks, kept, strict=True)
            ]
            running = [[cgutils.alloca_once_value(builder, value) for value in values] for values in start]
            with cgutils.for_range(builder, count) as (j, _):
                following = builder.add(j, emitter.integer(1))
                following = builder.select(builder.icmp_signed("==", j, last), emitter.integer(0), following)
                number = emitter.spread(builder.sitofp(j, emitter.ir.DoubleType()))
                for k, block in zip(blocks, running, strict=True):
                    before, here, *rest = (builder.load(one) for one in block)
                    after = sample(following, k)
                    now = (before, here, after, number, *rest)
                    values = emitter.emit(self.nodes, dict(zip(self.inputs, now, strict=True)))
                    for one, value in zip(block, [here, after, *(values[x] for x in self.results)], strict=True):
                        builder.store(value, one)
            for places, block in zip(kept, running, strict=True):
                for place, one in zip(places, block[2:], strict=True):
                    emitter.store(builder.load(one), table, place)


def _place(emitter: Emitter, columns: Any, row: int, k: Any) -> Any:
    """Return the position of a column in a row of a table."""
    return emitter.builder.add(emitter.builder.mul(columns, emitter.integer(row)), k)


def lanewise(inputs: tuple[int, ...], outputs: tuple[int, ...]) -> Callable[[Callable[..., Any]], Lanewise]:
    """Decorate a function of numbers as one from rows of a table to rows of it."""
    return lambda function: Lanewise(function, inputs, outputs)


def around(*rows: int) -> Callable[[Callable[..., Any]], Around]:
    """Decorate a function of a sample, its neighbours and its number, and of rows of a table that it updates."""
    return lambda function: Around(function, rows)
