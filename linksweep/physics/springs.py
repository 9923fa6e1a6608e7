"""Springs and dampers between two points, or between the lines of pins of two links.

A spring with the tension S pulls its ends together: the end at p bears S·u, the end at q bears −S·u, with

    u = (q − p)/l,   l = |q − p|,   S = k(l − l0)   or, for a damper,   S = c·dl/dt,   dl/dt = u·(v_q − v_p)

As the crank turns, the direction u turns by at most 1/w per radian, w = l/|d(q − p)/dθ2|: within such a width about the
angle where the ends pass closest, the force on them reverses.

A spring of zero length has no direction: its force there is 0, the mean of the forces on either side as its ends pass
through each other.
"""

from linksweep.physics.algebra.arctangent import arctangent
from linksweep.physics.algebra.arithmetic import Number, where
from linksweep.physics.algebra.planar import cross, dot, root, square


def line_direction(dx: Number, dy: Number, length: Number) -> tuple[Number, Number]:
    """Return u of the module's equations; 0 where the length is zero."""
    return where(length > 0.0, dx / length, 0.0), where(length > 0.0, dy / length, 0.0)


def turning_width(length: Number, dux: Number, duy: Number) -> Number:
    """Return w of the module's description [rad]."""
    return length / root(square(dux, duy))


def spring_tension(rate: Number, free_length: Number, length: Number) -> Number:
    """Return S = k(l − l0), negative where the spring pushes."""
    return rate * (length - free_length)


def twist(from_x: Number, from_y: Number, to_x: Number, to_y: Number, free_cos: Number, free_sin: Number) -> Number:
    """Return the angle from one vector to another, less the free angle, folded to (−π, π] [rad]."""
    along, across = dot(from_x, from_y, to_x, to_y), cross(from_x, from_y, to_x, to_y)
    return arctangent(across * free_cos - along * free_sin, along * free_cos + across * free_sin)


def turning_rate(omega_to: Number, omega_from: Number) -> Number:
    """Return the rate of the angle from one link to another."""
    return omega_to - omega_from


def resisting_power(effort: Number, rate: Number) -> Number:
    """Return the power −S·dl/dt of an effort (tension or torque) that resists this rate."""
    return -(effort * rate)
