"""The slider-crank: crank 2 (A-B), rod 3 (B-C), slider 4 at C on a guide of the ground 1."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np

from linksweep.base.fields import of_kind, parameter
from linksweep.base.validate import Number
from linksweep.chains.chain import Own
from linksweep.chains.equations import equations
from linksweep.chains.rows.bodies import Equation, drive_torque, newton_euler_equations
from linksweep.chains.rows.crank import BRANCH, BRANCH_SIGN, between_rows, frame_parameters, in_range, turned
from linksweep.chains.rows.load_forms import Form
from linksweep.chains.rows.pins import Journals
from linksweep.chains.shape import Shape
from linksweep.chains.topology import Topology, topology_of
from linksweep.engine.quantity import Quantity, Row, Total
from linksweep.mechanisms.balance import first_moment, on_crank
from linksweep.mechanisms.cylinder import PistonCylinder
from linksweep.mechanisms.drawing import Block, Drawing, Frame, Rail, direction
from linksweep.mechanisms.limits import slider_crank_limits as limits
from linksweep.mechanisms.limits.finding import Checks
from linksweep.mechanisms.linkage_drawing import drawing_of
from linksweep.mechanisms.links import LINK, AnyLink, cg_parameters, link_parameters
from linksweep.mechanisms.machine import Machine
from linksweep.mechanisms.mechanism import reach_problems, register
from linksweep.mechanisms.strokes import Stroke, slider_strokes
from linksweep.physics import advantage, coulomb, crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import slider_crank

TOPOLOGY = topology_of("crank A-B, rod B-C, slider C on guide", ("A",), (("guide", "ground"),))
DRIVES = {"crank": "T12", "coupler": "T13"}
DRIVEN = {"crank": "omega2", "coupler": "omega3"}
JOURNALS = {"A": 2, "B": 2, "C": 4}
"""As in engines: the crank carries crankshaft and crankpin, the piston the gudgeon pin; the rod has both its bushes."""
UNKNOWN_FORCES = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y")
FRICTION = Equation("friction on 4", {"F14x": (1.0, "friction_row_x"), "F14y": (1.0, "friction_row_y")}, "friction_rhs")
SLIDER = {"slider_inertia": 0.0, "slider_length": 1.0}
"""Inputs of the slider as a body that does not turn; its axes lie along and across the guide."""
GUIDE = Frame("guide", "slide_angle")


def _guide(mechanism: Any) -> Rail:
    """Return the guide of a slider-crank as plots draw it."""
    along = direction(mechanism.slide_angle)
    return Rail(float(mechanism.offset) * np.array([-along[1], along[0]]), along, offset=True)


@register
@dataclass(frozen=True, eq=False, repr=False)
class SliderCrank(Machine):
    """A slider-crank: engine, pump, compressor.

    Parameters
    ----------
    crank : Link, Bar or Disk
        Driven link; its first pin is A, its second B.
    rod : Link, Bar or Disk
        Connecting rod from B to C; its first pin is B.
    slider_mass : float or DataArray
        Mass of the slider [kg].
    offset : float or DataArray, default 0.0
        Height of the guide over A, to the left of the guide's direction [m], of either sign.
    friction : float or DataArray, default 0.0
        Coefficient of Coulomb friction between slider and guide [1].
    branch : str, default "open"
        Assembly: "open" (C ahead of B along the guide), "crossed" (behind), or "both" (adds the dimension `branch`).
    slide_angle : float or DataArray, default 0.0
        Direction of the guide to x [degree].
    slider_cg_distance : float or DataArray, default 0.0
        Distance of the slider's centre of gravity from its pin C [m].
    slider_cg_angle : float or DataArray, default 0.0
        Angle of that centre of gravity from the guide's direction, counter-clockwise [degree].

    Raises
    ------
    ValueError
        One line for each parameter out of bounds, and for lengths that cannot be joined at any crank angle.

    Notes
    -----
    A load on "slider" acts at a point from C, in axes along and across the guide.

    Friction wedges the slider where μ·|tan ψ| ≥ 1, ψ the angle of the rod (with drive="coupler", of the crank) to the
    guide: status `jammed` where no force moves it on, `jammed_two_solutions` where the guide may press on either side
    (the statics of rigid bodies allows both). The slider does not turn: the place of its centre of gravity changes
    only `T14`, the guide's moment on it, and the shaking moment; its moment of inertia would change nothing, and is no
    parameter. A load with a cycle of full turns of the crank (see `GasPressure`) has no value in a design whose crank
    does not turn fully: status `no_cycle`.

    Examples
    --------
    >>> import linksweep as ls
    >>> crank, rod = ls.Disk(0.045, 0.06, 0.02, 7800), ls.Link(0.15, 0.6, 2.2e-3, cg_distance=0.05)
    >>> ls.SliderCrank(crank, rod, slider_mass=0.5, friction=0.1).branch
    'open'
    """

    crank: AnyLink = of_kind(LINK)
    rod: AnyLink = of_kind(LINK)
    slider_mass: Number = parameter("mass", at_least=0.0)
    offset: Number = parameter("length", 0.0)
    friction: Number = parameter("dimensionless", 0.0, at_least=0.0)
    branch: str = of_kind(BRANCH, "open")
    slide_angle: Number = parameter("angle", 0.0)
    slider_cg_distance: Number = parameter("length", 0.0, at_least=0.0, polar=True)
    slider_cg_angle: Number = parameter("angle", 0.0)

    drives: ClassVar[dict[str, str]] = DRIVES
    journals: ClassVar[Journals] = JOURNALS
    balances_partly: ClassVar[bool] = True
    topology: ClassVar[Topology] = TOPOLOGY
    title: ClassVar[str] = "Slider-crank"
    drawing: ClassVar[Drawing] = replace(
        drawing_of(TOPOLOGY),
        journals=JOURNALS,
        frames={**drawing_of(TOPOLOGY).frames, 4: GUIDE},
        blocks=(Block(4, "C", GUIDE, _guide),),
        ideal={"friction": 0.0},
    )

    def closure_problems(self) -> list[str]:
        """Return why a single design cannot be assembled: crank and rod do not reach the guide."""
        a, b, e = self.crank.length, self.rod.length, self.offset
        return reach_problems(e, a, b, "crank + rod")

    def parameters(self) -> dict[str, Any]:
        numbers: dict[str, Any] = {
            "offset": self.offset,
            "friction": self.friction,
            "slider_mass": self.slider_mass,
            **frame_parameters("guide", self.slide_angle),
            "branch_sign": self.branch_sign,
            **cg_parameters("slider", self.slider_cg_distance, self.slider_cg_angle),
        }
        return numbers | SLIDER | link_parameters("crank", self.crank) | link_parameters("rod", self.rod)

    @property
    def near_toggle_angle(self) -> Number:
        return 90.0 + self.slide_angle

    @property
    def shape(self) -> Shape:
        return Shape(TOPOLOGY, turned=frozenset({"C"} if turned(self.slide_angle) else ()), plain=True)

    def own(self, drive: str, loads: tuple[Form, ...]) -> Own:
        return _own(drive, any(form.full_turns for form in loads))

    def unknowns(self, drive: str) -> tuple[str, ...]:
        return (*UNKNOWN_FORCES, self.drives[drive])

    def dynamics(self, drive: str) -> tuple[str, ...]:
        return (*self.unknowns(drive), "T14")

    def equations(self, drive: str) -> tuple[Equation, ...]:
        """Return the 9×9: document 1's rows, with friction; the torque in the row of the driven link (document 3)."""
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
        driven = "rod" if drive == "coupler" else drive
        crank_and_rod = equations(TOPOLOGY, {driven: self.drives[drive]})[:6]
        return (*crank_and_rod, *newton_euler_equations(4, {"F43": (-1.0, "R34"), "F14": (1.0, "R34")}, "T14"))

    @property
    def _lengths(self) -> tuple[Number, Number, Number]:
        """Lengths of crank and rod, and the offset, which alone decide the motion."""
        return self.crank.length, self.rod.length, self.offset

    def findings(self) -> Checks:
        return (limits.classes, self._lengths), (limits.angles, (*self._lengths, self.slide_angle))

    def dead_centre_findings(self, drive: str) -> Checks:
        """Return the check for angles at which a driven rod does not turn."""
        return ((limits.rod_dead_centres, (*self._lengths, self.slide_angle)),) if drive == "coupler" else ()

    def output_findings(self) -> Checks:
        """Return the check for angles at which the slider turns round."""
        return ((limits.slider_dead_centres, (*self._lengths, self.slide_angle)),)

    def driven_findings(self, motion: Mapping[str, Any]) -> Checks:
        """Return also the check for wedging, by the link whose moment equation is without the drive."""
        if motion["drive"] == "coupler":
            return (*super().driven_findings(motion), (limits.wedging_by_crank, (self.slide_angle, self.friction)))
        return ((limits.wedging, (*self._lengths, self.slide_angle, self.friction)),)

    def jumps(self) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which friction jumps: dead centres, where the slider turns round."""
        return self.dead_centres() if np.any(self.friction) else ()

    def kinks(self) -> tuple[str, ...]:
        """Return the normal force: friction has a kink where it changes sides."""
        return ("normal_force",) if np.any(self.friction) else ()

    def dead_centres(self) -> tuple[Number, ...]:
        """Compute the crank angles with the rod in line with the crank.

        Returns
        -------
        tuple of float or DataArray
            Angles [degree], for each branch stretched (C farthest from A), then folded; NaN in designs without any.
        """
        signs = [BRANCH_SIGN[self.branch]] if self.branch in BRANCH_SIGN else BRANCH_SIGN.values()
        cylinders = (PistonCylinder(*self._lengths, self.slide_angle, sign) for sign in signs)
        return tuple(angle for cylinder in cylinders for angle in cylinder.dead_centres())

    @property
    def strokes(self) -> dict[str, Stroke]:
        """Position of the slider, and its distance from the outer dead centre, which a load may follow."""
        return slider_strokes(*self._lengths, self.slide_angle, BRANCH_SIGN[self.branch], self.dead_centres())

    @property
    def engine_cylinder(self) -> PistonCylinder:
        """The cylinder in which the slider is the piston, its head where the rod reaches farthest."""
        return PistonCylinder(*self._lengths, self.slide_angle, BRANCH_SIGN[self.branch])

    def stroke_findings(self) -> Checks:
        """Return the closed forms of the slider's travel, time ratio and reversals."""
        return (limits.travel, self._lengths), (limits.reversals, (*self._lengths, self.slide_angle, self.branch_sign))

    def balancing_moments(self, fraction: Number) -> dict[str, Any]:
        """Return the first moment that the crank lacks to cancel what turns, and a fraction of the first order."""
        reciprocating = self.slider_mass + first_moment(self.rod).real / self.rod.length
        return {"crank": -on_crank(self.crank, self.rod) - fraction * self.crank.length * reciprocating}

    @cached_property
    def closes_everywhere(self) -> bool:
        b, height = self.rod.length, self.crank.length + abs(self.offset)
        return bool(in_range(b) and in_range(self.crank.length) and np.all(b - height > 1e-9 * (b + height)))

    def always_ok(self, drive: str) -> bool:
        """Return whether the numbers alone ensure status 0 at every sample, friction included."""
        b, height = self.rod.length, self.crank.length + abs(self.offset)
        with np.errstate(over="ignore"):
            wedges = np.square(self.friction * height) >= (b - height) * (b + height) * (1.0 - 1e-9)
        return super().always_ok(drive) and not np.any(wedges)


