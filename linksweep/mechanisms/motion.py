"""How a mechanism moves: which words of a scene it takes for that, and what its index means."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from linksweep.mechanisms.finding import Findings
from linksweep.mechanisms.validate import Number

OverDesigns = tuple[tuple[Callable[..., Mapping[str, Any]], tuple[Number, ...]], ...]
"""Functions of arrays of numbers, broadcast over the designs, that return arrays by name; and what each takes."""


class CrankDriven:
    """A mechanism whose crank turns as the scene says.

    `motion` are the words of a scene that it takes besides gravity; the first must be given, `defaults` stand for the
    others. `position` says what the index is, `spot` names a value of it in a sentence. `round_trip` says what the
    status of peaks tells, with `round_meanings` for 0, 1 and 2.
    """

    index: ClassVar[str] = "theta2"
    period: ClassVar[float] = 360.0
    position: ClassVar[str] = "angle of the crank from x, positive counter-clockwise"
    spot: ClassVar[str] = "crank angle"
    motion: ClassVar[tuple[str, ...]] = ("omega2", "alpha2", "drive", "loads")
    defaults: ClassVar[Mapping[str, Number]] = {"alpha2": 0.0, "drive": "crank"}
    profiles: ClassVar[Mapping[str, float]] = {}
    round_trip: ClassVar[str] = "whether every angle is ok: assembled, not jammed, not at a dead centre"
    round_meanings: ClassVar[tuple[str, ...]] = ("ok", "partial_revolution", "cannot_assemble")

    def driven(self, motion: Mapping[str, Number]) -> OverDesigns:
        """More numbers that the physics wires by, which depend on how it is driven."""
        return ()

    def driven_findings(self, motion: Mapping[str, Number]) -> tuple[tuple[Findings, tuple[Number, ...]], ...]:
        """What can be checked in closed form of how it is driven."""
        return ()

    def driven_peaks(self, motion: Mapping[str, Number]) -> OverDesigns:
        """Where quantities may have their peaks, by how it is driven [degree]."""
        return ()
