"""Springs and dampers between two points, or between the lines of pins of two links.

Of a spring that pulls its ends together with the tension S, the one end, at p, bears S·u and the other, at q, −S·u:

    u = (q − p)/l,   l = |q − p|,   S = k(l − l0)   or, of a damper,   S = c·dl/dt,   dl/dt = u·(v_q − v_p)

As the crank turns, the direction u turns by at most 1/w per radian of it, w = l/|d(q − p)/dθ2|: within such a width
about the place where the ends pass closest, the force on them turns over.

A spring of no length has no direction: its force there is 0, the mean of what it is on either side as its ends pass
through each other.
"""

from linksweep.physics.arctangent import arctangent
from linksweep.physics.arithmetic import Number, where
from linksweep.physics.planar import cross, dot, root, square


def line_direction(dx: Number, dy: Number, length: Number) -> tuple[Number, Number]:
    """u of the module's equation; 0 where there is none."""
    return where(length > 0.0, dx / length, 0.0), where(length > 0.0, dy / length, 0.0)


def turning_width(length: Number, dux: Number, duy: Number) -> Number:
    """w of the module's equation [rad]."""
    return length / root(square(dux, duy))


def spring_tension(rate: Number, free_length: Number, length: Number) -> Number:
    """S = k(l − l0), negative where it pushes."""
    return rate * (length - free_length)


def twist(from_x: Number, from_y: Number, to_x: Number, to_y: Number, free_cos: Number, free_sin: Number) -> Number:
    """Angle from one vector to another, less the free angle, folded to (−π, π] [rad]."""
    along, across = dot(from_x, from_y, to_x, to_y), cross(from_x, from_y, to_x, to_y)
    return arctangent(across * free_cos - along * free_sin, along * free_cos + across * free_sin)


def turning_rate(omega_to: Number, omega_from: Number) -> Number:
    """Rate of the angle from one link to another."""
    return omega_to - omega_from


def resisting_power(effort: Number, rate: Number) -> Number:
    """Power that an effort feeds in which resists this rate: −S·dl/dt."""
    return -(effort * rate)
