"""Numbers that a constructor or a function refuses: each message states path, value, what is allowed and what to do."""

import warnings
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from refusals import TURNED, array, coupler, crank, four_bar, load, loop, refusal, rocker, scene, track

import linksweep as ls
from linksweep.base.fields import PairField, declared, field_rules
from linksweep.base.validate import Rule, number_problems
from linksweep.mechanisms.four_bar import FourBar
from linksweep.scene.loads.load import Load
from linksweep.scene.scene import Scene


@dataclass(frozen=True)
class Number:
    """A parameter: how to change it, its unit in a message, and its bound ("any", "positive", "not negative")."""

    path: str
    change: object
    unit: str
    bound: str = "any"
    over_angle: bool = False

    @property
    def phrase(self) -> str:
        return "a number in " + {"degree": "degrees"}.get(self.unit, self.unit)

    @property
    def allowed(self) -> str:
        return {"any": "", "positive": "greater than 0", "not negative": "at least 0"}[self.bound]

    @property
    def finite(self) -> str:
        return "finite and " + self.allowed if self.allowed else "finite"

    def __str__(self) -> str:
        return self.path


def key(change, name: str):
    return lambda value: change(**{name: value})


def pair(change, name: str, k: int):
    """Change the k-th number of a pair."""
    return lambda value: change(**{name: (value, 1.0) if k == 1 else (1.0, value)})


NUMBERS = [
    Number("coupler.length", key(coupler, "length"), "m", "positive"),
    Number("coupler.mass", key(coupler, "mass"), "kg", "not negative"),
    Number("coupler.inertia", key(coupler, "inertia"), "kg m^2", "not negative"),
    Number("coupler.cg_distance", key(coupler, "cg_distance"), "m", "not negative"),
    Number("coupler.cg_angle", key(coupler, "cg_angle"), "degree"),
    *(Number(f"crank.{name}", key(crank, name), "m", "positive") for name in ("length", "width", "thickness")),
    Number("crank.density", key(crank, "density"), "kg/m^3", "not negative"),
    *(Number(f"rocker.{name}", key(rocker, name), "m", "positive") for name in ("length", "radius", "thickness")),
    Number("rocker.density", key(rocker, "density"), "kg/m^3", "not negative"),
    Number("rocker.cg_distance", key(rocker, "cg_distance"), "m", "not negative"),
    Number("rocker.cg_angle", key(rocker, "cg_angle"), "degree"),
    Number("ground", key(four_bar, "ground"), "m", "positive"),
    Number("ground_angle", key(four_bar, "ground_angle"), "degree"),
    Number("omega2", key(scene, "omega2"), "rad/s", over_angle=True),
    Number("alpha2", key(scene, "alpha2"), "rad/s^2", over_angle=True),
    Number("radius", key(track, "radius"), "m", "positive"),
    Number("mass", key(track, "mass"), "kg", "positive"),
    Number("speed", key(loop, "speed"), "m/s", "not negative"),
    Number("thrust", key(loop, "thrust"), "N"),
    *(Number(f"gravity[{k}]", pair(scene, "gravity", k), "m/s^2") for k in (1, 2)),
    *(Number(f"loads[2].force[{k}]", pair(load, "force", k), "N", over_angle=True) for k in (1, 2)),
    Number("loads[2].at[1]", pair(load, "at", 1), "m", "not negative"),
    Number("loads[2].at[2]", pair(load, "at", 2), "degree"),
    Number("loads[2].torque", key(load, "torque"), "N m", over_angle=True),
]
every_number = pytest.mark.parametrize("number", NUMBERS, ids=str)
POLAR = ("coupler.cg_distance", "rocker.cg_distance", "loads[2].at[1]")
OVER_ANGLE = "only omega2, alpha2, loads and lengths of cylinders may change over the revolution"


