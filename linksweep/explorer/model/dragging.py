"""Dragging a pin: the lengths, and the place on the ground, that put it under the mouse.

The other pins stay where they are, but for those that a slide or a cylinder places. A link between two pins gets the
distance between them, and a wheel the phase of its direction; third pins get new polar coordinates in the axes of their
link. A ground pin gets a new place, and its links, which keep their lengths, follow it. The crank turns with its pin,
and all that hangs on it moves.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from linksweep.base.validate import refuse
from linksweep.chains.topology import GROUND, Topology
from linksweep.explorer.model.controls import values
from linksweep.plot.kit.drawings import drawing_of
from linksweep.plot.kit.shape import places_of, positions
from linksweep.scene.scene import Scene


class Move(NamedTuple):
    """New numbers by path, and the crank angle [degree]."""

    numbers: dict[str, float]
    angle: float


def handles(scene: Scene) -> list[str]:
    """Return the pins that can be dragged: those that have a place, and numbers that move them."""
    joined = getattr(scene.mechanism, "topology", None)
    if joined is None:
        return []
    here, drawing = dict.fromkeys(joined.members, np.zeros(2)), drawing_of(scene.mechanism)
    plain, pins = values(scene), {*drawing.fixed(scene.mechanism), *drawing.moving}
    in_place = [pin for pin in joined.members if pin in pins]
    return [pin for pin in in_place if {*_numbers(scene, joined, here, pin, np.ones(2), 0.0)} & {*plain}]


def dragged(scene: Scene, pin: str, place: tuple[float, float], angle: float) -> Move:
    """Return the numbers with which a pin lies at a place [m] at a crank angle [degree].

    A pin on a guide goes to the nearest place on it, and that of a wheel without a phase to the nearest on its line.
    """
    joined: Topology = scene.mechanism.topology  # type: ignore[attr-defined]
    drawing = drawing_of(scene.mechanism)
    motion = positions(scene, drawing, [angle])
    here = {name: places[:, -1] for name, places in places_of(scene, drawing, motion).items()}
    refuse(
        [] if np.isfinite(list(here.values())).all() else [f"theta2 = {angle:.6g}: not assembled; turn the crank first"]
    )
    there = np.array(place, dtype=float)
    for block in drawing.blocks:
        if block.pin == pin and block.guide is not None:
            rail = block.guide(scene.mechanism)
            there = _nearest(there, rail.point, rail.along)
    plain = values(scene)
    for role in joined.gears:
        ends = joined.links[role][:2]
        if pin in {*ends} - {*joined.ground} and f"gears.{role}.phase" not in plain:
            hub = here[ends[1] if pin == ends[0] else ends[0]]
            arm = here[pin] - hub
            there = _nearest(there, hub, arm / np.hypot(*arm))
    new = _numbers(scene, joined, here, pin, there, angle)
    numbers = {path: value for path, value in new.items() if path in plain}
    refuse([] if numbers else [f"pin {pin}: no plain number of the scene moves it"])
    pivot, end = joined.pins_of(joined.crank)[:2]
    turned = _within_half_turn(_direction(there - here[pivot]) - angle) if pin == end else 0.0
    return Move(numbers, (angle + turned) % scene.period)


def _numbers(
    scene: Scene, joined: Topology, here: dict[str, np.ndarray], pin: str, there: np.ndarray, angle: float
) -> dict[str, float]:
    """Return the numbers that put a pin there, at this crank angle, while the others stay."""
    if pin in joined.ground:
        return {} if pin == joined.ground[0] else _on_ground(scene, joined, pin, there)
    numbers: dict[str, float] = {}
    now = {**here, pin: there}
    struts = {role: pins for role, pins in joined.cylinders.items() if role in joined.struts}
    crank_pin = pin in joined.links[joined.crank][:2]
    for role, (first, second, *others) in {**struts, **joined.links}.items():
        if crank_pin and role == joined.crank:
            numbers[f"{role}.length"] = float(np.hypot(*(now[second] - now[first])))
        elif pin in (first, second) and not crank_pin:
            numbers[f"{role}.length"] = float(np.hypot(*(now[second] - now[first])))
            numbers |= _third_pins(joined, now, role, others)
            if role in joined.gears:
                turned = float(joined.gears[role]) * angle
                numbers[f"gears.{role}.phase"] = _within_half_turn(_direction(now[second] - now[first]) - turned)
        elif joined.points.get(pin) == role:
            numbers |= _third_pins(joined, now, role, [pin])
    return numbers


def _third_pins(joined: Topology, now: dict[str, np.ndarray], role: str, pins: list[str]) -> dict[str, float]:
    """Return the polar coordinates, in their link's axes, with which its third pins lie where they are now."""
    first, second, *_ = joined.links.get(role) or joined.cylinders[role]
    numbers: dict[str, float] = {}
    for pin in (pin for pin in pins if joined.points[pin] == role):
        arm = now[pin] - now[first]
        numbers[f"points.{pin}[1]"] = float(np.hypot(*arm))
        numbers[f"points.{pin}[2]"] = _within_half_turn(_direction(arm) - _direction(now[second] - now[first]))
    return numbers


def _on_ground(scene: Scene, joined: Topology, pin: str, there: np.ndarray) -> dict[str, float]:
    machine: Any = scene.mechanism
    if isinstance(machine.ground, Mapping):
        x, y = there + np.array([float(part) for part in machine.ground[joined.ground[0]]])
        return {f"{GROUND}.{pin}[1]": float(x), f"{GROUND}.{pin}[2]": float(y)}
    return {"ground": float(np.hypot(*there)), "ground_angle": _within_half_turn(_direction(there))}


def _nearest(place: np.ndarray, point: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Return the place on a line, of a point and a unit vector, that is nearest to another."""
    nearest: np.ndarray = point + along * (along @ (place - point))
    return nearest


def _direction(vector: np.ndarray) -> float:
    return float(np.degrees(np.arctan2(vector[1], vector[0])))


def _within_half_turn(angle: float) -> float:
    return (angle + 180.0) % 360.0 - 180.0
