"""Numbers that functions are given, converted and checked as constructors do with theirs."""

from __future__ import annotations

from typing import Any

from linksweep.base.conversion import as_pair, to_float64
from linksweep.base.validate import Number, Rule, is_array, number_problems, pair_problems, refuse
from linksweep.scene.parameters import numbers
from linksweep.scene.units import unit_problems


def checked_number(path: str, value: Any, rule: Rule) -> Number:
    """Return a number as float64 in the unit of its rule.

    Raises
    ------
    ValueError
        For what the rule does not allow, and for an array that says another unit.
    """
    number = to_float64(value, rule.kind)
    refuse(number_problems(path, number, rule) or array_unit_problems(path, number, rule.kind))
    return number


def checked_pair(path: str, value: Any, rules: tuple[Rule, Rule], meaning: str) -> tuple[Number, Number]:
    """Return two numbers, each as `checked_number` does; `meaning` is what the message calls them."""
    first, second = rules
    pair = as_pair(value, (first.kind, second.kind))
    refuse(pair_problems(path, pair, rules, meaning))
    for k, (number, rule) in enumerate(zip(pair, rules, strict=True), 1):
        refuse(array_unit_problems(f"{path}[{k}]", number, rule.kind))
    return pair


def said_unit_problems(owner: Any) -> list[str]:
    """Return what is wrong with the units that the arrays of a scene, or of a part of one, say in their attributes."""
    return [p for path, number, kind in numbers(owner) if kind for p in array_unit_problems(path, number, kind)]


def array_unit_problems(path: str, number: Number, kind: str) -> list[str]:
    """Return what is wrong with the units that an array, and its angles theta2, say in their attributes."""
    if not is_array(number):
        return []
    angles = number.coords["theta2"].attrs if "theta2" in number.coords else {}
    problems = unit_problems(path, number.attrs.get("units"), kind)
    return problems + unit_problems(f"{path}.theta2", angles.get("units"), "angle")
