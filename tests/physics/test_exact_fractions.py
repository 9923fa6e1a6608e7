"""The physics functions on fractions, where nothing is rounded: equal to the last digit to the textbook's formulas.

On Pythagorean mechanisms all cosines and lengths are rational, and so are all results. Whatever tricks the functions
play to keep digits, in exact arithmetic they must be identities.
"""

from fractions import Fraction
from math import isqrt

import pytest

import linksweep as ls
from benchmarks.stress.decimals import Vector
from benchmarks.stress.machines import four_bar, inverted_slider_crank, slider_crank
from linksweep.engine.quantity import Row

FORCES = tuple(f"{pin}{axis}" for pin in ("F12", "F32", "F43", "F14") for axis in "xy")


class Exact:
    """A fraction among the operations that physics may use; its floats are taken as the fractions they are."""

    def __init__(self, value):
        self.value = value.value if isinstance(value, Exact) else Fraction(value)

    def __add__(self, other):
        return Exact(self.value + Exact(other).value)

    def __sub__(self, other):
        return Exact(self.value - Exact(other).value)

    def __rsub__(self, other):
        return Exact(other) - self

    def __mul__(self, other):
        return Exact(self.value * Exact(other).value)

    def __truediv__(self, other):
        return Exact(self.value / Exact(other).value)

    def __rtruediv__(self, other):
        return Exact(other) / self

    __radd__, __rmul__ = __add__, __mul__

    def __neg__(self):
        return Exact(-self.value)

    def __abs__(self):
        return Exact(abs(self.value))

    def __lt__(self, other):
        return self.value < Exact(other).value

    def __gt__(self, other):
        return self.value > Exact(other).value

    def __eq__(self, other):
        return self.value == Exact(other).value

    __hash__ = None

    def sqrt(self):
        """Only of squares."""
        top, bottom = isqrt(self.value.numerator), isqrt(self.value.denominator)
        assert Fraction(top, bottom) ** 2 == self.value, "not a Pythagorean mechanism"
        return Exact(Fraction(top, bottom))


def turn(p: int, q: int) -> Vector:
    """The unit vector at twice the angle of (q, p): cosine and sine are rational."""
    square = Fraction(p * p + q * q)
    return Vector(Exact((q * q - p * p) / square), Exact(2 * p * q / square))


def numbers(**fractions) -> dict:
    return {name: value if isinstance(value, Vector) else Exact(value) for name, value in fractions.items()}


def link(role: str, length, mass, inertia, distance, cg: Vector) -> dict:
    result = numbers(**{f"{role}_length": length, f"{role}_mass": mass, f"{role}_inertia": inertia})
    return result | {f"{role}_cg_distance": Exact(distance), f"{role}_cg_angle": cg}


COMMON = numbers(omega2=Fraction(-7, 3), alpha2=Fraction(11, 5)) | {
    "gravity": Vector(Exact(Fraction(1, 3)), Exact(Fraction(-981, 100)))
}
STRAIGHT = turn(0, 1)


def four_bars():
    """Crank, coupler and rocker in rational directions; the rocker's length makes the ground lie along x."""
    for crank, coupler, rocker, a, b in (
        (turn(1, 2), turn(1, 5), turn(3, 4), 2, 5),
        (turn(2, 3), turn(-1, 6), turn(5, 4), Fraction(3, 2), 4),
        (turn(-3, 5), turn(1, 3), turn(2, 5), 1, 6),
        (turn(4, 1), turn(1, 3), turn(1, 1), 3, Fraction(23, 2)),
    ):
        a, b = Exact(a), Exact(b)
        c = (a * crank.y + b * coupler.y) / rocker.y
        d = a * crank.x + b * coupler.x - c * rocker.x
        assert c > 0 and d > 0
        r3 = Vector(b * coupler.x, b * coupler.y)
        side = 1 if Vector(d - a * crank.x, -(a * crank.y)).cross(r3) > 0 else -1
        lengths = link("crank", a, 2, Fraction(1, 7), Fraction(1, 3), turn(1, 4))
        lengths |= link("coupler", b, 3, Fraction(2, 9), Fraction(5, 4), turn(-2, 7))
        lengths |= link("rocker", c, Fraction(5, 2), Fraction(4, 3), Fraction(3, 5), turn(5, 2))
        yield lengths | COMMON | {"theta2": crank, "ground": d, "ground_angle": STRAIGHT, "side": side}


