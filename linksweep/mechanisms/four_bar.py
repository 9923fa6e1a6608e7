"""The four-bar: crank 2 (A-B), coupler 3 (B-C), rocker 4 (D-C) on ground 1 (A-D)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np

from linksweep.base.fields import of_kind, parameter
from linksweep.base.validate import Number, is_lazy
from linksweep.engine.quantity import Quantity, Row, Table, Total
from linksweep.mechanisms.balance import first_moment, on_crank
from linksweep.mechanisms.drawing import Drawing, Frame, ground_pins
from linksweep.mechanisms.dyads import rrr
from linksweep.mechanisms.limits import four_bar_limits as limits
from linksweep.mechanisms.limits.finding import Checks
from linksweep.mechanisms.links import LINK, AnyLink, link_parameters
from linksweep.mechanisms.mechanism import Mechanism, register
from linksweep.mechanisms.rows import bodies
from linksweep.mechanisms.rows.bodies import Body, Equation
from linksweep.mechanisms.rows.crank import (
    BRANCH,
    BRANCH_SIGN,
    between_rows,
    frame_parameters,
    in_range,
    near_toggle_rows,
    straight_rows,
    turned,
)
from linksweep.mechanisms.rows.load_forms import Form
from linksweep.mechanisms.rows.pins import Journals, Pins, rotating
from linksweep.mechanisms.rows.whole_machine import machine_quantities, machine_rows, power_rows
from linksweep.mechanisms.strokes import Stroke, rocker_stroke
from linksweep.physics import advantage, crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import crank_angle, dyad_rrr, four_bar, freudenstein
from linksweep.physics.closures.freudenstein import PositionEquation

LINKS = {1: "ground", 2: "crank", 3: "coupler", 4: "rocker"}
PINS = {"A": (1, 2), "B": (3, 2), "C": (4, 3), "D": (1, 4)}
JOURNALS = {"A": 2, "B": 2, "C": 3, "D": 4}
DRIVEN = {"crank": "omega2", "coupler": "omega3", "rocker": "omega4"}
UNKNOWN_FORCES = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y")
BODIES = (
    bodies.CRANK,
    bodies.on_crank_pin(3, "coupler", "ratio3", "slope3"),
    Body(4, "rocker", pin_position=("Dx", "Dy"), ratio="ratio4", slope="slope4"),
)


CLOSED = (
    *("r3x", "r3y", "r4x", "r4y", "inverse_r4_cross_r3"),
    *("along3", "along4", "across", "inverse_2ff", "half_inverse_root"),
)


@register
@dataclass(frozen=True, eq=False, repr=False)
class FourBar(Mechanism):
    """A four-bar linkage.

    Parameters
    ----------
    crank : Link, Bar or Disk
        Driven link; its first pin is A, its second B.
    coupler : Link, Bar or Disk
        Link from B to C; its first pin is B.
    rocker : Link, Bar or Disk
        Link from D to C; its first pin is D.
    ground : float or DataArray
        Length of the frame from A to D [m].
    branch : str, default "open"
        Assembly: "open" (C to the left of the line B→D), "crossed", or "both" (adds the dimension `branch`).
    ground_angle : float or DataArray, default 0.0
        Angle of the line A→D to x [degree].

    Raises
    ------
    ValueError
        One line for each parameter out of bounds, and for lengths that cannot be joined at any crank angle.

    Examples
    --------
    >>> import linksweep as ls
    >>> bar = dict(width=0.02, thickness=0.02, density=7750)
    >>> press = ls.FourBar(crank=ls.Bar(length=0.08, **bar), coupler=ls.Bar(length=0.22, **bar),
    ...                    rocker=ls.Bar(length=0.18, **bar), ground=0.20)
    >>> press.branch
    'open'
    """

    crank: AnyLink = of_kind(LINK)
    coupler: AnyLink = of_kind(LINK)
    rocker: AnyLink = of_kind(LINK)
    ground: Number = parameter("length", above=0.0)
    branch: str = of_kind(BRANCH, "open")
    ground_angle: Number = parameter("angle", 0.0)

    drives: ClassVar[dict[str, str]] = {"crank": "T12", "coupler": "T13", "rocker": "T14"}
    roles: ClassVar[tuple[str, ...]] = ("crank", "coupler", "rocker")
    pins: ClassVar[Pins] = rotating(PINS)
    journals: ClassVar[Journals] = JOURNALS
    bodies: ClassVar[tuple[Body, ...]] = BODIES
    position_equation: ClassVar[PositionEquation | None] = freudenstein.POSITION_EQUATION
    title: ClassVar[str] = "Four-bar"
    drawing: ClassVar[Drawing] = Drawing(
        joints=PINS,
        journals=JOURNALS,
        frames={
            2: Frame("crank, A→B", "theta2"),
            3: Frame("coupler, B→C", "theta3"),
            4: Frame("rocker, D→C", "theta4"),
        },
        bars={2: ("A", "B"), 3: ("B", "C"), 4: ("D", "C")},
        moving=("B", "C"),
        fixed=ground_pins,
    )

    def lengths(self) -> dict[str, Number]:
        """Return the lengths of the four links.

        Returns
        -------
        dict of str to float or DataArray
            Lengths [m] by role.
        """
        return {role: link.length for role, link in self.parts.items()} | {"ground": self.ground}

    def closure_problems(self) -> list[str]:
        """Return why a single design cannot be assembled: its longest link is longer than the others together."""
        lengths = self.lengths()
        if any(hasattr(length, "dims") for length in lengths.values()):
            return []
        longest = max(lengths, key=lengths.__getitem__)
        excess = 2.0 * lengths[longest] - sum(lengths.values())
        if excess <= 0.0:
            return []
        path = "ground" if longest == "ground" else f"{longest}.length"
        others = " + ".join(role for role in lengths if role != longest)
        return [
            f"{path} = {lengths[longest]:.15g} m is {excess:.6g} m longer than {others}: "
            f"the mechanism cannot be assembled at any angle; shorten it or lengthen the others"
        ]

    def parameters(self) -> dict[str, Any]:
        numbers: dict[str, Any] = {"ground_length": self.ground, "branch_sign": self.branch_sign}
        numbers |= frame_parameters("ground", self.ground_angle)
        for role, link in self.parts.items():
            numbers |= link_parameters(role, link)
        return numbers

    @property
    def near_toggle_angle(self) -> Number:
        return self.ground_angle

    @property
    def strokes(self) -> dict[str, Stroke]:
        """Angle of the rocker, as a position that a load may follow."""
        a, b, c, d = self.lengths().values()
        return {"rocker.angle": rocker_stroke(a, b, c, d, self.ground_angle, BRANCH_SIGN[self.branch])}

    def table(self, drive: str, loads: tuple[Form, ...]) -> Table:
        return _table(drive, loads, turned(self.ground_angle), self._goes_through)

    def kinematics(self) -> tuple[str, ...]:
        return ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4")

    def unknowns(self, drive: str) -> tuple[str, ...]:
        """Return the nine unknowns of the 9×9, in the textbook's order."""
        return (*UNKNOWN_FORCES, self.drives[drive])

    def equations(self, drive: str) -> tuple[Equation, ...]:
        """Return the 9×9 of document 2 (ME 470), row by row."""
        torque = {drive: self.drives[drive]}.get
        return (
            *bodies.newton_euler_equations(2, {"F12": (1.0, "R12"), "F32": (1.0, "R32")}, torque("crank")),
            *bodies.newton_euler_equations(3, {"F32": (-1.0, "R23"), "F43": (1.0, "R43")}, torque("coupler")),
            *bodies.newton_euler_equations(4, {"F43": (-1.0, "R34"), "F14": (1.0, "R14")}, torque("rocker")),
        )

    def findings(self) -> Checks:
        lengths = tuple(self.lengths().values())
        return (limits.classes, lengths), (limits.angles, (*lengths, self.ground_angle))

    def dead_centre_findings(self, drive: str) -> Checks:
        """Return the check for angles at which coupler or rocker stands still."""
        dead_centres = {"coupler": limits.coupler_dead_centres, "rocker": limits.rocker_dead_centres}
        numbers = (*self.lengths().values(), self.ground_angle)
        return ((dead_centres[drive], numbers),) if drive in dead_centres else ()

    def stroke_findings(self) -> Checks:
        """Return the closed forms of the rocker's swing, time ratio and reversals."""
        lengths = tuple(self.lengths().values())
        return (limits.swings, lengths), (limits.reversals, (*lengths, self.ground_angle, self.branch_sign))

    def balancing_moments(self, fraction: Number) -> dict[str, Any]:
        """Return the first moments that crank and rocker lack for the centre of gravity to stand still."""
        on_rocker = first_moment(self.coupler) * (self.rocker.length / self.coupler.length)
        return {"crank": -on_crank(self.crank, self.coupler), "rocker": -first_moment(self.rocker) - on_rocker}

    @cached_property
    def closes_everywhere(self) -> bool:
        a, b, c, d = self.lengths().values()
        low = ((d - b) + (c - a)) * ((d - c) + (b - a))
        high = ((b - d) + (c - a)) * (b + c + d + a)
        perimeter = a + b + c + d
        margin = 1e-9 * perimeter * perimeter
        sized = all(map(in_range, (a, b, c, d))) and in_range(perimeter / a * (perimeter / d))
        return bool(sized and np.all(low > margin) and np.all(high > margin))

    @cached_property
    def _goes_through(self) -> bool:
        """True where a design may be a parallelogram or a kite, which change sides; other designs keep their bits."""
        if any(map(is_lazy, self.lengths().values())):
            return True
        a, b, c, d = self.lengths().values()
        near = 1e-9 * (a + b + c + d)
        opposite, adjacent = abs(a - c) < near, abs(a - b) < near
        return bool(np.any((abs(a + d - b - c) < near) & (opposite | adjacent)))

    def peak_quantities(self, drive: str) -> tuple[str, ...]:
        return ("F12", "F32", "F43", "F14", self.drives[drive])


