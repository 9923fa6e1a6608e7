"""Compare the life of each bearing of random machines, near toggles too, with a sum over very many samples."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import linksweep as ls
from benchmarks.stress.attacks import Outcome

TITLE = "bearing life is that of many samples, and none where peaks are infinite"
ROUNDS = 240
SMALL = 3

Random = np.random.Generator
FEW, MANY = 7, 30_000
EXPONENT = 3.0
OF_JUMPS, ROUNDING = 1e-5, 1e-9
"""Relative error of a load from samples: where forces jump between two of them, and at best."""


def attack(random: Random, rounds: int) -> Outcome:
    failures = []
    for k in range(rounds):
        scene = (_four_bar, _slider_crank, _inverted_slider_crank)[k % 3](random)
        failures += [f"round {k}: {failure}" for failure in wrong_lives(scene)]
    return Outcome(rounds, failures)


def wrong_lives(scene: ls.Scene) -> Iterator[str]:
    """Yield a sentence about each pin whose life differs from that of many samples."""
    pins = scene.mechanism.pins
    forces = {pin: f"F{i}{j}" for pin, (i, j) in pins.items()}
    bearings_ds = ls.bearings(scene, dict.fromkeys(pins, ls.Bearing(capacity=1e4)), theta2=FEW)
    worst, half, whole = ls.peaks(scene, list(forces.values())), *(_loads(scene, forces, n) for n in (MANY, 2 * MANY))
    for pin, force in forces.items():
        status, load, peak = (
            int(bearings_ds.life_status.sel(pin=pin)),
            bearings_ds.equivalent_load.sel(pin=pin),
            worst[f"{force}_peak"],
        )
        if (status == 3) != bool(np.isinf(peak)):
            yield f"{pin}: life_status {status}, peak {float(peak)}, {scene}"
        within = 10.0 * abs(whole[pin] - half[pin]) + (OF_JUMPS if scene.jumps() else ROUNDING) * whole[pin]
        if status < 2 and not abs(float(load) - whole[pin]) <= within:
            yield f"{pin}: {float(load)} N, by samples {whole[pin]} ± {within} N, {scene}"


def _loads(scene: ls.Scene, forces: dict[str, str], count: int) -> dict[str, float]:
    """Return the equivalent load of each pin from `count` samples."""
    angles = (np.arange(count) + 0.5) * (scene.period / count)
    cycle = ls.sweep(scene, angles, of=[*forces.values(), *(f"omega_{pin}" for pin in forces)])
    loads = {}
    for pin, force in forces.items():
        turns = abs(cycle[f"omega_{pin}"]).broadcast_like(cycle["theta2"]).where(cycle["status"] == 0)
        loads[pin] = float(((cycle[force] ** EXPONENT * turns).sum() / turns.sum()) ** (1.0 / EXPONENT))
    return loads


def _four_bar(random: Random) -> ls.Scene:
    """Return a four-bar of any class; every third one is near a change from one class to another."""
    a, b, c = random.uniform(0.05, 0.3, 3)
    closest = np.array([b + c - a, a + abs(b - c), a + b - c, a + c - b])
    grounds = closest[closest > 0.02] + random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(-6.0, -2.0)
    ground = float(random.choice([*grounds, *random.uniform(0.1, 0.4, 4)]))
    ground = min(ground, 0.98 * (a + b + c))
    links = (_link(random, length) for length in (a, b, c))
    torque = ls.Load("rocker", torque=random.normal(0.0, 10.0))
    return ls.Scene(ls.FourBar(*links, ground=ground, branch=_branch(random)), 5.0, gravity=(0.0, -9.81), loads=torque)


def _slider_crank(random: Random) -> ls.Scene:
    crank = random.uniform(0.03, 0.1)
    mechanism = ls.SliderCrank(
        _link(random, crank),
        _link(random, crank * random.uniform(0.8, 4.0)),
        slider_mass=random.uniform(0.0, 2.0),
        offset=random.uniform(-0.5, 0.5) * crank,
        friction=float(random.choice([0.0, random.uniform(0.0, 0.5)])),
        branch=_branch(random),
    )
    return ls.Scene(mechanism, 20.0, loads=[ls.Load("slider", force=random.normal(0.0, 100.0))])


def _inverted_slider_crank(random: Random) -> ls.Scene:
    crank = random.uniform(0.03, 0.1)
    mechanism = ls.InvertedSliderCrank(
        _link(random, crank),
        _link(random, 0.3),
        ground=crank * random.uniform(0.3, 3.0),
        offset=random.uniform(-0.3, 0.3) * crank,
        block_mass=random.uniform(0.0, 1.0),
        branch=_branch(random),
    )
    return ls.Scene(mechanism, 10.0, loads=[ls.Load("rocker", torque=random.normal(0.0, 10.0))])


def _link(random: Random, length: float) -> ls.Link:
    mass = float(random.choice([0.0, random.uniform(0.1, 2.0)]))
    return ls.Link(length, mass, mass * length**2 / 12.0, random.uniform(0.0, length), random.uniform(-180.0, 180.0))


def _branch(random: Random) -> str:
    return str(random.choice(["open", "crossed"]))
