"""Reduced inertia: the disk on the crank that has the kinetic energy of all moving links, ½ J ω2².

    J(θ2) = Σ (m |u|² + I k²),    u = v_G/ω2,  k = ω/ω2
    dJ/dθ2 = 2 Σ (m u·u' + I k k')

The derivatives u' and k' with respect to θ2 are the accelerations at ω2 = 1, α2 = 0. Source: F. Wittenbauer,
Graphische Dynamik (1923).
"""

from linksweep.physics.algebra.arithmetic import Number
from linksweep.physics.algebra.planar import dot, square


def reduced_inertia(mass: Number, inertia: Number, ux: Number, uy: Number, ratio: Number) -> Number:
    """Return one link's term of J."""
    return mass * square(ux, uy) + inertia * (ratio * ratio)


def reduced_inertia_slope(
    mass: Number,
    inertia: Number,
    ux: Number,
    uy: Number,
    ratio: Number,
    ux_slope: Number,
    uy_slope: Number,
    ratio_slope: Number,
) -> Number:
    """Return one link's term of dJ/dθ2."""
    return 2.0 * (mass * dot(ux, uy, ux_slope, uy_slope) + inertia * (ratio * ratio_slope))


def kinetic_energy(reduced_inertia: Number, omega2: Number) -> Number:
    return 0.5 * (reduced_inertia * (omega2 * omega2))