def test_the_table_lists_every_number_of_every_constructor():
    def ruled(cls) -> set[str]:
        return {*field_rules(cls)}

    named = {number.path for number in NUMBERS}
    for role, cls in (("coupler", ls.Link), ("crank", ls.Bar), ("rocker", ls.Disk)):
        assert {f"{role}.{name}" for name in ruled(cls)} <= named
    of_scene = ruled(Scene) - {"section"}  # between 0 and 1: see tests/mechanisms/test_section_forces.py
    assert ruled(FourBar) | ruled(ls.LoopTrack) | of_scene | {f"loads[2].{name}" for name in ruled(Load)} <= named
    pairs = {name for cls in (Scene, Load) for name, kind, _ in declared(cls) if isinstance(kind, PairField)}
    assert pairs == {"gravity", "force", "at"}


@every_number
def test_negative_and_zero(number):
    allowed = {"any": (-1.0, 0.0), "positive": (), "not negative": (0.0,)}[number.bound]
    turned = TURNED if number.path in POLAR else ""
    for value, text in ((-1.0, "-1"), (0.0, "0"), (-2.5e-4, "-0.00025"), (-np.float32(0.5), "-0.5"), (-3, "-3")):
        if value in allowed or number.bound == "any":
            number.change(value)
        else:
            expected = f"{number.path} = {text} {number.unit}: must be {number.allowed}{turned}"
            assert refusal(number.change, value) == [expected]


@every_number
def test_values_that_are_not_numbers(number):
    path, unit, phrase = number.path, number.unit, number.phrase
    designs = 'xarray.DataArray(values, dims="design")'
    named = f"name its dimensions, as in {designs}"
    if number.over_angle:
        angles = 'xarray.DataArray(values, {"theta2": degrees}, "theta2")'
        named = f"name its dimension: over the crank angle {angles}, one value for each design {designs}"
    bare = f"is a bare array: {named}"
    for value, expected in (
        (np.nan, f"{path} = nan {unit}: must be {number.finite}"),
        (np.float32("nan"), f"{path} = nan {unit}: must be {number.finite}"),
        (np.inf, f"{path} = inf {unit}: must be {number.finite}"),
        (-np.inf, f"{path} = -inf {unit}: must be {number.finite}"),
        (10**400, f"{path} = inf {unit}: must be {number.finite}"),
        (True, f"{path} = True: must be {phrase}, not a truth value"),
        (np.False_, f"{path} = False: must be {phrase}, not a truth value"),
        ("8 qq", f'{path} = "8 qq": "qq" is not an accepted unit of '),
        ("0.1", f'{path} = "0.1": has no unit; write '),
        ([0.1, 0.2], f"{path} = [0.1, 0.2] {bare}"),
        ((0.1, 0.2), f"{path} = (0.1, 0.2) {bare}"),
        ([[1], [1, 2]], f"{path} = [[1], [1, 2]] {bare}"),
        (np.array([0.1, 0.2]), f"{path} = array([0.1, 0.2]) {bare}"),
        (np.array(0.1), f"{path} = array(0.1) is a bare array: write float(...) of it"),
        (pd.Series([0.1, 0.2], [0.0, 5.0]), f"{path} is a Series: {named}"),
        (pd.DataFrame({"p": [0.1, 0.2]}), f"{path} is a DataFrame: {named}"),
        (0.1j, f"{path} = 0.1j: must be {phrase}, or an xarray.DataArray of them"),
        (Decimal("0.1"), f"{path} = Decimal('0.1'): must be {phrase}, or an xarray.DataArray of them"),
        ({}, f"{path} = {{}}: must be {phrase}, or an xarray.DataArray of them"),
        (xr.Variable("n", [0.1]), f"{path} = <xarray.Variable (n: 1)> Size: 8B array([0.1]): must be {phrase}, or an"),
        (xr.Dataset(), f"{path} = <xarray.Dataset> Size: 0B Dimensions: () Data variables: ...: must be {phrase}, or"),
        (np.timedelta64(1, "s"), f"{path} = np.timedelta64(1,'s'): must be {phrase}, or an xarray.DataArray of them"),
    ):
        (message,) = refusal(number.change, value)
        assert message.startswith(expected)
        assert message == expected or expected.endswith(("or an", "or", "unit of ", "write "))


