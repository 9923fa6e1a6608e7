"""Every number of every constructor is converted to float64, from every dtype and from quantities of pint."""

from dataclasses import fields, is_dataclass, replace
from fractions import Fraction

import numpy as np
import pint
import pytest
import xarray as xr
from refusals import refusal

import linksweep as ls
from benchmarks.stress.attacks.dtypes import engine, four_bar, loop, quick_return
from linksweep.base import units
from linksweep.base.validate import UNITS as UNITS_OF_KINDS
from linksweep.scene.parameters import free, replaced
from linksweep.studies.job import scene_digest

UNITS = pint.UnitRegistry()
SCENES = {make.__name__: make() for make in (four_bar, engine, quick_return, loop)}
DTYPES = ["float16", "float32", ">f8", "longdouble", "int8", "uint8", "int16", "uint64"]
OTHER_UNITS = {
    "length": "mm", "mass": "g", "inertia": "g*cm^2", "angle": "rad", "angular_velocity": "rpm", "force": "kN",
    "angular_acceleration": "degree/s^2", "torque": "lbf*in", "velocity": "km/hour", "acceleration": "mm/s^2",
    "density": "g/cm^3", "pressure": "bar", "spring_rate": "N/mm", "damping_coefficient": "N*s/mm",
    "torsional_rate": "N*m/degree", "torsional_damping": "N*m*s/degree", "dimensionless": "percent",
}  # fmt: skip


def numbers(scene):
    return {path: value for path, (value, _) in free(scene).items() if value is not None}


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("name", SCENES)
def test_every_number_is_converted_to_float64(name, dtype):
    made = SCENES[name]
    for path, value in numbers(made).items():
        array = xr.DataArray(np.abs([value, value + 1.0]), dims="design")
        for plain, other in ((array, array.astype(dtype)), (abs(value), np.dtype(dtype).type(abs(value)))):
            expected, result = replaced(made, {path: plain}), replaced(made, {path: other})
            assert np.result_type(numbers(result)[path]) == "=f8", path
            assert not isinstance(numbers(result)[path], np.generic), path
            assert result == expected and scene_digest(result) == scene_digest(expected), path


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("dtype", ["float32", "int8"])
def test_results_equal_those_of_float64_to_the_bit(name, dtype):
    made = SCENES[name]
    values = {path: value for path, (value, _) in free(made).items() if value is not None}
    arrays = {path: xr.DataArray([value, value], dims="design") for path, value in values.items()}
    others = {path: array.astype(dtype) for path, array in arrays.items()}
    assert ls.sweep(replaced(made, others), 12).identical(ls.sweep(replaced(made, arrays), 12))


def test_masses_of_int8_do_not_wrap():
    numbers = ([2, 3], [2, 2], [2, 2], [100, 120])
    bar = ls.Bar(*(xr.DataArray(np.array(values, np.int8), dims="d") for values in numbers))
    assert bar.mass.values.tolist() == [800.0, 1440.0]


def test_a_study_of_equal_numbers_of_another_dtype_is_opened(tmp_path):
    press = ls.example("press")
    lengths = xr.DataArray(np.linspace(0.2, 0.24, 5, dtype=np.float32), dims="d")
    one, other = (replaced(press, {"coupler.length": values}) for values in (lengths, lengths.astype(float)))
    ls.study(one, tmp_path / "s.nc", of=["F32"])
    assert ls.study(other, tmp_path / "s.nc", of=["F32"]).F32_peak.equals(ls.peaks(other, ["F32"]).F32_peak)


@pytest.mark.parametrize("whole", [2**53 + 1, -(2**70), np.int64(2**62 + 1), Fraction(1, 3), np.uint64(2**64 - 1)])
def test_integers_beyond_float64_are_rounded_to_nearest(whole):
    assert ls.Link(0.1, 1, whole).inertia == float(whole)
    assert type(ls.Link(0.1, 1, whole).inertia) is float


def test_dask_arrays_are_cast_when_they_are_computed():
    dask = pytest.importorskip("dask.array")
    link = ls.Link(xr.DataArray(dask.from_array(np.array([1, 2], np.int8)), dims="d"), 1, 1)
    assert link.length.chunks == ((2,),) and link.length.dtype == float


