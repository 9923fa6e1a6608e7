"""fuse(plan): choose the writer of its kernel: of one design at a time, or of several side by side."""

from __future__ import annotations

import inspect

from linksweep.engine.kernel import reduce
from linksweep.engine.kernel.batched import BatchedWriter, shares_rows
from linksweep.engine.kernel.writer import Reduction, Writer
from linksweep.engine.trace.plan import Plan

REDUCTIONS_SOURCE = inspect.getsource(reduce)


def fuse(plan: Plan, reductions: tuple[Reduction, ...]) -> Writer:
    """Return the kernel that stores the plan's outputs or reduces them row by row."""
    writer = Writer(plan, reductions)
    return BatchedWriter(plan, reductions) if shares_rows(writer) else writer
