"""The shape of a machine in a position: places of pins and blocks, and the curve that a point draws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.degrees import cos_sin
from linksweep.chains.between_links import is_pin
from linksweep.mechanisms.drawing import Block, Drawing, Frame
from linksweep.plot.kit import signals
from linksweep.results.peak_search.paths import Part
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene

CURVE = 720  # positions, of a turn of the crank, along the curve of a point
BLOCK = 0.26  # of the mean length of two bars, or of bar and frame: half a side of a block


class Slide(NamedTuple):
    """The places of a block's pin and the direction of its sides, (2, angles) each, the last ones the present.

    Places are measured from A, or from the pin of the link that carries the block.
    """

    places: np.ndarray
    along: np.ndarray

    def travel(self, origin: np.ndarray) -> tuple[float, float]:
        """Return the ends of the block's travel along its line [m], from a point."""
        places = np.sum((self.places - origin[:, None]) * self.along, axis=0)
        return float(np.nanmin(places)), float(np.nanmax(places))

    def turned(self, turn: np.ndarray) -> Slide:
        """Return the slide turned about the origin by a rotation matrix."""
        return Slide(turn @ self.places, turn @ self.along)


class Shape(NamedTuple):
    """A machine in a position, lengths in [m]: pins, centres of gravity, the curve of a point, blocks, shortest lengths
    of cylinders."""

    pins: dict[str, np.ndarray]
    centres: dict[int, np.ndarray]  # of links that have a mass, by number
    curve: np.ndarray  # (2, angles), closed over a whole turn
    point: np.ndarray
    slides: tuple[Slide, ...]
    shortest: tuple[float, ...]

    @property
    def lettered(self) -> dict[str, np.ndarray]:
        """Places of pins alone, without the centres of yokes."""
        return {name: place for name, place in self.pins.items() if is_pin(name)}

    def turned(self, turn: np.ndarray) -> Shape:
        """Return the shape turned about the origin by a rotation matrix."""
        return self._replace(
            pins={name: turn @ place for name, place in self.pins.items()},
            centres={number: turn @ place for number, place in self.centres.items()},
            curve=turn @ self.curve,
            point=turn @ self.point,
            slides=tuple(slide.turned(turn) for slide in self.slides),
        )


def part_of(ds: xr.Dataset) -> Part | None:
    """Return the first and the last crank angle [degree] of results; None of whole turns, and of one angle or none."""
    if ds.sizes.get(signals.INDEX, 0) < 2:
        return None
    angles = np.sort(ds[signals.INDEX].values.astype(float))
    whole = ds.attrs.get(signals.WHOLE_TURN, signals.full_turn(angles))
    return None if whole else (float(angles[0]), float(angles[-1]))


def positions(
    scene: Scene, drawing: Drawing, angles: Sequence[float] | np.ndarray, part: Part | None = None
) -> xr.Dataset:
    """Return the positions of the pins, until they repeat or over a part of the turn, and behind them at these angles,
    with their status."""
    set_aside: dict[str, Any] = dict(drawing.ideal)
    geometry = Scene(replace(scene.mechanism, **set_aside), omega2=0.0)
    outputs = [f"{pin}{axis}" for pin in drawing.moving for axis in "xy"]
    outputs += [name for name in drawing.angles if name in geometry.table.quantity]
    count = CURVE * round(geometry.period / geometry.mechanism.period)
    way = np.arange(count) * (geometry.period / count) if part is None else np.linspace(*part, CURVE + 1)
    cycle = sweep(geometry, theta2=np.append(way, angles), of=outputs)
    signals.require_one_design(cycle.values())
    return cycle


def shape_of(scene: Scene, drawing: Drawing, cycle: xr.Dataset, point: Any) -> Shape:
    """Return the machine's shape at the last angle of a cycle, with the curves over the others."""
    places = places_of(scene, drawing, cycle)
    path, whole = curve_of(scene, drawing, cycle, places, point), signals.full_turn(cycle[signals.INDEX].values[:-1])
    slides = (
        Slide(places[block.pin] - (places[block.on[1]] if block.on else 0.0), axes_of(scene, cycle, block.sides))
        for block in drawing.blocks
    )
    lengths = (np.hypot(*(places[end] - places[start])) for start, end in drawing.telescopes)
    return Shape(
        pins={pin: places[pin][:, -1] for pin in sorted(places)},
        centres={number: place[:, -1] for number, place in centres_of(scene, drawing, cycle, places).items()},
        curve=np.append(path[:, :-1], path[:, :1], axis=1) if whole else path[:, :-1],
        point=path[:, -1],
        slides=tuple(slides),
        shortest=tuple(float(np.nanmin(length)) for length in lengths),
    )