@pytest.mark.parametrize("dtype", ["float32", "int16", "uint8"])
def test_angles_of_arrays_over_theta2_are_float64(dtype):
    angles = np.array([0, 64, 128, 192, 255])
    table = xr.DataArray([1, 2, 4, 2, 3], {"theta2": angles}, "theta2")
    other = table.astype(dtype).assign_coords(theta2=angles.astype(dtype))
    loads = [ls.Load("rocker", torque=torque, interpolation="pchip") for torque in (table, other)]
    expected, result = (ls.Scene(ls.example("press").mechanism, 3, loads=[load]) for load in loads)
    assert result.loads[0].torque.theta2.dtype == float
    assert ls.sweep(result, 7).identical(ls.sweep(expected, 7))


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        (lambda x: ls.Bearing(x(2), x(3), x(1), x(4)), ls.Bearing(2.0, 3.0, 1.0, 4.0)),
        (lambda x: ls.Counterweight("crank", x(2), (x(3), x(4)), x(5)), ls.Counterweight("crank", 2, (3, 4), 5)),
        (lambda x: ls.Motor((x(0), x(30)), (x(4), x(1)), x(2)), ls.Motor((0.0, 30.0), (4.0, 1.0), 2.0)),
        (lambda x: ls.MultiCylinder(engine(), [x(0), x(90)], [x(1), x(2)], [x(3), x(4)]),
         ls.MultiCylinder(engine(), [0.0, 90.0], [1.0, 2.0], [3.0, 4.0])),
        (lambda x: ls.OttoCycle(x(9), x(100), x(50), x(2), x(2)), ls.OttoCycle(9, 100, 50, 2, 2)),
        (lambda x: ls.Load("crank", torque=1, breaks=[x(3), x(4)]), ls.Load("crank", torque=1, breaks=[3.0, 4.0])),
        (lambda x: ls.Load("slider", force=x(3)), ls.Load("slider", force=3.0)),
        (lambda x: ls.sample(four_bar(), {"omega2": (x(2), x(9)), "crank.length": [x(2), x(3)]}, n=x(4)),
         ls.sample(four_bar(), {"omega2": (2, 9), "crank.length": [2, 3]}, n=4)),
        (lambda x: ls.sample(four_bar(), {"omega2": ls.Normal(x(5), x(1), x(2))}, n=2),
         ls.sample(four_bar(), {"omega2": ls.Normal(5, 1, 2)}, n=2)),
        (lambda x: ls.sample(four_bar(), {"ground": ls.Tolerance(x(0), x(1))}, n=2),
         ls.sample(four_bar(), {"ground": ls.Tolerance(0, 1)}, n=2)),
        (lambda x: ls.objective(four_bar(), {"omega2": (x(2), x(3))}, minimize="T12_max", theta2=8).bounds,
         [(2.0, 3.0)]),
        (lambda x: ls.counterweights(engine(), radius=x(2), fraction=x(1)),
         ls.counterweights(engine(), radius=2.0, fraction=1.0)),
    ],
)  # fmt: skip
@pytest.mark.parametrize("dtype", [np.int8, np.uint8, np.float32, np.float16])
def test_other_constructors_and_functions_convert_to_float64(call, expected, dtype):
    if dtype in (np.float32, np.float16):  # counts are whole numbers
        counts = {4}
        result = call(lambda value: value if value in counts else dtype(value))
    else:
        result = call(dtype)
    assert result == expected
    assert all(type(n) is float for n in plain_numbers(result))


def plain_numbers(value):
    """Return every scalar number in a dataclass, except counts."""
    if is_dataclass(value):
        return [n for f in fields(value) if f.name != "strokes" for n in plain_numbers(getattr(value, f.name))]
    if isinstance(value, list | tuple):
        return [n for item in value for n in plain_numbers(item)]
    return [value] if isinstance(value, int | float | np.number) and not isinstance(value, bool) else []


@pytest.mark.parametrize(
    "call",
    [
        lambda x: ls.motor_load(ls.example("press"), ls.Motor((0, 999), (9, 9), 1), ratio=x(7), efficiency=x(1)),
        lambda x: ls.flywheel(ls.example("press"), fluctuation=x(1), theta2=12),
        lambda x: ls.flywheel(ls.example("press"), inertia=x(3), theta2=12),
        lambda x: ls.shaking_moment(
            ls.sweep(ls.example("press"), 8, of=["Fsx", "Fsy", "Ms"]), about=(x(3), x(7))
        ).to_dataset(),
        lambda x: ls.coupler_curve(ls.example("press"), (x(3), x(7)), theta2=8),
        lambda x: ls.sweep(ls.example("press"), [x(0), x(7), x(127)]),
        lambda x: ls.sweep(ls.example("press"), np.array([x(0), x(7), x(127)])),
        lambda x: ls.system(ls.example("press"), x(45)),
    ],
)
@pytest.mark.parametrize("dtype", [np.int8, np.float16, np.float32])
def test_results_of_functions_equal_those_of_float64(call, dtype):
    np.testing.assert_equal(
        call(dtype).to_dict(data="list")["data_vars"], call(float).to_dict(data="list")["data_vars"]
    )


