"""Time peaks of many designs, each number different in each: four pin forces, largest and smallest torque."""

from __future__ import annotations

from functools import partial

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.cases import ALL, Size, batch, scene
from benchmarks.rivals import limit, peers
from benchmarks.rivals.peers import Array
from benchmarks.speed.kernel import kernel_of, way
from benchmarks.timing import FASTER, SHARE, Row, race

PEAKS, KERNEL, LAPACK, C = "ls.peaks", "kernel alone", "numpy + LAPACK", "limit.c"
NAMES = ("F12_peak", "F32_peak", "F43_peak", "F14_peak", "T12_max", "T12_min")


def rows(size: Size) -> list[Row]:
    designs = batch(size.designs, *ALL)
    peaks = partial(ls.peaks, scene(designs), theta2=size.turn, threads=1)
    calls = {
        PEAKS: peaks,
        KERNEL: kernel_of(peaks).call,
        LAPACK: partial(peers.numpy_lapack_peaks, designs, size.turn),
    }
    with way("compiled"):
        expected = peers.numpy_lapack_peaks(designs, size.turn)[0]
        ours = difference(columns(peaks()), expected)
        error = {PEAKS: ours, KERNEL: ours}
        if lib := limit.build():
            calls[C], (values, _) = limit.bind_peaks(lib, designs, size.turn)
            calls[C]()
            error[C] = difference(values, expected)
        timed = race(calls, size, size.designs * size.turn)

    def row(kind: str, ours: str, theirs: str, goal: float | None = None) -> Row:
        return timed.row(kind, ours, theirs, goal, error=error.get(ours))

    return [
        row(FASTER, PEAKS, LAPACK, 200),
        row(FASTER, KERNEL, LAPACK),
        row(SHARE, KERNEL, C, 0.8),
        row(FASTER, C, LAPACK),
    ]


def columns(peaks_ds: xr.Dataset) -> Array:
    """Return a result of ls.peaks in the form of limit.c and peers.py: (designs, 6)."""
    return np.stack([peaks_ds[name].values for name in NAMES], axis=-1)


def difference(values: Array, expected: Array) -> float:
    """Return the largest difference of peaks: a force relative to itself, a torque to the largest of its design."""
    scale = np.abs(expected)
    scale[:, 4:] = scale[:, 4:].max(axis=1, keepdims=True)
    return float(np.max(np.abs(values - expected) / scale))
