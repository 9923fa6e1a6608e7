"""The cylinder of a machine with a piston: its opening at a crank angle, and its dead centres."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linksweep.base.degrees import cos_sin
from linksweep.base.validate import Number


@dataclass(frozen=True, eq=False)
class PistonCylinder:
    """A cylinder whose piston a crank moves by a rod.

    Parameters
    ----------
    crank, rod : lengths [m]
    offset : height of the guide over the crank's pivot, to the left of the guide's direction [m]
    slide_angle : direction of the guide to x [degree]
    side : 1 for a head ahead along the guide, -1 for a head behind
    """

    crank: Number
    rod: Number
    offset: Number
    slide_angle: Number
    side: float

    @property
    def turns_fully(self) -> Number:
        """True for each design whose crank turns fully, to the bit as its closure decides it."""
        return abs(self.offset) - self.rod + self.crank < 0.0

    def dead_centres(self) -> tuple[Number, Number]:
        """Return the crank angles [degree] of top and bottom dead centre: rod and crank stretched, folded.

        NaN in designs that have none.
        """
        with np.errstate(all="ignore"):  # out of reach: NaN
            reaches = self.rod + self.crank, self.rod - self.crank
            stretched, folded = (np.degrees(np.arcsin(np.divide(self.offset, reach))) for reach in reaches)
        ahead = np.mod(self.slide_angle + (0.0 if self.side > 0.0 else 180.0), 360.0)
        return ahead + self.side * stretched, ahead + 180.0 + self.side * folded

    def opening(self, angles: np.ndarray) -> np.ndarray:
        """Return the piston's distance from top dead centre over its stroke; NaN where it has no full turns."""
        a, b, e = self.crank, self.rod, self.offset
        cos, sin = cos_sin(angles - self.slide_angle)
        with np.errstate(all="ignore"):
            reach, least = np.sqrt((a + b) * (a + b) - e * e), np.sqrt((b - a) * (b - a) - e * e)
            opened = (reach - self.side * a * cos - np.sqrt(b * b - (e - a * sin) ** 2)) / (reach - least)
        return np.where(self.turns_fully, np.clip(opened, 0.0, 1.0), np.nan)
