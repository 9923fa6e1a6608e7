"""Links: any, a rectangular bar, or a disk. All three have length, mass, inertia and a centre of gravity.

Mass and moment of inertia of a bar and of a disk are document 2's (ME 470): m(L² + w²)/12 and m r²/2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from linksweep.base.degrees import cos_sin
from linksweep.base.equality import ByContent
from linksweep.base.fields import PartField, below, declared, field_problems, parameter
from linksweep.base.validate import Number, overflow_problems


@dataclass(frozen=True, eq=False)
class Link(ByContent):
    """A link of any shape.

    Parameters
    ----------
    length : distance between its two pins [m]
    mass : [kg]
    inertia : moment of inertia about its centre of gravity [kg m²]
    cg_distance : distance of the centre of gravity from the first pin [m]
    cg_angle : angle of the centre of gravity from the line of pins, counter-clockwise [degree]

    Each may be an xarray.DataArray with named dims, except theta2. Values are checked by the mechanism that takes
    the link, which knows it as crank, coupler or rocker: ValueError there.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.Link(length=0.22, mass=0.68, inertia=2.8e-3, cg_distance=0.11).mass
    0.68
    """

    length: Number = parameter("length", above=0.0)
    mass: Number = parameter("mass", at_least=0.0)
    inertia: Number = parameter("inertia", at_least=0.0)
    cg_distance: Number = parameter("length", 0.0, at_least=0.0, polar=True)
    cg_angle: Number = parameter("angle", 0.0)


@dataclass(frozen=True, eq=False)
class Bar(ByContent):
    """A uniform rectangular bar from pin to pin: m = ρ·L·w·t, I = m(L² + w²)/12, centre of gravity midway.

    Parameters
    ----------
    length, width, thickness : [m]; the width lies in the plane of motion
    density : [kg/m³]

    Values are checked as those of a Link. Source: document 2 (ME 470), bar link.

    Examples
    --------
    >>> import linksweep as ls
    >>> round(ls.Bar(length=0.08, width=0.02, thickness=0.02, density=7750).mass, 6)
    0.248
    """

    length: Number = parameter("length", above=0.0)
    width: Number = parameter("length", above=0.0)
    thickness: Number = parameter("length", above=0.0)
    density: Number = parameter("density", at_least=0.0)

    @property
    def mass(self) -> Number:
        return self.density * self.length * self.width * self.thickness

    @property
    def inertia(self) -> Number:
        return self.mass * (self.length * self.length + self.width * self.width) / 12.0

    @property
    def cg_distance(self) -> Number:
        return 0.5 * self.length

    @property
    def cg_angle(self) -> Number:
        return 0.0


@dataclass(frozen=True, eq=False)
class Disk(ByContent):
    """A uniform disk, its centre on the link's first pin or off it: m = ρ·πr²·t, I = m r²/2 about its centre.

    Parameters
    ----------
    length : distance between its two pins [m]
    radius, thickness : [m]
    density : [kg/m³]
    cg_distance : distance of the disk's centre, which is its centre of gravity, from the first pin [m]
    cg_angle : angle of the centre from the line of pins, counter-clockwise [degree]

    Values are checked as those of a Link. Source: document 2 (ME 470), circle link, with its s and δ2 (p and δ3, u and
    δ4).

    Examples
    --------
    >>> import linksweep as ls
    >>> wheel = ls.Disk(length=0.05, radius=0.08, thickness=0.01, density=7750)
    >>> wheel.cg_distance
    0.0

    An eccentric turns about a pin off its centre; its strap is a rod whose first pin is that centre:

    >>> eccentric = ls.Disk(length=0.01, radius=0.04, thickness=0.02, density=7750, cg_distance=0.01)
    >>> eccentric.inertia == 0.5 * eccentric.mass * 0.04**2
    True
    """

    length: Number = parameter("length", above=0.0)
    radius: Number = parameter("length", above=0.0)
    thickness: Number = parameter("length", above=0.0)
    density: Number = parameter("density", at_least=0.0)
    cg_distance: Number = parameter("length", 0.0, at_least=0.0, polar=True)
    cg_angle: Number = parameter("angle", 0.0)

    @property
    def mass(self) -> Number:
        return self.density * (math.pi * self.radius * self.radius) * self.thickness

    @property
    def inertia(self) -> Number:
        return 0.5 * self.mass * self.radius * self.radius


AnyLink = Link | Bar | Disk


class LinkField(PartField):
    """A field that holds a link, which it checks with its numbers."""

    def problems(self, path: str, value: Any) -> list[str]:
        if problems := super().problems(path, value) or field_problems(value, below(path, self)):
            return problems
        with np.errstate(over="ignore"):
            return overflow_problems(path, value.inertia, "moment of inertia")


LINK = LinkField((Link, Bar, Disk), AnyLink, default=Link)


def links_of(mechanism: Any) -> dict[str, AnyLink]:
    """Return the links that are fields of a mechanism, by role."""
    return {role: getattr(mechanism, role) for role, kind, _ in declared(mechanism) if kind is LINK}


def link_parameters(role: str, link: AnyLink) -> dict[str, Number]:
    """A link's numbers under the names that the physics wires by; its centre of gravity in the link's own axes."""
    return {
        f"{role}_length": link.length,
        f"{role}_mass": link.mass,
        f"{role}_inertia": link.inertia,
        **cg_parameters(role, link.cg_distance, link.cg_angle),
    }


def cg_parameters(role: str, distance: Number, angle: Number) -> dict[str, Number]:
    """Return a centre of gravity in its link's own axes, under the names that the physics wires by."""
    cos, sin = cos_sin(angle)
    return {f"{role}_cg_x": distance * cos, f"{role}_cg_y": distance * sin}
