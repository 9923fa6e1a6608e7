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
from typing import NamedTuple

import numpy as np
import xarray as xr

from linksweep.mechanisms import SliderCrank
from linksweep.mechanisms.content import ByContent
from linksweep.mechanisms.degrees import cos_sin
from linksweep.mechanisms.slider_crank import BRANCH_SIGN
from linksweep.mechanisms.validate import Number, is_lazy, parameter, problems, said

ATMOSPHERE = 101325.0


class Phase(NamedTuple):
    """A cylinder at crank angles: degrees turned since it fired, at its next bottom dead centre, and x/stroke."""

    turned: Number
    bottom: Number
    opened: Number


@dataclass(frozen=True, eq=False)
class OttoCycle(ByContent):
    """Ideal Otto cycle: isentropic compression and expansion, all the heat at top dead centre.

    Parameters
    ----------
    compression_ratio : largest over least volume [1]
    peak_pressure : right after combustion [Pa]
    intake_pressure : of intake and exhaust, absolute [Pa]
    gamma : ratio of the specific heats [1]
    strokes : 4 (the cycle takes 720 degrees) or 2 (360)

    Numbers may be DataArrays of design dims. It fires at the top dead centre of the first revolution, where the crank
    points along the guide to the head. A crank with omega2 < 0 runs through the same strokes, clockwise.

    Source: textbook air-standard analysis; efficiency 1 − r^(1 − γ).

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

    @property
    def period(self) -> float:
        return 180.0 * self.strokes

    def problems(self, path: str) -> list[str]:
        found = problems(self, path + ".") + _stroke_problems(path, self.strokes)
        end = "" if found else _below(self.peak_pressure, _compressed(self))
        return found or ([f"{path}.peak_pressure = {end}"] if end else [])

    def pressure(self, engine: SliderCrank, theta2, turning: Number = 1.0) -> xr.DataArray:
        """Absolute pressure [Pa] at crank angles [degree]; `turning` is -1 for a crank that turns clockwise."""
        return _pressure(self, self.peak_pressure, 1.0, phase(engine, theta2, turning, self.period))


@dataclass(frozen=True, eq=False)
class DieselCycle(ByContent):
    """Ideal Diesel cycle: isentropic compression and expansion, heat at constant pressure until the cutoff.

    Parameters
    ----------
    compression_ratio : largest over least volume [1]
    cutoff_ratio : volume at the end of combustion over the least [1], at most the compression ratio
    peak_pressure : during combustion [Pa]; default: that at the end of compression. Where given it is larger, and part
        of the heat comes at constant volume (mixed, or Seiliger cycle).
    intake_pressure, gamma, strokes : as `OttoCycle`

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

    @property
    def period(self) -> float:
        return 180.0 * self.strokes

    def problems(self, path: str) -> list[str]:
        found = problems(self, path + ".") + _stroke_problems(path, self.strokes)
        over = False if found else self.cutoff_ratio > self.compression_ratio
        if not is_lazy(over) and np.any(over):
            largest = float(np.max(self.cutoff_ratio))
            found.append(f"{path}.cutoff_ratio = {largest:.15g}: must be at most the compression ratio; reduce it")
        end = "" if found or self.peak_pressure is None else _below(self.peak_pressure, _compressed(self))
        return found or ([f"{path}.peak_pressure = {end}"] if end else [])

    def pressure(self, engine: SliderCrank, theta2, turning: Number = 1.0) -> xr.DataArray:
        """Absolute pressure [Pa] at crank angles [degree]; `turning` is -1 for a crank that turns clockwise."""
        peak = _compressed(self) if self.peak_pressure is None else self.peak_pressure
        return _pressure(self, peak, self.cutoff_ratio, phase(engine, theta2, turning, self.period))


Cycle = OttoCycle | DieselCycle


def phase(engine: SliderCrank, theta2, turning: Number, period: float) -> Phase:
    """Where a cylinder is in its cycle; NaN for designs whose crank does not turn fully."""
    angles = np.asarray(getattr(theta2, "values", theta2), dtype=float)
    theta2 = xr.DataArray(angles, {"theta2": angles}, "theta2")
    a, b, e = engine.crank.length, engine.rod.length, engine.offset
    sign, (top, bottom) = BRANCH_SIGN[engine.branch], engine.dead_centres()
    cos, sin = cos_sin(theta2 - engine.slide_angle)
    with np.errstate(all="ignore"):
        reach, least = np.sqrt((a + b) ** 2 - e**2), np.sqrt((b - a) ** 2 - e**2)
        opened = (reach - sign * a * cos - np.sqrt(b**2 - (e - a * sin) ** 2)) / (reach - least)
    turned, bottom = np.mod(turning * (theta2 - top), period), np.mod(turning * (bottom - top), 360.0)
    return Phase(turned, bottom, xr.where(engine.turns_fully, opened.clip(0.0, 1.0), np.nan))


def _pressure(cycle: Cycle, peak: Number, cutoff: Number, at: Phase) -> xr.DataArray:
    """The module's equations."""
    volume = 1.0 + (cycle.compression_ratio - 1.0) * at.opened  # over the least
    expansion = peak * np.minimum(1.0, cutoff / volume) ** cycle.gamma
    compression = cycle.intake_pressure * (cycle.compression_ratio / volume) ** cycle.gamma
    opens = at.bottom + (360.0 if cycle.strokes == 4 else 0.0)  # from blow-down to here the valves are open
    later = xr.where(at.turned < opens, cycle.intake_pressure, compression)
    later = later.where(at.opened.notnull())
    return xr.where(at.turned < at.bottom, expansion, later).transpose(..., "theta2")


def _compressed(cycle: Cycle) -> Number:
    """Pressure at the end of compression [Pa]."""
    return cycle.intake_pressure * cycle.compression_ratio**cycle.gamma


def _below(peak: Number, compressed: Number) -> str:
    """What is wrong with a peak pressure that compression alone exceeds."""
    peak, compressed = xr.broadcast(xr.DataArray(peak), xr.DataArray(compressed))
    if is_lazy(peak) or is_lazy(compressed) or not (short := (peak < compressed).values).any():
        return ""
    k = int(np.argmax(short))
    least = f"{compressed.values.reshape(-1)[k]:.6g} Pa"
    return f"{peak.values.reshape(-1)[k]:.15g} Pa: must be at least {least}, what compression alone gives"


def _stroke_problems(path: str, strokes: object) -> list[str]:
    if isinstance(strokes, int | float) and not isinstance(strokes, bool) and strokes in (2, 4):
        return []
    return [f"{path}.strokes = {said(strokes)}: must be 4 or 2"]
