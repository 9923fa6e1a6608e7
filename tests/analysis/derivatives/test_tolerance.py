"""Tolerance: published limits of ISO 286, closed forms of linear results, drawn designs beside."""

import math
import re

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.analysis.design.fits import limit_deviations
from linksweep.cli.main import main
from linksweep.scene.parameters import replaced

PRESS = ls.example("press")
MADE = {"crank.length": "js9", "ground": ls.Tolerance("-50 um", "50 um")}


@pytest.mark.parametrize(
    ("name", "lower", "upper"),
    [  # ISO 286-2, tables of limit deviations
        ("30 j6", -4, 9),
        ("50 r6", 34, 50),
        ("50 s6", 43, 59),
        ("70 s6", 59, 78),
        ("40 k8", 0, 39),
        ("40 N9", -62, 0),
        ("3 N9", -29, -4),
        ("40 P9", -88, -26),
        ("40 P7", -42, -17),
        ("40 S7", -59, -34),
        ("300 M6", -41, -9),
        ("600 h7", -70, 0),  # table of sizes above 500 mm
        ("1200 g6", -94, -28),
        ("2000 js9", -185, 185),
        ("3150 n6", 135, 270),
        ("700 P7", -168, -88),
        ("700 N9", -250, -50),
        ("40 H7", 0, 25),
        ("40 g6", -25, -9),
        ("10 h9", -36, 0),
        ("25 f7", -41, -20),
        ("60 k6", 2, 21),
        ("100 p6", 37, 59),
        ("20 n6", 15, 28),
        ("8 m6", 6, 15),
        ("20 JS9", -26, 26),
        ("180 e8", -148, -85),
        ("50 D10", 80, 180),
        ("50 G7", 9, 34),
        ("3 h6", -6, 0),
    ],
)
def test_limits_are_those_of_the_standard(name, lower, upper):
    assert limit_deviations(name, 1.0) == pytest.approx((1e-6 * lower, 1e-6 * upper), abs=1e-12)


RANGES = {30.0: 0, 50.0: 1, 80.0: 2, 120.0: 3}
HOLES = {  # catalogue tables of ISO 286-2 for sizes up to 30, 50, 80 and 120 mm [µm]
    "J6": ((-5, 8), (-6, 10), (-6, 13), (-6, 16)),
    "J7": ((-9, 12), (-11, 14), (-12, 18), (-13, 22)),
    "J8": ((-13, 20), (-15, 24), (-18, 28), (-20, 34)),
    "K6": ((-11, 2), (-13, 3), (-15, 4), (-18, 4)),
    "K7": ((-15, 6), (-18, 7), (-21, 9), (-25, 10)),
    "K8": ((-23, 10), (-27, 12), (-32, 14), (-38, 16)),
    "M6": ((-17, -4), (-20, -4), (-24, -5), (-28, -6)),
    "M7": ((-21, 0), (-25, 0), (-30, 0), (-35, 0)),
    "M8": ((-29, 4), (-34, 5), (-41, 5), (-48, 6)),
    "N6": ((-24, -11), (-28, -12), (-33, -14), (-38, -16)),
    "N7": ((-28, -7), (-33, -8), (-39, -9), (-45, -10)),
    "N8": ((-36, -3), (-42, -3), (-50, -4), (-58, -4)),
    "R7": ((-41, -20), (-50, -25), (-62, -32), (-76, -41)),
    "H11": ((0, 130), (0, 160), (0, 190), (0, 220)),
    "JS8": ((-16.5, 16.5), (-19.5, 19.5), (-23, 23), (-27, 27)),
}


@pytest.mark.parametrize("name", HOLES)
def test_limits_of_holes_are_those_of_the_tables(name):
    for size, column in RANGES.items():
        expected = tuple(1e-6 * end for end in HOLES[name][column])
        assert limit_deviations(f"{size:g} {name}", 1.0) == pytest.approx(expected, abs=1e-12), size


def test_a_class_without_a_size_is_that_of_the_length():
    assert limit_deviations("H7", 0.04) == limit_deviations("40 H7", 9.0)