# ------------------------------------------------------------------------------------------------ pint


@pytest.mark.parametrize("name", SCENES)
def test_quantities_of_pint_are_converted_in_every_parameter(name):
    made = SCENES[name]
    for path, value in numbers(made).items():
        _, kind = free(made)[path]
        unit = "" if kind == "dimensionless" else UNITS_OF_KINDS[kind].replace(" ", "*")
        quantity = UNITS.Quantity(np.array([value, value]), unit).to(OTHER_UNITS[kind])
        array = xr.DataArray(quantity, dims="design", attrs={"units": OTHER_UNITS[kind], "source": "drawing"})
        result = numbers(replaced(made, {path: array}))[path]
        assert type(result.data) is np.ndarray and result.attrs == {"source": "drawing"}, path
        assert array.attrs["units"] == OTHER_UNITS[kind], path
        np.testing.assert_allclose(result.values, value, rtol=1e-15, err_msg=path)
        assert numbers(replaced(made, {path: quantity[0]}))[path] == pytest.approx(value, rel=1e-15), path


@pytest.mark.parametrize("name", SCENES)
def test_a_quantity_of_another_dimension_is_refused_by_its_path(name):
    for path in numbers(SCENES[name]):
        _, kind = free(SCENES[name])[path]
        wrong = UNITS.Quantity(np.array([1.0]), "m" if kind == "dimensionless" else "kelvin")
        for quantity in (wrong[0], xr.DataArray(wrong, dims="design")):
            (line,) = refusal(replaced, SCENES[name], {path: quantity})
            assert line.startswith(f"{path} has the unit {wrong.units}: must be a number")


@pytest.mark.parametrize(
    ("path", "unit"), [("omega2", "Hz"), ("omega2", "1/s"), ("ground_angle", ""), ("omega2", "m/s")]
)
def test_a_quantity_of_pint_for_an_angle_needs_an_angular_unit(path, unit):
    (line,) = refusal(replaced, SCENES["four_bar"], {path: UNITS.Quantity(50.0, unit)})
    assert line.startswith(f"{path} has the unit ")


def test_a_study_accepts_theta2_as_a_quantity_of_pint(tmp_path):
    press, angles = ls.example("press"), UNITS.Quantity([0.0, 0.25, 0.5], "turn")
    study = ls.study(press, tmp_path / "s.nc", of=["T12"], theta2=angles)
    assert study.T12_peak == ls.peaks(press, ["T12"], theta2=[0.0, 90.0, 180.0]).T12_peak
    ls.study(press, tmp_path / "s.nc", of=["T12"], theta2=[0, 90, 180])


def test_other_constructors_and_functions_accept_pint():
    q = UNITS.Quantity
    assert ls.Scene(ls.example("press").mechanism, 3, gravity=q([0.0, -9810.0], "mm/s^2")).gravity == (0.0, -9.81)
    assert ls.Spring(("ground", q(30, "cm"), 0), ("rocker", 1, q(90, "deg")), 1, 1).to == ("rocker", 1.0, 90.0)
    assert ls.Load("crank", torque=1, breaks=q([0.25, 0.5], "turn")).breaks == pytest.approx((90.0, 180.0))
    assert ls.Motor(q([0, 60], "rpm"), [q(20, "N*cm"), 0]).speeds == pytest.approx((0.0, 2.0 * np.pi))
    assert ls.MultiCylinder(engine(), q([0.0, 0.5], "turn")).crank_angles == pytest.approx((0.0, 180.0))
    assert ls.sweep(ls.example("press"), q([0.0, 0.5], "turn")).theta2.values.tolist() == [0.0, 180.0]
    assert ls.sweep(ls.example("press"), [q(0.5, "turn"), 90]).theta2.values.tolist() == [180.0, 90.0]
    made = ls.sample(ls.example("press"), {"omega2": (q(100, "rpm"), q(200, "rpm")), "ground": [q(20, "cm")]}, n=4)
    assert made.omega2.max() < 21.0 and made.mechanism.ground.values.tolist() == [0.2] * 4
    limits = [ls.speed_limit(ls.example("press"), "F32", below=b).omega2_limit for b in (1000.0, q(1, "kN"))]
    assert limits[0] == limits[1]


