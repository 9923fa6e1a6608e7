"""The skeleton of a machine in a position: lines, circles and points on layers, lengths in [m]."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from linksweep.mechanisms.drawing import Drawing
from linksweep.plot.kit.drawings import drawing_of
from linksweep.plot.kit.shape import Shape, block_corners, half_side, positions, shape_of, slideway
from linksweep.plot.machine import require_assembled
from linksweep.scene.scene import Scene

PIN = 0.12  # of half a side of a block: radius of a pin's circle
LETTER = 0.25  # of half a side of a block: height of a letter

GROUND, PINS, CENTRES = "1 ground", "pins", "centres of gravity"
CENTRE_LINES, GUIDES, PITCH, CYLINDERS, NAMES = "centre lines", "guides", "pitch circles", "cylinders", "names"


class Curve(NamedTuple):
    """A point of a link that draws a curve: the link's role and number, distance [m] and angle [degree]."""

    link: str
    number: int
    at: tuple[float, float]


class Line(NamedTuple):
    """A line through points, the rows of an array [m]."""

    layer: str
    points: np.ndarray
    closed: bool = False
    dashed: bool = False


class Circle(NamedTuple):
    """A circle [m]."""

    layer: str
    centre: np.ndarray
    radius: float
    dashed: bool = False


class Point(NamedTuple):
    """A point [m]."""

    layer: str
    at: np.ndarray


class Name(NamedTuple):
    """A letter beside a point, of this height [m]."""

    layer: str
    at: np.ndarray
    text: str
    height: float


Part = Line | Circle | Point | Name


def skeleton(scene: Scene, angle: float, curves: Sequence[Curve] | None, machine: bool) -> list[Part]:
    """Return the parts of a drawing: the machine at a crank angle [degree], unless it is left out, and curves.

    Raises ValueError where the machine cannot be assembled at that angle.
    """
    drawing = drawing_of(scene.mechanism)
    cycle = positions(scene, drawing, [angle])
    require_assembled(cycle, angle, scene.period_of_motion)
    shape = shape_of(scene, drawing, cycle, None)
    parts = [*_machine(scene, drawing, shape)] if machine else []
    if curves is None:
        return [*parts, *_curve(f"curve of {drawing.carrier.role}", shape.curve)]
    for k, curve in enumerate(curves, 1):
        own = shape_of(scene, drawing.with_point_on(curve.link, curve.number), cycle, curve.at)
        parts += [*_curve(f"curve {k} of {curve.link}", own.curve), Point(f"curve {k} of {curve.link}", own.point)]
    return parts


def _curve(layer: str, curve: np.ndarray) -> Iterator[Line]:
    """Yield a curve, in pieces where there are angles without a position."""
    there = np.isfinite(curve).all(axis=0)
    if there.all():
        yield Line(layer, curve.T[:-1], closed=True)
        return
    edges = np.flatnonzero(np.diff(there, prepend=False, append=False)).reshape(-1, 2)
    yield from (Line(layer, curve.T[start:stop]) for start, stop in edges if stop - start > 1)


def _machine(scene: Scene, drawing: Drawing, shape: Shape) -> Iterator[Part]:
    layers = {body.number: f"{body.number} {body.role}" for body in scene.mechanism.bodies}
    half = half_side(drawing, shape)
    yield from _standing(scene, drawing, shape, half)
    for number, pins in drawing.bars.items():
        yield Line(layers[number], np.array([shape.pins[pin] for pin in pins]), closed=len(pins) > 2)
    for block, slide in zip(drawing.blocks, shape.slides, strict=True):
        if block.on is not None and block.on[0] not in drawing.bars:
            pivot, foot, ends = slideway(block, slide, shape, half)
            yield from (Line(layers[block.on[0]], points) for points in (np.array([pivot, foot]), ends))
        layer = layers[block.number] if block.number else "blocks"
        yield Line(layer, block_corners(shape.pins[block.pin], slide.along[:, -1], half)[:-1], closed=True)
    for ends_of in drawing.telescopes:
        yield Line(CYLINDERS, np.array([shape.pins[pin] for pin in ends_of]))
    for name, place in shape.lettered.items():
        yield Circle(PINS, place, PIN * half)
        yield Name(NAMES, place + PIN * half, name, LETTER * half)
    yield from (Point(CENTRES, place) for place in shape.centres.values())


def _standing(scene: Scene, drawing: Drawing, shape: Shape, half: float) -> Iterator[Part]:
    """Yield the ground: its pins joined, guides along the travel of their blocks, circles of the crank and of gears."""
    standing = np.array([shape.pins[pin] for pin in drawing.fixed(scene.mechanism)])
    if len(standing) > 1:
        yield Line(GROUND, standing, dashed=True)
    yield from (Point(GROUND, place) for place in standing)
    for block, slide in zip(drawing.blocks, shape.slides, strict=True):
        if block.guide is not None:
            guide = block.guide(scene.mechanism)
            low, high = slide.travel(guide.point)
            ends = np.array([guide.point + end * guide.along for end in (low - 2.0 * half, high + 2.0 * half)])
            yield Line(GUIDES, ends, dashed=True)
    for pin, radius in drawing.wheels(scene.mechanism):
        if np.isfinite(radius):
            yield Circle(PITCH, shape.pins[pin], float(radius), dashed=True)
    pivot, end = (shape.pins[pin] for pin in drawing.bars[2][:2])
    yield Circle(CENTRE_LINES, pivot, float(np.hypot(*(end - pivot))), dashed=True)
