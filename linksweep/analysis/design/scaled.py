"""An objective as local searches take it: parameters scaled to their ranges, values relative to the first ones.

Lengths in metres and forces in newtons differ by orders, and a search measures steps and changes by one number each:

    z = (x − low)/(high − low)        value(z) = f(x)/|f(x_0)|        constraint(z) = g(x)/|bound|
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from linksweep.analysis.design.constraints import one_sided

if TYPE_CHECKING:
    from scipy.optimize import NonlinearConstraint

    from linksweep.analysis.design.objective import Objective

FAR = 1e6
"""Scaled value of a design that has none, or that is not allowed: far from any optimum."""


@dataclass(frozen=True, eq=False)
class Scaled:
    """An objective over scaled parameters, which counts its calls.

    `whole` states whether designs must have the status ok, as the first one has.
    """

    objective: Objective
    size: float
    whole: bool
    calls: dict[str, int] = field(default_factory=lambda: {"value": 0, "gradient": 0})

    @property
    def width(self) -> np.ndarray:
        """Widths of the ranges, in the parameters' own units."""
        low, high = np.transpose(self.objective.bounds)
        return high - low

    def own(self, z: np.ndarray) -> np.ndarray:
        """Return parameters in their own units, within their bounds."""
        low, _ = np.transpose(self.objective.bounds)
        return low + self.width * np.clip(z, 0.0, 1.0)

    def first(self, x: np.ndarray) -> np.ndarray:
        """Return the variables of a start."""
        low, high = np.transpose(self.objective.bounds)
        return (np.clip(x, low, high) - low) / self.width

    @property
    def bounds(self) -> list[tuple[float | None, float | None]]:
        """Least and largest value of each variable."""
        return [(0.0, 1.0)] * len(self.objective.bounds)

    def value(self, z: np.ndarray) -> float:
        """Return the objective."""
        self.calls["value"] += 1
        x = self.own(z)
        number = self.objective.plain_value(x) / self.size if self._sound(x) else np.inf
        return number if np.isfinite(number) else FAR

    def gradient(self, z: np.ndarray) -> np.ndarray:
        """Return the derivatives of the objective; zeros where there are none."""
        self.calls["gradient"] += 1
        return np.nan_to_num(self.objective.gradient(self.own(z)) * self.width / self.size)

    def constraints(self) -> list[NonlinearConstraint]:
        """Return the objective's constraints, with their derivatives."""
        from scipy.optimize import NonlinearConstraint

        return [
            NonlinearConstraint(
                partial(self._result, name, worst, unit),
                bound / unit if worst == "min" else -np.inf,
                bound / unit if worst == "max" else np.inf,
                jac=partial(self._slopes, name, worst, unit),
            )
            for name, worst, bound in one_sided(self.objective.subject_to)
            for unit in (abs(bound) or 1.0,)
        ]

    def allowed(self, x: np.ndarray, tolerance: float) -> bool:
        """Return whether a design satisfies all constraints, but for a tolerance relative to their bounds."""
        if not self._sound(x):
            return False
        excess = [
            (self.objective.function.value(name, x, worst) - bound)
            * (1.0 if worst == "min" else -1.0)
            / abs(bound or 1)
            for name, worst, bound in one_sided(self.objective.subject_to)
        ]
        return all(each >= -tolerance for each in excess)

    def _sound(self, x: np.ndarray) -> bool:
        """Return whether a design has the status that it must have, and `constraint` is true of it."""
        constraint = self.objective.constraint
        if not self.whole and constraint is None:
            return True
        peaks = self.objective.peaks(x[:, None])  # over a dim: one that cannot be assembled is no error then
        ok = not self.whole or bool((peaks["status"] == 0).all())
        return ok and (constraint is None or bool(np.all(constraint(peaks))))

    def _result(self, name: str, worst: str, unit: float, z: np.ndarray) -> Any:
        number = self.objective.function.value(name, self.own(z), worst) / unit
        return number if np.isfinite(number) else -FAR if worst == "min" else FAR

    def _slopes(self, name: str, worst: str, unit: float, z: np.ndarray) -> np.ndarray:
        return np.nan_to_num(self.objective.function.gradient(name, self.own(z), worst) * self.width / unit)
