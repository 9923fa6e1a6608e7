"""Derivatives of integrals over the continuous revolution, by the quadrature of the integrals themselves.

Of quantities q1, q2, … with a function h, and angles θ* that move with the parameter p, at which h jumps,

    I = ∫ h(q1, q2, …) dθ        dI/dp = ∫ Σ ∂h/∂qk·∂qk/∂p dθ + Σ (h(θ*−) − h(θ*+))·dθ*/dp
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

import numpy as np
import xarray as xr

from linksweep.engine.trace.derivatives import derivative_of
from linksweep.results.derivatives.half_turns import half_turns
from linksweep.results.derivatives.samples import Pairs, pairs_over
from linksweep.results.peak_search.quadrature import Integrand, integrals
from linksweep.scene.derivatives.differentiated import Differentiated, differentiated
from linksweep.scene.derivatives.sloped import Sloped, slopes_of, value_of
from linksweep.scene.inputs import as_field
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene

BESIDE = 1e-7
"""Distance from a jump [degree] at which its two sides are taken."""


class Integral(NamedTuple):
    """An integral over the crank angle: its integrand, a function of some quantities, and the slope of that, a function
    of the quantities and then of their slopes. Where they are not known both count as 0."""

    names: tuple[str, ...]
    height: Callable[..., Array]
    slope: Callable[..., Array]


class Integrated(NamedTuple):
    """Integrals over the angle [degree] by name, and their derivatives by name and path."""

    values: Mapping[str, xr.DataArray]
    slopes: Mapping[tuple[str, str], xr.DataArray]


def integral_derivatives(scene: Scene, requests: Mapping[str, Integral], to: tuple[str, ...]) -> Integrated:
    """Return integrals over the cycle with their derivatives to parameters, each over the design dims."""
    every = tuple(dict.fromkeys(name for integral in requests.values() for name in integral.names))
    own = differentiated(scene, every, to)
    integrands: dict[tuple[str, str], Integrand] = {}
    for key, integral in requests.items():
        integrands[key, ""] = Integrand(integral.names, partial(_known, integral.height))
        for path in to:
            slopes = tuple(derivative_of(name, path) for name in integral.names)
            integrands[key, path] = Integrand((*integral.names, *slopes), partial(_known, integral.slope))
    total = {key: xr.DataArray(field.values, dims=field.dims) for key, field in integrals(own, integrands).items()}
    moving = known_jumps(own)
    for key, integral in requests.items():
        for path, jumped in _jumped(own, integral, moving).items():
            total[key, path] = total[key, path] + jumped
    values = {key: total[key, ""] for key in requests}
    return Integrated(values, {key: array for key, array in total.items() if key[1]})


def known_jumps(scene: Differentiated) -> list[Sloped]:
    """Return the crank angles [degree] at which forces jump, and which parameters move in a way that is known."""
    return [*(jump for jump in scene.moving_jumps if isinstance(jump, Sloped)), *half_turns(scene)]


def moving_unknown(scene: Scene, to: tuple[str, ...]) -> bool:
    """Return whether forces jump at angles that a parameter may move in a way that is not known."""
    own = differentiated(scene, (), to)
    searched = any(limit.zeros == "jump" for limit in scene.table.limits or ()) and scene.mechanism.rubs
    return searched or any(not isinstance(jump, Sloped | float) for jump in own.moving_jumps)


def _known(function: Callable[..., Array], *values: Array) -> Array:
    with np.errstate(all="ignore"):
        heights = function(*values)
    return np.where(np.isfinite(heights), heights, 0.0)


def _jumped(scene: Differentiated, integral: Integral, moving: list[Sloped]) -> dict[str, xr.DataArray]:
    """Return what the jumps that parameters move add to the derivatives of an integral, by path."""
    if not moving:
        return {}
    pairs = pairs_over(scene, tuple(scene.at_one_angle.inputs.sizes))
    sums = {path: np.zeros(len(pairs.designs)) for path in scene.to}
    for jump in moving:
        drop = _drop(pairs, integral, pairs.numbers(as_field(value_of(jump))))
        for path, slope in slopes_of(jump).items():
            sums[path] += drop * pairs.numbers(as_field(slope))
    fields = {path: pairs.field(total) for path, total in sums.items()}
    return {path: xr.DataArray(field.values, dims=field.dims) for path, field in fields.items()}


def _drop(pairs: Pairs, integral: Integral, angle: Array) -> Array:
    """Return h(θ*−) − h(θ*+) of each design, all turns of the cycle together."""
    turn = pairs.scene.mechanism.period
    total = np.zeros(len(pairs.designs))
    for k in range(round(pairs.scene.period / turn)):
        sides = (angle + k * turn - BESIDE, angle + k * turn + BESIDE)
        before, after = (_known(integral.height, *pairs.at(integral.names, side)) for side in sides)
        total += before - after
    return total