@pytest.mark.parametrize("name", ["40 Z7", "40 H20", "4000 H7", "600 s6", "40 j9", "40 J5"])
def test_classes_beyond_the_tables_are_refused(name):
    with pytest.raises(ValueError, match=name.split()[1]):
        limit_deviations(name, 1.0)


def test_a_result_that_is_linear_has_the_variance_of_its_terms():
    """N = m v²/R − m g·cos θ: at the bottom linear in the mass, whose drawn designs have the same sigma."""
    car = ls.Scene(ls.LoopTrack(radius=30.0, mass=700.0), speed=60.0, gravity=(0.0, -9.81), thrust=0.0)
    made = {"mass": ls.Tolerance(-6.0, 12.0), "gravity[2]": ls.Normal(deviation=0.1, within=2)}
    ds = ls.tolerance(car, made, of="normal_force_max", n=4096)
    of_mass, of_gravity = 60.0**2 / 30.0 + 9.81, -700.0
    part = math.sqrt(1 - 2 * 2 * math.exp(-2) / math.sqrt(2 * math.pi) / math.erf(math.sqrt(2)))
    sigmas = [of_mass * 18 / math.sqrt(12), 700.0 * 0.1 * part]
    assert float(ds.normal_force_max_sigma) == pytest.approx(math.hypot(*sigmas), rel=1e-12)
    assert ds.normal_force_max_share.values == pytest.approx(np.square(sigmas) / math.hypot(*sigmas) ** 2)
    assert float(ds.normal_force_max_shift) == pytest.approx(3.0 * of_mass)
    worst = float(ds.normal_force_max_worst_largest - ds.normal_force_max)
    assert worst == pytest.approx(12.0 * of_mass - 0.2 * of_gravity)
    assert float(ds.normal_force_max_drawn_sigma) == pytest.approx(math.hypot(*sigmas), rel=1e-3)
    assert float(ds.normal_force_max_drawn_largest) <= float(ds.normal_force_max_worst_largest) + 0.2


def test_drawn_designs_and_linear_agree_for_small_tolerances_alone():
    small = ls.tolerance(PRESS, MADE, of=["F32_peak", "swing"], n=256)
    for name in ("F32_peak", "swing"):
        assert float(small[f"{name}_sigma"]) == pytest.approx(float(small[f"{name}_drawn_sigma"]), rel=0.02)
    wide = ls.tolerance(PRESS, {"ground": ls.Tolerance("-3 cm", "3 cm")}, of="F32_peak", n=256)
    assert abs(float(wide.F32_peak_drawn_mean - wide.F32_peak)) > 5.0 * abs(float(wide.F32_peak_shift)) + 1.0


def test_designs_have_each_their_own():
    widths = xr.DataArray([0.01, 0.02], dims="w")
    both = ls.tolerance(replaced(PRESS, {"coupler.width": widths}), MADE, of="F32_peak", n=0)
    one = ls.tolerance(replaced(PRESS, {"coupler.width": 0.02}), MADE, of="F32_peak", n=0)
    assert both.F32_peak_sigma.dims == ("w",)
    assert float(both.F32_peak_sigma[1]) == pytest.approx(float(one.F32_peak_sigma), rel=1e-9)