@every_number
def test_none_is_refused_as_a_number_and_means_no_torque(number):
    if number.path == "loads[2].torque":
        assert number.change(None).loads[1].torque is None
    elif number.path in ("alpha2", "thrust"):
        assert number.change(None).motion[number.path] == 0.0
    elif number.path in ("omega2", "speed"):
        (message,) = refusal(number.change, None)
        assert message.startswith(f"{number.path}: missing; give ") and message.endswith(number.phrase)
    else:
        expected = f"{number.path} = None: must be {number.phrase}, or an xarray.DataArray of them"
        assert refusal(number.change, None) == [expected]


@every_number
def test_arrays_with_refused_values(number):
    path, unit = number.path, number.unit
    for value, expected in (
        (array(0.1, np.nan), f"{path} = nan {unit} at design[1]: must be {number.finite}"),
        (
            array(0.1, np.inf, 0.2, np.nan, design=list("abcd")),
            f"{path} = inf {unit} at design = b (and 1 more of 4): must be {number.finite}",
        ),
        (
            xr.DataArray([[0.1, 0.2], [0.3, np.nan]], {"speed": [10.5, 20.5]}, ("case", "speed")),
            f"{path} = nan {unit} at case[1], speed = 20.5: must be {number.finite}",
        ),
        (xr.DataArray(np.nan), f"{path} = nan {unit}: must be {number.finite}"),
        (array(1j), f"{path} holds complex128 values: each must be {number.phrase}"),
        (array(True), f"{path} holds bool values: each must be {number.phrase}"),
        (array("8 cm"), f"{path} holds <U4 values: each must be {number.phrase}"),
        (array(np.datetime64("2020-01-01", "ns")), f"{path} holds datetime64[ns] values: each must be {number.phrase}"),
        (array(None, 0.1), f"{path} holds object values: each must be {number.phrase}"),
        (array(), f"{path} is empty, {{'design': 0}}: give each dimension at least one value"),
    ):
        assert refusal(number.change, value) == [expected]
    if number.bound != "any":
        turned = TURNED if number.path in POLAR else ""
        expected = f"{path} = -0.2 {unit} at design[2]: must be {number.allowed}{turned}"
        assert refusal(number.change, array(0.1, 0.1, -0.2)) == [expected]


@every_number
def test_dimensions_that_a_number_cannot_have(number):
    path = number.path
    expected = f'{path} has a dimension "branch": that name is kept for branch="both"; rename it'
    assert refusal(number.change, array(0.1, 0.2, dims="branch")) == [expected]
    results = ("T12", "F32x") if path not in ("radius", "mass", "speed", "thrust") else ("speed", "a_total")
    for dim in (*results, "status", "toggle", "equation"):
        expected = f'{path} has a dimension "{dim}": that is the name of a result; rename it'
        assert refusal(number.change, array(0.1, 0.2, dims=dim)) == [expected]
    for dim in (5, "", "a/b", ("a", "b")):
        (line,) = refusal(number.change, array(0.1, 0.2, dims=[dim]))
        assert line.startswith(f"{path} has a dimension {dim!r}: its name must be a text that begins with a letter, ")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # xarray's own, of duplicate names
        message = refusal(number.change, xr.DataArray(np.ones((2, 2)), dims=("n", "n")))
    assert message == [f"{path} has dimensions ('n', 'n'): each name may appear once; rename one"]


