"""Numbers and names that a plot needs of a machine, from its topology, guides and gears; or of a car's track."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from linksweep.base.degrees import cos_sin
from linksweep.base.validate import Number
from linksweep.chains.between_links import force_name, is_pin, pair_of
from linksweep.chains.topology import GROUND, Topology
from linksweep.mechanisms.links import Guide

Points = dict[str, np.ndarray]
Wheels = list[tuple[str, float]]


class Frame(NamedTuple):
    """Axes of a link: the direction of x in words, and its angle [degree].

    The angle is a number, or the name of one in the results or among the parameters. It is turned on
    by `turned` [degree].
    """

    along: str
    angle: str | Number
    turned: Number = 0.0

    @property
    def across(self) -> str:
        return self.along.split(",")[0]


class Rail(NamedTuple):
    """A straight line on the ground that a block slides on: a point of it [m], its direction, and whether its distance
    from A is an offset to be drawn: the point is then the foot of A."""

    point: np.ndarray
    along: np.ndarray
    offset: bool = False


class Block(NamedTuple):
    """A block: its number (None without mass), the pin at its centre, and the axes of its sides.

    It slides in a guide on the ground, or on a link that turns about a pin: `on` has the number of that link, and the
    pin.
    """

    number: int | None
    pin: str
    sides: Frame
    guide: Callable[[Any], Rail] | None = None
    on: tuple[int, str] | None = None


class Carrier(NamedTuple):
    """The link whose point draws a curve: its name, its number, and the pin from which the point is measured.

    `end` is the pin that draws the curve where no point is stated; "" for the centre of gravity.
    """

    role: str
    number: int
    pin: str
    end: str = ""


COUPLER = Carrier("coupler", 3, "B")


class Track(NamedTuple):
    """A circular track on which a car runs from the bottom, counter-clockwise.

    `radius` names the parameter [m], `force` the quantity that is the force on the car towards the centre [N], `speed`
    that of the car [m/s].
    """

    radius: str
    force: str
    speed: str
    title: str


@dataclass(frozen=True)
class Drawing:
    """A linkage as plots draw it.

    `joints` are the pairs of links (i, j) whose force Fij is plotted, by the joint's name: a pin, or a word where links
    touch otherwise. `journals` are the links that carry the pins' journals. `acts_at` is the pin where the arrow of a
    force starts that acts at no pin. `bars` are the pins of each link. `fixed` returns the pins on the ground [m],
    `wheels` the pins at the centres of pitch circles, and their radii [m]. `moving` are the pins, and centres
    of yokes, with positions among the quantities. `telescopes` are the ends of cylinders. `ideal` are parameters to set
    aside where only positions are computed.
    """

    joints: Mapping[str, tuple[int, int]]
    journals: Mapping[str, int] = field(default_factory=dict)
    frames: Mapping[int, Frame] = field(default_factory=dict)
    bars: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    moving: tuple[str, ...] = ()
    fixed: Callable[[Any], Points] = lambda mechanism: {"A": np.zeros(2)}
    carrier: Carrier = COUPLER
    blocks: tuple[Block, ...] = ()
    telescopes: tuple[tuple[str, str], ...] = ()
    wheels: Callable[[Any], Sequence[tuple[str, float]]] = lambda mechanism: ()
    acts_at: Mapping[str, str] = field(default_factory=dict)
    ideal: Mapping[str, Any] = field(default_factory=dict)

    @property
    def forces(self) -> dict[str, str]:
        """Name of the joint of each force, such as F12."""
        return {force_name(i, j): name for name, (i, j) in self.joints.items()}

    @property
    def joint_of(self) -> dict[str, str]:
        """Name of the joint of each force and of its reaction."""
        return {force_name(i, j): name for name, pair in self.joints.items() for i, j in (pair, pair[::-1])}

    @property
    def pin_forces(self) -> list[str]:
        """Forces that act at a pin."""
        return [force for force in self.forces if self.at_pin(force)]

    @property
    def angles(self) -> list[str]:
        """Names of the angles of the axes of links and blocks."""
        frames = [*self.frames.values(), *(block.sides for block in self.blocks)]
        return list(dict.fromkeys(frame.angle for frame in frames if isinstance(frame.angle, str)))

    def with_point_on(self, role: str, number: int) -> Drawing:
        """Copy with the curve drawn by a point of another link."""
        own = number == self.carrier.number
        return self if own else replace(self, carrier=Carrier(role, number, self.pins_of(number)[0]))

    def pins_of(self, number: int) -> tuple[str, ...]:
        """Return the pins of a link, the first of which is the origin of its axes."""
        pins: dict[int | None, tuple[str, ...]] = {block.number: (block.pin,) for block in self.blocks}
        hosts = {block.on[0]: (block.on[1],) for block in self.blocks if block.on}
        return (pins | hosts | {**self.bars})[number]

    def start_of(self, force: str) -> str:
        """Return the pin where the arrow of a force starts."""
        joint = self.joint_of[force]
        return self.acts_at.get(joint, joint.partition(":")[0])

    def link_of(self, force: str, frame: str) -> int:
        """Return the link of a frame in which a force Fij is plotted; in a slide, link j takes the journal's place."""
        i, j = pair_of(force) or (1, 1)
        journal = self.journals.get(self.joint_of.get(force, ""), j)
        return {"ground": 1, "link": j, "journal": journal, "bearing": i + j - journal}[frame]

    def at_pin(self, force: str) -> bool:
        """Return whether a force acts at a pin."""
        return is_pin(self.joint_of[force])

    def joint_text(self, force: str) -> str:
        """Return the joint of a force in words: "pin C", "guide"."""
        return f"{'pin ' if self.at_pin(force) else ''}{self.joint_of[force]}"


