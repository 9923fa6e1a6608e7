"""Name the results of a solved linkage as linksweep does, in 50 digits; check them against conservation of energy."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchmarks.stress.decimals import Array, Number, Vector, angles, fifty_digits, root
from benchmarks.stress.linkages.constraints import GROUND, Apart, Constraint, OnLine, Pin, Turned
from benchmarks.stress.linkages.multibody import Solution

Results = dict[str, Array]


def named(solution: Solution) -> Results:
    """Return kinematics, forces and the drive's torque or force by name."""
    with fifty_digits():
        return kinematics(solution) | forces(solution)


def kinematics(solution: Solution) -> Results:
    assembly, frames = solution.assembly, solution.frames
    linkages = assembly.linkages
    results: Results = {}
    for body in linkages.bodies:
        k, frame = linkages.number[body.role], frames[body.role]
        if not body.slides:
            results |= {f"theta{k}": angles(frame.u), f"omega{k}": frame.omega, f"alpha{k}": frame.alpha}
    for pin in linkages.pins:
        role = linkages.carriers(pin)[0]
        if role != GROUND:
            results |= _vector(pin, frames[role].at(assembly.pin(role, pin)))
    for line in (c for c in assembly.constraints if isinstance(c, OnLine)):
        if next(body for body in linkages.bodies if body.role == line.j).slides:
            names = (f"{letter}_{line.j}" for letter in "xva")
            results |= dict(zip(names, line.sliding(frames), strict=True))
    for cylinder in linkages.cylinders:
        names = f"length_{cylinder.role}", f"rate_{cylinder.role}"
        results |= dict(zip(names, assembly.cylinder(cylinder).lengthening(frames), strict=True))
    return results


def forces(solution: Solution) -> Results:
    """Return the forces and torques of all constraints."""
    results: Results = {}
    for constraint, values in by_constraint(solution):
        results |= WAYS_OF_FORCES[type(constraint)](solution, constraint, *values)
    for constraint, (value, *_) in by_constraint(solution):
        if isinstance(constraint, Turned) and constraint.j in solution.assembly.ratios:
            results |= _meshed(solution, constraint, value, results)
    return results


def by_constraint(solution: Solution) -> Iterator[tuple[Constraint, list[Array]]]:
    left = list(solution.multipliers)
    for constraint in solution.assembly.constraints:
        yield constraint, left[: constraint.rows]
        left = left[constraint.rows :]


def between(solution: Solution, i: str, j: str) -> tuple[str, int]:
    """Return digits for the reported force between two bodies, and −1 where it is the opposite of that on j.

    The ground acts on the links, and the later link on the earlier.
    """
    linkages = solution.assembly.linkages
    a, b = linkages.number[i], linkages.number[j]
    if GROUND in (i, j) or a > b:
        return linkages.force(a, b)[1:], 1
    return linkages.force(b, a)[1:], -1


def _pin_force(solution: Solution, pin: Pin, x: Array, y: Array) -> Results:
    digits, reported = between(solution, pin.i, pin.j)
    return _vector(f"F{digits}", Vector(x, y) * reported) | {f"F{digits}": root(x * x + y * y)}


def _line_force(solution: Solution, line: OnLine, normal: Array) -> Results:
    digits, reported = between(solution, line.i, line.j)
    u, _ = line.axes(solution.frames)
    speed = line.sliding(solution.frames)[1]
    friction = line.friction * abs(normal) * np.where(speed > 0, -1, np.where(speed < 0, 1, 0))
    vector = u.left * normal + u * friction
    values = {"n": normal * reported, "t": friction * reported, "": root(vector.dot(vector))}
    return {f"F{digits}{axis}": value for axis, value in values.items()} | _vector(f"F{digits}", vector * reported)


def _moment(solution: Solution, turned: Turned, torque: Array) -> Results:
    if turned is solution.assembly.driver:
        return _drive(solution, torque)
    if turned.target:  # gears
        return {}
    digits, reported = between(solution, turned.i, turned.j)
    return {f"T{digits}": torque * reported}


