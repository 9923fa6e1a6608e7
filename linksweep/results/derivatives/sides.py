"""Inputs of the physics on the two sides of an angle: where they jump, and where they bend."""

from __future__ import annotations

import numpy as np

from linksweep.results.derivatives.samples import Pairs
from linksweep.scene.derivatives.differentiated import Differentiated
from linksweep.scene.pairs import Array, changing_inputs_at

BESIDE = 1e-7
"""Distance from a jump [degree] at which its two sides are taken, and within which two are at one angle."""
NEAR = 1e-5
"""Distance from a bend [degree] at which its two sides are taken."""
LEAP = 1e-12
"""Leap of an input, relative to the input, that is rounding."""
BEND = 1e-3
"""Difference of the changes on two sides, relative to the larger one, up to which an input is smooth."""
CURVED = 1e-11
"""Difference of these changes, relative to the input, that may be its curvature."""


def inputs_of(scene: Differentiated, load: int) -> tuple[str, ...]:
    """Return the inputs of a load, by its number, that change over the angle."""
    return tuple(name for name in scene.changing_inputs if name.startswith(f"load{load}_"))


def unlisted(scene: Differentiated) -> tuple[str, ...]:
    """Return the inputs that may jump where no jump of the scene tells of it: functions, and those of the motion."""
    functions = {path.partition(".")[0] for path in scene.functions}
    listed = [k for k in range(1, len(scene.loads) + 1) if f"loads[{k}]" not in functions]
    known = {name for k in listed for name in inputs_of(scene, k)}
    return tuple(name for name in scene.changing_inputs if name not in known)


def leaps(pairs: Pairs, names: tuple[str, ...], angles: Array) -> Array:
    """Return whether inputs jump at an angle [degree] of each design: by more than they change beside it."""
    there = np.zeros(len(angles), dtype=bool)
    for far_before, before, after, far_after in _sides(pairs, names, angles, (-10.0, -1.0, 1.0, 10.0), BESIDE):
        beside = np.abs(before - far_before) + np.abs(far_after - after)
        there |= np.abs(after - before) > beside + LEAP * np.abs(before)
    return there


def bends(pairs: Pairs, names: tuple[str, ...], angles: Array) -> Array:
    """Return whether inputs bend or jump at an angle [degree] of each design."""
    there = np.zeros(len(angles), dtype=bool)
    for sides in _sides(pairs, names, angles, (-3.0, -1.0, 1.0, 3.0), NEAR):
        changes = np.diff(sides, axis=0)
        apart = np.ptp(changes, axis=0)
        there |= (apart > BEND * np.abs(changes).max(axis=0)) & (apart > CURVED * np.abs(sides).max(axis=0))
    return there


def _sides(pairs: Pairs, names: tuple[str, ...], angles: Array, ways: tuple[float, ...], step: float) -> list[Array]:
    """Return the values (way, design) of each input at some steps from an angle of each design; NaN where that is."""
    values, known = np.full((len(names), len(ways), len(angles)), np.nan), np.isfinite(angles)
    for k, way in enumerate(ways if names and known.any() else ()):
        inputs = changing_inputs_at(pairs.scene.plain, pairs.designs[known], angles[known] + way * step)
        values[:, k, known] = [inputs[name] for name in names]
    return list(values)
