"""Freudenstein's equations of the four-bar A-B-C-D with sides a = AB, b = BC, c = CD, d = AD, as document 2 has them.

With θ2 counted from the line A→D and t the tangent of half an angle,

    A t² + B t + C = 0,  t = tan(θ4/2)        D t² + E t + F = 0,  t = tan(θ3/2)

They cancel near a toggle, and A or D may vanish in a sound mechanism: they are for comparison with the page, not for
computing. Source: document 2 (ME 470), position; R. L. Norton, Design of Machinery, chapter "Position Analysis".
"""

from linksweep.physics.algebra.arithmetic import Number


def ratios(
    crank_length: Number, coupler_length: Number, rocker_length: Number, ground_length: Number
) -> tuple[Number, Number, Number, Number, Number]:
    """Return K1 to K5 of document 2."""
    a, b, c, d = crank_length, coupler_length, rocker_length, ground_length
    return (
        d / a,
        d / c,
        (a * a - b * b + c * c + d * d) / (2.0 * a * c),
        d / b,
        (c * c - d * d - a * a - b * b) / (2.0 * a * b),
    )


def rocker_equation(
    psi_cos: Number, psi_sin: Number, K1: Number, K2: Number, K3: Number
) -> tuple[Number, Number, Number]:
    """Return A, B and C of document 2."""
    return (
        psi_cos - K1 - K2 * psi_cos + K3,
        -2.0 * psi_sin,
        K1 - (K2 + 1.0) * psi_cos + K3,
    )


def coupler_equation(
    psi_cos: Number, psi_sin: Number, K1: Number, K4: Number, K5: Number
) -> tuple[Number, Number, Number]:
    """Return D, E and F of document 2."""
    return (
        psi_cos - K1 + K4 * psi_cos + K5,
        -2.0 * psi_sin,
        K1 + (K4 - 1.0) * psi_cos + K5,
    )
