"""A sample in bins of two of its parameters: a study over two dims, of which a heat map can be drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr

from linksweep.results.front import has_peaks

STATISTICS = ("best", "mean", "worst")
EMPTY = "no_design"
"""Status of a bin without designs."""


class Bins(NamedTuple):
    """Equal bins of a parameter: its name and attributes, the middle of each, and the bin of each design."""

    name: str
    attributes: dict
    middles: np.ndarray
    of_design: np.ndarray


def bins_of(item: xr.DataArray, count: int) -> Bins:
    """Return equal bins from the least to the largest value of a parameter over a dim."""
    low, high = float(item.min()), float(item.max())
    edges = np.linspace(low, high, count + 1)
    of_design = np.clip(np.searchsorted(edges, item.values, side="right") - 1, 0, count - 1)
    return Bins(str(item.name), dict(item.attrs), 0.5 * (edges[1:] + edges[:-1]), of_design)


def binned(ds: xr.Dataset, statistics: Mapping[str, str], across: Bins, up: Bins, maximize: bool) -> xr.Dataset:
    """Return results of a sample in bins of two parameters, as a study over these.

    Parameters
    ----------
    statistics : results by name, each with what stands for the designs in a bin: their "best", "mean" or "worst"
    maximize : True where the largest is the best
    """
    shape, dims = (len(up.middles), len(across.middles)), (up.name, across.name)
    cell, size = np.ravel_multi_index((up.of_design, across.of_design), shape), shape[0] * shape[1]
    ok = np.broadcast_to(has_peaks(ds).values, cell.shape)
    status = ds.get("status", xr.DataArray(0))
    variables = {}
    for name, how in statistics.items():
        values = np.broadcast_to(ds[name].values, cell.shape).astype(float)
        counted = ok & np.isfinite(values)
        heights = _statistic(values[counted], cell[counted], size, how, maximize)
        variables[name] = (dims, heights.reshape(shape), ds[name].attrs)
    words = [*str(status.attrs.get("flag_meanings", "ok")).split(), EMPTY]
    codes = np.full(size, len(words) - 1)
    codes[cell] = np.broadcast_to(status.values, cell.shape)
    codes[cell[ok]] = 0  # one design that is ok is enough
    flags = (dims, codes.reshape(shape), {"flag_meanings": " ".join(words)})
    coordinates = {side.name: (side.name, side.middles, side.attributes) for side in (up, across)}
    return xr.Dataset({**variables, "status": flags}, coordinates)


def _statistic(values: np.ndarray, cell: np.ndarray, size: int, how: str, maximize: bool) -> np.ndarray:
    """Return one number for each of `size` cells, NaN for those that no value is in."""
    count = np.bincount(cell, minlength=size)
    if how == "mean":
        return np.bincount(cell, values, minlength=size) / np.where(count, count, np.nan)
    largest = (how == "best") == maximize
    ends = np.full(size, -np.inf if largest else np.inf)
    (np.maximum if largest else np.minimum).at(ends, cell, values)
    return np.where(count, ends, np.nan)
