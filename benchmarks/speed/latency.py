"""Time the waits of a user: one warm call, and the first minutes in fresh processes."""

from __future__ import annotations

import os
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.cases import GENERAL, NINE, Size, scene, stacked
from benchmarks.rivals import peers
from benchmarks.speed import fresh, peaks
from benchmarks.speed.kernel import kernel_of, way
from benchmarks.timing import WALL, Race, Row, race, timed
from linksweep.engine.kernel.compile import compiled

LAPACK = "numpy + LAPACK"
FIRST_SWEEP = "import linksweep as ls; ls.sweep(ls.example('press'))"
FIRST_COMPILED = """
import time

import linksweep as ls
from linksweep.engine import run
run.COMPILE_AFTER = -1
scene = ls.example("press")
start = time.perf_counter()
ls.sweep(scene)
print(time.perf_counter() - start)
"""


def warm_calls(size: Size) -> list[Row]:
    return [row for name in ("interpreted", "compiled") for row in _warm(name, size)]


def _warm(name: str, size: Size) -> list[Row]:
    """Time one revolution of one design: kinematics and unknowns, or peaks. The press carries a load."""
    machine, press = scene(GENERAL), ls.example("press")
    jobs = {
        f"ls.sweep, {name}": partial(ls.sweep, machine, size.turn),
        f"ls.sweep of the press, {name}": partial(ls.sweep, press, size.turn),
        f"ls.sweep, scene built anew, {name}": lambda: ls.sweep(scene(GENERAL), size.turn),
        f"ls.peaks, {name}": partial(ls.peaks, machine, theta2=size.turn),
    }
    goals = (0.25e-3, 0.25e-3, 0.45e-3, None)
    with way(name):
        errors = _errors(size.turn, *(call() for call in jobs.values()))
        timings = race(jobs | {LAPACK: partial(peers.numpy_lapack, GENERAL, peers.grid(size.turn))}, size)
    return [
        timings.row(WALL, job, LAPACK, goal, error=error) for job, goal, error in zip(jobs, goals, errors, strict=True)
    ]


def _errors(n_angles: int, *results: xr.Dataset) -> list[float]:
    """Return each warm job's error against a dense solve; the press, which carries a load, by linksweep's own."""
    sweep, press, anew, peaks_ds = results
    nine = peers.numpy_lapack(GENERAL, peers.grid(n_angles))
    dense_press = ls.sweep(ls.example("press"), n_angles, of=NINE, solver="dense")
    alone = replace(GENERAL, a=np.full((1, 1), GENERAL.a))
    return [
        peers.difference(stacked(sweep), nine),
        peers.difference(stacked(press), stacked(dense_press)),
        peers.difference(stacked(anew), nine),
        peaks.difference(peaks.columns(peaks_ds)[None], peers.numpy_lapack_peaks(alone, n_angles)[0]),
    ]


def first_minutes(size: Size) -> list[Row]:
    fresh.python("-c", "import linksweep")  # compiles what has no .pyc file yet, untimed
    rounds = [_first_round() for _ in range(size.processes)]
    timings = Race({job: [seconds[job] for seconds in rounds] for job in rounds[0]})
    return [
        timings.row(WALL, "import linksweep", "import xarray", 0.3),
        timings.row(WALL, "import of all public names", "import xarray"),
        timings.row(WALL, "import and first ls.sweep, on a fresh machine", "import xarray", 1.0),
        timings.row(WALL, "import and first ls.sweep", "import xarray", 1.0),
        timings.row(WALL, "linksweep demo, second", "linksweep demo, first", 1.5),
        timings.row(WALL, "first compiled ls.sweep, kernel from disk", "first compiled ls.sweep"),
        timings.row(WALL, "one kernel from disk, numba awake", "one kernel compiled, numba awake"),
    ]


def _first_round() -> dict[str, float]:
    """Run every job once, from empty caches of linksweep and matplotlib."""
    kernel = kernel_of(partial(ls.sweep, scene(GENERAL), 72, of=NINE, threads=1))
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        caches = {"LINKSWEEP_CACHE_DIR": f"{folder}/kernels", "MPLCONFIGDIR": f"{folder}/matplotlib"}
        with mock.patch.dict(os.environ, caches):
            python = partial(fresh.python, folder=Path(folder))
            return {
                "import xarray": timed(lambda: python("-c", "import xarray")),
                "import linksweep": timed(lambda: python("-c", "import linksweep")),
                "import of all public names": timed(lambda: python("-c", "from linksweep import *")),
                "import and first ls.sweep, on a fresh machine": timed(lambda: python("-c", FIRST_SWEEP)),
                "import and first ls.sweep": timed(lambda: python("-c", FIRST_SWEEP)),
                "linksweep demo, first": timed(lambda: python("-m", "linksweep", "demo")),
                "linksweep demo, second": timed(lambda: python("-m", "linksweep", "demo")),
                "first compiled ls.sweep": float(python("-c", FIRST_COMPILED)),
                "first compiled ls.sweep, kernel from disk": float(python("-c", FIRST_COMPILED)),
                "one kernel compiled, numba awake": timed(lambda: compiled.__wrapped__(*kernel.sources)),
                "one kernel from disk, numba awake": timed(lambda: compiled.__wrapped__(*kernel.sources)),
            }