@lru_cache
def _own(drive: str, full_turns: bool) -> Own:
    """Return a drive, the ratio of the slider's velocity to the crank's, and the document's friction row."""
    no_cycle = Row(slider_crank.no_cycle_status, ("status",), ("jam_status", "assembly"))
    rows: tuple[Row | Total, ...] = (
        Row(slider_crank.work_on_crank, ("work",)),
        Row(planar.identity, ("velocity_ratio",), ("ratio_slider",)),
        Row(advantage.mechanical_advantage, ("mechanical_advantage",), ("velocity_ratio", "crank_length", 1.0)),
        Row(slider_crank.friction_row, ("friction_row_x", "friction_row_y")),
        Total("friction_rhs", ()),
        *([] if drive == "crank" else DRIVEN_ROD),
        *([no_cycle] if full_turns else []),
    )
    return Own(
        drive_torque(DRIVES[drive], drive), DRIVEN[drive], rows, QUANTITIES, between_rows("upright_cos", "upright_sin")
    )


DRIVEN_ROD = (
    Row(slider_crank.inverse_lever, ("inverse_crank_along",)),
    Row(crank_driven.moment_on_crank, ("moment_r2",)),
    Row(
        slider_crank.guide_force,
        ("normal_force", "friction_force", "wedging", "rod_force_across", "rod_force_along"),
        ("inverse_crank_along", "crank_across", "moment_r2", "Q4x", "Q4y", "guide_cos", "guide_sin", "direction"),
    ),
    Row(slider_crank.torque_on_rod, ("T13",)),
    Row(crank_driven.drive_status, ("leverage_status",), ("closure", "crank_along", "crank_length", 1.0)),
    Row(coulomb.jammed_status, ("jam_status",), ("leverage_status", "wedging")),
)
"""Rows in which the crank's moment equation takes the place of the driven rod's."""
QUANTITIES = (
    Quantity("T14", "N m", "moment of the guide on the slider about C, positive counter-clockwise"),
    Quantity("normal_force", "N", "force of the guide on the slider across it, positive to the guide's left"),
    Quantity("friction_force", "N", "force of the guide on the slider along it"),
    Quantity("friction_power", "W", "power of friction on the slider, never positive"),
    Quantity("velocity_ratio", "m rad-1", "velocity of the slider per angular velocity of the crank"),
    Quantity("mechanical_advantage", "1", "force of the slider per force on the crank at B square to it"),
)
