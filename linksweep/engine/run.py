"""Running a plan: by numpy while it is small, by its compiled kernel once that pays; the same bits either way.

A kernel takes seconds to wake and compile, numpy a millisecond for a 720-angle cycle. So the first samples of a plan
are interpreted, operation by operation, and the kernel is compiled when the work done so has added up.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from linksweep.engine import reduce
from linksweep.engine.compile import compiled
from linksweep.engine.fuse import Fused, Reduction, fuse, reductions_source
from linksweep.engine.plan import Plan
from linksweep.engine.trace import Node

COMPILE_AFTER = 100_000
"""Samples (angles × designs) that a plan may cost interpreted before its kernel is compiled."""

SAMPLES_PER_THREAD = 20_000
"""Less work than this is not worth handing to another thread."""

OPERATORS = {
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    "<": np.less,
    "negate": np.negative,
    "abs": np.abs,
    "sqrt": np.sqrt,
    "atan2": np.arctan2,
    "where": np.where,
}


class Field(NamedTuple):
    """Numbers with named dims; `values` has one axis a dim, in that order."""

    dims: tuple[str, ...]
    values: np.ndarray


class Grid(NamedTuple):
    """The samples of the index dimension `dim`: its values, its period (0: none), and the rows of numbers that
    depend on it alone."""

    dim: str
    angles: np.ndarray
    period: float
    names: tuple[str, ...]
    table: np.ndarray


@dataclass(eq=False)
class Runner:
    """One plan made ready to run, and how much of it has been interpreted so far."""

    plan: Plan
    fused: Fused
    interpreted: int = field(default=0)

    def should_interpret(self, samples: int) -> bool:
        self.interpreted += samples
        return self.interpreted <= COMPILE_AFTER


@lru_cache(maxsize=256)
def runner(plan: Plan, reductions: tuple[Reduction, ...] = ()) -> Runner:
    return Runner(plan, fuse(plan, reductions))


def evaluate(
    plan: Plan, inputs: Mapping[str, Field], grid: Grid, sizes: Mapping[str, int], threads: int | None = None
) -> dict[str, Field]:
    """Every output of the plan over its own dims."""
    ready = runner(plan)
    if ready.should_interpret(_samples(plan, grid, sizes)):
        values = interpret(plan.nodes, aligned(plan, inputs, grid))
        stored = {node: _field(plan, node, values[node], grid, sizes) for node in plan.outputs.values()}
        return {name: stored[node] for name, node in plan.outputs.items()}
    block, single = _execute(ready, inputs, grid, sizes, threads)
    stored = _stored_fields(ready, block, single, grid, sizes)
    if plan.late:
        values = {node: _align(plan, node.dims, field) for node, field in stored.items()}
        values |= {node: np.asarray(node.value) for node in plan.nodes if node.operator == "constant"}
        values = interpret(plan.late, values)
        stored |= {node: _field(plan, node, values[node], grid, sizes) for node in plan.late}
    for node in plan.outputs.values():
        if node.operator == "constant":
            stored[node] = Field((), np.asarray(node.value))
    return {name: stored[node] for name, node in plan.outputs.items()}


def reduce_rows(
    plan: Plan,
    reductions: tuple[Reduction, ...],
    inputs: Mapping[str, Field],
    grid: Grid,
    sizes: Mapping[str, int],
    threads: int | None = None,
) -> dict[Reduction, tuple[Field, Field]]:
    """Two numbers for each reduction (value and angle, or value and count), over the signal's dims but the index."""
    ready = runner(plan, reductions)
    if plan.late or ready.should_interpret(_samples(plan, grid, sizes)):
        values = interpret(plan.nodes, aligned(plan, inputs, grid))
        fields = {name: _field(plan, node, values[node], grid, sizes) for name, node in plan.outputs.items()}
        return {r: _reduced_in_python(r, fields[r.name], grid) for r in reductions}
    _, single = _execute(ready, inputs, grid, sizes, threads)
    return {
        r: (_from_single(ready, 2 * k, r, single, sizes), _from_single(ready, 2 * k + 1, r, single, sizes))
        for k, r in enumerate(reductions)
    }


# ------------------------------------------------------------------------------------------ interpreted


def interpret(nodes, values: dict[Node, np.ndarray], operators=OPERATORS) -> dict[Node, np.ndarray]:
    """Do the nodes' operations in order, on numpy arrays or on any numbers that `operators` can handle."""
    with np.errstate(all="ignore"):
        for node in nodes:
            if node.operator == "constant":
                values[node] = np.asarray(node.value)
            elif node.operator != "input":
                values[node] = operators[node.operator](*(values[x] for x in node.operands))
    return values


def aligned(plan: Plan, inputs: Mapping[str, Field], grid: Grid) -> dict[Node, np.ndarray]:
    """The plan's inputs as arrays that broadcast: one axis a loop, then the index."""
    rows = dict(zip(grid.names, grid.table, strict=True))
    return {
        node: _align(
            plan,
            node.dims,
            Field((grid.dim,), rows[node.value]) if node.value in rows else inputs[node.value],
        )
        for node in plan.nodes
        if node.operator == "input"
    }


def _align(plan: Plan, dims: frozenset[str], field: Field) -> np.ndarray:
    axes = (*plan.loops, plan.index)
    order = sorted(range(len(field.dims)), key=lambda k: axes.index(field.dims[k]))
    values = np.transpose(field.values, order)
    shape = iter(values.shape)
    return values.reshape([next(shape) if axis in dims else 1 for axis in axes]) if dims else values


def _field(plan: Plan, node: Node, value: np.ndarray, grid: Grid, sizes: Mapping[str, int]) -> Field:
    dims = plan.dims(node)
    shape = tuple(len(grid.angles) if dim == grid.dim else sizes[dim] for dim in dims)
    return Field(dims, np.reshape(value, shape))