def _drive(solution: Solution, value: Array) -> Results:
    linkages = solution.assembly.linkages
    drive = linkages.drive or linkages.crank
    return {
        f"T{linkages.force(1, linkages.number[drive])[1:]}" if drive in linkages.number else f"force_{drive}": value
    }


def _meshed(solution: Solution, gears: Turned, torque: Array, results: Results) -> Results:
    """Return the forces on the pivots of two wheels whose teeth push with a pressure angle, at the pitch point.

    There, at t of the way from pivot to pivot, both wheels have one velocity: t = ratio (t - 1). Along the line of
    pivots the teeth push external gears apart, and a pinion out of the ring that it runs in.
    """
    assembly, wheels = solution.assembly, (gears.i, gears.j)
    angle = assembly.linkages.gears.get(gears.j, {}).get("pressure_angle")
    if angle is None:
        return {}
    pivots = (
        {*body.pins} & {*assembly.linkages.ground}
        for role in wheels
        for body in assembly.linkages.bodies
        if body.role == role
    )
    A, D = (assembly.pin(GROUND, pin) for (pin,) in pivots)
    line, slope = D - A, assembly.direction(angle)
    pitch = gears.ratio / (gears.ratio - 1)
    across = torque / ((pitch - 1) * line.dot(line))  # over the pivots' distance
    force = line.left * across + line * (abs(across) * slope.y / slope.x * (-1 if np.all(gears.ratio > 0) else 1))
    changed: Results = {}
    for role, sign in zip(wheels, (1, -1), strict=True):
        name = f"F{assembly.linkages.force(1, assembly.linkages.number[role])[1:]}"
        pivot = Vector(results[f"{name}x"], results[f"{name}y"]) + force * sign
        changed |= _vector(name, pivot) | {name: root(pivot.dot(pivot))}
    return changed


def _cylinder_force(solution: Solution, apart: Apart, multiplier: Array) -> Results:
    return {f"force_{apart.role}": multiplier * apart.lengthening(solution.frames)[0]}


WAYS_OF_FORCES = {Pin: _pin_force, OnLine: _line_force, Turned: _moment, Apart: _cylinder_force}


def _vector(name: str, vector: Vector) -> Results:
    return {f"{name}x": vector.x, f"{name}y": vector.y}


# ---- energy


def drive_power(solution: Solution) -> Number:
    """Return the power of the drive [W]."""
    linkages, frames = solution.assembly.linkages, solution.frames
    drive, value = linkages.drive or linkages.crank, solution.multipliers[-1]
    if drive in linkages.number:
        return value * frames[drive].omega
    cylinder = next(c for c in linkages.cylinders if c.role == drive)
    return value * solution.assembly.cylinder(cylinder).lengthening(frames)[1]


def power_terms(solution: Solution) -> list[Number]:
    """Return powers that sum to zero: of drive, cylinders, loads and friction, less the rate of kinetic energy."""
    with fifty_digits():
        assembly, frames = solution.assembly, solution.frames
        terms = [drive_power(solution)]
        for body in assembly.linkages.bodies:
            frame = frames[body.role]
            mass, inertia = assembly.part(body.role, "mass"), assembly.part(body.role, "inertia")
            fx, fy, moment = solution.loads[body.role]
            terms += [fx * frame.v.x, fy * frame.v.y, moment * frame.omega]
            terms += [-mass * frame.v.dot(frame.a), -inertia * frame.omega * frame.alpha]
        for constraint, (value, *_) in by_constraint(solution):
            if isinstance(constraint, OnLine):
                terms.append(-constraint.friction * abs(value) * abs(constraint.sliding(frames)[1]))
            if isinstance(constraint, Apart):
                terms.append(value * constraint.length[0] * constraint.lengthening(frames)[1])
        return terms
