"""Interpolation of arrays over an angle: each kind against its definition, jumps in peaks and means, overshoot of
splines, and files."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.scene.file.reading import parse_scene, read_scene
from linksweep.scene.file.writing import write_scene
from linksweep.studies.job import scene_digest

KINDS = ("periodic cubic", "pchip", "linear", "step")
CRANK, ROD = 0.04, 0.14
PRESS = ls.SliderCrank(ls.Link(CRANK, 1.0, 0.0), ls.Link(ROD, 0.5, 1e-3), slider_mass=0.5)
ANGLES = np.arange(0.0, 360.0, 10.0)
PUSH = np.where((ANGLES >= 100.0) & (ANGLES < 200.0), -1000.0, 0.0)


def over_angles(values, angles, **attributes) -> xr.DataArray:
    return xr.DataArray(values, {"theta2": angles}, "theta2", attrs=attributes)


def scene(interpolation=None, values=PUSH, angles=ANGLES, mechanism=PRESS) -> ls.Scene:
    load = ls.Load("slider", force=over_angles(values, angles), interpolation=interpolation)
    return ls.Scene(mechanism, omega2=100.0, loads=[load])


def force(interpolation, values, angles, theta2) -> np.ndarray:
    cycle = ls.sweep(scene(interpolation, values, angles), theta2, of=["T12"])
    return cycle["loads[1].force[1]"].values


def held(values, angles, theta2, period=360.0):
    """Return a step function by its definition: the value at the last known angle at or before each of `theta2`."""
    behind = np.mod(np.asarray(theta2)[:, None] - np.asarray(angles), period)
    return np.asarray(values)[behind.argmin(axis=1)]


def fritsch_butland(values, angles, theta2):
    """Return the monotone cubic by its published formula, in Hermite form, from three periods of data."""
    x = np.concatenate([np.asarray(angles) + turn for turn in (-360.0, 0.0, 360.0)])
    y = np.tile(values, 3)
    h, slope = np.diff(x), np.diff(y) / np.diff(x)
    tangent = np.zeros_like(y)
    for k in range(1, len(y) - 1):
        if slope[k - 1] * slope[k] > 0.0:
            w1, w2 = 2 * h[k] + h[k - 1], h[k] + 2 * h[k - 1]
            tangent[k] = (w1 + w2) / (w1 / slope[k - 1] + w2 / slope[k])
    k = np.searchsorted(x, theta2, side="right") - 1
    t = (theta2 - x[k]) / h[k]
    return (
        y[k] * (1 + 2 * t) * (1 - t) ** 2
        + y[k + 1] * t**2 * (3 - 2 * t)
        + h[k] * (tangent[k] * t * (1 - t) ** 2 - tangent[k + 1] * t**2 * (1 - t))
    )


# ------------------------------------------------------------------------------------------ definitions

DEFINED = {
    "step": held,
    "linear": lambda values, angles, theta2: np.interp(theta2, angles, values, period=360.0),
    "pchip": fritsch_butland,
}


@pytest.mark.parametrize("kind", [*DEFINED])
def test_each_kind_against_its_definition(kind):
    rng = np.random.default_rng(3)
    for first in (0.0, -50.5, 200.0):
        angles = first + np.sort(rng.uniform(0.0, 350.0, 30))
        values = np.round(rng.normal(size=30), 1)
        theta2 = np.sort(rng.uniform(0.0, 360.0, 400))
        order = np.argsort(np.mod(angles, 360.0))
        expected = DEFINED[kind](values[order], np.mod(angles, 360.0)[order], theta2)
        np.testing.assert_allclose(force(kind, values, angles, theta2), expected, rtol=0, atol=1e-11)


@pytest.mark.parametrize("kind", KINDS)
def test_values_at_known_angles_come_back_to_the_bit(kind):
    theta2 = np.append(ANGLES, 3.3)  # so that it is interpolated
    values = np.cos(np.radians(ANGLES))
    assert force(kind, values, ANGLES, theta2)[:-1].tolist() == values.tolist()


def test_a_step_holds_up_to_the_next_angle():
    theta2 = np.array([99.999999999, 100.0, 100.000000001, 199.999999999, 200.0, 359.999999999])
    assert force("step", PUSH, ANGLES, theta2).tolist() == [0.0, -1000.0, -1000.0, -1000.0, 0.0, 0.0]


def test_a_step_of_two_angles_needs_no_more():
    result = force("step", [-700.0, 0.0], [320.0, 355.0], np.array([319.9, 320.0, 354.0, 355.0, 10.0]))
    assert result.tolist() == [0.0, -700.0, -700.0, 0.0, 0.0]


def test_two_turns_come_round_after_two():
    angles = np.arange(0.0, 720.0, 20.0)
    values = np.where(angles < 180.0, 900.0, 0.0)
    four_stroke = scene("step", values, angles)
    assert four_stroke.period == 720.0
    result = ls.sweep(four_stroke, [170.0, 190.0, 530.0, 890.0], of=["T12"])["loads[1].force[1]"]
    assert result.values.tolist() == [900.0, 0.0, 0.0, 900.0]


def test_each_design_has_its_own_curve():
    values = np.stack([PUSH, 2.0 * PUSH])
    both = xr.DataArray(values, {"case": [1, 2], "theta2": ANGLES}, ("case", "theta2"))
    load = ls.Load("slider", force=both, interpolation="step")
    peaks = ls.peaks(ls.Scene(PRESS, omega2=100.0, loads=[load]), ["T12"])
    for k in range(2):
        assert float(peaks.T12_max[k]) == float(ls.peaks(scene("step", values[k]), ["T12"]).T12_max)


def test_gas_pressure_accepts_an_interpolation():
    pressure = over_angles(1e5 - 100.0 * PUSH, ANGLES)
    gas = ls.GasPressure(bore=0.05, pressure=pressure, interpolation="step")
    cycle = ls.sweep(ls.Scene(PRESS, omega2=100.0, loads=[gas]), [99.0, 105.0], of=["T12"])
    assert cycle["loads[1].pressure"].values.tolist() == [1e5, 2e5]


# ------------------------------------------------------------------------------------- peaks and means


@pytest.mark.parametrize(("kind", "names"), [("step", ["F32", "T12"]), ("linear", ["F32", "T12"])])
def test_exact_peaks_include_every_corner(kind, names):
    """Corners lie between the even angles; the reference is a fine sweep with both sides of each corner."""
    rng = np.random.default_rng(5)
    angles = np.sort(rng.uniform(0.0, 360.0, 12))
    values = np.round(rng.uniform(-9000.0, 9000.0, 12))
    made = scene(kind, values, angles)
    peaks = ls.peaks(made, names)
    theta2 = np.concatenate([np.arange(0.0, 360.0, 0.01), np.mod(angles - 1e-9, 360.0), np.mod(angles + 1e-9, 360.0)])
    fine = ls.sweep(made, theta2, of=names)
    for largest, dense in ((peaks.F32_peak, fine.F32.max()), (peaks.T12_max, fine.T12.max())):
        assert float(dense) * (1.0 - 1e-11) <= float(largest) <= float(dense) * (1.0 + 1e-6)
    assert float(peaks.T12_min) == pytest.approx(float(fine.T12.min()), rel=1e-6)


def test_a_step_equals_a_function_with_breaks():
    function = ls.Load("slider", force=lambda t: held(PUSH, ANGLES, t), breaks=[100.0, 200.0])
    by_function = ls.peaks(ls.Scene(PRESS, omega2=100.0, loads=[function]), ["F32", "T12", "T12_mean"])
    by_table = ls.peaks(scene("step"), ["F32", "T12", "T12_mean"])
    for name in ("F32_peak", "T12_max", "T12_min", "T12_mean"):
        assert float(by_table[name]) == pytest.approx(float(by_function[name]), rel=1e-10)


def test_the_mean_torque_does_the_work_of_the_steps():
    """Nothing else does work over a turn: 2π·mean = −F·(x at 200° − x at 100°), x in closed form."""
    x = [CRANK * np.cos(t) + np.sqrt(ROD**2 - (CRANK * np.sin(t)) ** 2) for t in np.radians([100.0, 200.0])]
    peaks = ls.peaks(scene("step"), ["T12_mean"])
    assert float(peaks.T12_mean) == pytest.approx(1000.0 * (x[1] - x[0]) / (2.0 * np.pi), rel=1e-11)


# ----------------------------------------------------------------------------------------------- ringing


def test_a_spline_that_overshoots_warns_and_check_reports_it():
    rings = scene()
    with pytest.warns(
        ls.OvershootWarning, match=r"^loads\[1\].force\[1\]: .* by 11 % of it; .*interpolation = \"pchip"
    ):
        ls.peaks(rings, ["F32"])
    checks = ls.check(rings)
    assert checks.overshoot.spline.values.tolist() == ["loads[1].force[1]"]
    assert float(checks.overshoot[0]) == pytest.approx(0.108, abs=1e-3)  # −1107.8 … +107.8, measured on a fine grid


def test_a_scene_warns_once():
    rings = scene()
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        ls.peaks(rings, ["F32", "T12"])
        ls.sweep(rings, 720)
    assert len(seen) == 1


@pytest.mark.parametrize("kind", KINDS[1:])
def test_other_interpolations_do_not_overshoot(kind):
    made = scene(kind)
    result = ls.sweep(made, 3600, of=["T12"])["loads[1].force[1]"]
    assert (float(result.min()), float(result.max())) == (-1000.0, 0.0)
    assert "overshoot" not in ls.check(made)


def test_smooth_loads_and_sweeps_at_the_known_angles_do_not_warn():
    smooth = scene(values=np.cos(np.radians(ANGLES)))
    ls.sweep(smooth, 720)
    assert float(ls.check(smooth).overshoot[0]) < 0.01
    ls.sweep(scene(), ANGLES)


def test_an_omega2_that_overshoots_warns():
    jerky = ls.Scene(PRESS, omega2=over_angles(100.0 + np.where(ANGLES < 180.0, 10.0, 0.0), ANGLES))
    with pytest.warns(ls.OvershootWarning, match="^omega2: .*give it at more angles, or as a function"):
        ls.sweep(jerky, 720, of=["omega3"])


# ---------------------------------------------------------------------------------------- through files

FILE = """\
omega2 = 100
[mechanism]
type = "SliderCrank"
slider_mass = 0.5
crank = {length = 0.04, mass = 1, inertia = 0}
rod = {length = 0.14, mass = 0.5, inertia = 1e-3}
[[loads]]
link = "slider"
"""


def read(folder, load, table="theta2,P\n320,-0.7\n355,0\n"):
    (folder / "p.csv").write_text(table)
    (folder / "scene.toml").write_text(FILE + load + "\n")
    return read_scene(folder / "scene.toml")


@pytest.mark.parametrize(
    "load",
    [
        'force = {csv = "p.csv", unit = "kN", interpolation = "step"}',
        'force = {csv = "p.csv", unit = "kN", interpolation = "step"}\ninterpolation = "step"',
        'force = {dim = "theta2", values = [-700, 0], theta2 = [320.0, 355.0]}\ninterpolation = "step"',
        'force = {dim = "theta2", values = [-700, 0], theta2 = [320.0, 355.0], interpolation = "step"}',
    ],
)
def test_a_scene_file_names_the_interpolation_in_the_table_or_the_load(tmp_path, load):
    assert read(tmp_path, load) == scene("step", [-700.0, 0.0], [320.0, 355.0])


@pytest.mark.parametrize("kind", [None, *KINDS])
def test_round_trips(tmp_path, kind):
    made = scene(kind, np.cos(np.radians(ANGLES)))
    assert parse_scene(write_scene(made)) == made
    ls.save(ls.sweep(made, ANGLES), tmp_path / "cycle.nc")
    assert ls.load_scene(tmp_path / "cycle.nc").loads[0].interpolation == kind


def test_loads_of_different_interpolations_are_not_equal():
    made = [scene(kind) for kind in (None, *KINDS[1:])]
    assert len({*made}) == len({scene_digest(one) for one in made}) == 4


@pytest.mark.parametrize(
    ("load", "message"),
    [
        (
            'torque = 1\ninterpolation = "linaer"',
            ":10: loads[1].interpolation = 'linaer': must be one of periodic cubic, ",
        ),
        ('torque = 1\ninterpolation = "linaer"', 'did you mean "linear"?'),
        (
            'force = {csv = "p.csv", interpolation = "setp"}',
            ":9: loads[1].force.interpolation = 'setp': must be one of ",
        ),
        (
            'force = {csv = "p.csv", interpolation = "step"}\ninterpolation = "linear"',
            ":10: loads[1].interpolation = 'linear': is that of all its arrays, but one is 'step'; give that a",
        ),
        (
            'force = 1\nat = [{dim = "n", values = [1], interpolation = "step"}, 0]',
            "loads[1].at[1].interpolation: is for",
        ),
        ('force = {csv = "p.csv"}', ":9: loads[1].force.csv: p.csv: has 2 rows of numbers: give at least 4"),
    ],
)
def test_an_unknown_interpolation_is_refused_with_its_line(tmp_path, load, message):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        read(tmp_path, load)
    assert message in str(refused.value)


def test_a_function_with_an_interpolation_is_refused():
    mixed = ls.Load("slider", force=(over_angles(PUSH, ANGLES), np.cos), interpolation="step")
    with pytest.raises(
        ValueError, match=r"^loads\[1\].interpolation = 'step': .* but one is a function; give that a l"
    ):
        ls.Scene(PRESS, omega2=1.0, loads=[mixed])


def test_a_speed_with_an_interpolation_is_refused():
    speed = over_angles(100.0 + np.cos(np.radians(ANGLES)), ANGLES, interpolation="step")
    with pytest.raises(ValueError, match=r"^omega2.interpolation: is for loads over theta2; leave it out"):
        ls.Scene(PRESS, omega2=speed)


def test_an_array_over_part_of_a_turn_is_checked_when_swept():
    part = replace(scene(), loads=[ls.Load("slider", force=over_angles([1.0, 2.0], [30.0, 70.0]))])
    assert "overshoot" not in ls.check(part)
    assert ls.sweep(part, [30.0, 70.0], of=["T12"]).T12.notnull().all()