def _reduced_in_python(reduction: Reduction, field: Field, grid: Grid) -> tuple[Field, Field]:
    if grid.dim not in field.dims:
        return field, Field(field.dims, np.full(field.values.shape, grid.angles[0]))
    dims, shape = field.dims[:-1], field.values.shape[:-1]
    lanes = np.empty(reduce.LANES)
    function = getattr(reduce, reduction.kind)
    rows = field.values.reshape(-1, len(grid.angles)).tolist()
    angles = grid.angles.tolist()
    both = np.array([function(row, angles, grid.period, lanes) for row in rows])
    return Field(dims, both[:, 0].reshape(shape)), Field(dims, both[:, 1].reshape(shape))


# --------------------------------------------------------------------------------------------- compiled


def _execute(ready: Runner, inputs: Mapping[str, Field], grid: Grid, sizes: Mapping[str, int], threads: int | None):
    """Lay the inputs out, run the kernel over all designs by a pool of threads, and return block and single."""
    plan, fused = ready.plan, ready.fused
    kernel = compiled(fused.source, reductions_source() if fused.reductions else "")
    loop_sizes = np.array([sizes[dim] for dim in plan.loops] or [1], dtype=np.int64)
    samples = len(grid.angles)
    parameters, parameter_at = _flat([_ordered(plan, inputs[node.value]) for node in fused.parameters])
    profiles, profile_at = _profiles(plan, fused.profiles, inputs, grid)
    block_at, block_rows = _places([_designs(plan, node, sizes) for node in fused.rows])
    singles = [*fused.singles, *(plan.outputs[r.name] for r in fused.reductions for _ in range(2))]
    single_at, single_size = _places([_designs(plan, node, sizes) for node in singles])
    block, single = np.empty((block_rows, samples)), np.empty(single_size)

    def work(first: int, last: int) -> None:
        scratch, lanes = np.empty((fused.scratch_rows, samples)), np.empty(reduce.LANES)
        kernel(
            first, last, samples, loop_sizes, parameters, parameter_at, profiles, profile_at,
            block, block_at, single, single_at, scratch, grid.angles, grid.period, lanes,
        )  # fmt: skip

    length = int(loop_sizes[0]) if plan.loops else samples
    workers = min(threads or os.cpu_count() or 1, 1 + _samples(plan, grid, sizes) // SAMPLES_PER_THREAD, length)
    if workers <= 1 or (fused.reductions and not plan.loops):
        work(0, length)
    else:
        bounds = [length * k // (4 * workers) for k in range(4 * workers + 1)]
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(work, bounds[:-1], bounds[1:]))
    return block, single


def _samples(plan: Plan, grid: Grid, sizes: Mapping[str, int]) -> int:
    return len(grid.angles) * math.prod(sizes[dim] for dim in plan.loops)


def _designs(plan: Plan, node: Node, sizes: Mapping[str, int]) -> int:
    return math.prod(sizes[dim] for dim in plan.dims(node) if dim != plan.index)


def _ordered(plan: Plan, field: Field) -> np.ndarray:
    """A field's values with its loops outermost first and the index last, contiguous."""
    if len(field.dims) < 2:
        return np.ascontiguousarray(field.values, dtype=np.float64)
    axes = (*plan.loops, plan.index)
    order = sorted(range(len(field.dims)), key=lambda k: axes.index(field.dims[k]))
    return np.ascontiguousarray(np.transpose(field.values, order), dtype=np.float64)


def _places(counts: list[int]) -> tuple[np.ndarray, int]:
    ends = np.cumsum([0, *counts], dtype=np.int64)
    return ends, int(ends[-1])


def _flat(arrays: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    at, _ = _places([array.size for array in arrays])
    return (np.concatenate([array.reshape(-1) for array in arrays]) if arrays else np.empty(0)), at


def _profiles(plan: Plan, nodes: tuple[Node, ...], inputs: Mapping[str, Field], grid: Grid):
    """Rows of all inputs that depend on the index; the grid's own table is used as it stands, uncopied."""
    rows, at, blocks = len(grid.table), [], [grid.table]
    for node in nodes:
        if node.value in grid.names:
            at.append(grid.names.index(node.value))
        else:
            blocks.append(_ordered(plan, inputs[node.value]).reshape(-1, len(grid.angles)))
            at.append(rows)
            rows += len(blocks[-1])
    table = blocks[0] if len(blocks) == 1 else np.concatenate(blocks)
    return table, np.array([*at, rows], dtype=np.int64)


def _stored_fields(ready: Runner, block, single, grid: Grid, sizes: Mapping[str, int]) -> dict[Node, Field]:
    plan, fields, row, place = ready.plan, {}, 0, 0
    for node in ready.fused.rows:
        count = _designs(plan, node, sizes)
        fields[node] = _field(plan, node, block[row : row + count], grid, sizes)
        row += count
    for node in ready.fused.singles:
        count = _designs(plan, node, sizes)
        fields[node] = _field(plan, node, single[place : place + count], grid, sizes)
        place += count
    return fields


def _from_single(ready: Runner, k: int, reduction: Reduction, single, sizes: Mapping[str, int]) -> Field:
    plan = ready.plan
    node = plan.outputs[reduction.name]
    dims = tuple(dim for dim in plan.dims(node) if dim != plan.index)
    counts = [_designs(plan, plan.outputs[r.name], sizes) for r in ready.fused.reductions for _ in range(2)]
    start = sum(counts[:k])
    return Field(dims, single[start : start + counts[k]].reshape([sizes[dim] for dim in dims]))
