"""Where a four-bar closes: Grashof class, assembly limits and toggle angles in closed form, for arrays of designs.

With φ the angle from the line A→D to the crank, the four-bar closes while (see `linksweep.physics.four_bar`)

    low  = (d−a−b+c)(d−a+b−c) + 4ad·sin²(φ/2) ≥ 0        low = 0: coupler folded back over the rocker, f = |b−c|
    high = (b+c−d−a)(b+c+d+a) + 4ad·cos²(φ/2) ≥ 0        high = 0: coupler and rocker stretched out, f = b+c

so that φ lies between ±φ_folded and ±φ_stretched, each found from its half angle, without the loss that acos has
near 0 and 180.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

GRASHOF = (
    "crank_rocker",
    "double_crank",
    "double_rocker",
    "rocker_crank",
    "triple_rocker",
    "change_point",
)
"""By the shortest link: crank, ground, coupler, rocker; then no link turns fully; then the borderline between."""

ASSEMBLY = ("everywhere", "partly", "never")


class Limits(NamedTuple):
    """Arrays over the designs; angles in degrees from the line A→D to the crank. NaN where there is no such limit."""

    grashof: np.ndarray
    assembly: np.ndarray
    folded: np.ndarray
    stretched: np.ndarray
    transmission_angle_min: np.ndarray


def limits(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> Limits:
    """Limits of four-bars with crank a, coupler b, rocker c and ground d [m]."""
    with np.errstate(invalid="ignore", divide="ignore"):
        low = (d - a - b + c) * (d - a + b - c)
        high = (b + c - d - a) * (b + c + d + a)
        folded = np.where(low <= 0.0, 2.0 * np.degrees(np.arcsin(np.sqrt(-low / (4.0 * a * d)))), np.nan)
        stretched = np.where(high <= 0.0, 2.0 * np.degrees(np.arccos(np.sqrt(-high / (4.0 * a * d)))), np.nan)
        never = np.maximum.reduce([a, b, c, d]) > 0.5 * (a + b + c + d)
        assembly = np.where(never, 2, np.where((low < 0.0) | (high < 0.0), 1, 0)).astype(np.int8)
        folded, stretched = (np.where(never, np.nan, angle) for angle in (folded, stretched))
        return Limits(_grashof(a, b, c, d), assembly, folded, stretched, _least_transmission_angle(a, b, c, d, never))


def _grashof(a, b, c, d) -> np.ndarray:
    """Shortest + longest against the sum of the other two."""
    links = np.stack(np.broadcast_arrays(a, d, b, c))
    margin = 0.5 * links.sum(axis=0) - links.min(axis=0) - links.max(axis=0)
    kind = np.where(margin > 0.0, links.argmin(axis=0), np.where(margin < 0.0, 4, 5))
    return kind.astype(np.int8)


def _least_transmission_angle(a, b, c, d, never) -> np.ndarray:
    """The acute angle between coupler and rocker is least where the diagonal f is shortest or longest."""
    shortest = np.maximum(np.abs(d - a), np.abs(b - c))
    longest = np.minimum(d + a, b + c)

    def acute(f):
        # half-angle form of the cosine rule: tan²(μ/2) = (f² − (b−c)²) / ((b+c)² − f²)
        half_square = (f - b + c) * (f + b - c), (b + c - f) * (b + c + f)
        angle = 2.0 * np.degrees(np.arctan2(*(np.sqrt(np.maximum(x, 0.0)) for x in half_square)))
        return np.minimum(angle, 180.0 - angle)

    return np.where(never, np.nan, np.minimum(acute(shortest), acute(longest)))


def arcs(found: Limits, ground_angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Start and end of the one or two arcs of θ2 [degree] that can be assembled, on a trailing axis.

    NaN where there is no such arc; an end may pass 360. With both limits there is one arc on either side of the frame line,
    with one limit a single arc through the side where there is none.
    """
    folded, stretched = np.isfinite(found.folded), np.isfinite(found.stretched)
    whole, both = found.assembly == 0, folded & stretched
    cases = [whole, both, folded, stretched]
    nothing = np.full(whole.shape, np.nan)
    first = (
        np.select(cases, [np.zeros(whole.shape), found.folded, found.folded, -found.stretched], np.nan),
        np.select(cases, [np.full(whole.shape, 360.0), found.stretched, 360.0 - found.folded, found.stretched], np.nan),
    )
    second = np.where(both, -found.stretched, nothing), np.where(both, -found.folded, nothing)
    start, end = (np.stack(pair, axis=-1) for pair in zip(first, second, strict=True))
    turned = np.mod(start + np.where(whole, 0.0, ground_angle)[..., None], 360.0)
    return turned, turned + (end - start)
