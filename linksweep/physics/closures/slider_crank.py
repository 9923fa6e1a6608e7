"""The slider-crank A-B-C: crank r2 = A→B of length a, rod r3 = B→C of length b, slider on a guide offset by e.

With ψ the angle of the crank from the guide's left normal, the rod's component across the guide is h = e − a·cos ψ, so

    low  = b − h = a(cos ψ − cos ψ_l),    cos ψ_l = (e − b)/a
    high = b + h = a(cos ψ_h − cos ψ),    cos ψ_h = (e + b)/a

It closes while both are positive: at every angle if a + |e| < b. Only the differences of cosines cancel, so the cosines
are kept in double-double.
"""

from linksweep.physics import crank_driven
from linksweep.physics.algebra.arithmetic import NOISE, Number, sqrt, where
from linksweep.physics.algebra.double_double import difference, divide, two_sum
from linksweep.physics.algebra.planar import cross, dot
from linksweep.physics.closures.crank_angle import cosine_noise, range_noise
from linksweep.physics.coulomb import opposing, sliding_contact


def guide_components(
    crank_length: Number, offset: Number, psi_cos: Number, psi_cos_lo: Number, psi_sin: Number
) -> tuple[Number, Number, Number]:
    """Return the crank's components along and across the guide, and the rod's component across: where the rod is far
    shorter than the crank, that keeps its digits, as its sum takes the exact product (`engine.trace.contraction`)."""
    crank_across = crank_length * psi_cos
    return -(crank_length * psi_sin), crank_across, (offset - crank_across) - crank_length * psi_cos_lo


def toggle_cosines(crank_length: Number, rod_length: Number, offset: Number) -> tuple[Number, Number, Number, Number]:
    """Return cos ψ_l and cos ψ_h, each as a double-double."""
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
    """Return low and high of the module's equations."""
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
    """Return the noise floors of low and high, below which they may be zero."""
    low_miss = difference((low_cos, low_cos_lo), (-1.0, 0.0))
    high_miss = difference((high_cos, high_cos_lo), (1.0, 0.0))
    noise = 2.0**-52 * (crank_length + rod_length + abs(offset)) / crank_length
    crank_beyond = crank_length * range_noise(crank_length * crank_length)
    beyond = crank_beyond + rod_length * range_noise(rod_length * rod_length)
    return (
        crank_length * cosine_noise(low_miss, noise, psi_sin) + beyond,
        crank_length * cosine_noise(high_miss, noise, psi_sin) + beyond,
    )


def length_noise(crank_length: Number, rod_length: Number, offset: Number) -> Number:
    """Return the speed per radian of the crank below which a slider stands still: rounding of sums of lengths."""
    return 0.25 * NOISE * (crank_length + rod_length + abs(offset))


def assembly(crank_length: Number, rod_length: Number, offset: Number) -> Number:
    """Return 0 where it closes at every angle, 1 where at some, 2 where at none."""
    reach = abs(offset) - rod_length
    return where(reach + crank_length < 0.0, 0.0, where(reach - crank_length < 0.0, 1.0, 2.0))


def near_toggle_widths(
    crank_length: Number, rod_length: Number, offset: Number, friction: Number
) -> tuple[Number, Number]:
    """Return the half-widths, as tan(angle/2), of the narrowest peaks that forces may have about φ = 90 and −90°, φ the
    crank's angle from the guide.

    High and low are there x + y·tan², zero at tan = ±i·√(x/y): the width is √(x/y). Friction wedges where μ times the
    slope of the rod against the guide is 1, that is where the rod's component across the guide is b/√(1 + μ²).
    """
    a, b, e = crank_length, rod_length / sqrt(1.0 + friction * friction), offset
    return sqrt((b + e - a) / (b + e + a)), sqrt((b - e - a) / (b - e + a))


def slider_position(crank_along: Number, rod_along: Number) -> Number:
    """Return the position of C along the guide, from the foot of the perpendicular from A."""
    return crank_along + rod_along


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
    """Return the guide's force on the slider across (normal) and along (friction), the wedging w; then F43 along and
    across.

    F43 = F14 + Q4 and r × F43 = moment, with the lever r the rod, or the crank where its torque is known, give the
    normal force N0 without friction; with friction see `linksweep.physics.coulomb`, where the slope is the lever's
    against the guide. F43 is computed from the lever, not from the guide's force, which may be far larger.
    """
    Q4_along, Q4_across = dot(Q4x, Q4y, guide_cos, guide_sin), cross(guide_cos, guide_sin, Q4x, Q4y)
    slope = lever_across * inverse_lever_along
    lever_force = (lever_moment + lever_across * Q4_along) * inverse_lever_along
    normal, friction, wedging = sliding_contact(lever_force - Q4_across, slope, direction)
    return normal, friction, wedging, lever_force + slope * friction, Q4_along + friction


def guide_force_from_friction(
    inverse_rod_along: Number,
    rod_across: Number,
    moment_r3: Number,
    Q4x: Number,
    Q4y: Number,
    guide_cos: Number,
    guide_sin: Number,
    friction_force: Number,
) -> tuple[Number, Number, Number]:
    """Return the guide's normal force on the slider, then F43 across and along, where the friction is known."""
    Q4_along, Q4_across = dot(Q4x, Q4y, guide_cos, guide_sin), cross(guide_cos, guide_sin, Q4x, Q4y)
    along = Q4_along + friction_force
    across = (moment_r3 + rod_across * along) * inverse_rod_along
    return across - Q4_across, across, along


def from_guide_axes(across: Number, along: Number, guide_cos: Number, guide_sin: Number) -> tuple[Number, Number]:
    """Return in ground axes a force with these components across and along the guide."""
    return along * guide_cos - across * guide_sin, along * guide_sin + across * guide_cos


def no_cycle_status(status: Number, assembly: Number) -> Number:
    """Return `status`, or, where it is 0 and the crank does not turn fully, 5 (no_cycle): a gas cycle needs whole
    turns."""
    return where(assembly > 0.0, where(status > 0.0, status, 5.0), status)


def inverse_lever(crank_along: Number, crank_length: Number) -> Number:
    """Return the inverse of the crank's component along the guide; NaN at the dead centres of the driven rod."""
    return 1.0 / crank_driven.away_from_dead_centre(crank_along, crank_along, crank_length, 1.0)


def moment_on_rod(N3: Number) -> Number:
    """Return r3 × F43 where the rod has no drive: its moments about B."""
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
    """Return T13, from r3 × F43 = −N3 − T13 in the guide's axes while the rod turns slowly, then from virtual work."""
    by_moments = -N3 - cross(rod_along, rod_across, rod_force_along, rod_force_across)
    return crank_driven.moments_or_work(by_moments, work, ratio3, ratio_slider / rod_length)


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
    """Return the virtual work of loads, weights, inertia forces and friction per radian of the crank."""
    push = dot(Q4x, Q4y, guide_cos, guide_sin) + friction_force
    return N2 + cross(r2x, r2y, Q3x, Q3y) + ratio3 * N3 + ratio_slider * push


def friction_row(
    normal_force: Number, direction: Number, guide_cos: Number, guide_sin: Number
) -> tuple[Number, Number]:
    """Return the coefficients of F14x and F14y in the friction row: component along + μ·sign(v)·sign(N)·component
    across = 0."""
    k = opposing(normal_force, direction)
    return guide_cos - k * guide_sin, guide_sin + k * guide_cos
