"""The inputs of a report: links in a table, motion and loads in words.

Where no units are chosen, lengths stand in mm (from 10 m on in m), speeds of a crank in rpm beside rad/s, pressures in
bar. A number that changes over the revolution stands as its least and its largest value.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from linksweep.base.fields import (
    FieldKind,
    NumberField,
    PairField,
    RowField,
    declared,
    field_rules,
    has_fields,
    left_out,
)
from linksweep.base.records import NamedField
from linksweep.mechanisms.links import Bar, Disk, Guide
from linksweep.mechanisms.machine import Machine
from linksweep.reports.markup import Markup, symbol, table, with_unit, written
from linksweep.reports.units_of_page import unit_of_input
from linksweep.scene.changes import angles_of_changes
from linksweep.scene.loads.ends import GROUND
from linksweep.scene.loads.load import Load
from linksweep.scene.loads.springs import EndField
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import UnitSystem, shown_units

LEFT_OUT = ("length", "angle")
"""Kinds of number that are left out at their default, no offset and no turn."""

TITLES = {"ground": "ground pin", "points": "pin", "guides": "guide", "branch": "branch of", "gears": "gears of"}
"""Titles of the rows of a linkage's named numbers, by parameter."""

SAMPLES = 720  # even angles for numbers that change over the revolution


def kind_of(scene: Scene) -> str:
    """Return the kind of machine, in words."""
    return scene.mechanism.title or type(scene.mechanism).__name__


def links(scene: Scene) -> Markup:
    """Return the table of the links: lengths, masses, inertias and centres of gravity."""
    mechanism, system = scene.mechanism, shown_units(scene.units)
    header = ["link", "length", "mass", "inertia", "centre of gravity", "made as"]
    rows = [_link(mechanism, body.role, body.number, system) for body in mechanism.bodies]
    if not any(row[-1] for row in rows):
        header, rows = header[:-1], [row[:-1] for row in rows]
    return table(header, rows, class_="links") if rows else Markup()


def loads(scene: Scene) -> Markup:
    """Return the table of the loads, each in words."""
    system, pairs = shown_units(scene.units), zip(_sampled(scene).loads, scene.loads, strict=True)
    words = (_load(load, scene.mechanism, system) + _followed(own) for load, own in pairs)
    rows = [(f"load {k}", text) for k, text in enumerate(words, 1)]
    return table((), rows, class_="settings") if rows else Markup()


def settings(scene: Scene) -> Markup:
    """Return the table of the mechanism's other parameters, its drive, its speed and gravity."""
    sampled, system = _sampled(scene), shown_units(scene.units)
    rows = [
        *_of_mechanism(sampled.mechanism, system),
        *_of_motion(sampled, system),
        ("gravity", _gravity(scene.gravity, system)),
    ]
    return table((), rows, class_="settings")


def _sampled(scene: Scene) -> Scene:
    """Return the scene with all that changes over the angle at `SAMPLES` angles, and where arrays and loads change."""
    return scene.at(scene.grid(np.union1d(scene.grid(SAMPLES).angles, angles_of_changes(scene))))


def _link(mechanism: Any, role: str, number: int, system: UnitSystem) -> tuple[str, ...]:
    """Return a row of the table; a slider or a block has its numbers in the mechanism itself."""
    link = mechanism.parts.get(role)
    owner, prefix = (mechanism, f"{role}_") if link is None else (link, "")
    values = {kind: getattr(owner, prefix + kind, None) for kind in ("length", "mass", "inertia")}
    sizes = ("" if value is None else quantity(value, kind, system) for kind, value in values.items())
    distance, angle = (getattr(owner, f"{prefix}cg_{word}") for word in ("distance", "angle"))
    place = f"{quantity(distance, 'length', system)} at {degrees(angle)}"
    cg = f"on {_origin(mechanism, role)}" if distance == 0.0 else place
    return f"{number} {role}", *sizes, cg, _made(link, system)


def _made(link: Any, system: UnitSystem) -> str:
    factor = unit_of_input("length", 0.0, system)[1]
    if isinstance(link, Bar):
        size = f"bar {_number(link.width, factor)} × {quantity(link.thickness, 'length', system)}"
    elif isinstance(link, Disk):
        size = f"disk ⌀ {_number(2.0 * link.radius, factor)} × {quantity(link.thickness, 'length', system)}"
    else:
        return ""
    return f"{size}, {quantity(link.density, 'density', system)}"


