"""grid(scene, {...}): a scene over all combinations of values of its parameters, a dim for each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.memory import require_memory
from linksweep.base.units import quantity
from linksweep.base.validate import count_problems, is_array, is_quantity, quote, refuse
from linksweep.scene.designs.sampling import parameter_problems
from linksweep.scene.file.axis import evenly
from linksweep.scene.parameters import free, replaced
from linksweep.scene.scene import Scene


def grid(scene: Scene, parameters: Mapping[str, Any]) -> Scene:
    """Make a scene of all combinations of values of its parameters, with a dimension for each.

    Parameters
    ----------
    scene : Scene
        Parameters that are not named stay as they are, also those with dims of their own.
    parameters : mapping
        Values of each parameter, by its path ("coupler.length", "gravity[2]", "loads[1].force[1]", "omega2"): a list or
        an array of them, each in the parameter's [unit] or a text with a unit, ["20 cm", "22 cm"]; or a range (low,
        high, count) with both ends, evenly spaced, ("20 cm", "24 cm", 21). They lie along a dim with the name of the
        path, whose labels they are (`speed_set` of the speed of a car in a loop, for `speed` is a result). A DataArray
        keeps the dims that it has: two of them along one dim vary together.

    Returns
    -------
    Scene
        Its parameters of these names are DataArrays.

    Raises
    ------
    ValueError
        One line for each parameter that is unknown, or whose values are none, equal or not numbers; and for values
        that the scene refuses.

    Examples
    --------
    >>> import linksweep as ls
    >>> designs = ls.grid(ls.example("press"), {"coupler.length": ("20 cm", "24 cm", 5), "omega2": ["200 rpm", 30.0]})
    >>> peaks = ls.peaks(designs, of=["F32"], theta2=360)
    >>> dict(peaks.F32_peak.sizes)
    {'omega2': 2, 'coupler.length': 5}
    >>> peaks["coupler.length"].values.tolist()
    [0.2, 0.21, 0.22, 0.23, 0.24]
    """
    refuse(parameter_problems(scene, parameters))
    own, values, problems = free(scene), {}, []
    results = {*scene.table.quantity} - {*scene.motion}
    for path, choice in parameters.items():
        dim = f"{path}_set" if path in results else path
        try:
            values[path] = _along(dim, choice, own[path][1])
        except ValueError as error:
            problems.append(f"{path}: {error}")
    refuse(problems)
    return replaced(scene, values)


def _along(dim: str, choice: Any, kind: str) -> xr.DataArray:
    """Return the values of a parameter along a dim, whose labels they are; a DataArray as it is."""
    if is_array(choice):
        if not choice.dims:
            raise ValueError("is one number: give it to the scene itself, or a DataArray with a dim")
        return choice
    values = _spaced(choice, kind) if isinstance(choice, tuple) else _listed(choice, kind)
    different, counts = np.unique(values, return_counts=True)
    if (counts > 1).any():
        raise ValueError(f"has {different[counts > 1][0]:.15g} more than once: give each value once")
    return xr.DataArray(values, {dim: values}, dim)


def _spaced(choice: tuple[Any, ...], kind: str) -> np.ndarray:
    """Return the values of a range (low, high, count)."""
    if len(choice) != 3:
        raise ValueError(
            f"{quote(choice)}: must be a range (low, high, count); a list [...] holds the values themselves"
        )
    *ends, count = choice
    low, high = (quantity(end, kind) for end in ends)
    refuse(["count is missing: give how many values"] if count is None else count_problems("count", count))
    require_memory(f"count = {count}", 8.0 * count)
    if count == 1 and low != high:
        raise ValueError(f"{quote(choice)}: two ends need a count of at least 2; a list [...] may hold one value")
    return evenly(low, high, int(count))


def _listed(choice: Any, kind: str) -> np.ndarray:
    """Return the values of a list, or of an array of one axis."""
    array = isinstance(choice, np.ndarray) or is_quantity(choice)
    if not (isinstance(choice, list | range) or (array and np.ndim(choice) == 1)) or not len(choice):
        raise ValueError(f"{quote(choice)}: must be a list of values, a range (low, high, count), or a DataArray")
    return np.array([quantity(value, kind) for value in choice])
