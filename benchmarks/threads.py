"""One thread and two: the same bits, sooner."""

from __future__ import annotations

from functools import partial
from time import perf_counter

import numpy as np
import xarray as xr

import linksweep as ls

from .cases import ALL, GENERAL, NINE, Size, batch, scene
from .kernel import way
from .timing import FASTER, Call, Row, cores, race


def rows(size: Size) -> list[Row]:
    many, one = scene(batch(size.designs, *ALL)), scene(GENERAL)
    return [
        _row("ls.peaks", partial(ls.peaks, many, theta2=size.turn), size, size.designs * size.turn),
        _row("ls.sweep, many designs", partial(ls.sweep, many, size.turn, NINE), size, size.designs * size.turn),
        _row("ls.sweep, one design", partial(ls.sweep, one, size.angles, NINE), size, size.angles),
    ]


def _row(job: str, call: Call, size: Size, samples: int) -> Row:
    alone, both = f"{job}, 1 thread", f"{job}, 2 threads"
    if cores() < 2:
        return Row(both, alone, FASTER, note="not measured: one core only")
    calls = {alone: partial(call, threads=1), both: partial(call, threads=2)}
    with way("compiled"):
        error = _difference(calls[both](), calls[alone]())
        return race(calls, size, samples, perf_counter).row(FASTER, both, alone, error=error)


def _difference(found: xr.Dataset, expected: xr.Dataset) -> float:
    """Largest difference of any variable; 0 when they agree bit for bit."""
    return max(float(np.max(np.abs(found[name].values - expected[name].values))) for name in expected.data_vars)
