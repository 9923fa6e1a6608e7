"""Time two threads against one; their bits are equal."""

from __future__ import annotations

from functools import partial
from time import perf_counter

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.cases import ALL, GENERAL, NINE, Size, batch, few, scene
from benchmarks.speed.exact import crank_rockers
from benchmarks.speed.kernel import way
from benchmarks.timing import FASTER, Call, Row, cores, race


def rows(size: Size) -> list[Row]:
    many, one = scene(batch(size.designs, *ALL)), scene(GENERAL)
    number, long = 100 * size.designs, size.largest_angles // 10
    rockers = crank_rockers(number, 0.0)
    return [
        _row(f"ls.peaks, exact, {number:,} crank-rockers", partial(ls.peaks, rockers), few(size), goal=1.7),
        _row("ls.peaks", partial(ls.peaks, many, theta2=size.turn), size, size.designs * size.turn),
        _row("ls.sweep, many designs", partial(ls.sweep, many, size.turn, of=NINE), size, size.designs * size.turn),
        _row("ls.sweep, one design", partial(ls.sweep, one, size.angles, of=NINE), size, size.angles),
        _row("ls.sweep, a million angles", partial(ls.sweep, one, long, of=NINE), few(size), long, goal=1.7),
    ]


def _row(job: str, call: Call, size: Size, samples: int | None = None, goal: float | None = None) -> Row:
    alone, both = f"{job}, 1 thread", f"{job}, 2 threads"
    if cores() < 2:
        return Row(both, alone, FASTER, goal=goal, note="not measured: one core only")
    calls = {alone: partial(call, threads=1), both: partial(call, threads=2)}
    with way("compiled"):
        error = _difference(calls[both](), calls[alone]())
        return race(calls, size, samples, perf_counter).row(FASTER, both, alone, goal, error=error)


def _difference(values: xr.Dataset, expected: xr.Dataset) -> float:
    """Return the largest difference of any variable; 0 where they agree bit for bit."""
    return max(float(np.max(np.abs(values[name].values - expected[name].values))) for name in expected.data_vars)
