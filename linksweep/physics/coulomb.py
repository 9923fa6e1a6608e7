"""Coulomb friction on a sliding part: −μ·|N|·sign(v) along its line, with N the normal force on it, v its velocity.

Where friction itself enters the moment equation for N, and N0 is the normal force without friction,

    N = N0/(1 + sign(N)·k),    k = μ·sign(v)·slope

μ·sign(v) is the `direction`, and the slope is the lever arm of the friction over that of the normal force. With w =
sign(N0)·k, exactly one sign of N is consistent for |w| < 1, that of N0; none for w ≤ −1, where the part is jammed; both
for w ≥ 1, where rigid-body statics cannot tell which.
"""

import math

from linksweep.physics.algebra.arithmetic import Number, where


def direction_of_sliding(friction: Number, velocity: Number, omega2: Number, noise: Number) -> Number:
    """Return μ·sign(v), or 0 where the part stands still: slower than `noise` per radian of the crank."""
    standing = abs(omega2) * noise
    return where(velocity > standing, friction, where(velocity < -standing, -friction, 0.0))


def opposing(force: Number, direction: Number) -> Number:
    """Return μ·sign(v)·sign(N) from any force that has the sign of N; the friction force is −N times this."""
    return where(force < 0.0, -direction, direction)


def sliding_contact(frictionless: Number, slope: Number, direction: Number) -> tuple[Number, Number, Number]:
    """Return the normal force N, the friction force, and w, whose magnitude reaches 1 where friction wedges."""
    k = opposing(frictionless, direction)
    wedging = k * slope
    normal = frictionless / where(abs(wedging) < 1.0, 1.0 + wedging, math.nan)
    return normal, -(k * normal), wedging


def grip(along_squared: Number, across: Number, friction: Number) -> Number:
    """Return along² − (μ·across)², positive where friction does not wedge: the slope is across over along."""
    wedged = friction * across
    return along_squared - wedged * wedged


def friction(normal: Number, direction: Number) -> Number:
    """Return the friction force for a normal force that does not depend on it."""
    return -(opposing(normal, direction) * normal)


def jammed_status(status: Number, wedging: Number) -> Number:
    """Return `status`, or, where it is 0 and friction wedges, 4 (jammed: no solution) or 6 (two solutions)."""
    return where(abs(wedging) < 1.0, status, where(status > 0.0, status, where(wedging > 0.0, 6.0, 4.0)))
