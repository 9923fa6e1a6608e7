"""Mass distributions of links: on them forces depend linearly, and they decide whether a machine shakes.

The moving links' centre of gravity moves with Σ m r_G. With h = m·(xG + i·yG) the first moment of a link about its
first pin in its own axes, lengths a, b, c of crank, coupler and rocker, and the loop a·e^{iθ2} + b·e^{iθ3} = d +
c·e^{iθ4} to eliminate the coupler's direction,

    four-bar       Σ m r_G = (h2 + m3·a − h3·a/b) e^{iθ2} + (h4 + h3·c/b) e^{iθ4} + constant
    slider-crank   Σ m r_G = (h2 + m3·a − h3·a/b) e^{iθ2} + (m4 + h3/b) r_C

A four-bar shakes no more where both coefficients are zero, whatever its speed: two counterweights can see to that. Of a
slider-crank one on the crank cancels the first coefficient and, of the slider's inertia along the guide, a fraction of
the first order in phase with the crank, which then appears across the guide. With an offset some of the first order is
a quarter turn away, and stays.

Sources: R. S. Berkof and G. G. Lowen, A New Method for Completely Force Balancing Simple Linkages, Journal of
Engineering for Industry 91 (1969) 21–26; for engines R. L. Norton, Design of Machinery, chapter "Engine Dynamics"
(balancing the single-cylinder engine).
"""

from __future__ import annotations

from typing import Any, NamedTuple

from linksweep.base.degrees import cos_sin
from linksweep.base.validate import Number


class MassDistribution(NamedTuple):
    """Mass [kg], its centre of gravity in polar coordinates of the link [m, degree], moment of inertia about it."""

    cg_distance: Number
    cg_angle: Number
    mass: Number
    inertia: Number

    def moments(self) -> tuple[Number, Number, Number, Number]:
        """Return m, m·xG, m·yG, and the moment of inertia about the first pin."""
        cos, sin = cos_sin(self.cg_angle)
        first = self.mass * self.cg_distance
        return self.mass, first * cos, first * sin, self.inertia + first * self.cg_distance

    def first_moment(self) -> Any:
        """Return the first moment about the first pin, h = m·(xG + i·yG) [kg m]."""
        _, x, y, _ = self.moments()
        return x + 1j * y


def distribution(link: Any) -> MassDistribution:
    """Return the mass distribution of a Link, Bar or Disk."""
    return MassDistribution(link.cg_distance, link.cg_angle, link.mass, link.inertia)


def first_moment(link: Any) -> Any:
    """Return the first moment of a Link, Bar or Disk."""
    return distribution(link).first_moment()


def turning_with_crank(crank: Any, coupler: Any) -> Any:
    """Return the first moment that turns with the crank, h2 + m3·a − h3·a/b [kg m]."""
    a, b = crank.length, coupler.length
    return first_moment(crank) + coupler.mass * a - first_moment(coupler) * (a / b)