@lru_cache(maxsize=64)
def _table(drive: str, loads: tuple[Form, ...], turned: bool, goes_through: bool) -> Table:
    rows = [
        *(near_toggle_rows("ground") if turned else straight_rows("cos2", "sin2")),
        *bodies.crank_pin_rows(),
        *_position(),
        Row(four_bar.side_of_diagonal, ("side",))
        if goes_through
        else Row(planar.identity, ("side",), ("branch_sign",)),
        *_rates(),
        *_forces(drive),
        *power_rows(FourBar.drives[drive], DRIVEN[drive], BODIES, loads),
    ]
    rows += machine_rows(BODIES, PINS, loads, **rrr.CERTAIN_ON_CRANK) + _transmission()
    rows += [*bodies.arm_rows(2, "R12", "R32"), *bodies.arm_rows(3, "R23", "R43"), *bodies.arm_rows(4, "R14", "R34")]
    return Table("theta2", tuple(rows), tuple(_quantities(drive, loads)), between_rows("ground_cos", "ground_sin"))


def _position() -> list[Row | Total]:
    return [
        Row(four_bar.near_toggle_widths, ("near_toggle_near", "near_toggle_far")),
        Row(four_bar.closure_unit, ("closure_unit",)),
        Row(four_bar.least_factors, ("least_low", "least_low_lo", "least_high", "least_high_lo")),
        Row(four_bar.sums_unit, ("sums_unit",)),
        Row(four_bar.toggle_cosines, ("folded_cos", "folded_cos_lo", "stretched_cos", "stretched_cos_lo")),
        Row(four_bar.change_points, ("folded_noise", "stretched_noise", "parallel")),
        Row(crank_angle.versines, ("versine", "vercosine")),
        Row(four_bar.diagonal, ("BDx", "BDy")),
        Row(four_bar.closure_factors, ("low", "high")),
        Row(four_bar.closure_noise, ("low_noise", "high_noise")),
        Row(four_bar.assembly, ("assembly",)),
        Row(dyad_rrr.rrr_close, CLOSED),
        Row(dyad_rrr.transmission_angle, ("transmission_angle",)),
        Row(dyad_rrr.transmission_angle_signed, ("transmission_angle_signed",)),
        Row(freudenstein.ratios, ("K1", "K2", "K3", "K4", "K5")),
        Row(freudenstein.rocker_equation, ("A", "B", "C")),
        Row(freudenstein.coupler_equation, ("D", "E", "F")),
        Row(planar.direction, ("theta3",), ("r3x", "r3y")),
        Row(planar.direction, ("theta4",), ("r4x", "r4y")),
        Row(planar.vector_sum, ("Cx", "Cy"), ("r2x", "r2y", "r3x", "r3y")),
        Row(planar.along, ("Dx", "Dy"), ("ground_length", "ground_cos", "ground_sin")),
    ]


