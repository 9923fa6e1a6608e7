"""Read a document's records into a drawing in SI units."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import chain, count
from typing import NamedTuple, TypeVar

from linksweep.base.units import quantity
from linksweep.base.validate import quote, refuse
from linksweep.files.pmks.drawing import Body, Drawing, Force, Joint, Point
from linksweep.files.pmks.text import integer, sections, unsigned

CLOCKWISE, WITHOUT_GRAVITY = 1 << 0, 1 << 8
SLIDES, DRIVEN, GROUNDED, WELDED, SEALED = 1 << 0, 1 << 1, 1 << 2, 1 << 3, 1 << 5
FOLLOWS, OUTWARD = 1 << 0, 1 << 1
WHOLE, PART = "YAMG0123", "Namg4567"
"""First characters of the records of whole bodies, and of the links welded in them."""
PICTURE = "JLFHKCST"
"""First characters of extras about the picture, its editing, or the strength of links: locks, holds, colours, …"""
GRAVITY = 9.80665
LINEAR_SPEED = 5.0
"""Speed of a sliding input where a document states none, in its unit of length per second."""


class Units(NamedTuple):
    """Units of a document's numbers."""

    length: str
    mass: str
    inertia: str
    force: str


UNITS = (Units("in", "lb", "lb in^2", "lbf"), Units("cm", "g", "kg cm^2", "N"), Units("m", "kg", "kg m^2", "N"))
Record = TypeVar("Record", Joint, Body, Force)


def read_drawing(text: str) -> Drawing:
    """Read the text of a document.

    Parameters
    ----------
    text : str
        Text of the document.

    Returns
    -------
    Drawing
        Its joints, bodies and forces in SI units. A slider that an older document has as two joints with a block
        between them is one joint.

    Raises
    ------
    ValueError
        Where the text is damaged or no document; where records cannot be read, or refer to what is not there: all of
        them, one a line.
    """
    parts = sections(text)
    numbers = _numbers(parts.settings, parts.extras)
    problems: list[str] = []
    joints = _read("joint", parts.joints, numbers.joint, problems)
    links = _read("link", parts.links, numbers.body, problems)
    forces = _read("force", parts.forces, numbers.force, problems)
    refuse(problems or _dangling(joints, links, forces))
    blocks = {record[2:].partition(",")[0] for record in parts.links if record[1] == "P"}
    whole = {record[2:].partition(",")[0] for record in parts.links if record[0] in WHOLE} - blocks
    joints, links = _lettered(*_folded(joints, links, blocks))
    owner = {part: name for name in whole for part in _parts(links, name)}
    return Drawing(
        {name: replace(joint, carrier=owner.get(joint.carrier, "")) for name, joint in joints.items()},
        {name: body for name, body in links.items() if name in whole},
        tuple(replace(force, body=owner[force.body]) for force in forces.values() if force.body in owner),
        numbers.gravity,
        tuple(_left_out(parts.joints, parts.extras)),
    )


def _read(kind: str, records: list[str], read: Callable[[str], Record], problems: list[str]) -> dict[str, Record]:
    """Return the records by name."""
    result: dict[str, Record] = {}
    for record in records:
        try:
            item = read(record)
        except (ValueError, IndexError, ZeroDivisionError):
            problems.append(
                f"{kind} {quote(record)}: cannot be read; the document is damaged, or newer than this reader"
            )
            continue
        if item.name in result:
            problems.append(f"{kind} {item.name}: is there twice")
        result[item.name] = item
    return result


