"""Mechanical advantage: ratio of output to input force or torque, without friction, weight and inertia.

No power is lost then, so forces are in the inverse ratio of velocities: T_out/T_in = ω_in/ω_out, and with the radii at
which they act, F_out/F_in = (ω_in/ω_out)·(r_in/r_out). Source: R. L. Norton, Design of Machinery, chapter "Velocity
Analysis".
"""

import math

from linksweep.physics.algebra.arithmetic import Number, where


def torque_ratio(velocity_ratio: Number) -> Number:
    """Return output torque over input torque; NaN where the output stands still, for then it could hold any load."""
    return where(abs(velocity_ratio) > 0.0, 1.0 / velocity_ratio, math.nan)


def mechanical_advantage(velocity_ratio: Number, radius_in: Number, radius_out: Number) -> Number:
    """Return output force over input force, each perpendicular to its radius; for a sliding output the radius is 1."""
    output = velocity_ratio * radius_out
    return where(abs(output) > 0.0, radius_in / output, math.nan)
