"""The largest of many rises under one bound that is minimized (minimax), so that no two equal peaks stop a search.

A peak has a corner where two rises are equal: it passes from one to the other there, and a search by gradients stops
beside it. The largest value q_k of a quantity in each of equal sectors of the turn has none there. So a bound t is a
further variable:

    minimize t     subject to   q_k(x) ≤ t in every sector k,   and the objective's own constraints

The q_k are exact, found as peaks are. (Source: e.g. J. Nocedal and S. Wright, Numerical Optimization, 2nd ed., section
12.1.)
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from linksweep.analysis.design.result_derivatives import split
from linksweep.analysis.design.scaled import FAR, Scaled
from linksweep.results.derivatives.of_sectors import sector_derivatives
from linksweep.scene.at_sections import with_sections

if TYPE_CHECKING:
    from scipy.optimize import NonlinearConstraint

    from linksweep.analysis.design.objective import Objective


def minimax_problems(objective: Objective) -> list[str]:
    """Return why an objective has no minimax form: it is no largest value that is minimized, nor a least maximized."""
    smaller = objective.sign > 0.0
    stem, _, end = objective.target.rpartition("_")
    sound = stem in objective.base.table.quantity and end in (("peak", "max") if smaller else ("min",))
    advice = "minimizes a result ending in _peak or _max" if smaller else "maximizes a result ending in _min"
    return [] if sound else [f"minimax: {objective.target} has no rises to hold below a bound; minimax {advice}"]


class Bounded:
    """A scaled objective with the bound t as its last variable: (z, t)."""

    def __init__(self, problem: Scaled, sectors: int) -> None:
        self.problem, self.sectors = problem, sectors
        self._known: tuple[bytes, np.ndarray, np.ndarray] = (b"", np.empty(0), np.empty(0))

    @property
    def bounds(self) -> list[tuple[float | None, float | None]]:
        """Least and largest value of each variable; none of the bound."""
        return [*self.problem.bounds, (None, None)]

    def first(self, x: np.ndarray) -> np.ndarray:
        """Return the variables of a start."""
        return np.append(self.problem.first(x), 1.0)

    def own(self, zt: np.ndarray) -> np.ndarray:
        """Return parameters in their own units, within their bounds."""
        return self.problem.own(zt[:-1])

    def value(self, zt: np.ndarray) -> float:
        """Return the bound."""
        return float(zt[-1])

    def gradient(self, zt: np.ndarray) -> np.ndarray:
        """Return the derivatives of the bound."""
        return np.append(np.zeros(len(zt) - 1), 1.0)

    def constraints(self) -> list[NonlinearConstraint]:
        """Return the objective's constraints, and that every rise is below the bound."""
        from scipy.optimize import NonlinearConstraint

        own = [
            NonlinearConstraint(partial(_without_bound, each.fun), each.lb, each.ub, jac=partial(_padded, each.jac))
            for each in self.problem.constraints()
        ]
        return [*own, NonlinearConstraint(self._slack, 0.0, np.inf, jac=self._slopes)]

    def _slack(self, zt: np.ndarray) -> np.ndarray:
        return zt[-1] - self._rises(zt[:-1])[0]

    def _slopes(self, zt: np.ndarray) -> np.ndarray:
        slopes = self._rises(zt[:-1])[1]
        return np.column_stack([-slopes, np.ones(len(slopes))])

    def _rises(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the largest value of each sector and its derivatives (rise, parameter), scaled."""
        if self._known[0] != z.tobytes():
            self._known = (z.tobytes(), *self._computed(z))
        return self._known[1:]

    def _computed(self, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        problem, objective = self.problem, self.problem.objective
        scene = with_sections(objective.function.designs(problem.own(z)), objective.target)
        stem, end = split(scene, objective.target)
        squared = scene.table.quantity[stem].squared
        signs = {"max": (1.0,), "min": (-1.0,)}.get(end, (1.0,) if squared else (1.0, -1.0))
        values, slopes = sector_derivatives(scene, squared or stem, signs, self.sectors, tuple(objective.names))
        if squared:
            values = np.sqrt(values)
            slopes = slopes / np.where(values > 0.0, 2.0 * values, np.inf)[:, None]
        problem.calls["gradient"] += 1
        sound = problem.value(z) < FAR  # a design without motion has no rise that would exceed the bound
        values = np.nan_to_num(values / problem.size, nan=-FAR, posinf=FAR) if sound else np.full(len(values), FAR)
        return values, slopes * problem.width / problem.size


def _without_bound(function: Callable[[np.ndarray], float], zt: np.ndarray) -> float:
    return function(zt[:-1])


def _padded(slopes: Callable[[np.ndarray], np.ndarray], zt: np.ndarray) -> np.ndarray:
    return np.append(slopes(zt[:-1]), 0.0)
