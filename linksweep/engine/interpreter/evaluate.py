"""Evaluate what a plan stores by its programs, one after the other."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import repeat

import numpy as np

from linksweep.engine.blocks import block
from linksweep.engine.interpreter.machine import TILE, interpret
from linksweep.engine.interpreter.program import Program, programs
from linksweep.engine.kernel.instructions import REGISTER
from linksweep.engine.kernel.machine_code import address
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import Plan

Values = dict[Node, np.ndarray | float]
"""Numbers of nodes: arrays with an axis for each loop and one for the index, of length 1 for dims that a node has not;
plain numbers where it has none: numpy's own take three times as long to copy."""


def evaluate(plan: Plan, values: Values, sizes: Mapping[str, int]) -> Values:
    """Return the values of all that the plan stores, from those of its inputs; `sizes` are those of all dims."""
    values |= {node: float(node.value) for node in plan.constants}
    for program in programs(plan):
        shape = tuple(sizes[dim] if dim in program.dims else 1 for dim in (*plan.loops, plan.index))
        of_designs = shape[:-1] if plan.index in program.dims else ()
        designs, samples = math.prod(of_designs), math.prod(shape[len(of_designs) :])
        rows = [_rows(values[node], shape, designs) for node in program.rows]
        results = block(len(program.results) * designs, max(samples, REGISTER))
        results = results.reshape(len(program.results), designs, -1)
        start, (apart, design, _) = address(results), results.strides
        places = [*map(_place, rows), *zip(range(start, start + results.nbytes, apart), repeat(design))]
        numbers = _numbers(program, values, of_designs)
        registers, at = block(program.registers, TILE), np.array(places, dtype=np.int64)
        interpret(program.code, registers, numbers, at, results.shape[2])
        stored = results[..., :samples].reshape(len(results), *shape) if program.dims else results[:, 0, 0].tolist()
        values.update(zip(program.results, stored, strict=True))
    return values


def _numbers(program: Program, values: Values, of_designs: tuple[int, ...]) -> np.ndarray:
    """Return the numbers that depend on no sample (design, number)."""
    each, designs = [values[node] for node in program.numbers], math.prod(of_designs)
    if designs == 1:
        return np.array([[value if isinstance(value, float) else value.item() for value in each]], dtype=np.float64)
    numbers = np.empty((designs, len(each)))
    for column, value in zip(numbers.T, each, strict=True):
        column[:] = np.broadcast_to(value, (*of_designs, 1)).reshape(-1)
    return numbers


def _rows(value: np.ndarray | float, shape: tuple[int, ...], designs: int) -> np.ndarray:
    """Return the samples of a value (design, sample), at least `REGISTER` of them, repeated along the dims that it has
    not; one design stands for all where they share them."""
    value = np.asarray(value)
    if designs > 1 and value.size == shape[-1]:
        designs, shape = 1, value.shape
    spread = value if value.shape == shape else np.broadcast_to(value, shape)  # which takes long even for nothing
    rows = np.ascontiguousarray(spread, dtype=np.float64).reshape(designs, -1)
    if (samples := rows.shape[1]) >= REGISTER:
        return rows
    filled = np.zeros((len(rows), REGISTER))  # nobody reads what comes of the zeros
    filled[:, :samples] = rows
    return filled


def _place(rows: np.ndarray) -> tuple[int, int]:
    """Return the address of the first design's row, and by how many bytes the next lies behind it."""
    return address(rows), rows.strides[0] if len(rows) > 1 else 0
