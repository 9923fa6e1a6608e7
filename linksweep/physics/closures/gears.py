"""A wheel that gears turn i times as fast as the crank, about a pin D; both pivots lie at d = A→D from each other.

Teeth touch at the pitch point A + i/(i − 1) d, where both wheels have one velocity, and push along a line at the
pressure angle to the velocity there, always so that external gears part, and a pinion is pushed out of its ring.
"""

from linksweep.physics.algebra.arithmetic import Number, where


def torque_on_crank(moment: Number, ratio: Number) -> Number:
    """Return the torque of the wheel on the crank, from all other moments on the wheel about D: powers add to zero."""
    return ratio * moment


def mesh_direction(torque: Number, dx: Number, dy: Number, ratio: Number, slope: Number) -> tuple[Number, Number]:
    """Return the force of the wheel's teeth on the crank per unit of their torque on it; `slope` is the tangent of the
    pressure angle."""
    across = (1.0 - 1.0 / ratio) / (dx * dx + dy * dy)
    parting = where(ratio < 0.0, -abs(across) * slope, abs(across) * slope)
    along = where(torque < 0.0, -parting, parting)
    return along * dx - across * dy, along * dy + across * dx
