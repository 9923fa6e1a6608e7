"""Complete random linkages with masses, motion, gravity, drive and loads; keep those away from toggles and jamming."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from typing import Any

import numpy as np

from benchmarks.stress.decimals import Array, fifty_digits
from benchmarks.stress.linkages.machine import Damper, Linkages, Load, Spring, TorsionDamper
from benchmarks.stress.linkages.multibody import Matrix, Solution, pushes, solve
from benchmarks.stress.linkages.sketch import Sketch
from benchmarks.stress.linkages.topologies import Family

LARGEST_CONDITION = 1e3
"""Condition of the scaled matrices of motion and of forces up to which linkages are away from toggles and jamming."""
FASTEST = 30.0
"""Largest rate of a link, of that of the crank."""


def drawn(family: Family, random: np.random.Generator, n: int) -> Solution:
    """Return n solved linkages at one crank angle, away from toggles, but for one stated, and from jamming."""
    count = 2 * n
    sketch = Sketch(random, count, family.near)
    family.topology.draw(sketch)
    solution = solve(completed(sketch, family))
    good = np.flatnonzero(away(solution, 100.0 if family.near else 1.0))[:n]
    if len(good) < n:
        raise ValueError(f"{len(good)} of {count} linkages are away from toggles")
    return solve(chosen(solution.assembly.linkages, good))


def completed(sketch: Sketch, family: Family) -> Linkages:
    """Return the sketched linkages with masses, motion and loads."""
    linkages, random = sketch.linkages(family.topology.text), sketch.random
    omega2 = 10.0 ** random.uniform(-1.0, 3.0) * sketch.uniform(0.5, 1.0) * random.choice([-1.0, 1.0])
    parts = {
        body.role: _massive(sketch, linkages.parts.get(body.role, {}), bool(body.guide)) for body in linkages.bodies
    }
    linkages = replace(
        linkages,
        parts={**linkages.parts, **parts},
        omega2=omega2,
        alpha2=omega2**2 * sketch.uniform(-2.0, 2.0) * random.integers(0, 2),
        gravity=_gravity(sketch, omega2),
        drive=family.drive,
    )
    count = int(random.integers(0, 5))
    return replace(linkages, loads=tuple(_load(sketch, linkages, omega2) for _ in range(count)))


def _massive(sketch: Sketch, part: Mapping[str, Any], slides: bool) -> dict[str, Any]:
    mass, length = 10.0 ** sketch.uniform(-1.0, 1.0), part.get("length", np.full(sketch.n, 0.5))
    distance = length * sketch.uniform(0.0, 1.2) * sketch.random.integers(0, 2)
    inertia = mass * length**2 * sketch.uniform(0.02, 0.5)
    return {
        **part,
        "mass": mass,
        "inertia": inertia,
        "cg_distance": distance,
        "cg_angle": sketch.uniform(-180.0, 180.0),
    }


def _gravity(sketch: Sketch, omega2: Array) -> tuple[Any, Any]:
    kind = sketch.random.integers(3)
    if kind < 2:
        return (0.0, 0.0) if kind else (0.0, -9.81)
    return omega2**2 * sketch.uniform(-1.0, 1.0), omega2**2 * sketch.uniform(-1.0, 1.0)


def _load(sketch: Sketch, linkages: Linkages, omega2: Array) -> Any:
    """Return a load comparable with the inertia of a kilogram at a metre."""
    force = omega2**2
    roles = [body.role for body in linkages.bodies]
    first, second = (str(role) for role in sketch.random.choice(roles, 2, replace=False))
    ends = _end(sketch, str(sketch.random.choice(["ground", first]))), _end(sketch, second)
    kinds: list[Callable[[], Any]] = [
        lambda: _force(sketch, first, force, torque=None),
        lambda: _force(sketch, first, force, torque=force * sketch.uniform(-2.0, 2.0)),
        lambda: Load(first, torque=force * sketch.uniform(-2.0, 2.0)),
        lambda: Spring(*ends, force * sketch.uniform(0.1, 2.0), sketch.uniform(0.1, 1.0)),
        lambda: Damper(*ends, abs(omega2) * sketch.uniform(0.1, 2.0)),
        lambda: TorsionDamper(ends[0][0], second, abs(omega2) * sketch.uniform(0.1, 2.0)),
    ]
    return kinds[sketch.random.integers(len(kinds))]()


def _force(sketch: Sketch, link: str, force: Array, torque: Array | None) -> Load:
    components = force * sketch.uniform(-2.0, 2.0), force * sketch.uniform(-2.0, 2.0)
    at = sketch.uniform(0.0, 1.5), sketch.uniform(-180.0, 180.0)
    frame, origin = (str(sketch.random.choice(words)) for words in (("ground", "link"), ("pin", "cg")))
    return Load(link, components, at, frame, torque, origin)


def _end(sketch: Sketch, link: str) -> tuple[str, Array, Array]:
    if link == "ground":
        return link, 3.0 + sketch.uniform(0.0, 2.0), 3.0 + sketch.uniform(0.0, 2.0)
    return link, sketch.uniform(0.0, 1.0), sketch.uniform(-180.0, 180.0)


# ---- choice


def away(solution: Solution, times: float = 1.0) -> Array:
    """Return which linkages are away from toggles, dead centres and jamming; the limits may be some times as large."""
    with fifty_digits():
        J = Matrix(solution.assembly, pushes(solution.assembly, solution.frames))
    frames = [solution.frames[body.role] for body in solution.assembly.linkages.bodies]
    rates = np.max([np.abs(np.asarray(frame.omega, dtype=float)) for frame in frames], axis=0)
    slow = rates < times * FASTEST * np.abs(solution.assembly.linkages.omega2)
    return (
        slow & (_condition(J) < times * LARGEST_CONDITION) & (_condition(solution.matrix) < times * LARGEST_CONDITION)
    )


def _condition(matrix: Matrix) -> Array:
    """Return the condition of the matrices with rows and columns scaled to one size."""
    scaled = matrix.floats.copy()
    for _ in range(3):
        scaled /= np.sqrt(np.abs(scaled).max(axis=2, keepdims=True))
        scaled /= np.sqrt(np.abs(scaled).max(axis=1, keepdims=True))
    return np.asarray(np.linalg.cond(scaled))


def chosen(value: Any, which: Array) -> Any:
    """Return the linkages, or any of their numbers, of some designs."""
    if isinstance(value, Linkages):
        return replace(value, **{f.name: chosen(getattr(value, f.name), which) for f in fields(value)})
    if isinstance(value, Mapping):
        return {key: chosen(one, which) for key, one in value.items()}
    if isinstance(value, tuple):
        parts = [chosen(one, which) for one in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    return value[which] if isinstance(value, np.ndarray) else value
