"""Average samples over time: each, at equal steps of the crank angle, counts by the time that the crank takes for it.

mean of q over time = ∑ q/|ω2| / ∑ 1/|ω2|
"""

from __future__ import annotations

import xarray as xr


def mean_over_time(
    signal: xr.DataArray, cycle: xr.Dataset, index: str = "theta2", pace: str = "omega2"
) -> xr.DataArray:
    """Return the mean of a signal over a cycle's samples, of those that are not NaN; NaN where the crank stands still
    or turns back.

    A pace that changes with the index must be in the cycle; a steady one takes as long for each sample.
    """
    speed = cycle.get(pace)
    if speed is None or index not in speed.dims:
        return signal.mean(index)
    one_way = (speed.min(index) > 0.0) | (speed.max(index) < 0.0)
    return signal.weighted((1.0 / abs(speed)).fillna(0.0)).mean(index).where(one_way)
