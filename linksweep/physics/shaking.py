"""Shaking: what the inertia of the moving links does to the ground, by d'Alembert's principle.

    Fs = −Σ m a_G        Ms = −Σ (r_G × m a_G + I α),  about A, r_G from there

Weights and loads are not in it: what the ground bears is this and them. About another point P, Ms − r_P × Fs.
Source: R. S. Berkof and G. G. Lowen, Journal of Engineering for Industry 91 (1969) 21–26; R. L. Norton, Design of
Machinery, chapter "Balancing".
"""

from linksweep.physics.arithmetic import Number
from linksweep.physics.planar import cross


def inertia_force(mass: Number, aGx: Number, aGy: Number) -> tuple[Number, Number]:
    """−m a_G, one link's share of Fs."""
    return -(mass * aGx), -(mass * aGy)


def inertia_moment(inertia: Number, alpha: Number, Gx: Number, Gy: Number, force_x: Number, force_y: Number) -> Number:
    """r_G × (−m a_G) − I α, its share of Ms."""
    return cross(Gx, Gy, force_x, force_y) - inertia * alpha
