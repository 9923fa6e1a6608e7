"""Travel of a position over the revolution: its ends, where its rate is zero, and the time that it takes each way.

A position x(θ2) turns round where its rate is zero. The largest and the least value lie at θmax and θmin; with
φ = θmax − θmin, between 0 and the angle P after which the motion repeats, 360° but for gears,

    travel = x(θmax) − x(θmin)        time ratio = the larger of φ and P − φ over the smaller

A dwell is the angle about an end over which the position stays within a fraction of its travel. Zeros between samples
are found by false position.

A position that grows without bound, as of two sliders on one pin whose guides become parallel, has an end that is inf
or -inf, at the crank angle of that pole; its travel is inf, its time ratio and its dwells are NaN.

A position stands still if it travels less than 1e-12 of its size: of a turn, or of its largest value and the crank's
length together. Its travel is then 0, both ends are its least value, and all else is NaN.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from linksweep.engine.quantity import opposite_of
from linksweep.engine.roots import roots
from linksweep.engine.run import Field
from linksweep.results.peak_search.between import EVERYWHERE
from linksweep.results.peak_search.groups import Group, assembled_groups, different, empty_over_all, with_assembly
from linksweep.results.peak_search.singular.poles import may_have_poles, poles
from linksweep.scene.scene import Scene

PER_TURN = 1440
TURN = 360.0
STILL = 1e-12
"""Travel of a position that stands still, relative to its size: rounding, with a margin."""
RATES = {"theta": "omega", "x_": "v_", "length_": "rate_"}
"""Beginning of the name of a position's rate, by that of the position; others are coordinates of pins."""
Array = np.ndarray


class Travel(NamedTuple):
    """Ends of a position, their crank angles [degree], the time ratio, and the dwells about the ends [degree]."""

    max: Any
    max_at: Any
    min: Any
    min_at: Any
    time_ratio: Any
    dwell_max: Any
    dwell_min: Any


class Samples(NamedTuple):
    """A position of designs and its rate at equal steps of a period [degree], both at pairs of a design's row and an
    angle; and its poles, as of `_pole_angles`."""

    period: float
    position: Array
    rate: Array
    position_at: Callable[[Array, Array], Array]
    rate_at: Callable[[Array, Array], Array]
    pole_angles: Array

    @property
    def step(self) -> float:
        """Step of the samples [degree]."""
        return self.period / self.position.shape[1]


def rate_of(position: str) -> str:
    """Return the name of the rate of a position: omega4 of theta4, v_ram of x_ram, vEx of Ex."""
    start = next((start for start in RATES if position.startswith(start)), "")
    return RATES.get(start, "v") + position.removeprefix(start)


def travel(scene: Scene, name: str, dwell: float) -> Travel:
    """Return the travel of a position as Fields over the design dims; NaN where it turns fully or has no revolution."""
    crank = scene.mechanism.parameters()[f"{scene.mechanism.roles[0]}_length"]
    names = (name, rate_of(name))
    empty = empty_over_all(scene, with_assembly(scene, names))
    results = Travel(*(Field(empty.dims, empty.values.copy()) for _ in Travel._fields))
    turns = scene.table.quantity[name].units == "degree"
    for _, group in assembled_groups(scene, different(scene, names), (EVERYWHERE,)):
        at = tuple(group.places[dim] for dim in empty.dims)
        with np.errstate(invalid="ignore", divide="ignore"):  # a link that turns fully, or stands still
            samples = _samples(group, names, turns)
            finite = np.nan_to_num(samples.position)  # at a pole it may be inf
            largest = TURN if turns else abs(finite).max(axis=1) + group.number(crank)
            values_of_group = _of_group(samples, dwell, STILL * largest)
        for field, values in zip(results, values_of_group, strict=True):
            field.values[at] = values if at else values[0]
    return results


