"""Rows of the dyad of a pin, a slide and a pin, in the names of an inverted slider-crank: block 3 on the known pin B,
rocker 4 about the known pin D, whose line passes B; `offset` is the line's from D.
"""

from __future__ import annotations

from linksweep.chains.dyads.names import Slide, full
from linksweep.chains.dyads.rrr import Certain, Rows
from linksweep.chains.rows.crank import near_toggle_rows, straight_rows
from linksweep.engine.quantity import Limit, Row
from linksweep.physics import coulomb, crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import dyad_rpr, inverted_slider_crank, moving_guide, pins

CERTAIN_ON_CRANK: Certain = dict.fromkeys(("psi_cos", "psi_cos_lo", "psi_sin", "slide_cosine", "psi_versine"), 1.0)
CERTAIN: Certain = {"slide_squared": "reach"}
CERTAIN_BEYOND: Certain = dict.fromkeys(full("line_"), 1.0)
TOGGLE = Limit("rocker", ("slide_squared",), ("noise",))
"""Limit of the dyad's motion."""
SLIDE = Limit("rocker", ("grip",), ("noise",), "wedge"), Limit("rocker", ("slide_leverage",), ("noise",), "jump")
"""Limits of friction in the slide: where it wedges the block, and where the block turns round."""
CONTACT = Slide("F43n", "friction_force", "T43", ("direction", "r3x", "r3y", "Bx", "By"))
LINE = ("slide", "ratio_slide", "inverse_slide", "offset", "r3x", "r3y")


def on_crank_and_ground(turned: bool) -> Rows:
    """Return the rows of the closure where B is the crank's pin and D on the ground: by the crank's angle."""
    return [
        *(near_toggle_rows("ground") if turned else straight_rows("cos2", "sin2")),
        Row(inverted_slider_crank.near_toggle_width, ("near_toggle_near",)),
        Row(planar.identity, ("near_toggle_far",), (1.0,)),
        Row(inverted_slider_crank.toggle_cosine, ("toggle_cos", "toggle_cos_lo")),
        Row(inverted_slider_crank.versine, ("psi_versine",)),
        Row(inverted_slider_crank.block_from_rocker_pivot, ("DBx", "DBy")),
        Row(inverted_slider_crank.slide_cosine, ("slide_cosine",)),
        Row(inverted_slider_crank.slide_squared, ("slide_squared",)),
        Row(inverted_slider_crank.slide_leverage, ("slide_leverage",)),
        Row(inverted_slider_crank.closure_noise, ("noise",)),
        Row(inverted_slider_crank.assembly, ("assembly",)),
        Row(planar.dot, ("crank_along",), ("r2x", "r2y", "r3x", "r3y")),
        Row(dyad_rpr.rpr_velocity_ratios, ("ratio4", "ratio_slide")),
        Row(dyad_rpr.rpr_accelerations, ("alpha4", "slide_acceleration")),
        Row(dyad_rpr.rpr_accelerations, ("slope4", "slope_slide"), ("uBx_slope", "uBy_slope", "ratio4", *LINE)),
        Row(inverted_slider_crank.slide_direction, ("direction",)),
        *_closed(),
    ]


def between_pins() -> Rows:
    """Return the rows of the closure between any two pins."""
    velocity, slope = ("u_DBx", "u_DBy"), ("u_DBx_slope", "u_DBy_slope")
    return [
        *(Row(planar.identity, (f"DB{axis}",), (f"exact_DB{axis}",)) for axis in "xy"),
        Row(dyad_rpr.rpr_between_pins, ("slide_squared",), (*full("exact_DB"), "offset", "offset_lo")),
        Row(planar.square, ("reach",), ("DBx", "DBy")),
        Row(dyad_rpr.rpr_noise, ("noise",)),
        Row(planar.difference, velocity, ("uBx", "uBy", "uDx", "uDy")),
        Row(moving_guide.along_and_across, ("u_along", "crank_along"), (*velocity, "r3x", "r3y")),
        Row(planar.dot, ("slide_leverage",), (*velocity, "DBx", "DBy")),
        Row(dyad_rpr.rpr_velocity_ratios, ("ratio4", "ratio_slide")),
        Row(planar.difference, slope, ("uBx_slope", "uBy_slope", "uDx_slope", "uDy_slope")),
        Row(dyad_rpr.rpr_accelerations, ("slope4", "slope_slide"), (*slope, "ratio4", *LINE)),
        Row(
            crank_driven.angular_acceleration,
            ("slide_acceleration",),
            ("omega2", "alpha2", "ratio_slide", "slope_slide"),
        ),
        Row(dyad_rpr.standing_noise, ("slide_noise",)),
        Row(coulomb.direction_of_sliding, ("direction",), ("friction", "slide_velocity", "omega2", "slide_noise")),
        *_closed(),
    ]


def _closed() -> Rows:
    """Return the rows that follow from the block's position."""
    return [
        Row(dyad_rpr.rpr_close, ("slide", "inverse_slide", "r3x", "r3y")),
        Row(pins.between, full("exact_DB"), (*full("B"), *full("D"))),
        Row(
            dyad_rpr.rpr_direction,
            full("line_"),
            (*full("exact_DB"), "offset", "offset_lo", "slide"),
        ),
        Row(dyad_rpr.rpr_status, ("closure",)),
        Row(dyad_rpr.rpr_transmission_angle, ("transmission_angle",)),
        Row(planar.product, ("slide_velocity",), ("omega2", "ratio_slide")),
    ]


def grip() -> Rows:
    """Return the row of the signal that is positive where friction does not wedge the block."""
    return [Row(coulomb.grip, ("grip",), ("slide_squared", "offset", "friction"))]


def forces() -> Rows:
    """Return the rows of the contact of rocker and block where friction is the only force along the line."""
    return [
        Row(inverted_slider_crank.contact_force, ("F43n", "friction_force", "wedging")),
        Row(planar.identity, ("line_force",), ("friction_force",)),
        Row(coulomb.jammed_status, ("jam_status",), ("closure", "wedging")),
        *from_contact(),
    ]


def forces_from_friction() -> Rows:
    """Return the rows of the contact where its friction is known."""
    return [
        Row(planar.identity, ("line_force",), ("friction_force",)),
        Row(inverted_slider_crank.normal_force_on_block, ("F43n",)),
        *from_contact(),
    ]


def from_contact() -> Rows:
    """Return the rows of the forces of rocker on block, of the block on pin B, and of pin D on the rocker."""
    return [
        Row(planar.opposite, ("T43",), ("N3",)),
        Row(planar.to_ground_axes, ("F43x", "F43y"), ("line_force", "F43n", 1.0, "r3x", "r3y")),
        Row(crank_driven.coupler_balance, ("F32x", "F32y")),
        Row(crank_driven.rocker_balance, ("F14x", "F14y")),
        Row(planar.product, ("friction_power",), ("friction_force", "slide_velocity")),
    ]
