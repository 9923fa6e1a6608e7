"""Gas pressure on the slider of a slider-crank: what an engine, a pump or a compressor has in its cylinder."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from linksweep.mechanisms import SliderCrank
from linksweep.mechanisms.actions import LoadForm
from linksweep.mechanisms.slider_crank import BRANCH_SIGN
from linksweep.mechanisms.validate import Number, Rule, parameter, problems
from linksweep.scene.air_cycle import ATMOSPHERE, Cycle, dead_centres, turns_fully

PRESSURE = Rule("pressure", over_angle=True)


@dataclass(frozen=True)
class GasPressure:
    """Gas pressure in the cylinder, as a load on the slider of a `SliderCrank`.

    Parameters
    ----------
    bore : diameter of the cylinder [m]
    pressure : in the cylinder, absolute [Pa]: a number, a DataArray, a function of theta2 [degree], or an `OttoCycle`
        or `DieselCycle`, which need no data
    crankcase : pressure on the other side of the piston, absolute [Pa]

    The force acts at C along the guide, (p − crankcase)·π·bore²/4. The head is where the rod reaches farthest: ahead
    of the slider (branch "open"), so that pressure above the crankcase's pushes it back, against the guide's
    direction; with branch "crossed" the head is behind, and pressure pushes it forward.

    A DataArray over theta2 is interpolated by a periodic cubic spline at angles that it does not hold. One that spans
    more than 360 degrees makes the scene's period 720, and so does a cycle of four strokes.

    In a study, a design whose crank does not turn fully has no cycle: there an ideal cycle gives no force.

    Raises
    ------
    ValueError
        By the scene that takes it: for a mechanism without such a cylinder, branch="both", numbers out of bounds,
        and a cycle in an engine whose crank does not turn fully.

    Examples
    --------
    >>> import linksweep as ls
    >>> engine = ls.SliderCrank(ls.Link(0.04, 1, 0), ls.Link(0.14, 1, 0), slider_mass=0.5)
    >>> gas = ls.GasPressure(bore=0.086, pressure=ls.OttoCycle(compression_ratio=10.0, peak_pressure=6e6))
    >>> ls.Scene(engine, omega2=300.0, loads=[gas]).period
    720.0
    """

    bore: Number = parameter("length", above=0.0)
    pressure: Number | Cycle = parameter("pressure", over_angle=True)
    crankcase: Number = parameter("pressure", ATMOSPHERE, over_angle=True)

    force: ClassVar[Number] = 0.0  # along the guide [N]; each instance brought to crank angles has its own
    link = "slider"
    form = LoadForm("slider", force=True, torque=False, link_axes=True)

    @property
    def cycle(self) -> Cycle | None:
        return self.pressure if isinstance(self.pressure, Cycle) else None

    @property
    def period(self) -> float:
        """Of the cycle [degree]; 0 where there is none."""
        return self.cycle.period if self.cycle else 0.0

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        given = self if self.cycle is None else replace(self, pressure=ATMOSPHERE)
        return problems(given, path + ".") + (self.cycle.problems(f"{path}.pressure") if self.cycle else [])

    def misfits(self, path: str, mechanism: Any) -> list[str]:
        """Why a mechanism does not take this load."""
        if not isinstance(mechanism, SliderCrank):
            kind = type(mechanism).__name__
            return [f"{path} is a GasPressure on a {kind}: must be on a SliderCrank; give the {kind} a Load"]
        if mechanism.branch not in BRANCH_SIGN:
            return [f'{path} is a GasPressure, whose cylinder has one head: give branch="open" or "crossed"']
        turns = turns_fully(mechanism)
        if self.cycle and not hasattr(turns, "dims") and not turns:
            return [
                f"{path}.pressure is a cycle, which takes full turns of the crank: rod.length must be greater than "
                f"crank.length + |offset|; make the rod longer"
            ]
        return []

    def sampled(self, path: str, sample: Callable[[str, Any, Rule], Any]) -> GasPressure:
        """The load with its pressures brought to a sweep's angles by sample(path, value, rule)."""
        pressure = self.pressure if self.cycle else sample(f"{path}.pressure", self.pressure, PRESSURE)
        return replace(self, pressure=pressure, crankcase=sample(f"{path}.crankcase", self.crankcase, PRESSURE))

    def in_cylinder(self, engine: Any, omega2: Number, theta2: np.ndarray) -> GasPressure:
        """The load with its force along the guide at crank angles; `omega2` and pressures are at them already."""
        pressure = self.cycle.pressure(engine, theta2, _turning(omega2)) if self.cycle else self.pressure
        area = 0.25 * math.pi * (self.bore * self.bore)
        force = BRANCH_SIGN[engine.branch] * (self.crankcase - pressure) * area
        brought = copy.copy(self)
        object.__setattr__(brought, "force", force.fillna(0.0) if hasattr(force, "dims") else force)
        return brought

    def jumps(self, engine: Any) -> tuple[Number, ...]:
        """Crank angles [degree] at which the pressure jumps."""
        return dead_centres(engine) if self.cycle else ()

    def parameters(self, load: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """The load's numbers under the names that the physics wires by."""
        zero = {f"{load}_force_y": 0.0, f"{load}_at_x": 0.0, f"{load}_at_y": 0.0}
        return {f"{load}_force_x": self.force} | zero


def _turning(omega2: Number) -> Number:
    """1 for a crank that turns counter-clockwise, -1 for clockwise; one number where all do the same."""
    clockwise = omega2 < 0.0
    if np.all(clockwise) or not np.any(clockwise):
        return -1.0 if np.any(clockwise) else 1.0
    return 1.0 - 2.0 * clockwise
