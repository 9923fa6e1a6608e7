"""Findings of a machine's closed-form checks, as arrays over its designs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray

ASSEMBLY = ("everywhere", "partly", "never")


class Finding(NamedTuple):
    """Values over the designs, and over a trailing dim of its own where `along` names one with its labels.

    Small integers stand for `words`; other values are in `units`.
    """

    values: Array
    long_name: str
    units: str = "degree"
    words: tuple[str, ...] = ()
    along: tuple[str, tuple[str, ...]] | None = None


Results = dict[str, Finding]

Findings = Callable[..., Results]
"""A function of arrays of numbers, broadcast against each other, that returns findings by name."""

Checks = tuple[tuple[Findings, tuple[Any, ...]], ...]
"""Closed-form checks, and the numbers that each takes."""


def turning_round(stretched: Array, folded: Array) -> Results:
    """Return the time ratio and the crank angles [degree] of an output that turns round where two links are in line."""
    between = np.mod(folded - stretched, 360.0)
    ratio = np.maximum(between, 360.0 - between) / np.minimum(between, 360.0 - between)
    angle, along = np.mod(np.stack([stretched, folded], axis=-1), 360.0), ("limit", ("stretched", "folded"))
    return {
        "time_ratio": Finding(ratio, "crank angle of the slower way over that of the faster one", "1"),
        "reversal_angle": Finding(angle, "crank angle at which it turns round: stretched, folded", along=along),
    }
