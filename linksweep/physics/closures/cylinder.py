"""A telescopic cylinder between two pins P and Q: r = P→Q of length L, force positive where it pushes them apart."""

from linksweep.physics.algebra.arithmetic import NOISE, Number, sqrt, where


def span(rx: Number, ry: Number) -> tuple[Number, Number, Number]:
    """Return L and the direction from P to Q."""
    length = sqrt(rx * rx + ry * ry)
    return length, *direction(rx, ry, length)


def direction(rx: Number, ry: Number, length: Number) -> tuple[Number, Number]:
    """Return the direction from P to Q."""
    return rx / length, ry / length


def extended_velocity(
    ux: Number, uy: Number, slope: Number, length: Number, rx: Number, ry: Number
) -> tuple[Number, Number]:
    """Return the velocity at Q of a rigid link that turns about P with the cylinder, less that of its turning:
    u + (L'/L) r."""
    stretch = slope / length
    return ux + stretch * rx, uy + stretch * ry


def extended_slope(
    ux_slope: Number,
    uy_slope: Number,
    ratio: Number,
    slope: Number,
    curvature: Number,
    length: Number,
    rx: Number,
    ry: Number,
) -> tuple[Number, Number]:
    """Return the derivative of that velocity: u' + (L''/L) r + 2k (L'/L)⊥r (Coriolis), k the cylinder's rotation."""
    along, coriolis = curvature / length, 2.0 * ratio * (slope / length)
    return ux_slope + along * rx - coriolis * ry, uy_slope + along * ry + coriolis * rx


def standing_status(ratio: Number, size: Number) -> Number:
    """Return 0, or 3 (dead centre) where the driven part stands still: its ratio to the crank is rounding of `size`."""
    return where(abs(ratio) > NOISE * size, 0.0, 3.0)
