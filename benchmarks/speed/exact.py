"""Time exact peaks of many designs against grids of samples and against numpy + LAPACK."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import partial

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.cases import ALL, GENERAL, LENGTHS, Size, batch, few, scene
from benchmarks.rivals import peers
from benchmarks.speed import fresh
from benchmarks.speed.kernel import kernel_of, way
from benchmarks.timing import FASTER, SHARE, Race, Row, race

EXACT = "ls.peaks, exact"
FORCES = ("F12", "F32", "F43", "F14", "T12")


def rows(size: Size) -> list[Row]:
    with way("compiled"):
        return [
            *_grids(size, 20.0, {720: 1.0, 360: 1.0}),
            *_grids(size, 0.0, {1440: 1.0}),
            _lapack(size),
            *_shared(size),
            _screening(size),
            _memory("ls.peaks", "ls.peaks(exact.crank_rockers({designs}, 0.0))", size, 1.0),
            _memory("ls.screen", "exact.screening({designs})", size, 0.5),
        ]


def crank_rockers(count: int, least_transmission_angle: float, seed: int = 1) -> ls.Scene:
    """Return random crank-rockers, each number different in each design, above a transmission angle [degree]."""
    rng = np.random.default_rng(seed)
    a, b, c, d = np.concatenate(list(_lengths(rng, count, least_transmission_angle)), axis=1)[:, :count]
    links = [design_link(rng, length) for length in (a, b, c)]
    mechanism = ls.FourBar(*links, ground=over_designs(d))
    speed, acceleration = rng.uniform(1.0, 30.0, count), rng.uniform(-20.0, 20.0, count)
    return ls.Scene(mechanism, over_designs(speed), over_designs(acceleration), gravity=(0.0, -9.81))


def _lengths(rng: np.random.Generator, count: int, least: float) -> Iterator[np.ndarray]:
    accepted = 0
    while accepted < count:
        lengths = np.sort(rng.uniform(0.05, 1.0, (4 * count, 4)), axis=1)
        a, longest = lengths[:, 0], lengths[:, 3]
        b, c, d = rng.permuted(lengths[:, 1:], axis=1).T
        grashof = a + longest < lengths[:, 1] + lengths[:, 2]
        good = grashof & (np.minimum(_transmission(b, c, d - a), _transmission(b, c, d + a)) > least)
        accepted += good.sum()
        yield np.stack([a, b, c, d])[:, good]


def _transmission(b: np.ndarray, c: np.ndarray, diagonal: np.ndarray) -> np.ndarray:
    """Return the acute angle between coupler and rocker [degree], by the cosine rule."""
    angle = np.degrees(np.arccos(np.clip((b * b + c * c - diagonal**2) / (2.0 * b * c), -1.0, 1.0)))
    return np.minimum(angle, 180.0 - angle)


def design_link(rng: np.random.Generator, length: np.ndarray) -> ls.Link:
    n = len(length)
    mass, fraction = rng.uniform(0.2, 3.0, n), rng.uniform(0.05, 0.2, n)
    distance, angle = length * rng.uniform(0.0, 1.0, n), rng.uniform(-60.0, 60.0, n)
    return ls.Link(*map(over_designs, (length, mass, mass * length**2 * fraction, distance, angle)))


def over_designs(values: np.ndarray) -> xr.DataArray:
    return xr.DataArray(values, dims="design")


def _grids(size: Size, least: float, goals: dict[int, float]) -> list[Row]:
    """Time exact peaks against the largest of n samples; the note states how far samples fall short."""
    designs = crank_rockers(100 * size.designs, least)
    population = f"transmission angle above {least:g}°" if least else "all crank-rockers"
    calls = {EXACT: partial(ls.peaks, designs, threads=1)}
    calls |= {_grid(n): partial(ls.peaks, designs, theta2=n, threads=1) for n in goals}
    exact = calls[EXACT]()
    timed = race(calls, size)
    return [
        timed.row(
            SHARE, EXACT, _grid(n), goal, note=f"{population}; the grid errs by {_shortfall(calls[_grid(n)](), exact)}"
        )
        for n, goal in goals.items()
    ]


def _grid(count: int) -> str:
    return f"largest of {count} samples"


def _shortfall(grid: xr.Dataset, exact: xr.Dataset) -> str:
    worst = np.max([1.0 - grid[f"{name}_peak"].values / exact[f"{name}_peak"].values for name in FORCES], axis=0)
    return f"{np.median(worst):.0e} in the median, {np.max(worst):.0e} at worst"


def _lapack(size: Size) -> Row:
    """Time per design; ours with a hundred times as many, for theirs would take a minute per round."""
    lapack = "numpy + LAPACK, 720 samples"
    calls = {
        EXACT: partial(ls.peaks, scene(batch(100 * size.designs, *ALL)), threads=1),
        lapack: partial(peers.numpy_lapack_peaks, batch(size.designs, *ALL), size.turn),
    }
    timed = race(calls, size)
    fair = Race({EXACT: [seconds / 100.0 for seconds in timed.seconds[EXACT]], lapack: timed.seconds[lapack]})
    return fair.row(FASTER, EXACT, lapack, 400, note=f"times for {size.designs} designs")


def _shared(size: Size) -> list[Row]:
    """Time a thousand masses, or speeds, of one geometry against a thousand geometries.

    Exact peaks share the kinematics of the samples, but not that of the trials about a peak: each design has its own.
    The largest of samples is computed as sums of a few cycles.
    """
    jobs = {name: scene(batch(size.designs, *numbers)) for name, numbers in SHARED.items()}
    exact = {f"{size.designs} {name}": partial(ls.peaks, job, threads=1) for name, job in jobs.items()}
    sums = {
        f"{size.designs} {name}, {_grid(size.turn)}, superposed": partial(
            ls.peaks, job, theta2=size.turn, threads=1, solver="superposed"
        )
        for name, job in jobs.items()
    }
    kernels = {f"{name}: kernel": kernel_of(call).call for name, call in sums.items()}
    goals = ((exact, (0.5, 0.3)), (sums, (0.35, 0.35)), (kernels, (0.35, 0.35)))
    return [row for calls, goal in goals for row in _against_first(race(calls, size), goal)]


SHARED = {"geometries": LENGTHS, "masses": ("m3",), "speeds": ("omega2",)}
"""Numbers that differ between designs."""


def _against_first(timed: Race, goals: Iterable[float | None]) -> list[Row]:
    theirs, *ours = timed.seconds
    return [timed.row(SHARE, name, theirs, goal) for name, goal in zip(ours, goals, strict=True)]


MAY_BE = {"coupler.length": (0.20, 0.24), "rocker.length": ls.Normal(0.18, 1e-3), "omega2": (20.0, 30.0)}


def screening(designs: int) -> xr.Dataset:
    """Screen designs of the general four-bar."""
    return ls.screen(scene(GENERAL), MAY_BE, n=designs, minimize=["F32_peak", "T12_peak"], threads=1)


def _screening(size: Size) -> Row:
    """Compare a screening with the peaks of the same designs, drawn before."""
    count = 100 * size.designs
    drawn = ls.draw(scene(GENERAL), MAY_BE, designs=range(count))
    ours, theirs = "ls.screen, designs drawn by it", "ls.peaks of the same designs"
    calls = {ours: partial(screening, count), theirs: partial(ls.peaks, drawn, ["F32", "T12"], threads=1)}
    return race(calls, few(size), count).row(SHARE, ours, theirs)


IN_ALL = """
import linksweep as ls
from benchmarks.speed import exact
from benchmarks.speed import growth
{call}
print(growth.peak_memory())
"""


def _memory(name: str, call: str, size: Size, goal: float) -> Row:
    """Measure the largest memory of a fresh process that computes a million designs [GB]."""
    designs = 1000 * size.designs
    code = IN_ALL.format(call=call.format(designs=designs))
    return Row(f"{name} of {designs:,} designs", "", "GB in all", float(fresh.python("-c", code)), goal=goal)
