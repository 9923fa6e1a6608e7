"""Limits of the four-bar: Grashof class, assembly limits and toggle angles in closed form, for arrays of designs.

With φ the angle from the line A→D to the crank, the four-bar closes while (see `linksweep.physics.closures.four_bar`)

    low  = (d−a−b+c)(d−a+b−c) + 4ad·sin²(φ/2) ≥ 0        low = 0: coupler folded back over the rocker, f = |b−c|
    high = (b+c−d−a)(b+c+d+a) + 4ad·cos²(φ/2) ≥ 0        high = 0: coupler and rocker stretched out, f = b+c

so that φ lies between ±φ_folded and ±φ_stretched. With 1 = cos² + sin² each is x·cos²(φ/2) + y·sin²(φ/2) = 0, whose x
and y factor into sums of lengths: tan(φ/2) = √(−x/y), without the loss that acos has near 0 and 180.

A driven rocker stands still where crank and coupler lie in one line, a driven coupler where crank and rocker are
parallel. Both times the crank, made longer or shorter by the link in line with it, closes a triangle with d and the
third link: with g = a ± b and h = c, or g = a ∓ c and h = b, is (d−g−h)(d−g+h) + 4dg·sin²(φ/2) = 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linksweep.mechanisms.limits.finding import ASSEMBLY, Array, Finding, Results, turning_round
from linksweep.physics.closures.four_bar import extremes

GRASHOF = ("crank_rocker", "double_crank", "double_rocker", "rocker_crank", "triple_rocker", "change_point")
"""Classes by the shortest link (crank, ground, coupler, rocker); then no link that turns fully; then the borderline."""

DEAD_CENTRES = {
    "rocker": ("open_stretched", "open_folded", "crossed_stretched", "crossed_folded"),
    "coupler": ("open_alike", "open_opposite", "crossed_alike", "crossed_opposite"),
}
"""Labels by branch: coupler along or against the crank; crank and rocker pointing the same way or opposite."""

TOGGLES = ("folded", "stretched", "stretched_mirrored", "folded_mirrored")


def classes(a: Array, b: Array, c: Array, d: Array) -> Results:
    """Compute the Grashof class, the assembly and the least transmission angle."""
    limits = limits_of(a, b, c, d)
    least = limits.transmission_angle_min
    return {
        "grashof": Finding(limits.grashof, "Grashof class", words=GRASHOF),
        "assembly": Finding(limits.assembly, "crank angles at which it can be assembled", words=ASSEMBLY),
        "transmission_angle_min": Finding(least, "smallest acute angle between coupler and rocker"),
    }


def angles(a: Array, b: Array, c: Array, d: Array, ground_angle: Array) -> Results:
    """Compute the crank angles of arcs and toggles."""
    limits = limits_of(a, b, c, d)
    start, end = arcs(limits, ground_angle)
    toggles = np.stack([limits.folded, limits.stretched, -limits.stretched, -limits.folded], axis=-1)
    toggles = np.mod(toggles + ground_angle[..., None], 360.0)
    return {
        "arc_start": Finding(start, "crank angle at which an assembled arc starts", along=("arc", ())),
        "arc_end": Finding(end, "crank angle at which it ends (may pass 360)", along=("arc", ())),
        "toggle_angle": Finding(toggles, "coupler and rocker in one line", along=("toggle", TOGGLES)),
    }


def swings(a: Array, b: Array, c: Array, d: Array) -> Results:
    """Compute how far the rocker of a crank that turns fully swings, from stretched to folded."""
    swing = _angle(c, a + b, d) - _angle(c, np.abs(a - b), d)
    swing = np.where(limits_of(a, b, c, d).assembly == 0, swing, np.nan)
    return {"swing": Finding(swing, "angle through which the rocker swings")}


def reversals(a: Array, b: Array, c: Array, d: Array, ground_angle: Array, side: Array) -> Results:
    """Compute where the rocker of a crank that turns fully turns round; `side` is 1 for open, -1 for crossed."""
    stretched, folded = (np.where(limits_of(a, b, c, d).assembly == 0, angle, np.nan) for angle in _in_line(a, b, c, d))
    return turning_round(ground_angle + side * stretched, ground_angle + side * folded)


def rocker_dead_centres(a: Array, b: Array, c: Array, d: Array, ground_angle: Array) -> Results:
    """Compute the crank angles at which the rocker turns round, and cannot drive."""
    return _dead_centres(_in_line(a, b, c, d), ground_angle, "rocker", "crank and coupler in one line")


def coupler_dead_centres(a: Array, b: Array, c: Array, d: Array, ground_angle: Array) -> Results:
    """Compute the crank angles at which the coupler does not turn, and cannot drive."""
    parallel = _angle(a - c, b, d), -_angle(a + c, b, d)
    return _dead_centres(parallel, ground_angle, "coupler", "crank and rocker parallel")


def _dead_centres(angles_open: tuple[Array, Array], ground_angle: Array, driven: str, long_name: str) -> Results:
    """Return the dead centres of both branches; those of the crossed one mirror those of the open one."""
    from_ground = np.stack([*angles_open, *(-angle for angle in angles_open)], axis=-1)
    angle = np.mod(from_ground + ground_angle[..., None], 360.0)
    return {"dead_centre_angle": Finding(angle, long_name, along=("dead_centre", DEAD_CENTRES[driven]))}


def _in_line(a: Array, b: Array, c: Array, d: Array) -> tuple[Array, Array]:
    """Return the crank's angles from the line A→D with the coupler in line with it: stretched, folded; branch open."""
    return _angle(a + b, c, d), -_angle(a - b, c, d)


