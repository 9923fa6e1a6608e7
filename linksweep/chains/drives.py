"""Drives of a machine of dyads other than the crank: any link on a ground pin, and any cylinder that follows.

Torque or force follow from the virtual work of all that acts on the links. It is applied to the driven links before
their dyads' forces are computed; the torque that the crank then needs is zero. Where the drive decides some of this
work, see `linksweep.chains.coupling`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import NamedTuple

from linksweep.chains.dyads.rrr import Rows
from linksweep.chains.rows.bodies import Source
from linksweep.chains.topology import GROUND, PRP, RPP, RPR, RRP, RRR, Step, Topology
from linksweep.engine.quantity import Limit, Quantity, Row
from linksweep.physics import crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.algebra.arithmetic import NOISE
from linksweep.physics.closures import cylinder

MOST_SLIDES = 4
"""Slides whose friction and the drive may decide each other: for four, 16 choices of their signs are tried."""


class Drive(NamedTuple):
    """A drive: its unknown, its rate and that per rate of the crank, the links on which it acts, and the size of that
    ratio."""

    name: str
    unknown: Quantity
    rate: str
    ratio: Source
    roles: tuple[str, ...]
    size: Source = 1.0

    @property
    def is_crank(self) -> bool:
        return self.unknown.name == "T12"

    def rows(self, work: str = "work") -> Rows:
        """Return the rows of torque or force from the virtual work of all else, and of the status where the driven part
        stands still."""
        if self.is_crank:
            return [Row(planar.opposite, (self.unknown.name,), ("work",))]
        return [
            Row(crank_driven.balancing_drive, (self.unknown.name,), (work, self.ratio)),
            Row(cylinder.standing_status, ("drive_status",), (self.ratio, self.size)),
            Row(planar.product, ("drive_noise",), (NOISE, self.size)),
        ]

    def limits(self) -> tuple[Limit, ...]:
        """Return the limit at which the driven part stands still and its force is unbounded."""
        return (
            ()
            if not isinstance(self.ratio, str)
            else (Limit(self.name, (self.ratio,), ("drive_noise",), "dead_centre"),)
        )


def steps_that_bear(topology: Topology, roles: Collection[str]) -> Iterator[Step]:
    """Yield the steps whose forces depend on what acts on these links: their own, then those of their hosts."""
    for step in reversed(topology.steps):
        if {*step.roles} & {*roles}:
            yield step
            roles = {*roles, *hosts(topology, step)} - {GROUND}


def hosts(topology: Topology, step: Step) -> list[str]:
    """Return the links, or the ground, that hold a dyad."""
    support, of_guide = topology.support, topology.hosts
    match step:
        case RRR(first, second):
            return [support[first.pin], support[second.pin]]
        case RRP(link, guide=guide):
            return [support[link.pin], of_guide[guide]]
        case RPR(link, pin=pin):
            return [support[link.pin], support[pin]]
        case PRP(first_guide=first_guide, second_guide=second_guide):
            return [of_guide[first_guide], of_guide[second_guide]]
        case RPP(guide=guide, pin=pin):
            return [of_guide[guide], support[pin]]
    return [topology.crank]


def friction_problems(topology: Topology, drive: Drive, rubbing: Collection[str]) -> list[str]:
    """Return the problem of a drive that loads more slides with friction than are solved together."""
    bearing = [] if drive.is_crank else [*steps_that_bear(topology, drive.roles)]
    guides = [guide for step in bearing for guide in step.slides if guide in rubbing]
    if len(guides) <= MOST_SLIDES:
        return []
    return [
        f'drive = "{drive.name}": it loads {len(guides)} slides with friction ({", ".join(guides)}), which decide '
        f'it in turn; at most {MOST_SLIDES} may: drive by "{topology.crank}", or take the friction of others away'
    ]
