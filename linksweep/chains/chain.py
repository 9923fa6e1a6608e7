"""The table of a machine made of a crank and dyads, and its square system of equations."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import NamedTuple

from linksweep.base.validate import refuse
from linksweep.chains.between_links import force_name, has_moment, name_between
from linksweep.chains.coupling import JAM
from linksweep.chains.cylinders import force_quantity
from linksweep.chains.drives import Drive, friction_problems
from linksweep.chains.dyads.rrr import Rows
from linksweep.chains.equations import arm_rows, contact_rows, cylinder_rows
from linksweep.chains.forces import Forces
from linksweep.chains.gears import gear_rows, teeth_quantities, torque_name
from linksweep.chains.limits import limits
from linksweep.chains.motion import Motion
from linksweep.chains.rows import bodies
from linksweep.chains.rows.beams import Beam
from linksweep.chains.rows.bodies import Source, xy
from linksweep.chains.rows.load_forms import Form
from linksweep.chains.rows.whole_machine import machine_quantities, machine_rows, power_rows
from linksweep.chains.shape import Shape
from linksweep.chains.topology import GROUND, clash_problems
from linksweep.engine.quantity import Quantity, Row, Table, Total, made_twice, others
from linksweep.physics.algebra import planar
from linksweep.physics.closures import chain as chains
from linksweep.physics.closures import crank_angle

BETWEEN = (
    Row(crank_angle.crank_from_tangent, ("cos2", "cos2_lo", "sin2", "sin2_lo")),
    Row(crank_angle.one_turn, ("radians2",)),
)
"""Rows of the crank's angle between samples."""


class Own(NamedTuple):
    """A drive, and what a machine of its own name adds to the rows of its dyad, or puts in their place."""

    unknown: Quantity
    rate: str
    rows: tuple[Row | Total, ...] = ()
    quantities: tuple[Quantity, ...] = ()
    between: tuple[Row, ...] = BETWEEN
    name: str = ""


FRICTION_POWER = Quantity("friction_power", "W", "power of friction on all sliders, never positive")