def direction(angle: Any) -> np.ndarray:
    """Return the unit vector at an angle [degree], exact at the multiples of 90."""
    return np.array([float(part) for part in cos_sin(angle)])


def ground_pins(mechanism: Any) -> Points:
    """Return the pins A and D [m] of a machine with a frame of length `ground` at `ground_angle`."""
    return {"A": np.zeros(2), "D": float(mechanism.ground) * direction(mechanism.ground_angle)}


class LinkageDrawing(NamedTuple):
    """Topology of a linkage, with the coordinates of its ground pins, and its guides."""

    topology: Topology
    ground: Mapping[str, Any]
    guides: Mapping[str, Guide]

    def drawing(self) -> Drawing:
        """Return the linkage as plots draw it."""
        joined = self.topology
        bars = {joined.number(role): pins for role, pins in joined.links.items()}
        slots = {joined.number(role): (f"{role}_", pin) for role, (_, pin) in joined.yokes.items()}
        frames = {joined.number(role): self._frame(role) for role in joined.links}
        frames |= {joined.number(role): self._sides(guide) for role, (_, guide) in self.topology.on_guides.items()}
        moving = [pin for pin in joined.members if pin not in joined.ground]
        return Drawing(
            joints={**joined.pins, **joined.slides},
            journals=joined.journals,
            frames=frames,
            bars=bars | slots,
            moving=(*moving, *(f"{role}_" for role in joined.yokes)),
            fixed=lambda machine: self._fixed(),
            carrier=self._carrier(),
            blocks=tuple(self._blocks()),
            telescopes=tuple(joined.cylinders.values()),
            wheels=lambda machine: self._wheels(),
            acts_at=self._acts_at(),
            ideal={"guides": {name: replace(guide, friction=0.0) for name, guide in self.guides.items()}},
        )

    def _frame(self, role: str) -> Frame:
        first, second, *_ = self.topology.links[role]
        return Frame(f"{role}, {first}→{second}", f"theta{self.topology.number(role)}")

    def _sides(self, name: str) -> Frame:
        """Return the axes of a block on a guide."""
        host, angle = self.topology.hosts[name], self._guide(name).angle
        return Frame(name, angle) if host == GROUND else Frame(name, f"theta{self.topology.number(host)}", angle)

    def _guide(self, name: str) -> Guide:
        return self.guides.get(name, Guide())

    def _fixed(self) -> Points:
        pivot = self._from_pivot((0.0, 0.0))
        return {pin: np.array([float(part) for part in at]) + pivot for pin, at in self.ground.items()}

    def _from_pivot(self, point: Any) -> np.ndarray:
        """Return the vector of a point on the ground from the crank's pivot."""
        return np.array([float(a) - float(b) for a, b in zip(point, self.ground[self.topology.ground[0]], strict=True)])

    def _rail(self, name: str) -> Any:
        """Return the function that gives a guide's line on the ground; None for a guide on a link."""
        guide = self._guide(name)
        on_ground = self.topology.hosts[name] == GROUND
        return (lambda machine: Rail(self._from_pivot(guide.through), direction(guide.angle))) if on_ground else None

    def _blocks(self) -> Iterator[Block]:
        joined = self.topology
        for role, (pin, guide) in self.topology.on_guides.items():
            yield Block(joined.number(role), pin, self._sides(guide), self._rail(guide), self._on(joined.hosts[guide]))
        for role, pin in joined.past.items():
            yield Block(None, pin, self._sides(role), on=self._on(role))

    def _on(self, host: str) -> tuple[int, str] | None:
        return None if host == GROUND else (self.topology.number(host), self.topology.links[host][0])

    def _acts_at(self) -> dict[str, str]:
        """Return the pin where the force of each slide acts."""
        joined = self.topology
        pins = {joined.number(role): pin for role, (pin, _) in self.topology.on_guides.items()}
        places = {name: pins[k] for name, pair in joined.slides.items() for k in pair if k in pins}
        return places | {f"{role} past {pin}": pin for role, pin in joined.passed.items()}

    def _carrier(self) -> Carrier:
        """Return the link with a free pin, which draws the curve; else the first that no ground pin holds."""
        joined = self.topology
        taken = {*joined.passed.values(), *(pin for pins in joined.cylinders.values() for pin in pins)}
        single = [(role, pin) for pin, (role, *others) in joined.members.items() if not others and pin not in taken]
        free = [(role, pin) for role, pin in single if role in joined.links]
        floating = [role for role, pins in joined.links.items() if not {*pins} & {*joined.ground}]
        role, end = free[-1] if free else ((*floating, joined.crank)[0], "")
        return Carrier(role, joined.number(role), joined.links[role][0], end)

    def _wheels(self) -> Wheels:
        """Return the pitch circles of the crank's gear and each wheel."""
        pivot, wheels = self.topology.ground[0], Wheels()
        for role, ratio in self.topology.gears.items():
            centre = next(pin for pin in self.topology.links[role] if pin in self.topology.ground)
            distance = float(np.hypot(*self._fixed()[centre]))
            radius = distance / abs(1.0 - float(ratio)) if ratio != 1 else np.nan
            wheels += [(pivot, radius * abs(float(ratio))), (centre, radius)]
        return wheels


def drawing_of(topology: Topology, **other: Any) -> Drawing:
    """Return all that a drawing takes from the topology alone, its first pin at A, with other fields in their place."""
    return replace(LinkageDrawing(topology, {"A": (0.0, 0.0)}, {}).drawing(), **{"ideal": {}} | other)
