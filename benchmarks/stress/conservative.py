"""Check machines without dissipation: at constant speed, under weight alone, the drive's mean torque over a turn is
zero."""

from __future__ import annotations

import numpy as np

import linksweep as ls
from benchmarks.stress.decimals import Array
from benchmarks.stress.designs import Designs
from benchmarks.stress.errors import EPS
from benchmarks.stress.families import Random, decades, four_bar_of, slider_crank_of

ANGLES = 1440
"""Samples per turn; their mean is that over the turn, within rounding, for machines far from toggles."""
BATCH = 50


def means(machines: int, seed: int) -> Array:
    """Return |mean torque| of random machines in ε of the largest torque of each."""
    parts = []
    for k in range(0, machines, BATCH):
        random = np.random.default_rng([seed, k])
        for designs in (_crank_rocker(random, BATCH // 2), _engine(random, BATCH // 2)):
            torque = ls.sweep(designs.scene(), ANGLES, of=["T12"]).T12.transpose("design", "theta2").values
            parts.append(np.abs(torque.mean(axis=1)) / np.abs(torque).max(axis=1) / EPS)
    return np.concatenate(parts)


def _conservative(designs: Designs) -> Designs:
    loads = [name for name in designs.numbers if "_force_" in name or name in ("rocker_torque", "slider_push")]
    return designs.changed(alpha2=np.zeros(len(designs)), **{name: np.zeros(len(designs)) for name in loads})


def _crank_rocker(random: Random, n: int) -> Designs:
    """Return crank-rockers whose crank turns with a margin of at least a tenth of the lengths."""
    a, d = np.ones(n), 1.0 + decades(random, n, -0.3, 0.5)
    difference, total = (d - a) * random.uniform(-0.7, 0.7, n), (d + a) * random.uniform(1.2, 2.0, n)
    lengths = a, 0.5 * (total + difference), 0.5 * (total - difference), d
    return _conservative(four_bar_of(random, lengths, 0.0, 0.0))


def _engine(random: Random, n: int) -> Designs:
    a = np.ones(n)
    offset = random.uniform(-0.5, 0.5, n)
    rod = (a + np.abs(offset)) * random.uniform(1.3, 4.0, n)
    psi = random.uniform(0.0, 2.0 * np.pi, n)
    return _conservative(slider_crank_of(random, a, rod, offset, psi, 0.0, friction=False))
