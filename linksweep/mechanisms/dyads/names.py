"""Names of a dyad's rows in the place where it stands in a machine."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from linksweep.engine.quantity import Row, Total
from linksweep.mechanisms.rows.bodies import Source

OF_THE_CRANK = {
    *("cos2", "cos2_lo", "sin2", "sin2_lo", "omega2", "alpha2", "gravity_x", "gravity_y", "r2x", "r2y"),
    *("Q2x", "Q2y", "N2"),
}
"""Names that mean the same in every dyad."""
PIN = ("{}x", "{}y", "{}x_lo", "{}y_lo", "u{}x", "u{}y", "u{}x_slope", "u{}y_slope", "v{}x", "v{}y", "a{}x", "a{}y")
LINK = ("r{}x", "r{}y", "ratio{}", "slope{}", "omega{}", "alpha{}", "theta{}")


class Slide(NamedTuple):
    """A dyad's own names of a slide: normal force, friction and moment; then all that its normal force acts by:
    μ·sign(v), the line's direction, and the slider's pin."""

    normal: str
    friction: str
    moment: str
    acts: tuple[str, str, str, str, str]


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


def of_link(digit: int, number: int) -> dict[str, Source]:
    """Return the names of a link's vector and rotation."""
    return {form.format(digit): form.format(number) for form in LINK}
