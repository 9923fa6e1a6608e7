"""The linkage: any planar machine of pins, slides and cylinders, its topology a text."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from linksweep.base.equality import ByContent
from linksweep.base.fields import POLAR_POINT, PairField, declared, field_problems, of_kind, word
from linksweep.base.frozen import bare, cached_property, normalise, with_sound
from linksweep.base.records import NamedField, Record, named, record
from linksweep.base.validate import Number, Rule, closest, did_you_mean, is_array, is_lazy, name_problems, quote, refuse
from linksweep.chains.gears import Geared
from linksweep.chains.rows.crank import BRANCH, BRANCH_SIGN, turned
from linksweep.chains.shape import Shape
from linksweep.chains.topology import GROUND, RPR, RRP, RRR, Topology, taken, topology
from linksweep.mechanisms.drawing import Drawing, LinkageDrawing
from linksweep.mechanisms.linkage_numbers import (
    ORIGIN,
    branch_sign,
    cylinder_numbers,
    gear_numbers,
    ground_pin,
    guide_line,
    point_on_link,
    slot_numbers,
)
from linksweep.mechanisms.links import (
    GEARS,
    GUIDE,
    PART,
    AnyLink,
    AnyPart,
    Cylinder,
    Gears,
    Guide,
    SampledCylinder,
    Slider,
    link_parameters,
)
from linksweep.mechanisms.machine import Machine
from linksweep.mechanisms.mechanism import register
from linksweep.mechanisms.strokes import OF_BLOCK, OF_LINK, OF_SLIDER, Stroke

GROUND_PIN = PairField(Rule("length"), Rule("length"), "(x, y) in m")
NONE = record(GROUND_PIN, {})
CLASSES = {AnyLink: "a Link, Bar or Disk", Slider: "a Slider", Cylinder: "a Cylinder"}
"""Classes of parts, and their names in words."""
WITH_BRANCHES = (RRR, RRP, RPR)
"""Dyads that have two assemblies."""
MOST_TURNS = 99
"""Turns of the crank after which a machine with gears must repeat, at most."""


@register
@dataclass(frozen=True, eq=False, repr=False, init=False)
class Linkage(Machine):
    """A linkage: any planar machine of pins, slides, cylinders and gears whose dyads close one after the other.

    Parameters
    ----------
    links : str
        Parts with their pins, the crank first, such as "crank A-B, rod B-C, rocker D-C-E"; a link's length is that from
        its first pin to its second. Besides links, "ram F on slide", a slider on a guide or a link; "arm D-E past B",
        a link whose line slides through a block at a pin; "yoke on slide past B", a slider with a slot for a pin;
        "c1 P~B", a cylinder; "wheel D-E : -2 crank", a second crank turned by gears; where their ratio is a fraction
        such as -3/2, the cycle takes as many turns as its denominator. Pins are capital letters, with digits where one
        is not enough; names of parts are words in lower case.
    ground : dict of str to pair of float or DataArray
        Coordinates (x, y) of each pin on the ground [m]; the first is the crank's pivot, from which results count.
    points : dict of str to pair of float or DataArray, default {}
        Third and further pins of links: distance from the link's first pin [m], angle from its line of pins [degree].
    guides : dict of str to Guide, default {}
        Guides by name, on the ground or on a link. One with the name of a link, and `of` that link, takes the place of
        that link's line of pins.
    branch : dict of str to str, default {}
        Assembly of each pin, or link past a pin, that closes in two ways: "open", "crossed", or "both" (adds the
        dimension `branch_F` for a pin F); those left out are open.
    gears : dict of str to Gears, default {}
        Gears of each wheel by its name; those left out have no phase, and pass on a torque alone.
    **parts : Link, Bar, Disk, Slider or Cylinder
        Part of each name in `links`: a Link, Bar or Disk where it has two pins or more, a Slider where it slides on a
        guide, a Cylinder. A cylinder that follows the others may be left out. Each is an attribute, so that a part has
        no name of another attribute of the class, such as drawing, nor one of results, such as power; no two have
        names after which two numbers would be called, as the acceleration a_mass of "mass" and the mass of "a".

    Raises
    ------
    ValueError
        One line for each parameter out of bounds, for each name that does not fit the others, for a mobility other than
        1, and for links that close only together.

    Notes
    -----
    Dyads close one after the other, from ground and crank on. A pin at which two links meet is open to the left of the
    line between their known pins, that of the first link first; a pin on a guide is open ahead of the known pin along
    the guide; a link that a known pin guides, past it or in a block on the link, is open where that pin lies ahead of
    the link's own known pin along its line.

    Links have numbers in the order of `links`: 1 ground, 2 crank, and so on; cylinders have none. Forces are `F16` of
    the ground on link 6, else `F65` of the later link on the earlier, from ten links on `F11_3`; of a slide `F16n`
    across, `F16t` along and the moment `T16` about the slider's pin. Where more than two links share a pin, the first
    carries it, and the pins of the others are "C:upper", "C:lower". `linksweep.quantities` lists all names.

    The position `x_ram` of a slider counts along its guide from the foot of the crank's pivot on it, on a link from the
    foot of the link's first pin. On a link that a known pin guides, `x_arm` or `x_block` counts from the foot of the
    link's own known pin, whichever is named first.

    Examples
    --------
    >>> import linksweep as ls
    >>> steel = dict(width=0.02, thickness=0.02, density=7750)
    >>> pump = ls.Linkage("crank A-B, rod B-C, ram C on slide", ground={"A": (0, 0)},
    ...                   guides={"slide": ls.Guide(through=(0, 0.02), angle=20.0, friction=0.1)},
    ...                   crank=ls.Bar(0.08, **steel), rod=ls.Bar(0.22, **steel), ram=ls.Slider(mass=3.0))
    >>> pump.ram.mass, pump.guides["slide"].angle
    (3.0, 20.0)
    """

    links: str = word('"crank A-B, rod B-C, rocker D-C"')
    ground: Mapping[str, Any] = named(GROUND_PIN, "pins (x, y)", "{A = [0, 0], D = [0.2, 0]}")
    points: Mapping[str, Any] = named(POLAR_POINT, "pins (distance, angle)", "{E = [0.12, -35.0]}", {})
    guides: Mapping[str, Any] = named(GUIDE, "guides", "{slide = {angle = 20.0}}", {})
    branch: Mapping[str, Any] = named(BRANCH, "words", '{F = "crossed"}', {})  # type: ignore[assignment]
    gears: Mapping[str, Any] = named(GEARS, "gears", "{wheel = {phase = 90.0}}", {})
    parts: Mapping[str, Any] = of_kind(NamedField(PART, "parts", inline=True), NONE)

    def __init__(
        self,
        /,
        links: str,
        *,
        ground: Mapping[str, Any],
        points: Mapping[str, Any] = NONE,
        guides: Mapping[str, Any] = NONE,
        branch: Mapping[str, Any] = NONE,
        gears: Mapping[str, Any] = NONE,
        **parts: Any,
    ) -> None:
        if isinstance(parts.get("parts"), Mapping):  # a copy passes on the field of its original
            parts = {**parts.pop("parts"), **parts}
        normalise(self, links=links, ground=ground, points=points, guides=guides, branch=branch, gears=gears)
        normalise(self, parts=parts)
        self.__post_init__()

    def __post_init__(self) -> None:
        ByContent.__post_init__(self)
        refuse(self._problems())
        in_order = {name: self.parts[name] for name in self.topology.names if name in self.parts}
        normalise(self, parts=record(PART, in_order))

    def __getattr__(self, name: str) -> Any:
        parts = vars(self).get("parts", {})
        if name in parts:
            return parts[name]
        raise AttributeError(f"{type(self).__name__} has no attribute {name!r}{did_you_mean(name, parts)}")

    @cached_property
    def topology(self) -> Topology:  # type: ignore[override]
        """Links, pins and slides, and the order in which the dyads close."""
        joined, problems = self._topology_and_problems
        if joined is None or problems:
            raise ValueError("\n".join(problems))
        return joined

    @property
    def _topology_and_problems(self) -> tuple[Topology | None, tuple[str, ...]]:
        hosts = ((name, str(guide.of)) for name, guide in self.guides.items() if isinstance(guide, Guide))
        ratios = ((name, gears.ratio) for name, gears in self.gears.items() if isinstance(gears, Gears))
        cylinders = {role: part for role, part in self.parts.items() if isinstance(part, Cylinder)}
        held = frozenset(role for role, cylinder in cylinders.items() if cylinder.length is not None)
        ground = tuple(self.ground) if isinstance(self.ground, Mapping) else ()  # a scene file may not have been read
        return topology(self.links, ground, tuple(hosts), tuple(ratios), held, RESERVED)

    def _problems(self) -> list[str]:
        """Return the problems of all parameters, and those of names that do not fit each other."""
        if not isinstance(self.links, str):
            return [
                f'links = {quote(self.links)}: must be a text, as "crank A-B, rod B-C, rocker D-C"',
                *field_problems(self),
            ]
        names, fields = taken(self.links, RESERVED), [kind.name for kind in declared(self)[1:]]
        misspelt = misspelt_fields(self.links, self.parts, fields)
        problems = [line for line in field_problems(self) if _first_word(line) not in {**names, **misspelt}]
        unread = {name for name in fields if name in names or not isinstance(getattr(self, name), Record)}
        if misspelt or unread - {"branch"}:  # what depends on them is not known
            return [*names.values(), *misspelt.values(), *problems]
        joined, of_text = self._topology_and_problems
        problems += of_text
        if joined is None:
            return problems
        problems += [*part_problems(joined, self.parts, names), *point_problems(joined, self.points)]
        problems += [*ground_problems(self.ground), *gear_problems(joined, self.gears)]
        if of_text:
            return problems
        return [*(line for line in problems if not line.startswith("branch = ")), *branch_problems(joined, self.branch)]

    @cached_property
    def shape(self) -> Shape:
        steps = frozenset(step.name for step in self.topology.steps)
        inclined = frozenset(name for name, guide in self.guides.items() if turned(guide.angle))
        meshed = frozenset(name for name, gears in self.gears.items() if gears.pressure_angle is not None)
        return Shape(self.topology, turned=steps, inclined=inclined, between=self._between_floats(), meshed=meshed)

    def _between_floats(self) -> frozenset[str]:
        """Return the ground pins and guides whose distance from the crank's pivot is no float in every design."""
        numbers = bare(self)._numbers_of_places()
        low_words = {pin: numbers[f"{pin}_distance_lo"] for pin in [*self.ground][1:]}
        low_words |= {name: numbers[f"{name}_offset_lo"] for name in self.topology.hosts}
        return frozenset(name for name, low_word in low_words.items() if is_lazy(low_word) or np.any(low_word))

    @cached_property
    def drawing(self) -> Drawing:  # type: ignore[override]
        """Linkage as plots draw it."""
        return LinkageDrawing(self.topology, self.ground, self.guides).drawing()

    @property
    def strokes(self) -> dict[str, Stroke]:
        joined, strokes = self.topology, dict[str, Stroke]()
        for role in (*joined.sliders, *joined.yokes):
            x, v = f"x_{role}", f"v_{role}"
            if role in self.sliders:
                strokes[f"{role}.position"] = Stroke(x, v, "length", OF_SLIDER)
                strokes[f"{role}.to_end"] = Stroke(x, v, "length", OF_SLIDER, sense=-1.0, from_end=True)
            else:
                strokes[f"{role}.position"] = Stroke(x, v, "length", OF_BLOCK)
        for role in joined.cylinders:
            strokes[f"{role}.length"] = Stroke(f"length_{role}", f"rate_{role}", "length", OF_BLOCK)
        for role in self.on_ground[1:]:
            k = joined.number(role)
            strokes[f"{role}.angle"] = Stroke(f"theta{k}", f"omega{k}", "angle", OF_LINK)
        return strokes

    @property
    def geared(self) -> Geared:  # type: ignore[override]
        return tuple((role, ratio) for role, ratio in self.topology.gears.items() if ratio.denominator > 1)

    @property
    def fastest(self) -> float:
        return max(1.0, *(abs(float(ratio)) for ratio in self.topology.gears.values()), 0.0)

    @property
    def places(self) -> tuple[str, ...]:  # type: ignore[override]
        return tuple(step.name for step in self.topology.steps)

    def at_angles(self, sample: Callable[[str, Any], tuple[Number, Number, Number]]) -> Self:
        lengths = {role: self.parts[role].length for role in self.topology.struts}
        sampled = {
            role: SampledCylinder(*sample(f"{role}.length", length))
            for role, length in lengths.items()
            if callable(length) or "theta2" in getattr(length, "dims", ())
        }
        return with_sound(self, parts=record(PART, {**self.parts, **sampled})) if sampled else self

    @property
    def branches(self) -> dict[str, str]:
        names = [step.name for step in self.topology.steps if isinstance(step, WITH_BRANCHES)]
        return {f"branch.{name}": self.branch.get(name, "open") for name in names}

    @property
    def both_branches(self) -> dict[str, str]:
        return {f"branch_{name}": f"branch.{name}" for name, branch in self.branch.items() if branch == "both"}

    @property
    def frictions(self) -> dict[str, Number]:
        guides = {f"{name}_friction": guide.friction for name, guide in self.guides.items()}
        return guides | {f"{role} slot_friction": self.parts[role].slot_friction for role in self.topology.yokes}

    @property
    def teeth(self) -> dict[str, Number]:
        numbers = {
            role: gear_numbers(role, gears) for role, gears in self.gears.items() if gears.pressure_angle is not None
        }
        return {slope: own[slope] for role, own in numbers.items() for slope in [f"{role}_pressure_slope"]}

    @property
    def rubbing(self) -> tuple[str, ...]:
        rubs = {name: is_lazy(friction) or np.any(friction) for name, friction in self.frictions.items()}
        return tuple(name.removesuffix("_friction") for name in rubs if rubs[name])

    def parameters(self) -> dict[str, Any]:
        return self._numbers_of_parts() | self._numbers_of_places()

    def _numbers_of_parts(self) -> dict[str, Any]:
        """Return the numbers of links, sliders, wheels and cylinders."""
        joined, parts, numbers = self.topology, self.parts, dict[str, Any]()
        for role in (*joined.links, *joined.on_guides):
            numbers |= link_parameters(role, parts[role])
        for role in joined.yokes:
            numbers |= slot_numbers(role, parts[role])
        for role in joined.gears:
            numbers |= gear_numbers(role, self.gears.get(role, Gears()))
        for role in joined.struts:
            numbers |= cylinder_numbers(role, parts[role])
        return numbers

    def _numbers_of_places(self) -> dict[str, Any]:
        """Return the numbers of pins and guides, and the signs of the branches."""
        (_, pivot), *others = self.ground.items()
        numbers: dict[str, Any] = {}
        for pin, point in others:
            numbers |= ground_pin(pin, *point, *pivot)
        for pin in self.topology.points:
            numbers |= point_on_link(pin, *self.points[pin])
        for name, host in self.topology.hosts.items():
            guide = self.guides.get(name, Guide())
            numbers |= guide_line(name, guide.angle, *guide.through, *(pivot if host == GROUND else ORIGIN))
            numbers[f"{name}_friction"] = guide.friction
        for path, branch in self.branches.items():
            numbers |= branch_sign(path.removeprefix("branch."), branch)
        return numbers


