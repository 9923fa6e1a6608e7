"""Angle of a vector by + − * / alone: equal bits on any machine, interpreted or compiled.

In the first eighth of a turn the slope t of the vector is at most 1. Up to tan 22.5° the series

    arctan t = t + t·t²·P(t²)

is used directly; beyond, (t − 1)/(t + 1) takes the place of t, the slope seen from 45°. P is the minimax polynomial
over that range (largest error 3e-17), close to the series −1/3 + t²/5 − …; symmetry covers the other eighths. Errors
stay below two units in the last place.
"""

import math

from linksweep.physics.algebra.arithmetic import Number, where

TAN_EIGHTH = math.tan(math.pi / 8.0)
SERIES = (
    -0.019162068915902573,
    0.03921955253255129,
    -0.05085030492810941,
    0.058580687568615106,
    -0.06664502215671447,
    0.07692182535116648,
    -0.09090904549884611,
    0.11111111014561013,
    -0.14285714284657894,
    0.1999999999999548,
    -0.3333333333333333,
)
PI_LO = 1.2246467991473532e-16
"""Low word of π: π − math.pi."""


def arctangent(y: Number, x: Number) -> Number:
    """Return the angle of the vector (x, y) from x [rad], in (−π, π]."""
    width, height = abs(x), abs(y)
    steep = height > width
    low, high = where(steep, width, height), where(steep, height, width)
    beyond = low > TAN_EIGHTH * high
    slope = where(beyond, low - high, low) / where(beyond, low + high, high)
    bend = _bend(slope)
    angle = where(beyond, 0.25 * math.pi + (slope + (bend + 0.25 * PI_LO)), slope + bend)
    angle = where(steep, 0.5 * math.pi - (angle - 0.5 * PI_LO), angle)
    angle = where(x < 0.0, math.pi - (angle - PI_LO), angle)
    return where(y < 0.0, -angle, angle)


def small_angle(slope: Number) -> Number:
    """Return the angle of a slope up to tan 22.5°, of either sign [rad]."""
    return slope + _bend(slope)


def _bend(slope: Number) -> Number:
    return slope * (slope * slope * _series(slope * slope))


def _series(z: Number) -> Number:
    total: Number = SERIES[0]
    for coefficient in SERIES[1:]:
        total = total * z + coefficient
    return total
