"""Problems of a linkage's topology, each a sentence that states what to change."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from fractions import Fraction
from itertools import combinations, count
from keyword import iskeyword

from linksweep.base.validate import closest, did_you_mean, repeated
from linksweep.chains.topology.text import PIN, RATIO, Part
from linksweep.chains.topology.topology import GROUND, Topology

RESERVED = {
    *(GROUND, "links", "points", "guides", "branch", "gears", "self", "type"),
    *("status", "status_at", "power", "power_residual", "error_bound", "cond", "drive", "loads", "gravity"),
}
"""Names of the constructor's parameters, of a table in a scene file, of quantities and of a scene's parameters."""

QUANTITY = re.compile(r"(theta|omega|alpha|F|T|R|aG|ratio|slope)[0-9].*")
"""Names of quantities that number the links, such as theta2."""


def taken_names(parts: list[Part], reserved: Collection[str]) -> dict[str, str]:
    """Return a problem of each part whose name is a word of Python or of results, or one of those `reserved`."""
    sentence = 'links: "{}" has a meaning of its own in linksweep or Python: give the part another name'
    roles = dict.fromkeys(part.role for part in parts)
    taken = [role for role in roles if role in RESERVED | {*reserved} or iskeyword(role) or QUANTITY.fullmatch(role)]
    return {role: sentence.format(role) for role in taken}


def name_problems(parts: list[Part], reserved: Collection[str]) -> Iterator[str]:
    """Yield the problems of names that mean something else; the parts themselves are understood."""
    yield from taken_names(parts, reserved).values()
    named = (name for part in parts for name in (part.role, part.guide) if not QUANTITY.fullmatch(name))
    for name in (name for name in named if re.fullmatch(PIN, name)):
        yield f'links: "{name}" reads as a pin: give parts and guides names in lower case, such as rod or slide'
    pins = {pin for part in parts for pin in (*part.pins, *part.ends)}
    for pin in sorted(pin for pin in pins if re.fullmatch("[FGQRT][0-9]+", pin)):
        yield f"links: pin {pin} has the name of a quantity: name it by a letter, or by one such as P and a number"


def clash_problems(twice: Iterable[str], names: Iterable[str], topology: Topology) -> Iterator[str]:
    """Yield the problem of each name that two numbers of a machine would have; `names` are those of all its numbers."""
    every, parts = " ".join(names), (*topology.names, *topology.hosts)
    for name in twice:
        after = [part for part in dict.fromkeys(parts) if re.search(rf"(?<![^\W_]){part}(?![^\W_])", name)]
        longest = max(after, key=len, default="part")
        free = next(other for other in (f"{longest}_{n}" for n in count(1)) if other not in every)
        quoted = " and ".join(f'"{part}"' for part in after) or "a part"
        yield f"links: two numbers would be called {name}, after {quoted}: rename {longest}, for example to {free}"


def part_problems(parts: list[Part]) -> Iterator[str]:
    """Yield the problem of each name that two parts have, and those of a part's own pins."""
    for name in repeated(part.role for part in parts):
        yield f'links: "{name}" is named twice: give each link, slider and cylinder its own name'
    for part in parts:
        for pin in repeated((*part.pins, *part.ends)):
            yield f"links: {part.role} names pin {pin} twice: name each pin of a link once"
        if part.past in part.pins and part.past:
            yield f"links: {part.role} passes its own pin {part.past}: name a pin of another link"


def crank_problems(crank: Part, ground: tuple[str, ...]) -> list[str]:
    """Return the problem of a first link that is no crank on the first ground pin."""
    if len(crank.pins) < 2 or crank.past or crank.mate:
        return [f"links: {crank.role} stands first: begin with the crank, a link such as crank A-B"]
    if not ground:
        return [f"ground: has no pin: begin with the pivot of the crank, {crank.pins[0]}"]
    if crank.pins[0] == ground[0]:
        return []
    return [
        f"links: {crank.role}, the first link, begins at pin {crank.pins[0]}, and the ground at pin {ground[0]}: "
        f"both must begin at the crank's pivot"
    ]


def pin_problems(parts: list[Part], topology: Topology) -> Iterator[str]:
    """Return the problems of pins that no link has, or that nothing names."""
    named = [pin for part in parts for pin in (*part.pins, *part.ends, part.past)]
    for part in parts:
        alone = [pin for pin in part.pins if part.guide and named.count(pin) == 1 and pin not in topology.ground]
        unknown = [pin for pin in (*part.ends, part.past) if pin and pin not in topology.members]
        for pin in (*unknown, *alone):
            yield f"links: no link has pin {pin} of {part.role}: name it in a link, as rod {pin}-…"
        carriers = [set(topology.members.get(pin, ())) for pin in dict.fromkeys(part.ends)]
        for role in sorted(set.intersection(*carriers)) if len(carriers) == 2 else ():
            yield f"links: both pins of {part.role} are on {role}, so that its length is fixed: leave it out"
    for pin in repeated(pin for pins in topology.links.values() for pin in pins[2:]):
        yield f"points.{pin}: two links name pin {pin} third: write it first or second in one of them"
    for pin in (pin for pin in topology.ground if pin not in named):
        yield f"ground.{pin}: no link has this pin: name it in one, or leave it out"


