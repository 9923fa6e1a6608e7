"""Local searches with exact gradients, from one start or several, by methods of scipy.optimize.

SLSQP: D. Kraft, A software package for sequential quadratic programming, DFVLR-FB 88-28 (1988). trust-constr: R. H.
Byrd, M. E. Hribar and J. Nocedal, An interior point algorithm for large-scale nonlinear programming, SIAM J. Optim. 9
(1999); it approaches active constraints from inside and ends before them, within 1e-3 of the ranges.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.analysis.design.minimax import Bounded, minimax_problems
from linksweep.analysis.design.scaled import Scaled
from linksweep.base.validate import count_problems, name_problems, refuse

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

    from linksweep.analysis.design.objective import Objective

ALLOWED = 1e-6
"""Excess over a constraint that is allowed, relative to its bound."""
UNKNOWN = "a derivative is not known where the search ended: ls.sensitivities of the scene there states why"
"""Message of such a search."""
OPTIONS: dict[str, dict[str, Any]] = {
    "SLSQP": {"maxiter": 200, "ftol": 1e-9},
    "trust-constr": {"maxiter": 300, "initial_tr_radius": 0.3},
}
"""Options of scipy's methods, by name: of variables between 0 and 1 and values near 1."""


def local_optimum(objective: Objective, method: str, multistart: Any, minimax: int) -> OptimizeResult:
    """Return the best result of searches from all starts; `minimax` sectors of the turn, 0 for the peak alone."""
    refuse(name_problems("method", method, OPTIONS))
    refuse(minimax_problems(objective) + count_problems("minimax", minimax) if minimax else [])
    starts = starts_of(objective, multistart)
    whole = bool((objective.peaks(starts[0][:, None])["status"] == 0).all())
    calls = {"value": 0, "gradient": 0}
    results = [_from_start(objective, start, method, minimax, whole, calls) for start in starts]
    sound = [result for result in results if result.allowed and np.isfinite(result.fun)]
    return min(sound or results, key=lambda result: np.nan_to_num(result.fun, nan=np.inf))


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
    refuse([f"{problem}, or a Dataset of designs" for problem in count_problems("multistart", multistart)])
    from scipy.stats import qmc

    points = qmc.Sobol(len(low), seed=0).random_base2(max(int(multistart) - 1, 0).bit_length())[: int(multistart)]
    return own + [low + (high - low) * point for point in points]


def _from_start(
    objective: Objective, start: np.ndarray, method: str, minimax: int, whole: bool, calls: dict[str, int]
) -> OptimizeResult:
    """Return the result from one start, in the parameters' own units."""
    from scipy.optimize import OptimizeResult, minimize

    size = abs(objective.plain_value(start))
    problem = Scaled(objective, size if np.isfinite(size) and size else 1.0, whole, calls)
    searched = Bounded(problem, minimax) if minimax else problem
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "delta_grad == 0.0")  # of a constraint that is linear
        answer = minimize(
            searched.value, searched.first(start), jac=searched.gradient, bounds=searched.bounds,
            constraints=searched.constraints(), method=method, options=OPTIONS[method],
        )  # fmt: skip
    x = searched.own(answer.x)
    known = bool(minimax) or np.isfinite(objective.gradient(x)).all()  # as 0 a search takes what is not known
    return OptimizeResult(
        x=x,
        fun=objective.plain_value(x),
        allowed=problem.allowed(x, ALLOWED),
        success=bool(answer.success) and known,
        message=str(answer.message) if known else UNKNOWN,
        nit=int(answer.nit),
        calls=calls,
        method=method,
        start=start,
    )
