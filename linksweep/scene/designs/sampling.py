"""sample(scene, {...}, n): a scene over n designs, drawn evenly or by chance from what its parameters may be."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.memory import require_memory
from linksweep.base.validate import choice_problems, count_problems, name_problems, quote, refuse
from linksweep.scene.designs.distributions import around_own, quantiles
from linksweep.scene.parameters import free, replaced
from linksweep.scene.scene import Scene

METHODS = ("sobol", "halton", "latin_hypercube", "random")
FINEST = 2.0**-31
"""Half of the finest step of scipy's Sobol points: 0 and 1, where a normal is infinite, are kept off by it."""

NUMBERED = {"long_name": "number of the design"}
"""Attributes of the labels of designs."""


def sample(
    scene: Scene,
    parameters: Mapping[str, Any],
    *,
    n: int,
    method: str = "sobol",
    seed: int | None = 0,
    dim: str = "design",
) -> Scene:
    """Draw designs of a scene from ranges and distributions of its parameters.

    Parameters
    ----------
    scene : Scene
        Parameters that are not named stay as they are, also those with dims of their own.
    parameters : mapping
        Values that each parameter may take, by its path ("coupler.length", "gravity[2]", "loads[1].force[1]",
        "omega2"): a range (low, high), evenly; a list of values, each as likely as the others;
        `Normal(mean, deviation)`; `Tolerance(lower, upper)` around the scene's own value; or any frozen distribution
        of scipy.stats. Numbers are in the parameter's [unit], or text with a unit: ("8 cm", "12 cm").
    n : int
        Number of designs.
    method : str, default "sobol"
        "sobol", "halton" and "latin_hypercube" fill the space more evenly than "random" does (scipy.stats.qmc,
        scrambled). Sobol points are at their best where n is a power of two; any n will do.
    seed : int, default 0
        Seed of the points, the same designs to the bit for the same seed; None for others each time.
    dim : str, default "design"
        Name of the dimension of the designs, which are numbered along it from 0.

    Returns
    -------
    Scene
        Its sampled parameters are DataArrays over `dim`, each independent of the others.

    Raises
    ------
    ValueError
        One line for each parameter that is unknown or whose range is invalid, and for values that the scene refuses,
        with how many of the n there are.

    Examples
    --------
    >>> import linksweep as ls
    >>> may_be = {"coupler.length": ("20 cm", "24 cm"), "crank.length": ls.Normal(deviation=1e-4), "omega2": [20, 30]}
    >>> drawn = ls.sample(ls.example("press"), may_be, n=1024)
    >>> dict(ls.peaks(drawn, of=["F32"]).F32_peak.sizes)
    {'design': 1024}
    """
    problems = parameter_problems(scene, parameters)
    problems += count_problems("n", n) + choice_problems("method", method, METHODS)
    refuse([*problems, *([] if seed is None else seed_problems(seed)), *dim_problems(scene, dim)])
    require_memory(f"n = {quote(n)}", 2.0 * 8.0 * n * len(parameters))
    return with_designs(scene, parameters, _points(method, len(parameters), int(n), seed), np.arange(int(n)), dim)


def with_designs(
    scene: Scene, parameters: Mapping[str, Any], levels: np.ndarray, labels: np.ndarray, dim: str
) -> Scene:
    """Return the scene of designs whose parameters are the quantiles at these levels, of shape (parameter, design)."""
    own, values, problems = free(scene), {}, []
    for row, (path, choice) in zip(levels, parameters.items(), strict=True):
        try:
            values[path] = _drawn(choice, row, dim, labels, *own[path])
        except ValueError as error:
            problems.append(f"{path}: {error}")
    refuse(problems)
    try:
        return replaced(scene, values)
    except ValueError as error:
        raise ValueError("\n".join(_advised(line, parameters) for line in str(error).split("\n"))) from None


def _drawn(choice: Any, levels: np.ndarray, dim: str, labels: np.ndarray, own: Any, kind: str) -> xr.DataArray:
    around = around_own(choice)
    if around and (own is None or (callable(own) and not hasattr(own, "dims"))):
        raise ValueError(f"{quote(choice)} is around the scene's own value, {quote(own)}: give it a number")
    drawn = xr.DataArray(quantiles(choice, levels, kind), {dim: (dim, labels, NUMBERED)}, dim)
    return own + drawn if around else drawn


def parameter_problems(scene: Any, parameters: Any) -> list[str]:
    """Return the problems of drawing these parameters of a scene."""
    if not isinstance(scene, Scene):
        return [f"scene is a {type(scene).__name__}: must be a Scene"]
    if not isinstance(parameters, Mapping) or not parameters:
        return [f'parameters = {quote(parameters)}: must name what varies, as in {{"coupler.length": (0.1, 0.3)}}']
    return [problem for path in parameters for problem in name_problems("parameters", path, free(scene))]


def dim_problems(scene: Any, dim: Any) -> list[str]:
    """Return the problems of a dim for the designs drawn of a scene."""
    if not isinstance(dim, str) or not dim:
        return [f'dim = {quote(dim)}: must be a name, as dim="design"']
    if not isinstance(scene, Scene):
        return []
    taken = {dim for array in scene.arrays.values() for dim in array.dims}
    if dim in taken | {scene.mechanism.index, *scene.mechanism.coordinates()}:
        return [f'dim = {quote(dim)}: the scene has this dimension already; give another name, as dim="other"']
    return []


def seed_problems(seed: Any) -> list[str]:
    """Return the problem of a seed that is no whole number."""
    whole = isinstance(seed, int | np.integer) and not isinstance(seed, bool)
    return [] if whole and seed >= 0 else [f"seed = {quote(seed)}: must be a whole number, 0 or more, or None"]


def _points(method: str, dims: int, n: int, seed: int | None) -> np.ndarray:
    """Return points of the unit cube, one row a dimension."""
    random = np.random.default_rng(seed)
    if method == "random":
        points = random.random((n, dims))
    else:
        from scipy.stats import qmc  # here: it is slow to import

        engines = {"sobol": qmc.Sobol, "halton": qmc.Halton, "latin_hypercube": qmc.LatinHypercube}
        engine = engines[method](dims, seed=random)
        # scipy draws Sobol points by powers of two, or warns; the first n of more are the same points
        points = engine.random_base2((n - 1).bit_length())[:n] if method == "sobol" else engine.random(n)
    return np.clip(points.T, FINEST, 1.0 - FINEST)


def _advised(line: str, parameters: Mapping[str, Any]) -> str:
    """Return a problem of a drawn value, with advice."""
    drawn = any(line.startswith((f"{path} =", f"{path} holds")) for path in parameters)
    return f"{line}; or draw from a range (low, high), or from ls.Normal(..., within=3)" if drawn else line
