"""The inverted slider-crank: crank 2 (A-B), block 3 on its pin B, rocker 4 about D, along which the block slides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, ClassVar, NamedTuple

import numpy as np

from linksweep.base.fields import of_kind, parameter
from linksweep.base.validate import Number
from linksweep.chains.chain import Own
from linksweep.chains.rows.bodies import Equation, Source, arm_rows, drive_torque, newton_euler_equations
from linksweep.chains.rows.crank import BRANCH, BRANCH_SIGN, between_rows, frame_parameters, in_range, turned
from linksweep.chains.rows.load_forms import Form
from linksweep.chains.shape import Shape
from linksweep.chains.topology import Topology, topology_of
from linksweep.engine.quantity import Quantity, Row
from linksweep.mechanisms.balance import first_moment
from linksweep.mechanisms.drawing import Block, Carrier, Drawing, Frame, ground_pins
from linksweep.mechanisms.limits import inverted_slider_crank_limits as limits
from linksweep.mechanisms.limits.finding import Checks
from linksweep.mechanisms.linkage_drawing import drawing_of
from linksweep.mechanisms.links import LINK, AnyLink, cg_parameters, link_parameters
from linksweep.mechanisms.machine import Machine
from linksweep.mechanisms.mechanism import reach_problems, register
from linksweep.mechanisms.strokes import Stroke, block_stroke
from linksweep.physics import advantage, coulomb, crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import inverted_slider_crank

TOPOLOGY = topology_of("crank A-B, block B on slide, rocker D-E", ("A", "D"), (("slide", "rocker"),))


class Drive(NamedTuple):
    """A way to drive: its unknown; the rate of the driven part, and that per rate of the crank; the leverage, which
    vanishes where the part stands still, with the two lengths whose product is its largest value."""

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

ROCKER = Frame("rocker", "theta4")
BLOCK_LENGTH = 1.0
"""Unit length of the block's axes, which lie along and across the rocker's line."""
SLIDE_FORCES = {
    "F43n": ("contact_x", "contact_y", "block_contact_arm", "contact_arm"),
    "cylinder_force": ("r3x", "r3y", "block_line_arm", "line_arm"),
}
"""Names of components and moments per unit of a force on the block at B: x, y, and the moments about the centres of
gravity of block and rocker. cylinder_force acts along (r3x, r3y), F43n across it together with its friction."""


@register
@dataclass(frozen=True, eq=False, repr=False)
class InvertedSliderCrank(Machine):
    """An inverted slider-crank: a shaper's quick-return, Whitworth's, a cylinder-driven rocker.

    Parameters
    ----------
    crank : Link, Bar or Disk
        Driven link; its first pin is A, and the block turns on its second, B.
    rocker : Link, Bar or Disk
        Link along which the block slides; its first pin is D. Its centre of gravity and its loads are polar from D and
        the direction of sliding; its length is a reference on which no result depends.
    ground : float or DataArray
        Distance A-D [m].
    block_mass : float or DataArray
        Mass of the block [kg].
    block_inertia : float or DataArray, default 0.0
        Moment of inertia of the block about its centre of gravity [kg m²]; the block turns with the rocker.
    offset : float or DataArray, default 0.0
        Distance of the line of sliding from D, to the left of the rocker's direction [m], of either sign.
    branch : str, default "open"
        Assembly: "open" (B ahead of D along the rocker), "crossed" (behind), or "both" (adds the dimension `branch`).
    ground_angle : float or DataArray, default 0.0
        Direction of the line A→D to x [degree].
    block_cg_distance : float or DataArray, default 0.0
        Distance of the block's centre of gravity from B [m].
    block_cg_angle : float or DataArray, default 0.0
        Angle of that centre of gravity from the rocker's direction, counter-clockwise [degree].
    friction : float or DataArray, default 0.0
        Coefficient of Coulomb friction between rocker and block [1].

    Raises
    ------
    ValueError
        One line for each parameter out of bounds, and for lengths that cannot be joined at any crank angle.

    Notes
    -----
    A load on "block" acts at a point from B, in axes along and across the rocker's line.

    The contact of rocker and block is a normal force F43n through B and a moment T43. In the nine unknowns they take
    the place of F43x, F43y, which are computed besides. Friction, −μ·|F43n|·sign(slide_velocity) on the
    block along the line, takes the size of the normal force alone: the moment T43, two more normal forces at the ends
    of the block, brings no friction of its own. It wedges where μ·|e/slide| ≥ 1, e the offset; with drive="rocker"
    where μ·|tan ψ| ≥ 1, ψ the angle of the crank to the line: status `jammed` where no force moves it on,
    `jammed_two_solutions` where the rocker may press on either side. A cylinder overcomes friction everywhere.

    With drive="cylinder" the rocker is the barrel and the block the end of the rod: the unknown is the cylinder's force
    `cylinder_force` on the block along the rocker's line, positive in the direction of slide (branch="open": positive
    pushes B away from D), the opposite on the rocker. F43x, F43y are then all that the barrel does to the rod, the
    cylinder's force, friction and the side load F43n, T43 of its bushes; torques on crank and rocker are known loads.
    At the dead centres, with the crank in line with A-D, the cylinder cannot drive.

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

    crank: AnyLink = of_kind(LINK)
    rocker: AnyLink = of_kind(LINK)
    ground: Number = parameter("length", above=0.0)
    block_mass: Number = parameter("mass", at_least=0.0)
    block_inertia: Number = parameter("inertia", 0.0, at_least=0.0)
    offset: Number = parameter("length", 0.0)
    branch: str = of_kind(BRANCH, "open")
    ground_angle: Number = parameter("angle", 0.0)
    block_cg_distance: Number = parameter("length", 0.0, at_least=0.0, polar=True)
    block_cg_angle: Number = parameter("angle", 0.0)
    friction: Number = parameter("dimensionless", 0.0, at_least=0.0)

    drives: ClassVar[dict[str, str]] = {word: drive.unknown.name for word, drive in DRIVES.items()}
    topology: ClassVar[Topology] = TOPOLOGY
    title: ClassVar[str] = "Inverted slider-crank"
    drawing: ClassVar[Drawing] = replace(
        drawing_of(TOPOLOGY),
        joints={"A": (1, 2), "B": (3, 2), "slide": (4, 3), "D": (1, 4)},
        frames={2: Frame("crank, A→B", "theta2"), 3: ROCKER, 4: ROCKER},
        bars={2: ("A", "B")},
        moving=("B",),
        fixed=ground_pins,
        carrier=Carrier("rocker", 4, "D"),
        blocks=(Block(3, "B", ROCKER, on=(4, "D")),),
        ideal={"friction": 0.0},
    )

    def lengths(self) -> tuple[Number, Number, Number]:
        """Return the lengths that alone decide the motion.

        Returns
        -------
        tuple of float or DataArray
            Crank, ground and offset [m].
        """
        return self.crank.length, self.ground, self.offset

    def closure_problems(self) -> list[str]:
        """Return why a single design cannot be assembled: the offset is beyond the reach of crank and ground."""
        a, d, e = self.lengths()
        return reach_problems(e, a, d, "crank + ground")

    def parameters(self) -> dict[str, Any]:
        numbers: dict[str, Any] = {
            "ground_length": self.ground,
            **frame_parameters("ground", self.ground_angle),
            "offset": self.offset,
            "block_mass": self.block_mass,
            "block_inertia": self.block_inertia,
            "branch_sign": self.branch_sign,
            "friction": self.friction,
            "block_length": BLOCK_LENGTH,
            **cg_parameters("block", self.block_cg_distance, self.block_cg_angle),
        }
        return numbers | link_parameters("crank", self.crank) | link_parameters("rocker", self.rocker)

    @property
    def near_toggle_angle(self) -> Number:
        return self.ground_angle

    @property
    def strokes(self) -> dict[str, Stroke]:
        """Position of the block along the rocker's line, or extension of a cylinder, which a load may follow."""
        return {"block.position": block_stroke(*self.lengths(), self.ground_angle, BRANCH_SIGN[self.branch])}

    @property
    def shape(self) -> Shape:
        return Shape(TOPOLOGY, turned=frozenset({"rocker"} if turned(self.ground_angle) else ()), plain=True)

    def own(self, drive: str, loads: tuple[Form, ...]) -> Own:
        return _own(drive)

    def unknowns(self, drive: str) -> tuple[str, ...]:
        """Return the nine unknowns of the 9×9: the contact of rocker and block as normal force and moment."""
        return ("F12x", "F12y", "F32x", "F32y", "F43n", "T43", "F14x", "F14y", self.drives[drive])

    def dynamics(self, drive: str) -> tuple[str, ...]:
        return (*self.unknowns(drive), "F43x", "F43y")

    def equations(self, drive: str) -> tuple[Equation, ...]:
        """Return the 9×9: the rows of document 2 (ME 470), the slide's forces along and across its line (r3x, r3y)."""
        torque = {drive: self.drives[drive]}.get
        crank = newton_euler_equations(2, {"F12": (1.0, "R12"), "F32": (1.0, "R32")}, torque("crank"))
        block = newton_euler_equations(3, {"F32": (-1.0, "R23")}, "T43")
        rocker = newton_euler_equations(4, {"F14": (1.0, "R14")}, torque("rocker"))
        rocker[2].coefficients["T43"] = -1.0
        for force in (name for name in self.unknowns(drive) if name in SLIDE_FORCES):
            x, y, about_block, about_rocker = SLIDE_FORCES[force]
            for row, name in zip(block, (x, y, about_block), strict=True):
                row.coefficients[force] = (1.0, name)
            for row, name in zip(rocker, (x, y, about_rocker), strict=True):
                row.coefficients[force] = (-1.0, name)
        return (*crank, *block, *rocker)

    def findings(self) -> Checks:
        lengths = self.lengths()
        return (limits.classes, lengths), (limits.angles, (*lengths, self.ground_angle)), *self.stroke_findings()

    def stroke_findings(self) -> Checks:
        """Return the closed forms of the rocker's swing, time ratio and reversals."""
        return (limits.swings, self.lengths()), (limits.reversals, (*self.lengths(), self.ground_angle))

    def balancing_moments(self, fraction: Number) -> dict[str, Any]:
        """Return the first moments that crank and rocker lack for the centre of gravity to stand still."""
        rocker_and_block = first_moment(self.rocker) + self.masses()["block"].first_moment()
        crank = first_moment(self.crank) + self.block_mass * self.crank.length
        return {"crank": -crank, "rocker": -rocker_and_block}

    def dead_centre_findings(self, drive: str) -> Checks:
        """Return the check for angles at which the block stands still on its line, or the rocker turns round."""
        checks = {"cylinder": limits.dead_centres, "rocker": limits.rocker_dead_centres}
        return ((checks[drive], (*self.lengths(), self.ground_angle)),) if drive in checks else ()

    def driven_findings(self, motion: Mapping[str, Any]) -> Checks:
        """Return also the check for wedging, by the moment equations without the drive; a cylinder overcomes it."""
        of_drive, numbers = super().driven_findings(motion), (*self.lengths(), self.ground_angle, self.friction)
        wedges = {"crank": limits.wedging, "rocker": limits.wedging_by_crank}
        return (*of_drive, *((wedges[drive], numbers) for drive in wedges if drive == motion["drive"]))

    def jumps(self) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which friction jumps: where the block turns round on its line."""
        if not np.any(self.friction):
            return ()
        a, d, e = self.lengths()
        near, far = (np.where(abs(e) < reach, 0.0, np.nan) for reach in (abs(d - a), d + a))
        return self.ground_angle + near, self.ground_angle + 180.0 + far

    def always_ok(self, drive: str) -> bool:
        """Return whether the numbers alone ensure status 0 at every sample, friction included."""
        a, d, e = self.lengths()
        nearest = abs(d - a)
        with np.errstate(over="ignore"):
            wedges = np.square(self.friction * e) >= (nearest - e) * (nearest + e) * (1.0 - 1e-9)
        return super().always_ok(drive) and not np.any(wedges)

    @cached_property
    def closes_everywhere(self) -> bool:
        a, d, e = self.lengths()
        return bool(in_range(a) and in_range(d) and np.all(abs(d - a) - abs(e) > 1e-9 * (a + d)))


@lru_cache
def _own(drive: str) -> Own:
    """Return a drive, the arms of the slide's forces, and the ratios of the rocker's velocity and torque.

    Torque or force of the drive come from virtual work, in which block and rocker turn together.
    """
    unknown, rate, ratio, leverage = DRIVES[drive]
    loads = ("N2", "N3", "N4", "Q3x", "Q3y", "r2x", "r2y", "ratio4", "ratio4")
    driven_ratio = [Row(crank_driven.away_from_dead_centre, ("driven_ratio",), (ratio, *leverage))] if leverage else []
    rows = (
        Row(planar.direction, ("theta4",), ("r3x", "r3y")),
        Row(planar.identity, ("theta3",), ("theta4",)),
        Row(planar.along, ("Dx", "Dy"), ("ground_length", "ground_cos", "ground_sin")),
        Row(crank_driven.moment_on_crank, ("moment_r2",)),
        Row(crank_driven.work_on_crank, ("work_of_loads",), loads),
        *_contact(drive),
        *driven_ratio,
        *_unknown(drive, unknown.name, "driven_ratio" if leverage else ratio),
        *_status(drive, leverage),
        *ARMS,
        Row(planar.identity, ("velocity_ratio",), ("ratio4",)),
        Row(advantage.torque_ratio, ("torque_ratio",)),
    )
    return Own(unknown, rate, rows, QUANTITIES, between_rows("ground_cos", "ground_sin"))


def _contact(drive: str) -> list[Row]:
    """Return rows of the slide's normal force and friction; with a cylinder, friction changes no other force."""
    if drive == "cylinder":
        return [
            Row(inverted_slider_crank.normal_force_on_block, ("F43n",)),
            Row(coulomb.friction, ("friction_force",), ("F43n", "direction")),
        ]
    if drive == "rocker":
        return [
            Row(planar.cross, ("crank_across",), ("r2x", "r2y", "r3x", "r3y")),
            Row(inverted_slider_crank.contact_force_from_crank, ("F43n", "friction_force", "wedging")),
        ]
    return []


