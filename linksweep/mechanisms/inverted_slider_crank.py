"""The inverted slider-crank: crank 2 (A-B), block 3 on its pin B, rocker 4 about D, along which the block slides."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, ClassVar, NamedTuple

import numpy as np

from linksweep.engine.quantity import Quantity, Row, Table, Total
from linksweep.mechanisms import rounding_error
from linksweep.mechanisms.actions import Form
from linksweep.mechanisms.bodies import (
    Body,
    Equation,
    Source,
    arm_rows,
    crank_pin_slope_rows,
    drive_quantities,
    drive_torque,
    newton_euler_equations,
    on_crank_pin,
    position_quantities,
)
from linksweep.mechanisms.finding import Checks
from linksweep.mechanisms.inverted_slider_crank_limits import angles, classes, dead_centres, rocker_dead_centres
from linksweep.mechanisms.links import Bar, Disk, Link, cg_parameters, link_parameters, link_problems
from linksweep.mechanisms.motion import (
    BRANCH_SIGN,
    CrankDriven,
    between_rows,
    frame_parameters,
    in_range,
    pinch_rows,
    straight_rows,
    turned,
)
from linksweep.mechanisms.pins import Journals, Pins, rotating
from linksweep.mechanisms.strokes import Stroke, block_stroke
from linksweep.mechanisms.validate import Number, parameter, problems, refuse
from linksweep.mechanisms.whole_machine import machine_quantities, machine_rows, power_rows
from linksweep.physics import advantage, crank_driven, dyad_rpr, inverted_slider_crank, planar

LINKS = {1: "ground", 2: "crank", 3: "block", 4: "rocker"}
PINS = {"A": (1, 2), "B": (3, 2), "slide (at B)": (4, 3), "D": (1, 4)}
JOURNALS = {"A": 2, "B": 2, "D": 4}
BODIES = (
    Body(2, "crank", steady=True, ratio=1.0),
    on_crank_pin(3, "block", "ratio4", "slope4"),
    Body(4, "rocker", pin_position=("Dx", "Dy"), ratio="ratio4", slope="slope4"),
)
BLOCK_LENGTH = 1.0
"""Unit of the block's axes, which lie along and across the rocker's line."""
SLIDE_FORCES = {
    "F43n": ((-1.0, "r3y"), (1.0, "r3x"), (1.0, "block_normal_arm"), (1.0, "normal_arm")),
    "cylinder_force": ((1.0, "r3x"), (1.0, "r3y"), (1.0, "block_cylinder_arm"), (1.0, "cylinder_arm")),
}
"""Of forces on the block at B, along (r3x, r3y) or across: x, y, and the moments about the centres of gravity of block
and rocker."""


class Drive(NamedTuple):
    """A way to drive: its unknown; the rate of what it drives, and that per rate of the crank; the leverage that
    vanishes where this stands still, and the two lengths whose product it is at most."""

    unknown: Quantity
    rate: str
    ratio: Source
    leverage: tuple[Source, ...] = ()


DRIVES = {
    "crank": Drive(drive_torque("T12", "crank"), "omega2", 1.0),
    "rocker": Drive(drive_torque("T14", "rocker"), "omega4", "ratio4", ("crank_along", "crank_length", 1.0)),
    "cylinder": Drive(
        Quantity("cylinder_force", "N", "force of the cylinder on the block along the line, positive as slide"),
        "slide_velocity",
        "ratio_slide",
        ("slide_leverage", "crank_length", "ground_length"),
    ),
}


@dataclass(frozen=True, eq=False)
class InvertedSliderCrank(CrankDriven):
    """An inverted slider-crank: a shaper's quick-return, Whitworth's, a cylinder-driven rocker.

    Parameters
    ----------
    crank : Link, Bar or Disk; its first pin is A, the block turns on its second, B
    rocker : Link, Bar or Disk; its first pin is D. Its line is the direction in which the block slides, its centre of
        gravity and its loads are polar from D and that direction; its length is a reference that no result depends on
    ground : distance A-D [m]
    block_mass : [kg]
    block_inertia : about its centre of gravity [kg m²]; the block turns with the rocker
    offset : distance of the line of sliding from D, to the left of the rocker's direction [m], either sign
    branch : "open" (B ahead of D along the rocker), "crossed" (behind), or "both" (adds the dimension `branch`)
    ground_angle : direction of the line A→D to x [degree]
    block_cg_distance : distance of the block's centre of gravity from B [m]
    block_cg_angle : angle of the centre of gravity from the rocker's direction, counter-clockwise [degree]

    All numbers may be DataArrays of design dims. A load on "block" acts at a point from B, in axes along and across
    the rocker's line.

    Raises
    ------
    ValueError
        One line for each parameter out of bounds, and for lengths that cannot be joined at any crank angle.

    Notes
    -----
    The contact without friction of rocker and block is a normal force F43n through B and a moment T43. Of the pin
    forces it takes the place of F43x, F43y in the nine unknowns; those are given besides.

    With drive="cylinder" the rocker is the barrel and the block the end of the rod: the unknown is the cylinder's force
    `cylinder_force` on the block along the rocker's line, positive in the direction of slide (branch="open": positive
    pushes B away from D), the opposite on the rocker. F43x, F43y are then all that the barrel does to the rod, the
    cylinder's force and the side load F43n, T43 of its bushes; torques on crank and rocker are known loads. At the dead
    centres, with the crank in line with A-D, the cylinder cannot drive.

    Examples
    --------
    >>> import linksweep as ls
    >>> crank, rocker = ls.Disk(0.12, 0.2, 0.03, 7800), ls.Link(0.7, 18.0, 0.8, cg_distance=0.35)
    >>> ls.InvertedSliderCrank(crank, rocker, ground=0.36, block_mass=1.5).branch
    'open'

    A tipper: its body, 4 t about the hinge A, is raised by a cylinder between the frame at D and the body at B.

    >>> body, barrel = ls.Link(1.8, 4000.0, 3000.0, cg_distance=2.2, cg_angle=10.0), ls.Link(1.5, 90.0, 15.0, 0.5)
    >>> tipper = ls.InvertedSliderCrank(body, barrel, ground=1.6, ground_angle=-25.0, block_mass=40.0)
    >>> scene = ls.Scene(tipper, omega2=0.05, gravity=(0.0, -9.81), drive="cylinder")
    >>> lift = ls.sweep(scene, theta2=range(51))
    >>> lift.cylinder_force.units, round(float(lift.cylinder_force[0]), -3)
    ('N', 54000.0)
    """

    crank: Link | Bar | Disk
    rocker: Link | Bar | Disk
    ground: Number = parameter("length", above=0.0)
    block_mass: Number = parameter("mass", at_least=0.0)
    block_inertia: Number = parameter("inertia", 0.0, at_least=0.0)
    offset: Number = parameter("length", 0.0)
    branch: str = "open"
    ground_angle: Number = parameter("angle", 0.0)
    block_cg_distance: Number = parameter("length", 0.0, at_least=0.0, polar=True)
    block_cg_angle: Number = parameter("angle", 0.0)

    drives: ClassVar[dict[str, str]] = {word: drive.unknown.name for word, drive in DRIVES.items()}
    links: ClassVar[tuple[str, ...]] = ("crank", "block", "rocker")
    pins: ClassVar[Pins] = rotating(PINS)
    journals: ClassVar[Journals] = JOURNALS
    bodies: ClassVar[tuple[Body, ...]] = BODIES
    status_meanings: ClassVar[tuple[str, ...]] = ("ok", "cannot_assemble", "toggle", "dead_centre")

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse(link_problems(self, "crank", "rocker") + problems(self) + self.branch_problems())
        refuse(self._never_closes())

    def lengths(self) -> tuple[Number, Number, Number]:
        """What decides how it moves: crank, ground, offset."""
        return self.crank.length, self.ground, self.offset

    def _never_closes(self) -> list[str]:
        a, d, e = self.lengths()
        if any(hasattr(number, "dims") for number in (a, d, e)) or abs(e) <= a + d:
            return []
        return [
            f"offset = {e:.15g} m is {abs(e) - a - d:.6g} m beyond the reach of crank + ground: "
            f"the mechanism cannot be assembled at any angle; reduce it or lengthen them"
        ]

    def parameters(self) -> dict[str, Any]:
        """The numbers that the physics wires by name; a Field where a dimension is the mechanism's own."""
        numbers: dict[str, Any] = {
            "ground_length": self.ground,
            **frame_parameters("ground", self.ground_angle),
            "offset": self.offset,
            "block_mass": self.block_mass,
            "block_inertia": self.block_inertia,
            "branch_sign": self.branch_sign,
            "block_length": BLOCK_LENGTH,
            **cg_parameters("block", self.block_cg_distance, self.block_cg_angle),
        }
        return numbers | link_parameters("crank", self.crank) | link_parameters("rocker", self.rocker)

    @property
    def pinch_angle(self) -> Number:
        """Crank angle [degree] about which, and opposite to which, it comes nearest to a toggle."""
        return self.ground_angle

    @property
    def strokes(self) -> dict[str, Stroke]:
        """Where the block is along the rocker's line: of a cylinder, how far it is extended."""
        return {"block.position": block_stroke(*self.lengths(), self.ground_angle, BRANCH_SIGN[self.branch])}

    def table(self, drive: str, loads: tuple[Form, ...]) -> Table:
        """All that can be computed for this drive and loads of these forms."""
        return _table(drive, loads, turned(self.ground_angle))

    def kinematics(self) -> tuple[str, ...]:
        return ("theta4", "omega4", "alpha4", "slide", "slide_velocity", "slide_acceleration")

    def unknowns(self, drive: str) -> tuple[str, ...]:
        """The nine unknowns of the 9×9: the contact of rocker and block as normal force and moment."""
        return ("F12x", "F12y", "F32x", "F32y", "F43n", "T43", "F14x", "F14y", self.drives[drive])

    def dynamics(self, drive: str) -> tuple[str, ...]:
        """What a sweep gives besides the kinematics."""
        return (*self.unknowns(drive), "F43x", "F43y")

    def equations(self, drive: str) -> tuple[Equation, ...]:
        """The 9×9: the rows of document 2 (ME 470), the slide's forces along and across its line (r3x, r3y)."""
        torque = {role: self.drives[drive] if role == drive else None for role in self.drives}
        crank = newton_euler_equations(2, {"F12": (1.0, "R12"), "F32": (1.0, "R32")}, torque["crank"])
        block = newton_euler_equations(3, {"F32": (-1.0, "R23")}, "T43")
        rocker = newton_euler_equations(4, {"F14": (1.0, "R14")}, torque["rocker"])
        rocker[2].coefficients["T43"] = -1.0
        for force in (name for name in self.unknowns(drive) if name in SLIDE_FORCES):
            x, y, about_block, about_rocker = SLIDE_FORCES[force]
            for row, entry in zip(block, (x, y, about_block), strict=True):
                row.coefficients[force] = entry
            for row, (factor, name) in zip(rocker, (x, y, about_rocker), strict=True):
                row.coefficients[force] = (-factor, name)
        return (*crank, *block, *rocker)

    def findings(self) -> Checks:
        """What can be checked in closed form, and the numbers that each takes."""
        return (classes, self.lengths()), (angles, (*self.lengths(), self.ground_angle))

    def dead_centre_findings(self, drive: str) -> Checks:
        """Where the block stands still on its line; where the rocker turns round."""
        found = {"cylinder": dead_centres, "rocker": rocker_dead_centres}
        return ((found[drive], (*self.lengths(), self.ground_angle)),) if drive in found else ()

    @cached_property
    def closes_everywhere(self) -> bool:
        """Whether every design closes at every angle with a margin that rounding cannot touch."""
        a, d, e = self.lengths()
        return bool(in_range(a) and in_range(d) and np.all(abs(d - a) - abs(e) > 1e-9 * (a + d)))

    def peak_quantities(self, drive: str) -> tuple[str, ...]:
        return ("F12", "F32", "F43", "F14", "T43", self.drives[drive])


