"""Cross-sections of links: any, a round tube, an I-beam; and how a link's mass lies along it.

The plane of motion bends a link about the axis across that plane. Sources: W. C. Young, R. G. Budynas and A. M. Sadegh,
Roark's Formulas for Stress and Strain, table "Properties of sections".

A link of which mass m, centre of gravity x and moment of inertia I about it are known has a uniform shank of mass

    m_s = 6 (m x (L − x) − I)/L²

from pin to pin, and two eyes on its pins: no other such link has the same forces at its pins. Where that is negative,
the link's mass lies about and beyond its pins, and its shank has none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from linksweep.base.equality import ByContent
from linksweep.base.fields import CheckedPartField, parameter
from linksweep.base.validate import Number, less_problems, refuse


@dataclass(frozen=True, eq=False, repr=False)
class Section(ByContent):
    """A cross-section of a link.

    Parameters
    ----------
    area : float or DataArray
        Area [m²].
    modulus : float or DataArray
        Section modulus for bending in the plane of motion [m³]: second moment of area over the distance of the extreme
        fibre.
    second_moment : float or DataArray, default None
        Second moment of area for bending in the plane of motion [m⁴]; None where no buckling is computed.
    second_moment_across : float or DataArray, default None
        Second moment of area for bending across that plane [m⁴].

    Notes
    -----
    The mechanism that takes the link checks the values, and raises ValueError where they are out of bounds.

    Examples
    --------
    >>> import linksweep as ls
    >>> rod = ls.Link(0.22, 0.68, 2.8e-3, cg_distance=0.11, section=ls.Section(area=4e-4, modulus=1.3e-6))
    >>> rod.section.area
    0.0004
    """

    area: Number = parameter("area", above=0.0)
    modulus: Number = parameter("section_modulus", above=0.0)
    second_moment: Number = parameter("second_moment", None, above=0.0)
    second_moment_across: Number = parameter("second_moment", None, above=0.0)


@dataclass(frozen=True, eq=False, repr=False)
class Tube(ByContent):
    """A round tube, or a round rod.

    Parameters
    ----------
    outer : float or DataArray
        Outer diameter [m].
    inner : float or DataArray, default 0.0
        Inner diameter [m]; 0 for a solid rod.

    Raises
    ------
    ValueError
        If the inner diameter is not less than the outer one.

    Examples
    --------
    >>> import linksweep as ls
    >>> f"{ls.Tube(outer=0.03, inner=0.02).area:.4g}"
    '0.0003927'
    """

    outer: Number = parameter("length", above=0.0)
    inner: Number = parameter("length", 0.0, at_least=0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse(less_problems("inner", self.inner, "outer", self.outer, "length"))

    @property
    def area(self) -> Number:
        """Area [m²]."""
        return 0.25 * math.pi * (self.outer - self.inner) * (self.outer + self.inner)

    @property
    def second_moment(self) -> Number:
        """Second moment of area about any diameter [m⁴]."""
        return self.area * (self.outer * self.outer + self.inner * self.inner) / 16.0

    @property
    def second_moment_across(self) -> Number:
        """Second moment of area for bending across the plane of motion [m⁴]."""
        return self.second_moment

    @property
    def modulus(self) -> Number:
        """Section modulus [m³]."""
        return self.second_moment / (0.5 * self.outer)


@dataclass(frozen=True, eq=False, repr=False)
class IBeam(ByContent):
    """A symmetric I-section whose web lies in the plane of motion.

    Parameters
    ----------
    height : float or DataArray
        Height over both flanges, in the plane of motion [m].
    width : float or DataArray
        Width of the flanges, across that plane [m].
    web : float or DataArray
        Thickness of the web [m].
    flange : float or DataArray
        Thickness of each flange [m].

    Raises
    ------
    ValueError
        If the web is not thinner than the flanges are wide, or the flanges leave no room for a web.

    Examples
    --------
    >>> import linksweep as ls
    >>> t = 0.008  # the connecting rod of the textbooks: flanges 4t wide, 5t high, all t thick
    >>> rod = ls.IBeam(height=5 * t, width=4 * t, web=t, flange=t)
    >>> round(rod.area / t**2, 9), round(rod.second_moment / t**4, 6)
    (11.0, 34.916667)
    """

    height: Number = parameter("length", above=0.0)
    width: Number = parameter("length", above=0.0)
    web: Number = parameter("length", above=0.0)
    flange: Number = parameter("length", above=0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse(less_problems("web", self.web, "width", self.width, "length"))
        refuse(less_problems("flange", self.flange, "half the height", self.height, "length", share=0.5))

    @property
    def _inside(self) -> Number:
        return self.height - 2.0 * self.flange

    @property
    def area(self) -> Number:
        """Area [m²]."""
        return 2.0 * self.width * self.flange + self.web * self._inside

    @property
    def second_moment(self) -> Number:
        """Second moment of area for bending in the plane of motion [m⁴]."""
        return (self.width * self.height**3 - (self.width - self.web) * self._inside**3) / 12.0

    @property
    def second_moment_across(self) -> Number:
        """Second moment of area for bending across the plane of motion [m⁴]."""
        return (2.0 * self.flange * self.width**3 + self._inside * self.web**3) / 12.0

    @property
    def modulus(self) -> Number:
        """Section modulus for bending in the plane of motion [m³]."""
        return self.second_moment / (0.5 * self.height)


AnySection = Section | Tube | IBeam
SECTION = CheckedPartField((Section, Tube, IBeam), AnySection, default=Section)


def rectangle(width: Number, thickness: Number) -> Section:
    """Return the section of a bar of this width in the plane of motion, and this thickness across it."""
    area = width * thickness
    squares = width * width, thickness * thickness
    return Section(area, area * width / 6.0, *(area * square / 12.0 for square in squares))


def shank_and_eyes(length: Number, mass: Number, inertia: Number, x: Number) -> tuple[Number, Number, Number, Number]:
    """Return the masses of a link's shank and of its second eye, first moment of that eye beyond its pin, and moment
    of inertia about it."""
    share = np.minimum(np.maximum(x / length, 0.0), 1.0)
    shank = np.maximum(6.0 * (mass * x * (length - x) - inertia) / (length * length), 0.0)
    eye, moment = mass * share - 0.5 * shank, mass * np.maximum(x - length, 0.0)
    left = inertia + mass * x * x - (shank / 3.0 + eye) * length * length - 2.0 * length * moment
    return shank, eye, moment, share * left
