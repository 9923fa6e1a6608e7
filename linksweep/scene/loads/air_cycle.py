"""Ideal air-standard cycles: the pressure in a cylinder over the crank angle, from the slider-crank's own volume.

With x the slider's distance from top dead centre and r the compression ratio, V/Vc = 1 + (r − 1)·x/stroke. Then

    compression  p = p1·(r·Vc/V)^γ                      from bottom dead centre, p1 the intake pressure
    combustion   up to p3 at top dead centre (Otto), or at p3 = p1·r^γ until V = cutoff·Vc (Diesel)
    expansion    p = p3·(cutoff·Vc/V)^γ                 to bottom dead centre, where it blows down to p1
    exhaust and intake at p1                            a further revolution, in four strokes

Combustion at top dead centre and blow-down at bottom dead centre take no time: there the pressure jumps, and the
sample at that very angle has the value after the jump.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.checked_number import checked_number
from linksweep.base.equality import ByContent
from linksweep.base.fields import field_problems, numbers, parameter
from linksweep.base.frozen import bare
from linksweep.base.validate import Number, Rule, as_float, is_lazy, quote, refuse
from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.capabilities import lack
from linksweep.mechanisms.cylinder import PistonCylinder
from linksweep.scene.dimensions import argument_problems, dims_of
from linksweep.scene.grid import crank_grid
from linksweep.scene.parameters import along

ATMOSPHERE = 101325.0


class Cycle(ByContent):
    """An ideal air cycle: a frozen dataclass with these fields, and a `cutoff_ratio` where combustion goes on."""

    compression_ratio: Number
    peak_pressure: Number | None
    intake_pressure: Number
    gamma: Number
    strokes: int
    cutoff_ratio: Number = 1.0

    @property
    def period(self) -> float:
        """Crank angle of a whole cycle [degree]."""
        return 180.0 * float(self.strokes)

    @property
    def compressed(self) -> Number:
        """Pressure at the end of compression [Pa]."""
        try:
            with np.errstate(over="ignore"):
                return self.intake_pressure * self.compression_ratio**self.gamma
        except OverflowError:
            return np.inf

    @property
    def combustion(self) -> tuple[Number, Number]:
        """Pressure during or right after combustion [Pa], and the volume at its end over the least."""
        return self.compressed if self.peak_pressure is None else self.peak_pressure, self.cutoff_ratio

    def problems(self, path: str) -> list[str]:
        """Return the problems of the cycle.

        Parameters
        ----------
        path : str
            Path of the cycle, with which each problem begins.

        Returns
        -------
        list of str
            One line for each problem.
        """
        problems = field_problems(self, path + ".")
        if as_float(self.strokes) not in (2.0, 4.0):
            problems.append(f"{path}.strokes = {quote(self.strokes)}: must be 4 or 2")
        problems = problems or argument_problems({}, **{path: self})
        return problems or self._compression_problems(path) or self._combustion_problems(path)

    def pressure(self, engine: Mechanism, theta2, turning: Number = 1.0) -> xr.DataArray:
        """Return the absolute pressure at crank angles.

        Parameters
        ----------
        engine : Mechanism
            SliderCrank whose cylinder the cycle runs in.
        theta2 : int or array_like
            Count of crank angles of a whole cycle, or the angles themselves [degree].
        turning : float or DataArray, default 1.0
            Sense of rotation of the crank [1]: 1 counter-clockwise, -1 clockwise.

        Returns
        -------
        DataArray
            Pressure [Pa] over the design dims and theta2; NaN for designs whose crank does not turn fully.

        Raises
        ------
        ValueError
            If a number of the cycle is out of bounds, the engine has no cylinder or both branches, an angle is no
            finite number, `turning` is neither 1 nor -1, or arrays over one dim differ in length or labels.
        """
        refuse(self.problems("cycle") + _misfits(engine))
        refuse(argument_problems({}, engine=engine, cycle=self, turning=turning))
        turning = checked_number("turning", turning, Rule("dimensionless"))
        either_way = is_lazy(turning) or np.isin(turning, (1.0, -1.0)).all()
        refuse([] if either_way else [f"turning = {quote(turning)}: must be 1 or -1, the sign of omega2"])
        angles = crank_grid(theta2, self.period).angles
        pressure = pressure_over(self, engine.engine_cylinder, angles, turning)
        labels: dict[Any, xr.Variable] = {}
        for array in [*(number for owner in (self, engine) for _, number, _ in numbers(owner)), turning]:
            if isinstance(array, xr.DataArray):
                dims = [dim for dim in array.dims if dim in array.coords and dim in pressure.dims]
                labels |= {dim: array[dim].variable for dim in dims}
        return xr.DataArray(pressure, labels | {"theta2": angles})

    def _compression_problems(self, path: str) -> list[str]:
        """Return why the compression can't be computed."""
        if is_lazy(self.compressed) or np.isfinite(self.compressed).all():
            return []
        largest = f"{float(np.max(self.compression_ratio)):.15g}"
        return [f"{path}.compression_ratio = {largest}: compresses to more than 1.8e308 Pa; reduce it, or gamma"]

    def _combustion_problems(self, path: str) -> list[str]:
        """Return the problem of a combustion that ends beyond the largest volume, or below compression's pressure."""
        over = self.cutoff_ratio > self.compression_ratio
        if not is_lazy(over) and np.any(over):
            largest = float(np.max(self.cutoff_ratio))
            return [f"{path}.cutoff_ratio = {largest:.15g}: must be at most the compression ratio; reduce it"]
        too_low = self.peak_pressure is not None and self.peak_pressure < self.compressed
        if is_lazy(too_low) or not np.any(too_low):
            return []
        peak, compressed = xr.broadcast(xr.DataArray(self.peak_pressure), xr.DataArray(self.compressed))
        k = int(np.argmax((peak < compressed).values))
        least = f"{compressed.values.reshape(-1)[k]:.6g} Pa, what compression alone gives"
        return [f"{path}.peak_pressure = {peak.values.reshape(-1)[k]:.15g} Pa: must be at least {least}"]


