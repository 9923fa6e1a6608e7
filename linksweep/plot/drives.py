"""Plots of a drive: the speed with a flywheel and on a motor, a run-up, and a motor's load beside its curve."""

from __future__ import annotations

from dataclasses import replace
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.analysis.drive.motors.curve import Motor
from linksweep.analysis.drive.motors.motor import AnyMotor, motor_problems
from linksweep.base.validate import refuse
from linksweep.files.netcdf import scene_of
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import BLUE, GREY, ORANGE, SHADE, SKY, VERMILION
from linksweep.plot.kit.style import axes_or_new, crank_angles, grid, legend_above, panels
from linksweep.results.compute import require_results
from linksweep.results.origin.in_shown_units import results_in_shown_units, units_of
from linksweep.results.sweep import sweep
from linksweep.scene.shown_units import UnitSystem
from linksweep.tables.of_drive import NO_SPEED
from linksweep.tables.of_runs import failure_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROUNDING = 1e-9  # of the largest torque: the mean of one that does no work
BETWEEN = 20
"""Points drawn from the end of a step of a run to that of the next."""
ON_MOTOR = {
    "speed": "crank speed $|\\omega_2|$",
    "motor_torque": "motor torque",
    "motor_power": "motor power",
}
"""Words on the axes of a steady cycle, by the stem of the extremes."""


def flywheel(ds: xr.Dataset, *, ax: Axes | None = None) -> Axes:
    """Plot the crank's speed over the cycle with a flywheel, its exact largest and least marked.

    Parameters
    ----------
    ds : Dataset
        Result of `linksweep.flywheel`, of one design.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with inertia and fluctuation in the title.

    Raises
    ------
    ValueError
        For a Dataset without speed at every angle, and for more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.plot.flywheel(ls.flywheel(ls.example("press"), fluctuation=0.05)).get_ylabel()
    'crank speed $\\\\omega_2$ [rad/s]'
    """
    require_results(ds, "ls.flywheel")
    known = {"speed", "speed_max"} <= ds.keys()
    refuse([] if known else ["ds has no speed with its extremes: take what ls.flywheel returns"])
    signals.require_angles(ds)
    ds = results_in_shown_units(ds)
    angles, speed = signals.revolution(ds, ds["speed"])
    refuse([] if np.isfinite(speed).all() else ["ds has no speed at some angle: it stalls, or does not turn fully"])
    ax = grid(axes_or_new(ax))
    ax.axhline(0.5 * float(ds["speed_max"] + ds["speed_min"]), color=GREY, linestyle="--", linewidth=1.0)
    ax.plot(angles, speed, color=BLUE, label="_speed")
    unit, of_size = signals.unit(ds["speed"], ""), signals.unit(ds["flywheel_inertia"], "").replace("^2", "²")
    for end in ("max", "min"):
        place, value = float(ds[f"speed_{end}_at"]), float(ds[f"speed_{end}"])
        if angles[0] <= place <= angles[-1]:  # of a cycle that was not cut
            _mark(ax, end, place, value, unit)
    size, fluctuation = float(ds["flywheel_inertia"]), float(ds["fluctuation"])
    ax.set_title(f"flywheel {signals.number(size)} {of_size}, fluctuation {100.0 * fluctuation:.3g} %", loc="left")
    crank_angles(ax, angles)
    ax.margins(y=0.18)
    ax.set_ylabel(f"crank speed $\\omega_2$ [{unit}]")
    return ax


