"""Sample the signals of a limit, and find their extremes and zeros.

Signals are smooth over the crank angle: samples bracket every extreme, and the search for peaks finds its place.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linksweep.engine.peaks import brackets as search
from linksweep.engine.peaks.paths import refine
from linksweep.engine.quantity import Limit
from linksweep.engine.roots import roots
from linksweep.scene.pairs import Array, quantities_at
from linksweep.scene.scene import Scene

SEAM = 40
"""Samples of a period that are repeated after its end, so that every extreme has neighbours on both sides."""
WIDE = 0.6
"""Half-width from which on a near-toggle is as smooth as the motion of the links [rad]."""
CLEAR = 4.0
"""Difference of neighbouring samples, in units of their noise, from which on it counts."""


class Curves(NamedTuple):
    """Signals of a limit along arcs, numbered signal by signal, at places x (arc, sample) [degree].

    `designs` are the designs of the arcs; `turns` states whether the arcs are whole turns.
    """

    scene: Scene
    limit: Limit
    designs: Array
    x: Array
    turns: bool

    def arc(self, curve: Array) -> Array:
        """Return the arc of each curve."""
        return curve % len(self.designs)

    def on_arcs(self, arc: Array, x: Array) -> tuple[Array, Array]:
        """Return values (signal, pair) of all signals at pairs of an arc and a place, and their noise."""
        names = (*self.limit.signals, *self.limit.noise)
        values, noise = quantities_at(self.scene, names, self.designs[arc], x).reshape(2, len(names) // 2, len(x))
        return values, noise

    def at(self, curve: Array, x: Array) -> tuple[Array, Array]:
        """Return the values of curves at places, and their noise."""
        values, noise = self.on_arcs(self.arc(curve), x)
        own = curve // len(self.designs), np.arange(len(x))
        return values[own], noise[own]

    def samples(self) -> tuple[Array, Array]:
        """Return the values (curve, sample) at all places, and their noise."""
        arc, per_arc = np.repeat(np.arange(len(self.designs)), self.x.shape[1]), self.x.shape[1]
        values, noise = self.on_arcs(arc, self.x.ravel())
        return values.reshape(-1, per_arc), noise.reshape(-1, per_arc)


class Extremes(NamedTuple):
    """Extremes of curves: least values (`sign` 1) and largest ones (−1), as brackets of three points (point, extreme).

    `x` are places [degree], with values of the curve; `noise` is that of the middle point.
    """

    curve: Array
    sign: Array
    x: Array
    values: Array
    noise: Array

    def some(self, which: Array) -> Extremes:
        """Return the extremes with these indices."""
        return Extremes(*(numbers[..., which] for numbers in self))

    @property
    def height(self) -> Array:
        """Height of each least value over zero, or depth of each largest one below it."""
        return self.sign * self.values[1]


def zeros_and_extremes(curves: Curves) -> tuple[Array, Array, Extremes]:
    """Return curve and place [degree] of each zero; and the extremes, refined, that are or may be near zero."""
    values, noise = curves.samples()
    turning = extremes(curves, values, noise)
    beyond = turning.some(turning.height < -turning.noise)
    return *_crossings(curves, values, noise, beyond), turning


def extremes(curves: Curves, values: Array, noise: Array) -> Extremes:
    """Return the extremes that may be near-toggles, or have a toggle on either side, refined."""
    least, largest = (_brackets(curves, sign, values, noise) for sign in (1.0, -1.0))
    brackets = Extremes(*(np.concatenate(both, axis=-1) for both in zip(least, largest, strict=True)))
    return _refined(curves, brackets.some(_matter(brackets)))


def _brackets(curves: Curves, sign: float, values: Array, noise: Array) -> Extremes:
    """Return the samples that lie lower (sign 1) or higher (−1) than those beside them, by more than noise."""
    last = values.shape[1] - 1
    slope = np.diff(sign * values, axis=1)
    with np.errstate(invalid="ignore"):
        slope = np.where(np.abs(slope) > CLEAR * np.maximum(noise[:, 1:], noise[:, :-1]), slope, 0.0)
    clear = np.maximum.accumulate(np.where(slope != 0.0, np.arange(last), 0), axis=1)[:, :-1]
    turns_up = (np.take_along_axis(slope, clear, axis=1) < 0.0) & (slope[:, 1:] > 0.0)
    if curves.turns:
        turns_up[:, : SEAM // 2 - 1] = turns_up[:, last - SEAM // 2 :] = False
    curve, j = np.nonzero(turns_up)
    points = np.stack([clear[curve, j], j + 1, j + 2])
    where = curves.x[curves.arc(curve), points], values[curve, points]
    return Extremes(curve, np.full(len(curve), sign), *where, noise[curve, j + 1])


def _matter(brackets: Extremes) -> Array:
    """Return whether each may be a near-toggle, or have a toggle on either side, by the parabola through its points."""
    slope, curvature = parabola(brackets)
    lowest = brackets.height - 0.25 * slope * slope / curvature
    return (brackets.height > -brackets.noise) & (lowest < 2.0 * curvature * WIDE**2)


def parabola(brackets: Extremes) -> tuple[Array, Array]:
    """Return the slope at the middle point [per rad] and half the second derivative [per rad²] of parabolas."""
    before, height, after = brackets.sign * brackets.values
    back, ahead = np.radians(np.diff(brackets.x, axis=0))
    fall, rise = (before - height) / back, (after - height) / ahead
    return (rise * back - fall * ahead) / (back + ahead), (fall + rise) / (back + ahead)


def _refined(curves: Curves, brackets: Extremes) -> Extremes:
    """Return the extremes at their places, by the search for peaks: each has a lane and a tag of its own."""
    count, place = len(brackets.curve), brackets.x[1]
    lanes, best = np.zeros((search.BRACKET_ROWS, search.in_blocks(2 * count))), np.empty((search.BEST_ROWS, count))
    before, middle, after = zip(brackets.x, -brackets.sign * brackets.values, strict=True)
    search.open_bracket(lanes, slice(count), before, middle, after, 0.0, 0.0, np.arange(count), brackets.noise)
    best[search.PEAK], best[search.PEAK_X] = lanes[search.FB, :count], place

    def heights(tag: Array, x: Array) -> Array:
        return -brackets.sign[tag] * curves.at(brackets.curve[tag], x)[0]

    with np.errstate(all="ignore"):
        refine(lanes, count, best, heights)
    value, noise = curves.at(brackets.curve, best[search.PEAK_X])
    x, values = brackets.x.copy(), brackets.values.copy()
    x[1], values[1] = best[search.PEAK_X], value
    return brackets._replace(x=x, values=values, noise=noise)


def _crossings(curves: Curves, values: Array, noise: Array, beyond: Extremes) -> tuple[Array, Array]:
    """Return curve and place [degree] of each zero: between samples, and on either side of extremes `beyond` zero."""
    curve, x, heights = _changes_of_sign(curves, values, noise)
    sides = [(beyond.curve, beyond.x[k : k + 2], beyond.values[k : k + 2]) for k in (0, 1)]
    curve, x, heights = (np.concatenate(all_of, axis=-1) for all_of in zip((curve, x, heights), *sides, strict=True))
    return curve, roots(lambda root, place: curves.at(curve[root], place)[0], x, heights)


def _changes_of_sign(curves: Curves, values: Array, noise: Array) -> tuple[Array, Array, Array]:
    """Return curve, places and values (end, change) of neighbouring samples of which one is negative beyond noise.

    The value of the other one is at least zero: one that is negative by noise alone is a zero.
    """
    positive, known = values >= -noise, np.isfinite(values)
    values = np.where(positive, np.maximum(values, 0.0), values)
    change = (positive[:, 1:] != positive[:, :-1]) & known[:, 1:] & known[:, :-1]
    if curves.turns:
        change[:, 1 - SEAM :] = False
    curve, j = np.nonzero(change)
    ends = np.stack([j, j + 1])
    return curve, curves.x[curves.arc(curve), ends], values[curve, ends]
