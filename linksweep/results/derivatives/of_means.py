"""Derivatives of means over time, by the quadrature of the means themselves.

With the pace v of the crank (or of a car), the mean of q over time is M = ∫ q/|v| dθ / ∫ 1/|v| dθ, and

    dM/dp = mean(∂q/∂p) − mean((q − M)·∂v/∂p/v)        rms: d√M/dp = dM/dp / (2√M), M the mean of q²

Where q jumps at an angle that moves with the parameter, the jump adds (q(θ*−) − q(θ*+))·dθ*/dp over the period.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from linksweep.engine.run import Field
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.results.compute import changing_pace
from linksweep.results.derivatives.samples import pairs_over
from linksweep.results.peak_search.quadrature import Integrand, integrals
from linksweep.scene.derivatives.differentiated import Differentiated, differentiated
from linksweep.scene.derivatives.sloped import Sloped, slopes_of, value_of
from linksweep.scene.dimensions import aligned
from linksweep.scene.inputs import as_field
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene

BESIDE = 1e-7
"""Distance from a jump [degree] at which its two sides are taken."""


def mean_derivatives(
    scene: Scene, name: str, power: int, to: tuple[str, ...], threads: int | None = None
) -> dict[str, Field]:
    """Return the derivatives of the mean over time of a power (1 or 2) of a quantity, by parameter."""
    pace = changing_pace(scene.at_one_angle)
    own = differentiated(scene, (name, *pace), to)
    integrands = {"time": Integrand((name, *pace), _time), "mean": Integrand((name, *pace), partial(_weighted, power))}
    for path in to:
        names = (name, derivative_of(name, path), *pace)
        integrands[f"slope {path}"] = Integrand(names, partial(_slope, power))
        if pace:
            names = (name, *pace, derivative_of(pace[0], path))
            integrands[f"pace {path}"] = Integrand(names, partial(_of_pace, power))
            integrands[f"time {path}"] = Integrand(names, partial(_of_pace, 0))
    total = integrals(own, integrands, threads=threads)
    jumped = {} if pace else _jumped(own, name, power, to)
    results = {}
    for path in to:
        parts = [field for key, field in total.items() if key in ("mean", "time") or key.endswith(f" {path}")]
        dims = tuple(dict.fromkeys(dim for field in (*parts, *jumped.values()) for dim in field.dims))
        number = {key: aligned(field, dims) for key, field in total.items() if {*field.dims} <= {*dims}}
        time = number["time"]
        with np.errstate(all="ignore"):
            slope = number[f"slope {path}"] / time
            if path in jumped:
                slope = slope + aligned(jumped[path], dims) / time
            if pace:
                mean = number["mean"] / time
                slope = slope - (number[f"pace {path}"] - mean * number[f"time {path}"]) / time
        sizes = own.at_one_angle.inputs.sizes
        results[path] = Field(dims, np.broadcast_to(slope, tuple(sizes[dim] for dim in dims)))
    return results


def moving_unknown(scene: Scene, to: tuple[str, ...]) -> bool:
    """Return whether forces jump at angles that a parameter may move in a way that is not known."""
    own = differentiated(scene, (), to)
    searched = any(limit.zeros == "jump" for limit in scene.table.limits or ()) and scene.mechanism.rubs
    located = any(not isinstance(jump, Sloped | float) for jump in own.moving_jumps)
    weighted = bool(changing_pace(scene.at_one_angle)) and any(isinstance(jump, Sloped) for jump in own.moving_jumps)
    return searched or located or weighted


def _jumped(scene: Differentiated, name: str, power: int, to: tuple[str, ...]) -> dict[str, Field]:
    """Return what the jumps that a parameter moves add to the derivative of the integral over the angle [degree]."""
    pairs = pairs_over(scene, tuple(scene.at_one_angle.inputs.sizes))
    turns = round(scene.period / scene.mechanism.period)
    sums = {path: np.zeros(len(pairs.designs)) for path in to}
    for jump in scene.moving_jumps:
        if not isinstance(jump, Sloped):
            continue
        angle = pairs.numbers(as_field(value_of(jump)))
        for turn in range(turns):
            places = (angle + turn * scene.mechanism.period + side for side in (-BESIDE, BESIDE))
            before, after = (pairs.at((name,), place)[0] ** power for place in places)
            for path, slope in slopes_of(jump).items():
                sums[path] += np.nan_to_num(before - after) * pairs.numbers(as_field(slope))
    return {path: pairs.field(total) for path, total in sums.items()} if scene.moving_jumps else {}


def _weighted(power: int, value: Array, pace: Array | float = 1.0) -> Array:
    return np.where(np.isfinite(value / pace), value**power / np.abs(pace), 0.0)


def _time(value: Array, pace: Array | float = 1.0) -> Array:
    return np.where(np.isfinite(value / pace), 1.0 / np.abs(pace), 0.0)


def _slope(power: int, value: Array, slope: Array, pace: Array | float = 1.0) -> Array:
    return np.where(np.isfinite(value / pace), power * value ** (power - 1) * slope / np.abs(pace), 0.0)


def _of_pace(power: int, value: Array, pace: Array, slope: Array) -> Array:
    return np.where(np.isfinite(value / pace), value**power * slope / (pace * np.abs(pace)), 0.0)
