"""Checking numbers at the door: every message names the parameter, the value, what is allowed and what to do."""

from __future__ import annotations

import difflib
import numbers
from collections.abc import Iterable
from dataclasses import MISSING, dataclass, field, fields
from typing import Any

import numpy as np

UNITS = {
    "length": "m",
    "mass": "kg",
    "inertia": "kg m^2",
    "angle": "degree",
    "angular_velocity": "rad/s",
    "angular_acceleration": "rad/s^2",
    "force": "N",
    "torque": "N m",
    "acceleration": "m/s^2",
    "density": "kg/m^3",
    "dimensionless": "1",
}
"""Unit in which each kind of number is given and stored."""

Number = Any
"""A float, or an xarray.DataArray whose named dims are axes of a design study."""


@dataclass(frozen=True)
class Rule:
    """What a parameter may be: its kind, its bound, and whether it may change over the revolution."""

    kind: str
    above: float | None = None
    at_least: float | None = None
    over_angle: bool = False

    @property
    def bound(self) -> str:
        if self.above is not None:
            return f"greater than {self.above:g}"
        return f"at least {self.at_least:g}" if self.at_least is not None else "finite"

    def broken_by(self, values: np.ndarray) -> np.ndarray:
        broken = ~np.isfinite(values)
        if self.above is not None:
            broken |= ~(values > self.above)
        if self.at_least is not None:
            broken |= ~(values >= self.at_least)
        return broken


def parameter(kind: str, default: Any = MISSING, **bounds: Any) -> Any:
    """A dataclass field that holds a number under a rule."""
    metadata = {"rule": Rule(kind, **bounds)}
    return field(metadata=metadata) if default is MISSING else field(default=default, metadata=metadata)


def problems(owner: Any, prefix: str = "") -> list[str]:
    """What is wrong with the ruled fields of a dataclass, each with its path; None is for the owner to judge."""
    return [
        problem
        for item in fields(owner)
        if "rule" in item.metadata and getattr(owner, item.name) is not item.default
        for problem in number_problems(prefix + item.name, getattr(owner, item.name), item.metadata["rule"])
    ]


def pair_problems(path: str, pair: Any, rules: tuple[Rule, Rule], meaning: str) -> list[str]:
    if not (isinstance(pair, tuple | list) and len(pair) == 2):
        return [f"{path} = {pair!r}: must be a pair {meaning}"]
    return [p for k in (0, 1) for p in number_problems(f"{path}[{k + 1}]", pair[k], rules[k])]


def number_problems(path: str, value: Any, rule: Rule) -> list[str]:
    unit = UNITS[rule.kind]
    if isinstance(value, bool | np.bool_):
        return [f"{path} = {value}: must be a number in {unit}, not a truth value"]
    if isinstance(value, str):
        return [f"{path} = {value!r}: must be a number in {unit}, not text; strings with units belong in scene files"]
    if callable(value) and not hasattr(value, "dims"):
        return [] if rule.over_angle else [f"{path} is a function: must be a number in {unit}; {_over_angle_only()}"]
    if hasattr(value, "dims"):
        return _array_problems(path, value, rule)
    if isinstance(value, numbers.Real):
        if rule.broken_by(np.asarray(float(value))):
            return [f"{path} = {float(value):.15g} {unit}: must be {_allowed(rule, float(value))}"]
        return []
    if isinstance(value, np.ndarray | list | tuple):
        return [
            f"{path} is a bare array of shape {np.shape(value)}: name its dimensions, "
            f'as in xarray.DataArray(values, dims="design")'
        ]
    return [f"{path} = {value!r}: must be a number in {unit} or an xarray.DataArray of them"]


def _allowed(rule: Rule, value: float) -> str:
    return rule.bound if np.isfinite(value) or rule.bound == "finite" else f"finite and {rule.bound}"


def _over_angle_only() -> str:
    return "only omega2, alpha2 and loads may change over the revolution"


def _array_problems(path: str, value: Any, rule: Rule) -> list[str]:
    unit = UNITS[rule.kind]
    if value.dtype.kind not in "fiu":
        return [f"{path} holds {value.dtype} values: must be numbers in {unit}"]
    found = []
    if "theta2" in value.dims and not rule.over_angle:
        found.append(f"{path} depends on theta2: it must be the same at every angle; {_over_angle_only()}")
    if "branch" in value.dims:
        found.append(f'{path} has a dimension "branch": that name is kept for branch="both"; rename it')
    if len(set(value.dims)) < len(value.dims):
        found.append(f"{path} has dimensions {value.dims}: each name may appear once; rename one")
    broken = rule.broken_by(np.asarray(value.values, dtype=float))
    if broken.any():
        first = np.unravel_index(int(np.argmax(broken)), broken.shape)
        place = ", ".join(f"{dim}={index}" for dim, index in zip(value.dims, first, strict=True))
        worst = float(value.values[first])
        found.append(
            f"{path} = {worst:.15g} {unit} at [{place}] ({int(broken.sum())} of {broken.size} values are not allowed): "
            f"must be {_allowed(rule, worst)}"
        )
    return found


def choice_problems(path: str, value: Any, allowed: Iterable[str]) -> list[str]:
    """A word that must be one of a few."""
    allowed = list(allowed)
    if isinstance(value, str) and value in allowed:
        return []
    return [f"{path} = {value!r}: must be one of {', '.join(allowed)}{did_you_mean(value, allowed)}"]


def name_problems(path: str, name: Any, known: Iterable[str]) -> list[str]:
    """A name that must be one of many; the message lists them all only where none is close."""
    known = list(known)
    if name in known:
        return []
    return [f"{path}: nothing is named {name!r}{did_you_mean(name, known) or '; there are ' + ', '.join(known)}"]


def did_you_mean(word: Any, known: Iterable[str]) -> str:
    spelled = {name.lower(): name for name in known}
    close = difflib.get_close_matches(str(word).lower(), spelled, n=1, cutoff=0.6)
    return f'; did you mean "{spelled[close[0]]}"?' if close else ""


def refuse(found: list[str]) -> None:
    """Raise ValueError with one problem a line, if there are any."""
    if found:
        raise ValueError("\n".join(found))
