"""Plain bearings: a pin of diameter d in a bush of length l, loaded by F; ω is their relative angular velocity.

    p = F/(d·l)                projected pressure
    v = |ω|·d/2                sliding speed
    ρ = (d/2)·sin φ = (d/2)·μ/√(1 + μ²)    radius of the friction circle
    P = ρ·F·|ω|                friction power

Coulomb friction acts where the journal touches its bush; there the load is inclined to the normal by φ, tan φ = μ.
Textbooks shorten ρ to μ·d/2, which is larger by √(1 + μ²): 0.5 % at μ = 0.1, 2 % at 0.2, 12 % at 0.5.

Source: R. G. Budynas and J. K. Nisbett, Shigley's Mechanical Engineering Design, chapter "Lubrication and Journal
Bearings" (boundary-lubricated bearings: nominal pressure, PV).
"""

from linksweep.physics.algebra.arithmetic import Number
from linksweep.physics.algebra.planar import cross, dot


def relative_rotation(omega_j: Number, omega_i: Number) -> Number:
    """Return the angular velocity of link j relative to link i."""
    return omega_j - omega_i


def in_link_axes(x: Number, y: Number, length: Number, rx: Number, ry: Number) -> tuple[Number, Number]:
    """Return the components of a vector along and across a link whose line of pins is r, |r| = length."""
    return dot(x, y, rx, ry) / length, cross(rx, ry, x, y) / length


def projected_pressure(force: Number, diameter: Number, length: Number) -> Number:
    return force / (diameter * length)


def sliding_speed(rotation_speed: Number, diameter: Number) -> Number:
    return abs(rotation_speed) * diameter / 2.0


def friction_circle(friction: Number, diameter: Number) -> Number:
    """Return the radius of the friction circle: the distance of the load's line of action from the pin's centre."""
    return 0.5 * diameter * friction / (1.0 + friction * friction) ** 0.5


def friction_loss(radius: Number, force: Number, rotation_speed: Number) -> Number:
    """Return the friction power, never negative, from the radius of the friction circle."""
    return radius * force * abs(rotation_speed)
