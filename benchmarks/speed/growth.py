"""Measure how cost grows: with angles and designs, by one thread and two, in time and memory, each size in a fresh
process; and with the request, in the time to compile its kernel. `first` has the start-up times."""

from __future__ import annotations

import json
import os
import re
import resource
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

import linksweep as ls
from benchmarks.cases import ALL, GENERAL, LOADS, NINE, Size, batch, few, scene
from benchmarks.speed import fresh
from benchmarks.speed.kernel import way
from benchmarks.timing import FASTER, WALL, Call, Row, timed

MANY = 1_000_000
"""Number of designs or angles from which a job is timed only twice; the first time it waits for memory."""
JOBS = {"angle": "ls.sweep, {:,} angle", "design": "ls.peaks, {:,} design"}


def rows(size: Size) -> list[Row]:
    sizes = {"angle": _decades(100, size.largest_angles), "design": _decades(1, size.largest_designs)}
    grown = [_grown(job, count, few(size).rounds) for job in sizes for count in sizes[job]]
    return grown + [_first(name) for name in list(REQUESTS)[: size.requests]]


def _decades(least: int, largest: int) -> list[int]:
    return [10**k for k in range(20) if least <= 10**k <= largest]


def _fresh(call: str) -> str:
    """Return the output of a function of this module in a fresh process."""
    return fresh.python("-c", f"from {__package__} import growth; growth.{call}")


# -------------------------------------------------------------------------------- angles, designs, threads


def _grown(job: str, count: int, rounds: int) -> Row:
    """Measure one size of a job in its own process: two threads against one, per angle or design; and its memory."""
    one, two, memory = json.loads(_fresh(f"measure({job!r}, {count}, {rounds})"))
    name = JOBS[job].format(count) + ("s" if count > 1 else "")
    return Row(f"{name}, 2 threads", "1 thread", FASTER, one / two, two, one, count, note=f"{memory:.2f} GB in all")


def measure(job: str, count: int, rounds: int) -> None:
    """Print the times of one thread and of two [s], and the peak memory of this process [GB]."""
    with way("compiled"):
        _call(job, 100)()  # loads the kernel
        call = _call(job, count)
        again = rounds + 1 if count < MANY else 2
        times = [min(timed(partial(call, threads=n)) for _ in range(again)) for n in (1, 2)]
    print(json.dumps([*times, peak_memory()]))


def _call(job: str, count: int) -> Call:
    if job == "angle":
        return partial(ls.sweep, scene(GENERAL), count, of=NINE)
    return partial(ls.peaks, scene(batch(count, *ALL)))


def peak_memory() -> float:
    """Return the peak memory of this process [GB], from /proc where it exists: getrusage includes the parent's on
    Linux."""
    status = Path("/proc/self/status")
    if status.exists():
        return int(re.search(r"VmHWM:\s*(\d+) kB", status.read_text())[1]) / 1e6
    unit = 1e9 if sys.platform == "darwin" else 1e6
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit


# --------------------------------------------------------------------------------------------- compiling

EXACT = "exact peaks"
REQUESTS = {
    "omega3, omega4": partial(ls.sweep, scene(GENERAL), 72, of=["omega3", "omega4"]),
    "the nine unknowns": partial(ls.sweep, scene(GENERAL), 72, of=NINE),
    "kinematics too, two loads": partial(ls.sweep, scene(GENERAL, LOADS), 72),
    "peaks of 72 samples": partial(ls.peaks, scene(GENERAL), theta2=72),
    "peaks of 72 samples, 30 designs": partial(ls.peaks, scene(batch(30, *ALL)), theta2=72),
    "nine by solver='dense'": partial(ls.sweep, scene(GENERAL), 72, of=NINE, solver="dense"),
    EXACT: partial(ls.peaks, scene(GENERAL)),
}


def _first(name: str) -> Row:
    """Time the first call in a process with numba loaded: its kernel compiled, or read from the user's cache."""
    empty = TemporaryDirectory(ignore_cleanup_errors=True)
    with empty as folder, mock.patch.dict(os.environ, {"LINKSWEEP_CACHE_DIR": folder}):
        compiled, read = (float(_fresh(f"first_call({name!r})")) for _ in range(2))
    goal = 2.0 if name == EXACT else 0.25
    return Row(f"{name}: first call", "kernel from disk", WALL, compiled / read, compiled, read, goal=goal)


def first_call(name: str) -> None:
    """Print the time of a request's first call [s]."""
    import numba

    numba.njit("f8(f8)")(lambda x: x)
    with way("compiled"):
        print(timed(REQUESTS[name]))
