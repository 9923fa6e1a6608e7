"""Derivatives of exact peaks to parameters, at the angle of each peak.

Where a quantity q(θ, p) has its largest value within a smooth piece, its angle θ* moves with the parameter p, but the
value only feels p itself, because ∂q/∂θ = 0 there:

    d(max q)/dp = ∂q/∂p at θ*        (the envelope theorem; J. M. Danskin, The Theory of Max-Min, 1967)

An error δ of the angle enters as δ·∂²q/∂θ∂p. So the angle of the search is polished by secants of ∂q/∂θ. Where that
slope is not zero, the peak lies at a jump or a kink. Where that stays at its angle, as the break of a load, or has a
closed form, as a dead centre, the derivative is one-sided:

    d(max q)/dp = ∂q/∂p + ∂q/∂θ·dθ*/dp

It is not known at other jumps that move and at an end of the motion, and there is none of one of two equal rises that
change differently. A status says which.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from linksweep.engine.run import Field
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.results.derivatives.samples import Pairs, pairs_over
from linksweep.scene.derivatives.differentiated import ANGLE, differentiated
from linksweep.scene.derivatives.sloped import Sloped, slopes_of, value_of
from linksweep.scene.inputs import as_field
from linksweep.scene.pairs import Array, in_period
from linksweep.scene.scene import Scene

MEANINGS = ("ok", "tie", "moving_jump", "unbounded", "no_peak")
"""Status of the derivatives of a peak."""
OK, TIE, JUMP, UNBOUNDED, NONE = range(len(MEANINGS))
STEP = 1e-7
"""First step of the secants [rad]."""
SECANTS = 4
MOST = 1e-5
"""Largest distance of the polished angle from that of the search [rad]."""
SETTLED = 1e-9
"""Step of the last secant [rad] below which a peak counts as smooth."""
BESIDE = 1e-6
"""Distance from a jump [degree] at which one-sided derivatives are taken."""
EVEN = 720
"""Even samples of a turn among which rivals of a peak are looked for."""
EQUAL = 1e-10
"""Difference of two rises that are equal, relative to the peak."""
ALIKE = 1e-8
"""Difference of two derivatives that are alike, relative to the largest of all."""


class PeakDerivatives(NamedTuple):
    """Derivatives of a signal's peaks: (parameter, design) over the designs' dims, and the status of each design; where
    that is not ok they are those of one rise, or of one side."""

    pairs: Pairs
    angle: Array
    slopes: Array
    status: Array


def peak_derivatives(
    scene: Scene, name: str, angle: Field, value: Field, to: tuple[str, ...], largest: bool = True
) -> PeakDerivatives:
    """Return the derivatives of a quantity's largest (or least) values, at the angles of a search.

    Parameters
    ----------
    scene : scene of any number of designs
    name : quantity, of a magnitude its square
    angle : angles [degree] of the extremes, over design dims
    value : the extremes
    to : paths of the parameters
    largest : False for least values
    """
    own = differentiated(scene, (name,), (*to, ANGLE))
    pairs = pairs_over(own, angle.dims)
    at, peak = pairs.numbers(angle), pairs.numbers(value)
    sign = 1.0 if largest else -1.0
    polished, smooth = _polished(pairs, name, at)
    held, jumps, moves = _at_jumps(pairs, at, to)
    smooth &= ~jumps
    place = np.where(smooth, polished, _side(pairs, name, at, peak))
    slopes = pairs.at(tuple(derivative_of(name, path) for path in to), place)
    (steep,) = pairs.at((derivative_of(name, ANGLE),), place)
    slopes = np.where(smooth, slopes, slopes + steep * moves)
    status = np.where(smooth | held, OK, JUMP)
    tied = _tied(pairs, name, to, place, peak, sign, slopes)
    status = np.where(tied, TIE, status)
    status = np.where(np.isinf(peak), UNBOUNDED, status)
    status = np.where(np.isnan(peak) | np.isnan(at), NONE, status)
    return PeakDerivatives(pairs, place, slopes, status)


def turning_point_derivatives(scene: Scene, name: str, angle: Field, to: tuple[str, ...]) -> tuple[Pairs, Array, Array]:
    """Return a quantity, and its derivatives (parameter, design), where it turns round near these angles [degree]."""
    pairs = pairs_over(differentiated(scene, (name,), (*to, ANGLE)), angle.dims)
    place, _ = _polished(pairs, name, pairs.numbers(angle))
    value, *slopes = pairs.at((name, *(derivative_of(name, path) for path in to)), place)
    return pairs, value, np.array(slopes).reshape(len(to), len(value))


def _polished(pairs: Pairs, name: str, angles: Array) -> tuple[Array, Array]:
    """Return angles [degree] where ∂q/∂θ is zero, from near ones, and whether they are."""
    slope = (derivative_of(name, ANGLE),)
    step = np.degrees(STEP)
    before, at = angles + step, angles
    (g_before,), (g,) = pairs.at(slope, before), pairs.at(slope, at)
    flat = (g == 0.0) & (g_before == 0.0)
    last = np.full(len(angles), np.inf)
    with np.errstate(all="ignore"):
        for _ in range(SECANTS):
            move = np.where(g == 0.0, 0.0, -g * (at - before) / (g - g_before))
            before, g_before = at, g
            last = np.where(np.isfinite(move), np.abs(move), last)  # 0/0 once it has settled
            at = at + np.where(np.abs(at + move - angles) <= np.degrees(MOST), move, 0.0)
            (g,) = pairs.at(slope, at)
    smooth = flat | (last <= np.degrees(SETTLED))
    return np.where(smooth & ~flat, at, angles), smooth


def _at_jumps(pairs: Pairs, angles: Array, to: tuple[str, ...]) -> tuple[Array, Array, Array]:
    """Return whether each angle is one at which a force jumps or bends, whether that is a jump, and how far (parameter,
    design) a parameter moves it [rad]."""
    scene = pairs.scene
    held, jumps = np.zeros((2, len(angles)), dtype=bool)
    moves = np.zeros((len(to), len(angles)))
    for angle in scene.quick.angles:
        held |= _near(angles, angle, scene.period)
    for jump in scene.moving_jumps:
        if not isinstance(jump, Sloped | float):
            continue
        turn = scene.mechanism.period
        here = _near(angles, np.mod(_over(pairs, value_of(jump)), turn), turn)
        jumps |= here
        for row, path in zip(moves, to, strict=True):
            row[here] = np.radians(_over(pairs, slopes_of(jump).get(path, 0.0)))[here]
    return held | jumps, jumps, moves


def _over(pairs: Pairs, number: Any) -> Array:
    """Return a number for each of the designs."""
    return pairs.numbers(as_field(number))


def _near(angles: Array, place: Any, period: float) -> Array:
    away = in_period(angles - place + 0.5 * period, period) - 0.5 * period
    return np.abs(away) < 10.0 * BESIDE


def _side(pairs: Pairs, name: str, angles: Array, peak: Array) -> Array:
    """Return these angles, or those just beside them on the side where a quantity has its peak."""
    places = np.stack([angles, angles - BESIDE, angles + BESIDE])
    values = np.stack([pairs.at((name,), some)[0] for some in places])
    away = np.nan_to_num(np.abs(values - peak), nan=np.inf)
    return np.take_along_axis(places, np.argmin(away, axis=0)[None], axis=0)[0]


def _tied(pairs: Pairs, name: str, to: tuple[str, ...], place: Array, peak: Array, sign: float, slopes: Array) -> Array:
    """Return where another rise is as high, and changes differently."""
    rival = _rivals(pairs, name, place, sign)
    rows = np.flatnonzero(np.isfinite(rival))
    tied = np.zeros(len(place), dtype=bool)
    if not len(rows):
        return tied
    some = pairs._replace(designs=pairs.designs[rows])
    at, smooth = _settled(some, name, rival[rows])
    (height,) = some.at((name,), at)
    equal = smooth & (np.abs(height - peak[rows]) <= EQUAL * np.abs(peak[rows]))
    other = some.at(tuple(derivative_of(name, path) for path in to), at)
    scale = np.fmax(np.abs(other), np.abs(slopes[:, rows]))
    apart = np.abs(other - slopes[:, rows]) > ALIKE * np.fmax(scale, 1e-300)
    tied[rows] = equal & apart.any(axis=0)
    return tied


def _settled(pairs: Pairs, name: str, angles: Array) -> tuple[Array, Array]:
    """Return the angles of rises from those of a coarse search, by golden steps of polishing."""
    smooth = np.zeros(len(angles), dtype=bool)
    for _ in range(2):
        for _ in range(8):
            angles = _newton(pairs, name, angles)
        polished, smooth = _polished(pairs, name, angles)
        angles = np.where(smooth, polished, angles)
    return angles, smooth


def _newton(pairs: Pairs, name: str, angles: Array) -> Array:
    """Return the angles one step nearer to where ∂q/∂θ is zero, by at most half a sample."""
    slope, step = (derivative_of(name, ANGLE),), 1e-4
    g, after = (pairs.at(slope, some)[0] for some in (angles, angles + step))
    with np.errstate(all="ignore"):
        move = np.clip(-g * step / (after - g), -180.0 / EVEN, 180.0 / EVEN)
    return angles + np.where(np.isfinite(move), move, 0.0)


def _rivals(pairs: Pairs, name: str, place: Array, sign: float) -> Array:
    """Return the angle [degree] of the highest rise beside the peak's own among even samples; NaN for none."""
    scene, count = pairs.scene, len(pairs.designs)
    turns = round(scene.period / scene.mechanism.period)
    samples = (np.arange(EVEN * turns) + 0.5) * (scene.period / (EVEN * turns))
    designs = np.repeat(np.arange(count), len(samples))
    values = sign * pairs.at((name,), np.tile(samples, count), designs)[0].reshape(count, -1)
    low = np.where(np.isnan(values), -np.inf, values)
    before, after = np.roll(low, 1, axis=1), np.roll(low, -1, axis=1)
    step = scene.period / len(samples)
    away = np.abs(in_period(samples - place[:, None] + 0.5 * scene.period, scene.period) - 0.5 * scene.period)
    rises = (low >= before) & (low >= after) & (away > 1.5 * step) & np.isfinite(low)
    with np.errstate(invalid="ignore", divide="ignore"):  # of two samples that are alike
        bend = np.where(np.isfinite(before + after), 2.0 * low - before - after, np.inf)
        height = np.where(rises, low + 0.125 * np.where(bend > 0.0, (after - before) ** 2 / bend, 0.0), -np.inf)
    k = np.argmax(height, axis=1)
    top = np.take_along_axis(height, k[:, None], axis=1)[:, 0]
    (own,) = pairs.at((name,), place)
    close = top >= sign * own - 1e-3 * np.abs(own)
    return np.where(close & np.isfinite(top), samples[k], np.nan)
