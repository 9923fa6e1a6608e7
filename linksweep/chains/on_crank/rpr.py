"""A block and its rocker on crank and ground: assembly, swing, dead centres and wedging in closed form; drives.

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
from linksweep.base.validate import Number
from linksweep.chains.finding import Array, Finding, Results
from linksweep.chains.on_crank import closed_forms
from linksweep.chains.on_crank.closed_forms import around, assembled, jams, leg, zero_angle
from linksweep.chains.on_crank.machine import (
    CRANK,
    FROM_GROUND,
    MOMENT_ON_CRANK,
    OF_ROCKER,
    RATIOS_OF_ROCKER,
    WEDGED,
    Driven,
    OnCrank,
    ratio_of_driven,
    status,
)
from linksweep.chains.rows.bodies import drive_torque
from linksweep.engine.quantity import Quantity, Row
from linksweep.physics import coulomb, crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import inverted_slider_crank

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
BEGINS = "crank angle at which friction begins to wedge the block"


def classes(a: Array, d: Array, e: Array) -> Results:
    """Compute the assembly, the kind of motion and the least transmission angle."""
    e, nearest, whole = np.abs(e), np.abs(d - a), np.abs(e) < np.abs(d - a)
    reach = np.maximum(nearest, e)
    motion = np.where(whole, np.where(a < d, 0, 1), 2).astype(np.int8)
    angle = np.degrees(np.arctan2(leg(reach, e), e))
    return {
        **assembled(~whole, e >= d + a, angle, "the line D-B and the normal force"),
        "rocker_motion": Finding(motion, "how the rocker moves", words=MOTIONS),
    }


def angles(a: Array, d: Array, e: Array, frame: Array) -> Results:
    """Compute the crank angles of arcs and toggles."""
    toggle, none = _toggle(a, d, e), np.full(a.shape, np.nan)
    arcs = closed_forms.arcs(np.abs(e) < np.abs(d - a), frame, toggle, none, none, -toggle)
    single = {name: arc._replace(values=arc.values[..., :1]) for name, arc in arcs.items()}
    words = "line D-B square to the rocker's line"
    return single | {"toggle_angle": Finding(around(frame, toggle, -toggle), words, along=("toggle", TOGGLES))}


def swings(a: Array, d: Array, e: Array) -> Results:
    """Compute how far the rocker swings, and how evenly it moves."""
    (short, long), e = np.sort([a, d], axis=0), np.abs(e)
    whole = e < np.abs(d - a)
    lean = np.where(whole, arcsine(short + e, long) + arcsine(short - e, long), np.nan)
    words = (
        "time of the slow stroke over the quick one at constant omega2 (rocker turning fully: of its half-turns, "
        "from square to the frame line to square)"
    )
    return {
        "swing": Finding(np.where(whole & (a < d), lean, np.nan), "angle through which the rocker swings"),
        "time_ratio": Finding((180.0 + lean) / (180.0 - lean), words, "1"),
    }


def reversals(a: Array, d: Array, e: Array, frame: Array) -> Results:
    """Compute the crank angles at which a rocker that swings turns round."""
    swings = (a + np.abs(e) < d)[..., None]
    angle = np.where(swings, around(frame, *_reversals(a, d, e)), np.nan)
    long_name = "crank angle at which the rocker turns round"
    return {"reversal_angle": Finding(angle, long_name, along=("reversal", REVERSALS))}


def dead_centres(a: Array, d: Array, e: Array, frame: Array) -> Results:
    """Compute where a cylinder along the rocker's line cannot drive, and how far it is extended there."""
    with np.errstate(invalid="ignore", over="ignore"):  # out of reach
        slide = np.stack([leg(way, e) for way in (np.abs(d - a), d + a)], axis=-1)
    angle = np.where(np.isnan(slide), np.nan, around(frame, 0.0 * a, 180.0 + 0.0 * a))
    return {
        **closed_forms.dead_centres(angle, "crank angle at which the block stands still", DEAD_CENTRES),
        "slide_at_dead_centre": Finding(slide, "size of slide there", "m", along=("dead_centre", DEAD_CENTRES)),
    }


def rocker_dead_centres(a: Array, d: Array, e: Array, frame: Array) -> Results:
    """Compute the crank angles at which the rocker turns round, and cannot drive."""
    angle = around(frame, *_reversals(a, d, e))
    return closed_forms.dead_centres(angle, "crank square to the rocker's line", REVERSALS)


def wedging(a: Array, d: Array, e: Array, frame: Array, friction: Array) -> Results:
    """Compute where friction wedges if the crank drives, |DB| ≤ |e|·√(1 + μ²), and the least that does."""
    e = np.abs(e)
    reach = e * np.hypot(1.0, friction)
    half = np.where(reach < a + d, _toggle(a, d, reach), 180.0)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        least = leg(np.maximum(np.abs(d - a), e), e) / e
    least = np.where((e < a + d) & (e != 0.0), least, np.nan)
    return jams(friction, around(frame, -half, half), BEGINS, JAMS, least, "block")


