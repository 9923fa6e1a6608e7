"""The inverted slider-crank: crank 2 (A-B), block 3 on its pin B, rocker 4 about D, along which the block slides."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from linksweep.base.fields import of_kind, parameter
from linksweep.base.validate import Number
from linksweep.engine.quantity import Table
from linksweep.mechanisms.balance import first_moment
from linksweep.mechanisms.drawing import Block, Carrier, Drawing, Frame, ground_pins
from linksweep.mechanisms.limits import inverted_slider_crank_limits as limits
from linksweep.mechanisms.limits.finding import Checks
from linksweep.mechanisms.links import LINK, AnyLink, cg_parameters, link_parameters
from linksweep.mechanisms.mechanism import Mechanism, reach_problems, register
from linksweep.mechanisms.rows.bodies import Body, Equation, newton_euler_equations
from linksweep.mechanisms.rows.crank import BRANCH, BRANCH_SIGN, STATUS_OF_SLIDER, frame_parameters, in_range, turned
from linksweep.mechanisms.rows.inverted_slider_crank_rows import BODIES, DRIVES, JOURNALS, PINS, table
from linksweep.mechanisms.rows.load_forms import Form
from linksweep.mechanisms.rows.pins import Journals, Pins, rotating
from linksweep.mechanisms.strokes import Stroke, block_stroke

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
class InvertedSliderCrank(Mechanism):
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
    roles: ClassVar[tuple[str, ...]] = ("crank", "block", "rocker")
    pins: ClassVar[Pins] = rotating(PINS)
    journals: ClassVar[Journals] = JOURNALS
    bodies: ClassVar[tuple[Body, ...]] = BODIES
    status_meanings: ClassVar[tuple[str, ...]] = STATUS_OF_SLIDER
    title: ClassVar[str] = "Inverted slider-crank"
    drawing: ClassVar[Drawing] = Drawing(
        joints={name.removesuffix(" (at B)"): links for name, links in PINS.items()},
        journals=JOURNALS,
        frames={2: Frame("crank, A→B", "theta2"), 3: ROCKER, 4: ROCKER},
        bars={2: ("A", "B")},
        moving=("B",),
        fixed=ground_pins,
        carrier=Carrier("rocker", 4, "D"),
        blocks=(Block(3, "B", ROCKER, on=(4, "D")),),
        acts_at={"slide": "B"},
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

    def table(self, drive: str, loads: tuple[Form, ...]) -> Table:
        return table(drive, loads, turned(self.ground_angle))

    def kinematics(self) -> tuple[str, ...]:
        return ("theta4", "omega4", "alpha4", "slide", "slide_velocity", "slide_acceleration")

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

    def kinks(self) -> tuple[str, ...]:
        """Return the normal force: friction has a kink where it changes sides."""
        return ("F43n",) if np.any(self.friction) else ()

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

    def peak_quantities(self, drive: str) -> tuple[str, ...]:
        return ("F12", "F32", "F43", "F14", "T43", self.drives[drive])
