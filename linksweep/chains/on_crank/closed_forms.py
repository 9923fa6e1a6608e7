"""Limits in closed form that machines of one dyad on crank and ground share, for arrays of designs."""

from __future__ import annotations

import numpy as np

from linksweep.chains.finding import ASSEMBLY, Array, Finding, Results


def zero_angle(x: Array, y: Array) -> Array:
    """Return the angle φ in [0, 180] where x·cos²(φ/2) + y·sin²(φ/2) is 0; NaN where x and y have the same sign.

    This is tan(φ/2) = √(−x/y), without the loss that acos has near 0 and 180.
    """
    crossing = (np.minimum(x, y) <= 0.0) & (np.maximum(x, y) >= 0.0)
    return np.where(crossing, 2.0 * np.degrees(np.arctan2(np.sqrt(np.abs(x)), np.sqrt(np.abs(y)))), np.nan)


def leg(hypotenuse: Array, other: Array) -> Array:
    """Return a leg of a right triangle by the other leg; NaN where this is the longer side."""
    with np.errstate(invalid="ignore"):
        return np.sqrt((hypotenuse - other) * (hypotenuse + other))


def around(frame: Array, *angles: Array) -> Array:
    """Return crank angles in [0, 360), on a trailing axis, of angles from the frame [degree]."""
    return np.mod(np.stack(angles, axis=-1) + frame[..., None], 360.0)


def assembled(partly: Array, never: Array, transmission_angle: Array, words: str) -> Results:
    """Return the assembly, and the least transmission angle [degree], `words` the links between which it lies."""
    assembly = np.where(never, 2, np.where(partly, 1, 0)).astype(np.int8)
    least = np.where(never, np.nan, transmission_angle)
    return {
        "assembly": Finding(assembly, "crank angles at which it can be assembled", words=ASSEMBLY),
        "transmission_angle_min": Finding(least, f"smallest acute angle between {words}"),
    }


def arcs(whole: Array, frame: Array, near: Array, far: Array, far_beyond: Array, near_beyond: Array) -> Results:
    """Return the one or two arcs that can be assembled, by the toggles from the frame [degree]; an end may pass 360.

    It closes from `near` to `far`, and mirrored from `far_beyond` to `near_beyond`; where one has no toggle (NaN), on
    a single arc through the side where there is none.
    """
    start = np.where(whole, 0.0, np.where(np.isnan(near), far_beyond, near))
    end = np.where(whole, 360.0, np.where(np.isnan(far), near_beyond + 360.0, far))
    both = ~(whole | np.isnan(near) | np.isnan(far))
    starts = np.stack([start, np.where(both, far_beyond, np.nan)], axis=-1)
    ends = np.stack([end, np.where(both, near_beyond, np.nan)], axis=-1)
    turned = np.mod(starts + np.where(whole, 0.0, frame)[..., None], 360.0)
    return {
        "arc_start": Finding(turned, "crank angle at which an assembled arc starts", along=("arc", ())),
        "arc_end": Finding(turned + (ends - starts), "crank angle at which it ends (may pass 360)", along=("arc", ())),
    }


def dead_centres(angle: Array, words: str, labels: tuple[str, ...]) -> Results:
    """Return the crank angles [degree] at which the driven part stands still, and cannot drive."""
    return {"dead_centre_angle": Finding(angle, words, along=("dead_centre", labels))}


def jams(friction: Array, angle: Array, words: str, labels: tuple[str, ...], least: Array, part: str) -> Results:
    """Return the crank angles [degree] between which friction wedges a part, and the least coefficient that does."""
    return {
        "jam_angle": Finding(np.where(friction[..., None] > 0.0, angle, np.nan), words, along=("side", labels)),
        "friction_to_jam": Finding(least, f"least coefficient of friction that wedges the {part}", "1"),
    }
