"""Check that the search misses no peak: random machines against the largest of many samples chosen independently.

The samples are equal for all designs of a kind: a dense even grid, and geometric ones about both near-toggles, from a
radian down to less than the narrowest spike. A peak is missed where a sample exceeds it by more than `ALLOWED`,
relative to the peak, besides the sample's own rounding errors: where other forces are a million times as large, samples
next to each other scatter. Half of the machines that turn fully come near to a toggle, at margins of 1e-7 to
1e-1 of their lengths; four-bars of any lengths are of all Grashof classes, most of which move over part of a turn.
Tables over the angle have few or many angles, even or nearly so, smooth or rough values, and all interpolations;
loads that are functions of it are waves with a narrow bump between breaks, speeds are waves.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import NamedTuple

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.cases import Size
from benchmarks.timing import FASTER, Row

ALLOWED = 1e-10
CHUNK = 10_000
FINEST = 1e-9
"""Distance of the nearest graded sample from a near-toggle [rad]."""
EVEN, PER_DECADE = 3600, 60
CLOSE = 1e-11
"""Step between samples that tell a sample's rounding errors [degree]."""
BESIDE = 50
"""Such samples on either side: the largest of thousands has a rounding error that few samples would show."""
INTERPOLATIONS = ("periodic cubic", "pchip", "linear", "step")

Array = np.ndarray
Random = np.random.Generator


class Missed(NamedTuple):
    """Result of a search: number of designs, number whose peak falls short of a sample, largest shortfall and the
    design that has it; time of the search and of the samples [s]."""

    designs: int
    count: int
    shortfall: float
    worst: dict[str, Array]
    seconds: float
    samples_take: float


class Family(NamedTuple):
    """Random scenes of one kind, and the crank angle [degree] of one of their near-toggles; the other is opposite. The
    share of all designs that is searched is smaller where a design takes a hundred times as long."""

    scene: Callable[[Random, int], ls.Scene]
    near_toggle: float = 0.0
    share: float = 1.0


def rows(size: Size) -> list[Row]:
    return [
        _row(name, search(family, max(round(family.share * size.machines), 1))) for name, family in FAMILIES.items()
    ]


def _row(name: str, result: Missed) -> Row:
    note = f"{result.count} of {result.designs:,} missed"
    times = result.samples_take / result.seconds, result.seconds, result.samples_take
    return Row(name, f"{len(angles(0.0)):,} samples", FASTER, *times, error=result.shortfall, note=note)


def search(family: Family, designs: int, seed: int = 0) -> Missed:
    """Compare peaks of random designs of a family with the largest samples."""
    parts = [_part(family, min(CHUNK, designs - k), [seed, k]) for k in range(0, designs, CHUNK)]
    worst = max(parts, key=lambda part: part.shortfall)
    designs, count, seconds, samples_take = (
        sum(getattr(part, field) for part in parts) for field in ("designs", "count", "seconds", "samples_take")
    )
    return Missed(designs, count, worst.shortfall, worst.worst, seconds, samples_take)


def _part(family: Family, designs: int, seed: list[int]) -> Missed:
    scene = family.scene(np.random.default_rng(seed), designs)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ls.OvershootWarning)  # rough tables are drawn on purpose
        return _compared(scene, family.near_toggle)


def _compared(scene: ls.Scene, near_toggle: float) -> Missed:
    start = perf_counter()
    exact = ls.peaks(scene)
    halfway = perf_counter()
    dense = ls.peaks(scene, theta2=of_all_turns(scene, near_toggle))
    times = halfway - start, perf_counter() - halfway
    short = shortfall(exact, dense)
    for k in np.flatnonzero(short > ALLOWED):
        own = (part.isel(design=k, missing_dims="ignore") for part in (exact, dense))
        short[k] = clear_of_rounding(ls.scene_at(scene, design=k), *own)
    k = int(short.argmax())
    worst = {path: array.values[k] for path, array in scene.arrays.items()}
    return Missed(len(short), int((short > ALLOWED).sum()), float(short[k]), worst, *times)


