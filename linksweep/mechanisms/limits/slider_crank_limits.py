"""Limits of the slider-crank: assembly, dead centres and wedging in closed form, for arrays of designs.

With φ the angle from the guide to the crank, the rod's component across the guide is h = e − a·sin φ. It closes while
|h| ≤ b, and friction wedges the slider where μ·|tan ψ| ≥ 1, with sin ψ = h/b the rod's slope: where |h| ≥ b/√(1 +
μ²). Both bound sin φ between (e − H)/a and (e + H)/a, with H = b or H = b/√(1 + μ²).
"""

from __future__ import annotations

import numpy as np

from linksweep.base.degrees import arcsine
from linksweep.mechanisms.limits.finding import ASSEMBLY, Array, Finding, Results, turning_round

SIDES = ("upper", "upper_beyond", "lower_beyond", "lower")
"""Labels of angles: at the largest height of the crank over the guide, before and past the normal; at the least."""

DEAD_CENTRES = ("upper", "lower")
"""Labels of a driven rod's dead centres, by the crank's height over the guide."""

TURNS = ("stretched", "stretched_behind", "folded", "folded_behind")
"""Labels of the slider's dead centres."""


def classes(a: Array, b: Array, e: Array) -> Results:
    """Compute the assembly and the least transmission angle."""
    reach = np.abs(e) - b
    assembly = np.where(reach + a < 0.0, 0, np.where(reach - a < 0.0, 1, 2)).astype(np.int8)
    highest = np.minimum(a + np.abs(e), b)
    along = np.sqrt((b - highest) * (b + highest))
    never = assembly == 2
    angle = np.where(never, np.nan, np.degrees(np.arctan2(along, highest)))
    return {
        "assembly": Finding(assembly, "crank angles at which it can be assembled", words=ASSEMBLY),
        "transmission_angle_min": Finding(angle, "smallest acute angle between the rod and the guide's normal"),
    }


def angles(a: Array, b: Array, e: Array, slide_angle: Array) -> Results:
    """Compute the crank angles of arcs and toggles."""
    toggles = np.mod(_crossings(a, b, e) + slide_angle[..., None], 360.0)
    start, end = _arcs(a, b, e, slide_angle)
    return {
        "arc_start": Finding(start, "crank angle at which an assembled arc starts", along=("arc", ())),
        "arc_end": Finding(end, "crank angle at which it ends (may pass 360)", along=("arc", ())),
        "toggle_angle": Finding(toggles, "rod square to the guide", along=("side", SIDES)),
    }


def travel(a: Array, b: Array, e: Array) -> Results:
    """Compute the stroke of a slider whose crank turns fully."""
    far, near = ((reach - e) * (reach + e) for reach in (b + a, b - a))
    stroke = np.where(np.abs(e) + a < b, np.sqrt(far) - np.sqrt(near), np.nan)
    return {"stroke": Finding(stroke, "travel of the slider from one dead centre to the other", "m")}


def reversals(a: Array, b: Array, e: Array, slide_angle: Array, side: Array) -> Results:
    """Compute where the slider of a crank that turns fully turns round; `side` is 1 for open, -1 for crossed."""
    turns = np.abs(e) + a < b
    stretched, folded = (np.where(turns, arcsine(e, reach), np.nan) for reach in (b + a, b - a))
    ahead = slide_angle + 90.0 * (1.0 - side)
    return turning_round(ahead + side * stretched, ahead + 180.0 + side * folded)


def rod_dead_centres(a: Array, b: Array, e: Array, slide_angle: Array) -> Results:
    """Compute the crank angles at which the rod does not turn, and cannot drive."""
    angle = np.mod(np.stack([slide_angle + 90.0, slide_angle - 90.0], axis=-1), 360.0)
    closes = np.abs(np.stack([e - a, e + a], axis=-1)) < b[..., None]
    angle, along = np.where(closes, angle, np.nan), ("dead_centre", DEAD_CENTRES)
    return {"dead_centre_angle": Finding(angle, "crank square to the guide", along=along)}


