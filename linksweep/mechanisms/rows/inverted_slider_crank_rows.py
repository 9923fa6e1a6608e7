"""Rows of the inverted slider-crank: the physics function that computes each of its quantities."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

from linksweep.engine.quantity import Quantity, Row, Table, Total
from linksweep.mechanisms.dyads import rpr
from linksweep.mechanisms.rows import bodies
from linksweep.mechanisms.rows.crank import between_rows, near_toggle_rows, straight_rows
from linksweep.mechanisms.rows.load_forms import Form
from linksweep.mechanisms.rows.whole_machine import machine_quantities, machine_rows, power_rows
from linksweep.physics import advantage, coulomb, crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import dyad_rpr, inverted_slider_crank

LINKS = {1: "ground", 2: "crank", 3: "block", 4: "rocker"}
PINS = {"A": (1, 2), "B": (3, 2), "slide (at B)": (4, 3), "D": (1, 4)}
JOURNALS = {"A": 2, "B": 2, "D": 4}
BODIES = (
    bodies.CRANK,
    bodies.on_crank_pin(3, "block", "ratio4", "slope4"),
    bodies.Body(4, "rocker", pin_position=("Dx", "Dy"), ratio="ratio4", slope="slope4"),
)


class Drive(NamedTuple):
    """A way to drive: its unknown; the rate of the driven part, and that per rate of the crank; the leverage, which
    vanishes where the part stands still, with the two lengths whose product is its largest value."""

    unknown: Quantity
    rate: str
    ratio: bodies.Source
    leverage: tuple[bodies.Source, ...] = ()


DRIVES = {
    "crank": Drive(bodies.drive_torque("T12", "crank"), "omega2", 1.0),
    "rocker": Drive(bodies.drive_torque("T14", "rocker"), "omega4", "ratio4", ("crank_along", "crank_length", 1.0)),
    "cylinder": Drive(
        Quantity("cylinder_force", "N", "force of the cylinder on the block along the line, positive as slide"),
        "slide_velocity",
        "ratio_slide",
        ("slide_leverage", "crank_length", "ground_length"),
    ),
}


@lru_cache(maxsize=64)
def table(drive: str, loads: tuple[Form, ...], turned: bool) -> Table:
    """Return the table for a drive, loads of these forms, and a frame line that may be turned."""
    rows = [
        *(near_toggle_rows("ground") if turned else straight_rows("cos2", "sin2")),
        *bodies.crank_pin_rows(),
        *_position(),
        *_rates(),
        *_forces(drive),
        *power_rows(DRIVES[drive].unknown.name, DRIVES[drive].rate, BODIES, loads, "friction_power"),
        Row(planar.product, ("friction_power",), ("friction_force", "slide_velocity")),
    ]
    rows += machine_rows(BODIES, PINS, loads, **rpr.CERTAIN_ON_CRANK) + _transmission()
    rows += [*bodies.arm_rows(2, "R12", "R32"), *_arms()]
    return Table("theta2", tuple(rows), tuple(_quantities(drive, loads)), between_rows("ground_cos", "ground_sin"))


def _arms() -> list[Row | Total]:
    """Return rows of the arms from the centres of gravity of block and rocker to their pins and to the slide at B."""
    line, block_arms = ("r3x", "r3y"), ("block_normal_arm", "block_line_arm")
    return [
        *bodies.arm_rows(3, "R23"),
        *bodies.arm_rows(4, "R14"),
        Row(inverted_slider_crank.slide_arms, ("normal_arm", "line_arm"), ("DBx", "DBy", "rG4x", "rG4y", *line)),
        Row(inverted_slider_crank.slide_arms, block_arms, (0.0, 0.0, "rG3x", "rG3y", *line)),
        Row(inverted_slider_crank.contact_direction, ("contact_x", "contact_y")),
        Row(inverted_slider_crank.contact_arm, ("contact_arm",)),
        Row(inverted_slider_crank.contact_arm, ("block_contact_arm",), ("F43n", "direction", *block_arms)),
    ]


def _position() -> list[Row | Total]:
    return [
        Row(inverted_slider_crank.near_toggle_width, ("near_toggle_near",)),
        Row(planar.identity, ("near_toggle_far",), (1.0,)),
        Row(inverted_slider_crank.toggle_cosine, ("toggle_cos", "toggle_cos_lo")),
        Row(inverted_slider_crank.versine, ("psi_versine",)),
        Row(inverted_slider_crank.block_from_rocker_pivot, ("DBx", "DBy")),
        Row(inverted_slider_crank.slide_cosine, ("slide_cosine",)),
        Row(inverted_slider_crank.slide_squared, ("slide_squared",)),
        Row(inverted_slider_crank.slide_leverage, ("slide_leverage",)),
        Row(inverted_slider_crank.closure_noise, ("noise",)),
        Row(inverted_slider_crank.assembly, ("assembly",)),
        Row(dyad_rpr.rpr_close, ("slide", "inverse_slide", "r3x", "r3y")),
        Row(dyad_rpr.rpr_transmission_angle, ("transmission_angle",)),
        Row(planar.along, ("r4x", "r4y"), ("rocker_length", "r3x", "r3y")),
        Row(planar.dot, ("crank_along",), ("r2x", "r2y", "r3x", "r3y")),
        Row(planar.direction, ("theta4",), ("r3x", "r3y")),
        Row(planar.identity, ("theta3",), ("theta4",)),
        Row(planar.along, ("Dx", "Dy"), ("ground_length", "ground_cos", "ground_sin")),
    ]


def _rates() -> list[Row | Total]:
    return [
        Row(dyad_rpr.rpr_velocity_ratios, ("ratio4", "ratio_slide")),
        Row(planar.product, ("omega4",), ("omega2", "ratio4")),
        Row(planar.identity, ("omega3",), ("omega4",)),
        Row(planar.product, ("slide_velocity",), ("omega2", "ratio_slide")),
        Row(dyad_rpr.rpr_accelerations, ("alpha4", "slide_acceleration")),
        Row(planar.identity, ("alpha3",), ("alpha4",)),
    ]


def _transmission() -> list[Row | Total]:
    """Return rows of the ratios of the rocker's velocity and torque to the crank's, and of their slopes."""
    line = ("ratio4", "slide", "ratio_slide", "inverse_slide", "offset", "r3x", "r3y")
    return [
        Row(dyad_rpr.rpr_accelerations, ("slope4", "slope_slide"), ("uBx_slope", "uBy_slope", *line)),
        Row(planar.identity, ("velocity_ratio",), ("ratio4",)),
        Row(advantage.torque_ratio, ("torque_ratio",)),
    ]


def _forces(drive: str) -> list[Row | Total]:
    """Return rows of the contact forces, by the moment equations without the drive, and of the others, by addition.

    Torque or force of the drive come from virtual work, in which block and rocker turn together.
    """
    unknown, _, ratio, leverage = DRIVES[drive]
    work = ("N2", "N3", "N4", "Q3x", "Q3y", "r2x", "r2y", "ratio4", "ratio4")
    return [
        Row(crank_driven.moment_on_crank, ("moment_r2",)),
        Row(inverted_slider_crank.slide_direction, ("direction",)),
        Row(crank_driven.work_on_crank, ("work_of_loads",), work),
        Row(inverted_slider_crank.work_with_friction, ("work",)),
        *_contact(drive),
        Row(planar.opposite, ("T43",), ("N3",)),
        Row(planar.to_ground_axes, ("F43x", "F43y"), ("line_force", "F43n", 1.0, "r3x", "r3y")),
        Row(crank_driven.coupler_balance, ("F32x", "F32y")),
        Row(crank_driven.rocker_balance, ("F14x", "F14y")),
        Row(crank_driven.crank_balance, ("F12x", "F12y")),
        *_driven_ratio(drive),
        *_drive(drive, unknown.name, "driven_ratio" if leverage else ratio),
        *_status(drive),
    ]


def _driven_ratio(drive: str) -> list[Row]:
    """Return the row of the driven part's rate per rate of the crank, if that can vanish."""
    _, _, ratio, leverage = DRIVES[drive]
    return [Row(crank_driven.away_from_dead_centre, ("driven_ratio",), (ratio, *leverage))] if leverage else []


