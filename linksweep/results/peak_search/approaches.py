"""Where springs and dampers turn over: the closest approaches of their ends, to be looked at more closely.

The direction of a line whose ends pass at a distance l0 turns by 180 degrees about there, nearly all of it within a
few times w = l0/|d(q − p)/dθ2| of the crank's angle. Half the slope of the squared distance, l·dl/dθ2, rises through 0
there; it is as smooth as the motion of the links, however narrow the approach is.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from linksweep.engine.kernel.writer import Reduction
from linksweep.engine.peaks.search_kernel import FAR_WIDTH, NEAR_WIDTH
from linksweep.engine.run import Field, reduce_rows
from linksweep.engine.trace.plan import plan
from linksweep.results.compute import compute
from linksweep.results.peak_search.between import Array, Group, crossing, positions_at
from linksweep.scene.dimensions import laid
from linksweep.scene.grid import crank_grid
from linksweep.scene.scene import Scene

WIDE = np.radians(20.0)
"""Wider approaches are as smooth as the rest of the machine [rad]."""
STEP = 2.0
"""Between the samples that tell which designs have narrow approaches [degree]."""
NARROW_PINCH = 0.1
"""Beside a narrower near-toggle an approach may hide between these samples [rad]."""
NARROWEST = 1e-9
"""An approach is looked at as if it were at least so wide [degree]."""
REACH = 30.0
"""How far about an approach its samples go, to meet others [degree]."""
SAMPLES = 56
"""About each approach, dense within its width."""
STEPS = 12
"""Steps of the false position to an approach, on a slope that is all but straight."""


class Approaches(NamedTuple):
    """Closest approaches of some designs: which design, the crank angle and the width there [degree]."""

    row: Array
    angle: Array
    width: Array

    def samples(self) -> Array:
        """Return crank angles (approach, sample) [degree] on a sinh grade about each."""
        grade = np.linspace(-1.0, 1.0, SAMPLES) * np.arcsinh(REACH / self.width)[:, None]
        return self.angle[:, None] + self.width[:, None] * np.sinh(grade)

    def by_design(self, designs: int) -> Array:
        """Return the samples (design, sample), NaN where other designs have more approaches."""
        order = np.argsort(self.row, kind="stable")
        owner = self.row[order]
        nth = np.arange(len(owner)) - np.searchsorted(owner, owner)
        table = np.full((designs, nth.max(initial=-1) + 1, SAMPLES), np.nan)
        table[owner, nth] = self.samples()[order]
        return table.reshape(designs, -1)


def approaches(group: Group, angles: Array) -> Approaches:
    """Return the narrow approaches of a group's designs that lie between crank angles (design, sample) [degree]."""
    rows = np.repeat(np.arange(len(angles)), angles.shape[1])
    names = group.scene.approaches()
    values = [group.values(pair, rows, angles.ravel()).reshape(2, *angles.shape) for pair in names]
    return joined([_narrow(group, angles, pair, *both) for pair, both in zip(names, values, strict=True)])


def approaches_of_turns(group: Group) -> Approaches:
    """Return the narrow approaches in the whole period of a group's designs; in narrow near-toggles they may hide."""
    even, names = np.arange(0.0, group.scene.period, STEP), group.scene.approaches()
    values = [positions_at(group.scene, pair, group.designs, even) for pair in names]
    angles = np.broadcast_to(even, (len(group.designs), len(even)))
    return joined([_narrow(group, angles, pair, *both) for pair, both in zip(names, values, strict=True)])


def joined(parts: list[Approaches]) -> Approaches:
    return Approaches(*map(np.concatenate, zip(*parts, strict=True)))


def _narrow(group: Group, angles: Array, names: tuple[str, str], slopes: Array, widths: Array) -> Approaches:
    """Return the approaches between angles (design, sample) at which l·dl/dθ2 and the width are known."""
    slope, width = names
    rising, narrower = np.roll(slopes, -1, axis=1), np.minimum(widths, np.roll(widths, -1, axis=1))
    steps = np.mod(np.roll(angles, -1, axis=1) - angles, group.scene.period)
    row, k = np.nonzero((slopes < 0.0) & (rising >= 0.0) & (narrower < WIDE + 2.0 * np.radians(steps)))
    ends = (angles[row, k], slopes[row, k]), (angles[row, k] + steps[row, k], rising[row, k])
    angle = crossing(group, slope, row, *ends, STEPS)
    (there,) = group.values((width,), row, angle)
    narrow = there < WIDE
    return Approaches(row[narrow], angle[narrow], np.maximum(np.degrees(there[narrow]), NARROWEST))


def with_narrow_approaches(scene: Scene, threads: int | None = None) -> Array:
    """Return the designs that may have narrow approaches: some sample says so, or near-toggles hide what samples say.

    For scenes in which no load changes with the angle.
    """
    index, sizes = scene.mechanism.index, scene.inputs.sizes
    grid = crank_grid(round(scene.period / STEP), scene.period, index)
    widths = tuple(width for _, width in scene.approaches())
    request = plan(scene.table, widths, scene.inputs.forms)
    least = {width: Reduction("least_sample", width) for width in widths}
    reduced = reduce_rows(request, tuple(least.values()), scene.inputs.fields, grid, sizes, threads)
    pinches = compute(scene, crank_grid(1, scene.period, index), (NEAR_WIDTH, FAR_WIDTH), threads)
    near = [_below(reduced[least[width]][0], WIDE + np.radians(STEP)) for width in widths]
    pinched = [_below(field, NARROW_PINCH) for field in pinches.values()]
    return np.flatnonzero(_anywhere([*near, *pinched], sizes))


def _below(field: Field, bound: float) -> Field:
    return Field(field.dims, ~(field.values >= bound))


def _anywhere(fields: list[Field], sizes: Mapping[str, int]) -> Array:
    """Return for each design whether any of these fields holds there."""
    shape = tuple(sizes.values())
    return np.any([np.broadcast_to(laid(field, tuple(sizes)), shape) for field in fields], axis=0)
