"""Strokes: positions of links that a load may follow in place of the crank, and the crank angles that belong to them.

A link that slides or swings goes to and fro once a turn, so that it has most positions at two crank angles. For a pin P
that a rod of length b joins to the crank pin, at the distance r and in the direction γ from A,

    θ2 = γ ± acos((a² + r² − b²)/(2ar))

of which one may belong to the other branch. A link that a rod drives turns round where crank and rod lie in one line, a
block on a rocker where the crank lies in line with the ground.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from linksweep.base.validate import Number

Angles = tuple[Number, ...]
OF_SLIDER, OF_BLOCK = ("closing", "opening"), ("extending", "retracting")
OF_LINK = "counter-clockwise", "clockwise"
"""Words for the two ways: of sliders on the ground, of blocks on links and of cylinders, of links that swing."""


@dataclass(frozen=True, eq=False)
class Stroke:
    """A position of a link, start + sense·quantity, which the crank moves to and fro.

    Parameters
    ----------
    quantity, slope : str
        Names of the quantity, and of its derivative to the crank's angle.
    kind : str
        Kind of the position: "length" [m] or "angle" [degree].
    words : pair of str
        Words for the two ways; on the first the quantity grows where `forward` is 1, and shrinks where it is -1.
    crank_angles : function, default None
        Crank angles [degree] at which the quantity has a value, on this or the other branch; NaN for none. None where
        there is no closed form of it.
    turning : tuple of float or DataArray, default ()
        Crank angles [degree] at which it turns round; NaN for none.
    forward, start, sense : float or DataArray
        Direction of the first way, and the two constants of the position.
    from_end : bool, default False
        True where `start` is the largest value of the quantity, without a closed form of it.
    """

    quantity: str
    slope: str
    kind: str
    words: tuple[str, str]
    crank_angles: Callable[[Number], Angles] | None = None
    turning: Angles = ()
    forward: Number = 1.0
    start: Number = 0.0
    sense: Number = 1.0
    from_end: bool = False

    def reached(self, position: float) -> Angles:
        """Return the crank angles [degree] at which the link has a position, on either branch; NaN for none."""
        assert self.crank_angles is not None, self.quantity
        with np.errstate(all="ignore"):
            return self.crank_angles((position - self.start) / self.sense)


def kind_of_position(name: str) -> str:
    """Return the kind of a position by its name, before its machine is known: "angle" for "rocker.angle"."""
    return "angle" if name.endswith(".angle") else "length"


def slider_strokes(a: Number, b: Number, e: Number, guide: Number, sign: float, turning: Angles) -> dict[str, Stroke]:
    """Return the strokes of a slider: its position, and its distance from the outer dead centre."""

    def crank_angles(x: Number) -> Angles:
        reach = np.hypot(x, e)
        return _two(np.arctan2(e, x), (a * a + reach * reach - b * b) / (2.0 * a * reach), guide)

    with np.errstate(invalid="ignore"):
        outermost = np.sqrt((a + b - e) * (a + b + e))
    position = Stroke("x_slider", "ratio_slider", "length", OF_SLIDER, crank_angles, turning, sign)
    to_end = Stroke("x_slider", "ratio_slider", "length", OF_SLIDER, crank_angles, turning, sign, outermost, -sign)
    return {"slider.position": position, "slider.to_end": to_end}


def block_stroke(a: Number, d: Number, e: Number, frame: Number, sign: float) -> Stroke:
    """Return the stroke of a block along its rocker, or of a cylinder: its slide."""

    def crank_angles(slide: Number) -> Angles:
        return _two(0.0 * slide, (a * a + d * d - e * e - slide * slide) / (2.0 * a * d), frame)

    turning = frame, frame + 180.0
    return Stroke("slide", "ratio_slide", "length", OF_BLOCK, crank_angles, turning, sign)


def rocker_stroke(a: Number, b: Number, c: Number, d: Number, frame: Number, sign: float) -> Stroke:
    """Return the stroke of a four-bar's rocker: its angle."""

    def crank_angles(theta4: Number) -> Angles:
        angle = np.radians(theta4 - frame)
        x, y = d + c * np.cos(angle), c * np.sin(angle)  # pin C from A, in axes along A-D
        reach = np.hypot(x, y)
        return _two(np.arctan2(y, x), (a * a + reach * reach - b * b) / (2.0 * a * reach), frame)

    with np.errstate(invalid="ignore"):
        lines = [np.degrees(np.arccos((d * d + f * f - c * c) / (2.0 * d * f))) for f in (b + a, b - a)]
    stretched, folded = (frame + sign * line for line in lines)
    return Stroke("theta4", "ratio4", "angle", OF_LINK, crank_angles, (stretched, folded + 180.0))


def _two(direction: Number, cosine: Number, frame: Number) -> Angles:
    """Return the angles [degree] on either side of a direction [rad] in a frame, by the cosine between them."""
    middle, away = frame + np.degrees(direction), np.degrees(np.arccos(cosine))
    return middle - away, middle + away