def _contact(drive: str) -> list[Row]:
    """Return rows of the slide's normal force and friction; with a cylinder, friction changes no other force."""
    forces = ("F43n", "friction_force", "wedging")
    if drive == "cylinder":
        return [
            Row(inverted_slider_crank.normal_force_on_block, ("F43n",)),
            Row(coulomb.friction, ("friction_force",), ("F43n", "direction")),
        ]
    if drive == "rocker":
        return [
            Row(planar.cross, ("crank_across",), ("r2x", "r2y", "r3x", "r3y")),
            Row(inverted_slider_crank.contact_force_from_crank, forces),
        ]
    return [Row(inverted_slider_crank.contact_force, forces)]


def _drive(drive: str, unknown: str, ratio: bodies.Source) -> list[Row]:
    """Return rows of the drive's unknown and of the force along the line: friction, or the balance with a cylinder."""
    if drive == "cylinder":
        return [
            Row(crank_driven.balancing_drive, ("line_force",), ("work_of_loads", ratio)),
            Row(inverted_slider_crank.cylinder_force, (unknown,)),
        ]
    return [
        Row(planar.identity, ("line_force",), ("friction_force",)),
        Row(crank_driven.balancing_drive, (unknown,), ("work", ratio)),
    ]


def _status(drive: str) -> list[Row | Total]:
    """Return rows of the status: closure, then leverage of the drive, then jamming, which a cylinder overcomes."""
    leverage = DRIVES[drive].leverage
    closed = Row(dyad_rpr.rpr_status, ("closure",))
    if drive == "cylinder":
        return [closed, Row(crank_driven.drive_status, ("status",), ("closure", *leverage))]
    moves = Row(planar.identity, ("leverage_status",), ("closure",))
    if leverage:
        moves = Row(crank_driven.drive_status, ("leverage_status",), ("closure", *leverage))
    return [closed, moves, Row(coulomb.jammed_status, ("status",), ("leverage_status", "wedging"))]


