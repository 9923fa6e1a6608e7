"""Shaking: force and moment of the moving links' inertia on the ground, by d'Alembert's principle.

    Fs = −Σ m a_G        Ms = −Σ (r_G × m a_G + I α),  about A, r_G from there

Weights and loads are excluded; the ground bears them in addition. About another point P the moment is Ms − r_P × Fs.
Source: R. S. Berkof and G. G. Lowen, Journal of Engineering for Industry 91 (1969) 21–26; R. L. Norton, Design of
Machinery, chapter "Balancing".
"""

from linksweep.physics.algebra.arithmetic import Number
from linksweep.physics.algebra.planar import cross


def inertia_force(mass: Number, aGx: Number, aGy: Number) -> tuple[Number, Number]:
    """Return −m a_G, one link's term of Fs."""
    return -(mass * aGx), -(mass * aGy)


def inertia_moment(inertia: Number, alpha: Number, Gx: Number, Gy: Number, force_x: Number, force_y: Number) -> Number:
    """Return r_G × (−m a_G) − I α, one link's term of Ms."""
    return cross(Gx, Gy, force_x, force_y) - inertia * alpha
