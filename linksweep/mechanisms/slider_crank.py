"""The slider-crank: crank 2 (A-B), rod 3 (B-C), slider 4 at C on a guide of the ground 1."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np

from linksweep.engine.quantity import Quantity, Row, Table, Total
from linksweep.mechanisms import rounding_error
from linksweep.mechanisms.actions import Form
from linksweep.mechanisms.bodies import (
    Body,
    Equation,
    arm_rows,
    crank_pin_slope_rows,
    drive_quantities,
    drive_torque,
    newton_euler_equations,
    on_crank_pin,
    position_quantities,
)
from linksweep.mechanisms.degrees import cos_sin_rests
from linksweep.mechanisms.finding import Checks
from linksweep.mechanisms.links import Bar, Disk, Link, cg_parameters, link_parameters, link_problems
from linksweep.mechanisms.motion import (
    BRANCH_SIGN,
    CrankDriven,
    between_rows,
    in_range,
    pinch_rows,
    straight_rows,
    turned,
)
from linksweep.mechanisms.pins import Pins, rotating
from linksweep.mechanisms.slider_crank_limits import (
    angles,
    classes,
    rod_dead_centres,
    slider_dead_centres,
    wedging,
    wedging_by_crank,
)
from linksweep.mechanisms.strokes import Stroke, slider_strokes
from linksweep.mechanisms.validate import Number, parameter, problems, refuse
from linksweep.mechanisms.whole_machine import machine_quantities, machine_rows, power_rows
from linksweep.physics import advantage, crank_driven, dyad_rrp, planar, slider_crank

LINKS = {1: "ground", 2: "crank", 3: "rod", 4: "slider"}
DRIVEN = {"crank": "omega2", "coupler": "omega3"}
UNKNOWN_FORCES = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y")
FRICTION = Equation("friction on 4", {"F14x": (1.0, "friction_row_x"), "F14y": (1.0, "friction_row_y")}, "friction_rhs")
PINS = {"A": (1, 2), "B": (3, 2), "C": (4, 3), "guide": (1, 4)}
BODIES = (
    Body(2, "crank", steady=True, ratio=1.0),
    on_crank_pin(3, "rod", "ratio3", "slope3"),
    Body(
        4,
        "slider",
        ("vCx", "vCy"),
        ("aCx", "aCy"),
        pin_position=("Cx", "Cy"),
        pin_ratio=("uCx", "uCy"),
        pin_slope=("uCx_slope", "uCy_slope"),
    ),
)
SLIDER = {
    "slider_inertia": 0.0,
    "slider_length": 1.0,
    "omega4": 0.0,
    "alpha4": 0.0,
}
"""The slider as a body that does not turn, so that any inertia would do; its axes lie along and across the guide."""


@dataclass(frozen=True, eq=False)
class SliderCrank(CrankDriven):
    """A slider-crank: engine, pump, compressor.

    Parameters
    ----------
    crank, rod : Link, Bar or Disk
        Their first pins are A and B.
    slider_mass : [kg]
    offset : height of the guide over A, to the left of the guide's direction [m], either sign
    friction : coefficient of Coulomb friction between slider and guide
    branch : "open" (C ahead of B along the guide), "crossed" (behind), or "both" (adds the dimension `branch`)
    slide_angle : direction of the guide to x [degree]
    slider_cg_distance : distance of the slider's centre of gravity from its pin C [m]
    slider_cg_angle : angle of the centre of gravity from the guide's direction, counter-clockwise [degree]

    All numbers may be DataArrays of design dims. A load on "slider" acts at a point from C, in axes along and across
    the guide.

    Raises
    ------
    ValueError
        One line for each parameter out of bounds, and for lengths that cannot be joined at any crank angle.

    Notes
    -----
    Friction wedges the slider where μ·|tan ψ| ≥ 1, ψ the angle of the rod (with drive="coupler", of the crank) to the
    guide: status `jammed` where no force moves it on, `jammed_two_solutions` where the guide may press on either side
    (rigid bodies do not tell which). The slider does not turn: where its centre of gravity lies changes `T14`, the
    guide's moment on it, and the shaking moment; its moment of inertia would change nothing, and is no parameter. A
    load that is a cycle of full turns of the crank (see `GasPressure`) is none in a design whose crank does not turn
    fully: status `no_cycle`.

    Examples
    --------
    >>> import linksweep as ls
    >>> crank, rod = ls.Disk(0.045, 0.06, 0.02, 7800), ls.Link(0.15, 0.6, 2.2e-3, cg_distance=0.05)
    >>> ls.SliderCrank(crank, rod, slider_mass=0.5, friction=0.1).branch
    'open'
    """

    crank: Link | Bar | Disk
    rod: Link | Bar | Disk
    slider_mass: Number = parameter("mass", at_least=0.0)
    offset: Number = parameter("length", 0.0)
    friction: Number = parameter("dimensionless", 0.0, at_least=0.0)
    branch: str = "open"
    slide_angle: Number = parameter("angle", 0.0)
    slider_cg_distance: Number = parameter("length", 0.0, at_least=0.0, polar=True)
    slider_cg_angle: Number = parameter("angle", 0.0)

    drives: ClassVar[dict[str, str]] = {"crank": "T12", "coupler": "T13"}
    links: ClassVar[tuple[str, ...]] = ("crank", "rod", "slider")
    pins: ClassVar[Pins] = rotating(PINS)
    bodies: ClassVar[tuple[Body, ...]] = BODIES
    status_meanings: ClassVar[tuple[str, ...]] = (
        "ok",
        "cannot_assemble",
        "toggle",
        "dead_centre",
        "jammed",
        "no_cycle",
        "jammed_two_solutions",
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse(link_problems(self, "crank", "rod") + problems(self) + self.branch_problems())
        refuse(self._never_closes())

    def _never_closes(self) -> list[str]:
        a, b, e = self.crank.length, self.rod.length, self.offset
        if any(hasattr(number, "dims") for number in (a, b, e)) or abs(e) <= a + b:
            return []
        return [
            f"offset = {e:.15g} m is {abs(e) - a - b:.6g} m beyond the reach of crank + rod: "
            f"the mechanism cannot be assembled at any angle; reduce it or lengthen them"
        ]

    def parameters(self) -> dict[str, Any]:
        """The numbers that the physics wires by name; a Field where a dimension is the mechanism's own."""
        guide_cos, guide_sin, cos_rest, sin_rest = cos_sin_rests(self.slide_angle)
        numbers: dict[str, Any] = {
            "offset": self.offset,
            "friction": self.friction,
            "slider_mass": self.slider_mass,
            "guide_cos": guide_cos,
            "guide_sin": guide_sin,
            "upright_cos": -guide_sin,
            "upright_cos_rest": -sin_rest,
            "upright_sin": guide_cos,
            "upright_sin_rest": cos_rest,
            "r4x": guide_cos,
            "r4y": guide_sin,
            "branch_sign": self.branch_sign,
            **cg_parameters("slider", self.slider_cg_distance, self.slider_cg_angle),
        }
        return numbers | SLIDER | link_parameters("crank", self.crank) | link_parameters("rod", self.rod)

    @property
    def pinch_angle(self) -> Number:
        """Crank angle [degree] about which, and opposite to which, it comes nearest to a toggle."""
        return 90.0 + self.slide_angle

    def table(self, drive: str, loads: tuple[Form, ...]) -> Table:
        """All that can be computed for this drive and loads of these forms."""
        return _table(drive, loads, turned(self.slide_angle))

    def kinematics(self) -> tuple[str, ...]:
        return ("theta3", "omega3", "alpha3", "x_slider", "v_slider", "a_slider")

    def unknowns(self, drive: str) -> tuple[str, ...]:
        return (*UNKNOWN_FORCES, self.drives[drive])

    def dynamics(self, drive: str) -> tuple[str, ...]:
        return (*self.unknowns(drive), "T14")

    def equations(self, drive: str) -> tuple[Equation, ...]:
        """The 9×9: document 1's rows, with friction; the torque in the row of the driven link (document 3)."""
        return (*self._newton_euler(drive)[:-1], FRICTION)

    def document_form(self, drive: str) -> tuple[tuple[str, ...], tuple[Equation, ...]]:
        """Return the unknowns and rows that document 3 prints: T14 with its trivial row; F14x only beside friction.

        A guide that is turned has F14x, too, which its friction row then ties to F14y.
        """
        pins, torque, rows = UNKNOWN_FORCES[:-2], self.drives[drive], self._newton_euler(drive)
        if np.any(self.friction) or turned(self.slide_angle):
            return (*UNKNOWN_FORCES, torque, "T14"), (*rows[:-1], FRICTION, rows[-1])
        return (*pins, torque, "F14y", "T14"), tuple(row.without("F14x") for row in rows)

    def _newton_euler(self, drive: str) -> tuple[Equation, ...]:
        """Return the three rows of each link; the guide's moment T14 is about C."""
        torque = {role: self.drives[drive] if role == drive else None for role in self.drives}
        return (
            *newton_euler_equations(2, {"F12": (1.0, "R12"), "F32": (1.0, "R32")}, torque["crank"]),
            *newton_euler_equations(3, {"F32": (-1.0, "R23"), "F43": (1.0, "R43")}, torque["coupler"]),
            *newton_euler_equations(4, {"F43": (-1.0, "R34"), "F14": (1.0, "R34")}, "T14"),
        )

    @property
    def _lengths(self) -> tuple[Number, Number, Number]:
        """What decides how it moves: crank, rod, offset."""
        return self.crank.length, self.rod.length, self.offset

    def findings(self) -> Checks:
        """What can be checked in closed form, and the numbers that each takes."""
        return (classes, self._lengths), (angles, (*self._lengths, self.slide_angle))

    def dead_centre_findings(self, drive: str) -> Checks:
        """Where the rod does not turn."""
        return ((rod_dead_centres, (*self._lengths, self.slide_angle)),) if drive == "coupler" else ()

    def output_findings(self) -> Checks:
        """Where the slider turns round."""
        return ((slider_dead_centres, (*self._lengths, self.slide_angle)),)

    def driven_findings(self, motion: Mapping[str, Any]) -> Checks:
        """Also where friction wedges the slider, by the link whose moment equation is free of the drive."""
        if motion["drive"] == "coupler":
            return (*super().driven_findings(motion), (wedging_by_crank, (self.slide_angle, self.friction)))
        return ((wedging, (*self._lengths, self.slide_angle, self.friction)),)

    def jumps(self) -> tuple[Number, ...]:
        """Crank angles [degree] at which friction jumps: dead centres, where the slider turns round."""
        return self.dead_centres() if np.any(self.friction) else ()

    def kinks(self) -> tuple[str, ...]:
        """Friction has one where the normal force changes sides."""
        return ("normal_force",) if np.any(self.friction) else ()

    def dead_centres(self) -> tuple[Number, ...]:
        """Crank angles [degree] with the rod in line with the crank: for each branch stretched, then folded.

        NaN in designs that have none. Stretched, C is farthest from A; folded, nearest.
        """
        a, b, e = self._lengths
        with np.errstate(all="ignore"):  # out of reach: NaN
            stretched, folded = (np.degrees(np.arcsin(np.divide(e, reach))) for reach in (a + b, b - a))
        found: list[Number] = []
        for sign in [BRANCH_SIGN[self.branch]] if self.branch in BRANCH_SIGN else BRANCH_SIGN.values():
            ahead = np.mod(self.slide_angle + (0.0 if sign > 0.0 else 180.0), 360.0)
            found += [ahead + sign * stretched, ahead + 180.0 + sign * folded]
        return tuple(found)

    @property
    def strokes(self) -> dict[str, Stroke]:
        """Where the slider is, and how far it still has to its outer dead centre."""
        return slider_strokes(*self._lengths, self.slide_angle, BRANCH_SIGN[self.branch], self.dead_centres())

    @property
    def turns_fully(self) -> Number:
        """Whether the crank of each design does, to the bit as `linksweep.physics.slider_crank.assembly` decides it."""
        return abs(self.offset) - self.rod.length + self.crank.length < 0.0

    @cached_property
    def closes_everywhere(self) -> bool:
        """Whether every design closes at every angle with a margin that rounding cannot touch."""
        b, height = self.rod.length, self.crank.length + abs(self.offset)
        return bool(in_range(b) and in_range(self.crank.length) and np.all(b - height > 1e-9 * (b + height)))

    def always_ok(self, drive: str) -> bool:
        """Whether the numbers alone say that every sample is ok: friction must not wedge the slider either."""
        b, height = self.rod.length, self.crank.length + abs(self.offset)
        with np.errstate(over="ignore"):
            wedges = np.square(self.friction * height) >= (b - height) * (b + height) * (1.0 - 1e-9)
        return super().always_ok(drive) and not np.any(wedges)

    def peak_quantities(self, drive: str) -> tuple[str, ...]:
        return ("F12", "F32", "F43", "F14", self.drives[drive])