@lru_cache(maxsize=64)
def _table(drive: str, loads: tuple[Form, ...], turned: bool) -> Table:
    rows = [
        *(pinch_rows("ground") if turned else straight_rows("cos2", "sin2")),
        *_position(),
        *_rates(),
        *_forces(drive),
        *power_rows(DRIVES[drive].unknown.name, DRIVES[drive].rate, BODIES, loads),
    ]
    rows += machine_rows(BODIES, PINS, loads) + _transmission()
    rows += [rounding_error.row(slide_cosine=1.0, pinch_versine=1.0), *arm_rows(2, "R12", "R32"), *_arms()]
    return Table("theta2", tuple(rows), tuple(_quantities(drive, loads)), between_rows("ground_cos", "ground_sin"))


def _arms() -> list[Row | Total]:
    """From the centres of gravity of block and rocker to their pins, and to the forces of the slide at B."""
    line = ("r3x", "r3y")
    return [
        *arm_rows(3, "R23"),
        *arm_rows(4, "R14"),
        Row(inverted_slider_crank.slide_arms, ("normal_arm", "cylinder_arm"), ("DBx", "DBy", "rG4x", "rG4y", *line)),
        Row(
            inverted_slider_crank.slide_arms,
            ("block_normal_arm", "block_cylinder_arm"),
            (0.0, 0.0, "rG3x", "rG3y", *line),
        ),
    ]


