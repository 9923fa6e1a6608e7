"""Sum quantities over the cylinders of an engine, and compute others from such sums.

Cylinder k is the engine's slider-crank turned by its bank angle β about A, its crank ahead by its crank angle φ. In
axes that turn with the cylinder its crank stands at θ2 + φ − β: each cylinder is thus the same cycle at other angles,
its forces turned by β. With z the place along the crankshaft, forces of the cylinders add up to

    Fs = Σ R(β) Fs(θ2 + φ − β)        Ms = Σ Ms(θ2 + φ − β)        T12 = Σ T12(θ2 + φ − β)
    Msx = −Σ z·Fsy,  Msy = Σ z·Fsx    (moments about the axes x and y at z = 0)

and so do powers, kinetic energy, the inertia reduced to the crank and the torque reduced to it. A main bearing at m
carries of each throw in the bays beside it what the lever rule leaves it, as if the crankshaft were hinged at every
main (statically determinate; a stiff crankshaft on more than two mains loads them otherwise):

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
    """How a cylinder stands: its own angle is θ2 + `ahead` [degree]; cos β and sin β; z; what the mains carry of it."""

    ahead: float
    bank: tuple[float, float]
    z: float
    shares: tuple[float, ...]


class Sum(NamedTuple):
    """Return the contribution of each throw, from the quantities `sources` of its cylinder."""

    sources: tuple[str, ...]
    part: Callable[..., Any]
    join: Callable[[Any, Any], Any] = add


class Made(NamedTuple):
    """Return a function's value of sums."""

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


def _first(one: Any, other: Any) -> Any:
    return one


def _fed(power: Any) -> Any:
    return np.maximum(power, 0.0)


def _regenerated(power: Any) -> Any:
    return np.maximum(-power, 0.0)


ADDED = {
    "T12": ("N m", "torque of the drive on the crankshaft, positive counter-clockwise"),
    "Ms": ("N m", "shaking moment of all cylinders about the crankshaft, positive counter-clockwise"),
    "power": ("W", "power of the drive, positive when it feeds the engine"),
    "load_power": ("W", "power of the loads of all cylinders, positive when they feed the engine"),
    "friction_power": ("W", "power of friction on all sliders, never positive"),
    "kinetic_energy": ("J", "kinetic energy of all moving links"),
    "reduced_inertia": ("kg m2", "inertia of all moving links reduced to the crank"),
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
    "omega2": Sum(("omega2",), _plain, _first),
    **{name: Sum((name,), _plain) for name in ADDED},
    **{name: Sum(SHAKING, part) for name, (part, _, _) in TURNED.items()},
}
MADE = {
    "Fs_squared": Made(SHAKING, planar.square),
    "Fs": Made(("Fs_squared",), np.sqrt),
    "power_fed": Made(("power",), _fed),
    "power_regenerated": Made(("power",), _regenerated),
}
QUANTITIES = (
    *(Quantity(name, units, said) for name, (units, said) in ADDED.items()),
    *(Quantity(name, units, said) for name, (_, units, said) in TURNED.items()),
    Quantity("Fs", "N", "magnitude of the shaking force of all cylinders", squared="Fs_squared"),
    Quantity("power_fed", "W", "power of the drive where it feeds the engine, else 0"),
    Quantity("power_regenerated", "W", "power that the drive takes back where the engine drives it, else 0"),
)


def main(k: int) -> str:
    """Return the name of main bearing k, counted from 1."""
    return f"main{k}"


def main_quantities(count: int) -> tuple[Quantity, ...]:
    """Return the loads of so many main bearings."""
    said = "of main bearing {} on its journal"
    return tuple(
        Quantity(name, "N", words.format(said.format(k)), squared)
        for k in range(1, count + 1)
        for name, words, squared in (
            (f"F_{main(k)}x", "force {}, component along x (positive to the right)", None),
            (f"F_{main(k)}y", "force {}, component along y (positive upwards)", None),
            (f"F_{main(k)}", "magnitude of the force {}", f"F_{main(k)}_squared"),
        )
    )


def makers(mains: int) -> dict[str, Sum | Made]:
    """Return how each quantity of an engine with so many main bearings is made, by name."""
    found: dict[str, Sum | Made] = {**SUMS, **MADE}
    for k in range(1, mains + 1):
        name = f"F_{main(k)}"
        for axis, along in (("x", _along_x), ("y", _along_y)):
            found[f"{name}{axis}"] = Sum(("F12x", "F12y"), _carried(k - 1, along))
        found[f"{name}_squared"] = Made((f"{name}x", f"{name}y"), planar.square)
        found[name] = Made((f"{name}_squared",), np.sqrt)
        found[f"omega_{main(k)}"] = Made(("omega2",), np.positive)
    return found | {opposite_of(name): Made((name,), np.negative) for name in found}


def _carried(k: int, along: Callable[..., Any]) -> Callable[..., Any]:
    return lambda throw, x, y: throw.shares[k] * along(throw, x, y)


def sources_of(names: Iterable[str], made: Mapping[str, Sum | Made]) -> tuple[str, ...]:
    """Return the quantities of one cylinder that these take."""
    found: dict[str, None] = {}
    for name in names:
        maker = made[name]
        own = maker.sources if isinstance(maker, Sum) else sources_of(maker.sources, made)
        found |= dict.fromkeys(own)
    return tuple(found)


def together(
    names: Iterable[str], made: Mapping[str, Sum | Made], throws: Iterable[Throw], cylinders: Iterable[Any]
) -> dict[str, Any]:
    """Return quantities of the whole engine from those of its cylinders by name, each at its own angles."""
    each, known = list(zip(throws, cylinders, strict=True)), dict[str, Any]()

    def value(name: str) -> Any:
        if name not in known:
            maker = made[name]
            if isinstance(maker, Sum):
                parts = [maker.part(throw, *(cylinder[s] for s in maker.sources)) for throw, cylinder in each]
                known[name] = reduce(maker.join, parts)
            else:
                known[name] = maker.function(*map(value, maker.sources))
        return known[name]

    return {name: value(name) for name in names}
