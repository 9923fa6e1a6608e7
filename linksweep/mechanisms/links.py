"""Parts of machines: links of any shape, rectangular bars, disks; and of linkages sliders, cylinders, guides, gears.

Source of mass and moment of inertia of bar and disk: document 2 (ME 470), m(L² + w²)/12 and m r²/2.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from linksweep.base.degrees import cos_sin
from linksweep.base.equality import ByContent
from linksweep.base.fields import CheckedPartField, PairField, declared, is_plain, of_kind, parameter, word
from linksweep.base.frozen import bare, normalise
from linksweep.base.validate import Number, Rule, as_float, overflow_problems
from linksweep.mechanisms.beams.sections import SECTION, AnySection, Section, rectangle


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
    section : Section, Tube or IBeam, default None
        Cross-section of a link whose strength is computed; it changes no mass.

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
    section: AnySection | None = of_kind(SECTION, None)


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

    @property
    def section(self) -> Section:
        """Rectangular cross-section."""
        return rectangle(self.width, self.thickness)


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


@dataclass(frozen=True, eq=False, repr=False)
class Slider(ByContent):
    """A part of a linkage that slides on a straight guide.

    Parameters
    ----------
    mass : float or DataArray
        Mass [kg].
    inertia : float or DataArray, default 0.0
        Moment of inertia about the centre of gravity [kg m²]; it counts where the guide turns.
    cg_distance : float or DataArray, default 0.0
        Distance of the centre of gravity from the slider's pin [m].
    cg_angle : float or DataArray, default 0.0
        Angle of the centre of gravity from the guide's direction, counter-clockwise [degree].
    slot_angle : float or DataArray, default 90.0
        Direction of the slot of a "yoke on slide past B" from the guide's direction [degree].
    slot_friction : float or DataArray, default 0.0
        Coefficient of Coulomb friction between such a slot and its pin [1].

    Notes
    -----
    Its axes lie along and across its guide. Its pin is that in "ram F on slide"; a yoke has its centre, from which its
    centre of gravity is measured, where the slot crosses the guide.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.Slider(mass=3.0)
    Slider(mass=3.0)
    """

    mass: Number = parameter("mass", at_least=0.0)
    inertia: Number = parameter("inertia", 0.0, at_least=0.0)
    cg_distance: Number = parameter("length", 0.0, at_least=0.0, polar=True)
    cg_angle: Number = parameter("angle", 0.0)
    slot_angle: Number = parameter("angle", 90.0)
    slot_friction: Number = parameter("dimensionless", 0.0, at_least=0.0)


@dataclass(frozen=True, eq=False, repr=False)
class Cylinder(ByContent):
    """A telescopic cylinder between two pins of a linkage, without mass.

    Parameters
    ----------
    length : float, DataArray or function of theta2, default None
        Distance of its two pins [m], the one length that may depend on theta2; None for a cylinder that follows the
        linkage.

    Notes
    -----
    A length that is stated removes a freedom, as a hydraulic cylinder that is held or moved. A cylinder that follows
    carries no force unless it is the drive. For a cylinder c1, `length_c1` [m], `rate_c1` [m/s] and `force_c1` [N],
    positive where it pushes its pins apart, are quantities.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.Cylinder(length=0.9)
    Cylinder(length=0.9)
    """

    length: Number = parameter("length", None, above=0.0, over_angle=True)

    @property
    def over_angle(self) -> tuple[Number, Number, Number]:
        """Length [m] and its first two derivatives to the crank's angle [m/rad, m/rad²]."""
        return self.length, 0.0, 0.0


@dataclass(frozen=True, eq=False, repr=False)
class SampledCylinder(Cylinder):
    """A cylinder whose length has been evaluated at the angles of a grid, with its first two derivatives to theta2."""

    slope: Number = 0.0
    curvature: Number = 0.0

    @property
    def over_angle(self) -> tuple[Number, Number, Number]:
        return self.length, self.slope, self.curvature


GUIDE_POINT = PairField(Rule("length"), Rule("length"), "(x, y) in m")