def of_all_turns(scene: ls.Scene, near_toggle: float) -> Array:
    """Return `angles` of each turn of a scene's cycle."""
    return np.add.outer(np.arange(0.0, scene.period, 360.0), angles(near_toggle)).ravel()


def angles(near_toggle: float) -> Array:
    """Return crank angles [degree]: even ones, and geometric ones about both near-toggles."""
    steps = np.degrees(np.geomspace(FINEST, 1.0, round(PER_DECADE * -np.log10(FINEST))))
    graded = [middle + side * steps for middle in (near_toggle, near_toggle + 180.0) for side in (-1.0, 1.0)]
    even = (np.arange(EVEN) + 0.3) * (360.0 / EVEN)
    return np.unique(np.concatenate([even, [near_toggle, near_toggle + 180.0], *graded]))


def shortfall(exact: xr.Dataset, dense: xr.Dataset) -> Array:
    """Return by how much the largest samples of each design exceed its peaks, relative to the peaks; 0 where none does,
    infinite where there are samples and no peak."""
    return np.max([_short(exact, dense, name) for name in _peaks_of(exact)], axis=0)


def clear_of_rounding(scene: ls.Scene, exact: xr.Dataset, dense: xr.Dataset) -> float:
    """Return by how much the largest samples of one design exceed its peaks and their own rounding errors, relative to
    the peaks."""
    return max(
        float(_short(exact, dense, name) - _rounding(scene, dense, name) / _scale(exact, name))
        for name in _peaks_of(exact)
        if f"{name}_at" in exact  # that of a torque is one of its extremes
    )


def _rounding(scene: ls.Scene, dense: xr.Dataset, name: str) -> float:
    """Return the rounding errors of a largest sample: the scatter of many, close together."""
    quantity, angle = name.rsplit("_", 1)[0], float(dense[f"{name}_at"])
    values = ls.sweep(scene, angle + CLOSE * np.arange(-BESIDE, BESIDE + 1.0), of=[quantity])[quantity].values
    return float(np.nan_to_num(np.abs(np.diff(values, n=2))).max())


def _short(exact: xr.Dataset, dense: xr.Dataset, name: str) -> Array:
    sign = -1.0 if name.endswith("_min") else 1.0
    peak, sample = sign * exact[name].values, sign * dense[name].values
    with np.errstate(invalid="ignore"):
        short = np.where(sample > peak, (sample - peak) / _scale(exact, name), 0.0)
    return np.where(np.isnan(peak) & ~np.isnan(sample), np.inf, short)


def _scale(exact: xr.Dataset, name: str) -> Array:
    """Return the size of a quantity's peaks; where one extreme is finite and the other is not, that of the one."""
    size = np.abs(exact[f"{name.rsplit('_', 1)[0]}_peak"].values)
    return np.where(np.isfinite(size), size, np.abs(exact[name].values))


def _peaks_of(exact: xr.Dataset) -> list[str]:
    return [name for name in map(str, exact.data_vars) if name.endswith(("_peak", "_max", "_min"))]


# ------------------------------------------------------------------------------------------ random machines


def _four_bar(random: Random, n: int) -> ls.Scene:
    """Return four-bars whose crank a turns fully: |b − c| < |d − a| and b + c > d + a.

    With a shortest, the rocker swings; with the ground d shortest, it turns too.
    """
    a, d = np.exp(random.uniform(-1.5, 1.5, (2, n)))
    b, c = _dyad(random, a, d)
    links = (_link(random, length) for length in (a, b, c))
    branch = str(random.choice(["open", "crossed"]))
    loads = [ls.Load("coupler", _pair(random, n, 50.0), at=(_number(0.7 * b), 20.0)), ls.Load("rocker", torque=3.0)]
    return _scene(random, n, ls.FourBar(*links, _number(d), branch), loads)


