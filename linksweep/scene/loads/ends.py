"""Loads between two links, or a link and the ground: their two ends, and the form that their rows share.

`from_` and `to` are the links by role, or "ground". Quantities at an end have its name: load1_from_Fx, load1_to_moment.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from linksweep.base.validate import choice_problems
from linksweep.mechanisms.rows.bodies import Source

GROUND = "ground"
Pair = tuple[Source, Source]


@dataclass(frozen=True)
class Between:
    """The form of a load between two links, or between one and the ground."""

    from_: str
    to: str
    damps: bool
    full_turns: ClassVar[bool] = False

    @property
    def place(self) -> str:
        return f"{self.from_}–{self.to}"

    def ends(self, name: str) -> Iterator[tuple[str, str]]:
        """Yield the ends on moving links, by name, and the link of each."""
        return ((f"{name}_{end}", link) for end, link in (("from", self.from_), ("to", self.to)) if link != GROUND)

    def powers(self, name: str) -> tuple[str, ...]:
        return tuple(f"{end}_power" for end, _ in self.ends(name))

    def title(self, name: str) -> str:
        """Return the load in words: "load 1 between ground and rocker"."""
        return f"{name.replace('load', 'load ')} between {self.from_} and {self.to}"


def link_problems(path: str, link: object, links: tuple[str, ...]) -> list[str]:
    """Return the problems of the link at an end."""
    return choice_problems(path, link, (GROUND, *links))


def same_link_problems(path: str, first: str, second: str) -> list[str]:
    """Return the problem of two ends on one link."""
    return [f"{path} = {second!r}: must be another link than that of from_"] if first == second else []