@lru_cache(maxsize=64)
def _table(drive: str, loads: tuple[Form, ...], turned: bool) -> Table:
    rows = [
        *(pinch_rows("upright") if turned else straight_rows("sin2", "cos2", minus_sin=True)),
        *_position(),
        *_rates(),
        *_forces(drive),
        *_status(drive, loads),
        *power_rows(SliderCrank.drives[drive], DRIVEN[drive], BODIES, loads, "friction_power"),
        Row(planar.product, ("friction_power",), ("friction_force", "v_slider")),
    ]
    rows += machine_rows(BODIES, PINS, loads) + _transmission()
    rows += [rounding_error.row(low="crank_length", high="crank_length")]
    rows += [*arm_rows(2, "R12", "R32"), *arm_rows(3, "R23", "R43"), *arm_rows(4, "R34")]
    return Table("theta2", tuple(rows), tuple(_quantities(drive, loads)), between_rows("upright_cos", "upright_sin"))


def _position() -> list[Row | Total]:
    return [
        Row(slider_crank.pinch_widths, ("pinch_near", "pinch_far")),
        Row(crank_driven.crank_pin, ("r2x", "r2y")),
        Row(slider_crank.toggle_cosines, ("low_cos", "low_cos_rest", "high_cos", "high_cos_rest")),
        Row(slider_crank.guide_shares, ("crank_along", "crank_across", "rod_across")),
        Row(slider_crank.closure_factors, ("low", "high")),
        Row(slider_crank.closure_noise, ("low_noise", "high_noise")),
        Row(slider_crank.length_noise, ("noise",)),
        Row(slider_crank.assembly, ("assembly",)),
        Row(dyad_rrp.rrp_close, ("r3x", "r3y", "rod_along", "inverse_rod_along")),
        Row(dyad_rrp.rod_transmission_angle, ("transmission_angle",)),
        Row(slider_crank.slider_position, ("x_slider",)),
        Row(planar.direction, ("theta3",), ("r3x", "r3y")),
        Row(planar.vector_sum, ("Bx", "By"), (0.0, 0.0, "r2x", "r2y")),
        Row(planar.vector_sum, ("Cx", "Cy"), ("r2x", "r2y", "r3x", "r3y")),
    ]


