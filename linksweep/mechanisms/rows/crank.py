"""Rows that every machine with a crank shares: the crank's angle in the machine's own frame."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from linksweep.base.degrees import cos_sin_low_words
from linksweep.base.validate import Number
from linksweep.engine.quantity import Row
from linksweep.physics.algebra import planar
from linksweep.physics.closures import crank_angle

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
    turns = (planar.identity, planar.identity, planar.opposite if minus_sin else planar.identity)
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
