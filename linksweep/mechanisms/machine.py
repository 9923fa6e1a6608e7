"""The base of machines made of a crank and dyads: all that follows from their topology."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, ClassVar

from linksweep.base.degrees import cos_sin
from linksweep.base.frozen import cached_property
from linksweep.base.validate import Number, refuse
from linksweep.chains.between_links import force_name
from linksweep.chains.chain import Chain, Own, chain, table
from linksweep.chains.equations import equations
from linksweep.chains.rows.bodies import Body, Equation
from linksweep.chains.rows.crank import STATUS_OF_SLIDER
from linksweep.chains.rows.load_forms import Form
from linksweep.chains.rows.pins import Journals, Pins
from linksweep.chains.shape import Shape
from linksweep.chains.topology import GROUND, Topology, clash_problems
from linksweep.engine.quantity import Table
from linksweep.mechanisms.beams.beam import beam_numbers, beam_problem, ends_of_beam
from linksweep.mechanisms.mechanism import Mechanism


@dataclass(frozen=True, eq=False, repr=False)
class Machine(Mechanism):
    """A machine made of a crank and dyads."""

    status_meanings: ClassVar[tuple[str, ...]] = STATUS_OF_SLIDER

    topology: ClassVar[Topology]
    """Links and joints, and the order in which the dyads close."""

    @property
    @abstractmethod
    def shape(self) -> Shape:
        """All that decides the rows of the machine's motion."""

    @cached_property
    def chain(self) -> Chain:
        """Motion and forces of all machines of this shape."""
        return chain(self.shape)

    @property
    def roles(self) -> tuple[str, ...]:  # type: ignore[override]
        return self.topology.roles

    @property
    def sliders(self) -> tuple[str, ...]:  # type: ignore[override]
        joined = self.topology
        return tuple(role for role, (_, guide) in joined.on_guides.items() if joined.hosts[guide] == GROUND)

    @property
    def on_ground(self) -> tuple[str, ...]:  # type: ignore[override]
        return self.topology.on_ground

    @property
    def pins(self) -> Pins:  # type: ignore[override]
        return self.topology.pins

    @property
    def journals(self) -> Journals:  # type: ignore[override]
        return self.topology.journals

    @property
    def bodies(self) -> tuple[Body, ...]:  # type: ignore[override]
        return self.chain.bodies

    @property
    def drives(self) -> dict[str, str]:  # type: ignore[override]
        return self.chain.drives

    @property
    def defaults(self) -> dict[str, str]:  # type: ignore[override]
        return {"drive": self.topology.crank}

    def own(self, drive: str, loads: tuple[Form, ...]) -> Own:
        """Return a drive, and the rows of the machine's own."""
        return self.chain.own(drive, loads)

    def table(self, drive: str, loads: tuple[Form, ...]) -> Table:
        refuse(self.chain.drive_problems(drive, self.rubbing))
        return table(self.chain, self.own(drive, loads), loads, frozenset(self.rubbing), self.beams)

    def clash_problems(self, twice: Collection[str], names: Collection[str]) -> list[str]:
        return [*clash_problems(twice, names, self.topology)]

    @cached_property
    def beams(self) -> tuple[str, ...]:  # type: ignore[override]
        return tuple(role for role in self.topology.links if not self.beam_problem(role))

    def beam_problem(self, role: str) -> str:
        return beam_problem(self.topology, role, self.parts.get(role), self._off_line(role))

    def beam_numbers(self) -> dict[str, Number]:
        numbers: dict[str, Number] = {}
        for role in self.beams:
            numbers |= beam_numbers(role, self.parts[role])
            numbers |= ends_of_beam(role, self.parts[role].length, self.third_pins_along(role))
        return numbers

    def third_pins_along(self, role: str) -> list[Number]:
        return [distance * cos_sin(angle)[0] for distance, angle in self._third_pins(role).values()]

    def pin_place(self, role: str, pin: str) -> tuple[Number, Number]:
        first, *others = self.topology.pins_of(role)
        if pin == first:
            return 0.0, 0.0
        return (self.parts[role].length, 0.0) if pin == others[0] else self._third_pins(role)[pin]

    def _third_pins(self, role: str) -> dict[str, Any]:
        """Return the third pins of a link in its polar coordinates."""
        pins = self.topology.links.get(role, ())[2:]
        return {pin: getattr(self, "points")[pin] for pin in pins}  # noqa: B009

    def _off_line(self, role: str) -> dict[str, Number]:
        """Return the distance of each third pin of a link from its line of pins."""
        return {pin: distance * cos_sin(angle)[1] for pin, (distance, angle) in self._third_pins(role).items()}

    @property
    def rubbing(self) -> tuple[str, ...]:
        """Names of the guides with friction, and of slots such as "yoke slot"."""
        return ()

    def directions(self) -> tuple[str, ...]:
        of_slides = self.chain.forces().directions
        return tuple(of_slides[slide] for slide in self.rubbing)

    def kinks(self) -> tuple[str, ...]:
        """Return the normal forces of slides, with which friction changes sides."""
        return tuple(f"{force_name(*pair)}n" for pair in self.topology.slides.values()) if self.rubs else ()

    def kinematics(self) -> tuple[str, ...]:
        return self.chain.kinematics

    def unknowns(self, drive: str) -> tuple[str, ...]:
        return (*self.chain.unknowns, self.drives[drive])

    def dynamics(self, drive: str) -> tuple[str, ...]:
        return (*self.unknowns(drive), *self.chain.slide_forces)

    def equations(self, drive: str) -> tuple[Equation, ...]:
        return equations(self.topology, {drive: self.drives[drive]}, self.shape.meshed)

    def peak_quantities(self, drive: str) -> tuple[str, ...]:
        """Return the force of each pin and slide, the moment of each slide between links, and the drive's unknown."""
        between = [slide for slide, pair in self.topology.slides.items() if 1 not in pair]
        moments = (name for slide in between for name in self.chain.slide_unknowns(slide)[1:])
        return (*(force_name(*pair) for pair in self.chain.joints.values()), *moments, self.drives[drive])