def _rates() -> list[Row | Total]:
    return [
        Row(dyad_rrp.rrp_velocity_ratios, ("ratio3", "ratio_slider")),
        Row(planar.product, ("omega3",), ("omega2", "ratio3")),
        Row(planar.product, ("v_slider",), ("omega2", "ratio_slider")),
        Row(planar.point_velocity, ("vBx", "vBy"), (0.0, 0.0, "omega2", "r2x", "r2y")),
        Row(crank_driven.crank_pin_acceleration, ("aBx", "aBy")),
        Row(dyad_rrp.rrp_accelerations, ("alpha3", "a_slider")),
        Row(planar.along, ("vCx", "vCy"), ("v_slider", "guide_cos", "guide_sin")),
        Row(planar.along, ("aCx", "aCy"), ("a_slider", "guide_cos", "guide_sin")),
    ]


def _transmission() -> list[Row | Total]:
    """What the slider has of the crank's velocity and force, and how the ratios change with the crank's angle."""
    rod, guide = ("ratio3", "rod_along", "rod_across", "inverse_rod_along"), ("guide_cos", "guide_sin")
    return [
        *crank_pin_slope_rows(),
        Row(dyad_rrp.rrp_accelerations, ("slope3", "slope_slider"), ("uBx_slope", "uBy_slope", *rod, *guide)),
        Row(planar.along, ("uCx", "uCy"), ("ratio_slider", *guide)),
        Row(planar.along, ("uCx_slope", "uCy_slope"), ("slope_slider", *guide)),
        Row(planar.same, ("velocity_ratio",), ("ratio_slider",)),
        Row(advantage.mechanical_advantage, ("mechanical_advantage",), ("velocity_ratio", "crank_length", 1.0)),
    ]


