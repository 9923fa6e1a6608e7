"""Numbers of a linkage's pins, guides, slots and cylinders under the names that the physics takes.

Positions that are products or differences are double-doubles, their low words under names in `_lo`: near a toggle the
result depends on digits beyond the 53 bits of one number.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

import numpy as np

from linksweep.base.degrees import cos_sin, cos_sin_low_words
from linksweep.base.validate import Number
from linksweep.chains.rows.crank import BRANCH_SIGN, frame_parameters
from linksweep.engine.run import Field
from linksweep.mechanisms.links import Cylinder, Gears, Slider
from linksweep.physics.algebra.double_double import Pair, divide, dot, multiply, ordered_sum, two_product, two_sum

Numbers = dict[str, Any]
NumbersOf = Callable[..., Numbers]
ORIGIN = (0.0, 0.0)


def by_values(numbers_of: NumbersOf) -> NumbersOf:
    """Make a function of a name and numbers compute with the values alone of arrays that have the same dims and no
    labels: for as many operations as these, arrays with dims take ten times as long."""

    @wraps(numbers_of)
    def of_values(name: str, *numbers: Number) -> Numbers:
        arrays = [number for number in numbers if hasattr(number, "dims")]
        alike = len({array.dims for array in arrays}) == 1
        if not alike or any(hasattr(array, "coords") or type(array.data) is not np.ndarray for array in arrays):
            return numbers_of(name, *numbers)
        results = numbers_of(name, *(number.values if hasattr(number, "dims") else number for number in numbers))
        return {key: arrays[0].copy(data=x) if isinstance(x, np.ndarray) else x for key, x in results.items()}

    return of_values


def words(name: str, pair: Pair) -> Numbers:
    """Return a double-double under a name and that of its low word."""
    return {name: pair[0], f"{name}_lo": pair[1]}


def root(square: Pair) -> Pair:
    """Return the square root of a double-double, by one Newton step."""
    high = np.sqrt(square[0])
    product, product_lo = two_product(high, high)
    return ordered_sum(high, (((square[0] - product) - product_lo) + square[1]) / (2.0 * high))


@by_values
def ground_pin(pin: str, x_pin: Number, y_pin: Number, x_crank: Number, y_crank: Number) -> Numbers:
    """Return a ground pin's position from the crank's pivot [m], and its distance and direction from there."""
    x, y = two_sum(x_pin, -x_crank), two_sum(y_pin, -y_crank)
    with np.errstate(all="ignore"):  # a design whose pins coincide has no direction
        distance = root(dot(x, y, x, y))
        cos, sin = divide(x, distance), divide(y, distance)
    place = words(f"{pin}x", x) | words(f"{pin}y", y)
    return place | words(f"{pin}_distance", distance) | words(f"{pin}_cos", cos) | words(f"{pin}_sin", sin)


@by_values
def point_on_link(pin: str, distance: Number, angle: Number) -> Numbers:
    """Return a pin's components along and across its link's line of pins [m], of its polar coordinates."""
    cos, sin, cos_lo, sin_lo = cos_sin_low_words(angle)
    along, across = (multiply((distance, 0.0), part) for part in ((cos, cos_lo), (sin, sin_lo)))
    return words(f"{pin}_along", along) | words(f"{pin}_across", across)


@by_values
def guide_line(name: str, angle: Number, x_guide: Number, y_guide: Number, x_host: Number, y_host: Number) -> Numbers:
    """Return the line of a guide in the axes of its host: direction, distance to the left of their origin.

    `start` is the position along the line of the guide's point, measured from the foot of the origin.
    """
    cos, sin, cos_lo, sin_lo = cos_sin_low_words(angle)
    x, y = two_sum(x_guide, -x_host), two_sum(y_guide, -y_host)
    offset, start = dot((-sin, -sin_lo), (cos, cos_lo), x, y), dot((cos, cos_lo), (sin, sin_lo), x, y)
    return frame_parameters(name, angle) | words(f"{name}_offset", offset) | {f"{name}_start": start[0]}


def slot_numbers(role: str, slider: Slider) -> Numbers:
    """Return the direction of a yoke's slot from that of its guide, and its friction."""
    return frame_parameters(f"{role} slot", slider.slot_angle) | {f"{role} slot_friction": slider.slot_friction}


def gear_numbers(role: str, gears: Gears) -> Numbers:
    """Return the direction of a wheel where the crank's angle is 0, and the tangent of the pressure angle."""
    cos, sin = cos_sin(0.0 if gears.pressure_angle is None else gears.pressure_angle)
    return frame_parameters(f"{role} phase", gears.phase) | {f"{role}_pressure_slope": sin / cos}


def cylinder_numbers(role: str, cylinder: Cylinder) -> Numbers:
    """Return the length of a cylinder [m] and its first two derivatives to the crank's angle [m/rad, m/rad²]."""
    length, slope, curvature = cylinder.over_angle
    return {f"{role}_length": length, f"{role}_length_slope": slope, f"{role}_length_curvature": curvature}


def branch_sign(name: str, branch: str) -> Numbers:
    """Return the sign of a dyad's assembly: 1 for open, -1 for crossed; for both, the two over a dim of that name."""
    both = Field((f"branch_{name}",), np.array(list(BRANCH_SIGN.values())))
    return {f"branch_sign {name}": BRANCH_SIGN.get(branch, both)}
