"""Motors and engines with a governor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linksweep.analysis.drive.motors.motor import AnyMotor
from linksweep.base.fields import parameter
from linksweep.base.validate import Number, less_problems, refuse


@dataclass(frozen=True, eq=False, repr=False)
class GovernedMotor(AnyMotor):
    """A motor or engine of constant torque, which its governor cuts along a straight line between two speeds.

    Parameters
    ----------
    torque : float or DataArray
        Torque at speeds up to `cut_from` [N m].
    cut_from : float or DataArray
        Speed from which the governor cuts the torque [rad/s].
    cut_to : float or DataArray
        Speed from which there is none [rad/s].
    inertia : float or DataArray, default 0.0
        Moment of inertia of its rotor [kg m²].

    Raises
    ------
    ValueError
        If a number is out of bounds, arrays over one dim differ in length or labels, or the governor begins to cut at
        the speed at which it ends, or beyond.

    Examples
    --------
    >>> import linksweep as ls
    >>> engine = ls.GovernedMotor("40 N m", cut_from="1500 rpm", cut_to="1590 rpm")
    >>> round(float(engine.torque_at(engine.cut_from)), 9), round(float(engine.torque_at(engine.cut_to)), 9)
    (40.0, 0.0)
    """

    torque: Number = parameter("torque", above=0.0)
    cut_from: Number = parameter("angular_velocity", at_least=0.0)
    cut_to: Number = parameter("angular_velocity", above=0.0)
    inertia: Number = parameter("inertia", 0.0, at_least=0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse(less_problems("cut_from", self.cut_from, "cut_to", self.cut_to, "angular_velocity"))

    @property
    def top_speed(self) -> Number:
        """Speed from which the governor leaves no torque [rad/s]."""
        return self.cut_to

    def _torque(self, speed: Any) -> Any:
        part = (self.cut_to - speed) / (self.cut_to - self.cut_from)
        return self.torque * np.minimum(np.maximum(part, 0.0), 1.0)

    def _slope(self, speed: Any) -> Any:
        steep = self.torque / (self.cut_to - self.cut_from)
        return -steep * (speed >= self.cut_from) * (speed < self.cut_to)
