"""A rod and a slider on crank and ground: assembly, dead centres and wedging in closed form; drives.

With φ the angle from the guide to the crank, the rod's component across the guide is h = e − a·sin φ. It closes while
|h| ≤ b, and friction wedges the slider where μ·|tan ψ| ≥ 1, with sin ψ = h/b the rod's slope: where |h| ≥ b/√(1 +
μ²). Both bound sin φ between (e − H)/a and (e + H)/a, with H = b or H = b/√(1 + μ²).
"""

from __future__ import annotations

import numpy as np

from linksweep.base.degrees import arcsine
from linksweep.base.validate import Number
from linksweep.chains.finding import Array, Finding, Results, turning_round
from linksweep.chains.on_crank.closed_forms import arcs, around, assembled, dead_centres, jams, leg
from linksweep.chains.on_crank.machine import (
    ADVANTAGE,
    CRANK,
    FROM_GUIDE,
    MOMENT_ON_CRANK,
    WEDGED,
    Driven,
    OnCrank,
    status,
)
from linksweep.chains.rows.bodies import drive_torque
from linksweep.engine.quantity import Quantity, Row
from linksweep.physics import advantage
from linksweep.physics.algebra import planar
from linksweep.physics.closures import slider_crank

SIDES = ("upper", "upper_beyond", "lower_beyond", "lower")
"""Labels of angles: at the largest height of the crank over the guide, before and past the normal; at the least."""

DEAD_CENTRES = ("upper", "lower")
"""Labels of a driven rod's dead centres, by the crank's height over the guide."""

TURNS = ("stretched", "stretched_behind", "folded", "folded_behind")
"""Labels of the slider's dead centres."""

JAMS = "friction wedges the slider between upper and upper_beyond, and between lower_beyond and lower"


def classes(a: Array, b: Array, e: Array) -> Results:
    """Compute the assembly and the least transmission angle."""
    reach = np.abs(e) - b
    highest = np.minimum(a + np.abs(e), b)
    angle = np.degrees(np.arctan2(leg(b, highest), highest))
    return assembled(reach + a >= 0.0, reach - a >= 0.0, angle, "the rod and the guide's normal")


def angles(a: Array, b: Array, e: Array, frame: Array) -> Results:
    """Compute the crank angles of arcs and toggles."""
    toggles = _crossings(a, b, e)
    never = np.abs(e) >= a + b
    upper, upper_beyond, lower_beyond, lower = (np.where(never, np.nan, angle) for angle in toggles)
    whole = np.isnan(upper) & np.isnan(lower) & ~never
    both = arcs(whole, frame, upper_beyond, lower_beyond, lower - 360.0, upper)
    return {
        **{name: arc._replace(values=_ahead_first(arc.values)) for name, arc in both.items()},
        "toggle_angle": Finding(around(frame, *toggles), "rod square to the guide", along=("side", SIDES)),
    }


def _ahead_first(arcs: Array) -> Array:
    """Return arcs with the one about the guide's direction before that behind."""
    return np.where(np.isnan(arcs[..., 1:]), arcs, arcs[..., ::-1])


def travel(a: Array, b: Array, e: Array) -> Results:
    """Compute the stroke of a slider whose crank turns fully."""
    stroke = np.where(np.abs(e) + a < b, leg(b + a, e) - leg(b - a, e), np.nan)
    return {"stroke": Finding(stroke, "travel of the slider from one dead centre to the other", "m")}


def reversals(a: Array, b: Array, e: Array, frame: Array, side: Array) -> Results:
    """Compute where the slider of a crank that turns fully turns round; `side` is 1 for open, -1 for crossed."""
    turns = np.abs(e) + a < b
    stretched, folded = (np.where(turns, arcsine(e, reach), np.nan) for reach in (b + a, b - a))
    ahead = frame + 90.0 * (1.0 - side)
    return turning_round(ahead + side * stretched, ahead + 180.0 + side * folded)


def rod_dead_centres(a: Array, b: Array, e: Array, frame: Array) -> Results:
    """Compute the crank angles at which the rod does not turn, and cannot drive."""
    closes = np.abs(np.stack([e - a, e + a], axis=-1)) < b[..., None]
    angle = np.where(closes, around(frame, 90.0 + 0.0 * a, -90.0 + 0.0 * a), np.nan)
    return dead_centres(angle, "crank square to the guide", DEAD_CENTRES)


