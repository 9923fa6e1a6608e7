"""Cylinders of a machine of dyads: those that follow, or drive, and those of given length (struts)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linksweep.chains.rows.bodies import Source, xy
from linksweep.chains.topology import Side
from linksweep.engine.quantity import Quantity
from linksweep.physics.algebra import planar
from linksweep.physics.closures import cylinder

if TYPE_CHECKING:
    from linksweep.chains.forces import Forces
    from linksweep.chains.motion import Motion


def place_cylinder(motion: Motion, role: str) -> None:
    """Add rows and quantities of a cylinder's length and of its rate: those that are given, or else from the places of
    its pins."""
    P, Q = motion.topology.cylinders[role]
    length, lengthening, axis = f"length_{role}", f"lengthening_{role}", xy(f"axis_{role}")
    motion.row(planar.difference, xy(f"span_{role}"), *motion.place(Q)[:2], *motion.place(P)[:2])
    if role in motion.topology.struts:
        motion.row(planar.identity, (length,), f"{role}_length")
        motion.row(planar.identity, (lengthening,), f"{role}_length_slope")
        motion.row(cylinder.direction, axis, *xy(f"span_{role}"), length)
    else:
        motion.row(cylinder.span, (length, *axis), *xy(f"span_{role}"))
        motion.row(planar.difference, xy(f"u_span_{role}"), *motion.motion(Q, "u"), *motion.motion(P, "u"))
        motion.row(planar.dot, (lengthening,), *xy(f"u_span_{role}"), *axis)
    motion.row(planar.product, (f"rate_{role}",), "omega2", lengthening)
    motion.quantities += [
        Quantity(length, "m", f"length of the cylinder {role}, from pin {P} to pin {Q}"),
        Quantity(f"rate_{role}", "m/s", f"velocity at which the cylinder {role} lengthens"),
    ]


def force_quantity(role: str) -> Quantity:
    """Return the force of a cylinder."""
    return Quantity(f"force_{role}", "N", f"force of the cylinder {role} on its pins, positive pushing them apart")


def side_of_strut(motion: Motion, digit: int, letter: str, word: str, side: Side) -> dict[str, Source]:
    """Return the names of a cylinder of given length as a side of a dyad, without mass, about its pin (`letter`).

    The pin's motion is that to which the lengthening has been added: the rest is a turning link's.
    """
    role, pin, vector = side.role, side.pin, xy(f"r_{side.role}")
    length, slope, curvature = (f"{role}_length{form}" for form in ("", "_slope", "_curvature"))
    u, u_slope = xy(f"extended_u_{role}"), xy(f"extended_slope_{role}")
    motion.row(cylinder.extended_velocity, u, *motion.motion(pin, "u"), slope, length, *vector)
    turning = (f"ratio_{role}", slope, curvature, length, *vector)
    motion.row(cylinder.extended_slope, u_slope, *motion.motion(pin, "u", "_slope"), *turning)
    names: dict[str, Source] = {f"{word}_length": length, f"{word}_length_lo": 0.0}
    for axis in range(2):
        names |= {f"u{letter}{'xy'[axis]}": u[axis], f"u{letter}{'xy'[axis]}_slope": u_slope[axis]}
    return names | {f"Q{digit}x": 0.0, f"Q{digit}y": 0.0, f"N{digit}": 0.0}


def force_strut(forces: Forces, side: Side, pin: str, push: str) -> None:
    """Add the row of a strut's force, from its push on the pin that its dyad finds, and those of its work and power."""
    role = side.role
    last = forces.topology.cylinders[role][1]
    forces.row(planar.dot, (f"force_{role}_outward",), *xy(push), *xy(f"axis_{role}"))
    outward = planar.identity if pin == last else planar.opposite
    forces.row(outward, (f"force_{role}",), f"force_{role}_outward")
    forces.row(planar.product, (f"work_of_{role}",), f"force_{role}", f"{role}_length_slope")
    forces.row(planar.product, (f"power_of_{role}",), f"force_{role}", f"rate_{role}")
    if forces.coupling is not None and any(role in step.roles for step in forces.bearing):
        forces.coupling.struts.append(role)
    else:
        forces.work.append(f"work_of_{role}")
    forces.powers.append(f"power_of_{role}")


def drive_by_cylinder(forces: Forces, role: str) -> None:
    """Add rows of the force of a driving cylinder on its pins, and apply it to their links."""
    P, Q = forces.topology.cylinders[role]
    forces.row(planar.along, xy(f"push_{role}_{Q}"), f"force_{role}", *xy(f"axis_{role}"))
    forces.opposite(f"push_{role}_{P}", f"push_{role}_{Q}")
    for pin in (P, Q):
        forces.push(Side(role, pin))