def _rates() -> list[Row | Total]:
    return [
        Row(four_bar.crank_on_diagonal, ("crank_along", "crank_across", "crank_per_across")),
        Row(dyad_rrr.rrr_velocity_ratios, ("ratio3", "ratio4")),
        Row(planar.product, ("omega3",), ("omega2", "ratio3")),
        Row(planar.product, ("omega4",), ("omega2", "ratio4")),
        Row(four_bar.ratio_slopes, ("slope3", "slope4")),
        Row(crank_driven.angular_acceleration, ("alpha3",), ("omega2", "alpha2", "ratio3", "slope3")),
        Row(crank_driven.angular_acceleration, ("alpha4",), ("omega2", "alpha2", "ratio4", "slope4")),
    ]


def _transmission() -> list[Row | Total]:
    """Return rows of the ratios of the rocker's velocity and torque to the crank's."""
    radii = ("crank_length", "rocker_length")
    return [
        Row(planar.identity, ("velocity_ratio",), ("ratio4",)),
        Row(advantage.torque_ratio, ("torque_ratio",)),
        Row(advantage.mechanical_advantage, ("mechanical_advantage",), ("velocity_ratio", *radii)),
    ]


def _forces(drive: str) -> list[Row | Total]:
    """Return rows of F43, by the two moment equations without the drive's torque, and of the others, by addition.

    The crank's torque comes from virtual work, which needs no pin force. The torque on another link, whose leverage may
    vanish, comes with F43, so that both have the same error.
    """
    return [
        *(_crank_driven() if drive == "crank" else _driven_beyond_the_crank(drive)),
        Row(crank_driven.coupler_balance, ("F32x", "F32y")),
        Row(crank_driven.rocker_balance, ("F14x", "F14y")),
        Row(crank_driven.crank_balance, ("F12x", "F12y")),
        Row(crank_driven.work_on_crank, ("work",)),
    ]


