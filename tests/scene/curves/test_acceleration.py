"""alpha2 = ω·dω/dθ of an omega2 that changes with theta2, against derivatives in closed form."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from refusals import refusal
from scipy.interpolate import CubicSpline

import linksweep as ls
from linksweep.cli.main import main
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.file.writing import write_scene
from linksweep.scene.grid import crank_grid

PRESS = ls.example("press")


def alpha2(omega2, theta2=720) -> np.ndarray:
    """Return the angular acceleration of the press's crank that sweep uses."""
    return ls.sweep(replace(PRESS, omega2=omega2), theta2, of=["alpha3"]).alpha2.values


def cosine(t):
    return 30.0 * (1.0 + 0.2 * np.cos(t)), -6.0 * np.sin(t)


def seventh_order(t):
    return 30.0 + 2.0 * np.cos(t) + np.sin(7.0 * t), -2.0 * np.sin(t) + 7.0 * np.cos(7.0 * t)


def narrow_pulse(t):
    """Return a pulse half a degree wide, between the points of the widest difference quotient."""
    pulse = np.exp((np.cos(t - 1.0) - 1.0) / 4e-5)
    return 30.0 + pulse, -pulse * np.sin(t - 1.0) / 4e-5


def order_45(t):
    """Return an oscillation with a period of 8 degrees."""
    return 30.0 + np.cos(45.0 * t), -45.0 * np.sin(45.0 * t)


def over_two_turns(t):
    return -20.0 + np.cos(0.5 * t), -0.5 * np.sin(0.5 * t)


def from_rest_to_rest(t):
    """ω² is smooth where ω is not: dω/dθ has no limit at 0, ω·dω/dθ has."""
    return 10.0 * np.abs(np.sin(0.5 * t)), 5.0 * np.cos(0.5 * t) * np.sign(np.sin(0.5 * t))


@pytest.mark.parametrize(
    ("motion", "within"),
    [
        (cosine, 1e-12),
        (seventh_order, 2e-10),
        (narrow_pulse, 2e-9),
        (order_45, 1e-10),
        (over_two_turns, 1e-12),
        (from_rest_to_rest, 1e-11),
    ],
)
@pytest.mark.parametrize("theta2", [720, np.linspace(3.0, 357.0, 997)])
def test_a_function_is_differentiated(motion, within, theta2):
    cycle = ls.sweep(replace(PRESS, omega2=lambda t: motion(np.radians(t))[0]), theta2, of=["alpha3"])
    omega, slope = motion(np.radians(cycle.theta2.values))
    expected = omega * slope
    np.testing.assert_allclose(cycle.alpha2.values, expected, rtol=0.0, atol=within * abs(expected).max())


@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # few angles, through a spline all the same
def test_an_array_is_differentiated_as_the_spline_that_interpolates_it():
    known = np.array([0.0, 50.0, 90.0, 170.0, 260.0, 300.0])
    values = np.array([30.0, 31.0, 28.0, 33.0, 29.0, 30.5])
    spline = CubicSpline(np.radians(np.append(known, 360.0)), np.append(values, values[0]), bc_type="periodic")
    inputs = xr.DataArray(values, {"theta2": known}, "theta2")
    for theta2 in (360, known, [12.3]):
        at = np.radians(crank_grid(theta2, 360.0).angles)
        np.testing.assert_allclose(alpha2(inputs, theta2), spline(at) * spline(at, 1), rtol=1e-11, atol=1e-9)


def test_an_array_over_part_of_a_turn_is_differentiated_at_its_own_angles():
    """ω² linear in θ is one acceleration; at the angles of the array, which nothing joins to a whole turn."""
    angles = np.linspace(10.0, 60.0, 201)
    inputs = xr.DataArray(np.sqrt(4.0 + 3.0 * np.radians(angles)), {"theta2": angles}, "theta2")
    np.testing.assert_allclose(alpha2(inputs, angles), 1.5, rtol=1e-8)
    without_angles = xr.DataArray(inputs.values, dims="theta2")
    np.testing.assert_array_equal(alpha2(without_angles, angles), alpha2(inputs, angles))


def test_each_design_has_its_own_alpha2():
    angles = np.arange(0.0, 360.0, 2.0)
    sizes = xr.DataArray([1.0, 5.0, 0.0], dims="size")
    inputs = 30.0 + sizes * xr.DataArray(np.cos(np.radians(angles)), {"theta2": angles}, "theta2")
    for array in (inputs, inputs.transpose("theta2", "size")):
        batch = ls.sweep(replace(PRESS, omega2=array), 360)
        peaks = ls.peaks(replace(PRESS, omega2=array), of=["T12"])
        for k in range(3):
            alone = replace(PRESS, omega2=inputs.isel(size=k))
            np.testing.assert_array_equal(batch.T12.isel(size=k).values, ls.sweep(alone, 360).T12.values)
            assert float(peaks.T12_max[k]) == float(ls.peaks(alone, of=["T12"]).T12_max)


def test_samples_and_peaks_use_the_derived_alpha2():
    """With α written out by hand: forces, torques, exact peaks."""
    shaped = replace(PRESS, omega2=lambda t: cosine(np.radians(t))[0])
    by_hand = replace(shaped, alpha2=lambda t: np.multiply(*cosine(np.radians(t))))
    cycle, expected = (ls.sweep(scene, of=["F12", "T12"]) for scene in (shaped, by_hand))
    np.testing.assert_allclose(cycle.T12, expected.T12, rtol=0.0, atol=1e-11 * float(abs(expected.T12).max()))
    worst, reference = (ls.peaks(scene, of=["F12", "T12"]) for scene in (shaped, by_hand))
    assert float(worst.F12_peak) == pytest.approx(float(reference.F12_peak), rel=1e-11)
    assert float(worst.F12_peak) == pytest.approx(387.8, abs=0.05)  # by maximal coordinates and Lagrange multipliers
    assert float(worst.T12_peak) == pytest.approx(22.80, abs=0.005)


