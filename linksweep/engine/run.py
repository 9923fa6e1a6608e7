"""Run a plan: by the interpreter while it is small, by its own kernel once that pays; both return equal bits.

A kernel takes half a second to load and compile, the interpreter 20 µs for a 720-angle cycle. So the first samples of a
plan are interpreted, and the kernel is compiled once the interpreted work has added up.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np

from linksweep.base.memory import require_memory
from linksweep.engine.blocks import block as new_block
from linksweep.engine.interpreter import evaluate as interpreter
from linksweep.engine.kernel import reduce
from linksweep.engine.kernel.compile import compiled
from linksweep.engine.kernel.instructions import REGISTER
from linksweep.engine.kernel.side_by_side import SideBySideWriter, fits_side_by_side, parity
from linksweep.engine.kernel.vectors import WIDEST, width_in_stages
from linksweep.engine.kernel.writer import Reduction, Writer
from linksweep.engine.once import once
from linksweep.engine.patience import Patience
from linksweep.engine.threads import over_threads
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import Plan

COMPILE_AFTER = 1_000_000
"""Samples (angles × designs) of a plan interpreted before its kernel is compiled: about 20 ms of the interpreter."""

STREAMED_FROM = 20_000_000
"""Bytes from which results are written past the caches, which would not hold them until somebody reads them: below,
that took twice as long, above two thirds (measured with caches of 32 MB)."""

SAMPLES_PER_THREAD = 300_000
"""Samples that pay for another thread: about a millisecond of kernel."""

MOST_REPEATED = 1.4
"""Designs in whole vectors for each design, at most, for designs side by side to pay: they take 0.7 of the time."""

Numbers = np.ndarray | float
"""The value of a node: an array, or a single number where it has no dims."""


class Field(NamedTuple):
    """Numbers with named dims; `values` has one axis per dim, in that order."""

    dims: tuple[str, ...]
    values: np.ndarray


Fields = Mapping[str, Field]
"""Inputs of a plan by name."""
Sizes = Mapping[str, int]
"""Sizes of the design dims."""
Places = Mapping[str, np.ndarray]
"""Indices of some designs along each design dim."""


class Grid(NamedTuple):
    """Samples of the index dim `dim`: its values, its period (0: none), and the named rows of numbers that depend on it
    alone."""

    dim: str
    angles: np.ndarray
    period: float
    names: tuple[str, ...]
    table: np.ndarray


class Slot(NamedTuple):
    """The place of a node's results, for the designs of `dims`: rows of the block, or single numbers, from `start`."""

    node: Node
    dims: tuple[str, ...]
    start: int
    shape: tuple[int, ...]

    @property
    def size(self) -> int:
        return math.prod(self.shape)


class Layout(NamedTuple):
    """The places of all results for one set of sizes."""

    sizes: np.ndarray
    rows: tuple[Slot, ...]
    singles: tuple[Slot, ...]

    @staticmethod
    def places(slots: tuple[Slot, ...]) -> tuple[np.ndarray, int]:
        """Return the starts as the kernel takes them, and the total size."""
        starts = np.array([slot.start for slot in slots], dtype=np.int64)
        return starts, sum(slot.size for slot in slots)


