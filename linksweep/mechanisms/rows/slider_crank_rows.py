"""Rows of the slider-crank: the physics function that computes each of its quantities."""

from __future__ import annotations

from functools import lru_cache

from linksweep.engine.quantity import Quantity, Row, Table, Total
from linksweep.mechanisms.dyads import rrp
from linksweep.mechanisms.rows import bodies
from linksweep.mechanisms.rows.crank import between_rows, near_toggle_rows, straight_rows
from linksweep.mechanisms.rows.load_forms import Form
from linksweep.mechanisms.rows.whole_machine import machine_quantities, machine_rows, power_rows
from linksweep.physics import advantage, coulomb, crank_driven
from linksweep.physics.algebra import planar
from linksweep.physics.closures import dyad_rrp, slider_crank

LINKS = {1: "ground", 2: "crank", 3: "rod", 4: "slider"}
DRIVES = {"crank": "T12", "coupler": "T13"}
DRIVEN = {"crank": "omega2", "coupler": "omega3"}
PINS = {"A": (1, 2), "B": (3, 2), "C": (4, 3), "guide": (1, 4)}
JOURNALS = {"A": 2, "B": 2, "C": 4}
"""As in engines: the crank carries crankshaft and crankpin, the piston the gudgeon pin; the rod has both its bushes."""
BODIES = (
    bodies.CRANK,
    bodies.on_crank_pin(3, "rod", "ratio3", "slope3"),
    bodies.Body(
        4,
        "slider",
        ("vCx", "vCy"),
        ("aCx", "aCy"),
        pin_position=("Cx", "Cy"),
        pin_ratio=("uCx", "uCy"),
        pin_slope=("uCx_slope", "uCy_slope"),
    ),
)


@lru_cache(maxsize=64)
def table(drive: str, loads: tuple[Form, ...], turned: bool) -> Table:
    """Return the table for a drive, loads of these forms, and a guide that may be turned."""
    rows = [
        *(near_toggle_rows("upright") if turned else straight_rows("sin2", "cos2", minus_sin=True)),
        *bodies.crank_pin_rows(),
        *_position(),
        *_rates(),
        *_forces(drive),
        *_status(drive, loads),
        *power_rows(DRIVES[drive], DRIVEN[drive], BODIES, loads, "friction_power"),
        Row(planar.product, ("friction_power",), ("friction_force", "v_slider")),
    ]
    rows += machine_rows(BODIES, PINS, loads, **rrp.CERTAIN_ON_CRANK) + _transmission()
    rows += [*bodies.arm_rows(2, "R12", "R32"), *bodies.arm_rows(3, "R23", "R43"), *bodies.arm_rows(4, "R34")]
    return Table("theta2", tuple(rows), tuple(_quantities(drive, loads)), between_rows("upright_cos", "upright_sin"))


def _position() -> list[Row | Total]:
    return [
        Row(slider_crank.near_toggle_widths, ("near_toggle_near", "near_toggle_far")),
        Row(slider_crank.toggle_cosines, ("low_cos", "low_cos_lo", "high_cos", "high_cos_lo")),
        Row(slider_crank.guide_components, ("crank_along", "crank_across", "rod_across")),
        Row(slider_crank.closure_factors, ("low", "high")),
        Row(slider_crank.closure_noise, ("low_noise", "high_noise")),
        Row(slider_crank.length_noise, ("noise",)),
        Row(slider_crank.assembly, ("assembly",)),
        Row(dyad_rrp.rrp_close, ("r3x", "r3y", "rod_along", "inverse_rod_along")),
        Row(dyad_rrp.rod_transmission_angle, ("transmission_angle",)),
        Row(slider_crank.slider_position, ("x_slider",)),
        Row(planar.direction, ("theta3",), ("r3x", "r3y")),
        Row(planar.vector_sum, ("Cx", "Cy"), ("r2x", "r2y", "r3x", "r3y")),
    ]


def _rates() -> list[Row | Total]:
    return [
        Row(dyad_rrp.rrp_velocity_ratios, ("ratio3", "ratio_slider")),
        Row(planar.product, ("omega3",), ("omega2", "ratio3")),
        Row(planar.product, ("v_slider",), ("omega2", "ratio_slider")),
        Row(dyad_rrp.rrp_accelerations, ("alpha3", "a_slider")),
        Row(planar.along, ("vCx", "vCy"), ("v_slider", "guide_cos", "guide_sin")),
        Row(planar.along, ("aCx", "aCy"), ("a_slider", "guide_cos", "guide_sin")),
    ]


