"""Shape of a machine made of a crank and dyads, and how a dyad holds its links."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from linksweep.chains.dyads.names import Vector, full
from linksweep.chains.rows.bodies import Source
from linksweep.chains.topology import Topology
from linksweep.physics.closures import pins

if TYPE_CHECKING:
    from linksweep.chains.motion import Motion

ORIGIN = (0.0, 0.0, 0.0, 0.0)


class Frame(NamedTuple):
    """The place of a link: a pin that has its place, and a vector in ground axes and in its own, with low words."""

    pin: str
    vector: Vector
    own: Vector


class Arm(NamedTuple):
    """A link of a dyad from its known pin to the pin that it places: stem of the vector, and its length."""

    stem: str
    length: str
    length_lo: Source


class Shape(NamedTuple):
    """All that decides the rows of a machine's motion.

    Parameters
    ----------
    topology : links and steps
    turned : names of steps on crank and ground whose frame may lie at an angle to x
    goes_through : names of such steps that may be a parallelogram or a kite
    inclined : names of guides on links that may lie at an angle to their link's line of pins
    between : names of ground pins and guides whose distance from the crank's pivot may lie between two floats
    meshed : names of wheels whose teeth push, at a pressure angle
    plain : whether the rows keep the names of the dyad's own machine; for a topology of one step
    """

    topology: Topology
    turned: frozenset[str] = frozenset()
    goes_through: frozenset[str] = frozenset()
    inclined: frozenset[str] = frozenset()
    between: frozenset[str] = frozenset()
    meshed: frozenset[str] = frozenset()
    plain: bool = False


class Arms:
    """Vectors to pins from those by which links place them.

    The vector between two pins leaves out what both have in common: it would cost operations, and digits.
    """

    def __init__(self, motion: Motion) -> None:
        self.motion = motion
        self._to: dict[str, dict[str, Vector]] = defaultdict(dict)

    def add(self, start: str, pin: str, arm: Vector) -> None:
        """Add the vector from one pin to another."""
        self._to[pin][start] = arm

    def apart(self, vector: tuple[str, ...], p: str, q: str) -> None:
        """Add the rows of the vector from one pin to another."""
        place = self.motion.place
        to_p, to_q = self._from_common_pin(p, q) or self._from_ground(p, q) or (place(p), place(q))
        self.motion.row(pins.apart, vector, *to_q, *to_p)

    def _from_common_pin(self, p: str, q: str) -> tuple[Vector, Vector] | None:
        """Return the vectors to two pins from one by which both are placed, or which is one of them."""
        to_p, to_q = {p: ORIGIN, **self._to[p]}, {q: ORIGIN, **self._to[q]}
        return next(((arm, to_q[start]) for start, arm in to_p.items() if start in to_q), None)

    def _from_ground(self, p: str, q: str) -> tuple[Vector, Vector] | None:
        """Return the vectors to two pins from the ground pin by which one is placed, where the other is on the ground.

        Places count from the crank's pivot already.
        """
        motion = self.motion
        if motion.fixed(p):
            both = self._from_ground(q, p)
            return both and both[::-1]
        for start, arm in self._to[p].items():
            if motion.fixed(q) and motion.fixed(start) and not motion.is_origin(start):
                on_ground = full(f"ground_{start}_{q}")
                motion.row(pins.between, on_ground, *motion.place(q), *motion.place(start))
                self.add(start, q, on_ground)
                return arm, on_ground
        return None