@dataclass(frozen=True, eq=False, repr=False)
class OttoCycle(Cycle):
    """Ideal Otto cycle: isentropic compression and expansion, all heat added at top dead centre.

    Parameters
    ----------
    compression_ratio : float or DataArray
        Largest over least volume [1].
    peak_pressure : float or DataArray
        Absolute pressure right after combustion [Pa].
    intake_pressure : float or DataArray, default 101325.0
        Absolute pressure of intake and exhaust [Pa].
    gamma : float or DataArray, default 1.4
        Ratio of the specific heats [1].
    strokes : int, default 4
        Strokes of a cycle: 4 (the cycle takes 720 degrees) or 2 (360).

    Notes
    -----
    It fires at top dead centre, in four strokes once in 720 degrees: at theta2 = ψ + δ with ψ = `slide_angle`, or with
    branch "crossed" at ψ − δ with ψ = slide_angle + 180. ψ is counted in [0, 360), so that slide_angle=-1 fires at 359,
    and δ = arcsin(offset/(crank + rod)) may lead to the end of the second revolution: −3 degrees are 717. Mind the
    revolution beside other loads that take two turns.

    A crank with omega2 < 0 runs through the same strokes, clockwise. The scene that takes the cycle checks its numbers,
    as `pressure` does, and raises ValueError. Source: textbook air-standard analysis; efficiency 1 − r^(1 − γ).

    Examples
    --------
    >>> import linksweep as ls
    >>> engine = ls.SliderCrank(ls.Link(0.04, 1, 0), ls.Link(0.14, 1, 0), slider_mass=0.5)
    >>> cycle = ls.OttoCycle(compression_ratio=8.0, peak_pressure=5e6)
    >>> cycle.pressure(engine, [0.0, 180.0, 540.0]).values.round().tolist()
    [5000000.0, 101325.0, 101325.0]
    """

    compression_ratio: Number = parameter("dimensionless", above=1.0)
    peak_pressure: Number = parameter("pressure", above=0.0)
    intake_pressure: Number = parameter("pressure", ATMOSPHERE, above=0.0)
    gamma: Number = parameter("dimensionless", 1.4, above=1.0)
    strokes: int = 4


