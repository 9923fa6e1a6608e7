"""Links of a machine that are beams: straight, and with a cross-section."""

from __future__ import annotations

from typing import Any

import numpy as np

from linksweep.base.degrees import cos_sin
from linksweep.base.validate import Number, is_lazy
from linksweep.chains.topology import Topology
from linksweep.mechanisms.beams.sections import shank_and_eyes
from linksweep.mechanisms.links import Bar, Link


def beam_problem(topology: Topology, role: str, part: Any, across: dict[str, Number]) -> str:
    """Return why a link is no beam, and what to do; empty for one that is.

    `across` has the distance of each third pin from its link's line of pins.
    """
    if role not in topology.links:
        return "it slides on a guide, and has no line of pins"
    if not isinstance(part, Bar) and getattr(part, "section", None) is None:
        return "it has no cross-section: give it as ls.Bar(...), or as ls.Link(..., section=ls.Section(...))"
    off = [pin for pin in topology.links[role] if pin in across and (is_lazy(across[pin]) or np.any(across[pin]))]
    return f"its pin {off[0]} is off its line of pins" if off else ""


def beam_numbers(role: str, link: Link | Bar) -> dict[str, Number]:
    """Return the section of a link, and how its mass lies along it, under the names that the physics takes."""
    if isinstance(link, Bar):
        spin = link.mass * link.width * link.width / 12.0
        masses: tuple[Number, ...] = (link.mass, 0.0, 0.0, 0.0)
    else:
        cos, _ = cos_sin(link.cg_angle)
        spin, masses = 0.0, shank_and_eyes(link.length, link.mass, link.inertia, link.cg_distance * cos)
    numbers = dict(zip(("shank_mass", "eye_mass", "eye_moment", "eye_inertia"), masses, strict=True))
    section: Any = link.section  # a beam has one
    numbers |= {"shank_spin": spin, "area": section.area, "modulus": section.modulus}
    return {f"{role} {name}": number for name, number in numbers.items()}


def ends_of_beam(role: str, length: Number, thirds: list[Number]) -> dict[str, Number]:
    """Return the positions of the first and the last of a link's pins along its line."""
    start, end = 0.0 * length, length
    for along in thirds:
        start, end = np.minimum(start, along), np.maximum(end, along)
    return {f"{role}_beam_start": start, f"{role}_beam_end": end}
