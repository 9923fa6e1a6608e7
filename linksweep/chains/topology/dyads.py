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
from typing import ClassVar


@dataclass(frozen=True)
class Side:
    """A link of a dyad, and its pin (`pin`) that has a place before the dyad closes."""

    role: str
    pin: str


@dataclass(frozen=True)
class Step:
    """A dyad, or a gear: links that find their places together."""

    places: ClassVar[str] = "pin"
    """Field with the pin, or the part, that the step places; it names the step."""

    @property
    def name(self) -> str:
        return _role(getattr(self, self.places))

    @property
    def roles(self) -> tuple[str, ...]:
        """The links that find their places."""
        links = (vars(self).get(word) for word in ("first", "second", "link", "slider", "block"))
        return tuple(_role(link) for link in links if link)

    @property
    def slides(self) -> tuple[str, ...]:
        """Names of the slides: guides, and slots such as "yoke slot"."""
        return tuple(guide for word, guide in vars(self).items() if word.endswith("guide"))


def _role(link: Side | str) -> str:
    return link.role if isinstance(link, Side) else link


@dataclass(frozen=True)
class RRR(Step):
    """Two links that meet at a pin; the first is that named first. One of them may be a cylinder of given length."""

    first: Side
    second: Side
    pin: str


@dataclass(frozen=True)
class RRP(Step):
    """A link with a slider at its other pin; the guide is on the ground or on a link that has its place."""

    link: Side
    slider: str
    pin: str
    guide: str


@dataclass(frozen=True)
class RPR(Step):
    """A link whose guide passes a pin that has its place; `block` is the link that slides there, "" without mass."""

    places: ClassVar[str] = "link"
    link: Side
    block: str
    pin: str
    guide: str


@dataclass(frozen=True)
class PRP(Step):
    """Two sliders that share a pin, on two guides that have their places."""

    first: str
    second: str
    pin: str
    first_guide: str
    second_guide: str


@dataclass(frozen=True)
class RPP(Step):
    """A slider on a guide that has its place, with a slot for a pin that has its own."""

    places: ClassVar[str] = "slider"
    slider: str
    guide: str
    pin: str

    @property
    def slides(self) -> tuple[str, ...]:
        return (self.guide, f"{self.slider} slot")


@dataclass(frozen=True)
class Gear(Step):
    """A second crank on a ground pin, turned by gears."""

    places: ClassVar[str] = "link"
    link: Side
    ratio: Fraction
