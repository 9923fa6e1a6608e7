"""Results of an objective's scene as functions of its parameters, with exact gradients: what constraints are made of.

Where the scene has dims of its own (load cases, both branches) the worst over them counts: the least value for a lower
bound, the largest for an upper one, each with the gradient of that design.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.analysis.design.conditions import USUAL, Conditions
from linksweep.analysis.design.result_derivatives import Derived, derived, result_problems, result_value, whole_name
from linksweep.base.units import quantity
from linksweep.base.validate import as_float, limits_in, name_problems, quote, refuse
from linksweep.scene.parameters import free, replaced
from linksweep.scene.scene import Scene

if TYPE_CHECKING:
    from scipy.optimize import NonlinearConstraint

CANDIDATES = "candidate"
"""Dimension of the designs of one call; always of the same name, so that one kernel serves all calls."""
KEPT = 4
"""Sets of parameters whose results are kept: an optimizer asks for value, gradient and constraints one by one."""
FAR = 1e9
"""Size of a result that does not exist: such a design violates the constraint."""
Bounds = tuple[float | None, float | None]


@dataclass(frozen=True, eq=False)
class ResultFunction:
    """Results of a scene as functions of some of its parameters, by path in the order of x."""

    base: Scene
    paths: tuple[str, ...]
    conditions: Conditions = USUAL
    _kept: dict[tuple[str, bytes], Derived] = field(default_factory=dict, repr=False)

    def scene(self, x: np.ndarray) -> Scene:
        """Return the scene of one design (parameters,), or of designs (parameters, designs) over a dim."""
        rows = map(float, x) if x.ndim == 1 else (xr.DataArray(row, dims=CANDIDATES) for row in x)
        return replaced(self.base, dict(zip(self.paths, rows, strict=True)))

    def designs(self, x: np.ndarray) -> Scene:
        """Return the scene of designs over a dim, also of one: one that cannot be assembled is no error then."""
        return self.scene(x.reshape(len(x), -1))

    def value(self, name: str, x: np.ndarray, worst: str) -> Any:
        """Return the worst ("max" or "min") of a result at x: a number, or one for each column of x."""
        values = result_value(self.designs(x), name, conditions=self.conditions)
        others = [dim for dim in values.dims if dim != CANDIDATES]
        numbers = getattr(values, worst)(others, skipna=False).values
        return float(numbers.reshape(-1)[0]) if x.ndim == 1 else np.broadcast_to(numbers, x.shape[1:]).copy()

    def gradient(self, name: str, x: np.ndarray, worst: str) -> np.ndarray:
        """Return the derivatives of the worst of a result to the parameters at x, of shape (parameters,)."""
        key = name, x.tobytes()
        if key not in self._kept:
            while len(self._kept) >= KEPT:
                self._kept.pop(next(iter(self._kept)))
            self._kept[key] = derived(self.designs(x), name, self.paths, conditions=self.conditions)
        result = self._kept[key]
        arrays = xr.broadcast(result.value, *(slope.drop_attrs() for slope in result.slopes.values()))
        values, *slopes = (array.values.ravel() for array in arrays)
        k = int((np.nanargmax if worst == "max" else np.nanargmin)(values)) if np.isfinite(values).any() else 0
        return np.array([slope[k] for slope in slopes])


def checked_ranges(scene: Scene, parameters: Any) -> dict[str, tuple[float, float]]:
    """Return (low, high) of each parameter in its unit; ValueError for ranges that are none of the scene."""
    if not isinstance(parameters, Mapping) or not parameters:
        refuse([f'parameters = {quote(parameters)}: must name what varies, as in {{"coupler.length": (0.1, 0.3)}}'])
    kinds = {path: kind for path, (_, kind) in free(scene).items()}
    refuse([problem for path in parameters for problem in name_problems("parameters", path, kinds)])
    ranges, problems = {}, []
    for path, ends in parameters.items():
        try:
            ranges[path] = _range(ends, kinds[path])
        except ValueError as error:
            problems.append(f"{path} = {error}")
    refuse(problems)
    return ranges


def _range(ends: Any, kind: str) -> tuple[float, float]:
    if not isinstance(ends, tuple | list) or len(ends) != 2:
        raise ValueError(f"{quote(ends)}: must be a range (low, high)")
    low, high = (quantity(end, kind) for end in ends)
    if not low < high:
        raise ValueError(f"({low:.15g}, {high:.15g}): low must be less than high")
    return low, high


def checked_bounds(scene: Scene, subject_to: Any, conditions: Conditions = USUAL) -> dict[str, Bounds]:
    """Return the bounds of results by whole name; ValueError for unknown names, and for what is no pair of bounds."""
    if subject_to is None:
        return {}
    if not isinstance(subject_to, Mapping):
        refuse([f'subject_to = {quote(subject_to)}: must be bounds by result, as in {{"swing": (50, None)}}'])
    problems = [problem for name in subject_to for problem in result_problems(scene, "subject_to", name, conditions)]
    for name, ends in subject_to.items():
        must = "must be (low, high), numbers or one None"
        problems += [f"subject_to.{name} = {quote(ends)}: {must}"] if limits_in(ends) is None else []
    refuse(problems)
    return {whole_name(scene, name): (as_float(low), as_float(high)) for name, (low, high) in subject_to.items()}


def one_sided(bounds: Mapping[str, Bounds]) -> list[tuple[str, str, float]]:
    """Return each bound of a result with the worst that it is for: the least for a lower one."""
    lower = [(name, "min", low) for name, (low, _) in bounds.items() if low is not None]
    return lower + [(name, "max", high) for name, (_, high) in bounds.items() if high is not None]


def nonlinear_constraints(function: ResultFunction, bounds: Mapping[str, Bounds]) -> list[NonlinearConstraint]:
    """Return bounds of results as scipy.optimize takes them, each with its gradient."""
    from scipy.optimize import NonlinearConstraint

    return [
        NonlinearConstraint(
            partial(_component, function, name, worst),
            bound if worst == "min" else -np.inf,
            bound if worst == "max" else np.inf,
            jac=partial(_gradient, function, name, worst),
        )
        for name, worst, bound in one_sided(bounds)
    ]


def _component(function: ResultFunction, name: str, worst: str, x: Any) -> Any:
    """Return the one component of a constraint: a number, or of x (parameters, designs) a row; far off where NaN."""
    values = function.value(name, np.asarray(x, dtype=float), worst)
    known = np.nan_to_num(values, nan=-FAR if worst == "min" else FAR)
    return float(known) if np.ndim(x) == 1 else known[None]


def _gradient(function: ResultFunction, name: str, worst: str, x: Any) -> np.ndarray:
    return function.gradient(name, np.asarray(x, dtype=float), worst)