@dataclass(eq=False)
class Runner(Patience):
    """One plan ready to run."""

    traced: Plan
    reductions: tuple[Reduction, ...]
    layouts: dict[tuple[int, ...], Layout] = field(default_factory=dict)
    writers: dict[tuple[int, ...], Writer] = field(default_factory=dict)
    latest: tuple[np.ndarray | None, tuple[int, ...]] = (None, ())
    """Profiles of the latest run, often the table of a grid that is kept, and their parities."""

    @once
    def plan(self) -> Plan:
        """The plan as kernels follow it."""
        return self.traced.with_arctangents_expanded()

    @once
    def fused(self) -> Writer:
        return Writer(self.plan, self.reductions)

    @once
    def streamed(self) -> Writer:
        """The kernel that writes results past the caches, a line of them at once: halves of lines that do not follow
        each other go to memory one by one, and took three times as long (AMD Zen 3)."""
        return Writer(self.plan, self.reductions, staged=width_in_stages() >= REGISTER)

    def fused_for(self, designs: int, profiles: np.ndarray, at: np.ndarray) -> Writer:
        """Return the kernel for this many designs in the innermost loop, and the samples of its profiles."""
        pays = -(-designs // WIDEST) * WIDEST <= MOST_REPEATED * designs
        if designs < WIDEST or not pays or not fits_side_by_side(self.fused):  # else lanes would write behind results
            return self.fused
        known, key = self.latest
        if known is not profiles:
            rows = zip(self.fused.profiles, profiles[at[:-1]], strict=True)
            key = tuple(parity(row) if len(node.dims) == 1 else 0 for node, row in rows)
            self.latest = profiles, key
        if key not in self.writers:
            self.writers[key] = SideBySideWriter(self.plan, self.reductions, key)
        return self.writers[key]

    def layout(self, sizes: Sizes) -> Layout:
        key = tuple(sizes[dim] for dim in self.plan.loops)
        if key not in self.layouts:
            reduced = (self.plan.outputs[r.name] for r in self.reductions for _ in range(2))  # two numbers each
            rows = slots(self.plan, self.fused.rows, sizes)
            singles = slots(self.plan, (*self.fused.singles, *reduced), sizes)
            self.layouts[key] = Layout(np.array(key or (1,), dtype=np.int64), rows, singles)
        return self.layouts[key]


def slots(plan: Plan, nodes: Iterable[Node], sizes: Sizes) -> tuple[Slot, ...]:
    """Return consecutive places for the results of nodes."""
    places, start = [], 0
    for node in nodes:
        dims = tuple(dim for dim in plan.dims(node) if dim != plan.index)
        places.append(Slot(node, dims, start, tuple(sizes[dim] for dim in dims)))
        start += places[-1].size
    return tuple(places)


runner = lru_cache(maxsize=256)(Runner)
"""Return the `Runner` of these arguments, one for all requests."""


def evaluate(plan: Plan, inputs: Fields, grid: Grid, sizes: Sizes) -> dict[str, Field]:
    """Return every output of the plan over its own dims."""
    ready = runner(plan, ())
    if ready.should_interpret(_samples(plan, grid, sizes), COMPILE_AFTER):
        return _interpreted(plan, inputs, grid, sizes)
    layout = ready.layout(sizes)
    block, single = _execute(ready, inputs, grid, sizes)
    stored = {slot.node: _rows_of(slot, block, grid) for slot in layout.rows}
    stored |= {slot.node: single_of(slot, single) for slot in layout.singles}
    stored |= {node: Field((), np.asarray(node.value)) for node in ready.plan.constants}
    return {name: stored[node] for name, node in ready.plan.outputs.items()}


def reduce_rows(
    plan: Plan, reductions: tuple[Reduction, ...], inputs: Fields, grid: Grid, sizes: Sizes
) -> dict[Reduction, tuple[Field, Field]]:
    """Return two numbers for each reduction (value and angle, or value and count), over the signal's dims but the
    index."""
    ready = runner(plan, reductions)
    if ready.should_interpret(_samples(plan, grid, sizes), COMPILE_AFTER):
        fields = _interpreted(plan, inputs, grid, sizes)
        return {r: _reduced_in_python(r, fields[r.name], grid) for r in reductions}
    layout = ready.layout(sizes)
    _, single = _execute(ready, inputs, grid, sizes)
    pairs = zip(reductions, layout.singles[::2], layout.singles[1::2], strict=True)
    return {r: (single_of(value, single), single_of(at, single)) for r, value, at in pairs}


# ------------------------------------------------------------------------------------------ interpreted


def _interpreted(plan: Plan, inputs: Fields, grid: Grid, sizes: Sizes) -> dict[str, Field]:
    """Return every output of the plan without a kernel of its own."""
    sizes = {**sizes, grid.dim: len(grid.angles)}
    values = interpreter.evaluate(plan, aligned(plan, inputs, grid), sizes)
    return {name: _field(dims, values[plan.outputs[name]], sizes) for name, dims in plan.dims_of_outputs.items()}


def aligned(plan: Plan, inputs: Fields, grid: Grid) -> dict[Node, Numbers]:
    """Return the plan's inputs as arrays that broadcast, one axis per loop, then the index; scalars without dims."""
    fields = {**inputs, **{name: Field((grid.dim,), row) for name, row in zip(grid.names, grid.table, strict=True)}}
    return {node: _align(plan, node.dims, fields[node.value]) for node in plan.input_nodes}


def _align(plan: Plan, dims: frozenset[str], field: Field) -> Numbers:
    if not dims:
        return float(field.values)
    shape = iter((values := ordered(plan, field)).shape)
    return values.reshape([next(shape) if dim in dims else 1 for dim in (*plan.loops, plan.index)])


def _field(dims: tuple[str, ...], value: Any, sizes: Sizes) -> Field:
    if not dims or value.ndim == len(dims):
        return Field(dims, np.asarray(value))
    return Field(dims, value.reshape(tuple(sizes[dim] for dim in dims)))  # np.reshape takes as long as a row of samples


def _reduced_in_python(reduction: Reduction, field: Field, grid: Grid) -> tuple[Field, Field]:
    last = -1 if grid.dim in field.dims else None
    dims, shape = field.dims[:last], field.values.shape[:last]
    rows = np.broadcast_to(field.values.reshape(math.prod(shape), -1), (math.prod(shape), len(grid.angles)))
    function, work, angles = getattr(reduce, reduction.kind), np.empty(reduce.WORK), grid.angles.tolist()
    both = np.array([function(row, angles, work) for row in rows.tolist()])
    return Field(dims, both[:, 0].reshape(shape)), Field(dims, both[:, 1].reshape(shape))


# --------------------------------------------------------------------------------------------- compiled


def _execute(ready: Runner, inputs: Fields, grid: Grid, sizes: Sizes) -> tuple[np.ndarray, np.ndarray]:
    """Flatten the inputs, run the kernel over all designs by a pool of threads, and return block and single."""
    plan, layout = ready.plan, ready.layout(sizes)
    profiles, profile_at = _profiles(plan, ready.fused.profiles, inputs, grid)
    (block_at, block_rows), (single_at, single_size) = layout.places(layout.rows), layout.places(layout.singles)
    samples = len(grid.angles)
    room = max(samples, WIDEST)
    streamed = 8 * block_rows * room >= STREAMED_FROM
    if streamed:  # whole vectors, each of whole lines of the caches
        samples = room = -(-room // WIDEST) * WIDEST
        fused, kernel = ready.streamed, compiled(ready.streamed.source, "block")
    else:
        fused = ready.fused_for(int(layout.sizes[-1]), profiles, profile_at)
        kernel = compiled(fused.source)
    parameters, parameter_at = flat([ordered(plan, inputs[node.value]) for node in fused.parameters])
    missing = room - len(grid.angles)
    profiles = np.pad(profiles, ((0, 0), (0, missing)), mode="edge") if missing else profiles
    numbers = block_rows * room + single_size
    require_memory(f"{numbers} numbers (results × designs × angles): ask for fewer", 8.0 * numbers)
    block, single = new_block(block_rows, room), np.empty(single_size)
    unit, length = (fused.unit, int(layout.sizes[0])) if plan.loops else (WIDEST, samples)

    def work(first: int, last: int) -> None:
        apart = room + WIDEST if room % 512 == 0 else room  # else all rows would compete for the same cache sets
        scratch, values = np.empty((len(fused.scratch), apart)), new_block(1, fused.value_count)[0]
        kernel(
            first * unit, min(last * unit, length), samples, room, apart, layout.sizes, parameters, parameter_at,
            profiles, profile_at, block, block_at, single, single_at, scratch, values, grid.angles,
            np.empty(reduce.WORK),
        )  # fmt: skip

    workers = 1 + _samples(plan, grid, sizes) // SAMPLES_PER_THREAD
    over_threads(work, -(-length // unit), 1 if ready.reductions and not plan.loops else workers)
    return block[:, : len(grid.angles)], single


def _samples(plan: Plan, grid: Grid, sizes: Sizes) -> int:
    return len(grid.angles) * math.prod(sizes[dim] for dim in plan.loops)


def ordered(plan: Plan, field: Field) -> np.ndarray:
    """Return a field's values with its loops outermost first and the index last, contiguous."""
    if len(field.dims) < 2:
        return np.ascontiguousarray(field.values, dtype=np.float64)
    axes = (*plan.loops, plan.index)
    order = sorted(range(len(field.dims)), key=lambda k: axes.index(field.dims[k]))
    return np.ascontiguousarray(np.transpose(field.values, order), dtype=np.float64)


def flat(arrays: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    at = np.array([*accumulate((array.size for array in arrays), initial=0)], dtype=np.int64)
    return (np.concatenate(arrays, axis=None) if arrays else np.empty(0)), at


def _profiles(plan: Plan, nodes: tuple[Node, ...], inputs: Fields, grid: Grid):
    """Return the rows of all inputs that depend on the index; the grid's own table is used uncopied."""
    rows, at, blocks = len(grid.table), [], [grid.table]
    for node in nodes:
        if node.value in grid.names:
            at.append(grid.names.index(node.value))
        else:
            blocks.append(ordered(plan, inputs[node.value]).reshape(-1, len(grid.angles)))
            at.append(rows)
            rows += len(blocks[-1])
    table = blocks[0] if len(blocks) == 1 else np.concatenate(blocks)
    return table, np.array([*at, rows], dtype=np.int64)


def _rows_of(slot: Slot, block: np.ndarray, grid: Grid) -> Field:
    if not slot.dims:
        return Field((grid.dim,), block[slot.start])
    rows = block[slot.start : slot.start + slot.size]
    return Field((*slot.dims, grid.dim), rows.reshape(*slot.shape, len(grid.angles)))


def single_of(slot: Slot, single: np.ndarray) -> Field:
    return Field(slot.dims, single[slot.start : slot.start + slot.size].reshape(slot.shape))