def slider_cranks():
    """Crank and rod in rational directions; the rod's length brings its end to the guide."""
    for crank, rod, a, e, friction in (
        (turn(1, 2), turn(-1, 5), 1, Fraction(-1, 5), 0),
        (turn(3, 4), turn(-1, 3), Fraction(1, 2), 0, Fraction(1, 10)),
        (turn(-2, 3), turn(1, 4), 2, Fraction(1, 3), Fraction(2, 10)),
        (turn(5, 2), turn(6, 1), 1, Fraction(3, 2), Fraction(1, 10)),
    ):
        a, e = Exact(a), Exact(e)
        b = (e - a * crank.y) / rod.y
        assert b > 0
        lengths = link("crank", a, 2, Fraction(1, 7), Fraction(1, 3), turn(1, 4))
        lengths |= link("rod", b, 3, Fraction(2, 9), Fraction(5, 4), turn(-2, 7))
        lengths |= numbers(offset=e, friction=friction, slider_mass=Fraction(7, 4))
        still = {"slider_force": Vector(Exact(0), Exact(0)), "slide_angle": STRAIGHT}
        yield lengths | COMMON | still | {"theta2": crank, "side": 1 if rod.x > 0 else -1}


def inverted_slider_cranks():
    """Crank and line in rational directions; slide and ground follow."""
    for crank, line, a, e in (
        (turn(1, 2), turn(3, 4), 1, Fraction(1, 6)),
        (turn(2, 3), turn(5, 3), 2, Fraction(-1, 4)),
        (turn(-1, 3), turn(2, 7), 1, 0),
    ):
        a, e = Exact(a), Exact(e)
        slide = (a * crank.y - e * line.x) / line.y
        d = a * crank.x - (slide * line.x - e * line.y)
        assert d > 0
        lengths = link("crank", a, 2, Fraction(1, 7), Fraction(1, 3), turn(1, 4))
        lengths |= link("rocker", 2, 3, Fraction(2, 9), Fraction(5, 4), turn(-2, 7))
        lengths |= numbers(ground=d, offset=e, block_mass=Fraction(7, 4), block_inertia=Fraction(1, 8))
        yield lengths | COMMON | {"theta2": crank, "ground_angle": STRAIGHT, "side": 1 if slide > 0 else -1}


class Rows:
    """Evaluate a mechanism's rows, followed back from the requested names to the inputs."""

    def __init__(self, table, known: dict):
        self.table, self.known = table, known

    def __getitem__(self, name):
        if isinstance(name, float):
            return Exact(name)
        if name not in self.known:
            row = self.table.maker[name]
            made = row.function(*(self[x] for x in row.wiring))
            several = isinstance(row, Row) and len(row.outputs) > 1
            self.known |= dict(zip(row.outputs, made if several else (made,), strict=True))
        return self.known[name]


def wired(x: dict, mechanism) -> dict:
    """Return the numbers by the argument names of the physics functions."""
    result = {name: value for name, value in x.items() if isinstance(value, Exact)}
    for role in ("crank", "coupler", "rod", "rocker"):
        if f"{role}_length" in x:
            cg, distance = x[f"{role}_cg_angle"], x[f"{role}_cg_distance"]
            result |= {f"{role}_cg_x": cg.x * distance, f"{role}_cg_y": cg.y * distance}
    result |= {"cos2": x["theta2"].x, "sin2": x["theta2"].y, "gravity_x": x["gravity"].x, "gravity_y": x["gravity"].y}
    result |= {"ground_length": x["ground"]} if "ground" in x else {}
    parameters = {name: Exact(number) for name, number in mechanism.parameters().items() if name not in result}
    rests = dict.fromkeys(("cos2_lo", "sin2_lo"), Exact(0))
    return parameters | rests | result | {"branch_sign": Exact(x["side"])}


LINK = ls.Link(1.0, 1.0, 1.0)
MACHINES = {
    "four-bar": (four_bars, four_bar, ls.FourBar(LINK, LINK, LINK, 1.0)),
    "slider-crank": (slider_cranks, slider_crank, ls.SliderCrank(LINK, LINK, 1.0)),
    "inverted slider-crank": (
        inverted_slider_cranks,
        inverted_slider_crank,
        ls.InvertedSliderCrank(LINK, LINK, 1.0, 1.0),
    ),
}
CASES = [
    *(("four-bar", drive) for drive in ("crank", "coupler", "rocker")),
    *(("slider-crank", drive) for drive in ("crank", "coupler")),
    ("inverted slider-crank", "crank"),
]


@pytest.mark.parametrize(("machine", "drive"), CASES)
def test_no_digit_differs_from_the_textbook(machine, drive):
    pythagorean, textbook, mechanism = MACHINES[machine]
    count = 0
    for x in pythagorean():
        expected = textbook(x | {"drive": drive}, Exact.sqrt)
        result = Rows(mechanism.table(drive, ()), wired(x, mechanism))
        assert result["status"] == 0
        for name in (*FORCES, *(name for name in expected if name.startswith(("omega", "alpha")))):
            assert result[name] == expected[name], (name, count)
        assert result[mechanism.drives[drive]] == expected["drive"]
        assert result["power_residual"] == 0
        count += 1
    assert count >= 3