def torque_with_flywheel(ds: xr.Dataset) -> Figure:
    """Plot the drive's torque without and with a flywheel, and the speed of the crank with it.

    Parameters
    ----------
    ds : Dataset
        From `linksweep.flywheel`, of one design.

    Returns
    -------
    matplotlib Figure
        Above the torque on the crank that keeps its speed constant, and the constant one that is enough with the
        flywheel: where that gives more, the crank gains speed. Below that speed, as in `flywheel`.

    Raises
    ------
    ValueError
        For a Dataset without speed at every angle, more than one design, and an engine of several cylinders.

    Examples
    --------
    >>> import linksweep as ls
    >>> figure = ls.plot.torque_with_flywheel(ls.flywheel(ls.example("press"), fluctuation=0.05))
    >>> [ax.get_ylabel() for ax in figure.axes]
    ['torque on the crank [N m]', 'crank speed $\\\\omega_2$ [rad/s]']
    """
    require_results(ds, "ls.flywheel")
    alone = "ds holds no scene of one machine, as of an engine of several cylinders: draw its speed with plot.flywheel"
    refuse([] if "scene" in ds.attrs else [alone])
    with panels(2, 1, figsize=(7.1, 5.4)) as (figure, (above, below)):
        flywheel(ds, ax=below)
        _torques(above, ds)
    return figure


def _torques(ax: Axes, wheel: xr.Dataset) -> None:
    """Draw the torque at constant speed around the constant torque, excess and lack shaded."""
    steady = replace(scene_of(wheel, whole=False), alpha2=0.0)
    cycle = results_in_shown_units(sweep(steady, wheel[signals.INDEX].values, of=["reduced_torque"]))
    wheel, unit = results_in_shown_units(wheel), signals.unit(cycle["reduced_torque"], "")
    angles, without = signals.revolution(cycle, cycle["reduced_torque"])
    constant = float(wheel["drive_torque"])
    grid(ax)
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    more = (constant - without) * np.sign(float(wheel["speed"].mean())) > 0.0
    for where, color, text in ((more, SKY, "gains speed"), (~more, ORANGE, "loses speed")):
        ax.fill_between(angles, without, constant, where=where, color=color, alpha=0.4, linewidth=0.0, label=text)
    ax.plot(angles, without, color=BLUE, label="without flywheel")
    size = constant if abs(constant) > ROUNDING * np.max(np.abs(without)) else 0.0
    text = f"with it, constant: {signals.number(size)} {unit}"
    ax.axhline(constant, color=VERMILION, linestyle="--", label=text)
    crank_angles(ax, angles)
    ax.margins(y=0.12)
    ax.set_ylabel(f"torque on the crank [{unit}]")
    legend_above(ax, ncols=4)


def _mark(ax: Axes, end: str, place: float, value: float, unit: str) -> None:
    """Mark an extreme, "max" or "min", with its value."""
    from linksweep.plot.kit.labels import label

    ax.plot([place], [value], "o", color=BLUE, markersize=4.5, label=f"_{end}")
    label(ax, place, value, (f"{end} {_five_digits(value)} {unit}", BLUE))


def steady_cycle(ds: xr.Dataset) -> Figure:
    """Plot a machine on its motor over the cycle that repeats: the crank's speed, and the motor's torque and power.

    Parameters
    ----------
    ds : Dataset
        Result of `linksweep.steady_cycle`, of one design.

    Returns
    -------
    matplotlib Figure
        Panels of speed, torque and power over the crank angle, the largest and least of each marked with their exact
        values, and dashed the means over time of speed and power.

    Raises
    ------
    ValueError
        For a Dataset without a whole steady cycle, a machine that does not keep turning, and more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> motor = ls.DCMotor(stall_torque=10.0, no_load_speed=160.0, inertia=0.004)
    >>> cycle = ls.steady_cycle(ls.example("press"), motor, ratio=5.0, flywheel=0.2, theta2=72)
    >>> [ax.get_ylabel() for ax in ls.plot.steady_cycle(cycle).axes]
    ['crank speed $|\\\\omega_2|$ [rad/s]', 'motor torque [N m]', 'motor power [W]']
    """
    require_results(ds, "ls.steady_cycle")
    known = {"omega2", "motor_torque_max", "motor_power_max", "speed_max"} <= ds.keys()
    refuse([] if known else ["ds has no cycle on a motor: take what ls.steady_cycle returns"])
    signals.require_angles(ds)
    signals.require_one_design([ds["speed_max"]])
    word = ds["status"].attrs["flag_meanings"].split()[int(ds["status"])]
    refuse([] if word == "ok" else [f"ds has no speed: {NO_SPEED[word]}"])
    curves = abs(ds["omega2"]), ds["motor_torque"], ds["motor_power"]
    angles, *rows = signals.revolution(ds, *curves)
    whole = np.ptp(angles) >= 360.0
    refuse([] if whole else ["ds has a part of the cycle: take all angles of ls.steady_cycle, at least three"])
    with panels(3, 1, sharex=True, figsize=(7.1, 6.6)) as (figure, axes):
        for ax, name, row in zip(axes, ON_MOTOR, rows, strict=True):
            _on_motor(ax, ds, name, angles, row)
        crank_angles(axes[-1], angles)
        axes[0].set_title(f"fluctuation {100.0 * float(ds['fluctuation']):.3g} %", loc="left")
    return figure


