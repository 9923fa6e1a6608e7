"""Machines of one dyad on crank and ground, in the names of their textbooks: drives, ratios of the output, contacts.

Of a link that is driven in place of the crank, the crank's moment equation takes the place of its own. Torque or force
of the drive, whose leverage may vanish, then come with the pin forces, so that all have the same error.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from linksweep.chains.rows.bodies import Source, drive_torque
from linksweep.chains.rows.crank import between_rows
from linksweep.engine.quantity import Quantity, Row, Total
from linksweep.physics import advantage, coulomb, crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import dyad_rrr, inverted_slider_crank, slider_crank

Lengths = tuple[Source, Source]


class Driven(NamedTuple):
    """A drive: its unknown, the rate of the driven part, and rows that take the place of those of a driven crank."""

    unknown: Quantity
    rate: str
    rows: tuple[Row | Total, ...] = ()


class OnCrank(NamedTuple):
    """A machine of one dyad on crank and ground: its drives by the name of the driven part, further rows, the
    quantities of rows, and the rows of the crank's angle between samples."""

    drives: dict[str, Driven]
    rows: tuple[Row | Total, ...]
    quantities: tuple[Quantity, ...]
    between: tuple[Row, ...]


def _status(leverage: str, lengths: Lengths, *jams: Row) -> tuple[Row, ...]:
    """Return rows of the status where a driven part may stand still: `leverage` is then 0, at most that of `lengths`.

    A jam has a meaning only where it moves.
    """
    moves = Row(crank_driven.drive_status, ("leverage_status",), ("closure", leverage, *lengths))
    return moves, *(jams or (Row(planar.identity, ("status",), ("leverage_status",)),))


def _ratio(ratio: str, leverage: str, lengths: Lengths) -> Row:
    """Return the row of a driven part's rate per rate of the crank; NaN where it stands still."""
    return Row(crank_driven.away_from_dead_centre, ("driven_ratio",), (ratio, leverage, *lengths))


def _of_rrr(link: int, role: str, other: tuple[str, str, str], length: str, torque: Callable) -> Driven:
    """Return the drive of one link of three pins; `other` are vector and moment of the other, of this length."""
    inverse, lengths = "inverse_r4_cross_r3", ("crank_length", length)
    at_C = ("r2x", "r2y", "crank_length", "moment_r2", *other, "driven_ratio", inverse)
    rows = (
        Row(planar.opposite, ("moment_r3",), ("N3",)),
        MOMENT_ON_CRANK,
        Row(dyad_rrr.rrr_leverage, ("leverage",), (f"ratio{link}", inverse)),
        _ratio(f"ratio{link}", "leverage", lengths),
        Row(dyad_rrr.rrr_driven_pin_force, ("push_rocker_Cx", "push_rocker_Cy", "pull", "push"), at_C),
        Row(torque, (f"T1{link}",)),
        *_status("leverage", lengths),
    )
    return Driven(drive_torque(f"T1{link}", role), f"omega{link}", rows)


CRANK = Driven(drive_torque("T12", "crank"), "omega2")
MOMENT_ON_CRANK = Row(crank_driven.moment_on_crank, ("moment_r2",))
WEDGED = Row(coulomb.jammed_status, ("jam_status",), ("leverage_status", "wedging"))
FROM_GROUND, FROM_GUIDE = between_rows("ground_cos", "ground_sin"), between_rows("upright_cos", "upright_sin")
GROUND_PIN = Row(planar.along, ("Dx", "Dy"), ("ground_length", "ground_cos", "ground_sin"))
OF_ROCKER = (
    GROUND_PIN,
    Row(planar.identity, ("velocity_ratio",), ("ratio4",)),
    Row(advantage.torque_ratio, ("torque_ratio",)),
)
RATIOS_OF_ROCKER = (
    Quantity("velocity_ratio", "1", "angular velocity of the rocker per that of the crank"),
    Quantity("torque_ratio", "1", "torque that the rocker gives per torque on the crank, without any losses"),
)
ADVANTAGE = ("mechanical_advantage",)

RRR = OnCrank(
    drives={
        "crank": CRANK,
        "coupler": _of_rrr(3, "coupler", ("r4x", "r4y", "N4"), "rocker_length", dyad_rrr.rrr_coupler_torque),
        "rocker": _of_rrr(4, "rocker", ("r3x", "r3y", "moment_r3"), "coupler_length", dyad_rrr.rrr_rocker_torque),
    },
    rows=(
        *OF_ROCKER,
        Row(advantage.mechanical_advantage, ADVANTAGE, ("velocity_ratio", "crank_length", "rocker_length")),
    ),
    quantities=(
        *RATIOS_OF_ROCKER,
        Quantity(*ADVANTAGE, "1", "force across the rocker at C per force across the crank at B"),
    ),
    between=FROM_GROUND,
)
"""Coupler 3 and rocker 4; a rocker that is driven, or a coupler, may stand still."""