@every_number
def test_the_crank_angle_and_functions_of_it(number):
    over = array(0.1, 0.2, 0.1, dims="theta2")
    if number.over_angle:
        number.change(over)
        number.change(lambda theta2: np.cos(np.radians(theta2)))
    else:
        expected = f"{number.path} depends on theta2: it must be the same at every angle; {OVER_ANGLE}"
        assert refusal(number.change, over) == [expected]
        expected = f"{number.path} = <ufunc 'cos'>: must be {number.phrase}, not a function; {OVER_ANGLE}"
        assert refusal(number.change, np.cos) == [expected]


@pytest.mark.parametrize("number", [number for number in NUMBERS if number.over_angle], ids=str)
def test_refused_theta2_coordinates(number):
    def torque_at(*angles):
        return array(*np.ones(len(angles)), dims="theta2", theta2=list(angles))

    for angles, text in (
        ((0.0, np.nan, 180.0), "[0.0, nan, 180.0]: its coordinate must hold finite angles in degrees"),
        (("a", "b"), "['a', 'b']: its coordinate must hold finite angles in degrees"),
        ((0.0, 90.0, 90.0, 180.0), "90 more than once: give one value for each angle"),
    ):
        assert refusal(number.change, torque_at(*angles)) == [f"{number.path} has theta2 = {text}"]
    radians = "has theta2 in radians: it ends at 12.5663706143592, which is 4π; give degrees, 360 a turn"
    assert refusal(number.change, torque_at(*np.linspace(0.0, 4.0 * np.pi, 9))) == [f"{number.path} {radians}"]


@every_number
def test_accepted_types_of_number(number):
    for value in (0.1, np.float64(0.1), np.float32(0.1), Fraction(1, 10), array(0.1, 0.2), xr.DataArray(0.1)):
        number.change(value)
    for value in (1, np.int8(1), array(1, 2)):
        if not number.path.endswith(("length", "ground")) or isinstance(value, xr.DataArray):
            number.change(value)  # a link of 1 m would be too long for the others


def test_a_number_without_unit():
    rule = Rule("dimensionless", at_least=0.0)
    assert number_problems("friction", -0.1, rule) == ["friction = -0.1: must be at least 0"]
    assert number_problems("friction", np.nan, rule) == ["friction = nan: must be finite and at least 0"]
    assert number_problems("friction", True, rule) == ["friction = True: must be a number, not a truth value"]


# ------------------------------------------------------------------------------ numbers of functions

PRESS = ls.example("press")


@pytest.mark.parametrize(
    ("call", "path"),
    [
        (lambda two: ls.geometry(PRESS, dwell=two), "dwell"),
        (lambda two: ls.best_counterweights(PRESS, {"Fs_rms": 1}, radius=two), "radius"),
        (lambda two: ls.best_counterweights(PRESS, {"Fs_rms": 1}, radius={"crank": two}), "radius.crank"),
        (lambda two: ls.best_counterweights(PRESS, {"Fs_rms": 1}, radius=0.06, most=two), "most"),
        (lambda two: ls.best_counterweights(PRESS, {"Fs_rms": two}, radius=0.06), "minimize.Fs_rms"),
        (lambda two: ls.save_drawing(PRESS, "a.svg", scale=two), "scale"),
        (lambda two: ls.speed_limit(PRESS, "F32", below=two), "below"),
        (lambda two: ls.plot.over_speed(PRESS, "F32", speeds=[10, 20], below=two), "below"),
        (lambda two: ls.Motor([0.0, two], [3.0, 0.0]), "speeds[2]"),
        (lambda two: ls.run_down(PRESS, turns=two), "turns"),
    ],
)
def test_one_number_is_no_array_of_several(call, path):
    two = array(0.1, 0.2, dims="k")
    assert refusal(call, two) == [f"{path}: has 1 dims: give one number for all designs"]


def test_no_radius_at_all_is_refused():
    (line,) = refusal(ls.best_counterweights, PRESS, {"Fs_rms": 1}, radius={})
    assert line == "radius: is empty; name one or more of crank, coupler, rocker"