def _crank_driven() -> list[Row | Total]:
    return [
        Row(dyad_rrr.rrr_status, ("status",)),
        Row(dyad_rrr.rrr_pin_force, ("F43x", "F43y")),
        Row(planar.opposite, ("T12",), ("work",)),
    ]


def _driven_beyond_the_crank(drive: str) -> list[Row | Total]:
    """Return rows in which the crank's moment equation takes the place of the driven link's."""
    free, ratio, torque = {
        "coupler": (("r4x", "r4y", "N4"), "ratio3", dyad_rrr.rrr_coupler_torque),
        "rocker": (("r3x", "r3y", "moment_r3"), "ratio4", dyad_rrr.rrr_rocker_torque),
    }[drive]
    leverage = ("leverage", "crank_length", {"coupler": "rocker_length", "rocker": "coupler_length"}[drive])
    crank, inverse = ("r2x", "r2y", "crank_length", "moment_r2"), "inverse_r4_cross_r3"
    return [
        Row(planar.opposite, ("moment_r3",), ("N3",)),
        Row(crank_driven.moment_on_crank, ("moment_r2",)),
        Row(dyad_rrr.rrr_leverage, ("leverage",), (ratio, inverse)),
        Row(crank_driven.away_from_dead_centre, ("driven_ratio",), (ratio, *leverage)),
        Row(dyad_rrr.rrr_driven_pin_force, ("F43x", "F43y", "pull", "push"), (*crank, *free, "driven_ratio", inverse)),
        Row(torque, (FourBar.drives[drive],)),
        Row(dyad_rrr.rrr_status, ("closure",)),
        Row(crank_driven.drive_status, ("status",), ("closure", *leverage)),
    ]


def _quantities(drive: str, loads: tuple[Form, ...]) -> list[Quantity]:
    return [
        Quantity("theta3", "degree", "angle of the coupler B→C from x, counter-clockwise, in (-180, 180]"),
        Quantity("theta4", "degree", "angle of the rocker D→C from x, counter-clockwise, in (-180, 180]"),
        Quantity("transmission_angle", "degree", "acute angle between coupler and rocker"),
        Quantity("transmission_angle_signed", "degree", "mu = theta4 - theta3 of document 2 (ME 470), in (-180, 180]"),
        *bodies.position_quantities("B", "C"),
        *bodies.drive_quantities(bodies.drive_torque(FourBar.drives[drive], drive)),
        Quantity("velocity_ratio", "1", "angular velocity of the rocker per that of the crank"),
        Quantity("torque_ratio", "1", "torque that the rocker gives per torque on the crank, without any losses"),
        Quantity("mechanical_advantage", "1", "force across the rocker at C per force across the crank at B"),
        *machine_quantities(BODIES, PINS, LINKS, loads),
    ]
