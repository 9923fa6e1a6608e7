"""What every action on a mechanism offers to the scene that takes it, with what most of them answer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linksweep.base.equality import ByContent
from linksweep.base.validate import Number, field_problems
from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.rows.load_forms import Form
from linksweep.scene.revolution import Revolution


class Action(ByContent):
    """What may stand among a scene's loads: a frozen dataclass that knows its form and its numbers."""

    @property
    def form(self) -> Form:
        """Which rows it brings, without its numbers."""
        raise NotImplementedError

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """Its numbers under the names that the physics wires by, given the machine's."""
        raise NotImplementedError

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        """What is wrong with it on a machine of these links; by default, what is with its numbers."""
        return field_problems(self, path + ".")

    def misfits(self, path: str, mechanism: Mechanism) -> list[str]:
        """Why a mechanism does not take it, sound as it is in itself."""
        return []

    @property
    def on_centre_of(self) -> str:
        """The link with whose centre of gravity its place moves; "" for none."""
        return ""

    @property
    def over_positions(self) -> tuple[Any, ...]:
        """Its tables and functions of a position: curves, which have neither designs nor crank angles."""
        return ()

    @property
    def period(self) -> float:
        """After which it repeats [degree], besides what its numbers over theta2 say; 0 where it has none of its own."""
        return 0.0

    def jumps(self, mechanism: Mechanism) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which its force or torque jumps, kinks or is narrow; NaN for none."""
        return ()

    def approaches(self, name: str) -> tuple[tuple[str, str], ...]:
        """Return the names of pairs of quantities: one rises through 0 where its force may turn over quickly, the other
        says within which angle of the crank [rad]."""
        return ()

    def sampled(self, path: str, revolution: Revolution) -> Action:
        """The same with all that changes over the revolution at its angles; itself where nothing does."""
        return self
