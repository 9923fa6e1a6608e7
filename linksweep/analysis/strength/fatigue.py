"""Life under a stress with several rises: its closed cycles by rainflow counting, and Miner's sum of their damage.

Motion repeats, so that a stress counted from its largest value on consists of closed cycles alone. Each has a mean σ_m
and an amplitude σ_a, a part of the damage, and the whole motion their sum:

    σ_ar = σ_a/(1 − σ_m/S_u)        N = N_e (S_e/σ_ar)^k        D = Σ 1/N        (Goodman, σ_m in tension alone)

with the endurance limit S_e, reached after N_e cycles, and the slope k of the S-N curve. Where no cycle exceeds S_e,
none does damage; where one does, those below count by the same line (the elementary form of Miner's rule). The cycle
from the largest value to the least has the largest σ_ar of all where S_e < S_u, so that the safety needs no counting.

Turning points are sought between the samples of a search for exact peaks: each narrow event that it finds counts.

Sources: ASTM E1049-85, Standard Practices for Cycle Counting in Fatigue Analysis, section 5.4.5, rainflow counting of
repeating histories; R. G. Budynas and J. K. Nisbett, Shigley's Mechanical Engineering Design, chapter "Fatigue Failure
Resulting from Variable Loading", for Goodman's amplitude and Miner's rule.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.strength.material import Material
from linksweep.engine.run import Field
from linksweep.results.peak_search.between import EVERYWHERE
from linksweep.results.peak_search.groups import Group, assembled_groups
from linksweep.results.peak_search.paths import search_samples
from linksweep.scene.dimensions import aligned
from linksweep.scene.pairs import Array, flat_index
from linksweep.scene.scene import Scene

THIRDS = 32
"""Steps towards an extreme between samples, each of which leaves two thirds."""
SLIGHT = 1e-9
"""Range of a cycle of stress that is rounding, relative to the largest size of the stress."""


def life(scene: Scene, names: tuple[str, str], place: xr.Dataset, material: Material) -> dict[str, xr.DataArray]:
    """Return the number of closed cycles of stress in a cycle of motion, their damage, and the life in such cycles.

    Parameters
    ----------
    scene : Scene
        Scene without sections.
    names : tuple of str
        Names of the stress in the fibres on either side.
    place : Dataset
        Over the design dims: `share` of the section and number of the `fibre` where fatigue is worst, the `factor` on
        its stress, and its exact extremes `largest` and `least` [Pa].
    material : Material
        Material with a slope.
    """
    numbers = (material.tensile_strength, material.endurance, material.slope, material.knee)
    section, *_ = xr.broadcast(place["share"], *map(xr.DataArray, numbers))
    along = replace(scene, section=section if section.ndim else float(section))
    sizes = along.at_one_angle.inputs.sizes
    shape = tuple(sizes.values())
    rows = [np.broadcast_to(aligned(xr.DataArray(one), tuple(sizes)), shape).ravel() for one in numbers]
    places = [np.broadcast_to(aligned(place[name], tuple(sizes)), shape).ravel() for name in place]
    by_name = dict(zip(map(str, place), places, strict=True))
    counts, damage = np.full((2, int(np.prod(shape, dtype=int))), np.nan)
    for design, turning in _histories(along, names, by_name):
        counts[design], damage[design] = miner(turning, *(float(row[design]) for row in rows))
    with np.errstate(divide="ignore"):
        results = {"stress_cycles": counts, "damage": damage, "life": 1.0 / damage}
    return {name: xr.DataArray(values.reshape(shape), dims=tuple(sizes)) for name, values in results.items()}


def miner(turning: Array, tensile: float, endurance: float, slope: float, knee: float) -> tuple[int, float]:
    """Return the number of closed cycles in the turning points of a stress that repeats, and their damage."""
    mean, amplitude = closed_cycles(turning)
    with np.errstate(divide="ignore"):
        left = np.maximum(1.0 - np.maximum(mean, 0.0) / tensile, 0.0)
        equivalent = amplitude / left
    harmless = bool((equivalent <= endurance).all())
    return len(mean), 0.0 if harmless else float(((equivalent / endurance) ** slope).sum() / knee)


def closed_cycles(turning: Array) -> tuple[Array, Array]:
    """Return mean and amplitude of the closed cycles of a stress that repeats, from its turning points in order."""
    first = int(np.argmax(turning))
    from_largest = [*turning[first:], *turning[: first + 1]]
    counted = np.array([*_extract_cycles()(from_largest)]).reshape(-1, 5)
    size, mean, count = counted.T[:3]
    (halves,) = np.nonzero(count < 1.0)  # the largest fall and the largest rise are one cycle
    whole = np.delete(np.arange(len(counted)), halves[1::2])
    kept = whole[size[whole] > SLIGHT * np.abs(turning).max()]
    return mean[kept], 0.5 * size[kept]


class Brackets(NamedTuple):
    """Samples of periodic functions that are higher (sign 1) or lower (−1) than both of their neighbours: rows of the
    functions, angles [degree] of the samples and their neighbours, and the sampled values."""

    row: Array
    sign: Array
    low: Array
    high: Array
    value: Array


def brackets(angles: Array, values: Array, period: float) -> Brackets:
    """Return the brackets of all extremes of functions with samples (row, sample) in order, of which some repeat; in
    order of the rows and of the angles."""
    own = np.diff(angles, axis=1, prepend=-np.inf) > 0.0
    count = own.sum(axis=1)
    row, last = np.repeat(np.arange(len(count)), count), np.cumsum(count) - 1
    x, value, nth = angles[own], values[own], np.arange(len(row))
    first = (last - count + 1)[row]
    before = first + (nth - 1 - first) % count[row]
    after = first + (nth + 1 - first) % count[row]
    top = (value > value[before]) & (value >= value[after])
    (k,) = np.nonzero(top | (value < value[before]) & (value <= value[after]))
    low, high = x[before] - period * (before > nth), x[after] + period * (after < nth)
    return Brackets(row[k], np.where(top[k], 1.0, -1.0), low[k], high[k], value[k])


def turning_points(value_at: Callable[[Array, Array], Array], extremes: Brackets) -> Array:
    """Return the extremes in brackets; `value_at` returns values at pairs of a row and an angle [degree]."""
    row, sign, low, high, sampled = extremes
    for _ in range(THIRDS):
        third = (high - low) / 3.0
        left, right = (sign * value_at(row, angle) for angle in (low + third, high - third))
        low, high = np.where(left < right, low + third, low), np.where(left < right, high, high - third)
    between = value_at(row, 0.5 * (low + high))
    return np.where(sign * between > sign * sampled, between, sampled)  # at a jump the sample on its side is the limit


def _histories(scene: Scene, names: tuple[str, str], place: dict[str, Array]) -> Iterator[tuple[int, Array]]:
    """Yield the number of each design that moves at all angles, and the turning points of its stress."""
    sizes, every = scene.at_one_angle.inputs.sizes, np.arange(len(place["fibre"]))
    numbers = Field(tuple(sizes), every.reshape(tuple(sizes.values())))
    for _, group in assembled_groups(scene, every, (EVERYWHERE,)):
        designs = flat_index(numbers, group.places, len(group.designs))

        def stress_at(row: Array, angle: Array, group: Group = group, designs: Array = designs) -> Array:
            both = group.values(names, row, angle)
            chosen = place["fibre"][designs[row]].astype(int)
            return both[chosen, np.arange(len(row))] * place["factor"][designs[row]]

        angles = search_samples(group)
        rows = np.repeat(np.arange(len(designs)), angles.shape[1])
        samples = stress_at(rows, angles.ravel()).reshape(angles.shape)
        extremes = brackets(angles, samples, scene.period)
        turning = turning_points(stress_at, extremes)
        for one, design in enumerate(designs):
            own = extremes.row == one
            history = turning[own] if own.any() else samples[one, :2]  # a constant has no extremes
            if np.isfinite(samples[one]).all():
                history[np.argmax(history)] = place["largest"][design]
                history[np.argmin(history)] = place["least"][design]
                yield int(design), history


def _extract_cycles() -> Any:
    """Return the function that counts cycles."""
    try:
        from rainflow import extract_cycles  # here: only those who state a slope need it
    except ImportError:
        missing = 'Counting cycles of stress needs rainflow: pip install "linksweep[fatigue]"'
        raise ImportError(f"{missing}, or leave out the slope of the material") from None
    return extract_cycles
