"""The base of motors, and checks of their numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from linksweep.base.checked_number import unit_attribute_problems
from linksweep.base.equality import ByContent
from linksweep.base.fields import field_problems, numbers
from linksweep.base.frozen import field_values
from linksweep.base.validate import UNITS, Number, is_array, quote, refuse
from linksweep.scene.dimensions import argument_problems


class AnyMotor(ByContent):
    """Base of motors: torque over the speed in the direction in which it turns, positive where it drives."""

    inertia: Number

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse(field_problems(self))
        refuse(unit_attribute_problems(numbers(self)) + argument_problems({}, **field_values(self)))

    @property
    def top_speed(self) -> Number:
        """Least speed at which it no longer drives [rad/s]."""
        raise NotImplementedError

    def torque_at(self, speed: Any) -> Any:
        """Return the torque at a speed.

        Parameters
        ----------
        speed : float, array or DataArray
            Speed [rad/s], positive in the direction in which the motor drives.

        Returns
        -------
        float, array or DataArray
            Torque [N m].
        """
        return in_unit("torque", self._torque(speed))

    def torque_slope_at(self, speed: Any) -> Any:
        """Return the derivative of the torque to the speed; at a corner of the curve, that of the faster side.

        Parameters
        ----------
        speed : float, array or DataArray
            Speed [rad/s].

        Returns
        -------
        float, array or DataArray
            Derivative [N m s/rad].
        """
        return in_unit("torsional_damping", self._slope(speed))

    def heat_at(self, speed: Any) -> Any:
        """Return the power that turns into heat at a speed: in an induction motor that in its rotor alone.

        Parameters
        ----------
        speed : float, array or DataArray
            Speed [rad/s].

        Returns
        -------
        float, array or DataArray
            Power [W]; NaN of a motor whose parameters do not tell it.
        """
        return in_unit("power", self._heat(speed))

    def _torque(self, speed: Any) -> Any:
        raise NotImplementedError

    def _slope(self, speed: Any) -> Any:
        raise NotImplementedError

    def _heat(self, speed: Any) -> Any:
        return np.nan * speed


def in_unit(kind: str, values: Any) -> Any:
    """Return values in the unit of their kind: an array says so, where it would have the unit of the speed."""
    return values.drop_attrs(deep=False).assign_attrs(units=UNITS[kind]) if is_array(values) else values


def motor_problems(motor: Any) -> list[str]:
    """Return the problem of anything but a motor."""
    kinds = "Motor, InductionMotor, DCMotor or GovernedMotor"
    return [] if isinstance(motor, AnyMotor) else [f"motor = {quote(motor)}: must be a {kinds}"]
