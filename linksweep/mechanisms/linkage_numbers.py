"""Numbers of a linkage's pins, guides, slots and cylinders under the names that the physics takes.

Positions that are products or differences are double-doubles, their low words under names in `_lo`: near a toggle the
result depends on digits beyond the 53 bits of one number.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from linksweep.base.degrees import cos_sin, cos_sin_low_words
from linksweep.base.validate import Number
from linksweep.chains.rows.crank import BRANCH_SIGN, frame_parameters
from linksweep.engine.run import Field
from linksweep.mechanisms.links import Cylinder, Gears, Guide, Slider
from linksweep.physics.algebra.double_double import Pair, divide, dot, multiply, ordered_sum, two_product, two_sum

Numbers = dict[str, Any]
ORIGIN = (0.0, 0.0)


def words(name: str, pair: Pair) -> Numbers:
    """Return a double-double under a name and that of its low word."""
    return {name: pair[0], f"{name}_lo": pair[1]}


def from_origin(point: Sequence[Number], origin: Sequence[Number]) -> tuple[Pair, Pair]:
    """Return the exact vector from an origin to a point."""
    x, y = (two_sum(coordinate, -start) for coordinate, start in zip(point, origin, strict=True))
    return x, y


def root(square: Pair) -> Pair:
    """Return the square root of a double-double, by one Newton step."""
    high = np.sqrt(square[0])
    product, product_lo = two_product(high, high)
    return ordered_sum(high, (((square[0] - product) - product_lo) + square[1]) / (2.0 * high))


def ground_pin(pin: str, point: Sequence[Number], crank_pivot: Sequence[Number]) -> Numbers:
    """Return a ground pin's position from the crank's pivot [m], and its distance and direction from there."""
    x, y = from_origin(point, crank_pivot)
    with np.errstate(all="ignore"):  # a design whose pins coincide has no direction
        distance = root(dot(x, y, x, y))
        cos, sin = divide(x, distance), divide(y, distance)
    place = words(f"{pin}x", x) | words(f"{pin}y", y)
    return place | words(f"{pin}_distance", distance) | words(f"{pin}_cos", cos) | words(f"{pin}_sin", sin)


def point_on_link(pin: str, distance: Number, angle: Number) -> Numbers:
    """Return a pin's components along and across its link's line of pins [m], of its polar coordinates."""
    cos, sin, cos_lo, sin_lo = cos_sin_low_words(angle)
    along, across = (multiply((distance, 0.0), part) for part in ((cos, cos_lo), (sin, sin_lo)))
    return words(f"{pin}_along", along) | words(f"{pin}_across", across)


def guide_numbers(name: str, guide: Guide, origin: Sequence[Number] = ORIGIN) -> Numbers:
    """Return the line of a guide in the axes of its host: direction, distance to the left of their origin, friction.

    `start` is the position along the line of the guide's point, measured from the foot of the origin.
    """
    cos, sin, cos_lo, sin_lo = cos_sin_low_words(guide.angle)
    x, y = from_origin(guide.through, origin)
    offset, start = dot((-sin, -sin_lo), (cos, cos_lo), x, y), dot((cos, cos_lo), (sin, sin_lo), x, y)
    line = frame_parameters(name, guide.angle) | words(f"{name}_offset", offset)
    return line | {f"{name}_start": start[0], f"{name}_friction": guide.friction}


def slot_numbers(role: str, slider: Slider) -> Numbers:
    """Return the direction of a yoke's slot from that of its guide, and its friction."""
    return frame_parameters(f"{role}_slot", slider.slot_angle) | {f"{role}_slot_friction": slider.slot_friction}


def gear_numbers(role: str, gears: Gears) -> Numbers:
    """Return the direction of a wheel where the crank's angle is 0, and the tangent of the pressure angle."""
    cos, sin = cos_sin(0.0 if gears.pressure_angle is None else gears.pressure_angle)
    return frame_parameters(f"{role}_phase", gears.phase) | {f"{role}_pressure_slope": sin / cos}


def cylinder_numbers(role: str, cylinder: Cylinder) -> Numbers:
    """Return the length of a cylinder [m] and its first two derivatives to the crank's angle [m/rad, m/rad²]."""
    length, slope, curvature = cylinder.over_angle
    return {f"{role}_length": length, f"{role}_length_slope": slope, f"{role}_length_curvature": curvature}


def branch_sign(name: str, branch: str) -> Numbers:
    """Return the sign of a dyad's assembly: 1 for open, -1 for crossed; for both, the two over a dim of that name."""
    both = Field((f"branch_{name}",), np.array(list(BRANCH_SIGN.values())))
    return {f"branch_{name}": BRANCH_SIGN.get(branch, both)}
