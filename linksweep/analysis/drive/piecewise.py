"""Represent quantities over the whole cycle by polynomials on pieces of it, which are integrated and searched exactly.

The cycle is cut where quantities jump and, more densely, about near-toggles, as by the search for peaks. On each piece
16 points of Gauss give the Legendre series of a quantity; a piece is halved until its last terms are rounding. With x
from −1 to 1 on a piece,

    q = Σ ck Pk(x)        ∫ from −1 to x of Pk = (Pk+1(x) − Pk−1(x)) / (2k + 1)

Source: L. N. Trefethen, Approximation Theory and Approximation Practice (2013), chapters 17 and 19.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from linksweep.engine.roots import roots
from linksweep.results.peak_search.paths import turns
from linksweep.scene.pairs import Array, by_row

TERMS = 16
"""Terms of a series, and points of a piece."""
TOLERANCE = 1e-14
"""Size of the last terms of a piece, relative to the largest value over the cycle, times its part of the cycle."""
HALVINGS = 40
"""Most halvings of a piece: from 15 degrees down to the last few digits of an angle."""
MOST = 2**18
"""Most pieces of a design that are halved at a time."""
FIRST_NOISE, NOISE = 3, 0.05
"""Halvings after which a quantity whose last terms, in those before, still have this size in most pieces counts as
rounding noise."""
PLACES = np.cos(np.linspace(np.pi, 0.0, 2 * TERMS + 1))
"""Places x of a piece at which extremes are bracketed."""
POINTS, WEIGHTS = legendre.leggauss(TERMS)
TO_TERMS = (np.arange(TERMS) + 0.5)[:, None] * legendre.legvander(POINTS, TERMS - 1).T * WEIGHTS


class Place(NamedTuple):
    """Places on a cycle, one for each design: the number of the piece, and x on it."""

    piece: Array
    x: Array


class Piecewise(NamedTuple):
    """Quantities of some designs over the cycle: pieces (design, piece) from `start` with a `width` [degree], NaN where
    others have more, and the Legendre series `terms` (quantity, design, piece, term)."""

    start: Array
    width: Array
    terms: Array

    @property
    def period(self) -> Array:
        """Length of the cycle of each design [degree]."""
        return np.nansum(self.width, axis=1)

    def primitive(self, k: int) -> tuple[Array, Array]:
        """Return the integral of a quantity from the start of the cycle on, over the angle [rad]: its series (design,
        piece, term) and the integral over the whole cycle."""
        half = np.radians(0.5 * self.width)[..., None]
        series = half * legendre.legint(self.terms[k], lbnd=-1.0, axis=-1)
        pieces = np.where(np.isnan(self.start), 0.0, series.sum(axis=-1))
        series[..., 0] += np.cumsum(pieces, axis=-1) - pieces
        return series, pieces.sum(axis=-1)

    def straight(self, slope: Array) -> Array:
        """Return the series of slope·(θ − θ at the start of the cycle), with one slope [per rad] for each design."""
        half = np.radians(0.5 * self.width)
        first = np.radians(self.start - self.start[:, :1])
        return slope[:, None, None] * np.stack([first + half, half], axis=-1)

    def angles(self, place: Place) -> Array:
        """Return the crank angles of places, one for each design, in [0, cycle) [degree]."""
        row = np.arange(len(self.start))
        return np.mod(self._angle(row, place), self.period)

    def _angle(self, row: Array, place: Place) -> Array:
        return self.start[row, place.piece] + 0.5 * (1.0 + place.x) * self.width[row, place.piece]

    def at(self, series: Array, angles: Array) -> Array:
        """Return the values (design, angle) of a series (design, piece, term) at angles [degree], of each design or
        shared by all."""
        angles = np.broadcast_to(angles, (len(series), angles.shape[-1]))
        values = np.empty(angles.shape)
        for row, (start, width, own) in enumerate(zip(self.start, self.width, angles, strict=True)):
            inside = start[0] + np.mod(own - start[0], np.nansum(width))
            piece = np.searchsorted(start, inside, side="right") - 1  # NaN are last
            x = np.clip(2.0 * (inside - start[piece]) / width[piece] - 1.0, -1.0, 1.0)
            values[row] = sum_of(series[row, piece], x)
        return values


def sum_of(series: Array, x: Array) -> Array:
    """Return the values of series (…, term) at places x, one for each."""
    return (legendre.legvander(x, series.shape[-1] - 1) * series).sum(axis=-1)


def added(*series: Array) -> Array:
    """Return the sum of series of any numbers of terms."""
    most = max(each.shape[-1] for each in series)
    return np.sum([np.pad(each, ((0, 0), (0, 0), (0, most - each.shape[-1]))) for each in series], axis=0)


def piecewise(group: Any, names: tuple[str, ...]) -> Piecewise:
    """Return quantities of a group's designs over the cycle: designs whose crank turns fully; NaN where not known."""
    paths, count = turns(group), len(group.designs)
    path, first = np.nonzero(paths.cuts[:, 1:] > paths.cuts[:, :-1])
    pieces = np.stack([paths.cuts[path, first], np.diff(paths.cuts, axis=1)[path, first]])
    done, scale, full = [], np.zeros((len(names), count)), np.bincount(path, minlength=count)
    before, noisy = np.full((len(names), len(path)), np.inf), np.zeros((len(names), count), dtype=bool)
    for halvings in range(HALVINGS + 1):
        values = _values(group, names, paths.row[path], pieces)
        # no matrix product: the order in which it sums, and so the last bit, depends on the number of pieces
        terms = np.stack([(values * weights).sum(axis=-1) for weights in TO_TERMS], axis=-1)
        if not halvings:
            for row, size in zip(scale, np.nan_to_num(np.abs(values).max(axis=-1)), strict=True):
                np.maximum.at(row, path, size)
        tail = np.abs(terms[..., -2:]).max(axis=-1)
        wide = tail * (pieces[1] / group.scene.period) > TOLERANCE * scale[:, path]
        if halvings >= FIRST_NOISE:
            noisy |= _noise(wide & (tail > NOISE * before), path, full * 2.0**halvings)
            wide &= ~noisy[:, path]
        halved = wide.any(axis=0) & (halvings < HALVINGS)
        halved &= (np.bincount(path, halved, len(full)) <= MOST)[path]
        done.append((path[~halved], pieces[:, ~halved], np.moveaxis(terms[:, ~halved], 1, -1)))
        if not halved.any():
            break
        (start, width), path, before = pieces[:, halved], np.tile(path[halved], 2), np.tile(tail[:, halved], 2)
        pieces = np.stack([np.append(start, start + 0.5 * width), np.tile(0.5 * width, 2)])
    path, (start, width), terms = (np.concatenate(parts, axis=-1) for parts in zip(*done, strict=True))
    terms = np.moveaxis(terms, -1, 0)
    order = np.argsort(start, kind="stable")
    tables = [by_row(paths.row[path[order]], each[order], count) for each in (start, width, terms)]
    return Piecewise(tables[0], tables[1], np.moveaxis(tables[2], 2, 0))