def _unknown(drive: str, unknown: str, ratio: Source) -> list[Row]:
    """Return rows of the drive's unknown and, with a cylinder, of the whole force along the line."""
    if drive == "cylinder":
        return [
            Row(crank_driven.balancing_drive, ("line_force",), ("work_of_loads", ratio)),
            Row(inverted_slider_crank.cylinder_force, (unknown,)),
        ]
    return [Row(crank_driven.balancing_drive, (unknown,), ("work", ratio))]


def _status(drive: str, leverage: tuple[Source, ...]) -> list[Row]:
    """Return rows of the status: closure, then leverage of the drive, then jamming, which a cylinder overcomes."""
    if not leverage:
        return []
    moves = Row(crank_driven.drive_status, ("leverage_status",), ("closure", *leverage))
    if drive == "cylinder":
        return [moves, Row(planar.identity, ("status",), ("leverage_status",))]
    return [moves, Row(coulomb.jammed_status, ("jam_status",), ("leverage_status", "wedging"))]


LINE = ("r3x", "r3y")
ARMS = (
    *arm_rows(3, "R23"),
    *arm_rows(4, "R14"),
    Row(inverted_slider_crank.slide_arms, ("normal_arm", "line_arm"), ("DBx", "DBy", "rG4x", "rG4y", *LINE)),
    Row(
        inverted_slider_crank.slide_arms,
        ("block_normal_arm", "block_line_arm"),
        (0.0, 0.0, "rG3x", "rG3y", *LINE),
    ),
    Row(inverted_slider_crank.contact_direction, ("contact_x", "contact_y")),
    Row(inverted_slider_crank.contact_arm, ("contact_arm",)),
    Row(
        inverted_slider_crank.contact_arm,
        ("block_contact_arm",),
        ("F43n", "direction", "block_normal_arm", "block_line_arm"),
    ),
)
"""Rows of the arms of the slide's forces from the centres of gravity of block and rocker."""
QUANTITIES = (
    Quantity("theta3", "degree", "angle of the block, the rocker's"),
    Quantity("theta4", "degree", "direction of the rocker's line from x, counter-clockwise, in (-180, 180]"),
    Quantity("F43n", "N", "force of the rocker on the block across its line, positive to the line's left"),
    Quantity("T43", "N m", "moment of the rocker on the block about B, positive counter-clockwise"),
    Quantity("friction_force", "N", "friction of the rocker on the block along its line"),
    Quantity("friction_power", "W", "power of friction in the slide, never positive"),
    Quantity("velocity_ratio", "1", "angular velocity of the rocker per that of the crank"),
    Quantity("torque_ratio", "1", "torque that the rocker gives per torque on the crank, without any losses"),
)