@pytest.mark.parametrize("labelled", [False, True])
@pytest.mark.parametrize(
    ("call", "path"),
    [
        (lambda q, _: ls.sweep(ls.example("press"), q), "theta2"),
        (lambda q, _: ls.bearings(ls.example("press"), theta2=q), "theta2"),
        (lambda q, path: ls.study(ls.example("press"), path / "s.nc", of=["T12"], theta2=q), "theta2"),
        (lambda q, _: ls.MultiCylinder(engine(), [0.0, 180.0]).sweep(q), "theta2"),
        (lambda q, _: ls.plot.over_speed(ls.example("press"), "F32", speeds=q), "speeds"),
        (lambda q, _: ls.Motor(q, [3.0, 0.0]), "speeds"),
        (lambda q, _: ls.Motor([0.0, 90.0], q), "torques"),
    ],
)
def test_lists_of_quantities_of_another_kind_are_refused(call, path, labelled, tmp_path):
    wrong = UNITS.Quantity(np.array([0.0, 90.0]), "kg")
    (line,) = refusal(call, xr.DataArray(wrong, dims="k") if labelled else wrong, tmp_path)
    assert line.startswith(f"{path} has the unit kilogram: must be a number in ")


def test_angles_and_positions_of_another_unit_are_refused():
    radians = xr.DataArray([0.0, 1.0, 2.0], {"theta2": ("theta2", [0.0, 2.0, 4.0], {"units": "rad"})}, "theta2")
    (line,) = refusal(lambda: replace(ls.example("press"), loads=[ls.Load("rocker", torque=radians)]))
    assert line.startswith('loads[1].torque.theta2 has attrs["units"] = "rad": must be in degree')
    push = xr.DataArray([-1.0, 0.0], {"position": ("position", [0.0, 12.0], {"units": "mm"})}, "position")
    (line,) = refusal(lambda: replace(engine(), loads=[ls.Load("slider", force=push, over="slider.to_end")]))
    assert line.startswith('loads[1].force[1].position has attrs["units"] = "mm": must be in m')
    (line,) = refusal(ls.sweep, ls.example("press"), xr.DataArray([0.0, 1.0], dims="x", attrs={"units": "rad"}))
    assert line.startswith('theta2 has attrs["units"] = "rad": must be in degree')


@pytest.mark.parametrize(
    ("call", "path"),
    [
        (lambda mm: ls.Bearing(diameter=mm), "diameter"),
        (lambda mm: ls.Counterweight("crank", 1, (mm, 0)), "at[1]"),
        (lambda mm: ls.counterweights(ls.example("press"), radius=mm), "radius"),
        (lambda mm: ls.coupler_curve(ls.example("press"), at=(mm, 0)), "at[1]"),
    ],
)
def test_arrays_with_a_units_attribute_of_another_unit_are_refused(call, path):
    (line,) = refusal(call, xr.DataArray([20.0], dims="design", attrs={"units": "mm"}))
    assert line.startswith(f'{path} has attrs["units"] = "mm": must be in m')


# ----------------------------------------------------------------------------------------------- texts


@pytest.mark.parametrize("name", SCENES)
def test_texts_with_units_are_converted_in_every_parameter(name):
    made = SCENES[name]
    for path, value in numbers(made).items():
        _, kind = free(made)[path]
        other = units.KINDS[kind].spellings[-1]
        size = units.quantity(f"1 {other}", kind)
        texts = (f"{float(value)!r} {UNITS_OF_KINDS[kind]}", f"{float(value) / size!r} {other}")
        for text in texts[kind == "dimensionless" :]:
            assert numbers(replaced(made, {path: text}))[path] == pytest.approx(value, rel=1e-15), (path, text)


def test_other_constructors_and_functions_accept_texts():
    gravity = ("0 m/s^2", "-9810 mm/s^2")
    assert ls.Scene(ls.example("press").mechanism, "3 rad/s", gravity=gravity).gravity == (0.0, -9.81)
    assert ls.Spring(("ground", "30 cm", 0), ("rocker", 1, "90 deg"), "1 N/m", 1).from_ == ("ground", 0.3, 0.0)
    assert ls.Load("slider", force="2 kN").force == 2000.0
    assert ls.Motor(["0 rpm", "60 rpm"], ["20 N cm", 0]).speeds == pytest.approx((0.0, 2.0 * np.pi))
    assert ls.sweep(ls.example("press"), ["30 deg", "0.25 rev"]).theta2.values.tolist() == [30.0, 90.0]
    assert ls.Bearing(diameter="20 mm").diameter == 0.02
    with pytest.raises(ValueError, match=r'^radius = "6 kg": kg is a unit of mass, not of length'):
        ls.counterweights(ls.example("press"), radius="6 kg")
