"""Dimensions of a scene's DataArrays: each has a name of its own, one length and one set of labels."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.fields import has_fields, numbers
from linksweep.base.validate import quote
from linksweep.chains.rows.beams import SECTION
from linksweep.mechanisms import Mechanism
from linksweep.scene.storable import label_problem, name_problem

ANGLE = re.compile("((theta|θ)2?|crankangle)(deg|degrees?)?|angledeg(rees?)?")
"""Names that probably mean the index, without signs and spaces."""
UNNAMED = re.compile(r"dim_\d+")
"""Names that xarray gives."""
RESULTS = (
    "status", "arc", "toggle", "spline", "equation", "unknown", SECTION, "pin", "main", "cylinder", "frame", "source",
    "balance", "order", "parameter", "limit", "link", "plane", "criterion", "load_class", "step",
)  # fmt: skip
"""Names of variables and dims in results besides the quantities."""
SUMMARY = re.compile(r"(.+?)_(?:peak|max|min|mean|rms|ripple|bound|samples|amplitude|phase|cos|sin)(?:_.*)?")
"""Names of what results hold of a quantity, such as F32_peak_at."""

Arrays = dict[str, xr.DataArray]
"""DataArrays by the path of the parameter."""


def side_by_side(numbers: Iterable[Any]) -> tuple[tuple[str, ...], list[np.ndarray]]:
    """Return all dims of some numbers, in order of appearance, and the numbers as arrays of one shape over them."""
    numbers = list(numbers)
    dims = dims_of(numbers)
    return dims, list(np.broadcast_arrays(*(np.asarray(aligned(number, dims), dtype=float) for number in numbers)))


def dims_of(numbers: Iterable[Any]) -> tuple[str, ...]:
    """Return all dims of some numbers, in order of appearance."""
    return tuple(dict.fromkeys(str(dim) for number in numbers for dim in getattr(number, "dims", ())))


def aligned(number: Any, dims: tuple[str, ...]) -> Any:
    """Return a number as an array with an axis for each of these dims, of length one where it lacks one."""
    if not hasattr(number, "dims"):
        return number
    sizes = dict(zip(number.dims, number.values.shape, strict=True))
    ordered = number.values.transpose([number.dims.index(dim) for dim in dims if dim in sizes])
    return ordered.reshape([sizes.get(dim, 1) for dim in dims])


def dimension_problems(arrays: Arrays, index: str, quantities: Collection[str]) -> list[str]:
    """Return why a scene's arrays cannot be variables of one Dataset.

    Parameters
    ----------
    arrays : dict of str to DataArray
        Arrays by the path of the parameter.
    index : str
        Dimension of the sweep, which compares sizes and labels itself.
    quantities : collection of str
        Names of the quantities of the scene.
    """
    problems: list[str] = []
    for dim, sharing in _by_dim(arrays).items():
        if dim == index:
            continue
        if name_problems := list(_name_problems(dim, index, sharing, arrays, {*quantities, *RESULTS})):
            problems += name_problems
        else:
            problems += _length_problems(dim, sharing)
            problems += [*_storage_problems(dim, sharing)][:1] or _label_problems(dim, sharing, arrays)
    return problems


def argument_problems(arrays: Arrays, **arguments: Any) -> list[str]:
    """Return why arrays in a function's arguments do not fit a scene's, or each other: a line for each whose length or
    labels along a dim differ. Arguments may be numbers, objects that hold them, and lists or mappings of these."""
    own = _arrays_in(arguments)
    every = _by_dim(arrays | own)
    dims = [dim for dim, sharing in every.items() if own.keys() & sharing.keys()]
    checks = ([*_length_problems(dim, every[dim]), *_label_problems(dim, every[dim], {})] for dim in dims)
    return [problem for check in checks for problem in check]


def _arrays_in(values: Mapping[str, Any]) -> Arrays:
    """Return the arrays among values by path, and in the objects, lists and mappings among them."""
    arrays: Arrays = {}
    for path, value in values.items():
        if isinstance(value, xr.DataArray):
            arrays[path] = value
        elif isinstance(value, Mapping):
            arrays |= _arrays_in({f"{path}.{key}": item for key, item in value.items()})
        elif isinstance(value, tuple | list):
            arrays |= _arrays_in({f"{path}[{k}]": item for k, item in enumerate(value, 1)})
        elif has_fields(value):
            arrays |= _arrays_in({inner: number for inner, number, _ in numbers(value, f"{path}.")})
    return arrays


def length_problems(numbers: Mapping[str, tuple[Any, str]], index: str) -> list[str]:
    """Return why arrays of a machine and its motion, among the numbers of a scene, do not fit together: a line for each
    whose length along a dim, but the index, differs from that of the first, or for the dim's name, if that is wrong.
    Nothing can be computed of such arrays."""
    every = {path: number for path, (number, _) in numbers.items() if isinstance(number, xr.DataArray)}
    arrays = {path: array for path, array in every.items() if not path.startswith("loads[")}
    problems: list[str] = []
    for dim, sharing in _by_dim(arrays).items():
        if dim != index and (lengths := [*_length_problems(dim, sharing)]):
            problems += [*_name_problems(dim, index, sharing, arrays, ())] or lengths
    return problems


def _by_dim(arrays: Arrays) -> dict[object, Arrays]:
    """Return the arrays over each dim."""
    by_dim: dict[object, Arrays] = {}
    for path, array in arrays.items():
        for dim in array.dims:
            by_dim.setdefault(dim, {})[path] = array
    return by_dim


def _name_problems(dim: object, index: str, sharing: Arrays, arrays: Arrays, results: Collection[str]) -> Iterator[str]:
    """Yield why a dim cannot have its name."""
    path = next(iter(sharing))
    if problem := name_problem(dim):
        yield f"{path} has a dimension {quote(dim)}: {problem}; rename it"
    elif ANGLE.fullmatch(re.sub(r"[\W_]", "", unicodedata.normalize("NFKC", str(dim)).casefold())):
        yield f'{path} has a dimension "{dim}": rename it; did you mean "{index}"?'
    elif UNNAMED.fullmatch(str(dim)):
        yield f'{path} has a dimension "{dim}", which nobody named: rename it, "{index}" of angles, "design" of designs'
    elif _of_results(str(dim), results) and [dim, *sharing] != [SECTION, SECTION]:  # `section` lies along its own dim
        yield f'{path} has a dimension "{dim}": that is the name of a result; rename it'
    elif dim in sharing and sharing[str(dim)].dims != (dim,):
        advice = 'give it one of another name, as in xarray.DataArray([...], dims="k")'
        yield f"{dim} has dimensions {sharing[str(dim)].dims}: beside that of its own name it has no other; {advice}"
    elif dim in arrays and arrays[dim].dims != (dim,):
        yield f'{path} has a dimension "{dim}": that is the name of another parameter; rename it'


def _of_results(name: str, results: Collection[str]) -> bool:
    summary = SUMMARY.fullmatch(name)
    return name in results or bool(summary and summary[1] in results)


def _length_problems(dim: object, sharing: Arrays) -> Iterator[str]:
    """Yield the arrays whose length along a dim differs from that of the first."""
    (path, first), *others = sharing.items()
    for other, array in others:
        if array.sizes[dim] != first.sizes[dim]:
            yield (
                f"{other} has {array.sizes[dim]} values along {dim}, but {path} has {first.sizes[dim]}: "
                f"one dimension has one length; give them the same, or rename one"
            )


def _storage_problems(dim: object, sharing: Arrays) -> Iterator[str]:
    """Yield the arrays whose labels along a dim no file can hold."""
    for path, values in _labels(dim, sharing).items():
        if problem := label_problem(values):
            yield f"{path} has along {dim} {problem}; change its labels"


def _labels(dim: object, sharing: Arrays) -> dict[str, xr.Variable]:
    """Return the labels along a dim of those arrays that have some."""
    return {path: array[dim].variable for path, array in sharing.items() if dim in array.coords}


def _label_problems(dim: object, sharing: Arrays, arrays: Arrays) -> Iterator[str]:
    """Yield the arrays whose labels along a dim differ from those of others."""
    labels = _labels(dim, sharing)
    if dim in arrays:  # a parameter over a dimension of its own name: its values are the labels
        expected, others = arrays[str(dim)].variable, f"the values of {dim}"
    elif labels:
        (first, expected), *_ = labels.items()
        others = f"those of {first}"
    for path, values in labels.items():
        if values.shape == expected.shape and not values.equals(expected):
            yield f"{path} has labels along {dim} that are not {others}: make them equal, or rename one dimension"


def index_problems(arrays: Arrays, mechanism: Mechanism) -> list[str]:
    """Return a line for each parameter over the index of a machine that is not the crank's angle."""
    index = mechanism.index
    over = [path for path, array in arrays.items() if index in array.dims and index != "theta2"]
    return [f"{path} depends on {index}: it must be the same at every {mechanism.spot}" for path in over]


def interpolation_problems(arrays: Arrays, index: str) -> list[str]:
    """Return a line for each array that states an interpolation without being a load over the angles."""
    stated = [(path, array) for path, array in arrays.items() if "interpolation" in array.attrs]
    others = [path for path, array in stated if index not in array.dims or not path.startswith("loads")]
    return [f"{path}.interpolation: is for loads over {index}; leave it out" for path in others]
