"""Measure run time against error, method by method: unknowns and rates of one four-bar by linksweep and by others.

Errors are against 50 digits: of forces, relative to each sample's largest force (for the torque, at the longest link);
of rates, to the largest value. They are measured at angles of a revolution, and for methods that take any angle also
down to 1e-6 rad from a toggle. Speed is constant, as programs that step through time know no other way to come round.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace
from functools import partial
from importlib import import_module
from time import process_time
from typing import NamedTuple

import numpy as np

import linksweep as ls
from benchmarks.accuracy import truth
from benchmarks.cases import GENERAL, NINE, Size, few, scene, stacked
from benchmarks.rivals import Bound, limit, peers
from benchmarks.rivals.peers import Array, Design
from benchmarks.speed.kernel import kernel_of, way
from benchmarks.timing import Call, Race, Row, race

TIMES = "times the time"
OURS, KERNEL, RATES = "ls.sweep", "its kernel alone", "ls.sweep, rates"
DENSE, REFINED = "ls.sweep, solver='dense'", "ls.sweep, solver='refined'"
LINKSWEEP = (OURS, KERNEL, DENSE, REFINED, RATES)
NEAR = "near a toggle"

STEADY = replace(GENERAL, alpha2=0.0)
TOGGLE = replace(STEADY, b=STEADY.c + (STEADY.d - STEADY.a) * (1.0 - 1e-12))
"""Four-bar whose coupler and rocker lie within 1e-6 rad of one line where the crank is at 0."""
NEARBY = np.concatenate([-np.geomspace(10.0, 1e-8, 28), [0.0], np.geomspace(1e-8, 10.0, 28)])
"""Crank angles about that near-toggle [degree]."""

Bind = Callable[[Design, Array], Bound]


class Method(NamedTuple):
    """A method: how to bind it, the error allowed over a revolution, whether it takes any angle (then it is tested near
    a toggle), and the most angles it is timed with."""

    bind: Bind
    allowed: float = 1e-10
    any_angle: bool = True
    most: int | None = None


class Measured(NamedTuple):
    """A call to be timed, its number of angles, and its errors."""

    call: Call
    angles: int
    error: float
    near: float | None


def rows(size: Size) -> list[Row]:
    with way("compiled"):
        return [*_rows(NINE_BY, OURS, size), *_rows(RATES_BY, RATES, size)]


def _rows(methods: dict[str, Method], against: str, size: Size) -> list[Row]:
    """Return a row per method, time per angle against ours; a method that fails says so."""
    measured: dict[str, Measured | str] = {}
    for name, method in methods.items():
        try:
            measured[name] = _measured(method, size)
        except Exception as problem:  # another program may raise anything: its row states it, the others are measured
            if name in LINKSWEEP:
                raise
            measured[name] = f"not measured: {str(problem).splitlines()[0]}"
    there = {name: one for name, one in measured.items() if isinstance(one, Measured)}
    raced = race({name: one.call for name, one in there.items()}, few(size), clock=process_time)
    each = Race({name: [s / one.angles for s in raced.seconds[name]] for name, one in there.items()}, samples=1)
    return [
        _row(each, name, against, there[name], method.allowed)
        if name in there
        else Row(name, against, TIMES, note=str(measured[name]))
        for name, method in methods.items()
    ]


def _row(each: Race, name: str, against: str, one: Measured, allowed: float) -> Row:
    figures = {} if one.near is None else {NEAR: one.near}
    return each.row(TIMES, name, against, error=one.error, allowed=allowed, figures=figures)


def _measured(method: Method, size: Size) -> Measured:
    theta2 = peers.grid(min(size.angles, method.most or size.angles))
    checked = np.linspace(0, len(theta2), size.checked, endpoint=False, dtype=int)
    call, read = method.bind(STEADY, theta2)
    error = _error(STEADY, theta2[checked], read(call())[:, checked])
    return Measured(call, len(theta2), error, _near(method) if method.any_angle else None)


def _near(method: Method) -> float:
    call, read = method.bind(TOGGLE, NEARBY)
    return _error(TOGGLE, NEARBY, read(call()))


def _error(q: Design, theta2: Array, values: Array) -> float:
    """Return the largest error of all samples."""
    if len(values) == len(truth.RATES):
        return peers.difference(values, truth.rates(q, theta2))
    exact = truth.unknowns(q, theta2)
    force = np.hypot(exact[0:8:2], exact[1:8:2]).max(axis=0)
    torque = np.maximum(force * max(q.a, q.b, q.c, q.d), np.abs(exact[8]))
    return float(np.max(np.abs(values - exact) / np.stack([force] * 8 + [torque])))


# ------------------------------------------------------------------------------------------------ methods


def _sweep(q: Design, theta2: Array, of: tuple[str, ...] = NINE, **how) -> Bound:
    even = np.array_equal(theta2, peers.grid(len(theta2)))
    angles = len(theta2) if even else theta2
    return Bound(partial(ls.sweep, scene(q), angles, of=of, threads=1, **how), lambda cycle: stacked(cycle, of))


def _kernel(q: Design, theta2: Array) -> Bound:
    """Bind the kernel that ls.sweep runs; its result is read from ls.sweep."""
    sweep, read = _sweep(q, theta2)
    answer = read(sweep())
    return Bound(kernel_of(sweep).call, lambda _: answer)


def _limit(q: Design, theta2: Array) -> Bound:
    lib = limit.build()
    if lib is None:
        raise ImportError("no C compiler found")
    call, out = limit.bind_store(lib, q, theta2)
    return Bound(call, lambda _: out)


def _numpy(nine: Callable[[Design, Array], Array]) -> Bind:
    return lambda q, theta2: Bound(partial(nine, q, theta2))


def _single(nine: Callable[[Design, Array], Array]) -> Bind:
    """Bind a method in single precision (24 bits)."""

    def bind(q: Design, theta2: Array) -> Bound:
        halved = Design(**{f.name: np.float32(getattr(q, f.name)) for f in fields(q)})
        return Bound(partial(nine, halved, theta2.astype(np.float32)))

    return bind


def _rival(module: str) -> Bind:
    """Bind a rival, imported only when measured, for its package may be missing."""
    return lambda q, theta2: import_module(f"benchmarks.rivals.{module}").bind(q, theta2)


NINE_BY = {
    OURS: Method(_sweep),
    KERNEL: Method(_kernel),
    DENSE: Method(partial(_sweep, solver="dense")),
    REFINED: Method(partial(_sweep, solver="refined")),
    "limit.c": Method(_limit),
    "numpy closed form": Method(_numpy(peers.numpy_closed_form)),
    "numpy + LAPACK": Method(_numpy(peers.numpy_lapack)),
    "numpy closed form, float32": Method(_single(peers.numpy_closed_form), 1e-3, False),
    "numpy + LAPACK, float32": Method(_single(peers.numpy_lapack), 1e-3, False),
    "numba, 9×9 by angle": Method(_rival("numba_dense")),
    "JAX, jit + vmap 9×9": Method(_rival("jax_dense")),
    "exudyn, 720 steps": Method(_rival("exudyn_nine"), 2e-2, False, 720),
    "exudyn, 7200 steps": Method(_rival("exudyn_nine"), 2e-2, False, 7200),
    "KinePy, 720 samples": Method(_rival("kinepy_nine"), 2e-2, False, 720),
}
RATES_BY = {
    RATES: Method(partial(_sweep, of=truth.RATES)),
    "pylinkage, 720 steps": Method(_rival("pylinkage_rates"), 1e-8, False, 720),
    "mechanism": Method(_rival("mechanism_rates"), 1e-6, False, 72),
}
