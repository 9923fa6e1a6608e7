"""Loads over the position of a slider, on one way or on both: random tables on random slider-cranks.

Each is held against the table read at the position of the closed form, x = a·cos θ ± √(b² − (e − a·sin θ)²), with the
way from its derivative; and its exact peaks against samples and both sides of every angle at which the slider passes a
place of the table or reverses, located by bisection.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.attacks import Outcome

TITLE = "loads over a slider's position, by random tables and ways"
ROUNDS, SMALL = 300, 4
STEP, FINE = 0.25, 0.02
"""Degrees between samples in a small run, and in a long one."""
LONG = 60
"""Rounds from which a run is a long one."""

Array = np.ndarray
Random = np.random.Generator


def attack(random: Random, rounds: int) -> Outcome:
    step = FINE if rounds >= LONG else STEP
    failures = [f"round {k}: {failure}" for k in range(rounds) for failure in _wrong(_Case(random), step)]
    return Outcome(rounds, failures)


class _Case:
    """A random machine with a random table over its slider's position."""

    def __init__(self, random: Random) -> None:
        self.a, self.guide = random.uniform(0.02, 0.08), random.uniform(-180.0, 180.0)
        self.e = random.uniform(-0.5, 0.5) * self.a * random.integers(2)
        self.b = (self.a + abs(self.e)) * random.uniform(1.1, 4.0)
        self.sign = random.choice([1.0, -1.0])
        self.over = str(random.choice(["slider.position", "slider.to_end"]))
        self.way = random.choice([None, "closing", "opening"])
        self.kind = str(random.choice(["step", "linear"]))
        self.omega = random.choice([25.0, -25.0])
        ends = np.sort(self.position(np.linspace(0.0, 360.0, 721)))[[0, -1]]
        self.places = np.sort(
            random.uniform(*(ends + 0.1 * np.ptp(ends) * np.array([-1.0, 1.0])), random.integers(2, 7))
        )
        self.values = np.round(random.normal(size=len(self.places)), 1) * 1e4

    def position(self, theta2: Array) -> Array:
        turned = np.radians(theta2 - self.guide)
        along = self.a * np.cos(turned) + self.sign * np.sqrt(self.b**2 - (self.e - self.a * np.sin(turned)) ** 2)
        outer = np.sqrt((self.a + self.b) ** 2 - self.e**2)
        return along if self.over == "slider.position" else outer - self.sign * along

    def force(self, theta2: Array) -> Array:
        place = self.position(theta2)
        held = self.values[np.clip(np.searchsorted(self.places, place, side="right") - 1, 0, None)]
        force = held if self.kind == "step" else np.interp(place, self.places, self.values)
        return force * (self.way is None or self.closing(theta2) == (self.way == "closing"))

    def closing(self, theta2: Array) -> Array:
        """Return whether the slider moves outwards, away from the crank: by its derivative to the angle, in closed
        form."""
        turned = np.radians(theta2 - self.guide)
        across = self.e - self.a * np.sin(turned)
        slope = across * np.cos(turned) / np.sqrt(self.b**2 - across**2) - self.sign * np.sin(turned)
        return slope * self.omega > 0.0

    def scene(self, **words: Any) -> ls.Scene:
        crank, rod = ls.Link(self.a, 1.0, 1e-3), ls.Link(self.b, 0.5, 1e-3)
        branch = "open" if self.sign > 0.0 else "crossed"
        machine = ls.SliderCrank(crank, rod, slider_mass=0.4, offset=self.e, slide_angle=self.guide, branch=branch)
        return ls.Scene(machine, omega2=self.omega, loads=[ls.Load("slider", **words)])

    def __repr__(self) -> str:
        return str(vars(self))


def _wrong(case: _Case, step: float) -> Iterator[str]:
    table = xr.DataArray(case.values, {"position": case.places}, "position")
    scene = case.scene(force=table, over=case.over, while_=case.way, interpolation=case.kind)
    angles = np.arange(0.0, 360.0, step) + 0.0131
    force, expected = ls.sweep(scene, angles, of=["T12"])["loads[1].force[1]"].values, case.force(angles)
    if not np.allclose(force, expected, rtol=0.0, atol=1e-6):
        yield f"forces differ by {abs(force - expected).max():.3g} N: {case}"
        return
    sides = _sides(case, angles)
    reference = ls.peaks(case.scene(force=case.force), ["F32", "T12"], theta2=np.append(angles, sides))
    peaks_ds = ls.peaks(scene, ["F32", "T12"])
    for name in ("F32_peak", "T12_max", "T12_min"):
        short = (1.0 if name != "T12_min" else -1.0) * float(reference[name] - peaks_ds[name])
        most = abs(float(peaks_ds["T12_peak" if name.startswith("T12") else name]))
        if short > 1e-9 * most:
            yield f"{name} is short by {short / most:.3g} of {most:.6g}: {case}"
        elif short < -(1e-4 if step > FINE else 1e-6) * most:
            yield f"{name} is {-short / most:.3g} of {most:.6g} beyond every sample: {case}"


def _sides(case: _Case, angles: Array) -> Array:
    """Return angles just before and just after the slider passes a place of the table, or reverses."""
    passing = [partial(_beyond, case, place) for place in case.places] + [case.closing]
    before = [low for passed in passing for low in _changes(passed, angles)]
    return np.concatenate([np.array(before) - 1e-9, np.array(before) + 1e-9])


def _beyond(case: _Case, place: float, theta2: Array) -> Array:
    return case.position(theta2) > place


def _changes(passed: Callable[[Array], Array], angles: Array) -> Array:
    """Return angles at which a condition changes, by bisection between adjacent angles."""
    there = passed(angles)
    low, high = (angles[np.flatnonzero(there[1:] != there[:-1]) + k] for k in (0, 1))
    first = passed(low)
    for _ in range(48):
        middle = 0.5 * (low + high)
        same = passed(middle) == first
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return low
