"""Time exact peaks of designs near toggles, of partial turns, and of forces that jump or follow a table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.accuracy.missed import FAMILIES, shortfall
from benchmarks.cases import Size, few
from benchmarks.speed.exact import crank_rockers, design_link, over_designs
from benchmarks.speed.kernel import way
from benchmarks.timing import OWN, WALL, Race, Row, timed
from linksweep.results.peak_search.limits import limits_of

GOAL = 10e-6
"""Time of a design [s] whose slider rubs, or whose crank moves over part of a turn."""
WITH_GOAL = "part of a turn", "friction in the guide"
SAMPLES = 360
GRID = f"largest of {SAMPLES} samples"

Population = Callable[[int], ls.Scene]


def rows(size: Size) -> list[Row]:
    with way("compiled"):
        many = [_row(name, machines, 10 * size.designs, size) for name, machines in MANY.items()]
        return many + [_row(name, machines, size.designs, size) for name, machines in FEW.items()]


def _row(name: str, machines: Population, designs: int, size: Size) -> Row:
    """Time designs that the process meets for the first time, its kernels compiled."""
    calls = {name: ls.peaks, GRID: partial(ls.peaks, theta2=SAMPLES)}
    exact, samples = (call(machines(designs)) for call in calls.values())
    rounds = [
        {job: timed(partial(call, _anew(machines, designs), threads=1), OWN) for job, call in calls.items()}
        for _ in range(few(size).rounds)
    ]
    race = Race({job: [seconds[job] for seconds in rounds] for job in calls}, designs)
    goal = GOAL * designs if name.endswith(WITH_GOAL) else None
    error, note = float(np.max(shortfall(exact, samples))), f"{designs:,} designs"
    return race.row(WALL, name, GRID, goal, error=error, note=note)


def _anew(machines: Population, designs: int) -> ls.Scene:
    """Return a scene about whose designs nothing is known: their limits are kept for a while."""
    limits_of.cache_clear()
    return machines(designs)


# ------------------------------------------------------------------------------------- four-bars and slider-cranks


def rocking_four_bars(count: int) -> ls.Scene:
    """Return random four-bars whose coupler and rocker reach less far than crank and ground together."""
    rng = np.random.default_rng(4)
    a, b, c, share = rng.uniform(0.5, 1.0, (4, count))
    links = (design_link(rng, length) for length in (a, b, c))
    return ls.Scene(ls.FourBar(*links, over_designs(b + c - a * share)), 10.0, gravity=(0.0, -9.81))


def rocking_slider_cranks(count: int) -> ls.Scene:
    """Return random slider-cranks whose rod is shorter than their crank."""
    rng = np.random.default_rng(5)
    crank = rng.uniform(0.5, 1.0, count)
    links = design_link(rng, crank), design_link(rng, crank * rng.uniform(0.4, 0.9, count))
    offset = crank * rng.uniform(-0.2, 0.2, count)
    mechanism = ls.SliderCrank(*links, over_designs(rng.uniform(0.2, 2.0, count)), over_designs(offset))
    return ls.Scene(mechanism, 10.0, gravity=(0.0, -9.81))


def rubbing_slider_cranks(count: int) -> ls.Scene:
    """Return random slider-cranks with friction in the guide and a constant force on the slider."""
    rng = np.random.default_rng(3)
    crank = rng.uniform(0.03, 0.06, count)
    numbers = rng.uniform(0.2, 2.0, count), crank * rng.uniform(-0.3, 0.3, count), rng.uniform(0.02, 0.2, count)
    links = design_link(rng, crank), design_link(rng, crank * rng.uniform(2.5, 4.5, count))
    push = ls.Load("slider", tuple(map(over_designs, rng.uniform(-50.0, 50.0, (2, count)))))
    mechanism = ls.SliderCrank(*links, *map(over_designs, numbers))
    return ls.Scene(mechanism, over_designs(rng.uniform(1.0, 30.0, count)), 5.0, (0.0, -9.81), [push])


def pushed_four_bars(count: int) -> ls.Scene:
    """Return random crank-rockers with a table of a torque over theta2 that all share."""
    angles = np.arange(0.0, 360.0, 5.0)
    push = xr.DataArray(-300.0 * np.exp(-(((angles - 180.0) / 40.0) ** 2)), {"theta2": angles}, "theta2")
    return replace(crank_rockers(count, 20.0), loads=(ls.Load("rocker", torque=push),))


def unsteady_four_bars(count: int) -> ls.Scene:
    """Return random crank-rockers whose speed changes with theta2 alike."""
    return replace(crank_rockers(count, 20.0), omega2=lambda theta2: 10.0 + 3.0 * np.sin(np.radians(theta2)))


def family(name: str) -> Population:
    """Return random machines as `benchmarks.accuracy.missed` draws them: half of them near a toggle."""
    return lambda count: FAMILIES[name].scene(np.random.default_rng(1), count)


# ----------------------------------------------------------------------------------------------------- linkages

LONGEST = {"watt-2": 1.0912693408, "knuckle-press": 3.1830424924, "jansen-leg": 1.0702868516}
"""Cranks with which examples just turn fully, in lengths of their own."""


def clear(random: np.random.Generator, count: int) -> np.ndarray:
    """Return cranks that turn fully, clear of toggles, in lengths of the longest one that turns."""
    return random.uniform(0.5, 0.9, count)


def near_toggle(random: np.random.Generator, count: int) -> np.ndarray:
    """Return cranks that turn fully, half of them shorter by 1e-7 to 1e-1 than the longest one."""
    return np.where(random.random(count) < 0.5, clear(random, count), 1.0 - 10.0 ** random.uniform(-7.0, -1.0, count))


def partial_turn(random: np.random.Generator, count: int) -> np.ndarray:
    """Return cranks that are too long to turn fully."""
    return random.uniform(2.0, 2.4, count)


def linkages(name: str, cranks: Callable[[np.random.Generator, int], np.ndarray]) -> Population:
    """Return an example with cranks and speeds of many designs."""

    def designs(count: int) -> ls.Scene:
        example, random = ls.example(name), np.random.default_rng(6)
        crank = example.mechanism.crank
        longer = replace(crank, length=over_designs(crank.length * LONGEST[name] * cranks(random, count)))
        speed = over_designs(random.uniform(1.0, 10.0, count))
        return replace(example, mechanism=replace(example.mechanism, crank=longer), omega2=speed)

    return designs


MANY = {
    "slider-cranks with friction in the guide": rubbing_slider_cranks,
    "slider-cranks, part of a turn": rocking_slider_cranks,
    "four-bars, part of a turn": rocking_four_bars,
    "four-bars, a table of a load that all share": pushed_four_bars,
    "four-bars, a table each, half near a toggle": family("four-bar with a table"),
    "four-bars, a function of the angle, half near a toggle": family("four-bar with a function"),
    "four-bars, speed changes with the angle": unsteady_four_bars,
}
"""Machines of which ten times as many designs are timed in one call."""
KINDS = {"clear of toggles": clear, "half near a toggle": near_toggle, "part of a turn": partial_turn}
FEW = {f"{name}, {kind}": linkages(name, cranks) for name in LONGEST for kind, cranks in KINDS.items()} | {
    "random Watt six-bars, half near a toggle": family("Watt six-bar"),
    "random presses with friction, half near a toggle": family("knuckle-joint press with friction"),
}
