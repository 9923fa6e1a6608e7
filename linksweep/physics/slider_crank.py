"""The slider-crank A-B-C: crank r2 = A→B of length a, rod r3 = B→C of length b, slider on a guide offset by e.

With ψ the angle of the crank from the guide's left normal, the rod's share across the guide is h = e − a·cos ψ, so that

    low  = b − h = a(cos ψ − cos ψ_l),    cos ψ_l = (e − b)/a
    high = b + h = a(cos ψ_h − cos ψ),    cos ψ_h = (e + b)/a

It closes while both are positive: at every angle if a + |e| < b. The differences of cosines are all that cancels, and
are therefore sums of two numbers each.
"""

from linksweep.physics import crank_driven
from linksweep.physics.arithmetic import NOISE, Number, sqrt, where
from linksweep.physics.coulomb import opposing, sliding_contact
from linksweep.physics.crank_angle import beyond_range, unknown_of_cosine
from linksweep.physics.double_double import difference, divide, two_sum
from linksweep.physics.planar import cross, dot


def guide_shares(
    crank_length: Number, offset: Number, psi_cos: Number, psi_sin: Number
) -> tuple[Number, Number, Number]:
    """The crank's shares along and across the guide, and the rod's share across."""
    crank_across = crank_length * psi_cos
    return -(crank_length * psi_sin), crank_across, offset - crank_across


def toggle_cosines(crank_length: Number, rod_length: Number, offset: Number) -> tuple[Number, Number, Number, Number]:
    """cos ψ_l and cos ψ_h, each with its rest."""
    low, high = two_sum(offset, -rod_length), two_sum(offset, rod_length)
    return *divide(low, (crank_length, 0.0)), *divide(high, (crank_length, 0.0))


def closure_factors(
    crank_length: Number,
    psi_cos: Number,
    psi_cos_lo: Number,
    low_cos: Number,
    low_cos_lo: Number,
    high_cos: Number,
    high_cos_lo: Number,
) -> tuple[Number, Number]:
    """low and high, as the module's equations write them."""
    cosine = psi_cos, psi_cos_lo
    low = crank_length * difference(cosine, (low_cos, low_cos_lo))
    return low, crank_length * difference((high_cos, high_cos_lo), cosine)


def closure_noise(
    crank_length: Number,
    rod_length: Number,
    offset: Number,
    low_cos: Number,
    low_cos_lo: Number,
    high_cos: Number,
    high_cos_lo: Number,
    psi_sin: Number,
) -> tuple[Number, Number]:
    """What low and high cannot tell from zero."""
    low_miss = difference((low_cos, low_cos_lo), (-1.0, 0.0))
    high_miss = difference((high_cos, high_cos_lo), (1.0, 0.0))
    noise = 2.0**-52 * (crank_length + rod_length + abs(offset)) / crank_length
    crank_beyond = crank_length * beyond_range(crank_length * crank_length)
    beyond = crank_beyond + rod_length * beyond_range(rod_length * rod_length)
    return (
        crank_length * unknown_of_cosine(low_miss, noise, psi_sin) + beyond,
        crank_length * unknown_of_cosine(high_miss, noise, psi_sin) + beyond,
    )


def length_noise(crank_length: Number, rod_length: Number, offset: Number) -> Number:
    """A slider that moves by less per radian of the crank stands: sums of lengths are known to a few last digits."""
    return 0.25 * NOISE * (crank_length + rod_length + abs(offset))


def assembly(crank_length: Number, rod_length: Number, offset: Number) -> Number:
    """0 where it closes at every angle, 1 where at some, 2 where at none."""
    reach = abs(offset) - rod_length
    return where(reach + crank_length < 0.0, 0.0, where(reach - crank_length < 0.0, 1.0, 2.0))


def near_toggle_widths(
    crank_length: Number, rod_length: Number, offset: Number, friction: Number
) -> tuple[Number, Number]:
    """How narrow forces may peak about φ = 90 and −90°: high and low are there x + y·tan², zero at tan = ±i·√(x/y).

    Friction wedges where μ·tan ψ = 1, that is where the rod's share across the guide is b/√(1 + μ²).
    """
    a, b, e = crank_length, rod_length / sqrt(1.0 + friction * friction), offset
    return sqrt((b + e - a) / (b + e + a)), sqrt((b - e - a) / (b - e + a))


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
) -> tuple[Number, Number, Number, Number, Number]:
    """The guide's force on the slider across (normal) and along (friction), and how near it is to wedging (w); then the
    rod's force F43 across and along.

    F43 = F14 + Q4 and r × F43 = moment for the lever r (the rod, or the crank where its torque is known) give,
    without friction, a normal force N0; with it see `linksweep.physics.coulomb`, the slope that of the lever to the
    guide. F43 comes from the lever, not from the guide's force, which may be far larger.
    """
    Q4_along, Q4_across = dot(Q4x, Q4y, guide_cos, guide_sin), cross(guide_cos, guide_sin, Q4x, Q4y)
    slope = lever_across * inverse_lever_along
    lever_force = (lever_moment + lever_across * Q4_along) * inverse_lever_along
    normal, friction, wedging = sliding_contact(lever_force - Q4_across, slope, direction)
    return normal, friction, wedging, lever_force + slope * friction, Q4_along + friction


def from_guide_axes(across: Number, along: Number, guide_cos: Number, guide_sin: Number) -> tuple[Number, Number]:
    """A force in ground axes."""
    return along * guide_cos - across * guide_sin, along * guide_sin + across * guide_cos


def no_cycle_status(status: Number, assembly: Number) -> Number:
    """The status so far, or 5 (no_cycle) where the crank does not turn fully, but a cycle takes whole turns of it."""
    return where(assembly > 0.0, where(status > 0.0, status, 5.0), status)


def inverse_lever(crank_along: Number, crank_length: Number) -> Number:
    """Inverse of the crank's share along the guide; NaN at the dead centres of the driven rod."""
    return 1.0 / crank_driven.away_from_dead_centre(crank_along, crank_along, crank_length, 1.0)


def moment_on_rod(N3: Number) -> Number:
    """r3 × F43 where the rod bears no drive: its moments about B."""
    return -N3


def torque_on_rod(
    N3: Number,
    rod_along: Number,
    rod_across: Number,
    rod_force_along: Number,
    rod_force_across: Number,
    work: Number,
    ratio3: Number,
    rod_length: Number,
    ratio_slider: Number,
) -> Number:
    """T13, from r3 × F43 = −N3 − T13 in the guide's axes while the rod turns slowly, then from virtual work."""
    by_moments = -N3 - cross(rod_along, rod_across, rod_force_along, rod_force_across)
    return crank_driven.slower_or_work(by_moments, work, ratio3, ratio_slider / rod_length)


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
    k = opposing(normal_force, direction)
    return guide_cos - k * guide_sin, guide_sin + k * guide_cos
