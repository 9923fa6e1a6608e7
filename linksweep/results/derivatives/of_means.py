"""Derivatives of means over time, of their two integrals (`linksweep.results.derivatives.of_integrals`).

With the pace v of the crank (or of a car), the mean of q over time is M = ∫ q/|v| dθ / ∫ 1/|v| dθ = I/T, and

    dM/dp = (dI/dp − M·dT/dp)/T        rms: d√M/dp = dM/dp / (2√M), M the mean of q²
"""

from __future__ import annotations

from functools import partial

import numpy as np
import xarray as xr

from linksweep.results.compute import changing_pace
from linksweep.results.derivatives.of_integrals import Integral, integral_derivatives
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene


def mean_derivatives(scene: Scene, name: str, power: int, to: tuple[str, ...]) -> dict[str, xr.DataArray]:
    """Return the derivatives of the mean over time of a power (1 or 2) of a quantity, by parameter."""
    pace = changing_pace(scene.at_one_angle)
    names = (name, *pace)
    slope_of_sum = _slope_of_pace if name in pace else _slope_of_weighted
    requests = {
        "sum": Integral(names, partial(_weighted, power), partial(slope_of_sum, power)),
        "time": Integral(names, partial(_weighted, 0), partial(_slope_of_weighted, 0)),
    }
    total = integral_derivatives(scene, requests, to)
    whole, time = total.values["sum"], total.values["time"]
    with np.errstate(all="ignore"):
        return {path: (total.slopes["sum", path] - whole / time * total.slopes["time", path]) / time for path in to}


def _weighted(power: int, value: Array, pace: Array | float = 1.0) -> Array:
    """Return q^n/|v|; NaN where either is not known."""
    return value**power / abs(pace) + 0.0 * (value / pace)


def _slope_of_weighted(power: int, value: Array, *others: Array) -> Array:
    """Return d(q^n/|v|)/dp from q, v, dq/dp and dv/dp, or from q and dq/dp alone."""
    pace, slope, slope_of_pace = others if len(others) == 3 else (np.ones(()), *others, np.zeros(()))
    of_value = power * value ** (power - 1) * slope if power else np.zeros(())
    return (of_value - value**power * slope_of_pace / pace) / np.abs(pace) + 0.0 * (value / pace)


def _slope_of_pace(power: int, pace: Array, *others: Array) -> Array:
    """Return d(v^n/|v|)/dp: 0 of the pace itself, of which the slopes of both would leave rounding errors."""
    _, slope, _ = others
    return (power - 1) * np.sign(pace) * pace ** (power - 2) * slope + 0.0 * pace
