"""Load ratings of deep-groove ball bearings from their balls: Z of diameter Dw on a pitch circle Dpw, in one row.

    C = bm·fc·(i·cos α)^0.7·Z^(2/3)·Dw^1.8    [N], Dw in mm, at most 25.4 mm; i = 1, α = 0, bm = 1.3
    C0 = f0·i·Z·Dw²·cos α                     [N], Dw in mm
    fc, f0 over γ = Dw·cos α/Dpw              tables of the standards, linear between their rows
    (Z − 1)·2·asin(Dw/Dpw) ≤ ψ                balls that fit between eccentric rings, which fill the arc ψ

Sources: ISO 281 (C, table of fc for grooves of 0.52·Dw), ISO 76 (C0, table of f0 for a contact stress of 4200 MPa);
the arc ψ, assembly by A. B. W. Conrad, is that of any handbook of rolling bearings.
"""

import math
from bisect import bisect

from linksweep.physics.algebra.arithmetic import Number

RATING_FACTOR = 1.3
"""bm of radial contact groove ball bearings of today's steel."""
DYNAMIC_FACTORS = (
    (0.05, 46.7), (0.06, 49.1), (0.07, 51.1), (0.08, 52.8), (0.09, 54.3), (0.10, 55.5), (0.12, 57.5), (0.14, 58.8),
    (0.16, 59.6), (0.18, 59.9), (0.20, 59.9), (0.22, 59.6), (0.24, 59.0), (0.26, 58.2), (0.28, 57.1), (0.30, 56.0),
    (0.32, 54.6), (0.34, 53.2), (0.36, 51.7), (0.38, 50.0), (0.40, 48.4),
)  # fmt: skip
"""Rows (γ, fc)."""
STATIC_FACTORS = (
    (0.05, 15.7), (0.06, 15.9), (0.07, 16.1), (0.08, 16.3), (0.09, 16.5), (0.10, 16.4), (0.11, 16.1), (0.12, 15.9),
    (0.13, 15.6), (0.14, 15.4), (0.15, 15.2), (0.16, 14.9), (0.17, 14.7), (0.18, 14.4), (0.19, 14.2), (0.20, 14.0),
    (0.21, 13.7), (0.22, 13.5), (0.23, 13.2), (0.24, 13.0), (0.25, 12.8), (0.26, 12.5), (0.27, 12.3), (0.28, 12.1),
    (0.29, 11.8), (0.30, 11.6), (0.31, 11.4), (0.32, 11.2), (0.33, 10.9), (0.34, 10.7), (0.35, 10.5), (0.36, 10.3),
    (0.37, 10.0), (0.38, 9.8), (0.39, 9.6), (0.40, 9.4),
)  # fmt: skip
"""Rows (γ, f0)."""


def dynamic_rating(ball: Number, pitch: Number, balls: int) -> Number:
    """Return the basic dynamic load rating C [N] from the diameters of ball and pitch circle [mm]."""
    return RATING_FACTOR * _between(DYNAMIC_FACTORS, ball / pitch) * balls ** (2.0 / 3.0) * ball**1.8


def static_rating(ball: Number, pitch: Number, balls: int) -> Number:
    """Return the basic static load rating C0 [N] from the diameters of ball and pitch circle [mm]."""
    return _between(STATIC_FACTORS, ball / pitch) * balls * ball * ball


def balls_in_arc(ball: Number, pitch: Number, arc: Number) -> int:
    """Return the number of balls that fill an arc [degree] of the pitch circle at most."""
    return 1 + math.floor(math.radians(arc) / (2.0 * math.asin(ball / pitch)))


def _between(rows: tuple[tuple[float, float], ...], x: float) -> float:
    """Return the value of a table at x, linear between its rows."""
    k = min(max(bisect(rows, (x,)), 1), len(rows) - 1)
    (x0, y0), (x1, y1) = rows[k - 1], rows[k]
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
