"""Scenes, machines, loads and links as a notebook shows them: a small drawing, and their numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from linksweep.base.fields import NumberField, declared, left_out
from linksweep.base.validate import UNITS, is_array
from linksweep.mechanisms import Mechanism
from linksweep.plot.kit.drawings import drawing_of
from linksweep.plot.kit.shape import Shape, half_side, positions, shape_of
from linksweep.reports import scene_tables
from linksweep.reports.markup import Markup, joined, table, tag
from linksweep.scene.designs.choose import chosen, design_labels
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import shown_units
from linksweep.tables.table import STYLE

WIDTH, HEIGHT, ROOM = 260.0, 170.0, 16.0
"""Pixels of the drawing, and of the room around it."""
POINTS = 120
"""Points of the curve that is drawn."""
ANGLE = 45.0
"""Crank angle of the drawing [degree], where the machine has a position there."""


def html_of(thing: Any) -> str:
    """Return a scene, a machine, a load or a link as HTML.

    Parameters
    ----------
    thing : Scene, Mechanism or another object of numbers
        What a notebook shows; of a scene of several designs the first is drawn.

    Returns
    -------
    str
        A drawing, where there is one, and tables.
    """
    if isinstance(thing, Scene):
        return _page(type(thing.mechanism).__name__, thing, _scene_tables)
    if isinstance(thing, Mechanism):
        return _page(type(thing).__name__, thing, _machine_tables)
    return tag("div", Markup(STYLE), tag("p", type(thing).__name__), _fields(thing), class_="linksweep")


def _page(title: str, thing: Any, tables: Any) -> str:
    """Return the drawing beside the tables of the first design."""
    scene = thing if isinstance(thing, Scene) else _alone(thing)
    labels = design_labels(scene) if scene else {}
    first = _first(scene, labels) if scene else None
    if scene is None or first is None:
        return tag("div", Markup(STYLE), tag("p", title), _fields(thing), class_="linksweep")
    several = " × ".join(f"{len(names)} {dim}" for dim, names in labels.items())
    heading = f"{title}, {several}: the first of them" if several else title
    parts = joined(tag("p", heading), *tables(first))
    beside = tag("div", parts, style="flex:1 1 auto;max-width:100%;overflow-x:auto")
    both = tag("div", _drawing(first), beside, style="display:flex;flex-wrap:wrap;gap:1em;align-items:flex-start")
    return tag("div", Markup(STYLE), both, class_="linksweep")


def _alone(machine: Mechanism) -> Scene | None:
    """Return a scene of a machine that does nothing but turn; None for one that takes other motion."""
    return Scene(machine, omega2=1.0) if machine.motion[0] == "omega2" else None


def _first(scene: Scene, labels: dict[str, np.ndarray]) -> Scene | None:
    """Return the first design of a scene; None where it is refused by itself."""
    try:
        return chosen(scene, {dim: names[0] for dim, names in labels.items()}) if labels else scene
    except ValueError:
        return None


def _scene_tables(scene: Scene) -> list[Markup]:
    return [scene_tables.links(scene), scene_tables.settings(scene), scene_tables.loads(scene)]


def _machine_tables(scene: Scene) -> list[Markup]:
    return [scene_tables.links(scene)]


def _fields(thing: Any) -> Markup:
    """Return the table of an object's fields, each with its unit."""
    rows, system = [], shown_units()
    for name, kind, _ in declared(thing):
        value = getattr(thing, name)
        if not left_out(value):
            unit = UNITS[kind.rule.kind] if isinstance(kind, NumberField) and isinstance(value, float) else ""
            rows.append((name, _text(system.value(value, unit)), system.unit(unit).removesuffix("1")))
    return table((), rows)


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:g}"
    if is_array(value):
        return f"{dict(value.sizes)}: {float(value.min()):g} to {float(value.max()):g}" if value.size else "empty"
    return value if isinstance(value, str) else repr(value)


