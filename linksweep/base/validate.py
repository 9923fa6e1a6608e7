"""Validate numbers on input: every message names the parameter, the value, what is allowed and what to do."""

from __future__ import annotations

import difflib
import math
import numbers
import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

Item = TypeVar("Item")
UNITS = {
    "length": "m",
    "mass": "kg",
    "inertia": "kg m^2",
    "area": "m^2",
    "section_modulus": "m^3",
    "second_moment": "m^4",
    "angle": "degree",
    "angular_velocity": "rad/s",
    "angular_acceleration": "rad/s^2",
    "force": "N",
    "torque": "N m",
    "velocity": "m/s",
    "acceleration": "m/s^2",
    "density": "kg/m^3",
    "pressure": "Pa",
    "power": "W",
    "energy": "J",
    "spring_rate": "N/m",
    "damping_coefficient": "N s/m",
    "torsional_rate": "N m/rad",
    "torsional_damping": "N m s/rad",
    "life": "h",
    "voltage": "V",
    "resistance": "ohm",
    "torque_constant": "N m/A",
    "dimensionless": "1",
}
"""Unit in which each kind of number is passed in and stored."""

MANY, SOME = 30, 6
"""Names that a message lists, and how many it lists of more than these."""

Number = Any
"""A float, or an xarray.DataArray whose named dims are axes of a design study."""


@dataclass(frozen=True)
class Rule:
    """Constraints on a parameter: its kind and bound, whether it may change over the revolution (`over_angle`), and
    whether it is the distance of a point in polar coordinates (`polar`)."""

    kind: str
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    below: float | None = None
    over_angle: bool = False
    polar: bool = False

    @property
    def number(self) -> str:
        """Expected value, in words."""
        unit = {"1": "", "degree": " in degrees"}.get(UNITS[self.kind], f" in {UNITS[self.kind]}")
        return f"a number{unit}"

    @property
    def named_dimensions(self) -> str:
        """Advice for values whose dimensions have no names."""
        if self.over_angle:
            return (
                'name its dimension: over the crank angle xarray.DataArray(values, {"theta2": degrees}, "theta2"), '
                'one value for each design xarray.DataArray(values, dims="design")'
            )
        return 'name its dimensions, as in xarray.DataArray(values, dims="design")'

    def measured(self, value: float) -> str:
        return f"{value:.15g} {UNITS[self.kind]}".removesuffix(" 1")

    def allowed(self, value: float) -> str:
        """Return the allowed range in place of this value, and what to do."""
        bound = f"greater than {self.above:g}" if self.above is not None else ""
        bound = f"at least {self.at_least:g}" if self.at_least is not None else bound
        bound += f" and at most {self.at_most:g}" if self.at_most is not None else ""
        bound += f" and less than {self.below:g}" if self.below is not None else ""
        finite = "" if bound and np.isfinite(value) else "finite"
        negative = self.polar and np.isfinite(value)
        advice = "; for a point on the other side turn its angle by 180 degrees" if negative else ""
        return " and ".join(filter(None, (finite, bound))) + advice

    def allows(self, value: float) -> bool:
        above = self.above is None or value > self.above
        at_least = self.at_least is None or value >= self.at_least
        at_most = self.at_most is None or value <= self.at_most
        return math.isfinite(value) and above and at_least and at_most and (self.below is None or value < self.below)

    def broken_by(self, values: np.ndarray) -> np.ndarray:
        broken = ~np.isfinite(values)
        if self.above is not None:
            broken |= ~(values > self.above)
        if self.at_least is not None:
            broken |= ~(values >= self.at_least)
        if self.at_most is not None:
            broken |= ~(values <= self.at_most)
        if self.below is not None:
            broken |= ~(values < self.below)
        return broken


def overflow_problems(path: str, number: Number, meaning: str) -> list[str]:
    """Return a problem if a number derived from valid ones is more than a float can hold."""
    sound = math.isfinite(number) if type(number) is float else is_lazy(number) or bool(np.all(np.isfinite(number)))
    return [] if sound else [f"{path}: its {meaning} is more than a number can hold; reduce its measures"]


def less_problems(path: str, value: Any, bound: str, limit: Any, kind: str, share: float = 1.0) -> list[str]:
    """Return the problem of a number that must be less than a share of another, in some design; what is no number, or
    not yet computed, has none here."""
    if not (_is_known(value) and _is_known(limit) and np.any(value >= share * limit)):
        return []
    number, most = (quote(each) if is_array(each) else Rule(kind).measured(each) for each in (value, share * limit))
    return [f"{path} = {number}: must be less than {bound} = {most}"]


def _is_known(value: Any) -> bool:
    known = is_array(value) and not is_lazy(value) and not is_quantity(value) and value.dtype.kind == "f"
    return known or type(value) is float