def wedging_by_crank(a: Array, d: Array, e: Array, frame: Array, friction: Array) -> Results:
    """Compute where friction wedges if the rocker drives, μ·|tan ψ| ≥ 1 with ψ from crank to line, and the least."""
    lean = np.degrees(np.arctan(friction))
    beside = [angle + way * lean for angle in _reversals(a / np.hypot(1.0, friction), d, e) for way in (-1.0, 1.0)]
    steepest = np.minimum(a, d + np.abs(e))
    least = np.where(np.abs(e) < a + d, leg(a, steepest) / steepest, np.nan)
    return jams(friction, around(frame, *beside), BEGINS, JAMS_BY_CRANK, least, "block")


def _toggle(a: Array, d: Array, e: Array) -> Array:
    """Return φ in [0, 180] with |DB| = |e|; NaN where there is none."""
    near, far = (e - (d - a)) * (e + (d - a)), ((d + a) - e) * ((d + a) + e)
    return zero_angle(-near, far)


def _reversals(a: Array, d: Array, e: Array) -> tuple[Array, Array, Array, Array]:
    """Return φ with the crank square to the rocker's line, in the order of `REVERSALS`; NaN where it never is."""
    ahead, behind = arcsine(a - e, d), arcsine(a + e, d)
    return 270.0 + ahead, 90.0 - behind, 270.0 + behind, 90.0 - ahead


def narrowest(a: Number, d: Number, e: Number) -> tuple[tuple[Number, Number], ...]:
    """Return the least distance of the block from D, and the offset."""
    return ((abs(d - a), abs(e)),)


WORK = ("N2", "N3", "N4", "Q3x", "Q3y", "r2x", "r2y", "ratio4", "ratio4")
LINE = ("r3x", "r3y")
ON_ROCKER, ON_BLOCK = ("normal_arm4", "line_arm4"), ("normal_arm3", "line_arm3")
MACHINE = OnCrank(
    drives={
        "crank": CRANK,
        "rocker": Driven(
            drive_torque("T14", "rocker"),
            "omega4",
            (
                MOMENT_ON_CRANK,
                Row(planar.cross, ("crank_across",), ("r2x", "r2y", *LINE)),
                Row(inverted_slider_crank.contact_force_from_crank, ("F43n", "friction_force", "wedging")),
                ratio_of_driven("ratio4", "crank_along", ("crank_length", 1.0)),
                Row(crank_driven.balancing_drive, ("T14",), ("work", "driven_ratio")),
                *status("crank_along", ("crank_length", 1.0), WEDGED),
            ),
        ),
        "cylinder": Driven(
            Quantity("cylinder_force", "N", "force of the cylinder on the block along the line, positive as slide"),
            "slide_velocity",
            (
                Row(crank_driven.work_on_crank, ("work_of_loads",), WORK),
                ratio_of_driven("ratio_slide", "slide_leverage", ("crank_length", "ground_length")),
                Row(crank_driven.balancing_drive, ("line_force",), ("work_of_loads", "driven_ratio")),
                Row(inverted_slider_crank.normal_force_on_block, ("F43n",)),
                Row(coulomb.friction, ("friction_force",), ("F43n", "direction")),
                Row(inverted_slider_crank.cylinder_force, ("cylinder_force",)),
                *status("slide_leverage", ("crank_length", "ground_length")),
            ),
        ),
    },
    rows=(
        *OF_ROCKER,
        Row(planar.direction, ("theta4",), LINE),
        Row(planar.identity, ("theta3",), ("theta4",)),
        Row(inverted_slider_crank.slide_arms, ON_ROCKER, ("DBx", "DBy", "rG4x", "rG4y", *LINE)),
        Row(inverted_slider_crank.slide_arms, ON_BLOCK, (0.0, 0.0, "rG3x", "rG3y", *LINE)),
        Row(inverted_slider_crank.contact_arm, ("contact_F43_on4",), ("F43n", "direction", *ON_ROCKER)),
        Row(inverted_slider_crank.contact_arm, ("contact_F43_on3",), ("F43n", "direction", *ON_BLOCK)),
    ),
    quantities=(
        Quantity("theta3", "degree", "angle of the block, the rocker's"),
        Quantity("theta4", "degree", "direction of the rocker's line from x, counter-clockwise, in (-180, 180]"),
        Quantity("F43n", "N", "force of the rocker on the block across its line, positive to the line's left"),
        Quantity("T43", "N m", "moment of the rocker on the block about B, positive counter-clockwise"),
        Quantity("friction_force", "N", "friction of the rocker on the block along its line"),
        Quantity("friction_power", "W", "power of friction in the slide, never positive"),
        *RATIOS_OF_ROCKER,
    ),
    between=FROM_GROUND,
    checks={
        "machine": (classes, angles, swings, reversals),
        "stroke": (swings, reversals),
        "output": (rocker_dead_centres,),
        "crank": (wedging,),
        "rocker": (rocker_dead_centres, wedging_by_crank),
        "cylinder": (dead_centres,),
    },
    narrowest=narrowest,
)
"""Block 3 and rocker 4. A cylinder along the rocker's line overcomes friction: it takes no part in the contact."""
