"""Average samples over time: each counts by the time that the crank takes for the angle that it stands for.

mean of q over time = ∑ h q/|ω2| / ∑ h/|ω2|

The angles h are alike where the samples divide whole turns evenly; else half the distance between both neighbours.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from linksweep.scene.grid import whole_turns
from linksweep.scene.pairs import Array

TURN = 360.0


def mean_over_time(
    signal: xr.DataArray, cycle: xr.Dataset, index: str = "theta2", pace: str = "omega2"
) -> xr.DataArray:
    """Return the mean of a signal over a cycle's samples, of those that are not NaN; NaN where the crank stands still
    or turns back.

    A pace that changes with the index must be in the cycle; a steady one takes as long for each degree.
    """
    speed, weights = cycle.get(pace), xr.DataArray(weights_of(cycle[index].values), dims=index)
    if speed is None or index not in speed.dims:
        return signal.mean(index) if (weights == 1.0).all() else signal.weighted(weights).mean(index)
    one_way = (speed.min(index) > 0.0) | (speed.max(index) < 0.0)
    return signal.weighted((weights / abs(speed)).fillna(0.0)).mean(index).where(one_way)


def weights_of(angles: Array) -> Array:
    """Return the weights of samples at angles [degree]: 1 where they divide whole turns evenly, or are one angle; else
    their reach."""
    even = np.ptp(angles) == 0.0 or whole_turns(np.sort(angles), TURN) is not None
    return np.ones(len(angles)) if even else reach(angles)


def reach(angles: Array) -> Array:
    """Return half the distance between the neighbours of each angle, in any order; of an end, to its one neighbour."""
    order = np.argsort(angles, kind="stable")
    ordered, halves = angles[order], np.empty(len(order))
    halves[order] = np.diff(np.concatenate([ordered[:1], 0.5 * (ordered[1:] + ordered[:-1]), ordered[-1:]]))
    return halves