def _angle(g: Array, h: Array, d: Array) -> Array:
    """Return the angle φ in [0, 180] between the sides g and d of a triangle, h opposite; NaN where there is none.

    The module's equation of dead centres; a side g < 0 points the other way.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        near, far = ((h - d) + g) * ((h + d) - g), ((d - h) + g) * ((d + h) + g)
        angle = 2.0 * np.degrees(np.arctan2(np.sqrt(near * np.sign(g)), np.sqrt(far * np.sign(g))))
    return np.where(g == 0.0, np.nan, angle)


class Limits(NamedTuple):
    """Limits as arrays over the designs; angles in degrees from the line A→D to the crank, NaN where there is none."""

    grashof: Array
    assembly: Array
    folded: Array
    stretched: Array
    transmission_angle_min: Array


@np.errstate(over="ignore", invalid="ignore")
def limits_of(a: Array, b: Array, c: Array, d: Array) -> Limits:
    """Compute the limits of four-bars with crank a, coupler b, rocker c and ground d [m]."""
    low, largest_low, high, largest_high = extremes(a, b, c, d)
    never = (largest_low < 0.0) | (largest_high < 0.0)
    folded = _where_zero(low, largest_low, never)
    stretched = _where_zero(largest_high, high, never)
    assembly = np.where(never, 2, np.where((low < 0.0) | (high < 0.0), 1, 0)).astype(np.int8)
    return Limits(_grashof(a, b, c, d), assembly, folded, stretched, _least_transmission_angle(a, b, c, d, never))


def _where_zero(x: Array, y: Array, never: Array) -> Array:
    """Return the angle φ in [0, 180] where x cos²(φ/2) + y sin²(φ/2) is 0; NaN where x and y have the same sign."""
    crossing = (np.minimum(x, y) <= 0.0) & (np.maximum(x, y) >= 0.0) & ~never
    half = np.arctan2(np.sqrt(np.abs(x)), np.sqrt(np.abs(y)))
    return np.where(crossing, 2.0 * np.degrees(half), np.nan)


def _grashof(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Compare shortest + longest with the sum of the others; a difference below the rounding of the lengths is none."""
    links = np.stack(np.broadcast_arrays(a, d, b, c))
    shortest, p, q, longest = np.sort(links, axis=0)
    margin = (p + q) - (shortest + longest)
    borderline = np.abs(margin) <= 2.0 * np.finfo(float).eps * (p + q)
    return np.select([borderline, margin > 0.0], [5, links.argmin(axis=0)], 4).astype(np.int8)


def _least_transmission_angle(a, b, c, d, never) -> Array:
    """Return the least acute angle between coupler and rocker: where the diagonal f is shortest or longest."""
    shortest = np.maximum(np.abs(d - a), np.abs(b - c))
    longest = np.minimum(d + a, b + c)

    def acute(f):
        # half-angle form of the cosine rule: tan²(μ/2) = (f² − (b−c)²) / ((b+c)² − f²)
        half_square = (f - b + c) * (f + b - c), (b + c - f) * (b + c + f)
        angle = 2.0 * np.degrees(np.arctan2(*(np.sqrt(np.maximum(x, 0.0)) for x in half_square)))
        return np.minimum(angle, 180.0 - angle)

    return np.where(never, np.nan, np.minimum(acute(shortest), acute(longest)))


def arcs(limits: Limits, ground_angle: Array) -> tuple[Array, Array]:
    """Return start and end of the one or two arcs of θ2 [degree] that can be assembled, on a trailing axis.

    NaN where there is no such arc; an end may pass 360. With both limits there is one arc on either side of the frame
    line, with one limit a single arc through the side where there is none.
    """
    folded, stretched = np.isfinite(limits.folded), np.isfinite(limits.stretched)
    whole = limits.assembly == 0
    both = folded & stretched & ~whole
    cases = [whole, both, folded, stretched]
    nothing = np.full(whole.shape, np.nan)
    starts = [np.zeros(whole.shape), limits.folded, limits.folded, -limits.stretched]
    ends = [np.full(whole.shape, 360.0), limits.stretched, 360.0 - limits.folded, limits.stretched]
    first = np.select(cases, starts, np.nan), np.select(cases, ends, np.nan)
    second = np.where(both, -limits.stretched, nothing), np.where(both, -limits.folded, nothing)
    start, end = (np.stack(pair, axis=-1) for pair in zip(first, second, strict=True))
    turned = np.mod(start + np.where(whole, 0.0, ground_angle)[..., None], 360.0)
    return turned, turned + (end - start)
