"""objective(scene, {...}, minimize=...): a function of numbers, as optimizers want it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import name_problems, quote, refuse
from linksweep.results.compute import require_scene
from linksweep.results.peaks import peaks
from linksweep.scene.parameters import free, replaced
from linksweep.scene.scene import Scene
from linksweep.scene.units import quantity

CANDIDATES = "candidate"
"""Dimension of the designs of one call. It always has the same name, so that one kernel serves all calls."""
WORDS = ("peak", "max", "min", "peak_at", "max_at", "min_at")
"""What names of peaks have behind the name of the quantity."""

Measure = Callable[[xr.Dataset], Any]


@dataclass(frozen=True, eq=False)
class Objective:
    """A scene's objective as a function of its free parameters: see `objective`."""

    base: Scene
    ranges: Mapping[str, tuple[float, float]]
    measure: Measure
    constraint: Measure | None
    of: list[str] | None
    options: Mapping[str, Any]

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """(low, high) of each parameter, as scipy.optimize takes them."""
        return list(self.ranges.values())

    @property
    def names(self) -> list[str]:
        """Paths of the parameters, in the order of x."""
        return list(self.ranges)

    def scene(self, x: Any) -> Scene:
        """The scene with these parameters; for x of shape (parameters, designs) over the dim `candidate`."""
        x = self._numbers(x)
        rows = map(float, x) if x.ndim == 1 else (xr.DataArray(row, dims=CANDIDATES) for row in x)
        return replaced(self.base, dict(zip(self.ranges, rows, strict=True)))

    def peaks(self, x: Any) -> xr.Dataset:
        """What the objective looks at."""
        return peaks(self.scene(x), self.of, **self.options)

    def __call__(self, x: Any) -> Any:
        """The objective at x: one number, or one for each column of x."""
        x = self._numbers(x)
        columns = x.reshape(len(x), -1)
        found = self.peaks(columns)
        sound = _alone(found["status"] == 0)
        if self.constraint is not None:
            sound = sound & _alone(self.constraint(found))
        value = _alone(self.measure(found))
        value = value.where(sound & np.isfinite(value), np.inf)
        worst = value.max([dim for dim in value.dims if dim != CANDIDATES]).values
        return float(worst.reshape(-1)[0]) if x.ndim == 1 else np.array(np.broadcast_to(worst, columns.shape[1:]))

    def _numbers(self, x: Any) -> np.ndarray:
        x = np.asarray(x, dtype=float)
        if x.ndim not in (1, 2) or len(x) != len(self.ranges):
            wanted = f"({len(self.ranges)},) or ({len(self.ranges)}, designs)"
            raise ValueError(f"x has the shape {x.shape}: must be {wanted}, one row for each of {self.names}")
        return x


def _alone(value: Any) -> xr.DataArray:
    """Without the parameters that stand beside it: to compare them takes longer than to use it."""
    return xr.DataArray(value).reset_coords(drop=True)


def objective(
    scene: Scene,
    parameters: Mapping[str, tuple[Any, Any]],
    minimize: str | Measure | None = None,
    maximize: str | Measure | None = None,
    constraint: Measure | None = None,
    of: Iterable[str] | None = None,
    **options: Any,
) -> Objective:
    """A scene as a function to be minimized, ready for ``scipy.optimize.differential_evolution(vectorized=True)``.

    Parameters
    ----------
    scene : what does not vary. Where it has dims of its own (load cases, both branches), the worst over them counts
    parameters : (low, high) of each free parameter by its path; numbers in the parameter's unit, or text with a unit
    minimize, maximize : one of the two: a name in what `peaks` gives ("F32_peak", "T12_rms", "transmission_angle_min"),
        or a function of that Dataset, such as ``lambda peaks: peaks.F32_peak + 0.1 * peaks.T12_peak``
    constraint : function of the Dataset of peaks; False where a design is not allowed
    of : quantities that these functions look at, as `peaks` takes them. Default: what `minimize` names; where there
        are functions, all pins and the torque besides
    **options : for `peaks`, such as theta2

    Returns
    -------
    Objective, with `bounds`. Called with x of shape (parameters,) it gives a number, with (parameters, designs) one
    for each design; with `maximize` the negative. Designs whose status is not ok, or that are not allowed, give +inf.
    `.scene(x)` is the scene with these parameters, `.peaks(x)` its peaks.

    Raises
    ------
    ValueError
        For unknown parameters and names, and ranges that are none or that the scene refuses.

    Examples
    --------
    >>> import linksweep as ls
    >>> from scipy.optimize import differential_evolution
    >>> lightest = ls.objective(ls.example("press"), {"coupler.length": ("20 cm", "24 cm")}, minimize="F32_peak")
    >>> found = differential_evolution(
    ...     lightest, lightest.bounds, vectorized=True, updating="deferred", polish=False, maxiter=3, rng=1)
    >>> best = lightest.scene(found.x)
    >>> bool(ls.peaks(best, of=["F32"]).F32_peak == found.fun)
    True
    """
    require_scene(scene)
    ranges = _ranges(scene, parameters)
    both = minimize is not None and maximize is not None
    if both or minimize is maximize:
        refuse([f'minimize: give {"either" if both else "it,"} or maximize, as minimize="F32_peak"'])
    wanted, path = (maximize, "maximize") if minimize is None else (minimize, "minimize")
    if not isinstance(wanted, str) and not callable(wanted):
        refuse([f"{path} = {quote(wanted)}: must be a name, or a function of the Dataset of peaks"])
    wanted_of = None if of is None else list(of)
    ready = Objective(
        scene, ranges, _measure(wanted, path), constraint, _of(scene, wanted, constraint, wanted_of), options
    )
    _try(ready, wanted, path)
    return ready


def _try(ready: Objective, wanted: Any, path: str) -> None:
    """At the ends of all ranges, so that what is wrong is said here and not in the middle of a search."""
    found = ready.peaks(np.array(ready.bounds))
    refuse(name_problems(path, wanted, map(str, found.data_vars)) if isinstance(wanted, str) else [])
    ready(np.array(ready.bounds))


def _measure(wanted: Any, path: str) -> Measure:
    sign = 1.0 if path == "minimize" else -1.0
    return lambda found: sign * (found[wanted] if isinstance(wanted, str) else wanted(found))


def _of(scene: Scene, wanted: Any, constraint: Measure | None, of: list[str] | None) -> list[str] | None:
    """What to ask `peaks` for."""
    named = [_quantity(wanted)] if isinstance(wanted, str) else []
    if of is None and (constraint is not None or not named):
        of = list(scene.mechanism.peak_quantities(scene.drive))
    return list(dict.fromkeys([*named, *(of or [])]))


def _quantity(name: str) -> str:
    """The quantity of which a name of peaks is one: F32 of F32_peak; means are asked for by their own names."""
    return next((name.removesuffix(f"_{word}") for word in WORDS if name.endswith(f"_{word}")), name)


def _ranges(scene: Scene, parameters: Any) -> dict[str, tuple[float, float]]:
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
