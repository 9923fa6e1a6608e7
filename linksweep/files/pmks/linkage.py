"""The linkage of a machine of a drawing, assembled as it is drawn."""

from __future__ import annotations

import math
from typing import Any

from linksweep.base.validate import refuse
from linksweep.chains.topology import RPR, RRP, RRR, Step, Topology, topology
from linksweep.files.pmks.axes import Axes, along, polar
from linksweep.files.pmks.drawing import Point
from linksweep.files.pmks.machines import Machine
from linksweep.files.pmks.words import Words
from linksweep.mechanisms.linkage import Linkage
from linksweep.mechanisms.links import Cylinder, Guide, Link, Slider


def words_of(machine: Machine) -> Words:
    """Return a machine in words, with the link at its input as crank; else the first from which all links close.

    Raises
    ------
    ValueError
        One line for each thing that no linkage has, and for links that do not close.
    """
    cranks = _cranks(machine)
    if not cranks:
        raise ValueError("no link turns about a pin on the ground: a linkage needs one as its crank")
    candidates = [Words(machine, crank) for crank in cranks]
    problems = [_problems(words) for words in candidates]
    refuse(problems[0] if all(problems) else [])
    return candidates[problems.index([])]


def linkage_of(words: Words) -> Linkage:
    """Return the linkage, each dyad assembled as it is drawn."""
    closed = _topology(words)[0]
    assert closed is not None
    return Linkage(
        words.text,
        ground=words.ground,
        points=words.points,
        guides=_guides(words),
        branch={step.name: "crossed" for step in closed.steps if _crossed(step, words, closed)},
        parts=_links(words) | _sliders(words),
    )


def _cranks(machine: Machine) -> list[str]:
    """Return the bodies that may be the crank: one at an input on the ground, else all that have a ground pin."""
    driven = {joint.name for joint in machine.inputs[:1]} & machine.ground
    bodies = [body for name, body in machine.bodies.items() if name not in Words(machine, name).cylinder]
    return [body.name for body in bodies if (driven or machine.ground) & {*body.joints} and len(body.joints) > 1]


def _problems(words: Words) -> list[str]:
    return words.problems() or list(_topology(words)[1])


def _topology(words: Words) -> tuple[Topology | None, tuple[str, ...]]:
    hosts = tuple((name, guide.of) for name, guide in _guides(words).items())
    return topology(words.text, tuple(words.ground), hosts)


def _guides(words: Words) -> dict[str, Guide]:
    guides = {}
    for name, joint in words.sliding.items():
        line, carrier = words.guides[name], words.axes.get(joint.carrier)
        of = words.roles[joint.carrier] if carrier else "ground"
        through, angle = _in_axes(line, carrier) if carrier else (line.origin, line.angle)
        guides[name] = Guide(through, angle, of=of)
    return guides


def _in_axes(line: Axes, axes: Axes) -> tuple[Point, float]:
    """Return a point and the direction of a line in the axes of a link."""
    offset = line.origin[0] - axes.origin[0], line.origin[1] - axes.origin[1]
    return axes.components(offset), math.remainder(line.angle - axes.angle, 360.0)


def _links(words: Words) -> dict[str, Any]:
    links: dict[str, Any] = {}
    for name, pins in words.pins.items():
        body, joints = words.machine.bodies[name], words.machine.joints
        length = polar(joints[pins[0]].at, joints[pins[1]].at)[0]
        links[words.roles[name]] = Link(length, body.mass, body.inertia, *words.axes[name].polar(body.cg))
    return links | {words.roles[barrel]: Cylinder() for barrel in words.cylinder[:1]}


def _sliders(words: Words) -> dict[str, Slider]:
    sliders = {f"block_{joint.name}": Slider(joint.mass) for joint in words.blocks}
    for name in words.sliders:
        body, axes = words.machine.bodies[name], words.axes[name]
        slot = words.slot(words.yokes[name]) - axes.angle if name in words.yokes else 90.0
        sliders[words.roles[name]] = Slider(body.mass, body.inertia, *axes.polar(body.cg), slot_angle=slot)
    return sliders


def _crossed(step: Step, words: Words, closed: Topology) -> bool:
    """Return whether a dyad is drawn in its crossed assembly."""
    at = {name: joint.at for name, joint in words.machine.joints.items()}
    if isinstance(step, RRR):
        return Axes(at[step.first.pin], polar(at[step.first.pin], at[step.second.pin])[1]).offset(at[step.pin]) < 0.0
    if isinstance(step, RRP | RPR):
        side, angle = step.link.pin, words.guides[step.guide].angle
        return along((at[step.pin][0] - at[side][0], at[step.pin][1] - at[side][1]), angle) < 0.0
    return False
