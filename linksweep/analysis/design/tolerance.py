"""Tolerances and results: linear variance with the share of each, the worst case, and exact results beside.

With the derivatives s_k of a result to the parameters p_k, each of which has a mean shift m_k, a standard deviation σ_k
and limits l_k ≤ p − p0 ≤ u_k, all independent,

    shift Σ s_k m_k        variance σ² = Σ (s_k σ_k)²        share_k = (s_k σ_k)²/σ²
    worst case  Σ max(s_k l_k, s_k u_k)   and   Σ min(s_k l_k, s_k u_k)

This holds while the result is linear within the tolerances. Beside it stand mean, deviation, least and largest of the
exact results of designs that are drawn from the same tolerances: where the two differ, linear does not hold.

A `Tolerance` is even between its limits, as in `sample`: σ = (u − l)/√12. Limits of a `Normal` without any are ±3σ.
Source: e.g. E. Morse et al., Tolerancing: Managing uncertainty from conceptual design to final product, CIRP Annals 67
(2018) 695 (worst case and root sum square).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.design.conditions import checked_conditions
from linksweep.analysis.design.fits import is_fit, limit_deviations
from linksweep.analysis.design.result_derivatives import derived, result_problems, result_value, whole_name
from linksweep.analysis.design.sensitivities import labelled, stacked
from linksweep.analysis.pins.bearing import Bearing
from linksweep.base.units import quantity
from linksweep.base.validate import count_problems, quote, refuse
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import requested_some, require_scene
from linksweep.results.dataset import flags
from linksweep.results.derivatives.of_peaks import MEANINGS
from linksweep.scene.at_sections import with_sections
from linksweep.scene.derivatives.differentiated import number_problem
from linksweep.scene.designs.distributions import Normal, Tolerance
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.designs.sampling import parameter_problems, sample
from linksweep.scene.parameters import free
from linksweep.scene.scene import Scene

DRAWN = "toleranced_design"
"""Dim of the designs drawn from tolerances."""
SIGMAS = 3.0
"""Limits of a normal distribution without any, in standard deviations."""
NARROW = 1e-4
"""Largest distance from the mean, in standard deviations, within which a normal distribution is even, to 1e-9."""
Choice = Normal | Tolerance


class Spread(NamedTuple):
    """Mean shift, standard deviation and limits of a parameter from its own value, in its SI unit."""

    shift: float
    deviation: float
    lower: float
    upper: float


@limits_threads
def tolerance(
    scene: Scene,
    tolerances: Mapping[str, Choice | str],
    *,
    of: str | Iterable[str],
    n: int = 1024,
    seed: int | None = 0,
    fluctuation: float = 0.02,
    pins: Mapping[str, Bearing] | None = None,
    threads: int | None = None,
) -> xr.Dataset:
    """Compute what tolerances of parameters do to results: sigma, the share of each parameter, the worst case.

    Parameters
    ----------
    scene : Scene
        Scene of any number of designs, with the nominal values.
    tolerances : mapping
        Tolerance of each parameter by its path: `Tolerance(lower, upper)` or `Normal(deviation=...)` around the scene's
        own value, or of a length a class of ISO 286, as "h9" for its own size or "40 H7" for another [mm].
    of : str or iterable of str
        Names of results, as in `linksweep.sensitivities`.
    n : int, default 1024
        Designs drawn from the tolerances whose exact results stand beside; 0 for none.
    seed : int, default 0
        Seed of these designs; None for others each time.
    fluctuation : float, default 0.02
        Coefficient of speed fluctuation of "flywheel_inertia" [1].
    pins : mapping of str to Bearing, default None
        Bearings, {"B": ls.Bearing(capacity=...)}, of which "L10_B" and "L10h_B" take the capacity.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Over the design dims, for each result such as F32_peak: its nominal value; `F32_peak_sigma`, the linear standard
        deviation, and `F32_peak_shift`, that of the mean; over the dim `parameter` `F32_peak_share` [1] of the
        variance, `F32_peak_lower` and `F32_peak_upper`, the changes with each parameter alone at its lower and upper
        limit; `F32_peak_worst_least` and `F32_peak_worst_largest`, the linear worst cases; `F32_peak_drawn_mean`,
        `_drawn_sigma`, `_drawn_least` and `_drawn_largest` of the exact results of drawn designs; and
        `F32_peak_status`, as from `linksweep.sensitivities`.

    Raises
    ------
    ValueError
        If a path or name is unknown, there is no name, a parameter has no derivative, a tolerance or the fluctuation is
        none, or bearings do not fit the scene.

    Notes
    -----
    Equations and sources: `linksweep.analysis.design.tolerance`, classes of ISO 286: `linksweep.analysis.design.fits`.

    Examples
    --------
    >>> import linksweep as ls
    >>> made = {"crank.length": "js9", "coupler.length": ls.Normal(deviation="0.05 mm", within=3)}
    >>> ds = ls.tolerance(ls.example("press"), made, of="F32_peak", n=64)
    >>> print(f"{float(ds.F32_peak):.1f} N, sigma {float(ds.F32_peak_sigma):.3f} N")
    354.5 N, sigma 0.051 N
    >>> ds.F32_peak_share.round(3).values.tolist()  # of its variance, by parameter
    [0.871, 0.129]
    """
    require_scene(scene)
    names = requested_some("of", of, scene)
    scene = with_sections(in_memory(scene), names)
    choices = _choices(scene, tolerances)
    conditions = checked_conditions(scene, fluctuation, pins)
    problems = [problem for name in names for problem in result_problems(scene, "of", name, conditions)]
    refuse([*problems, *([] if n == 0 else count_problems("n", n))])
    paths = tuple(choices)
    spreads = {path: _spread(choice, free(scene)[path][1]) for path, choice in choices.items()}
    variables: dict[str, Any] = {}
    drawn = sample(scene, choices, n=n, seed=seed, dim=DRAWN) if n else None
    for name in dict.fromkeys(whole_name(scene, name) for name in names):
        result = derived(scene, name, paths, conditions).only_ok()
        units, text = (str(result.value.attrs.get(word, "")) for word in ("units", "long_name"))
        linear = _linear(name, result.slopes, spreads, result.value, text)
        exact = {} if drawn is None else _drawn(name, result_value(drawn, name, conditions), text)
        for key, (values, words) in (linear | exact).items():
            unit = "1" if key.endswith("_share") else units
            variables[key] = values.reset_coords(drop=True).assign_attrs(units=unit, long_name=words)
        meanings = flags(f"whether derivatives exist: {name}", MEANINGS)
        variables[f"{name}_status"] = result.status.astype(np.int8).reset_coords(drop=True).assign_attrs(meanings)
    return labelled(scene, variables, paths, f"linksweep.tolerance(scene, {{...}}, of={names}, n={n})")


def _choices(scene: Scene, tolerances: Any) -> dict[str, Choice]:
    """Return the tolerances with names of ISO 286 as limits."""
    if not isinstance(tolerances, Mapping) or not tolerances:
        refuse([f'tolerances = {quote(tolerances)}: must name what varies, as in {{"crank.length": "h9"}}'])
    refuse([line.replace("parameters", "tolerances", 1) for line in parameter_problems(scene, tolerances)])
    own, choices, problems = free(scene), dict[str, Choice](), []
    for path, choice in tolerances.items():
        value, kind = own[path]
        if problem := number_problem(scene, path):
            problems.append(problem)
        elif is_fit(choice):
            if kind != "length" or not isinstance(value, float):
                problems.append(f"{path}: {choice!r} is a class of lengths; give it ls.Tolerance(lower, upper)")
            else:
                try:
                    choices[path] = Tolerance(*limit_deviations(str(choice), abs(value)))
                except ValueError as error:
                    problems.append(f"{path} = {error}")
        elif isinstance(choice, Choice):
            choices[path] = choice
        else:
            words = 'ls.Tolerance(lower, upper), ls.Normal(deviation=...) or a class of ISO 286, as "h9"'
            problems.append(f"{path}: {quote(choice)}: must be {words}")
    refuse(problems)
    centred = [
        f"{path}: {choice!r} has a mean of its own; leave it out"
        for path, choice in choices.items()
        if isinstance(choice, Normal) and choice.mean is not None
    ]
    refuse(centred)
    refuse([line for path, choice in choices.items() for line in _values_problems(path, choice, own[path][1])])
    return choices


def _values_problems(path: str, choice: Choice, kind: str) -> list[str]:
    """Return the problem of a tolerance whose numbers cannot be drawn, whether designs are drawn or not."""
    try:
        choice.at(np.array([0.5]), kind)
    except ValueError as error:
        return [f"{path}: {error}"]
    return []


def _spread(choice: Choice, kind: str) -> Spread:
    """Return the numbers of a tolerance."""
    if isinstance(choice, Tolerance):
        lower, upper = (quantity(end, kind) for end in (choice.lower, choice.upper))
        return Spread(0.5 * (lower + upper), (upper - lower) / math.sqrt(12.0), lower, upper)
    deviation, k = quantity(choice.deviation, kind), float(choice.within)
    limit = (k if math.isfinite(k) else SIGMAS) * deviation
    return Spread(0.0, deviation * _truncated(k), -limit, limit)


def _truncated(k: float) -> float:
    """Return the standard deviation of a standard normal distribution within ±k."""
    if not math.isfinite(k):
        return 1.0
    if k < NARROW:
        return k / math.sqrt(3.0)
    density, inside = math.exp(-0.5 * k * k) / math.sqrt(2.0 * math.pi), math.erf(k / math.sqrt(2.0))
    return math.sqrt(1.0 - 2.0 * k * density / inside)


def _linear(
    name: str, slopes: Mapping[str, xr.DataArray], spreads: Mapping[str, Spread], value: xr.DataArray, text: str
) -> dict[str, tuple[xr.DataArray, str]]:
    """Return the module's equations, with words for each."""
    sizes = {path: abs(slope) * spreads[path].deviation for path, slope in slopes.items()}
    variance = sum(size * size for size in sizes.values())
    lower = {path: slope * spreads[path].lower for path, slope in slopes.items()}
    upper = {path: slope * spreads[path].upper for path, slope in slopes.items()}
    most = sum(np.maximum(lower[path], upper[path]) for path in slopes)
    least = sum(np.minimum(lower[path], upper[path]) for path in slopes)
    shift = sum(slope * spreads[path].shift for path, slope in slopes.items())
    share = stacked({path: size * size / xr.DataArray(variance) for path, size in sizes.items()})
    return {
        name: (value, text),
        f"{name}_sigma": (xr.DataArray(variance) ** 0.5, f"linear standard deviation of: {text}"),
        f"{name}_shift": (xr.DataArray(shift), f"linear shift of the mean of: {text}"),
        f"{name}_share": (share, f"share in the variance of: {text}"),
        f"{name}_lower": (stacked(lower), f"change with the parameter at its lower limit of: {text}"),
        f"{name}_upper": (stacked(upper), f"change with the parameter at its upper limit of: {text}"),
        f"{name}_worst_least": (value + least, f"least with all parameters at their worst, linear, of: {text}"),
        f"{name}_worst_largest": (value + most, f"largest with all parameters at their worst, linear, of: {text}"),
    }


def _drawn(name: str, values: xr.DataArray, text: str) -> dict[str, tuple[xr.DataArray, str]]:
    """Return mean, deviation and ends of exact results of drawn designs."""
    values = values if DRAWN in values.dims else values.expand_dims(DRAWN)
    with np.errstate(invalid="ignore"):  # forces without bound have no deviation: inf − inf
        deviation = values.std(DRAWN)
    return {
        f"{name}_drawn_mean": (values.mean(DRAWN), f"mean over drawn designs of: {text}"),
        f"{name}_drawn_sigma": (deviation, f"standard deviation over drawn designs of: {text}"),
        f"{name}_drawn_least": (values.min(DRAWN), f"least over drawn designs of: {text}"),
        f"{name}_drawn_largest": (values.max(DRAWN), f"largest over drawn designs of: {text}"),
    }
