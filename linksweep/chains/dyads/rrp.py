"""Rows of the dyad of two pins and a slider, in the names of a slider-crank: rod 3 (B-C), slider 4 at C; B known.

The guide is on the ground or on a link that has its place: O is the origin of its axes, from which it lies at `offset`.
"""

from __future__ import annotations

from linksweep.chains.dyads.names import Slide, full
from linksweep.chains.dyads.rrr import Certain, Rows
from linksweep.chains.rows.crank import near_toggle_rows, straight_rows
from linksweep.engine.quantity import Limit, Row
from linksweep.physics import coulomb, crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import dyad_rrp, moving_guide, pins, slider_crank

CERTAIN_ON_CRANK: Certain = {
    **dict.fromkeys(("psi_cos", "psi_cos_lo", "psi_sin"), 1.0),
    **dict.fromkeys(("low", "high"), "crank_length"),
}
CERTAIN: Certain = {"low": "rod_length", "high": "rod_length", "rod_across": "rod_length"}
CERTAIN_BEYOND: Certain = {"Cx_lo": "rod_length", "Cy_lo": "rod_length"}
TOGGLE = Limit("C", ("low", "high"), ("low_noise", "high_noise"))
"""Limit of the dyad's motion."""
SLIDE = Limit("C", ("grip",), ("grip_noise",), "wedge"), Limit("C", ("ratio_slider",), ("noise",), "jump")
"""Limits of friction in the guide: where it wedges the slider, and where the slider turns round."""
GUIDE = ("guide_cos", "guide_sin")
CONTACT = Slide("normal_force", "friction_force", "T14", ("direction", "guide_cos", "guide_sin", "Cx", "Cy"))
FROM_B = ("BCx_lo", "BCy_lo")
"""Names of what r3 misses of the vector from B to C: C lies on the guide on the ground, else at the rod's end."""
ROD = ("rod_along", "rod_across", "inverse_rod_along")


def on_crank_and_ground(turned: bool) -> Rows:
    """Return the rows of the closure where B is the crank's pin and the guide on the ground: by the crank's angle."""
    upright = [
        Row(planar.opposite, ("upright_cos",), ("guide_sin",)),
        Row(planar.opposite, ("upright_cos_lo",), ("guide_sin_lo",)),
        Row(planar.identity, ("upright_sin",), ("guide_cos",)),
        Row(planar.identity, ("upright_sin_lo",), ("guide_cos_lo",)),
    ]
    return [
        *upright,
        *(near_toggle_rows("upright") if turned else straight_rows("sin2", "cos2", minus_sin=True)),
        Row(slider_crank.near_toggle_widths, ("near_toggle_near", "near_toggle_far")),
        Row(slider_crank.toggle_cosines, ("low_cos", "low_cos_lo", "high_cos", "high_cos_lo")),
        Row(slider_crank.guide_components, ("crank_along", "crank_across", "rod_across")),
        Row(slider_crank.closure_factors, ("low", "high")),
        Row(slider_crank.closure_noise, ("low_noise", "high_noise")),
        Row(slider_crank.length_noise, ("noise",)),
        Row(slider_crank.assembly, ("assembly",)),
        Row(slider_crank.slider_position, ("x_slider",)),
        Row(dyad_rrp.rrp_velocity_ratios, ("ratio3", "ratio_slider")),
        Row(planar.product, ("omega3",), ("omega2", "ratio3")),
        Row(planar.product, ("v_slider",), ("omega2", "ratio_slider")),
        Row(dyad_rrp.rrp_accelerations, ("alpha3", "a_slider")),
        Row(dyad_rrp.rrp_accelerations, ("slope3", "slope_slider"), ("uBx_slope", "uBy_slope", "ratio3", *ROD, *GUIDE)),
        Row(moving_guide.on_guide, ("Cx", "Cy"), ("x_slider", "offset", *GUIDE)),
        Row(pins.vector_low_words, FROM_B, ("Cx", "Cy", *full("B"), "r3x", "r3y")),
        *_closed(),
        Row(planar.along, ("vCx", "vCy"), ("v_slider", *GUIDE)),
        Row(planar.along, ("aCx", "aCy"), ("a_slider", *GUIDE)),
        Row(planar.along, ("uCx", "uCy"), ("ratio_slider", *GUIDE)),
        Row(planar.along, ("uCx_slope", "uCy_slope"), ("slope_slider", *GUIDE)),
    ]


