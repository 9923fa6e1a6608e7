"""Fourier orders of a signal over the crank angle: its parts that turn once, twice, … as fast as the crank.

    F(θ2) = Σ (c_k cos kθ2 + s_k sin kθ2) = Σ A_k cos(kθ2 − φ_k)

Source: W. T. Thomson, Theory of Vibration with Applications (harmonic analysis); for engines C. F. Taylor, The
Internal-Combustion Engine in Theory and Practice, volume 2.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import xarray as xr

from linksweep.base.degrees import cos_sin
from linksweep.base.validate import count_problems, name_problems, quote, refuse
from linksweep.mechanisms import indices
from linksweep.results.compute import requested, require_results
from linksweep.results.dataset import by_command, with_units
from linksweep.results.origin.machine_of_results import cycle_of_results, name_in_results
from linksweep.scene.grid import whole_turns

TURN = 360.0


def orders(ds: xr.Dataset, of: str | Iterable[str], *, n: int = 12) -> xr.Dataset:
    """Compute the Fourier orders of signals over a whole cycle: of shaking forces, torques, accelerations.

    Parameters
    ----------
    ds : Dataset
        Cycle in equal steps, as from ``sweep(scene, theta2=720)``.
    of : str or iterable of str
        Names of its variables.
    n : int, default 12
        Highest order; a cycle of two turns (four-stroke) has half orders too, one of three turns has thirds.

    Returns
    -------
    Dataset
        Dim `order` (0, 1, 2, … n; 0 is the mean over theta2) in place of theta2. For each signal `Fsx_amplitude` and,
        in its unit, the coefficients `Fsx_cos`, `Fsx_sin`; and `Fsx_phase` [degree], the angle k·θ2 at which the order
        is largest. A design with a sample that is not ok has NaN.

    Raises
    ------
    ValueError
        If a name is unknown, the angles are no whole cycle in equal steps (of cranks geared by p/q, q turns; of loads
        that repeat after two turns, both), or n is more than half the samples of a turn.

    Notes
    -----
    Sums over samples: of a smooth signal exact to rounding for all orders below the sampling's limit; of a signal with
    jumps, amplitudes err by about the jump divided by the number of samples.

    Examples
    --------
    >>> import linksweep as ls
    >>> shaking = ls.sweep(ls.example("engine"), of=["Fsx", "Fsy"])
    >>> parts = ls.orders(shaking, "Fsy", n=4)
    >>> parts.Fsy_amplitude.sel(order=[1, 2]).round(-1).values.tolist()
    [4460.0, 820.0]
    """
    require_results(ds, "ls.sweep")
    names = [name_in_results(ds, name) for name in requested("of", of)]
    index = next((dim for dim in indices() if dim in ds.dims), "theta2")
    refuse([] if index in ds.dims else [f"ds has no dimension {index}: take what ls.sweep returns"])
    refuse(["of = 'status': is a code without orders; name quantities, such as F32"] if "status" in names else [])
    known = [str(name) for name in ds.data_vars if name != "status"]
    refuse([problem for name in names for problem in name_problems("of", name, known)] + count_problems("n", n))
    angles = ds[index].values.astype(float)
    period = _period(angles, index)
    whole = cycle_of_results(ds, names) or TURN
    part = f"{index} covers {period:g} degrees, but motion and loads repeat after {whole:g}: sweep with a count, "
    refuse([f"{part}such as {index}={2.0 * whole:g}"] if period % whole else [])
    most = len(angles) * TURN / period / 2.0
    few = f"n = {quote(n)}: must be less than {most:g}, half the samples of a turn; or sweep at more angles"
    refuse([] if n < most else [few])
    order = np.arange(int(n * period / TURN) + 1) * (TURN / period)
    waves = [xr.DataArray(wave, dims=("order", index)) for wave in cos_sin(np.multiply.outer(order, angles))]
    weight = xr.DataArray(np.where(order == 0.0, 1.0, 2.0) / len(angles), dims="order")
    variables: dict[str, xr.DataArray] = {}
    for name in names:
        signal = ds[name].broadcast_like(ds[index])  # a constant has a mean alone
        variables |= _named(name, ds[name], *(weight * xr.dot(signal, wave, dim=index) for wave in waves))
    attributes = {"units": "1", "long_name": f"cycles in one turn of {index}"}
    origin = ds.attrs | by_command(f"linksweep.orders(ds, {names}, n={n})")
    return xr.Dataset(variables, attrs=origin).assign_coords(order=("order", order, attributes))


def _named(name: str, signal: xr.DataArray, cos: xr.DataArray, sin: xr.DataArray) -> dict[str, xr.DataArray]:
    units, name_of = signal.attrs.get("units", ""), signal.attrs.get("long_name", name)
    amplitude, phase = np.hypot(cos, sin), np.degrees(np.arctan2(sin, cos))
    parts = {
        f"{name}_amplitude": (amplitude, units, f"amplitude of each order of: {name_of}"),
        f"{name}_phase": (phase, "degree", f"order times crank angle at which each order is largest of: {name_of}"),
        f"{name}_cos": (cos, units, f"coefficient of the cosine of each order of: {name_of}"),
        f"{name}_sin": (sin, units, f"coefficient of the sine of each order of: {name_of}"),
    }
    return {key: values.transpose(..., "order") for key, values in with_units(parts).items()}


def _period(angles: np.ndarray, index: str) -> float:
    """Return the turns [degree] that the angles divide evenly, in any order."""
    period = whole_turns(np.sort(angles), TURN) if len(angles) > 2 else None
    if period is not None:
        return period
    raise ValueError(
        f"{index} has {len(angles)} angles from {angles.min():g} to {angles.max():g}: orders take a whole cycle in "
        f"equal steps; sweep with a count, such as {index}=720"
    )
