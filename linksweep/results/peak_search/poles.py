"""Poles: crank angles inside a turn or an arc at which quantities grow without bound, and which of them do.

Where they may be is known in closed form: the dead centres of the drive and of the output, the angles from which on
friction wedges, and, in a crank that turns fully, its change points. There a quantity has a pole if it grows as a power
of the distance, on one side at least: no rounding does that, nor a quantity that has a limit.
"""

from __future__ import annotations

from functools import singledispatch
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.engine.run import Field
from linksweep.mechanisms.limits.finding import Finding
from linksweep.results.compute import surely_ok
from linksweep.results.peak_search.between import Array, Group
from linksweep.scene.dimensions import side_by_side
from linksweep.scene.scene import Scene

CLOSEST = 1e-8
"""How near to a dead centre or jam a quantity is looked at [degree]."""
CLOSEST_TO_TOGGLE = 1e-5, 1e-4
"""How near to a change point [degree]: clear of what cannot be told from it, by whichever power leads there."""
BESIDE = np.array([1.0, 2.0, 4.0, 8.0])
LEAST_GROWTH = 1.5
"""By which a quantity grows at least over half the way to a pole: the power of 2 that it is of, nearly."""
EVENNESS = 1.1
"""Growths over halves of the way to a pole differ by less than this factor."""
PARTLY = 1.0
"""The assembly of what moves over a part of the turn."""
TOGGLE = 2.0


OF_OUTPUT = ("torque_ratio", "mechanical_advantage")
"""Quantities with a pole where the output stands still, whatever drives."""


Places = tuple[Array, Array, Array]


class Poles(NamedTuple):
    """Angles [degree] of the designs `row` of a group, and whether each signal grows to +inf there (pole, signal)."""

    row: Array
    angle: Array
    infinite: Array


def may_have_poles(scene: Scene, signals: tuple[str, ...]) -> bool:
    """Return whether any of these quantities may grow without bound inside a turn or an arc."""
    return "unbounded" in scene.mechanism.round_meanings and (_of_output(signals) or not surely_ok(scene))


def _of_output(signals: tuple[str, ...]) -> bool:
    return any(signal.removeprefix("-") in OF_OUTPUT for signal in signals)


def with_dead_centres(scene: Scene, assembly: Field) -> Field:
    """Return `assembly`, made 1 where a dead centre or friction forbids some angles of a whole turn."""
    status = xr.Variable(assembly.dims, assembly.values, fastpath=True)  # without waking dask to see whether it is its
    if "unbounded" in scene.mechanism.round_meanings:
        for findings, numbers in scene.mechanism.driven_findings(scene.motion | {"drive": scene.drive}):
            dims, arrays = side_by_side(numbers)
            for angles in _singular_angles(findings(*arrays)):
                there = xr.Variable(dims, np.isfinite(angles).any(axis=-1))
                status = xr.where(there & (status < PARTLY), PARTLY, status)
    return Field(tuple(map(str, status.dims)), status.values)


def poles(group: Group, signals: tuple[str, ...], threads: int | None = None) -> Poles:
    """Return the poles of these designs, inside the angles at which they can be assembled."""
    row, angle, step = places_of_poles(group, signals)
    if not len(row):
        return Poles(row, angle, np.zeros((0, len(signals)), dtype=bool))
    side = np.array([-1.0, 1.0])
    angles = angle[:, None, None] + step[:, None, None] * side[:, None] * BESIDE
    rows = np.repeat(row, angles[:1].size)
    with np.errstate(invalid="ignore"):
        values = group.values(signals, rows, angles.ravel(), threads).reshape(len(signals), *angles.shape)
        infinite = _grows_as_a_power(np.abs(values)) & (values[..., 0] > 0.0)
    return Poles(row, angle, np.any(infinite, axis=-1).T)


@singledispatch
def places_of_poles(group: Any, signals: tuple[str, ...]) -> Places:
    """Return designs, angles [degree] at which poles may be, and how near to look."""
    row, angle, step = (
        np.concatenate(parts) for parts in zip(_known(group, signals), _change_points(group), strict=True)
    )
    return row, angle, step


def _grows_as_a_power(size: Array) -> Array:
    """Return whether sizes (…, step), the nearest first, grow by the same factor with each half of the way."""
    with np.errstate(all="ignore"):
        growth = size[..., :-1] / size[..., 1:]
    least, largest = growth.min(axis=-1), growth.max(axis=-1)
    return (least > LEAST_GROWTH) & (largest < EVENNESS * least)


def _singular_angles(found: dict[str, Finding]) -> list[Array]:
    """Dead centres and jams among what was found in closed form [degree], several on a trailing axis."""
    return [found[kind].values for kind in ("dead_centre_angle", "jam_angle") if kind in found]


def _known(group: Group, signals: tuple[str, ...]) -> Places:
    """Dead centres and jams: designs, angles [degree], and how near to look."""
    scene = group.scene
    checks = scene.mechanism.driven_findings(scene.motion | {"drive": scene.drive})
    checks += scene.mechanism.output_findings() if _of_output(signals) else ()
    found = [_singular_angles(findings(*map(group.number, numbers))) for findings, numbers in checks]
    angle = np.concatenate([np.empty((len(group.designs), 0)), *chain(*found)], axis=1)
    row, which = np.nonzero(np.isfinite(angle))
    return row, angle[row, which], np.full(len(row), CLOSEST)


def _change_points(group: Group) -> Places:
    """The middles of the pinches of these designs where they cannot be told from toggles."""
    middle = group.number(group.scene.mechanism.near_toggle_angle)
    row, angle = np.tile(np.arange(len(middle)), 2), np.concatenate([middle, middle + 180.0])
    (status,) = group.values(("status",), row, angle)
    there, steps = np.flatnonzero(status == TOGGLE), np.array(CLOSEST_TO_TOGGLE)
    twice = np.repeat(there, len(steps))
    return row[twice], angle[twice], np.tile(steps, len(there))
