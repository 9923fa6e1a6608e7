"""The four-bar: crank 2 (A-B), coupler 3 (B-C), rocker 4 (D-C) on ground 1 (A-D)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np

from linksweep.base.fields import of_kind, parameter
from linksweep.base.validate import Number, is_lazy
from linksweep.chains.chain import Own
from linksweep.chains.rows import bodies
from linksweep.chains.rows.crank import BRANCH, BRANCH_SIGN, between_rows, frame_parameters, in_range, turned
from linksweep.chains.rows.load_forms import Form
from linksweep.chains.shape import Shape
from linksweep.chains.topology import Topology, topology_of
from linksweep.engine.quantity import Quantity, Row
from linksweep.mechanisms.balance import first_moment, on_crank
from linksweep.mechanisms.drawing import Drawing, ground_pins
from linksweep.mechanisms.limits import four_bar_limits as limits
from linksweep.mechanisms.limits.finding import Checks
from linksweep.mechanisms.linkage_drawing import drawing_of
from linksweep.mechanisms.links import LINK, AnyLink, link_parameters
from linksweep.mechanisms.machine import Machine
from linksweep.mechanisms.mechanism import register
from linksweep.mechanisms.strokes import Stroke, rocker_stroke
from linksweep.physics import advantage, crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import dyad_rrr, freudenstein
from linksweep.physics.closures.freudenstein import PositionEquation

TOPOLOGY = topology_of("crank A-B, coupler B-C, rocker D-C", ("A", "D"))
DRIVES = {"crank": "T12", "coupler": "T13", "rocker": "T14"}


@register
@dataclass(frozen=True, eq=False, repr=False)
class FourBar(Machine):
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

    drives: ClassVar[dict[str, str]] = DRIVES
    position_equation: ClassVar[PositionEquation | None] = freudenstein.POSITION_EQUATION
    topology: ClassVar[Topology] = TOPOLOGY
    title: ClassVar[str] = "Four-bar"
    drawing: ClassVar[Drawing] = replace(drawing_of(TOPOLOGY), fixed=ground_pins)

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

    @property
    def shape(self) -> Shape:
        frame, kite = ({"C"} if turned(self.ground_angle) else ()), ({"C"} if self._goes_through else ())
        return Shape(TOPOLOGY, turned=frozenset(frame), goes_through=frozenset(kite), plain=True)

    def own(self, drive: str, loads: tuple[Form, ...]) -> Own:
        return _own(drive)

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


@lru_cache
def _own(drive: str) -> Own:
    """Return a drive, the ratios of the rocker's velocity and torque to the crank's, and the document's numbers."""
    radii = ("crank_length", "rocker_length")
    rows = (
        Row(planar.along, ("Dx", "Dy"), ("ground_length", "ground_cos", "ground_sin")),
        Row(dyad_rrr.transmission_angle_signed, ("transmission_angle_signed",)),
        Row(freudenstein.ratios, ("K1", "K2", "K3", "K4", "K5")),
        Row(freudenstein.rocker_equation, ("A", "B", "C")),
        Row(freudenstein.coupler_equation, ("D", "E", "F")),
        Row(planar.identity, ("velocity_ratio",), ("ratio4",)),
        Row(advantage.torque_ratio, ("torque_ratio",)),
        Row(advantage.mechanical_advantage, ("mechanical_advantage",), ("velocity_ratio", *radii)),
    )
    quantities = (
        Quantity("transmission_angle_signed", "degree", "mu = theta4 - theta3 of document 2 (ME 470), in (-180, 180]"),
        Quantity("velocity_ratio", "1", "angular velocity of the rocker per that of the crank"),
        Quantity("torque_ratio", "1", "torque that the rocker gives per torque on the crank, without any losses"),
        Quantity("mechanical_advantage", "1", "force across the rocker at C per force across the crank at B"),
    )
    torque = bodies.drive_torque(DRIVES[drive], drive)
    driven = () if drive == "crank" else _driven_beyond_the_crank(drive)
    between = between_rows("ground_cos", "ground_sin")
    return Own(torque, f"omega{TOPOLOGY.number(drive)}", (*rows, *driven), quantities, between)


def _driven_beyond_the_crank(drive: str) -> tuple[Row, ...]:
    """Return rows in which the crank's moment equation takes the place of the driven link's.

    The drive's torque, whose leverage may vanish, comes with the force at C, so that both have the same error.
    """
    free, ratio, torque = {
        "coupler": (("r4x", "r4y", "N4"), "ratio3", dyad_rrr.rrr_coupler_torque),
        "rocker": (("r3x", "r3y", "moment_r3"), "ratio4", dyad_rrr.rrr_rocker_torque),
    }[drive]
    leverage = ("leverage", "crank_length", {"coupler": "rocker_length", "rocker": "coupler_length"}[drive])
    crank, inverse = ("r2x", "r2y", "crank_length", "moment_r2"), "inverse_r4_cross_r3"
    force = ("push_rocker_Cx", "push_rocker_Cy", "pull", "push")
    return (
        Row(planar.opposite, ("moment_r3",), ("N3",)),
        Row(crank_driven.moment_on_crank, ("moment_r2",)),
        Row(dyad_rrr.rrr_leverage, ("leverage",), (ratio, inverse)),
        Row(crank_driven.away_from_dead_centre, ("driven_ratio",), (ratio, *leverage)),
        Row(dyad_rrr.rrr_driven_pin_force, force, (*crank, *free, "driven_ratio", inverse)),
        Row(torque, (DRIVES[drive],)),
        Row(crank_driven.drive_status, ("status",), ("closure", *leverage)),
    )
