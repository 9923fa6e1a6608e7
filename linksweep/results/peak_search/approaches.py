"""Find the closest approaches of the ends of springs and dampers: the direction of their force turns quickly there.

Where the ends p and q pass each other at a distance l0, the line through them turns by 180 degrees, nearly all of it
within a few widths w = l0/|d(q − p)/dθ2| of crank angle. Even samples may miss that. Half the slope of the squared
distance, l·dl/dθ2, rises through 0 there and is as smooth as the motion of the links, however narrow the approach: so
the approach is the zero of that slope.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linksweep.engine.kernel.writer import Reduction
from linksweep.engine.peaks.roles import WIDTHS
from linksweep.engine.roots import roots
from linksweep.engine.run import Field, reduce_rows
from linksweep.engine.trace.plan import plan
from linksweep.results.compute import compute
from linksweep.results.peak_search.between import positions_at
from linksweep.results.peak_search.groups import Group
from linksweep.scene.dimensions import aligned
from linksweep.scene.pairs import Array, joined
from linksweep.scene.scene import Scene

WIDE = np.radians(20.0)
"""Width from which on an approach is as smooth as the motion of the links and needs no samples of its own [rad]."""
STEP = 2.0
"""Step of the even samples that show which designs have narrow approaches [degree]."""
NARROW_NEAR_TOGGLE = 0.1
"""Width of a near-toggle below which an approach beside it may hide between even samples [rad]."""
NARROWEST = 1e-9
"""Least width by which samples about an approach are graded [degree]."""
REACH = 30.0
"""Distance from an approach to the outermost samples about it, far enough to reach the even ones [degree]."""
SAMPLES = 56
"""Samples about each approach, dense within its width."""


class Approaches(NamedTuple):
    """Closest approaches: the design (by its row in a group), crank angle and width [degree] of each."""

    row: Array
    angle: Array
    width: Array

    def samples(self) -> Array:
        """Return crank angles (approach, sample) [degree] on a sinh grade about each approach."""
        grade = np.linspace(-1.0, 1.0, SAMPLES) * np.arcsinh(REACH / self.width)[:, None]
        return self.angle[:, None] + self.width[:, None] * np.sinh(grade)


def approaches(group: Group, angles: Array, ends_meet: bool = True) -> Approaches:
    """Return the narrow approaches between the crank angles (design, sample) [degree] of a group's designs.

    `ends_meet` is True where the last angle of a design is followed by its first, as on a whole turn.
    """
    rows = np.repeat(np.arange(len(angles)), angles.shape[1])
    names = group.scene.approaches()
    values = [group.values(pair, rows, angles.ravel()).reshape(2, *angles.shape) for pair in names]
    return joined([_narrow(group, angles, pair, both, ends_meet) for pair, both in zip(names, values, strict=True)])


def approaches_of_turns(group: Group) -> Approaches:
    """Return the narrow approaches between even samples of the whole period of a group's designs.

    An approach beside a narrow near-toggle may be missing: links move quickly there, between two samples.
    """
    even, names = np.arange(0.0, group.scene.period, STEP), group.scene.approaches()
    values = [positions_at(group.scene, pair, group.designs, even) for pair in names]
    angles = np.broadcast_to(even, (len(group.designs), len(even)))
    return joined([_narrow(group, angles, pair, both) for pair, both in zip(names, values, strict=True)])


def _narrow(group: Group, angles: Array, names: tuple[str, str], both: Array, ends_meet: bool = True) -> Approaches:
    """Return the narrow approaches of one spring or damper from its l·dl/dθ2 and width at angles (design, sample)."""
    (slope, width), (slopes, widths) = names, both
    rising, narrower = np.roll(slopes, -1, axis=1), np.minimum(widths, np.roll(widths, -1, axis=1))
    steps = np.mod(np.roll(angles, -1, axis=1) - angles, group.scene.period)
    passing = (slopes < 0.0) & (rising >= 0.0) & (narrower < WIDE + 2.0 * np.radians(steps))
    passing[:, -1] &= ends_meet
    row, k = np.nonzero(passing)
    ends = np.stack([angles[row, k], angles[row, k] + steps[row, k]])
    angle = roots(group.of(slope, row), ends, np.stack([slopes[row, k], rising[row, k]]))
    (radians,) = group.values((width,), row, angle)
    narrow = radians < WIDE
    return Approaches(row[narrow], angle[narrow], np.maximum(np.degrees(radians[narrow]), NARROWEST))


def with_narrow_approaches(scene: Scene) -> Array:
    """Return the designs that may have narrow approaches, for a scene whose loads do not change with the angle.

    A design may have one if an even sample lies in or beside it, or if a near-toggle is narrow enough to hide it.
    """
    sizes = scene.inputs.sizes
    grid = scene.grid(round(scene.period / STEP))
    widths = tuple(width for _, width in scene.approaches())
    request = plan(scene.table, widths, scene.inputs.forms)
    least = {width: Reduction("least_sample", width) for width in widths}
    reduced = reduce_rows(request, tuple(least.values()), scene.inputs.fields, grid, sizes)
    near_toggles = compute(scene, scene.grid(1), WIDTHS)
    # at a sample δ away from an approach the width is √(w² + δ²), which is at most w + δ
    seen = [_below(reduced[least[width]][0], WIDE + np.radians(STEP)) for width in widths]
    hidden = [_below(field, NARROW_NEAR_TOGGLE) for field in near_toggles.values()]
    dims, shape = tuple(sizes), tuple(sizes.values())
    return np.flatnonzero(np.any([np.broadcast_to(aligned(field, dims), shape) for field in (*seen, *hidden)], axis=0))


def _below(field: Field, limit: float) -> Field:
    return Field(field.dims, ~(field.values >= limit))  # a NaN counts as below