def between_pin_and_guide() -> Rows:
    """Return the rows of the closure between any pin and any guide."""
    guide_motion = ("uOx", "uOy", "guide_ratio", "OCx", "OCy")
    slope_inputs = ("uOx_slope", "uOy_slope", "guide_ratio", "guide_slope", "OCx", "OCy", "ratio_slider", *GUIDE)
    relative = ("u_B_guide_x", "u_B_guide_y")
    return [
        Row(pins.apart, full("OB"), (*full("B"), *full("O"))),
        Row(
            dyad_rrp.rrp_between,
            ("B_along", "rod_across", "low", "high"),
            (*full("OB"), *GUIDE, "guide_cos_lo", "guide_sin_lo", "offset", "offset_lo", "rod_length", "rod_length_lo"),
        ),
        Row(dyad_rrp.rrp_noise, ("low_noise",)),
        Row(planar.identity, ("high_noise",), ("low_noise",)),
        Row(planar.identity, ("noise",), ("low_noise",)),
        Row(slider_crank.slider_position, ("x_slider",), ("B_along", "rod_along")),
        Row(moving_guide.on_guide, ("OCx", "OCy"), ("x_slider", "offset", *GUIDE)),
        Row(moving_guide.relative_velocity, relative, ("uBx", "uBy", *guide_motion)),
        Row(moving_guide.along_and_across, ("minus_crank_across", "crank_along"), (*relative, *GUIDE)),
        Row(planar.opposite, ("crank_across",), ("minus_crank_across",)),
        Row(dyad_rrp.rrp_velocity_ratios, ("ratio3", "ratio_slider")),
        Row(moving_guide.relative_slope, ("a_B_guide_x", "a_B_guide_y"), ("uBx_slope", "uBy_slope", *slope_inputs)),
        Row(
            dyad_rrp.rrp_accelerations,
            ("slope3", "slope_slider"),
            ("a_B_guide_x", "a_B_guide_y", "ratio3", *ROD, *GUIDE),
        ),
        *rates("slider"),
        Row(planar.vector_sum, ("Cx", "Cy"), ("Bx", "By", "r3x", "r3y")),
        Row(pins.link_low_words, FROM_B, (*full("B"), "r3x", "r3y")),
        *_closed(),
        Row(planar.point_velocity, ("uCx", "uCy"), ("uBx", "uBy", "ratio3", "r3x", "r3y")),
        Row(
            planar.point_acceleration,
            ("uCx_slope", "uCy_slope"),
            ("uBx_slope", "uBy_slope", "ratio3", "slope3", "r3x", "r3y"),
        ),
    ]


def rates(name: str) -> Rows:
    """Return the rows of a part's velocity and acceleration along its guide."""
    rates = ("omega2", "alpha2", f"ratio_{name}", f"slope_{name}")
    return [
        Row(planar.product, (f"v_{name}",), ("omega2", f"ratio_{name}")),
        Row(crank_driven.angular_acceleration, (f"a_{name}",), rates),
    ]


