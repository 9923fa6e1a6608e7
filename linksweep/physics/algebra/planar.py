"""Vectors in the plane: the cross product p × q = px·qy − py·qx, the left normal (−py, px) of p, and rotation."""

from linksweep.physics.algebra.arithmetic import Number, atan2, degrees, sqrt


def cross(px: Number, py: Number, qx: Number, qy: Number) -> Number:
    return px * qy - py * qx


def dot(px: Number, py: Number, qx: Number, qy: Number) -> Number:
    return px * qx + py * qy


def square(px: Number, py: Number) -> Number:
    return px * px + py * py


def root(squared: Number) -> Number:
    return sqrt(squared)


def opposite(x: Number) -> Number:
    return -x


def product(x: Number, y: Number) -> Number:
    return x * y


def identity(x: Number) -> Number:
    return x


def vector_sum(px: Number, py: Number, qx: Number, qy: Number) -> tuple[Number, Number]:
    return px + qx, py + qy


def difference(px: Number, py: Number, qx: Number, qy: Number) -> tuple[Number, Number]:
    return px - qx, py - qy


def along(length: Number, cos: Number, sin: Number) -> tuple[Number, Number]:
    """Return the vector of this length in the direction (cos, sin)."""
    return length * cos, length * sin


def direction(x: Number, y: Number) -> Number:
    """Return the angle of a vector [degree], in (−180, 180]."""
    return degrees(atan2(y, x))


def to_ground_axes(x: Number, y: Number, length: Number, rx: Number, ry: Number) -> tuple[Number, Number]:
    """Return in ground axes a vector whose components are in the axes of a link with line of pins r, |r| = length."""
    along, across = x / length, y / length
    return along * rx - across * ry, along * ry + across * rx


def moment_about(moment: Number, x: Number, y: Number, Fx: Number, Fy: Number) -> Number:
    """Return a moment about the point (x, y), from the moment about the origin and the force."""
    return moment - cross(x, y, Fx, Fy)


def point_velocity(pin_vx: Number, pin_vy: Number, omega: Number, x: Number, y: Number) -> tuple[Number, Number]:
    """Return the velocity of a link's point at (x, y) from its pin: v_pin + ω × r."""
    return pin_vx - omega * y, pin_vy + omega * x


def point_acceleration(
    pin_ax: Number, pin_ay: Number, omega: Number, alpha: Number, x: Number, y: Number
) -> tuple[Number, Number]:
    """Return the acceleration of a link's point at (x, y) from its pin: a_pin + α × r − ω² r."""
    centripetal = omega * omega
    return pin_ax - alpha * y - centripetal * x, pin_ay + alpha * x - centripetal * y
