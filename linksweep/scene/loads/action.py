"""The base class of all loads, and the register of their kinds."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from linksweep.base.equality import ByContent
from linksweep.base.fields import field_problems
from linksweep.base.validate import Number
from linksweep.chains.rows.load_forms import Form
from linksweep.mechanisms import Mechanism
from linksweep.mechanisms.strokes import Stroke
from linksweep.scene.revolution import Revolution

Kind = TypeVar("Kind", bound="type[Action]")


class Action(ByContent):
    """A load of a scene: a frozen dataclass with a form (its rows in a machine's table) and numbers for them.

    Derive a dataclass, declare the kind of each field, and register it::

        @register
        @dataclass(frozen=True, eq=False, repr=False)
        class Brake(Action):
            torque: Number = parameter("torque", at_least=0.0)
            ...

    With a line in `linksweep.scene.loads` it is then one of the package's loads.
    """

    @property
    def form(self) -> Form:
        """The rows and quantities that the load adds to a machine's table."""
        raise NotImplementedError

    def parameters(self, name: str, machine: Mapping[str, Any]) -> dict[str, Number]:
        """Return the load's numbers under the names that the rows of its form take; `machine` are the machine's."""
        raise NotImplementedError

    def problems(self, path: str, links: tuple[str, ...]) -> list[str]:
        """Return the problems of the load on a machine of these links; by default those of its fields."""
        return field_problems(self, path + ".")

    def for_machine(self, mechanism: Mechanism) -> Action:
        """Return the load on this mechanism; itself where all its parameters are independent of it."""
        return self

    def misfits(self, path: str, mechanism: Mechanism) -> list[str]:
        """Return why this mechanism cannot take the load, which is valid in itself."""
        return []

    @property
    def on_centre_of(self) -> str:
        """The link with whose centre of gravity its point of action moves; "" for none."""
        return ""

    @property
    def over_positions(self) -> tuple[Any, ...]:
        """Tables and functions of a position: curves, which have neither designs nor crank angles."""
        return ()

    @property
    def period(self) -> float:
        """Period [degree] of the load, besides those of its numbers over theta2; 0 where it has none of its own."""
        return 0.0

    def jumps(self, mechanism: Mechanism) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which its force or torque jumps, kinks or is narrow; NaN for none."""
        return ()

    def jumps_along(self, stroke_of: Callable[[str], Stroke]) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which a load over the position of a link jumps, kinks or is narrow.

        `stroke_of` returns the stroke of a position by its name.
        """
        return ()

    def approaches(self, name: str) -> tuple[tuple[str, str], ...]:
        """Return the names of pairs of quantities that locate where its force may turn over quickly.

        One rises through 0 there, the other states within which angle of the crank [rad].
        """
        return ()

    def sampled(self, path: str, revolution: Revolution) -> Action:
        """Return the load with all that changes over the revolution at its angles; itself where nothing changes."""
        return self


LOADS: dict[str, type[Action]] = {}
"""Every registered kind of load by the name of its class, which is its `type` in a scene file."""


def register(kind: Kind) -> Kind:
    """Add a kind of load to `LOADS`; a decorator of its dataclass."""
    LOADS[kind.__name__] = kind
    return kind
