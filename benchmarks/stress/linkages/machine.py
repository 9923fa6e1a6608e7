"""Linkages as data of the reference solution: a reader of their text, their numbers, loads and a start of each pin."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

from benchmarks.stress.decimals import Array


class Element(NamedTuple):
    """An element of a linkage's text: a link by its pins, a slider on a guide, a cylinder; `past` is the pin that its
    line of pins, or its slot, slides past; `gear` is the ratio to another crank and that crank's role."""

    role: str
    pins: tuple[str, ...] = ()
    guide: str = ""
    past: str = ""
    ends: tuple[str, ...] = ()
    gear: tuple[Fraction, str] | None = None

    @property
    def slides(self) -> bool:
        return bool(self.guide)


def element(text: str) -> Element:
    """Read one element, such as "rocker D-C-E", "ram F on slide", "yoke on slide past B" or "wheel D-E : -2 crank"."""
    role, *words = text.split()
    after = {word: words[words.index(word) + 1] for word in ("on", "past") if word in words}
    if "~" in words[0]:
        return Element(role, ends=tuple(words[0].split("~")))
    pins = () if words[0] == "on" else tuple(words[0].split("-"))
    gear = (Fraction(words[2]), words[3]) if ":" in words else None
    return Element(role, pins, after.get("on", ""), after.get("past", ""), gear=gear)


class TorsionSpring(NamedTuple):
    """A spring that turns one link from another, ground's line being x; its angles in degrees."""

    from_: str
    to: str
    rate: Array
    free_angle: Any = 0.0


class Load(NamedTuple):
    """A force at a point of a link, and a torque on it; fields as those of linksweep's."""

    link: str
    force: tuple[Array, Array] | None = None
    at: tuple[Any, Any] = (0.0, 0.0)
    frame: str = "ground"
    torque: Array | None = None
    origin: str = "pin"


class Spring(NamedTuple):
    """A spring between two points: ("ground", x, y) from A, or (link, distance, angle)."""

    from_: tuple[str, Any, Any]
    to: tuple[str, Any, Any]
    rate: Array
    free_length: Array


class Damper(NamedTuple):
    """A damper between two points."""

    from_: tuple[str, Any, Any]
    to: tuple[str, Any, Any]
    coefficient: Array


class TorsionDamper(NamedTuple):
    """A damper of the relative rotation of two links."""

    from_: str
    to: str
    coefficient: Array


@dataclass(frozen=True)
class Linkages:
    """Linkages of one topology; every number, a float or a decimal, is an array over the designs, or one number.

    `parts` has the fields of each link and slider (length, mass, inertia, cg_distance, cg_angle; slot_angle of a yoke;
    length of a cylinder), `guides` those of each guide (through, angle, friction, of), `gears` ratio and phase. `pins`
    is where the pins nearly are, x + jy [m]: the start of Newton's method. `drive` is a link or a cylinder, or, as
    "along block", a force along the line on which a link slides. Of the loads, some may be functions of assembly and
    frames that return pushes.
    """

    text: str
    ground: Mapping[str, tuple[Any, Any]]
    parts: Mapping[str, Mapping[str, Any]]
    pins: Mapping[str, Array]
    theta2: Any
    points: Mapping[str, tuple[Any, Any]] = field(default_factory=dict)
    guides: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    gears: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    branch: Mapping[str, str] = field(default_factory=dict)
    omega2: Any = 1.0
    alpha2: Any = 0.0
    gravity: tuple[Any, Any] = (0.0, 0.0)
    drive: str = ""
    loads: tuple[Any, ...] = ()

    def __len__(self) -> int:
        return len(next(iter(self.pins.values())))

    @cached_property
    def elements(self) -> tuple[Element, ...]:
        return tuple(element(words) for words in self.text.split(","))

    @cached_property
    def bodies(self) -> tuple[Element, ...]:
        """The elements that are links, numbered from 2 on."""
        return tuple(part for part in self.elements if not part.ends)

    @property
    def cylinders(self) -> Iterator[Element]:
        return (part for part in self.elements if part.ends)

    @cached_property
    def number(self) -> dict[str, int]:
        return {"ground": 1} | {body.role: k for k, body in enumerate(self.bodies, 2)}

    @property
    def crank(self) -> str:
        return self.bodies[0].role

    def carriers(self, pin: str) -> list[str]:
        """Return the links that a pin joins: the ground, or the first that the text names, and then the others."""
        ground = ["ground"] if pin in self.ground else []
        return ground + [body.role for body in self.bodies if pin in body.pins]

    def force(self, i: int, j: int) -> str:
        """Return the name of the force of link i on link j."""
        return f"F{i}_{j}" if max(i, j) > 9 else f"F{i}{j}"
