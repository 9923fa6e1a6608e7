"""Section forces of a straight link at a distance x from its first pin: axial force N, shear V, bending moment M.

Each is what the part of the link beyond x exerts on the part before it: N along the line of pins, positive in tension,
V across it, positive to its left, M positive counter-clockwise. By d'Alembert a mass dm of that part, at s along the
line and c to its left, adds

    dN = (b_t + ω² s + α c) dm        b = g − a, of the first pin, along and across the line
    dV = (b_n − α s + ω² c) dm        dM = (s − x) dV − c dN

and a force F at (s, c) adds F_t, F_n and (s − x) F_n − c F_t. The link's mass is a uniform shank from pin to pin and
two eyes about the pins, on one line through the centre of gravity, at c. The first pin's eye lies beyond no section.

Source: S. P. Timoshenko, Strength of Materials, part I; its fibres are those of a straight beam.
"""

from linksweep.physics.algebra.arithmetic import Number, where
from linksweep.physics.algebra.planar import cross, dot

Forces = tuple[Number, Number, Number]


def position(section: Number, start: Number, end: Number) -> Number:
    """Return the distance x of a section from the first pin; both ends are exact."""
    return (1.0 - section) * start + section * end


def in_shank(x: Number, length: Number) -> Number:
    """Return x, moved to the nearer end of the shank where it lies beyond."""
    return where(x < 0.0, 0.0, where(length < x, length, x))


def body_force(
    gravity_x: Number, gravity_y: Number, pin_ax: Number, pin_ay: Number, length: Number, rx: Number, ry: Number
) -> tuple[Number, Number]:
    """Return b = g − a of the first pin, along and across the line of pins r, |r| = length."""
    bx, by = gravity_x - pin_ax, gravity_y - pin_ay
    return dot(bx, by, rx, ry) / length, cross(rx, ry, bx, by) / length


def shank_beyond(
    x: Number,
    near: Number,
    length: Number,
    mass: Number,
    spin: Number,
    c: Number,
    b_along: Number,
    b_across: Number,
    omega: Number,
    alpha: Number,
) -> Forces:
    """Return what weight and inertia of the shank beyond x exert there.

    `near` is where that part begins, `mass` that of the whole shank, and `spin` its moment of inertia about its own
    line, which is spread evenly.
    """
    share = (length - near) / length
    beyond = mass * share
    first, second = 0.5 * beyond * (length + near), beyond * (length * (length + near) + near * near) / 3.0
    axial, shear, moment = _inertia_beyond(x, beyond, first, second, c, b_along, b_across, omega, alpha)
    return axial, shear, moment - spin * share * alpha


def eye_beyond(
    x: Number,
    length: Number,
    mass: Number,
    moment: Number,
    inertia: Number,
    c: Number,
    b_along: Number,
    b_across: Number,
    omega: Number,
    alpha: Number,
) -> Forces:
    """Return what weight and inertia of the eye about the second pin exert at x.

    `moment` is its first moment beyond that pin, `inertia` its moment of inertia about it.
    """
    first = mass * length + moment
    second = first * length + moment * length + inertia
    return _inertia_beyond(x, mass, first, second, c, b_along, b_across, omega, alpha)


def _inertia_beyond(
    x: Number,
    mass: Number,
    first: Number,
    second: Number,
    c: Number,
    b_along: Number,
    b_across: Number,
    omega: Number,
    alpha: Number,
) -> Forces:
    """Return the module's integrals over a mass, of which the first and second moments about the first pin, ∫ s dm and
    ∫ s² dm, are `first` and `second`."""
    centripetal = omega * omega
    axial = mass * (b_along + alpha * c) + centripetal * first
    shear = mass * (b_across + centripetal * c) - alpha * first
    across_moment = (first - x * mass) * (b_across + centripetal * c) - alpha * (second - x * first)
    return axial, shear, across_moment - c * axial


def force_at(x: Number, s: Number, c: Number, along: Number, across: Number, torque: Number) -> Forces:
    """Return what a force and a torque at (s, c) exert at a section before them."""
    return along, across, (s - x) * across - c * along + torque


def force_beyond(
    x: Number, start: Number, s: Number, c: Number, along: Number, across: Number, torque: Number
) -> Forces:
    """Return what a force and a torque at (s, c) exert at x: nothing before s, nor at the link's own start."""
    exerted = force_at(x, s, c, along, across, torque)
    axial, shear, moment = (where(s < x, 0.0, where(start < s, part, 0.0)) for part in exerted)
    return axial, shear, moment


def fibre_stresses(axial: Number, moment: Number, area: Number, modulus: Number) -> tuple[Number, Number, Number]:
    """Return the stress of the extreme fibres on the left and on the right of the line of pins, and the larger size.

    σ = N/A ∓ M/W, positive in tension.
    """
    direct, bending = axial / area, moment / modulus
    return direct - bending, direct + bending, abs(direct) + abs(bending)
