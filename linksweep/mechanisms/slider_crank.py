"""The slider-crank: crank 2 (A-B), rod 3 (B-C), slider 4 at C on a guide of the ground 1."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from linksweep.base.fields import of_kind, parameter
from linksweep.base.frozen import cached_beside
from linksweep.base.validate import Number
from linksweep.chains.chain import Own
from linksweep.chains.equations import equations
from linksweep.chains.on_crank import rrp
from linksweep.chains.on_crank.machine import OnCrank
from linksweep.chains.rows.bodies import Equation, newton_euler_equations
from linksweep.chains.rows.crank import BRANCH, BRANCH_SIGN, turned
from linksweep.chains.rows.load_forms import Form
from linksweep.chains.rows.pins import Journals
from linksweep.chains.topology import Topology, topology_of
from linksweep.engine.quantity import Row, Total
from linksweep.mechanisms.balance import first_moment, turning_with_crank
from linksweep.mechanisms.cylinder import PistonCylinder
from linksweep.mechanisms.drawing import Block, Drawing, Frame, Rail, direction, drawing_of
from linksweep.mechanisms.links import LINK, AnyLink
from linksweep.mechanisms.mechanism import register
from linksweep.mechanisms.single_dyad import SingleDyad
from linksweep.mechanisms.strokes import Stroke, slider_strokes
from linksweep.physics.closures import slider_crank

TOPOLOGY = topology_of("crank A-B, rod B-C, slider C on guide", ("A",), (("guide", "ground"),))
JOURNALS = {"A": 2, "B": 2, "C": 4}
"""As in engines: the crank carries crankshaft and crankpin, the piston the gudgeon pin; the rod has both its bushes."""
UNKNOWN_FORCES = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y")
FRICTION = Equation("friction on 4", {"F14x": (1.0, "friction_row_x"), "F14y": (1.0, "friction_row_y")}, "friction_rhs")
FRICTION_ROWS = Row(slider_crank.friction_row, ("friction_row_x", "friction_row_y")), Total("friction_rhs", ())
NO_CYCLE = Row(slider_crank.no_cycle_status, ("status",), ("jam_status", "assembly"))
GUIDE = Frame("guide", "slide_angle")


def _guide(mechanism: Any) -> Rail:
    """Return the guide of a slider-crank as plots draw it."""
    along = direction(mechanism.slide_angle)
    return Rail(float(mechanism.offset) * np.array([-along[1], along[0]]), along, offset=True)


@register
@dataclass(frozen=True, eq=False, repr=False)
class SliderCrank(SingleDyad):
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

    Friction wedges the slider where ``μ·|tan ψ| ≥ 1``, ψ the angle of the rod (with drive="coupler", of the crank) to
    the guide: status `jammed` where no force moves it on, `jammed_two_solutions` where the guide may press on either
    side (the statics of rigid bodies allows both). The slider does not turn: the place of its centre of gravity changes
    only `T14`, the guide's moment on it, and the shaking moment; its moment of inertia would change nothing, and is no
    parameter. A load with a cycle of full turns of the crank (see `GasPressure`) has no value in a design whose crank
    does not turn fully: status `no_cycle`.

    Examples
    --------
    >>> import linksweep as ls
    >>> crank, rod = ls.Disk(0.045, 0.06, 0.02, 7800), ls.Link(0.15, 0.6, 2.2e-3, cg_distance=0.05)
    >>> engine = ls.SliderCrank(crank, rod, slider_mass=0.5, friction=0.1)
    >>> worst = ls.peaks(ls.Scene(engine, omega2=300.0), of=["F32"])
    >>> print(f"{float(worst.F32_peak):.1f} N at {float(worst.F32_peak_at):.1f} degrees")
    5306.5 N at 0.9 degrees
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

    topology: ClassVar[Topology] = TOPOLOGY
    dyad: ClassVar[OnCrank] = rrp.MACHINE._replace(rows=(*rrp.MACHINE.rows, *FRICTION_ROWS))
    sizes: ClassVar[tuple[str, ...]] = ("crank", "rod", "offset")
    frame: ClassVar[tuple[str, str]] = ("guide", "slide_angle")
    first: ClassVar[tuple[str, ...]] = ("offset", "friction", "slider_mass", "guide_cos", "branch_sign", "slider_cg_x")
    journals: ClassVar[Journals] = JOURNALS
    balances_partly: ClassVar[bool] = True
    title: ClassVar[str] = "Slider-crank"
    drawing: ClassVar[Drawing] = drawing_of(
        TOPOLOGY,
        journals=JOURNALS,
        frames={**drawing_of(TOPOLOGY).frames, 4: GUIDE},
        blocks=(Block(4, "C", GUIDE, _guide),),
        ideal={"friction": 0.0},
    )

    @property
    def near_toggle_angle(self) -> Number:
        return 90.0 + self.slide_angle

    def own(self, drive: str, loads: tuple[Form, ...]) -> Own:
        own = super().own(drive, loads)
        return own._replace(rows=(*own.rows, NO_CYCLE)) if any(form.full_turns for form in loads) else own

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

    @cached_beside
    def jumps(self) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which friction jumps: dead centres, where the slider turns round."""
        return self.dead_centres() if np.any(self.friction) else ()

    def dead_centres(self) -> tuple[Number, ...]:
        """Compute the crank angles with the rod in line with the crank.

        Returns
        -------
        tuple of float or DataArray
            Angles [degree], for each branch stretched (C farthest from A), then folded; NaN in designs without any.
        """
        signs = [BRANCH_SIGN[self.branch]] if self.branch in BRANCH_SIGN else BRANCH_SIGN.values()
        return tuple(angle for sign in signs for angle in self._cylinder(sign).dead_centres())

    @property
    def strokes(self) -> dict[str, Stroke]:
        """Position of the slider, and its distance from the outer dead centre, which a load may follow."""
        a, b, e = self.by_role.values()
        return slider_strokes(a, b, e, self.slide_angle, BRANCH_SIGN[self.branch], self.dead_centres())

    @property
    def engine_cylinder(self) -> PistonCylinder:
        """The cylinder in which the slider is the piston, its head where the rod reaches farthest."""
        return self._cylinder(BRANCH_SIGN[self.branch])

    def _cylinder(self, side: float) -> PistonCylinder:
        a, b, e = self.by_role.values()
        return PistonCylinder(a, b, e, self.slide_angle, side)

    def balancing_moments(self, fraction: Number) -> dict[str, Any]:
        """Return the first moment that the crank lacks to cancel what turns, and a fraction of the first order."""
        reciprocating = self.slider_mass + first_moment(self.rod).real / self.rod.length
        return {"crank": -turning_with_crank(self.crank, self.rod) - fraction * self.crank.length * reciprocating}