@dataclass(frozen=True, eq=False, repr=False)
class Guide(ByContent):
    """A straight guide of a linkage, on the ground or on a link.

    Parameters
    ----------
    through : pair of float or DataArray, default (0.0, 0.0)
        Point of the guide's line [m]: on the ground in the axes of the ground pins, on a link in the link's own axes,
        from its first pin and along its line of pins.
    angle : float or DataArray, default 0.0
        Direction of the guide [degree], from x or from the link's line of pins, counter-clockwise.
    friction : float or DataArray, default 0.0
        Coefficient of Coulomb friction between guide and slider [1].
    of : str, default "ground"
        Link that carries the guide, by its name; "ground" for one that stands still.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.Guide(through=(0.0, 0.02), angle=20.0, friction=0.1)
    Guide(through=(0.0, 0.02), angle=20.0, friction=0.1)
    """

    through: Sequence[Number] = of_kind(GUIDE_POINT, (0.0, 0.0))
    angle: Number = parameter("angle", 0.0)
    friction: Number = parameter("dimensionless", 0.0, at_least=0.0)
    of: str = word('"ground"', "ground")


@dataclass(frozen=True, eq=False, repr=False)
class Gears(ByContent):
    """A pair or train of gears by which the crank of a linkage turns a second crank.

    Parameters
    ----------
    ratio : float, Fraction or str, default ""
        Turns of the wheel per turn of the crank [1], negative for the opposite sense: a whole number, or a fraction
        p/q of whole numbers up to 99, as "-3/2", Fraction(-3, 2) or -1.5. The cycle then takes q turns of the crank.
        State it once: here, or in the text of the linkage.
    phase : float or DataArray, default 0.0
        Angle of the wheel where that of the crank is 0 [degree].
    pressure_angle : float or DataArray, default None
        Pressure angle of the teeth, 0 to below 90 [degree]: their force acts at the pitch point, for which the ratio
        must not be 1, nor the wheel stand on the crank's pivot. None for gears that pass on a torque alone.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.Gears(ratio=-2.0, phase=90.0)
    Gears(ratio='-2', phase=90.0)
    """

    ratio: Any = word('"-2"', "")
    phase: Number = parameter("angle", 0.0)
    pressure_angle: Number = parameter("angle", None, at_least=0.0, below=90.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        normalise(self, ratio=fraction_text(self.ratio))


def fraction_text(ratio: Any) -> str:
    """Return a number as the text of a fraction of small whole numbers; anything else, and other numbers, as text."""
    number = as_float(ratio)
    if number is None or not math.isfinite(number):
        return str(ratio)
    near = Fraction(number).limit_denominator(99)
    return str(near) if float(near) == number else str(ratio)


AnyLink = Link | Bar | Disk
AnyPart = AnyLink | Slider | Cylinder


class LinkField(CheckedPartField):
    """A field that holds a link, which it checks with its numbers and their moment of inertia."""

    def problems(self, path: str, value: Any) -> list[str]:
        if problems := super().problems(path, value):
            return problems
        with nullcontext() if is_plain(value) else np.errstate(over="ignore"):
            return overflow_problems(path, getattr(bare(value), "inertia", 0.0), "moment of inertia")


LINK = LinkField((Link, Bar, Disk), AnyLink, default=Link)
PART = LinkField((Link, Bar, Disk, Slider, Cylinder), AnyPart, default=Link)
GUIDE = CheckedPartField((Guide,), Guide, default=Guide)
GEARS = CheckedPartField((Gears,), Gears, default=Gears)


def links_of(mechanism: Any) -> dict[str, AnyLink]:
    """Return the links that are fields of a mechanism, by role."""
    return {role: getattr(mechanism, role) for role, kind, _ in declared(mechanism) if kind is LINK}


def with_distribution(part: Any, numbers: Mapping[str, Number]) -> Any:
    """Return a link, or a slider, with another mass distribution: the numbers of a `MassDistribution` by name."""
    return Link(part.length, **numbers) if isinstance(part, Bar | Disk) else replace(part, **numbers)


def link_parameters(role: str, link: Any) -> dict[str, Number]:
    """Return the numbers of a link under the names that the physics takes; the centre of gravity in the link's axes.

    Of a slider, or of a `MassDistribution`, the axes lie along and across its guide, of unit length.
    """
    return {
        f"{role}_length": getattr(link, "length", 1.0),
        f"{role}_mass": link.mass,
        f"{role}_inertia": link.inertia,
        **cg_parameters(role, link.cg_distance, link.cg_angle),
    }


def cg_parameters(role: str, distance: Number, angle: Number) -> dict[str, Number]:
    """Return a centre of gravity in its link's own axes, under the names that the physics takes."""
    cos, sin = cos_sin(angle)
    return {f"{role}_cg_x": distance * cos, f"{role}_cg_y": distance * sin}