def misspelt_fields(links: str, parts: Mapping[str, Any], fields: Iterable[str]) -> dict[str, str]:
    """Return the problem of each part that no text names, and whose name is nearly that of a parameter."""
    words = re.findall(r"\w+", links)
    meant = {name: closest(name, [*words, *fields]) for name in parts if name not in words}
    return {name: f'{name}: is no parameter; did you mean "{near}"?' for name, near in meant.items() if near in fields}


def part_problems(joined: Topology, parts: Mapping[str, Any], taken: Collection[str]) -> Iterator[str]:
    """Yield the problems of parts that are missing, of the wrong class, or that no text names."""
    expected: dict[str, Any] = dict.fromkeys(joined.links, AnyLink) | dict.fromkeys(joined.cylinders, Cylinder)
    expected |= dict.fromkeys(joined.on_guides, Slider)
    for role, kind in expected.items():
        if role not in parts and kind is not Cylinder and role not in taken:
            yield f"{role}: missing; give {role} = {CLASSES[kind]}"
        elif isinstance(part := parts.get(role), AnyPart) and not isinstance(part, kind):
            yield f"{role} = {quote(part)}: must be {CLASSES[kind]}, as it stands in links"
    for role in parts:
        yield from name_problems(role, role, expected)


def point_problems(joined: Topology, points: Mapping[str, Any]) -> Iterator[str]:
    """Yield the problems of third pins of links without a point, and of points of other pins."""
    for pin, role in joined.points.items():
        if pin not in points:
            yield f"points.{pin}: missing; give (distance, angle) of this pin in the axes of {role}"
    for pin in points:
        if pin not in joined.points:
            others = did_you_mean(pin, joined.points) or "; leave it out, or name it third in a link, as rod B-C-E"
            yield f"points.{pin}: is no third pin of a link{others}"


