"""A small catalogue of deep-groove ball bearings: series 60, 62 and 63 of bores from 10 to 50 mm.

Bore, outside diameter and width are those of ISO 15, dimension series 10, 02 and 03, which all makers keep to. Load
ratings are none of a maker's: they follow from ISO 281 and ISO 76 (`linksweep.physics.rolling_bearing`) with balls by a
rule of thumb,

    Dw = 0.30·(D − d) in series 60 and 62, 0.31·(D − d) in series 63;   Dpw = (D + d)/2;   as many as fill 197°

which gives about the balls that makers have: a 6205 has 9 of 8.1 mm here, of 7.94 mm in fact. Beside SKF's catalogue
the 33 values of C are from 15 % below (6210) to 12 % above (6200), 3 % below on average, and those of C0 from 9 % below
to 11 % above. Makers differ among themselves, too (C of a 6205: SKF 14.8 kN, NSK 14.0 kN). So a choice is a size to
begin with, and its maker's catalogue decides.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

from linksweep.physics.rolling_bearing import balls_in_arc, dynamic_rating, static_rating

ARC = 197.0
"""Arc [degree] of the pitch circle that balls fill before the rings are made concentric."""
BORES = (10, 12, 15, 17, 20, 25, 30, 35, 40, 45, 50)
"""Bores [mm], with codes from 00 to 10."""
SIZES = {
    "60": "26x8 28x8 32x9 35x10 42x12 47x12 55x13 62x14 68x15 75x16 80x16",
    "62": "30x9 32x10 35x11 40x12 47x14 52x15 62x16 72x17 80x18 85x19 90x20",
    "63": "35x11 37x12 42x13 47x14 52x15 62x17 72x19 80x21 90x23 100x25 110x27",
}
"""Outside diameter and width [mm] for each bore, by series."""
BALL_SHARES = {"60": 0.30, "62": 0.30, "63": 0.31}
"""Diameter of the balls over the difference of the bearing's diameters, by series."""


class DeepGroove(NamedTuple):
    """A bearing: its diameters and width [m], and its load ratings [N]."""

    designation: str
    series: str
    bore: float
    outside: float
    width: float
    capacity: float
    static_capacity: float


@cache
def catalogue() -> tuple[DeepGroove, ...]:
    """Return all bearings, the smallest outside diameter first, of equal ones the narrowest."""
    sizes = [
        _bearing(series, code, *map(int, size.split("x")))
        for series, row in SIZES.items()
        for code, size in enumerate(row.split())
    ]
    return tuple(sorted(sizes, key=lambda one: (one.outside, one.width)))


def _bearing(series: str, code: int, outside: int, width: int) -> DeepGroove:
    bore = BORES[code]
    ball, pitch = BALL_SHARES[series] * (outside - bore), 0.5 * (outside + bore)
    balls = balls_in_arc(ball, pitch, ARC)
    ratings = dynamic_rating(ball, pitch, balls), static_rating(ball, pitch, balls)
    return DeepGroove(f"{series}{code:02d}", series, bore / 1000, outside / 1000, width / 1000, *ratings)
