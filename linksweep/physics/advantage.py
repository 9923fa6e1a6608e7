"""Mechanical advantage: what comes out per what goes in, without friction, weight and inertia.

No power is lost then, so that forces are as velocities are, turned over: T_out/T_in = ω_in/ω_out, and with the radii
at which they act, F_out/F_in = (ω_in/ω_out)·(r_in/r_out). Source: R. L. Norton, Design of Machinery, chapter
"Velocity Analysis".
"""

import math

from linksweep.physics.arithmetic import Number, where


def torque_ratio(velocity_ratio: Number) -> Number:
    """Torque out per torque in; NaN where the output stands still, and any load could be held."""
    return where(abs(velocity_ratio) > 0.0, 1.0 / velocity_ratio, math.nan)


def mechanical_advantage(velocity_ratio: Number, radius_in: Number, radius_out: Number) -> Number:
    """Force out per force in, each square to its radius; of an output that slides, the radius is 1."""
    output = velocity_ratio * radius_out
    return where(abs(output) > 0.0, radius_in / output, math.nan)
