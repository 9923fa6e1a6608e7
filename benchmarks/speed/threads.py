"""Time two threads against one; their bits are equal."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import CDLL
from dataclasses import replace
from functools import partial
from time import perf_counter

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.cases import ALL, GENERAL, NINE, Size, batch, scene
from benchmarks.rivals import limit
from benchmarks.speed.exact import crank_rockers
from benchmarks.speed.kernel import way
from benchmarks.timing import FASTER, Call, Row, cores, race


def rows(size: Size) -> list[Row]:
    designs, number, long = 4 * size.designs, 100 * size.designs, size.largest_angles // 10
    many, one, samples = scene(batch(designs, *ALL)), scene(GENERAL), designs * size.turn
    rockers = crank_rockers(number, 0.0)
    return [
        _row(f"ls.peaks, exact, {number:,} crank-rockers", partial(ls.peaks, rockers), size, goal=1.7),
        _row(f"ls.peaks, {designs:,} designs", partial(ls.peaks, many, theta2=size.turn), size, samples),
        _row(f"ls.sweep, {designs:,} designs", partial(ls.sweep, many, size.turn, of=NINE), size, samples),
        _row("ls.sweep, a million angles", partial(ls.sweep, one, long, of=NINE), size, long, goal=1.7),
        _arithmetic(size, designs),
        _memory(size, long),
    ]


def _arithmetic(size: Size, number: int) -> Row:
    """Return what a second thread can gain where arithmetic alone counts: the peaks of these designs, by limit.c."""
    designs, peaks = batch(number, *ALL), []

    def bind(lib: CDLL, threads: int) -> Call:
        call, (values, _) = limit.bind_peaks(lib, designs, size.turn, threads)
        peaks.append(values)
        return call

    row = _row_in_c(f"limit.c, peaks of {number:,} designs", bind, size, number * size.turn)
    return replace(row, error=float(np.max(np.abs(peaks[1] - peaks[0])))) if peaks else row


def _memory(size: Size, angles: int) -> Row:
    """Return what a second thread can gain where memory alone counts: the bytes of that sweep, moved in C."""
    row = _row_in_c("its bytes moved in C", partial(limit.bind_move, n_angles=angles), size, angles)
    if row.seconds is None:
        return row
    rates = " and ".join(f"{8e-9 * (9 + 3) * angles / seconds:.0f}" for seconds in (row.against_seconds, row.seconds))
    return replace(row, note=f"{rates} GB/s")


def _row_in_c(job: str, bind: Callable[..., Call], size: Size, samples: int) -> Row:
    alone, both = f"{job}, 1 thread", f"{job}, 2 threads"
    lib = limit.build()
    if cores() < 2 or not lib:
        return Row(both, alone, FASTER, note="not measured: one core only, or no C compiler found")
    calls = {name: bind(lib, threads=threads) for name, threads in ((alone, 1), (both, 2))}
    return race(calls, size, samples, perf_counter).row(FASTER, both, alone)


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
