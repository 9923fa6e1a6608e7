"""Place and forces of a second crank that gears turn.

The torque of the wheel on the crank, T32 for link 3 on link 2, is an unknown; with a pressure angle the force of the
teeth on the crank, F32, acts at the pitch point and has this moment about the crank's pivot.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING

from linksweep.chains.between_links import force_name, name_between
from linksweep.chains.dyads.names import Names, full
from linksweep.chains.dyads.rrr import Rows
from linksweep.chains.rows.bodies import Equation, Source, pin_force_quantities, pin_force_rows, xy
from linksweep.chains.topology import Gear, Topology
from linksweep.engine.quantity import Quantity, Row
from linksweep.physics.algebra import planar
from linksweep.physics.closures import gears, pins

if TYPE_CHECKING:
    from linksweep.chains.forces import Forces
    from linksweep.chains.motion import Motion

Vector = tuple[Source, ...]
Geared = tuple[tuple[str, Fraction], ...]
"""Roles of wheels, and their turns per turn of the crank."""


def geared_rows(role: str) -> tuple[str, ...]:
    """Return the names of cosine and sine of the angle of a wheel less its phase, tabulated over the crank angle for
    a ratio that is no whole number, then of their low words."""
    return tuple(f"geared {role}_{part}" for part in ("cos", "sin", "cos_lo", "sin_lo"))


def place_Gear(motion: Motion, step: Gear) -> None:
    """Add rows of a wheel: its angle is the crank's, times the ratio, and the phase."""
    role, k, ratio = step.link.role, motion.number(step.link.role), float(step.ratio)
    phase: Vector = tuple(f"{role} phase_{part}" for part in ("cos", "sin", "cos_lo", "sin_lo"))
    turned = full(f"turned_{role}_")
    whole = step.ratio.denominator == 1
    unturned = _power(motion, role, abs(int(ratio)), ratio < 0.0) if whole else geared_rows(role)
    motion.row(pins.turned_with_low_words, turned, *unturned, *phase)
    motion.certain |= dict.fromkeys(turned, 1.0)
    motion.row(planar.along, xy(f"r{k}"), f"{role}_length", *turned[:2])
    motion.names[role] = Names(f" {role}")
    motion.turn(step.link, turned, ratio)
    torque = f"torque of link {k} ({role}) on link 2 ({motion.topology.crank}) by the gears, counter-clockwise"
    motion.quantities.append(Quantity(torque_name(motion.topology, role), "N m", torque))


def _power(motion: Motion, role: str, n: int, backwards: bool) -> Vector:
    """Return the names of cos(nθ2) and sin(nθ2) with low words, by repeated multiplication of complex numbers."""
    base: Vector = ("cos2", "sin2", "cos2_lo", "sin2_lo")
    if backwards:
        back = full(f"back_{role}_")
        motion.row(planar.difference, back[1::2], 0.0, 0.0, "sin2", "sin2_lo")
        base = ("cos2", back[1], "cos2_lo", back[3])
    power = base
    for exponent in range(2, n + 1):
        name = full(f"power{exponent}_{role}_")
        motion.row(pins.turned_with_low_words, name, *power, *base)
        motion.certain |= dict.fromkeys(name, 1.0)
        power = name
    return power


def force_Gear(forces: Forces, step: Gear) -> None:
    """Add rows of the torque, and of the force, that the teeth pass on to the crank; then of the wheel on its pin."""
    role, pin, topology = step.link.role, step.link.pin, forces.topology
    k, torque, push = topology.number(role), torque_name(topology, role), xy(f"push_{role}_{pin}")
    forces.act_about(step.link)
    forces.row(gears.torque_on_crank, (torque,), f"L{k}_{pin}", float(step.ratio))
    forces.statuses.append((0.0, 0.0))
    if role in forces.motion.shape.meshed:
        mesh, force = f"mesh_{role}", force_name(k, 2)
        d = forces.motion.place(pin)[:2]
        forces.row(gears.mesh_direction, xy(mesh), torque, *d, float(step.ratio), f"{role}_pressure_slope")
        forces.row(planar.along, xy(force), torque, *xy(mesh))
        forces.row(planar.difference, push, *xy(f"acting{k}"), *xy(force))
        forces.applied[topology.crank].append((force, torque))
    else:
        for axis, out in zip("xy", push, strict=True):
            forces.row(planar.identity, (out,), f"acting{k}{axis}")
        forces.applied[topology.crank].append(("", torque))
    forces.push(step.link)


def torque_name(topology: Topology, role: str) -> str:
    """Return the name of the torque of a wheel on the crank."""
    return name_between("T", topology.number(role), 2)


def gear_rows(motion: Motion) -> Rows:
    """Return rows of the teeth's moments about the centres of gravity, and of the magnitude of their force."""
    rows: Rows = []
    for step in (step for step in motion.topology.steps if isinstance(step, Gear) and step.name in motion.shape.meshed):
        k, (dx, dy, *_) = motion.number(step.name), motion.place(step.link.pin)
        pitch = xy(f"pitch_{step.name}")
        rows += [Row(planar.along, pitch, (float(step.ratio / (step.ratio - 1)), dx, dy)), *pin_force_rows(k, 2)]
        for number in (2, k):
            lever = xy(f"lever_{step.name}_{number}")
            rows.append(Row(planar.difference, lever, (*pitch, *xy(f"G{number}"))))
            rows.append(Row(planar.cross, (f"mesh_{step.name}_on{number}",), (*lever, *xy(f"mesh_{step.name}"))))
    return rows


def teeth_quantities(motion: Motion, names: Mapping[int, str]) -> list[Quantity]:
    """Return the quantities of the forces that teeth pass on."""
    numbers = [motion.number(role) for role in motion.topology.gears if role in motion.shape.meshed]
    return [quantity for k in numbers for quantity in pin_force_quantities(k, 2, "the teeth", names)]


def add_gears(topology: Topology, meshed: frozenset[str], rows: list[Equation], k: int) -> None:
    """Add the torques that gears pass on to the rows of link k."""
    for step in (step for step in topology.steps if isinstance(step, Gear)):
        number, torque, mesh = topology.number(step.name), torque_name(topology, step.name), f"mesh_{step.name}"
        if k not in (2, number):
            continue
        if step.name in meshed:
            for row, name in zip(rows, (*xy(mesh), f"{mesh}_on{k}"), strict=True):
                row.coefficients[torque] = (1.0 if k == 2 else -1.0, name)
        else:
            rows[2].coefficients[torque] = 1.0 if k == 2 else -1.0 / float(step.ratio)