@pytest.mark.parametrize(
    ("made", "words"),
    [
        ({"crank.lenght": "js9"}, "did you mean"),
        (0.0001, 'tolerances = 0.0001: must name what varies, as in {"crank.length": "h9"}'),
        ({"omega2": "h7"}, "class of lengths"),
        ({"crank.length": "H77"}, "crank.length = 'H77': grade 77: must be from 5 to 14"),
        ({"ground": 0.1}, "must be ls.Tolerance"),
        ({"ground": ls.Normal(0.2, 0.1)}, "mean of its own"),
    ],
)
def test_refusals_name_the_parameter(made, words):
    with pytest.raises(ValueError, match=words):
        ls.tolerance(PRESS, made, of="F32_peak")


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (ls.Normal(deviation=1e-4, within=0), "within = 0: must be greater than 0"),
        (ls.Normal(deviation=1e-4, within=-1.0), "within = -1.0: must be greater than 0"),
        (ls.Normal(deviation=1e-4, within="x"), "within = 'x': must be greater than 0"),
        (ls.Normal(deviation=1e-4, within=None), "within = None: must be greater than 0"),
        (ls.Normal(deviation=-1e-4), "deviation = -0.0001: must be greater than 0"),
        (ls.Tolerance(5e-5, -5e-5), "Tolerance(5e-05, -5e-05): low must be less than high; swap them"),
        (ls.Tolerance(0.0, 0.0), "Tolerance(0, 0): low must be less than high; give the scene itself a value"),
    ],
)
@pytest.mark.parametrize("n", [0, 8])
def test_tolerances_without_width_are_refused_whether_designs_are_drawn_or_not(made, words, n):
    with pytest.raises(ValueError, match=f"^{re.escape(f'crank.length: {words}')}"):
        ls.tolerance(PRESS, {"crank.length": made}, of="F32_peak", n=n)


@pytest.mark.parametrize("within", [1e-9, 1e-6, 0.01])
def test_a_narrow_part_of_a_normal_distribution_is_even(within):
    """From -k to k the density is constant to k²/2, and the deviation k/√3 to k²/15."""
    narrow = ls.tolerance(PRESS, {"ground": ls.Normal(deviation=1e-3, within=within)}, of="F32_peak", n=0)
    even = ls.tolerance(PRESS, {"ground": ls.Tolerance(-1e-3 * within, 1e-3 * within)}, of="F32_peak", n=0)
    assert float(narrow.F32_peak_sigma) == pytest.approx(float(even.F32_peak_sigma), rel=within**2 / 15 + 1e-11, abs=0)


def test_an_angle_alone_does_not_say_which_of_its_extremes():
    with pytest.raises(ValueError, match=r"of: transmission_angle is a quantity; .* transmission_angle_min"):
        ls.tolerance(PRESS, {"ground": "js9"}, of="transmission_angle")


def test_commands_print_the_tables(capsys):
    main(["sensitivities", "press", "--of", "F32_peak", "--to", "ground", "crank.length"])
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("F32_peak = 354.5") and any(line.startswith("ground") for line in lines)
    limits = ["--tol", "crank.length", "-20 um", "20 um"]
    names = ["--of", "F32_peak", "swing", "time_ratio"]
    main(["tolerance", "press", *names, "--tol", "ground", "js9", *limits, "-n", "8"])
    text = capsys.readouterr().out
    assert "\nswing = 61.3156°, sigma" in text and "time_ratio = 1.32804, sigma" in text
    assert "sigma" in text and "of the variance" in text and "drawn designs" in text


def test_commands_take_the_capacity_of_bearings(capsys):
    pins = dict.fromkeys("ABCD", ls.Bearing(capacity=5000.0, kind="roller"))
    expected = ls.sensitivities(PRESS, of=["L10_B"], to=["ground"], pins=pins)
    rating = ["--capacity", "5 kN", "--kind", "roller"]
    main(["sensitivities", "press", "--of", "L10_B", "--to", "ground", *rating])
    assert f"L10_B = {float(expected.L10_B):.6g}" in capsys.readouterr().out
    main(["tolerance", "press", "--of", "L10_B", "--tol", "ground", "js9", *rating, "-n", "0"])
    assert f"{float(expected.L10_B):.6g}" in capsys.readouterr().out
    assert main(["sensitivities", "press", "--of", "L10_B"]) == 2
    assert "give --capacity" in capsys.readouterr().err


def test_the_command_shows_derivatives_per_shown_unit_of_the_parameter(capsys):
    """A pound force is 0.45359237·9.80665 N, an inch 0.0254 m."""
    assert main(["sensitivities", "press", "--of", "F32_peak", "--to", "ground", "--units", "US"]) == 0
    slope = ls.sensitivities(PRESS, of="F32_peak", to="ground").F32_peak_derivative.item()
    assert f"{slope * 0.0254 / (0.45359237 * 9.80665):.5g}  lbf per in" in capsys.readouterr().out
