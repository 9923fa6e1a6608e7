"""Extrapolate signals to the ends of arcs, and to singular places, by polynomials through samples beside these."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from linksweep.scene.pairs import Array

NODES, SPANS = 10, (25.0, 5.0, 1.0, 0.2, 0.04)
"""Samples beside an end from which a signal is extrapolated, and the distances from it of the farthest ones, in steps
of a path. The first is a quarter of that to the next toggle: others may hide beyond."""
ALLOWED = 1e-10
"""Error of a limit, relative to it, from which on samples are taken closer to the end."""
ANGLES = (np.arange(NODES) + 0.5) * (np.pi / NODES)
TERMS = np.cos(np.outer(ANGLES, np.arange(NODES))) * np.append(1.0, np.full(NODES - 1, 2.0)) / NODES
"""Chebyshev's angles of samples, 0 at the end, and the terms of the polynomial through values there, at that angle."""
BETWEEN = np.linspace(0.0, np.pi, 12 * NODES + 1)
FINELY, SHARES = np.cos(np.outer(BETWEEN, np.arange(NODES))), np.sin(0.5 * BETWEEN) ** 2
"""Such angles, close together, the terms' polynomials there, and the shares of the farthest distance that they are."""


class Extrapolated(NamedTuple):
    """Polynomials of signals beside places (signal, place), by distances x up to a farthest one.

    Their terms; their errors, by the last of these, inf of those that are not known; the farthest distances; and counts
    of samples.
    """

    terms: Array
    error: Array
    farthest: Array
    samples: Array

    @property
    def limit(self) -> Array:
        """Limits at the places; −inf where they are not known."""
        return np.where(self.error < np.inf, self.terms.sum(axis=-1), -np.inf)

    def highest(self, within: Array) -> tuple[Array, Array]:
        """Return the highest values of polynomials up to a distance, limits included, −inf where they are not known,
        and where they are."""
        height, distance = np.full(self.error.shape, -np.inf), np.zeros(self.error.shape)
        known = self.error < np.inf
        height[known], distance[known] = _highest(self.terms[known], self.farthest[known], within[known])
        return height, distance


def _highest(terms: Array, farthest: Array, within: Array) -> tuple[Array, Array]:
    """Return the highest values of polynomials (each, term) up to a distance, and where they are."""
    heights, distances = (terms[:, None] * FINELY).sum(axis=-1), farthest[:, None] * SHARES
    nth = np.where(distances <= within[:, None], heights, -np.inf).argmax(axis=1)[:, None]
    middle = np.clip(nth, 1, len(BETWEEN) - 2)
    before, top, after = (np.take_along_axis(heights, middle + k, axis=1)[:, 0] for k in (-1, 0, 1))
    slope, bend = 0.5 * (after - before), before - 2.0 * top + after
    with np.errstate(divide="ignore", invalid="ignore"):
        step = np.where(bend < 0.0, np.clip(-slope / bend, -1.0, 1.0), 0.0)
    summit = top + step * (slope + 0.5 * step * bend)
    place = farthest * np.sin(0.5 * (middle[:, 0] + step) * BETWEEN[1]) ** 2
    height, distance = (np.take_along_axis(numbers, nth, axis=1)[:, 0] for numbers in (heights, distances))
    higher = (summit > height) & (place <= within)
    return np.where(higher, summit, height), np.where(higher, place, distance)


def extrapolated(
    values_at: Callable[[Array, Array, Array], Array], steps: Array, needs: Array, spans: tuple[float, ...] = SPANS
) -> Extrapolated:
    """Return the polynomials of signals at one end of arcs, or on one side of singular places, where they are needed
    (signal, arc): of those through farther and closer samples, that with the least error.

    `values_at` returns values (signal, arc, place) of signals and arcs, by their numbers, at distances x (arc, place).
    """
    terms, error = np.zeros((*needs.shape, NODES)), np.full(needs.shape, np.inf)
    farthest, samples = np.zeros((2, *needs.shape))
    for span in spans:
        with np.errstate(invalid="ignore"):
            unsure = needs & ~(error <= ALLOWED * np.abs(terms.sum(axis=-1)))
        rows, which = np.flatnonzero(unsure.any(axis=0)), np.flatnonzero(unsure.any(axis=1))
        if not len(rows):
            break
        x = np.multiply.outer(span * steps[rows], 0.5 - 0.5 * np.cos(ANGLES))
        # no product of matrices, whose bits may depend on how many designs there are
        own_terms, own = (values_at(which, rows, x)[..., None] * TERMS).sum(axis=-2), np.ix_(which, rows)
        last = np.abs(own_terms[..., -2:]).sum(axis=-1)
        better = unsure[own] & (last < error[own])
        terms[own] = np.where(better[..., None], own_terms, terms[own])
        error[own] = np.where(better, last, error[own])
        farthest[own] = np.where(better, span * steps[rows], farthest[own])
        samples[own] += NODES * unsure[own]
    return Extrapolated(terms, error, farthest, samples)
