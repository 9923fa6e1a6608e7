"""A machine of a drawing in the words of a `Linkage`: links, sliders and blocks by their pins.

A joint that slides and lets its links turn is a block with a pin, whose guide is on the ground or on a link. A body
that slides without turning is a slider: its guide, which may lie anywhere beside it, goes through its pin, or through
the pin in its slot.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from linksweep.chains.topology import taken
from linksweep.files.pmks.axes import Axes, Polar, polar
from linksweep.files.pmks.drawing import Body, Joint, Point
from linksweep.files.pmks.machines import Machine
from linksweep.mechanisms.linkage import RESERVED

BESIDE = 1e-3
"""Distance of a cylinder's pin from its line, relative to its length, that a drawing's rounding explains."""


@dataclass(frozen=True)
class Words:
    """A machine in the words of a `Linkage`, by the name of the body that is its crank."""

    machine: Machine
    crank: str

    @cached_property
    def bodies(self) -> list[Body]:
        """Bodies, the crank first, then in the document's order."""
        return sorted(self.machine.bodies.values(), key=lambda body: body.name != self.crank)

    @cached_property
    def roles(self) -> dict[str, str]:
        """Role of each body: its title in the drawing, with its letters where others have that title, too."""
        titles = {body.name: _role(body.title) for body in self.bodies}
        twice = {title for title in titles.values() if list(titles.values()).count(title) > 1}
        return {name: _role(f"{title}_{name}") if title in twice else title for name, title in titles.items()}

    @cached_property
    def piston(self) -> Joint | None:
        """Joint of the cylinder that drives the machine, if its line goes through a pin at either end."""
        return next((joint for joint in self.machine.inputs if joint.sealed and self._through_pins(joint)), None)

    @cached_property
    def cylinder(self) -> tuple[str, ...]:
        """Barrel and rod of the cylinder that drives the machine."""
        return (self.piston.carrier, *self._riders(self.piston)) if self.piston else ()

    @cached_property
    def ends(self) -> list[str]:
        """Pins of the cylinder that drives the machine."""
        return [pin for name in self.cylinder for pin in self._joined(name)]

    @cached_property
    def sliders(self) -> dict[str, Joint]:
        """Joint by which each body that does not turn against its guide slides."""
        welded = [joint for joint in self.machine.slides if joint.welded and joint is not self.piston]
        return {rider: joint for joint in welded for rider in self._riders(joint)}

    @cached_property
    def yokes(self) -> dict[str, Joint]:
        """Joint in the slot of each slider that has a slot and no pin."""
        slots = {joint.carrier: joint for joint in self.machine.slides if joint.carrier in self.sliders}
        return {name: joint for name, joint in slots.items() if not self._joined(name)}

    @cached_property
    def blocks(self) -> list[Joint]:
        """Joints that are blocks with a pin."""
        return [joint for joint in self.machine.slides if not joint.welded and joint not in self.yokes.values()]

    @cached_property
    def pins(self) -> dict[str, list[str]]:
        """Pins of each link: two that make its axes, that on the ground first, then further points.

        The two are pins that earlier links name, if any, since a pin is a further point of one link only; then those on
        the ground, and those of other links.
        """
        pins: dict[str, list[str]] = {}
        named: set[str] = set()
        ground = self.machine.ground
        for body in self.bodies:
            if body.name not in {*self.cylinder, *self.sliders}:
                own = [pin for pin in body.joints if not self._slides_rigidly(pin)]
                rank = {pin: (pin not in named, pin not in ground, pin not in self._joined(body.name)) for pin in own}
                first = sorted(
                    sorted(own, key=rank.__getitem__)[:2], key=lambda pin: (pin not in ground, own.index(pin))
                )
                pins[body.name] = [*first, *(pin for pin in own if pin not in first)]
                named |= {*own}
        return pins

    @cached_property
    def sliding(self) -> dict[str, Joint]:
        """Joint that slides on each guide."""
        return {f"guide_{joint.name}": joint for joint in (*self.sliders.values(), *self.blocks)}

    @cached_property
    def guides(self) -> dict[str, Axes]:
        """Line of each guide."""
        through = {self.sliders[name].name: self.pin_of(name) for name in self.sliders}
        pins = {guide: through.get(joint.name, joint.name) for guide, joint in self.sliding.items()}
        return {guide: Axes(self._at(pins[guide]), self.slot(joint)) for guide, joint in self.sliding.items()}

    @cached_property
    def axes(self) -> dict[str, Axes]:
        """Axes of each link and slider."""
        links = {name: self._line(pins[0], pins[1]) for name, pins in self.pins.items()}
        return links | {name: self.guides[f"guide_{joint.name}"] for name, joint in self.sliders.items()}

    @property
    def text(self) -> str:
        """Links, sliders and cylinder by their pins."""
        return ", ".join(self._elements())

    @property
    def ground(self) -> dict[str, Point]:
        """Pins on the ground, the crank's pivot first."""
        pins = dict.fromkeys([*(pin for pins in self.pins.values() for pin in pins), *self.ends])
        return {pin: self._at(pin) for pin in pins if pin in self.machine.ground}

    @property
    def points(self) -> dict[str, Polar]:
        """Third and further pins of links, in the axes of theirs."""
        return {pin: self.axes[name].polar(self._at(pin)) for name, pins in self.pins.items() for pin in pins[2:]}

    def slot(self, joint: Joint) -> float:
        """Return the direction along which a joint slides [degree]."""
        return self._line(*joint.slot).angle if joint.carrier else math.remainder(joint.angle, 360.0)

    def problems(self) -> list[str]:
        """Return sentences on what no linkage has, or has otherwise."""
        problems = [f"link {self.roles[name]} has one pin" for name, pins in self.pins.items() if len(pins) < 2]
        for name in self.sliders:
            if len(pins := self._joined(name)) != 1 and name not in self.yokes:
                has = f"the pins {', '.join(pins)}" if pins else "no pin"
                problems.append(f"link {self.roles[name]} slides and has {has}: a slider has one pin, or a slot")
        return problems

    def _elements(self) -> Iterator[str]:
        for body in self.bodies:
            role = self.roles[body.name]
            if body.name in self.pins:
                yield f"{role} {'-'.join(self.pins[body.name])}"
            elif body.name in self.yokes:
                yield f"{role} on guide_{self.sliders[body.name].name} past {self.yokes[body.name].name}"
            elif body.name in self.sliders:
                yield f"{role} {self.pin_of(body.name)} on guide_{self.sliders[body.name].name}"
            elif body.name == self.cylinder[0]:
                yield f"{role} {'~'.join(self.ends)}"
        for joint in self.blocks:
            yield f"block_{joint.name} {joint.name} on guide_{joint.name}"

    def _joined(self, name: str) -> list[str]:
        """Return the pins of a body that it shares with another, a block or the ground."""
        pins = [pin for pin in self.machine.bodies[name].joints if not self._slides_rigidly(pin)]
        ground, joints = self.machine.ground, self.machine.joints
        return [pin for pin in pins if pin in ground or joints[pin].slides or len(self.machine.at(pin)) > 1]

    def _through_pins(self, piston: Joint) -> bool:
        """Return whether barrel and rod have a pin each on the line along which the piston slides."""
        parts = [name for name in (piston.carrier, *self._riders(piston)) if name in self.machine.bodies]
        pins = [self._at(pin) for name in parts for pin in self._joined(name)]
        line = self._line(*piston.slot)
        return len(parts) == len(pins) == 2 and all(abs(line.offset(pin)) <= BESIDE * polar(*pins)[0] for pin in pins)

    def _slides_rigidly(self, pin: str) -> bool:
        joint = self.machine.joints[pin]
        return joint.slides and joint.welded

    def _riders(self, joint: Joint) -> list[str]:
        return [body.name for body in self.machine.at(joint.name) if body.name != joint.carrier]

    def pin_of(self, slider: str) -> str:
        """Return the pin of a slider, or that in its slot."""
        return (
            self.yokes[slider].name if slider in self.yokes else [*self._joined(slider), self.sliders[slider].name][0]
        )

    def _at(self, pin: str) -> Point:
        return self.machine.joints[pin].at

    def _line(self, start: str, end: str) -> Axes:
        return Axes(self._at(start), polar(self._at(start), self._at(end))[1])


def _role(title: str) -> str:
    """Return a title as a role: small letters, digits and underscores, beginning with a letter."""
    role = re.sub(r"\W+", "_", title.strip()).lower()
    return role if role.isidentifier() and not taken(f"{role} A-B", RESERVED) else f"link_{role}"
