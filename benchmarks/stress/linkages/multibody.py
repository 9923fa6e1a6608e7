"""Solve linkages in 50 digits as multibody systems: no dyads, no formulas of linksweep.

Every link is a body with three coordinates q. Constraints Φ(q, θ2) = 0 are pins, points on lines, equal or geared
angles, held lengths, and the crank's angle: as many as coordinates. Newton's method gives q; then

    J q' = −∂Φ/∂t        J q'' = −(second derivative of Φ at q'' = 0)        A λ = M q'' − Q

with A the columns that the constraints' multipliers push with: those of J, but with Coulomb friction −μ|N| sign(v)
beside each N that rubs, and with the drive's torque or force in place of the crank's. Signs of all N are assumed in
turn, and those kept that their own solution confirms. Matrices are inverted in floats; the residuals that refine are
in 50 digits.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from benchmarks.stress.decimals import Array, Number, Vector, exactly, fifty_digits, sign
from benchmarks.stress.linkages.assembly import Assembly
from benchmarks.stress.linkages.constraints import GROUND, Frame, Frames, OnLine, Push
from benchmarks.stress.linkages.loads import add, loads_on
from benchmarks.stress.linkages.machine import Linkages

ROUNDS = 6
"""Refinements at most; each gives as many digits as a float has, less those of the matrix's condition."""
TIGHT = 1e-40
NOTHING = 1e-12
"""Normal force, of the largest multiplier, below which nothing presses."""
OK, JAMMED, JAMMED_TWO_SOLUTIONS = 0, 4, 6


class Unsolved(ValueError):
    """Newton's method or a refinement did not converge."""


class Solution(NamedTuple):
    """The frames of all bodies, the matrix of forces, its solution, the total loads, and the status of each design."""

    assembly: Assembly
    frames: Frames
    matrix: Matrix
    multipliers: list[Array]
    loads: Push
    status: Array


def solve(linkages: Linkages) -> Solution:
    """Return positions, rates and multipliers of all designs."""
    with fifty_digits():
        assembly = Assembly(linkages)
        frames = accelerating(assembly, moving(assembly, placed(assembly)))
        loads = loads_on(assembly, frames)
        columns = pushes(assembly, frames)
        columns[-1] = drive_push(assembly, frames)
        signs, status = confirmed_signs(assembly, frames, columns, loads)
        columns = rubbing(assembly, frames, columns, signs)
        matrix = Matrix(assembly, columns, transposed=True)
        multipliers = matrix.solve(required(assembly, frames, loads))
        return Solution(assembly, frames, matrix, multipliers, loads, status)


# ---- linear systems


class Matrix:
    """A square matrix of each design, whose rows, or columns where transposed, are pushes on the bodies."""

    def __init__(self, assembly: Assembly, pushes: Sequence[Push], transposed: bool = False) -> None:
        column = {body.role: 3 * k for k, body in enumerate(assembly.linkages.bodies)}
        places = (
            (row, column[role] + axis, value)
            for row, push in enumerate(pushes)
            for role, values in push.items()
            for axis, value in enumerate(values)
            if np.ndim(value) or value
        )
        self.entries = {(j, i) if transposed else (i, j): value for i, j, value in places}
        self.floats = np.zeros((len(assembly.linkages), len(pushes), len(pushes)))
        for (i, j), value in self.entries.items():
            self.floats[:, i, j] = np.asarray(value, dtype=float)
        self.inverse = np.linalg.inv(self.floats)

    def step(self, residual: Sequence[Number]) -> Array:
        """Return the solution in floats, an unknown a row."""
        rhs = np.stack([np.broadcast_to(np.asarray(r, dtype=float), len(self.inverse)) for r in residual])
        return np.einsum("nij,jn->in", self.inverse, rhs)

    def solve(self, rhs: Sequence[Number]) -> list[Array]:
        """Return the solution in 50 digits, by refinement."""
        x = [exactly(row) for row in self.step(rhs)]
        largest = np.max(np.abs(np.asarray(x, dtype=float)), axis=0) + 1e-300
        for _ in range(ROUNDS):
            residual = list(rhs)
            for (i, j), value in self.entries.items():
                residual[i] = residual[i] - value * x[j]
            step = self.step(residual)
            x = [value + exactly(row) for value, row in zip(x, step, strict=True)]
            if np.all(np.abs(step) <= TIGHT * largest):
                return x
        raise Unsolved("a linear system is too badly conditioned to be refined")


# ---- motion


def pushes(assembly: Assembly, frames: Frames) -> list[Push]:
    """Return the rows of J, which are the pushes of unit multipliers."""
    return [push for constraint in assembly.constraints for push in constraint.pushes(frames)]


def placed(assembly: Assembly) -> Frames:
    """Return the frames in which all constraints hold."""
    frames = assembly.start
    for _ in range(20):
        values = [value for constraint in assembly.constraints for value in constraint.value(frames)]
        step = Matrix(assembly, pushes(assembly, frames)).step([-1 * value for value in values])
        frames = {GROUND: Frame()} | {
            body.role: _displaced(frames[body.role], *map(exactly, step[3 * k : 3 * k + 3]))
            for k, body in enumerate(assembly.linkages.bodies)
        }
        if np.all(np.abs(step) <= TIGHT):
            return frames
    raise Unsolved("Newton's method does not converge from these pins")


