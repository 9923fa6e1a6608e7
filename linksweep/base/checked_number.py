"""Convert and check the numbers of a function's arguments, as constructors do with their fields."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from linksweep.base.conversion import to_float64
from linksweep.base.fields import PairField, numbers_in
from linksweep.base.units import text_problems, unit_problems
from linksweep.base.validate import Number, Rule, is_array, number_problems, refuse


def checked_number(path: str, value: Any, rule: Rule) -> Number:
    """Return a number as float64 in the unit of its rule; an array without attributes, which what is computed from it
    would inherit.

    Raises
    ------
    ValueError
        For a number that the rule does not allow, and for an array whose `units` attribute names another unit.
    """
    number = to_float64(value, rule.kind)
    refuse(text_problems(path, number, rule.kind) if isinstance(number, str) else [])
    refuse(number_problems(path, number, rule) or array_unit_problems(path, number, rule.kind))
    return number.drop_attrs(deep=False) if is_array(number) else number


def one_number(path: str, value: Any, rule: Rule) -> float:
    """Return a number as `checked_number` does; raise ValueError for an array of several."""
    return _alone(path, checked_number(path, value, rule))


def checked_pair(path: str, value: Any, kind: PairField) -> tuple[Number, Number]:
    """Return two numbers, each as `checked_number` does."""
    pair = kind.converted(value)
    refuse(kind.problems(path, pair))
    refuse(unit_attribute_problems(numbers_in(path, pair, kind)))
    return pair


def one_pair(path: str, value: Any, kind: PairField) -> tuple[float, float]:
    """Return two numbers, each as `one_number` does."""
    first, second = checked_pair(path, value, kind)
    return _alone(f"{path}[1]", first), _alone(f"{path}[2]", second)


def _alone(path: str, number: Number) -> float:
    refuse(dims_problems(path, number))
    return float(number)


def dims_problems(path: str, number: Number) -> list[str]:
    """Return a problem of an array with dims, where one number is to stand."""
    return [f"{path}: has {np.ndim(number)} dims: give one number for all designs"] if np.ndim(number) else []


def unit_attribute_problems(parameters: Iterable[tuple[str, Number, str]]) -> list[str]:
    """Return the problems of the units that arrays have in their attributes, of numbers with their paths and kinds."""
    return [problem for path, number, kind in parameters for problem in array_unit_problems(path, number, kind)]


def array_unit_problems(path: str, number: Number, kind: str) -> list[str]:
    """Return the problems of the `units` attributes of an array and of its angles theta2."""
    if not is_array(number):
        return []
    angles = number.coords["theta2"].attrs if "theta2" in number.coords else {}
    problems = unit_problems(path, number.attrs.get("units"), kind)
    return problems + unit_problems(f"{path}.theta2", angles.get("units"), "angle")
