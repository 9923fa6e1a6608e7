"""Direct-current motors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linksweep.analysis.drive.motors.motor import AnyMotor
from linksweep.base.checked_number import checked_number
from linksweep.base.fields import parameter
from linksweep.base.public.clear_calls import clear_method
from linksweep.base.validate import Number, Rule, refuse
from linksweep.physics import motor as physics
from linksweep.scene.dimensions import argument_problems

VOLTAGE = Rule("voltage", above=0.0)
RESISTANCE = Rule("resistance", above=0.0)
CONSTANT = Rule("torque_constant", above=0.0)


@dataclass(frozen=True, eq=False, repr=False)
class DCMotor(AnyMotor):
    """A direct-current motor on a constant voltage.

    Parameters
    ----------
    stall_torque : float or DataArray
        Torque at standstill [N m].
    no_load_speed : float or DataArray
        Speed without torque [rad/s].
    inertia : float or DataArray, default 0.0
        Moment of inertia of its rotor [kg m²].

    Raises
    ------
    ValueError
        If a number is out of bounds, or arrays over one dim differ in length or labels.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.DCMotor(stall_torque=2.0, no_load_speed=400.0).torque_at(100.0)
    1.5
    """

    stall_torque: Number = parameter("torque", above=0.0)
    no_load_speed: Number = parameter("angular_velocity", above=0.0)
    inertia: Number = parameter("inertia", 0.0, at_least=0.0)

    @classmethod
    @clear_method
    def from_winding(cls, voltage: Number, resistance: Number, constant: Number, *, inertia: Number = 0.0) -> DCMotor:
        """Make a motor by the voltage on it, and the resistance and constant of its winding.

        Parameters
        ----------
        voltage : float or DataArray
            Voltage [V], such as "24 V".
        resistance : float or DataArray
            Resistance of the winding [ohm].
        constant : float or DataArray
            Torque over current [N m/A], which is also voltage over speed.
        inertia : float or DataArray, default 0.0
            Moment of inertia of its rotor [kg m²].

        Returns
        -------
        DCMotor
            Motor of the stall torque constant·voltage/resistance and the no-load speed voltage/constant.

        Raises
        ------
        ValueError
            If a number is out of bounds, or arrays over one dim differ in length or labels.

        Examples
        --------
        >>> import linksweep as ls
        >>> motor = ls.DCMotor.from_winding("24 V", "0.6 ohm", "0.05 N m/A")
        >>> print(f"{motor.stall_torque:.3f} N m, {motor.no_load_speed:.3f} rad/s")
        2.000 N m, 480.000 rad/s
        """
        voltage = checked_number("voltage", voltage, VOLTAGE)
        resistance = checked_number("resistance", resistance, RESISTANCE)
        constant = checked_number("constant", constant, CONSTANT)
        refuse(argument_problems({}, voltage=voltage, resistance=resistance, constant=constant))
        return cls(constant * voltage / resistance, voltage / constant, inertia)

    @property
    def top_speed(self) -> Number:
        """No-load speed [rad/s]."""
        return self.no_load_speed

    def _torque(self, speed: Any) -> Any:
        return physics.straight_torque(speed, self.stall_torque, self.no_load_speed)

    def _slope(self, speed: Any) -> Any:
        return 0.0 * speed - self.stall_torque / self.no_load_speed

    def _heat(self, speed: Any) -> Any:
        return physics.heat(self.torque_at(speed), speed, self.no_load_speed)
