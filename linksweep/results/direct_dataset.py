"""Make Datasets of variables that are new and fit each other, without the constructor's copies and comparisons.

xarray's own shortcut for this is private. So it is tried once on a small Dataset, and where it is missing, or makes
another Dataset than the public constructor, that one is called.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from xarray.indexes import PandasIndex

Variables = Mapping[str, xr.Variable]
Constructor = Callable[[Variables, Variables, Mapping[str, Any]], xr.Dataset]


def dataset_of(variables: Variables, coordinates: Variables, attributes: Mapping[str, Any]) -> xr.Dataset:
    """Return the Dataset of variables that nobody else holds, and of copies of the coordinates."""
    return _constructor()(variables, coordinates, attributes)


@cache
def _constructor() -> Constructor:
    """Return the shortcut where it works, else the public constructor."""
    angles, names = (xr.IndexVariable(dim, pd.Index([0.0]), fastpath=True) for dim in ("theta2", "design"))
    numbers = xr.Variable(("design", "theta2"), np.ones((1, 1)), {"units": "N"}, fastpath=True)
    parts = {"a": numbers}, {"theta2": angles, "design": names, "b": numbers}, {"title": "a probe"}
    try:
        works = _content(direct(*parts)) == _content(xr.Dataset(*parts))
    except (AttributeError, TypeError):
        works = False
    return direct if works else xr.Dataset


def _content(ds: xr.Dataset) -> tuple[Any, ...]:
    """Return what makes up a small Dataset; its method `identical` would import dask."""
    variables = [(name, type(each), each.dims, each.values.tolist(), each.attrs) for name, each in ds.variables.items()]
    return variables, dict(ds.sizes), {*ds.coords}, {name: type(index) for name, index in ds.xindexes.items()}, ds.attrs


def direct(variables: Variables, coordinates: Variables, attributes: Mapping[str, Any]) -> xr.Dataset:
    """Return what ``xr.Dataset`` does of these, by its private shortcut."""
    every: dict[Any, xr.Variable] = dict(variables)
    indexes: dict[Any, xr.Index] = {}
    for name, variable in coordinates.items():
        if variable.dims == (name,):
            along = {name: variable.to_index_variable()}
            index = indexes[name] = PandasIndex.from_variables(along, options={})
            every |= index.create_variables(along)
        else:
            every[name] = variable.to_base_variable()
    sizes = {dim: size for variable in every.values() for dim, size in zip(variable.dims, variable.shape, strict=True)}
    return xr.Dataset._construct_direct(every, {*coordinates}, sizes, dict(attributes) or None, indexes)
