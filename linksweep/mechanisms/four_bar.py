"""The four-bar: crank 2 (A-B), coupler 3 (B-C), rocker 4 (D-C) on ground 1 (A-D)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from linksweep.base.fields import of_kind, parameter
from linksweep.base.frozen import bare, cached_property
from linksweep.base.validate import Number, is_lazy
from linksweep.chains.on_crank import rrr
from linksweep.chains.on_crank.machine import OnCrank
from linksweep.chains.rows.crank import BRANCH, BRANCH_SIGN
from linksweep.chains.shape import Shape
from linksweep.chains.topology import Topology, topology_of
from linksweep.engine.quantity import Quantity, Row
from linksweep.mechanisms.balance import first_moment, turning_with_crank
from linksweep.mechanisms.drawing import Drawing, drawing_of, ground_pins
from linksweep.mechanisms.links import LINK, AnyLink
from linksweep.mechanisms.mechanism import register
from linksweep.mechanisms.single_dyad import SingleDyad
from linksweep.mechanisms.strokes import Stroke, rocker_stroke
from linksweep.physics.closures import dyad_rrr, freudenstein
from linksweep.physics.closures.freudenstein import PositionEquation

TOPOLOGY = topology_of("crank A-B, coupler B-C, rocker D-C", ("A", "D"))
DOCUMENT_2 = (
    Row(dyad_rrr.transmission_angle_signed, ("transmission_angle_signed",)),
    Row(freudenstein.ratios, ("K1", "K2", "K3", "K4", "K5")),
    Row(freudenstein.rocker_equation, ("A", "B", "C")),
    Row(freudenstein.coupler_equation, ("D", "E", "F")),
)
SIGNED = Quantity("transmission_angle_signed", "degree", "mu = theta4 - theta3 of document 2 (ME 470), in (-180, 180]")


@register
@dataclass(frozen=True, eq=False, repr=False)
class FourBar(SingleDyad):
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
    >>> worst = ls.peaks(ls.Scene(press, omega2=30.0, gravity=(0.0, -9.81)), of=["F32"])
    >>> print(f"{float(worst.F32_peak):.1f} N at {float(worst.F32_peak_at):.1f} degrees")
    183.3 N at 15.0 degrees
    """

    crank: AnyLink = of_kind(LINK)
    coupler: AnyLink = of_kind(LINK)
    rocker: AnyLink = of_kind(LINK)
    ground: Number = parameter("length", above=0.0)
    branch: str = of_kind(BRANCH, "open")
    ground_angle: Number = parameter("angle", 0.0)

    topology: ClassVar[Topology] = TOPOLOGY
    dyad: ClassVar[OnCrank] = rrr.MACHINE._replace(
        rows=(*rrr.MACHINE.rows, *DOCUMENT_2), quantities=(SIGNED, *rrr.MACHINE.quantities)
    )
    sizes: ClassVar[tuple[str, ...]] = ("crank", "coupler", "rocker", "ground")
    first: ClassVar[tuple[str, ...]] = ("ground_length", "branch_sign")
    position_equation: ClassVar[PositionEquation | None] = freudenstein.POSITION_EQUATION
    title: ClassVar[str] = "Four-bar"
    drawing: ClassVar[Drawing] = drawing_of(TOPOLOGY, fixed=ground_pins)

    def lengths(self) -> dict[str, Number]:
        """Return the lengths of the four links.

        Returns
        -------
        dict of str to float or DataArray
            Lengths [m] by role.
        """
        return self.by_role

    @property
    def strokes(self) -> dict[str, Stroke]:
        """Angle of the rocker, as a position that a load may follow."""
        a, b, c, d = self.by_role.values()
        return {"rocker.angle": rocker_stroke(a, b, c, d, self.ground_angle, BRANCH_SIGN[self.branch])}

    @property
    def shape(self) -> Shape:
        return super().shape._replace(goes_through=frozenset({"C"} if self._goes_through else ()))

    def balancing_moments(self, fraction: Number) -> dict[str, Any]:
        """Return the first moments that crank and rocker lack for the centre of gravity to stand still."""
        on_rocker = first_moment(self.coupler) * (self.rocker.length / self.coupler.length)
        return {
            "crank": -turning_with_crank(self.crank, self.coupler),
            "rocker": -first_moment(self.rocker) - on_rocker,
        }

    @cached_property
    def _goes_through(self) -> bool:
        """True where a design may be a parallelogram or a kite, which change sides; other designs keep their bits."""
        lengths = self.by_role.values()
        if any(map(is_lazy, lengths)):
            return True
        a, b, c, d = map(bare, lengths)
        near = 1e-9 * (a + b + c + d)
        folds = abs(a + d - b - c) < near
        if folds is False or not np.any(folds):  # numpy takes long to look at a plain truth value
            return False
        opposite, adjacent = abs(a - c) < near, abs(a - b) < near
        return bool(np.any(folds & (opposite | adjacent)))
