"""Time linkages: the kernel of all their unknowns against numpy's solution of the same systems, and per instruction."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.cases import GENERAL, Size, scene
from benchmarks.rivals import peers
from benchmarks.speed.kernel import eliminations, kernel_of, way
from benchmarks.timing import FASTER, SHARE, Call, Race, Row, race
from linksweep.engine.kernel.instructions import REGISTER
from linksweep.engine.kernel.pipeline import busy
from linksweep.engine.trace.plan import Plan, plan

FOUR_BAR = "four-bar, per instruction"
EXAMPLES = "watt-2", "knuckle-press", "jansen-leg"
GOAL = 250.0
"""Times as fast as numpy's batched solution of the same systems."""


def rows(size: Size) -> list[Row]:
    return [row for name in EXAMPLES for row in _rows(name, size)]


def _rows(name: str, size: Size) -> list[Row]:
    """Return the rows of an example: against its systems by numpy, and per instruction against a four-bar's."""
    angles = max(size.angles // 10, 1)  # more systems of equations than that would not fit into memory
    linkage, four_bar = ls.example(name), scene(GENERAL)
    names = linkage.mechanism.unknowns(linkage.drive)
    sweep = partial(ls.sweep, linkage, angles, of=names, threads=1)
    kernel, systems = f"{name}, {len(names)} unknowns", f"{name}, numpy.linalg.solve"
    dense = f"{name}, solver='dense', the systems alone"
    with way("compiled"):
        by_elimination, by_lapack = eliminations(linkage, angles)
        calls: dict[str, Call] = {
            kernel: kernel_of(sweep).call,
            dense: by_elimination,
            systems: by_lapack,
            FOUR_BAR: kernel_of(
                partial(ls.sweep, four_bar, angles, of=four_bar.mechanism.unknowns("crank"), threads=1)
            ).call,
        }
        solved, fast = by_elimination(), _values(sweep(), names, angles)
        some = solved.any(axis=1)  # a slider without inertia has no moment
        error = peers.difference(fast[some], solved[some])
        timed = race(calls, size, angles)
    ours, theirs = instructions(linkage), instructions(four_bar)
    note = f"{ours} instructions"
    cycles = max(busy(node for node in _plan(linkage).nodes if "theta2" in node.dims and node.operands).values())
    at_least = f"{note}, {cycles} cycles for {REGISTER} angles at the least"
    of_instructions = _per_instruction(timed, {kernel: ours, FOUR_BAR: theirs})
    return [
        timed.row(FASTER, kernel, systems, GOAL, error=error, note=at_least),
        timed.row(FASTER, dense, systems, 5.0, error=error),
        of_instructions.row(SHARE, kernel, FOUR_BAR, 1.0, note=f"{note}, {theirs} of the four-bar"),
    ]


def _values(cycle: xr.Dataset, names: Iterable[str], angles: int) -> np.ndarray:
    """Return the values of quantities at each angle; a slider's moment may depend on none."""
    return np.stack([np.broadcast_to(cycle[name].values, angles) for name in names])


def instructions(machine: ls.Scene) -> int:
    """Return the number of instructions per angle of all unknowns."""
    return _plan(machine).instructions("theta2")


def _plan(machine: ls.Scene) -> Plan:
    return plan(machine.table, machine.mechanism.unknowns(machine.drive), machine.inputs.forms)


def _per_instruction(timed: Race, counts: dict[str, int]) -> Race:
    """Return the times of one instruction."""
    seconds = {name: [time / count for time in timed.seconds[name]] for name, count in counts.items()}
    return Race(seconds, timed.samples)
