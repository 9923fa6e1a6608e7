"""A car in a loop in 50 digits, from Newton's law along the track's tangent and normal, and from work and energy."""

from __future__ import annotations

import numpy as np

from benchmarks.stress.decimals import RADIAN, Array, Vector, angles, directions, fifty_digits, root
from benchmarks.stress.derivatives.numbers import Numbers


def results(numbers: Numbers, theta: Array) -> dict[str, Array]:
    """Return all results by linksweep's names in all columns, at decimal positions [degree]."""
    own = numbers.times(len(theta) // len(numbers))
    with fifty_digits():
        radius, mass, thrust, speed = (own(path) for path in ("radius", "mass", "thrust", "speed"))
        gravity = Vector(own("gravity[1]"), own("gravity[2]"))
        forward = directions(theta)
        squared = speed**2
        if own.scene.profile == "energy":
            displacement = (forward - Vector(1, 0)) * radius
            travelled = theta - 360 * np.floor(theta.astype(float) / 360.0).astype(int)  # in one lap from the bottom
            work = thrust * radius * travelled * RADIAN - mass * gravity.dot(displacement.left)
            squared = squared + 2 * work / mass
        inward, along = squared / radius, thrust / mass + gravity.dot(forward)
        total = forward * along + forward.left * inward
        return {
            "speed": root(squared),
            "normal_force": mass * (inward - gravity.dot(forward.left)),
            "a_radial": inward,
            "a_tangential": along,
            "a_total": root(total.dot(total)),
            "a_total_angle": angles(total),
        }
