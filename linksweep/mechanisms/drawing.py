"""Numbers and names that a plot needs of a machine: joints, links, their axes, blocks, guides; or a car's track."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from linksweep.base.degrees import cos_sin
from linksweep.base.validate import Number
from linksweep.chains.between_links import force_name, is_pin, pair_of

Points = dict[str, np.ndarray]


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
        first = {block.number: block.pin for block in self.blocks} | {k: pins[0] for k, pins in self.bars.items()}
        return self if number == self.carrier.number else replace(self, carrier=Carrier(role, number, first[number]))

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
