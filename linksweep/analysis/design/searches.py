"""Local searches with exact gradients: from one start or several, and of the largest of many rises (minimax).

The minimax form has a bound t as a further variable: least t with q(θ_k, x) ≤ t at many angles θ_k, and with the exact
peak ≤ t. Each of these is smooth where the peak is not, because it passes from one rise to another:

    minimize t     subject to   ±q(θ_k, x) ≤ t,   peak(x) ≤ t,   and the objective's own constraints

Variables are scaled to their ranges and values to the first one: lengths in metres and forces in newtons differ by
orders. (SLSQP: D. Kraft, A software package for sequential quadratic programming, DFVLR-FB 88-28, 1988.)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.analysis.design.constraints import one_sided
from linksweep.analysis.design.result_derivatives import split
from linksweep.base.validate import refuse
from linksweep.results.compute import compute
from linksweep.results.derivatives.samples import sample_derivatives

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

    from linksweep.analysis.design.objective import Objective

ALLOWED = 1e-6
"""Excess over a constraint that is allowed, relative to its bound."""
MOST = 200
"""Most iterations from one start."""


def local_optimum(objective: Objective, starts: list[np.ndarray], method: str, angles: int) -> OptimizeResult:
    """Return the best result of scipy's searches from these starts; `angles` of the minimax form, 0 for none."""
    results = [_from_start(objective, start, method, angles) for start in starts]
    sound = [result for result in results if result.allowed]
    return min(sound or results, key=lambda result: result.fun)


def starts_of(objective: Objective, multistart: Any) -> list[np.ndarray]:
    """Return the starts: the scene's own values, and points by number, or the designs of a Dataset."""
    own = [objective.x0]
    if multistart is None:
        return own
    low, high = np.transpose(objective.bounds)
    if isinstance(multistart, xr.Dataset):
        missing = [name for name in objective.names if name not in multistart.coords]
        refuse([f"multistart: the Dataset has no coordinate {missing[0]}: take a study of it"] if missing else [])
        arrays = xr.broadcast(*(multistart[name].reset_coords(drop=True) for name in objective.names))
        columns = np.stack([array.values.ravel() for array in arrays], axis=1)
        return own + [np.clip(column, low, high) for column in columns]
    from scipy.stats import qmc

    points = qmc.Sobol(len(low), seed=0).random_base2(max(int(multistart) - 1, 0).bit_length())[: int(multistart)]
    return own + [low + (high - low) * point for point in points]


def _from_start(objective: Objective, start: np.ndarray, method: str, angles: int) -> OptimizeResult:
    """Return scipy's result from one start, in the parameters' own units, with `allowed` and `calls`."""
    from scipy.optimize import NonlinearConstraint, minimize

    low, high = np.transpose(objective.bounds)
    width, size = high - low, abs(objective.plain_value(start)) or 1.0
    n, calls = len(low), {"value": 0, "gradient": 0}

    def own(z: np.ndarray) -> np.ndarray:
        return low + width * np.clip(z[:n], 0.0, 1.0)

    def value(z: np.ndarray) -> float:
        calls["value"] += 1
        number = objective.plain_value(own(z)) / size
        return number if np.isfinite(number) else 1e6

    def gradient(z: np.ndarray) -> np.ndarray:
        calls["gradient"] += 1
        return np.nan_to_num(objective.gradient(own(z)) * width / size)

    function, constraints = objective.function, []
    for name, worst, bound in one_sided(objective.subject_to):
        unit = abs(bound) or 1.0
        constraints.append(
            NonlinearConstraint(
                lambda z, name=name, worst=worst, unit=unit: np.nan_to_num(
                    function.value(name, own(z), worst) / unit, nan=-1e6 if worst == "min" else 1e6
                ),
                bound / unit if worst == "min" else -np.inf,
                bound / unit if worst == "max" else np.inf,
                jac=lambda z, name=name, worst=worst, unit=unit: _padded(
                    np.nan_to_num(function.gradient(name, own(z), worst) * width / unit), len(z)
                ),
            )
        )
    first = (np.clip(start, low, high) - low) / width
    options: dict[str, Any] = {"maxiter": MOST}
    if not angles:
        result = minimize(
            value, first, jac=gradient, bounds=[(0.0, 1.0)] * n, constraints=constraints, method=method, options=options
        )
    else:
        slack, slope = _rises(objective, own, width, size, angles)
        constraints.append(NonlinearConstraint(slack, 0.0, np.inf, jac=slope))
        constraints.append(
            NonlinearConstraint(lambda z: z[n] - value(z), 0.0, np.inf, jac=lambda z: np.append(-gradient(z), 1.0))
        )
        result = minimize(
            lambda z: z[n], np.append(first, 1.0), jac=lambda z: np.append(np.zeros(n), 1.0),
            bounds=[*[(0.0, 1.0)] * n, (None, None)], constraints=constraints, method=method, options=options,
        )  # fmt: skip
    result.x = own(result.x)
    result.fun = objective.plain_value(result.x)
    result.allowed = all(
        (function.value(name, result.x, worst) - bound) * (1.0 if worst == "min" else -1.0)
        >= -ALLOWED * abs(bound or 1)
        for name, worst, bound in one_sided(objective.subject_to)
    )
    result.calls = calls
    return result


def _rises(objective: Objective, own: Any, width: np.ndarray, size: float, angles: int) -> tuple[Any, Any]:
    """Return t − ±q/size at even angles as a function of (x, t), and its Jacobian."""
    scene = objective.base
    stem, end = split(scene, objective.target)
    signs = {"max": (1.0,), "min": (-1.0,)}.get(end, (1.0,) if scene.table.quantity[stem].squared else (1.0, -1.0))
    grid, n = scene.grid(angles), len(width)

    def slack(z: np.ndarray) -> np.ndarray:
        at = objective.scene(own(z)).at(grid)
        values = np.ravel(compute(at, grid, (stem,))[stem].values) / size
        return np.nan_to_num(np.concatenate([z[n] - sign * values for sign in signs]), nan=0.0)

    def slope(z: np.ndarray) -> np.ndarray:
        samples = sample_derivatives(objective.scene(own(z)), grid, (stem,), tuple(objective.names))
        shape = samples.values[stem].values.shape
        columns = [np.ravel(np.broadcast_to(field.values, shape)) for field in samples.derivatives.values()]
        rows = np.nan_to_num(np.stack(columns, axis=1) * width / size)
        return np.concatenate([np.column_stack([-sign * rows, np.ones(len(rows))]) for sign in signs])

    return slack, slope


def _padded(row: np.ndarray, length: int) -> np.ndarray:
    return np.concatenate([row, np.zeros(length - len(row))])
