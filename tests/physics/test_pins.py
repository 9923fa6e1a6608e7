"""Low words of pins and links against fractions, in which nothing is rounded."""

import random
from fractions import Fraction
from math import cos, hypot, sin

import pytest

from linksweep.physics.closures import pins

ANGLES = [0.0, 1e-9, 1e-5, 0.3, 0.7853981633974483, 1.5707963267948966, 2.0, 3.141592653589793, 5.0]
SMALL = Fraction(1, 2**98)


def exact(*words: float) -> Fraction:
    return sum(map(Fraction, words), Fraction())


def numbers(seed: int, count: int) -> list[float]:
    draw = random.Random(seed)
    return [draw.uniform(-1.0, 1.0) * 10.0 ** draw.randint(-3, 3) for _ in range(count)]


@pytest.mark.parametrize("seed", range(20))
def test_vectors_joined_and_apart(seed):
    px, py, qx, qy = numbers(seed, 4)
    low = [2.0**-53 * x for x in numbers(seed + 100, 4)]
    p, q = (px, py, *low[:2]), (qx, qy, *low[2:])
    for made, sign in ((pins.joined(*p, *q), 1), (pins.apart(*p, *q), -1)):
        for k in range(2):
            truth = exact(p[k], p[k + 2]) + sign * exact(q[k], q[k + 2])
            assert abs(exact(made[k], made[k + 2]) - truth) <= SMALL * 1000
            assert made[k] == p[k] + sign * q[k]
    assert pins.joined_low_words(*p, *q) == pins.joined(*p, *q)[2:]


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("length", [1.0, 0.7, 1.0 - 2.0**-53, 1.9999999999999998])
@pytest.mark.parametrize("stretch", [-8, -1, 0, 1, 8])
def test_excess_of_a_square_by_which_a_vector_misses_its_length(angle, length, stretch):
    """Also along an axis, where its component may be a rounding longer than the length."""
    size = length * (1.0 + stretch * 2.0**-52)
    x, y, x_lo, y_lo, length_lo = size * cos(angle), size * sin(angle), 3e-17, -2e-17, 1e-17
    truth = (exact(length, length_lo) ** 2 - exact(x, x_lo) ** 2 - exact(y, y_lo) ** 2) / 2
    # the squares of low words are left out
    assert abs(exact(pins.excess_square(x, y, x_lo, y_lo, length, length_lo)) - truth) <= SMALL


@pytest.mark.parametrize("seed", range(20))
def test_a_step_closes_a_dyad_to_twice_the_digits(seed):
    """Rounded vectors r3 and r4 from pins B and D, moved by the step, have their lengths, and end in one point."""
    draw = random.Random(seed)
    BD = draw.uniform(0.8, 1.2), draw.uniform(-0.3, 0.3), 2e-17, -3e-17
    r4x, r4y = draw.uniform(-0.5, 0.5), draw.uniform(0.4, 0.9)
    lengths = hypot(r4x + BD[0], r4y + BD[1]), hypot(r4x, r4y)
    r3x, r3y = (r4x + BD[0]) * (1.0 + 2.0**-52), (r4y + BD[1]) * (1.0 - 2.0**-52)
    from_B = pins.joined(r4x, r4y, 0.0, 0.0, *BD)
    missing = (
        pins.excess_square(r4x, r4y, 0.0, 0.0, lengths[1], 0.0),
        pins.excess_square(*from_B, lengths[0], 0.0),
    )
    step = pins.newton_step(*missing, r4x, r4y, r3x, r3y, 1.0 / (r4x * r3y - r4y * r3x))
    low = pins.low_words(r3x, r3y, *from_B, *step)
    r4 = [exact(r4x, step[0]), exact(r4y, step[1])]
    r3 = [exact(r3x, low[0]), exact(r3y, low[1])]
    assert abs(r4[0] ** 2 + r4[1] ** 2 - exact(lengths[1]) ** 2) <= SMALL
    assert abs(r3[0] ** 2 + r3[1] ** 2 - exact(lengths[0]) ** 2) <= SMALL
    for k in range(2):
        assert abs(r3[k] - r4[k] - exact(BD[k], BD[k + 2])) <= SMALL
