"""Rows and quantities of any machine of links: of each link, joint and load, and their sums."""

from __future__ import annotations

from collections.abc import Mapping

from linksweep.chains.rows import rounding_error
from linksweep.chains.rows.bodies import Body, motion_quantities, pin_force_quantities, pin_force_rows
from linksweep.chains.rows.load_forms import Form, action_powers, action_quantities, action_rows
from linksweep.chains.rows.pins import Pins, pin_quantities, pin_rows
from linksweep.engine.quantity import Quantity, Row, Total
from linksweep.physics import power, reduced_inertia
from linksweep.physics.algebra import planar

Bodies = tuple[Body, ...]
Loads = tuple[Form, ...]


def machine_rows(bodies: Bodies, joints: Pins, loads: Loads, **closure: str | float) -> list[Row | Total]:
    """Return all rows but those of the closure and of the drive; `closure` as in `rounding_error.row`."""
    rows = [row for body in bodies for row in body.rows()] + action_rows(loads, bodies)
    for i, j in joints.values():
        rows += pin_force_rows(i, j)
    return [*rows, *pin_rows(joints, bodies), *_sums(bodies, loads), rounding_error.row(joints, closure)]


def power_rows(unknown: str, rate: str, bodies: Bodies, loads: Loads, *losses: str) -> list[Row | Total]:
    """Return rows of the power of the drive, its unknown times its rate, and of the residual of all powers."""
    terms = [term for body in bodies for term in body.powers()] + action_powers(loads)
    return [
        Row(planar.product, ("power",), (unknown, rate)),
        Total("power_size", tuple(f"power_size{body.number}" for body in bodies)),
        Row(power.power_residual, ("power_residual",), ("power_size", "power", *losses, *terms)),
    ]


def machine_quantities(bodies: Bodies, joints: Pins, links: Mapping[int, str], loads: Loads) -> list[Quantity]:
    """Return the quantities of all links, joints and loads; `links` are the roles by number, with the ground."""
    quantities = _quantities_of_sums()
    for body in bodies:
        quantities += motion_quantities(body)
    for joint, (i, j) in joints.items():
        is_pin = joint[0].isupper()
        quantities += pin_force_quantities(i, j, f"pin {joint}" if is_pin else f"the {joint}", links)
    return quantities + pin_quantities(joints, links) + action_quantities(loads)


def _sums(bodies: Bodies, loads: Loads) -> list[Row | Total]:
    """Return rows of all moving links together: shaking, reduced inertia, powers, and power that the drive feeds."""
    sums = {"Fsx": "shaking{}x", "Fsy": "shaking{}y", "Ms": "shaking{}m", "inertia_power": "inertia_power{}"}
    sums |= {"gravity_power": "gravity_power{}", "reduced_inertia": "reduced_inertia{}"}
    sums |= {"reduced_inertia_slope": "reduced_inertia_slope{}"}
    return [
        *(Total(name, tuple(part.format(body.number) for body in bodies)) for name, part in sums.items()),
        Total("load_power", tuple(action_powers(loads))),
        Row(planar.square, ("Fs_squared",), ("Fsx", "Fsy")),
        Row(planar.root, ("Fs",), ("Fs_squared",)),
        Row(reduced_inertia.kinetic_energy, ("kinetic_energy",)),
        Row(planar.opposite, ("reduced_torque",), ("work",)),
        Row(power.power_fed, ("power_fed",)),
        Row(power.power_regenerated, ("power_regenerated",)),
    ]


def _quantities_of_sums() -> list[Quantity]:
    """Return the sums over all moving links as quantities."""
    force = "force of the moving links' inertia on the ground (weights and loads not in it)"
    return [
        Quantity("Fsx", "N", f"shaking force: {force}, component along x"),
        Quantity("Fsy", "N", f"shaking force: {force}, component along y"),
        Quantity("Fs", "N", f"magnitude of the shaking force: {force}", squared="Fs_squared"),
        Quantity("Ms", "N m", "shaking moment of the moving links' inertia on the ground about A, counter-clockwise"),
        rounding_error.QUANTITY,
        Quantity("reduced_inertia", "kg m^2", "inertia of all moving links reduced to the crank"),
        Quantity("reduced_inertia_slope", "kg m^2/rad", "derivative of the reduced inertia to the crank angle"),
        Quantity("kinetic_energy", "J", "kinetic energy of all moving links"),
        Quantity("reduced_torque", "N m", "drive reduced to the crank: its work per radian of the crank"),
        Quantity("power_fed", "W", "power of the drive where it feeds the mechanism, else 0"),
        Quantity("power_regenerated", "W", "power that the drive takes back where the mechanism drives it, else 0"),
        Quantity("inertia_power", "W", "power of all inertia forces, positive when they feed the mechanism"),
        Quantity("gravity_power", "W", "power of all weights, positive when they feed the mechanism"),
        Quantity("load_power", "W", "power of all loads, springs and dampers, positive when they feed the mechanism"),
    ]