def _numbers(settings: list[str], extras: list[str]) -> _Numbers:
    flags, decimals, integers, units = settings
    tagged = (extra[1:].rpartition("~") for extra in extras if extra[0] == "P")
    exact = {tag: float(value) for tag, _, value in tagged}
    system = unsigned(units[:1])
    if system >= len(UNITS):
        raise ValueError(f"the document's unit of length is number {system}: must be 0 (in), 1 (cm) or 2 (m)")
    rpm = exact.get("I~0", integer(integers.split(",")[0]))
    linear = exact.get("D~1", integer((decimals + ",").split(",")[1]) / 1000) or LINEAR_SPEED
    turning = -rpm if unsigned(flags) & CLOCKWISE else rpm
    gravity = 0.0 if unsigned(flags) & WITHOUT_GRAVITY else GRAVITY
    return _Numbers(UNITS[system], turning, linear, gravity, exact)


@dataclass(frozen=True)
class _Numbers:
    """Numbers of a document: units, speeds of inputs, gravity, and by tag those with more digits than records have."""

    units: Units
    rpm: float
    linear_speed: float
    gravity: float
    exact: Mapping[str, float]

    def joint(self, record: str) -> Joint:
        first, _, x, y, angle, *fields = record.split(",")
        carrier, start, end, speed, mass, *_ = fields + [""] * 5
        flags, name = unsigned(first[0]), first[1:]
        own_speed = self._number(f"J{name}~3", speed)
        return Joint(
            name,
            self._point(f"J{name}", 0, x, y),
            grounded=bool(flags & GROUNDED),
            driven=bool(flags & DRIVEN),
            slides=bool(flags & SLIDES),
            welded=bool(flags & WELDED),
            sealed=bool(flags & SEALED and carrier),
            angle=_whole_degree(math.degrees(self._number(f"J{name}~2", angle))),
            carrier=carrier,
            slot=(start, end),
            speed=self._along(own_speed) if flags & SLIDES else _turning(own_speed or self.rpm),
            mass=self._quantity(f"J{name}~4", mass, "mass", self.units.mass),
        )

    def body(self, record: str) -> Body:
        name, title, mass, inertia, x, y, _, *names = record[2:].split(",")
        if record[0] not in WHOLE + PART or record[1] not in "RP":
            raise ValueError
        end = names.index("")
        return Body(
            name,
            title,
            tuple(names[:end]),
            self._quantity(f"L{name}~0", mass, "mass", self.units.mass),
            self._quantity(f"L{name}~1", inertia, "inertia", self.units.inertia),
            self._point(f"L{name}", 2, x, y),
            tuple(part for part in names[end:] if part),
        )

    def force(self, record: str) -> Force:
        first, body, _, x, y, end_x, end_y, size, *_ = record.split(",")
        flags, name = unsigned(first[0]), first[1:]
        at, end = self._point(f"F{name}", 0, x, y), self._point(f"F{name}", 2, end_x, end_y)
        arrow = end[0] - at[0], end[1] - at[1]
        force = self._quantity(f"F{name}~4", size, "force", self.units.force)
        scale = math.copysign(force / math.hypot(*arrow), 1 if flags & OUTWARD else -1) if force else 0.0
        return Force(name, body, at, (scale * arrow[0], scale * arrow[1]), bool(flags & FOLLOWS))

    def _number(self, tag: str, digits: str) -> float:
        return self.exact.get(tag, integer(digits) / 1000)

    def _quantity(self, tag: str, digits: str, kind: str, unit: str) -> float:
        return quantity(self._number(tag, digits), kind, unit)

    def _point(self, tag: str, first: int, x: str, y: str) -> Point:
        unit = self.units.length
        return (
            self._quantity(f"{tag}~{first}", x, "length", unit),
            self._quantity(f"{tag}~{first + 1}", y, "length", unit),
        )

    def _along(self, speed: float) -> float:
        return quantity(speed or self.linear_speed, "velocity", f"{self.units.length}/s")


def _turning(rpm: float) -> float:
    return quantity(rpm, "angular_velocity", "rpm")


def _whole_degree(angle: float) -> float:
    """Return the whole degree from which an angle differs by no more than rounding to a thousandth of a radian."""
    return float(round(angle)) if abs(angle - round(angle)) <= math.degrees(0.0005) else angle


