"""Loads on the bodies of a linkage: weights, forces and torques, springs and dampers."""

from __future__ import annotations

from typing import Any

from benchmarks.stress.decimals import RADIAN, Array, Number, Vector, angles, root
from benchmarks.stress.linkages.assembly import Assembly
from benchmarks.stress.linkages.constraints import GROUND, Frames, Push, push
from benchmarks.stress.linkages.machine import Damper, Load, Spring, TorsionDamper, TorsionSpring


def add(first: Push, second: Push) -> Push:
    """Return two pushes together."""
    both = {
        role: tuple(x + y for x, y in zip(first[role], second[role], strict=True)) for role in first.keys() & second
    }
    return first | second | both


def loads_on(assembly: Assembly, frames: Frames) -> Push:
    """Return weights and loads on all bodies."""
    zero = assembly.exact(0.0)
    total: Push = {body.role: (zero, zero, zero) for body in assembly.linkages.bodies}
    gravity = assembly.vector(*assembly.linkages.gravity)
    for role in total:
        mass = assembly.part(role, "mass")
        total[role] = gravity.x * mass, gravity.y * mass, zero
    for load in assembly.linkages.loads:
        pushes = load(assembly, frames) if callable(load) else WAYS[type(load)](assembly, frames, load)
        for part in pushes:
            total = add(total, part)
    return total


def load_pushes(assembly: Assembly, frames: Frames, load: Load) -> list[Push]:
    frame, pushes = frames[load.link], []
    if load.force is not None:
        force = assembly.vector(*load.force)
        local = assembly.polar(load.at) - assembly.centre[load.link] * (load.origin == "pin")
        pushes.append(push(frames, load.link, frame.at(local), frame.arm(force) if load.frame == "link" else force))
    return [*pushes, *([] if load.torque is None else [{load.link: (0, 0, assembly.exact(load.torque))}])]


def end(assembly: Assembly, frames: Frames, of: tuple[str, Any, Any]) -> tuple[Vector, Vector]:
    """Return place and velocity of a spring's end."""
    role, *at = of
    if role == GROUND:
        place = assembly.vector(*at)
    else:
        place = frames[role].at(assembly.polar((at[0], at[1])) - assembly.centre[role])
    return place, frames[role].velocity_at(place)


def line_pushes(assembly: Assembly, frames: Frames, load: Spring | Damper) -> list[Push]:
    (P, v), (Q, w) = (end(assembly, frames, of) for of in (load.from_, load.to))
    line = Q - P
    length = root(line.dot(line))
    unit = line * (1 / length)
    pull = unit * _tension(assembly, load, length, unit.dot(w - v))
    return [push(frames, load.from_[0], P, pull), push(frames, load.to[0], Q, pull * -1)]


def _tension(assembly: Assembly, load: Spring | Damper, length: Array, lengthening: Array) -> Number:
    if isinstance(load, Damper):
        return assembly.exact(load.coefficient) * lengthening
    return assembly.exact(load.rate) * (length - assembly.exact(load.free_length))


def torsion_pushes(assembly: Assembly, frames: Frames, load: TorsionDamper | TorsionSpring) -> list[Push]:
    torque = _resistance(assembly, frames, load)
    ends = {load.from_: (0, 0, torque), load.to: (0, 0, -torque)}
    return [{role: values} for role, values in ends.items() if role != GROUND]


def _resistance(assembly: Assembly, frames: Frames, load: TorsionDamper | TorsionSpring) -> Number:
    if isinstance(load, TorsionDamper):
        return assembly.exact(load.coefficient) * (frames[load.to].omega - frames[load.from_].omega)
    free = assembly.direction(load.free_angle).turned(frames[load.from_].u)
    twist = angles(frames[load.to].u.turned(Vector(free.x, -free.y)))
    return assembly.exact(load.rate) * twist * RADIAN


WAYS: dict[type, Any] = {
    Load: load_pushes,
    Spring: line_pushes,
    Damper: line_pushes,
    TorsionSpring: torsion_pushes,
    TorsionDamper: torsion_pushes,
}
