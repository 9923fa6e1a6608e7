"""Coulomb friction on a sliding part: −μ·|N|·sign(v) along its line, with N the normal force on it, v its velocity.

Where friction itself enters the moment equation for N, and N0 is the normal force without friction,

    N = N0/(1 + sign(N)·k),    k = μ·sign(v)·slope

μ·sign(v) is the `direction`, and the slope is the lever arm of the friction over that of the normal force. With w =
sign(N0)·k, exactly one sign of N is consistent for |w| < 1, that of N0; none for w ≤ −1, where the part is jammed; both
for w ≥ 1, where rigid-body statics cannot tell which.
"""

import math

from linksweep.physics.algebra.arithmetic import Number, where

CONTACT_NOISE = 2.0**-44
"""Part of the forces that press below which a normal force counts as none."""


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


def grips_of_two(sin_squared: Number, friction: Number, second_friction: Number) -> tuple[Number, Number]:
    """Return two numbers, of which one is 0 where friction of two guides begins or ceases to wedge what slides on both.

    It wedges where the angle between the guides is at most the sum of their angles of friction, atan μ, or the
    difference of these: which of the two, the directions of sliding decide.
    """
    scale = (1.0 + friction * friction) * (1.0 + second_friction * second_friction)
    both, between = friction + second_friction, friction - second_friction
    return sin_squared - both * both / scale, sin_squared - between * between / scale


def edges_of_cone(along: Number, across: Number, friction: Number) -> tuple[Number, Number, Number]:
    """Return two numbers, of which one is 0 where a force lies on an edge of a guide's cone of friction; and their
    noise.

    If the force presses on this guide and another contact, the other one then bears nothing, whatever its friction.
    """
    rubbing = friction * across
    return along + rubbing, along - rubbing, CONTACT_NOISE * (abs(along) + abs(rubbing))


def two_sliding_contacts(
    along: Number, across: Number, direction: Number, cos: Number, sin: Number, second_direction: Number
) -> tuple[Number, Number, Number, Number, Number]:
    """Return normal force and friction of two guides on what slides on both, and the number of consistent solutions.

    A force (along, across), in the axes of the first guide, presses on it; the second guide lies at the angle of this
    cosine and sine. Each pair of signs of the normal forces is assumed in turn. Only one pair that its own solution
    confirms makes it a solution: else the forces are NaN.
    """
    least = -CONTACT_NOISE * (abs(along) + abs(across))
    normal = second = count = 0.0
    for sign in (1.0, -1.0):
        for second_sign in (1.0, -1.0):
            k, k2 = sign * direction, second_sign * second_direction
            pushed_along, pushed_across = sin + k2 * cos, cos - k2 * sin
            inverse = 1.0 / (pushed_along - k * pushed_across)
            one = -(along * pushed_across + across * pushed_along) * inverse
            other = (along + k * across) * inverse
            confirmed = has_sign(one, sign, least) * has_sign(other, second_sign, least)
            normal, second = where(confirmed > 0.0, one, normal), where(confirmed > 0.0, other, second)
            count = count + confirmed
    normal, second = (where(abs(count - 1.0) < 0.5, force, math.nan) for force in (normal, second))
    return normal, friction(normal, direction), second, friction(second, second_direction), count


def two_contacts_from_friction(
    along: Number, across: Number, friction: Number, cos: Number, sin: Number, second_friction: Number
) -> tuple[Number, Number]:
    """Return the normal forces of two guides on what slides on both, where the friction of both is known."""
    second = (along + friction + second_friction * cos) / sin
    return -(across + second_friction * sin + second * cos), second


def has_sign(force: Number, sign: float, least: Number) -> Number:
    """Return 1 where a force has the sign that was assumed for it, else 0; one of next to nothing is positive."""
    return where(force < least, 1.0 if sign < 0.0 else 0.0, 0.0 if sign < 0.0 else 1.0)


def solutions_status(status: Number, count: Number) -> Number:
    """Return `status`, or, where it is 0, 4 (jammed: no solution) or 6 (more than one)."""
    jammed = where(count < 0.5, 4.0, where(count > 1.5, 6.0, 0.0))
    return where(status > 0.0, status, jammed)


def friction(normal: Number, direction: Number) -> Number:
    """Return the friction force for a normal force that does not depend on it."""
    return -(opposing(normal, direction) * normal)


def jammed_status(status: Number, wedging: Number) -> Number:
    """Return `status`, or, where it is 0 and friction wedges, 4 (jammed: no solution) or 6 (two solutions)."""
    return where(abs(wedging) < 1.0, status, where(status > 0.0, status, where(wedging > 0.0, 6.0, 4.0)))
