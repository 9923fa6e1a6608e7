"""Compute the sums of an engine of several cylinders at any pairs of a design and a crank angle, and their peaks.

Each cylinder is a scene. Angles that need denser samples in one of them (jumps, near-toggles, quick loads, poles) need
them in the sum, too, at the engine's angle. A design that moves over part of a turn has no sums: its cylinders are
never all assembled for a whole cycle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from linksweep.engine.run import Field, Places
from linksweep.results.compute import names_unless_jammed
from linksweep.results.cylinders.cylinder_sums import combined, sources_of
from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.results.peak_search.along_paths import (
    PathsOf,
    SignalPeak,
    follow,
    nothing,
    numbers_of,
    on_own_side,
    put,
    raise_to_poles,
    with_unknown_bound,
)
from linksweep.results.peak_search.arcs import arc_ends
from linksweep.results.peak_search.between import EVERYWHERE, NEVER
from linksweep.results.peak_search.groups import (
    AT_ONCE,
    Group,
    assembled_groups,
    different,
    empty,
    empty_over_all,
    groups,
)
from linksweep.results.peak_search.paths import (
    AT_JUMP,
    Paths,
    about_approaches,
    distinct,
    listed_jumps,
    moved_aside,
    neighbours,
    reversals,
    turns,
)
from linksweep.results.peak_search.singular.poles import Candidates, may_have_poles, pole_candidates
from linksweep.scene.pairs import Array, changes, in_period, joined
from linksweep.scene.scene import Scene


class Cylinders(NamedTuple):
    """Some designs of an engine: a `Group` of them for each cylinder."""

    machine: MultiCylinder
    each: tuple[Group, ...]

    @property
    def scene(self) -> Scene:
        return self.each[0].scene

    @property
    def designs(self) -> Array:
        return self.each[0].designs

    @property
    def places(self) -> Places:
        return self.each[0].places

    def some(self, rows: Array) -> Cylinders:
        """Return the designs in these rows."""
        return self._replace(each=tuple(group.some(rows) for group in self.each))

    def values(self, names: tuple[str, ...], rows: Array, angles: Array) -> Array:
        """Return values (names, pairs) of sums at pairs of a design, by its row, and an angle [degree], or beside it
        where a cylinder jumps there."""
        return self._sums(names, rows, self._beside_jumps(rows, angles))

    def of(self, name: str, rows: Array) -> Callable[[Array, Array], Array]:
        """Return the function that evaluates a sum of some of the designs in these rows at an angle [degree] of each,
        as a sweep does: at a jump, too."""
        return lambda which, angles: self._sums((name,), rows[which], angles)[0]

    def _sums(self, names: tuple[str, ...], rows: Array, angles: Array) -> Array:
        """Return values of sums, NaN where friction jams a cylinder: it has no motion to add either."""
        rules, throws, period = self.machine.rules, self.machine.throws, self.machine.period
        sources = sources_of(names, rules)
        free = tuple(names_unless_jammed(self.machine.engine.at_one_angle, sources).values())
        own = [
            group.values(free, rows, in_period(angles + throw.ahead, period))
            for group, throw in zip(self.each, throws, strict=True)
        ]
        cylinders = [dict(zip(sources, values, strict=True)) for values in own]
        sums = combined(names, rules, throws, cylinders)
        return np.stack([np.broadcast_to(sums[name], angles.shape) for name in names])

    def assembly(self) -> Array:
        """Return the assembly of each design; it is `NEVER` if one of its cylinders moves over part of a turn."""
        return np.where(np.max([one.assembly() for one in self.each], axis=0) > EVERYWHERE, NEVER, EVERYWHERE)

    def _beside_jumps(self, rows: Array, angles: Array) -> Array:
        """Return angles with those at a jump moved to its nearer side: cylinders that jump together then all do. Where
        friction begins to jam one its forces grow without bound, and means need all samples as they are."""
        for one, ahead in self.by_cylinder():
            for jump in np.concatenate([listed_jumps(one), reversals(one)], axis=1).T:
                angles = moved_aside(angles, jump[rows] - ahead, self.machine.period)
        return angles

    def by_cylinder(self) -> Iterator[tuple[Group, float]]:
        """Yield the Group of each cylinder, and the angle by which it is ahead [degree]."""
        yield from zip(self.each, (throw.ahead for throw in self.machine.throws), strict=True)


@groups.register
def _groups(machine: MultiCylinder, designs: Array, at_once: int = AT_ONCE) -> Iterator[Cylinders]:
    for each in zip(*(groups(scene, designs, at_once) for scene in machine.cylinders), strict=True):
        yield Cylinders(machine, each)


@different.register
def _different(machine: MultiCylinder, names: tuple[str, ...]) -> Array:
    return different(machine.cylinders[0], sources_of(names, machine.rules))


@empty.register
def _empty(machine: MultiCylinder, names: tuple[str, ...]) -> dict[str, Field]:
    cylinder = machine.cylinders[0]
    return {name: empty_over_all(cylinder, sources_of([name], machine.rules)) for name in names}


@arc_ends.register
def _arc_ends(group: Cylinders) -> tuple[Array, ...]:
    return ()


@reversals.register
def _reversals(group: Cylinders) -> Array:
    return np.empty((len(group.designs), 0))  # sums are beside all jumps of their cylinders in any case


@turns.register
def _turns(group: Cylinders) -> Paths:
    period = group.machine.period
    own = [(turns(one), ahead) for one, ahead in group.by_cylinder()]
    x, cuts = (
        distinct(np.concatenate([in_period(numbers - ahead, period) for numbers, ahead in parts], axis=1), AT_JUMP)
        for parts in ([(p.x, ahead) for p, ahead in own], [(p.cuts[:, :-1], ahead) for p, ahead in own])
    )
    before, after = neighbours(x, period)
    return own[0][0]._replace(x=x, before=before, after=after, cuts=np.append(cuts, cuts[:, :1] + period, axis=1))


@about_approaches.register
def _about_approaches(group: Cylinders) -> Paths:
    windows = [(about_approaches(one), ahead) for one, ahead in group.by_cylinder()]
    parts = [(w.row, w.x - ahead, w.before - ahead, w.after - ahead, w.cuts - ahead) for w, ahead in windows]
    row, x, before, after, cuts = map(np.concatenate, zip(*parts, strict=True))
    return Paths(row, x, before, after, cuts, ends="pass")


@pole_candidates.register
def _pole_candidates(group: Cylinders, signals: tuple[str, ...]) -> Candidates:
    sources = sources_of(signals, group.machine.rules)
    parts = [(pole_candidates(one, sources), ahead) for one, ahead in group.by_cylinder()]
    return joined([some._replace(angle=some.angle - ahead) for some, ahead in parts])


def exact_peaks_of_sums(machine: MultiCylinder, signals: tuple[str, ...]) -> dict[str, SignalPeak]:
    """Return the peak of each sum over the continuous cycle, for every design; NaN where it has none."""
    peaks = {signal: nothing(field) for signal, field in empty(machine, signals).items()}
    paths: tuple[PathsOf, ...] = (turns, about_approaches) if machine.engine.approaches() else (turns,)
    for _, group in assembled_groups(machine, different(machine, signals)):
        follow(group, peaks, paths)
        if may_have_poles(machine.engine, signals):
            raise_to_poles(group, peaks)
        _on_own_sides(group, peaks)
    if machine.engine.quick.all:
        return peaks
    over_angle = [signal for signal in peaks if changes(machine.engine, sources_of((signal,), machine.rules))]
    return peaks | {signal: with_unknown_bound(peaks[signal]) for signal in over_angle}


def _on_own_sides(group: Cylinders, peaks: dict[str, SignalPeak]) -> None:
    """Move the angles of peaks that are limits at a jump to the side that has these values in a sweep."""
    rows = np.arange(len(group.designs))
    for signal, peak in peaks.items():
        value, angle, *others = numbers_of(peak, group)
        put(peak, group, (value, on_own_side(group.of(signal, rows), angle, value, group.machine.period), *others))
