"""Search peaks of machines of all drives and frames at dead centres: unbounded forces are inf, and no others."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

import linksweep as ls
from benchmarks.stress.attacks import Outcome

TITLE = "dead centres of every drive: forces without bound are inf, with status 3, and all others finite"
ROUNDS = 1500
SMALL = 10

Random = np.random.Generator
UNBOUNDED = 3
SAMPLES = np.arange(0.0437, 360.0, 0.1)
"""Sampled angles [degree], away from round ones, at which a rate may itself be 0."""
ROUNDING = 0.2
"""Relative error of a force that is 0/0 at a dead centre: ε over the distance, down to where the status is not ok."""
DRIVEN = {
    ("FourBar", "coupler"): "omega3",
    ("FourBar", "rocker"): "omega4",
    ("SliderCrank", "coupler"): "omega3",
    ("InvertedSliderCrank", "rocker"): "omega4",
    ("InvertedSliderCrank", "cylinder"): "slide_velocity",
}
"""Rate of the driven link, by drive: a machine has a dead centre where it changes sign."""
KINDS = tuple(DRIVEN)


def attack(random: Random, rounds: int) -> Outcome:
    failures = []
    for k in range(rounds):
        kind, drive = KINDS[k % len(KINDS)]
        scene = _scene(random, kind, drive)
        failures += [f"round {k}, {kind} by {drive}: {failure}" for failure in _unbounded(scene)]
        failures += [f"round {k}: {failure}" for failure in _with_a_limit(random)]
    return Outcome(rounds, failures)


# ------------------------------------------------------------------------------------------------ any machine


def _scene(random: Random, kind: str, drive: str) -> ls.Scene:
    """Return a machine that turns or swings, in any frame, loaded so that no force vanishes at a dead centre."""
    while True:
        try:
            mechanism = MECHANISMS[kind](random)
        except ValueError:  # it closes nowhere
            continue
        break
    steady, push = random.normal(0.0, 5.0), random.normal(0.0, 30.0, 2)
    torque = (lambda t: steady + np.cos(np.radians(t))) if random.random() < 0.2 else steady
    loads = [ls.Load("crank", torque=torque), ls.Load(mechanism.roles[1], force=tuple(push))]
    gravity = tuple(random.normal(0.0, 10.0, 2))
    return ls.Scene(mechanism, random.uniform(1.0, 30.0), random.normal(0.0, 100.0), gravity, loads, drive=drive)


def _frame(random: Random) -> float:
    return float(random.choice([0.0, 90.0, 17.3, 30.0, -45.0, random.uniform(-180.0, 180.0)]))


def _branch(random: Random) -> str:
    return str(random.choice(["open", "crossed"]))


def _link(random: Random, length: float) -> ls.Link:
    mass = random.uniform(0.1, 2.0)
    centre = random.uniform(0.1, 0.9) * length
    return ls.Link(length, mass, random.uniform(0.05, 0.5) * mass * length**2, centre, random.uniform(-180.0, 180.0))


def _four_bar(random: Random) -> ls.FourBar:
    crank, coupler, rocker, ground = random.uniform(0.05, 0.5, 4)
    links = (_link(random, length) for length in (crank, coupler, rocker))
    return ls.FourBar(*links, ground, _branch(random), _frame(random))


def _slider_crank(random: Random) -> ls.SliderCrank:
    crank = random.uniform(0.05, 0.2)
    rod, offset = crank * random.uniform(0.6, 4.0), crank * random.uniform(-0.5, 0.5)
    links = _link(random, crank), _link(random, rod)
    return ls.SliderCrank(*links, random.uniform(0.1, 2.0), offset, branch=_branch(random), slide_angle=_frame(random))


def _inverted_slider_crank(random: Random) -> ls.InvertedSliderCrank:
    crank, ground = random.uniform(0.05, 0.5, 2)
    offset = random.uniform(-0.5, 0.5) * max(crank, ground)
    links = _link(random, crank), _link(random, random.uniform(0.1, 0.5))
    block = random.uniform(0.1, 2.0), random.uniform(1e-4, 1e-3)
    return ls.InvertedSliderCrank(*links, ground, *block, offset, _branch(random), _frame(random))


MECHANISMS: dict[str, Callable] = {
    "FourBar": _four_bar,
    "SliderCrank": _slider_crank,
    "InvertedSliderCrank": _inverted_slider_crank,
}


def _unbounded(scene: ls.Scene) -> Iterator[str]:
    """Yield a sentence about each pin force that is finite although the drive passes a dead centre, or infinite
    although the crank turns fully and the drive keeps moving."""
    rate = DRIVEN[type(scene.mechanism).__name__, scene.drive]
    speed = ls.sweep(ls.Scene(scene.mechanism, 1.0), SAMPLES, of=[rate])[rate].values
    passes = bool((speed * np.roll(speed, 1) < 0.0).any())
    peaks_ds = ls.peaks(scene)
    peaks = {
        name: float(values) for name, values in peaks_ds.items() if name.startswith("F") and name.endswith("_peak")
    }
    if passes:
        yield from (f"{name} = {peak} past a dead centre" for name, peak in peaks.items() if peak < math.inf)
        if int(peaks_ds.status) != UNBOUNDED:
            yield f"status {int(peaks_ds.status)} past a dead centre"
    elif np.isfinite(speed).all():
        yield from (f"{name} is infinite without a dead centre" for name, peak in peaks.items() if peak == math.inf)


# ------------------------------------------------------------------------------------------------ with a limit


def _with_a_limit(random: Random) -> Iterator[str]:
    """Yield a sentence about each wrong force where forces have a finite limit at dead centres: for a crank that hangs
    straight down, or is fixed, at both of them, with massless other links.

    Its moment m·g·r·sin ψ vanishes with the arm a·sin ψ of the force on its pin.
    """
    crank, other = random.uniform(0.05, 0.2), random.uniform(0.25, 0.6)
    mass, centre, angle = random.uniform(0.1, 5.0), random.uniform(0.02, 0.2), random.uniform(-180.0, 180.0)
    links = ls.Link(crank, mass, 0.01, centre), ls.Link(other, 0.0, 0.0)
    slider = ls.SliderCrank(*links, slider_mass=0.0, slide_angle=angle - 90.0)
    cylinder = ls.InvertedSliderCrank(*links, ground=other, block_mass=0.0, ground_angle=angle)
    pull = 9.81 * np.exp(1j * np.radians(angle))
    force = mass * 9.81 * centre / crank
    for mechanism, drive, true in ((slider, "coupler", force), (cylinder, "cylinder", force * (crank + other) / other)):
        scene = ls.Scene(mechanism, 10.0, gravity=(pull.real, pull.imag), drive=drive)
        peak = float(ls.peaks(scene, of=["F43"]).F43_peak)
        if not abs(peak / true - 1.0) < ROUNDING:
            yield f"{drive}, frame at {angle}: F43_peak = {peak}, and should be {true}"
