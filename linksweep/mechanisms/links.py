"""Links: of any shape, a rectangular bar, or a disk. Each has length, mass, inertia and a centre of gravity.

Source of mass and moment of inertia of bar and disk: document 2 (ME 470), m(L² + w²)/12 and m r²/2.
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


@dataclass(frozen=True, eq=False, repr=False)
class Link(ByContent):
    """A link of any shape.

    Parameters
    ----------
    length : float or DataArray
        Distance between its two pins [m].
    mass : float or DataArray
        Mass [kg].
    inertia : float or DataArray
        Moment of inertia about the centre of gravity [kg m²].
    cg_distance : float or DataArray, default 0.0
        Distance of the centre of gravity from the first pin [m].
    cg_angle : float or DataArray, default 0.0
        Angle of the centre of gravity from the line of pins, counter-clockwise [degree].

    Notes
    -----
    Each number may be an xarray.DataArray with named dims, except theta2. The mechanism that takes the link, as its
    crank, coupler or rocker, checks the values, and raises ValueError where they are out of bounds.

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


@dataclass(frozen=True, eq=False, repr=False)
class Bar(ByContent):
    """A uniform rectangular bar from pin to pin.

    Its mass is ρ·L·w·t, its moment of inertia m(L² + w²)/12 about the centre of gravity, midway between the pins.

    Parameters
    ----------
    length : float or DataArray
        Distance between its two pins [m].
    width : float or DataArray
        Width in the plane of motion [m].
    thickness : float or DataArray
        Thickness across the plane of motion [m].
    density : float or DataArray
        Density of the material [kg/m³].

    Notes
    -----
    Values are checked like those of a `Link`. Source: document 2 (ME 470), bar link.

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
        """Mass [kg]."""
        return self.density * self.length * self.width * self.thickness

    @property
    def inertia(self) -> Number:
        """Moment of inertia about the centre of gravity [kg m²]."""
        return self.mass * (self.length * self.length + self.width * self.width) / 12.0

    @property
    def cg_distance(self) -> Number:
        """Distance of the centre of gravity from the first pin [m]."""
        return 0.5 * self.length

    @property
    def cg_angle(self) -> Number:
        """Angle of the centre of gravity from the line of pins [degree]."""
        return 0.0


@dataclass(frozen=True, eq=False, repr=False)
class Disk(ByContent):
    """A uniform disk, centred on the link's first pin or off it.

    Its mass is ρ·πr²·t, its moment of inertia m r²/2 about its centre.

    Parameters
    ----------
    length : float or DataArray
        Distance between its two pins [m].
    radius : float or DataArray
        Radius of the disk [m].
    thickness : float or DataArray
        Thickness of the disk [m].
    density : float or DataArray
        Density of the material [kg/m³].
    cg_distance : float or DataArray, default 0.0
        Distance of the disk's centre, which is its centre of gravity, from the first pin [m].
    cg_angle : float or DataArray, default 0.0
        Angle of the centre from the line of pins, counter-clockwise [degree].

    Notes
    -----
    Values are checked like those of a `Link`. Source: document 2 (ME 470), circle link, with its s and δ2 (p and δ3, u
    and δ4).

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
        """Mass [kg]."""
        return self.density * (math.pi * self.radius * self.radius) * self.thickness

    @property
    def inertia(self) -> Number:
        """Moment of inertia about the centre of gravity [kg m²]."""
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
    """Return the numbers of a link under the names that the physics takes; the centre of gravity in the link's axes."""
    return {
        f"{role}_length": link.length,
        f"{role}_mass": link.mass,
        f"{role}_inertia": link.inertia,
        **cg_parameters(role, link.cg_distance, link.cg_angle),
    }


def cg_parameters(role: str, distance: Number, angle: Number) -> dict[str, Number]:
    """Return a centre of gravity in its link's own axes, under the names that the physics takes."""
    cos, sin = cos_sin(angle)
    return {f"{role}_cg_x": distance * cos, f"{role}_cg_y": distance * sin}