def ground_problems(ground: Mapping[str, Any]) -> Iterator[str]:
    """Yield the problem of each ground pin that is where another one is, in a single design."""
    places: dict[Any, str] = {}
    for pin, place in ground.items():
        single = isinstance(place, tuple) and not any(map(is_array, place))
        if single and (other := places.setdefault(place, pin)) != pin:
            yield f"ground.{pin} = {quote(place)}: is where pin {other} is; give it a place of its own"


def gear_problems(joined: Topology, gears: Mapping[str, Any]) -> Iterator[str]:
    """Yield the problems of ratios and pressure angles, and that of a cycle of too many turns."""
    fractions = {name: ratio for name, ratio in joined.gears.items() if ratio.denominator > 1}
    uneven = {name for name, ratio in fractions.items() if max(abs(ratio.numerator), ratio.denominator) > MOST_TURNS}
    for name in uneven:
        near = fractions[name].limit_denominator(int(MOST_TURNS / max(abs(float(fractions[name])), 1.0)) or 1)
        allowed = f"a whole number, or a fraction of whole numbers up to {MOST_TURNS}, as {near}"
        yield f"gears.{name}.ratio = {fractions[name]}: must be {allowed}: its denominator is the cycle's turns"
    turns = math.lcm(*(ratio.denominator for ratio in fractions.values()))
    if turns > MOST_TURNS and not uneven:
        yield f"gears: all repeats only after {turns} turns of the crank: take ratios that repeat within {MOST_TURNS}"
    for name, ratio in joined.gears.items():
        angle = getattr(gears.get(name), "pressure_angle", None)
        alike = "of ratio 1" if ratio == 1 else "on one shaft" * (joined.ground[0] in joined.links.get(name, ()))
        if angle is not None and alike:
            value = f" = {Rule('angle').measured(angle)}" if isinstance(angle, float) else ""
            yield f"gears.{name}.pressure_angle{value}: wheels {alike} have no pitch point; leave it out"


def branch_problems(joined: Topology, branch: Any) -> Iterator[str]:
    """Yield the problem of each branch that is of no pin, or link past a pin, with two assemblies."""
    known = [step.name for step in joined.steps if isinstance(step, WITH_BRANCHES)]
    if not known:
        yield from ["branch: no pin of this linkage has two assemblies; leave it out"] if branch else []
    elif not isinstance(branch, Mapping):
        word = branch if branch in (*BRANCH_SIGN, "both") else "crossed"
        pins = ", ".join(f'"{name}": "{word}"' for name in known)
        yield f"branch = {quote(branch)}: must be stated by pin, all or some, as branch={{{pins}}}"
    else:
        for name in branch:
            yield from name_problems(f"branch.{name}", name, known)


def _first_word(problem: str) -> str:
    """Return the first word of a problem: the parameter of which it is."""
    return re.findall(r"\w*", problem)[0]


RESERVED = frozenset(name for name in dir(Linkage) if not name.startswith("_"))
RESERVED |= {"mechanism", "speed", "thrust", "profile"}
"""Attributes of a linkage and words of a scene, that no part may have for a name, besides those of the topology."""
