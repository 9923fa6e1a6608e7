"""A scene's peaks as a function of some of its parameters, in the form that optimizers take."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.design.conditions import USUAL, Conditions, checked_conditions
from linksweep.analysis.design.constraints import (
    CANDIDATES,
    Bounds,
    ResultFunction,
    checked_bounds,
    checked_ranges,
    nonlinear_constraints,
)
from linksweep.analysis.design.result_derivatives import result_names
from linksweep.analysis.design.searches import local_optimum
from linksweep.analysis.pins.bearing import Bearing
from linksweep.base.public.clear_calls import clear_method, passing_options_to
from linksweep.base.validate import name_problems, quote, refuse
from linksweep.results.compute import by_name, requested, require_scene
from linksweep.results.peaks import peaks, quantity_of
from linksweep.results.scene_peaks import requests_named
from linksweep.scene.parameters import free
from linksweep.scene.scene import Scene

Measure = Callable[[xr.Dataset], Any]

PARTS = "between", "theta2", "theta"
"""Arguments of `peaks` for a part of the cycle, or samples of it."""


@dataclass(frozen=True, eq=False)
class Objective:
    """A scene's objective as a function of its free parameters, as `objective` returns it.

    Parameters
    ----------
    base : Scene
        Scene of which the parameters vary.
    ranges : mapping of str to pair of float
        Least and largest value of each parameter by its path, in the parameter's unit [SI].
    measure : callable
        Function of the Dataset of peaks whose value is minimized.
    constraint : callable or None
        Function of the Dataset of peaks; False for a design that is not allowed.
    of : list of str or None
        Names of the quantities whose peaks are computed.
    options : mapping
        Further arguments of `peaks`.
    target : str, default ""
        Name of the result that is minimized or maximized; "" for a function.
    sign : float, default 1.0
        1 where it is minimized, -1 where it is maximized [1].
    subject_to : mapping of str to pair, default empty
        Bounds of results by name, each in its result's unit [any].
    conditions : Conditions, default Conditions(fluctuation=0.02, pins=None)
        Speed fluctuation and bearings on which some of these results depend.

    Examples
    --------
    >>> import linksweep as ls
    >>> lightest = ls.objective(ls.example("press"), {"coupler.length": ("20 cm", "24 cm")}, minimize="F32_peak")
    >>> lightest.bounds
    [(0.2, 0.24)]
    """

    base: Scene
    ranges: Mapping[str, tuple[float, float]]
    measure: Measure
    constraint: Measure | None
    of: list[str] | None
    options: Mapping[str, Any]
    target: str = ""
    sign: float = 1.0
    subject_to: Mapping[str, Bounds] = field(default_factory=dict)
    conditions: Conditions = USUAL

    @property
    def x0(self) -> np.ndarray:
        """The scene's own values, within the bounds: the start of a search."""
        own, (low, high) = free(self.base), np.transpose(self.bounds)
        middle = 0.5 * (low + high)
        numbers = [own[path][0] if isinstance(own[path][0], float) else middle[k] for k, path in enumerate(self.ranges)]
        return np.clip(numbers, low, high)

    @cached_property
    def function(self) -> ResultFunction:
        """Results of the scene as functions of the parameters."""
        return ResultFunction(self.base, tuple(self.ranges), self.conditions)

    @property
    def constraints(self) -> list[Any]:
        """The bounds in `subject_to` as scipy.optimize takes them, with exact gradients."""
        return nonlinear_constraints(self.function, self.subject_to)

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """(low, high) of each parameter, as scipy.optimize takes them."""
        return list(self.ranges.values())

    @property
    def names(self) -> list[str]:
        """Paths of the parameters, in the order of x."""
        return list(self.ranges)

    @clear_method
    def scene(self, x: Any) -> Scene:
        """Return the scene with these parameters.

        Parameters
        ----------
        x : array_like
            Values of the parameters [SI], of shape (parameters,) or (parameters, designs).

        Returns
        -------
        Scene
            Scene of one design, or of designs over the dim `candidate`.
        """
        return self.function.scene(self._numbers(x))

    @clear_method
    def peaks(self, x: Any) -> xr.Dataset:
        """Compute the peaks on which the objective depends.

        Parameters
        ----------
        x : array_like
            Values of the parameters [SI], of shape (parameters,) or (parameters, designs).

        Returns
        -------
        Dataset
            Peaks, as from `linksweep.peaks`.
        """
        return peaks(self.scene(x), self.of, **self.options)

    def __call__(self, x: Any) -> Any:
        """Return the objective at x: one number, or one for each column of x."""
        x = self._numbers(x)
        columns = x.reshape(len(x), -1)  # also of one: one that cannot be assembled is no error then
        worst_cases = self.peaks(columns)
        sound = _alone(worst_cases["status"] == 0)
        if self.constraint is not None:
            sound = sound & _alone(self.constraint(worst_cases))
        value = _alone(self.measure(worst_cases))
        value = value.where(sound & np.isfinite(value), np.inf)
        worst = value.max([dim for dim in value.dims if dim != CANDIDATES]).values
        return float(worst.reshape(-1)[0]) if x.ndim == 1 else np.array(np.broadcast_to(worst, columns.shape[1:]))

    def plain_value(self, x: Any) -> float:
        """Return the named result at x, of shape (parameters,), whatever its status: the objective of local searches.

        Parameters
        ----------
        x : array_like
            Values of the parameters [SI].

        Returns
        -------
        float
            The worst over the scene's own dims; with `maximize` the negative.

        Raises
        ------
        ValueError
            If the objective is a function and not a name, or of samples or a part of the cycle.
        """
        self._require_gradients()
        return self.sign * self.function.value(self.target, self._numbers(x), "max" if self.sign > 0.0 else "min")

    @clear_method
    def gradient(self, x: Any) -> np.ndarray:
        """Return the exact derivatives of the objective to the parameters.

        Parameters
        ----------
        x : array_like
            Values of the parameters [SI], of shape (parameters,).

        Returns
        -------
        array
            One for each parameter, at the peak's own angle; of two equal rises those of one.

        Raises
        ------
        ValueError
            If the objective is a function and not a name, or of samples or a part of the cycle.
        """
        self._require_gradients()
        return self.sign * self.function.gradient(self.target, self._numbers(x), "max" if self.sign > 0.0 else "min")

    @clear_method
    def optimum(self, *, method: str = "SLSQP", multistart: Any = None, minimax: int = 0) -> Any:
        """Search a local optimum under the constraints, with exact gradients, from one start or several.

        Parameters
        ----------
        method : str, default "SLSQP"
            Method of ``scipy.optimize.minimize``: "SLSQP", or "trust-constr", which takes more calls.
        multistart : int or Dataset, default None
            Further starts besides the scene's own values, a search for each: a number of points within the ranges, or
            the designs of a Dataset, such as the front of a study of these parameters. Where `constraint` is False of
            the scene itself give some: it has no gradient that would lead to designs of which it is True.
        minimax : int, default 0
            Number of equal sectors of the cycle, such as 24, in each of which the largest value is held below a bound
            that is minimized: two equal peaks do not stop this search. 0 for the peak alone.

        Returns
        -------
        OptimizeResult
            The best of all starts: `x`, in the parameters' units, and `fun`, the exact result there, of a maximum the
            negative; `allowed`, whether all constraints hold and, where the scene itself has status ok, the status is;
            `success`, `message` and `nit`, the iterations, as scipy returns them; `calls`, the values and gradients
            computed for all starts; `start` and `method`.

        Raises
        ------
        ValueError
            If the objective is a function and not a name, or of samples or a part of the cycle, a Dataset lacks a
            parameter, a method is unknown, or minimax is asked for a result without rises, such as "T12_rms".

        Examples
        --------
        >>> import linksweep as ls
        >>> may_be = {"coupler.length": (0.2, 0.24), "rocker.length": (0.15, 0.2)}
        >>> lightest = ls.objective(ls.example("press"), may_be, minimize="F32_peak", subject_to={"swing": (60, None)})
        >>> best = lightest.optimum()
        >>> bool(best.allowed and best.fun < lightest(lightest.x0))
        True
        """
        self._require_gradients()
        return local_optimum(self, method, multistart, minimax)

    def _require_gradients(self) -> None:
        advice = 'a search by gradients needs the name of a result, as minimize="F32_peak"'
        refuse([] if self.target else [f"minimize is a function: {advice}"])
        advice = "leave it out, or search by values alone, as differential_evolution does"
        parts = {name: value for name in PARTS if (value := self.options.get(name)) is not None}
        words = f"gradients are those of the whole cycle's peak: {advice}"
        refuse([f"{name} = {quote(value)}: {words}" for name, value in parts.items()])

    def _numbers(self, x: Any) -> np.ndarray:
        x = np.asarray(x, dtype=float)
        if x.ndim not in (1, 2) or len(x) != len(self.ranges):
            shapes = f"({len(self.ranges)},) or ({len(self.ranges)}, designs)"
            raise ValueError(f"x has the shape {x.shape}: must be {shapes}, one row for each of {self.names}")
        return x


