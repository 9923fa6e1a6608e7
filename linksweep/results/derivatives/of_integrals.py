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
from linksweep.results.derivatives.jumps import Jumps, known_jumps
from linksweep.results.derivatives.samples import Pairs, pairs_over
from linksweep.results.derivatives.sides import BESIDE
from linksweep.results.peak_search.quadrature import Integrand, integrals
from linksweep.scene.derivatives.differentiated import differentiated
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene


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
    pairs = pairs_over(own, tuple(own.at_one_angle.inputs.sizes))
    jumps = known_jumps(pairs)
    for key, integral in requests.items() if len(jumps.angles) else ():
        for path, jumped in _jumped(pairs, integral, jumps).items():
            total[key, path] = total[key, path] + jumped
    values = {key: total[key, ""] for key in requests}
    return Integrated(values, {key: array for key, array in total.items() if key[1]})


def _known(function: Callable[..., Array], *values: Array) -> Array:
    with np.errstate(all="ignore"):
        heights = function(*values)
    return np.where(np.isfinite(heights), heights, 0.0)


def _jumped(pairs: Pairs, integral: Integral, jumps: Jumps) -> dict[str, xr.DataArray]:
    """Return what the jumps that parameters move add to the derivatives of an integral, by path."""
    sums = np.zeros((len(pairs.scene.to), len(pairs.designs)))
    for angle, moves in zip(jumps.angles, jumps.moves, strict=True):
        before, after = (_known(integral.height, *pairs.at(integral.names, angle + s)) for s in (-BESIDE, BESIDE))
        drop = before - after
        sums += drop * moves
    fields = {path: pairs.field(total) for path, total in zip(pairs.scene.to, sums, strict=True)}
    return {path: xr.DataArray(field.values, dims=field.dims) for path, field in fields.items()}
