"""Loads whose numbers may change over the revolution: their interpolation between angles, and the angles of jumps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linksweep.base.fields import RowField
from linksweep.base.frozen import normalise
from linksweep.base.validate import Number, Rule, choice_problems, is_array, quote
from linksweep.mechanisms import Mechanism
from linksweep.scene.curves.interpolation import INTERPOLATIONS
from linksweep.scene.curves.over_angle import corners
from linksweep.scene.loads.action import Action

BREAKS = RowField(Rule("angle"))


class ChangingLoad(Action):
    """A load with an `interpolation`, by default that of its arrays, attrs["interpolation"]; and with `breaks`."""

    interpolation: str | None
    breaks: Sequence[float]

    @property
    def changing(self) -> tuple[Any, ...]:
        """The numbers that may change over the revolution."""
        raise NotImplementedError

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.interpolation is None:
            normalise(self, interpolation=next(iter(self._of_arrays()), None))

    def interpolation_problems(self, path: str) -> list[str]:
        """Return the problems of the interpolation of the load at this path."""
        if self.interpolation is None:
            return []
        problems = choice_problems(f"{path}.interpolation", self.interpolation, INTERPOLATIONS)
        others = [f"one is {quote(other)}" for other in self._of_arrays() if other != self.interpolation]
        others += ["one is a function" for number in self.changing if callable(number) and not is_array(number)]
        kind = f"{path}.interpolation = {quote(self.interpolation)}: is that of all its arrays, but"
        return problems + [f"{kind} {other}; give that a load of its own" for other in others[:1]]

    def jumps(self, mechanism: Mechanism) -> tuple[Number, ...]:
        """Return the breaks, and the crank angles [degree] at which its arrays jump, or bend."""
        return (*self.breaks, *(angle for array in self.changing for angle in corners(array, self.interpolation)))

    def _of_arrays(self) -> list[Any]:
        """Return the interpolations that its arrays name in their attributes."""
        attributes = (getattr(number, "attrs", {}) for number in self.changing)
        return [own["interpolation"] for own in attributes if "interpolation" in own]
