"""The slider-crank A-B-C: crank r2 = A→B of length a, rod r3 = B→C of length b, slider on a guide offset by e.

With φ the angle from the guide to the crank, the rod's share across the guide is h = e − a·sin φ, so that

    low  = b − h = (b − e − a) + a(1 + sin φ),    1 + sin φ = (cos φ/2 + sin φ/2)²
    high = b + h = (b + e − a) + a(1 − sin φ),    1 − sin φ = (cos φ/2 − sin φ/2)²

It closes while both are positive: at every angle if a + |e| < b.
"""

import math

from linksweep.physics.arithmetic import NOISE, Number, where
from linksweep.physics.planar import cross, dot


def guide_shares(
    r2x: Number, r2y: Number, offset: Number, guide_cos: Number, guide_sin: Number
) -> tuple[Number, Number, Number]:
    """The crank's shares along and across the guide, and the rod's share across."""
    crank_across = guide_cos * r2y - guide_sin * r2x
    return dot(r2x, r2y, guide_cos, guide_sin), crank_across, offset - crank_across


def closure_factors(
    crank_length: Number, rod_length: Number, offset: Number, sin_half: Number, cos_half: Number
) -> tuple[Number, Number]:
    """low and high, as the module's equations write them."""
    a, b, e = crank_length, rod_length, offset
    plus, minus = cos_half + sin_half, cos_half - sin_half
    return (b - e - a) + a * (plus * plus), (b + e - a) + a * (minus * minus)


def closure_noise(crank_length: Number, rod_length: Number, offset: Number) -> Number:
    """What low and high cannot tell from zero: sums of lengths are known to a few last digits of the largest."""
    return 0.25 * NOISE * (crank_length + rod_length + abs(offset))


def assembly(crank_length: Number, rod_length: Number, offset: Number) -> Number:
    """0 where it closes at every angle, 1 where at some, 2 where at none."""
    reach = abs(offset) - rod_length
    return where(reach + crank_length < 0.0, 0.0, where(reach - crank_length < 0.0, 1.0, 2.0))


def slider_position(crank_along: Number, rod_along: Number) -> Number:
    """Position of C along the guide, from the foot of A on it."""
    return crank_along + rod_along


def friction_direction(friction: Number, v_slider: Number, omega2: Number, noise: Number) -> Number:
    """μ·sign(v); 0 where the slider stands, as far as the lengths can tell."""
    standing = abs(omega2) * noise
    return where(v_slider > standing, friction, where(v_slider < -standing, -friction, 0.0))


def guide_force(
    inverse_lever_along: Number,
    lever_across: Number,
    lever_moment: Number,
    Q4x: Number,
    Q4y: Number,
    guide_cos: Number,
    guide_sin: Number,
    direction: Number,
) -> tuple[Number, Number, Number]:
    """The guide's force on the slider across (normal) and along (friction), and how near it is to wedging.

    F43 = F14 + Q4 and r × F43 = moment for the lever r (the rod, or the crank where its torque is known) give,
    without friction, a normal force N0. Friction −μ|N|·sign(v) changes it to N = N0/(1 + sign(N)·k) with k =
    μ·sign(v)·tan ψ, μ·sign(v) the `direction` and tan ψ the lever's slope to the guide. For |k| < 1 exactly one sign
    of N is consistent, that of N0; for |k| ≥ 1 none or both are: the slider wedges, and nothing is known.
    """
    Q4_along, Q4_across = dot(Q4x, Q4y, guide_cos, guide_sin), cross(guide_cos, guide_sin, Q4x, Q4y)
    slope = lever_across * inverse_lever_along
    frictionless = lever_moment * inverse_lever_along + slope * Q4_along - Q4_across
    opposing = where(frictionless < 0.0, -direction, direction)
    wedging = abs(direction * slope)
    normal = frictionless / where(wedging < 1.0, 1.0 + opposing * slope, math.nan)
    return normal, -(opposing * normal), wedging


def guide_force_in_ground_axes(
    normal_force: Number, friction_force: Number, guide_cos: Number, guide_sin: Number
) -> tuple[Number, Number]:
    """F14."""
    return (
        friction_force * guide_cos - normal_force * guide_sin,
        friction_force * guide_sin + normal_force * guide_cos,
    )


def jammed_status(status: Number, wedging: Number) -> Number:
    """The status so far, or 4 (jammed) where friction wedges the slider."""
    return where(wedging < 1.0, status, where(status > 0.0, status, 4.0))


def inverse_or_nan(x: Number) -> Number:
    return where(abs(x) > 0.0, 1.0 / x, math.nan)


def moment_on_rod(N3: Number) -> Number:
    """r3 × F43 where the rod bears no drive: its moments about B."""
    return -N3


def work_on_crank(
    N2: Number,
    N3: Number,
    Q3x: Number,
    Q3y: Number,
    Q4x: Number,
    Q4y: Number,
    friction_force: Number,
    r2x: Number,
    r2y: Number,
    ratio3: Number,
    ratio_slider: Number,
    guide_cos: Number,
    guide_sin: Number,
) -> Number:
    """Virtual work per turn of the crank of all loads, weights, inertia forces and friction."""
    push = dot(Q4x, Q4y, guide_cos, guide_sin) + friction_force
    return N2 + cross(r2x, r2y, Q3x, Q3y) + ratio3 * N3 + ratio_slider * push


def friction_row(
    normal_force: Number, direction: Number, guide_cos: Number, guide_sin: Number
) -> tuple[Number, Number]:
    """Coefficients of F14x and F14y in the friction row: share along + μ·sign(v)·sign(N)·share across = 0."""
    k = where(normal_force < 0.0, -direction, direction)
    return guide_cos - k * guide_sin, guide_sin + k * guide_cos
