"""The inverted slider-crank A-B-D: crank r2 = A→B of length a, its block on the line of a rocker that turns about D.

With φ the angle from the frame line A→D, of length d, to the crank, w = D→B has −(d−a) − 2a·sin²(φ/2) along the
frame line and 2a·sin(φ/2)·cos(φ/2) across it, and its part s along the rocker's line, at the offset e from D,

    s² = |w|² − e² = (d−a−e)(d−a+e) + 4ad·sin²(φ/2)

It closes while s² > 0. Half angles keep every digit where cos φ would drop them, also where B passes close to D.
"""

import math

from linksweep.physics.arithmetic import NOISE, Number, where
from linksweep.physics.planar import dot


def block_from_rocker_pivot(
    crank_length: Number,
    ground_length: Number,
    sin_half: Number,
    cos_half: Number,
    ground_cos: Number,
    ground_sin: Number,
) -> tuple[Number, Number]:
    """w = D→B in ground axes."""
    twice = 2.0 * crank_length * sin_half
    along, across = (crank_length - ground_length) - twice * sin_half, twice * cos_half
    return along * ground_cos - across * ground_sin, along * ground_sin + across * ground_cos


def slide_squared(crank_length: Number, ground_length: Number, offset: Number, sin_half: Number) -> Number:
    """s², as the module's equation writes it."""
    a, d, e = crank_length, ground_length, offset
    return ((d - a) - e) * ((d - a) + e) + 4.0 * a * d * (sin_half * sin_half)


def closure_noise(crank_length: Number, ground_length: Number, offset: Number) -> Number:
    """What s² cannot tell from zero: each sum of lengths is known to a few last digits of the largest."""
    a, d, e = crank_length, ground_length, abs(offset)
    noise = 0.25 * NOISE * (a + d + e)
    return noise * (abs(d - a) + e + noise)


def assembly(crank_length: Number, ground_length: Number, offset: Number) -> Number:
    """0 where it closes at every angle, 1 where at some, 2 where at none."""
    a, d, e = crank_length, ground_length, abs(offset)
    return where(e < abs(d - a), 0.0, where(e < d + a, 1.0, 2.0))


def normal_force_on_block(N3: Number, N4: Number, inverse_slide: Number) -> Number:
    """F43n from the moments of block and rocker about B and D: the contact's moment T43 drops out, s·F43n = N3 + N4."""
    return (N3 + N4) * inverse_slide


def normal_force_from_crank(moment_r2: Number, crank_along: Number) -> Number:
    """F43n where the crank's torques are all known: r2 × F43 = (r2·u)·F43n."""
    return where(abs(crank_along) > 0.0, moment_r2 / crank_along, math.nan)


def normal_vector(normal: Number, r3x: Number, r3y: Number) -> tuple[Number, Number]:
    """A vector across the rocker's line, in ground axes."""
    return -(normal * r3y), normal * r3x


def contact_arm(DBx: Number, DBy: Number, rG4x: Number, rG4y: Number, r3x: Number, r3y: Number) -> Number:
    """Arm of the normal force about the rocker's centre of gravity: the way from G4 to B along the line."""
    return dot(DBx - rG4x, DBy - rG4y, r3x, r3y)