def _of_mechanism(mechanism: Any, system: UnitSystem) -> Iterator[tuple[str, str]]:
    """Yield the parameters that belong to no link, and the branch."""
    bodies = tuple(f"{body.role}_" for body in mechanism.bodies)
    for name, field, default in declared(mechanism):
        value = getattr(mechanism, name)
        kind = field.rule.kind if isinstance(field, NumberField) else ""
        if kind and not name.startswith(bodies) and not (kind in LEFT_OUT and value == default):
            yield _plain(name), quantity(value, kind, system)
        elif isinstance(value, str):
            yield name, value
        elif isinstance(field, NamedField) and not field.inline:
            title = TITLES.get(name, name)
            yield from ((f"{title} {key}", _named(field.each, item, system)) for key, item in value.items())
    for role in mechanism.topology.cylinders if isinstance(mechanism, Machine) else ():
        length = getattr(mechanism.parts.get(role), "length", None)
        yield f"cylinder {role}", "follows" if length is None else f"{quantity(length, 'length', system)} long"


def _named(kind: FieldKind, item: Any, system: UnitSystem) -> str:
    """Return a named thing in words: a point, a word, a guide, or gears by their fields."""
    if isinstance(item, Guide):
        return _guide(item, system)
    if isinstance(kind, PairField):
        return _pair(kind, item, system)
    return ", ".join(_fields(item, system)) if has_fields(item) else item


def _guide(guide: Guide, system: UnitSystem) -> str:
    """Return a guide in words: "on the ground, through (0 mm, 20 mm) at 20°, friction 0.1"."""
    host = "on the ground" if guide.of == GROUND else f"on the {guide.of}, in its axes"
    x, y = (quantity(number, "length", system) for number in guide.through)
    friction = f", friction {quantity(guide.friction, 'dimensionless', system)}" if np.any(guide.friction) else ""
    return f"{host}, through ({x}, {y}) at {degrees(guide.angle)}{friction}"


def _pair(kind: PairField, pair: Any, system: UnitSystem) -> str:
    """Return a point in words, by its coordinates or by distance and angle."""
    first, second = quantity(pair[0], kind.first.kind, system), quantity(pair[1], kind.second.kind, system)
    return f"{first} at {second}" if kind.second.kind == "angle" else f"({first}, {second})"


def _of_motion(sampled: Scene, system: UnitSystem) -> Iterator[tuple[str, str]]:
    """Yield the parameters of the motion that the mechanism takes, in words."""
    mechanism, remarks = sampled.mechanism, sampled.mechanism.remarks(vars(sampled))
    if "drive" in mechanism.motion:
        yield "drive", f"{sampled.drive}; unknown: {symbol(mechanism.drives[sampled.drive])}"
    if "omega2" in mechanism.motion:
        yield f"speed of the {mechanism.roles[0]}", _speed(sampled.omega2, system)
    if np.any(np.not_equal(sampled.motion.get("alpha2", 0.0), 0.0)):
        yield "its acceleration", quantity(sampled.motion["alpha2"], "angular_acceleration", system)
    for name in ("speed", "thrust"):
        if name in mechanism.motion:
            size = quantity(getattr(sampled, name), field_rules(Scene)[name].kind, system)
            yield name, f"{size} {remarks.get(name, '')}".rstrip()
    turns = round(sampled.period / mechanism.period)
    if turns > 1:
        yield "cycle", f"{turns} turns of the crank"


def _speed(omega2: Any, system: UnitSystem) -> str:
    clockwise = np.mean(omega2) < 0.0
    size = -omega2 if clockwise else omega2
    way = "clockwise" if clockwise else "counter-clockwise"
    beside = "" if system.chosen else f" ({_number(size)} rad/s)"
    return f"{quantity(size, 'angular_velocity', system)}{beside} {way}"


def _gravity(gravity: Sequence[Any], system: UnitSystem) -> str:
    x, y = gravity
    size = quantity(float(np.hypot(x, y)), "acceleration", system)
    if x == 0.0:
        return "none" if y == 0.0 else f"{size} {'down' if y < 0.0 else 'up'}"
    return f"{size} at {degrees(float(np.degrees(np.arctan2(y, x))))} to x"


