"""Parameters over the revolution: constants, DataArrays over theta2 and functions of theta2 give equal results."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pint
import pytest
import xarray as xr
from refusals import refusal
from scipy.interpolate import CubicSpline

import linksweep as ls
from linksweep.base.validate import Rule
from linksweep.scene.curves.over_angle import ArrayCurve, at_angles
from linksweep.scene.grid import crank_grid

BAR = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
PRESS = ls.FourBar(ls.Bar(0.08, **BAR), ls.Bar(0.22, **BAR), ls.Bar(0.18, **BAR), ground=0.2)
EVERYTHING = ("theta3", "omega3", "alpha4", "F12x", "F32y", "F43", "F14", "T12", "power", "power_residual")
TORQUE = Rule("torque", over_angle=True)


def scene(omega2=30.0, alpha2=0.0, Fx=40.0, Fy=-80.0, torque=-12.0, frame="ground") -> ls.Scene:
    loads = [
        ls.Load("coupler", force=(Fx, Fy), at=(0.1, 15.0), frame=frame),
        ls.Load("rocker", torque=torque),
    ]
    return ls.Scene(PRESS, omega2=omega2, alpha2=alpha2, gravity=(0.0, -9.81), loads=loads)


def over_angles(values, angles) -> xr.DataArray:
    return xr.DataArray(values, {"theta2": angles}, "theta2")


def sampled_torque(value, theta2) -> np.ndarray:
    """Return a torque sampled at the angles of a sweep."""
    sampled = at_angles("torque", value, TORQUE, crank_grid(theta2, 360.0), ArrayCurve("torque", value, 360.0))
    return sampled.transpose("theta2", ...).values


def assert_equal_arrays(actual: xr.Dataset, expected: xr.Dataset) -> None:
    assert set(actual.data_vars) == set(expected.data_vars)
    for name in expected.data_vars:
        broadcast = expected[name].variable.set_dims(actual[name].sizes)
        np.testing.assert_array_equal(actual[name].values, broadcast.values, err_msg=str(name))


# ------------------------------------------------------------------------- constants, arrays, functions


@pytest.mark.parametrize("parameter", ["omega2", "alpha2", "Fx", "Fy", "torque"])
@pytest.mark.parametrize("number", [7.25, 1.0, 0.0])  # 1 and 0 are left out of what is planned
@pytest.mark.parametrize("count", [4, 360])
def test_a_constant_a_data_array_and_a_function_give_equal_arrays(parameter, number, count):
    angles = np.arange(count) * (360 / count)
    constant = ls.sweep(scene(**{parameter: number}), count, of=EVERYTHING)
    for value in (
        lambda theta2: number,
        lambda theta2: np.full(theta2.shape, number),
        lambda theta2: [number for _ in theta2],
        over_angles(np.full(count, number), angles),
        over_angles([number] * 4, [0.0, 90.0, 180.0, 270.0]),
        xr.DataArray(np.full(count, number), dims="theta2"),
    ):
        assert_equal_arrays(ls.sweep(scene(**{parameter: value}), count, of=EVERYTHING), constant)


@dataclass
class Wave:
    """A function as a class of its own, whose fields are no parameters of the scene."""

    size: float

    def __call__(self, theta2):
        return 7.0 + self.size * np.cos(np.radians(theta2))


@pytest.mark.parametrize("parameter", ["omega2", "Fx"])
def test_a_function_may_be_an_object_of_a_dataclass(parameter):
    """It was taken for a part with fields, so that a speed of it had no acceleration."""
    plain = ls.sweep(scene(**{parameter: lambda theta2: 7.0 + 2.0 * np.cos(np.radians(theta2))}), 4, of=EVERYTHING)
    own = scene(**{parameter: Wave(2.0)})
    assert_equal_arrays(ls.sweep(own, 4, of=EVERYTHING), plain)
    assert {own: True}[own]


@pytest.mark.parametrize("parameter", ["omega2", "alpha2", "Fx", "Fy", "torque"])
@pytest.mark.parametrize("frame", ["ground", "link"])
def test_a_varying_parameter_equals_at_each_angle_a_constant_of_its_value(parameter, frame):
    angles = np.array([0.0, 20.0, 111.0, 250.5])
    values = np.array([3.0, -2.0, 5.5, 1.25])
    for value in (lambda theta2: np.interp(np.mod(theta2, 360.0), angles, values), over_angles(values, angles)):
        cycle = ls.sweep(scene(**{parameter: value}, frame=frame), angles, of=EVERYTHING)
        for k, (angle, number) in enumerate(zip(angles, values, strict=True)):
            alone = ls.sweep(scene(**{parameter: number}, frame=frame), [angle], of=EVERYTHING)
            for name in EVERYTHING:
                assert cycle[name].values.reshape(-1)[k if cycle[name].size > 1 else 0] == alone[name].item(), name


def test_a_variable_has_theta2_only_where_its_inputs_have():
    cycle = ls.sweep(scene(torque=lambda theta2: np.sin(np.radians(theta2))), 8, of=["omega3", "T12"])
    batch = ls.sweep(scene(torque=xr.DataArray(np.ones((3, 8)), dims=("case", "theta2"))), 8, of=["omega3", "T12"])
    assert cycle.T12.dims == cycle.omega3.dims == batch.omega3.dims == ("theta2",)
    assert batch.T12.dims == ("case", "theta2")


@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # rough data, through a spline all the same
def test_design_dims_and_theta2_together_in_any_order():
    angles = np.arange(4) * 90.0
    values = np.array([[1.0, -2.0, 3.0, 0.5], [4.0, 4.0, -1.0, 2.0]])
    torque = xr.DataArray(values, {"case": ["a", "b"], "theta2": angles}, ("case", "theta2"))
    for inputs in (torque, torque.T, torque[:, ::-1]):
        cycle = ls.sweep(scene(torque=inputs), 12, of=["T12"])
        for k, case in enumerate(["a", "b"]):
            alone = ls.sweep(scene(torque=over_angles(values[k], angles)), 12, of=["T12"])
            np.testing.assert_array_equal(cycle.T12.sel(case=case).values, alone.T12.values)


@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # rough data, through a spline all the same
def test_peaks_of_varying_parameters_equal_those_of_the_sweep():
    load = over_angles([0.0, -50.0, 20.0, 5.0], [0.0, 90.0, 180.0, 270.0])
    moving = scene(torque=load, omega2=lambda theta2: 30.0 + np.cos(np.radians(theta2)))
    cycle, peaks = ls.sweep(moving, 3600), ls.peaks(moving, of=["T12"])
    assert float(peaks.T12_max) == pytest.approx(float(cycle.T12.max()), rel=1e-4)
    assert float(peaks.T12_min) == pytest.approx(float(cycle.T12.min()), rel=1e-4)


# ------------------------------------------------------------------------------------------- the spline


def ripple(theta2):
    radians = np.radians(theta2)
    return 3.0 + np.cos(radians) - 0.5 * np.sin(3 * radians)


@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # rough data, through a spline all the same
def test_known_angles_are_reproduced_to_the_bit():
    rng = np.random.default_rng(1)
    for first in (0.0, 0.1, -200.0, 33.3):
        known = first + np.sort(rng.uniform(0.0, 359.0, 20))
        values = rng.normal(size=20)
        for order in (np.arange(20), rng.permutation(20)):
            inputs = over_angles(values[order], known[order])
            assert sampled_torque(inputs, known).tolist() == values.tolist()
            with_others = np.append(known, known[0] + 0.123456)  # so that it is interpolated
            assert sampled_torque(inputs, with_others)[:-1].tolist() == values.tolist()


@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # rough data, through a spline all the same
def test_the_spline_is_periodic_and_smooth_over_the_join():
    known = np.array([10.0, 60.0, 130.0, 200.0, 280.0, 340.0])
    inputs = over_angles(ripple(known), known)
    requested = np.array([-350.0, 0.0, 5.0, 45.0, 359.9, 123.4])
    np.testing.assert_allclose(
        sampled_torque(inputs, requested), sampled_torque(inputs, requested + 720.0), rtol=0, atol=1e-12
    )
    step = 1e-3
    around = sampled_torque(inputs, 10.0 + step * np.arange(-2, 3))  # the join of the knots
    first, second = np.diff(around) / step, np.diff(around, 2) / step**2
    assert np.ptp(first) < 1e-4
    assert np.ptp(second) < 1e-2 * np.abs(second).max() + 1e-5


def test_the_spline_converges_with_the_fourth_power():
    requested = np.linspace(0.0, 360.0, 997)
    errors = [
        np.abs(sampled_torque(over_angles(ripple(known), known), requested) - ripple(requested)).max()
        for known in (np.arange(n) * (360 / n) for n in (24, 48, 96))
    ]
    assert errors[0] / errors[1] > 12
    assert errors[1] / errors[2] > 12
    assert errors[2] < 2e-5


@pytest.mark.parametrize("closed", [False, True])
def test_a_closing_point_at_360_changes_nothing(closed):
    known = np.arange(0.0, 360.0, 30.0)
    closing = np.append(known, 360.0)
    values = ripple(known)
    inputs = over_angles(np.append(values, values[0]), closing) if closed else over_angles(values, known)
    expected = sampled_torque(over_angles(values, known), 50)
    assert sampled_torque(inputs, 50).tolist() == expected.tolist()
    assert sampled_torque(inputs, closing).tolist() == [*values, values[0]]


def test_angles_beyond_one_revolution_mean_a_period_of_two():
    known = np.arange(0.0, 720.0, 20.0)

    def four_stroke(theta2):
        return np.cos(np.radians(theta2 / 2))

    inputs = over_angles(four_stroke(known), known)
    requested = np.arange(0.0, 1440.0, 7.0)
    np.testing.assert_allclose(sampled_torque(inputs, requested), four_stroke(requested), atol=1e-5)
    cycle = ls.sweep(scene(torque=inputs), [90.0, 450.0, 810.0], of=["T12"]).T12.values
    assert cycle[0] == cycle[2] != cycle[1]


@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # rough data, through a spline all the same
def test_other_dims_are_interpolated_side_by_side():
    known = np.arange(0.0, 360.0, 45.0)
    both = xr.DataArray([ripple(known), 2.0 - ripple(known)], {"case": [5, 7], "theta2": known}, ("case", "theta2"))
    result = sampled_torque(both, 100)
    assert result.shape == (100, 2)
    np.testing.assert_array_equal(result[:, 0], sampled_torque(over_angles(ripple(known), known), 100))
    np.testing.assert_allclose(result.sum(axis=1), 2.0, atol=1e-12)


@pytest.mark.parametrize("labels", [{}, {"design": ["a", "b"]}], ids=["of one design", "of labelled designs"])
def test_interpolated_arrays_are_those_of_the_constructor_of_xarray(labels):
    """Arrays over the same angles share an index, not their attributes."""
    known = np.arange(0.0, 360.0, 30.0)
    values = np.outer(np.sin(np.radians(known)), [1.0, 2.0]) if labels else np.sin(np.radians(known))
    dims, attributes, grid = ("theta2", *labels), {"source": "a test rig"}, crank_grid(50, 360.0)
    array = xr.DataArray(values, {"theta2": known, **labels}, dims, attrs=attributes)
    curve = ArrayCurve("torque", array, 360.0)
    first, second = (at_angles("torque", array, TORQUE, grid, curve) for _ in range(2))
    expected = xr.DataArray(curve.periodic(grid.angles), {"theta2": grid.angles, **labels}, dims, attrs=attributes)
    assert first.identical(expected)
    first.attrs["source"] = "another"
    assert second.identical(expected)
    assert first.xindexes["theta2"].index is second.xindexes["theta2"].index


def test_a_function_gets_its_own_copy_of_the_angles():
    def careless(theta2):
        theta2 *= 0.0
        return theta2 + 1.0

    assert sampled_torque(careless, 8).tolist() == [1.0] * 8
    assert crank_grid(8, 360.0).angles.tolist() == [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0]


def test_a_function_is_evaluated_at_angles_that_repeat():
    """A torque on the crank alone is what its drive feels: T12 = −T."""
    light = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18)), ground=0.2)
    push = ls.Load("crank", torque=lambda theta2: 5.0 * np.sin(np.radians(theta2)))
    scene = ls.Scene(light, omega2=lambda theta2: 20.0 + np.cos(np.radians(theta2)), loads=[push])
    angles = np.array([90.0, 30.0, 90.0, 450.0])
    torque = ls.sweep(scene, angles, of=["T12"]).T12
    np.testing.assert_allclose(torque, -5.0 * np.sin(np.radians(angles)), rtol=1e-12)
    assert ls.system(scene, [30.0, 30.0]).sizes["theta2"] == 2


# ------------------------------------------------------------------------------------------- messages


def fails(theta2):
    raise RuntimeError("no\ndata")


REFUSED = [
    # functions
    (
        lambda theta2: np.ones(3),
        "torque: the function returned shape (3,) for 8 angles; it must return a number in N m",
    ),
    (lambda theta2: np.ones((2, 8)), "torque: the function returned shape (2, 8) for 8 angles; "),
    (lambda theta2: np.where(theta2 == 90.0, np.nan, 1.0), "torque = nan N m at theta2 = 90.0: must be finite; its f"),
    (
        lambda theta2: np.where(theta2 > 180.0, -np.inf, 1.0),
        "torque = -inf N m at theta2 = 225.0 (and 2 more of 8): must be finite; its function returned it",
    ),
    (lambda theta2: theta2 > 90.0, "torque holds bool values: each must be a number in N m; its function returned it"),
    (lambda theta2: 1j * theta2, "torque holds complex128 values: each must be a number in N m; "),
    (lambda theta2: "12 N m", "torque holds <U6 values: each must be a number in N m; "),
    (lambda theta2: None, "torque holds object values: each must be a number in N m; "),
    (
        fails,
        "torque: the function failed on an array of theta2 in degrees (RuntimeError: no data); "
        "write it with numpy, as in lambda theta2: 5 * np.cos(np.radians(theta2))",
    ),
    (lambda: 1.0, "torque: the function failed on an array of theta2 in degrees (TypeError: "),
    (lambda theta2: 1.0 if theta2 > 90.0 else 0.0, "torque: the function failed on an array of theta2 in degrees (Val"),
    # DataArrays
    (
        xr.DataArray([1.0, 2.0, 3.0], dims="theta2"),
        "torque has 3 values over theta2 but no theta2 coordinate, and the sweep has 8 angles: "
        'give it its angles with coords={"theta2": degrees}',
    ),
    (
        over_angles([1.0, 2.0], [0.0, 180.0]),
        "torque: its 2 angles from 0 to 180 degrees cannot be joined; "
        "give at least 3 different angles within one period of 360 degrees",
    ),
    (
        over_angles([1.0, 2.0, 3.0, 4.0], [0.0, 30.0, 60.0, 730.0]),
        "torque: its 4 angles from 0 to 730 degrees leave 670 of 1080 degrees open; give values all the way round",
    ),
    (
        over_angles([1.0, 2.0, 3.0, 1.5], [0.0, 120.0, 240.0, 360.0]),
        "torque: its values at 0 and 360 degrees differ, but they are the same position; "
        "make them equal or leave one out",
    ),
    (
        over_angles([1.0, 2.0, 1.5], [0.0, 200.0, 360.0]),
        "torque: its values at 0 and 360 degrees differ, but they are the same position; "
        "make them equal or leave one out",
    ),
    (
        over_angles([1.0, 2.0, 3.0, 4.0], [0.0, 30.0, 60.0, 100.0]),
        "torque: its 4 angles from 0 to 100 degrees leave 260 of 360 degrees open; give values all the way round",
    ),
]


@pytest.mark.parametrize(("value", "message"), REFUSED)
def test_functions_and_arrays_that_cannot_be_sampled_are_refused(value, message):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        sampled_torque(value, 8)
    assert str(refused.value).startswith(message)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("parameter", "path"),
    [
        ("omega2", "omega2"),
        ("alpha2", "alpha2"),
        ("Fx", "loads[1].force[1]"),
        ("Fy", "loads[1].force[2]"),
        ("torque", "loads[2].torque"),
    ],
)
@pytest.mark.parametrize("job", [ls.sweep, ls.peaks, partial(ls.system, theta2=[1.0, 2.0])])
def test_messages_of_a_scene_name_the_parameter(parameter, path, job):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        job(scene(**{parameter: fails}))
    assert str(refused.value).startswith(f"{path}: the function failed on an array of theta2")


def test_known_angles_need_no_spline():
    held = over_angles([1.0, 2.0], [30.0, 70.0])
    assert sampled_torque(held, [70.0, 30.0, 70.0]).tolist() == [2.0, 1.0, 2.0]


@pytest.mark.parametrize(
    ("function", "period"),
    [
        (lambda theta2: 5.0 * np.cos(np.radians(theta2) / 2.0), 720.0),
        (lambda theta2: np.where(np.mod(theta2, 720.0) < 180.0, -900.0, 0.0), 720.0),
        (lambda theta2: 5.0 * np.cos(np.radians(theta2)), 360.0),
        (lambda theta2: 5.0, 360.0),
        (lambda theta2: np.where(np.mod(theta2, 720.0) < 30.0, -900.0, 0.0), 720.0),
        (lambda theta2: 100.0 * (np.sin(np.radians(theta2)) >= 0.0), 360.0),  # jumps where rounding decides
        (lambda theta2: np.interp(theta2, [0.0, 100.0, 360.0], [1.0, 5.0, 1.0]), 360.0),
        (lambda theta2: np.interp(theta2, [0.0, 100.0, 360.0, 500.0, 720.0], [1.0, 5.0, 1.0, 2.0, 1.0]), 720.0),
        (CubicSpline([0.0, 100.0, 200.0, 300.0, 360.0], [1.0, 5.0, 4.0, 2.0, 1.0]), 360.0),
        (CubicSpline([0.0, 200.0, 360.0, 600.0, 720.0], [1.0, 5.0, 4.0, 2.0, 1.0]), 720.0),
    ],
)
def test_a_function_with_a_period_of_two_turns_sets_the_cycle(function, period):
    scene = replace(ls.example("press"), loads=[ls.Load("rocker", torque=function)])
    assert scene.period == period
    cycle = ls.sweep(scene, 8)
    assert cycle.theta2.values[-1] == period * 7 / 8
    np.testing.assert_array_equal(cycle["loads[1].torque"], np.broadcast_to(function(cycle.theta2.values), 8))


@pytest.mark.parametrize("function", [lambda theta2: 10.0 * np.sin(theta2), np.cos, lambda theta2: 0.1 * theta2])
@pytest.mark.parametrize("parameter", ["omega2", "torque"])
def test_a_function_that_is_not_periodic_is_refused(function, parameter):
    (line,) = refusal(scene, **{parameter: function})
    path = {"torque": "loads[2].torque"}.get(parameter, parameter)
    first, turned, twice = (f"{function(angle):.6g}" for angle in (0.0, 360.0, 720.0))
    assert line.startswith(
        f"{path}: the function gives {first} at 0, {turned} at 360, {twice} at 720 degrees: it must "
    )
    assert "theta2 is in degrees, so write np.sin(np.radians(theta2))" in line


@pytest.mark.parametrize(
    "name",
    ["theta", "Theta2", "theta_2", "THETA", "θ", "θ₂", "theta2 [deg]", "theta-2", "theta2_degrees", "crank angle"],
)
def test_dims_named_almost_like_theta2_are_refused(name):
    (line,) = refusal(scene, torque=xr.DataArray([1.0, 2.0], dims=name))
    assert line == f'loads[2].torque has a dimension "{name}": rename it; did you mean "theta2"?'


def test_dims_named_almost_like_theta_of_a_loop_are_refused():
    (line,) = refusal(replace, ls.example("loop"), thrust=xr.DataArray([1.0, 2.0], dims="theta_2"))
    assert line == 'thrust has a dimension "theta_2": rename it; did you mean "theta"?'


def test_a_function_that_returns_a_quantity_is_refused():
    metre = pint.UnitRegistry().Quantity(1.0, "m")
    moving = scene(torque=lambda theta2: np.cos(np.radians(theta2)) * metre)
    (line,) = refusal(ls.sweep, moving, 8)
    assert line == "loads[2].torque: the function returned a quantity in meter; it must return a number in N m"