def _dyad(random: Random, a: Array, d: Array) -> tuple[Array, Array]:
    """Return the lengths of two links that join a pin at a radius a to one at a distance d all the way round."""
    n = len(a)
    difference, total = np.abs(d - a) * (1.0 - _margin(random, n)), (d + a) * (1.0 + _margin(random, n))
    difference *= random.choice([-1.0, 1.0], n)
    return 0.5 * (total + difference), 0.5 * (total - difference)


def _any_four_bar(random: Random, n: int) -> ls.Scene:
    """Return four-bars of any lengths that close."""
    lengths = np.exp(random.uniform(-1.5, 1.5, (4, n)))
    longest = lengths.max(axis=0)
    lengths = np.minimum(lengths, 0.98 * (lengths.sum(axis=0) - longest))
    *links, d = lengths
    branch = str(random.choice(["open", "crossed"]))
    return _scene(random, n, ls.FourBar(*(_link(random, length) for length in links), _number(d), branch), [])


def _slider_crank(friction: bool) -> Callable[[Random, int], ls.Scene]:
    def scene(random: Random, n: int) -> ls.Scene:
        """Return machines whose crank turns fully: the rod is longer than crank and offset together."""
        a = np.exp(random.uniform(-1.5, 1.5, n))
        offset = a * random.uniform(-0.8, 0.8, n) * random.choice([0.0, 1.0], n)
        b, slides = _rod(random, a + np.abs(offset), friction)
        mass = _number(random.uniform(0.2, 2.0, n))
        branch = str(random.choice(["open", "crossed"]))
        crank, rod = _link(random, a), _link(random, b)
        mechanism = ls.SliderCrank(crank, rod, mass, _number(offset), _number(slides) if friction else 0.0, branch)
        return _scene(random, n, mechanism, [ls.Load("slider", _pair(random, n, 50.0))])

    return scene


def _rod(random: Random, height: Array, friction: bool) -> tuple[Array, Array]:
    """Return the length of a rod to a slider, longer than the largest height of its other end over the guide; and the
    guide's friction, which does not wedge the slider."""
    n = len(height)
    b = height * (1.0 + _margin(random, n))
    wedges = np.sqrt((b - height) * (b + height)) / height
    return b, np.minimum(wedges * random.uniform(0.0, 0.95, n), 0.5) if friction else np.zeros(n)


def _six_bar(random: Random, n: int) -> ls.Scene:
    """Return Watt six-bars whose crank turns fully; the second four-bar closes wherever its first link may be."""
    a, d, e, g = np.exp(random.uniform(-1.5, 1.5, (4, n)))
    lengths = dict(zip(("crank", "coupler", "rocker"), (a, *_dyad(random, a, d)), strict=True))
    lengths |= dict(zip(("rod", "output"), _dyad(random, e, g), strict=True))
    turned = np.radians(random.uniform(-180.0, 180.0))
    pivots = {
        "A": (0.0, 0.0),
        "D": (_number(d), 0.0),
        "G": (_number(d + g * np.cos(turned)), _number(g * np.sin(turned))),
    }
    mechanism = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F",
        ground=pivots,
        points={"E": (_number(e), random.uniform(-180.0, 180.0))},
        branch=_branches(random, "C", "F"),
        **{role: _link(random, length) for role, length in lengths.items()},
    )
    return _scene(random, n, mechanism, [ls.Load("output", torque=3.0)])


