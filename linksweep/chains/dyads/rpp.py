"""Rows of the dyad of a slider with a slot, in the names of a scotch yoke: slider 4, pin B in its slot.

C is the slider's centre, where the slot crosses the guide; O the origin of the guide's axes. `in_slot` is the position
of B along the slot from C. The guide's force on the slider has a moment about C; that of the slot on the pin has none.
"""

from __future__ import annotations

from linksweep.chains.dyads.names import Slide, full
from linksweep.chains.dyads.rrp import GUIDE, rates, slider_rows
from linksweep.chains.dyads.rrr import Rows
from linksweep.engine.quantity import Limit, Row
from linksweep.physics import coulomb
from linksweep.physics.algebra import planar
from linksweep.physics.closures import dyad_prp, dyad_rpp, moving_guide, pins, slider_crank

SLIDE = (Limit("C", ("ratio_slider",), ("noise",), "jump"),)
SLOT = (Limit("C", ("ratio_in_slot",), ("noise",), "jump"),)
"""Limits of friction: where the slider, and the pin in its slot, turn round."""
EDGE_NOISE = ("edge_noise", "edge_noise", "slot_edge_noise", "slot_edge_noise")
BOTH = Limit("C", ("edge", "opposite_edge", "slot_edge", "slot_opposite_edge"), EDGE_NOISE, "contact")
"""Limits of friction that depend on the forces: where guide or pin bear nothing."""
CONTACT = Slide("normal_force", "friction_force", "T14", ("direction", *GUIDE, "Cx", "Cy"))
SLOT_CONTACT = Slide("slot_force", "slot_friction_force", "", ("slot_direction", "slot_x", "slot_y", "Bx", "By"))
SLOT_AXIS = ("slot_cos", "slot_sin")


def between_pin_and_guide() -> Rows:
    """Return the rows of the closure between any pin and any guide."""
    relative, slope = ("u_B_guide_x", "u_B_guide_y"), ("a_B_guide_x", "a_B_guide_y")
    guiding = ("uOx_slope", "uOy_slope", "guide_ratio", "guide_slope", "OBx", "OBy", 1.0, *relative)
    return [
        Row(pins.between, full("OB"), (*full("B"), *full("O"))),
        Row(moving_guide.along_and_across, ("B_along", "B_across"), ("OBx", "OBy", *GUIDE)),
        Row(dyad_rpp.rpp_positions, ("x_slider", "in_slot"), ("B_along", "B_across", "offset", *SLOT_AXIS)),
        Row(dyad_rpp.rpp_status, ("closure",)),
        Row(dyad_prp.crossing_angle, ("transmission_angle",), SLOT_AXIS),
        Row(moving_guide.relative_velocity, relative, ("uBx", "uBy", "uOx", "uOy", "guide_ratio", "OBx", "OBy")),
        Row(moving_guide.along_and_across, ("u_B_along", "u_B_across"), (*relative, *GUIDE)),
        Row(dyad_rpp.rpp_positions, ("ratio_slider", "ratio_in_slot"), ("u_B_along", "u_B_across", 0.0, *SLOT_AXIS)),
        Row(moving_guide.relative_slope, slope, ("uBx_slope", "uBy_slope", *guiding)),
        Row(moving_guide.along_and_across, ("a_B_along", "a_B_across"), (*slope, *GUIDE)),
        Row(dyad_rpp.rpp_positions, ("slope_slider", "slope_in_slot"), ("a_B_along", "a_B_across", 0.0, *SLOT_AXIS)),
        *rates("slider"),
        Row(planar.product, ("v_in_slot",), ("omega2", "ratio_in_slot")),
        *slider_rows(),
        Row(planar.vector_sum, ("Cx", "Cy"), ("Ox", "Oy", "OCx", "OCy")),
    ]


def edges() -> Rows:
    """Return the rows of the signals that are 0 where guide or pin bear nothing."""
    second = ("Q4_along_slot", "Q4_across_slot")
    return [
        Row(coulomb.edges_of_cone, ("edge", "opposite_edge", "edge_noise"), ("Q4_along", "Q4_across", "friction")),
        Row(moving_guide.along_and_across, second, ("Q4x", "Q4y", "slot_x", "slot_y")),
        Row(
            coulomb.edges_of_cone,
            ("slot_edge", "slot_opposite_edge", "slot_edge_noise"),
            (*second, "slot_friction"),
        ),
    ]


def forces() -> Rows:
    """Return the rows of the forces of guide on slider and of the slot on the pin, by the signs of both."""
    contacts = ("normal_force", "friction_force", "minus_slot_force", "minus_slot_friction", "solutions")
    return [
        Row(dyad_rpp.standing_noise, ("noise",)),
        Row(coulomb.direction_of_sliding, ("direction",), ("friction", "v_slider", "omega2", "noise")),
        Row(coulomb.direction_of_sliding, ("slot_direction",), ("slot_friction", "v_in_slot", "omega2", "noise")),
        Row(planar.opposite, ("minus_slot_direction",), ("slot_direction",)),
        Row(moving_guide.along_and_across, ("Q4_along", "Q4_across"), ("Q4x", "Q4y", *GUIDE)),
        Row(
            coulomb.two_sliding_contacts,
            contacts,
            ("Q4_along", "Q4_across", "direction", *SLOT_AXIS, "minus_slot_direction"),
        ),
        Row(planar.to_ground_axes, ("slot_x", "slot_y"), (*SLOT_AXIS, 1.0, *GUIDE)),
        Row(planar.opposite, ("slot_force",), ("minus_slot_force",)),
        Row(planar.opposite, ("slot_friction_force",), ("minus_slot_friction",)),
        Row(slider_crank.from_guide_axes, ("F14x", "F14y"), ("normal_force", "friction_force", *GUIDE)),
        Row(planar.vector_sum, ("F42x", "F42y"), ("F14x", "F14y", "Q4x", "Q4y")),
        Row(dyad_rpp.guide_moment, ("T14",)),
        Row(coulomb.solutions_status, ("jam_status",), ("closure", "solutions")),
        Row(planar.product, ("friction_power",), ("friction_force", "v_slider")),
        Row(planar.product, ("slot_friction_power",), ("slot_friction_force", "v_in_slot")),
    ]
