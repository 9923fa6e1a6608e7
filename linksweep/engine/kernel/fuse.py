"""fuse(plan): choose the writer of its kernel: of one design at a time, or of designs side by side."""

from __future__ import annotations

from linksweep.engine.kernel.side_by_side import SideBySideWriter
from linksweep.engine.kernel.writer import Reduction, Writer
from linksweep.engine.trace.plan import Plan


def fuse(plan: Plan, reductions: tuple[Reduction, ...], of_profiles: tuple[int, ...] | None = None) -> Writer:
    """Return the kernel that stores the plan's outputs or reduces them row by row.

    With the parities of its profiles, return that of designs side by side.
    """
    return Writer(plan, reductions) if of_profiles is None else SideBySideWriter(plan, reductions, of_profiles)