def _on_motor(ax: Axes, ds: xr.Dataset, name: str, angles: np.ndarray, values: np.ndarray) -> None:
    """Draw a curve of a steady cycle, with its mean over time and its exact extremes."""
    system, of = units_of(ds), ds[f"{name}_max"].attrs["units"]
    unit, row = system.unit(of), system.value(values, of)
    grid(ax)
    ax.plot(angles, row, color=BLUE, label=f"_{name}")
    if f"{name}_mean" in ds:
        mean = float(system.value(float(ds[f"{name}_mean"]), of))
        mean = mean if abs(mean) > ROUNDING * np.max(np.abs(row)) else 0.0
        ax.axhline(mean, color=GREY, linestyle="--", linewidth=1.0, label=f"mean {_five_digits(mean)} {unit}")
        legend_above(ax, loc="lower right", bbox_to_anchor=(1.0, 1.0))
    steady = np.ptp(row) <= ROUNDING * np.max(np.abs(row))
    for end, sign in () if steady else (("max", 1.0), ("min", -1.0)):
        value = float(system.value(float(ds[f"{name}_{end}"]), of))
        _mark(ax, end, _summit(angles, sign * row), value, unit)
    ax.margins(y=0.2)
    if steady:
        ax.set_ylim(*sorted((0.0, 1.2 * row[0] or 1.0)))
    ax.set_ylabel(f"{ON_MOTOR[name]} [{unit}]")


def _five_digits(value: float) -> str:
    return f"{value:#.5g}".rstrip(".").replace("-", "−") if value else "0"


def _summit(angles: np.ndarray, values: np.ndarray) -> float:
    """Return the angle of the largest value [degree]: of the parabola through the largest sample and those beside."""
    k = int(np.argmax(values[:-1]))
    before, top, after = values[k - 1 if k else -2], values[k], values[k + 1]
    bend = before - 2.0 * top + after
    return float(angles[k] + (0.5 * (before - after) / bend * (angles[1] - angles[0]) if bend < 0.0 else 0.0))


