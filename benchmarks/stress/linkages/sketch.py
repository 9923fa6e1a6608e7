"""Sketch random linkages pin by pin at one crank angle: their lengths follow, so all of them close there.

Every pin of a dyad is at least 25 degrees from a toggle, or one of them 0.03 degrees. Lengths are about a
metre.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.stress.decimals import Array
from benchmarks.stress.linkages.assembly import length_spline
from benchmarks.stress.linkages.machine import Linkages, element

SIDE = {"open": 1, "crossed": -1}
LEAST = np.radians(25.0)
NEAR = np.radians(0.03)
"""Transmission angle near a toggle."""


def turn(degrees: Any) -> Array:
    return np.exp(1j * np.radians(degrees))


class Sketch:
    """Pins, guides and branches of n linkages of one topology, as they are drawn.

    The pin `near` is near a toggle; where the linkage `rubs`, all guides and slots have friction.
    """

    def __init__(self, random: np.random.Generator, n: int, near: str = "", rubs: bool = False) -> None:
        self.random, self.n, self.near, self.rubs = random, n, near, rubs
        self.theta2 = float(random.uniform(-180.0, 540.0))
        self.pins: dict[str, Array] = {}
        self.fixed: list[str] = []
        self.guides: dict[str, dict[str, Any]] = {}
        self.parts: dict[str, dict[str, Any]] = {}
        self.gears: dict[str, dict[str, Any]] = {}
        self.branch: dict[str, str] = {}
        self.axes: dict[str, Array] = {}

    def uniform(self, low: float, high: float) -> Array:
        return self.random.uniform(low, high, self.n)

    def around(self, pin: str, low: float = 0.7, high: float = 2.0) -> Array:
        """Return points at random around a pin."""
        return self.pins[pin] + self.uniform(low, high) * turn(self.uniform(0.0, 360.0))

    def choose(self, name: str) -> int:
        """Draw the branch of a pin or link; return 1 for open, −1 for crossed."""
        self.branch[name] = str(self.random.choice(list(SIDE)))
        return SIDE[self.branch[name]]

    # ---- pins

    def crank(self) -> None:
        """Draw A, at or away from the origin, and B."""
        place = complex(*self.random.uniform(-1.0, 1.0, 2)) if self.random.random() < 0.3 else 0.0
        self.pins["A"] = np.full(self.n, place, dtype=complex)
        self.fixed.append("A")
        self.pins["B"] = self.pins["A"] + self.uniform(0.2, 1.0) * turn(self.theta2)

    def ground(self, pin: str, near: str) -> None:
        self.pins[pin] = self.around(near)
        self.fixed.append(pin)

    def carried(self, pin: str, first: str, second: str) -> None:
        """Draw a third pin of the link first-second."""
        line = self.pins[second] - self.pins[first]
        self.pins[pin] = self.pins[first] + line * self.uniform(0.3, 1.5) * turn(self.uniform(-180.0, 180.0))

    def rrr(self, pin: str, first: str, second: str) -> None:
        """Draw a pin of two links from two known pins: the angle between the links, then that at the first pin."""
        P, Q, side = self.pins[first], self.pins[second], self.choose(pin)
        at_pin, at_first = self._near_toggle() if pin == self.near else self._away_from_toggle()
        ratio = np.sin(at_pin + at_first) / np.sin(at_pin)
        self.pins[pin] = P + (Q - P) * ratio * np.exp(1j * side * at_first)

    def _away_from_toggle(self) -> tuple[Array, Array]:
        """Draw the angles of a triangle of two links at their pin and at the first known pin [rad]."""
        at_pin = self.uniform(LEAST, np.pi - LEAST)
        return at_pin, self.uniform(0.15, 0.85) * (np.pi - at_pin)

    def _near_toggle(self) -> tuple[Array, Array]:
        """Draw such angles of links that are nearly stretched, or nearly folded with the first the longer one."""
        stretched, longer = self.uniform(0.0, 1.0) < 0.5, self.uniform(1.3, 2.5)
        at_first = np.where(stretched, self.uniform(0.2, 0.8) * NEAR, np.arcsin(longer * np.sin(NEAR)) - NEAR)
        return np.where(stretched, np.pi - NEAR, NEAR), at_first

    def rrp(self, pin: str, first: str, guide: str) -> None:
        """Draw a pin of a rod from a known pin, on a new guide of the ground."""
        self.pins[pin] = self.around(first)
        rod = np.degrees(np.angle((self.pins[pin] - self.pins[first]) * self.choose(pin)))
        most = 90.0 - np.degrees(NEAR)
        leaning = self.random.choice([-most, most], self.n) if pin == self.near else self.uniform(-60.0, 60.0)
        self.guide(guide, pin, rod + leaning)

    def rrp_on_link(self, pin: str, first: str, role: str, start: str, end: str) -> None:
        """Draw a pin of a rod from a known pin, on a new guide that a link start-end carries."""
        self.pins[pin] = self.around(first)
        rod, line = self.pins[pin] - self.pins[first], self.pins[end] - self.pins[start]
        axes = line / abs(line)
        direction = self.choose(pin) * rod / abs(rod) * turn(self.uniform(-60.0, 60.0)) / axes
        through = (self.pins[pin] - self.pins[start]) / axes + self.uniform(-1.0, 1.0) * direction
        angle = np.degrees(np.angle(direction))
        self.guides[role] = {"of": role, "through": (through.real, through.imag), "angle": angle, **self.friction()}

    def guide(self, name: str, pin: str, angle: Array) -> None:
        """Draw a guide of the ground through a pin, with a friction that may be none."""
        through = self.pins[pin] + self.uniform(-1.0, 1.0) * turn(angle)
        self.guides[name] = {"through": (through.real, through.imag), "angle": angle, **self.friction()}

    def friction(self) -> dict[str, Any]:
        if self.rubs:
            return {"friction": self.uniform(0.02, 1.2)}
        most = 0.0 if self.near else self.random.choice([0.0, 0.3, 1.0])
        return {"friction": self.uniform(0.0, most)} if most else {}

    def line_through(self, role: str, pivot: str, end: str, pin: str, branch: str) -> None:
        """Draw a link pivot-end whose line, which may be off its line of pins, passes through a known pin."""
        side, w = self.choose(branch), self.pins[pin] - self.pins[pivot]
        leaning = turn(self.uniform(-50.0, 50.0)) if self.random.random() < 0.7 else np.ones(self.n, dtype=complex)
        inclined = self.uniform(-20.0, 20.0) if self.random.random() < 0.3 else np.zeros(self.n)
        direction = side * w / abs(w) * leaning
        self.axes[role] = direction
        self.pins[end] = self.pins[pivot] + self.uniform(0.7, 2.5) * direction / turn(inclined)
        offset = (w / direction).imag
        through = 1j * offset * turn(inclined) + self.uniform(-1.0, 1.0) * turn(inclined)
        guide = {"of": role, "through": (through.real, through.imag), "angle": inclined, **self.friction()}
        if np.any(offset) or np.any(inclined) or "friction" in guide:
            self.guides[role] = guide

    def on_line(self, pin: str, role: str, of: str) -> None:
        """Draw a pin along the line of a link that passes through another pin."""
        self.pins[pin] = self.pins[of] + self.uniform(0.4, 2.0) * self.axes[role]

    def across(self, role: str) -> Array:
        """Return directions across the line of a link, by at least 35 degrees [degree]."""
        return np.degrees(np.angle(self.axes[role])) + self.uniform(35.0, 145.0)

    def wheel(self, role: str, pivot: str, pin: str, ratio: float) -> None:
        """Draw the pin of a second crank geared to the first."""
        phase = self.uniform(-180.0, 180.0)
        self.gears[role] = {"phase": phase}
        if self.random.random() < 0.5:
            self.gears[role]["pressure_angle"] = self.uniform(14.0, 25.0)
        self.pins[pin] = self.pins[pivot] + self.uniform(0.2, 1.0) * turn(ratio * self.theta2 + phase)

    def yoke(self, role: str, guide: str, pin: str) -> None:
        """Draw the guide of a yoke, somewhere near the pin that its slot slides past, and the slot's angle."""
        angle = self.uniform(-180.0, 180.0)
        through = self.around(pin, 0.0, 1.0)
        self.guides[guide] = {"through": (through.real, through.imag), "angle": angle, **self.friction()}
        self.parts[role] = {"slot_angle": self.uniform(35.0, 145.0)}
        if self.rubs:
            self.parts[role]["slot_friction"] = self.uniform(0.02, 1.2)

    def cylinder(self, role: str, first: str, second: str) -> None:
        """Hold a cylinder at the distance of two pins, or move it over the turn."""
        length = abs(self.pins[second] - self.pins[first])
        if self.random.random() < 0.5:
            phase = self.uniform(0.0, 360.0)[:, None] + np.arange(0.0, 360.0, 11.25)
            around = 1.0 + self.uniform(0.0, 0.1)[:, None] * turn(phase).real
            length = around * (length / length_spline(around)(self.theta2))[:, None]
        self.parts[role] = {"length": length}

    # ---- the whole

    def linkages(self, text: str) -> Linkages:
        """Return the linkages without masses and loads."""
        points: dict[str, tuple[Array, Array]] = {}
        parts = {role: dict(part) for role, part in self.parts.items()}
        for body in map(element, text.split(",")):
            if len(body.pins) > 1:
                line = self.pins[body.pins[1]] - self.pins[body.pins[0]]
                parts[body.role] = {"length": abs(line)}
                for pin in body.pins[2:]:
                    own = (self.pins[pin] - self.pins[body.pins[0]]) / line * abs(line)
                    points[pin] = abs(own), np.degrees(np.angle(own))
        ground = {pin: (self.pins[pin].real, self.pins[pin].imag) for pin in self.fixed}
        from_A = {pin: z - self.pins["A"] for pin, z in self.pins.items()}
        return Linkages(text, ground, parts, from_A, self.theta2, points, self.guides, self.gears, self.branch)
