"""Pass numbers of every dtype in every place: the scene must equal that of the values in float64, to the bit."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.attacks import Outcome
from linksweep.scene.parameters import free, replaced
from linksweep.studies.job import scene_digest

TITLE = "numbers of every dtype, alone and in arrays, are float64 of the same values"
ROUNDS = 2000
SMALL = 12

Random = np.random.Generator
DTYPES = ("f2", "f4", "f8", ">f4", ">f8", "longdouble", "i1", "i2", "i4", "i8", ">i2", "u1", "u2", "u4", "u8")


def attack(random: Random, rounds: int) -> Outcome:
    failures = []
    for k in range(rounds):
        machine = (four_bar, engine, quick_return, loop)[k % 4]()
        expected, other = _in_dtypes(random, machine)
        failures += [f"round {k}: {failure}" for failure in _differences(expected, other)]
    return Outcome(rounds, failures)


def _in_dtypes(random: Random, scene: ls.Scene) -> tuple[ls.Scene, ls.Scene]:
    """Return a scene of random numbers in float64, and one of the numbers each in a dtype of its own."""
    expected, other = {}, {}
    for path, (value, _) in free(scene).items():
        if isinstance(value, float):
            dtype = np.dtype(random.choice(DTYPES))
            expected[path], other[path] = _drawn(random, value, dtype)
    return replaced(scene, expected), replaced(scene, other)


def _drawn(random: Random, value: float, dtype: np.dtype) -> tuple[Any, Any]:
    """Return a number, or an array, near a value: in float64, and in a dtype that holds it, too."""
    step = 0.0625 if dtype.kind == "f" else 1.0  # of the coarsest float there is, below 128
    size = () if random.integers(2) else (2,)
    values = (abs(value) if dtype.kind == "u" else value) + step * random.integers(0, 3, size)
    if size:
        return xr.DataArray(values, dims="design"), xr.DataArray(values.astype(dtype), dims="design")
    return float(values), np.asarray(values).astype(dtype)[()]


def _differences(expected: ls.Scene, other: ls.Scene) -> Iterator[str]:
    narrow = [path for path, (value, _) in free(other).items() if value is not None and not _is_float64(value)]
    yield from (f"{path} is not float64" for path in narrow)
    if other != expected or hash(other) != hash(expected) or scene_digest(other) != scene_digest(expected):
        yield "scenes of equal numbers are not equal"
    if not ls.sweep(other, 8).identical(ls.sweep(expected, 8)):
        yield "sweeps of equal numbers are not identical"


def _is_float64(value: Any) -> bool:
    return type(value) is float or getattr(value, "dtype", None) == np.dtype("=f8")


def four_bar() -> ls.Scene:
    """Return a scene with every kind of link and load, its numbers small integers."""
    bar, disk = ls.Bar(2, 1, 1, 3), ls.Disk(15, 1, 1, 3)
    press = ls.FourBar(bar, ls.Link(16, 5, 7, 3, 15), disk, ground=14, ground_angle=10)
    loads = (
        ls.Load("coupler", force=(3, -80), at=(2, 15), torque=-12, breaks=[10]),
        ls.Spring(("ground", 3, 1), ("rocker", 2, 15), rate=20, free_length=1),
        ls.Damper(("crank", 1, 20), ("rocker", 2, 15), coefficient=3),
        ls.TorsionSpring("ground", "rocker", rate=5, free_angle=90),
        ls.TorsionDamper("crank", "coupler", coefficient=2),
    )
    return ls.Scene(press, omega2=3, alpha2=1, gravity=(0, -10), loads=loads)


def engine() -> ls.Scene:
    """Return an engine with a cycle, its numbers small integers."""
    mechanism = ls.SliderCrank(ls.Link(2, 3, 4), ls.Link(16, 5, 7, 3), slider_mass=2, offset=1, slide_angle=90)
    gas = ls.GasPressure(bore=1, pressure=ls.DieselCycle(9, 2, intake_pressure=100, gamma=2), crankcase=90)
    return ls.Scene(mechanism, omega2=30, loads=[gas])


def quick_return() -> ls.Scene:
    """Return an inverted slider-crank, its numbers small integers."""
    mechanism = ls.InvertedSliderCrank(ls.Link(4, 3, 4), ls.Link(20, 5, 7, 3), ground=16, block_mass=1, offset=1)
    return ls.Scene(mechanism, omega2=5, gravity=(1, -10), loads=[ls.Load("rocker", torque=-12)])


def loop() -> ls.Scene:
    """Return a car in a loop, its numbers small integers."""
    return ls.Scene(ls.LoopTrack(radius=30, mass=70), speed=100, thrust=100, gravity=(0, -10))
