"""Between the samples of an engine of several cylinders: its sums at any pairs of a design and a crank angle.

Each cylinder is a scene; what is looked at more closely in one of them (jumps, near-toggles, quick loads, poles) is
looked at in the sum, at the angle where that cylinder has it. What moves over part of a turn has no sums: its cylinders
never all close together for a whole cycle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from linksweep.engine.run import Field
from linksweep.results.cylinders.cylinder_sums import sources_of, together
from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.results.peak_search.between import Array, Group, Places, empty, groups, in_period
from linksweep.results.peak_search.exact import NEVER, WHOLLY, Found, follow, nothing, raise_to_poles
from linksweep.results.peak_search.paths import ASIDE, Paths, about_approaches, jump_angles, limits, turns
from linksweep.results.peak_search.poles import may_have_poles, places_of_poles
from linksweep.scene.scene import Scene

HALF_TURN = 180.0
MERGED = 0.1 * ASIDE
"""Samples nearer to each other are one [degree]."""


class Cylinders(NamedTuple):
    """Some designs of an engine, as a `Group` has those of a scene, with a Group for each cylinder."""

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
        return self._replace(each=tuple(group.some(rows) for group in self.each))

    def values(self, names: tuple[str, ...], rows: Array, angles: Array, threads: int | None = None) -> Array:
        """Values (names, pairs) of sums at pairs of one of these designs and an angle [degree]."""
        makers, throws, period = self.machine.makers, self.machine.throws, self.machine.period
        sources, angles = sources_of(names, makers), self._beside_jumps(rows, angles)
        own = [
            group.values(sources, rows, in_period(angles + throw.ahead, period), threads)
            for group, throw in zip(self.each, throws, strict=True)
        ]
        cylinders = [dict(zip(sources, values, strict=True)) for values in own]
        found = together(names, makers, throws, cylinders)
        return np.stack([np.broadcast_to(found[name], angles.shape) for name in names])

    def constants(self, *names: str) -> Array:
        """Values (names, designs) of what depends on no angle; designs that do not close everywhere never do."""
        values = self.values(names, np.arange(len(self.designs)), np.zeros(len(self.designs)))
        closing = np.array(names) == "assembly"
        return np.where(closing[:, None] & (values > WHOLLY), NEVER, values)

    def _beside_jumps(self, rows: Array, angles: Array) -> Array:
        """Return angles, those at a jump moved to its nearer side: cylinders that jump together do so to the digit."""
        for one, ahead in self.by_cylinder():
            for jump in jump_angles(one):
                away = np.mod(angles - (jump[rows] - ahead) + HALF_TURN, 2.0 * HALF_TURN) - HALF_TURN
                beside = angles - away + np.copysign(MERGED, away)
                angles = np.where(np.abs(away) < MERGED, beside, angles)
        return angles

    def by_cylinder(self) -> Iterator[tuple[Group, float]]:
        """Yield the Group of each cylinder, and how far it is ahead [degree]."""
        yield from zip(self.each, (throw.ahead for throw in self.machine.throws), strict=True)


@groups.register
def _groups(machine: MultiCylinder, names: tuple[str, ...]) -> Iterator[Cylinders]:
    sources = sources_of(names, machine.makers)
    for each in zip(*(groups(scene, sources) for scene in machine.cylinders), strict=True):
        yield Cylinders(machine, each)


@empty.register
def _empty(machine: MultiCylinder, names: tuple[str, ...]) -> dict[str, Field]:
    found = {}
    for name in names:
        fields = empty(machine.cylinders[0], sources_of([name], machine.makers)).values()
        sizes = {dim: n for field in fields for dim, n in zip(field.dims, field.values.shape, strict=True)}
        found[name] = Field(tuple(sizes), np.full(tuple(sizes.values()), np.nan))
    return found


@limits.register
def _limits(group: Cylinders) -> tuple[Array, ...]:
    return ()


@turns.register
def _turns(group: Cylinders) -> Paths:
    period = group.machine.period
    own = [(turns(one), ahead) for one, ahead in group.by_cylinder()]
    x, cuts = (
        _merged(np.concatenate([in_period(numbers - ahead, period) for numbers, ahead in parts], axis=1))
        for parts in ([(p.x, ahead) for p, ahead in own], [(p.cuts[:, :-1], ahead) for p, ahead in own])
    )
    before, after = np.roll(x, 1, axis=1), np.roll(x, -1, axis=1)
    before[:, 0] -= period
    after[:, -1] += period
    return own[0][0]._replace(x=x, before=before, after=after, cuts=np.append(cuts, cuts[:, :1] + period, axis=1))


def _merged(x: Array) -> Array:
    """Return places (path, place) in order; what rounding alone tells from the one before is made equal to it."""
    x = np.sort(x, axis=1)
    new = np.diff(x, axis=1, prepend=-1.0) > MERGED
    last = np.maximum.accumulate(np.where(new, np.arange(x.shape[1]), 0), axis=1)
    return np.take_along_axis(x, last, axis=1)


@about_approaches.register
def _about_approaches(group: Cylinders) -> Paths:
    parts = [_shifted(about_approaches(one), ahead) for one, ahead in group.by_cylinder()]
    joined: dict[str, Any] = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return about_approaches(group.each[0])._replace(**joined)


def _shifted(paths: Paths, ahead: float) -> dict[str, Any]:
    places = {name: getattr(paths, name) - ahead for name in ("x", "before", "after", "cuts")}
    return {"row": paths.row, **places}


@places_of_poles.register
def _places_of_poles(group: Cylinders, signals: tuple[str, ...]) -> tuple[Array, Array, Array]:
    sources = sources_of(signals, group.machine.makers)
    parts = [
        (row, angle - ahead, step)
        for one, ahead in group.by_cylinder()
        for row, angle, step in [places_of_poles(one, sources)]
    ]
    row, angle, step = (np.concatenate(part) for part in zip(*parts, strict=True))
    return row, angle, step


def exact_peaks_together(
    machine: MultiCylinder, signals: tuple[str, ...], threads: int | None = None
) -> dict[str, Found]:
    """Return the largest value of each sum over the continuous cycle, for every design; NaN where it has none."""
    found = {signal: nothing(field) for signal, field in empty(machine, signals).items()}
    paths: tuple[Callable[[Any], Paths], ...] = (turns, about_approaches) if machine.engine.approaches() else (turns,)
    for group in groups(machine, (*signals, "assembly")):
        (kinds,) = group.constants("assembly")
        if np.any(kinds == WHOLLY):
            whole = group.some(kinds == WHOLLY)
            follow(whole, found, paths, threads)
            if may_have_poles(machine.engine, signals):
                raise_to_poles(whole, found, threads)
    return found if machine.engine.quick.all else {signal: _doubted(peak) for signal, peak in found.items()}


def _doubted(peak: Found) -> Found:
    """Return a peak that may be higher by anything: some load changes too quickly to be followed."""
    beyond = np.where(np.isfinite(peak.value.values), np.inf, peak.beyond.values)
    return peak._replace(beyond=Field(peak.beyond.dims, beyond))
