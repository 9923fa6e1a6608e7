"""Coulomb friction of a part that slides: −μ·|N|·sign(v) along its line, N the normal force on it, v its velocity.

Where the moments that give N have the friction in them too, they give without it N0, and with it

    N = N0/(1 + sign(N)·k),    k = μ·sign(v)·slope

μ·sign(v) is the `direction`, and the slope the friction's lever over the normal force's. With w = sign(N0)·k, exactly
one sign of N is consistent for |w| < 1, that of N0; none for w ≤ −1, where no force moves it on; both for w ≥ 1, where
rigid bodies do not tell which.
"""

import math

from linksweep.physics.arithmetic import Number, where


def opposing(force: Number, direction: Number) -> Number:
    """Return μ·sign(v)·sign(N) for any force that has the sign of N: friction is that times −N."""
    return where(force < 0.0, -direction, direction)


def sliding_contact(frictionless: Number, slope: Number, direction: Number) -> tuple[Number, Number, Number]:
    """Return the normal force N, the friction, and how near they are to wedging (w)."""
    k = opposing(frictionless, direction)
    wedging = k * slope
    normal = frictionless / where(abs(wedging) < 1.0, 1.0 + wedging, math.nan)
    return normal, -(k * normal), wedging


def friction(normal: Number, direction: Number) -> Number:
    """Return the friction beside a normal force that does not depend on it."""
    return -(opposing(normal, direction) * normal)


def jammed_status(status: Number, wedging: Number) -> Number:
    """Return the status so far, or where friction wedges 4 (jammed: no solution) or 6 (two solutions)."""
    return where(abs(wedging) < 1.0, status, where(status > 0.0, status, where(wedging > 0.0, 6.0, 4.0)))
