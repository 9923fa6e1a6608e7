"""Energy and inertia of a cycle at constant speed, and the two tangents of Wittenbauer's diagram, exact.

See `linksweep.analysis.drive.flywheel`. With half the coefficient of fluctuation, s = δ/2, the mean speed ω2, and the
work S = ∫ (T_d − T) dθ by which the constant torque T_d is ahead of the torque T that keeps the speed constant,

    upper = S − J ω2² s (1 + s/2),     lower = S + J ω2² s (1 − s/2),     J_f δ ω2² = max(upper) − min(lower)

and the speed is ω² = ω2² (1 + s)² − 2 (max(upper) − upper)/(J_f + J).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from linksweep.analysis.drive.piecewise import Piecewise, Place, added, largest, piecewise, sum_of
from linksweep.scene.pairs import Array

NAMES = ("reduced_torque", "reduced_inertia", "omega2")
STEPS = 60
"""Newton steps, at most, to the fluctuation that a flywheel leaves."""
SETTLED = 1e-12
"""Relative size of a step that is the last one."""


class Tangents(NamedTuple):
    """The largest value of `upper` and the least one of `lower`, for each design, with their places."""

    high: Array
    at_high: Place
    low: Array
    at_low: Place


class Turning(NamedTuple):
    """Designs at constant speed: their cycle, signed speed [rad/s], the drive's constant torque [N m], and the series
    (design, piece, term) of S [J] and J [kg m²] over the cycle."""

    cycle: Piecewise
    omega2: Array
    drive: Array
    work: Array
    inertia: Array

    @classmethod
    def of(cls, group: Any) -> Turning:
        """Return the designs of a group, whose cranks turn fully."""
        cycle = piecewise(group, NAMES[:2])
        work, drive = ahead(cycle, 0)
        rows = np.arange(len(group.designs))
        (omega2,) = group.values(NAMES[2:], rows, np.zeros(len(rows)))
        return cls(cycle, omega2, drive, work, cycle.terms[1])

    @property
    def energy_fluctuation(self) -> Array:
        """Greatest less least S [J]."""
        return largest(self.cycle, self.work)[0] + largest(self.cycle, -self.work)[0]

    def upper(self, s: Array) -> Array:
        """Return the series of `upper`."""
        return added(self.work, (-(self.omega2**2) * s * (1.0 + 0.5 * s))[:, None, None] * self.inertia)

    def tangents(self, s: Array) -> Tangents:
        """Return the tangents for a fluctuation δ = 2 s of each design."""
        lower = added(self.work, (self.omega2**2 * s * (1.0 - 0.5 * s))[:, None, None] * self.inertia)
        high, at_high = largest(self.cycle, self.upper(s))
        low, at_low = largest(self.cycle, -lower)
        return Tangents(high, at_high, -low, at_low)

    def size(self, s: Array) -> Array:
        """Return the inertia of the flywheel that leaves δ = 2 s; negative where none is needed."""
        tangents = self.tangents(s)
        return (tangents.high - tangents.low) / (2.0 * s * self.omega2**2)

    def half_fluctuation(self, size: Array) -> Array:
        """Return s = δ/2 with a flywheel of this inertia, by Newton's method; NaN where the crank stalls on the way."""
        s, low, high = np.zeros(len(size)), np.zeros(len(size)), np.ones(len(size))
        for _ in range(STEPS):
            excess, slope = self._excess(s, size)
            low, high = np.where(excess > 0.0, s, low), np.where(excess > 0.0, high, s)
            with np.errstate(divide="ignore", invalid="ignore"):
                following = np.where(slope < 0.0, s - excess / slope, s)
            following = np.where((following >= low) & (following <= high), following, 0.5 * (low + high))
            settled = ~(np.abs(following - s) > SETTLED * following + 1e-3 * SETTLED)
            s = following
            if settled.all():
                break
        return np.where(self._excess(np.ones(len(size)), size)[0] > 0.0, np.nan, s)

    def _excess(self, s: Array, size: Array) -> tuple[Array, Array]:
        """Return by how much the energy varies more than the flywheel allows [J], and the derivative to s."""
        tangents, square = self.tangents(s), self.omega2**2
        high, low = (self.inertia_at(place) for place in (tangents.at_high, tangents.at_low))
        excess = tangents.high - tangents.low - 2.0 * size * square * s
        return excess, -square * ((1.0 + s) * high + (1.0 - s) * low + 2.0 * size)

    def inertia_at(self, place: Place) -> Array:
        """Return J at a place of each design."""
        return sum_of(self.inertia[np.arange(len(self.inertia)), place.piece], place.x)

    def speed(self, size: Array, s: Array, angles: Array) -> Array:
        """Return the speed (design, angle) [rad/s] with flywheels that leave δ = 2 s, never negative."""
        high = self.tangents(s).high
        lost = np.maximum(high[:, None] - self.cycle.at(self.upper(s), angles), 0.0)
        total = size[:, None] + self.cycle.at(self.inertia, angles)
        fastest, slowest = ((np.abs(self.omega2) * (1.0 + sign * s))[:, None] for sign in (1.0, -1.0))
        with np.errstate(divide="ignore", invalid="ignore"):
            square = fastest**2 - np.where(lost > 0.0, 2.0 * lost / total, 0.0)
        return np.sqrt(np.clip(square, slowest**2, fastest**2))


def ahead(cycle: Piecewise, k: int) -> tuple[Array, Array]:
    """Return the series of ∫ (mean − q) dθ from the start of the cycle on, of its k-th quantity q, and the mean."""
    series, whole = cycle.primitive(k)
    mean = whole / np.radians(cycle.period)
    return added(-series, cycle.straight(mean)), mean
