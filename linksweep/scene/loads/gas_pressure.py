"""Gas pressure on a slider: what an engine, a pump or a compressor has in its cylinder."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from linksweep.base.fields import field_problems, of_kind, parameter, word
from linksweep.base.frozen import with_sound
from linksweep.base.validate import Number, Rule, choice_problems, overflow_problems
from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.capabilities import lack
from linksweep.scene.loads.action import register
from linksweep.scene.loads.air_cycle import ATMOSPHERE, CYCLES, Cycle, pressure_over
from linksweep.scene.loads.changing_load import BREAKS, ChangingLoad
from linksweep.scene.loads.load import LoadForm
from linksweep.scene.revolution import Revolution

PRESSURE = Rule("pressure", over_angle=True)


@register
@dataclass(frozen=True, eq=False, repr=False)
class GasPressure(ChangingLoad):
    """Gas pressure in a cylinder, as a load on the slider that is its piston.

    Parameters
    ----------
    bore : float or DataArray
        Diameter of the cylinder [m].
    pressure : float, DataArray, function, OttoCycle or DieselCycle
        Absolute pressure in the cylinder [Pa]; a function is one of theta2 [degree], its slope as that of a `Load`. An
        ideal cycle is for a `SliderCrank`.
    crankcase : float, DataArray or function, default 101325.0
        Absolute pressure on the other side of the piston [Pa].
    breaks : list of float, default ()
        Angles theta2 [degree] at which either pressure jumps, kinks or is narrow, as those of a `Load`.
    interpolation : str, default None
        Curve through DataArrays over theta2, as that of a `Load`.
    link : str, default "slider"
        Role of the slider, which slides on the ground.

    Notes
    -----
    The force acts at the slider's pin along the guide, (p − crankcase)·π·bore²/4. The head is ahead of the slider, so
    that pressure above the crankcase's pushes it back, against the guide's direction; in a `SliderCrank` it is where
    the rod reaches farthest: with branch "crossed" the head is behind, and pressure pushes it forward.

    A DataArray over theta2 that spans two turns makes the scene's period 720, and so does a cycle of four strokes.

    In a study, a design whose crank does not turn fully has no ideal cycle: none of its samples is ok (status
    `no_cycle` where it can be assembled), and its forces are NaN.

    The scene that takes the load raises ValueError for a mechanism without such a cylinder, for branch="both", for
    numbers out of bounds, and for a cycle in an engine whose crank does not turn fully.

    Examples
    --------
    >>> import linksweep as ls
    >>> engine = ls.SliderCrank(ls.Link(0.04, 1, 0), ls.Link(0.14, 1, 0), slider_mass=0.5)
    >>> gas = ls.GasPressure(bore=0.086, pressure=ls.OttoCycle(compression_ratio=10.0, peak_pressure=6e6))
    >>> ls.Scene(engine, omega2=300.0, loads=[gas]).period
    720.0
    """

    bore: Number = parameter("length", above=0.0)
    pressure: Number | Cycle = parameter("pressure", over_angle=True, parts=CYCLES)
    crankcase: Number = parameter("pressure", ATMOSPHERE, over_angle=True)
    breaks: Sequence[float] = of_kind(BREAKS, ())
    interpolation: str | None = None
    link: str = word('"slider"', "slider")
    in_cylinder: Number = field(default=None, init=False, repr=False)  # of a cycle, over the angles of a sweep [Pa]

    @property
    def changing(self) -> tuple[Any, ...]:
        """The numbers that may change over the revolution."""
        return self.pressure, self.crankcase

    @property
    def form(self) -> LoadForm:
        """Form of its rows."""
        return LoadForm(self.link, force=True, torque=False, link_axes=True, full_turns=self.cycle is not None)

    @property
    def cycle(self) -> Cycle | None:
        """The ideal air cycle in the cylinder; None for any other pressure."""
        return self.pressure if isinstance(self.pressure, Cycle) else None

    @property
    def period(self) -> float:
        """Period of the cycle [degree]; 0 for any other pressure."""
        return self.cycle.period if self.cycle else 0.0

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        """Return the problems of the load on a machine of these links."""
        of_cycle = self.cycle.problems(f"{path}.pressure") if self.cycle else []
        problems = field_problems(self, path + ".")
        with np.errstate(over="ignore"):
            problems = problems or overflow_problems(f"{path}.bore", self.bore * self.bore, "square")
        return problems + of_cycle + self.interpolation_problems(path)

    def misfits(self, path: str, mechanism: Mechanism) -> list[str]:
        """Return why this mechanism cannot take the load, which is valid in itself."""
        if not mechanism.sliders:
            return [f"{path} is a GasPressure on {lack(mechanism, 'engine_cylinder')}, or a Load"]
        if self.cycle and lack(mechanism, "engine_cylinder"):
            wrong = f"{path}.pressure is a cycle, which takes a SliderCrank, not a {type(mechanism).__name__}"
            return [f"{wrong}: give its pressure over theta2"]
        if problems := choice_problems(f"{path}.link", self.link, mechanism.sliders):
            return problems
        if "branch" in mechanism.both_branches:
            return [f'{path} is a GasPressure, whose cylinder has one head: give branch="open" or "crossed"']
        turns = mechanism.engine_cylinder.turns_fully if self.cycle else True
        if not hasattr(turns, "dims") and not turns:
            return [
                f"{path}.pressure is a cycle, which takes full turns of the crank: rod.length must be greater than "
                f"crank.length + |offset|; make the rod longer"
            ]
        return []

    def sampled(self, path: str, revolution: Revolution) -> GasPressure:
        """Return the load with all that changes over the revolution at its angles."""
        crankcase = revolution.sample(f"{path}.crankcase", self.crankcase, PRESSURE)
        if self.cycle is None:
            pressure = revolution.sample(f"{path}.pressure", self.pressure, PRESSURE)
            return with_sound(self, pressure=pressure, crankcase=crankcase)
        cylinder = revolution.mechanism.engine_cylinder
        pressure = pressure_over(self.cycle, cylinder, revolution.angles, revolution.turning)
        return with_sound(self, crankcase=crankcase, in_cylinder=pressure)

    def jumps(self, mechanism: Mechanism) -> tuple[Number, ...]:
        """Return dead centres, where a cycle's pressure jumps, breaks, and where arrays jump or bend [degree]."""
        dead_centres = mechanism.engine_cylinder.dead_centres() if self.cycle else ()
        return (*dead_centres, *super().jumps(mechanism))

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """Return the force along the guide, NaN where the crank of a cycle does not turn fully; it acts at C."""
        pressure = self.in_cylinder if self.cycle else self.pressure
        area = 0.25 * math.pi * (self.bore * self.bore)
        force = machine.get("branch_sign", 1.0) * (self.crankcase - pressure) * area
        return {f"{name}_force_x": force, f"{name}_force_y": 0.0, f"{name}_at_x": 0.0, f"{name}_at_y": 0.0}
