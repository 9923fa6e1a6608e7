"""Derivatives of exact peaks to parameters, at the angle of each peak.

Where a quantity q(θ, p) has its largest value within a smooth piece, its angle θ* moves with the parameter p, but the
value only feels p itself, because ∂q/∂θ = 0 there:

    d(max q)/dp = ∂q/∂p at θ*        (the envelope theorem; J. M. Danskin, The Theory of Max-Min, 1967)

An error δ of the angle enters as δ·∂²q/∂θ∂p. So the angle of the search is polished by secants of ∂q/∂θ. Where that
slope is not zero, the peak lies at a jump or a kink. Where that stays at its angle, as the break of a load, or has a
closed form, as a dead centre, the derivative is one-sided:

    d(max q)/dp = ∂q/∂p + ∂q/∂θ·dθ*/dp

It is not known at other jumps that move, and there is none at the end of an arc, a toggle, where slopes are infinite,
nor of two equal rises that change differently, nor at two jumps, or bends, at one angle that a parameter parts. A
status says which.

Two rises are equal where they differ by less than the search may err. Those as high as the peak are found by the search
itself (`linksweep.results.peak_search.rises`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.degrees import signed_distance
from linksweep.engine.quantity import opposite_of
from linksweep.engine.run import Field
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.results.derivatives.samples import Pairs, pairs_over
from linksweep.results.derivatives.sides import bends, unlisted
from linksweep.results.peak_search.along_paths import on_own_side
from linksweep.results.peak_search.rises import at_arc_ends, equal_rises
from linksweep.scene.derivatives.differentiated import ANGLE, differentiated
from linksweep.scene.derivatives.sloped import Sloped, slopes_of, value_of
from linksweep.scene.inputs import as_field
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene

MEANINGS = ("ok", "tie", "moving_jump", "unbounded", "no_peak", "arc_end", "zero_magnitude")
"""Status of the derivatives of a peak, or of a magnitude."""
OK, TIE, JUMP, UNBOUNDED, NONE, ARC_END, ZERO = range(len(MEANINGS))
STEP = 1e-7
"""First step of the secants [rad]."""
SECANTS = 4
MOST = 1e-5
"""Largest distance of the polished angle from that of the search [rad]."""
SETTLED = 1e-9
"""Step of the last secant [rad] below which a peak counts as smooth."""
BESIDE = 1e-6
"""Distance within which angles are the same [degree]."""
SIDE = 1e-8
"""Distance from a jump [degree] at which its two sides are compared."""
SAME = 1e-8
"""Difference of a peak and its polished one, relative to it, beyond which they are not the same."""
APART = 1e-3
"""Least distance of two rises [degree]: those on the two sides of a kink are one."""
EQUAL = 1e-10
"""Difference of two rises that are equal, relative to the peak."""
ALIKE = 1e-8
"""Difference of two derivatives that are alike, relative to the larger one."""
ROUNDING = 1e-12
"""Rounding of a derivative, relative to the peak over the parameter's size."""
RADIAN = 180.0 / np.pi
"""Size of all parameters that are angles [degree]: sines and cosines change as fast at 0 as elsewhere."""


class PeakDerivatives(NamedTuple):
    """Derivatives of a signal's peaks: (parameter, design) over the designs' dims, which of them differ between equal
    rises, and the status of each design. Where that is not ok they are those of one rise, or of one side."""

    pairs: Pairs
    slopes: Array
    corners: Array
    status: Array


class AtJumps(NamedTuple):
    """Jumps and bends at an angle of each design: whether there are any, and all move in a way that is known; whether
    some may be moved; their place [degree], NaN for none; and how far, least and most, parameters move them (parameter,
    design) [rad]."""

    known: Array
    jumps: Array
    place: Array
    least: Array
    most: Array


class RiseDerivatives(NamedTuple):
    """Derivatives of extremes (parameter, design), which of them differ between jumps at one angle, and whether those
    of a design are known; where they are not, as at an angle that stays, they are those at the angle itself."""

    slopes: Array
    corners: Array
    known: Array


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
    slopes, corners, known = rise_derivatives(pairs, name, to, at, peak)
    corners |= _corners(pairs, name, to, at, peak, largest, slopes) | _across_jumps(pairs, name, to, at, peak)
    status = np.where(known, np.where(corners.any(axis=0), TIE, OK), JUMP)
    at_ends = at_arc_ends(own.plain, pairs.designs, at, 10.0 * BESIDE)
    status = np.where(at_ends | np.isnan(slopes).any(axis=0), ARC_END, status)  # or a load's position counts from there
    status = np.where(np.isinf(peak), UNBOUNDED, status)
    status = np.where(np.isnan(peak) | np.isnan(at), NONE, status)
    return PeakDerivatives(pairs, slopes, corners, status)


def rise_derivatives(pairs: Pairs, name: str, to: tuple[str, ...], angles: Array, heights: Array) -> RiseDerivatives:
    """Return the derivatives of a quantity's extremes at these angles [degree]."""
    polished, smooth = _polished(pairs, name, angles)
    at_jumps = _at_jumps(pairs, angles, to)
    (polished_heights,) = pairs.at((name,), polished)
    smooth &= ~at_jumps.jumps & (
        np.abs(polished_heights - heights) <= SAME * np.abs(heights)
    )  # not in the middle of a jump
    sides = on_own_side(
        lambda rows, places: pairs.some(rows).at((name,), places)[0], angles, heights, pairs.scene.period
    )
    place = np.where(smooth, polished, sides)
    values = pairs.at(tuple(derivative_of(name, path) for path in (*to, ANGLE)), place)
    slopes, steep = values[:-1], values[-1]
    with np.errstate(invalid="ignore"):
        least, most = (np.where(smooth, slopes, slopes + steep * way) for way in at_jumps[-2:])
    return RiseDerivatives(most, _unlike(pairs, to, least, most, heights), smooth | at_jumps.known)


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