def _any_six_bar(random: Random, n: int) -> ls.Scene:
    """Return six-bars of any lengths, most of which move over part of a turn: the second four-bar hangs on the rocker
    of the first, so that its toggles end arcs, too, or on the crank, whose first four-bar its toggles leave alone."""
    on_rocker = random.random() < 0.5
    a, b, c, d, e, f, g = np.exp(random.uniform(-1.0, 1.0, (7, n)))
    hangs = "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F"
    stands = "crank A-B-E, coupler B-C, rocker D-C, rod E-F, output G-F"
    mechanism = ls.Linkage(
        hangs if on_rocker else stands,
        ground={"A": (0.0, 0.0), "D": (_number(d), 0.0), "G": (_number(random.uniform(-2.0, 2.0, n)), _number(g))},
        points={"E": (_number(e), random.uniform(-180.0, 180.0))},
        branch=_branches(random, "C", "F"),
        **{
            role: _link(random, length)
            for role, length in {
                "crank": a,
                "coupler": b,
                "rocker": c,
                "rod": f,
                "output": random.permutation(f),
            }.items()
        },
    )
    return _scene(random, n, mechanism, [ls.Load("output", torque=3.0)])


def _press(random: Random, n: int) -> ls.Scene:
    """Return knuckle-joint presses with friction whose crank turns fully: the lower link is longer than the upper and
    the offset of the guide together."""
    a, d = np.exp(random.uniform(-1.5, 1.5, (2, n)))
    b, c = _dyad(random, a, d)
    offset = _offset_of_press(random, c)
    lower, friction = _rod(random, c + np.abs(offset), friction=True)
    return _press_of(random, {"crank": a, "rod": b, "upper": c, "lower": lower}, d, offset, friction)


def _any_press(random: Random, n: int) -> ls.Scene:
    """Return knuckle-joint presses of any lengths, most of which move over part of a turn, with friction that wedges
    half of them on part of that."""
    a, b, c, d, lower = np.exp(random.uniform(-1.0, 1.0, (5, n)))
    offset, friction = _offset_of_press(random, c), 10.0 ** random.uniform(-2.0, 0.3, n)
    return _press_of(random, {"crank": a, "rod": b, "upper": c, "lower": lower}, d, offset, friction)


def _offset_of_press(random: Random, upper: Array) -> Array:
    return upper * random.uniform(-0.8, 0.8, len(upper)) * random.choice([0.0, 1.0], len(upper))


def _press_of(random: Random, lengths: dict[str, Array], d: Array, offset: Array, friction: Array) -> ls.Scene:
    """Return presses with links of these lengths, the upper one's pivot at d, and a guide of any direction."""
    n, angle = len(d), float(random.uniform(-180.0, 180.0))
    across = -np.sin(np.radians(angle)), np.cos(np.radians(angle))
    guide = ls.Guide((_number(d + offset * across[0]), _number(offset * across[1])), angle, _number(friction))
    mechanism = ls.Linkage(
        "crank A-B, rod B-C, upper D-C, lower C-E, ram E on slide",
        ground={"A": (0.0, 0.0), "D": (_number(d), 0.0)},
        guides={"slide": guide},
        branch=_branches(random, "C", "E"),
        ram=ls.Slider(_number(random.uniform(0.2, 2.0, n))),
        **{role: _link(random, length) for role, length in lengths.items()},
    )
    return _scene(random, n, mechanism, [ls.Load("ram", _pair(random, n, 50.0))])


def _branches(random: Random, *pins: str) -> dict[str, str]:
    return {pin: str(random.choice(["open", "crossed"])) for pin in pins}


def _inverted_slider_crank(random: Random, n: int) -> ls.Scene:
    """Return machines whose crank turns fully: the offset is less than the difference of crank and ground."""
    a, d = np.exp(random.uniform(-1.5, 1.5, (2, n)))
    offset = np.abs(d - a) * (1.0 - _margin(random, n)) * random.choice([-1.0, 1.0], n)
    mass, inertia = random.uniform(0.2, 2.0, (2, n))
    branch = str(random.choice(["open", "crossed"]))
    crank, rocker = _link(random, a), _link(random, d)
    mechanism = ls.InvertedSliderCrank(
        crank, rocker, _number(d), _number(mass), _number(0.1 * inertia), _number(offset), branch
    )
    return _scene(random, n, mechanism, [ls.Load("rocker", torque=3.0)])