def slider_dead_centres(a: Array, b: Array, e: Array, frame: Array) -> Results:
    """Compute the slider's dead centres on either branch: rod and crank in one line, sin φ = e/(a ± b)."""
    stretched, folded = arcsine(e, a + b), arcsine(e * np.sign(a - b), np.abs(a - b))
    angle = around(frame, stretched, 180.0 - stretched, folded, 180.0 - folded)
    return dead_centres(angle, "rod and crank in one line", TURNS)


def wedging(a: Array, b: Array, e: Array, frame: Array, friction: Array) -> Results:
    """Compute where friction wedges if the crank drives, about 90° and 270° from the guide, and the least that does."""
    highest = np.minimum(a + np.abs(e), b)
    with np.errstate(divide="ignore", over="ignore"):
        least = np.where(np.abs(e) < a + b, leg(b, highest) / highest, np.nan)
    angle = around(frame, *_crossings(a, b / np.hypot(1.0, friction), e))
    return jams(friction, angle, JAMS, SIDES, least, "slider")


def wedging_by_crank(frame: Array, friction: Array) -> Results:
    """Compute where friction wedges if the rod drives: where the crank is too steep; with any μ at 90°."""
    steep = np.degrees(np.arctan2(1.0, friction))
    angle = around(frame, steep, 180.0 - steep, 180.0 + steep, 360.0 - steep)
    return jams(friction, angle, JAMS, SIDES, np.zeros(friction.shape), "slider")


def _crossings(a: Array, height: Array, e: Array) -> tuple[Array, Array, Array, Array]:
    """Return φ with e − a sin φ = −height (upper), and = height (lower), two of each; NaN: none."""
    upper, lower = arcsine(e + height, a), arcsine(e - height, a)
    return upper, 180.0 - upper, 180.0 - lower, 360.0 + lower


def narrowest(a: Number, b: Number, e: Number) -> tuple[tuple[Number, Number], ...]:
    """Return the rod's length and its largest component across the guide."""
    return ((b, a + abs(e)),)


FROM_CRANK = ("inverse_crank_along", "crank_across", "moment_r2", "Q4x", "Q4y", "guide_cos", "guide_sin", "direction")
MACHINE = OnCrank(
    drives={
        "crank": CRANK,
        "coupler": Driven(
            drive_torque("T13", "coupler"),
            "omega3",
            (
                Row(slider_crank.inverse_lever, ("inverse_crank_along",)),
                MOMENT_ON_CRANK,
                Row(
                    slider_crank.guide_force,
                    ("normal_force", "friction_force", "wedging", "rod_force_across", "rod_force_along"),
                    FROM_CRANK,
                ),
                Row(slider_crank.torque_on_rod, ("T13",)),
                *status("crank_along", ("crank_length", 1.0), WEDGED),
            ),
        ),
    },
    rows=(
        Row(slider_crank.work_on_crank, ("work",)),
        Row(planar.identity, ("velocity_ratio",), ("ratio_slider",)),
        Row(advantage.mechanical_advantage, ADVANTAGE, ("velocity_ratio", "crank_length", 1.0)),
    ),
    quantities=(
        Quantity("T14", "N m", "moment of the guide on the slider about C, positive counter-clockwise"),
        Quantity("normal_force", "N", "force of the guide on the slider across it, positive to the guide's left"),
        Quantity("friction_force", "N", "force of the guide on the slider along it"),
        Quantity("friction_power", "W", "power of friction on the slider, never positive"),
        Quantity("velocity_ratio", "m/rad", "velocity of the slider per angular velocity of the crank"),
        Quantity(*ADVANTAGE, "1", "force of the slider per force on the crank at B square to it"),
    ),
    between=FROM_GUIDE,
    checks={
        "machine": (classes, angles),
        "stroke": (travel, reversals),
        "output": (slider_dead_centres,),
        "crank": (wedging,),
        "coupler": (rod_dead_centres, wedging_by_crank),
    },
    narrowest=narrowest,
)
"""Rod 3 and slider 4."""
