"""Parts of a machine of one dyad on crank and ground: its drives, ratios of its output, limits in closed form.

Of a link that is driven in place of the crank, the crank's moment equation takes the place of its own. Torque or force
of the drive, whose leverage may vanish, then come with the pin forces, so that all have the same error.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from linksweep.base.validate import Number
from linksweep.chains.finding import Findings
from linksweep.chains.rows.bodies import Source, drive_torque
from linksweep.chains.rows.crank import between_rows
from linksweep.engine.quantity import Quantity, Row, Total
from linksweep.physics import advantage, coulomb, crank_driven
from linksweep.physics.algebra import planar

Lengths = tuple[Source, Source]


class Driven(NamedTuple):
    """A drive: its unknown, the rate of the driven part, and rows that take the place of those of a driven crank."""

    unknown: Quantity
    rate: str
    rows: tuple[Row | Total, ...] = ()


class OnCrank(NamedTuple):
    """A machine of one dyad on crank and ground.

    drives : by the name of the driven part
    rows : further rows, or in place of those of the dyad
    quantities : those of these rows
    between : rows of the crank's angle between samples
    checks : closed forms of the machine, of its stroke and its output, and of each drive
    narrowest : pairs of lengths of which the first is larger at every crank angle where it closes all the way

    The arguments of closed forms are named as in equations.
    """

    drives: dict[str, Driven]
    rows: tuple[Row | Total, ...]
    quantities: tuple[Quantity, ...]
    between: tuple[Row, ...]
    checks: Mapping[str, tuple[Findings, ...]]
    narrowest: Callable[..., tuple[tuple[Number, Number], ...]]


def status(leverage: str, lengths: Lengths, *jams: Row) -> tuple[Row, ...]:
    """Return rows of the status where a driven part may stand still: `leverage` is then 0, at most that of `lengths`.

    A jam has a meaning only where it moves.
    """
    moves = Row(crank_driven.drive_status, ("leverage_status",), ("closure", leverage, *lengths))
    return moves, *(jams or (Row(planar.identity, ("status",), ("leverage_status",)),))


def ratio_of_driven(ratio: str, leverage: str, lengths: Lengths) -> Row:
    """Return the row of a driven part's rate per rate of the crank; NaN where it stands still."""
    return Row(crank_driven.away_from_dead_centre, ("driven_ratio",), (ratio, leverage, *lengths))


CRANK = Driven(drive_torque("T12", "crank"), "omega2")
MOMENT_ON_CRANK = Row(crank_driven.moment_on_crank, ("moment_r2",))
WEDGED = Row(coulomb.jammed_status, ("jam_status",), ("leverage_status", "wedging"))
FROM_GROUND, FROM_GUIDE = between_rows("ground_cos", "ground_sin"), between_rows("upright_cos", "upright_sin")
OF_ROCKER = (
    Row(planar.along, ("Dx", "Dy"), ("ground_length", "ground_cos", "ground_sin")),
    Row(planar.identity, ("velocity_ratio",), ("ratio4",)),
    Row(advantage.torque_ratio, ("torque_ratio",)),
)
RATIOS_OF_ROCKER = (
    Quantity("velocity_ratio", "1", "angular velocity of the rocker per that of the crank"),
    Quantity("torque_ratio", "1", "torque that the rocker gives per torque on the crank, without any losses"),
)
ADVANTAGE = ("mechanical_advantage",)
