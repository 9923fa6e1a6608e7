"""Errors of the derivatives of exact peaks, against differences of peaks in 50 digits.

A smooth peak is the vertex of a parabola through three points so close that it is exact to 20 digits, of each moved
scene its own. One beside a jump lies where a velocity is zero, at that angle of each moved scene, or at an angle that
stays; its value is that on the side where linksweep finds it, or at the jump itself, where a slide stands still.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from decimal import Decimal
from functools import partial
from typing import NamedTuple

import numpy as np

import linksweep as ls
from benchmarks.stress.decimals import Array, exactly, fifty_digits
from benchmarks.stress.derivatives.loads import dead_centres, level_of
from benchmarks.stress.derivatives.machine import near_pins, results
from benchmarks.stress.derivatives.numbers import AtRest, Numbers, over_designs, some, turning_point
from benchmarks.stress.derivatives.samples import parameters_of
from benchmarks.stress.linkages.multibody import Unsolved
from linksweep.results.derivatives.of_peaks import MEANINGS, OK

Every = Callable[[Array], Mapping[str, Array]]
STEP = Decimal("1e-9")
"""Distance of the moved scenes, of the parameter's size."""
NEAR = 1e-4
"""Largest distance of a peak from linksweep's [degree]."""
SAME = 1e-9
"""Largest difference of two equal peaks, relative to them."""
BESIDE = Decimal("1e-15")
"""Distance from a jump [degree]."""


class Errors(NamedTuple):
    """Errors of peaks, of the largest derivative times its parameter's size, or of the peak; how many peaks have each
    status; and how many are ok whose kind the reference does not know."""

    error: Array
    statuses: Counter[str]
    unknown: list[str]
    worst: str = ""


def errors_of(scene: ls.Scene, random: np.random.Generator, most: int = 2, parameters: int = 3) -> Errors:
    """Return the errors of so many peaks of scenes, to so many parameters, drawn at random."""
    paths = parameters_of(scene)
    paths = tuple(sorted(random.choice(paths, min(parameters, len(paths)), replace=False)))
    stems = sorted(random.permutation([*scene.mechanism.peak_quantities(scene.drive)])[:most])
    names = {stem: _name(scene, str(stem), random) for stem in stems}
    ds = ls.sensitivities(scene, of=list(names.values()), to=paths)
    every = ls.peaks(scene, of=[str(stem) for stem in stems])
    count = Numbers(scene, paths).designs
    errors, statuses, unknown, worst = [np.zeros(0)], Counter[str](), list[str](), ""
    for stem, name in names.items():
        status, at, value = (
            over_designs(array, count) for array in (ds[f"{name}_status"], every[f"{name}_at"], ds[name])
        )
        ours = over_designs(ds[f"{name}_derivative"], count, parameter=len(paths))
        statuses.update(MEANINGS[k] for k in status)
        rows = np.flatnonzero(status == OK)
        if not len(rows):
            continue
        error, known = _errors(some(scene, rows, count), str(stem), paths, at[rows], value[rows], ours[rows])
        unknown += [f"{name}, design {rows[k]}, at {at[rows][k]:.6g}" for k in np.flatnonzero(~known)]
        if known.any() and error[known].max() > max(part.max(initial=0.0) for part in errors):
            k = int(np.argmax(np.where(known, error, 0.0)))
            worst = f"{name}, design {rows[k]}, at {at[rows][k]:.6g}"
        errors.append(error[known])
    return Errors(np.concatenate(errors), statuses, unknown, worst)


def joined(parts: Sequence[Errors]) -> Errors:
    """Return the errors of all parts together."""
    statuses = sum((part.statuses for part in parts), Counter[str]())
    worst = max(parts, key=lambda part: part.error.max(initial=0.0)).worst
    unknown = [text for part in parts for text in part.unknown]
    return Errors(np.concatenate([part.error for part in parts]), statuses, unknown, worst)


def _name(scene: ls.Scene, stem: str, random: np.random.Generator) -> str:
    ends = ("peak",) if scene.table.quantity[stem].squared else ("max", "min")
    return f"{stem}_{random.choice(ends)}"