def _transmission() -> list[Row | Total]:
    """Return rows of the ratios of the slider's velocity and force to the crank's, and of their slopes."""
    rod, guide = ("ratio3", "rod_along", "rod_across", "inverse_rod_along"), ("guide_cos", "guide_sin")
    return [
        Row(dyad_rrp.rrp_accelerations, ("slope3", "slope_slider"), ("uBx_slope", "uBy_slope", *rod, *guide)),
        Row(planar.along, ("uCx", "uCy"), ("ratio_slider", *guide)),
        Row(planar.along, ("uCx_slope", "uCy_slope"), ("slope_slider", *guide)),
        Row(planar.identity, ("velocity_ratio",), ("ratio_slider",)),
        Row(advantage.mechanical_advantage, ("mechanical_advantage",), ("velocity_ratio", "crank_length", 1.0)),
    ]


def _forces(drive: str) -> list[Row | Total]:
    """Return rows of the guide's force, by the moment equation without the drive, and of the others, by addition."""
    lever = {
        "crank": ("inverse_rod_along", "rod_across", "moment_r3"),
        "coupler": ("inverse_crank_along", "crank_across", "moment_r2"),
    }[drive]
    guide = ("guide_cos", "guide_sin")
    by_crank = drive == "crank"
    torque = Row(planar.opposite, ("T12",), ("work",)) if by_crank else Row(slider_crank.torque_on_rod, ("T13",))
    return [
        Row(slider_crank.moment_on_rod, ("moment_r3",)),
        Row(slider_crank.inverse_lever, ("inverse_crank_along",)),
        Row(crank_driven.moment_on_crank, ("moment_r2",)),
        Row(coulomb.direction_of_sliding, ("direction",), ("friction", "v_slider", "omega2", "noise")),
        Row(
            slider_crank.guide_force,
            ("normal_force", "friction_force", "wedging", "rod_force_across", "rod_force_along"),
            (*lever, "Q4x", "Q4y", *guide, "direction"),
        ),
        Row(slider_crank.from_guide_axes, ("F14x", "F14y"), ("normal_force", "friction_force", *guide)),
        Row(slider_crank.from_guide_axes, ("F43x", "F43y"), ("rod_force_across", "rod_force_along", *guide)),
        Row(crank_driven.coupler_balance, ("F32x", "F32y")),
        Row(crank_driven.crank_balance, ("F12x", "F12y")),
        Row(planar.opposite, ("T14",), ("N4",)),
        Row(slider_crank.work_on_crank, ("work",)),
        torque,
        Row(slider_crank.friction_row, ("friction_row_x", "friction_row_y")),
        Total("friction_rhs", ()),
    ]


def _status(drive: str, loads: tuple[Form, ...]) -> list[Row | Total]:
    """Return rows of the status: closure, then leverage of the drive, then jamming, then full turns for its loads."""
    leverage = Row(planar.identity, ("leverage_status",), ("closure",))
    if drive == "coupler":
        of_crank = ("closure", "crank_along", "crank_length", 1.0)
        leverage = Row(crank_driven.drive_status, ("leverage_status",), of_crank)
    jam = Row(coulomb.jammed_status, ("jam_status",), ("leverage_status", "wedging"))
    cycle = Row(planar.identity, ("status",), ("jam_status",))
    if any(form.full_turns for form in loads):
        cycle = Row(slider_crank.no_cycle_status, ("status",), ("jam_status", "assembly"))
    return [Row(dyad_rrp.rrp_status, ("closure",)), leverage, jam, cycle]


def _quantities(drive: str, loads: tuple[Form, ...]) -> list[Quantity]:
    torque = bodies.drive_torque(DRIVES[drive], drive)
    return [
        Quantity("theta3", "degree", "angle of the rod B→C from x, counter-clockwise, in (-180, 180]"),
        Quantity("transmission_angle", "degree", "acute angle between the rod and the guide's normal"),
        Quantity("x_slider", "m", "position of the slider along the guide, from the foot of A on it"),
        Quantity("v_slider", "m s-1", "velocity of the slider along the guide"),
        Quantity("a_slider", "m s-2", "acceleration of the slider along the guide"),
        Quantity("T14", "N m", "moment of the guide on the slider about C, positive counter-clockwise"),
        Quantity("normal_force", "N", "force of the guide on the slider across it, positive to the guide's left"),
        Quantity("friction_force", "N", "force of the guide on the slider along it"),
        Quantity("friction_power", "W", "power of friction on the slider, never positive"),
        *bodies.position_quantities("B", "C"),
        *bodies.drive_quantities(torque, "drive, friction, loads, gravity and inertia"),
        Quantity("velocity_ratio", "m rad-1", "velocity of the slider per angular velocity of the crank"),
        Quantity("mechanical_advantage", "1", "force of the slider per force on the crank at B square to it"),
        *machine_quantities(BODIES, PINS, LINKS, loads),
    ]
