"""Topology of a linkage: its links, slides and cylinders as a text names them, and the order in which they close.

A cylinder of given length is a massless link. What no dyad finds closes only together, and is refused.
"""

from __future__ import annotations

import re
from fractions import Fraction
from functools import lru_cache

from linksweep.chains.topology.dyads import PRP, RPP, RPR, RRP, RRR, Gear, Side, Step
from linksweep.chains.topology.problems import (
    clash_problems,
    closure_problems,
    crank_problems,
    gear_problems,
    guide_problems,
    joint_problems,
    mobility_problems,
    name_problems,
    part_problems,
    pin_problems,
    taken_names,
)
from linksweep.chains.topology.text import RATIO, Part, read
from linksweep.chains.topology.topology import GROUND, Topology

__all__ = [
    "GROUND",
    "PRP",
    "RPP",
    "RPR",
    "RRP",
    "RRR",
    "Gear",
    "Side",
    "Step",
    "Topology",
    "clash_problems",
    "taken",
    "topology",
    "topology_of",
]

Names = tuple[tuple[str, str], ...]


@lru_cache(maxsize=1024)
def topology(
    links: str,
    ground: tuple[str, ...],
    hosts: Names = (),
    ratios: Names = (),
    struts: frozenset[str] = frozenset(),
    reserved: frozenset[str] = frozenset(),
) -> tuple[Topology | None, tuple[str, ...]]:
    """Return the topology of a linkage, or None, and its problems.

    Parameters
    ----------
    links : text, such as "crank A-B, coupler B-C, rocker D-C, ram F on slide, c1 P~B"
    ground : pins on the ground; the first is the crank's pivot
    hosts : name of each declared guide, and the link that carries it or "ground"
    ratios : name of each declared gear pair's wheel, and its ratio as text, "" where `links` states it
    struts : cylinders of given length, each a massless link
    reserved : names that no link may have

    Returns
    -------
    topology : None where a part of the text has no form, or its name is another part's, or the ground's
    problems : all at once, each a sentence that states what to change; () for a machine that closes dyad by dyad
    """
    parts, unread = read(links)
    roles = [part.role for part in parts]
    if unread or len({*roles, GROUND}) <= len(roles):
        return None, (*unread, *part_problems(parts), *name_problems(parts, reserved))
    machine = _joined(parts, ground, dict(hosts), dict(ratios), struts).closed()
    of_pins = [*part_problems(parts), *pin_problems(parts, machine)]
    of_joints = [*guide_problems(parts, machine, dict(hosts)), *gear_problems(parts, machine, dict(ratios))]
    problems = [*name_problems(parts, reserved), *of_pins, *of_joints]
    from_crank = crank_problems(parts[0], ground)
    if not from_crank and not of_pins:  # else links are held in another way than is meant
        from_crank = [*mobility_problems(machine), *([] if of_joints else closure_problems(machine))]
        from_crank += [] if of_joints or from_crank else joint_problems(machine)
    return machine, (*problems, *from_crank)


def taken(links: str, reserved: frozenset[str]) -> dict[str, str]:
    """Return a problem of each part of a text that has a reserved name."""
    return taken_names(read(links)[0], reserved)


def topology_of(links: str, ground: tuple[str, ...], hosts: Names = ()) -> Topology:
    """Return the topology of a linkage that is known to close; ValueError for any other."""
    machine, problems = topology(links, ground, hosts)
    if machine is None or problems:
        raise ValueError("\n".join(problems))
    return machine


def _joined(
    parts: list[Part], ground: tuple[str, ...], hosts: dict[str, str], ratios: dict[str, str], struts: frozenset[str]
) -> Topology:
    links = {part.role: tuple(dict.fromkeys(part.pins)) for part in parts if part.pins and not part.guide}
    past = {part.role: part.past for part in parts if part.past and part.pins}
    cylinders = {part.role: (part.ends[0], part.ends[1]) for part in parts if part.ends}
    lines = {*past, *(part.guide for part in parts if part.guide in links)}
    undeclared = {part.guide: GROUND for part in parts if part.guide}  # so that its other problems are known
    declared = {name: host if host in links else GROUND for name, host in hosts.items()}
    return Topology(
        names=tuple(part.role for part in parts),
        ground=ground,
        links=links,
        sliders={part.role: (part.pins[0], part.guide) for part in parts if part.guide and part.pins},
        past=past,
        yokes={part.role: (part.guide, part.past) for part in parts if part.guide and not part.pins},
        cylinders=cylinders,
        struts=tuple(role for role in cylinders if role in struts),
        gears={part.role: _ratio(part.ratio or ratios.get(part.role, "")) for part in parts if part.mate},
        hosts={**undeclared, **{name: name for name in lines}, **declared},
    )


def _ratio(text: str) -> Fraction:
    return Fraction(text) if re.fullmatch(RATIO, text) else Fraction(0)