def motor_load(ds: xr.Dataset, motor: AnyMotor, *, ax: Axes | None = None) -> Axes:
    """Plot the torque that a motor must give over its speed, beside the most that it can give.

    Parameters
    ----------
    ds : Dataset
        Result of `linksweep.motor_load`, of one design.
    motor : Motor, InductionMotor, DCMotor or GovernedMotor
        Motor of that result, of one design.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with the path in red where the motor is too weak, and the exact least margin of the torque.

    Raises
    ------
    ValueError
        For a Dataset without a motor's torque, for what is no motor, and for more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> servo = ls.Motor(speeds=(0.0, 300.0, 600.0), torques=(4.0, 4.0, 1.0), inertia=2e-4)
    >>> load = ls.motor_load(ls.example("press"), servo, ratio=10.0)
    >>> ls.plot.motor_load(load, servo).get_xlabel()
    'motor speed [rad/s]'
    """
    require_results(ds, "ls.motor_load")
    known = {"motor_torque", "torque_margin_min"} <= ds.keys()
    refuse(motor_problems(motor))
    refuse([] if known else ["ds has no motor_torque with its least margin: take what ls.motor_load returns"])
    signals.require_angles(ds)
    results, system, ds = ds, units_of(ds), results_in_shown_units(ds)
    _, speed, torque, margin = signals.revolution(ds, ds["motor_speed"], ds["motor_torque"], ds["torque_margin"])
    ax = grid(axes_or_new(ax))
    side = -1.0 if np.nanmean(speed) < 0.0 else 1.0
    speeds = np.asarray(motor.speeds if isinstance(motor, Motor) else np.linspace(0.0, float(motor.top_speed), 201))
    torques = np.asarray(motor.torque_at(speeds))
    curve = side * system.value(speeds, "rad/s"), system.value(torques, "N m")
    ax.fill_between(curve[0], -curve[1], curve[1], color=SHADE, linewidth=0.0, label="what the motor can give")
    ax.plot(np.r_[curve[0], curve[0][::-1]], np.r_[curve[1], -curve[1][::-1]], color=GREY, linewidth=1.0)
    ax.plot(speed, torque, color=BLUE, linewidth=1.6, label="what the machine takes")
    if (margin < 0.0).any():
        ax.plot(speed, np.where(margin < 0.0, torque, np.nan), color=VERMILION, linewidth=2.4, label="too much")
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    _least_margin(ax, results, motor, system)
    ax.set(xlabel=f"motor speed [{system.unit('rad/s')}]", ylabel=f"motor torque [{system.unit('N m')}]")
    ax.margins(y=0.12)
    ax.legend(fontsize="small", frameon=False)
    return ax


def _least_margin(ax: Axes, ds: xr.Dataset, motor: AnyMotor, system: UnitSystem) -> None:
    """Mark the exact least margin of a motor's torque, of results in SI units."""
    from linksweep.plot.kit.labels import label

    angles, speeds, torques = signals.revolution(ds, ds["motor_speed"], ds["motor_torque"])
    place, margin = float(ds["torque_margin_min_at"]), float(ds["torque_margin_min"])
    if not (angles[0] <= place <= angles[-1] and np.isfinite(margin)):  # of a cycle that was cut
        return
    speed, side = np.interp(place, angles, speeds), np.sign(np.interp(place, angles, torques))
    x, y = system.value(speed, "rad/s"), system.value(side * (float(motor.torque_at(abs(speed))) - margin), "N m")
    color = VERMILION if margin < 0.0 else BLUE
    ax.plot([x], [y], "o", color=color, markersize=4.5, label="_worst")
    text = f"least margin {signals.number(float(system.value(margin, 'N m')))} {system.unit('N m')}"
    label(ax, x, y, (text, color))


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
        Axes of the speed; those of the torque share its time. A run that comes to nothing says so there.

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
    require_results(ds, "ls.run_up")
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
    lines, beside = ax.get_lines(), ax
    if torque is not None:
        beside = ax.twinx()
        row = system.value(torque, "N m")  # of turning backwards, it may lie on the speed
        lines += beside.plot(time, row, "-.", color=VERMILION, linewidth=1.2, label="motor torque")
        beside.set_ylabel(f"motor torque [{system.unit('N m')}]")
    if len(time) > 1:
        legend_above(ax, handles=lines, ncols=3)
    if "status" in ds and (failure := failure_of(ds)):
        box = {"facecolor": ax.get_facecolor(), "linewidth": 0.0, "alpha": 0.8}
        middle: dict[str, Any] = {"ha": "center", "va": "center", "transform": ax.transAxes, "bbox": box}
        beside.text(0.5, 0.5, fill(failure, 50), fontsize="small", color=GREY, **middle)
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