def _errors(
    scene: ls.Scene, stem: str, paths: tuple[str, ...], at: Array, value: Array, ours: Array
) -> tuple[Array, Array]:
    """Return the errors of the peaks of a quantity at angles [degree], and which the reference knows."""
    numbers = Numbers(scene, paths, STEP)
    pins = near_pins(scene, at)

    def every(theta2: Array, of: Numbers = numbers) -> Mapping[str, Array]:
        return results(of, theta2, pins)

    at_rest = partial(every, of=AtRest(scene, paths, STEP))
    with fifty_digits():
        try:
            start = numbers.columns(exactly(at))
            place, height = turning_point(lambda theta2: every(theta2)[stem], start)
            smooth = _alike(numbers, height, value) & (np.abs(numbers.middle(place).astype(float) - at) < NEAR)
            known = smooth
            if not smooth.all():
                beside = _beside_jumps(numbers, every, at_rest, stem, start, value)
                known = smooth | _alike(numbers, beside, value)
                height = np.where(numbers.columns(smooth), height, beside)
        except (Unsolved, np.linalg.LinAlgError, ZeroDivisionError):
            return np.zeros(len(at)), np.zeros(len(at), dtype=bool)
        exact = numbers.derivatives(height)
        off = np.abs((exactly(ours) - exact).astype(float))
    sizes = np.stack([numbers.sizes(path) for path in paths], axis=1)
    scale = np.maximum((np.abs(exact.astype(float)) * sizes).max(axis=1), np.abs(value))
    return np.max(off * sizes, axis=1) / scale, known


def _alike(numbers: Numbers, height: Array, value: Array) -> Array:
    return np.abs(numbers.middle(height).astype(float) - value) <= SAME * np.abs(value)


def _beside_jumps(numbers: Numbers, every: Every, at_rest: Every, stem: str, start: Array, value: Array) -> Array:
    """Return the values beside the jumps and bends near these angles, on the sides where they are nearest to the peaks,
    or between them, where the slides stand still and do not rub.

    NaN where none is near.
    """
    place = numbers.columns(exactly(_nearest(numbers.scene, start.astype(float)[:: 2 * len(numbers.moved)])))
    step = Decimal("1e-6")
    wide = every(np.concatenate([start - step, start + step]))
    for name, level in events(numbers, wide):
        before, after = np.split(wide[name] - np.tile(level, 2), 2)
        with np.errstate(all="ignore"):
            away = step * (before + after) / (before - after)
        here = np.abs(away.astype(float)) < NEAR
        if here.any():
            zero = _zero(lambda theta2, name=name, level=level: every(theta2)[name] - np.tile(level, 2), start + away)
            place = np.where(here, zero, place)
    known = ~np.isnan(place.astype(float))
    near = np.where(known, place, start)
    sides = np.stack([of(near + side)[stem] for of in (every, at_rest) for side in (-BESIDE, BESIDE)])
    away = [np.abs(numbers.middle(side).astype(float) - value) for side in sides]
    nearest = np.take_along_axis(sides, numbers.columns(np.argmin(away, axis=0))[None], axis=0)[0]
    return np.where(known, nearest, exactly(np.nan))


def events(numbers: Numbers, known: Mapping[str, Array]) -> Iterator[tuple[str, Array]]:
    """Yield the results whose passage through a level is a jump or a bend, and the level in all columns."""
    none = exactly(np.zeros(len(numbers)))
    for name in known:
        if name.startswith(("v_", "rate_", "slide_velocity", "omega")):
            yield name, none
    for k, load in enumerate(numbers.scene.loads, 1):
        if isinstance(load, ls.GasPressure) and isinstance(load.pressure, ls.DieselCycle):
            (_, top), (_, bottom) = dead_centres(numbers)
            ratio, cutoff = (numbers(f"loads[{k}].pressure.{word}_ratio") for word in ("compression", "cutoff"))
            yield "x_slider", top - (top - bottom) * (cutoff - 1) / (ratio - 1)
        if isinstance(load, ls.Load) and load.over:
            stroke = numbers.scene.mechanism.strokes[load.over]
            for place in sorted({float(x) for table in load.over_positions for x in getattr(table, "position", ())}):
                yield stroke.quantity, level_of(numbers, load.over, place)


def _zero(function: Callable[[Array], Array], near: Array) -> Array:
    """Return the angles near these at which a function is zero, by two secants; NaN where there is none."""
    at = near
    for step in map(Decimal, ("1e-9", "1e-14")):
        before, after = np.split(function(np.concatenate([at - step, at + step])), 2)
        at = at + step * (before + after) / (before - after)
    return at


def _nearest(scene: ls.Scene, at: Array) -> Array:
    """Return the angle near each of these at which a load over theta2 jumps or bends, or a lap begins; NaN where none
    is near."""
    loads = [load for load in scene.loads if getattr(load, "interpolation", None) in ("step", "linear")]
    tables = (part for load in loads for part in load.changing if "theta2" in getattr(part, "coords", ()))
    breaks = {float(angle) for table in tables for angle in table.theta2}
    breaks |= {0.0} if scene.profile == "energy" else set()
    nearest = np.full(len(at), np.nan)
    for angle in breaks:
        place = angle + 360.0 * np.round((at - angle) / 360.0)
        nearest = np.where(np.abs(at - place) < NEAR, place, nearest)
    return nearest
