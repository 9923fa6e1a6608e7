"""Make Datasets that explain themselves: units, signs, status in words, and the whole scene as text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.frozen import cached_beside
from linksweep.base.validate import refuse
from linksweep.base.version import installed_version
from linksweep.engine.run import Field, Grid
from linksweep.results.direct_dataset import Axis, dataset_of, variable_of
from linksweep.scene.file.writing import write_scene
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

OWN_UNITS = "shown_units"
"""Attribute of a Dataset whose scene states units to show results in."""
CYCLE = "cycle"
"""Attribute of a variable of an engine: the crank angle after which it repeats [degree]."""
STATUS_LONG_NAME = "what happened at this sample; values are NaN where it is not ok"
STATUS_AT_LONG_NAME = "pin, or link past a pin, whose dyad first fails at this sample"


def described(
    scene: Scene, sampled: Scene, grid: Grid, fields: Mapping[str, Field], status: Field, command: str
) -> xr.Dataset:
    """Return a cycle's Dataset: fields over their dims, status, coordinates and attributes."""
    order = (*sampled.inputs.sizes, grid.dim)
    quantity = scene.table.quantity
    variables = {
        name: variable(field, quantity[name].units, quantity[name].long_name, order) for name, field in fields.items()
    }
    variables["status"] = plain(status, status_attributes(scene.mechanism.status_meanings))
    known = scene.motion  # a result may have the name of a parameter
    coordinates = {
        name: values
        for name, values in (sampled.labels | sampled.parameters).items()
        if name in known or name not in quantity
    }
    attributes = provenance(scene, command, coordinates)
    variables = {name: values for name, values in variables.items() if values.dims != (name,)}  # a dim's own labels
    beside = {name: values for name, values in coordinates.items() if name not in variables}
    return dataset_of(variables, beside, attributes, axis_of(scene, grid))


def index_coordinate(scene: Scene, grid: Grid) -> dict[str, xr.Variable]:
    """Return the angles of a grid as the coordinate of the scene's index."""
    return {grid.dim: axis_of(scene, grid).variable()}


def axis_of(scene: Scene, grid: Grid) -> Axis:
    """Return the index of a grid's angles: of the same count and period the same one."""
    words = scene.mechanism.position
    if grid.period:
        return _even_axis(len(grid.angles), grid.period, grid.dim, words)
    return _axis(grid.angles, grid.dim, words)


@lru_cache(maxsize=8)
def _even_axis(count: int, period: float, dim: str, words: str) -> Axis:
    return _axis(crank_grid(count, period, dim).angles, dim, words)


def _axis(angles: np.ndarray, dim: str, words: str) -> Axis:
    return Axis(dim, angles, {"units": "degree", "long_name": words})


def plain(field: Field, attributes: Mapping[str, Any]) -> xr.Variable:
    """Return a field as a variable."""
    return variable_of(field.dims, field.values, attributes)


def variable(field: Field, units: str, long_name: str, order: Iterable[str]) -> xr.Variable:
    """Return a field with its unit, and its dims in the order of the scene."""
    result = variable_of(field.dims, field.values, {"units": units, "long_name": long_name})
    if len(field.dims) < 2:
        return result
    return result.transpose(*(dim for dim in dict.fromkeys(order) if dim in field.dims))


def with_units(results: Mapping[str, tuple[Any, str, str]]) -> dict[str, xr.DataArray]:
    """Return arrays by name, of values, unit and description each."""
    arrays = {name: xr.DataArray(values) for name, (values, _, _) in results.items()}
    require_own_names(arrays)
    return {name: arrays[name].assign_attrs(units=units, long_name=text) for name, (_, units, text) in results.items()}


def require_own_names(arrays: Mapping[str, xr.DataArray]) -> None:
    """Raise ValueError where a result has the name of a dim of designs, whose labels would stand in its place."""
    dims = {dim for array in arrays.values() for dim in array.dims}
    taken = "is the name of a result, and of a dimension of the designs; rename the dimension"
    refuse([f"{name}: {taken}" for name in arrays if name in dims])


def flags(long_name: str, meanings: Iterable[str]) -> dict:
    """Return the CF attributes of a variable whose small integers stand for words."""
    words = list(meanings)
    values = np.arange(len(words), dtype=np.int8)
    return {"long_name": long_name, "flag_values": values, "flag_meanings": " ".join(words)}


def status_attributes(meanings: Iterable[str]) -> dict:
    return flags(STATUS_LONG_NAME, meanings)


def design_coordinates(scene: Scene) -> dict[str, xr.Variable]:
    """Return the labels of the design dims, and every parameter that has design dims, by its path."""
    index = scene.mechanism.index
    return scene.labels | {path: array for path, array in scene.parameters.items() if index not in array.dims}


def origin_attributes(scene: Scene, command: str) -> dict[str, str]:
    return {
        "Conventions": "CF-1.11",
        "title": f"linksweep: {type(scene.mechanism).__name__}",
        "linksweep_version": installed_version(),
        **by_command(command),
    } | ({OWN_UNITS: scene.units} if scene.units else {})


def by_command(command: str) -> dict[str, str]:
    """Return the attributes that state the command by which a Dataset was made; CF calls one of them its history."""
    return {"command": command, "history": f"linksweep {installed_version()}: {command}"}


def provenance(scene: Scene, command: str, coordinates: Mapping[str, xr.Variable]) -> dict[str, str]:
    """Return attributes that state the origin of a Dataset, with the scene as TOML, so that it can be run again."""
    return origin_attributes(scene, command) | {"scene": _cached_text(scene, kept_beside(scene, coordinates))}


def kept_beside(scene: Scene, coordinates: Iterable[Any]) -> tuple[str, ...]:
    """Return the paths of arrays over designs that these coordinates store: the text of the scene leaves them out.

    Arrays over the index stay in the text: a Dataset has them at the requested angles alone.
    """
    index, names = scene.mechanism.index, {*coordinates}
    return tuple(path for path, array in scene.arrays.items() if path in names and index not in array.dims)


_cached_text = cached_beside(write_scene)


def joined(parts: Iterable[Any], dim: str, labels: Iterable[str]) -> xr.DataArray:
    """Return arrays side by side along a new dim, each broadcast over the dims of all."""
    arrays = xr.broadcast(*(xr.DataArray(part) for part in parts))
    return xr.concat(arrays, xr.Variable(dim, list(labels)), coords="minimal", compat="override", join="override")
