"""Dyads: from ground and crank, one after the other finds its place between two pins or guides that have theirs.

Letters are those of the joints from one known pin or guide to the other, R for a pin and P for a slide:

    RRR   two links meet at a pin                     RPR   a link's line passes a known pin, or carries its block
    RRP   a link ends at a slider on a known guide    PRP   two sliders on known guides share a pin
    RPP   a slider on a known guide has a slot for a known pin

A cylinder of given length is a massless link. What no dyad finds closes only together, and is refused.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Side:
    """A link of a dyad, and its pin (`pin`) that has a place before the dyad closes."""

    role: str
    pin: str


@dataclass(frozen=True)
class RRR:
    """Two links that meet at a pin; the first is that named first. One of them may be a cylinder of given length."""

    first: Side
    second: Side
    pin: str

    @property
    def name(self) -> str:
        return self.pin

    @property
    def roles(self) -> tuple[str, ...]:
        return self.first.role, self.second.role


@dataclass(frozen=True)
class RRP:
    """A link with a slider at its other pin; the guide is on the ground or on a link that has its place."""

    link: Side
    slider: str
    pin: str
    guide: str

    @property
    def name(self) -> str:
        return self.pin

    @property
    def roles(self) -> tuple[str, ...]:
        return self.link.role, self.slider


@dataclass(frozen=True)
class RPR:
    """A link whose guide passes a pin that has its place; `block` is the link that slides there, "" without mass."""

    link: Side
    block: str
    pin: str
    guide: str

    @property
    def name(self) -> str:
        return self.link.role

    @property
    def roles(self) -> tuple[str, ...]:
        return (self.link.role, self.block) if self.block else (self.link.role,)


@dataclass(frozen=True)
class PRP:
    """Two sliders that share a pin, on two guides that have their places."""

    first: str
    second: str
    pin: str
    first_guide: str
    second_guide: str

    @property
    def name(self) -> str:
        return self.pin

    @property
    def roles(self) -> tuple[str, ...]:
        return self.first, self.second


@dataclass(frozen=True)
class RPP:
    """A slider on a guide that has its place, with a slot for a pin that has its own."""

    slider: str
    guide: str
    pin: str

    @property
    def name(self) -> str:
        return self.slider

    @property
    def roles(self) -> tuple[str, ...]:
        return (self.slider,)


@dataclass(frozen=True)
class Gear:
    """A second crank on a ground pin, turned by gears."""

    link: Side
    ratio: Fraction

    @property
    def name(self) -> str:
        return self.link.role

    @property
    def roles(self) -> tuple[str, ...]:
        return (self.link.role,)


Step = RRR | RRP | RPR | PRP | RPP | Gear
