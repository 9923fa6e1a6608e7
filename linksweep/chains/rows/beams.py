"""Rows of the section forces of links that are beams, over the dim `section`: shares of the way along a link's pins."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from itertools import count
from typing import NamedTuple

from linksweep.chains.between_links import force_name, has_moment, name_between
from linksweep.chains.rows.bodies import Body, Source, xy
from linksweep.chains.rows.load_forms import Form, named
from linksweep.chains.topology import GROUND, Topology
from linksweep.engine.quantity import Quantity, Row, Total
from linksweep.physics import beam, bearing
from linksweep.physics.algebra import planar

Rows = list[Row | Total]
SECTION = "section"
"""The share at which section forces are computed, an input; by default over a dim of that name."""
FORCES = ("axial_force", "shear_force", "bending_moment")
STRESSES = ("stress{}_left", "stress{}_right", "stress{}")


class Point(NamedTuple):
    """A force, a torque, or both, by name, at a point of a link in its own axes; `last` is the pin at its end."""

    force: str
    torque: Source
    s: Source
    c: Source = 0.0
    last: bool = False


class Beam:
    """A link that is a beam: rows and quantities of its section forces and stresses."""

    def __init__(
        self,
        topology: Topology,
        meshed: Collection[str],
        body: Body,
        loads: tuple[Form, ...],
        drive: tuple[str, str],
        slider_pins: Mapping[tuple[int, int], tuple[Source, Source]],
    ):
        self.topology, self.meshed, self.body, self.loads = topology, meshed, body, loads
        (self.driven, self.unknown), self.slider_pins = drive, slider_pins
        self.pins = topology.links[body.role]
        self.k, self.length = body.number, f"{body.role}_length"
        self.rows: Rows = []
        self._names = count(1)

    def all_rows(self) -> Rows:
        """Return the rows of section forces and stresses."""
        k, role = self.k, self.body.role
        start, end = self._ends
        self.rows.append(Row(beam.position, (self.x,), (SECTION, start, end)))
        terms = [self._shank(), self._eye(), *(self._beyond(point) for point in self._points())]
        for n, name in enumerate(FORCES):
            self.rows.append(Total(f"{name}{k}", tuple(term[n] for term in terms)))
        stresses = tuple(name.format(k) for name in STRESSES)
        inputs = (f"axial_force{k}", f"bending_moment{k}", f"{role} area", f"{role} modulus")
        return [*self.rows, Row(beam.fibre_stresses, stresses, inputs)]

    def quantities(self) -> list[Quantity]:
        """Return section forces and stresses as quantities."""
        k, role = self.k, self.body.role
        part = f"of the {role} at a section, exerted by the part beyond it"
        stress = f"stress of the {role} in the extreme fibre"
        return [
            Quantity(f"axial_force{k}", "N", f"axial force {part}, positive in tension"),
            Quantity(f"shear_force{k}", "N", f"shear force {part}, positive to the left of its line of pins"),
            Quantity(f"bending_moment{k}", "N m", f"bending moment {part}, positive counter-clockwise"),
            Quantity(f"stress{k}_left", "Pa", f"{stress} on the left of its line of pins, positive in tension"),
            Quantity(f"stress{k}_right", "Pa", f"{stress} on the right of its line of pins, positive in tension"),
            Quantity(f"stress{k}", "Pa", f"largest size of the normal stress of the {role} at a section"),
        ]

    @property
    def x(self) -> str:
        return f"x_section{self.k}"

    @property
    def _overhangs(self) -> bool:
        """True where third pins may lie beyond the first two."""
        return len(self.pins) > 2

    @property
    def _ends(self) -> tuple[Source, Source]:
        role = self.body.role
        return (f"{role}_beam_start", f"{role}_beam_end") if self._overhangs else (0.0, self.length)

    @property
    def _motion(self) -> tuple[Source, ...]:
        """Offset of its centre of gravity, weight and acceleration of its first pin in its axes, and its rates."""
        k = self.k
        return (f"{self.body.role}_cg_y", f"body_force{k}_along", f"body_force{k}_across", f"omega{k}", f"alpha{k}")

    def _shank(self) -> tuple[str, ...]:
        k, role, near = self.k, self.body.role, self.x
        if self._overhangs:
            near = f"x_shank{k}"
            self.rows.append(Row(beam.in_shank, (near,), (self.x, self.length)))
        weight = (*xy("gravity_"), *self.body.pin_acceleration, *self.body.axes)
        self.rows.append(Row(beam.body_force, self._motion[1:3], weight))  # type: ignore[arg-type]
        mass = (f"{role} shank_mass", f"{role} shank_spin")
        return self._term(beam.shank_beyond, self.x, near, self.length, *mass, *self._motion)

    def _eye(self) -> tuple[str, ...]:
        role = self.body.role
        mass = (f"{role} eye_mass", f"{role} eye_moment", f"{role} eye_inertia")
        return self._term(beam.eye_beyond, self.x, self.length, *mass, *self._motion)

    def _points(self) -> Iterator[Point]:
        """Yield the forces and torques on the link, but for those on the pin at its start."""
        yield from self._pin_forces()
        yield from self._slides()
        yield from self._cylinders()
        yield from self._gears()
        for name, form in named(self.loads):
            for force, torque, at, other in form.applied(name, self.body.role):
                if other:
                    at = self._place(self._joint_with(other))
                yield Point(force, torque or 0.0, *at)
        if self.driven == self.body.role:
            yield Point("", self.unknown, *self._pivot)

    def _pin_forces(self) -> Iterator[Point]:
        for joint, (i, j) in self.topology.pins.items():
            pin = joint.partition(":")[0]
            if self.k in (i, j) and pin in self._bearing:
                yield Point(force_name(i + j - self.k, self.k), 0.0, *self._place(pin), self._is_last(pin))

    def _slides(self) -> Iterator[Point]:
        """Yield the forces and moments in slides: at the slider's pin, which moves along the link or is its own."""
        for slide, (i, j) in self.topology.slides.items():
            if self.k not in (i, j):
                continue
            force, torque = force_name(i + j - self.k, self.k), name_between("T", i, j) if has_moment(slide) else ""
            if torque and self.k == i:
                reaction, torque = torque, f"beam{self.k}_{torque}"
                self.rows.append(Row(planar.opposite, (torque,), (reaction,)))
            pin = slide.partition(" past ")[2]
            if pin in self.pins:
                if pin in self._bearing:
                    yield Point(force, torque or 0.0, *self._place(pin), self._is_last(pin))
            else:
                arm, at = xy(f"beam{self.k}_{force}_"), (f"beam{self.k}_{force}_s", f"beam{self.k}_{force}_c")
                self.rows.append(Row(planar.difference, arm, (*self.slider_pins[i, j], *self.body.pin_position)))
                self.rows.append(Row(bearing.in_link_axes, at, (*arm, *self.body.axes)))
                yield Point(force, torque or 0.0, *at)

    def _cylinders(self) -> Iterator[Point]:
        """Yield the pushes of cylinders on pins that the link carries."""
        for role, ends in self.topology.cylinders.items():
            for pin, way in zip(ends, (-1.0, 1.0), strict=True):
                carried = self.topology.members[pin][0] == self.body.role and pin in self._bearing
                if carried and self._pushes(role):
                    push = f"beam{self.k}_{role}_{pin}"
                    signed, force = f"{push}_signed", f"force_{role}"
                    self.rows.append(Row(planar.product, (signed,), (force, way)))
                    self.rows.append(Row(planar.along, xy(push), (signed, *xy(f"axis_{role}"))))
                    yield Point(push, 0.0, *self._place(pin), self._is_last(pin))

    def _gears(self) -> Iterator[Point]:
        """Yield the torque, and the force of the teeth, that gears pass on to the crank and to a wheel."""
        for wheel, ratio in self.topology.gears.items():
            number = self.topology.number(wheel)
            torque = name_between("T", number, 2)
            if self.k == number:
                on_crank, torque = torque, f"beam{self.k}_{torque}"
                self.rows.append(Row(planar.product, (torque,), (on_crank, -1.0 / float(ratio))))
            if self.k in (2, number):
                force = force_name(2 + number - self.k, self.k) if wheel in self.meshed else ""
                yield Point(force, torque, *self._pivot)

    def _pushes(self, cylinder: str) -> bool:
        return cylinder in self.topology.struts or cylinder == self.driven

    @property
    def _bearing(self) -> Iterable[str]:
        """Pins whose forces may lie beyond a section."""
        return self.pins if self._overhangs else self.pins[1:]

    def _is_last(self, pin: str) -> bool:
        return not self._overhangs and pin == self.pins[1]

    def _place(self, pin: str) -> tuple[Source, Source]:
        """Return the position of a pin along the link, and beside its line of pins: 0, but with slopes of its own."""
        if pin in self.pins[:2]:
            return (0.0, self.length)[self.pins.index(pin)], 0.0
        return f"{pin}_along", f"{pin}_across"

    @property
    def _pivot(self) -> tuple[Source, Source]:
        return self._place(self._joint_with(GROUND))

    def _joint_with(self, other: str) -> str:
        """Return the pin at which another link, or the ground, is joined to this one; else its first pin."""
        shared = [pin for pin in self.pins if pin in self.topology.pins_of(other)]
        return (*shared, self.pins[0])[0]

    def _beyond(self, point: Point) -> tuple[str, ...]:
        """Add the rows of what a force and torque exert at the sections before them."""
        parts: tuple[Source, Source] = (0.0, 0.0)
        if point.force:
            names = f"{point.force}_along_{self.k}", f"{point.force}_across_{self.k}"
            self.rows.append(Row(bearing.in_link_axes, names, (*xy(point.force), *self.body.axes)))
            parts = names
        exerted = (point.s, point.c, *parts, point.torque)
        if point.last:
            return self._term(beam.force_at, self.x, *exerted)
        return self._term(beam.force_beyond, self.x, self._ends[0], *exerted)

    def _term(self, function: Callable[..., beam.Forces], *inputs: Source) -> tuple[str, ...]:
        """Add a row of three section forces, and return their names."""
        n = next(self._names)
        names = tuple(f"{force}{self.k}_{n}" for force in FORCES)
        self.rows.append(Row(function, names, inputs))
        return names
