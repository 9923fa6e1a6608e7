"""Bodies in the plane and the constraints between them, in maximal coordinates: x, y of each centre of gravity, angle.

Each constraint has its value, which vanishes where it holds; the generalised forces of its unit multipliers, which are
also its gradient; its second derivative in time; and what drives it. Numbers are floats or decimals, single or arrays.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from benchmarks.stress.decimals import Number, Vector, root

ORIGIN = Vector(0, 0)
Push = dict[str, tuple[Number, Number, Number]]
"""Force x and y on bodies, and moment about their centres of gravity."""


class Frame(NamedTuple):
    """A body's centre of gravity, the direction of its axes, and their first and second rates."""

    G: Vector = ORIGIN
    u: Vector = Vector(1, 0)
    v: Vector = ORIGIN
    omega: Number = 0
    a: Vector = ORIGIN
    alpha: Number = 0

    def arm(self, local: Vector) -> Vector:
        return local.turned(self.u)

    def at(self, local: Vector) -> Vector:
        return self.G + self.arm(local)

    def velocity(self, local: Vector) -> Vector:
        return self.v + self.arm(local).left * self.omega

    def acceleration(self, local: Vector) -> Vector:
        arm = self.arm(local)
        return self.a + arm.left * self.alpha - arm * (self.omega * self.omega)

    def velocity_at(self, place: Vector) -> Vector:
        """Return the velocity of the body's point at a place of the ground's axes."""
        return self.v + (place - self.G).left * self.omega


Frames = Mapping[str, Frame]
GROUND = "ground"


def push(frames: Frames, role: str, place: Vector, force: Vector) -> Push:
    """Return a force at a place as a push on a body; none on the ground."""
    if role == GROUND:
        return {}
    return {role: (force.x, force.y, (place - frames[role].G).cross(force))}


def pair(frames: Frames, i: str, j: str, place: Vector, force: Vector) -> Push:
    """Return a force on j and its opposite on i, both at a place."""
    return push(frames, j, place, force) | push(frames, i, place, force * -1)


@dataclass(frozen=True)
class Pin:
    """A pin of i and j; its multipliers are the force on j."""

    i: str
    at_i: Vector
    j: str
    at_j: Vector

    rows: ClassVar[int] = 2

    def driven(self, omega2: Number, alpha2: Number) -> list[tuple[Number, Number]]:
        return [(0, 0), (0, 0)]

    def value(self, frames: Frames) -> list[Number]:
        return [*(frames[self.j].at(self.at_j) - frames[self.i].at(self.at_i))]

    def pushes(self, frames: Frames) -> list[Push]:
        ends = (self.i, self.at_i, -1), (self.j, self.at_j, 1)
        axes = Vector(1, 0), Vector(0, 1)
        return [
            {role: value for r, at, sign in ends for role, value in push(frames, r, frames[r].at(at), e * sign).items()}
            for e in axes
        ]

    def second(self, frames: Frames) -> list[Number]:
        return [*(frames[self.j].acceleration(self.at_j) - frames[self.i].acceleration(self.at_i))]


@dataclass(frozen=True)
class OnLine:
    """A point of j on a line of i, through a point with a direction; its multiplier is the force on j along the line's
    left normal."""

    i: str
    through: Vector
    direction: Vector
    j: str
    at: Vector
    friction: Number = 0

    rows: ClassVar[int] = 1

    def driven(self, omega2: Number, alpha2: Number) -> list[tuple[Number, Number]]:
        return [(0, 0)]

    def axes(self, frames: Frames) -> tuple[Vector, Vector]:
        """Return the line's direction, and the vector from its point to that of j."""
        i = frames[self.i]
        return i.arm(self.direction), frames[self.j].at(self.at) - i.at(self.through)

    def value(self, frames: Frames) -> list[Number]:
        u, w = self.axes(frames)
        return [u.cross(w)]

    def pushes(self, frames: Frames) -> list[Push]:
        u, _ = self.axes(frames)
        return [pair(frames, self.i, self.j, frames[self.j].at(self.at), u.left)]

    def rubbing(self, frames: Frames) -> Push:
        """Return the unit force on j along the line, and its opposite on i."""
        u, _ = self.axes(frames)
        return pair(frames, self.i, self.j, frames[self.j].at(self.at), u)

    def second(self, frames: Frames) -> list[Number]:
        u, w = self.axes(frames)
        i, dw, ddw = frames[self.i], *self._relative(frames)
        return [u.left.dot(ddw) - 2 * i.omega * u.dot(dw) - i.alpha * u.dot(w)]

    def sliding(self, frames: Frames) -> tuple[Number, Number, Number]:
        """Return position, velocity and acceleration of the point along the line."""
        u, w = self.axes(frames)
        i, dw, ddw = frames[self.i], *self._relative(frames)
        return u.dot(w), u.dot(dw), u.dot(ddw) + 2 * i.omega * u.left.dot(dw) - i.omega * i.omega * u.dot(w)

    def _relative(self, frames: Frames) -> tuple[Vector, Vector]:
        i, j = frames[self.i], frames[self.j]
        return j.velocity(self.at) - i.velocity(self.through), j.acceleration(self.at) - i.acceleration(self.through)


