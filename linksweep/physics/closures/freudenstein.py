"""Freudenstein's equations of the four-bar A-B-C-D with sides a = AB, b = BC, c = CD, d = AD, as document 2 has them.

With θ2 counted from the line A→D and t the tangent of half an angle,

    A t² + B t + C = 0,  t = tan(θ4/2)        D t² + E t + F = 0,  t = tan(θ3/2)

They cancel near a toggle, and A or D may vanish in a sound mechanism: they are for comparison with the page, not for
computing. Source: document 2 (ME 470), position; R. L. Norton, Design of Machinery, chapter "Position Analysis".
"""

from typing import NamedTuple

from linksweep.physics.algebra.arithmetic import Number


class PositionEquation(NamedTuple):
    """The formulas of a position equation's coefficients, and of its roots, by the names of their quantities."""

    coefficients: dict[str, str]
    roots: dict[str, str]


POSITION_EQUATION = PositionEquation(
    {
        "K1": "d/a",
        "K2": "d/c",
        "K3": "(a**2 - b**2 + c**2 + d**2)/(2*a*c)",
        "K4": "d/b",
        "K5": "(c**2 - d**2 - a**2 - b**2)/(2*a*b)",
        "A": "cos(theta2) - K1 - K2*cos(theta2) + K3",
        "B": "-2*sin(theta2)",
        "C": "K1 - (K2 + 1)*cos(theta2) + K3",
        "D": "cos(theta2) - K1 + K4*cos(theta2) + K5",
        "E": "-2*sin(theta2)",
        "F": "K1 + (K4 - 1)*cos(theta2) + K5",
    },
    {
        "theta3": "2*atan((-E ± sqrt(E**2 - 4*D*F))/(2*D)), - for open and + for crossed",
        "theta4": "2*atan((-B ± sqrt(B**2 - 4*A*C))/(2*A)), - for open and + for crossed",
    },
)


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
