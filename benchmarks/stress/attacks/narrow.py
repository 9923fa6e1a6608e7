"""Apply loads that reverse within a fraction of a degree: ends that pass closely, and narrow pulses.

Peaks are compared with brute force: samples every 1e-4 degree, and others that close in on the narrow place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.attacks import Outcome

TITLE = "springs and dampers whose ends pass close by, and narrow functions"
ROUNDS, SMALL = 400, 8
DESIGNS = 4
"""Designs of one scene: they share its form."""
LEAST = 60
"""Rounds from which brute force has its finest step."""
ALLOWED = 1e-9

Array = np.ndarray
Random = np.random.Generator
Made = tuple[ls.Scene, float]
"""A scene, and the angle where its loads are narrow [degree]."""


def attack(random: Random, rounds: int) -> Outcome:
    step = 1e-4 if rounds >= LEAST else 0.02
    failures, tried = [], 0
    while tried < rounds:
        for make in (_passing, _pulsing):
            scene, place = make(random)
            failures += [f"round {tried}: {failure}" for failure in _missed(scene, place, step)]
            tried += DESIGNS
    return Outcome(tried, failures)


def _missed(scene: ls.Scene, place: float, step: float) -> Iterator[str]:
    """Yield peaks that fall short of a sample, or whose bound does."""
    names = [name for name in scene.mechanism.peak_quantities(scene.drive) if "_" not in name]
    peaks_ds = ls.peaks(scene, of=[*names, *(f"{name}_bound" for name in names)])
    brute = ls.peaks(scene, of=names, theta2=_angles(scene.period, place, step))
    for name in names:
        peak, most = peaks_ds[f"{name}_peak"].values, brute[f"{name}_peak"].values
        short = np.broadcast_to((most - peak) / most, (DESIGNS,))
        beyond = np.broadcast_to(most - peak - peaks_ds[f"{name}_bound"].values, (DESIGNS,))
        for k in np.flatnonzero((short > ALLOWED) | (beyond > 1e-12 * most)):
            yield f"{name} of design {k} is short by {short[k]:.2g} near {place:.6f}: {scene.at_one_angle.loads}"


def _angles(period: float, place: float, step: float) -> Array:
    aside = np.geomspace(1e-9, 8.0, 4000)
    return np.unique(np.mod(np.concatenate([np.arange(0.0, period, step), place - aside, place + aside]), period))


# -------------------------------------------------------------------------------------------- machines that turn


def _machine(random: Random) -> Any:
    return random.choice([_four_bar, _slider_crank, _inverted])(random)


def _four_bar(random: Random) -> ls.FourBar:
    a, d = random.uniform(0.05, 0.15), random.uniform(0.3, 0.6)
    b, c = d + random.uniform(-0.1, 0.1, 2) + a * random.uniform(0.6, 1.2, 2)
    while a + max(b, c, d) >= a + b + c + d - a - max(b, c, d):
        b, c = 1.1 * b, 1.1 * c
    return ls.FourBar(*(_link(random, x) for x in (a, b, c)), ground=d, branch=_branch(random))


def _slider_crank(random: Random) -> ls.SliderCrank:
    a = random.uniform(0.05, 0.15)
    e = random.uniform(-0.5, 0.5) * a
    rod = _link(random, (a + abs(e)) * random.uniform(1.2, 4.0))
    return ls.SliderCrank(_link(random, a), rod, random.uniform(0.2, 2.0), e, branch=_branch(random))


def _inverted(random: Random) -> ls.InvertedSliderCrank:
    a, d = random.uniform(0.05, 0.4), random.uniform(0.05, 0.4)
    return ls.InvertedSliderCrank(
        _link(random, a), _link(random, 0.3), d, random.uniform(0.2, 1.0), 1e-3, 0.5 * abs(d - a), _branch(random)
    )


def _branch(random: Random) -> str:
    return str(random.choice(["open", "crossed"]))


def _link(random: Random, length: float) -> ls.Link:
    return ls.Link(length, random.uniform(0.1, 2.0), 0.01 * length, random.uniform(0.0, 0.1), random.uniform(-180, 180))


# ------------------------------------------------------------------------------------ ends that pass close by


def _passing(random: Random) -> Made:
    """Return a machine with a spring or damper whose ends pass at 1e-9 to 1e-2 m in the course of the revolution."""
    machine, place = _machine(random), float(random.uniform(0.0, 360.0))
    first, second = random.permutation(["ground", *_links(machine)])[:2]
    near = 10.0 ** random.uniform(-9.0, -2.0, DESIGNS) * np.exp(2j * np.pi * random.random(DESIGNS))
    point = _point(machine, str(first), random.uniform(0.02, 0.3) * np.exp(2j * np.pi * random.random()), place)
    ends = _end(machine, str(first), point + np.zeros(DESIGNS), place), _end(machine, str(second), point + near, place)
    load: Any = ls.Damper(*ends, coefficient=random.uniform(1.0, 200.0))
    if random.random() < 0.5:
        load = ls.Spring(*ends, rate=random.uniform(10.0, 5000.0), free_length=random.uniform(0.01, 0.2))
    loads = [load, ls.Load(_links(machine)[0], torque=_smooth(random))] if random.random() < 0.3 else [load]
    return ls.Scene(machine, random.uniform(2.0, 40.0), gravity=(6.5, 8.6), loads=loads), place


def _links(machine: Any) -> tuple[str, ...]:
    return tuple(link for link in machine.roles if link in ("crank", "coupler", "rod", "rocker", "slider"))


def _axes(machine: Any, link: str, place: float) -> tuple[complex, complex]:
    """Return first pin and direction of a link."""
    if link == "ground":
        return 0.0, 1.0
    end = ls.Spring(("ground", 0.0, 0.0), (link, 0.0, 0.0), rate=0.0, free_length=0.0)
    points = [_to(machine, end, place), _to(machine, ls.Spring(end.from_, (link, 1.0, 0.0), 0.0, 0.0), place)]
    return points[0], points[1] - points[0]


def _to(machine: Any, spring: ls.Spring, place: float) -> complex:
    """Return the end of a spring from the origin, by its distances from three points."""
    lengths = []
    for x, y in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)):
        shifted = ls.Spring(("ground", x, y), spring.to, 0.0, 0.0)
        cycle = ls.sweep(ls.Scene(machine, 1.0, loads=[shifted]), [place], of=["load1_length"])
        lengths.append(cycle.load1_length.values.item() ** 2)
    return 0.5 * (1.0 + lengths[0] - lengths[1]) + 0.5j * (1.0 + lengths[0] - lengths[2])


def _point(machine: Any, link: str, local: complex, place: float) -> complex:
    pin, axis = _axes(machine, link, place)
    return pin + local * axis


def _end(machine: Any, link: str, point: Array, place: float) -> tuple[str, Any, Any]:
    """Return the point of a link that is at these places at this angle."""
    pin, axis = _axes(machine, link, place)
    local = (point - pin) / axis
    first, second = (local.real, local.imag) if link == "ground" else (np.abs(local), np.degrees(np.angle(local)))
    return link, _designs(first), _designs(second)


def _designs(values: Array) -> xr.DataArray:
    return xr.DataArray(values, dims="design")


# ------------------------------------------------------------------------------------------------- functions


def _pulsing(random: Random) -> Made:
    """Return a machine with a Gaussian pulse of half-width 0.02 to 0.2 degrees, or of 1e-6 with a break that marks it,
    on a smooth load."""
    machine, place = _machine(random), float(random.uniform(0.0, 360.0))
    breaks = random.random() < 0.3
    width = 10.0 ** (random.uniform(-6.0, -2.0) if breaks else random.uniform(np.log10(0.02), np.log10(0.2)))
    smooth, height = _smooth(random), random.normal() * 20.0
    torque = _pulse(smooth, height, place, width)
    load = ls.Load(_links(machine)[0 if random.random() < 0.5 else -1], torque=torque, breaks=[place] if breaks else [])
    if load.link == "slider":
        load = ls.Load("slider", force=torque, breaks=load.breaks)
    omega2 = _designs(random.uniform(2.0, 40.0, DESIGNS))
    return ls.Scene(machine, omega2, gravity=(0.0, -9.81), loads=[load]), place


def _smooth(random: Random) -> Callable[[Array], Array]:
    size, phase = random.normal(size=(2, 4))
    orders = np.arange(1, 5)
    return lambda theta2: (size * np.sin(orders * np.radians(np.asarray(theta2))[..., None] + phase)).sum(axis=-1)


def _pulse(smooth: Callable[[Array], Array], height: float, place: float, width: float) -> Callable[[Array], Array]:
    def torque(theta2: Array) -> Array:
        away = np.mod(theta2 - place + 180.0, 360.0) - 180.0
        return smooth(theta2) + height * np.exp(-((away / width) ** 2))

    return torque
