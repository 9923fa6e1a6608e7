"""Designs that no other dominates, by their costs; and designs whose peaks count."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

BATCH = 64
KEPT = ("ok", "partial_revolution")
"""Status of designs whose peaks count: a machine that moves over part of a turn is not worse for it."""


def has_peaks(ds: xr.Dataset) -> xr.DataArray:
    """Return whether each design has peaks that count."""
    if "status" not in ds.variables:
        return xr.DataArray(True)
    words = str(ds["status"].attrs.get("flag_meanings", "ok")).split()
    return ds["status"].isin([code for code, word in enumerate(words) if word in KEPT])


def objective_attributes(minimize: Iterable[str], maximize: Iterable[str]) -> dict[str, str]:
    """Return attributes of a Dataset that state what its designs were chosen for, the first objective first."""
    words = {"minimize": ", ".join(minimize), "maximize": ", ".join(maximize)}
    return {word: names for word, names in words.items() if names}


def stated_objective(ds: xr.Dataset) -> tuple[str, bool] | None:
    """Return the first objective that a Dataset states, and whether it is to be large; None where it states none."""
    for word in ("minimize", "maximize"):
        name = str(ds.attrs.get(word, "")).partition(", ")[0]
        if name in ds.variables:
            return name, word == "maximize"
    return None


def front(costs: np.ndarray) -> np.ndarray:
    """Return the rows of costs (designs, objectives) that no other dominates, sorted by columns; equal rows too."""
    order = np.lexsort(costs.T[::-1])  # only an earlier row can dominate a row
    ordered = costs[order]
    first = np.ones(len(order), dtype=bool)
    first[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    different = ordered[first]
    best = _of_two(different) if costs.shape[1] <= 2 else _of_more(different)
    return order[best[np.cumsum(first) - 1]]


def _of_two(costs: np.ndarray) -> np.ndarray:
    """Return whether each of different rows in order has a last column below all before it."""
    last = costs[:, -1]
    before = np.minimum.accumulate(np.concatenate([[np.inf], last]))[:-1]
    return last < before


def _of_more(costs: np.ndarray) -> np.ndarray:
    """Return whether no row before it dominates each of different rows, in any number of columns.

    Each row of the front strikes out the rows after it that it dominates. The rows with the least sum of ranks come
    first: they dominate the most, and no later row can dominate them, as equal costs rank in the order of their rows.
    Rows are dropped a batch at a time.
    """
    ranks = np.argsort(np.argsort(costs, axis=0, kind="stable"), axis=0)
    rows = np.argsort(ranks.sum(axis=1), kind="stable")
    best = np.zeros(len(rows), dtype=bool)
    while rows.size:
        after = np.ascontiguousarray(costs[rows].T)
        left = np.ones(len(rows), dtype=bool)
        for k in range(min(BATCH, len(rows))):
            if left[k]:
                left[k:] &= (after[:, k:] < after[:, k, None]).any(axis=0)
                best[rows[k]] = True
        rows = rows[BATCH:][left[BATCH:]]
    return best