def places_of(scene: Scene, drawing: Drawing, cycle: xr.Dataset) -> dict[str, np.ndarray]:
    """Return the place of each pin [m] at every angle of a cycle, (2, angles)."""
    count = cycle.sizes[signals.INDEX]
    fixed = drawing.fixed(scene.mechanism)
    places = {pin: np.repeat(place[:, None], count, axis=1) for pin, place in fixed.items()}
    return places | {
        pin: np.array([signals.spread(cycle[f"{pin}{axis}"], count) for axis in "xy"]) for pin in drawing.moving
    }


def curve_of(
    scene: Scene, drawing: Drawing, cycle: xr.Dataset, places: dict[str, np.ndarray], point: Any = None
) -> np.ndarray:
    """Return the places [m] of the carrier's point at every angle of a cycle, (2, angles)."""
    carrier = drawing.carrier
    if carrier.end and point is None:
        return places[carrier.end]
    cg = scene.mechanism.masses()[carrier.role]
    at = _polar(*((cg.cg_distance, cg.cg_angle) if point is None else point))
    return point_of(scene, drawing, cycle, places, carrier.number, *at)


def centres_of(
    scene: Scene, drawing: Drawing, cycle: xr.Dataset, places: Mapping[str, np.ndarray]
) -> dict[int, np.ndarray]:
    """Return the places [m] of the centres of gravity, (2, angles), of links that have a mass."""
    masses = scene.mechanism.masses()
    heavy = {body.number: masses[body.role] for body in scene.mechanism.bodies if one(masses[body.role].mass) > 0.0}
    points = {number: _polar(link.cg_distance, link.cg_angle) for number, link in heavy.items()}
    return {number: point_of(scene, drawing, cycle, places, number, *at) for number, at in points.items()}


def point_of(
    scene: Scene,
    drawing: Drawing,
    cycle: xr.Dataset,
    places: Mapping[str, np.ndarray],
    number: int,
    along: Any,
    across: Any,
) -> np.ndarray:
    """Return the places [m] of a point of a link, by its coordinates in the link's axes, (2, angles)."""
    x, y = axes_of(scene, cycle, drawing.frames[number])
    return places[drawing.pins_of(number)[0]] + along * np.array([x, y]) + across * np.array([-y, x])


def _polar(distance: Any, angle: Any) -> tuple[float, float]:
    cos, sin = cos_sin(angle)
    return one(distance) * one(cos), one(distance) * one(sin)


def axes_of(scene: Scene, cycle: xr.Dataset, frame: Frame) -> np.ndarray:
    """Return the direction of a frame's x axis at each angle of a cycle, (2, angles)."""
    angle = np.radians(angle_of(scene, cycle, frame))
    return np.array([np.cos(angle), np.sin(angle)])


def angle_of(scene: Scene, cycle: xr.Dataset, frame: Frame) -> np.ndarray:
    """Return the angle of a frame's x axis [degree] at each angle of a cycle: a variable of it, or a parameter."""
    name: Any = frame.angle
    if isinstance(name, str) and name in cycle:
        angle = signals.spread(cycle[name], cycle.sizes[signals.INDEX])
    else:
        standing = scene.numbers[name][0] if isinstance(name, str) else name
        angle = np.full(cycle.sizes[signals.INDEX], one(standing))
    return angle + one(frame.turned) if np.any(frame.turned) else angle


def one(number: Any) -> float:
    """Return a number of a scene of one design; raise ValueError for several."""
    if isinstance(number, xr.DataArray):
        signals.require_one_design([number])
    return float(number)


def slideway(block: Block, slide: Slide, shape: Shape, half: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the pivot of a link that carries a block, the foot of it on the block's line, and the ends of the link's
    slideway, as long as the block's travel."""
    along, pivot = slide.along[:, -1], shape.pins[block.on[1] if block.on else ""]
    across = np.array([-along[1], along[0]])
    foot = pivot + across * (across @ (shape.pins[block.pin] - pivot))
    low, high = slide.travel(np.zeros(2))
    ends = np.array([foot + place * along for place in (min(low - 1.4 * half, 0.0), max(high + 1.4 * half, 0.0))])
    return pivot, foot, ends


def block_corners(centre: np.ndarray, along: np.ndarray, half: float) -> np.ndarray:
    """Return the corners of a block about as long as it is wide, the first again at the end."""
    x, y = half * along, 0.92 * half * np.array([-along[1], along[0]])
    return centre + np.array([-x - y, x - y, x + y, y - x, -x - y])


def half_side(drawing: Drawing, shape: Shape) -> float:
    """Return half a side of the blocks [m]."""
    pairs = [(shape.pins[pins[0]], shape.pins[pins[1]]) for pins in drawing.bars.values()]
    lengths = [float(np.hypot(*(end - start))) for start, end in pairs]
    if "D" in shape.pins:
        lengths.append(float(np.hypot(*shape.pins["D"])))
    return BLOCK * float(np.sqrt(2.0 / len(lengths))) * sum(lengths) / len(lengths)
