"""Find all rises of a signal that are as high as its peak, and its largest value in each of equal sectors.

The search for a peak drops every bracket that cannot exceed it, and with them the equals of the peak. Here each bracket
is refined on its own, so that two equal rises are both found as exactly as the peak itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import numpy as np

from linksweep.engine.quantity import unless_jammed, where_ok
from linksweep.results.compute import known_names
from linksweep.results.peak_search.along_paths import highest, rises
from linksweep.results.peak_search.arcs import arc_ends, arcs_within
from linksweep.results.peak_search.between import EVERYWHERE, PARTLY
from linksweep.results.peak_search.exact import paths_of
from linksweep.results.peak_search.friction.jams import may_jam
from linksweep.results.peak_search.groups import Group, groups
from linksweep.scene.pairs import Array, in_period, joined
from linksweep.scene.scene import Scene


class Equals(NamedTuple):
    """Rises as high as peaks: row of the design, angle [degree] and height."""

    row: Array
    angle: Array
    height: Array


def equal_rises(scene: Scene, signal: str, designs: Array, level: Array) -> Equals:
    """Return all rises of a signal of these designs that reach a level, one for each design."""
    signal = _known(scene, (signal,))[0]
    parts = [Equals(np.empty(0, dtype=int), np.empty(0), np.empty(0))]
    for rows, kind, group in _by_assembly(scene, designs):
        for paths in (paths_of_group(group) for paths_of_group in paths_of(scene, kind)):
            if len(paths.row):
                path, angle, height = rises(group, signal, paths, level[rows[paths.row]])
                high = height >= level[rows[paths.row[path]]]
                parts.append(Equals(rows[paths.row[path]][high], angle[high], height[high]))
    return joined(parts)


def at_arc_ends(scene: Scene, designs: Array, angles: Array, near: float) -> Array:
    """Return whether an angle [degree] of each of these designs is the end of one of its arcs."""
    at_end = np.zeros(len(designs), dtype=bool)
    for rows, kind, group in _by_assembly(scene, designs):
        if kind == PARTLY:
            ends = np.concatenate(arc_ends(group), axis=1)
            away = in_period(angles[rows, None] - ends + near, scene.period_of_motion)
            at_end[rows] = (away < 2.0 * near).any(axis=1)
    return at_end


def sector_peaks(scene: Scene, signals: tuple[str, ...], sectors: int) -> tuple[Array, Array]:
    """Return the largest value of each signal in each of equal sectors of the cycle, and its angle [degree].

    Both are arrays (signal, design, sector), designs row-major over all design dims; NaN where a design has no motion.
    """
    signals, sizes = _known(scene, signals), scene.at_one_angle.inputs.sizes
    designs = np.arange(int(np.prod(tuple(sizes.values()), dtype=int)))
    value, angle = np.full((2, len(signals), len(designs), sectors), np.nan)
    pieces = partial(arcs_within, (0.0, scene.period), pieces=sectors)
    for rows, _, group in _by_assembly(scene, designs):
        paths = pieces(group)
        lowest = np.full((len(paths.row), len(signals)), -np.inf)
        heights, angles, *_ = highest(group, signals, paths, lowest)
        sector = (in_period(paths.middle, scene.period) * (sectors / scene.period)).astype(int)
        for k in range(len(signals)):
            order = np.argsort(heights[:, k])  # the highest of a sector is written last
            order = order[heights[order, k] > -np.inf]
            place = rows[paths.row[order]], sector[order]
            value[k][place], angle[k][place] = heights[order, k], angles[order, k]
    return value, angle


def _known(scene: Scene, signals: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of the signals' values that exist: none where friction jams a machine."""
    if not scene.mechanism.rubs:
        return signals
    # where closed forms tell of jams, dead centres of the drive are inside of them
    known = unless_jammed if may_jam(scene) else where_ok
    return tuple(known_names(scene.at_one_angle, signals, known).values())


def _by_assembly(scene: Scene, designs: Array) -> Iterator[tuple[Array, float, Group]]:
    """Yield these designs in groups of one kind of assembly that move, with their rows and the kind."""
    first = 0
    for group in groups(scene, designs):
        rows = first + np.arange(len(group.designs))
        first += len(rows)
        assembly = group.assembly()
        for kind in (EVERYWHERE, PARTLY):
            some = np.flatnonzero(assembly == kind)
            if len(some) and (kind == EVERYWHERE or arc_ends(group)):
                yield rows[some], kind, group.some(some)
