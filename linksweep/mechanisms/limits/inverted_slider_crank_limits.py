"""Limits of the inverted slider-crank: assembly, motion of the rocker, dead centres, wedging, for arrays of designs.

The block's distance from D, between |d − a| and d + a, must exceed the offset e of the rocker's line (see
`linksweep.physics.closures.inverted_slider_crank`). It equals |e| where tan²(φ/2) = (e² − (d−a)²)/((d+a)² − e²).

For a < d the rocker swings. It turns round where its line touches the crank's circle: sin ψ = (e ∓ a)/d with ψ its
angle from the frame line, the crank square to it. Between those the crank turns through 180° ± the swing, asin((a +
e)/d) + asin((a − e)/d). For a > d the rocker turns fully (Whitworth); square to the frame line, it divides the crank's
turn into 180° ± (asin((d + e)/a) + asin((d − e)/a)).

A cylinder along the line drives by s, which stands still where B is nearest to D and farthest from it, φ = 0 and 180°.
"""

from __future__ import annotations

import numpy as np

from linksweep.base.degrees import arcsine
from linksweep.mechanisms.limits.finding import ASSEMBLY, Array, Finding, Results

MOTIONS = ("swings", "turns_fully", "limited")
"""Motion of the rocker: as the crank turns, or as it goes back and forth between its limits."""

REVERSALS = ("open_greatest", "open_least", "crossed_greatest", "crossed_least")
"""Labels by branch: at the greatest and the least theta4."""

DEAD_CENTRES = ("nearest", "farthest")
"""Labels by the distance of B from D."""

TOGGLES = ("toggle", "toggle_mirrored")
JAMS = ("jam", "jam_mirrored")
"""Labels of the limits of wedging about the angle where B is nearest to D."""
JAMS_BY_CRANK = tuple(f"{reversal}_{side}" for reversal in REVERSALS for side in ("before", "after"))
"""Labels of the limits of wedging about each angle where the rocker turns round."""


def classes(a: Array, d: Array, e: Array) -> Results:
    """Compute the assembly, the kind of motion and the least transmission angle."""
    e = np.abs(e)
    whole = e < np.abs(d - a)
    assembly = np.where(whole, 0, np.where(e < d + a, 1, 2)).astype(np.int8)
    motion = np.where(whole, np.where(a < d, 0, 1), 2).astype(np.int8)
    nearest = np.maximum(np.abs(d - a), e)
    angle = np.degrees(np.arctan2(np.sqrt((nearest - e) * (nearest + e)), e))
    least = np.where(assembly == 2, np.nan, angle)
    return {
        "assembly": Finding(assembly, "crank angles at which it can be assembled", words=ASSEMBLY),
        "rocker_motion": Finding(motion, "how the rocker moves", words=MOTIONS),
        "transmission_angle_min": Finding(least, "smallest acute angle between the line D-B and the normal force"),
    }


def angles(a: Array, d: Array, e: Array, ground_angle: Array) -> Results:
    """Compute the crank angles of arcs and toggles."""
    toggle = _toggle(a, d, e)
    whole = np.abs(e) < np.abs(d - a)
    start = np.where(whole, 0.0, np.mod(toggle + ground_angle, 360.0))
    end = start + np.where(whole, 360.0, 360.0 - 2.0 * toggle)
    toggles = np.mod(np.stack([toggle, -toggle], axis=-1) + ground_angle[..., None], 360.0)
    return {
        "arc_start": Finding(start[..., None], "crank angle at which the assembled arc starts", along=("arc", ())),
        "arc_end": Finding(end[..., None], "crank angle at which it ends (may pass 360)", along=("arc", ())),
        "toggle_angle": Finding(toggles, "line D-B square to the rocker's line", along=("toggle", TOGGLES)),
    }


def swings(a: Array, d: Array, e: Array) -> Results:
    """Compute how far the rocker swings, and how evenly it moves."""
    whole = np.abs(e) < np.abs(d - a)
    lean = _lean(a, d, np.abs(e), whole)
    return {
        "swing": Finding(np.where(whole & (a < d), lean, np.nan), "angle through which the rocker swings"),
        "time_ratio": Finding(
            (180.0 + lean) / (180.0 - lean),
            "time of the slow stroke over the quick one at constant omega2 (rocker turning fully: of its half-turns, "
            "from square to the frame line to square)",
            "1",
        ),
    }


def reversals(a: Array, d: Array, e: Array, ground_angle: Array) -> Results:
    """Compute the crank angles at which a rocker that swings turns round."""
    swings = (a + np.abs(e) < d)[..., None]
    angle = np.where(swings, np.mod(_reversals(a, d, e) + ground_angle[..., None], 360.0), np.nan)
    long_name = "crank angle at which the rocker turns round"
    return {"reversal_angle": Finding(angle, long_name, along=("reversal", REVERSALS))}


