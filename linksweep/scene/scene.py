"""A scene: a mechanism, how it is driven, and what acts on it; and the same scene as numbers for the engine."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.engine.plan import InputForms
from linksweep.engine.quantity import Table
from linksweep.engine.run import Field, Grid
from linksweep.mechanisms import MECHANISMS, Mechanism
from linksweep.mechanisms.validate import (
    Number,
    Rule,
    choice_problems,
    is_array,
    pair_problems,
    parameter,
    problems,
    refuse,
    said,
)
from linksweep.scene.dimensions import dimension_problems
from linksweep.scene.grid import NAMES as GRID_ROWS
from linksweep.scene.loads import Load
from linksweep.scene.over_angle import at_angles

ACCELERATION = Rule("acceleration")


class Inputs(NamedTuple):
    """A scene as the engine takes it: numbers with dims, their forms for the planner, and the size of each dim."""

    fields: Mapping[str, Field]
    forms: InputForms
    sizes: Mapping[str, int]


@dataclass(frozen=True, eq=False)
class Scene:
    """What happens to a mechanism: its drive, gravity and loads.

    Parameters
    ----------
    mechanism : FourBar
    omega2 : angular velocity of the crank [rad/s], positive counter-clockwise
    alpha2 : its angular acceleration [rad/s²]; taken as given, also where omega2 changes with theta2
    gravity : (gx, gy) [m/s²]; none by default, (0, -9.81) for a mechanism that stands upright
    loads : any number of Load
    drive : the link whose ground torque is the unknown: "crank" (T12), "coupler" (T13) or "rocker" (T14)

    Any number may be an xarray.DataArray with named dims; omega2, alpha2, forces and torques may also depend on
    theta2, as a DataArray or a function of theta2 [degree].

    Raises
    ------
    ValueError
        One line for each parameter that is not allowed, by its path.

    Examples
    --------
    >>> import linksweep as ls
    >>> bar = dict(width=0.02, thickness=0.02, density=7750)
    >>> press = ls.FourBar(crank=ls.Bar(length=0.08, **bar), coupler=ls.Bar(length=0.22, **bar),
    ...                    rocker=ls.Bar(length=0.18, **bar), ground=0.20)
    >>> scene = ls.Scene(press, omega2=30.0, gravity=(0.0, -9.81), loads=[ls.Load("rocker", torque=-12.0)])
    >>> scene.drive
    'crank'
    """

    mechanism: Mechanism
    omega2: Number = parameter("angular_velocity", over_angle=True)
    alpha2: Number = parameter("angular_acceleration", 0.0, over_angle=True)
    gravity: tuple[Number, Number] = (0.0, 0.0)
    loads: tuple[Load, ...] = ()
    drive: str = "crank"

    def __post_init__(self) -> None:
        sound = isinstance(self.mechanism, MECHANISMS)
        known = " or ".join(kind.__name__ for kind in MECHANISMS)
        found = [] if sound else [f"mechanism = {said(self.mechanism)}: must be a {known}"]
        found += problems(self)
        found += pair_problems("gravity", self.gravity, (ACCELERATION, ACCELERATION), "(gx, gy) in m/s^2")
        found += choice_problems("drive", self.drive, self._of_mechanism("drives"))
        found += self._take_loads()
        refuse(found)
        refuse(dimension_problems(self.arrays, self.mechanism.index, self.table.quantity))

    def _of_mechanism(self, words: str) -> tuple[str, ...]:
        """The mechanism's drives or links; of an unsound one, those of any."""
        kinds = (type(self.mechanism),) if isinstance(self.mechanism, MECHANISMS) else MECHANISMS
        return tuple(dict.fromkeys(word for kind in kinds for word in getattr(kind, words)))

    def _take_loads(self) -> list[str]:
        """Any collection of loads as a tuple; a single load counts as one."""
        loads = (self.loads,) if isinstance(self.loads, Load) else self.loads
        if isinstance(loads, str | Mapping | np.ndarray) or is_array(loads) or not isinstance(loads, Iterable):
            return [f"loads = {said(loads)}: must be a Load, or a list of them"]
        object.__setattr__(self, "loads", tuple(loads))
        found = []
        for k, load in enumerate(self.loads, 1):
            sound = isinstance(load, Load)
            problem = [f"loads[{k}] = {said(load)}: must be a Load"]
            found += load.problems(f"loads[{k}]", self._of_mechanism("links")) if sound else problem
        return found

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return _content(self) == _content(other)

    __hash__ = None  # type: ignore[assignment]

    @cached_property
    def table(self) -> Table:
        """All that can be computed of this scene."""
        return self.mechanism.table(self.drive, tuple(load.form for load in self.loads))

    @cached_property
    def arrays(self) -> dict[str, xr.DataArray]:
        """The scene's DataArrays by the path of the parameter that each is."""
        return {path: value for path, value in _numbers(self) if isinstance(value, xr.DataArray)}

    @cached_property
    def functions(self) -> dict[str, Any]:
        """The scene's functions of theta2 by path."""
        return {path: value for path, value in _numbers(self) if callable(value) and not hasattr(value, "dims")}

    def at(self, grid: Grid) -> Scene:
        """The same scene with all that changes over the revolution given as DataArrays over the grid's angles."""
        if not self.functions and not any("theta2" in array.dims for array in self.arrays.values()):
            return self

        def sample(path: str, value: Any, rule: Rule) -> Any:
            changes = path in self.functions or "theta2" in getattr(value, "dims", ())
            return at_angles(path, value, rule, grid, self.mechanism.period) if changes else value

        return replace(
            self,
            omega2=sample("omega2", self.omega2, Rule("angular_velocity", over_angle=True)),
            alpha2=sample("alpha2", self.alpha2, Rule("angular_acceleration", over_angle=True)),
            loads=tuple(load.sampled(f"loads[{k}]", sample) for k, load in enumerate(self.loads, 1)),
        )

    @cached_property
    def inputs(self) -> Inputs:
        """The scene as the engine takes it; what changes over the revolution must have been brought `at` a grid."""
        named = self._named_values()
        fields = {name: _field(value) for name, value in named.items()}
        grid_rows = tuple((name, (self.mechanism.index,)) for name in GRID_ROWS)
        forms = (*((name, _form(field)) for name, field in fields.items()), *grid_rows)
        sizes = {dim: n for f in fields.values() for dim, n in zip(f.dims, f.values.shape, strict=True)}
        sizes.pop(self.mechanism.index, None)
        return Inputs(fields, forms, sizes)

    @cached_property
    def labels(self) -> dict[str, xr.Variable]:
        """Coordinates of the design dims that have some."""
        found = {dim: xr.Variable(dim, names) for dim, names in self.mechanism.coordinates().items()}
        for array in self.arrays.values():
            found |= {str(dim): array[dim].variable for dim in array.dims if dim in array.coords}
        found.pop(self.mechanism.index, None)
        return found

    def _named_values(self) -> dict[str, Any]:
        gx, gy = self.gravity
        named = {"omega2": self.omega2, "alpha2": self.alpha2, "gravity_x": gx, "gravity_y": gy}
        named |= self.mechanism.parameters()
        for k, load in enumerate(self.loads, 1):
            cg = (named[f"{load.link}_cg_x"], named[f"{load.link}_cg_y"])
            named |= load.parameters(f"load{k}", cg)
        return named


