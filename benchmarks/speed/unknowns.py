"""Time all nine unknowns of one general four-bar at many crank angles."""

from __future__ import annotations

from functools import partial

import numpy as np

import linksweep as ls
from benchmarks.cases import GENERAL, NINE, Size, scene, stacked
from benchmarks.rivals import limit, peers
from benchmarks.speed import avx2
from benchmarks.speed.kernel import eliminations, kernel_of, way
from benchmarks.timing import FASTER, SHARE, WALL, Row, race

SWEEP, KERNEL, LAPACK, CLOSED, C = "ls.sweep", "kernel alone", "numpy + LAPACK", "numpy closed form", "limit.c"
DENSE, ALONE, SOLVE = "ls.sweep, solver='dense'", "its 9×9 alone", "numpy.linalg.solve of the same 9×9"
WIDE = "limit.c, vectors by hand"
BLOCKS, ANEW, DEFAULT = "numpy + LAPACK, a tenth at a time", "ls.sweep, scene built anew", "ls.sweep, kinematics too"


def rows(size: Size) -> list[Row]:
    theta2, machine = peers.grid(size.angles), scene(GENERAL)
    sweep = partial(ls.sweep, theta2=size.angles, threads=1)
    sweeps = {
        SWEEP: partial(sweep, machine, of=NINE),
        ANEW: lambda: sweep(scene(GENERAL), of=NINE),
        DEFAULT: partial(sweep, machine),
        DENSE: partial(sweep, machine, of=NINE, solver="dense"),
    }
    calls = sweeps | {
        KERNEL: kernel_of(sweeps[SWEEP]).call,
        CLOSED: partial(peers.numpy_closed_form, GENERAL, theta2),
        LAPACK: partial(peers.numpy_lapack, GENERAL, theta2),
        BLOCKS: lambda: [peers.numpy_lapack(GENERAL, block) for block in np.split(theta2, 10)],
    }
    with way("compiled"):
        results = {name: stacked(call()) for name, call in sweeps.items()} | {CLOSED: calls[CLOSED]()}
        results[KERNEL] = results[SWEEP]  # the kernel is the one that ls.sweep runs
        if lib := limit.build():
            calls[C], results[C] = limit.bind_store(lib, GENERAL, theta2)
            calls[C]()
        if lib := limit.build(flags=limit.SCHEDULED):
            calls[WIDE], results[WIDE] = limit.bind_store(lib, GENERAL, theta2, "store_wide")
            calls[WIDE]()
        calls[ALONE], calls[SOLVE] = eliminations(machine, size.angles)
        results[ALONE] = calls[ALONE]()
        dense, results[BLOCKS] = calls[LAPACK](), np.concatenate(calls[BLOCKS](), axis=1)
        error = {name: peers.difference(nine, dense) for name, nine in results.items()}
        timed = race(calls, size, size.angles)

    def row(kind: str, ours: str, theirs: str, goal: float | None = None) -> Row:
        return timed.row(kind, ours, theirs, goal, error=error.get(ours))

    return [
        row(FASTER, SWEEP, LAPACK, 60),
        row(WALL, SWEEP, KERNEL, 10e-9 * size.angles),
        row(WALL, DEFAULT, SWEEP, 18e-9 * size.angles),
        row(FASTER, KERNEL, LAPACK, 250),
        row(SHARE, KERNEL, C, 1.05),
        row(SHARE, KERNEL, WIDE, 1.1),
        row(SHARE, WIDE, C),
        *avx2.rows(size),
        row(FASTER, C, LAPACK),
        row(FASTER, BLOCKS, LAPACK),
        row(FASTER, CLOSED, LAPACK),
        row(FASTER, SWEEP, CLOSED),
        row(FASTER, ANEW, LAPACK),
        row(FASTER, DEFAULT, LAPACK),
        row(FASTER, DENSE, LAPACK),
        row(FASTER, ALONE, SOLVE, 5),
    ]