def guide_problems(parts: list[Part], topology: Topology, hosts: Mapping[str, str]) -> Iterator[str]:
    """Return the problems of guides that are unknown, unused, or on a link that can't carry them."""
    known = [*hosts, *topology.links]
    meant = {part.guide: closest(part.guide, known) for part in parts if part.guide and part.guide not in known}
    used = {part.guide for part in parts if part.guide} | {part.role for part in parts if part.past and part.pins}
    used |= {*meant.values()}
    for part in parts:
        if part.guide in meant:
            advice = "declare it in guides, by an ls.Guide"
            if near := meant[part.guide]:
                advice = f'did you mean "{near}"?' + ("" if near in hosts else f" Else {advice}")
            yield f'links: "{part.guide}", on which {part.role} slides, is neither a guide nor a link; {advice}'
        if part.pins and part.guide and part.pins[0] in topology.links.get(topology.hosts.get(part.guide, ""), ()):
            yield f"links: {part.role} slides on {topology.hosts[part.guide]} and is pinned to it: name another pin"
    for guide, host in hosts.items():
        if host != GROUND and host not in topology.links:
            close = did_you_mean(host, [GROUND, *topology.links])
            yield f'guides.{guide}.of = "{host}": must be ground or a link with pins{close}'
        elif guide in topology.names and host != guide:
            yield f'guides.{guide} has the name of a link: write of="{guide}", or give it another name'
        if guide not in used:
            yield f"guides.{guide}: nothing slides on it: leave it out"


def gear_problems(parts: list[Part], topology: Topology, ratios: Mapping[str, str]) -> Iterator[str]:
    """Return the problems of gears: their ratios, the link that they mesh with, the pin that they turn about."""
    wheels = {part.role: part for part in parts if part.mate}
    for role in (role for role in ratios if role not in wheels):
        yield f"gears.{role}: links has no such wheel: write {role} D-E : {topology.crank}"
    for role, wheel in wheels.items():
        stated = [ratio for ratio in (wheel.ratio, ratios.get(role)) if ratio]
        if len(stated) != 1:
            times = "twice" if stated else "nowhere"
            yield f"gears.{role}.ratio is stated {times}: state it once, in links or in gears"
        for ratio in stated:
            if not re.fullmatch(RATIO, ratio) or not Fraction(ratio):
                yield f'gears.{role}.ratio = "{ratio}": must be a whole number or a fraction such as -3/2, and not 0'
        if wheel.mate != topology.crank:
            yield f"links: {role} meshes with {wheel.mate}: give its ratio to the crank, {topology.crank}"
        if len({*wheel.pins} & {*topology.ground}) != 1:
            yield f"links: {role} is turned by gears: one of its pins, and no other, must be on the ground"


def mobility_problems(topology: Topology) -> list[str]:
    """Return the problem of a linkage whose links and joints leave another number of freedoms than one."""
    freedoms = topology.freedoms(topology.roles)
    if freedoms == 1:
        return []
    if freedoms > 1:
        more = "one more crank, or one link less" if freedoms == 2 else f"{freedoms - 1} more cranks, or fewer links"
        return [f"links: {freedoms} degrees of freedom: {more}"]
    degrees = "no degree of freedom" if freedoms == 0 else f"{1 - freedoms} constraints too many"
    return [f"links: {degrees}: nothing can move; one link less, or one pin less on a link"]


def joint_problems(topology: Topology) -> Iterator[str]:
    """Yield the problem of each two links that two joints hold, whose forces would have one name."""
    joints, roles = {**topology.pins, **topology.slides}, (GROUND, *topology.roles)
    for pair in repeated(joints.values()):
        one, other = (roles[number - 1] for number in sorted(pair))
        places = ", ".join(joint for joint, links in joints.items() if links == pair)
        yield f"links: {one} and {other} are joined twice ({places}), and stand still on each other: leave one out"


def closure_problems(topology: Topology) -> list[str]:
    """Return the problems of links that have no place when all dyads are found."""
    single = [*_held_twice(topology), *_loose(topology)]
    waiting = [role for role in topology.waiting if role in topology.roles]
    if single or not waiting:
        return single
    if topology.freedoms(waiting, topology.placed) > 0:
        return [f"links: {', '.join(waiting)} can move while the crank stands: hold one by another link"]
    together = [*_inseparable(topology, waiting), *topology.struts]
    names = [name for name in topology.waiting if name in together]
    return [f"links: {', '.join(names)} close only together: no dyad finds them; give them another joint or crank"]


def _held_twice(topology: Topology) -> Iterator[str]:
    for name in topology.waiting:
        if name in topology.struts and {*topology.cylinders[name]} <= {*topology.support}:
            yield f"links: both pins of {name} have their places without it: give it no length, or leave it out"
        if name in topology.roles and topology.freedoms([name], topology.placed) < 0:
            yield f"links: {name} is held by one joint too many: leave out one of its pins or slides, or the link"


def _loose(topology: Topology) -> Iterator[str]:
    for role in (role for role in topology.waiting if role in topology.roles):
        if topology.freedoms([role], [other for other in (GROUND, *topology.roles) if other != role]) > 0:
            alone = [pin for pin in topology.pins_of(role) if topology.members[pin] == (role,)]
            end = f"its pin {' or '.join(alone)}" if alone else "it"
            yield f"links: {role} hangs loose: hold {end} by another link or on the ground, or leave {role} out"


def _inseparable(topology: Topology, roles: list[str]) -> list[str]:
    """Return the links that are left when dyads at the end of the chain are taken away, one after the other."""
    for group in (group for size in (1, 2) for group in combinations(roles, size)):
        others = [role for role in roles if role not in group]
        if others and topology.freedoms(group, [*topology.placed, *others]) == 0:
            return _inseparable(topology, others)
    return roles
