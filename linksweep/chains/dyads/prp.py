"""Rows of the dyad of two sliders that share pin C: slider 3 on the first guide, slider 4 on the second, both known.

O and P are the origins of the guides' axes. Each guide's force on its slider has a moment about C.
"""

from __future__ import annotations

from linksweep.chains.dyads.names import Slide, full
from linksweep.chains.dyads.rrp import GUIDE, rates, slider_rows
from linksweep.chains.dyads.rrr import Certain, Rows
from linksweep.engine.quantity import Limit, Row
from linksweep.physics import coulomb
from linksweep.physics.algebra import planar
from linksweep.physics.closures import dyad_prp, dyad_rpp, moving_guide, pins, slider_crank
from linksweep.physics.closures.crank_angle import CHANGE_POINT_NOISE

CERTAIN: Certain = {
    "crossing_cos": 1.0,
    "crossing_cos_lo": 1.0,
    "crossing_sin": 1.0,
    "gap": "size",
    "second_gap": "size",
}
CERTAIN_BEYOND: Certain = {"Cx_lo": "size", "Cy_lo": "size"}
TOGGLE = Limit("C", ("low",), ("low_noise",))
"""Limit of the dyad's motion: where the guides are parallel."""
EDGE_NOISE = ("edge_noise", "edge_noise", "second_edge_noise", "second_edge_noise")
WEDGED = Limit("C", ("grip", "second_grip"), ("low_noise", "low_noise"), "wedge")
SLIDE = WEDGED, Limit("C", ("ratio_slider",), ("noise",), "jump")
SECOND_SLIDE = WEDGED, Limit("C", ("ratio_second",), ("noise",), "jump")
"""Limits of friction: where it may wedge the sliders, and where each turns round."""
BOTH = Limit("C", ("edge", "opposite_edge", "second_edge", "second_opposite_edge"), EDGE_NOISE, "contact")
"""Limits of friction that depend on the forces: where one of the guides bears nothing."""
SECOND = ("second_guide_cos", "second_guide_sin")
CONTACT = Slide("normal_force", "friction_force", "T13", ("direction", *GUIDE, "Cx", "Cy"))
SECOND_CONTACT = Slide("second_normal_force", "second_friction_force", "T14", ("second_direction", *SECOND, "Cx", "Cy"))
LINE = (*GUIDE, "guide_cos_lo", "guide_sin_lo", "offset", "offset_lo")
SECOND_LINE = (*SECOND, "second_guide_cos_lo", "second_guide_sin_lo", "second_offset", "second_offset_lo")


def between_guides() -> Rows:
    """Return the rows of the closure between any two guides."""
    crossing, first, second = ("crossing_cos", "crossing_cos_lo"), full("OC_line"), full("PC_line")
    ways = ("wx", "wy"), (*GUIDE, *SECOND, "crossing_sin")
    turning = ("second_guide_ratio", "second_guide_slope")
    return [
        Row(dyad_prp.prp_crossing, (*crossing, "crossing_sin", "low"), (*LINE[:4], *SECOND_LINE[:4])),
        Row(planar.identity, ("low_noise",), (CHANGE_POINT_NOISE,)),
        Row(dyad_prp.prp_status, ("closure",)),
        Row(dyad_prp.crossing_angle, ("transmission_angle",), ("crossing_cos", "crossing_sin")),
        Row(pins.between, full("OP"), (*full("P"), *full("O"))),
        Row(pins.between, full("PO"), (*full("O"), *full("P"))),
        Row(dyad_prp.prp_gap, ("gap", "size"), (*full("OP"), *SECOND_LINE, "offset", "offset_lo", *crossing)),
        Row(
            dyad_prp.prp_gap,
            ("second_gap", "second_size"),
            (*full("PO"), *LINE, "second_offset", "second_offset_lo", *crossing),
        ),
        Row(dyad_prp.prp_positions, ("x_slider", "x_second", "inverse_crossing_sin")),
        Row(moving_guide.on_guide, ("PCx", "PCy"), ("x_second", "second_offset", *SECOND)),
        Row(planar.point_velocity, ("vgx", "vgy"), ("uOx", "uOy", "guide_ratio", "OCx", "OCy")),
        Row(planar.point_velocity, ("vhx", "vhy"), ("uPx", "uPy", "second_guide_ratio", "PCx", "PCy")),
        Row(planar.difference, ways[0], ("vhx", "vhy", "vgx", "vgy")),
        Row(dyad_prp.prp_rates, ("ratio_slider", "ratio_second"), (*ways[0], *ways[1])),
        Row(
            moving_guide.guiding_slope,
            ("ahx", "ahy"),
            ("uPx_slope", "uPy_slope", *turning, "PCx", "PCy", "ratio_second", *SECOND),
        ),
        Row(planar.difference, ("zx", "zy"), ("ahx", "ahy", "guiding_x", "guiding_y")),
        Row(dyad_prp.prp_rates, ("slope_slider", "slope_second"), ("zx", "zy", *ways[1])),
        *rates("slider"),
        *rates("second"),
        *slider_rows(),
        Row(planar.vector_sum, ("Cx", "Cy"), ("Ox", "Oy", "OCx", "OCy")),
        Row(pins.between, first, ("Cx", "Cy", 0.0, 0.0, *full("O"))),
        Row(pins.between, second, ("Cx", "Cy", 0.0, 0.0, *full("P"))),
        Row(pins.excess_component, ("first_missing",), (*first, *LINE)),
        Row(pins.excess_component, ("second_missing",), (*second, *SECOND_LINE)),
        Row(planar.opposite, ("minus_guide_sin",), ("guide_sin",)),
        Row(planar.opposite, ("minus_second_sin",), ("second_guide_sin",)),
        Row(
            pins.newton_step,
            ("Cx_lo", "Cy_lo"),
            (
                *("first_missing", "second_missing", "minus_guide_sin", "guide_cos"),
                *("minus_second_sin", "second_guide_cos", "inverse_crossing_sin"),
            ),
        ),
    ]


