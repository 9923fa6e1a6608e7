"""Hold the numbers besides a scene on which some results depend: the allowed speed fluctuation, bearings in pins."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from linksweep.analysis.drive.flywheel import FLUCTUATION, checked_fluctuation
from linksweep.analysis.pins.bearing import Bearing, bearing_problems
from linksweep.analysis.pins.life_derivatives import LIFE
from linksweep.base.checked_number import one_number
from linksweep.base.validate import refuse
from linksweep.scene.scene import Scene


class Conditions(NamedTuple):
    """Coefficient of fluctuation of "flywheel_inertia" [1], and the bearing of each pin by its name."""

    fluctuation: float = 0.02
    pins: Mapping[str, Bearing] | None = None

    def bearing(self, pin: str) -> Bearing:
        """Return the bearing of a pin; one without a capacity where none is given."""
        return (self.pins or {}).get(pin, Bearing())

    def problems(self, scene: Scene) -> list[str]:
        """Return the problems of the bearings on a scene's machine."""
        return bearing_problems(self.pins, pins_of(scene), scene)

    def life_problems(self, path: str, name: str) -> list[str]:
        """Return why the life of a bearing, such as L10_B, cannot be computed."""
        word, pin = life_of(name)
        if word == "equivalent_load" or self.bearing(pin).capacity is not None:
            return []
        return [f'{path}: {name} takes a bearing with a capacity; give pins={{"{pin}": ls.Bearing(capacity=...)}}']


USUAL = Conditions()


def pins_of(scene: Scene) -> tuple[str, ...]:
    """Return the names of the pins of a scene's machine."""
    return tuple(getattr(scene.mechanism, "pins", ()))


def life_names(scene: Scene) -> list[str]:
    """Return the names of the results of bearings: equivalent_load_B, L10_B, L10h_B for each pin."""
    return [f"{word}_{pin}" for pin in pins_of(scene) for word in LIFE]


def life_of(name: str) -> tuple[str, str]:
    """Return word and pin of the name of a bearing's result."""
    word = next(word for word in LIFE if name.startswith(f"{word}_"))
    return word, name.removeprefix(f"{word}_")


def checked_conditions(scene: Scene, fluctuation: Any, pins: Any) -> Conditions:
    """Return conditions; ValueError for no fluctuation of one number, and for bearings that do not fit the scene."""
    conditions = Conditions(checked_fluctuation(one_number("fluctuation", fluctuation, FLUCTUATION)), pins)
    refuse(conditions.problems(scene))
    return conditions