def _alone(value: Any) -> xr.DataArray:
    """Return an array without its scalar coordinates, whose comparison takes longer than its use."""
    return xr.DataArray(value).reset_coords(drop=True)


@passing_options_to(peaks)
def objective(
    scene: Scene,
    parameters: Mapping[str, tuple[Any, Any]],
    *,
    minimize: str | Measure | None = None,
    maximize: str | Measure | None = None,
    constraint: Measure | None = None,
    of: Iterable[str] | None = None,
    subject_to: Mapping[str, tuple[float | None, float | None]] | None = None,
    fluctuation: float = 0.02,
    pins: Mapping[str, Bearing] | None = None,
    **options: Any,
) -> Objective:
    """Make a function of a scene's parameters for ``scipy.optimize.differential_evolution(vectorized=True)``.

    Parameters
    ----------
    scene : Scene
        Scene whose other numbers stay. Where it has dims of its own (load cases, both branches), the worst over them
        counts.
    parameters : mapping of str to pair
        Least and largest value of each free parameter by its path: numbers in the parameter's unit [SI], or text with a
        unit.
    minimize : str or callable, default None
        Name of a result of `peaks` ("F32_peak", "T12_rms", "transmission_angle_min"), or a function of that Dataset,
        such as ``lambda peaks: peaks.F32_peak + 0.1 * peaks.T12_peak``.
    maximize : str or callable, default None
        Name or function that is to be maximized; give one of the two.
    constraint : callable, default None
        Function of the Dataset of peaks; False where a design is not allowed.
    of : iterable of str, default None
        Quantities on which these functions depend, as in `peaks`. None for the one that `minimize` names; where there
        are functions, all pins and the torque besides.
    subject_to : mapping of str to pair, default None
        Least and largest value of results by name, each in the result's unit [any], None for no bound:
        {"transmission_angle_min": (40, None), "swing": (50, None)}, names as in `linksweep.sensitivities`, over the
        whole cycle. They are in `.constraints`, and in `.optimum()`.
    fluctuation : float, default 0.02
        Coefficient of speed fluctuation of "flywheel_inertia" [1].
    pins : mapping of str to Bearing, default None
        Bearings, {"B": ls.Bearing(capacity=...)}, of which "L10_B" and "L10h_B" take the capacity.
    **options
        Further arguments of `peaks`, such as between or theta2: then without gradients.

    Returns
    -------
    Objective
        Function with `bounds`. With x of shape (parameters,) it returns a number, with (parameters, designs) one for
        each design; with `maximize` the negative. Designs whose status is not ok, or that are not allowed, have +inf.
        `.scene(x)` is the scene with these parameters, `.peaks(x)` its peaks. With a name, `.gradient`, `.constraints`
        are for ``scipy.optimize.minimize(f, f.x0, jac=f.gradient, bounds=f.bounds, constraints=f.constraints)``, and
        `.optimum()` is such a search.

    Raises
    ------
    ValueError
        If a parameter or name is unknown, a range or bound is no pair (low, high), the constraint is no function, the
        fluctuation is none, bearings do not fit the scene, or the scene refuses its values.

    Examples
    --------
    >>> import linksweep as ls
    >>> from scipy.optimize import differential_evolution
    >>> lightest = ls.objective(ls.example("press"), {"coupler.length": ("20 cm", "24 cm")}, minimize="F32_peak")
    >>> result = differential_evolution(
    ...     lightest, lightest.bounds, vectorized=True, updating="deferred", polish=False, maxiter=3, rng=1)
    >>> best = lightest.scene(result.x)
    >>> bool(ls.peaks(best, of=["F32"]).F32_peak == result.fun)
    True
    """
    require_scene(scene)
    ranges = checked_ranges(scene, parameters)
    both = minimize is not None and maximize is not None
    if both or minimize is maximize:
        refuse([f'minimize: give {"either" if both else "it,"} or maximize, as minimize="F32_peak"'])
    target, path = (maximize, "maximize") if minimize is None else (minimize, "minimize")
    if not isinstance(target, str) and not callable(target):
        refuse([f"{path} = {quote(target)}: must be a name, or a function of the Dataset of peaks"])
    bound = 'a function of the Dataset of peaks; bounds of a result are subject_to={"F32_peak": (None, 900)}'
    known = constraint is None or callable(constraint)
    refuse([] if known else [f"constraint = {quote(constraint)}: must be {bound}"])
    if isinstance(target, str):
        (target,) = requested(path, target, scene)
        requests_named(path, [quantity_of(target)], scene)
    names = _names(scene, target, constraint, None if of is None else requested("of", of, scene))
    measure = partial(_measured, target, 1.0 if path == "minimize" else -1.0)
    if isinstance(subject_to, Mapping):
        subject_to = by_name("subject_to", subject_to, scene)
    conditions = checked_conditions(scene, fluctuation, pins)
    bounds = checked_bounds(scene, subject_to, conditions)
    result = target if isinstance(target, str) and target in result_names(scene) else ""
    sign = 1.0 if path == "minimize" else -1.0
    ready = Objective(scene, ranges, measure, constraint, names, options, result, sign, bounds, conditions)
    _try(ready, target, path)
    return ready


def _try(ready: Objective, target: Any, path: str) -> None:
    """Evaluate at the ends of all ranges, so that errors appear here and not in the middle of a search."""
    results = ready.peaks(np.array(ready.bounds))
    refuse(name_problems(path, target, map(str, results.data_vars)) if isinstance(target, str) else [])
    for word, function in ((path, target), ("constraint", ready.constraint)):
        several = callable(function) and isinstance(function(results), xr.Dataset)
        one = f"{word}: its function must return one result, such as peaks.F32_peak, not a Dataset"
        refuse([one] if several else [])
    ready(np.array(ready.bounds))


def _measured(target: Any, sign: float, results: xr.Dataset) -> Any:
    """Return what is minimized, of a name or function as the target; of the module, so that an objective is pickled."""
    return sign * (results[target] if isinstance(target, str) else target(results))


def _names(scene: Scene, target: Any, constraint: Measure | None, of: list[str] | None) -> list[str] | None:
    """Return the quantities that `peaks` is to compute."""
    named = [quantity_of(target)] if isinstance(target, str) else []
    if of is None and (constraint is not None or not named):
        of = list(scene.mechanism.peak_quantities(scene.drive))
    return list(dict.fromkeys([*named, *(of or [])]))
