"""Limits of the loop track: leaving the track and stalling in closed form, for arrays of designs.

With q = F/m, force F_N and squared speed v² have the form, over the angle φ from the bottom [rad],

    f(φ) = A + B φ + C (gx sin φ − gy cos φ),    f'(φ) = B + C·|g|·cos(φ − δ),    δ the direction of gravity

    R·F_N/m by energy: A = v0² + 2R gy, B = 2R q, C = 3R      at constant speed: A = v0², B = 0, C = R
    v²      by energy: A = v0² + 2R gy, B = 2R q, C = 2R      at constant speed: A = v0², B = 0, C = 0

so extremes are known in closed form, and the least entry speed with them: the car goes round while no minimum is
negative. Between extremes f is monotone: bisection finds a zero there, to rounding.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linksweep.mechanisms.limits.finding import Array, Finding, Results

TURN = 2.0 * np.pi
ROUNDING = 16.0 * 2.0**-52  # of the terms of f
HALVINGS = 60
LAP = ("whole", "leaves_track", "stalls")


class Curve(NamedTuple):
    """Function f of the module's equation, for every design."""

    A: Array
    B: Array
    C: Array
    gx: Array
    gy: Array

    def __call__(self, angle: Array) -> Array:
        return self.A + self.B * angle + self.C * (self.gx * np.sin(angle) - self.gy * np.cos(angle))

    def knots(self) -> Array:
        """Return bottom, extremes and end of the lap in order, on a leading axis."""
        extremes = np.sort(np.nan_to_num(_extremes(self)), axis=0)
        return np.concatenate([0.0 * extremes[:1], extremes, TURN + 0.0 * extremes[:1]])

    def noise(self) -> Array:
        """Return a bound on the rounding error of f."""
        pull = np.hypot(self.gx, self.gy)
        return ROUNDING * (np.abs(self.A) + TURN * np.abs(self.B) + np.abs(self.C) * pull)


def curves(radius, mass, speed, thrust, gx, gy, work_counts) -> tuple[Curve, Curve]:
    """Return the curves of R·F_N/m and v²."""
    A, B = speed * speed + work_counts * 2.0 * radius * gy, work_counts * 2.0 * radius * (thrust / mass)
    return (Curve(A, B, radius * (1.0 + 2.0 * work_counts), gx, gy), Curve(A, B, radius * (2.0 * work_counts), gx, gy))


def _extremes(curve: Curve) -> Array:
    """Return both angles in a lap at which f is extreme [rad], on a leading axis; NaN where it is monotone."""
    pull, direction = np.hypot(curve.gx, curve.gy), np.arctan2(curve.gy, curve.gx)
    with np.errstate(invalid="ignore", divide="ignore"):
        side = np.arccos(-curve.B / (curve.C * pull))
    return np.mod(np.stack([direction - side, direction + side]), TURN)


def first_zero(curve: Curve) -> Array:
    """Return the angle in the lap at which f first falls below zero [rad]; infinite where it does not."""
    knots = curve.knots()
    below = curve(knots) < -curve.noise()
    first = np.argmax(below, axis=0)
    end = np.take_along_axis(knots, first[None], axis=0)[0]
    start = np.take_along_axis(knots, np.maximum(first - 1, 0)[None], axis=0)[0]
    for _ in range(HALVINGS):
        middle = 0.5 * (start + end)
        negative = curve(middle) < 0.0
        start, end = np.where(negative, start, middle), np.where(negative, middle, end)
    return np.where(below.any(axis=0), np.where(first == 0, 0.0, end), np.inf)


@np.errstate(all="ignore")
def events(radius, mass, speed, thrust, gx, gy, work_counts) -> dict[str, Array]:
    """Compute where a car that follows work and energy first leaves the track, and where it first stalls [rad]."""
    force, squared_speed = curves(radius, mass, speed, thrust, gx, gy, work_counts)
    leaves, stalls = first_zero(force), first_zero(squared_speed)
    return {"leaves_at": leaves, "stalls_at": stalls}


def lap(radius, mass, speed, thrust, gx, gy, work_counts) -> Results:
    """Compute the outcome of one lap from the bottom, and the entry speed that the car needs to go round."""
    leaves, stalls = events(radius, mass, speed, thrust, gx, gy, work_counts).values()
    leaves, stalls = np.where(leaves < stalls, leaves, np.inf), np.where(stalls <= leaves, stalls, np.inf)
    outcome = np.select([np.isfinite(leaves), np.isfinite(stalls)], [1, 2], 0).astype(np.int8)
    from_rest = curves(radius, mass, 0.0 * speed, thrust, gx, gy, work_counts)
    needed = np.max([np.max(-curve(curve.knots()), axis=0) for curve in from_rest], axis=0)
    least = np.sqrt(np.maximum(needed, 0.0))
    return {
        "lap": Finding(outcome, "what becomes of the car in one lap from the bottom", words=LAP),
        "leaves_track_at": Finding(_degrees(leaves), "position at which the car first leaves the track"),
        "stalls_at": Finding(_degrees(stalls), "position at which the car stalls"),
        "least_entry_speed": Finding(least, "least speed at the bottom with which it goes round", "m s-1"),
    }


def _degrees(angle: Array) -> Array:
    return np.degrees(np.where(np.isfinite(angle), angle, np.nan))