def _quantities(drive: str, loads: tuple[Form, ...]) -> list[Quantity]:
    return [
        Quantity("theta3", "degree", "angle of the block, the rocker's"),
        Quantity("theta4", "degree", "direction of the rocker's line from x, counter-clockwise, in (-180, 180]"),
        Quantity("transmission_angle", "degree", "acute angle between the line D-B and the normal force on the rocker"),
        Quantity("slide", "m", "position of the block along the rocker's line, from the foot of D on it"),
        Quantity("slide_velocity", "m s-1", "velocity of the block along the rocker's line, relative to the rocker"),
        Quantity("slide_acceleration", "m s-2", "acceleration of the block along the rocker's line, relative to it"),
        Quantity("F43n", "N", "force of the rocker on the block across its line, positive to the line's left"),
        Quantity("T43", "N m", "moment of the rocker on the block about B, positive counter-clockwise"),
        *bodies.position_quantities("B"),
        Quantity("friction_force", "N", "friction of the rocker on the block along its line"),
        Quantity("friction_power", "W", "power of friction in the slide, never positive"),
        *bodies.drive_quantities(DRIVES[drive].unknown, "drive, friction, loads, gravity and inertia"),
        Quantity("velocity_ratio", "1", "angular velocity of the rocker per that of the crank"),
        Quantity("torque_ratio", "1", "torque that the rocker gives per torque on the crank, without any losses"),
        *machine_quantities(BODIES, PINS, LINKS, loads),
    ]
