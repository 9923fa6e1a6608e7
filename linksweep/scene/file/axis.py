"""Design axes as a scene file has them: an inline table of numbers over named dims, in place of one number."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.units import accepted_unit, as_toml, key_as_toml, quantity
from linksweep.base.validate import did_you_mean
from linksweep.scene.curves.interpolation import interpolation_attribute
from linksweep.scene.storable import name_problem

MOST = 1_000_000
"""Largest count of numbers of an axis that is stated by its ends."""
KEYS = ("dim", "dims", "values", "unit", "start", "stop", "num", "coords", "theta2", "position", "interpolation")
PLACES = ("theta2", "position")
"""Dims along which a load may change, each short for its own `coords`."""


def design_axis(table: dict[str, Any], kind: str, alone: bool = True, position_kind: str = "length") -> xr.DataArray:
    """Read the inline table that stands in place of a number: ``{dim = "length", values = ["8 cm", 0.09]}``.

    Parameters
    ----------
    table : dict
        `dim` or `dims`; `values`, nested as deep as the dims, or `start`, `stop`, `num`; the `unit` of plain
        numbers; `coords`, a list for each dim with labels; `theta2` and `position`, short for angles [degree] and
        positions [m] or [degree] in `coords`; `interpolation` over them.
    kind : str
        Kind of the quantity: a key of `KINDS`.
    alone : bool
        True where no other number has this one dim: without `coords` the values are then its labels.
    position_kind : str
        Kind of the positions: "length", or "angle" in a load over the angle of a link.

    Returns
    -------
    DataArray
        The values [`KINDS[kind].unit`], with the dims named.

    Raises
    ------
    ValueError
        One problem a line, each starting with its place in the table.

    Examples
    --------
    >>> design_axis({"dim": "length", "values": [8, 9], "unit": "cm"}, "length").values.tolist()
    [0.08, 0.09]
    """
    listed = f"; a design axis has {', '.join(KEYS)}"
    unknown = [key for key in table if key not in KEYS]
    problems = [f"{key_as_toml(key)}: unknown key{did_you_mean(key, KEYS) or listed}" for key in unknown]
    dims = _dims(table, problems)
    values = _values(table, kind, problems)
    if not problems and values.ndim != len(dims):
        problems.append(f"values: lists nested {values.ndim} deep for {len(dims)} dims, {', '.join(dims)}")
    coords = {} if problems else _coords(table, dims, values, alone, position_kind, problems)
    if unknown:  # one of them may be what is missing
        problems = [problem for problem in problems if ": missing" not in problem]
    if problems:
        raise ValueError("\n".join(problems))
    return xr.DataArray(values, dims=dims, coords=coords, attrs=interpolation_attribute(table))


def _dims(table: dict[str, Any], problems: list[str]) -> list[str]:
    key = "dims" if "dims" in table else "dim"
    dims = table.get("dims", [table.get("dim")])
    if key not in table:
        problems.append('dim: missing; write dim = "name of the design axis"')
    elif not isinstance(dims, list) or len({dim for dim in dims if not name_problem(dim)}) < len(dims):
        must = "a list of different names" if key == "dims" else "a name"
        problems.append(f"{key} = {as_toml(table[key])}: must be {must}")
    return dims


def _values(table: dict[str, Any], kind: str, problems: list[str]) -> Any:
    """Read `values`, or `start`, `stop` and `num`."""
    unit = _unit(table, kind, problems)
    if "values" in table:
        values = _read_nested(table["values"], "values", kind, unit, problems)
        return np.array([]) if problems else _array(values, problems)
    if not table.keys() >= {"start", "stop", "num"}:
        problems.append("values: missing; write values = [...], or start, stop and num")
        return None
    start, stop = (_read_nested(table[key], key, kind, unit, problems) for key in ("start", "stop"))
    if not isinstance(num := table["num"], int) or isinstance(num, bool) or num < 1:
        problems.append(f"num = {as_toml(num)}: must be a count, 1 or more")
    elif num > MOST:
        problems.append(f"num = {as_toml(num)}: must be at most {MOST}; for more designs use sample or a DataArray")
    return None if problems else evenly(start, stop, num)


def evenly(start: float, stop: float, num: int) -> Any:
    """Return evenly spaced decimals: four from 0.06 to 0.09 have 0.07, where floats give 0.06999999999999999."""
    first, last = Fraction(repr(start)), Fraction(repr(stop))
    return np.array([float(first + (last - first) * Fraction(i, max(num - 1, 1))) for i in range(num)])


def _unit(table: dict[str, Any], kind: str, problems: list[str]) -> str | None:
    try:
        return accepted_unit(str(table["unit"]), kind) if "unit" in table else None
    except ValueError as error:
        problems.append(f"unit = {as_toml(table['unit'])}: {error}")
        return None


def _read_nested(item: Any, at: str, kind: str, unit: str | None, problems: list[str]) -> Any:
    if isinstance(item, list):
        return [_read_nested(part, f"{at}[{i}]", kind, unit, problems) for i, part in enumerate(item, 1)]
    try:
        return quantity(item, kind, unit)
    except ValueError as error:
        problems.append(f"{at} = {error}")
        return math.nan


def _array(values: Any, problems: list[str]) -> Any:
    try:
        array = np.array(values, dtype=float)
    except ValueError:
        problems.append("values: the rows differ in length")
        return None
    if not array.size:
        problems.append("values: is empty")
    return array


def _coords(
    table: dict[str, Any], dims: list[str], values: Any, alone: bool, position_kind: str, problems: list[str]
) -> dict[str, Any]:
    """Read the labels of the dims; those of theta2 and of position are quantities."""
    sizes = dict(zip(dims, values.shape, strict=True))
    if not table.keys() & {"coords", *PLACES}:
        return {dims[0]: values} if alone and len(dims) == 1 and dims[0] not in PLACES else {}
    if not isinstance(coords := table.get("coords", {}), dict):
        problems.append(f"coords = {as_toml(coords)}: must be a table, {{{dims[0]} = [...]}}")
        return {}
    coords = coords | {dim: table[dim] for dim in PLACES if dim in table}
    for dim, kind in zip(PLACES, ("angle", position_kind), strict=True):
        if isinstance(places := coords.get(dim), list) and any(isinstance(place, str | bool) for place in places):
            coords[dim] = _read_nested(places, dim, kind, None, problems)
    for dim, labels in coords.items():
        if dim not in sizes:
            problems.append(f"coords: {key_as_toml(dim)} is no dim of these values; they have {', '.join(dims)}")
        elif not isinstance(labels, list) or [type(label) is list for label in labels] != [False] * sizes[dim]:
            problems.append(f"coords: {dim} must be a list of {sizes[dim]} labels, one for each position")
    return coords
