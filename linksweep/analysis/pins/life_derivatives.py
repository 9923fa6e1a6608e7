"""Derivatives of the life of rolling bearings to parameters of a scene.

With the rotation R = ∫ |dψ| of a pin, the damage D = ∫ F^p |dψ| and the time T = ∫ dt of the crank's way, by the
equations of `linksweep.analysis.pins.bearing_life`,

    P = (D/R)^(1/p)        dP = P/p·(dD/D − dR/R)
    L10 = (C/P)^p          dL10 = −L10·p·dP/P        dL10h = L10h·(dL10/L10 − dR/R + dT/T)
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np
import xarray as xr

from linksweep.analysis.pins.bearing import Bearing
from linksweep.analysis.pins.bearing_life import rotation_under_load
from linksweep.chains.between_links import force_name
from linksweep.results.derivatives.of_integrals import Integral, Integrated, integral_derivatives
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene

LIFE = ("equivalent_load", "L10", "L10h")
"""Results of a bearing that have derivatives."""


def life(scene: Scene, pin: str, bearing: Bearing) -> dict[str, xr.DataArray]:
    """Return the life of a bearing in a pin, and its status, each over the design dims."""
    forces = {pin: force_name(*scene.mechanism.pins[pin])}
    rotation = rotation_under_load(scene, forces, {pin: bearing.exponent})
    return rotation.life(pin, bearing.capacity, bearing.exponent)


def life_derivatives(
    scene: Scene, word: str, pin: str, bearing: Bearing, to: tuple[str, ...]
) -> tuple[dict[str, xr.DataArray], Mapping[str, xr.DataArray]]:
    """Return the life of a bearing in a pin, and the derivatives of one of its `LIFE` to parameters."""
    results = life(scene, pin, bearing)
    total = integral_derivatives(scene, _integrals(scene, pin, bearing.exponent), to)
    slopes = {path: results[word] * _relative(word, total, path, bearing.exponent) for path in to}
    return results, slopes


def _relative(word: str, total: Integrated, path: str, exponent: float) -> xr.DataArray:
    """Return the derivative of a life to a parameter, relative to that life."""
    with np.errstate(all="ignore"):
        of = {name: total.slopes[name, path] / value for name, value in total.values.items()}
    life = of["rotation"] - of["damage"]
    return {"equivalent_load": -life / exponent, "L10": life, "L10h": life - of["rotation"] + of["time"]}[word]


def _integrals(scene: Scene, pin: str, exponent: float) -> dict[str, Integral]:
    """Return the integrals of a bearing's life over the crank angle."""
    force = str(scene.table.quantity[force_name(*scene.mechanism.pins[pin])].squared)
    turning = f"omega_{pin}", "omega2"
    return {
        "rotation": Integral(turning, _turn, _slope_of_turn),
        "damage": Integral((*turning, force), partial(_damage, exponent), partial(_slope_of_damage, exponent)),
        "time": Integral(turning, _time, _slope_of_time),
    }


def _turn(speed: Array, omega2: Array) -> Array:
    return abs(speed / omega2)


def _slope_of_turn(speed: Array, omega2: Array, speed_slope: Array, omega2_slope: Array) -> Array:
    """Return the slope of |dψ/dθ|: to omega2 it is 0, of which the slopes of the two speeds leave rounding errors."""
    return np.sign(speed / omega2) * np.where(omega2_slope == 0.0, speed_slope, 0.0) / omega2


def _damage(exponent: float, speed: Array, omega2: Array, squared: Array) -> Array:
    """Return F^p |dψ/dθ|, from F²."""
    return squared ** (0.5 * exponent) * _turn(speed, omega2)


def _slope_of_damage(exponent: float, speed: Array, omega2: Array, squared: Array, *slopes: Array) -> Array:
    *of_turning, of_squared = slopes
    steep = 0.5 * exponent * squared ** (0.5 * exponent - 1.0) * of_squared
    return steep * _turn(speed, omega2) + squared ** (0.5 * exponent) * _slope_of_turn(speed, omega2, *of_turning)


def _time(speed: Array, omega2: Array) -> Array:
    return 1.0 / abs(omega2) + 0.0 * speed


def _slope_of_time(speed: Array, omega2: Array, speed_slope: Array, omega2_slope: Array) -> Array:
    return -omega2_slope / (omega2 * abs(omega2)) + 0.0 * speed
