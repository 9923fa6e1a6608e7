"""Rows that every machine with a crank shares: the crank's angle in the machine's own frame."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from linksweep.base.degrees import cos_sin_low_words
from linksweep.base.fields import ChoiceField
from linksweep.base.validate import Number
from linksweep.engine.quantity import Row
from linksweep.physics.algebra import planar
from linksweep.physics.closures import crank_angle

BRANCH_SIGN = {"open": 1.0, "crossed": -1.0}
BRANCH = ChoiceField((*BRANCH_SIGN, "both"))
"""A field that holds an assembly; "both" adds a dim."""
STATUS_OF_CRANK = ("ok", "cannot_assemble", "toggle", "dead_centre")
"""Status by number of every machine with a crank."""
STATUS_OF_SLIDER = (*STATUS_OF_CRANK, "jammed", "no_cycle", "jammed_two_solutions")
"""Status by number of every machine in which friction may wedge a sliding part."""

OverDesigns = tuple[tuple[Callable[..., Mapping[str, Any]], tuple[Number, ...]], ...]
"""Functions of arrays, broadcast over the designs, that return arrays by name; and the numbers that each takes."""
CRANK = ("cos2", "cos2_lo", "sin2", "sin2_lo")
"""The crank's angle from x, as a grid tabulates it."""
PSI = ("psi_cos", "psi_cos_lo", "psi_sin")
"""The crank's angle from a near-toggle; the low word is the rounding of the cosine."""


def frame_parameters(name: str, angle: Number) -> dict[str, Number]:
    """Return cosine and sine of a frame's angle [degree], with low words, under the names that the physics takes."""
    parts = ("cos", "sin", "cos_lo", "sin_lo")
    return {f"{name}_{part}": number for part, number in zip(parts, cos_sin_low_words(angle), strict=True)}


def near_toggle_rows(middle: str) -> list[Row]:
    """Return the row of the crank's angle from a near-toggle; `middle` names the angle at which that lies."""
    near_toggle = tuple(f"{middle}_{part}" for part in ("cos", "cos_lo", "sin", "sin_lo"))
    return [Row(crank_angle.psi_from_crank_angle, PSI, (*CRANK, *near_toggle))]


def straight_rows(cos: str, sin: str, minus_sin: bool = False) -> list[Row]:
    """Return rows of the crank's angle from a near-toggle that lies along an axis: tabulated numbers, to the bit."""
    cosine = [Row(planar.identity, (psi,), (name,)) for psi, name in zip(PSI, (cos, f"{cos}_lo"), strict=False)]
    return [*cosine, Row(planar.opposite if minus_sin else planar.identity, PSI[2:], (sin,))]


def between_rows(middle_cos: str | float, middle_sin: str | float) -> tuple[Row, ...]:
    """Return rows of these angles, and of those that a grid tabulates, from half-angle tangents."""
    middle = (middle_cos, middle_sin)
    return (
        Row(crank_angle.angle_from_tangent, PSI),
        Row(crank_angle.angle_from_x, ("cos2", "sin2"), ("psi_cos", "psi_sin", *middle)),
        Row(crank_angle.one_turn, ("radians2",)),
    )


def in_range(length: Number) -> bool:
    """Return whether the square of a length is far from the least and the largest number in every design."""
    return in_every_design((length > 1e-140) & (length < 1e140))


def in_every_design(condition: Any) -> bool:
    """Return whether a condition on numbers holds in every design; of plain numbers it is a truth value itself."""
    return condition if type(condition) is bool else bool(np.all(condition))


def turned(frame_angle: Number) -> bool:
    """Return whether a frame may lie at an angle to x."""
    return hasattr(frame_angle, "dims") or frame_angle != 0.0
