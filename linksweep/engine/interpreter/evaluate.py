"""Evaluate what a plan stores by its programs, one after the other."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from linksweep.engine.blocks import block
from linksweep.engine.interpreter.machine import TILE, address, interpret
from linksweep.engine.interpreter.program import Program, programs
from linksweep.engine.kernel.instructions import REGISTER
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import Plan

Values = dict[Node, np.ndarray | np.float64]
"""Numbers of nodes: arrays with an axis for each loop and one for the index, of length 1 for dims that a node has not;
single numbers where it has none."""


def evaluate(plan: Plan, values: Values, sizes: Mapping[str, int]) -> Values:
    """Return the values of all that the plan stores, from those of its inputs; `sizes` are those of all dims."""
    values |= {node: np.float64(node.value) for node in plan.constants}
    for program in programs(plan):
        shape = tuple(sizes[dim] if dim in program.dims else 1 for dim in (*plan.loops, plan.index))
        samples = math.prod(shape)
        rows = [_row(values[node], shape) for node in program.rows]
        results = block(len(program.results), max(samples, REGISTER))
        starts = np.array([*map(address, rows), *_starts(results)], dtype=np.int64)
        interpret(program.code, _registers(program, values), starts, results.shape[1])
        for node, result in zip(program.results, results, strict=True):
            values[node] = result[:samples].reshape(shape) if program.dims else result[0]
    return values


def _row(value: np.ndarray | np.float64, shape: tuple[int, ...]) -> np.ndarray:
    """Return the samples of a value, repeated along the dims that it has not; at least `REGISTER` of them."""
    row = np.ascontiguousarray(np.broadcast_to(value, shape), dtype=np.float64).reshape(-1)
    return row if len(row) >= REGISTER else np.pad(row, (0, REGISTER - len(row)), mode="edge")


def _starts(rows: np.ndarray) -> range:
    """Return the addresses of the rows of an array."""
    start = address(rows)
    return range(start, start + rows.nbytes, rows.strides[0])


def _registers(program: Program, values: Values) -> np.ndarray:
    """Return registers, with single numbers in the first of them."""
    registers = np.empty((program.registers, TILE))
    registers[: len(program.numbers)] = np.array([values[node] for node in program.numbers]).reshape(-1, 1)
    return registers
