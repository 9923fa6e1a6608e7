"""Tell where the directions of sliding are known: between the angles at which links alone make slides turn round."""

from __future__ import annotations

import numpy as np

from linksweep.engine.run import Field
from linksweep.results.peak_search.between import ONE, number_of
from linksweep.results.peak_search.groups import Group
from linksweep.scene.curves.polynomials import SPEED, polynomials
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene


def divides(scene: Scene) -> bool:
    """Return whether all jumps of a scene are those of friction, so that signals are smooth between them."""
    machine = scene.mechanism
    return bool(machine.directions()) and not scene.approaches() and len(scene.jumps()) == len(machine.jumps())


def with_known_directions(scene: Scene, designs: Array) -> Array:
    """Return those designs whose crank does not turn round, and its slides with it."""
    if not (scene.changes_speed and scene.mechanism.directions()):
        return designs
    speeds = polynomials(scene)
    one_way = number_of(scene, speeds.turns_one_way(), designs) if speeds else np.zeros(len(designs))
    return designs[one_way > 0.0]


def speed_at_one_angle(group: Group) -> dict[str, Field]:
    """Return the input that is a speed which changes with the angle: at one angle, for it has the same sign at all."""
    if not group.scene.changes_speed:
        return {}
    speed = group.scene.at_one_angle.omega2.isel({group.scene.mechanism.index: 0})
    return {SPEED: Field((ONE,), group.number(speed))}
