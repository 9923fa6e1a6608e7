"""Check transformations that must not change a bit: mirror, time reversal, units by powers of two, chunks, threads."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from unittest import mock

import numpy as np
import xarray as xr

from benchmarks.stress.backward import values
from benchmarks.stress.decimals import Array
from benchmarks.stress.designs import FORCES, Designs
from benchmarks.stress.errors import answers
from benchmarks.stress.families import scaled
from linksweep.engine import run

TURNED = ("_angle", "_y", "_torque", "omega2", "alpha2", "offset")
"""Ends of the names of numbers that change sign in a mirror along x."""
UNITS = (2.0**-7, 2.0**11, 2.0**5)
"""Units of length, mass and rate."""
ALONE = 3
"""Number of designs that are also swept alone."""


def changed(designs: Designs) -> dict[str, int]:
    """Count designs whose bits change, by the transformation applied."""
    plain = _results(designs, answers(designs))
    return {what: int(np.any(plain != other, axis=0)[where].sum()) for what, other, where in _others(designs, plain)}


def _others(designs: Designs, plain: Array) -> Iterator[tuple[str, Array, slice]]:
    n, every = len(designs), slice(None)
    y = np.array([-1.0 if name[-1] == "y" or name == "drive" else 1.0 for name in (*FORCES, "drive", "status")])
    swapped = -1 if designs.machine == "four-bar" else 1
    mirrors = [_results(designs, answers(mirrored(designs, branch))) for branch in (swapped, 1)]
    yield "mirror", np.where(_goes_through(designs), mirrors[1], mirrors[0]) * y[:, None], every
    if not np.any(designs.numbers.get("friction", 0.0)):
        back = designs.changed(omega2=-np.asarray(designs.numbers["omega2"]))
        yield "time reversed", _results(designs, answers(back)), every
    length, mass, rate = UNITS
    if np.all(np.abs(plain)[:-1][plain[:-1] != 0.0] > 1e-290):
        force = mass * length * rate**2
        units = np.array([force] * len(FORCES) + [force * length, 1.0])
        ones = np.ones(n)
        other = answers(scaled(designs, length * ones, mass * ones, rate * ones))
        yield "units by powers of two", _results(designs, other) / units[:, None], every
    cut = slice(n // 3, n)
    part = _results(designs.part(cut), answers(designs.part(cut)))
    yield "a part of the batch", np.concatenate([plain[:, : n // 3], part], axis=1), every
    with mock.patch.object(run, "SAMPLES_PER_THREAD", 10):
        yield "two threads", _results(designs, answers(designs, threads=2)), every
    alone = np.stack([_results(designs.one(k), answers(designs.one(k)))[:, 0] for k in range(ALONE)], axis=1)
    yield "alone", np.concatenate([alone, plain[:, ALONE:]], axis=1), every


def mirrored(designs: Designs, branch: int) -> Designs:
    """Return the machines mirrored at the x axis: a four-bar's C is then on the other side of B→D."""
    numbers = {name: -np.asarray(x) if name.endswith(TURNED) else x for name, x in designs.numbers.items()}
    return replace(designs, numbers=numbers, theta2=-designs.theta2, branch=branch * designs.branch)


def _goes_through(designs: Designs) -> Array:
    """Return which designs are parallelograms or kites: they change sides at their folds, and keep their branch in a
    mirror."""
    if designs.machine != "four-bar":
        return np.zeros(len(designs), dtype=bool)
    a, b, c, d = (designs.numbers[name] for name in ("crank_length", "coupler_length", "rocker_length", "ground"))
    return ((a == c) & (b == d)) | ((a == b) & (c == d))


def _results(designs: Designs, cycle: xr.Dataset) -> Array:
    """Return forces, drive and status, one row each, with 0 for NaN."""
    rows = np.stack([values(cycle, name, len(designs)).astype(float) for name in (*FORCES, "drive", "status")])
    return np.nan_to_num(rows, nan=0.0)
