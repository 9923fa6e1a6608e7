"""Rows of the dyad of three pins, in the names of a four-bar: coupler 3 (B-C), rocker 4 (D-C), B and D known."""

from __future__ import annotations

from linksweep.chains.dyads.names import full
from linksweep.chains.rows.bodies import Source
from linksweep.chains.rows.crank import near_toggle_rows, straight_rows
from linksweep.engine.quantity import Limit, Row, Total
from linksweep.physics import crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import crank_angle, dyad_rrr, four_bar, pins

Rows = list[Row | Total]
Certain = dict[str, Source]
TOGGLE = Limit("C", ("low", "high"), ("low_noise", "high_noise"))
"""Limit of the dyad's motion."""
CERTAIN_ON_CRANK: Certain = {
    **dict.fromkeys(("psi_cos", "psi_cos_lo", "psi_sin", "low", "high", "versine", "vercosine"), 1.0),
    **dict.fromkeys(("least_low", "least_high"), "sums_unit"),
}
"""Names of the numbers made in double-double on crank and ground, with their errors in those of a cosine."""
CERTAIN: Certain = {"low": "reach", "high": "reach"}
"""Likewise between any two pins."""
CERTAIN_BEYOND: Certain = {
    **dict.fromkeys(("r3x_lo", "r3y_lo", "Cx_lo", "Cy_lo"), "coupler_length"),
    **dict.fromkeys(("r4x_lo", "r4y_lo"), "rocker_length"),
}
"""Likewise of the links, and of the pin, on which dyads beyond may close."""
CLOSED = (
    *("r3x", "r3y", "r4x", "r4y", "inverse_r4_cross_r3"),
    *("along3", "along4", "across", "inverse_2ff", "half_inverse_root"),
)


def on_crank_and_ground(turned: bool, goes_through: bool) -> Rows:
    """Return the rows of the closure where B is the crank's pin and D on the ground: by the crank's angle.

    `turned` where the line A-D may lie at an angle to x; `goes_through` where it may be a parallelogram or a kite.
    """
    side = Row(planar.identity, ("side",), ("branch_sign",))
    return [
        *(near_toggle_rows("ground") if turned else straight_rows("cos2", "sin2")),
        Row(four_bar.near_toggle_widths, ("near_toggle_near", "near_toggle_far")),
        Row(four_bar.closure_unit, ("closure_unit",)),
        Row(four_bar.least_factors, ("least_low", "least_low_lo", "least_high", "least_high_lo")),
        Row(four_bar.sums_unit, ("sums_unit",)),
        Row(four_bar.toggle_cosines, ("folded_cos", "folded_cos_lo", "stretched_cos", "stretched_cos_lo")),
        Row(four_bar.change_points, ("folded_noise", "stretched_noise", "parallel")),
        Row(crank_angle.versines, ("versine", "vercosine")),
        Row(four_bar.diagonal, ("BDx", "BDy")),
        Row(four_bar.closure_factors, ("low", "high")),
        Row(four_bar.closure_noise, ("low_noise", "high_noise")),
        Row(four_bar.assembly, ("assembly",)),
        Row(four_bar.side_of_diagonal, ("side",)) if goes_through else side,
        Row(four_bar.crank_on_diagonal, ("crank_along", "crank_across", "crank_per_across")),
        Row(dyad_rrr.rrr_velocity_ratios, ("ratio3", "ratio4")),
        Row(four_bar.ratio_slopes, ("slope3", "slope4")),
        *_closed(),
        *_pin("B", 3),
    ]


def between_pins() -> Rows:
    """Return the rows of the closure between any two pins, of which `apart_BD` is known."""
    links = ("r3x", "r3y", "r4x", "r4y", "inverse_r4_cross_r3")
    lengths = ("coupler_length", "coupler_length_lo", "rocker_length", "rocker_length_lo")
    return [
        Row(planar.vector_sum, ("BDx", "BDy"), full("apart_BD")),
        Row(dyad_rrr.rrr_between_pins, ("low", "high"), (*full("apart_BD"), *lengths)),
        Row(dyad_rrr.rrr_reach, ("reach", "low_noise")),
        Row(planar.identity, ("high_noise",), ("low_noise",)),
        Row(planar.identity, ("side",), ("branch_sign",)),
        Row(planar.identity, ("closure_unit",), (1.0,)),
        Row(planar.difference, ("u_BDx", "u_BDy"), ("uDx", "uDy", "uBx", "uBy")),
        Row(dyad_rrr.rrr_ratios_between_pins, ("ratio3", "ratio4"), ("u_BDx", "u_BDy", *links)),
        Row(
            planar.difference,
            ("u_BDx_slope", "u_BDy_slope"),
            ("uDx_slope", "uDy_slope", "uBx_slope", "uBy_slope"),
        ),
        Row(
            dyad_rrr.rrr_slopes_between_pins,
            ("slope3", "slope4"),
            ("u_BDx_slope", "u_BDy_slope", "ratio3", "ratio4", *links),
        ),
        *_closed(),
        *_pin("D", 4),
    ]


def _closed() -> Rows:
    """Return the rows that follow from the factors low and high."""
    from_B, step = full("exact_BC"), ("r4x_lo", "r4y_lo")
    return [
        Row(dyad_rrr.rrr_close, CLOSED),
        Row(dyad_rrr.rrr_status, ("closure",)),
        Row(dyad_rrr.transmission_angle, ("transmission_angle",)),
        Row(pins.joined, from_B, ("r4x", "r4y", 0.0, 0.0, *full("apart_BD"))),
        Row(pins.excess_square, ("B_missing",), (*from_B, "coupler_length", "coupler_length_lo")),
        Row(pins.excess_square, ("D_missing",), ("r4x", "r4y", 0.0, 0.0, "rocker_length", "rocker_length_lo")),
        Row(pins.newton_step, step, ("D_missing", "B_missing", "r4x", "r4y", "r3x", "r3y", "inverse_r4_cross_r3")),
        Row(pins.low_words, ("r3x_lo", "r3y_lo"), ("r3x", "r3y", *from_B, *step)),
    ]


def _pin(known: str, digit: int) -> Rows:
    """Return the rows of pin C and its motion, from a known pin and the link from there."""
    r, ratio, slope = full(f"r{digit}"), f"ratio{digit}", f"slope{digit}"
    u, u_slope = (f"u{known}x", f"u{known}y"), (f"u{known}x_slope", f"u{known}y_slope")
    return [
        Row(planar.vector_sum, ("Cx", "Cy"), (f"{known}x", f"{known}y", *r[:2])),
        Row(pins.joined_low_words, ("Cx_lo", "Cy_lo"), (*full(known), *r)),
        Row(planar.point_velocity, ("uCx", "uCy"), (*u, ratio, *r[:2])),
        Row(planar.point_acceleration, ("uCx_slope", "uCy_slope"), (*u_slope, ratio, slope, *r[:2])),
    ]


def forces() -> Rows:
    """Return the rows of the forces of rocker on coupler at C, of the coupler on pin B, and of pin D on the rocker."""
    return [
        Row(dyad_rrr.rrr_pin_force, ("F43x", "F43y")),
        Row(crank_driven.coupler_balance, ("F32x", "F32y")),
        Row(crank_driven.rocker_balance, ("F14x", "F14y")),
    ]
