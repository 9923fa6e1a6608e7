"""How a mechanism moves: which words of a scene it takes for that, and what its index means."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, ClassVar

import numpy as np

from linksweep.base.degrees import cos_sin_low_words
from linksweep.base.equality import ByContent
from linksweep.base.validate import Number, choice_problems
from linksweep.engine.quantity import Row
from linksweep.engine.run import Field
from linksweep.mechanisms.limits.finding import Checks
from linksweep.mechanisms.rows.bodies import Equation
from linksweep.mechanisms.strokes import Stroke
from linksweep.physics import crank_angle, planar

BRANCH_SIGN = {"open": 1.0, "crossed": -1.0}
STATUS_OF_SLIDER = (
    *("ok", "cannot_assemble", "toggle", "dead_centre"),
    *("jammed", "no_cycle", "jammed_two_solutions"),
)
"""Status by number, the same for all machines in which friction may wedge a part that slides."""

OverDesigns = tuple[tuple[Callable[..., Mapping[str, Any]], tuple[Number, ...]], ...]
"""Functions of arrays of numbers, broadcast over the designs, that return arrays by name; and what each takes."""


CRANK = ("cos2", "cos2_lo", "sin2", "sin2_lo")
"""The crank's angle from x, as a grid tabulates it."""
PSI = ("psi_cos", "psi_cos_lo", "psi_sin")
"""Its angle from the pinch; the rest says by what the cosine is rounded."""


class CrankDriven(ByContent):
    """A mechanism whose crank turns as the scene says.

    `motion` are the words of a scene that it takes besides gravity; the first must be given, `defaults` stand for the
    others. `position` says what the index is, `spot` names a value of it in a sentence, `pace` is the quantity that its
    rate goes with. `round_trip` says what the status of peaks tells, with `round_meanings` for 0, 1, 2 and 3.
    """

    branch: str

    index: ClassVar[str] = "theta2"
    period: ClassVar[float] = 360.0
    position: ClassVar[str] = "angle of the crank from x, positive counter-clockwise"
    spot: ClassVar[str] = "crank angle"
    pace: ClassVar[str] = "omega2"
    motion: ClassVar[tuple[str, ...]] = ("omega2", "alpha2", "drive", "loads")
    defaults: ClassVar[Mapping[str, str]] = {"drive": "crank"}
    profiles: ClassVar[Mapping[str, float]] = {}
    round_trip: ClassVar[str] = "whether every angle is ok: assembled, not jammed, not at a dead centre"
    round_meanings: ClassVar[tuple[str, ...]] = ("ok", "partial_revolution", "cannot_assemble", "unbounded")

    @property
    def strokes(self) -> dict[str, Stroke]:
        """Positions of its links that a load may follow, by name: none. For one branch only."""
        return {}

    def branch_problems(self) -> list[str]:
        return choice_problems("branch", self.branch, (*BRANCH_SIGN, "both"))

    @property
    def branch_sign(self) -> float | Field:
        """1 for open, -1 for crossed; of both, over a dimension that the mechanism itself brings."""
        return BRANCH_SIGN.get(self.branch, Field(("branch",), np.array(list(BRANCH_SIGN.values()))))

    def coordinates(self) -> dict[str, list[str]]:
        """Labels of the dimensions that the mechanism itself brings."""
        return {"branch": list(BRANCH_SIGN)} if self.branch == "both" else {}

    def jumps(self) -> tuple[Number, ...]:
        """Crank angles at which a force may jump [degree]: none."""
        return ()

    def kinks(self) -> tuple[str, ...]:
        """Quantities at whose change of sign others have a kink: none."""
        return ()

    @property
    def closes_everywhere(self) -> bool:
        """Whether every design closes at every angle with a margin that rounding cannot touch."""
        raise NotImplementedError

    def unknowns(self, drive: str) -> tuple[str, ...]:
        """Return the unknowns of the square system."""
        raise NotImplementedError

    def equations(self, drive: str) -> tuple[Equation, ...]:
        """Return the rows of the square system."""
        raise NotImplementedError

    def document_form(self, drive: str) -> tuple[tuple[str, ...], tuple[Equation, ...]]:
        """Return the unknowns and rows of the square system as the documents print it, where that is another."""
        return self.unknowns(drive), self.equations(drive)

    def always_ok(self, drive: str) -> bool:
        """Whether the numbers alone say that every sample is ok; with another drive than the crank there are dead
        centres."""
        return drive == "crank" and self.closes_everywhere

    def driven(self, motion: Mapping[str, Number]) -> OverDesigns:
        """More numbers that the physics wires by, which depend on how it is driven."""
        return ()

    def dead_centre_findings(self, drive: str) -> Checks:
        """Where what is driven stands still; a crank never does."""
        return ()

    def output_findings(self) -> Checks:
        """Where the output stands still: what transmits without end there."""
        return self.dead_centre_findings("rocker")

    def driven_findings(self, motion: Mapping[str, Any]) -> Checks:
        """List what can be checked in closed form of how it is driven."""
        return self.dead_centre_findings(motion["drive"])


def frame_parameters(name: str, angle: Number) -> dict[str, Number]:
    """Cosine and sine of the angle [degree] at which a frame lies, under the names that the physics wires by."""
    parts = ("cos", "sin", "cos_lo", "sin_lo")
    return {f"{name}_{part}": number for part, number in zip(parts, cos_sin_low_words(angle), strict=True)}


def near_toggle_rows(middle: str) -> list[Row]:
    """The crank's angle from the pinch that lies at the angle of this name."""
    pinch = tuple(f"{middle}_{part}" for part in ("cos", "cos_lo", "sin", "sin_lo"))
    return [Row(crank_angle.psi_from_crank_angle, PSI, (*CRANK, *pinch))]


def straight_rows(cos: str, sin: str, minus_sin: bool = False) -> list[Row]:
    """The same bits where cosine and sine from the pinch are tabulated numbers themselves."""
    made = (cos, f"{cos}_lo", sin)
    turns = (planar.same, planar.same, planar.opposite if minus_sin else planar.same)
    return [Row(turn, (name,), (number,)) for turn, name, number in zip(turns, PSI, made, strict=True)]


def between_rows(middle_cos: str | float, middle_sin: str | float) -> tuple[Row, ...]:
    """Rows that make all this from half-angle tangents, and what a grid has in its table."""
    middle = (middle_cos, middle_sin)
    return (
        Row(crank_angle.angle_from_tangent, PSI),
        Row(crank_angle.angle_from_x, ("cos2", "sin2"), ("psi_cos", "psi_sin", *middle)),
        Row(crank_angle.one_turn, ("radians2",)),
    )


def in_range(length: Number) -> bool:
    """Whether the square of such a length in every design is far from the least and the largest number."""
    return bool(np.all((length > 1e-140) & (length < 1e140)))


def turned(frame_angle: Number) -> bool:
    """Whether a frame may lie at an angle to x."""
    return hasattr(frame_angle, "dims") or frame_angle != 0.0
