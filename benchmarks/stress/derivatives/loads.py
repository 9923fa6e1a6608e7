"""Loads of scenes as those of the reference, in 50 digits: numbers, curves over theta2 or a position, gas pressure."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import linksweep as ls
from benchmarks.stress.decimals import RADIAN, Array, Vector, angles, exact, exactly
from benchmarks.stress.derivatives.curves import Wave, over_angle, over_position
from benchmarks.stress.derivatives.numbers import Numbers, over_designs, turning_point
from benchmarks.stress.linkages import machine as reference
from benchmarks.stress.linkages.assembly import Assembly
from benchmarks.stress.linkages.constraints import Frames, OnLine, Push
from benchmarks.stress.linkages.loads import load_pushes
from benchmarks.stress.linkages.machine import Linkages
from benchmarks.stress.linkages.multibody import placed
from linksweep.scene.strokes import stroke_of

PI = 180 * RADIAN


def loads_of(numbers: Numbers, alone: Linkages) -> tuple[Any, ...]:
    """Return the loads of a scene on its linkages without loads."""
    return tuple(_load(Source(numbers, alone, f"loads[{k}]", load)) for k, load in enumerate(numbers.scene.loads, 1))


@dataclass(frozen=True, eq=False)
class Source:
    """A load of a scene, and where it stands."""

    numbers: Numbers
    alone: Linkages
    path: str
    load: Any

    def __call__(self, field: str) -> Array:
        return self.numbers(f"{self.path}.{field}")

    def over_angle(self, field: str, value: Any) -> Array:
        """Return a number, or the value of its curve at the angles."""
        if value is None or f"{self.path}.{field}" in self.numbers:
            return None if value is None else self(field)
        return over_angle(value, self.load.interpolation).at(self.alone.theta2, self.numbers.design)


def _load(source: Source) -> Any:
    load = source.load
    if isinstance(load, ls.GasPressure):
        return Gas(source)
    if isinstance(load, ls.Load):
        return Following(source) if load.over else _plain(source, source.over_angle)
    if isinstance(load, ls.TorsionSpring):
        return reference.TorsionSpring(load.from_, load.to, source("rate"), source("free_angle"))
    if isinstance(load, ls.TorsionDamper):
        return reference.TorsionDamper(load.from_, load.to, source("coefficient"))
    ends = (
        (of[0], source(f"{word}[2]"), source(f"{word}[3]")) for word, of in (("from_", load.from_), ("to", load.to))
    )
    if isinstance(load, ls.Damper):
        return reference.Damper(*ends, source("coefficient"))
    return reference.Spring(*ends, source("rate"), source("free_length"))


def _plain(source: Source, value_of: Any) -> reference.Load:
    load = source.load
    force = load.force and tuple(value_of(f"force[{k}]", part) for k, part in enumerate(load.force, 1))
    at = source("at[1]"), source("at[2]")
    return reference.Load(load.link, force, at, load.frame, value_of("torque", load.torque), load.origin)


def line_of(assembly: Assembly, role: str) -> OnLine:
    """Return the line on which a link slides."""
    return next(line for line in assembly.constraints if isinstance(line, OnLine) and line.j == role)


@dataclass(frozen=True, eq=False)
class Following:
    """A load over the position of a link."""

    source: Source

    def __call__(self, assembly: Assembly, frames: Frames) -> list[Push]:
        position, rate = self.position(assembly, frames)
        stroke, load = self.source.numbers.scene.mechanism.strokes[self.source.load.over], self.source.load
        way = 0 if load.while_ is None else 1 if load.while_ == stroke.words[0] else -1
        acts = 1 * (rate * way * exact(stroke.forward, len(rate)) > 0) if way else 1

        def value_of(field: str, value: Any) -> Any:
            if value is None or (isinstance(value, float) and value == 0.0):
                return value
            return self._at(field, value, position, stroke.kind == "angle") * acts

        return load_pushes(assembly, frames, _plain(self.source, value_of))

    def position(self, assembly: Assembly, frames: Frames) -> tuple[Array, Array]:
        """Return the position that it follows, and its rate."""
        role, what = self.source.load.over.split(".")
        if what == "angle":
            return angles(frames[role].u), frames[role].omega
        if what == "length":
            cylinder = next(part for part in assembly.linkages.cylinders if part.role == role)
            return assembly.cylinder(cylinder).lengthening(frames)
        x, rate, _ = line_of(assembly, role).sliding(frames)
        return (self._to_end(role, x) if what == "to_end" else x), rate

    def _at(self, field: str, value: Any, position: Array, turns: bool) -> Array:
        if f"{self.source.path}.{field}" in self.source.numbers:
            return self.source(field)
        if isinstance(value, Wave):
            return value.at(position, self.source.numbers.design)
        table = over_position(value, self.source.load.interpolation)
        if turns:
            middle = exactly(0.5 * (value.position.values.min() + value.position.values.max()))
            position = position - 360 * np.round((position - middle).astype(float) / 360.0).astype(int)
        return table.at(position, self.source.numbers.design)

    def _to_end(self, role: str, x: Array) -> Array:
        """Return the distance to the outer dead centre, or to the farthest position along the guide."""
        way, end = end_of(self.source.numbers, self.source.load.over)
        return (end - x) * way


def end_of(numbers: Numbers, over: str) -> tuple[int, Array]:
    """Return the position of a slider from which distances to its end count, and 1 where they shrink with it, or -1."""
    if isinstance(numbers.scene.mechanism, ls.SliderCrank):
        return (1 if numbers.scene.mechanism.branch == "open" else -1), dead_centres(numbers)[0][1]
    return 1, farthest(numbers, over, over.partition(".")[0])


def level_of(numbers: Numbers, over: str, place: float) -> Array:
    """Return the position of a link, as results have it, at a place of a load over that position."""
    way, end = end_of(numbers, over) if over.endswith("to_end") else (-1, exact(0.0, len(numbers)))
    return end - exact(place, len(numbers)) * way


def farthest(numbers: Numbers, over: str, role: str) -> Array:
    """Return the farthest position of a slider along its guide in all columns."""
    from benchmarks.stress.derivatives.machine import linkages_of, near_pins

    stroke = stroke_of(numbers.scene, over)
    alone = replace(numbers.scene.unloaded, drive="crank")  # where the slider turns round, its own drive is at rest
    turning = np.stack([np.broadcast_to(np.asarray(angle), numbers.designs) for angle in stroke.turning])
    heights = []
    for angle in np.nan_to_num(turning):
        cycle = ls.sweep(alone, np.unique(angle), of=[stroke.quantity])[stroke.quantity]
        values = over_designs(cycle, numbers.designs, theta2=len(np.unique(angle)))
        heights.append(values[np.arange(numbers.designs), np.unique(angle, return_inverse=True)[1]])
    best = np.nanargmax(np.where(np.isnan(turning), np.nan, heights), axis=0)
    angle = turning[best, np.arange(numbers.designs)]
    pins = near_pins(alone, angle)
    bare = replace(numbers, scene=alone)

    def positions(theta2: Array) -> Array:
        linkages = linkages_of(replace(bare, repeated=1), theta2, pins)
        assembly = Assembly(linkages)
        return line_of(assembly, role).sliding(placed(assembly))[0]

    single = replace(bare, repeated=1)
    return np.tile(turning_point(positions, single.columns(exactly(angle)))[1], numbers.repeated)


@dataclass(frozen=True, eq=False)
class Gas:
    """Gas pressure on a slider, along its guide."""

    source: Source

    def __call__(self, assembly: Assembly, frames: Frames) -> list[Push]:
        source, load = self.source, self.source.load
        crankcase = source.over_angle("crankcase", load.crankcase)
        pressure = source.over_angle("pressure", load.pressure) if load.cycle is None else self.cycle(assembly, frames)
        side = -1 if getattr(source.numbers.scene.mechanism, "branch", "") == "crossed" else 1
        force = side * (crankcase - pressure) * PI * source("bore") ** 2 / 4
        return load_pushes(assembly, frames, reference.Load(load.link, (force, 0.0), frame="link"))

    def cycle(self, assembly: Assembly, frames: Frames) -> Array:
        """Return the pressure of an ideal cycle, from the place of the piston between its dead centres."""
        source, cycle = self.source, self.source.load.cycle
        ratio, gamma, intake = (source(f"pressure.{w}") for w in ("compression_ratio", "gamma", "intake_pressure"))
        compressed = intake * ratio**gamma
        peak = compressed if cycle.peak_pressure is None else source("pressure.peak_pressure")
        cutoff = source("pressure.cutoff_ratio") if isinstance(cycle, ls.DieselCycle) else exact(1.0, len(ratio))
        (top, farthest), (bottom, nearest) = dead_centres(source.numbers)
        x = line_of(assembly, "slider").sliding(frames)[0]
        volume = 1 + (ratio - 1) * (farthest - x) / (farthest - nearest)
        way = np.where(assembly.exact(assembly.linkages.omega2) < 0, -1, 1)
        turned = _within(way * (assembly.exact(assembly.linkages.theta2) - top), int(cycle.period))
        down = _within(way * (bottom - top), 360)
        expansion = peak * np.minimum(exact(1.0, len(ratio)), cutoff / volume) ** gamma
        opens = down + (360 if int(cycle.strokes) == 4 else 0)
        later = np.where(turned < opens, intake, intake * (ratio / volume) ** gamma)
        return np.where(turned < down, expansion, later)


def dead_centres(numbers: Numbers) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Return the crank angle [degree] and the position of a slider-crank's dead centres, the outer one first.

    In four strokes it fires in the turn in which the crank points to the head at an angle from 0 to 360.
    """
    a, b, e = numbers("crank.length"), numbers("rod.length"), numbers("offset")
    side = 1 if numbers.scene.mechanism.branch == "open" else -1
    head = _within(numbers("slide_angle") + (0 if side > 0 else 180), 360)
    x, y = (side * np.sqrt(reach**2 - e**2) for reach in (b + a, b - a))
    top, bottom = (head + angles(Vector(abs(along), side * e)) for along in (x, y))
    return (top, x), (bottom + 180, y)


def _within(angle: Array, period: int) -> Array:
    return angle - period * np.floor((angle.astype(float)) / period).astype(int)
