"""Many designs of one machine at one crank angle: as a scene of linksweep, in 50 digits, and to first order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.decimals import Array, Number, Vector, directions, exactly, fifty_digits, root
from benchmarks.stress.machines import MACHINES
from benchmarks.stress.spread import FirstOrder

LINKS = {
    "four-bar": ("crank", "coupler", "rocker"),
    "slider-crank": ("crank", "rod"),
    "inverted slider-crank": ("crank", "rocker"),
}
FORCES = tuple(f"{pin}{axis}" for pin in ("F12", "F32", "F43", "F14") for axis in "xy")


@dataclass(frozen=True)
class Designs:
    """Designs of one machine. `numbers` are arrays over the designs, or single numbers, by the words of a scene;
    `branch` is 1 open, −1 crossed; `sides` are the sides of B→D that C is on, where they differ from the branch's."""

    machine: str
    numbers: Mapping[str, Any]
    theta2: float
    branch: int = 1
    drive: str = "crank"
    sides: Array | None = None

    def __len__(self) -> int:
        return max(np.size(values) for values in self.numbers.values())

    def changed(self, **numbers: Any) -> Designs:
        return replace(self, numbers={**self.numbers, **numbers})

    def part(self, which: slice) -> Designs:
        numbers = {name: values[which] if np.ndim(values) else values for name, values in self.numbers.items()}
        return replace(self, numbers=numbers, sides=None if self.sides is None else self.sides[which])

    def one(self, k: int) -> Designs:
        """Return a single design, its numbers without dims."""
        numbers = {name: float(values[k]) if np.ndim(values) else values for name, values in self.numbers.items()}
        return replace(self, numbers=numbers, sides=None if self.sides is None else self.sides[k : k + 1])

    def scene(self) -> ls.Scene:
        x = {name: xr.DataArray(v, dims="design") if np.ndim(v) else v for name, v in self.numbers.items()}
        return ls.Scene(
            _mechanism(self.machine, x, "open" if self.branch > 0 else "crossed"),
            x["omega2"],
            x["alpha2"],
            (x["gravity_x"], x["gravity_y"]),
            _loads(x),
            drive=self.drive,
        )

    def exact(self) -> tuple[dict[str, Array], list[Array]]:
        """Return results in 50 digits, and the square roots computed on the way."""
        roots: list[Array] = []

        def recorded(radicand: Array) -> Array:
            roots.append(root(radicand))
            return roots[-1]

        with fifty_digits():
            results = MACHINES[self.machine](self._exact_numbers(), recorded)
            results["mu"] = np.minimum(abs(results["mu"]), abs(results.pop("grip", results["mu"])))
        return results, roots

    def spreads(self, roots: list[Array]) -> dict[str, Array]:
        """Return the change of the results with the last digits of all inputs."""
        known: Iterator[Array] = iter([values.astype(float) for values in roots])
        with np.errstate(all="ignore"):  # some designs do not close
            results = MACHINES[self.machine](self._first_order_numbers(), lambda radicand: radicand.root(next(known)))
            return {name: value.spread for name, value in results.items()}

    def _exact_numbers(self) -> dict[str, Any]:
        return self._vectors(
            {name: directions(values) if _is_angle(name) else exactly(values) * 1 for name, values in self._arrays()}
        )

    def _first_order_numbers(self) -> dict[str, Any]:
        arrays = dict(self._arrays())
        numbers: dict[str, Any] = {}
        for k, (name, values) in enumerate(arrays.items()):
            unit = np.zeros((len(arrays), len(self)))
            unit[k] = np.where(values == 0.0, 0.0, np.spacing(np.abs(values)))
            numbers[name] = _first_order_direction(values, unit) if _is_angle(name) else FirstOrder(values, unit)
        return self._vectors(numbers)

    def _arrays(self) -> Iterator[tuple[str, Array]]:
        for name, values in (*self.numbers.items(), ("theta2", self.theta2)):
            yield name, np.broadcast_to(np.asarray(values, dtype=float), len(self))

    def _vectors(self, numbers: dict[str, Number]) -> dict[str, Any]:
        for name in [name for name in numbers if name.endswith("_x")]:
            stem = name.removesuffix("_x")
            numbers[stem] = Vector(numbers.pop(name), numbers.pop(f"{stem}_y"))
        if "slider_push" in numbers:
            numbers["slider_force"] = numbers["slide_angle"] * numbers.pop("slider_push")
        side = np.full(len(self), self.branch) if self.sides is None else self.sides
        return numbers | {"side": side, "drive": self.drive}


def _is_angle(name: str) -> bool:
    return name.endswith("_angle") or name == "theta2"


def _first_order_direction(degrees: Array, unit: Array) -> Vector:
    cos, sin = (values.astype(float) for values in directions(degrees))
    radians = np.radians(1.0) * unit
    return Vector(FirstOrder(cos, -sin * radians), FirstOrder(sin, cos * radians))


def _mechanism(machine: str, x: Mapping[str, Any], branch: str) -> Any:
    words = ("length", "mass", "inertia", "cg_distance", "cg_angle")
    links = [ls.Link(*(x[f"{role}_{word}"] for word in words)) for role in LINKS[machine]]
    if machine == "four-bar":
        return ls.FourBar(*links, x["ground"], branch, x["ground_angle"])
    if machine == "slider-crank":
        return ls.SliderCrank(*links, x["slider_mass"], x["offset"], x["friction"], branch, x["slide_angle"])
    block = (x["block_mass"], x["block_inertia"])
    return ls.InvertedSliderCrank(*links, x["ground"], *block, x["offset"], branch, x["ground_angle"])


def _loads(x: Mapping[str, Any]) -> list[ls.Load]:
    loads = []
    if "coupler_force_x" in x:
        at = x["coupler_at_distance"], x["coupler_at_angle"]
        loads.append(ls.Load("coupler", (x["coupler_force_x"], x["coupler_force_y"]), at=at))
    if "rocker_torque" in x:
        loads.append(ls.Load("rocker", torque=x["rocker_torque"]))
    if "slider_push" in x:
        loads.append(ls.Load("slider", x["slider_push"]))
    return loads
