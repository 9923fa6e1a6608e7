"""Axes of links in a drawing, and points in their polar coordinates."""

from __future__ import annotations

import math
from dataclasses import dataclass

from linksweep.files.pmks.drawing import Point

Polar = tuple[float, float]


@dataclass(frozen=True)
class Axes:
    """Axes of a link: from a point [m] in a direction [degree]."""

    origin: Point
    angle: float

    def polar(self, point: Point) -> Polar:
        """Return a point's distance from the origin [m], and its angle from the axis [degree]."""
        distance, angle = polar(self.origin, point)
        return distance, math.remainder(angle - self.angle, 360.0) if distance else 0.0

    def offset(self, point: Point) -> float:
        """Return a point's distance to the left of the axis [m]."""
        return along((point[0] - self.origin[0], point[1] - self.origin[1]), self.angle + 90.0)

    def components(self, vector: Point) -> Point:
        """Return the components of a vector along and across."""
        return along(vector, self.angle), along(vector, self.angle + 90.0)


def polar(start: Point, end: Point) -> Polar:
    """Return the distance between two points [m], and the direction from one to the other [degree]."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    return math.hypot(dx, dy), math.degrees(math.atan2(dy, dx))


def along(vector: Point, angle: float) -> float:
    """Return the component of a vector in a direction [degree]."""
    return vector[0] * math.cos(math.radians(angle)) + vector[1] * math.sin(math.radians(angle))
