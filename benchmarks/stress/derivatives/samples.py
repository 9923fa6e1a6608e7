"""Errors of the derivatives of samples to all parameters of scenes, against 50-digit differences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

import linksweep as ls
from benchmarks.stress.decimals import Array, exactly, fifty_digits
from benchmarks.stress.derivatives.machine import near_pins, results
from benchmarks.stress.derivatives.numbers import Numbers, over_designs, some
from benchmarks.stress.linkages.errors import KINDS, kind
from linksweep.scene.derivatives.differentiated import number_problem
from linksweep.scene.parameters import free, replaced

LARGE = 1e-12
"""Error of derivatives above which the effect of the numbers' last digits is computed, to compare."""
BENT = 1e-6
"""Difference of the derivatives to two sides, relative to them, from which a result has a corner there."""
NOTHING = 1e-13
"""Part of its change with a parameter that is as large again, below which a magnitude is zero but for rounding."""


class Errors(NamedTuple):
    """Errors of each design that is ok; `value` and `derivative` are of the largest of their kind in the machine, a
    derivative times the size of its parameter; `alone` is of the largest derivative to the same parameter.

    `over_digit` is that of derivatives, where it is above `LARGE`, over the change of the exact derivatives when every
    number of the scene changes by its last digit, up or down at random.
    """

    designs: int
    value: Array
    derivative: Array
    alone: Array
    over_digit: Array
    worst: str


def joined(parts: Sequence[Errors]) -> Errors:
    """Return the errors of all parts together."""
    arrays = (
        np.concatenate([getattr(part, name) for part in parts])
        for name in ("value", "derivative", "alone", "over_digit")
    )
    worst = max(parts, key=lambda part: part.derivative.max(initial=0.0)).worst
    return Errors(sum(part.designs for part in parts), *arrays, worst)


def parameters_of(scene: ls.Scene) -> tuple[str, ...]:
    """Return the paths of all parameters that have derivatives."""
    return tuple(path for path in free(scene) if not number_problem(scene, path))


def errors_of(scene: ls.Scene, theta2: float, random: np.random.Generator, most: int = 14) -> Errors:
    """Return the errors of a scene's quantities at an angle [degree], of so many drawn at random."""
    paths = parameters_of(scene)
    count, index = Numbers(scene, paths).designs, scene.mechanism.index
    status = ls.sweep(scene, [theta2], of=["status"]).status
    ok = np.flatnonzero(over_designs(status, count, **{index: 1})[:, 0] == 0)
    if not len(ok):
        return Errors(count, *np.zeros((4, 0)), "")
    scene = some(scene, ok, count)
    numbers = Numbers(scene, paths)
    angles = np.full(numbers.designs, theta2)
    exact = results(numbers, numbers.columns(exactly(angles)), near_pins(scene, angles))
    drawn = sorted(random.permutation(sorted(exact))[:most])
    ds = ls.sensitivities(scene, of=drawn, to=paths, **{index: [theta2]})
    values, slopes, errors, own, exact_slopes = {}, {}, {}, {}, {}
    sizes = np.stack([numbers.sizes(path) for path in paths], axis=1)
    with fifty_digits():
        for name in drawn:
            middle, slope = numbers.middle(exact[name]), numbers.derivatives(exact[name])
            ours = over_designs(ds[name], numbers.designs, **{index: 1})[:, 0]
            sizes_of = {index: 1, "parameter": len(paths)}
            derivative = over_designs(ds[f"{name}_derivative"], numbers.designs, **sizes_of)[:, 0]
            exact_slopes[name] = slope
            values[name], slopes[name] = np.abs(middle.astype(float)), np.abs(slope.astype(float))
            own[name] = np.abs((exactly(ours) - middle).astype(float))
            errors[name] = _off(exactly(derivative), slope, numbers.sides(exact[name]))
            if scene.table.quantity[name].squared:  # the magnitude of no force has no derivative
                errors[name][values[name] < NOTHING * (slopes[name] * sizes).max(axis=1)] = 0.0
    own = {name: _turned(name, error) for name, error in own.items()}
    relative = _relative(values, slopes, own, errors, sizes, (drawn, paths))
    rows = np.flatnonzero(relative.derivative > LARGE)
    if not len(rows):
        return relative._replace(designs=count)
    changed = _changed_by_a_digit(some(scene, rows, numbers.designs), paths, theta2, random)
    with fifty_digits():
        changes = {name: np.abs((changed[name] - exact_slopes[name][rows]).astype(float)) for name in drawn}
    values, slopes = ({name: of[name][rows] for name in drawn} for of in (values, slopes))
    effect = _relative(values, slopes, values, changes, sizes[rows], (drawn, paths)).derivative
    relative.over_digit[rows] = relative.derivative[rows] / effect
    return relative._replace(designs=count)


