"""The inverted slider-crank A-B-D: crank r2 = A→B of length a, its block on the line of a rocker that turns about D.

With ψ the angle from the frame line A→D, of length d, to the crank, w = D→B has −(d−a) − a(1 − cos ψ) along the
frame line and a·sin ψ across it. Its component s along the rocker's line, which is at the offset e from D, follows from

    s² = |w|² − e² = 2ad·(cos ψ_t − cos ψ),    cos ψ_t = 1 + (d−a−e)(d−a+e)/(2ad)

It closes while s² > 0. The cosines are kept in double-double, so no digit is lost near a toggle, nor where B passes
close to D. The block stands still on the line where the crank lies along the frame line: r2 × w = ad·sin ψ = 0, for any
offset.
"""

from linksweep.physics.algebra.arithmetic import NOISE, Number, sqrt, where
from linksweep.physics.algebra.double_double import Pair, add, difference, divide, multiply, two_product, two_sum
from linksweep.physics.algebra.planar import cross, dot
from linksweep.physics.closures.crank_angle import cosine_noise, range_noise
from linksweep.physics.coulomb import opposing, sliding_contact
from linksweep.physics.crank_driven import away_from_dead_centre


def versine(psi_cos: Number, psi_cos_lo: Number) -> Number:
    """Return 1 − cos ψ, which keeps its digits as ψ tends to 0."""
    return difference((1.0, 0.0), (psi_cos, psi_cos_lo))


def block_from_rocker_pivot(
    crank_length: Number,
    ground_length: Number,
    psi_versine: Number,
    psi_sin: Number,
    ground_cos: Number,
    ground_sin: Number,
) -> tuple[Number, Number]:
    """Return w = D→B in ground axes."""
    along, across = (crank_length - ground_length) - crank_length * psi_versine, crank_length * psi_sin
    return along * ground_cos - across * ground_sin, along * ground_sin + across * ground_cos


def toggle_cosine(crank_length: Number, ground_length: Number, offset: Number) -> Pair:
    """Return cos ψ_t as a double-double."""
    a, d, e = crank_length, ground_length, offset
    d_a = two_sum(d, -a)
    least = multiply(add(d_a, (-e, 0.0)), add(d_a, (e, 0.0)))
    return add((1.0, 0.0), divide(least, two_product(2.0 * a, d)))


def slide_cosine(psi_cos: Number, psi_cos_lo: Number, toggle_cos: Number, toggle_cos_lo: Number) -> Number:
    """Return cos ψ_t − cos ψ."""
    return difference((toggle_cos, toggle_cos_lo), (psi_cos, psi_cos_lo))


def slide_squared(crank_length: Number, ground_length: Number, slide_cosine: Number) -> Number:
    """Return s² of the module's equation."""
    return 2.0 * crank_length * ground_length * slide_cosine


def slide_leverage(crank_length: Number, ground_length: Number, psi_sin: Number) -> Number:
    """Return r2 × w of the module's equation."""
    return crank_length * ground_length * psi_sin


def near_toggle_width(crank_length: Number, ground_length: Number, offset: Number, friction: Number) -> Number:
    """Return the half-width, as tan(ψ/2), of the narrowest peak that forces may have about ψ = 0.

    There s² is x + y·tan²(ψ/2), zero at tan = ±i·√(x/y): the width is √(x/y). Friction wedges where s² = μ²e², that is
    where B is |e|·√(1 + μ²) from D.
    """
    a, d, e = crank_length, ground_length, offset * sqrt(1.0 + friction * friction)
    return sqrt((((d - a) - e) * ((d - a) + e)) / (((d + a) - e) * ((d + a) + e)))


def closure_noise(
    crank_length: Number,
    ground_length: Number,
    offset: Number,
    toggle_cos: Number,
    toggle_cos_lo: Number,
    psi_sin: Number,
) -> Number:
    """Return the noise floor of s², below which it may be zero."""
    a, d, e = crank_length, ground_length, abs(offset)
    length, twice_ad = 2.0**-52 * (a + d + e), 2.0 * a * d
    miss = difference((toggle_cos, toggle_cos_lo), (1.0, 0.0))
    noise = length * (abs(d - a) + e + length) / twice_ad
    return twice_ad * (cosine_noise(miss, noise, psi_sin) + range_noise(twice_ad))


def assembly(crank_length: Number, ground_length: Number, offset: Number) -> Number:
    """Return 0 where it closes at every angle, 1 where at some, 2 where at none."""
    a, d, e = crank_length, ground_length, abs(offset)
    return where(e < abs(d - a), 0.0, where(e < d + a, 1.0, 2.0))


def slide_direction(
    friction: Number, slide_velocity: Number, slide_leverage: Number, crank_length: Number, ground_length: Number
) -> Number:
    """Return μ·sign(s'), or 0 where the block stands still within the error of the angle."""
    moves = abs(slide_leverage) > NOISE * crank_length * ground_length
    direction = where(slide_velocity > 0.0, friction, where(slide_velocity < 0.0, -friction, 0.0))
    return where(moves, direction, 0.0)


def normal_force_on_block(N3: Number, N4: Number, inverse_slide: Number, offset: Number, line_force: Number) -> Number:
    """Return F43n from the moments of block and rocker about B and D: s·F43n − e·F = N3 + N4.

    The contact's moment T43 drops out; the force F along the line has the arm e.
    """
    return (N3 + N4 + offset * line_force) * inverse_slide


def contact_force(
    N3: Number, N4: Number, inverse_slide: Number, offset: Number, direction: Number
) -> tuple[Number, Number, Number]:
    """Return F43n, friction force and wedging w where F is friction alone: s·F43n − e·F = N3 + N4."""
    return sliding_contact((N3 + N4) * inverse_slide, offset * inverse_slide, direction)


def contact_force_from_crank(
    moment_r2: Number, crank_along: Number, crank_across: Number, crank_length: Number, direction: Number
) -> tuple[Number, Number, Number]:
    """Return F43n, friction force and wedging w where the crank's torques are known: r2 × F43 = (r2·u)·F43n + (r2 ×
    u)·F."""
    lever = away_from_dead_centre(crank_along, crank_along, crank_length, 1.0)
    return sliding_contact(moment_r2 / lever, -(crank_across / lever), direction)


def cylinder_force(line_force: Number, friction_force: Number) -> Number:
    """Return the cylinder's own force: the whole force on the block along the line, less friction."""
    return line_force - friction_force


def contact_direction(F43n: Number, direction: Number, r3x: Number, r3y: Number) -> tuple[Number, Number]:
    """Return the force on the block per unit normal force, with its friction: n − μ·sign(s')·sign(F43n)·u."""
    k = opposing(F43n, direction)
    return -r3y - k * r3x, r3x - k * r3y


def contact_arm(F43n: Number, direction: Number, normal_arm: Number, line_arm: Number) -> Number:
    """Return the moment per unit normal force, with that of its friction."""
    return normal_arm - opposing(F43n, direction) * line_arm


def slide_arms(Bx: Number, By: Number, rGx: Number, rGy: Number, r3x: Number, r3y: Number) -> tuple[Number, Number]:
    """Return the moments about a link's centre of gravity of a unit force at B across the line and of one along it; B
    and centre of gravity are measured from the link's first pin."""
    x, y = Bx - rGx, By - rGy
    return dot(x, y, r3x, r3y), cross(x, y, r3x, r3y)
