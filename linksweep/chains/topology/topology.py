"""Links, pins and slides of a linkage, and the order in which its dyads close."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

from linksweep.chains.topology.dyads import PRP, RPP, RPR, RRP, RRR, Gear, Side, Step

GROUND = "ground"


@dataclass(frozen=True, eq=False)
class Topology:
    """Links, pins and slides of a linkage.

    names : links, sliders and cylinders in the order of the text; the first is the crank
    ground : pins on the ground; the first is the crank's pivot
    links : pins of each link that has pins, by role
    sliders : pin and guide of each slider pinned to another link (`ram F on slide`)
    past : pin of another link that the line of a link passes (`arm D-E past B`)
    yokes : guide and pin of each slider with a slot (`yoke on slide past B`)
    cylinders : both pins of each cylinder (`c1 P~B`)
    struts : cylinders of given length, in the order of the text, each a massless link
    gears : turns of each wheel per turn of the crank
    hosts : link that carries each guide, or "ground"; the guide of `past` and of `block on arm` has the link's name
    steps : gears and dyads in the order in which they find their places
    """

    names: tuple[str, ...]
    ground: tuple[str, ...]
    links: Mapping[str, tuple[str, ...]]
    sliders: Mapping[str, tuple[str, str]]
    past: Mapping[str, str]
    yokes: Mapping[str, tuple[str, str]]
    cylinders: Mapping[str, tuple[str, str]]
    struts: tuple[str, ...]
    gears: Mapping[str, Fraction]
    hosts: Mapping[str, str]
    steps: tuple[Step, ...] = ()

    @property
    def crank(self) -> str:
        return self.names[0]

    @property
    def on_ground(self) -> tuple[str, ...]:
        """Links that turn about a ground pin, whichever of their pins that is; the crank first."""
        return tuple(role for role, pins in self.links.items() if {*pins} & {*self.ground})

    @cached_property
    def roles(self) -> tuple[str, ...]:
        """Moving links with a number, in the order of the text: all but cylinders."""
        return tuple(name for name in self.names if name not in self.cylinders)

    def number(self, role: str) -> int:
        """Return the number of a link: 1 for the ground, 2 for the crank, and so on in the order of the text."""
        return 1 if role == GROUND else 2 + self.roles.index(role)

    def pins_of(self, name: str) -> tuple[str, ...]:
        """Return the pins of the ground, a link, a slider or a cylinder."""
        slider = {role: (pin,) for role, (pin, _) in self.sliders.items()}
        return {GROUND: self.ground, **self.links, **slider, **self.cylinders}.get(name, ())

    @cached_property
    def on_guides(self) -> dict[str, tuple[str, str]]:
        """Pin and guide of each part that slides on one; of a yoke its centre, such as yoke_."""
        return {**self.sliders, **{role: (f"{role}_", guide) for role, (guide, _) in self.yokes.items()}}

    @cached_property
    def points(self) -> dict[str, str]:
        """Link in whose axes each third pin is stated."""
        return {pin: role for role, pins in self.links.items() for pin in pins[2:]}

    @cached_property
    def members(self) -> dict[str, tuple[str, ...]]:
        """Links that share each pin: the ground first where it has the pin, then in the order of the text."""
        roles = (GROUND, *self.roles)
        pins = dict.fromkeys(pin for role in (*self.roles, GROUND) for pin in self.pins_of(role))
        return {pin: tuple(role for role in roles if pin in self.pins_of(role)) for pin in pins}

    @cached_property
    def placed(self) -> tuple[str, ...]:
        """The ground, the crank, and the links and cylinders of the dyads, in the order in which they have places."""
        return (GROUND, self.crank, *(role for step in self.steps for role in sorted(step.roles, key=self.names.index)))

    @cached_property
    def support(self) -> dict[str, str]:
        """Link that places each pin, or "ground": of a dyad's pin the link named first of those that meet there."""
        support: dict[str, str] = {}
        for role in (name for name in self.placed if name not in self.cylinders):
            support |= {pin: role for pin in self.pins_of(role) if pin not in support}
        return support

    @cached_property
    def pins(self) -> dict[str, tuple[int, int]]:
        """Numbers i, j of the force Fij of link i on link j at each pin: of the ground, or of the later link.

        Where more than two links share a pin, the first carries it and each other has a name such as "C:lower".
        """
        pins: dict[str, tuple[int, int]] = {}
        for pin, (carrier, *others) in self.members.items():
            pins |= {pin if len(others) == 1 else f"{pin}:{role}": self.pair(carrier, role) for role in others}
        return pins

    @cached_property
    def journals(self) -> dict[str, int]:
        """Number of the link that carries the journal of each pin: the earlier one, but never the ground."""
        return {pin: max(pair) if 1 in pair else min(pair) for pin, pair in self.pins.items()}

    @cached_property
    def slides(self) -> dict[str, tuple[int, int]]:
        """Numbers i, j of the force Fij of link i on link j in each slide, named as "slide", "arm" or "arm past B".

        Where several sliders share a guide, each has a name such as "slide:ram".
        """
        on = {role: guide for role, (_, guide) in self.on_guides.items()}
        guides = list(on.values())
        return {
            **{
                guide if guides.count(guide) == 1 else f"{guide}:{role}": self.pair(self.hosts[guide], role)
                for role, guide in on.items()
            },
            **{f"{role} past {pin}": self.pair(role, self.members[pin][0]) for role, pin in self.passed.items()},
        }

    @cached_property
    def passed(self) -> dict[str, str]:
        """Pin that each link's line, or each yoke's slot, passes."""
        return {**self.past, **{role: pin for role, (_, pin) in self.yokes.items()}}

    def freedoms(self, moving: Collection[str], fixed: Collection[str] = (GROUND,)) -> int:
        """Return the degrees of freedom of some links among others that stand still, by the criterion of Grübler."""
        bodies = [
            (constraints, sum(role in moving for role in joined) + any(role in fixed for role in joined))
            for constraints, joined in self._joints()
        ]
        return 3 * len(moving) - sum(constraints * max(count - 1, 0) for constraints, count in bodies)

    def closed(self) -> Topology:
        """Return the topology with all dyads that can be found from ground and crank."""
        step = next((step for step in self._steps() if step), None)
        return replace(self, steps=(*self.steps, step)).closed() if step else self

    @property
    def waiting(self) -> list[str]:
        """Names that have no place yet; a cylinder without a given length needs none."""
        follow = [name for name in self.cylinders if name not in self.struts]
        return [name for name in self.names if name not in (*self.placed, *follow)]

    def pair(self, one: str, other: str) -> tuple[int, int]:
        earlier, later = sorted((self.number(one), self.number(other)))
        return (1, later) if earlier == 1 else (later, earlier)

    def _joints(self) -> Iterator[tuple[int, Iterable[str]]]:
        """Return the number of constraints of each joint, and the links that it joins."""
        carrier = {pin: members[0] for pin, members in self.members.items()}
        yield from ((2, members) for members in self.members.values())
        yield from ((2, (role, self.hosts.get(guide, ""))) for role, (_, guide) in self.on_guides.items())
        yield from ((1, (role, carrier.get(pin, ""))) for role, pin in self.passed.items())
        yield from ((1, (role, self.crank)) for role in self.gears)
        yield from ((1, [carrier.get(pin, "") for pin in self.cylinders[name]]) for name in self.struts)

    def _steps(self) -> Iterator[Step | None]:
        waiting = self.waiting
        for k, name in enumerate(waiting):
            yield self._alone(name)
            yield from (self._together(name, other) for other in waiting[k + 1 :])

    def _alone(self, name: str) -> Step | None:
        """Return the step by which a link finds its place without another."""
        side, guide = self._side(name), self.yokes.get(name, ("", ""))[0]
        if name in self.gears and side:
            return Gear(side, self.gears[name])
        if self.passed.get(name) not in self.support:
            return None
        if side:
            return RPR(side, "", self.past[name], name)
        return RPP(name, guide, self.yokes[name][1]) if self._stands(guide) else None

    def _together(self, one: str, other: str) -> Step | None:
        """Return the dyad of two links; the first is that named first."""
        if {one, other} & {*self.gears, *self.passed}:
            return None
        if one in self.sliders and other in self.sliders:
            return self._two_sliders(one, other)
        if one in self.sliders:
            return self._slider(other, one)
        return self._slider(one, other) if other in self.sliders else self._two_links(one, other)

    def _two_links(self, one: str, other: str) -> RRR | None:
        first, second = self._side(one), self._side(other)
        shared = [pin for pin in self.pins_of(one) if pin in self.pins_of(other) and pin not in self.support]
        massless = one in self.cylinders and other in self.cylinders
        return RRR(first, second, shared[0]) if first and second and shared and not massless else None

    def _slider(self, link: str, slider: str) -> RRP | RPR | None:
        side, (pin, guide) = self._side(link), self.sliders[slider]
        if side and pin in self.support and self.hosts.get(guide) == link:
            return RPR(side, slider, pin, guide)
        ends = pin in self.pins_of(link) and pin not in self.support
        return RRP(side, slider, pin, guide) if side and ends and self._stands(guide) else None

    def _two_sliders(self, one: str, other: str) -> PRP | None:
        (pin, first), (second_pin, second) = self.sliders[one], self.sliders[other]
        free = pin == second_pin and pin not in self.support
        return PRP(one, other, pin, first, second) if free and self._stands(first) and self._stands(second) else None

    def _stands(self, guide: str) -> bool:
        return self.hosts.get(guide) in self.placed

    def _side(self, name: str) -> Side | None:
        """Return a link or cylinder with its only pin that has a place; None for any other."""
        pins = [pin for pin in self.pins_of(name) if pin in self.support]
        return Side(name, pins[0]) if len(pins) == 1 and name not in self.sliders else None
