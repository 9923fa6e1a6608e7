"""Shape of a machine made of a crank and dyads, and how a dyad holds its links."""

from __future__ import annotations

from typing import NamedTuple

from linksweep.chains.dyads.names import Vector
from linksweep.chains.rows.bodies import Source
from linksweep.chains.topology import Topology

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
