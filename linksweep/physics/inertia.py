"""Newton's and Euler's equations for one link, about its first pin, in d'Alembert's form.

A link has mass m, first moment h = m·r_G (pin → centre of gravity) and moment of inertia J = I + m|r_G|² about its
first pin. That pin accelerates by a, and an external load acts: force P and moment M about the pin. The link then
exerts on its pins

    Q = m(g − a) − α × h + ω² h + P          (effective force)
    N = h × (g − a) − J α + M                (effective moment about the first pin)

so that the pin forces on the link add up to −Q, and their moments about the first pin (with any drive torque) to −N.
"""

from linksweep.physics.algebra.arithmetic import Number
from linksweep.physics.algebra.planar import cross, dot


def moment_of_inertia_about_pin(mass: Number, inertia: Number, cg_x: Number, cg_y: Number) -> Number:
    """Return J = I + m|r_G|² (Steiner)."""
    return inertia + mass * (cg_x * cg_x + cg_y * cg_y)


def first_moment(
    mass: Number, cg_x: Number, cg_y: Number, length: Number, rx: Number, ry: Number
) -> tuple[Number, Number]:
    """Return h = m·r_G in ground axes, for a link whose line of pins is r, |r| = length."""
    along, across = mass * cg_x / length, mass * cg_y / length
    return along * rx - across * ry, along * ry + across * rx


def effective_force(
    mass: Number,
    hx: Number,
    hy: Number,
    pin_ax: Number,
    pin_ay: Number,
    gravity_x: Number,
    gravity_y: Number,
    omega: Number,
    alpha: Number,
    Px: Number,
    Py: Number,
) -> tuple[Number, Number]:
    """Return Q of the module's equations."""
    centripetal = omega * omega
    return (
        mass * (gravity_x - pin_ax) + alpha * hy + centripetal * hx + Px,
        mass * (gravity_y - pin_ay) - alpha * hx + centripetal * hy + Py,
    )


def steady_effective_force(
    mass: Number,
    cg_x: Number,
    cg_y: Number,
    length: Number,
    rx: Number,
    ry: Number,
    gravity_x: Number,
    gravity_y: Number,
    omega: Number,
    alpha: Number,
    Px: Number,
    Py: Number,
) -> tuple[Number, Number]:
    """Return Q of a link whose first pin is fixed: its inertia is one rotating vector, cheap where its rates are
    constant."""
    h_along, h_across, centripetal = mass * cg_x / length, mass * cg_y / length, omega * omega
    along = centripetal * h_along + alpha * h_across
    across = centripetal * h_across - alpha * h_along
    return (
        mass * gravity_x + along * rx - across * ry + Px,
        mass * gravity_y + along * ry + across * rx + Py,
    )


def steady_effective_moment(
    J: Number,
    mass: Number,
    cg_x: Number,
    cg_y: Number,
    length: Number,
    rx: Number,
    ry: Number,
    gravity_x: Number,
    gravity_y: Number,
    alpha: Number,
    M: Number,
) -> Number:
    """Return N of a link whose first pin is fixed."""
    h_along, h_across = mass * cg_x / length, mass * cg_y / length
    lever_x = h_along * gravity_y - h_across * gravity_x
    lever_y = h_along * gravity_x + h_across * gravity_y
    return lever_x * rx - lever_y * ry - J * alpha + M


def effective_moment(
    J: Number,
    hx: Number,
    hy: Number,
    pin_ax: Number,
    pin_ay: Number,
    gravity_x: Number,
    gravity_y: Number,
    alpha: Number,
    M: Number,
) -> Number:
    """Return N of the module's equations."""
    return cross(hx, hy, gravity_x - pin_ax, gravity_y - pin_ay) - J * alpha + M


def inertia_power(
    mass: Number, inertia: Number, vGx: Number, vGy: Number, aGx: Number, aGy: Number, omega: Number, alpha: Number
) -> Number:
    """Return the power of a link's inertia forces, −(m a_G·v_G + I α ω): minus the rate of its kinetic energy."""
    return -(mass * dot(aGx, aGy, vGx, vGy) + inertia * (alpha * omega))


def gravity_power(mass: Number, gravity_x: Number, gravity_y: Number, vGx: Number, vGy: Number) -> Number:
    return mass * dot(gravity_x, gravity_y, vGx, vGy)


def power_size(
    mass: Number,
    inertia: Number,
    pin_vx: Number,
    pin_vy: Number,
    pin_ax: Number,
    pin_ay: Number,
    omega: Number,
    alpha: Number,
    rGx: Number,
    rGy: Number,
    gravity_x: Number,
    gravity_y: Number,
    Px: Number,
    Py: Number,
    M: Number,
) -> Number:
    """Return the sum of the magnitudes of all terms in the powers of a link's inertia, weight and loads, split into the
    motion of its first pin and its rotation about it."""
    x, y, centripetal = abs(rGx), abs(rGy), omega * omega
    along_x = (abs(pin_vx) + abs(omega) * y) * (abs(gravity_x) + abs(pin_ax) + abs(alpha) * y + centripetal * x)
    along_y = (abs(pin_vy) + abs(omega) * x) * (abs(gravity_y) + abs(pin_ay) + abs(alpha) * x + centripetal * y)
    load_terms = abs(Px * pin_vx) + abs(Py * pin_vy) + abs(M * omega)
    return mass * (along_x + along_y) + inertia * abs(alpha * omega) + load_terms


def newton_euler_right_side(
    mass: Number,
    inertia: Number,
    aGx: Number,
    aGy: Number,
    alpha: Number,
    gravity_x: Number,
    gravity_y: Number,
    rGx: Number,
    rGy: Number,
    Px: Number,
    Py: Number,
    M: Number,
) -> tuple[Number, Number, Number]:
    """Return the right sides of ΣF = m a_G and ΣM_G = I α, weight and loads moved over (document 2, with gravity)."""
    return (
        mass * (aGx - gravity_x) - Px,
        mass * (aGy - gravity_y) - Py,
        inertia * alpha - (M - cross(rGx, rGy, Px, Py)),
    )
