"""A scotch yoke, written as a user of linksweep would write it: crank 2 (A-B), yoke 4 on a guide along x.

The crank's pin B runs in the yoke's slot, square to the guide. With r = A→B of length a, the yoke's point C, where the
slot crosses the guide, moves by

    x = a cos θ2        dx/dθ2 = −a sin θ2        d²x/dθ2² = −a cos θ2

There is no friction: the slot presses on B along x only, and the guide carries F14y and the moment T14 about C.
Q and N are a link's effective force and moment, as in `linksweep.physics.inertia`.
"""

from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from linksweep.base.fields import of_kind, parameter
from linksweep.base.validate import Number
from linksweep.chains.finding import Finding, turning_round
from linksweep.chains.rows.bodies import (
    CRANK,
    Body,
    crank_pin_rows,
    drive_quantities,
    drive_torque,
    newton_euler_equations,
    position_quantities,
)
from linksweep.chains.rows.crank import between_rows, straight_rows
from linksweep.chains.rows.pins import Journals, Pins, rotating
from linksweep.chains.rows.whole_machine import machine_quantities, machine_rows, power_rows
from linksweep.engine.quantity import Quantity, Row, Table
from linksweep.mechanisms.drawing import Block, Carrier, Drawing, Frame, Rail
from linksweep.mechanisms.links import LINK, AnyLink, cg_parameters, link_parameters
from linksweep.mechanisms.mechanism import MECHANISMS, Mechanism, register
from linksweep.physics import crank_driven
from linksweep.physics.algebra import planar

LINKS = {1: "ground", 2: "crank", 4: "yoke"}
PINS = {"A": (1, 2), "B": (4, 2), "guide": (1, 4)}
YOKE = Body(
    4,
    "yoke",
    pin_velocity=("v_yoke", 0.0),
    pin_acceleration=("a_yoke", 0.0),
    pin_position=("Cx", "Cy"),
    pin_ratio=("ratio_yoke", 0.0),
    pin_slope=("slope_yoke", 0.0),
)
GUIDE = Frame("guide", 0.0)
TRANSLATES = {"yoke_inertia": 0.0, "yoke_length": 1.0, "r4x": 1.0, "r4y": 0.0, "omega4": 0.0, "alpha4": 0.0}
"""Numbers of the yoke as a body that does not turn; its axes are those of the ground."""


@dataclass(frozen=True, eq=False, repr=False)
class ScotchYoke(Mechanism):
    """A scotch yoke: compressor, valve actuator, sine generator.

    Parameters
    ----------
    crank : Link, Bar or Disk
        Crank; its first pin is A, its second runs in the slot.
    yoke_mass : float
        Mass of the yoke [kg].
    yoke_cg_distance : float, default 0.0
        Distance of the yoke's centre of gravity from C [m].
    yoke_cg_angle : float, default 0.0
        Angle of the centre of gravity from the guide's direction, counter-clockwise [degree].
    """

    crank: AnyLink = of_kind(LINK)
    yoke_mass: Number = parameter("mass", at_least=0.0)
    yoke_cg_distance: Number = parameter("length", 0.0, at_least=0.0, polar=True)
    yoke_cg_angle: Number = parameter("angle", 0.0)

    drives: ClassVar[dict[str, str]] = {"crank": "T12"}
    roles: ClassVar[tuple[str, ...]] = ("crank", "yoke")
    sliders: ClassVar[tuple[str, ...]] = ("yoke",)
    pins: ClassVar[Pins] = rotating(PINS)
    journals: ClassVar[Journals] = {"A": 2, "B": 2}
    bodies: ClassVar[tuple[Body, ...]] = (CRANK, YOKE)
    closes_everywhere: ClassVar[bool] = True
    drawing: ClassVar[Drawing] = Drawing(
        joints=PINS,
        journals=journals,
        frames={2: Frame("crank, A→B", "theta2"), 4: GUIDE},
        bars={2: ("A", "B"), 4: ("C", "B")},
        moving=("B", "C"),
        carrier=Carrier("crank", 2, "A"),
        blocks=(Block(4, "C", GUIDE, lambda mechanism: Rail(np.zeros(2), np.array([1.0, 0.0]))),),
        acts_at={"guide": "C"},
    )

    def parameters(self):
        yoke_cg = cg_parameters("yoke", self.yoke_cg_distance, self.yoke_cg_angle)
        return TRANSLATES | {"yoke_mass": self.yoke_mass} | yoke_cg | link_parameters("crank", self.crank)

    def table(self, drive, loads):
        return table(loads)

    def kinematics(self):
        return ("Cx", "v_yoke", "a_yoke")

    def unknowns(self, drive):
        return ("F12x", "F12y", "F42x", "F14y", "T14", "T12")

    def dynamics(self, drive):
        return (*self.unknowns(drive), "F42y", "F14x")

    def equations(self, drive):
        crank = newton_euler_equations(2, {"F12": (1.0, "R12"), "F42": (1.0, "R42")}, "T12")
        yoke = newton_euler_equations(4, {"F42": (-1.0, "R24"), "F14": (1.0, "R14")}, "T14")
        return tuple(row.without("F42y").without("F14x") for row in (*crank, *yoke))

    def peak_quantities(self, drive):
        return ("F12", "F42", "F14", "T12")

    def findings(self):
        return ((travel, (self.crank.length,)),)

    def stroke_findings(self):
        return ((travel, (self.crank.length,)),)


