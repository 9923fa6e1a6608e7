"""Loads between two links, or a link and the ground: their two ends, and the form that their rows share.

`from_` and `to` are the links by role, or "ground". Quantities at an end have its name: load1_from_Fx, load1_to_moment.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from linksweep.base.validate import choice_problems
from linksweep.chains.rows.bodies import Source
from linksweep.chains.rows.load_forms import Form

GROUND = "ground"
Pair = tuple[Source, Source]


@dataclass(frozen=True)
class Between(Form):
    """The form of a load between two links, or between one and the ground."""

    from_: str
    to: str
    damps: bool

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


def link_problems(path: str, item: str, from_: str, to: str, links: tuple[str, ...]) -> list[str]:
    """Return the problems of the links at the two ends; `item` is the place of a link in the value of an end."""
    problems = choice_problems(f"{path}.from_{item}", from_, (GROUND, *links))
    problems += choice_problems(f"{path}.to{item}", to, (GROUND, *links))
    if problems or from_ != to:
        return problems
    return [f"{path}.to{item} = {to!r}: must be another link than that of from_"]