def _forces(drive: str) -> list[Row | Total]:
    """The guide's force from the lever whose moment equation is free of the drive; the rest follows by addition."""
    lever = {
        "crank": ("inverse_rod_along", "rod_across", "moment_r3"),
        "coupler": ("inverse_crank_along", "crank_across", "moment_r2"),
    }[drive]
    guide = ("guide_cos", "guide_sin")
    torque = {
        "crank": Row(planar.opposite, ("T12",), ("work",)),
        "coupler": Row(slider_crank.torque_on_rod, ("T13",)),
    }[drive]
    return [
        Row(slider_crank.moment_on_rod, ("moment_r3",)),
        Row(slider_crank.inverse_lever, ("inverse_crank_along",)),
        Row(crank_driven.moment_on_crank, ("moment_r2",)),
        Row(slider_crank.friction_direction, ("direction",)),
        Row(
            slider_crank.guide_force,
            ("normal_force", "friction_force", "wedging", "rod_force_across", "rod_force_along"),
            (*lever, "Q4x", "Q4y", *guide, "direction"),
        ),
        Row(slider_crank.from_guide_axes, ("F14x", "F14y"), ("normal_force", "friction_force", *guide)),
        Row(slider_crank.from_guide_axes, ("F43x", "F43y"), ("rod_force_across", "rod_force_along", *guide)),
        Row(crank_driven.coupler_balance, ("F32x", "F32y")),
        Row(crank_driven.crank_balance, ("F12x", "F12y")),
        Row(planar.opposite, ("T14",), ("N4",)),
        Row(slider_crank.work_on_crank, ("work",)),
        torque,
        Row(slider_crank.friction_row, ("friction_row_x", "friction_row_y")),
        Total("friction_rhs", ()),
    ]


