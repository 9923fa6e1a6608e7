"""Define the benchmark's job for all rivals: one general four-bar, and batches, as peers.Design and as scenes.

No special case can be exploited: gravity in both axes, alpha2, centres of gravity off the lines of pins.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.rivals.peers import Array, Design, Number

NINE = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12")

GENERAL = Design(
    a=0.08, b=0.22, c=0.18, d=0.20,
    m2=0.25, m3=0.68, m4=0.55, I2=2.4e-4, I3=2.8e-3, I4=1.6e-3,
    s=0.03, p=0.12, u=0.07, delta2=70.0, delta3=12.0, delta4=-25.0,
    omega2=30.0, alpha2=50.0, gx=0.3, gy=-9.81,
)  # fmt: skip
LOADS = (
    ls.Load("coupler", force=(12.0, -80.0), at=(0.10, 15.0)),
    ls.Load("rocker", force=(-5.0, 20.0), at=(0.09, 0.0), frame="link", torque=-12.0),
)
LENGTHS = ("a", "b", "c", "d")
MASSES = ("m2", "m3", "m4", "I2", "I3", "I4")
ALL = (*LENGTHS, *MASSES, "s", "p", "u", "delta2", "delta3", "delta4", "omega2", "alpha2", "gx", "gy")


@dataclass(frozen=True)
class Size:
    """Size of a run: angles of one long sweep and of one turn, designs, rounds of timing; angles and random designs
    checked in 50 digits; how far growth is followed, and for how many requests."""

    angles: int = 72_000
    turn: int = 720
    designs: int = 1000
    batch: int = 100
    machines: int = 200_000
    rounds: int = 15
    burst: float = 0.03
    processes: int = 5
    checked: int = 180
    population: int = 1000
    largest_angles: int = 10_000_000
    largest_designs: int = 1_000_000
    requests: int = 7


FULL = Size()
QUICK = Size(
    angles=200,
    turn=72,
    designs=6,
    batch=3,
    machines=20,
    rounds=1,
    burst=0.0,
    processes=1,
    checked=6,
    population=4,
    largest_angles=100,
    largest_designs=1,
    requests=1,
)


def few(size: Size) -> Size:
    """Return the size with fewer rounds, for many rivals."""
    return replace(size, rounds=min(size.rounds, 5))


def batch(n_designs: int, *names: str) -> Design:
    """Return designs around the general one: each named number spread at random over 10 %; all remain crank-rockers."""
    rng = np.random.default_rng(2)
    spread = {name: getattr(GENERAL, name) * (1 + 0.1 * rng.random((n_designs, 1))) for name in names}
    return replace(GENERAL, **spread)


def scene(q: Design, loads: tuple[ls.Load, ...] = ()) -> ls.Scene:
    """Return the scene of a design; columns become DataArrays over `design`."""
    rows = ((q.a, q.m2, q.I2, q.s, q.delta2), (q.b, q.m3, q.I3, q.p, q.delta3), (q.c, q.m4, q.I4, q.u, q.delta4))
    links = (ls.Link(*map(_number, row)) for row in rows)
    mechanism = ls.FourBar(*links, ground=_number(q.d), branch="open" if q.sign > 0 else "crossed")
    gravity = (_number(q.gx), _number(q.gy))
    return ls.Scene(mechanism, _number(q.omega2), _number(q.alpha2), gravity, loads)


def _number(value: Number) -> float | xr.DataArray:
    return xr.DataArray(value[:, 0], dims="design") if isinstance(value, np.ndarray) else value


def stacked(cycle: xr.Dataset, names: tuple[str, ...] = NINE) -> Array:
    """Return variables of a sweep as one array (names, designs…, angles)."""
    return np.stack([cycle[name].values for name in names])
