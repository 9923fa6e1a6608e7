"""fuse(plan): write the source of its kernel, and the order of the kernel's arguments."""

from __future__ import annotations

import inspect
from dataclasses import dataclass

from linksweep.engine.kernel import reduce
from linksweep.engine.kernel.batched import BatchedWriter, shares_rows
from linksweep.engine.kernel.writer import Reduction, Writer
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.plan import Plan


@dataclass(frozen=True, eq=False)
class Fused:
    """A kernel's source, and the order of inputs, rows and single results in its arguments."""

    source: str
    parameters: tuple[Node, ...]
    profiles: tuple[Node, ...]
    rows: tuple[Node, ...]
    singles: tuple[Node, ...]
    reductions: tuple[Reduction, ...]
    scratch_size: int


def fuse(plan: Plan, reductions: tuple[Reduction, ...], room: int) -> Fused:
    """Write the kernel that stores the plan's outputs or reduces them row by row, for at most `room` samples."""
    writer = Writer(plan, reductions, room)
    if shares_rows(writer):
        writer = BatchedWriter(plan, reductions, room)
    return Fused(
        source=writer.kernel(),
        parameters=writer.parameters,
        profiles=writer.profiles,
        rows=writer.rows,
        singles=writer.singles,
        reductions=reductions,
        scratch_size=writer.scratch_size,
    )


def reductions_source() -> str:
    return inspect.getsource(reduce)
