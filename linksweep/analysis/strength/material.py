"""Materials of links: any, and a few steels and aluminium alloys by name.

Sources: structural steels, EN 1993-1-1 (Eurocode 3), table 3.1 with corrigendum AC:2009, thickness up to 40 mm, and E
of clause 3.2.6; AISI steels, R. G. Budynas and J. K. Nisbett, Shigley's Mechanical Engineering Design, tables A-5, A-20
(estimated minimum values of SAE) and A-21; aluminium alloys, typical values of the Aluminum Association as in ASM
Handbook, volume 2 (their fatigue strength is that of 5e8 cycles). The endurance limit of a steel is half its tensile
strength, that of a polished specimen in rotating bending (Shigley, chapter on fatigue).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from linksweep.base.checked_number import unit_attribute_problems
from linksweep.base.equality import ByContent
from linksweep.base.fields import field_problems, numbers, parameter
from linksweep.base.validate import Number, choice_problems, refuse


@dataclass(frozen=True, eq=False, repr=False)
class Material(ByContent):
    """A material of links.

    Parameters
    ----------
    E : float or DataArray
        Modulus of elasticity [Pa].
    yield_strength : float or DataArray
        Yield strength [Pa].
    tensile_strength : float or DataArray
        Tensile strength [Pa].
    endurance : float or DataArray
        Amplitude of a stress without mean that the part endures for ever [Pa]: of a specimen, times the factors of the
        part's surface, size and reliability.
    slope : float or DataArray, default None
        Slope k of the S-N curve, N = knee·(endurance/σ)^k [1], for a finite life: about 5 for machined parts, 3 for
        welded ones; None where no life is computed.
    knee : float or DataArray, default 1e6
        Number of cycles at which that curve reaches the endurance [1]: about 1e6 for steel, 5e8 for aluminium.

    Raises
    ------
    ValueError
        If a number is out of bounds; one line for each.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.Material(E=210e9, yield_strength=355e6, tensile_strength=490e6, endurance=0.8 * 245e6).yield_strength
    355000000.0
    """

    E: Number = parameter("pressure", above=0.0)
    yield_strength: Number = parameter("pressure", above=0.0)
    tensile_strength: Number = parameter("pressure", above=0.0)
    endurance: Number = parameter("pressure", above=0.0)
    slope: Number = parameter("dimensionless", None, above=0.0)
    knee: Number = parameter("dimensionless", 1e6, above=0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse(field_problems(self))
        refuse(unit_attribute_problems(numbers(self)))


STEELS = {  # E, yield strength, tensile strength, endurance or fatigue strength; in MPa
    "S235": (210e3, 235.0, 360.0, 180.0),
    "S275": (210e3, 275.0, 430.0, 215.0),
    "S355": (210e3, 355.0, 490.0, 245.0),
    "AISI 1020 HR": (207e3, 210.0, 380.0, 190.0),
    "AISI 1045 CD": (207e3, 530.0, 630.0, 315.0),
    "AISI 4140 QT 540": (207e3, 834.0, 951.0, 475.5),
}
ALUMINIUM = {
    "2024-T4": (73.1e3, 324.0, 469.0, 138.0),
    "6061-T6": (68.9e3, 276.0, 310.0, 96.5),
    "7075-T6": (71.7e3, 503.0, 572.0, 159.0),
}
STRENGTHS = STEELS | ALUMINIUM
ALUMINIUM_KNEE = 5e8
"""Number of cycles of the fatigue strength of aluminium."""


def material(name: str) -> Material:
    """Return a steel or an aluminium alloy by its name.

    Parameters
    ----------
    name : str
        "S235", "S275", "S355" (structural steels); "AISI 1020 HR" (hot-rolled), "AISI 1045 CD" (cold-drawn), "AISI 4140
        QT 540" (tempered at 540 °C); "2024-T4", "6061-T6", "7075-T6" (aluminium).

    Returns
    -------
    Material
        Material, whose endurance limit is that of a polished specimen; of aluminium it is reached after 5e8 cycles, its
        `knee`.

    Raises
    ------
    ValueError
        For another name.

    Notes
    -----
    Least values of standards and typical ones of handbooks: see the sources in `linksweep.analysis.strength.material`.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.material("S355")
    Material(E=210000000000.0, yield_strength=355000000.0, tensile_strength=490000000.0, endurance=245000000.0)
    """
    refuse(choice_problems("name", name, STRENGTHS))
    metal = Material(*(1e6 * number for number in STRENGTHS[name]))
    return replace(metal, knee=ALUMINIUM_KNEE) if name in ALUMINIUM else metal
