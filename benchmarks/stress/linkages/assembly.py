"""Assemble a linkage's bodies, constraints and loads from its text and numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from benchmarks.stress.decimals import Array, Number, Vector, directions, exact
from benchmarks.stress.linkages.constraints import GROUND, ORIGIN, Apart, Constraint, Frame, OnLine, Pin, Turned
from benchmarks.stress.linkages.machine import Element, Linkages

Line = tuple[str, Vector, Vector, Number]
"""Body of a line, a point and a direction of the line in its axes, coefficient of friction."""


def length_spline(lengths: Array) -> CubicSpline:
    """Return the periodic splines over the angle [degree] through lengths (designs, angles) at equal steps."""
    angles = np.linspace(0.0, 360.0, lengths.shape[1] + 1)
    return CubicSpline(angles, np.append(lengths, lengths[:, :1], axis=1), axis=1, bc_type="periodic")


@dataclass(frozen=True)
class Assembly:
    """Bodies and constraints of linkages, their numbers exact."""

    linkages: Linkages

    def exact(self, values: Any) -> Array:
        return exact(values, len(self.linkages))

    def direction(self, degrees: Any) -> Vector:
        return directions(self.exact(degrees))

    def polar(self, at: tuple[Any, Any]) -> Vector:
        return self.direction(at[1]) * self.exact(at[0])

    def vector(self, x: Any, y: Any) -> Vector:
        return Vector(self.exact(x), self.exact(y))

    def part(self, role: str, name: str) -> Array:
        return self.exact(self.linkages.parts.get(role, {}).get(name, 0.0))

    # ---- points in the axes of their bodies, from the centres of gravity

    @cached_property
    def centre(self) -> dict[str, Vector]:
        """The centres of gravity, from the first pins."""
        parts = ((body.role, self.linkages.parts[body.role]) for body in self.linkages.bodies)
        return {role: self.polar((part.get("cg_distance", 0.0), part.get("cg_angle", 0.0))) for role, part in parts}

    def pin(self, role: str, pin: str) -> Vector:
        """Return a pin of a body, or of the ground, from which A is the origin."""
        if role == GROUND:
            return self.from_crank_pivot(*self.linkages.ground[pin])
        pins = next(body.pins for body in self.linkages.bodies if body.role == role)
        places = {0: lambda: ORIGIN, 1: lambda: Vector(self.part(role, "length"), 0)}
        place = places.get(pins.index(pin), lambda: self.polar(self.linkages.points[pin]))()
        return place - self.centre[role]

    def from_crank_pivot(self, x: Any, y: Any) -> Vector:
        pivot = self.linkages.ground[self.linkages.bodies[0].pins[0]]
        return self.vector(x, y) - self.vector(*pivot)

    def line(self, name: str) -> Line:
        """Return a guide, or the line of pins of a link for which no guide is stated.

        Its point is the foot of the origin of its axes: A, or the first pin of its link.
        """
        guide = self.linkages.guides.get(name, {"of": name})
        of, through = guide.get("of", GROUND), guide.get("through", (0.0, 0.0))
        point = self.from_crank_pivot(*through) if of == GROUND else self.vector(*through)
        u, friction = self.direction(guide.get("angle", 0.0)), self.exact(guide.get("friction", 0.0))
        foot = u.left * point.dot(u.left)
        return of, foot if of == GROUND else foot - self.centre[of], u, friction

    # ---- constraints

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        parts = (self._pins(), self._slides(), self._past(), self._gears(), self._cylinders(), [self.driver])
        return tuple(constraint for part in parts for constraint in part)

    @cached_property
    def driver(self) -> Turned:
        return Turned(GROUND, self.linkages.crank, self.direction(self.linkages.theta2), target=True, drives=True)

    def _pins(self) -> Iterator[Pin]:
        for pin in {pin: None for body in self.linkages.bodies for pin in body.pins}:
            first, *others = self.linkages.carriers(pin)
            for other in others:
                yield Pin(first, self.pin(first, pin), other, self.pin(other, pin))

    def _slides(self) -> Iterator[OnLine | Turned]:
        for body in self.linkages.bodies:
            if body.slides:
                of, through, direction, friction = self.line(body.guide)
                yield OnLine(of, through, direction, body.role, self.centre[body.role] * -1, friction)
                yield Turned(of, body.role, direction)

    def _past(self) -> Iterator[OnLine]:
        for body in self.linkages.bodies:
            if body.past:
                host = self.linkages.carriers(body.past)[0]
                yield OnLine(*self._sliding_line(body), host, self.pin(host, body.past), self.line_friction(body))

    def line_friction(self, body: Element) -> Number:
        if body.slides:  # a yoke's slot
            return self.part(body.role, "slot_friction")
        return self.exact(self.linkages.guides.get(body.role, {}).get("friction", 0.0))

    def _sliding_line(self, body: Element) -> tuple[str, Vector, Vector]:
        if body.slides:  # a yoke's slot
            slot = self.linkages.parts[body.role].get("slot_angle", 90.0)
            return body.role, self.centre[body.role] * -1, self.direction(slot)
        return self.line(body.role)[:3]

    def _gears(self) -> Iterator[Turned]:
        for role, (ratio, other) in self.ratios.items():
            degrees = self.wheel_angle(role)
            yield Turned(other, role, directions(degrees), ratio, target=True)

    @cached_property
    def ratios(self) -> dict[str, tuple[Number, str]]:
        """The ratio of each geared wheel, and the crank that turns it."""
        geared = (body for body in self.linkages.bodies if body.gear)
        return {body.role: (self._ratio(body), body.gear[1]) for body in geared if body.gear}

    def _ratio(self, body: Element) -> Number:
        stated = body.gear and body.gear[0]
        if stated:
            return Decimal(stated.numerator) / Decimal(stated.denominator)
        return self.exact(self.linkages.gears[body.role]["ratio"])

    def wheel_angle(self, role: str) -> Array:
        """Return the angle of a crank, or of a wheel geared to it [degree]."""
        if role == self.linkages.crank:
            return self.exact(self.linkages.theta2)
        ratio, other = self.ratios[role]
        phase = self.exact(self.linkages.gears.get(role, {}).get("phase", 0.0))
        return phase + self.wheel_angle(other) * ratio

    def _cylinders(self) -> Iterator[Apart]:
        for cylinder in self.linkages.cylinders:
            if "length" in self.linkages.parts.get(cylinder.role, {}):
                yield self.cylinder(cylinder)

    def cylinder(self, cylinder: Element) -> Apart:
        """Return a cylinder between the links that carry its pins; of length 0 where it follows."""
        i, j = (self.linkages.carriers(pin)[0] for pin in cylinder.ends)
        P, Q = cylinder.ends
        return Apart(i, self.pin(i, P), j, self.pin(j, Q), self.length(cylinder.role), cylinder.role)

    def length(self, role: str) -> tuple[Number, Number, Number]:
        """Return a cylinder's length and its derivatives by the crank's angle; it may be a function that returns them,
        or a spline through some lengths over a turn."""
        length = self.linkages.parts.get(role, {}).get("length", 0.0)
        if callable(length):
            return length(self.exact(self.linkages.theta2))
        lengths = np.asarray(length)
        if lengths.ndim < 2:
            return self.exact(lengths), 0, 0
        spline = length_spline(lengths)
        value, slope, curvature = (spline(self.linkages.theta2, k) * np.degrees(1.0) ** k for k in range(3))
        return self.exact(value), self.exact(slope), self.exact(curvature)

    # ---- start of Newton's method

    @cached_property
    def start(self) -> dict[str, Frame]:
        """Frames of all bodies, from where the pins nearly are."""
        frames = {GROUND: Frame()}
        for body in sorted(self.linkages.bodies, key=lambda body: body.slides):  # their guides may be on links
            frames[body.role] = self._sliding_frame(body, frames) if body.slides else self._link_frame(body)
        return frames

    def place(self, pin: str) -> Vector:
        z = self.linkages.pins[pin]
        return self.vector(z.real, z.imag)

    def _link_frame(self, body: Element) -> Frame:
        z = self.linkages.pins[body.pins[1]] - self.linkages.pins[body.pins[0]]
        u = self.vector((z / abs(z)).real, (z / abs(z)).imag)
        return Frame(self.place(body.pins[0]) + self.centre[body.role].turned(u), u)

    def _sliding_frame(self, body: Element, frames: dict[str, Frame]) -> Frame:
        of, through, direction, _ = self.line(body.guide)
        u, S = frames[of].arm(direction), frames[of].at(through)
        place = self.place(body.pins[0]) if body.pins else self._yoke_place(body, S, u)
        return Frame(place + self.centre[body.role].turned(u), u)

    def _yoke_place(self, body: Element, S: Vector, u: Vector) -> Vector:
        """Return where the slot's line through the pin meets the guide."""
        slot = self._sliding_line(body)[2].turned(u)
        w = self.place(body.past) - S
        return S + u * (w.cross(slot) / u.cross(slot))
