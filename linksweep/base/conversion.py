"""Convert numbers on input: to float64, in the unit of their kind.

numpy computes in an array's own dtype, where a mass of int8 overflows; so the constructor converts every number to
float64. An integer that float64 cannot hold is rounded to the nearest. A quantity of pint is recognised by its
attributes and converted by its own registry, so that pint need not be imported. A text such as "80 mm" is read as in a
scene file.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linksweep.base.units import quantity
from linksweep.base.validate import UNITS, Rule, as_float, is_array, is_quantity, number_problems, refuse


def to_float64(value: Any, kind: str) -> Any:
    """Return a number as a float, an array as one of float64, in the unit of its kind; anything else unchanged.

    The angles of an array over theta2 are converted, too.
    """
    if type(value) is float or value is None:
        return value
    if isinstance(value, str):
        return _of_text(value, kind)
    if is_array(value):
        return _with_angles(_array(value, kind))
    if is_quantity(value):
        magnitude = _in_unit(value, UNITS[kind])
        return magnitude if magnitude is value or np.ndim(magnitude) else float(magnitude)
    number = as_float(value)
    return value if number is None else number


def _of_text(text: str, kind: str) -> Any:
    """Return the number that a text states; the text itself where it states none, for validation to say why."""
    try:
        return quantity(text, kind)
    except ValueError:
        return text


def all_to_float64(path: str, values: Any, kind: str) -> Any:
    """Return a list of numbers, or an array without its labels, converted as by `to_float64`.

    Raises ValueError for an array of quantities of another kind, whose unit numpy would leave out.
    """
    if isinstance(values, tuple | list):
        return [to_float64(value, kind) for value in values]
    converted = to_float64(values, kind)
    refuse(number_problems(path, converted, Rule(kind)) if is_quantity(converted) else [])
    return converted.values if is_array(converted) else converted


def _array(array: Any, kind: str) -> Any:
    if is_quantity(array):
        data = _in_unit(array.data, UNITS[kind])
        if data is array.data:
            return array
        converted = array.copy(data=data)
        converted.attrs.pop("units", None)
        return converted
    with np.errstate(over="ignore"):  # numbers beyond float64 become inf, which validation refuses
        return array.astype(float) if _is_real(array.dtype) and array.dtype != np.float64 else array


def _with_angles(array: Any) -> Any:
    """Return an array with its angles theta2, if any, converted."""
    if "theta2" not in array.dims or "theta2" not in array.coords:
        return array
    angles = array.coords["theta2"]
    converted = _array(angles, "angle")
    return array if converted is angles else array.assign_coords(theta2=converted.variable)


def _in_unit(quantity: Any, unit: str) -> Any:
    """Return the magnitude of a pint quantity in a unit; the quantity itself where it is of another kind.

    pint takes an angle for a plain number, so that 50 Hz are 50 rad/s and 45 without a unit is 45 rad; here 45 without
    a unit is no angle.
    """
    kind = type(quantity)
    try:
        one = kind(1.0, "dimensionless" if unit == "1" else unit.replace(" ", "*"))
        same = kind(1.0, quantity.units).to_root_units().units == one.to_root_units().units
        return kind(_float64(quantity.magnitude), quantity.units).m_as(one.units) if same else quantity
    except (AttributeError, TypeError, ValueError):  # validation refuses what pint cannot convert
        return quantity


def _float64(magnitude: Any) -> Any:
    """Return the magnitude of a quantity as float64; TypeError where it is no real number."""
    number = magnitude.astype(float) if _is_real(getattr(magnitude, "dtype", None)) else as_float(magnitude)
    if number is None:
        raise TypeError
    return number


def _is_real(dtype: Any) -> bool:
    return getattr(dtype, "kind", "") in ("f", "i", "u")
