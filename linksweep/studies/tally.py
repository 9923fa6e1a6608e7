"""Tally the designs of a screening: counts, and those designs that may be among the best of all.

Counts are whole numbers, and of equal designs the one with the lowest number is kept. So the tally of all designs is
the same however they are divided into parts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from linksweep.results.front import front

Array = np.ndarray


@dataclass(frozen=True, eq=False)
class Tally:
    """Counts of designs: by `status`; `within` all limits, then within each; by histogram bin; all histograms in line.

    Candidates, by their numbers in order, are the best designs in each objective and the Pareto front of all
    objectives; `costs` (candidate, objective) are to be small.
    """

    status: Array
    within: Array
    bins: Array
    numbers: Array
    costs: Array

    def plus(self, later: Tally, keep: int) -> Tally:
        """Return the tally of these designs and `later` ones, with the `keep` best in each objective."""
        numbers = np.concatenate([self.numbers, later.numbers])
        costs = np.concatenate([self.costs, later.costs])
        candidates = best(costs, keep)
        counts = (self.status + later.status, self.within + later.within, self.bins + later.bins)
        return Tally(*counts, numbers[candidates], costs[candidates])

    @property
    def dataset(self) -> xr.Dataset:
        """Return the tally as a Dataset."""
        counts = {name: (name, getattr(self, name)) for name in ("status", "within", "bins")}
        dims = ("candidate", "objective")
        return xr.Dataset({**counts, "numbers": (dims[0], self.numbers), "costs": (dims, self.costs)})

    @staticmethod
    def of(ds: xr.Dataset) -> Tally:
        """Return the tally of a Dataset of `Tally.dataset`."""
        return Tally(*(ds.variables[name].values for name in ("status", "within", "bins", "numbers", "costs")))


def best(costs: Array, keep: int) -> Array:
    """Return the positions, in order, of the `keep` rows with the least cost in each column, and of the Pareto front.

    Of equal rows or costs the first come first, and of equal rows one alone is on the front.
    """
    chosen = [_least(column, keep) for column in costs.T] if len(costs) else []
    if len(costs) and costs.shape[1] > 1:
        chosen.append(_front(costs))
    return np.unique(np.concatenate([*chosen, np.empty(0, dtype=np.int64)]))


def _least(column: Array, keep: int) -> Array:
    """Return the positions of the least values; only those up to the last of them are sorted."""
    last = min(keep, len(column)) - 1
    among = np.flatnonzero(column <= np.partition(column, last)[last])
    return among[np.argsort(column[among], kind="stable")[:keep]]


def _front(costs: Array) -> Array:
    """Return the positions of the Pareto front; only rows that one good row does not dominate are compared."""
    with np.errstate(over="ignore", invalid="ignore"):
        from_best = costs - costs.min(axis=0)
        good = np.argmin((from_best / from_best.max(axis=0)).sum(axis=1))
    among = np.flatnonzero((costs <= costs[good]).any(axis=1))
    rows = among[front(costs[among])]  # equal rows in their order, one behind the other
    different = np.ones(len(rows), dtype=bool)
    different[1:] = (costs[rows[1:]] != costs[rows[:-1]]).any(axis=1)
    return rows[different]


def bin_counts(values: Array, edges: Array) -> Array:
    """Return how many values lie below all edges, from each edge to before the next, and from the last on."""
    there = values[~np.isnan(values)]
    return np.bincount(np.searchsorted(edges, there, side="right"), minlength=len(edges) + 1)


def within_limits(values: Mapping[str, Array], limits: Mapping[str, tuple[Any, Any]]) -> dict[str, Array]:
    """Return for each limit where its values lie within it; NaN does not."""
    return {name: (values[name] >= low) & (values[name] <= high) for name, (low, high) in limits.items()}
