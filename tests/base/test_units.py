"""Numbers with units: exact conversion, and a helpful message where the text is ambiguous."""

import random
from fractions import Fraction

import mpmath
import numpy as np
import pint
import pytest

from linksweep.base import units
from linksweep.base.units import KINDS, accepted_unit, quantity
from linksweep.scene.file.axis import design_axis

# International definitions, all exact: the inch, the pound, standard gravity.
INCH, FOOT, POUND, G0 = Fraction("0.0254"), Fraction("0.3048"), Fraction("0.45359237"), Fraction("9.80665")
LBF = POUND * G0
SLUG, BLOB = LBF / FOOT, LBF / INCH

EXACT = [
    ("8 cm", "length", Fraction("0.08")),
    ("25.4 mm", "length", INCH),
    ("1 in", "length", INCH),
    ("1.5 in", "length", Fraction("1.5") * INCH),
    ("3 ft", "length", 3 * FOOT),
    ("3 µm", "length", Fraction("3e-6")),
    ("2.3 lb", "mass", Fraction("2.3") * POUND),
    ("2.3 lbm", "mass", Fraction("2.3") * POUND),
    ("0.1 slug", "mass", Fraction("0.1") * SLUG),
    ("0.1 blob", "mass", Fraction("0.1") * BLOB),
    ("0.1 lbf s^2/in", "mass", Fraction("0.1") * BLOB),
    ("2.8e-3 kg m^2", "inertia", Fraction("2.8e-3")),
    ("2.8e-3 kg·m²", "inertia", Fraction("2.8e-3")),
    ("0.4 lbf in s^2", "inertia", Fraction("0.4") * LBF * INCH),
    ("0.4 in*lbf*s**2", "inertia", Fraction("0.4") * LBF * INCH),
    ("0.4 blob in^2", "inertia", Fraction("0.4") * BLOB * INCH**2),
    ("45 deg", "angle", Fraction(45)),
    ("-45 °", "angle", Fraction(-45)),
    ("0.3 rev", "angle", Fraction(108)),
    ("80 lbf", "force", 80 * LBF),
    ("−80 lbf", "force", -80 * LBF),  # the typographic minus of a document
    ("5 kgf", "force", 5 * G0),
    ("12 N m", "torque", Fraction(12)),
    ("12 N cm", "torque", Fraction("0.12")),
    ("10 lbf ft", "torque", 10 * LBF * FOOT),
    ("10 ft-lbf", "torque", 10 * LBF * FOOT),
    ("-386.1 in/s^2", "acceleration", Fraction("-386.1") * INCH),
    ("1 g0", "acceleration", G0),
    ("7.75 g/cm^3", "density", Fraction(7750)),
    ("0.28 lb/in^3", "density", Fraction("0.28") * POUND / INCH**3),
    ("36 ksi", "pressure", 36_000 * LBF / INCH**2),
    ("10 %", "dimensionless", Fraction("0.1")),
    ("1_500 rad/s", "angular_velocity", Fraction(1500)),
    ("  7 rad s^-1 ", "angular_velocity", Fraction(7)),
    ("0 lbf", "force", Fraction(0)),
    ("1e-999999999 m", "length", Fraction(0)),
]


@pytest.mark.parametrize(("text", "kind", "exact"), EXACT)
def test_text_is_the_correctly_rounded_float(text, kind, exact):
    assert quantity(text, kind) == float(exact)


def test_rounding_is_correct_for_any_number():
    draw = random.Random(17)
    units = [("cm", "length", Fraction(1, 100)), ("in", "length", INCH), ("slug", "mass", SLUG), ("lbf", "force", LBF)]
    for _ in range(500):
        number = f"{draw.uniform(-1, 1) * 10.0 ** draw.randint(-6, 6):.{draw.randint(0, 16)}e}"
        unit, kind, factor = draw.choice(units)
        assert quantity(f"{number} {unit}", kind) == float(Fraction(number) * factor)


@pytest.mark.parametrize(
    ("text", "kind", "per_pi"),
    [
        ("1500 rpm", "angular_velocity", Fraction(50)),
        ("7 rev/min", "angular_velocity", Fraction(7, 30)),
        ("7 rev/s", "angular_velocity", Fraction(14)),
        ("30 deg/s", "angular_velocity", Fraction(1, 6)),
        ("90 deg/s^2", "angular_acceleration", Fraction(1, 2)),
        ("60 rpm/s", "angular_acceleration", Fraction(2)),
    ],
)
def test_units_of_rotation_are_correctly_rounded(text, kind, per_pi):
    with mpmath.workdps(40):
        assert quantity(text, kind) == float(mpmath.pi * per_pi.numerator / per_pi.denominator)


def test_radians_become_degrees():
    with mpmath.workdps(40):
        assert quantity("1 rad", "angle") == float(180 / mpmath.pi)


@pytest.mark.parametrize("value", [0.1, -3, 0, np.float64(0.3), np.int32(7)])
def test_a_plain_number_passes_through(value):
    result = quantity(value, "length")
    assert type(result) is float
    assert result == value


