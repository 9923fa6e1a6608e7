"""Datasets that explain themselves: units, signs, status in words, and the whole scene as text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from linksweep.base.frozen import cached_beside
from linksweep.base.version import installed_version
from linksweep.engine.run import Field, Grid
from linksweep.scene.file.toml import write_scene
from linksweep.scene.scene import Scene

STATUS_LONG_NAME = "what happened at this sample; values are NaN where it is not ok"


def described(
    scene: Scene, sampled: Scene, grid: Grid, fields: Mapping[str, Field], status: Field, command: str
) -> xr.Dataset:
    """A cycle's Dataset: the fields over their dims, status, coordinates and attributes."""
    order = (*sampled.inputs.sizes, grid.dim)
    quantity = scene.table.quantity
    variables = {
        name: variable(field, quantity[name].units, quantity[name].long_name, order) for name, field in fields.items()
    }
    variables["status"] = plain(status, status_attributes(scene.mechanism.status_meanings))
    coordinates = cycle_coordinates(sampled) | index_coordinate(scene, grid)
    others = quantity.keys() - scene.motion.keys()  # results that have the name of a parameter, but are not it
    coordinates = {name: values for name, values in coordinates.items() if name not in others}
    attributes = provenance(scene, command, coordinates)
    return xr.Dataset(variables, {k: v for k, v in coordinates.items() if k not in variables}, attributes)


def index_coordinate(scene: Scene, grid: Grid) -> dict[str, xr.Variable]:
    said = {"units": "degree", "long_name": scene.mechanism.position}
    # already pandas' own: xarray would wake dask and pint to see whether the angles are theirs
    return {grid.dim: xr.IndexVariable(grid.dim, pd.Index(grid.angles), said, fastpath=True)}


def plain(field: Field, attributes: Mapping[str, Any]) -> xr.Variable:
    """A field as a variable. xarray need not look at its numbers, nor wake dask to see whether they are dask's."""
    return xr.Variable(field.dims, field.values, attributes, fastpath=True)


def variable(field: Field, units: str, long_name: str, order: Iterable[str]) -> xr.Variable:
    """A field with its unit, and its dims in the order in which the scene names them."""
    made = plain(field, {"units": units, "long_name": long_name})
    if len(field.dims) < 2:
        return made
    return made.transpose(*(dim for dim in dict.fromkeys(order) if dim in field.dims))


def flags(long_name: str, meanings: Iterable[str]) -> dict:
    """CF attributes of a variable whose small integers stand for words."""
    words = list(meanings)
    values = np.arange(len(words), dtype=np.int8)
    return {"long_name": long_name, "flag_values": values, "flag_meanings": " ".join(words)}


def status_attributes(meanings: Iterable[str]) -> dict:
    return flags(STATUS_LONG_NAME, meanings)


def design_coordinates(scene: Scene) -> dict[str, xr.Variable]:
    """Labels of the design dims, and every parameter that has design dims, under its path."""
    index = scene.mechanism.index
    return scene.labels | {path: array for path, array in scene.parameters.items() if index not in array.dims}


def cycle_coordinates(scene: Scene) -> dict[str, xr.Variable]:
    """The same, and the parameters that change over the revolution."""
    return scene.labels | scene.parameters


def origin_attributes(scene: Scene, command: str) -> dict[str, str]:
    return {
        "Conventions": "CF-1.11",
        "title": f"linksweep: {type(scene.mechanism).__name__}",
        "linksweep_version": installed_version(),
        "command": command,
    }


def provenance(scene: Scene, command: str, coordinates: Mapping[str, xr.Variable]) -> dict[str, str]:
    """Where a Dataset comes from, with the whole scene as TOML, so that it can be run again."""
    return origin_attributes(scene, command) | {"scene": _cached_text(scene, kept_beside(scene, coordinates))}


def kept_beside(scene: Scene, coordinates: Iterable[Any]) -> tuple[str, ...]:
    """Paths of the arrays that the text of a scene leaves to coordinates of these names: those over designs.

    Of what changes over the revolution a Dataset has only the samples that were asked for.
    """
    index, names = scene.mechanism.index, {*coordinates}
    return tuple(path for path, array in scene.arrays.items() if path in names and index not in array.dims)


_cached_text = cached_beside(write_scene)


def joined(parts: Iterable[Any], dim: str, labels: Iterable[str]) -> xr.DataArray:
    """Arrays side by side along a new dim, each spread over the dims of all."""
    spread = xr.broadcast(*(xr.DataArray(part) for part in parts))
    return xr.concat(spread, xr.Variable(dim, list(labels)), coords="minimal", compat="override", join="override")