class Chain:
    """Motion and forces of all machines of a shape."""

    def __init__(self, shape: Shape):
        self.topology = shape.topology
        self.motion = Motion(shape)
        self.bodies = tuple(self.motion.bodies[role] for role in self.topology.roles)
        self.joints = {**self.topology.pins, **self.topology.slides}
        self.names = {self.topology.number(role): role for role in (GROUND, *self.topology.roles)}

    @cached_property
    def drives(self) -> dict[str, str]:
        """Unknown torque of each link that turns about a ground pin, or force of each cylinder that follows."""
        joined = self.topology
        follow = [role for role in joined.cylinders if role not in joined.struts]
        torques = {role: name_between("T", 1, joined.number(role)) for role in joined.on_ground}
        return torques | {role: f"force_{role}" for role in follow}

    def drive(self, name: str) -> Drive:
        """Return a drive by the name of its link or cylinder."""
        if name in self.topology.cylinders:
            hosts = tuple(self.topology.support[pin] for pin in self.topology.cylinders[name])
            return Drive(
                name,
                force_quantity(name),
                f"rate_{name}",
                f"lengthening_{name}",
                hosts,
                f"{self.topology.crank}_length",
            )
        unknown = bodies.drive_torque(self.drives[name], name)
        return Drive(name, unknown, f"omega{self.topology.number(name)}", self.motion.bodies[name].ratio, (name,))

    def drive_problems(self, name: str, rubbing: Collection[str]) -> list[str]:
        """Return the problems of a drive of a machine whose slides on these guides rub."""
        return [] if self.motion.plain else friction_problems(self.topology, self.drive(name), rubbing)

    @lru_cache(maxsize=16)  # noqa: B019
    def forces(self, name: str = "", rubbing: frozenset[str] = frozenset()) -> Forces:
        """Return the rows of the forces with a drive; with that of the crank where none is named."""
        return Forces(self.motion, self.drive(name) if name and not self.motion.plain else None, rubbing)

    @cached_property
    def unknowns(self) -> tuple[str, ...]:
        """Forces at pins, then normal force and moment of each slide, forces of struts, torques of gears."""
        of_pins = [part for i, j in self.topology.pins.values() for part in xy(force_name(i, j))]
        of_slides = (part for slide in self.topology.slides for part in self.slide_unknowns(slide))
        struts = (f"force_{role}" for role in self.topology.cylinders if role in self.topology.struts)
        return (*of_pins, *of_slides, *struts, *(torque_name(self.topology, role) for role in self.topology.gears))

    @cached_property
    def slide_forces(self) -> tuple[str, ...]:
        """Friction in each slide, and the components of its whole force."""
        names = [force_name(*pair) for pair in self.topology.slides.values()]
        return tuple(f"{name}{part}" for name in names for part in ("xy" if self.motion.plain else "txy"))

    @cached_property
    def kinematics(self) -> tuple[str, ...]:
        """Angle, rates and accelerations of all links but the crank, then of all that slides."""
        turning = [self.topology.number(role) for role in self.topology.links if role != self.topology.crank]
        of_links = [f"{word}{k}" for word in ("theta", "omega", "alpha") for k in turning]
        return (*of_links, *(names[k] for k in range(3) for names in self.motion.sliding.values()))

    def slide_unknowns(self, slide: str) -> tuple[str, ...]:
        """Return normal force and moment of a slide; a block without mass passes on no moment."""
        i, j = self.topology.slides[slide]
        moment = (name_between("T", i, j),) if has_moment(slide) else ()
        return (f"{force_name(i, j)}n", *moment)

    def own(self, drive: str, loads: tuple[Form, ...]) -> Own:
        """Return the drive of a link by a torque."""
        driven = self.drive(drive)
        return Own(driven.unknown, driven.rate, tuple(driven.rows()), name=drive)

    def table(
        self,
        own: Own,
        loads: tuple[Form, ...],
        rubbing: frozenset[str] = frozenset(),
        beams: tuple[str, ...] = (),
    ) -> Table:
        """Return the table of all quantities for a drive and loads of these forms; slides on guides `rubbing` rub, and
        the links `beams` have section forces."""
        driven = self.drive(own.name) if own.name else None
        forces = self.forces(own.name, frozenset() if driven is None or driven.is_crank else rubbing)
        coupling, limited = forces.coupling, None
        if not self.motion.plain:
            limited = limits(self.motion, rubbing, forces.coupled)
        drive, slider_pins = (own.name, own.unknown.name), {c.pair: (c.pin_x, c.pin_y) for c in forces.contacts}
        meshed, turning = self.motion.shape.meshed, self.motion.bodies
        straight = [Beam(self.topology, meshed, turning[role], loads, drive, slider_pins) for role in beams]
        rows = [
            *self.motion.rows,
            *forces.rows,
            *self._status(forces, driven),
            *power_rows(own.unknown.name, own.rate, self.bodies, loads, *forces.losses, *forces.powers),
            *machine_rows(self.bodies, self.joints, loads, **self.motion.certain),
            *arm_rows(self.motion),
            *contact_rows(forces.contacts),
            *cylinder_rows(self.topology),
            *gear_rows(self.motion),
            *(limited.rows if limited else []),
            *self._work(forces, own),
            *([] if self.motion.plain else [Total("friction_power", tuple(forces.losses))]),
            *(row for beam in straight for row in beam.all_rows()),
        ]
        friction = "drive, friction, loads, gravity and inertia" if self.topology.slides else ""
        quantities = [
            *self._motion_quantities(),
            *(quantity for slide in self.topology.slides for quantity in self._slide_quantities(slide)),
            *(bodies.drive_quantities(own.unknown, friction) if friction else bodies.drive_quantities(own.unknown)),
            *own.quantities,
            *(force_quantity(role) for role in self.topology.cylinders if role in self.topology.struts),
            *teeth_quantities(self.motion, self.names),
            *([FRICTION_POWER] if forces.losses and not self.motion.plain else []),
            *machine_quantities(self.bodies, self.joints, self.names, loads),
            *(quantity for beam in straight for quantity in beam.quantities()),
        ]
        last = {quantity.name: quantity for quantity in quantities}
        if self.motion.plain:
            rows = [*others(rows, own.rows), *own.rows]
        elif twice := made_twice(rows):
            refuse([*clash_problems(twice, (name for row in rows for name in row.outputs), self.topology)])
        table = Table("theta2", tuple(rows), tuple(last.values()), own.between)
        if not limited:
            return table
        of_drive = (coupling or driven).limits() if driven else ()
        contacts = (*limited.of_contacts, *(coupling.contacts() if coupling else ()))
        return replace(table, limits=(*limited.of_motion, *of_drive), contacts=contacts)

    def _work(self, forces: Forces, own: Own) -> Rows:
        """Return the rows of the work on the crank, and of the drive that it needs."""
        work = (*self.motion.work, *forces.work)
        if forces.coupling:
            return forces.coupling.rows(forces.rows, work)
        of_work = [Row(planar.opposite, (own.unknown.name,), ("work",))]
        return [Total("work", work), *(of_work if self.motion.plain else own.rows)]

    def _status(self, forces: Forces, drive: Drive | None) -> Rows:
        """Return rows of the status and its step: of the first dyad that does not close, else of the first jam.

        Where the driven part stands still, jams have no meaning; those that the drive decides come after the others,
        on which they depend.
        """
        rows: Rows = []
        status: Source = 0.0
        at: Source = 0.0
        steps = [*enumerate(forces.statuses, 1)]
        jams = [(k, jam) for k, (closure, jam) in steps if jam not in (closure, JAM)]
        jams += [(k, JAM) for k, (_, jam) in steps if jam == JAM][:1]
        standing = drive is not None and not drive.is_crank
        closures = [(k, closure) for k, (closure, _) in steps if len(steps) > 1 or standing or not jams]
        if drive and standing:
            place = [k for k, step in enumerate(self.topology.steps, 1) if drive.name in step.roles]
            closures.append(((*place, 1)[0], "drive_status"))
        if not closures + jams:  # a crank alone
            return [Row(planar.identity, ("status",), (0.0,))]
        for n, (k, one) in reversed([*enumerate([*closures, *jams])]):
            out = ("status", "status_at") if n == 0 else (f"status_from_{n}", f"status_at_from_{n}")
            rows.append(Row(chains.first_failure, out, (one, float(k), status, at)))
            status, at = out
        return rows

    def _counts(self, pin: str) -> bool:
        """Return whether a pin has results: in a machine of its own name, only a pin that joins links."""
        return not self.motion.plain or len(self.topology.members[pin]) > 1

    def _slide_quantities(self, slide: str) -> list[Quantity]:
        if self.motion.plain:
            return []
        i, j = self.topology.slides[slide]
        force, place = force_name(i, j), f"of link {i} ({self.names[i]}) on link {j} ({self.names[j]}) at the {slide}"
        moment = Quantity(name_between("T", i, j), "N m", f"moment {place}, about the slider's pin, counter-clockwise")
        return [
            Quantity(f"{force}n", "N", f"force {place}, component across the guide, positive to its left"),
            Quantity(f"{force}t", "N", f"friction {place}, component along the guide"),
            *([moment] if moment.name in self.slide_unknowns(slide) else []),
        ]

    def _motion_quantities(self) -> list[Quantity]:
        topology, quantities = self.topology, []
        for role, (first, second, *_) in topology.links.items():
            if role != topology.crank:
                words = f"angle of the {role} {first}→{second} from x, counter-clockwise, in (-180, 180]"
                quantities.append(Quantity(f"theta{topology.number(role)}", "degree", words))
        moving = [pin for pin, role in topology.support.items() if role != GROUND and self._counts(pin)]
        return [*quantities, *self.motion.quantities, *bodies.position_quantities(*moving)]


chain = lru_cache(maxsize=64)(Chain)
table = lru_cache(maxsize=64)(Chain.table)
