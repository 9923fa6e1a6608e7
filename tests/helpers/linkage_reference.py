"""Compare a scene of one linkage with the multibody reference, which knows nothing of dyads."""

from dataclasses import replace
from typing import Any

import numpy as np

import linksweep as ls
from benchmarks.stress.linkages import multibody
from benchmarks.stress.linkages.machine import Linkages, Load
from benchmarks.stress.linkages.results import named


def numbers(part: Any) -> dict[str, Any]:
    of_bar = () if isinstance(part, ls.Guide | ls.Gears) else ("length", "mass", "inertia", "cg_distance", "cg_angle")
    values = {name: getattr(part, name, None) for name in (*vars(part), *of_bar)}
    return {name: value for name, value in values.items() if value is not None}


def as_data(scene: ls.Scene, theta2: float) -> Linkages:
    """Return a scene's numbers at one crank angle; where linksweep finds the pins is the start of the reference."""
    machine = scene.mechanism
    moving = [pin for pin, role in machine.topology.support.items() if role != "ground"]
    guides = {name: replace(guide, friction=0.0) for name, guide in machine.guides.items()}
    yokes = {role: replace(machine.parts[role], slot_friction=0.0) for role in machine.topology.yokes}
    ideal = replace(scene, mechanism=replace(machine, guides=guides, **yokes), drive="")  # no status but of positions
    cycle = ls.sweep(ideal, [theta2], of=[f"{pin}{axis}" for pin in moving for axis in "xy"])
    (_, pivot), *_ = machine.ground.items()
    pins = {pin: np.array([complex(*place) - complex(*pivot)]) for pin, place in machine.ground.items()}
    pins |= {pin: cycle[f"{pin}x"].values + 1j * cycle[f"{pin}y"].values for pin in moving}
    slots = {role: {"of": role, "friction": machine.parts[role].slot_friction} for role in machine.topology.yokes}
    return Linkages(
        machine.links,
        machine.ground,
        {role: numbers(part) for role, part in machine.parts.items()},
        pins,
        theta2,
        machine.points,
        {name: numbers(guide) for name, guide in machine.guides.items()} | slots,
        {name: numbers(gears) for name, gears in machine.gears.items()},
        omega2=scene.omega2,
        alpha2=scene.alpha2 or 0.0,
        gravity=scene.gravity,
        drive=scene.drive,
        loads=tuple(Load(**{name: getattr(load, name) for name in Load._fields}) for load in scene.loads),
    )


def solved(scene: ls.Scene, theta2: float) -> tuple[dict[str, float], int]:
    """Return all that the reference names, computed in 50 digits, and its status."""
    solution = multibody.solve(as_data(scene, theta2))
    return {name: float(values[0]) for name, values in named(solution).items()}, int(solution.status[0])


def largest_error(scene: ls.Scene, theta2: float) -> float:
    """Return the largest error of all that both name, relative to the largest number of its kind; and at least that
    of a status that differs."""
    exact, status = solved(scene, theta2)
    names = [name for name in exact if name in scene.table.quantity.keys() - {"theta2", "omega2", "alpha2"}]
    cycle = ls.sweep(scene, [theta2], of=names)
    if cycle.status[0] or status:
        return float(cycle.status[0] != status)
    assert {f"F{i}{j}x" for i, j in scene.mechanism.chain.joints.values()} <= {*names}
    size = {"F": 0.0, "T": 0.0, "a": 1.0, "v": 0.1, "o": 1.0, "x": 0.1}
    for name in names:
        size[name[0]] = max(size.get(name[0], 0.1), abs(exact[name]))
    size["T"] = max(size["T"], 0.1 * size["F"])
    return max(abs(cycle[name].item() - exact[name]) / size[name[0]] for name in names)