def test_a_plain_number_in_another_unit():
    assert quantity(8, "length", "cm") == 0.08
    assert quantity("8 mm", "length", "cm") == 0.008


@pytest.mark.parametrize("kind", KINDS)
def test_every_listed_unit_is_known_and_of_one_kind(kind):
    for spelling in KINDS[kind].spellings:
        assert quantity(f"1 {spelling}", kind) > 0
        for other in KINDS.keys() - {kind}:
            with pytest.raises(ValueError, match="is a unit of"):
                accepted_unit(spelling, other)
    assert quantity(KINDS[kind].example, kind) > 0
    if kind != "dimensionless":
        assert quantity(f"1 {KINDS[kind].unit}", kind) == 1.0


REFUSED = [
    # texts that pint alone would misread
    ("12 Nm", "torque", '"12 Nm": "Nm" runs its units together; write them with a space, "N m"'),
    ("2e-3 kgm^2", "inertia", 'write them with a space, "kg m^2"'),
    ("1 1/2 in", "length", '"1 1/2 in": a fraction is not read; write the decimal number, "1.5 in"'),
    ("-1-1/2 in", "length", 'write the decimal number, "-1.5 in"'),
    ("3/4 in", "length", 'write the decimal number, "0.75 in"'),
    ("2,5 mm", "length", '"2,5 mm": a comma in a number is not read; write "2.5 mm"'),
    ("1,500 rpm", "angular_velocity", 'a comma in a number is not read; write "1.5 rpm" or "1500 rpm"'),
    ("20,000 h", "life", 'a comma in a number is not read; write "20 h" or "20000 h"'),
    ("1,500.5 rpm", "angular_velocity", 'write "1500.5 rpm"'),
    ("1,500,000 rpm", "angular_velocity", 'write "1500000 rpm"'),
    # not one number and one unit
    ("8cm", "length", 'needs a space between the number and the unit; write "8 cm"'),
    ("5 6 mm", "length", 'must be one number, a space and one unit, as in "8 cm"'),
    ("2.5.3 mm", "length", "must be one number, a space and one unit"),
    ("1½ in", "length", "must be one number, a space and one unit"),
    ("5 ± 1 mm", "length", "must be one number, a space and one unit"),
    ("cm", "length", 'must be a number, a space and a unit, as in "8 cm"'),
    ("", "length", 'must be a number, a space and a unit, as in "8 cm"'),
    ("0.08", "length", 'has no unit; write "0.08 m", or 0.08 without the quotes, which is in m'),
    ("0.1", "dimensionless", "has no unit; write 0.1 without the quotes"),
    ("nan m", "length", "must be a finite number, a space and a unit"),
    ("-inf m", "length", "must be a finite number, a space and a unit"),
    ("1e400 m", "length", "must be a finite number, at most 1.8e308"),
    ("1e308 km", "length", "must be a finite number, at most 1.8e308"),
    # another unit
    ("5 N", "length", '"5 N": N is a unit of force, not of length; accepted: m, mm, cm, km, um, in, ft'),
    (
        "1500 rmp",
        "angular_velocity",
        '"rmp" is not an accepted unit of angular velocity; did you mean "rpm"? accepted:',
    ),
    ("80 lb", "force", 'lb is a unit of mass, not of force; did you mean "lbf"?'),
    ("10 ft lb", "torque", 'did you mean "lbf ft"?'),
    ("30 1/s", "angular_velocity", 'did you mean "rad/s"?'),
    ("25 Hz", "angular_velocity", 'did you mean "rev/s"?'),
    ("1 g", "acceleration", 'g is a unit of mass, not of acceleration; did you mean "g0"?'),
    ("1500 RPM", "angular_velocity", '"RPM" is written "rpm"'),
    ("5 furlong", "length", '"furlong" is not an accepted unit of length; accepted: m, mm'),
    ("5 m^2", "length", "m^2 is a unit of area, not of length"),
    ("5 m^5", "length", '"m^5" is not an accepted unit of length'),
    ("5 lbf/in s^2", "mass", 'did you mean "lbf s^2/in"?'),
    # not a number
    (True, "length", 'true: must be a number or a text such as "8 cm"'),
    (None, "length", 'null: must be a number or a text such as "8 cm"'),
    ([1], "length", '[1]: must be a number or a text such as "8 cm"'),
    (float("nan"), "length", "nan: must be a finite number"),
    (float("-inf"), "length", "-inf: must be a finite number"),
    (10**400, "length", "...: must be a finite number"),
]


@pytest.mark.parametrize(("value", "kind", "part"), REFUSED)
def test_refused_texts_name_the_correct_one(value, kind, part):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        quantity(value, kind)
    assert part in str(refused.value)
    assert "\n" not in str(refused.value)
    if isinstance(value, str):
        assert str(refused.value).startswith(f'"{value}": ')


