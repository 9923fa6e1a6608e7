"""Crank angles at which torsion springs pass half a turn of twist, where their torque jumps, with derivatives.

Between crank and ground they have a closed form (`linksweep.scene.loads.torsion`). Between other links they are found
where the twist jumps between samples; those that come twice between two of them are not.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from linksweep.results.derivatives.of_zeros import zero_angles
from linksweep.results.derivatives.samples import pairs_over
from linksweep.scene.derivatives.differentiated import ANGLE, Differentiated, Jump, differentiated
from linksweep.scene.derivatives.sloped import Sloped
from linksweep.scene.loads.torsion import TorsionSpring
from linksweep.scene.pairs import Array, by_row

STEP = 0.5
"""Distance of the samples [degree]."""


def half_turns(scene: Differentiated) -> list[Jump]:
    """Return the crank angles [degree] at which springs without a closed form pass 180 degrees of twist, over
    the whole cycle; NaN for designs that have fewer."""
    jumps: list[Jump] = []
    for k, load in enumerate(scene.loads, 1):
        if isinstance(load, TorsionSpring) and not load.jumps(scene.mechanism):
            jumps += [Jump(k, angle) for angle in _half_turns_of(scene, f"load{k}_twist")]
    return jumps


def _half_turns_of(scene: Differentiated, twist: str) -> list[Sloped]:
    """Return the crank angles at which one twist passes 180 degrees."""
    own = differentiated(scene.plain, (twist,), (*scene.to, ANGLE))
    pairs = pairs_over(own, tuple(own.at_one_angle.inputs.sizes))
    count, angles = len(pairs.designs), np.arange(0.0, scene.period + STEP, STEP)
    (values,) = pairs.some(np.repeat(np.arange(count), len(angles))).at((twist,), np.tile(angles, count))
    values = values.reshape(count, len(angles))
    design, k = np.nonzero(np.abs(np.diff(values)) > 180.0)
    before, after = _excess(values[design, k]), _excess(values[design, k + 1])
    jumps: list[Sloped] = []
    for near in by_row(design, angles[k] + STEP * before / (before - after), count).T:
        at, slopes = zero_angles(pairs, twist, near, scene.to, _excess)
        moves = np.where(np.isnan(at), 0.0, slopes)
        angle, *rows = (xr.Variable(*pairs.field(row)) for row in (at, *moves))
        jumps.append(Sloped(angle, dict(zip(scene.to, rows, strict=True))))
    return jumps


def _excess(twist: Array) -> Array:
    """Return by how much a twist is beyond 180 degrees."""
    return np.mod(twist, 360.0) - 180.0
