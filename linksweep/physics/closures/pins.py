"""Pins of a chain of links as double-doubles, so that a dyad near its toggle keeps its digits wherever it stands.

The high words are plain sums of link vectors. Low words are what these sums miss: of a pin on a link whose direction is
known, from the same sum in double-double; of a pin that a dyad finds, by one Newton step on the residuals of its two
conditions, evaluated in double-double.

A link is placed by one vector s of it in ground axes, whose components in the link's own axes are d. Another vector v
of the link then lies at (v/d)·s, vectors taken as complex numbers.
"""

from linksweep.physics.algebra.arithmetic import Number, sqrt, sum_low
from linksweep.physics.algebra.double_double import (
    Pair,
    add,
    difference,
    divide,
    dot,
    multiply,
    ordered_sum,
    overlapping_dot,
    two_product,
    two_sum,
)

Four = tuple[Number, Number, Number, Number]
"""A vector: x, y, and their low words."""


def crank_pin_low_words(
    crank_length: Number, cos2: Number, cos2_lo: Number, sin2: Number, sin2_lo: Number
) -> tuple[Number, Number]:
    """Return the low words of the crank pin, whose high words are the crank's length times cosine and sine."""
    (_, x_lo), (_, y_lo) = two_product(crank_length, cos2), two_product(crank_length, sin2)
    return x_lo + crank_length * cos2_lo, y_lo + crank_length * sin2_lo


def quotient(
    vx: Number, vy: Number, vx_lo: Number, vy_lo: Number, dx: Number, dy: Number, dx_lo: Number, dy_lo: Number
) -> Four:
    """Return v/d of the module's equation."""
    v, d = ((vx, vx_lo), (vy, vy_lo)), ((dx, dx_lo), (dy, dy_lo))
    square = dot(*d, *d)
    x, y = divide(dot(*v, *d), square), divide(_cross(*d, *v), square)
    return x[0], y[0], x[1], y[1]


def turned(kx: Number, ky: Number, sx: Number, sy: Number) -> tuple[Number, Number]:
    """Return k·s of two vectors taken as complex numbers."""
    return kx * sx - ky * sy, kx * sy + ky * sx


def turned_with_low_words(
    kx: Number, ky: Number, kx_lo: Number, ky_lo: Number, sx: Number, sy: Number, sx_lo: Number, sy_lo: Number
) -> Four:
    """Return k·s as double-doubles."""
    k, s = ((kx, kx_lo), (ky, ky_lo)), ((sx, sx_lo), (sy, sy_lo))
    x, y = overlapping_dot(*k, s[0], _opposite(s[1])), overlapping_dot(*k, s[1], s[0])
    return x[0], y[0], x[1], y[1]


def joined(
    px: Number, py: Number, px_lo: Number, py_lo: Number, rx: Number, ry: Number, rx_lo: Number, ry_lo: Number
) -> Four:
    """Return p + r as sums of two words, of which the low ones may reach into the high ones."""
    return px + rx, py + ry, *joined_low_words(px, py, px_lo, py_lo, rx, ry, rx_lo, ry_lo)


def joined_low_words(
    px: Number, py: Number, px_lo: Number, py_lo: Number, rx: Number, ry: Number, rx_lo: Number, ry_lo: Number
) -> tuple[Number, Number]:
    """Return the low words of p + r, whose high words are the rounded sums of their high words."""
    return sum_low(px, rx) + (px_lo + rx_lo), sum_low(py, ry) + (py_lo + ry_lo)


def link_low_words(
    px: Number, py: Number, px_lo: Number, py_lo: Number, rx: Number, ry: Number
) -> tuple[Number, Number]:
    """Return what r misses of the vector from p to the rounded sum of p's high words and r."""
    return -(sum_low(px, rx) + px_lo), -(sum_low(py, ry) + py_lo)


