"""Measure peaks of random crank-rockers, run time against error: exact peaks, and the largest of 90 … 5760 samples.

The error of a design is that of its worst peak, among four pin forces and the torque, against 50 digits. The error of a
grid does not depend on who evaluates it: it is measured once, by linksweep.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import inf

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.accuracy import truth
from benchmarks.accuracy.solves import TIMES
from benchmarks.cases import Size, few
from benchmarks.rivals import limit, peers
from benchmarks.rivals.peers import Array, Design
from benchmarks.speed.exact import EXACT, crank_rockers
from benchmarks.speed.kernel import way
from benchmarks.timing import Call, Race, Row, race

SAMPLES = (90, 180, 360, 720, 1440, 2880, 5760)
PEAKS = ("F12_peak", "F32_peak", "F43_peak", "F14_peak", "T12_peak")
MEDIAN, MOST, WORST = "median", "99 %", "worst"
POPULATIONS = {"transmission angle above 20°": 20.0, "any transmission angle": 0.0}
"""Least transmission angle of a population [degree], by name."""
MANY, LAPACK_DESIGNS, NUMPY_DESIGNS, CACHED = 5, 10, 80, 7200
"""Designs timed by compiled code per design checked; designs timed by LAPACK and by numpy, which are slower; samples
that numpy computes at a time, as suits its cache."""


def rows(size: Size) -> list[Row]:
    with way("compiled"):
        return [row for name, least in POPULATIONS.items() for row in _rows(name, least, size)]


def _rows(population: str, least: float, size: Size) -> list[Row]:
    checked, many = crank_rockers(size.population, least), crank_rockers(MANY * size.population, least)
    errors = _errors(_ours(checked), truth.peaks(design(checked)))
    calls = _ours(many)
    count = dict.fromkeys(calls, MANY * size.population)
    for n in SAMPLES:
        for name, (count[name], calls[name]) in _others(design(many), n).items():
            errors[name] = errors[f"ls.peaks, {n} samples"]
    timed = race(calls, few(size))
    each = Race({name: [s / count[name] for s in seconds] for name, seconds in timed.seconds.items()})
    return [_row(each, name, population, errors[name]) for name in calls]


def _row(each: Race, name: str, population: str, errors: dict[str, float]) -> Row:
    allowed = 1e-10 if name == EXACT else inf
    figures = {MEDIAN: errors[MEDIAN], MOST: errors[MOST]}
    return each.row(TIMES, name, EXACT, error=errors[WORST], note=population, allowed=allowed, figures=figures)


def _errors(calls: dict[str, Call], exact: Array) -> dict[str, dict[str, float]]:
    errors = {}
    for name, call in calls.items():
        short = np.abs(_columns(call()) / exact - 1.0).max(axis=0)
        errors[name] = {MEDIAN: np.median(short), MOST: np.quantile(short, 0.99), WORST: short.max()}
    return errors


def _columns(peaks: xr.Dataset) -> Array:
    return np.stack([peaks[name].values for name in PEAKS])


def _ours(scene: ls.Scene) -> dict[str, Call]:
    grids = {f"ls.peaks, {n} samples": partial(ls.peaks, scene, theta2=n, threads=1) for n in SAMPLES}
    return {EXACT: partial(ls.peaks, scene, threads=1)} | grids


def _others(q: Design, n: int) -> dict[str, tuple[int, Call]]:
    """Return each rival's call, with the number of designs it takes."""
    lib = limit.build()
    c = {f"limit.c, {n} samples": (len(q.a), limit.bind_peaks(lib, q, n)[0])} if lib else {}
    return c | {
        f"numpy closed form, {n} samples": _numpy(peers.numpy_closed_form, q[:NUMPY_DESIGNS], n),
        f"numpy + LAPACK, {n} samples": _numpy(peers.numpy_lapack, q[:LAPACK_DESIGNS], n),
    }


def _numpy(nine: Callable[[Design, Array], Array], q: Design, n: int) -> tuple[int, Call]:
    return len(q.a), partial(peers.numpy_peaks, q, n, nine, max(1, CACHED // n))


def design(scene: ls.Scene) -> Design:
    """Return a scene of four-bars as `peers` takes it: numbers are columns."""
    bars = scene.mechanism
    links = bars.crank, bars.coupler, bars.rocker
    words = {"length": "abc", "mass": ("m2", "m3", "m4"), "inertia": ("I2", "I3", "I4"), "cg_distance": "spu"}
    words["cg_angle"] = ("delta2", "delta3", "delta4")
    numbers = {
        name: _column(getattr(link, word))
        for word, names in words.items()
        for name, link in zip(names, links, strict=True)
    }
    gx, gy = scene.gravity
    motion = {"omega2": _column(scene.omega2), "alpha2": _column(scene.alpha2), "gx": gx, "gy": gy}
    return Design(**numbers, d=_column(bars.ground), **motion, sign=1.0 if bars.branch == "open" else -1.0)


def _column(values: xr.DataArray) -> Array:
    return values.values[:, None]