def _by(drive: str, machines: Callable[[Random, int], ls.Scene]) -> Callable[[Random, int], ls.Scene]:
    def scene(random: Random, n: int) -> ls.Scene:
        """Return machines that this link drives; those whose rocker swings have dead centres, where forces are
        unbounded."""
        return replace(machines(random, n), drive=drive)

    return scene


def _with_table(machines: Callable[[Random, int], ls.Scene], link: str) -> Callable[[Random, int], ls.Scene]:
    def scene(random: Random, n: int) -> ls.Scene:
        """Return machines with a torque and a force over the angle besides, each design with values of its own."""
        table, kind = _table(random, n)
        load = {"force": (30.0 * table, 9.0)} if link == "slider" else {"torque": 30.0 * table}
        without = machines(random, n)
        return replace(without, loads=(*without.loads, ls.Load(link, **load, interpolation=kind)))

    return scene


def _at_speeds(machines: Callable[[Random, int], ls.Scene]) -> Callable[[Random, int], ls.Scene]:
    def scene(random: Random, n: int) -> ls.Scene:
        """Return machines whose speed changes with the angle, each design by values of its own; some turn round."""
        changes, _ = _table(random, n)
        return replace(machines(random, n), omega2=_speed(random, n) * (1.0 + 0.1 * changes), alpha2=None)

    return scene


def _at_a_function(machines: Callable[[Random, int], ls.Scene]) -> Callable[[Random, int], ls.Scene]:
    def scene(random: Random, n: int) -> ls.Scene:
        """Return machines whose speed is the same function of the angle; some turn round."""
        size, turns = random.uniform(-0.3, 0.3, 4), random.integers(1, 3)
        order, phase = random.integers(0, 10, (4, 1)), random.uniform(0.0, 6.3, (4, 1))
        mean = float(_speed(random, 1)[0])

        def speed(theta2: Array) -> Array:
            return mean * (1.0 + size @ np.cos(np.radians(order * theta2) / turns + phase))

        return replace(machines(random, n), omega2=speed, alpha2=None)

    return scene


def _speed(random: Random, n: int) -> xr.DataArray:
    """Return speeds of either sign [rad/s]."""
    return _number(random.uniform(1.0, 20.0, n) * random.choice([-1.0, 1.0], n))


def _table(random: Random, n: int) -> tuple[xr.DataArray, str]:
    """Return values of some units over the angle, in one or two turns, of each design its own; and an interpolation."""
    count, turns, kind = random.choice([9, 24, 72]), random.integers(1, 3), str(random.choice(INTERPOLATIONS))
    angles = np.sort((np.arange(count) + random.uniform(0.0, 0.8, count)) * (360.0 * turns / count))
    waves = np.cos(np.radians(np.outer(np.arange(1, 4), angles) / turns) + random.uniform(0.0, 6.3, (3, 1)))
    rough = 10.0 ** random.uniform(-3.0, 0.0, (n, 1)) * random.normal(size=(n, count))
    values = random.normal(size=(n, 3)) @ waves + rough
    return xr.DataArray(values, {"theta2": angles}, ("design", "theta2")), kind


