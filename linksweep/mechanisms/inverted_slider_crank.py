"""The inverted slider-crank: crank 2 (A-B), block 3 on its pin B, rocker 4 about D, along which the block slides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from linksweep.base.fields import of_kind, parameter
from linksweep.base.frozen import cached_beside
from linksweep.base.validate import Number
from linksweep.chains.equations import add_force
from linksweep.chains.on_crank import rpr
from linksweep.chains.on_crank.machine import OnCrank
from linksweep.chains.rows.bodies import Equation
from linksweep.chains.rows.crank import BRANCH, BRANCH_SIGN
from linksweep.chains.topology import Topology, topology_of
from linksweep.mechanisms.balance import first_moment
from linksweep.mechanisms.drawing import Block, Carrier, Drawing, Frame, drawing_of, ground_pins
from linksweep.mechanisms.links import LINK, AnyLink
from linksweep.mechanisms.mechanism import register
from linksweep.mechanisms.single_dyad import SingleDyad
from linksweep.mechanisms.strokes import Stroke, block_stroke

TOPOLOGY = topology_of("crank A-B, block B on slide, rocker D-E", ("A", "D"), (("slide", "rocker"),))
ROCKER = Frame("rocker", "theta4")


@register
@dataclass(frozen=True, eq=False, repr=False)
class InvertedSliderCrank(SingleDyad):
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
    the place of F43x, F43y, which are computed besides. Friction, ``−μ·|F43n|·sign(slide_velocity)`` on the
    block along the line, takes the size of the normal force alone: the moment T43, two more normal forces at the ends
    of the block, brings no friction of its own. It wedges where ``μ·|e/slide| ≥ 1``, e the offset; with
    drive="rocker" where ``μ·|tan ψ| ≥ 1``, ψ the angle of the crank to the line: status `jammed` where no force moves
    it on, `jammed_two_solutions` where the rocker may press on either side. A cylinder overcomes friction everywhere.

    With drive="cylinder" the rocker is the barrel and the block the end of the rod: the unknown is the cylinder's force
    `cylinder_force` on the block along the rocker's line, positive in the direction of slide (branch="open": positive
    pushes B away from D), the opposite on the rocker. F43x, F43y are then all that the barrel does to the rod, the
    cylinder's force, friction and the side load F43n, T43 of its bushes; torques on crank and rocker are known loads.
    At the dead centres, with the crank in line with A-D, the cylinder cannot drive.

    Examples
    --------
    >>> import linksweep as ls
    >>> crank, rocker = ls.Disk(0.12, 0.2, 0.03, 7800), ls.Link(0.7, 18.0, 0.8, cg_distance=0.35)
    >>> shaper = ls.InvertedSliderCrank(crank, rocker, ground=0.36, block_mass=1.5)
    >>> motion = ls.geometry(ls.Scene(shaper, omega2=5.0))
    >>> print(f"swing {float(motion.swing):.2f} degrees, time ratio {float(motion.time_ratio):.3f}")
    swing 38.94 degrees, time ratio 1.552

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

    topology: ClassVar[Topology] = TOPOLOGY
    dyad: ClassVar[OnCrank] = rpr.MACHINE
    sizes: ClassVar[tuple[str, ...]] = ("crank", "ground", "offset")
    first: ClassVar[tuple[str, ...]] = (
        "ground_length",
        "ground_cos",
        "offset",
        "block_mass",
        "block_inertia",
        "branch_sign",
        "friction",
        "block_cg_x",
    )
    title: ClassVar[str] = "Inverted slider-crank"
    drawing: ClassVar[Drawing] = drawing_of(
        TOPOLOGY,
        joints={"A": (1, 2), "B": (3, 2), "slide": (4, 3), "D": (1, 4)},
        frames={2: Frame("crank, A→B", "theta2"), 3: ROCKER, 4: ROCKER},
        bars={2: ("A", "B")},
        moving=("B",),
        fixed=ground_pins,
        carrier=Carrier("rocker", 4, "D"),
        blocks=(Block(3, "B", ROCKER, on=(4, "D")),),
        ideal={"friction": 0.0},
    )

    def lengths(self) -> tuple[Number, ...]:
        """Return the lengths that alone decide the motion.

        Returns
        -------
        tuple of float or DataArray
            Crank, ground and offset [m].
        """
        return tuple(self.by_role.values())

    @property
    def strokes(self) -> dict[str, Stroke]:
        """Position of the block along the rocker's line, or extension of a cylinder, which a load may follow."""
        a, d, e = self.by_role.values()
        return {"block.position": block_stroke(a, d, e, self.ground_angle, BRANCH_SIGN[self.branch])}

    def unknowns(self, drive: str) -> tuple[str, ...]:
        """Return the nine unknowns of the 9×9: the contact of rocker and block as normal force and moment."""
        return ("F12x", "F12y", "F32x", "F32y", "F43n", "T43", "F14x", "F14y", self.drives[drive])

    def peak_quantities(self, drive: str) -> tuple[str, ...]:
        return ("F12", "F32", "F43", "F14", "T43", self.drives[drive])

    def equations(self, drive: str) -> tuple[Equation, ...]:
        """Return the 9×9: the rows of document 2 (ME 470), with a cylinder along the rocker's line (r3x, r3y)."""
        rows = super().equations(drive)
        if drive == "cylinder":
            add_force(rows[3:6], self.drives[drive], 1.0, ("r3x", "r3y", "line_arm3"))
            add_force(rows[6:], self.drives[drive], -1.0, ("r3x", "r3y", "line_arm4"))
        return rows

    def balancing_moments(self, fraction: Number) -> dict[str, Any]:
        """Return the first moments that crank and rocker lack for the centre of gravity to stand still."""
        rocker_and_block = first_moment(self.rocker) + self.masses()["block"].first_moment()
        crank = first_moment(self.crank) + self.block_mass * self.crank.length
        return {"crank": -crank, "rocker": -rocker_and_block}

    @cached_beside
    def jumps(self) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which friction jumps: where the block turns round on its line."""
        if not np.any(self.friction):
            return ()
        a, d, e = self.by_role.values()
        with np.errstate(invalid="ignore"):  # 0/0 where the block is out of reach
            near, far = (np.divide(0.0, abs(e) < reach) for reach in (abs(d - a), d + a))
        return self.ground_angle + near, self.ground_angle + 180.0 + far
