"""Life under a stress with several rises: its closed cycles by rainflow counting, and Miner's sum of their damage.

Motion repeats, so that a stress counted from its largest value on consists of closed cycles alone. Each has a mean σ_m
and an amplitude σ_a, a part of the damage, and the whole motion their sum:

    σ_ar = σ_a/(1 − σ_m/S_u)        N = N_e (S_e/σ_ar)^k        D = Σ 1/N        (Goodman, σ_m in tension alone)

with the endurance limit S_e, reached after N_e cycles, and the slope k of the S-N curve. Where no cycle exceeds S_e,
none does damage; where one does, those below count by the same line (the elementary form of Miner's rule). The cycle
from the largest value to the least has the largest σ_ar of all where S_e < S_u, so that the safety needs no counting.

Sources: ASTM E1049-85, Standard Practices for Cycle Counting in Fatigue Analysis, section 5.4.5, rainflow counting of
repeating histories; R. G. Budynas and J. K. Nisbett, Shigley's Mechanical Engineering Design, chapter "Fatigue Failure
Resulting from Variable Loading", for Goodman's amplitude and Miner's rule.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.strength.material import Material
from linksweep.scene.dimensions import aligned
from linksweep.scene.pairs import Array, quantities_at
from linksweep.scene.scene import Scene

PER_TURN, THIRDS = 720, 32
"""Even samples of a turn, and steps towards an extreme between them, each of which leaves two thirds."""
SLIGHT = 1e-9
"""Range of a cycle of stress that is rounding, relative to the largest size of the stress."""
BLOCK = 4096
"""Designs whose samples are held at once."""


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


def turning_points(value_at: Callable[[Array, Array], Array], values: Array, step: float) -> tuple[Array, Array]:
    """Return row and value of the extremes of periodic functions with even samples (row, sample), in order of the rows
    and of the angles [degree]; `value_at` returns values at pairs of a row and an angle."""
    before, after = np.roll(values, 1, axis=1), np.roll(values, -1, axis=1)
    top, bottom = (values > before) & (values >= after), (values < before) & (values <= after)
    row, k = np.nonzero(top | bottom)
    sign = np.where(top[row, k], 1.0, -1.0)
    low, high = (k - 1) * step, (k + 1) * step
    for _ in range(THIRDS):
        third = (high - low) / 3.0
        left, right = (sign * value_at(row, angle) for angle in (low + third, high - third))
        low, high = np.where(left < right, low + third, low), np.where(left < right, high, high - third)
    return row, value_at(row, 0.5 * (low + high))


def _histories(scene: Scene, names: tuple[str, str], place: dict[str, Array]) -> Iterator[tuple[int, Array]]:
    """Yield the number of each design that moves at all angles, and the turning points of its stress."""
    count = PER_TURN * round(scene.period / 360.0)
    step = scene.period / count
    for start in range(0, len(place["fibre"]), BLOCK):
        designs = np.arange(start, min(start + BLOCK, len(place["fibre"])))

        def stress_at(row: Array, angle: Array, designs: Array = designs) -> Array:
            both = quantities_at(scene, names, designs[row], angle)
            chosen = place["fibre"][designs[row]].astype(int)
            return both[chosen, np.arange(len(row))] * place["factor"][designs[row]]

        rows = np.repeat(np.arange(len(designs)), count)
        samples = stress_at(rows, np.tile(np.arange(count) * step, len(designs))).reshape(len(designs), count)
        row, turning = turning_points(stress_at, samples, step)
        for one, design in enumerate(designs):
            history = turning[row == one]
            if np.isfinite(samples[one]).all() and len(history):
                history[np.argmax(history)], history[np.argmin(history)] = (
                    place["largest"][design],
                    place["least"][design],
                )
                yield int(design), history


def _extract_cycles() -> Any:
    """Return the function that counts cycles."""
    try:
        from rainflow import extract_cycles  # here: only those who state a slope need it
    except ImportError:
        missing = 'Counting cycles of stress needs rainflow: pip install "linksweep[fatigue]"'
        raise ImportError(f"{missing}, or leave out the slope of the material") from None
    return extract_cycles