@dataclass(frozen=True)
class Turned:
    """The angle of j is that of i times a ratio, plus a constant; its multiplier is the torque on j.

    `direction` is that of j in the axes of i, or in the ground's where `target` is true; `drives` is true of the
    crank's own angle.
    """

    i: str
    j: str
    direction: Vector
    ratio: Number = 1
    target: bool = False
    drives: bool = False

    rows: ClassVar[int] = 1

    def driven(self, omega2: Number, alpha2: Number) -> list[tuple[Number, Number]]:
        """Return the first and second derivatives in time of the crank's angle; zeros for other angles."""
        return [(omega2, alpha2)] if self.drives else [(0, 0)]

    def value(self, frames: Frames) -> list[Number]:
        base = self.direction if self.target else self.direction.turned(frames[self.i].u)
        return [base.cross(frames[self.j].u)]

    def pushes(self, frames: Frames) -> list[Push]:
        on_i = {} if self.i == GROUND else {self.i: (0, 0, -self.ratio)}
        return [{self.j: (0, 0, 1), **on_i}]

    def second(self, frames: Frames) -> list[Number]:
        return [frames[self.j].alpha - self.ratio * frames[self.i].alpha]


@dataclass(frozen=True)
class Apart:
    """Two points of i and j are a length apart; its multiplier times the length is the force that pushes them apart.

    `length` has its first and second derivatives by the crank's angle [rad] with it.
    """

    i: str
    at_i: Vector
    j: str
    at_j: Vector
    length: Sequence[Number] = (0, 0, 0)
    role: str = ""

    rows: ClassVar[int] = 1

    def driven(self, omega2: Number, alpha2: Number) -> list[tuple[Number, Number]]:
        """Return the first and second derivatives in time of half the length's square."""
        length, slope, curvature = self.length
        return [(length * slope * omega2, (slope * slope + length * curvature) * omega2**2 + length * slope * alpha2)]

    def line(self, frames: Frames) -> Vector:
        return frames[self.j].at(self.at_j) - frames[self.i].at(self.at_i)

    def value(self, frames: Frames) -> list[Number]:
        w = self.line(frames)
        return [(w.dot(w) - self.length[0] * self.length[0]) / 2]

    def pushes(self, frames: Frames) -> list[Push]:
        w = self.line(frames)
        on_j = push(frames, self.j, frames[self.j].at(self.at_j), w)
        return [on_j | push(frames, self.i, frames[self.i].at(self.at_i), w * -1)]

    def second(self, frames: Frames) -> list[Number]:
        dw = frames[self.j].velocity(self.at_j) - frames[self.i].velocity(self.at_i)
        ddw = frames[self.j].acceleration(self.at_j) - frames[self.i].acceleration(self.at_i)
        return [self.line(frames).dot(ddw) + dw.dot(dw)]

    def lengthening(self, frames: Frames) -> tuple[Number, Number]:
        """Return the length and its rate."""
        w = self.line(frames)
        dw = frames[self.j].velocity(self.at_j) - frames[self.i].velocity(self.at_i)
        length = root(w.dot(w))
        return length, w.dot(dw) / length


Constraint = Pin | OnLine | Turned | Apart
