"""The base class of every machine, and the register in which all machines stand."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, Self, TypeVar

import numpy as np

from linksweep.base.equality import ByContent
from linksweep.base.fields import ANYTHING, declared, field_problems
from linksweep.base.frozen import bare, cached_copy, cached_property
from linksweep.base.validate import Number, refuse
from linksweep.chains.finding import Checks
from linksweep.chains.gears import Geared
from linksweep.chains.rows.bodies import Body, Equation
from linksweep.chains.rows.crank import BRANCH_SIGN, STATUS_OF_CRANK, OverDesigns
from linksweep.chains.rows.load_forms import Form
from linksweep.chains.rows.pins import Journals, Pins
from linksweep.engine.quantity import Table
from linksweep.engine.run import Field
from linksweep.mechanisms.balance import MassDistribution, distribution
from linksweep.mechanisms.cylinder import PistonCylinder
from linksweep.mechanisms.drawing import Drawing, Track
from linksweep.mechanisms.links import links_of, with_distribution
from linksweep.mechanisms.strokes import Stroke
from linksweep.physics.closures.freudenstein import PositionEquation

Kind = TypeVar("Kind", bound="type[Mechanism]")


@dataclass(frozen=True, eq=False, repr=False)
class Mechanism(ByContent, ABC):
    """A machine: a frozen dataclass of its numbers, and a table of the quantities that can be computed of it.

    Unless it states otherwise, its crank turns as a scene prescribes with `omega2` and `alpha2`, and the results are
    over the crank angle `theta2`. Derive a dataclass, implement the abstract methods, and register it::

        @register
        @dataclass(frozen=True, eq=False, repr=False)
        class ScotchYoke(Mechanism):
            crank: AnyLink = of_kind(LINK)
            yoke_mass: Number = parameter("mass", at_least=0.0)

            roles = ("crank", "yoke")
            ...

    Scenes, scene files, sweeps, checks, peaks and studies then take it like the machines of this package.
    """

    index: ClassVar[str] = "theta2"
    """The dimension of a sweep."""
    period: ClassVar[float] = 360.0
    """One turn, in units of the index [degree]."""
    geared: ClassVar[Geared] = ()
    """Wheels that make no whole number of turns per turn of the crank, with their ratios."""
    position: ClassVar[str] = "angle of the crank from x, positive counter-clockwise"
    """Description of the index in results."""
    spot: ClassVar[str] = "crank angle"
    """Noun for one value of the index, for sentences and labels."""
    pace: ClassVar[str] = "omega2"
    """The quantity that is the rate of the index."""
    motion: ClassVar[tuple[str, ...]] = ("omega2", "alpha2", "drive", "loads", "section")
    """Parameters of a scene that the machine takes besides gravity; the first is required."""
    defaults: ClassVar[Mapping[str, Any]] = {"drive": "crank"}
    """Values of those parameters of `motion` that a scene leaves out."""
    drives: ClassVar[Mapping[str, str]] = {}
    """Names of the unknown torque or force, by the part that can be driven."""
    roles: ClassVar[tuple[str, ...]] = ()
    """Roles of the moving links, on which loads may act."""
    sliders: ClassVar[tuple[str, ...]] = ()
    """Roles of the links that slide on the ground; one number is a force along their guide."""
    on_ground: ClassVar[tuple[str, ...]] = ()
    """Roles of the links that turn about a ground pin."""
    pins: ClassVar[Pins] = {}
    """Numbers of the two links of each pin, by its letter."""
    journals: ClassVar[Journals] = {}
    """Number of the link that carries the journal of each pin."""
    bodies: ClassVar[tuple[Body, ...]] = ()
    """The moving links as bodies with mass."""
    beams: ClassVar[tuple[str, ...]] = ()
    """Roles of the links that are beams, of which section forces and stresses can be computed."""
    status_meanings: ClassVar[tuple[str, ...]] = STATUS_OF_CRANK
    """Meaning of each value of `status`."""
    places: ClassVar[tuple[str, ...]] = ()
    """Pins, or links past a pin, in the order in which they find their places, of which `status_at` names one."""
    round_trip: ClassVar[str] = "whether every angle is ok: assembled, not jammed, not at a dead centre"
    """Description of the status of peaks."""
    round_meanings: ClassVar[tuple[str, ...]] = ("ok", "partial_revolution", "cannot_assemble", "unbounded")
    """Meaning of each value of the status of peaks."""
    lap_ends: ClassVar[tuple[str, ...]] = ()
    """Names of those numbers of the motion that may end a lap early: positions [rad], infinite where they do not."""
    title: ClassVar[str] = ""
    """Kind of machine in words; where empty, the name of the class."""
    runs: ClassVar[str] = "run"
    """Verb for a machine that has results all the way round."""
    highlights: ClassVar[Mapping[str, str]] = {}
    """Titles of the quantities whose peak, or range, a report shows besides forces."""
    drawing: ClassVar[Drawing | None] = None
    """Linkage as plots draw it; None where it cannot be drawn."""
    track: ClassVar[Track | None] = None
    """Track of a car, where the machine is one."""
    branch = "open"
    """The assembly: "open", "crossed" or "both"; a machine with a single assembly has no such parameter."""
    friction = 0.0
    """Coefficient of Coulomb friction of the part that slides; a machine without one has no such parameter."""
    balances_partly: ClassVar[bool] = False
    """True where counterweights on the links cancel no more than a fraction of the first order of the shaking force."""
    position_equation: ClassVar[PositionEquation | None] = None
    """The position equation that a source document prints for the machine."""

    @property
    def turns(self) -> int:
        """Turns of the crank after which the motion repeats, but for lengths that change with its angle."""
        return math.lcm(*(ratio.denominator for _, ratio in self.geared))

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse(field_problems(self))
        refuse(self.closure_problems())

    @property
    def fastest(self) -> float:
        """Most turns that gears give a link per turn of the crank; 1 without gears."""
        return 1.0

    @abstractmethod
    def parameters(self) -> dict[str, Any]:
        """Return the numbers of the machine under the names that the physics takes; a Field where it adds a dim."""

    def clash_problems(self, twice: Collection[str], names: Collection[str]) -> list[str]:
        """Return the problem of each name that two numbers would have; `names` are those of all numbers."""
        return [f"two numbers of the machine would be called {name}" for name in twice]

    @abstractmethod
    def table(self, drive: str, loads: tuple[Form, ...]) -> Table:
        """Return the table of all quantities that can be computed for this drive and loads of these forms."""

    @abstractmethod
    def kinematics(self) -> tuple[str, ...]:
        """Return the names of the kinematic quantities that a sweep computes by default."""

    @abstractmethod
    def unknowns(self, drive: str) -> tuple[str, ...]:
        """Return the unknowns of the square system of equations."""

    @abstractmethod
    def equations(self, drive: str) -> tuple[Equation, ...]:
        """Return the rows of the square system of equations."""

    @abstractmethod
    def peak_quantities(self, drive: str) -> tuple[str, ...]:
        """Return the names of the quantities whose peaks are computed by default."""

    def dynamics(self, drive: str) -> tuple[str, ...]:
        """Return the names of the forces and torques that a sweep computes by default."""
        return self.unknowns(drive)

    def document_form(self, drive: str) -> tuple[tuple[str, ...], tuple[Equation, ...]]:
        """Return unknowns and rows of the square system as the source document prints them."""
        return self.unknowns(drive), self.equations(drive)

    def choices(self) -> Mapping[str, Collection[str]]:
        """Return the allowed values of each parameter of `motion` that is a choice."""
        return {"drive": self.drives}

    def motion_parameters(self, values: Mapping[str, Any]) -> dict[str, Number]:
        """Return the numbers of the motion under the names that the physics takes, of a scene's parameters by name."""
        alpha2, section = values["alpha2"], values["section"]
        numbers = {"omega2": values["omega2"], "alpha2": 0.0 if alpha2 is None else alpha2}
        return numbers if section is None else {**numbers, "section": section}

    def at_angles(self, sample: Callable[[str, Any], tuple[Number, Number, Number]]) -> Self:
        """Return the machine with its lengths that change over the revolution evaluated at the angles of a grid.

        `sample` takes path and length, and returns the values there and the first two derivatives [m/rad, m/rad²].
        """
        return self

    def remarks(self, parameters: Mapping[str, Any]) -> dict[str, str]:
        """Return remarks on parameters of the motion, by name, for a report. `parameters` are a scene's."""
        return {}

    def driven_numbers(self, motion: Mapping[str, Number]) -> OverDesigns:
        """Return functions that derive further numbers of the physics from the design and its motion."""
        return ()

    @property
    @cached_copy
    def bare(self) -> Self:
        """Machine whose arrays have no labels."""
        return bare(self)

    @cached_property
    def engine_parameters(self) -> dict[str, Any]:
        """`parameters`, computed once."""
        return self.parameters()

    @cached_property
    def parts(self) -> Mapping[str, Any]:
        """Links that are parameters of the machine, and other parts with a mass or a length, by role."""
        return links_of(self)

    def masses(self) -> dict[str, MassDistribution]:
        """Return the mass distribution of each moving link by role: a part's own, or parameters such as block_mass."""
        parts, names = self.parts, MassDistribution._fields
        return {
            role: distribution(parts[role])
            if role in parts
            else MassDistribution(*(getattr(self, f"{role}_{name}", 0.0) for name in names))
            for role in self.roles
        }

    def with_masses(self, masses: Mapping[str, MassDistribution]) -> Self:
        """Return a copy whose links have other mass distributions, by role; a number that has no parameter stays 0."""
        parts, own = self.parts, {item.name for item in fields(self)}
        changed: dict[str, Any] = {}
        for role, placed in masses.items():
            numbers = placed._asdict()
            if role in parts:
                changed[role] = with_distribution(parts[role], numbers)
            else:
                changed |= {f"{role}_{name}": n for name, n in numbers.items() if f"{role}_{name}" in own}
        return replace(self, **changed)

    def beam_problem(self, role: str) -> str:
        """Return why a link is no beam, and what to do; empty for one that is."""
        return "its machine has no links that are beams"

    def beam_numbers(self) -> dict[str, Number]:
        """Return sections, mass along the link, and ends of all beams under the names that the physics takes."""
        return {}

    def third_pins_along(self, role: str) -> list[Number]:
        """Return the distances of a link's third pins from its first, along its line of pins [m]."""
        return []

    def pin_place(self, role: str, pin: str) -> tuple[Number, Number]:
        """Return a pin of a link in the link's own polar coordinates [m, degree]; its first where no link is a beam."""
        return 0.0, 0.0

    def balancing_moments(self, fraction: Number) -> dict[str, Any]:
        """Return the first moments mx + i·my [kg m] that links lack for balance, by role; {} where not known.

        `fraction` is the part of the first order to balance, in a machine that `balances_partly`.
        """
        return {}

    @property
    def frictions(self) -> Mapping[str, Number]:
        """Coefficients of Coulomb friction under the names that the physics takes."""
        return {"friction": self.friction}

    @property
    def teeth(self) -> Mapping[str, Number]:
        """Tangents of the pressure angles of gears, under the names that the physics takes."""
        return {}

    @property
    def not_linear(self) -> str:
        """Reasons for which forces are not linear in masses and loads, in words; empty where they are."""
        reasons = {"friction": self.rubs, "pressure angles of gears": bool(self.teeth)}
        return " and ".join(reason for reason, holds in reasons.items() if holds)

    @cached_property
    def rubs(self) -> bool:
        """True where some part slides with friction."""
        return any(mu != 0.0 if type(mu) is float else np.any(mu) for mu in self.frictions.values())

    @property
    def engine_cylinder(self) -> PistonCylinder:
        """The cylinder in which gas presses on the link "slider". For one branch only."""
        raise NotImplementedError

    def stroke_findings(self) -> Checks:
        """Return the closed forms of the output's stroke or swing, time ratio and reversals."""
        return ()

    def closure_problems(self) -> list[str]:
        """Return the problem of a single design that can never be assembled; in a batch, its results are NaN."""
        return []

    @property
    def branch_sign(self) -> float | Field:
        """1 for open, -1 for crossed; for both, the two over the dim `branch`."""
        return BRANCH_SIGN.get(self.branch, Field(("branch",), np.array(list(BRANCH_SIGN.values()))))

    @property
    def branches(self) -> dict[str, str]:
        """Branch by its path, of each assembly that can be chosen: "open", "crossed" or "both"."""
        own = any(field.name == "branch" for field in fields(self))
        return {"branch": self.branch} if own else {}

    @property
    def both_branches(self) -> dict[str, str]:
        """Path of each branch that is "both", by the dim that it adds to results."""
        return {"branch": "branch"} if self.branch == "both" else {}

    def coordinates(self) -> dict[str, list[str]]:
        """Return the labels of each dim that the machine itself adds to results."""
        return {dim: list(BRANCH_SIGN) for dim in self.both_branches}

    @property
    def strokes(self) -> dict[str, Stroke]:
        """Positions of links that a load may follow, by name. For one branch only."""
        return {}

    @property
    def near_toggle_angle(self) -> Number:
        """Angle [degree] about which, and opposite to which, the machine comes nearest to a toggle."""
        return 0.0

    @property
    def closes_everywhere(self) -> bool:
        """True where every design closes at every angle, with a margin far above rounding."""
        return False

    def always_ok(self, drive: str) -> bool:
        """Return whether the numbers alone ensure status 0 at every sample; other drives than the crank do not."""
        return drive == "crank" and self.closes_everywhere

    def ok_clear_of_toggles(self, drive: str) -> bool:
        """Return whether a design that is ok where it comes nearest to its toggles is ok at every angle."""
        return False  # where parts hardly move, noise hides near-toggles from a search

    def jumps(self) -> tuple[Number, ...]:
        """Return the crank angles [degree] at which a force may jump."""
        return ()

    def seams(self, profile: str) -> tuple[float, ...]:
        """Return the positions [degree] at which a lap begins with other values than it ends."""
        return ()

    def directions(self) -> tuple[str, ...]:
        """Return the directions of sliding that change at all jumps; where they are known, forces are smooth."""
        return ()

    def kinks(self) -> tuple[str, ...]:
        """Return the quantities at whose change of sign others have a kink."""
        return ()

    def findings(self) -> Checks:
        """Return the closed-form checks of the machine alone, each with its numbers."""
        return ()

    def output_findings(self) -> Checks:
        """Return the checks for angles at which the output stands still, where its force is unbounded."""
        return ()

    def driven_findings(self, motion: Mapping[str, Any]) -> Checks:
        """Return the closed-form checks that depend on the motion and its drive."""
        return ()


MECHANISMS: dict[str, type[Mechanism]] = {}
"""Every registered machine by the name of its class, which is its `type` in a scene file."""


def register(kind: Kind) -> Kind:
    """Add a machine to `MECHANISMS`; a decorator of its dataclass, or one call.

    Scene, scene files and results look machines up in `MECHANISMS` at the moment of use, so that a machine may be
    registered at any time; ``del MECHANISMS["ScotchYoke"]`` removes it. A field of no stated kind is
    refused.
    """
    unstated = [f.name for f in declared(kind) if f.kind is ANYTHING and not isinstance(f.default, str)]
    advice = "must state what it holds: parameter(...) for a number, of_kind(LINK) for a link"
    refuse([f"{kind.__name__}.{name}: {advice}" for name in unstated])
    MECHANISMS[kind.__name__] = kind
    return kind


def indices() -> tuple[str, ...]:
    """Return the names that the dimension of a sweep may have."""
    return tuple(dict.fromkeys(kind.index for kind in MECHANISMS.values()))
