"""Three pins on crank and ground: Grashof class, assembly limits and toggle angles in closed form; drives.

With φ the angle from the line A→D to the crank, the four-bar closes while (see `linksweep.physics.closures.four_bar`)

    low  = (d−a−b+c)(d−a+b−c) + 4ad·sin²(φ/2) ≥ 0        low = 0: coupler folded back over the rocker, f = |b−c|
    high = (b+c−d−a)(b+c+d+a) + 4ad·cos²(φ/2) ≥ 0        high = 0: coupler and rocker stretched out, f = b+c

so that φ lies between ±φ_folded and ±φ_stretched. With 1 = cos² + sin² each is x·cos²(φ/2) + y·sin²(φ/2) = 0, whose x
and y factor into sums of lengths.

A driven rocker stands still where crank and coupler lie in one line, a driven coupler where crank and rocker are
parallel. Both times the crank, made longer or shorter by the link in line with it, closes a triangle with d and the
third link: with g = a ± b and h = c, or g = a ∓ c and h = b, is (d−g−h)(d−g+h) + 4dg·sin²(φ/2) = 0.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from linksweep.base.validate import Number
from linksweep.chains.finding import Array, Finding, Results, turning_round
from linksweep.chains.on_crank.closed_forms import arcs, around, assembled, dead_centres, zero_angle
from linksweep.chains.on_crank.machine import (
    ADVANTAGE,
    CRANK,
    FROM_GROUND,
    MOMENT_ON_CRANK,
    OF_ROCKER,
    RATIOS_OF_ROCKER,
    Driven,
    OnCrank,
    ratio_of_driven,
    status,
)
from linksweep.chains.rows.bodies import drive_torque
from linksweep.engine.quantity import Quantity, Row
from linksweep.physics import advantage
from linksweep.physics.algebra import planar
from linksweep.physics.closures import dyad_rrr
from linksweep.physics.closures.four_bar import extremes

GRASHOF = ("crank_rocker", "double_crank", "double_rocker", "rocker_crank", "triple_rocker", "change_point")
"""Classes by the shortest link (crank, ground, coupler, rocker); then no link that turns fully; then the borderline."""

DEAD_CENTRES = {
    "rocker": ("open_stretched", "open_folded", "crossed_stretched", "crossed_folded"),
    "coupler": ("open_alike", "open_opposite", "crossed_alike", "crossed_opposite"),
}
"""Labels by branch: coupler along or against the crank; crank and rocker pointing the same way or opposite."""

TOGGLES = ("folded", "stretched", "stretched_mirrored", "folded_mirrored")


@np.errstate(over="ignore", invalid="ignore")
def classes(a: Array, b: Array, c: Array, d: Array) -> Results:
    """Compute the Grashof class, the assembly and the least transmission angle."""
    partly, never = _assembly(a, b, c, d)
    return {
        "grashof": Finding(_grashof(a, b, c, d), "Grashof class", words=GRASHOF),
        **assembled(partly, never, _least_transmission_angle(a, b, c, d), "coupler and rocker"),
    }


@np.errstate(over="ignore", invalid="ignore")
def angles(a: Array, b: Array, c: Array, d: Array, frame: Array) -> Results:
    """Compute the crank angles of arcs and toggles."""
    low, largest_low, high, largest_high = extremes(a, b, c, d)
    partly, never = _assembly(a, b, c, d)
    zeros = zero_angle(low, largest_low), zero_angle(largest_high, high)
    folded, stretched = (np.where(never, np.nan, zero) for zero in zeros)
    toggles = folded, stretched, -stretched, -folded
    words = "coupler and rocker in one line"
    return {
        **arcs(~(partly | never), frame, *toggles),
        "toggle_angle": Finding(around(frame, *toggles), words, along=("toggle", TOGGLES)),
    }


def swings(a: Array, b: Array, c: Array, d: Array) -> Results:
    """Compute how far the rocker of a crank that turns fully swings, from stretched to folded."""
    swing = _where_it_turns(a, b, c, d, _angle(c, a + b, d) - _angle(c, np.abs(a - b), d))
    return {"swing": Finding(swing, "angle through which the rocker swings")}


def reversals(a: Array, b: Array, c: Array, d: Array, frame: Array, side: Array) -> Results:
    """Compute where the rocker of a crank that turns fully turns round; `side` is 1 for open, -1 for crossed."""
    stretched, folded = (_where_it_turns(a, b, c, d, angle) for angle in _in_line(a, b, c, d))
    return turning_round(frame + side * stretched, frame + side * folded)


def rocker_dead_centres(a: Array, b: Array, c: Array, d: Array, frame: Array) -> Results:
    """Compute the crank angles at which the rocker turns round, and cannot drive, on both branches, mirrored."""
    stretched, folded = _in_line(a, b, c, d)
    angle = around(frame, stretched, folded, -stretched, -folded)
    return dead_centres(angle, "crank and coupler in one line", DEAD_CENTRES["rocker"])


def coupler_dead_centres(a: Array, b: Array, c: Array, d: Array, frame: Array) -> Results:
    """Compute the crank angles at which the coupler does not turn, and cannot drive, on both branches, mirrored."""
    alike, opposite = _angle(a - c, b, d), -_angle(a + c, b, d)
    angle = around(frame, alike, opposite, -alike, -opposite)
    return dead_centres(angle, "crank and rocker parallel", DEAD_CENTRES["coupler"])


def _in_line(a: Array, b: Array, c: Array, d: Array) -> tuple[Array, Array]:
    """Return the crank's angles from the line A→D with the coupler in line with it: stretched, folded; branch open."""
    return _angle(a + b, c, d), -_angle(a - b, c, d)