def _field(value: Any) -> Field:
    if isinstance(value, Field):
        return value
    if isinstance(value, xr.DataArray):
        return Field(tuple(map(str, value.dims)), np.asarray(value.values, dtype=float))
    return Field((), np.asarray(float(value)))


def _form(field: Field) -> tuple[str, ...] | float:
    """A number that is exactly 0 or 1 is worth knowing when planning: what it multiplies can be left out."""
    return float(field.values) if not field.dims and field.values in (0.0, 1.0) else field.dims


def _numbers(owner: Any, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Every number of a scene with its path, as messages write it."""
    for item in fields(owner):
        value, path = getattr(owner, item.name), prefix + item.name
        if "rule" in item.metadata:
            yield path, value
        elif item.name == "loads":
            for k, load in enumerate(value, 1):
                yield from _numbers(load, f"loads[{k}].")
        elif is_dataclass(value):
            yield from _numbers(value, "" if item.name == "mechanism" else path + ".")
        elif isinstance(value, tuple | list):
            yield from ((f"{path}[{k}]", number) for k, number in enumerate(value, 1))


def _content(value: Any) -> Any:
    """What makes two scenes equal, as nested tuples."""
    if is_dataclass(value):
        return type(value).__name__, tuple(_content(getattr(value, item.name)) for item in fields(value))
    if isinstance(value, xr.DataArray):
        coordinates = [(dim, value[dim].values.tolist()) for dim in value.dims if dim in value.coords]
        return value.dims, value.astype(float).values.tobytes(), repr(coordinates)
    return tuple(map(_content, value)) if isinstance(value, tuple | list) else value