def _status(drive: str, loads: tuple[Form, ...]) -> list[Row | Total]:
    """Step by step: does it close, can the drive move it, does friction wedge it, have its loads their whole turns."""
    closure: list[Row | Total] = [Row(dyad_rrp.rrp_status, ("closure",))]
    leverage: list[Row | Total] = [Row(planar.same, ("leverage_status",), ("closure",))]
    if drive == "coupler":
        leverage = [
            Row(crank_driven.drive_status, ("leverage_status",), ("closure", "crank_along", "crank_length", 1.0))
        ]
    cycle: list[Row | Total] = [Row(planar.same, ("status",), ("jam_status",))]
    if any(form.full_turns for form in loads):
        cycle = [Row(slider_crank.no_cycle_status, ("status",), ("jam_status", "assembly"))]
    jam = Row(slider_crank.jammed_status, ("jam_status",), ("leverage_status", "wedging"))
    return [*closure, *leverage, jam, *cycle]


def _quantities(drive: str, loads: tuple[Form, ...]) -> list[Quantity]:
    return [
        Quantity("theta3", "degree", "angle of the rod B→C from x, counter-clockwise, in (-180, 180]"),
        Quantity("transmission_angle", "degree", "acute angle between the rod and the guide's normal"),
        Quantity("x_slider", "m", "position of the slider along the guide, from the foot of A on it"),
        Quantity("v_slider", "m s-1", "velocity of the slider along the guide"),
        Quantity("a_slider", "m s-2", "acceleration of the slider along the guide"),
        Quantity("T14", "N m", "moment of the guide on the slider about C, positive counter-clockwise"),
        Quantity("normal_force", "N", "force of the guide on the slider across it, positive to the guide's left"),
        Quantity("friction_force", "N", "force of the guide on the slider along it"),
        Quantity("friction_power", "W", "power of friction on the slider, never positive"),
        *position_quantities("B", "C"),
        *drive_quantities(
            drive_torque(SliderCrank.drives[drive], drive), "drive, friction, loads, gravity and inertia"
        ),
        Quantity("velocity_ratio", "m rad-1", "velocity of the slider per angular velocity of the crank"),
        Quantity("mechanical_advantage", "1", "force of the slider per force on the crank at B square to it"),
        *machine_quantities(BODIES, PINS, LINKS, loads),
    ]
