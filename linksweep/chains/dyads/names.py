"""Names of a dyad's rows in the place where it stands in a machine."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from linksweep.chains.rows.bodies import Source
from linksweep.engine.quantity import Row, Total

OF_THE_CRANK = {
    *("cos2", "cos2_lo", "sin2", "sin2_lo", "omega2", "alpha2", "gravity_x", "gravity_y", "r2x", "r2y"),
    *("Q2x", "Q2y", "N2"),
}
"""Names that mean the same in every dyad."""
PIN = ("{}x", "{}y", "{}x_lo", "{}y_lo", "u{}x", "u{}y", "u{}x_slope", "u{}y_slope", "v{}x", "v{}y", "a{}x", "a{}y")
LINK = ("r{}x", "r{}y", "r{}x_lo", "r{}y_lo", "ratio{}", "slope{}", "omega{}", "alpha{}", "theta{}")
RATES = frozenset(("omega3", "alpha3", "alpha4", "vCx", "vCy", "aCx", "aCy"))
"""Rates that some closures on crank and ground make themselves, more precisely than from their ratios."""
Vector = tuple[Source, ...]
NOTHING: dict[str, Source] = {"Q3x": 0.0, "Q3y": 0.0, "N3": 0.0}
"""Loads on a block without mass."""


class Slide(NamedTuple):
    """A dyad's own names of a slide: normal force, friction and moment; then all that its normal force acts by:
    μ·sign(v), the line's direction, and the slider's pin."""

    normal: str
    friction: str
    moment: str
    acts: tuple[str, str, str, str, str]

    @property
    def power(self) -> str:
        """The power of its friction."""
        return self.friction.replace("force", "power")


class Names(dict[str, Source]):
    """Actual names, or numbers, of a dyad's own names; those not listed get the dyad's suffix."""

    def __init__(self, suffix: str, *listed: Mapping[str, Source]):
        super().__init__({name: name for name in OF_THE_CRANK})
        self.suffix = suffix
        for names in listed:
            self |= names

    def __missing__(self, name: str) -> str:
        return f"{name}{self.suffix}"

    def of(self, source: Source) -> Source:
        """Return the actual name of an input; a number stays."""
        return self[source] if isinstance(source, str) else source

    def placed(self, rows: Iterable[Row | Total]) -> list[Row | Total]:
        """Return rows under their actual names."""
        return [
            Total(str(self[row.output]), tuple(str(self[term]) for term in row.terms))
            if isinstance(row, Total)
            else Row(row.function, tuple(str(self[name]) for name in row.outputs), tuple(map(self.of, row.wiring)))
            for row in rows
        ]


def of_pin(letter: str, pin: str, fixed: bool = False, origin: bool = False) -> dict[str, Source]:
    """Return the names of a pin's position and motion; zeros for a fixed pin's motion, and for the crank's pivot."""
    names: dict[str, Source] = {}
    for form in PIN:
        still = origin if form[0] == "{" else fixed
        names[form.format(letter)] = 0.0 if still else form.format(pin)
    return names


def of_link(digit: int, number: int | str) -> dict[str, Source]:
    """Return the names of a link's vector and rotation."""
    return {form.format(digit): form.format(number) for form in LINK}


def full(stem: str) -> tuple[str, str, str, str]:
    """Return the names of a vector's components and their low words."""
    return f"{stem}x", f"{stem}y", f"{stem}x_lo", f"{stem}y_lo"


def frame_of(frame: str, pin: str) -> Mapping[str, Source]:
    """Return the names of the distance and direction of a ground pin from the crank's pivot."""
    parts = ("cos", "sin", "cos_lo", "sin_lo")
    return {f"{frame}_length": f"{pin}_distance"} | {f"{frame}_{part}": f"{pin}_{part}" for part in parts}


def direction_of(guide: str) -> Vector:
    """Return the names of a guide's direction in the axes of its link."""
    return f"{guide}_cos", f"{guide}_sin", f"{guide}_cos_lo", f"{guide}_sin_lo"


def sliding_of(name: str, role: str) -> dict[str, Source]:
    """Return the names of a slider's position and motion along its guide."""
    return {f"{form}{name}": f"{form}{role}" for form in ("x_", "v_", "a_", "ratio_", "slope_")}


def block_sliding_of(role: str) -> dict[str, Source]:
    """Return the names of a block's position on its line, and of its motion."""
    return {
        "slide": f"x_{role}",
        "slide_velocity": f"v_{role}",
        "slide_acceleration": f"a_{role}",
        "ratio_slide": f"ratio_{role}",
        "slope_slide": f"slope_{role}",
    }


def of_force(force: str, stem: str) -> dict[str, Source]:
    """Return the names of a force's components."""
    return {f"{force}{axis}": f"{stem}{axis}" for axis in "xy"}


def full_of_point(pin: str) -> Vector:
    """Return the names of a third pin's position in the axes of its link."""
    return f"{pin}_along", f"{pin}_across", f"{pin}_along_lo", f"{pin}_across_lo"
