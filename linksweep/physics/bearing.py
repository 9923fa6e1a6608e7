"""Plain bearings: a pin of diameter d in a bush of length l, loaded by F, one turning in the other by ω.

    p = F/(d·l)                projected pressure
    v = |ω|·d/2                sliding speed
    P = μ·F·v                  power of friction

Source: R. G. Budynas and J. K. Nisbett, Shigley's Mechanical Engineering Design, chapter "Lubrication and Journal
Bearings" (boundary-lubricated bearings: nominal pressure, PV).
"""

from linksweep.physics.arithmetic import Number
from linksweep.physics.planar import cross, dot


def relative_rotation(omega_journal: Number, omega_bearing: Number) -> Number:
    """Angular velocity of the journal's link seen from the bearing's."""
    return omega_journal - omega_bearing


def in_link_axes(x: Number, y: Number, length: Number, rx: Number, ry: Number) -> tuple[Number, Number]:
    """Components of a vector along and across a link whose line of pins is r, |r| = length."""
    return dot(x, y, rx, ry) / length, cross(rx, ry, x, y) / length


def projected_pressure(force: Number, diameter: Number, length: Number) -> Number:
    return force / (diameter * length)


def sliding_speed(rotation_speed: Number, diameter: Number) -> Number:
    return abs(rotation_speed) * diameter / 2.0


def friction_loss(friction: Number, force: Number, speed: Number) -> Number:
    """Power that friction takes, never negative."""
    return friction * force * speed