def _load(load: Any, mechanism: Any, system: UnitSystem) -> str:
    """Return a load in words: a force or torque as a sentence, anything else by its parameters."""
    if not isinstance(load, Load):
        return _in_words(load, system)
    parts = []
    if load.force is not None:
        start = "its centre of gravity" if load.origin == "cg" else _origin(mechanism, load.link)
        axes = "" if load.frame == "ground" else ", in its own axes"
        unit, factor = unit_of_input("force", load.force, system)
        x, y = (_number(part, factor) for part in load.force)
        parts.append(f"({x}, {y}) {unit} on the {load.link}{axes}, {_place(load.at, start, system)}")
    if load.torque is not None:
        parts.append(f"{quantity(load.torque, 'torque', system)} on the {load.link}")
    return "; ".join(parts + _breaks(load.breaks))


def _place(at: Sequence[Any], origin: str, system: UnitSystem) -> str:
    """Return a point of a link in words, by its polar coordinates from an origin."""
    distance, angle = at
    if np.all(distance == 0.0):
        return f"at {origin}"
    return f"{quantity(distance, 'length', system)} at {degrees(angle)} from {origin}"


def _origin(mechanism: Any, role: str) -> str:
    """Return the origin of a link's own coordinates, in words."""
    if getattr(mechanism.parts.get(role), "length", None) is not None:
        return "its first pin"
    yokes = mechanism.topology.yokes if isinstance(mechanism, Machine) else ()
    return "its slot at the guide" if role in yokes else "its pin"


def _followed(load: Any) -> str:
    """Return the position that a load follows, and the direction of motion in which it acts."""
    if getattr(load, "over", None) is None:
        return ""
    return f", over {load.over}" + (f", while {load.while_}" if load.while_ else "")


def _breaks(angles: Sequence[float]) -> list[str]:
    """Return in words the angles at which a load jumps, kinks or is narrow."""
    return [f"breaks at {', '.join(degrees(angle) for angle in angles)}"] if angles else []


def _in_words(part: Any, system: UnitSystem) -> str:
    """Return a dataclass in words: "Spring (from ground at (300 mm, 0 mm), to …, rate 2 N/mm)"."""
    title = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(part).__name__).capitalize()
    return f"{title} ({', '.join(_fields(part, system))})"


def _fields(part: Any, system: UnitSystem) -> list[str]:
    """Return those fields of a dataclass that are stated, each in words."""
    fields = ((name, kind, getattr(part, name)) for name, kind, _ in declared(part))
    return [_field_in_words(_plain(name), kind, value, system) for name, kind, value in fields if not left_out(value)]


def _field_in_words(name: str, kind: FieldKind, value: Any, system: UnitSystem) -> str:
    if has_fields(value):
        return f"{name}: {_in_words(value, system)}"
    if isinstance(kind, NumberField):
        return f"{name} {quantity(value, kind.rule.kind, system)}"
    if isinstance(kind, PairField):
        return f"{name} {_pair(kind, value, system)}"
    if isinstance(kind, RowField):
        return f"{name} at {', '.join(quantity(number, kind.rule.kind, system) for number in value)}"
    return f"{name} {_end(value, system) if isinstance(kind, EndField) else value}"


def _end(end: tuple[str, Any, Any], system: UnitSystem) -> str:
    """Return the end of a spring in words: a point of the ground, or of a link in its polar coordinates."""
    link, first, second = end
    if link == GROUND:
        return f"ground at ({quantity(first, 'length', system)}, {quantity(second, 'length', system)})"
    return f"{link}, {_place((first, second), 'its first pin', system)}"


def _plain(name: str) -> str:
    return name.strip("_").replace("_", " ")


def quantity(value: Any, kind: str, system: UnitSystem) -> str:
    """Format a parameter in its unit on the page; for one that changes over the revolution, its least and largest
    value."""
    unit, factor = unit_of_input(kind, value, system)
    return with_unit(_number(value, factor), unit)


def degrees(value: Any) -> str:
    """Format an angle, or the least and largest of several."""
    return with_unit(_number(value), "°")


def _number(value: Any, factor: float = 1.0) -> str:
    low, high = (written(_short(float(extreme(value)) * factor)) for extreme in (np.min, np.max))
    return low if low == high else f"{low} to {high}"


def _short(value: float) -> str:
    """Format a number with five significant digits, without trailing zeros."""
    if value == 0.0 or 1e-3 <= abs(value) < 1e7:
        return f"{value:.{max(5, len(f'{abs(value):.0f}'))}g}"
    digits, _, power = f"{value:.4e}".partition("e")
    return f"{digits.rstrip('0').rstrip('.')}e{power}"
