"""Motors by their measured curve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linksweep.analysis.drive.motors.motor import AnyMotor
from linksweep.base.checked_number import array_unit_problems, dims_problems, unit_attribute_problems
from linksweep.base.conversion import all_to_float64
from linksweep.base.equality import ByContent
from linksweep.base.fields import field_problems, numbers, parameter
from linksweep.base.frozen import normalise
from linksweep.base.validate import Number, Rule, is_array, number_problems, quote, refuse

POINTS = {"speeds": Rule("angular_velocity", at_least=0.0), "torques": Rule("torque", at_least=0.0)}


@dataclass(frozen=True, eq=False, repr=False)
class Motor(AnyMotor):
    """A motor by its measured curve: points of torque over speed, joined by straight lines.

    Parameters
    ----------
    speeds : sequence of float
        Speeds of the curve's points [rad/s], from 0, growing.
    torques : sequence of float
        Largest torques at these speeds [N m]; none beyond the last speed.
    inertia : float or DataArray, default 0.0
        Moment of inertia of its rotor [kg m²].

    Raises
    ------
    ValueError
        If the points form no curve, or a number is out of bounds.

    Examples
    --------
    A direct-current motor: 2 N m when held, 400 rad/s when free.

    >>> import linksweep as ls
    >>> ls.Motor(speeds=(0.0, 400.0), torques=(2.0, 0.0), inertia=1e-4).torque_at(100.0)
    1.5
    """

    speeds: Sequence[float]
    torques: Sequence[float]
    inertia: Number = parameter("inertia", 0.0, at_least=0.0)

    def __post_init__(self) -> None:
        ByContent.__post_init__(self)
        problems = field_problems(self) + unit_attribute_problems(numbers(self))
        for name, rule in POINTS.items():
            points = _points(name, getattr(self, name), rule.kind)
            problems += array_unit_problems(name, getattr(self, name), rule.kind)
            problems += [p for k, point in enumerate(points, 1) for p in number_problems(f"{name}[{k}]", point, rule)]
            normalise(self, **{name: points})
        count = len(self.speeds)
        if len(self.torques) != count or count < 2:
            problems.append(f"torques has {len(self.torques)} values for {count} speeds: give as many, two at least")
        elif not problems and (self.speeds[0] != 0.0 or np.any(np.diff(self.speeds) <= 0.0)):
            problems.append(f"speeds = {quote(list(self.speeds))}: must grow from 0")
        refuse(problems)

    @property
    def top_speed(self) -> Number:
        """Least speed from which the curve has no torque [rad/s]."""
        driving = np.flatnonzero(self.torques)
        return self.speeds[min(driving[-1] + 1, len(self.speeds) - 1)] if driving.size else 0.0

    def _torque(self, speed: Any) -> Any:
        return _over(speed, lambda at: np.interp(np.abs(at), self.speeds, self.torques, right=0.0))

    def _slope(self, speed: Any) -> Any:
        steps = np.diff(self.torques) / np.diff(self.speeds)
        slopes = np.concatenate([steps, [0.0]])  # none beyond the last speed

        def slope(at: np.ndarray) -> np.ndarray:
            return np.sign(at) * slopes[np.searchsorted(self.speeds, np.abs(at), side="right") - 1]

        return _over(speed, slope)


def _points(path: str, values: Any, kind: str) -> tuple[Any, ...]:
    """Return the numbers of a curve's points, converted; ValueError for an array among them."""
    converted = all_to_float64(path, values, kind)
    each = enumerate(converted, 1) if isinstance(converted, list) else ()
    refuse([p for k, point in each if is_array(point) for p in dims_problems(f"{path}[{k}]", point)])
    return tuple(np.ravel(np.asarray(converted, dtype=object)).tolist())


def _over(speed: Any, function: Any) -> Any:
    """Return a function of a float, of an array, or of the values of an array with dims."""
    if hasattr(speed, "dims"):
        return speed.copy(data=function(speed.values))
    values = function(np.asarray(speed, dtype=float))
    return float(values) if np.ndim(values) == 0 else values