def slider_rows() -> Rows:
    """Return the rows of a slider's motion from its position along its guide: vector from O, velocity and slope."""
    guiding = ("guide_ratio", "guide_slope", "OCx", "OCy", "ratio_slider", *GUIDE)
    return [
        Row(moving_guide.on_guide, ("OCx", "OCy"), ("x_slider", "offset", *GUIDE)),
        Row(
            moving_guide.sliding_velocity,
            ("uCx", "uCy"),
            ("uOx", "uOy", "guide_ratio", "OCx", "OCy", "ratio_slider", *GUIDE),
        ),
        Row(moving_guide.guiding_slope, ("guiding_x", "guiding_y"), ("uOx_slope", "uOy_slope", *guiding)),
        Row(planar.along, ("sliding_x", "sliding_y"), ("slope_slider", *GUIDE)),
        Row(planar.vector_sum, ("uCx_slope", "uCy_slope"), ("guiding_x", "guiding_y", "sliding_x", "sliding_y")),
    ]


def _closed() -> Rows:
    """Return the rows that follow from the factors low and high."""
    from_O = full("OC_line")
    line = (*GUIDE, "guide_cos_lo", "guide_sin_lo", "offset", "offset_lo")
    return [
        Row(dyad_rrp.rrp_close, ("r3x", "r3y", "rod_along", "inverse_rod_along")),
        Row(dyad_rrp.rrp_status, ("closure",)),
        Row(dyad_rrp.rod_transmission_angle, ("transmission_angle",)),
        Row(pins.between, from_O, ("Cx", "Cy", 0.0, 0.0, *full("O"))),
        Row(pins.excess_square, ("B_missing",), ("r3x", "r3y", *FROM_B, "rod_length", "rod_length_lo")),
        Row(pins.excess_component, ("guide_missing",), (*from_O, *line)),
        Row(planar.opposite, ("minus_guide_sin",), ("guide_sin",)),
        Row(
            pins.newton_step,
            ("Cx_lo", "Cy_lo"),
            ("B_missing", "guide_missing", "r3x", "r3y", "minus_guide_sin", "guide_cos", "inverse_rod_along"),
        ),
        Row(planar.vector_sum, ("r3x_lo", "r3y_lo"), (*FROM_B, "Cx_lo", "Cy_lo")),
    ]


def grip() -> Rows:
    """Return the rows of the signal that is positive where friction does not wedge the slider."""
    return [
        Row(planar.product, ("along_squared",), ("low", "high")),
        Row(coulomb.grip, ("grip",), ("along_squared", "rod_across", "friction")),
        Row(planar.product, ("grip_noise",), ("low_noise", "rod_length")),
    ]


def forces() -> Rows:
    """Return the rows of the guide's force on the slider, and of the forces at C and B, where the rod has no drive."""
    return [
        Row(slider_crank.moment_on_rod, ("moment_r3",)),
        Row(
            slider_crank.guide_force,
            ("normal_force", "friction_force", "wedging", "rod_force_across", "rod_force_along"),
            ("inverse_rod_along", "rod_across", "moment_r3", "Q4x", "Q4y", *GUIDE, "direction"),
        ),
        *from_guide(),
    ]


def forces_from_friction() -> Rows:
    """Return the rows of the same forces where the friction is known."""
    along = ("rod_force_across", "rod_force_along")
    return [
        Row(slider_crank.moment_on_rod, ("moment_r3",)),
        Row(slider_crank.guide_force_from_friction, ("normal_force", *along)),
        *by_addition(),
    ]


def from_guide() -> Rows:
    """Return the rows of the forces by addition, and of the status."""
    return [*by_addition(), Row(coulomb.jammed_status, ("jam_status",), ("closure", "wedging"))]


def by_addition() -> Rows:
    """Return the rows of the forces by addition, and of the guide's moment about C."""
    return [
        Row(coulomb.direction_of_sliding, ("direction",), ("friction", "v_slider", "omega2", "noise")),
        Row(slider_crank.from_guide_axes, ("F14x", "F14y"), ("normal_force", "friction_force", *GUIDE)),
        Row(slider_crank.from_guide_axes, ("F43x", "F43y"), ("rod_force_across", "rod_force_along", *GUIDE)),
        Row(crank_driven.coupler_balance, ("F32x", "F32y")),
        Row(planar.opposite, ("T14",), ("N4",)),
        Row(planar.product, ("friction_power",), ("friction_force", "v_slider")),
    ]
