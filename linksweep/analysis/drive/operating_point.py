"""Operating point of a machine on its motor: the speed at which the motor gives what the machine takes on average.

At a constant speed w the machine takes the mean T̄(w) over the cycle of the torque of inverse dynamics; at the operating
point i·M(i·w) = T̄(w) + L, with the torque L that the gear takes. Of several such speeds it is the fastest, which a
motor of falling torque keeps. The motor's own fluctuation over the cycle shifts the mean speed by its square only.
"""

from __future__ import annotations

import numpy as np

from linksweep.analysis.drive.runs import Designs
from linksweep.scene.pairs import Array

ANGLES = 96
"""Angles of a turn over which the torque is averaged."""
PARTS = np.linspace(0.0, 1.0, 5)
"""Speeds, as parts of the fastest, between which the torque is a polynomial, for a search; without friction it is one
of the second degree."""
PLACES, ROUNDS = 512, 8
"""Speeds at which the search looks, and steps of the secant method from there."""


def operating_speed(designs: Designs) -> Array:
    """Return the speed of each design at its operating point [rad/s]; NaN where it has none."""
    crank, top, count = designs.crank(), designs.top_speed, designs.count
    n = ANGLES * round(crank.scene.period / 360.0)
    rows, angles = np.repeat(np.arange(count), n), np.arange(n) * (np.radians(crank.scene.period) / n)
    pairs, still = crank.at(rows, np.tile(angles, count)), np.zeros(len(rows))

    def load(speed: Array) -> Array:
        """Return the mean torque that machines take at constant speeds; NaN where one does not turn fully."""
        torque, status = crank.values((crank.torque, "status"), pairs, np.repeat(speed, n), still)
        return np.mean(np.where(status == 0.0, crank.direction[rows] * torque, np.nan).reshape(count, n), axis=1)

    def supply(speed: Array) -> Array:
        """Return the torque of the motors behind their gears."""
        every = np.arange(count)
        return designs.torque(every, speed) - crank.loss(every, speed, 0.0 * speed)

    def excess(speed: Array) -> Array:
        return supply(speed) - load(speed)

    near = np.stack([load(part * top) for part in PARTS])
    powers = np.linalg.solve(np.vander(PARTS), near)
    places = np.linspace(1.0, 0.0, PLACES)
    surplus = [supply(part * top) - np.vander([part], len(PARTS))[0] @ powers for part in places]
    enough = np.stack(surplus) >= -1e-12 * np.max(abs(np.stack(surplus)), axis=0)
    first = np.argmax(enough, axis=0)
    last, speed = top * places[np.maximum(first - 1, 0)], top * places[first]
    before = excess(last)
    for _ in range(ROUNDS):
        now = excess(speed)
        with np.errstate(invalid="ignore", divide="ignore"):
            step = now * (speed - last) / (now - before)
        last, before, speed = speed, now, np.where(np.isfinite(step), speed - step, speed)
    return np.where(enough.any(axis=0), np.where(first == 0, top, speed), np.nan)
