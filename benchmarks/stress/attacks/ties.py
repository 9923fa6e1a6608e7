"""Check symmetric machines, whose maxima tie: each force at its `_peak_at` must be the peak."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

import linksweep as ls
from benchmarks.stress.attacks import Outcome

TITLE = "symmetric machines: the force at every `_peak_at` is the peak"
ROUNDS = 2000
SMALL = 24

Random = np.random.Generator
BESIDE = (-1e-9, 0.0, 1e-9)
"""Distance of a sample on either side of a jump, where a peak is one-sided [degree]."""


def attack(random: Random, rounds: int) -> Outcome:
    failures = []
    for k in range(rounds):
        scene = (_slider_crank, _four_bar, _inverted_slider_crank)[k % 3](random)
        failures += [f"round {k}: {failure}" for failure in misplaced(scene)]
    return Outcome(rounds, failures)


def misplaced(scene: ls.Scene) -> Iterator[str]:
    """Yield a sentence about each finite peak of a scene that is not at its stated angle."""
    peaks_ds = ls.peaks(scene)
    for place in map(str, peaks_ds.data_vars):
        if place.endswith("_at") and math.isfinite(peak := float(peaks_ds[place.removesuffix("_at")])):
            name, at = place.rsplit("_", 2)[0], float(peaks_ds[place])
            there = ls.sweep(scene, [at + away for away in BESIDE], of=[name])[name].values
            error = np.fmin.reduce(np.abs(there - peak))
            if not (0.0 <= at < scene.period and error <= 1e-7 * abs(peak) + 1e-12):
                yield f"{place} = {at!r}: {name} is {there} there, and the peak {peak}"


def _slider_crank(random: Random) -> ls.Scene:
    """Return a slider-crank without offset, the load along the guide; friction in every other one."""
    crank, angle = random.uniform(0.02, 0.1), _frame(random)
    mechanism = ls.SliderCrank(
        _bar(random, crank),
        _bar(random, crank * random.uniform(1.2, 5.0)),
        slider_mass=random.uniform(0.0, 2.0),
        friction=float(random.choice([0.0, random.uniform(0.0, 0.3)])),
        branch=_branch(random),
        slide_angle=angle,
    )
    push = random.normal(0.0, 100.0) * np.exp(1j * np.radians(angle))
    return ls.Scene(mechanism, _speed(random), loads=[ls.Load("slider", force=(push.real, push.imag))])


def _four_bar(random: Random) -> ls.Scene:
    """Return a four-bar with equal coupler and rocker; a torque on the crank in every other one."""
    crank, others = random.uniform(0.02, 0.1), random.uniform(0.15, 0.3)
    coupler = _bar(random, others)
    ground = crank * random.uniform(1.1, 1.6)
    mechanism = ls.FourBar(_bar(random, crank), coupler, coupler, ground, _branch(random), _frame(random))
    torque = float(random.choice([0.0, random.normal()]))
    return ls.Scene(mechanism, _speed(random), loads=[ls.Load("crank", torque=torque)])


def _inverted_slider_crank(random: Random) -> ls.Scene:
    """Return an inverted slider-crank without offset."""
    crank = random.uniform(0.02, 0.1)
    mechanism = ls.InvertedSliderCrank(
        _bar(random, crank),
        _bar(random, 0.3),
        ground=crank * float(random.choice([random.uniform(0.2, 0.9), random.uniform(1.1, 4.0)])),
        block_mass=random.uniform(0.0, 2.0),
        branch=_branch(random),
        ground_angle=_frame(random),
    )
    return ls.Scene(mechanism, _speed(random))


def _bar(random: Random, length: float) -> ls.Link:
    """Return a link with its centre of gravity on the line of its pins."""
    mass = float(random.choice([0.0, random.uniform(0.1, 2.0)]))
    centre = float(random.choice([0.0, random.uniform(0.0, length)]))
    return ls.Link(length, mass, mass * length**2 / 12.0, centre)


def _branch(random: Random) -> str:
    return str(random.choice(["open", "crossed"]))


def _frame(random: Random) -> float:
    return float(random.choice([0.0, 90.0, 30.0, random.uniform(-180.0, 180.0)]))


def _speed(random: Random) -> float:
    return random.uniform(1.0, 50.0) * float(random.choice([-1.0, 1.0]))
