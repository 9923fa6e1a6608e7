"""Units on a report's page: those that were chosen, and where none were, the usual ones of drawings."""

from __future__ import annotations

from typing import Any

import numpy as np

from linksweep.base.validate import UNITS
from linksweep.reports.markup import Markup, number
from linksweep.scene.shown_units import UnitSystem

USUAL = {
    "length": ("mm", 1e3),
    "angular_velocity": ("rpm", 30.0 / np.pi),
    "pressure": ("bar", 1e-5),
    "spring_rate": ("N/mm", 1e-3),
}
"""Unit of an input where none was chosen, and its count in the SI unit; other kinds of number stand in SI units."""
LONG = 10.0  # m: lengths from here on stand in m
TYPESET = {"degree": "°", "1": ""}


def typeset(unit: str) -> str:
    """Return a unit as it follows a number: "m/s^2" as "m/s²", "degree" as "°"."""
    return TYPESET.get(unit, unit).replace("^2", "²").replace("^3", "³").replace("^4", "⁴")


def measure(value: float, unit: str, system: UnitSystem, text: str = "") -> Markup:
    """Return a result of this SI unit with the unit in which it is shown; `text` in place of its digits."""
    return number(float(system.value(value, unit)), typeset(system.unit(unit)), text)


def distance(value: float, system: UnitSystem) -> Markup:
    """Return a distance [m] of the results, in mm where no unit was chosen."""
    return measure(value, "m", system) if system.chosen else number(1e3 * value, "mm")


def stress(value: float, system: UnitSystem) -> Markup:
    """Return a stress [Pa] of the results, in MPa where no unit was chosen."""
    return measure(value, "Pa", system) if system.chosen else number(value / 1e6, "MPa")


def unit_of_input(kind: str, value: Any, system: UnitSystem) -> tuple[str, float]:
    """Return the unit of an input of this kind, and its count in the SI unit."""
    if system.chosen or kind not in USUAL or (kind == "length" and np.max(np.abs(value)) >= LONG):
        return typeset(system.unit(UNITS[kind])), 1.0 / system.size(UNITS[kind])
    return USUAL[kind]