def _angle(g: Array, h: Array, d: Array) -> Array:
    """Return the angle φ in [0, 180] between the sides g and d of a triangle, h opposite; NaN where there is none.

    The module's equation of dead centres; a side g < 0 points the other way.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        near, far = ((h - d) + g) * ((h + d) - g), ((d - h) + g) * ((d + h) + g)
        return np.where(g == 0.0, np.nan, zero_angle(-near * np.sign(g), far * np.sign(g)))


@np.errstate(over="ignore", invalid="ignore")
def _assembly(a: Array, b: Array, c: Array, d: Array) -> tuple[Array, Array]:
    """Return whether it has toggles, and whether it closes at no angle."""
    low, largest_low, high, largest_high = extremes(a, b, c, d)
    return (low < 0.0) | (high < 0.0), (largest_low < 0.0) | (largest_high < 0.0)


def _where_it_turns(a: Array, b: Array, c: Array, d: Array, angle: Array) -> Array:
    """Return an angle of a four-bar whose crank turns fully; NaN of any other, and of a parallelogram or a kite, which
    passes through its two change points and turns round elsewhere, if at all."""
    partly, never = _assembly(a, b, c, d)
    low, _, high, _ = extremes(a, b, c, d)
    return np.where(partly | never | ((low == 0.0) & (high == 0.0)), np.nan, angle)


def _grashof(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Compare shortest + longest with the sum of the others; a difference below the rounding of the lengths is none."""
    links = np.stack([a, d, b, c])
    shortest, p, q, longest = np.sort(links, axis=0)
    margin = (p + q) - (shortest + longest)
    borderline = np.abs(margin) <= 2.0 * np.finfo(float).eps * (p + q)
    return np.select([borderline, margin > 0.0], [5, links.argmin(axis=0)], 4).astype(np.int8)


def _least_transmission_angle(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Return the least acute angle between coupler and rocker: where the diagonal f is shortest or longest."""
    shortest, longest = np.maximum(np.abs(d - a), np.abs(b - c)), np.minimum(d + a, b + c)

    def acute(f):
        # half-angle form of the cosine rule: tan²(μ/2) = (f² − (b−c)²) / ((b+c)² − f²)
        half_square = (f - b + c) * (f + b - c), (b + c - f) * (b + c + f)
        angle = 2.0 * np.degrees(np.arctan2(*(np.sqrt(np.maximum(x, 0.0)) for x in half_square)))
        return np.minimum(angle, 180.0 - angle)

    return np.minimum(acute(shortest), acute(longest))


def narrowest(a: Number, b: Number, c: Number, d: Number) -> tuple[tuple[Number, Number], ...]:
    """Return the diagonal f and |b−c| where f is shortest, b+c and f where it is longest."""
    return (abs(d - a), abs(b - c)), (b + c, d + a)


def _driven(link: int, role: str, other: tuple[str, str, str], length: str, torque: Callable) -> Driven:
    """Return the drive of one link of three pins; `other` are vector and moment of the other, of this length."""
    inverse, lengths = "inverse_r4_cross_r3", ("crank_length", length)
    at_C = ("r2x", "r2y", "crank_length", "moment_r2", *other, "driven_ratio", inverse)
    rows = (
        Row(planar.opposite, ("moment_r3",), ("N3",)),
        MOMENT_ON_CRANK,
        Row(dyad_rrr.rrr_leverage, ("leverage",), (f"ratio{link}", inverse)),
        ratio_of_driven(f"ratio{link}", "leverage", lengths),
        Row(dyad_rrr.rrr_driven_pin_force, ("push_rocker_Cx", "push_rocker_Cy", "pull", "push"), at_C),
        Row(torque, (f"T1{link}",)),
        *status("leverage", lengths),
    )
    return Driven(drive_torque(f"T1{link}", role), f"omega{link}", rows)


MACHINE = OnCrank(
    drives={
        "crank": CRANK,
        "coupler": _driven(3, "coupler", ("r4x", "r4y", "N4"), "rocker_length", dyad_rrr.rrr_coupler_torque),
        "rocker": _driven(4, "rocker", ("r3x", "r3y", "moment_r3"), "coupler_length", dyad_rrr.rrr_rocker_torque),
    },
    rows=(
        *OF_ROCKER,
        Row(advantage.mechanical_advantage, ADVANTAGE, ("velocity_ratio", "crank_length", "rocker_length")),
    ),
    quantities=(
        *RATIOS_OF_ROCKER,
        Quantity(*ADVANTAGE, "1", "force across the rocker at C per force across the crank at B"),
    ),
    between=FROM_GROUND,
    checks={
        "machine": (classes, angles),
        "stroke": (swings, reversals),
        "output": (rocker_dead_centres,),
        "coupler": (coupler_dead_centres,),
        "rocker": (rocker_dead_centres,),
    },
    narrowest=narrowest,
)
"""Coupler 3 and rocker 4; a rocker that is driven, or a coupler, may stand still."""
