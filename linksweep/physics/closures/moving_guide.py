"""Motion relative to a guide on a moving link, per rate of the crank.

The link carries the origin O of the guide's axes and turns by k per radian of the crank. A point moves in these axes as
it would over a guide at rest, with its velocity less that of the link's own point there, u − u_O − k⊥p, where p is the
position from O, and with the derivative of the velocity less u_O' + k'⊥p − k²p and Coriolis' 2k⊥v, v the velocity along
the guide. On the ground all these terms vanish.
"""

from linksweep.physics.algebra.arithmetic import Number
from linksweep.physics.algebra.planar import cross, dot

Vector = tuple[Number, Number]


def on_guide(position: Number, offset: Number, guide_cos: Number, guide_sin: Number) -> Vector:
    """Return the vector from O to the point of the guide at a position along it."""
    return position * guide_cos - offset * guide_sin, position * guide_sin + offset * guide_cos


def relative_velocity(
    ux: Number, uy: Number, uOx: Number, uOy: Number, ratio: Number, px: Number, py: Number
) -> Vector:
    """Return the velocity relative to the guide."""
    return (ux - uOx) + ratio * py, (uy - uOy) - ratio * px


def along_and_across(ux: Number, uy: Number, guide_cos: Number, guide_sin: Number) -> Vector:
    """Return the components of a vector along the guide and across it."""
    return dot(ux, uy, guide_cos, guide_sin), cross(guide_cos, guide_sin, ux, uy)


def relative_slope(
    ux_slope: Number,
    uy_slope: Number,
    uOx_slope: Number,
    uOy_slope: Number,
    ratio: Number,
    slope: Number,
    px: Number,
    py: Number,
    sliding: Number,
    guide_cos: Number,
    guide_sin: Number,
) -> Vector:
    """Return the derivative of the velocity relative to the guide, which slides by `sliding` per radian."""
    square, coriolis = ratio * ratio, 2.0 * ratio * sliding
    return (
        (ux_slope - uOx_slope) + slope * py + square * px + coriolis * guide_sin,
        (uy_slope - uOy_slope) - slope * px + square * py - coriolis * guide_cos,
    )


def sliding_velocity(
    uOx: Number,
    uOy: Number,
    ratio: Number,
    px: Number,
    py: Number,
    sliding: Number,
    guide_cos: Number,
    guide_sin: Number,
) -> Vector:
    """Return the velocity of a point that slides along the guide."""
    return uOx - ratio * py + sliding * guide_cos, uOy + ratio * px + sliding * guide_sin


def guiding_slope(
    uOx_slope: Number,
    uOy_slope: Number,
    ratio: Number,
    slope: Number,
    px: Number,
    py: Number,
    sliding: Number,
    guide_cos: Number,
    guide_sin: Number,
) -> Vector:
    """Return the derivative of the velocity of a point that slides evenly along the guide, by `sliding` per radian."""
    minus = relative_slope(0.0, 0.0, uOx_slope, uOy_slope, ratio, slope, px, py, sliding, guide_cos, guide_sin)
    return -minus[0], -minus[1]
