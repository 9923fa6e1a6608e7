"""Compute unknowns, rates and peaks of four-bars in 50 digits, by the textbook formulas of `stress.machines`."""

from __future__ import annotations

import numpy as np

from benchmarks.accuracy import missed
from benchmarks.rivals import peers
from benchmarks.rivals.peers import Array, Design
from benchmarks.stress.decimals import fifty_digits
from benchmarks.stress.designs import Designs

NINE = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "drive")
RATES = ("omega3", "omega4", "alpha3", "alpha4")
FORCES = ("F12", "F32", "F43", "F14")

STEP = 1e-6
"""Step of the parabola through a peak in 50 digits [degree]."""
CANDIDATES, ROUNDS, CHUNK = 3, 45, 20


def unknowns(q: Design, theta2: Array) -> Array:
    """Return the nine unknowns (9, n) at theta2 [degree], rounded once."""
    return _rounded(_exact(q, theta2), NINE)


def rates(q: Design, theta2: Array) -> Array:
    """Return omega3, omega4, alpha3 and alpha4 (4, n) at theta2 [degree], rounded once."""
    return _rounded(_exact(q, theta2), RATES)


def peaks(q: Design) -> Array:
    """Return the largest F12, F32, F43, F14 and |T12| over the revolution of many crank-rockers (5, designs).

    numpy searches thousands of samples, then between them; the top is that of a parabola in 50 digits.
    """
    parts = [_brackets(q[i : i + CHUNK]) for i in range(0, len(q.a), CHUNK)]
    tops = _tops(q, *np.concatenate(parts, axis=2))
    return np.stack([_parabola(q, signal, theta2) for signal, theta2 in enumerate(tops)])


def _exact(q: Design, theta2: Array) -> dict[str, Array]:
    """Return all results as arrays of decimals, one per crank angle; each number of a design is single or one per
    angle."""
    numbers = {
        "crank_length": q.a, "coupler_length": q.b, "rocker_length": q.c, "ground": q.d, "ground_angle": 0.0,
        "crank_mass": q.m2, "coupler_mass": q.m3, "rocker_mass": q.m4,
        "crank_inertia": q.I2, "coupler_inertia": q.I3, "rocker_inertia": q.I4,
        "crank_cg_distance": q.s, "coupler_cg_distance": q.p, "rocker_cg_distance": q.u,
        "crank_cg_angle": q.delta2, "coupler_cg_angle": q.delta3, "rocker_cg_angle": q.delta4,
        "omega2": q.omega2, "alpha2": q.alpha2, "gravity_x": q.gx, "gravity_y": q.gy,
    }  # fmt: skip
    full = {name: np.broadcast_to(np.ravel(values), len(theta2)) for name, values in numbers.items()}
    return Designs("four-bar", full, theta2, int(q.sign)).exact()[0]


def _rounded(results: dict[str, Array], names: tuple[str, ...]) -> Array:
    return np.stack([results[name].astype(float) for name in names])


def _parabola(q: Design, signal: int, theta2: Array) -> Array:
    """Return the top of each design near theta2 [degree], from its squares at three angles."""
    before, here, after = (_square(q, signal, theta2 + step) for step in (-STEP, 0.0, STEP))
    with fifty_digits():
        top = here - (after - before) ** 2 / (8 * (before - 2 * here + after))
        return np.sqrt(top).astype(float)


def _square(q: Design, signal: int, theta2: Array) -> Array:
    results = _exact(q, theta2)
    with fifty_digits():
        if signal == len(FORCES):
            return results["drive"] ** 2
        return results[f"{FORCES[signal]}x"] ** 2 + results[f"{FORCES[signal]}y"] ** 2


# ------------------------------------------------------------------------- where the peaks are, by numpy


def _brackets(q: Design) -> Array:
    """Return the neighbours [degree] of each design's highest local maxima of samples (2, 5, designs, candidates)."""
    theta2 = missed.angles(0.0)
    around = np.concatenate([theta2[-1:] - 360.0, theta2, theta2[:1] + 360.0])
    highest = np.stack([_highest(samples) for samples in _squares(peers.numpy_closed_form(q, theta2))])
    return np.stack([around[highest], around[highest + 2]])


def _highest(samples: Array) -> Array:
    rises = (samples >= np.roll(samples, 1, axis=1)) & (samples >= np.roll(samples, -1, axis=1))
    left, places = np.where(rises, samples, -1.0), []
    for _ in range(CANDIDATES):
        places.append(left.argmax(axis=1))
        left[np.arange(len(left)), places[-1]] = -1.0
    return np.stack(places, axis=1)


def _tops(q: Design, low: Array, high: Array) -> Array:
    """Return where each signal is largest between low and high, by ternary search; precise to half the digits."""

    def square(theta2: Array) -> Array:
        return np.stack([_squares(peers.numpy_closed_form(q, theta2[k]))[k] for k in range(len(theta2))])

    for _ in range(ROUNDS):
        third = (high - low) / 3.0
        rises = square(low + third) < square(high - third)
        low, high = np.where(rises, low + third, low), np.where(rises, high, high - third)
    places = (low + high) / 2.0
    return np.take_along_axis(places, square(places).argmax(axis=-1)[..., None], axis=-1)[..., 0]


def _squares(nine: Array) -> Array:
    return np.stack([*nine[0:8:2] ** 2 + nine[1:8:2] ** 2, nine[8] ** 2])
