"""Sum quantities over the cylinders of an engine, and compute further ones from the sums.

Cylinder k is the engine's slider-crank turned by its bank angle β about A, its crank ahead by its crank angle φ. In
axes that turn with the cylinder its crank stands at θ2 + φ − β: each cylinder is thus the same cycle at other angles,
its forces turned by β. With z the place along the crankshaft, forces of the cylinders add up to

    Fs = Σ R(β) Fs(θ2 + φ − β)        Ms = Σ Ms(θ2 + φ − β)        T12 = Σ T12(θ2 + φ − β)
    Msx = −Σ z·Fsy,  Msy = Σ z·Fsx    (moments about the axes x and y at z = 0)

and so do powers, kinetic energy, the inertia reduced to the crank and the torque reduced to it. A main bearing at m
carries a part of the force of each throw in the bays beside it, by the lever rule, as if the crankshaft were hinged at
every main (statically determinate; a stiff crankshaft on more than two mains loads them otherwise):

    F_main = Σ (1 − |z − m|/bay) R(β) F12(θ2 + φ − β)

Source: C. F. Taylor, The Internal-Combustion Engine in Theory and Practice, volume 2 (engine balance and vibration;
loads on main bearings); R. L. Norton, Design of Machinery, chapter "Multicylinder Engines".
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import reduce
from operator import add
from typing import Any, NamedTuple

import numpy as np

from linksweep.engine.quantity import Quantity, opposite_of
from linksweep.physics.algebra import planar


class Throw(NamedTuple):
    """A cylinder's place: its own angle is θ2 + `ahead` [degree], `bank` cos β and sin β, `shares` each main's part."""

    ahead: float
    bank: tuple[float, float]
    z: float
    shares: tuple[float, ...]


class Sum(NamedTuple):
    """A sum over throws: `part` gives each contribution from the quantities `sources` of its cylinder."""

    sources: tuple[str, ...]
    part: Callable[..., Any]
    join: Callable[[Any, Any], Any] = add


class Derived(NamedTuple):
    """A function of sums, or of other derived quantities."""

    sources: tuple[str, ...]
    function: Callable[..., Any]


def _plain(throw: Throw, value: Any) -> Any:
    return value


def _along_x(throw: Throw, x: Any, y: Any) -> Any:
    cos, sin = throw.bank
    return cos * x - sin * y


def _along_y(throw: Throw, x: Any, y: Any) -> Any:
    cos, sin = throw.bank
    return sin * x + cos * y


def _tilt(throw: Throw, x: Any, y: Any) -> Any:
    return -throw.z * _along_y(throw, x, y)


def _yaw(throw: Throw, x: Any, y: Any) -> Any:
    return throw.z * _along_x(throw, x, y)


ADDED = {
    "T12": ("N m", "torque of the drive on the crankshaft, positive counter-clockwise"),
    "Ms": ("N m", "shaking moment of all cylinders about the crankshaft, positive counter-clockwise"),
    "power": ("W", "power of the drive, positive when it feeds the engine"),
    "load_power": ("W", "power of the loads of all cylinders, positive when they feed the engine"),
    "friction_power": ("W", "power of friction on all sliders, never positive"),
    "kinetic_energy": ("J", "kinetic energy of all moving links"),
    "reduced_inertia": ("kg m^2", "inertia of all moving links reduced to the crank"),
    "reduced_torque": ("N m", "drive reduced to the crank: its work per radian of the crank"),
}
SHAKING = ("Fsx", "Fsy")
TURNED: dict[str, tuple[Callable[..., Any], str, str]] = {
    "Fsx": (_along_x, "N", "shaking force of all cylinders, component along x"),
    "Fsy": (_along_y, "N", "shaking force of all cylinders, component along y"),
    "Msx": (_tilt, "N m", "moment of the shaking forces about the x axis, -z times Fsy"),
    "Msy": (_yaw, "N m", "moment of the shaking forces about the y axis, z times Fsx"),
}
SUMS = {
    "status": Sum(("status",), _plain, np.maximum),
    "assembly": Sum(("assembly",), _plain, np.maximum),
    "omega2": Sum(("omega2",), _plain, lambda first, _: first),
    **{name: Sum((name,), _plain) for name in ADDED},
    **{name: Sum(SHAKING, part) for name, (part, _, _) in TURNED.items()},
}
DERIVED = {
    "Fs_squared": Derived(SHAKING, planar.square),
    "Fs": Derived(("Fs_squared",), np.sqrt),
    "power_fed": Derived(("power",), lambda power: np.maximum(power, 0.0)),
    "power_regenerated": Derived(("power",), lambda power: np.maximum(-power, 0.0)),
}
QUANTITIES = (
    *(Quantity(name, units, long_name) for name, (units, long_name) in ADDED.items()),
    *(Quantity(name, units, long_name) for name, (_, units, long_name) in TURNED.items()),
    Quantity("Fs", "N", "magnitude of the shaking force of all cylinders", squared="Fs_squared"),
    Quantity("power_fed", "W", "power of the drive where it feeds the engine, else 0"),
    Quantity("power_regenerated", "W", "power that the drive takes back where the engine drives it, else 0"),
)


def main(k: int) -> str:
    """Return the name of main bearing k, counted from 1."""
    return f"main{k}"


def main_quantities(count: int) -> tuple[Quantity, ...]:
    """Return the quantities of so many main bearings: their forces."""
    quantities: list[Quantity] = []
    for k in range(1, count + 1):
        name, force = f"F_{main(k)}", f"force of main bearing {k} on its journal"
        quantities += [
            Quantity(f"{name}x", "N", f"{force}, component along x (positive to the right)"),
            Quantity(f"{name}y", "N", f"{force}, component along y (positive upwards)"),
            Quantity(name, "N", f"magnitude of the {force}", squared=f"{name}_squared"),
        ]
    return tuple(quantities)


def rules_of(mains: int) -> dict[str, Sum | Derived]:
    """Return the sum or function for each quantity of an engine with so many main bearings, by name."""
    rules: dict[str, Sum | Derived] = {**SUMS, **DERIVED}
    for k in range(1, mains + 1):
        name = f"F_{main(k)}"
        for axis, along in (("x", _along_x), ("y", _along_y)):
            rules[f"{name}{axis}"] = Sum(("F12x", "F12y"), _carried(k - 1, along))
        rules[f"{name}_squared"] = Derived((f"{name}x", f"{name}y"), planar.square)
        rules[name] = Derived((f"{name}_squared",), np.sqrt)
        rules[f"omega_{main(k)}"] = Derived(("omega2",), np.positive)
    return rules | {opposite_of(name): Derived((name,), np.negative) for name in rules}


def _carried(k: int, along: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function for the part of a throw's force that main k carries, counted from 0."""
    return lambda throw, x, y: throw.shares[k] * along(throw, x, y)


def sources_of(names: Iterable[str], rules: Mapping[str, Sum | Derived]) -> tuple[str, ...]:
    """Return the quantities of one cylinder from which these quantities of the engine are computed."""
    sources: dict[str, None] = {}
    for name in names:
        rule = rules[name]
        own = rule.sources if isinstance(rule, Sum) else sources_of(rule.sources, rules)
        sources |= dict.fromkeys(own)
    return tuple(sources)


def combined(
    names: Iterable[str], rules: Mapping[str, Sum | Derived], throws: Iterable[Throw], cylinders: Iterable[Any]
) -> dict[str, Any]:
    """Return quantities of the whole engine from those of its cylinders by name, each cylinder's at its own angles."""
    each, known = list(zip(throws, cylinders, strict=True)), dict[str, Any]()

    def value(name: str) -> Any:
        if name not in known:
            rule = rules[name]
            if isinstance(rule, Sum):
                parts = [rule.part(throw, *(cylinder[s] for s in rule.sources)) for throw, cylinder in each]
                known[name] = reduce(rule.join, parts)
            else:
                known[name] = rule.function(*map(value, rule.sources))
        return known[name]

    return {name: value(name) for name in names}