@dataclass(frozen=True, eq=False, repr=False)
class DieselCycle(Cycle):
    """Ideal Diesel cycle: isentropic compression and expansion, heat added at constant pressure until the cutoff.

    Parameters
    ----------
    compression_ratio : float or DataArray
        Largest over least volume [1].
    cutoff_ratio : float or DataArray
        Volume at the end of combustion over the least [1], at most the compression ratio.
    peak_pressure : float or DataArray, default None
        Absolute pressure during combustion [Pa]; None for that at the end of compression. A larger one adds part of
        the heat at constant volume (mixed, or Seiliger cycle).
    intake_pressure : float or DataArray, default 101325.0
        Absolute pressure of intake and exhaust [Pa].
    gamma : float or DataArray, default 1.4
        Ratio of the specific heats [1].
    strokes : int, default 4
        Strokes of a cycle: 4 (the cycle takes 720 degrees) or 2 (360).

    Notes
    -----
    It fires where an `OttoCycle` does, and the scene that takes it checks its numbers. Source: textbook air-standard
    analysis.

    Examples
    --------
    >>> import linksweep as ls
    >>> engine = ls.SliderCrank(ls.Link(0.04, 1, 0), ls.Link(0.14, 1, 0), slider_mass=0.5)
    >>> cycle = ls.DieselCycle(compression_ratio=18.0, cutoff_ratio=2.0, intake_pressure=1e5)
    >>> cycle.pressure(engine, [0.0, 10.0]).values.round().tolist()
    [5719809.0, 5719809.0]
    """

    compression_ratio: Number = parameter("dimensionless", above=1.0)
    cutoff_ratio: Number = parameter("dimensionless", above=1.0)
    peak_pressure: Number | None = parameter("pressure", None, above=0.0)
    intake_pressure: Number = parameter("pressure", ATMOSPHERE, above=0.0)
    gamma: Number = parameter("dimensionless", 1.4, above=1.0)
    strokes: int = 4


CYCLES = (OttoCycle, DieselCycle)


def _misfits(engine: Mechanism) -> list[str]:
    """Return why an engine has no cylinder for a cycle."""
    if not isinstance(engine, Mechanism):
        return [f"engine is a {type(engine).__name__}: must be a SliderCrank"]
    if missing := lack(engine, "engine_cylinder"):
        return [f"engine is {missing}"]
    both = 'engine.branch = "both": must be "open" or "crossed"; a cylinder has one head'
    return [both] if "branch" in engine.both_branches else []


def pressure_over(cycle: Cycle, cylinder: PistonCylinder, angles: Any, turning: Number) -> Any:
    """Return the pressure [Pa] over the dims of all numbers that it takes, then theta2; labels are left out.

    NaN for designs whose crank does not turn fully. The module's equations. Of numbers with slopes one with slopes.
    """
    numbers_of_cycle = (*bare(cycle).combustion, cycle.compression_ratio, cycle.gamma, cycle.intake_pressure)
    taken = (turning, cylinder.slide_angle, cylinder.offset, cylinder.crank, cylinder.rod, *numbers_of_cycle)
    dims = (*(dim for dim in dims_of(taken) if dim != "theta2"), "theta2")
    cycle, cylinder, turning = along(cycle, dims), along(cylinder, dims), along(turning, dims)
    (peak, cutoff), (top, bottom), opened = cycle.combustion, cylinder.dead_centres(), cylinder.opening(angles)
    turned, bottom = np.mod(turning * (angles - top), cycle.period), np.mod(turning * (bottom - top), 360.0)
    volume = 1.0 + (cycle.compression_ratio - 1.0) * opened  # over the least
    expansion = peak * np.minimum(1.0, cutoff / volume) ** cycle.gamma
    compression = cycle.intake_pressure * (cycle.compression_ratio / volume) ** cycle.gamma
    opens = bottom + (360.0 if cycle.strokes == 4 else 0.0)  # from blow-down to here the valves are open
    later = np.where(turned < opens, cycle.intake_pressure, compression)
    later = np.where(np.isnan(opened), np.nan, later)
    pressure = np.where(turned < bottom, expansion, later)
    return xr.Variable(dims, pressure) if isinstance(pressure, np.ndarray) else pressure
