"""Make Datasets of variables that are new and fit each other, without the constructors' copies and comparisons.

xarray's own shortcuts for this are private. So they are tried once on a small Dataset, and where one is missing, or
makes another Dataset than the public constructors, those are called.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from xarray.indexes import PandasIndex

Variables = Mapping[str, xr.Variable]


@dataclass(frozen=True, eq=False)
class Axis:
    """The index of a dim, made once for many Datasets, and the attributes of its coordinate."""

    dim: str
    values: np.ndarray
    attributes: Mapping[str, Any]

    def variable(self) -> xr.Variable:
        """Return a coordinate whose attributes are its own."""
        return self._first.copy(deep=False)

    def direct_variable(self) -> xr.Variable:
        """Return the same by the private fields of variables."""
        return _direct_variable((self.dim,), self._first._data, dict(self.attributes), xr.IndexVariable)

    @cached_property
    def index(self) -> PandasIndex:
        return PandasIndex.from_variables({self.dim: self._passed}, options={})

    @cached_property
    def _first(self) -> xr.Variable:
        return self.index.create_variables({self.dim: self._passed})[self.dim]

    @cached_property
    def _passed(self) -> xr.IndexVariable:
        # a pandas index and fastpath: xarray would import dask and pint to see whether the values are theirs
        index = pd.Index(self.values, name=self.dim)  # named, or the index of the Dataset would be a copy
        return xr.IndexVariable(self.dim, index, self.attributes, fastpath=True)


Constructor = Callable[[Variables, Variables, Mapping[str, Any], Axis | None], xr.Dataset]


def dataset_of(
    variables: Variables, coordinates: Variables, attributes: Mapping[str, Any], axis: Axis | None = None
) -> xr.Dataset:
    """Return the Dataset of variables that nobody else holds, and of copies of the coordinates, `axis` the last."""
    return _constructor()(variables, coordinates, attributes, axis)


def variable_of(dims: tuple[str, ...], values: np.ndarray, attributes: Mapping[str, Any]) -> xr.Variable:
    """Return the variable of an array, with a copy of the attributes."""
    make = _direct_variable if _constructor() is direct else _public_variable
    return make(dims, values, dict(attributes))


@cache
def _constructor() -> Constructor:
    """Return the shortcut where it works, and that for variables does, else the public constructor."""
    designs = xr.IndexVariable("design", pd.Index([0.0]), fastpath=True)
    try:
        direct_one, public_one = (
            make(
                {"a": number(("design", "theta2"), np.ones((1, 1)), {"units": "N"})},
                {"design": designs, "b": number(("theta2",), np.ones(1), {})},
                {"title": "a probe"},
                Axis("theta2", np.zeros(1), {"units": "degree"}),
            )
            for make, number in ((direct, _direct_variable), (public, _public_variable))
        )
        works = _content(direct_one) == _content(public_one)
    except (AttributeError, TypeError):
        works = False
    return direct if works else public


def _public_variable(dims: tuple[str, ...], values: np.ndarray, attributes: dict[str, Any]) -> xr.Variable:
    return xr.Variable(dims, values, attributes, fastpath=True)  # else xarray would import dask


def _direct_variable(
    dims: tuple[Hashable, ...], values: Any, attributes: dict[Any, Any], kind: type[xr.Variable] = xr.Variable
) -> xr.Variable:
    """Return what ``xr.Variable`` makes of these, by its private fields."""
    made: Any = kind.__new__(kind)
    made._dims, made._data, made._attrs, made._encoding = dims, values, attributes or None, None
    return made


def _copied(variable: xr.Variable) -> xr.Variable:
    """Return a variable with attributes of its own; of an index, or with an encoding, as xarray does it."""
    if type(variable) is not xr.Variable or variable._encoding:
        return variable.to_base_variable()
    return _direct_variable(variable._dims, variable._data, dict(variable._attrs or {}))


def _content(ds: xr.Dataset) -> tuple[Any, ...]:
    """Return what makes up a small Dataset; its method `identical` would import dask."""
    variables = [(name, type(each), each.dims, each.values.tolist(), each.attrs) for name, each in ds.variables.items()]
    return variables, dict(ds.sizes), {*ds.coords}, {name: type(index) for name, index in ds.xindexes.items()}, ds.attrs


def public(
    variables: Variables, coordinates: Variables, attributes: Mapping[str, Any], axis: Axis | None
) -> xr.Dataset:
    """Return the Dataset of these by the public constructor."""
    along = {} if axis is None else {axis.dim: axis.variable()}
    return xr.Dataset(variables, {**coordinates, **along}, attributes)


def direct(
    variables: Variables, coordinates: Variables, attributes: Mapping[str, Any], axis: Axis | None
) -> xr.Dataset:
    """Return what `public` does of these, by the private shortcut of ``xr.Dataset``."""
    every: dict[Any, xr.Variable] = dict(variables)
    names: set[Any] = {*coordinates}
    indexes: dict[Any, xr.Index] = {}
    for name, variable in coordinates.items():
        if variable.dims == (name,):
            along = {name: variable.to_index_variable()}
            index = indexes[name] = PandasIndex.from_variables(along, options={})
            every |= index.create_variables(along)
        else:
            every[name] = _copied(variable)
    if axis is not None:
        names.add(axis.dim)
        every[axis.dim], indexes[axis.dim] = axis.direct_variable(), axis.index
    shapes = ((variable.dims, variable._data.shape) for variable in every.values())
    sizes = {dim: size for dims, shape in shapes for dim, size in zip(dims, shape, strict=True)}
    return xr.Dataset._construct_direct(every, names, sizes, dict(attributes) or None, indexes)
