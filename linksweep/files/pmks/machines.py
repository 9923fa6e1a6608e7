"""Machines of a drawing: bodies that move and hang together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from linksweep.files.pmks.drawing import Body, Drawing, Joint


@dataclass(frozen=True)
class Machine:
    """Bodies that move and hang together, and the joints of the drawing.

    Parameters
    ----------
    bodies : mapping of str to Body
        Its bodies, in the document's order.
    joints : mapping of str to Joint
        All joints of the drawing.
    ground : set of str
        Pins on the ground, and those on bodies that stand still.
    """

    bodies: Mapping[str, Body]
    joints: Mapping[str, Joint]
    ground: frozenset[str]

    def at(self, joint: str) -> list[Body]:
        """Return the bodies that a joint is on."""
        return [body for body in self.bodies.values() if joint in body.joints]

    @property
    def inputs(self) -> list[Joint]:
        """Joints with an input."""
        return [joint for joint in self.joints.values() if joint.driven and self.at(joint.name)]

    @property
    def slides(self) -> list[Joint]:
        """Joints that slide."""
        return [joint for joint in self.joints.values() if joint.slides and self.at(joint.name)]


def machines(drawing: Drawing) -> list[Machine]:
    """Return the machines of a drawing: those with an input first, then in the document's order."""
    standing, ground = _standing(drawing)
    moving = {name: body for name, body in drawing.bodies.items() if name not in standing}
    groups: list[set[str]] = []
    for name, body in moving.items():
        carriers = {drawing.joints[pin].carrier for pin in body.joints} & moving.keys()
        joined = {*(f"joint {pin}" for pin in body.joints), *carriers, name}
        meeting = [group for group in groups if group & joined]
        groups = [group for group in groups if group not in meeting] + [joined.union(*meeting)]
    parts = [{name: body for name, body in moving.items() if name in group} for group in groups]
    result = [Machine(bodies, drawing.joints, ground) for bodies in parts]
    order = list(moving)
    return sorted(result, key=lambda machine: (not machine.inputs, order.index(next(iter(machine.bodies)))))


def _standing(drawing: Drawing) -> tuple[set[str], frozenset[str]]:
    """Return the bodies that two pins on the ground hold still, and all pins on the ground: their joints are, too."""
    ground = {joint.name for joint in drawing.joints.values() if joint.grounded and not joint.slides}
    standing: set[str] = set()
    while held := [
        body for body in drawing.bodies.values() if body.name not in standing and _held(drawing, body, ground)
    ]:
        standing |= {body.name for body in held}
        ground |= {name for body in held for name in body.joints}
    return standing, frozenset(ground)


def _held(drawing: Drawing, body: Body, ground: set[str]) -> bool:
    return len({drawing.joints[name].at for name in body.joints if name in ground}) > 1