def _drawing(scene: Scene) -> Markup:
    """Return the machine in one position as SVG; nothing for a machine that is not drawn, or nowhere assembled."""
    if scene.mechanism.drawing is None:
        return Markup()
    drawing = drawing_of(scene.mechanism)
    cycle = positions(scene, drawing, [ANGLE])
    if int(np.ravel(cycle.status.values)[-1] if cycle.status.ndim else cycle.status):
        good = np.flatnonzero(np.broadcast_to(cycle.status.values, cycle.sizes["theta2"]) == 0)
        if not good.size:
            return Markup()
        cycle = positions(scene, drawing, [float(cycle.theta2.values[good[len(good) // 2]])])
    shape = shape_of(scene, drawing, cycle, None)
    return _svg(shape, [*drawing.bars.values()], [block.pin for block in drawing.blocks], half_side(drawing, shape))


def _svg(shape: Shape, bars: list[tuple[str, ...]], blocks: list[str], half: float) -> Markup:
    every = np.array([*shape.pins.values(), *shape.curve.T])
    every = every[np.isfinite(every).all(axis=1)]
    low, high = every.min(axis=0), every.max(axis=0)
    scale = min((WIDTH - 2 * ROOM) / max(high[0] - low[0], 1e-300), (HEIGHT - 2 * ROOM) / max(high[1] - low[1], 1e-300))
    middle = 0.5 * (low + high)

    def at(place: np.ndarray) -> np.ndarray:
        return np.array([WIDTH, HEIGHT]) / 2.0 + scale * (place - middle) * [1.0, -1.0]

    size = f"0 0 {WIDTH:g} {HEIGHT:g}"
    links = [*_links(shape, bars, at), *_blocks(shape, blocks, half * scale, at), *_centres(shape, at)]
    parts = [*_curve(shape, at), *links, *_pins(shape, at)]
    look = {"width": f"{WIDTH:g}", "height": f"{HEIGHT:g}", "viewBox": size, "role": "img", "class_": "machine"}
    return tag("svg", *parts, **look)


def _path(points: Any, **look: str) -> Markup:
    return tag("polyline", points=" ".join(f"{x:.1f},{y:.1f}" for x, y in points), **look)


def _curve(shape: Shape, at: Any) -> Iterator[Markup]:
    curve = shape.curve[:, :: max(1, shape.curve.shape[1] // POINTS)].T
    gaps = np.flatnonzero(~np.isfinite(curve).all(axis=1))
    for piece in np.split(curve, gaps):
        there = piece[np.isfinite(piece).all(axis=1)]
        if len(there) > 1:
            yield _path(map(at, there), fill="none", stroke="#56B4E9")


def _links(shape: Shape, bars: list[tuple[str, ...]], at: Any) -> Iterator[Markup]:
    for pins in bars:
        corners = [at(shape.pins[pin]) for pin in pins]
        closed = [*corners, corners[0]] if len(corners) > 2 else corners
        look = {"stroke": "#8A9AA8", "stroke_width": "5", "stroke_linejoin": "round", "stroke_linecap": "round"}
        fill = "#DCE6EE" if len(corners) > 2 else "none"
        yield _path(closed, fill=fill, **{key.replace("_", "-"): value for key, value in look.items()})


def _blocks(shape: Shape, blocks: list[str], half: float, at: Any) -> Iterator[Markup]:
    side = min(max(0.6 * half, 5.0), 12.0)
    for pin, slide in zip(blocks, shape.slides, strict=True):
        x, y = at(shape.pins[pin])
        turned = -float(np.degrees(np.arctan2(slide.along[1, -1], slide.along[0, -1])))
        box = {"x": f"{x - side:.1f}", "y": f"{y - side:.1f}", "width": f"{2 * side:.1f}", "height": f"{2 * side:.1f}"}
        yield tag("rect", **box, transform=f"rotate({turned:.1f} {x:.1f} {y:.1f})", fill="#DCE6EE", stroke="#3F4B55")


def _centres(shape: Shape, at: Any) -> Iterator[Markup]:
    """Yield the sign of each centre of gravity, a circle in black and white quarters."""
    for place in shape.centres.values():
        x, y = at(place)
        rim, quarters = "M-4 0A4 4 0 0 0 4 0A4 4 0 0 0 -4 0Z", "M0 0V-4A4 4 0 0 1 4 0ZM0 0V4A4 4 0 0 1 -4 0Z"
        sign = tag("path", d=rim, fill="white", stroke="black"), tag("path", d=quarters, fill="black")
        yield tag("g", *sign, class_="centre", transform=f"translate({x:.1f} {y:.1f})")


def _pins(shape: Shape, at: Any) -> Iterator[Markup]:
    for name, place in shape.lettered.items():
        x, y = at(place)
        yield tag("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r="3", fill="white", stroke="#3F4B55")
        style = {"font-size": "11", "fill": "currentColor"}
        yield tag("text", name, x=f"{x + 5:.1f}", y=f"{y - 5:.1f}", **style)
