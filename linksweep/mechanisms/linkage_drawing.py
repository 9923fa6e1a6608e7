"""The drawing of a linkage, from its topology, guides and gears."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from linksweep.chains.topology import GROUND, Topology
from linksweep.mechanisms.drawing import Block, Carrier, Drawing, Frame, Points, Rail, direction
from linksweep.mechanisms.links import Guide

Wheels = list[tuple[str, float]]


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
        frames |= {joined.number(role): self._sides(guide) for role, (_, guide) in self._slides()}
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

    def _slides(self) -> Iterator[tuple[str, tuple[str, str]]]:
        """Yield each slider with its pin, of a yoke its centre, and its guide."""
        yield from self.topology.sliders.items()
        yield from ((role, (f"{role}_", guide)) for role, (guide, _) in self.topology.yokes.items())

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
        for role, (pin, guide) in self._slides():
            yield Block(joined.number(role), pin, self._sides(guide), self._rail(guide), self._on(joined.hosts[guide]))
        for role, pin in joined.past.items():
            yield Block(None, pin, self._sides(role), on=self._on(role))

    def _on(self, host: str) -> tuple[int, str] | None:
        return None if host == GROUND else (self.topology.number(host), self.topology.links[host][0])

    def _acts_at(self) -> dict[str, str]:
        """Return the pin where the force of each slide acts."""
        joined = self.topology
        pins = {joined.number(role): pin for role, (pin, _) in self._slides()}
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


def drawing_of(topology: Topology) -> Drawing:
    """Return all that a drawing takes from the topology alone, its first pin at A, and no parameter set aside."""
    return replace(LinkageDrawing(topology, {"A": (0.0, 0.0)}, {}).drawing(), ideal={})