def _changed_by_a_digit(
    scene: ls.Scene, paths: tuple[str, ...], theta2: float, random: np.random.Generator
) -> dict[str, Array]:
    """Return the exact derivatives of results where every number has changed by its last digit, up or down at random;
    one that is zero stays."""
    ways = {path: random.choice([-np.inf, np.inf]) for path in paths}
    numbers = {path: free(scene)[path][0] for path in paths}
    changed = {path: np.nextafter(value, ways[path]) for path, value in numbers.items() if np.all(value)}
    near = Numbers(replaced(scene, changed), paths)
    angles = np.full(near.designs, theta2)
    exact = results(near, near.columns(exactly(angles)), near_pins(near.scene, angles))
    with fifty_digits():
        return {name: near.derivatives(one) for name, one in exact.items()}


def _off(ours: Array, slope: Array, sides: Array) -> Array:
    """Return the errors of derivatives, where a slide bears nothing, or a magnitude is zero, from the nearest of those
    to its two sides; where a derivative is next to nothing, the sides differ only by their own errors."""
    right, left = sides
    off, nearer = (abs(x).astype(float) for x in (ours - slope, np.minimum(abs(ours - right), abs(ours - left))))
    bent = abs(right - left).astype(float) > BENT * (abs(right) + abs(left)).astype(float)
    return np.where(bent, np.minimum(off, nearer), off)


def _turned(name: str, error: Array) -> Array:
    """Return the error of an angle within a turn."""
    return np.minimum(error, np.abs(360.0 - error)) if kind(name) == "angle" else error


def _relative(
    values: dict, slopes: dict, own: dict, errors: dict, sizes: Array, labels: tuple[Sequence, Sequence]
) -> Errors:
    """Return errors relative to the largest of their kind; forces, torques and motions are kinds."""
    value, derivative, alone = np.zeros((3, len(sizes)))
    where, largest = "", 0.0
    for one in KINDS:
        names = [name for name in values if kind(name) == one]
        if not names:
            continue
        scale = np.max([values[name] for name in names], axis=0) + 1e-300
        steep = np.max([slopes[name] * sizes for name in names], axis=(0, 2)) + 1e-300
        most = np.max([slopes[name] for name in names], axis=0)
        most = np.maximum(most, 1e-3 * steep[:, None] / sizes)
        for name in names:
            value = np.fmax(value, own[name] / np.maximum(scale, steep))
            off = np.nanmax(errors[name] * sizes, axis=1) / steep
            if np.max(off, initial=0.0) > largest:
                largest, k = float(np.max(off)), int(np.argmax(off))
                where = f"{name} to {labels[1][int(np.argmax(errors[name][k] * sizes[k]))]}"
            derivative, alone = np.fmax(derivative, off), np.fmax(alone, np.max(errors[name] / most, axis=1))
    missing = np.array([np.isnan(errors[name]).any(axis=1) for name in errors]).any(axis=0)
    derivative = np.where(missing, np.inf, derivative)
    return Errors(len(sizes), value, derivative, alone, np.zeros(len(sizes)), where)
