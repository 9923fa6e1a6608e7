"""Life of rolling bearings under loads that change while they turn, by integrals over the continuous revolution.

    P = (∫ F^p |dψ| / ∫ |dψ|)^(1/p)      equivalent load over the relative rotation ψ; p = 3 for balls, 10/3 for rollers
    L10 = (C/P)^p                        life that nine of ten reach, in million revolutions
    L10h = L10 · 10⁶ · 2π/∫ |dψ| · ∫ dt  in time, with dt = dθ2/|ω2|

Where F is unbounded, so is the damage ∫ F^p |dψ|, and the life is 0. At a toggle, δ before the limit of θ2,
the sine of the transmission angle μ goes with √δ: F grows as 1/μ under loads, as μ^-4 with inertia. The pins of coupler
and rocker turn by |dψ| ∝ dμ, the crank's by |dψ| ∝ dδ ∝ μ dμ, so that ∫ F^p |dψ| ≥ ∫ μ^(1-p) dμ, which diverges for
p ≥ 2. Where the driven link stands still, or friction wedges, F grows as 1/δ, |dψ| ∝ dδ, or δ dδ at the pin that stands
still: ∫ δ^(1-p) dδ diverges as well. So every unbounded load counts, however short.

Sources: ISO 281 (basic rating life); variable loads by the linear damage rule of A. Palmgren and M. A. Miner, as in R.
G. Budynas and J. K. Nisbett, Shigley's Mechanical Engineering Design, chapter "Rolling-Contact Bearings", and C. R.
Mischke in Standard Handbook of Machine Design, 3rd ed., section 18.7. A journal that turns to and fro counts with the
whole angle that it turns, the simplest of the rules that O. Menck and M. Stammler review (Wind Energy Science 9 (2024)
777): swings so small that the rolling elements' paths do not overlap want more care.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.results.peak_search.paths import Part
from linksweep.results.peak_search.quadrature import Integrand, integrals
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene

MILLION = 1e6
MEANINGS = ("ok", "partial_revolution", "nothing_solved", "unbounded_load", "no_rotation")
OK, PARTIAL, NOTHING, UNBOUNDED, STANDING = range(len(MEANINGS))
WHOLE = 1.0 - 1e-9
"""Share of the crank's way that must be ok for a whole revolution."""
LARGEST = 1e300


class Rotation(NamedTuple):
    """Rotation of the pins under their loads on the crank's way.

    `way` [degree] is the crank's rotation, `solved` [degree] the part of it that is ok; `time` [s] and, by pin,
    `rotation` [degree] and `damage` [N^p degree] are integrals over that part.
    """

    way: float
    solved: xr.DataArray
    time: xr.DataArray
    rotation: Mapping[str, xr.DataArray]
    damage: Mapping[str, xr.DataArray]

    def life(self, pin: str, capacity: Any, exponent: float) -> dict[str, xr.DataArray]:
        """Return rotation, equivalent load, life (NaN without a capacity) and its status of the bearing in a pin."""
        rotation = self.rotation[pin].where(self.solved > 0.0)
        mean = (self.damage[pin] / rotation.where(rotation > 0.0)).where(rotation > 0.0)
        equivalent = mean ** (1.0 / exponent)
        life = ((np.nan if capacity is None else capacity) / equivalent) ** exponent
        hours = life * MILLION / (rotation / 360.0) * self.time / 3600.0
        status = self._status(pin)
        return {"rotation": rotation, "equivalent_load": equivalent, "L10": life, "L10h": hours, "life_status": status}

    def _status(self, pin: str) -> xr.DataArray:
        rotation, damage = self.rotation[pin], self.damage[pin]
        status = xr.where(self.solved < WHOLE * self.way, PARTIAL, OK)
        status = xr.where(rotation > 0.0, status, STANDING)
        status = xr.where(np.isinf(damage), UNBOUNDED, status)
        return xr.where(self.solved > 0.0, status, NOTHING).astype(np.int8)


def rotation_under_load(
    scene: Scene | MultiCylinder, forces: Mapping[str, str], exponents: Mapping[str, float], part: Part | None = None
) -> Rotation:
    """Integrate rotation and damage of each pin over the whole cycle or a part of a turn [degree].

    Parameters
    ----------
    forces : names of the pins' forces, by pin
    exponents : p of their bearings, by pin
    """
    solved, time = _integrand(np.ones_like, "omega2"), _integrand(_time, "omega2")
    turns = {pin: _integrand(_turn, f"omega_{pin}", "omega2") for pin in forces}
    damages = {
        pin: _integrand(partial(_damage, exponents[pin]), f"omega_{pin}", "omega2", force)
        for pin, force in forces.items()
    }
    every = (solved, time, *turns.values(), *damages.values())
    totals = integrals(scene, dict(enumerate(every)), part)
    arrays = [xr.DataArray(field.values, dims=field.dims) for field in totals.values()]
    of_pins = (dict(zip(forces, arrays[k:], strict=False)) for k in (2, 2 + len(forces)))
    return Rotation(scene.period if part is None else part[1] - part[0], arrays[0], arrays[1], *of_pins)


def _integrand(height: Callable[..., Array], *names: str) -> Integrand:
    return Integrand(("status", *names), partial(_where_ok, height))


def _where_ok(height: Callable[..., Array], status: Array, *values: Array) -> Array:
    heights = height(*values)
    return np.where((status == 0.0) & ~np.isnan(heights), np.minimum(heights, LARGEST), 0.0)


def _time(omega2: Array) -> Array:
    return np.radians(1.0) / np.abs(omega2)


def _turn(speed: Array, omega2: Array) -> Array:
    return np.abs(speed / omega2)


def _damage(exponent: float, speed: Array, omega2: Array, force: Array) -> Array:
    return force**exponent * _turn(speed, omega2)