@contextmanager
def registered():
    """Let scene files and results know the machine for a while, and forget it afterwards."""
    yield register(ScotchYoke)
    del MECHANISMS[ScotchYoke.__name__]


def travel(a):
    """Closed forms of the yoke's way: it turns round where the crank lies along the guide."""
    stroke = Finding(2.0 * a, "travel of the yoke from one dead centre to the other", "m")
    return {"stroke": stroke} | turning_round(0.0 * a, 180.0 + 0.0 * a)


def work_on_crank(N2, Q4x, ratio_yoke):
    """Virtual work per radian of the crank of all loads, weights and inertia forces."""
    return N2 + ratio_yoke * Q4x


def crank_balance(F42x, F42y, Q2x, Q2y):
    """Return F12, from F12 + F42 + Q2 = 0."""
    return -F42x - Q2x, -F42y - Q2y


def moment_of_guide(N4, Q4x, r2y):
    """T14, from T14 + N4 + r2y·Q4x = 0 about C: the pin presses with −Q4x at the height r2y."""
    return -N4 - r2y * Q4x


@lru_cache(maxsize=64)
def table(loads):
    rows = [
        *straight_rows("cos2", "sin2"),
        Row(planar.identity, ("near_toggle_near",), (1.0,)),
        Row(planar.identity, ("near_toggle_far",), (1.0,)),
        Row(planar.identity, ("assembly",), (0.0,)),
        Row(planar.identity, ("status",), (0.0,)),
        *crank_pin_rows(),
        Row(planar.vector_sum, ("Cx", "Cy"), (0.0, 0.0, "r2x", 0.0)),
        Row(planar.opposite, ("ratio_yoke",), ("r2y",)),
        Row(planar.opposite, ("slope_yoke",), ("r2x",)),
        Row(planar.product, ("v_yoke",), ("omega2", "ratio_yoke")),
        Row(crank_driven.angular_acceleration, ("a_yoke",), ("omega2", "alpha2", "ratio_yoke", "slope_yoke")),
        Row(planar.vector_sum, ("F42x", "F42y"), (0.0, 0.0, "Q4x", 0.0)),
        Row(planar.difference, ("F14x", "F14y"), (0.0, 0.0, 0.0, "Q4y")),
        Row(crank_balance, ("F12x", "F12y"), ("F42x", "F42y", "Q2x", "Q2y")),
        Row(moment_of_guide, ("T14",)),
        Row(work_on_crank, ("work",)),
        Row(planar.opposite, ("T12",), ("work",)),
        *power_rows("T12", "omega2", (CRANK, YOKE), loads),
        *machine_rows((CRANK, YOKE), PINS, loads),
        Row(planar.difference, ("R12x", "R12y"), (0.0, 0.0, "rG2x", "rG2y")),
        Row(planar.difference, ("R42x", "R42y"), ("r2x", "r2y", "rG2x", "rG2y")),
        Row(planar.difference, ("R14x", "R14y"), (0.0, 0.0, "rG4x", "rG4y")),
        Row(planar.difference, ("R24x", "R24y"), (0.0, "r2y", "rG4x", "rG4y")),
        Row(planar.identity, ("velocity_ratio",), ("ratio_yoke",)),
    ]
    return Table("theta2", tuple(rows), tuple(quantities(loads)), between_rows(1.0, 0.0))


def quantities(loads):
    return [
        Quantity("v_yoke", "m/s", "velocity of the yoke"),
        Quantity("a_yoke", "m/s^2", "acceleration of the yoke"),
        Quantity("T14", "N m", "moment of the guide on the yoke about C, positive counter-clockwise"),
        Quantity("velocity_ratio", "m/rad", "velocity of the yoke per angular velocity of the crank"),
        *position_quantities("B", "C"),
        *drive_quantities(drive_torque("T12", "crank")),
        *machine_quantities((CRANK, YOKE), PINS, LINKS, loads),
    ]