def _position() -> list[Row | Total]:
    return [
        Row(inverted_slider_crank.pinch_width, ("pinch_near",)),
        Row(planar.same, ("pinch_far",), (1.0,)),
        Row(crank_driven.crank_pin, ("r2x", "r2y")),
        Row(inverted_slider_crank.toggle_cosine, ("toggle_cos", "toggle_cos_rest")),
        Row(inverted_slider_crank.versine, ("pinch_versine",)),
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
        Row(planar.same, ("theta3",), ("theta4",)),
        Row(planar.vector_sum, ("Bx", "By"), (0.0, 0.0, "r2x", "r2y")),
        Row(planar.along, ("Dx", "Dy"), ("ground_length", "ground_cos", "ground_sin")),
    ]


def _rates() -> list[Row | Total]:
    return [
        Row(dyad_rpr.rpr_velocity_ratios, ("ratio4", "ratio_slide")),
        Row(planar.product, ("omega4",), ("omega2", "ratio4")),
        Row(planar.same, ("omega3",), ("omega4",)),
        Row(planar.product, ("slide_velocity",), ("omega2", "ratio_slide")),
        Row(planar.point_velocity, ("vBx", "vBy"), (0.0, 0.0, "omega2", "r2x", "r2y")),
        Row(crank_driven.crank_pin_acceleration, ("aBx", "aBy")),
        Row(dyad_rpr.rpr_accelerations, ("alpha4", "slide_acceleration")),
        Row(planar.same, ("alpha3",), ("alpha4",)),
    ]