def _dangling(joints: dict[str, Joint], links: dict[str, Body], forces: dict[str, Force]) -> list[str]:
    """Return a line for each name to which a record refers without its being there."""
    named: list[tuple[str, str, Collection[str]]]
    named = [(f"joint {joint.name}", joint.carrier, links) for joint in joints.values() if joint.carrier]
    named += [(f"joint {joint.name}", pin, joints) for joint in joints.values() for pin in joint.slot if pin]
    named += [(f"link {link.name}", pin, joints) for link in links.values() for pin in link.joints]
    named += [(f"link {link.name}", part, links) for link in links.values() for part in link.parts]
    named += [(f"force {force.name}", force.body, links) for force in forces.values()]
    undirected = [joint for joint in joints.values() if joint.carrier and "" in joint.slot]
    return [f"joint {joint.name}: slides on {joint.carrier} in no direction" for joint in undirected] + [
        f"{place}: refers to {name}, which is not in the document" for place, name, known in named if name not in known
    ]


def _folded(
    joints: dict[str, Joint], links: dict[str, Body], blocks: Iterable[str]
) -> tuple[dict[str, Joint], dict[str, Body]]:
    """Return joints and links with each block's pin and sliding joint as one: it has the pin's name."""
    for block in blocks:
        pin, slide = sorted((joints[name] for name in links[block].joints), key=lambda joint: joint.slides)
        moved = replace(slide, name=pin.name, grounded=slide.grounded or (pin.grounded and not slide.carrier))
        moved = replace(moved, welded=pin.welded, driven=slide.driven or pin.driven, mass=links[block].mass)
        others = {name: joint for name, joint in joints.items() if name != slide.name} | {pin.name: moved}
        names = {name: name for name in joints} | {"": "", slide.name: pin.name}
        joints = {
            name: replace(joint, slot=(names[joint.slot[0]], names[joint.slot[1]])) for name, joint in others.items()
        }
        links = {
            name: replace(link, joints=tuple(dict.fromkeys(names[pin] for pin in link.joints)))
            for name, link in links.items()
            if name != block
        }
    return joints, links


def _lettered(joints: dict[str, Joint], links: dict[str, Body]) -> tuple[dict[str, Joint], dict[str, Body]]:
    """Return joints and links with a capital letter for each joint, and P with a number where that is taken."""
    letters = {"": ""}
    for name in sorted(joints, key=lambda name: not re.fullmatch("[A-Z]", name)):  # capital letters keep theirs
        letter = name[0].upper() if re.match("[A-Za-z]", name) else "P1"
        choices = chain([letter], (f"P{number}" for number in count(1)))
        letters[name] = next(choice for choice in choices if choice not in letters.values())
    renamed = [
        replace(joint, name=letters[name], slot=(letters[joint.slot[0]], letters[joint.slot[1]]))
        for name, joint in joints.items()
    ]
    return (
        {joint.name: joint for joint in renamed},
        {name: replace(link, joints=tuple(letters[pin] for pin in link.joints)) for name, link in links.items()},
    )


def _parts(links: dict[str, Body], name: str) -> list[str]:
    """Return the name of a body and those of all links welded in it."""
    parts = [name]
    for part in parts:
        parts.extend(inner for inner in links[part].parts if inner in links and inner not in parts)
    return parts


def _left_out(joints: list[str], extras: list[str]) -> list[str]:
    """Return sentences on entries that have no meaning here."""
    fields = {record[1:].partition(",")[0]: record.split(",")[11:] for record in joints}
    entries = [
        f"joint {name}: its entries {','.join(rest)} (friction or a name)" for name, rest in fields.items() if any(rest)
    ]
    gears = [extra for extra in extras if extra.startswith("G1~")]
    others = [extra for extra in extras if extra[0] not in PICTURE + "P" and extra not in gears]
    return entries + ["gears" for _ in gears] + [f"the entry {quote(extra)}" for extra in others]