def number_problems(path: str, value: Any, rule: Rule) -> list[str]:
    if type(value) is float and rule.allows(value):
        return []
    if is_quantity(value):
        units = (value.data if is_array(value) else value).units
        return [f"{path} has the unit {units}: must be {rule.number}, or in a unit of that kind"]
    if is_array(value):
        return _array_problems(path, value, rule)
    if callable(value):
        function = f"{path} = {quote(value)}: must be {rule.number}, not a function; {_over_angle_only()}"
        return [] if rule.over_angle else [function]
    if isinstance(value, np.ndarray | list | tuple):
        scalar = isinstance(value, np.ndarray) and value.ndim == 0
        start = f"{path} = {quote(value)} is a bare array"
        return [f"{start}: {'write float(...) of it' if scalar else rule.named_dimensions}"]
    if hasattr(value, "to_xarray"):  # of pandas: its own to_xarray() would name a dimension of designs
        return [f"{path} is a {type(value).__name__}: {rule.named_dimensions}"]
    if isinstance(value, bool | np.bool_):
        return [f"{path} = {value}: must be {rule.number}, not a truth value"]
    if isinstance(value, str):
        return [f"{path} = {value!r}: must be {rule.number}, or a text with a unit of that kind"]
    number = as_float(value)
    if number is None:
        return [f"{path} = {quote(value)}: must be {rule.number}, or an xarray.DataArray of them"]
    return [] if rule.allows(number) else [f"{path} = {rule.measured(number)}: must be {rule.allowed(number)}"]


def is_array(value: Any) -> bool:
    """Return whether a value is a DataArray, recognised by its attributes, since xarray starts at the scene."""
    return hasattr(value, "dims") and hasattr(value, "coords") and hasattr(value, "dtype")


def is_quantity(value: Any) -> bool:
    """Return whether a value is a quantity of pint, or an array of them, by its attributes, since pint is slow to
    import.

    Numbers are converted on input; one that is still a quantity afterwards is of another kind.
    """
    data = value.data if is_array(value) else value
    return hasattr(data, "magnitude") and hasattr(data, "units") and hasattr(data, "to_root_units")


def is_lazy(value: Any) -> bool:
    """Return whether a value is an array that dask has yet to compute: its numbers are checked then, not on input."""
    known = is_array(value) and isinstance(value.variable._data, np.ndarray)  # xarray itself takes long to look
    return not known and getattr(value, "chunks", None) is not None


def as_float(value: Any) -> float | None:
    """Return a real number as a float, infinite where it is too large for one; None for anything else."""
    if not isinstance(value, numbers.Real) or isinstance(value, bool | np.timedelta64):
        return None
    real: Any = value
    try:
        return float(real)
    except OverflowError:
        return np.inf if real > 0 else -np.inf


def quote(value: Any) -> str:
    """Return a value in one short line for a message, equal in every run."""
    try:
        text = re.sub(r" at 0x\w+", "", " ".join(repr(value).split()))
    except Exception:  # an int of too many digits, or any class's own repr
        text = f"<{type(value).__name__}>"
    return text if len(text) <= 60 else text[:57] + "..."


def _over_angle_only() -> str:
    return "only omega2, alpha2, loads and lengths of cylinders may change over the revolution"


def _array_problems(path: str, value: Any, rule: Rule) -> list[str]:
    problems = []
    if "theta2" in value.dims:
        problem = f"{path} depends on theta2: it must be the same at every angle; {_over_angle_only()}"
        problems += _angle_problems(path, value) if rule.over_angle else [problem]
    if "branch" in value.dims:
        problems.append(f'{path} has a dimension "branch": that name is kept for branch="both"; rename it')
    if len(set(value.dims)) < len(value.dims):
        return [*problems, f"{path} has dimensions {value.dims}: each name may appear once; rename one"]
    return [*problems, *value_problems(path, value, rule)]


def value_problems(path: str, array: Any, rule: Rule) -> list[str]:
    """Return the problems of the values of a DataArray, whatever its dims and labels; a lazy one's are not computed."""
    if array.dtype.kind not in "fiu":
        return [f"{path} holds {array.dtype} values: each must be {rule.number}"]
    if array.size == 0:
        return [f"{path} is empty, {dict(array.sizes)}: give each dimension at least one value"]
    if is_lazy(array):
        return []
    broken = rule.broken_by(np.asarray(array.values, dtype=float))
    if not broken.any():
        return []
    first = np.unravel_index(int(np.argmax(broken)), broken.shape)
    worst = float(array.values[first])
    return [f"{path} = {rule.measured(worst)}{_place(array, first, broken)}: must be {rule.allowed(worst)}"]


def _place(array: Any, first: tuple, broken: np.ndarray) -> str:
    """Return the place of the first value that is not allowed: by label where its dim has labels."""
    places = [
        f"{dim} = {array.coords[dim].values[k]}" if dim in array.coords else f"{dim}[{k}]"
        for dim, k in zip(array.dims, first, strict=True)
    ]
    others = f" (and {int(broken.sum()) - 1} more of {broken.size})" if broken.sum() > 1 else ""
    return f" at {', '.join(places)}{others}" if places else ""


