"""Plot of a run-up or a run-down: the crank's speed over time, and the motor's torque."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from linksweep.base.validate import refuse
from linksweep.plot.kit.colors import BLUE, GREY, VERMILION
from linksweep.plot.kit.style import axes_or_new, grid, legend_above
from linksweep.results.compute import require_dataset
from linksweep.results.origin.in_shown_units import units_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BETWEEN = 20
"""Points drawn from the end of a step to that of the next."""


def run_up(ds: xr.Dataset, *, ax: Axes | None = None) -> Axes:
    """Plot the crank's speed over the time of a run-up or a run-down, and the torque of the motor.

    Parameters
    ----------
    ds : Dataset
        Result of `linksweep.run_up` or `linksweep.run_down`, of one design.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes of the speed; those of the torque share its time.

    Raises
    ------
    ValueError
        For a Dataset without a run, and for more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> motor = ls.DCMotor(stall_torque=10.0, no_load_speed=160.0, inertia=0.004)
    >>> ls.plot.run_up(ls.run_up(ls.example("press"), motor, ratio=5.0, until=0.5)).get_xlabel()
    'time [s]'
    """
    require_dataset(ds, "ls.run_up")
    refuse([] if {"time", "speed", "acceleration"} <= ds.keys() else ["ds has no run: take what ls.run_up returns"])
    others = [dim for dim in ds["time"].dims if dim != "step"]
    refuse([f"ds has several designs, over {', '.join(map(str, others))}: choose one with isel"] if others else [])
    ax, system = grid(axes_or_new(ax)), units_of(ds)
    time, speed, torque = _between(ds)
    ax.plot(time, system.value(speed, "rad/s"), color=BLUE, label="crank speed")
    if "operating_speed" in ds and np.isfinite(ds["operating_speed"]):
        usual = np.sign(speed[-1]) * float(ds["operating_speed"])
        ax.axhline(system.value(usual, "rad/s"), color=GREY, linestyle="--", linewidth=1.0, label="operating point")
    ax.set(xlabel="time [s]", ylabel=f"crank speed $\\omega_2$ [{system.unit('rad/s')}]")
    ax.margins(x=0.0)
    lines = ax.get_lines()
    if torque is not None:
        beside = ax.twinx()
        lines += beside.plot(time, system.value(torque, "N m"), color=VERMILION, linewidth=1.0, label="motor torque")
        beside.set_ylabel(f"motor torque [{system.unit('N m')}]")
    legend_above(ax, handles=lines, ncols=3)
    return ax


def _between(ds: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Return time, speed and torque at the ends of steps and between them: a cubic with the accelerations."""
    from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

    known = np.isfinite(ds["time"].values)
    time, speed, rise = (ds[name].values[known] for name in ("time", "speed", "acceleration"))
    if len(time) < 2:
        return time, speed, ds["motor_torque"].values[known] if "motor_torque" in ds else None
    places = np.arange((len(time) - 1) * BETWEEN + 1) / BETWEEN
    fine = np.interp(places, np.arange(len(time)), time)
    torque = PchipInterpolator(time, ds["motor_torque"].values[known])(fine) if "motor_torque" in ds else None
    return fine, CubicHermiteSpline(time, speed, rise)(fine), torque