def _with_function(machines: Callable[[Random, int], ls.Scene], link: str) -> Callable[[Random, int], ls.Scene]:
    def scene(random: Random, n: int) -> ls.Scene:
        """Return machines with a torque or a force besides that is a function: waves and a narrow bump between two
        breaks, at which it jumps."""
        (size, order, phase), turns = random.uniform(0.0, 30.0, (3, 4)), random.integers(1, 3)
        narrow, *breaks = 10.0 ** random.uniform(0.5, 2.0), *np.sort(random.uniform(0.0, 360.0 * turns, 2))

        def load(theta2: Array) -> Array:
            theta2 = np.mod(theta2, 360.0 * turns)
            waves = size @ np.cos(np.radians(np.outer(order // 3.0, theta2)) / turns + phase[:, None])
            bump = 50.0 * np.exp(-(((theta2 - breaks[0]) / narrow) ** 2))
            return np.where((theta2 > breaks[0]) & (theta2 < breaks[1]), waves + bump, waves)

        without, number = machines(random, n), {"force": (load, 9.0)} if link == "slider" else {"torque": load}
        return replace(without, loads=(*without.loads, ls.Load(link, **number, breaks=breaks)))

    return scene


def _margin(random: Random, n: int) -> Array:
    """Return by how much machines miss a toggle, relative to their lengths: half by anything, half by little."""
    return np.where(random.random(n) < 0.5, random.uniform(0.02, 0.98, n), 10.0 ** random.uniform(-7.0, -1.0, n))


def _link(random: Random, length: Array) -> ls.Link:
    """Return links of any mass, with centres of gravity anywhere."""
    n = len(length)
    mass, reach = random.uniform(0.2, 2.0, n), random.uniform(0.0, 1.2, n)
    inertia = mass * length**2 * random.uniform(0.02, 0.2, n)
    angle = random.uniform(-180.0, 180.0, n) * random.choice([0.0, 1.0], n)
    return ls.Link(*map(_number, (length, mass, inertia, reach * length, angle)))


def _scene(random: Random, n: int, mechanism: object, loads: list[ls.Load]) -> ls.Scene:
    omega2, alpha2 = random.uniform(-20.0, 20.0, n), random.uniform(-100.0, 100.0, n)
    return ls.Scene(mechanism, _number(omega2), _number(alpha2), (0.0, -9.81), loads)


def _pair(random: Random, n: int, size: float) -> tuple[xr.DataArray, xr.DataArray]:
    x, y = random.uniform(-size, size, (2, n))
    return _number(x), _number(y)


def _number(values: Array) -> xr.DataArray:
    return xr.DataArray(values, dims="design")


FAMILIES = {
    "four-bar": Family(_four_bar),
    "four-bar of any lengths": Family(_any_four_bar),
    "slider-crank": Family(_slider_crank(friction=False), 90.0),
    "slider-crank with friction": Family(_slider_crank(friction=True), 90.0),
    "inverted slider-crank": Family(_inverted_slider_crank),
    "Watt six-bar": Family(_six_bar, share=0.5),
    "six-bar of any lengths": Family(_any_six_bar, share=0.5),
    "knuckle-joint press with friction": Family(_press, share=0.5),
    "knuckle-joint press of any lengths": Family(_any_press, share=0.5),
    "four-bar by its rocker": Family(_by("rocker", _four_bar)),
    "inverted slider-crank by its rocker": Family(_by("rocker", _inverted_slider_crank)),
    "Watt six-bar by its output": Family(_by("output", _six_bar), share=0.05),
    "six-bar of any lengths by its output": Family(_by("output", _any_six_bar), share=0.05),
    "knuckle-joint press by its upper link": Family(_by("upper", _press), share=0.05),
    "four-bar with a table": Family(_with_table(_four_bar, "rocker")),
    "slider-crank with friction and a table": Family(_with_table(_slider_crank(friction=True), "slider"), 90.0),
    "four-bar with a function": Family(_with_function(_four_bar, "rocker")),
    "slider-crank with friction and a function": Family(_with_function(_slider_crank(friction=True), "slider"), 90.0),
    "four-bar at speeds in a table": Family(_at_speeds(_four_bar)),
    "six-bar of any lengths by its output at speeds in a table": Family(
        _at_speeds(_by("output", _any_six_bar)), share=0.01
    ),
    "slider-crank with friction at speeds in a table": Family(_at_speeds(_slider_crank(friction=True)), 90.0, 0.5),
    "four-bar at a speed that is a function": Family(_at_a_function(_four_bar)),
}
