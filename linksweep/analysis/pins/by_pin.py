"""Numbers of pins: one for all of them, or one for each by its letter."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linksweep.base.checked_number import checked_number
from linksweep.base.validate import Number, Rule, name_problems, refuse
from linksweep.chains.between_links import is_pin
from linksweep.results.compute import require
from linksweep.scene.scene import Scene

Numbers = Number | Mapping[str, Number]


def links_of_pins(scene: Scene) -> dict[str, tuple[int, int]]:
    """Return the numbers of the two links that each pin joins; ValueError for a machine without pins."""
    require(scene, "pins")
    return {pin: links for pin, links in scene.mechanism.pins.items() if is_pin(pin)}


def numbers_by_pin(path: str, numbers: Numbers, pins: Mapping[str, Any], rule: Rule) -> dict[str, Number]:
    """Return the numbers that are stated, by pin; ValueError for an unknown pin, and a number out of bounds."""
    stated = numbers if isinstance(numbers, Mapping) else dict.fromkeys(pins, numbers)
    refuse([problem for pin in stated for problem in name_problems(path, pin, pins)])
    return {pin: checked_number(f"{path}.{pin}", number, rule) for pin, number in stated.items()}
