"""Derivatives of the time ratio of a link that goes to and fro, from those of the angles at which it turns round.

With φ the crank angle of one way and P the cycle, ρ the time ratio,

    ρ = φ/(P − φ) for φ ≥ P/2        dρ/dφ = P/(P − φ)²
    ρ = (P − φ)/φ for φ < P/2        dρ/dφ = −P/φ²

Where both ways take as long, ρ = 1 is the least that it can be, and has a corner.
"""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr

from linksweep.analysis.design.travel import rate_of
from linksweep.engine.run import Field
from linksweep.results.derivatives.of_zeros import zero_derivatives
from linksweep.scene.scene import Scene

TIME_RATIO = "time_ratio"
EVEN = 1e-9
"""Difference of a time ratio from 1 at which both ways take as long."""


def time_ratio_slopes(
    scene: Scene, position: str, ends: tuple[xr.DataArray, xr.DataArray], to: tuple[str, ...]
) -> tuple[Mapping[str, xr.DataArray], xr.DataArray]:
    """Return the derivatives of the time ratio of a position that turns round at two crank angles [degree], and whether
    it has a corner there; `scene` is the mechanism alone."""
    period = scene.period_of_motion
    first, last = (_angle_slopes(scene, rate_of(position), end, to) for end in ends)
    way = (ends[0] - ends[1]) % period
    slower = xr.where(way >= 0.5 * period, way, period - way)
    steep = xr.where(way >= 0.5 * period, 1.0, -1.0) * period / (period - slower) ** 2
    slopes = {path: steep * (first[path] - last[path]) for path in to}
    even = abs(slower / (period - slower) - 1.0) <= EVEN
    return slopes, even & (sum((abs(slope) for slope in slopes.values()), xr.zeros_like(way)) > EVEN)


def _angle_slopes(scene: Scene, rate: str, at: xr.DataArray, to: tuple[str, ...]) -> dict[str, xr.DataArray]:
    """Return the derivatives [degree] of the crank angles near these at which a rate is zero."""
    pairs, slopes = zero_derivatives(scene, rate, Field(tuple(map(str, at.dims)), at.values), to)
    return {p: xr.DataArray(pairs.field(row).values, dims=pairs.dims) for p, row in zip(to, slopes, strict=True)}