def slider_dead_centres(a: Array, b: Array, e: Array, slide_angle: Array) -> Results:
    """Compute the slider's dead centres on either branch: rod and crank in one line, sin φ = e/(a ± b)."""
    stretched, folded = arcsine(e, a + b), arcsine(e * np.sign(a - b), np.abs(a - b))
    angle = np.stack([stretched, 180.0 - stretched, folded, 180.0 - folded], axis=-1)
    angle = np.mod(angle + slide_angle[..., None], 360.0)
    return {"dead_centre_angle": Finding(angle, "rod and crank in one line", along=("dead_centre", TURNS))}


def wedging(a: Array, b: Array, e: Array, slide_angle: Array, friction: Array) -> Results:
    """Compute where friction wedges if the crank drives, about 90° and 270° from the guide, and the least that does."""
    highest = np.minimum(a + np.abs(e), b)
    with np.errstate(divide="ignore", over="ignore"):
        least = np.where(np.abs(e) < a + b, np.sqrt((b - highest) * (b + highest)) / highest, np.nan)
    return _jams(_crossings(a, b / np.hypot(1.0, friction), e), slide_angle, friction, least)


def wedging_by_crank(slide_angle: Array, friction: Array) -> Results:
    """Compute where friction wedges if the rod drives: where the crank is too steep; with any μ at 90°."""
    steep = np.degrees(np.arctan2(1.0, friction))
    begin = np.stack([steep, 180.0 - steep, 180.0 + steep, 360.0 - steep], axis=-1)
    return _jams(begin, slide_angle, friction, np.zeros(friction.shape))


def _jams(begin: Array, slide_angle: Array, friction: Array, least: Array) -> Results:
    """Return the angles and the friction of a wedged slider as findings."""
    turned = np.where(friction[..., None] > 0.0, np.mod(begin + slide_angle[..., None], 360.0), np.nan)
    long_name = "friction wedges the slider between upper and upper_beyond, and between lower_beyond and lower"
    return {
        "jam_angle": Finding(turned, long_name, along=("side", SIDES)),
        "friction_to_jam": Finding(least, "least coefficient of friction that wedges the slider", "1"),
    }


def _crossings(a: Array, height: Array, e: Array) -> Array:
    """Return φ with e − a sin φ = −height (upper) and = height (lower), two of each on a trailing axis; NaN: none."""
    upper, lower = arcsine(e + height, a), arcsine(e - height, a)
    return np.stack([upper, 180.0 - upper, 180.0 - lower, 360.0 + lower], axis=-1)


def _arcs(a: Array, b: Array, e: Array, slide_angle: Array) -> tuple[Array, Array]:
    """Return start and end of the one or two arcs that can be assembled, on a trailing axis; NaN for none."""
    upper, upper_beyond, lower_beyond, lower = np.moveaxis(_crossings(a, b, e), -1, 0)
    above, below = np.isfinite(upper), np.isfinite(lower)
    never = np.abs(e) >= a + b
    whole, both = ~above & ~below & ~never, above & below
    cases = [never, whole, both, above, below]
    nothing = np.full(a.shape, np.nan)
    start = np.select(cases, [nothing, 0.0 * a, lower - 360.0, upper_beyond, lower - 360.0], np.nan)
    end = np.select(cases, [nothing, 0.0 * a + 360.0, upper, upper + 360.0, lower_beyond], np.nan)
    second_start, second_end = np.where(both, upper_beyond, nothing), np.where(both, lower_beyond, nothing)
    starts, ends = np.stack([start, second_start], axis=-1), np.stack([end, second_end], axis=-1)
    turned = np.mod(starts + np.where(whole, 0.0, slide_angle)[..., None], 360.0)
    return turned, turned + (ends - starts)
