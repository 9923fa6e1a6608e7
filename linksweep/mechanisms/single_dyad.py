"""The base of machines of one dyad on crank and ground, which have names and parameters of their own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from inspect import signature
from typing import Any, ClassVar

import numpy as np

from linksweep.base.frozen import cached_property
from linksweep.base.validate import Number
from linksweep.chains.chain import Own
from linksweep.chains.finding import Checks
from linksweep.chains.on_crank.machine import OnCrank
from linksweep.chains.rows.crank import frame_parameters, in_every_design, in_range, turned
from linksweep.chains.rows.load_forms import Form
from linksweep.chains.shape import Shape
from linksweep.mechanisms.links import link_parameters
from linksweep.mechanisms.machine import Machine

LETTERS = {"crank": "a", "coupler": "b", "rod": "b", "rocker": "c", "ground": "d", "offset": "e"}
"""Letters of lengths in equations."""
OWN = {"ground_length": "ground", "offset": "offset", "friction": "friction"}
"""Parameters of a machine by their names in physics."""


@dataclass(frozen=True, eq=False, repr=False)
class SingleDyad(Machine):
    """A machine of one dyad on crank and ground."""

    dyad: ClassVar[OnCrank]
    """Drives, rows and closed forms in the names of the textbooks."""
    sizes: ClassVar[tuple[str, ...]]
    """Parameters whose lengths alone decide the motion; an offset, from the line of another link, is the last."""
    frame: ClassVar[tuple[str, str]] = ("ground", "ground_angle")
    """Name of the frame link in physics, and the parameter with its angle to x."""
    first: ClassVar[tuple[str, ...]]
    """Names in physics of the numbers whose dims come first in results, before those of the links."""

    @property
    def drives(self) -> dict[str, str]:  # type: ignore[override]
        return {part: driven.unknown.name for part, driven in self.dyad.drives.items()}

    @property
    def frame_angle(self) -> Number:
        """Angle of the frame link to x [degree]."""
        return getattr(self, self.frame[1])

    @property
    def near_toggle_angle(self) -> Number:
        return self.frame_angle

    @property
    def shape(self) -> Shape:
        (step,) = self.topology.steps
        return Shape(self.topology, turned=frozenset({step.name} if turned(self.frame_angle) else ()), plain=True)

    @property
    def by_role(self) -> dict[str, Number]:
        """Lengths that alone decide the motion [m], by role."""
        return {name: self.parts[name].length if name in self.parts else getattr(self, name) for name in self.sizes}

    def closure_problems(self) -> list[str]:
        """Return why a single design cannot be assembled: a length is larger than the others together."""
        lengths = self.by_role
        if any(hasattr(length, "dims") for length in lengths.values()):
            return []
        beyond = "offset" in lengths
        longest = "offset" if beyond else max(lengths, key=lengths.__getitem__)
        excess = 2.0 * abs(lengths[longest]) - sum(map(abs, lengths.values()))
        if not excess > 0.0:
            return []
        others = " + ".join(name for name in lengths if name != longest)
        path = f"{longest}.length" if longest in self.parts else longest
        than, advice = ("beyond the reach of", "reduce it") if beyond else ("longer than", "shorten it")
        return [
            f"{path} = {lengths[longest]:.15g} m is {excess:.6g} m {than} {others}: the mechanism cannot be assembled "
            f"at any angle; {advice} or lengthen {'them' if beyond else 'the others'}"
        ]

    def parameters(self) -> dict[str, Any]:
        numbers = {name: getattr(self, OWN[name]) for name in self.first if name in OWN}
        numbers |= {"branch_sign": self.branch_sign} | frame_parameters(self.frame[0], self.frame_angle)
        for role, mass in self.masses().items():
            numbers |= link_parameters(role, self.parts.get(role, mass))
        return {name: numbers[name] for name in (*self.first, *numbers)}

    def directions(self) -> tuple[str, ...]:
        return ("direction",) if self.rubs else ()

    def own(self, drive: str, loads: tuple[Form, ...]) -> Own:
        return _own(type(self), drive)

    def findings(self) -> Checks:
        return self._checks("machine")

    def stroke_findings(self) -> Checks:
        return self._checks("stroke")

    def output_findings(self) -> Checks:
        return self._checks("output")

    def driven_findings(self, motion: Mapping[str, Any]) -> Checks:
        return self._checks(motion["drive"])

    @cached_property
    def closes_everywhere(self) -> bool:
        first, *_, last = lengths = [length for name, length in self.by_role.items() if name != "offset"]
        size = sum(map(abs, self.by_role.values()))
        least = 1e-9 * size * size
        wide = (in_every_design((reach - other) * (reach + other) > least) for reach, other in self._narrowest)
        return all(map(in_range, lengths)) and in_range(size / first * (size / last)) and all(wide)

    def always_ok(self, drive: str) -> bool:
        """Return whether the numbers alone ensure status 0 at every sample, friction included."""
        return super().always_ok(drive) and (not self.rubs or self._never_wedged)

    def ok_clear_of_toggles(self, drive: str) -> bool:
        """Return whether a design that is ok where it comes nearest to its toggles is ok at every angle."""
        return drive == "crank" and not self.rubs

    @cached_property
    def _never_wedged(self) -> bool:
        reach, other = self._narrowest[0]
        with np.errstate(over="ignore"):
            slides = np.square(self.friction * other) < (reach - other) * (reach + other) * (1.0 - 1e-9)
        return bool(np.all(slides))

    @property
    def _narrowest(self) -> tuple[tuple[Number, Number], ...]:
        return self.dyad.narrowest(*self.by_role.values())

    def _checks(self, of: str) -> Checks:
        """Return closed forms, each with the numbers after which its arguments are named."""
        numbers: dict[str, Any] = {LETTERS[name]: length for name, length in self.by_role.items()}
        numbers |= {"frame": self.frame_angle, "side": self.branch_sign, "friction": self.friction}
        return tuple(
            (f, tuple(numbers[name] for name in signature(f).parameters)) for f in self.dyad.checks.get(of, ())
        )


@lru_cache
def _own(kind: type[SingleDyad], drive: str) -> Own:
    """Return a drive of a kind of machine, with all rows of its own."""
    dyad, driven = kind.dyad, kind.dyad.drives[drive]
    return Own(driven.unknown, driven.rate, (*dyad.rows, *driven.rows), dyad.quantities, dyad.between)