def vector_low_words(
    qx: Number, qy: Number, px: Number, py: Number, px_lo: Number, py_lo: Number, rx: Number, ry: Number
) -> tuple[Number, Number]:
    """Return what r, which differs by roundings of p and q, misses of the vector from p to (qx, qy)."""
    (x, x_lo), (y, y_lo) = two_sum(qx, -px), two_sum(qy, -py)
    return (x - rx) + (x_lo - px_lo), (y - ry) + (y_lo - py_lo)


def apart(
    qx: Number, qy: Number, qx_lo: Number, qy_lo: Number, px: Number, py: Number, px_lo: Number, py_lo: Number
) -> Four:
    """Return the vector from p to q likewise."""
    return joined(qx, qy, qx_lo, qy_lo, -px, -py, -px_lo, -py_lo)


def low_words(
    x: Number, y: Number, vx: Number, vy: Number, vx_lo: Number, vy_lo: Number, step_x: Number, step_y: Number
) -> tuple[Number, Number]:
    """Return what (x, y), a rounding or two away, misses of v, moved by a step."""
    return (vx - x) + (vx_lo + step_x), (vy - y) + (vy_lo + step_y)


def between(
    qx: Number, qy: Number, qx_lo: Number, qy_lo: Number, px: Number, py: Number, px_lo: Number, py_lo: Number
) -> Four:
    """Return the vector from p to q."""
    x, y = add((qx, qx_lo), (-px, -px_lo)), add((qy, qy_lo), (-py, -py_lo))
    return x[0], y[0], x[1], y[1]


def distance(x: Number, y: Number, x_lo: Number, y_lo: Number) -> Pair:
    """Return the length of a vector as a double-double."""
    square = dot((x, x_lo), (y, y_lo), (x, x_lo), (y, y_lo))
    root = sqrt(square[0])
    return root, 0.5 * (difference(square, two_product(root, root)) / root)


def excess_square(x: Number, y: Number, x_lo: Number, y_lo: Number, length: Number, length_lo: Number) -> Number:
    """Return half of length² − |(x, y)|², for a vector whose length is this but for some roundings.

    Its components are then no longer, and where the first one's square is taken off, the second one's is what remains.
    """
    (xx, xx_lo), (yy, yy_lo) = two_product(x, x), two_product(y, y)
    size, size_lo = multiply((length, length_lo), (length, length_lo))
    rest, rest_lo = ordered_sum(size, -xx)
    return 0.5 * ((rest - yy) + (rest_lo + (size_lo - (xx_lo + yy_lo)))) - (x * x_lo + y * y_lo)


def excess_component(
    x: Number,
    y: Number,
    x_lo: Number,
    y_lo: Number,
    line_x: Number,
    line_y: Number,
    line_x_lo: Number,
    line_y_lo: Number,
    offset: Number,
    offset_lo: Number,
) -> Number:
    """Return by how much the component of (x, y) across a line falls short of the offset."""
    return sum(offset_from(offset, offset_lo, line_x, line_y, line_x_lo, line_y_lo, x, y, x_lo, y_lo))


def offset_from(
    offset: Number,
    offset_lo: Number,
    line_x: Number,
    line_y: Number,
    line_x_lo: Number,
    line_y_lo: Number,
    x: Number,
    y: Number,
    x_lo: Number,
    y_lo: Number,
) -> Pair:
    """Return the offset of a line from the point (x, y), from its offset from the origin."""
    across = _cross((line_x, line_x_lo), (line_y, line_y_lo), (x, x_lo), (y, y_lo))
    return add((offset, offset_lo), _opposite(across))


def newton_step(
    first_missing: Number,
    second_missing: Number,
    first_x: Number,
    first_y: Number,
    second_x: Number,
    second_y: Number,
    inverse: Number,
) -> tuple[Number, Number]:
    """Return the step whose components along two vectors, times their lengths, are these numbers; `inverse` is that of
    their cross product."""
    a, b = first_missing * inverse, second_missing * inverse
    return a * second_y - b * first_y, b * first_x - a * second_x


def _opposite(p: Pair) -> Pair:
    return -p[0], -p[1]


def _cross(px: Pair, py: Pair, qx: Pair, qy: Pair) -> Pair:
    return dot(px, py, qy, _opposite(qx))