def _angle_problems(path: str, value: Any) -> list[str]:
    """Return the problems of the angles of a DataArray over theta2."""
    if "theta2" not in value.coords:
        return []  # its values belong to the sweep's own angles
    angles = value.coords["theta2"].values
    if angles.dtype.kind not in "fiu" or not np.isfinite(angles).all():
        return [f"{path} has theta2 = {quote(angles.tolist())}: its coordinate must hold finite angles in degrees"]
    different, counts = np.unique(angles, return_counts=True)
    twice = different[counts > 1]
    once = [f"{path} has theta2 = {twice[0]:.15g} more than once: give one value for each angle"] if twice.size else []
    return once + radian_problems(f"{path} has theta2", angles)


def radian_problems(start: str, angles: np.ndarray) -> list[str]:
    """Return a problem of angles that end at half a turn, or at one or two, in radians."""
    end = float(np.abs(angles).max(initial=0.0))
    turn = {math.pi: "π", 2.0 * math.pi: "2π", 4.0 * math.pi: "4π"}.get(end)
    return [f"{start} in radians: it ends at {end:.15g}, which is {turn}; give degrees, 360 a turn"] if turn else []


def choice_problems(path: str, value: Any, allowed: Iterable[str]) -> list[str]:
    """Return a problem unless a text is one of a few."""
    allowed = list(allowed)
    if isinstance(value, str) and value in allowed:
        return []
    return [f"{path} = {quote(value)}: must be one of {', '.join(allowed)}{did_you_mean(value, allowed)}"]


def one_text_problems(path: str, value: Any, meaning: str) -> list[str]:
    """Return a problem unless a value is a text, with what it is to mean."""
    return [] if isinstance(value, str) else [f"{path} = {quote(value)}: must be {meaning}"]


def count_problems(path: str, value: Any) -> list[str]:
    """Return a problem unless a value is a whole number, 1 or more."""
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    return [] if whole and value >= 1 else [f"{path} = {quote(value)}: must be a whole number, 1 or more"]


def flag_problems(path: str, value: Any) -> list[str]:
    """Return a problem unless a value is a truth value."""
    sound = isinstance(value, bool | np.bool_)
    return [] if sound else [f"{path} = {quote(value)}: must be True or False"]


def name_problems(path: str, name: Any, known: Iterable[str], listed: str = "") -> list[str]:
    """Return a problem unless a name is among the known ones.

    Where none is close, the message lists them all, or of many those that are least far, and `listed`, which names
    them all.
    """
    known = list(known)
    if isinstance(name, str) and name in known:
        return []
    if advice := did_you_mean(name, known):
        return [f"{path}: nothing is named {quote(name)}{advice}"]
    if len(known) <= MANY:
        return [f"{path}: nothing is named {quote(name)}; there are {', '.join(known)}"]
    alike = [other for other in known if re.sub("[0-9]", "", other) == re.sub("[0-9]", "", str(name))]  # F32 like F99
    some = (alike or difflib.get_close_matches(str(name), known, n=SOME, cutoff=0.5) or known)[:SOME]
    others = f"{len(known) - len(some)} others{f': see {listed}' if listed else ''}"
    return [f"{path}: nothing is named {quote(name)}; there are {', '.join(some)} and {others}"]


def did_you_mean(word: Any, known: Iterable[str]) -> str:
    near = closest(word, known)
    return f'; did you mean "{near}"?' if near else ""


def closest(word: Any, known: Iterable[str]) -> str:
    """Return the known name that a misspelt word most likely means; empty where none is close."""
    spelled = {name.lower(): name for name in known}
    word = str(word).lower()
    close = [name for name in spelled if name.startswith((f"{word}_", f"{word}.")) or word.startswith(f"{name}.")]
    close += difflib.get_close_matches(word, spelled, n=1, cutoff=0.6)
    close += [name for name in spelled if f"{name}_".startswith(f"{word}_") or word.startswith(f"{name}_")]
    return spelled[close[0]] if close else ""


def listed(value: Any) -> list[Any]:
    """Return what a value holds as a list; a text, or what holds nothing, as the only one in it."""
    try:
        return [value] if isinstance(value, str) else list(value)
    except TypeError:  # also an array without dims, which is an Iterable by its class
        return [value]


def limits_in(ends: Any) -> tuple[float, float] | None:
    """Return the two limits (least, most), infinite for None; None where they are none, or both open."""
    if not isinstance(ends, tuple | list) or len(ends) != 2 or ends[0] is ends[1] is None:
        return None
    low, high = (
        open_end if end is None else as_float(end) for end, open_end in zip(ends, (-math.inf, math.inf), strict=True)
    )
    return None if low is None or high is None or not low <= high else (low, high)


def repeated(items: Iterable[Item]) -> list[Item]:
    """Return what stands more than once, each once."""
    return [item for item, count in Counter(items).items() if count > 1]


def refuse(problems: list[str]) -> None:
    """Raise ValueError with one problem a line, if there are any."""
    if problems:
        raise ValueError("\n".join(problems))