def _values(group: Any, names: tuple[str, ...], row: Array, pieces: Array) -> Array:
    """Return the values (quantity, piece, point) of quantities on pieces."""
    start, width = pieces
    angles = (start[:, None] + 0.5 * (1.0 + POINTS) * width[:, None]).ravel()
    return group.values(names, np.repeat(row, TERMS), angles).reshape(len(names), len(row), TERMS)


def _noise(lasting: Array, path: Array, full: Array) -> Array:
    """Return whether quantities (quantity, design) are rounding noise, as a torque of 0: their last terms are `lasting`
    over most of the cycle, which has as many pieces as are `full`."""
    return np.stack([np.bincount(path, each, len(full)) for each in lasting]) > 0.5 * full


def largest(curves: Piecewise, series: Array) -> tuple[Array, Place]:
    """Return the largest value of a series (design, piece, term) over the cycle of each design, and its place.

    The slope changes its sign at extremes inside a piece; at the ends of pieces it may jump.
    """
    slope = legendre.legder(series, axis=-1)
    values, slopes = (each @ legendre.legvander(PLACES, each.shape[-1] - 1).T for each in (series, slope))
    row, piece, k = np.nonzero((slopes[..., :-1] > 0.0) & (slopes[..., 1:] < 0.0))
    ends = np.stack([PLACES[k], PLACES[k + 1]]), np.stack([slopes[row, piece, k], slopes[row, piece, k + 1]])
    x = roots(lambda root, place: sum_of(slope[row[root], piece[root]], place), *ends)
    heights = sum_of(series[row, piece], x)
    flat = np.where(np.isnan(curves.start)[..., None], -np.inf, values).reshape(len(series), -1)
    best = np.argmax(flat, axis=1)
    value = np.take_along_axis(flat, best[:, None], axis=1)[:, 0]
    place = Place(best // len(PLACES), PLACES[best % len(PLACES)])
    order = np.argsort(heights, kind="stable")  # the highest of a design is written last
    order = order[heights[order] >= value[row[order]]]
    value[row[order]], place.piece[row[order]], place.x[row[order]] = heights[order], piece[order], x[order]
    return value, place
