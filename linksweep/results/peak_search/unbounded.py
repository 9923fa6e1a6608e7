"""Search for peaks on arcs between toggles at which signals grow without bound."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linksweep.engine.peaks.samples import HALF
from linksweep.results.peak_search.along_paths import SignalPeak, angle_in_period, put, raise_to
from linksweep.results.peak_search.arcs import NEAREST, arc_ends
from linksweep.results.peak_search.groups import Group, groups
from linksweep.results.peak_search.pieces import (
    AT_ONCE,
    BEYOND,
    BORDERS,
    NARROW,
    Pieces,
    between,
    designs_without_jams,
    highest_on_pieces,
)
from linksweep.scene.pairs import Array, some_of
from linksweep.scene.scene import Scene

PROBES = np.array([1e-4, 1e-5])
"""Distances from a toggle, in x of an arc, of the samples that show whether a signal is unbounded."""
BESIDE_TOGGLE = 0.03
"""Part of an arc that is a piece of its own beside each toggle."""
LEAST_GROWTH, LARGE = 5.0, 1e3
"""Growth from the one to the other, and over the middle of the arc, of an unbounded signal."""


def follow_unbounded(scene: Scene, designs: Array, peaks: dict[str, SignalPeak], threads: int | None) -> Array:
    """Write the peaks of those designs that move over part of a turn, and of which all signals grow without bound at
    all toggles, to either side; return the other designs."""
    if not len(designs) or scene.jumps() or scene.mechanism.kinks() or scene.approaches():
        return designs
    regular, signals = designs_without_jams(scene, designs), tuple(peaks)
    others = [np.setdiff1d(designs, regular, assume_unique=True)]
    for group in groups(scene, signals, regular, AT_ONCE):
        arcs, growth = _growth_at_toggles(group, signals, threads)
        known = np.bincount(arcs.row, (growth == 0.0).any(axis=(0, 1)), len(group.designs)) == 0.0
        known &= np.bincount(arcs.row, minlength=len(group.designs)) > 0
        others.append(group.designs[~known])
        for signal, of_signal in zip(signals, growth, strict=True):
            upwards = np.bincount(arcs.row, (of_signal > 0.0).any(axis=0), len(group.designs)) > 0
            _put_infinite(group, np.flatnonzero(known & upwards), peaks[signal], arcs, of_signal)
            bounded = np.flatnonzero(known & ~upwards)
            if len(bounded):
                some = some_of(arcs, np.flatnonzero((known & ~upwards)[arcs.row]))
                part = group.some(some.row)
                highest = highest_on_pieces(part, _pieces(part, some), (signal,), HALF, threads)
                raise_to(peaks[signal], part, highest[signal])
    return np.sort(np.concatenate(others))


class Arcs(NamedTuple):
    """Arcs of designs, in their order: row of the design in its group, start and end [degree]."""

    row: Array
    start: Array
    end: Array


def _growth_at_toggles(group: Group, signals: tuple[str, ...], threads: int | None) -> tuple[Arcs, Array]:
    """Return the arcs of designs, and for each (signal, end, arc) 1 where the signal tends to +∞, −1 where it tends to
    −∞, and 0 where samples do not show it."""
    starts, ends = arc_ends(group)
    row, nth = np.nonzero(np.isfinite(starts))
    arcs = Arcs(row, starts[row, nth], ends[row, nth])
    middle, half = 0.5 * (arcs.start + arcs.end), 0.5 * (arcs.end - arcs.start)
    away = 1.0 - np.cos(PROBES)
    shares = np.concatenate([away - 1.0, [0.0], 1.0 - away])  # the start's, the middle's, the end's
    angles = (middle[:, None] + half[:, None] * shares).ravel()
    values = group.values((*signals, "status"), np.repeat(row, len(shares)), angles, threads)
    values = np.moveaxis(values.reshape(-1, len(row), len(shares)), 2, 0)
    moves, inside = values[2, -1] == 0.0, LARGE * np.abs(values[2, :-1])
    growth = []
    for probe, closer in ((values[0, :-1], values[1, :-1]), (values[3, :-1], values[4, :-1])):
        unbounded = (np.abs(closer) > LEAST_GROWTH * np.abs(probe)) & (np.abs(closer) > inside) & moves
        growth.append(np.where(unbounded, np.sign(closer), 0.0))
    return arcs, np.stack(growth, axis=1)


def _put_infinite(group: Group, rows: Array, peak: SignalPeak, arcs: Arcs, growth: Array) -> None:
    """Write the infinite peaks of a signal of the designs in these rows: at the first end at which it grows."""
    if not len(rows):
        return
    arc, end = np.nonzero((growth > 0.0).T)
    own, first = np.unique(arcs.row[arc], return_index=True)
    at = first[np.searchsorted(own, rows)]
    angle = angle_in_period(np.where(end > 0, arcs.end[arc], arcs.start[arc])[at], group.scene.period)
    known = np.zeros(len(rows))
    put(peak, group.some(rows), (known + np.inf, angle, known, known + len(PROBES) * 2.0 + 1.0))


def _pieces(group: Group, arcs: Arcs) -> Pieces:
    """Return the pieces of arcs, one of each of these designs: between toggles, narrow near-toggles, and ends of half
    turns."""
    length = arcs.end - arcs.start
    start = np.mod(arcs.start - group.number(group.scene.mechanism.near_toggle_angle), 360.0)
    middles, widths = group.near_toggles()
    with np.errstate(invalid="ignore"):
        narrow = np.where(widths < NARROW, middles, np.nan)
        cuts = np.concatenate([narrow, np.broadcast_to(BORDERS, (len(length), 2))], axis=1)
        away = np.mod(cuts - start[:, None], 360.0)
        least = np.array([*np.zeros(narrow.shape[1]), BEYOND, BEYOND])
        away = np.where((away > least) & (away < length[:, None] - least), away, np.nan)
    near = 0.5 * (1.0 - np.cos(NEAREST))
    away = np.concatenate([away, np.multiply.outer(length, [near, BESIDE_TOGGLE, 1.0 - BESIDE_TOGGLE])], axis=1)
    pieces = between(np.sort(start[:, None] + away, axis=1), start + (1.0 - near) * length, len(length))
    before, after = pieces.start - start[:, None], (start + length)[:, None] - pieces.end
    widths = np.sqrt(np.minimum(np.stack([before, after]) / (pieces.end - pieces.start), 1.0))
    return pieces._replace(widths=widths)