def _displaced(frame: Frame, dx: Array, dy: Array, angle: Array) -> Frame:
    """Return the frame displaced, and turned by an angle, small or to be corrected by the next step."""
    u = frame.u + frame.u.left * angle
    return Frame(frame.G + Vector(dx, dy), u * (1 / np.sqrt(u.dot(u))))


def moving(assembly: Assembly, frames: Frames) -> Frames:
    """Return the frames with their velocities."""
    rates = Matrix(assembly, pushes(assembly, frames)).solve(_driven(assembly, 0))
    return _with(assembly, frames, rates, "v", "omega")


def accelerating(assembly: Assembly, frames: Frames) -> Frames:
    """Return the frames with their accelerations."""
    second = [value for constraint in assembly.constraints for value in constraint.second(frames)]
    rhs = [driven - value for driven, value in zip(_driven(assembly, 1), second, strict=True)]
    return _with(assembly, frames, Matrix(assembly, pushes(assembly, frames)).solve(rhs), "a", "alpha")


def _driven(assembly: Assembly, order: int) -> list[Number]:
    """Return the first (0) or second (1) derivatives in time of what drives the constraints."""
    omega2, alpha2 = assembly.exact(assembly.linkages.omega2), assembly.exact(assembly.linkages.alpha2)
    return [both[order] for constraint in assembly.constraints for both in constraint.driven(omega2, alpha2)]


def _with(assembly: Assembly, frames: Frames, values: Sequence[Array], vector: str, turning: str) -> Frames:
    changed = {GROUND: Frame()}
    for k, body in enumerate(assembly.linkages.bodies):
        x, y, angle = values[3 * k : 3 * k + 3]
        changed[body.role] = frames[body.role]._replace(**{vector: Vector(x, y), turning: angle})
    return changed


# ---- forces


def required(assembly: Assembly, frames: Frames, loads: Push) -> list[Array]:
    """Return M q'' − Q: all that the multipliers must provide."""
    rhs: list[Array] = []
    for body in assembly.linkages.bodies:
        frame, mass = frames[body.role], assembly.part(body.role, "mass")
        inertial = frame.a.x * mass, frame.a.y * mass, frame.alpha * assembly.part(body.role, "inertia")
        rhs += [i - load for i, load in zip(inertial, loads[body.role], strict=True)]
    return rhs


def drive_push(assembly: Assembly, frames: Frames) -> Push:
    """Return the push of the drive's unit torque on a link, or of its unit force that lengthens a cylinder, or that
    pushes a link along the line on which it slides."""
    linkages = assembly.linkages
    drive = linkages.drive or linkages.crank
    for cylinder in linkages.cylinders:
        if cylinder.role == drive:
            between = assembly.cylinder(cylinder)
            length, _ = between.lengthening(frames)
            (push,) = between.pushes(frames)
            return {role: tuple(value / length for value in values) for role, values in push.items()}
    for line in assembly.constraints:
        if isinstance(line, OnLine) and drive == f"along {line.j}":
            return line.rubbing(frames)
    return {drive: (0, 0, 1)}


def lines(assembly: Assembly) -> list[tuple[int, OnLine]]:
    """Return the lines along which something rubs, each with the place of its normal force among the multipliers."""
    rubbed, place = [], 0
    for constraint in assembly.constraints:
        if isinstance(constraint, OnLine) and np.any(constraint.friction != 0):
            rubbed.append((place, constraint))
        place += constraint.rows
    return rubbed


def rubbing(assembly: Assembly, frames: Frames, columns: list[Push], signs: Sequence[Array]) -> list[Push]:
    """Return the columns with friction beside the normal forces, for assumed signs of these."""
    columns = list(columns)
    for (place, line), assumed in zip(lines(assembly), signs, strict=True):
        factor = -line.friction * assumed * sign(line.sliding(frames)[1])
        friction = {role: tuple(factor * x for x in push) for role, push in line.rubbing(frames).items()}
        columns[place] = add(columns[place], friction)
    return columns


def confirmed_signs(assembly: Assembly, frames: Frames, columns: list[Push], loads: Push) -> tuple[Array, Array]:
    """Return the signs of the normal forces that their own solution confirms, and 4 where none, 6 where several are.

    A line that nothing presses has one solution for either sign, counted as that of the positive one.
    """
    rhs, where = required(assembly, frames, loads), [place for place, _ in lines(assembly)]
    n = len(assembly.linkages)
    chosen, count = np.ones((len(where), n), dtype=int), np.zeros(n, dtype=int)
    for assumed in product((1, -1), repeat=len(where)):
        signs = [np.full(n, one) for one in assumed]
        multipliers = Matrix(assembly, rubbing(assembly, frames, columns, signs), transposed=True).step(rhs)
        least = -NOTHING * np.max(np.abs(multipliers), axis=0)
        normal = zip(assumed, multipliers[where], strict=True)
        confirmed = np.all([np.where(one > 0, least < N, least > N) for one, N in normal] or [[True] * n], axis=0)
        chosen[:, confirmed] = np.array(assumed, dtype=int)[:, None]
        count += confirmed
    return chosen, np.select([count == 0, count > 1], [JAMMED, JAMMED_TWO_SOLUTIONS], OK)