@pytest.mark.parametrize("name", ["press", "quick-return"])
def test_the_speed_with_a_flywheel_needs_a_constant_drive_torque(name):
    """With the speed of `flywheel` as omega2, drive torque and flywheel together are constant: T12 + J·α2 = const."""
    scene = ls.example(name)
    wheel = ls.flywheel(scene, fluctuation=0.2, theta2=1440)
    cycle = ls.sweep(replace(scene, omega2=wheel.speed), 1440, of=["T12", "alpha3" if name == "press" else "alpha4"])
    drive = cycle.T12 + wheel.flywheel_inertia * cycle.alpha2
    at_constant_speed = ls.sweep(scene, 1440, of=["T12"]).T12
    tolerance = 1e-6 if name == "press" else 1e-4  # the shaper's load jumps
    swing = float(at_constant_speed.max() - at_constant_speed.min())
    np.testing.assert_allclose(drive, float(wheel.drive_torque), rtol=0.0, atol=tolerance * swing)


def test_an_explicit_alpha2_is_used_and_check_reports_its_difference():
    def scene(**words):
        return replace(PRESS, omega2=lambda t: cosine(np.radians(t))[0], **words)

    alone = replace(PRESS, omega2=30.0 * (1.0 + 0.2 * np.cos(np.radians(70.0))), alpha2=0.0)
    assert ls.sweep(scene(alpha2=0.0), [70.0]).T12.item() == ls.sweep(alone, [70.0]).T12.item()
    omega, slope = cosine(np.radians(np.arange(720) * 0.5))
    checks = ls.check(scene(alpha2=xr.DataArray([0.0, 50.0], dims="case")))
    for case, inputs in enumerate((0.0, 50.0)):
        difference = abs(inputs - omega * slope)
        assert float(checks.alpha2_difference[case]) == pytest.approx(difference.max(), rel=1e-10)
        assert float(checks.alpha2_difference_at[case]) == 0.5 * difference.argmax()
    assert checks.alpha2_difference.units == "rad/s^2"
    by_hand = ls.check(scene(alpha2=lambda t: np.multiply(*cosine(np.radians(t)))))
    assert float(by_hand.alpha2_difference) < 1e-9
    for other in (scene(), PRESS, replace(PRESS, alpha2=7.0)):
        assert "alpha2_difference" not in ls.check(other)


def test_a_scene_without_alpha2_round_trips_through_files(tmp_path):
    angles = np.arange(0.0, 360.0, 5.0)
    inputs = xr.DataArray(cosine(np.radians(angles))[0], {"theta2": angles}, "theta2")
    scene = replace(PRESS, omega2=inputs)
    again = parse_scene(write_scene(scene))
    assert again == scene
    assert again.alpha2 is None
    np.testing.assert_array_equal(ls.sweep(again).T12, ls.sweep(scene).T12)
    ls.save(ls.sweep(scene, 36), tmp_path / "cycle.nc")
    read = ls.load_scene(tmp_path / "cycle.nc")
    np.testing.assert_array_equal(ls.sweep(read, 36).T12, ls.sweep(scene, 36).T12)


def test_studies_may_vary_alpha2_of_a_steady_crank():
    made = ls.sample(PRESS, {"alpha2": (-5.0, 5.0)}, n=8)
    assert made.alpha2.dims == ("design",)


def test_a_speed_that_jumps_is_refused():
    step = replace(PRESS, omega2=lambda t: np.where(np.mod(t, 360.0) < 180.0, 30.0, 20.0))
    (line,) = refusal(lambda: ls.sweep(step, 360))
    assert line == "omega2: jumps at theta2 = 0 degrees; give alpha2, or a ramp in place of the jump"
    assert np.isfinite(ls.sweep(replace(step, alpha2=0.0), 360).T12).all()


def test_an_omega2_at_one_angle_without_alpha2_is_refused():
    one = xr.DataArray([30.0], {"theta2": [5.0]}, "theta2")
    (line,) = refusal(lambda: ls.sweep(replace(PRESS, omega2=one), [5.0]))
    assert line.startswith("omega2: its 1 angles from 5 to 5 degrees cannot be joined")
    assert line.endswith("or give alpha2")


@pytest.mark.parametrize(
    ("words", "expected"), [pytest.param({}, False, marks=pytest.mark.long), ({"alpha2": 0.0}, True)]
)
def test_command_line_and_report_state_the_difference_of_alpha2(tmp_path, monkeypatch, capsys, words, expected):
    """30²·0.2·(1 + 0.2·cos θ)·sin θ is largest, 183.4 rad/s², at 79.1 degrees."""
    monkeypatch.chdir(tmp_path)
    angles = np.arange(0.0, 360.0, 5.0)
    speed = xr.DataArray(cosine(np.radians(angles))[0], {"theta2": angles}, "theta2")
    scene = replace(PRESS, omega2=speed, **words)
    (tmp_path / "uneven.toml").write_text(write_scene(scene))
    assert main(["check", "uneven.toml"]) == 0
    text = capsys.readouterr().out
    assert ("differs from that of omega2 by up to 183.4" in text) == expected
    ls.report(scene, tmp_path / "uneven.html")
    page = (tmp_path / "uneven.html").read_text("utf-8")
    assert ("acceleration of the crank" in page) == expected
    assert "mean power" in page  # over time, of a crank that changes its speed
    assert "flywheel for" not in page