def _samples(group: Group, names: tuple[str, ...], turns: bool) -> Samples:
    period = group.scene.period_of_motion
    designs, count = len(group.designs), PER_TURN * round(period / TURN)
    angles, rows = np.arange(count) * (period / count), np.repeat(np.arange(designs), count)
    position, rate = group.values(names, rows, np.tile(angles, designs)).reshape(2, designs, count)

    def at(name: str) -> Callable[[Array, Array], Array]:
        return lambda rows, angles: group.values((name,), rows, np.nan_to_num(angles))[0]

    position_at, rate_at = map(at, names)
    pole_angles = _pole_angles(group, names[0])
    if not turns:
        return Samples(period, position, rate, position_at, rate_at, pole_angles)
    unwrapped = np.unwrap(np.column_stack([position, position[:, :1]]), period=TURN, axis=1)
    goes_round = abs(unwrapped[:, -1] - unwrapped[:, 0]) > 0.5 * TURN
    position = np.where(goes_round[:, None], np.nan, unwrapped[:, :-1])

    def near_samples(rows: Array, angles: Array) -> Array:
        near = position[rows, np.round(np.nan_to_num(angles) * (count / period)).astype(int) % count]
        return near + (position_at(rows, angles) - near + 0.5 * TURN) % TURN - 0.5 * TURN

    return Samples(period, position, rate, near_samples, rate_at, pole_angles)


def _pole_angles(group: Group, name: str) -> Array:
    """Return the crank angles (end, design) [degree] at which a position is inf, and -inf; NaN where it is not."""
    ends = name, opposite_of(name)
    angles = np.full((len(ends), len(group.designs)), np.nan)
    if may_have_poles(group.scene, ends):
        row, angle, infinite = poles(group, ends)
        for of_end, here in zip(angles, infinite.T, strict=True):
            of_end[row[here]] = angle[here]
    return angles


def _of_group(samples: Samples, dwell: float, still: float | Array) -> Travel:
    """Return the travel of each design of a group; one that is at most `still` is none."""
    (top, top_at), (bottom, bottom_at) = map(partial(_end, samples), (1.0, -1.0), samples.pole_angles)
    period = samples.period
    way = (top_at - bottom_at) % period
    ratio = np.maximum(way, period - way) / np.minimum(way, period - way)
    near = dwell * (top - bottom)
    dwells = _dwell(samples, top_at, top - near, 1.0), _dwell(samples, bottom_at, bottom + near, -1.0)
    moves, stands = top - bottom > still, top - bottom <= still  # neither where it turns fully
    top_at, bottom_at = (np.where(moves, at % period, np.nan) for at in (top_at, bottom_at))
    others = (np.where(moves & (near < np.inf), number, np.nan) for number in (ratio, *dwells))
    return Travel(np.where(stands, bottom, top), top_at, bottom, bottom_at, *others)


def _end(samples: Samples, sign: float, pole: Array) -> tuple[Array, Array]:
    """Return the largest position (with sign -1 the least) and its crank angle: its pole, or a zero of the rate by the
    largest sample."""
    rows, count = np.arange(len(samples.position)), samples.position.shape[1]
    k = np.argmax(np.where(np.isnan(samples.position), -np.inf, sign * samples.position), axis=1)
    first = np.where((samples.rate[rows, k - 1] < 0.0) != (samples.rate[rows, k] < 0.0), k - 1, k)
    ends = np.stack([first, first + 1])
    at = roots(samples.rate_at, ends * samples.step, samples.rate[rows, ends % count])
    at = np.where(np.isfinite(at), at, k * samples.step)
    infinite = np.isfinite(pole)
    return np.where(infinite, sign * np.inf, samples.position_at(rows, at)), np.where(infinite, pole, at)


def _dwell(samples: Samples, at: Array, level: Array, sign: float) -> Array:
    """Return the angle about an end over which the position stays beyond a level."""
    rows, count = np.arange(len(at)), samples.position.shape[1]
    angle = np.zeros(len(at))
    for way in (1, -1):
        k = np.round(at / samples.step).astype(int)[:, None] + way * np.arange(count)
        within = sign * (samples.position[rows[:, None], k % count] - level[:, None]) >= 0.0
        step = np.argmin(within, axis=1)
        ends = np.stack([k[rows, np.maximum(step + side, 0)] * samples.step for side in (-1, 0)])
        beyond = np.stack([samples.position_at(rows, end) - level for end in ends])
        reached = roots(lambda row, x: samples.position_at(row, x) - level[row], ends, beyond)
        angle += way * (reached - at)
    return angle
