"""Controls of the page: a slider for each number of a scene, in groups."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from linksweep.base.units import quantity
from linksweep.base.validate import UNITS
from linksweep.scene.parameters import free, replaced
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import SI, UnitSystem

STEPS = 200  # of a slider, at least
SIGNED = {"length", "angle", "force", "torque", "velocity", "acceleration", "angular_velocity", "angular_acceleration"}
"""Kinds of numbers that may be negative; where a scene refuses them nevertheless, the slider starts at 0."""
ORDERS = {"angular_acceleration": 100.0, "acceleration": 10.0, "force": 100.0, "torque": 10.0, "length": 0.1}
"""Ends of the sliders of numbers that are 0, by kind, where the scene has no other of this kind."""
SYMBOLS = {"degree": "°", "1": ""}
MOST_PRESSURE_ANGLE = 89.0
"""End of the slider of an angle that must be less than 90 degrees."""
PARTS = {True: ("distance", "angle"), False: ("x", "y")}
"""Names of the two numbers of a point: polar or not."""


class Control(NamedTuple):
    """A number of a scene, with the ends and the step of its slider, in its unit."""

    path: str
    group: str
    name: str
    unit: str
    value: float
    low: float
    high: float
    step: float


def controls(scene: Scene, system: UnitSystem = SI) -> list[Control]:
    """Return a control for each plain number of a scene; none for what changes over the angle, or is left out."""
    kinds = {path: kind for path, (_, kind) in free(scene).items()}
    return [_control(scene, path, value, kinds, system) for path, (value, _) in free(scene).items() if is_plain(value)]


def values(scene: Scene, system: UnitSystem = SI) -> dict[str, float]:
    """Return the value of each control by its path."""
    plain = {path: number for path, number in free(scene).items() if is_plain(number[0])}
    return {path: float(system.value(value, UNITS[kind])) for path, (value, kind) in plain.items()}


def with_branch(scene: Scene, path: str, branch: str) -> Scene:
    """Return the scene with another assembly, of a linkage at one of its pins; refused ones raise ValueError."""
    name, _, pin = path.partition(".")
    others: Any = scene.mechanism.branch
    return replaced(scene, {name: {**others, pin: branch} if pin else branch})


def read(number: float | str, kind: str, system: UnitSystem = SI) -> float:
    """Return a number in SI units, of one in the units of the page, or of a text with a unit of its own, "80 mm".

    Raises ValueError for a text that is no number with a unit of this kind.
    """
    try:
        return float(number) * system.size(UNITS[kind])
    except ValueError:
        return quantity(str(number), kind)


def is_plain(value: Any) -> bool:
    """Return whether a value is a number by itself: no array, no function, not left out."""
    return isinstance(value, int | float)


def _control(scene: Scene, path: str, value: float, kinds: Mapping[str, str], system: UnitSystem) -> Control:
    unit = UNITS[kinds[path]]
    value, low, high = (float(system.value(v, unit)) for v in (value, *_range(scene, path, value, kinds[path])))
    step = 10.0 ** math.floor(math.log10((high - low) / STEPS))
    ends = math.floor(low / step) * step, math.ceil(high / step) * step
    low, high, step = (float(f"{number:.12g}") for number in (*ends, step))
    return Control(path, *_names(scene, path, kinds), written(system.unit(unit)), value, low, high, step)


def written(unit: str) -> str:
    """Return a unit as a page writes it: "kg/m³", "°"; "" for a number without one."""
    return SYMBOLS.get(unit, unit).replace("^2", "²").replace("^3", "³")


def _range(scene: Scene, path: str, value: float, kind: str) -> tuple[float, float]:
    """Return the ends of a slider: about the value, or where that is 0 as far as the scene's other numbers go."""
    if kind == "angle":
        low = -180.0 if _takes(scene, path, -180.0) else 0.0
        high = 180.0 if _takes(scene, path, 180.0) else MOST_PRESSURE_ANGLE
        return min(low, value), max(high, value)
    if value:
        low, high = sorted((0.5 * value, 1.5 * value))
        return low, high
    others = (abs(other) for other, its in free(scene).values() if its == kind and is_plain(other))
    size = max(others, default=0.0) or ORDERS.get(kind, 1.0)
    return (-size if kind in SIGNED and _takes(scene, path, -size) else 0.0), size


def _takes(scene: Scene, path: str, value: float) -> bool:
    try:
        replaced(scene, {path: value})
    except ValueError:
        return False
    return True


def _names(scene: Scene, path: str, kinds: Mapping[str, str]) -> tuple[str, str]:
    """Return the group of a path and the name in it: "crank" and "length", "load 1, coupler" and "force y"."""
    *owners, last = _words(path, kinds)
    if not owners:
        return ("motion" if path.partition("[")[0] in {*scene.mechanism.motion, "gravity"} else "machine"), last
    group = owners[0]
    if load := re.fullmatch(r"loads\[(\d+)\]", group):
        link = getattr(scene.loads[int(load[1]) - 1], "link", "")
        group = f"load {load[1]}" + f", {link}" * bool(link)
    return group, " ".join([*owners[1:], last])


def _words(path: str, kinds: Mapping[str, str]) -> Iterator[str]:
    *owners, last = path.split(".")
    yield from owners
    name, bracket, index = last.partition("[")
    name = name.replace("_", " ").strip()
    if bracket:
        stem = path.removesuffix(index)
        pair = [
            own for own in (f"{stem}{k}]" for k in (1, 2, 3)) if own in kinds
        ]  # the end of a spring begins with a link
        name = f"{name} {PARTS[kinds[pair[-1]] == 'angle'][pair.index(path)]}"
    yield name