def _transmission() -> list[Row | Total]:
    """What the rocker has of the crank's velocity and torque, and how the ratios change with the crank's angle."""
    line = ("ratio4", "slide", "ratio_slide", "inverse_slide", "offset", "r3x", "r3y")
    return [
        *crank_pin_slope_rows(),
        Row(dyad_rpr.rpr_accelerations, ("slope4", "slope_slide"), ("uBx_slope", "uBy_slope", *line)),
        Row(planar.same, ("velocity_ratio",), ("ratio4",)),
        Row(advantage.torque_ratio, ("torque_ratio",)),
    ]


def _forces(drive: str) -> list[Row | Total]:
    """The contact's normal force from the moment equations free of the drive's torque; the rest follows by addition.

    Torque or force of the drive come from virtual work, in which block and rocker turn together.
    """
    unknown, _, ratio, leverage = DRIVES[drive]
    work = ("N2", "N3", "N4", "Q3x", "Q3y", "r2x", "r2y", "ratio4", "ratio4")
    along_line = unknown.name if drive == "cylinder" else 0.0
    return [
        Row(crank_driven.moment_on_crank, ("moment_r2",)),
        _normal_force(drive, along_line),
        Row(planar.opposite, ("T43",), ("N3",)),
        Row(planar.turned, ("F43x", "F43y"), (along_line, "F43n", 1.0, "r3x", "r3y")),
        Row(crank_driven.coupler_balance, ("F32x", "F32y")),
        Row(crank_driven.rocker_balance, ("F14x", "F14y")),
        Row(crank_driven.crank_balance, ("F12x", "F12y")),
        Row(crank_driven.work_on_crank, ("work",), work),
        *_driven_ratio(drive),
        Row(crank_driven.balancing_drive, (unknown.name,), ("work", "driven_ratio" if leverage else ratio)),
        *_status(drive),
    ]


def _driven_ratio(drive: str) -> list[Row]:
    """The driven part's rate per rate of the crank, where there is one that can vanish."""
    _, _, ratio, leverage = DRIVES[drive]
    return [Row(crank_driven.away_from_dead_centre, ("driven_ratio",), (ratio, *leverage))] if leverage else []


def _normal_force(drive: str, along_line: Source) -> Row:
    if drive == "rocker":
        return Row(inverted_slider_crank.normal_force_from_crank, ("F43n",))
    moments = ("N3", "N4", "inverse_slide", "offset", along_line)
    return Row(inverted_slider_crank.normal_force_on_block, ("F43n",), moments)


def _status(drive: str) -> list[Row | Total]:
    leverage = DRIVES[drive].leverage
    if not leverage:
        return [Row(dyad_rpr.rpr_status, ("status",))]
    return [
        Row(dyad_rpr.rpr_status, ("closure",)),
        Row(crank_driven.drive_status, ("status",), ("closure", *leverage)),
    ]


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
        *position_quantities("B"),
        *drive_quantities(DRIVES[drive].unknown),
        Quantity("velocity_ratio", "1", "angular velocity of the rocker per that of the crank"),
        Quantity("torque_ratio", "1", "torque that the rocker gives per torque on the crank, without any losses"),
        *machine_quantities(BODIES, PINS, LINKS, loads),
    ]