@pytest.mark.parametrize("text", ["2.5 mm", "1.5 in", "-1.5 in", "1500 rpm", "12 N m"])
def test_texts_suggested_by_messages_are_read(text):
    kind = {"mm": "length", "in": "length", "rpm": "angular_velocity", "m": "torque"}[text.split()[-1]]
    assert quantity(text, kind) != 0


def test_design_axis():
    axis = design_axis({"dim": "width", "values": ["8 cm", 0.09]}, "length")
    assert axis.dims == ("width",)
    assert axis.values.tolist() == [0.08, 0.09]
    assert axis["width"].values.tolist() == [0.08, 0.09]


def test_design_axis_shared_with_others_has_no_labels():
    assert "design" not in design_axis({"dim": "design", "values": [1, 2]}, "mass", alone=False).coords


def test_design_axis_in_a_unit():
    assert design_axis({"dim": "n", "values": [8, "3 mm"], "unit": "cm"}, "length").values.tolist() == [
        0.08,
        0.003,
    ]


def test_design_axis_evenly_spaced_has_exact_decimals():
    axis = design_axis({"dim": "n", "start": "6 cm", "stop": 0.09, "num": 4}, "length")
    assert axis.values.tolist() == [0.06, 0.07, 0.08, 0.09]
    assert design_axis({"dim": "n", "start": 6, "stop": 9, "num": 1}, "length").values.tolist() == [6.0]


def test_design_axis_of_two_dims_and_crank_angles():
    table = {
        "dims": ["case", "theta2"],
        "values": [[1, 2], [3, 4]],
        "coords": {"case": ["a", "b"]},
        "theta2": [0, "0.5 rev"],
    }
    axis = design_axis(table, "torque")
    assert axis.sel(case="b", theta2=180.0) == 4.0


@pytest.mark.parametrize(
    ("table", "problems"),
    [
        ({"values": [1]}, ['dim: missing; write dim = "name of the design axis"']),
        ({"dim": "n"}, ["values: missing; write values = [...], or start, stop and num"]),
        ({"dim": "n", "start": 1, "stop": 2}, ["values: missing"]),
        ({"dim": "n", "valeus": [1], "values": [1]}, ['valeus: unknown key; did you mean "values"?']),
        ({"dim": 3, "values": [1]}, ["dim = 3: must be a name"]),
        ({"dims": ["a", "a"], "values": [[1]]}, ['dims = ["a", "a"]: must be a list of different names']),
        ({"dims": ["a", "b"], "values": [1, 2]}, ["values: lists nested 1 deep for 2 dims, a, b"]),
        ({"dims": ["a", "b"], "values": [[1], [2, 3]]}, ["values: the rows differ in length"]),
        ({"dim": "n", "values": []}, ["values: is empty"]),
        ({"dim": "n", "values": [1, "5 N"]}, ['values[2] = "5 N": N is a unit of force, not of length']),
        (
            {"dims": ["a", "b"], "values": [["1 N", 1], [2, True]]},
            ['values[1][1] = "1 N": ', "values[2][2] = true: must be a number"],
        ),
        ({"dim": "n", "values": [1], "unit": "cn"}, ['unit = "cn": "cn" is not an accepted unit of length']),
        (
            {"dim": "n", "start": "1 N", "stop": 2, "num": 0},
            ['start = "1 N": N is', "num = 0: must be a count, 1 or more"],
        ),
        ({"dim": "n", "values": [1, 2], "coords": 3}, ["coords = 3: must be a table, {n = [...]}"]),
        (
            {"dim": "n", "values": [1, 2], "coords": {"m": [1, 2]}},
            ["coords: m is no dim of these values; they have n"],
        ),
        ({"dim": "n", "values": [1, 2], "coords": {"n": [1]}}, ["coords: n must be a list of 2 labels"]),
        (
            {"dim": "n", "values": [1, 2], "coords": {"n": [[1], [2, 3]]}},
            ["coords: n must be a list of 2 labels"],
        ),
        ({"dim": "theta2", "values": [1, 2], "theta2": [0, "90"]}, ['theta2[2] = "90": has no unit']),
    ],
)
def test_design_axis_reports_all_problems(table, problems):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        design_axis(table, "length")
    lines = str(refused.value).splitlines()
    assert len(lines) == len(problems)
    for line, problem in zip(lines, problems, strict=True):
        assert line.startswith(problem)


# ----------------------------------------------------------------------------------------------- sizes of units


def test_listed_units_have_the_sizes_that_pint_gives_them():
    registry = pint.UnitRegistry(non_int_type=Fraction)
    registry.define("blob = lbf * s^2 / in")
    registry.define("rev = revolution")
    for kind in KINDS.values():
        for spelling in kind.spellings:
            si = "dimensionless" if kind.unit == "1" else kind.unit.replace(" ", "*")
            size = registry.Quantity(Fraction(1), spelling.replace(" ", "*")).to(si).magnitude
            assert units._size(spelling) / units._size(kind.unit) == size, spelling