def _at_jumps(pairs: Pairs, angles: Array, to: tuple[str, ...]) -> AtJumps:
    """Return the jumps and bends at an angle of each design."""
    scene, turn = pairs.scene, pairs.scene.mechanism.period
    held, jumps, searched = np.zeros((3, len(angles)), dtype=bool)
    least, most = np.full((2, len(to), len(angles)), np.nan)
    place = np.full(len(angles), np.nan)
    for angle in scene.quick.angles:
        here = _near(angles, angle, scene.period)
        held, place = held | here, np.where(here, angle, place)
    for jump in scene.moving_jumps:
        angle = _over(pairs, value_of(jump.angle))
        here = _near(angles, angle, turn)
        if not isinstance(jump.angle, Sloped | float):
            searched |= here
            continue
        jumps, place = jumps | here, np.where(here, angles - signed_distance(angles, angle, turn), place)
        for k, path in enumerate(to):
            way = np.where(here, np.radians(_over(pairs, slopes_of(jump.angle).get(path, 0.0))), np.nan)
            least[k], most[k] = np.fmin(least[k], way), np.fmax(most[k], way)
    stays = bends(pairs, unlisted(scene), np.where(jumps, angles, np.nan))
    least, most = (np.where(stays, end(way, 0.0), way) for end, way in ((np.minimum, least), (np.maximum, most)))
    searched |= _at_reversals(pairs, angles)
    return AtJumps((held | jumps) & ~searched, jumps, place, np.nan_to_num(least), np.nan_to_num(most))


def _at_reversals(pairs: Pairs, angles: Array) -> Array:
    """Return whether a slide that rubs turns round at each angle, where no closed form tells of that."""
    limits = pairs.scene.table.limits or () if pairs.scene.mechanism.rubs else ()
    signals = tuple(signal for limit in limits if limit.zeros == "jump" for signal in limit.signals)
    before, after = (pairs.at(signals, angles + side) for side in (-10.0 * BESIDE, 10.0 * BESIDE))
    return (before * after < 0.0).any(axis=0)


def _over(pairs: Pairs, number: Any) -> Array:
    """Return a number for each of the designs."""
    return pairs.numbers(as_field(number))


def _near(angles: Array, place: Any, period: float) -> Array:
    return np.abs(signed_distance(angles, place, period)) < 10.0 * BESIDE


def size_of(number: Any, kind: str) -> Any:
    """Return the size of a parameter to which the rounding of derivatives is related; inf for one that is 0."""
    if kind == "angle":
        return RADIAN
    number = 0.0 if number is None else value_of(number)
    return xr.where(number == 0.0, np.inf, abs(number))


def unlike(one: Any, other: Any, peak: Any, size: Any) -> Any:
    """Return whether derivatives of two equal rises to a parameter of this size differ by more than their errors."""
    return abs(one - other) > ALIKE * np.maximum(abs(one), abs(other)) + ROUNDING * abs(peak) / size


def _unlike(pairs: Pairs, to: tuple[str, ...], one: Array, other: Array, peak: Array) -> Array:
    """Return whether derivatives (parameter, design) of two equal rises of each design differ."""
    sizes = [_over(pairs, size_of(*pairs.scene.numbers[path])) for path in to]
    return unlike(one, other, peak, np.reshape(sizes, one.shape))


def _corners(
    pairs: Pairs, name: str, to: tuple[str, ...], angles: Array, peak: Array, largest: bool, slopes: Array
) -> Array:
    """Return for which parameters (parameter, design) another rise is as high, and changes differently or in a way that
    is not known."""
    height = peak if largest else -peak
    level = np.where(np.isfinite(peak), height, np.nan)
    level = np.nan_to_num(level - EQUAL * np.abs(level), nan=np.inf)
    signal = name if largest else opposite_of(name)
    row, angle, top = equal_rises(pairs.scene.plain, signal, pairs.designs, level)
    other = np.abs(signed_distance(angle, angles[row], pairs.scene.period)) > APART
    row, angle, top = row[other], angle[other], top[other]
    corners = np.zeros(slopes.shape, dtype=bool)
    if len(row):
        some = pairs.some(row)
        rivals, own, known = rise_derivatives(some, name, to, angle, top if largest else -top)
        apart = own | ~known | _unlike(some, to, rivals, slopes[:, row], peak[row])
        for corner, each in zip(corners, apart, strict=True):
            corner[row[each]] = True
    return corners


def _across_jumps(pairs: Pairs, name: str, to: tuple[str, ...], angles: Array, peak: Array) -> Array:
    """Return for which parameters (parameter, design) both sides of a jump at the peak are as high, and change
    differently."""
    at_jumps = _at_jumps(pairs, angles, to)
    names = (name, *(derivative_of(name, path) for path in (*to, ANGLE)))
    sides = [_beside(pairs, names, at_jumps.place, way) for way in (-SIDE, SIDE)]
    equal = [np.abs(values[0] - peak) <= EQUAL * np.abs(peak) for values in sides]
    before, after = (values[1:-1] + values[-1] * at_jumps.most for values in sides)
    return equal[0] & equal[1] & _unlike(pairs, to, before, after, peak)


def _beside(pairs: Pairs, names: tuple[str, ...], place: Array, way: float) -> Array:
    """Return the limits (names, design) of quantities on one side of a place of each design, from two angles there."""
    near, far = (pairs.at(names, np.mod(place + k * way, pairs.scene.period)) for k in (1.0, 3.0))
    return 1.5 * near - 0.5 * far