def dead_centres(a: Array, d: Array, e: Array, ground_angle: Array) -> Results:
    """Compute where a cylinder along the rocker's line cannot drive, and how far it is extended there."""
    along = ("dead_centre", DEAD_CENTRES)
    way = np.stack([np.abs(d - a), d + a], axis=-1)
    with np.errstate(invalid="ignore", over="ignore"):  # out of reach
        slide = np.sqrt((way - e[..., None]) * (way + e[..., None]))
    angle = np.mod(np.stack([ground_angle, ground_angle + 180.0], axis=-1), 360.0)
    return {
        "dead_centre_angle": Finding(
            np.where(np.isnan(slide), np.nan, angle), "crank angle at which the block stands still", along=along
        ),
        "slide_at_dead_centre": Finding(slide, "size of slide there", "m", along=along),
    }


def rocker_dead_centres(a: Array, d: Array, e: Array, ground_angle: Array) -> Results:
    """Compute the crank angles at which the rocker turns round, and cannot drive."""
    angle = np.mod(_reversals(a, d, e) + ground_angle[..., None], 360.0)
    return {"dead_centre_angle": Finding(angle, "crank square to the rocker's line", along=("dead_centre", REVERSALS))}


def wedging(a: Array, d: Array, e: Array, ground_angle: Array, friction: Array) -> Results:
    """Compute where friction wedges if the crank drives, |DB| ≤ |e|·√(1 + μ²), and the least that does."""
    reach = np.abs(e) * np.hypot(1.0, friction)
    half = np.where(reach < a + d, _toggle(a, d, reach), 180.0)
    nearest = np.maximum(np.abs(d - a), np.abs(e))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        least = np.sqrt((nearest - np.abs(e)) * (nearest + np.abs(e))) / np.abs(e)
    least = np.where(np.abs(e) < a + d, np.where(e == 0.0, np.nan, least), np.nan)
    return _jams(np.stack([-half, half], axis=-1), ground_angle, friction, least, JAMS)


def wedging_by_crank(a: Array, d: Array, e: Array, ground_angle: Array, friction: Array) -> Results:
    """Compute where friction wedges if the rocker drives, μ·|tan ψ| ≥ 1 with ψ from crank to line, and the least."""
    lean = np.degrees(np.arctan(friction))[..., None]
    beside = _reversals(a / np.hypot(1.0, friction), d, e)
    angle = np.stack([beside - lean, beside + lean], axis=-1).reshape(*friction.shape, len(JAMS_BY_CRANK))
    steepest = np.minimum(a, d + np.abs(e))
    least = np.where(np.abs(e) < a + d, np.sqrt((a - steepest) * (a + steepest)) / steepest, np.nan)
    return _jams(angle, ground_angle, friction, least, JAMS_BY_CRANK)


def _jams(angle: Array, ground_angle: Array, friction: Array, least: Array, sides: tuple[str, ...]) -> Results:
    """Return the angles and the friction of a wedged block as findings."""
    turned = np.where(friction[..., None] > 0.0, np.mod(angle + ground_angle[..., None], 360.0), np.nan)
    return {
        "jam_angle": Finding(turned, "crank angle at which friction begins to wedge the block", along=("side", sides)),
        "friction_to_jam": Finding(least, "least coefficient of friction that wedges the block", "1"),
    }


def _lean(a: Array, d: Array, e: Array, whole: Array) -> Array:
    """Return the difference of the crank's two parts of a turn from 180°; NaN where it does not turn fully."""
    short, long = np.minimum(a, d), np.maximum(a, d)
    return np.where(whole, arcsine(short + e, long) + arcsine(short - e, long), np.nan)


def _toggle(a: Array, d: Array, e: Array) -> Array:
    """Return φ in [0, 180] with |DB| = |e|; NaN where there is none."""
    with np.errstate(invalid="ignore"):
        near, far = (e - (d - a)) * (e + (d - a)), ((d + a) - e) * ((d + a) + e)
        return 2.0 * np.degrees(np.arctan2(np.sqrt(near), np.sqrt(far)))


def _reversals(a: Array, d: Array, e: Array) -> Array:
    """Return φ with the crank square to the rocker's line, on a trailing axis; NaN where it never is."""
    ahead, behind = arcsine(a - e, d), arcsine(a + e, d)
    return np.stack([270.0 + ahead, 90.0 - behind, 270.0 + behind, 90.0 - ahead], axis=-1)
