"""Bearing of a pin, and the results of one bearing from the load on it at each sample.

Equations and sources: `linksweep.analysis.pins.bearing_life` for rolling bearings, `linksweep.physics.bearing` for
plain ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.pins.bearing_life import MEANINGS
from linksweep.base.checked_number import unit_attribute_problems
from linksweep.base.equality import ByContent
from linksweep.base.fields import field_problems, numbers, parameter
from linksweep.base.validate import Number, choice_problems, name_problems, quote, refuse
from linksweep.physics import bearing as plain
from linksweep.results.compute import require
from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.results.dataset import flags, joined, with_units
from linksweep.results.peaks import peaks
from linksweep.scene.dimensions import argument_problems
from linksweep.scene.scene import Scene

EXPONENTS = {"ball": 3.0, "roller": 10.0 / 3.0}
TEXTS = {
    "F": ("N", "magnitude of the pin force"),
    "F_peak": ("N", "largest load over the continuous cycle or part of a turn"),
    "F_peak_at": ("degree", "crank angle of the largest load"),
    "F_mean": ("N", "mean load over the time of the continuous cycle or part of a turn"),
    "pressure_peak": ("Pa", "projected pressure under the largest load"),
    "Fx": ("N", "pin force Fij of link i on link j, component along the x axis of the frame"),
    "Fy": ("N", "pin force Fij of link i on link j, component along the y axis of the frame"),
    "rotation_speed": ("rad/s", "angular velocity of link j relative to link i, of the pin force Fij"),
    "rotation_share": ("1", "share of the cycle's rotation of the journal in its bearing that this sample stands for"),
    "rotation": ("degree", "angle that the journal turns in its bearing on the crank's way, to and fro added up"),
    "pressure": ("Pa", "projected pressure, force over diameter times length"),
    "sliding_speed": ("m/s", "sliding speed of the journal in its bearing, never negative"),
    "pv": ("Pa m/s", "projected pressure times sliding speed"),
    "friction_loss": ("W", "power that friction in the pin takes, never negative"),
    "equivalent_load": ("N", "constant load of the same life as the cycle's loads"),
    "L10": ("megarevolution", "revolutions of the journal in its bearing that nine of ten rolling bearings reach"),
    "L10h": ("h", "running time that nine of ten rolling bearings reach"),
}


@dataclass(frozen=True, eq=False, repr=False)
class Bearing(ByContent):
    """The bearing of a pin.

    All sizes may be left out; results that need them are then NaN. Numbers may be DataArrays of design dims.

    Parameters
    ----------
    diameter : float or DataArray, default None
        Diameter of the journal [m].
    length : float or DataArray, default None
        Length of the bush [m].
    friction : float or DataArray, default 0.0
        Coefficient of Coulomb friction between the two [1]; its friction circle is exact, μ·r/√(1 + μ²).
    capacity : float or DataArray, default None
        Basic dynamic load rating C of a rolling bearing [N].
    kind : str, default "ball"
        Rolling elements, "ball" or "roller", for the exponent of the life.

    Raises
    ------
    ValueError
        If a parameter is out of bounds; one line for each.

    Examples
    --------
    >>> import linksweep as ls
    >>> pins = {"B": ls.Bearing(diameter=0.02, length=0.03, friction=0.1), "C": ls.Bearing(capacity=5000.0)}
    >>> loads = ls.bearings(ls.example("press"), pins)
    >>> round(float(loads.pressure.sel(pin="B").max())), round(float(loads.L10.sel(pin="C")))  # Pa, million revolutions
    (590895, 16520)
    """

    diameter: Number = parameter("length", None, above=0.0)
    length: Number = parameter("length", None, above=0.0)
    friction: Number = parameter("dimensionless", 0.0, at_least=0.0)
    capacity: Number = parameter("force", None, above=0.0)
    kind: str = "ball"

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse(field_problems(self) + choice_problems("kind", self.kind, EXPONENTS))
        refuse(unit_attribute_problems(numbers(self)))

    @property
    def exponent(self) -> float:
        """Exponent p of the life's equation."""
        return EXPONENTS[self.kind]


def checked_pins(scene: Scene, pins: Mapping[str, Bearing] | None) -> Mapping[str, tuple[int, int]]:
    """Return the pins of a scene's machine; raise ValueError where it has none, or bearings do not fit it."""
    require(scene, "pins")
    refuse(bearing_problems(pins, scene.mechanism.pins, scene))
    return scene.mechanism.pins


def bearing_problems(pins: Any, known: Iterable[str], scene: Scene) -> list[str]:
    """Return the problems of bearings by pin, of those known, in the machine of a scene."""
    if not isinstance(pins, Mapping | None):
        return [f'pins = {quote(pins)}: must be as {{"B": ls.Bearing(...)}}']
    pins = pins or {}
    wrong = [problem for pin in pins for problem in name_problems("pins", pin, known)]
    strange = {pin: item for pin, item in pins.items() if not isinstance(item, Bearing)}
    wrong += [f"pins.{pin} = {quote(item)}: must be a Bearing" for pin, item in strange.items()]
    return wrong or argument_problems(scene.arrays, pins=pins)


def side_by_side(
    parts: list[dict[str, xr.DataArray]], dim: str, pins: Iterable[str], texts: Mapping[str, tuple[str, str]]
) -> dict[str, xr.DataArray]:
    """Return the results of all pins along a dim, with unit and description."""
    results = {name: joined([part[name] for part in parts], dim, pins) for name in parts[0]}
    status = flags("loads for which the life of the bearing holds", MEANINGS)
    life_status = results.pop("life_status").assign_attrs(status)
    described = with_units({name: (values, *texts[name]) for name, values in results.items()})
    return described | {"life_status": life_status}


def exact_loads(
    machine: Scene | MultiCylinder, forces: Iterable[str], between: tuple[float, float] | None = None
) -> xr.Dataset:
    """Return the exact peaks and means of pin forces."""
    return peaks(machine, of=[f"{force}_{word}" for force in forces for word in ("peak", "mean")], between=between)


def load_results(exact: xr.Dataset, name: str, bearing: Bearing) -> dict[str, xr.DataArray]:
    """Return the largest load of a pin, of this name, its angle, the pressure under it, and the mean load."""
    loads = {f"F_{word}": exact[f"{name}_{word}"] for word in ("peak", "peak_at", "mean")}
    return loads | {"pressure_peak": plain.projected_pressure(loads["F_peak"], *_sizes(bearing))}


def _sizes(bearing: Bearing) -> tuple[Number, Number]:
    """Return diameter and length; NaN of those that are unknown."""
    diameter, length = (np.nan if size is None else size for size in (bearing.diameter, bearing.length))
    return diameter, length


def journal_results(
    cycle: xr.Dataset, name: str, speed: xr.DataArray, turns: xr.DataArray, bearing: Bearing
) -> dict[str, xr.DataArray]:
    """Return rotation, pressure, sliding and friction of a journal under a load of this name at each sample.

    `turns` is proportional to the rotation for which each sample stands.
    """
    force, (diameter, length) = cycle[name], _sizes(bearing)
    sliding = plain.sliding_speed(speed, diameter)
    pressure = plain.projected_pressure(force, diameter, length)
    loss = plain.friction_loss(plain.friction_circle(bearing.friction, diameter), force, speed)
    turns = turns.where(cycle["status"] == 0)
    motion = {"rotation_speed": speed, "rotation_share": turns / turns.sum("theta2", skipna=True, min_count=1)}
    return motion | {"pressure": pressure, "sliding_speed": sliding, "pv": pressure * sliding, "friction_loss": loss}