FROM_CRANK = ("inverse_crank_along", "crank_across", "moment_r2", "Q4x", "Q4y", "guide_cos", "guide_sin", "direction")
RRP = OnCrank(
    drives={
        "crank": CRANK,
        "coupler": Driven(
            drive_torque("T13", "coupler"),
            "omega3",
            (
                Row(slider_crank.inverse_lever, ("inverse_crank_along",)),
                MOMENT_ON_CRANK,
                Row(
                    slider_crank.guide_force,
                    ("normal_force", "friction_force", "wedging", "rod_force_across", "rod_force_along"),
                    FROM_CRANK,
                ),
                Row(slider_crank.torque_on_rod, ("T13",)),
                *_status("crank_along", ("crank_length", 1.0), WEDGED),
            ),
        ),
    },
    rows=(
        Row(slider_crank.work_on_crank, ("work",)),
        Row(planar.identity, ("velocity_ratio",), ("ratio_slider",)),
        Row(advantage.mechanical_advantage, ADVANTAGE, ("velocity_ratio", "crank_length", 1.0)),
    ),
    quantities=(
        Quantity("T14", "N m", "moment of the guide on the slider about C, positive counter-clockwise"),
        Quantity("normal_force", "N", "force of the guide on the slider across it, positive to the guide's left"),
        Quantity("friction_force", "N", "force of the guide on the slider along it"),
        Quantity("friction_power", "W", "power of friction on the slider, never positive"),
        Quantity("velocity_ratio", "m rad-1", "velocity of the slider per angular velocity of the crank"),
        Quantity(*ADVANTAGE, "1", "force of the slider per force on the crank at B square to it"),
    ),
    between=FROM_GUIDE,
)
"""Rod 3 and slider 4."""

WORK = ("N2", "N3", "N4", "Q3x", "Q3y", "r2x", "r2y", "ratio4", "ratio4")
LINE = ("r3x", "r3y")
ON_ROCKER, ON_BLOCK = ("normal_arm4", "line_arm4"), ("normal_arm3", "line_arm3")
RPR = OnCrank(
    drives={
        "crank": CRANK,
        "rocker": Driven(
            drive_torque("T14", "rocker"),
            "omega4",
            (
                MOMENT_ON_CRANK,
                Row(planar.cross, ("crank_across",), ("r2x", "r2y", *LINE)),
                Row(inverted_slider_crank.contact_force_from_crank, ("F43n", "friction_force", "wedging")),
                _ratio("ratio4", "crank_along", ("crank_length", 1.0)),
                Row(crank_driven.balancing_drive, ("T14",), ("work", "driven_ratio")),
                *_status("crank_along", ("crank_length", 1.0), WEDGED),
            ),
        ),
        "cylinder": Driven(
            Quantity("cylinder_force", "N", "force of the cylinder on the block along the line, positive as slide"),
            "slide_velocity",
            (
                Row(crank_driven.work_on_crank, ("work_of_loads",), WORK),
                _ratio("ratio_slide", "slide_leverage", ("crank_length", "ground_length")),
                Row(crank_driven.balancing_drive, ("line_force",), ("work_of_loads", "driven_ratio")),
                Row(inverted_slider_crank.normal_force_on_block, ("F43n",)),
                Row(coulomb.friction, ("friction_force",), ("F43n", "direction")),
                Row(inverted_slider_crank.cylinder_force, ("cylinder_force",)),
                *_status("slide_leverage", ("crank_length", "ground_length")),
            ),
        ),
    },
    rows=(
        *OF_ROCKER,
        Row(planar.direction, ("theta4",), LINE),
        Row(planar.identity, ("theta3",), ("theta4",)),
        Row(inverted_slider_crank.slide_arms, ON_ROCKER, ("DBx", "DBy", "rG4x", "rG4y", *LINE)),
        Row(inverted_slider_crank.slide_arms, ON_BLOCK, (0.0, 0.0, "rG3x", "rG3y", *LINE)),
        Row(inverted_slider_crank.contact_arm, ("contact_F43_on4",), ("F43n", "direction", *ON_ROCKER)),
        Row(inverted_slider_crank.contact_arm, ("contact_F43_on3",), ("F43n", "direction", *ON_BLOCK)),
    ),
    quantities=(
        Quantity("theta3", "degree", "angle of the block, the rocker's"),
        Quantity("theta4", "degree", "direction of the rocker's line from x, counter-clockwise, in (-180, 180]"),
        Quantity("F43n", "N", "force of the rocker on the block across its line, positive to the line's left"),
        Quantity("T43", "N m", "moment of the rocker on the block about B, positive counter-clockwise"),
        Quantity("friction_force", "N", "friction of the rocker on the block along its line"),
        Quantity("friction_power", "W", "power of friction in the slide, never positive"),
        *RATIOS_OF_ROCKER,
    ),
    between=FROM_GROUND,
)
"""Block 3 and rocker 4. A cylinder along the rocker's line overcomes friction: it takes no part in the contact."""
