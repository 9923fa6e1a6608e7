"""Vectors in the plane: the cross product p × q = px·qy − py·qx, the left normal of p, (−py, px), and turning."""

from linksweep.physics.arithmetic import Number, atan2, degrees, sqrt


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


def same(x: Number) -> Number:
    return x


def vector_sum(px: Number, py: Number, qx: Number, qy: Number) -> tuple[Number, Number]:
    return px + qx, py + qy


def difference(px: Number, py: Number, qx: Number, qy: Number) -> tuple[Number, Number]:
    return px - qx, py - qy


def along(length: Number, cos: Number, sin: Number) -> tuple[Number, Number]:
    """A vector of this length in the direction (cos, sin)."""
    return length * cos, length * sin


def direction(x: Number, y: Number) -> Number:
    """Angle of a vector [degree], in (−180, 180]."""
    return degrees(atan2(y, x))


def turned(x: Number, y: Number, length: Number, rx: Number, ry: Number) -> tuple[Number, Number]:
    """A vector given in the axes of a link whose line of pins is r, |r| = length, in ground axes."""
    along, across = x / length, y / length
    return along * rx - across * ry, along * ry + across * rx


def point_velocity(pin_vx: Number, pin_vy: Number, omega: Number, x: Number, y: Number) -> tuple[Number, Number]:
    """Velocity of a link's point at (x, y) from its pin: v_pin + ω × r."""
    return pin_vx - omega * y, pin_vy + omega * x


def point_acceleration(
    pin_ax: Number, pin_ay: Number, omega: Number, alpha: Number, x: Number, y: Number
) -> tuple[Number, Number]:
    """Acceleration of a link's point at (x, y) from its pin: a_pin + α × r − ω² r."""
    centripetal = omega * omega
    return pin_ax - alpha * y - centripetal * x, pin_ay + alpha * x - centripetal * y