def grip() -> Rows:
    """Return the row of the signals that are positive where friction does not wedge the sliders."""
    return [Row(coulomb.grips_of_two, ("grip", "second_grip"), ("low", "friction", "second_friction"))]


def edges() -> Rows:
    """Return the rows of the signals that are 0 where one of the guides bears nothing."""
    second = ("Q_along_second", "Q_across_second")
    return [
        Row(coulomb.edges_of_cone, ("edge", "opposite_edge", "edge_noise"), ("Q_along", "Q_across", "friction")),
        Row(moving_guide.along_and_across, second, ("Qx", "Qy", *SECOND)),
        Row(
            coulomb.edges_of_cone,
            ("second_edge", "second_opposite_edge", "second_edge_noise"),
            (*second, "second_friction"),
        ),
    ]


def forces() -> Rows:
    """Return the rows of the guides' forces on the sliders, by the signs of both, and of slider 4 on slider 3."""
    contacts = ("normal_force", "friction_force", "second_normal_force", "second_friction_force", "solutions")
    pressing = ("Q_along", "Q_across", "direction", "crossing_cos", "crossing_sin", "second_direction")
    return [
        *_pressing(),
        Row(coulomb.two_sliding_contacts, contacts, pressing),
        *_by_addition(),
        Row(coulomb.solutions_status, ("jam_status",), ("closure", "solutions")),
    ]


def forces_from_friction() -> Rows:
    """Return the rows of the same forces where the friction of both is known."""
    pressing = ("Q_along", "Q_across", "friction_force", "crossing_cos", "crossing_sin", "second_friction_force")
    return [
        *_pressing(),
        Row(coulomb.two_contacts_from_friction, ("normal_force", "second_normal_force"), pressing),
        *_by_addition(),
    ]


def _pressing() -> Rows:
    """Return the rows of μ·sign(v) of both guides, and of what presses on both, in the axes of the first."""
    return [
        Row(dyad_rpp.standing_noise, ("noise",), ("OCx", "OCy", "offset")),
        Row(coulomb.direction_of_sliding, ("direction",), ("friction", "v_slider", "omega2", "noise")),
        Row(coulomb.direction_of_sliding, ("second_direction",), ("second_friction", "v_second", "omega2", "noise")),
        Row(planar.vector_sum, ("Qx", "Qy"), ("Q3x", "Q3y", "Q4x", "Q4y")),
        Row(moving_guide.along_and_across, ("Q_along", "Q_across"), ("Qx", "Qy", *GUIDE)),
    ]


def _by_addition() -> Rows:
    """Return the rows of forces, moments and powers from normal forces and friction."""
    return [
        Row(slider_crank.from_guide_axes, ("F13x", "F13y"), ("normal_force", "friction_force", *GUIDE)),
        Row(
            slider_crank.from_guide_axes,
            ("F14x", "F14y"),
            ("second_normal_force", "second_friction_force", *SECOND),
        ),
        Row(planar.vector_sum, ("F43x", "F43y"), ("F14x", "F14y", "Q4x", "Q4y")),
        Row(planar.opposite, ("T13",), ("N3",)),
        Row(planar.opposite, ("T14",), ("N4",)),
        Row(planar.product, ("friction_power",), ("friction_force", "v_slider")),
        Row(planar.product, ("second_friction_power",), ("second_friction_force", "v_second")),
    ]
