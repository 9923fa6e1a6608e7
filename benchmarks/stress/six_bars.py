"""Random six-bars: exact peaks against the largest of many samples, and arcs against the status of many more.

    python -m benchmarks.stress.six_bars [--designs N] [--seed S] [--processes P] [--only WORD]

Half of the designs turn fully, both dyads coming near to a toggle by margins of 1e-7 to 1 of their lengths, anywhere in
the revolution; the others have any lengths. A peak is missed where a sample exceeds it by more than 1e-10 of it. Arcs
and jams are checked against the status of 36 000 samples. `--only "Jansen leg"` checks linkages of another topology.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from fractions import Fraction
from functools import partial
from multiprocessing import get_context
from time import perf_counter
from typing import NamedTuple

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.accuracy.missed import ALLOWED, shortfall
from benchmarks.stress.linkages.scene import scene_of
from benchmarks.stress.linkages.scenes import completed
from benchmarks.stress.linkages.sketch import Sketch
from benchmarks.stress.linkages.topologies import AWAY_FROM_TOGGLES, Family, Topology, shaper_with_two_slides

Array = np.ndarray
Random = np.random.Generator
Point = tuple[Array, Array]

SHAPER = AWAY_FROM_TOGGLES["shaper with two slides"].topology.text
SAMPLES, STATUS_SAMPLES = 5760, 36_000
AT_ONCE = 250
CANNOT_ASSEMBLE, TOGGLE, JAMMED = 1, 2, (4, 6)
"""Statuses of a sample."""
TURN = 2.0 * np.pi
RATIOS = ("1/2", "3/2", "-2/3", "-5/4")
COARSE = np.linspace(0.0, TURN, 720, endpoint=False)
"""Crank angles at which a design is laid out [rad]."""


class Result(NamedTuple):
    """Designs checked, those that move, missed peaks, the largest shortfall of a peak, designs with wrong arcs, and the
    time of the peaks [s]."""

    designs: int = 0
    moving: int = 0
    missed: int = 0
    shortfall: float = 0.0
    wrong_arcs: int = 0
    seconds: float = 0.0

    def __add__(self, other: Result) -> Result:  # type: ignore[override]
        return Result(*(max(a, b) if k == 3 else a + b for k, (a, b) in enumerate(zip(self, other, strict=True))))


# ---------------------------------------------------------------------------------------------- random designs


def watt(random: Random, n: int) -> ls.Scene:
    """Return Watt II six-bars: the second dyad on the rocker and the ground."""
    a, b, c, d = _four_bar(random, n)
    point = c * random.uniform(0.4, 1.6, n), random.uniform(-180.0, 180.0, n)
    branch = _branch(random)
    _, C = _positions(a, b, c, d, branch["C"])
    E = _on_link((d, 0.0 * d), C, c, point)
    text = "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F"
    return _six_bar(random, text, (a, b, c, d), point, E, branch)


def stephenson(random: Random, n: int) -> ls.Scene:
    """Return Stephenson III six-bars: the second dyad on the coupler and the ground."""
    a, b, c, d = _four_bar(random, n)
    point = b * random.uniform(0.4, 1.6, n), random.uniform(-180.0, 180.0, n)
    branch = _branch(random)
    B, C = _positions(a, b, c, d, branch["C"])
    E = _on_link(B, C, b, point)
    text = "crank A-B, coupler B-C-E, rocker D-C, rod E-F, output G-F"
    return _six_bar(random, text, (a, b, c, d), point, E, branch)


def slider(random: Random, n: int) -> ls.Scene:
    """Return four-bars whose rocker moves a slider by a rod."""
    a, b, c, d = _four_bar(random, n)
    point = c * random.uniform(0.4, 1.6, n), random.uniform(-180.0, 180.0, n)
    branch = _branch(random)
    _, C = _positions(a, b, c, d, branch["C"])
    E = _on_link((d, 0.0 * d), C, c, point)
    angle, through = random.uniform(-180.0, 180.0, n), _near(random, E)
    x, y = through
    height = (E[0] - x[:, None]) * -np.sin(np.radians(angle))[:, None]
    height = height + (E[1] - y[:, None]) * np.cos(np.radians(angle))[:, None]
    rod = np.nanmax(np.abs(height), axis=1, initial=0.0) * (1.0 + _margin(random, n)) + 1e-3
    rod = np.where(random.random(n) < 0.3, rod * random.uniform(0.3, 1.0, n), rod)
    machine = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, ram F on slide",
        ground={"A": (0.0, 0.0), "D": (_number(d), 0.0)},
        points={"E": (_number(point[0]), _number(point[1]))},
        guides={"slide": ls.Guide(through=(_number(x), _number(y)), angle=_number(angle))},
        branch=branch,
        crank=_link(random, a), coupler=_link(random, b), rocker=_link(random, c), rod=_link(random, rod),
        ram=ls.Slider(_number(random.uniform(0.2, 2.0, n))),
    )  # fmt: skip
    return _scene(random, n, machine, [ls.Load("ram", force=_pair(random, n))])


def geared(random: Random, n: int) -> ls.Scene:
    """Return geared five-bars of several turns; half of them turn fully, near toggles, the others have any lengths."""
    ratio = Fraction(random.choice(RATIOS))
    theta2 = np.linspace(0.0, ratio.denominator * TURN, 720 * ratio.denominator, endpoint=False)
    (a, e), (x, y) = np.exp(random.uniform(-1.0, 0.5, (2, n))), random.uniform(-3.0, 3.0, (2, n))
    phase = random.uniform(-180.0, 180.0, n)
    angle = float(ratio) * theta2 + np.radians(phase)[:, None]
    across, up = (z[:, None] + e[:, None] * of(angle) - a[:, None] * of(theta2) for z, of in ((x, np.cos), (y, np.sin)))
    left, right = _lengths_of_dyad(random, np.hypot(across, up))
    branch = {"C": random.choice(["open", "crossed"])}
    machine = ls.Linkage(
        f"crank A-B, wheel D-E : {ratio} crank, left B-C, right E-C",
        ground={"A": (0.0, 0.0), "D": (_number(x), _number(y))},
        gears={"wheel": ls.Gears(phase=_number(phase))},
        branch=branch,
        crank=_link(random, a), wheel=_link(random, e), left=_link(random, left), right=_link(random, right),
    )  # fmt: skip
    loads = [
        ls.Load("right", torque=_number(random.uniform(-10.0, 10.0, n))),
        ls.Load("left", force=_pair(random, n)),
    ]
    return _scene(random, n, machine, loads)


def any_linkage(family: Family, random: Random, n: int, rubs: bool = False) -> ls.Scene:
    """Return linkages of a topology, with springs, dampers and friction; all slides and slots rub where it `rubs`."""
    sketch = Sketch(random, n, rubs=rubs)
    family.topology.draw(sketch)
    return scene_of(completed(sketch, family))


def yoke_on_a_shaper(sketch: Sketch) -> None:
    """A shaper with two slides whose arm also moves a yoke: what rubs in the yoke presses on the slides."""
    shaper_with_two_slides(sketch)
    sketch.yoke("yoke", "rail", "E")


RUB_TWICE = {
    "scotch yoke": AWAY_FROM_TOGGLES["scotch yoke"],
    "shaper with two slides": AWAY_FROM_TOGGLES["shaper with two slides"],
    "yoke on a shaper": Family(Topology(f"{SHAPER}, yoke on rail past E", yoke_on_a_shaper)),
}
"""Families with dyads of two slides."""
KINDS: dict[str, Callable[[Random, int], ls.Scene]] = {"watt": watt, "stephenson": stephenson, "slider": slider}
OTHERS: dict[str, Callable[[Random, int], ls.Scene]] = {
    **{name: partial(any_linkage, family) for name, family in AWAY_FROM_TOGGLES.items()},
    "geared by a fraction": geared,
    **{f"{name}, both slides rub": partial(any_linkage, family, rubs=True) for name, family in RUB_TWICE.items()},
}
"""Any topologies, whose designs come near to toggles only by chance; and geared five-bars of several turns, near
toggles."""


def _six_bar(
    random: Random, text: str, lengths: Sequence[Array], point: Point, E: Point, branch: dict[str, str]
) -> ls.Scene:
    a, b, c, d = lengths
    n = len(a)
    x, y = _near(random, E)
    reach = np.hypot(E[0] - x[:, None], E[1] - y[:, None])
    rod, output = _lengths_of_dyad(random, reach)
    machine = ls.Linkage(
        text,
        ground={"A": (0.0, 0.0), "D": (_number(d), 0.0), "G": (_number(x), _number(y))},
        points={"E": (_number(point[0]), _number(point[1]))},
        branch=branch,
        crank=_link(random, a), coupler=_link(random, b), rocker=_link(random, c),
        rod=_link(random, rod), output=_link(random, output),
    )  # fmt: skip
    loads = [
        ls.Load("output", torque=_number(random.uniform(-10.0, 10.0, n))),
        ls.Load("coupler", force=_pair(random, n)),
    ]
    return _scene(random, n, machine, loads)


def _lengths_of_dyad(random: Random, reach: Array) -> tuple[Array, Array]:
    """Return the lengths of two links that close over distances (design, angle), some not over all of them."""
    n = len(reach)
    nearest, farthest = np.nanmin(reach, axis=1, initial=1e3), np.nanmax(reach, axis=1, initial=1e-3)
    total, difference = farthest * (1.0 + _margin(random, n)), nearest * (1.0 - _margin(random, n))
    some = random.random(n) < 0.3
    total = np.where(some, total * random.uniform(0.5, 1.0, n), total)
    difference = np.minimum(difference, 0.98 * total) * random.choice([-1.0, 1.0], n)
    return 0.5 * (total + difference), 0.5 * (total - difference)


def _four_bar(random: Random, n: int) -> tuple[Array, Array, Array, Array]:
    """Return crank, coupler, rocker and ground: half turn fully, the others have any lengths that close somewhere."""
    a, d = np.exp(random.uniform(-1.0, 1.0, (2, n)))
    difference = np.abs(d - a) * (1.0 - _margin(random, n)) * random.choice([-1.0, 1.0], n)
    total = (d + a) * (1.0 + _margin(random, n))
    b, c = 0.5 * (total + difference), 0.5 * (total - difference)
    any_b, any_c = np.exp(random.uniform(-1.0, 1.0, (2, n)))
    lengths = np.where(random.random(n) < 0.5, (a, b, c, d), (a, any_b, any_c, d))
    longest = lengths.max(axis=0)
    return tuple(np.minimum(lengths, 0.98 * (lengths.sum(axis=0) - longest)))


def _positions(a: Array, b: Array, c: Array, d: Array, branch: str) -> tuple[Point, Point]:
    """Return pins B and C at the coarse angles, NaN where the four-bar does not close."""
    a, b, c, d = (length[:, None] for length in (a, b, c, d))
    B = a * np.cos(COARSE), a * np.sin(COARSE)
    x, y = d - B[0], -B[1]
    f = np.hypot(x, y)
    along = (f * f + b * b - c * c) / (2.0 * f)
    with np.errstate(invalid="ignore"):
        across = np.sqrt(b * b - along * along) * (1.0 if branch == "open" else -1.0)
    return B, (B[0] + (along * x - across * y) / f, B[1] + (along * y + across * x) / f)


def _on_link(first: Point, second: Point, length: Array, point: Point) -> Point:
    """Return the place of a point of a link, stated by distance and angle from its line of pins."""
    first = tuple(np.reshape(x, (len(length), -1)) for x in first)
    cos, sin = ((second[k] - first[k]) / length[:, None] for k in (0, 1))
    along, across = (point[0] * f(np.radians(point[1])) for f in (np.cos, np.sin))
    x, y = along[:, None], across[:, None]
    return first[0] + x * cos - y * sin, first[1] + x * sin + y * cos


def _near(random: Random, E: Point) -> Point:
    """Return points at random about the middle of a path."""
    middle = [np.nan_to_num(0.5 * (np.nanmin(x, axis=1, initial=1e3) + np.nanmax(x, axis=1, initial=-1e3))) for x in E]
    away, angle = random.uniform(0.3, 3.0, len(middle[0])), random.uniform(0.0, TURN, len(middle[0]))
    return middle[0] + away * np.cos(angle), middle[1] + away * np.sin(angle)


def _branch(random: Random) -> dict[str, str]:
    """Return one of two pairs of branches: each pair has kernels of its own, which take a minute to compile."""
    return {"C": "open", "F": "crossed"} if random.random() < 0.5 else {"C": "crossed", "F": "open"}


def _margin(random: Random, n: int) -> Array:
    return np.where(random.random(n) < 0.5, random.uniform(0.02, 0.98, n), 10.0 ** random.uniform(-7.0, -1.0, n))


def _link(random: Random, length: Array) -> ls.Link:
    n = len(length)
    mass = random.uniform(0.2, 2.0, n)
    numbers = length, mass, mass * length**2 * random.uniform(0.02, 0.2, n), length * random.uniform(0.0, 1.2, n)
    return ls.Link(*map(_number, (*numbers, random.uniform(-180.0, 180.0, n))))


def _scene(random: Random, n: int, machine: ls.Linkage, loads: list[ls.Load]) -> ls.Scene:
    omega2, alpha2 = random.uniform(-20.0, 20.0, n), random.uniform(-100.0, 100.0, n)
    return ls.Scene(machine, _number(omega2), _number(alpha2), (0.0, -9.81), loads)


def _pair(random: Random, n: int) -> tuple[xr.DataArray, xr.DataArray]:
    x, y = random.uniform(-50.0, 50.0, (2, n))
    return _number(x), _number(y)


def _number(values: Array) -> xr.DataArray:
    return xr.DataArray(values, dims="design")


# ------------------------------------------------------------------------------------------------- the checks


def check(kind: str, designs: int, seed: Sequence[int]) -> Result:
    """Check peaks and arcs of random designs of one kind."""
    scene = (KINDS | OTHERS)[kind](np.random.default_rng(seed), designs)
    start = perf_counter()
    exact = ls.peaks(scene)
    seconds = perf_counter() - start
    short = shortfall(exact, ls.peaks(scene, theta2=_off_round(scene, SAMPLES)))
    wrong = wrong_arcs(scene)
    return Result(
        designs, int((exact.status != 2).sum()), int((short > ALLOWED).sum()), float(short.max()), wrong, seconds
    )


def _off_round(scene: ls.Scene, per_turn: int) -> Array:
    """Return even crank angles of a whole period [degree], none of them round."""
    return (np.arange(per_turn * round(scene.period / 360.0)) + 0.3) * (360.0 / per_turn)


def wrong_arcs(scene: ls.Scene) -> int:
    """Return the number of designs that some sample's status contradicts: on an arc it closes, and is jammed where
    friction is said to jam it."""
    limits = ls.check(scene)
    theta2 = _off_round(scene, STATUS_SAMPLES)
    status = ls.sweep(scene, theta2, of=["status"]).status.transpose("design", "theta2").values
    closes = (status != CANNOT_ASSEMBLE) & (status != TOGGLE)
    wrong = (closes != _inside(limits, "arc", theta2, scene.period)).any(axis=1)
    if "jam_start" in limits:
        wrong |= (np.isin(status, JAMMED) != _inside(limits, "jam", theta2, scene.period)).any(axis=1)
    return int(wrong.sum())


def _inside(limits: xr.Dataset, arc: str, theta2: Array, period: float) -> Array:
    """Return whether each crank angle lies on an arc of each design."""
    start, end = (limits[f"{arc}_{side}"].values[..., None] for side in ("start", "end"))
    return (np.mod(theta2 - start, period) < end - start).any(axis=1)


def chunks(kinds: Sequence[str], designs: int, seed: int) -> Iterator[tuple[str, int, list[int]]]:
    """Yield kind, number and seed of chunks of designs, the kinds in turn."""
    each = -(-designs // len(kinds))
    for first in range(0, each, AT_ONCE):
        for kind in kinds:
            yield kind, min(AT_ONCE, each - first), [seed, first, [*KINDS, *OTHERS].index(kind)]


def main(arguments: Sequence[str] | None = None) -> int:
    """Check random six-bars and print a row for each kind; return 1 where a peak is missed or an arc is wrong."""
    options = _parser().parse_args(arguments)
    kinds = [kind for kind in (*KINDS, *OTHERS) if options.only in kind] if options.only else list(KINDS)
    jobs = list(chunks(kinds, options.designs, options.seed))
    totals = dict.fromkeys(kinds, Result())
    with ProcessPoolExecutor(options.processes, get_context("spawn")) as pool:
        for (kind, _, seed), result in zip(jobs, pool.map(check, *zip(*jobs, strict=True)), strict=True):
            totals[kind] += result
            if result.missed or result.wrong_arcs:
                print(f"{kind}, seed {seed}: {result}", flush=True)
    for kind, total in totals.items():
        print(kind, total)
    return int(any(total.missed or total.wrong_arcs for total in totals.values()))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.stress.six_bars", description="Random six-bars.")
    parser.add_argument("--designs", type=int, default=3000, metavar="N", help="of all kinds together")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--only", default="", metavar="WORD", help="kinds with this word, of any topology")
    return parser


if __name__ == "__main__":
    sys.exit(main())
