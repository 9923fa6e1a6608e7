"""Induction motors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linksweep.analysis.drive.motors.motor import AnyMotor, in_unit
from linksweep.base.fields import parameter
from linksweep.base.validate import Number, less_problems, refuse
from linksweep.physics import motor as physics


@dataclass(frozen=True, eq=False, repr=False)
class InductionMotor(AnyMotor):
    """An induction motor on the mains, by Kloss's equation.

    Give the rated torque and speed of its nameplate, or the breakdown slip.

    Parameters
    ----------
    synchronous_speed : float or DataArray
        Synchronous speed [rad/s], such as "1500 rpm".
    breakdown_torque : float or DataArray
        Breakdown torque, the largest [N m].
    rated_torque : float or DataArray, default None
        Rated torque [N m].
    rated_speed : float or DataArray, default None
        Rated speed, at the rated torque [rad/s].
    breakdown_slip : float or DataArray, default None
        Slip at the breakdown torque [1], in place of the rated torque and speed.
    inertia : float or DataArray, default 0.0
        Moment of inertia of its rotor [kg m²].

    Raises
    ------
    ValueError
        If a number is out of bounds, too many or too few are given, or arrays over one dim differ in length or labels.

    Examples
    --------
    >>> import linksweep as ls
    >>> motor = ls.InductionMotor("1500 rpm", "15 N m", rated_torque="6 N m", rated_speed="1425 rpm", inertia=0.004)
    >>> round(float(motor.torque_at(motor.rated_speed)), 12)
    6.0
    """

    synchronous_speed: Number = parameter("angular_velocity", above=0.0)
    breakdown_torque: Number = parameter("torque", above=0.0)
    rated_torque: Number = parameter("torque", None, above=0.0)
    rated_speed: Number = parameter("angular_velocity", None, above=0.0)
    breakdown_slip: Number = parameter("dimensionless", None, above=0.0)
    inertia: Number = parameter("inertia", 0.0, at_least=0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        rated = [each is not None for each in (self.rated_torque, self.rated_speed)]
        either = (all(rated) and self.breakdown_slip is None) or (not any(rated) and self.breakdown_slip is not None)
        refuse([] if either else ["give both rated_torque and rated_speed, or breakdown_slip alone"])
        if all(rated):
            speeds = self.rated_speed, "synchronous_speed", self.synchronous_speed, "angular_velocity"
            torques = self.rated_torque, "breakdown_torque", self.breakdown_torque, "torque"
            refuse(less_problems("rated_speed", *speeds) + less_problems("rated_torque", *torques))

    @property
    def top_speed(self) -> Number:
        """Synchronous speed [rad/s]."""
        return self.synchronous_speed

    @property
    def slip_at_breakdown(self) -> Number:
        """Slip at the breakdown torque [1]."""
        if self.breakdown_slip is not None:
            return self.breakdown_slip
        rated_slip = physics.slip_at(self.rated_speed, self.synchronous_speed)
        slip = physics.breakdown_slip(rated_slip, self.breakdown_torque / self.rated_torque)
        return in_unit("dimensionless", slip)

    def slip_at(self, speed: Any) -> Any:
        """Return the slip at a speed.

        Parameters
        ----------
        speed : float, array or DataArray
            Speed [rad/s].

        Returns
        -------
        float, array or DataArray
            Slip [1]: 0 at the synchronous speed, 1 at standstill.
        """
        return in_unit("dimensionless", physics.slip_at(speed, self.synchronous_speed))

    def _torque(self, speed: Any) -> Any:
        return physics.kloss_torque(self.slip_at(speed), self.breakdown_torque, self.slip_at_breakdown)

    def _slope(self, speed: Any) -> Any:
        slope = physics.kloss_slope(self.slip_at(speed), self.breakdown_torque, self.slip_at_breakdown)
        return -slope / self.synchronous_speed

    def _heat(self, speed: Any) -> Any:
        return physics.heat(self.torque_at(speed), speed, self.synchronous_speed)
